//! Classical lighting: `CF = CA + CD + CS` (000 §6.3–6.4, 003, 004). Symbols as in the crate's conventions.
//!
//! `CA` ambient, `CD` diffuse, `CS` specular, `CE` emissive; `L?` a light's colour and `M?` the material's colour for one
//! of the terms; `shininess` the exponent of the highlight, ≥ 0; `atten` a light's attenuation. Unit vectors are taken
//! as such unless a function says that it normalises.

use crate::algebra::{Rgb, Rgba, Vec3, Vector};
use crate::attenuation;
use crate::real::Real;
use crate::step::step;
use crate::vector::{at_vertex, face_normal, halfway, halfway_unnormalised, power, reflect, toward};
pub use crate::vector::{cosine_power, cosine_power_by_chord};
pub use lightmeter_scene::shading::{Specular, SpecularGate};

/// The colours of a light.
#[derive(Clone, Copy, Debug)]
pub struct Light<R> {
    /// LA.
    pub ambient: Rgb<R>,
    /// LD.
    pub diffuse: Rgb<R>,
    /// LS.
    pub specular: Rgb<R>,
}

/// What a surface does with light.
#[derive(Clone, Copy, Debug)]
pub struct Material<R> {
    /// MA.
    pub ambient: Rgb<R>,
    /// MD.
    pub diffuse: Rgb<R>,
    /// MS.
    pub specular: Rgb<R>,
    /// The exponent of the highlight, ≥ 0.
    pub shininess: R,
}

/// kc, kl and kq of `atten = 1 / (kc + kl·d + kq·d²)`.
#[derive(Clone, Copy, Debug)]
pub struct Falloff<R> {
    /// Constant, 1.
    pub kc: R,
    /// Linear, 1/unit.
    pub kl: R,
    /// Quadratic, 1/unit².
    pub kq: R,
}

/// The terms of one light at one point.
#[derive(Clone, Copy, Debug)]
pub struct Terms<R> {
    /// CA.
    pub ambient: Rgb<R>,
    /// CD.
    pub diffuse: Rgb<R>,
    /// CS.
    pub specular: Rgb<R>,
}

impl<R: Real> Terms<R> {
    /// `CF = CA + CD + CS`. Source: 000 §6.3.
    #[must_use]
    pub fn sum(self) -> Rgb<R> {
        let Self { ambient, diffuse, specular } = self;
        step!("CF", |ambient, diffuse, specular| Vector::sum([ambient, diffuse, specular]))
    }
}

/// `CA = LA * MA`. Source: 000 §6.3.
pub fn ambient<R: Real>(light: Rgb<R>, material: Rgb<R>) -> Rgb<R> {
    step!("CA", |light, material| light * material)
}

/// `CA + CD` with CA a global constant that no light multiplies. Source: 004; ruling 8.
pub fn ambient_constant<R: Real>(ambient: Rgb<R>, diffuse: Rgb<R>) -> Rgb<R> {
    step!("CF", |ambient, diffuse| ambient + diffuse)
}

/// `FI = max(l·n, 0)`. Source: 000 §6.3 with the shader's `max`; ruling 16.
pub fn incidence<R: Real>(l: Vec3<R>, n: Vec3<R>) -> R {
    lit_side(cosine(l, n))
}

fn cosine<R: Real>(l: Vec3<R>, n: Vec3<R>) -> R {
    step!("l·n", |l, n| l.dot(n))
}

fn lit_side<R: Real>(cosine: R) -> R {
    step!("FI", |cosine| cosine.max(R::literal(0.0)))
}

/// `CD = LD * MD * FI`, from the vector towards the light. Source: 004.
pub fn diffuse_toward<R: Real>(light: Rgb<R>, material: Rgb<R>, l: Vec3<R>, n: Vec3<R>) -> Rgb<R> {
    diffuse_of(light, material, incidence(l, n))
}

#[inline]
fn diffuse_of<R: Real, const N: usize>(light: Vector<R, N>, material: Vector<R, N>, incidence: R) -> Vector<R, N> {
    step!("CD", |light, material, incidence| Vector::product([light, material, Vector::splat(incidence)]))
}

