//! A frame as a file that any renderer can read: plain numbers, and the words of scene files.

use lightmeter_document::Word;
use lightmeter_document::frame::{
    BlendWords, FrameBlend, FrameDepth, FrameDocument, FrameDraw, FrameFog, FrameFogForm, FrameLight, FrameMaterial,
    FrameMesh, FrameSampled, FrameShading, FrameTarget, FrameTexture, FrameTextured, LightPlace, SCHEMA,
};
use lightmeter_scene::blend::State;
use lightmeter_scene::effects::{Effect, effects};
use lightmeter_scene::frame::{Draw, Fog, FogForm, Frame, Light, Material, Mesh, Place, Sampled, Shading, Textured};
use lightmeter_scene::model;
use lightmeter_scene::shading::Frequency;
use serde::Serialize;
use serde_json::Value;

/// The frame with its meshes and textures.
#[must_use]
pub fn document(id: &str, title: &str, frame: &Frame) -> FrameDocument {
    let texture = |texture: &lightmeter_scene::frame::Texture| FrameTexture {
        width: texture.width,
        height: texture.height,
        texels: texture.texels.clone(),
    };
    FrameDocument {
        schema: SCHEMA.into(),
        id: id.to_owned(),
        title: title.to_owned(),
        target: FrameTarget {
            width: frame.target.width,
            height: frame.target.height,
            format: frame.target.format.name().into(),
        },
        background: frame.background,
        clear_depth: frame.clear_depth,
        projection: frame.projection,
        ambient: frame.ambient,
        ambient_form: word::<model::AmbientForm>(frame.ambient_form),
        light_ambient: word::<model::LightAmbient>(frame.light_ambient),
        lights: frame.lights.iter().map(light).collect(),
        fog: frame.fog.as_ref().map(fog),
        meshes: frame.meshes.iter().map(mesh).collect(),
        textures: frame.textures.iter().map(texture).collect(),
        draws: frame.draws.iter().map(draw).collect(),
        effects: called(frame).into_iter().map(Word::from).collect(),
    }
}

/// The names of the effects that any draw calls for, in their order.
pub(super) fn called(frame: &Frame) -> Vec<&'static str> {
    let draws = effects(frame);
    let is_called = |effect: &Effect| draws.iter().any(|called| called.effects.has(*effect));
    Effect::ALL.into_iter().filter(is_called).map(Effect::name).collect()
}

/// The word of a scene file that stands for a resolved value.
fn word<W: Serialize>(resolved: impl Into<W>) -> Word {
    match serde_json::to_value(resolved.into()) {
        Ok(Value::String(word)) => word.into(),
        other => unreachable!("words are texts, not {other:?}"),
    }
}

fn mesh(mesh: &Mesh) -> FrameMesh {
    FrameMesh {
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        uvs: mesh.uvs.clone(),
        lightmap_uvs: mesh.lightmap_uvs.clone(),
        colors: mesh.colors.clone(),
        triangles: mesh.triangles.clone(),
    }
}

fn light(light: &Light) -> FrameLight {
    let place = match light.place {
        Place::Directional { toward, unit } => LightPlace::Directional { toward, unit },
        Place::Point { position, falloff } => LightPlace::Point { position, falloff },
        Place::Spot { position, falloff, axis, cutoff_cosine, exponent } => {
            LightPlace::Spot { position, falloff, axis, cutoff_cosine, exponent }
        }
    };
    FrameLight {
        name: light.name.clone(),
        ambient: light.ambient,
        diffuse: light.diffuse,
        specular: light.specular,
        place,
    }
}

fn fog(fog: &Fog) -> FrameFog {
    let form = match fog.form {
        FogForm::Linear { dmin, dmax } => FrameFogForm::Linear { dmin, dmax },
        FogForm::Exp { density } => FrameFogForm::Exp { density },
        FogForm::Exp2Document { density } => FrameFogForm::Exp2Document { density },
        FogForm::Exp2OpenGl { density } => FrameFogForm::Exp2OpenGl { density },
    };
    FrameFog { color: fog.color, form, distance: word::<model::FogDistance>(fog.distance) }
}

fn draw(draw: &Draw) -> FrameDraw {
    let blend = |blend: lightmeter_scene::frame::Blend| FrameBlend {
        color: words(blend.state.color),
        alpha: words(blend.state.alpha),
        constant: blend.constant,
    };
    FrameDraw {
        name: draw.name.clone(),
        mesh: draw.mesh,
        modelview: draw.modelview,
        material: material(draw.material),
        shading: draw.shading.map(shading),
        alpha: draw.alpha,
        vertex_colors: draw.vertex_colors,
        texture: draw.texture.map(textured),
        lightmap: draw.lightmap.map(sampled),
        cutout: draw.cutout,
        blend: draw.blend.map(blend),
        depth: draw.depth.map(|test| FrameDepth { compare: test.compare.name().into(), write: test.write }),
        cull: word::<model::Cull>(draw.cull),
    }
}

const fn material(material: Material) -> FrameMaterial {
    let Material { emissive, ambient, diffuse, specular, shininess } = material;
    FrameMaterial { emissive, ambient, diffuse, specular, shininess }
}

fn shading(shading: Shading) -> FrameShading {
    let frequency = match shading.frequency {
        Frequency::Flat => model::Frequency::Flat,
        Frequency::Gouraud => model::Frequency::Gouraud,
        Frequency::Phong => model::Frequency::Phong,
    };
    FrameShading {
        frequency: word::<model::Frequency>(frequency),
        provoking: word::<model::TakenFrom>(shading.provoking),
        specular: word::<model::Specular>(shading.specular),
        gate: word::<model::Gate>(shading.gate),
        viewer: word::<model::Viewer>(shading.viewer),
        normals: word::<model::NormalForm>(shading.normals),
    }
}

fn sampled(sampled: Sampled) -> FrameSampled {
    FrameSampled {
        texture: sampled.texture,
        filter: word::<model::ReadFilter>(sampled.filter),
        wrap: word::<model::ReadWrap>(sampled.wrap),
    }
}

fn textured(textured: Textured) -> FrameTextured {
    FrameTextured { sampled: sampled(textured.sampled), replaces: textured.replaces }
}

/// The names of a state's equation and factors.
pub(super) fn words(State { equation, src, dst }: State) -> BlendWords {
    BlendWords { equation: equation.name().into(), src: src.name().into(), dst: dst.name().into() }
}
