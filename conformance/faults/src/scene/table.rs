//! The mistakes of whole renderers: a frame that is drawn as if it were another, and an image that is written as if it were.

use crate::row::{Arithmetic as _, Narrowing};
use lightmeter_reference::color;
use lightmeter_scene::blend::{Factor, State};
use lightmeter_scene::frame::{
    Cull, Fog, FogForm, Frame, Light, Material, Place, Shading, TextureFilter, Textured, Wrap,
};
use lightmeter_scene::raster::Provoking;
use lightmeter_scene::shading::{Ambient, Distance, Frequency, LightAmbient, Normals, Specular, SpecularGate, Viewer};

/// A mistake of a renderer.
#[derive(Debug)]
pub struct SceneFault {
    /// Its name.
    pub name: &'static str,
    /// In words, as the end of a sentence.
    pub says: &'static str,
    /// A renderer that made it, or where it comes from.
    pub seen_in: Option<&'static str>,
    /// What it changes.
    pub(super) change: Change,
}

/// What a mistake changes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Change {
    /// The frame, before it is drawn.
    Frame(fn(&mut Frame)),
    /// Given a pixel and the image's size, each as column and row: the pixel that it takes its colour from.
    Place(fn([usize; 2], [usize; 2]) -> [usize; 2]),
    /// The colour of every pixel, in linear values before it is stored. It is monotone in each component.
    Color(fn([f64; 4]) -> [f64; 4]),
}

macro_rules! seen_in {
    () => {
        None
    };
    ($seen_in:literal) => {
        Some($seen_in)
    };
}

macro_rules! faults {
    ($($kind:ident $name:literal $says:literal $(@ $seen_in:literal)? $change:expr;)*) => {
        /// Every mistake.
        pub const SCENE_FAULTS: &[SceneFault] =
            &[$(SceneFault { name: $name, says: $says, seen_in: seen_in!($($seen_in)?), change: Change::$kind($change) }),*];
    };
}