/// `CD = LD * MD * max((−i)·n, 0)`, from the direction in which light travels. Source: 000 §6.3.
pub fn diffuse_travel<R: Real>(light: Rgb<R>, material: Rgb<R>, i: Vec3<R>, n: Vec3<R>) -> Rgb<R> {
    diffuse_toward(light, material, -i, n)
}

/// `FS` of a unit normal, a unit vector to the light and one to the eye.
///
/// Phong: `max(r·v, 0)^S`; Blinn: `max(n·h, 0)^S`. Source: 000 §6.3, 004.
pub fn highlight<R: Real>(model: Specular, n: Vec3<R>, l: Vec3<R>, v: Vec3<R>, shininess: R) -> R {
    let cosine = match model {
        Specular::Phong => step!("r·v", |n, l, v| reflect(-l, n).dot(v)),
        Specular::Blinn => step!("n·h", |n, l, v| n.dot(halfway(v, l))),
        Specular::BlinnUnnormalised => step!("n·(v + l)", |n, l, v| n.dot(halfway_unnormalised(v, l))),
    };
    power(cosine, shininess).or_dark([n.0, l.0, v.0])
}

/// `CS = LS * MS * FS` with Phong's `FS = max(r·v, 0)^S`. Source: 000 §6.3.
pub fn specular_phong<R: Real>(light: Rgb<R>, material: Rgb<R>, r: Vec3<R>, v: Vec3<R>, shininess: R) -> Rgb<R> {
    specular(light, material, power(step!("r·v", |r, v| r.dot(v)), shininess))
}

/// `CS = LS * MS * FS` with Blinn's `FS = max(n·h, 0)^S`. Source: 000 §6.4, 004.
pub fn specular_blinn<R: Real>(light: Rgb<R>, material: Rgb<R>, n: Vec3<R>, h: Vec3<R>, shininess: R) -> Rgb<R> {
    specular(light, material, power(step!("n·h", |n, h| n.dot(h)), shininess))
}

/// `CS = LS * MS * max(r.z, 0)^S`: the viewer at infinity, v = (0, 0, 1). Source: 000 §6.4.
pub fn specular_nonlocal<R: Real>(light: Rgb<R>, material: Rgb<R>, r: Vec3<R>, shininess: R) -> Rgb<R> {
    specular(light, material, power(step!("r.z", |r| r.z()), shininess))
}

#[inline]
fn specular_of<R: Real, const N: usize>(
    light: Vector<R, N>,
    material: Vector<R, N>,
    fs: R,
    [n, l, v]: [Vec3<R>; 3],
    shininess: R,
) -> Vector<R, N> {
    step!("CS", |light, material, fs, n, l, v, shininess| Vector::product([light, material, Vector::splat(fs)]))
}

fn specular<R: Real>(light: Rgb<R>, material: Rgb<R>, fs: R) -> Rgb<R> {
    step!("CS", |light, material, fs| Vector::product([light, material, Vector::splat(fs)]))
}

/// CA, CD and CS of one light for unit n, l and v; `atten` multiplies diffuse and specular.
pub fn terms<R: Real>(
    dialect: (Specular, SpecularGate),
    light: &Light<R>,
    material: &Material<R>,
    vectors: [Vec3<R>; 3],
    atten: R,
) -> Terms<R> {
    weighted_terms(dialect, light, material, vectors, Weight { cone: None, atten, of_ambient: false })
}

/// What a positional light's terms are multiplied by.
#[derive(Clone, Copy, Debug)]
struct Weight<R> {
    /// What a spotlight's cone leaves of it.
    cone: Option<R>,
    atten: R,
    /// Whether the ambient term is attenuated too.
    of_ambient: bool,
}

