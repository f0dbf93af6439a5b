//! What happens at a vertex and at a fragment of a draw.
//!
//! Vertex: `p = modelview·position`, `clip = projection·p`, `n = ⟨N·normal⟩`. Lit colour:
//! `CE + CA + Σᵢ(CAᵢ + CDᵢ + CSᵢ)`, at the vertices or at the fragment. Then vertex colours, texture, lightmap, cutout and
//! fog, in this order. Everything that a draw names is computed, whether or not it could change a pixel, unless a set of
//! effects says what is called for.

use super::attributes::{Attributes, LIT};
use crate::algebra::{Mat3, Mat4, Rgb, Rgba, Vec2, Vec3, Vec4, Vector};
use crate::departure::{FresnelHighlight, half_lambert, smoothstep, turned_to};
use crate::lighting::{self, Material};
use crate::real::Real;
use crate::vector::{self, NormalMatrix};
use crate::{attenuation, color, fog, texture};
use lightmeter_scene::effects::{Called, Effect};
use lightmeter_scene::frame::{self, Departures, FogForm, Frame, Place, Sampled, Shading, Texture, TextureFilter};
use lightmeter_scene::shading::{Ambient, Frequency, LightAmbient, Normals, SpecularGate, Viewer};
use lightmeter_scene::stage::Intermediate;

/// A draw with its constants brought to an arithmetic.
#[derive(Clone, Debug)]
pub struct Shader<'a, R> {
    frame: &'a Frame,
    draw: &'a frame::Draw,
    only: Option<&'a Called>,
    /// What is handed from the vertices to the fragments.
    pub attributes: Attributes,
    modelview: Mat4<R>,
    projection: Mat4<R>,
    /// Where the draw is lit.
    normals: Option<NormalTransform<R>>,
    material: Material<R>,
    emissive: Rgb<R>,
    ambient: Rgb<R>,
    lights: Vec<Light<R>>,
    fog: Option<Rgb<R>>,
    /// Whether the parts of a lit colour are asked for.
    stages: bool,
    /// Whether some light has use for normals.
    has_normals: bool,
}

/// What brings normals to eye space.
#[derive(Clone, Copy, Debug)]
enum NormalTransform<R> {
    InverseTranspose(NormalMatrix<R>),
    Modelview(Mat3<R>),
}

/// A light with everything that does not vary over the surface.
#[derive(Clone, Debug)]
struct Light<R> {
    colors: lighting::Light<R>,
    shape: Shape<R>,
}

#[derive(Clone, Copy, Debug)]
enum Shape<R> {
    Directional { l: Vec3<R> },
    Point { position: Vec3<R>, falloff: [R; 3] },
    Spot { position: Vec3<R>, falloff: [R; 3], axis: Vec3<R>, cutoff: R, exponent: R },
}

impl<R: Real> Shape<R> {
    fn new(place: Place, departures: Departures) -> Self {
        let vec3 = |v: [f32; 3]| Vector(v.map(R::input));
        match place {
            Place::Directional { toward, unit: true } => Self::Directional { l: vec3(toward) },
            Place::Directional { toward, unit: false } => Self::Directional { l: vec3(toward).normalize() },
            Place::Point { position, falloff } => {
                Self::Point { position: vec3(position), falloff: falloff.map(R::input) }
            }
            Place::Spot { position, falloff, axis, cutoff_cosine, exponent } => Self::Spot {
                position: vec3(position),
                falloff: falloff.map(R::input),
                axis: if departures.axis_at_length { vec3(axis) } else { vec3(axis).normalize() },
                cutoff: R::input(cutoff_cosine),
                exponent: R::input(exponent),
            },
        }
    }
}

/// A fragment: its colour, and what it came from.
#[derive(Clone, Copy, Debug)]
pub struct Fragment<R> {
    /// Its position in eye space, where something asks for it.
    pub p: Vec3<R>,
    /// The unit normal, where the fragment has one.
    pub n: Vec3<R>,
    /// `CE + CA + Σᵢ(CAᵢ + CDᵢ)`.
    pub diffuse: Rgb<R>,
    /// `Σᵢ CSᵢ`.
    pub specular: Rgb<R>,
    /// The colour with vertex colours, texture and lightmap.
    pub surface: Rgba<R>,
    /// The same in the fog.
    pub color: Rgba<R>,
    /// 1 where the fragment is drawn, 0 where a cutout leaves it out.
    pub kept: R,
}