faults! {
    // Where lights are.
    Frame "light-reversed" "lights shine from the other side" @ "OpenGL's direction to the light for the direction of travel" |frame| each_place(frame, |place| match place {
        Place::Directional { toward, .. } => negate(toward),
        Place::Point { position, .. } | Place::Spot { position, .. } => negate(position),
    });
    Frame "positional-as-directional" "positional lights are taken as directional" |frame| each_place(frame, |place| {
        if let Place::Point { position, .. } | Place::Spot { position, .. } = place {
            *place = Place::Directional { toward: *position, unit: false };
        }
    });
    Frame "directional-as-positional" "directional lights are taken as positional" |frame| each_place(frame, |place| {
        if let Place::Directional { toward, .. } = place {
            *place = Place::Point { position: *toward, falloff: [1.0, 0.0, 0.0] };
        }
    });
    Frame "light-not-normalised" "the vector to a directional light is not normalised" |frame| each_place(frame, |place| {
        if let Place::Directional { unit, .. } = place {
            *unit = true;
        }
    });
    Frame "attenuation-left-out" "attenuation is left out" |frame| each_falloff(frame, |falloff| *falloff = [1.0, 0.0, 0.0]);
    Frame "attenuation-swapped" "the linear and the quadratic term of attenuation are swapped" |frame| each_falloff(frame, |falloff| falloff.swap(1, 2));
    Frame "attenuation-without-constant" "the constant term of attenuation is left out" |frame| each_falloff(frame, |falloff| if falloff[1] + falloff[2] > 0.0 { falloff[0] = 0.0 });
    Frame "attenuation-inverse-square" "attenuation is the inverse square of the distance" @ "three.js, decay 2; Filament" |frame| each_falloff(frame, |falloff| *falloff = [0.0, 0.0, 1.0]);
    Frame "spot-as-point" "spotlights shine all around" |frame| each_place(frame, |place| {
        if let Place::Spot { position, falloff, .. } = *place {
            *place = Place::Point { position, falloff };
        }
    });
    Frame "spot-exponent-left-out" "a spotlight is as bright at its edge as in its middle" @ "OpenGL's GL_SPOT_EXPONENT left at 0" |frame| each_place(frame, |place| {
        if let Place::Spot { exponent, .. } = place {
            *exponent = 0.0;
        }
    });
    Frame "spot-half-angle" "a spotlight's angle is taken for the whole cone's" @ "Babylon.js" |frame| each_place(frame, |place| {
        if let Place::Spot { cutoff_cosine, .. } = place {
            *cutoff_cosine = (0.5 * cutoff_cosine.acos()).cos();
        }
    });
    Frame "last-light-left-out" "the last light is left out" |frame| { frame.lights.pop(); };
    Frame "lights-limited-to-eight" "no more than eight lights shine" @ "OpenGL's GL_LIGHT0 to GL_LIGHT7" |frame| frame.lights.truncate(8);
    Frame "lights-limited" "the lights' colours are limited to 1" |frame| each_light(frame, |light| [&mut light.ambient, &mut light.diffuse, &mut light.specular].into_iter().flatten().for_each(|c| *c = c.min(1.0)));
    Frame "first-light-alone" "the first light alone shines" |frame| frame.lights.truncate(1);
    // Terms.
    Frame "ambient-left-out" "the ambient light is left out" |frame| frame.ambient = [0.0; 3];
    Frame "ambient-twice" "the ambient light is added twice" |frame| frame.ambient = frame.ambient.map(|c| 2.0 * c);
    Frame "ambient-without-material" "the ambient light is added as it is: the material's ambient colour is left out" @ "document 004's constant ambient term" |frame| if frame.ambient_form == Ambient::Product {
        frame.ambient_form = Ambient::Constant;
    };
    Frame "ambient-times-material" "the material's ambient colour multiplies an ambient term that is a constant" @ "OpenGL's fixed function" |frame| if frame.ambient_form == Ambient::Constant {
        frame.ambient_form = Ambient::Product;
    };
    Frame "light-ambient-left-out" "the lights' own ambient terms are left out" |frame| each_light(frame, |light| light.ambient = [0.0; 3]);
    Frame "ambient-attenuated" "attenuation weakens the lights' own ambient terms" @ "OpenGL's fixed function" |frame| if frame.light_ambient == LightAmbient::Documents {
        frame.light_ambient = LightAmbient::OpenGl;
    };
    Frame "ambient-not-attenuated" "attenuation does not weaken the lights' own ambient terms" |frame| if frame.light_ambient == LightAmbient::OpenGl {
        frame.light_ambient = LightAmbient::Documents;
    };
    Frame "emission-left-out" "emission is left out" @ "pygfx" |frame| each_material(frame, |material| material.emissive = [0.0; 3]);
    Frame "diffuse-left-out" "the diffuse term is left out" |frame| each_light(frame, |light| light.diffuse = [0.0; 3]);
    Frame "specular-left-out" "the highlight is left out" |frame| each_material(frame, |material| material.specular = [0.0; 3]);
    Frame "light-specular-ignored" "the highlight has the light's diffuse colour" @ "engines whose lights have one colour" |frame| each_light(frame, |light| light.specular = light.diffuse);
    Frame "material-specular-ignored" "the highlight is white whatever the material" |frame| each_material(frame, |material| material.specular = [1.0; 3]);
    Frame "shininess-fourfold" "shininess is 4 times what was asked" @ "Blinn's exponent converted from Phong's" |frame| each_material(frame, |material| material.shininess *= 4.0);
    Frame "shininess-quarter" "shininess is a quarter of what was asked" @ "Phong's exponent converted from Blinn's" |frame| each_material(frame, |material| material.shininess *= 0.25);
    Frame "shininess-limited-to-128" "the shininess is limited to 128" @ "OpenGL's GL_SHININESS" |frame| each_material(frame, |material| material.shininess = material.shininess.min(128.0));
    Frame "shininess-128ths" "shininess is in 128ths" |frame| each_material(frame, |material| material.shininess /= 128.0);
    // How it is lit.
    Frame "gouraud-for-phong" "the vertices are lit in the place of the fragments" @ "OpenGL's fixed function; three.js, MeshLambertMaterial of old" |frame| each_shading(frame, |shading| if shading.frequency == Frequency::Phong { shading.frequency = Frequency::Gouraud });
    Frame "phong-for-gouraud" "the fragments are lit in the place of the vertices" |frame| each_shading(frame, |shading| if shading.frequency == Frequency::Gouraud { shading.frequency = Frequency::Phong });
    Frame "flat-for-smooth" "faces are lit once" |frame| each_shading(frame, |shading| shading.frequency = Frequency::Flat);
    Frame "smooth-for-flat" "flat faces are lit at their vertices" |frame| each_shading(frame, |shading| if shading.frequency == Frequency::Flat { shading.frequency = Frequency::Gouraud });
    Frame "last-vertex-for-first" "a flat face has the colour of its last vertex, not of its first" @ "OpenGL's provoking vertex" |frame| each_shading(frame, |shading| if shading.provoking == Provoking::First {
        shading.provoking = Provoking::Last;
    });
    Frame "first-vertex-for-last" "a flat face has the colour of its first vertex, not of its last" @ "Vulkan's and Direct3D's provoking vertex" |frame| each_shading(frame, |shading| if shading.provoking == Provoking::Last {
        shading.provoking = Provoking::First;
    });
    Frame "blinn-for-phong" "the highlight is Blinn's in the place of Phong's" @ "three.js, MeshPhongMaterial" |frame| each_shading(frame, |shading| if shading.specular == Specular::Phong { shading.specular = Specular::Blinn });
    Frame "phong-for-blinn" "the highlight is Phong's in the place of Blinn's" |frame| each_shading(frame, |shading| if shading.specular == Specular::Blinn { shading.specular = Specular::Phong });
    Frame "half-vector-not-normalised" "the half vector is not normalised" |frame| each_shading(frame, |shading| if shading.specular == Specular::Blinn { shading.specular = Specular::BlinnUnnormalised });
    Frame "normalised-highlight" "the highlight is Blinn's normalised lobe with Schlick's Fresnel term, times n·l" @ "three.js, BRDF_BlinnPhong under lights of intensity π" |frame| if frame.draws.iter().any(|draw| draw.shading.is_some()) {
        frame.departures.fresnel_highlight = true;
    };
    Frame "highlight-over-texture" "a texture multiplies what is diffuse, and the highlight is added afterwards" |frame| if frame.draws.iter().any(|draw| draw.shading.is_some() && (draw.texture.is_some() || draw.lightmap.is_some())) {
        frame.departures.highlight_over_texture = true;
    };
    Frame "specular-gated" "the highlight is 0 where the light is behind the surface" @ "OpenGL's fixed function" |frame| each_shading(frame, |shading| if shading.gate == SpecularGate::Documents {
        shading.gate = SpecularGate::OpenGl;
    });
    Frame "specular-not-gated" "there is a highlight where the light is behind the surface" @ "document 000's programs" |frame| each_shading(frame, |shading| if shading.gate == SpecularGate::OpenGl {
        shading.gate = SpecularGate::Documents;
    });
    Frame "viewer-at-infinity" "the viewer is infinitely far away, not at the eye" @ "OpenGL's GL_LIGHT_MODEL_LOCAL_VIEWER left off" |frame| each_shading(frame, |shading| if shading.viewer == Viewer::Local {
        shading.viewer = Viewer::NonLocal;
    });
    Frame "viewer-at-the-eye" "the viewer is at the eye, not infinitely far away" |frame| each_shading(frame, |shading| if shading.viewer == Viewer::NonLocal {
        shading.viewer = Viewer::Local;
    });
    Frame "normals-by-modelview" "normals are brought to eye space by the modelview" @ "documents 000 and 003" |frame| each_shading(frame, |shading| shading.normals = Normals::Modelview);
    Frame "normals-not-normalised" "normals keep the length that the modelview leaves them" |frame| if frame.draws.iter().any(|draw| draw.shading.is_some()) {
        frame.departures.normals_at_length = true;
    };
    Frame "normals-reversed" "normals point inward" |frame| frame.meshes.iter_mut().flat_map(|mesh| &mut mesh.normals).for_each(negate);
    Frame "fragment-normals-not-normalised" "interpolated normals are not normalised again" @ "interpolated normals used as they come" |frame| if frame.draws.iter().any(is_lit_by_fragments) {
        frame.departures.fragment_normals_at_length = true;
    };
    Frame "two-sided" "normals are turned towards the eye" @ "faceforward; pygfx, issue 105" |frame| if frame.draws.iter().any(|draw| draw.shading.is_some()) {
        frame.departures.two_sided = true;
    };
    Frame "half-lambert" "the diffuse term is half-Lambert: (0.5 n·l + 0.5)²" @ "Valve's half Lambert" |frame| if frame.draws.iter().any(|draw| draw.shading.is_some()) && !frame.lights.is_empty() {
        frame.departures.half_lambert = true;
    };
    // Which object something is of.
    Frame "matrix-of-the-first-object" "every object is drawn by the first one's matrix" |frame| if let Some(first) = frame.draws.first().map(|draw| draw.modelview) {
        each_draw(frame, |draw| draw.modelview = first);
    };
    Frame "material-of-the-first-object" "every object has the first one's material" |frame| if let Some(first) = frame.draws.first().map(|draw| draw.material) {
        each_material(frame, |material| *material = first);
    };
    Frame "material-of-the-last-object" "every object has the last one's material" |frame| if let Some(last) = frame.draws.last().map(|draw| draw.material) {
        each_material(frame, |material| *material = last);
    };
    // Fog.
    Frame "fog-left-out" "fog is left out" |frame| frame.fog = None;
    Frame "fog-radial" "fog is by the distance from the eye, not by the depth" @ "OpenGL drivers; Unity" |frame| each_fog(frame, |fog| if fog.distance == Distance::Planar {
        fog.distance = Distance::Radial;
    });
    Frame "fog-planar" "fog is by the depth, not by the distance from the eye" @ "three.js; OpenGL drivers" |frame| each_fog(frame, |fog| if fog.distance == Distance::Radial {
        fog.distance = Distance::Planar;
    });
    Frame "fog-exp2-opengl-for-document" "exponential fog of the square squares the density, too, as OpenGL does" @ "OpenGL; three.js, FogExp2" |frame| each_fog(frame, |fog| if let FogForm::Exp2Document { density } = fog.form {
        fog.form = FogForm::Exp2OpenGl { density };
    });
    Frame "fog-exp2-document-for-opengl" "exponential fog of the square does not square the density" @ "document 000" |frame| each_fog(frame, |fog| if let FogForm::Exp2OpenGl { density } = fog.form {
        fog.form = FogForm::Exp2Document { density };
    });
    Frame "fog-exp-for-exp2" "fog is of the distance in the place of its square" |frame| each_fog(frame, |fog| if let FogForm::Exp2Document { density } | FogForm::Exp2OpenGl { density } = fog.form {
        fog.form = FogForm::Exp { density };
    });
    Frame "fog-exp2-for-exp" "fog is of the distance's square in the place of the distance" @ "three.js, FogExp2" |frame| each_fog(frame, |fog| if let FogForm::Exp { density } = fog.form {
        fog.form = FogForm::Exp2OpenGl { density };
    });
    Frame "fog-smoothstep" "linear fog follows smoothstep" @ "three.js, Fog" |frame| if matches!(frame.fog, Some(Fog { form: FogForm::Linear { .. }, .. })) {
        frame.departures.smoothstep_fog = true;
    };
    Frame "fog-ends-swapped" "where linear fog begins and where it ends are swapped" |frame| each_fog(frame, |fog| if let FogForm::Linear { dmin, dmax } = &mut fog.form {
        std::mem::swap(dmin, dmax);
    });
    Frame "fog-black" "fog is black" |frame| each_fog(frame, |fog| fog.color = [0.0; 3]);
    // Blending, depth, order.
    Frame "blend-left-out" "blending is left out" |frame| each_draw(frame, |draw| draw.blend = None);
    Frame "blend-premultiplied" "colours are taken as multiplied by their alpha already" @ "three.js, premultipliedAlpha" |frame| each_state(frame, |state| if state.src == Factor::SrcAlpha { state.src = Factor::One });
    Frame "blend-factors-swapped" "the factors of source and destination are swapped" |frame| each_state(frame, |state| std::mem::swap(&mut state.src, &mut state.dst));
    Frame "blend-additive" "colours are added whatever the destination's factor" |frame| each_state(frame, |state| state.dst = Factor::One);
    Frame "alpha-one" "what is translucent is opaque" @ "three.js, materials not marked transparent" |frame| each_draw(frame, |draw| draw.alpha = 1.0);
    Frame "order-reversed" "objects are drawn in the reverse order" @ "transparent objects sorted front to back" |frame| frame.draws.reverse();
    Frame "depth-left-out" "the depth test is left out" |frame| each_draw(frame, |draw| draw.depth = None);
    Frame "depth-always-written" "what is blended leaves its depth" |frame| each_draw(frame, |draw| if let Some(test) = &mut draw.depth { test.write = true });
    Frame "front-culled-for-back" "front faces are culled in the place of back faces" @ "clockwise front faces; a mirrored projection" |frame| each_draw(frame, |draw| if draw.cull == Cull::Back {
        draw.cull = Cull::Front;
    });
    Frame "cull-left-out" "no face is culled" |frame| each_draw(frame, |draw| draw.cull = Cull::None);
    // Textures and colours of vertices.
    Frame "texture-left-out" "textures are left out" |frame| each_draw(frame, |draw| draw.texture = None);
    Frame "texture-replaces" "a texture takes the place of the colour that it should multiply" @ "OpenGL's GL_REPLACE" |frame| each_texture(frame, |texture| if !texture.replaces {
        texture.replaces = true;
    });
    Frame "texture-multiplies" "a texture multiplies the colour whose place it should take" @ "OpenGL's GL_MODULATE" |frame| each_texture(frame, |texture| if texture.replaces {
        texture.replaces = false;
    });
    Frame "texture-filtered" "textures are filtered bilinearly, not read at the nearest texel" |frame| each_texture(frame, |texture| if texture.sampled.filter == TextureFilter::Nearest {
        texture.sampled.filter = TextureFilter::Bilinear;
    });
    Frame "texture-not-filtered" "textures are read at the nearest texel, not filtered bilinearly" |frame| each_texture(frame, |texture| if texture.sampled.filter == TextureFilter::Bilinear {
        texture.sampled.filter = TextureFilter::Nearest;
    });
    Frame "texture-clamped" "textures are clamped at their edges, not repeated" @ "WebGPU's default, clamp-to-edge" |frame| each_texture(frame, |texture| if texture.sampled.wrap == Wrap::Repeat {
        texture.sampled.wrap = Wrap::Clamp;
    });
    Frame "texture-repeated" "textures are repeated beyond their edges, not clamped" @ "OpenGL's default, GL_REPEAT" |frame| each_texture(frame, |texture| if texture.sampled.wrap == Wrap::Clamp {
        texture.sampled.wrap = Wrap::Repeat;
    });
    Frame "texture-upside-down" "textures are upside down" @ "OpenGL's origin of images for WebGPU's" |frame| frame.meshes.iter_mut().flat_map(|mesh| &mut mesh.uvs).for_each(|uv| uv[1] = 1.0 - uv[1]);
    Frame "texture-alpha-ignored" "the alpha of textures and lightmaps is taken as 1" @ "textures uploaded as RGB" |frame| frame.textures.iter_mut().flat_map(|texture| &mut texture.texels).for_each(|texel| texel[3] = 1.0);
    Frame "vertex-alpha-ignored" "the alpha of the vertices' colours is taken as 1" @ "vertex colours of three components" |frame| frame.meshes.iter_mut().flat_map(|mesh| &mut mesh.colors).for_each(|color| color[3] = 1.0);
    Frame "lightmap-left-out" "lightmaps are left out" |frame| each_draw(frame, |draw| draw.lightmap = None);
    Frame "vertex-colours-left-out" "the vertices' colours are left out" |frame| each_draw(frame, |draw| draw.vertex_colors = false);
    Frame "texture-half-a-texel-off" "textures are read half a texel to the left and up" @ "texel coordinates without their ½" |frame| each_texture_coordinate(frame, |uv, size| {
        (0..2).for_each(|k| uv[k] -= 0.5 / size[k]);
    });
    Frame "texel-truncated" "a nearest texel is found by truncation, not by ⌊x⌋: below 0 it is the next one" @ "ivec2(uv * size)" |frame| if frame.draws.iter().any(|draw| draw.texture.is_some() || draw.lightmap.is_some()) {
        frame.departures.truncated_texels = true;
    };
    Frame "texture-magnitudes" "texture coordinates count by their magnitude" |frame| if frame.draws.iter().any(|draw| draw.texture.is_some() || draw.lightmap.is_some()) {
        frame.departures.texture_magnitudes = true;
    };
    Frame "texture-for-lightmap" "the lightmap is read at the texture's coordinates" @ "meshes with one set of coordinates" |frame| for mesh in &mut frame.meshes {
        if !mesh.uvs.is_empty() && !mesh.lightmap_uvs.is_empty() {
            mesh.lightmap_uvs.clone_from(&mesh.uvs);
        }
    };
    Frame "cutout-at-half" "the cutout's threshold is ½ whatever was asked" |frame| each_draw(frame, |draw| draw.cutout.iter_mut().for_each(|threshold| *threshold = 0.5));
    Frame "cutout-at-the-threshold" "what has the cutout's threshold for its alpha is cut out, too" @ "alpha <= threshold for alpha < threshold" |frame| each_draw(frame, |draw| {
        draw.cutout.iter_mut().for_each(|threshold| *threshold = threshold.next_up());
    });
    Frame "cutout-turned" "what is at or above the cutout's threshold is cut out in the place of what is below" |frame| if frame.draws.iter().any(|draw| draw.cutout.is_some()) {
        frame.departures.cutout_turned = true;
    };
    Frame "alpha-fogged" "fog takes alpha to 1 as it takes colours to its own" @ "mix(fog, color, f) of four components" |frame| if frame.fog.is_some() {
        frame.departures.fogged_alpha = true;
    };
    Frame "clamped-at-the-vertices" "what is lit at the vertices is limited to 1 there, before it is interpolated" @ "gl4es; OpenGL's fixed function" |frame| if frame.draws.iter().any(|draw| draw.shading.is_some_and(|shading| shading.frequency == Frequency::Gouraud)) {
        frame.departures.clamped_vertices = true;
    };
    Frame "lit-at-least-0" "what is lit is held above 0, before it is interpolated" @ "max(color, 0) at the end of a lighting function" |frame| if frame.draws.iter().any(|draw| draw.shading.is_some()) {
        frame.departures.lit_at_least_0 = true;
    };
    Frame "axis-not-normalised" "a spotlight's axis is not normalised" |frame| if frame.lights.iter().any(|light| matches!(light.place, Place::Spot { .. })) {
        frame.departures.axis_at_length = true;
    };
    Frame "cutout-left-out" "nothing is cut out" |frame| each_draw(frame, |draw| draw.cutout = None);
    // Where pixels are.
    Frame "half-pixel" "all is half a pixel to the right and down, as if pixels were sampled at their upper left corners" @ "Direct3D 9" |frame| shift(frame, [0.5, 0.5]);
    Frame "mirrored" "the image is mirrored" @ "a left-handed camera for a right-handed one" |frame| scale(frame, 0, -1.0);
    Frame "background-black" "the background is black" |frame| frame.background = [0.0, 0.0, 0.0, frame.background[3]];
    Place "upside-down" "the image is upside down" @ "OpenGL's origin for WebGPU's" |[x, y], [_, height]| [x, height - 1 - y];
    // How colours are written.
    Color "red-and-blue-swapped" "red and blue are swapped" @ "BGRA read as RGBA" |[r, g, b, a]| [b, g, r, a];
    Color "srgb-encoded" "colours are encoded as sRGB and the target is not" @ "three.js, the default output colour space" |pixel| each_color(pixel, |c| color::srgb_encode(c.clamp(0.0, 1.0)));
    Color "gamma-encoded" "colours are raised to the power 1/2.2" |pixel| each_color(pixel, |c| c.max(0.0).powf(1.0 / 2.2));
    Color "gamma-decoded" "colours are raised to the power 2.2" |pixel| each_color(pixel, |c| c.max(0.0).powf(2.2));
    Color "clamped" "colours are clamped to 1 and the target is not" @ "OpenGL's fixed function" |pixel| each_color(pixel, |c| c.clamp(0.0, 1.0));
    Color "not-below-0" "colours below 0 are taken as 0" @ "max(color, 0) at the end of a fragment shader" |pixel| each_color(pixel, |c| c.max(0.0));
    Color "premultiplied" "colours are multiplied by their alpha" @ "a browser's canvas" |[r, g, b, a]| [r * a, g * a, b * a, a];
    Color "alpha-lost" "alpha is 1 everywhere" |[r, g, b, _]| [r, g, b, 1.0];
    Color "truncated" "steps of 8 bits are truncated and not rounded" @ "int(255·c)" |pixel| pixel.map(|c| ((255.0 * c + 1e-9).floor() / 255.0).min(c));
    Frame "shininess-of-1000-as-128" "the shininess is rescaled from a range of 1000 to one of 128" @ "importers of Wavefront materials for OpenGL" |frame| each_material(frame, |material| material.shininess *= 0.128);
    Frame "shininess-ignored" "the shininess is ignored: the highlight is the bare cosine" |frame| each_material(frame, |material| material.shininess = 1.0);
    Frame "attenuation-plus-one" "the divisor of attenuation has 1 added" @ "PlayCanvas; (1 + d²) that never divides by 0" |frame| each_falloff(frame, |falloff| if falloff[1] + falloff[2] > 0.0 { falloff[0] += 1.0 });
    Frame "spot-exponent-fourfold" "a spotlight's exponent is 4 times what was asked" |frame| each_place(frame, |place| if let Place::Spot { exponent, .. } = place { *exponent *= 4.0 });
    Frame "spot-axis-reversed" "spotlights point the other way" |frame| each_place(frame, |place| if let Place::Spot { axis, .. } = place { negate(axis) });
    Frame "fog-density-squared" "the fog's density is squared" |frame| each_fog(frame, |fog| if let FogForm::Exp { density } | FogForm::Exp2Document { density } | FogForm::Exp2OpenGl { density } = &mut fog.form { *density *= *density });
    Frame "half-pixel-reversed" "all is half a pixel to the left and up, as if pixels were sampled at their lower right corners" @ "corrections for Direct3D 9 that are kept elsewhere" |frame| shift(frame, [-0.5, -0.5]);
    Color "in-half-precision" "the image is held in half precision" @ "mediump; rgba16float targets" |pixel| each_color(pixel, |c| c.in_half(Narrowing::Rounded));
    Color "in-8-bits" "the image is held in 8 bits on its way" @ "intermediate targets of 8 bits" |pixel| each_color(pixel, |c| (255.0 * c.clamp(0.0, 1.0)).round_ties_even() / 255.0);
    Color "srgb-encoded-twice" "colours are encoded for sRGB twice" @ "an sRGB target beneath a shader that encodes" |pixel| each_color(pixel, |c| color::srgb_encode(color::srgb_encode(c.clamp(0.0, 1.0))));
    Color "half-as-bright" "all is half as bright" |pixel| each_color(pixel, |c| 0.5 * c);
}