fn weighted_terms<R: Real>(
    (model, gate): (Specular, SpecularGate),
    light: &Light<R>,
    material: &Material<R>,
    [n, l, v]: [Vec3<R>; 3],
    weight: Weight<R>,
) -> Terms<R> {
    let [n, l, v] = surface([n, l, v]);
    let (shininess, atten, cone) = (material.shininess, weight.atten, weight.cone.unwrap_or_else(|| R::literal(1.0)));
    let by = |cone: R, atten: R| Vector::splat(if weight.cone.is_some() { R::product([cone, atten]) } else { atten });
    let cosine = cosine(l, n);
    let incidence = lit_side(cosine);
    let fs = gated(gate, cosine, || highlight(model, n, l, v, shininess));
    let ambient = {
        let (light, material) = (light.ambient, material.ambient);
        step!("CA", |light, material, cone, atten| {
            if weight.of_ambient { Vector::product([light, material, Vector::splat(atten)]) } else { light * material }
        })
    };
    let diffuse = {
        let (light, material) = (light.diffuse, material.diffuse);
        step!("CD", |light, material, incidence, cone, atten| {
            Vector::product([light, material, Vector::splat(incidence), by(cone, atten)])
        })
    };
    let (light, material) = (light.specular, material.specular);
    let specular = step!("CS", |light, material, fs, cone, atten, n, l, v, shininess| {
        Vector::product([light, material, Vector::splat(fs), by(cone, atten)])
    });
    Terms { ambient, diffuse, specular }
}

/// The highlight of a surface that light falls on by this cosine: it may have none where it faces away.
#[inline]
fn gated<R: Real>(gate: SpecularGate, cosine: R, fs: impl Fn() -> R) -> R {
    let zero = R::literal(0.0);
    match gate {
        SpecularGate::Documents => step!(quiet "FS of either side", |cosine| fs()),
        SpecularGate::OpenGl => step!("FS of the lit side", |cosine| R::if_ge(zero, cosine, || zero, &fs)),
    }
}

fn to_eye<R: Real>(p: Vec3<R>) -> Vec3<R> {
    let to_eye = step!(quiet "−p", |p| -p);
    step!("v", |to_eye| to_eye.normalize())
}

/// The vectors that a surface is lit by, as they are used.
#[inline]
fn surface<R: Real>([n, l, v]: [Vec3<R>; 3]) -> [Vec3<R>; 3] {
    step!(quiet "n, l and v", |n, l, v| [n, l, v])
}

fn normal<R: Real>(n: Vec3<R>) -> Vec3<R> {
    step!("n", |n| n.normalize())
}

/// A directional light, local viewer, everything normalised at the point. Source: 000 §6.3, its fragment shader.
///
/// `p` and the normal `n` as interpolated, `direction` the way light travels; none need be of unit length.
pub fn directional<R: Real>(
    dialect: (Specular, SpecularGate),
    light: &Light<R>,
    material: &Material<R>,
    [p, n, direction]: [Vec3<R>; 3],
) -> Rgba<R> {
    let to_light = -direction;
    let l = step!("l", |to_light| to_light.normalize());
    let terms = terms(dialect, light, material, [normal(n), l, to_eye(p)], R::literal(1.0));
    terms.sum().extend(R::literal(1.0))
}

/// The same with the light's direction taken as a unit vector and not normalised. Source: 000 §6.4.
pub fn unit_light<R: Real>(light: &Light<R>, material: &Material<R>, [p, n, direction]: [Vec3<R>; 3]) -> Rgba<R> {
    let vectors = [normal(n), step!("l", |direction| -direction), to_eye(p)];
    terms((Specular::Phong, SpecularGate::Documents), light, material, vectors, R::literal(1.0))
        .sum()
        .extend(R::literal(1.0))
}

/// The viewer at infinity, v = (0, 0, 1), and a unit light: 000 §6.4's faster program.
pub fn nonlocal<R: Real>(light: &Light<R>, material: &Material<R>, n: Vec3<R>, direction: Vec3<R>) -> Rgba<R> {
    let (n, l) = (normal(n), step!("l", |direction| -direction));
    let v = Vector([0.0, 0.0, 1.0].map(R::literal));
    let cosine = cosine(l, n);
    let incidence = lit_side(cosine);
    let highlight = || power(step!("r·v", |n, l, v| reflect(-l, n).z()), material.shininess).or_dark([n.0, l.0, v.0]);
    let fs = gated(SpecularGate::Documents, cosine, highlight);
    let (ambient, shininess) = (ambient(light.ambient, material.ambient), material.shininess);
    let diffuse = diffuse_of(light.diffuse, material.diffuse, incidence);
    Terms { ambient, diffuse, specular: specular_of(light.specular, material.specular, fs, [n, l, v], shininess) }
        .sum()
        .extend(R::literal(1.0))
}