/// Terms that are summed up, kept from fragment to fragment.
#[derive(Clone, Debug)]
pub struct Scratch<R> {
    diffuse: Vec<Rgb<R>>,
    specular: Vec<Rgb<R>>,
}

impl<R> Default for Scratch<R> {
    fn default() -> Self {
        Self { diffuse: vec![], specular: vec![] }
    }
}

impl<R: Real> Fragment<R> {
    /// An intermediate result of a fragment at a depth, as an image shows it.
    pub fn at(&self, stage: Intermediate, depth: R) -> Rgba<R> {
        let (zero, one) = (R::literal(0.0), R::literal(1.0));
        match stage {
            Intermediate::Position => self.p.extend(one),
            Intermediate::Depth => Vector([depth, zero, zero, one]),
            Intermediate::Normal => self.n.extend(one),
            Intermediate::Diffuse => self.diffuse.extend(one),
            Intermediate::Specular => self.specular.extend(one),
            Intermediate::Surface => self.surface,
            Intermediate::Fog => self.color,
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Lit<R> {
    color: Rgb<R>,
    diffuse: Rgb<R>,
    specular: Rgb<R>,
}

impl<'a, R: Real> Shader<'a, R> {
    /// The shader of a draw: of all that it names, or of what is called for only. `stages` keeps what intermediate results
    /// ask for. What does not vary over the surface is worked out here, so that an arithmetic that asks for a profile needs one in force.
    #[must_use]
    pub fn new(frame: &'a Frame, draw: usize, only: Option<&'a Called>, stages: bool) -> Self {
        let draw = &frame.draws[draw];
        let rgb = |c: [f32; 3]| Vector(c.map(R::input));
        let m = &draw.material;
        let light = |light: &frame::Light| {
            let [ambient, diffuse, specular] = [light.ambient, light.diffuse, light.specular].map(rgb);
            Light {
                colors: lighting::Light { ambient, diffuse, specular },
                shape: Shape::new(light.place, frame.departures),
            }
        };
        let lights = match only {
            _ if draw.shading.is_none() => vec![],
            Some(called) => called.lights.iter().map(|&place| light(&frame.lights[place])).collect(),
            None => frame.lights.iter().map(light).collect(),
        };
        let modelview: Mat4<R> = matrix(&draw.modelview);
        let normals = draw.shading.map(|shading| match shading.normals {
            Normals::InverseTranspose => NormalTransform::InverseTranspose(NormalMatrix::new(&modelview.upper3())),
            Normals::Modelview => NormalTransform::Modelview(modelview.upper3()),
        });
        let [diffuse, specular] = [m.diffuse, m.specular].map(rgb);
        let has_normals = only.map_or(!frame.lights.is_empty(), |called| called.effects.has_normals());
        let fogged = only.is_none_or(|called| called.effects.has_fog());
        let fog = frame.fog.as_ref().filter(|_| fogged);
        Self {
            frame,
            draw,
            only,
            attributes: Attributes::of(draw, stages || fog.is_some(), stages && has_normals),
            modelview,
            projection: matrix(&frame.projection),
            normals,
            material: Material { ambient: rgb(m.ambient), diffuse, specular, shininess: R::input(m.shininess) },
            emissive: rgb(m.emissive),
            ambient: rgb(frame.ambient),
            lights,
            fog: fog.map(|fog| rgb(fog.color)),
            stages,
            has_normals,
        }
    }

    #[inline]
    fn has(&self, effect: Effect) -> bool {
        self.only.is_none_or(|called| called.effects.has(effect))
    }

    /// The clip coordinates of a vertex of the draw's mesh; its attributes are appended.
    pub fn vertex(&self, vertex: usize, scratch: &mut Scratch<R>, attributes: &mut Vec<R>) -> Vec4<R> {
        let eye = self.eye(vertex);
        self.vertex_attributes(vertex, eye, scratch, attributes);
        self.clip(eye)
    }

    /// A vertex of the draw's mesh in eye space.
    pub fn eye(&self, vertex: usize) -> Vec4<R> {
        let position: Vec3<R> = Vector(self.frame.meshes[self.draw.mesh].positions[vertex].map(R::input));
        self.modelview.transform(position.extend(R::literal(1.0)))
    }

    /// The clip coordinates of a place in eye space.
    pub fn clip(&self, eye: Vec4<R>) -> Vec4<R> {
        self.projection.transform(eye)
    }

    /// The attributes of a vertex of the draw's mesh, whose place in eye space is given, appended.
    pub fn vertex_attributes(&self, vertex: usize, eye: Vec4<R>, scratch: &mut Scratch<R>, attributes: &mut Vec<R>) {
        let p = eye.xyz();
        let (mesh, at) = (&self.frame.meshes[self.draw.mesh], &self.attributes);
        let n = self.normals.as_ref().filter(|_| at.n.is_some() || at.lit.is_some()).map(|transform| {
            let given = mesh.normals.get(vertex).copied().unwrap_or_default();
            self.normal(transform, Vector(given.map(R::input)))
        });
        let n = n.unwrap_or(Vector::splat(R::literal(0.0)));
        let start = attributes.len();
        if at.p.is_some() {
            attributes.extend(p.0);
        }
        if at.n.is_some() {
            attributes.extend(n.0);
        }
        if at.lit.is_some() {
            let mut lit = self.lit(p, n, scratch);
            if self.frame.departures.clamped_vertices {
                let limited = |c: Rgb<R>| c.map(|x| x.clamp(R::literal(0.0), R::literal(1.0)));
                lit = Lit { color: limited(lit.color), diffuse: limited(lit.diffuse), specular: limited(lit.specular) };
            }
            attributes.extend([lit.color, lit.diffuse, lit.specular].into_iter().flat_map(|c| c.0));
        }
        if at.uv.is_some() {
            attributes.extend(mesh.uvs[vertex].map(R::input));
        }
        if at.lightmap_uv.is_some() {
            attributes.extend(mesh.lightmap_uvs[vertex].map(R::input));
        }
        if at.color.is_some() {
            attributes.extend(mesh.colors[vertex].map(R::input));
        }
        debug_assert_eq!(attributes.len() - start, at.count);
    }

    fn normal(&self, transform: &NormalTransform<R>, given: Vec3<R>) -> Vec3<R> {
        let n = match transform {
            NormalTransform::InverseTranspose(matrix) => matrix.transform(given),
            NormalTransform::Modelview(matrix) => vector::normal_modelview(matrix, given),
        };
        if self.frame.departures.normals_at_length { n } else { n.normalize() }
    }

    /// `CE + CA + Σᵢ(CAᵢ + CDᵢ + CSᵢ)` at a point with a unit normal.
    #[inline]
    fn lit(&self, p: Vec3<R>, n: Vec3<R>, scratch: &mut Scratch<R>) -> Lit<R> {
        let Scratch { diffuse, specular } = scratch;
        diffuse.clear();
        specular.clear();
        if self.has(Effect::Emissive) {
            diffuse.push(self.emissive);
        }
        match self.frame.ambient_form {
            Ambient::Product if self.has(Effect::AmbientProduct) => {
                diffuse.push(lighting::ambient(self.ambient, self.material.ambient));
            }
            Ambient::Constant if self.has(Effect::AmbientConstant) => diffuse.push(self.ambient),
            _ => {}
        }
        if let Some(shading) = self.draw.shading
            && !self.lights.is_empty()
        {
            let v = match shading.viewer {
                Viewer::Local if self.has(Effect::LocalViewer) => (-p).normalize(),
                _ => Vector([0.0, 0.0, 1.0].map(R::literal)),
            };
            let n = if self.frame.departures.two_sided { turned_to(-p, n) } else { n };
            for light in &self.lights {
                self.add_light(shading, light, [p, n, v], diffuse, specular);
            }
        }
        let none = Vector::splat(R::literal(0.0));
        let of = |terms: &[Rgb<R>]| Vector(std::array::from_fn(|k| R::sum_over(terms.iter().map(|term| term[k]))));
        let (without, highlights) = if self.stages || self.frame.departures.highlight_over_texture {
            (of(diffuse), of(specular))
        } else {
            (none, none)
        };
        diffuse.append(specular);
        let color = of(diffuse);
        let color = if self.frame.departures.lit_at_least_0 { color.map(|x| x.max(R::literal(0.0))) } else { color };
        Lit { color, diffuse: without, specular: highlights }
    }

    #[inline]
    fn add_light(
        &self,
        shading: Shading,
        light: &Light<R>,
        [p, n, v]: [Vec3<R>; 3],
        diffuse: &mut Vec<Rgb<R>>,
        specular: &mut Vec<Rgb<R>>,
    ) {
        let one = R::literal(1.0);
        let (colors, material) = (&light.colors, &self.material);
        let (l, cone) = match light.shape {
            Shape::Directional { l } => (l, one),
            Shape::Point { position, .. } => (vector::toward(position, p), one),
            Shape::Spot { position, axis, cutoff, exponent, .. } => {
                let l = vector::toward(position, p);
                let cone = if self.has(Effect::SpotExponent) {
                    attenuation::spot_exponent(l, axis, cutoff, exponent)
                } else {
                    attenuation::spot_cutoff(l, axis, cutoff)
                };
                (l, cone)
            }
        };
        let atten = match light.shape {
            Shape::Point { position, falloff: [kc, kl, kq] } | Shape::Spot { position, falloff: [kc, kl, kq], .. }
                if self.has(Effect::Attenuation) =>
            {
                attenuation::point(kc, kl, kq, position, p)
            }
            _ => one,
        };
        if self.has(Effect::LightAmbient) {
            let ambient = lighting::ambient(colors.ambient, material.ambient);
            let weakened = self.frame.light_ambient == LightAmbient::OpenGl && self.has(Effect::AttenuatedAmbient);
            diffuse.push(if weakened { ambient.map(|c| R::product([c, cone, atten])) } else { ambient });
        }
        let is_dark = cone.is_at_most(0.0);
        let fi = lighting::incidence(l, n);
        let is_turned_away = fi.is_at_most(0.0);
        if self.frame.departures.half_lambert {
            let lit = half_lambert(l.dot(n));
            let factors = |light: R, material: R| R::product([light, material, lit, cone, atten]);
            diffuse.push(zip(colors.diffuse, material.diffuse, factors));
        } else if self.has(Effect::Diffuse) && !is_dark && !is_turned_away {
            let factors = |light: R, material: R| R::product([light, material, fi, cone, atten]);
            diffuse.push(zip(colors.diffuse, material.diffuse, factors));
        }
        let gated = shading.gate == SpecularGate::OpenGl;
        if self.has_specular() && !is_dark && !(gated && is_turned_away) {
            if self.frame.departures.fresnel_highlight {
                let fresnel = FresnelHighlight::new(n, l, v, fi, material.shininess);
                let factors = |light: R, material: R| {
                    R::product([light, fresnel.tinted(material), fresnel.density, fresnel.incidence, cone, atten])
                };
                specular.push(zip(colors.specular, material.specular, factors));
                return;
            }
            let fs = || lighting::highlight(shading.specular, n, l, v, material.shininess);
            let fs = match shading.gate {
                SpecularGate::OpenGl => R::if_ge(R::literal(0.0), l.dot(n), || R::literal(0.0), fs),
                SpecularGate::Documents => fs(),
            };
            let factors = |light: R, material: R| R::product([light, material, fs, cone, atten]);
            specular.push(zip(colors.specular, material.specular, factors));
        }
    }

    fn has_specular(&self) -> bool {
        self.only.is_none_or(|called| called.effects.has_specular())
    }

    /// A fragment, from its interpolated attributes.
    pub fn fragment(&self, attributes: &[R], scratch: &mut Scratch<R>) -> Fragment<R> {
        let (zero, one, at) = (R::literal(0.0), R::literal(1.0), &self.attributes);
        let three = |start: usize| Vector([attributes[start], attributes[start + 1], attributes[start + 2]]);
        let p = at.p.map_or(Vector::splat(zero), three);
        let f = self.fog.zip(self.frame.fog.as_ref()).map(|(color, fog)| (color, self.factor(fog, p)));
        // Where nothing but fog is seen, what is under it need not be lit.
        let is_hidden = !self.stages && f.is_some_and(|(_, f)| f.is_at_most(0.0));
        let (mut n, dark) = (Vector::splat(zero), Vector::splat(zero));
        let lit = match (self.draw.shading.map(|shading| shading.frequency), at.lit) {
            (None, _) => Lit { color: self.material.diffuse, diffuse: self.material.diffuse, specular: dark },
            (Some(Frequency::Phong), _) => {
                let given = at.n.map_or(n, three);
                let at_length = self.frame.departures.fragment_normals_at_length;
                let of_point = if at_length { given } else { given.normalize() };
                n = if self.has_normals { of_point } else { n };
                if is_hidden {
                    Lit { color: dark, diffuse: dark, specular: dark }
                } else {
                    self.lit(p, of_point, scratch)
                }
            }
            (Some(_), start) => {
                n = at.n.map_or(n, three);
                let start = start.unwrap_or_default();
                debug_assert!(start + LIT <= attributes.len());
                Lit { color: three(start), diffuse: three(start + 3), specular: three(start + 6) }
            }
        };
        let highlight = lit.specular;
        let is_over = self.frame.departures.highlight_over_texture;
        let under = if is_over { lit.diffuse } else { lit.color };
        let mut surface = self.surface(under.extend(R::input(self.draw.alpha)), attributes);
        if is_over {
            surface = (surface.xyz() + highlight).extend(surface.w());
        }
        let kept = match self.draw.cutout.filter(|_| self.has(Effect::Cutout)) {
            Some(threshold) => {
                let (kept, cut) = if self.frame.departures.cutout_turned { (zero, one) } else { (one, zero) };
                R::if_ge(surface.w(), R::input(threshold), || kept, || cut)
            }
            None => one,
        };
        let color = match f {
            Some((fog, f)) => {
                let alpha = if self.frame.departures.fogged_alpha {
                    R::literal(1.0) - (R::literal(1.0) - surface.w()) * f
                } else {
                    surface.w()
                };
                fog::apply(fog, surface.xyz(), f).extend(alpha)
            }
            None => surface,
        };
        Fragment { p, n, diffuse: lit.diffuse, specular: lit.specular, surface, color, kept }
    }

    fn factor(&self, fog: &frame::Fog, p: Vec3<R>) -> R {
        let distance = fog::distance(p, fog.distance);
        match fog.form {
            FogForm::Linear { dmin, dmax } => {
                let f = fog::linear(distance, R::input(dmin), R::input(dmax));
                let is_smooth = self.frame.departures.smoothstep_fog;
                if is_smooth { smoothstep(R::literal(0.0), R::literal(1.0), f) } else { f }
            }
            FogForm::Exp { density } => fog::exp(distance, R::input(density)),
            FogForm::Exp2Document { density } => fog::exp2_document(distance, R::input(density)),
            FogForm::Exp2OpenGl { density } => fog::exp2_opengl(distance, R::input(density)),
        }
    }

    /// Vertex colours, texture and lightmap.
    fn surface(&self, mut surface: Rgba<R>, attributes: &[R]) -> Rgba<R> {
        let at = &self.attributes;
        let uv = |start: usize, sampled: Sampled| {
            let given = Vector([attributes[start], attributes[start + 1]]);
            self.moved(given, &self.frame.textures[sampled.texture], sampled.filter)
        };
        if let Some(start) = at.color.filter(|_| self.has(Effect::VertexColor)) {
            surface = color::modulate(Vector(std::array::from_fn(|k| attributes[start + k])), surface);
        }
        if let (Some(textured), Some(start)) = (self.draw.texture, at.uv)
            && self.only.is_none_or(|called| called.effects.has_texture())
        {
            let sampled = textured.sampled;
            let texture = &self.frame.textures[sampled.texture];
            let texel = texture::sample(texture, sampled.filter, sampled.wrap, uv(start, sampled));
            let apply = if textured.replaces { color::replace } else { color::modulate };
            surface = apply(texel, surface);
        }
        if let (Some(sampled), Some(start)) = (self.draw.lightmap, at.lightmap_uv)
            && self.only.is_none_or(|called| called.effects.has_lightmap())
        {
            let lightmap = &self.frame.textures[sampled.texture];
            surface =
                color::modulate(texture::sample(lightmap, sampled.filter, sampled.wrap, uv(start, sampled)), surface);
        }
        surface
    }

    /// Texture coordinates as they are, or as a mistake takes them.
    fn moved(&self, uv: Vec2<R>, texture: &Texture, filter: TextureFilter) -> Vec2<R> {
        let (departures, zero) = (self.frame.departures, R::literal(0.0));
        if departures.texture_magnitudes {
            return uv.map(R::abs);
        }
        if departures.truncated_texels && filter == TextureFilter::Nearest {
            let size = [texture.width, texture.height].map(|texels| R::literal(1.0 / f64::from(texels)));
            return Vector(std::array::from_fn(|k| R::if_ge(uv[k], zero, || uv[k], || uv[k] + size[k])));
        }
        uv
    }
}

fn matrix<R: Real>(columns: &frame::Matrix) -> Mat4<R> {
    Mat4(columns.map(|column| Vector(column.map(R::input))))
}

fn zip<R: Real>(a: Rgb<R>, b: Rgb<R>, f: impl Fn(R, R) -> R) -> Rgb<R> {
    Vector(std::array::from_fn(|k| f(a[k], b[k])))
}