/// Whether a draw is lit at its fragments.
fn is_lit_by_fragments(draw: &lightmeter_scene::frame::Draw) -> bool {
    draw.shading.is_some_and(|shading| shading.frequency == Frequency::Phong)
}

fn negate(v: &mut [f32; 3]) {
    v.iter_mut().for_each(|x| *x = -*x);
}

fn each_light(frame: &mut Frame, change: impl Fn(&mut Light)) {
    frame.lights.iter_mut().for_each(change);
}

fn each_place(frame: &mut Frame, change: impl Fn(&mut Place)) {
    each_light(frame, |light| change(&mut light.place));
}

fn each_falloff(frame: &mut Frame, change: impl Fn(&mut [f32; 3])) {
    each_place(frame, |place| {
        if let Place::Point { falloff, .. } | Place::Spot { falloff, .. } = place {
            change(falloff);
        }
    });
}

fn each_draw(frame: &mut Frame, change: impl Fn(&mut lightmeter_scene::frame::Draw)) {
    frame.draws.iter_mut().for_each(change);
}

fn each_material(frame: &mut Frame, change: impl Fn(&mut Material)) {
    each_draw(frame, |draw| change(&mut draw.material));
}

fn each_shading(frame: &mut Frame, change: impl Fn(&mut Shading)) {
    each_draw(frame, |draw| draw.shading.iter_mut().for_each(&change));
}