/// A point light with attenuation on its diffuse and specular terms. Source: 000 §6.4, 004; rulings 2 and 11.
pub fn point<R: Real>(
    dialect: (Specular, SpecularGate),
    light: &Light<R>,
    material: &Material<R>,
    [p, n, position]: [Vec3<R>; 3],
    falloff: &Falloff<R>,
) -> Rgba<R> {
    let atten = attenuation::point(falloff.kc, falloff.kl, falloff.kq, position, p);
    let vectors = [normal(n), toward(position, p), to_eye(p)];
    terms(dialect, light, material, vectors, atten).sum().extend(R::literal(1.0))
}

/// A point light as OpenGL's fixed function has it: `atten·(CA + CD + CS)`, no highlight where n·l ≤ 0, and the alpha of
/// the diffuse material. Dialects of rulings 9, 11 and 14.
pub fn point_opengl<R: Real>(
    light: &Light<R>,
    material: &Material<R>,
    [p, n, position]: [Vec3<R>; 3],
    falloff: &Falloff<R>,
    alpha: R,
) -> Rgba<R> {
    let atten = attenuation::point(falloff.kc, falloff.kl, falloff.kq, position, p);
    let vectors = [normal(n), toward(position, p), to_eye(p)];
    let weight = Weight { cone: None, atten, of_ambient: true };
    weighted_terms((Specular::Blinn, SpecularGate::OpenGl), light, material, vectors, weight).sum().extend(alpha)
}

/// A spotlight: a point light within a cone about `axis`, its brightness falling as `max(−l·axis, 0)^exponent`.
///
/// `axis` need not be of unit length; the cutoff is given by its cosine. Source: 000 §6.4; the exponent is OpenGL's.
pub fn spot<R: Real>(
    light: &Light<R>,
    material: &Material<R>,
    [p, n, position, axis]: [Vec3<R>; 4],
    falloff: &Falloff<R>,
    [cutoff_cosine, exponent]: [R; 2],
) -> Rgba<R> {
    let l = toward(position, p);
    let axis = step!("axis", |axis| axis.normalize());
    let cone = Some(attenuation::spot_exponent(l, axis, cutoff_cosine, exponent).or_dark([axis.0; 3]));
    let atten = attenuation::point(falloff.kc, falloff.kl, falloff.kq, position, p);
    let vectors = [normal(n), l, to_eye(p)];
    let dialect = (Specular::Phong, SpecularGate::Documents);
    let weight = Weight { cone, atten, of_ambient: false };
    weighted_terms(dialect, light, material, vectors, weight).sum().extend(R::literal(1.0))
}

/// Scalar ka, kd, ks on a light's colour and an ambient colour; a point light without attenuation. Source: 003.
pub fn scalar_material<R: Real>(
    [ambient_color, light_color]: [Rgb<R>; 2],
    [ka, kd, ks, shininess]: [R; 4],
    [p, n, position]: [Vec3<R>; 3],
) -> Rgba<R> {
    let light = Light { ambient: ambient_color, diffuse: light_color, specular: light_color };
    let [ambient, diffuse, specular] = [ka, kd, ks].map(Vector::splat);
    let material = Material { ambient, diffuse, specular, shininess };
    let vectors = [normal(n), toward(position, p), to_eye(p)];
    terms((Specular::Phong, SpecularGate::Documents), &light, &material, vectors, R::literal(1.0))
        .sum()
        .extend(R::literal(1.0))
}

/// One light of document 004: `diffuse·color·max(n·l, 0) + specular·color·max(n·h, 0)^S`, in RGBA. Source: 004.
pub fn compute_light<R: Real>(
    color: Rgba<R>,
    [diffuse, specular]: [Rgba<R>; 2],
    shininess: R,
    [n, l, v]: [Vec3<R>; 3],
) -> [Rgba<R>; 2] {
    let [n, l, v] = surface([n, l, v]);
    let cosine = cosine(l, n);
    let incidence = lit_side(cosine);
    let fs = gated(SpecularGate::Documents, cosine, || highlight(Specular::Blinn, n, l, v, shininess));
    [diffuse_of(color, diffuse, incidence), specular_of(color, specular, fs, [n, l, v], shininess)]
}

/// `ambient + Σ(CD + CS)` of a directional light 0 and a point light 1, Blinn's highlight, no attenuation, RGBA summed, so
/// that alpha may exceed 1. `direction` points to light 0. Source: 004; rulings 13 and 14.
pub fn two_lights<R: Real>(
    ambient: Rgba<R>,
    colors: [Rgba<R>; 2],
    material: [Rgba<R>; 2],
    shininess: R,
    [p, n, direction, position]: [Vec3<R>; 4],
) -> Rgba<R> {
    let (n, v) = (normal(n), to_eye(p));
    let to_light = direction;
    let l = step!("l", |to_light| to_light.normalize());
    let [d0, s0] = compute_light(colors[0], material, shininess, [n, l, v]);
    let [d1, s1] = compute_light(colors[1], material, shininess, [n, toward(position, p), v]);
    step!("CF", |ambient, d0, s0, d1, s1| Vector::sum([ambient, d0, s0, d1, s1]))
}

/// `CE + CA + Σᵢ(CDᵢ + CSᵢ)` of two lights. Source: 004.
pub fn sum<R: Real>(emissive: Rgb<R>, ambient: Rgb<R>, diffuse: [Rgb<R>; 2], specular: [Rgb<R>; 2]) -> Rgb<R> {
    Vector::sum([emissive, ambient, diffuse[0], specular[0], diffuse[1], specular[1]])
}

/// Plastic: the highlight has the light's colour, `CS = LS·ks·FS`. Source: 004.
pub fn highlight_plastic<R: Real>(light: Rgb<R>, _surface: Rgb<R>, ks: R, fs: R) -> Rgb<R> {
    light.map(|x| R::product([x, ks, fs]))
}

/// Metal: the highlight has the surface's colour too, `CS = LS * MD·ks·FS`. Source: 004.
pub fn highlight_metal<R: Real>(light: Rgb<R>, surface: Rgb<R>, ks: R, fs: R) -> Rgb<R> {
    Vector::product([light, surface, Vector::splat(ks), Vector::splat(fs)])
}

/// What is known at a vertex: its position and its normal.
#[derive(Clone, Copy, Debug)]
pub struct Vertex<R> {
    /// Position in eye space.
    pub p: Vec3<R>,
    /// Normal, of any length.
    pub n: Vec3<R>,
}

/// Scalar material and light for the shading-frequency formulas: kd, ks, shininess under one white point light.
fn intensity<R: Real>([n, l, v]: [Vec3<R>; 3], [kd, ks, shininess]: [R; 3]) -> R {
    let [n, l, v] = surface([n, l, v]);
    let cosine = cosine(l, n);
    let incidence = lit_side(cosine);
    let fs = gated(SpecularGate::Documents, cosine, || highlight(Specular::Phong, n, l, v, shininess));
    step!("I", |kd, ks, incidence, fs, n, l, v, shininess| kd * incidence + ks * fs)
}

/// Gouraud shading between two vertices: lit at both, `(1 − t)·I(a) + t·I(b)`. Source: 000 §6.3, 004.
pub fn gouraud<R: Real>(a: Vertex<R>, b: Vertex<R>, t: R, position: Vec3<R>, material: [R; 3]) -> R {
    let lit = |vertex: Vertex<R>| {
        let vectors = [normal(vertex.n), toward(position, vertex.p), to_eye(vertex.p)];
        intensity(vectors, material)
    };
    let (a, b) = (lit(a), lit(b));
    step!("I between the vertices", |a, b, t| R::mix(a, b, t))
}

/// Phong shading between two vertices: position and normal interpolated, the normal normalised again, then lit.
/// Source: 000 §6.3, 004.
pub fn phong<R: Real>(a: Vertex<R>, b: Vertex<R>, t: R, position: Vec3<R>, material: [R; 3]) -> R {
    let p = a.p.mix(b.p, t).named("p");
    let n = normal(at_vertex(a.n).mix(at_vertex(b.n), t));
    intensity([n, toward(position, p), to_eye(p)], material)
}