fn each_texture(frame: &mut Frame, change: impl Fn(&mut Textured)) {
    each_draw(frame, |draw| draw.texture.iter_mut().for_each(&change));
}

/// The texture coordinates of each draw's mesh, with the size of the texture that they are of.
#[expect(clippy::cast_precision_loss, reason = "a texture's size")]
fn each_texture_coordinate(frame: &mut Frame, change: impl Fn(&mut [f32; 2], [f32; 2])) {
    let size = |texture: usize| [frame.textures[texture].width as f32, frame.textures[texture].height as f32];
    let mut sizes = vec![[None; 2]; frame.meshes.len()];
    for draw in &frame.draws {
        sizes[draw.mesh] = [
            draw.texture.map(|textured| size(textured.sampled.texture)),
            draw.lightmap.map(|sampled| size(sampled.texture)),
        ];
    }
    for (mesh, [texture, lightmap]) in frame.meshes.iter_mut().zip(sizes) {
        for (uvs, size) in [(&mut mesh.uvs, texture), (&mut mesh.lightmap_uvs, lightmap)] {
            size.into_iter().for_each(|size| uvs.iter_mut().for_each(|uv| change(uv, size)));
        }
    }
}

fn each_fog(frame: &mut Frame, change: impl Fn(&mut Fog)) {
    frame.fog.iter_mut().for_each(change);
}

fn each_state(frame: &mut Frame, change: impl Fn(&mut State)) {
    each_draw(frame, |draw| {
        if let Some(blend) = &mut draw.blend {
            change(&mut blend.state.color);
            change(&mut blend.state.alpha);
        }
    });
}

fn each_color([r, g, b, a]: [f64; 4], change: impl Fn(f64) -> f64) -> [f64; 4] {
    [change(r), change(g), change(b), a]
}

/// Moves all that is drawn by a number of pixels, right and down.
#[expect(clippy::cast_precision_loss, reason = "a target's size")]
fn shift(frame: &mut Frame, by: [f32; 2]) {
    let size = [frame.target.width as f32, -(frame.target.height as f32)];
    for column in &mut frame.projection {
        for axis in 0..2 {
            column[axis] += 2.0 * by[axis] / size[axis] * column[3];
        }
    }
}

/// Scales an axis of clip space.
fn scale(frame: &mut Frame, axis: usize, by: f32) {
    frame.projection.iter_mut().for_each(|column| column[axis] *= by);
}