/// Phong shading as document 003 has it: n, l and v all computed at the vertices, interpolated, and normalised at the
/// point. Source: 003.
pub fn phong_interpolated<R: Real>(a: Vertex<R>, b: Vertex<R>, t: R, position: Vec3<R>, material: [R; 3]) -> R {
    let to_light = |p: Vec3<R>| {
        let l = step!(quiet "light − p", |position, p| position - p);
        step!(quiet "l at a vertex", |l| l)
    };
    let to_eye = |p: Vec3<R>| {
        let v = -p;
        step!(quiet "v at a vertex", |v| v)
    };
    let (to_light_from_a, to_light_from_b, to_eye) = (to_light(a.p), to_light(b.p), to_eye(a.p).mix(to_eye(b.p), t));
    let to_light = Vector(std::array::from_fn(|k| {
        R::mix_of_differences([to_light_from_a[k], to_light_from_b[k]], position[k], [a.p[k], b.p[k]], t)
    }));
    let (l, v) = (step!("l", |to_light| to_light.normalize()), step!("v", |to_eye| to_eye.normalize()));
    let n = normal(at_vertex(a.n).mix(at_vertex(b.n), t));
    intensity([n, l, v], material)
}

/// Flat shading: one normal for the face, lit at its first vertex. Source: 004.
pub fn flat<R: Real>(face: [Vec3<R>; 3], position: Vec3<R>, material: [R; 3]) -> R {
    let [a, b, c] = face;
    let lit = step!(quiet "where it is lit", |a, b, c| a);
    intensity([face_normal(a, b, c), toward(position, lit), to_eye(lit)], material)
}

/// `t/(S − S·t + t)` for `t = max(a·b, 0)`: an approximation of `t^S` without a power, of its value and slope at 1 and of its
/// value at 0. Source: Schlick 1994.
pub fn cosine_power_by_schlick<R: Real>(a: Vec3<R>, b: Vec3<R>, exponent: R) -> R {
    schlick(a.dot(b), exponent)
}

/// Schlick's approximation of `max(cosine, 0)^exponent`.
pub fn schlick<R: Real>(cosine: R, exponent: R) -> R {
    let t = cosine.max(R::literal(0.0)).named("t");
    t / R::sum([exponent, -(exponent * t), t])
}

/// [`cosine_power`] without the `max`: no value where the cosine is negative.
pub fn cosine_power_unguarded<R: Real>(a: Vec3<R>, b: Vec3<R>, exponent: R) -> R {
    let cosine = step!("a·b", |a, b| a.dot(b));
    step!("FS", |cosine, exponent| cosine.pow(exponent))
}

/// A directional light with Blinn's highlight, stable throughout: every vector normalised at any length, no highlight where
/// n·l ≤ 0, and its power by the chord. With OpenGL's gate it is [`directional`]'s Blinn.
pub fn blinn_stable<R: Real>(light: &Light<R>, material: &Material<R>, [p, n, direction]: [Vec3<R>; 3]) -> Rgba<R> {
    let to_light = -direction;
    let (n, l) = (step!("n", |n| n.normalize_scaled()), step!("l", |to_light| to_light.normalize_scaled()));
    let to_eye = step!(quiet "−p", |p| -p);
    let v = step!("v", |to_eye| to_eye.normalize_scaled());
    let sum = halfway_unnormalised(v, l);
    let (h, cosine) = (step!("h", |sum| sum.normalize_scaled()), cosine(l, n));
    let exponent = material.shininess;
    let power = || step!("(n·h)^S", |n, l, v, h, exponent| cosine_power_by_chord(n, h, exponent));
    let (fs, incidence) = (gated(SpecularGate::OpenGl, cosine, power), lit_side(cosine));
    let (ambient, diffuse) =
        (ambient(light.ambient, material.ambient), diffuse_of(light.diffuse, material.diffuse, incidence));
    let specular = specular_of(light.specular, material.specular, fs, [n, l, v], exponent);
    Terms { ambient, diffuse, specular }.sum().extend(R::literal(1.0))
}
