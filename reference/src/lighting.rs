//! Classical lighting: `CF = CA + CD + CS` (000 §6.3–6.4, 003, 004). Symbols as in the crate's conventions.
//!
//! `CA` ambient, `CD` diffuse, `CS` specular, `CE` emissive; `L?` a light's colour and `M?` the material's colour for one
//! of the terms; `shininess` the exponent of the highlight, ≥ 0; `atten` a light's attenuation. Unit vectors are taken
//! as such unless a function says that it normalises.

use crate::algebra::{Rgb, Rgba, Vec3, Vector};
use crate::attenuation;
use crate::real::Real;
pub use crate::vector::{cosine_power, cosine_power_by_chord};
use crate::vector::{face_normal, halfway, halfway_unnormalised, reflect, toward};
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
        Vector::sum([self.ambient, self.diffuse, self.specular]).named("CF")
    }
}

/// `CA = LA * MA`. Source: 000 §6.3.
pub fn ambient<R: Real>(light: Rgb<R>, material: Rgb<R>) -> Rgb<R> {
    (light * material).named("CA")
}

/// `CA + CD` with CA a global constant that no light multiplies. Source: 004; ruling 8.
pub fn ambient_constant<R: Real>(ambient: Rgb<R>, diffuse: Rgb<R>) -> Rgb<R> {
    ambient + diffuse
}

/// `FI = max(l·n, 0)`. Source: 000 §6.3 with the shader's `max`; ruling 16.
pub fn incidence<R: Real>(l: Vec3<R>, n: Vec3<R>) -> R {
    l.dot(n).named("l·n").max(R::literal(0.0)).named("FI")
}

/// `CD = LD * MD * FI`, from the vector towards the light. Source: 004.
pub fn diffuse_toward<R: Real>(light: Rgb<R>, material: Rgb<R>, l: Vec3<R>, n: Vec3<R>) -> Rgb<R> {
    Vector::product([light, material, Vector::splat(incidence(l, n))]).named("CD")
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
        Specular::Phong => reflect(-l, n).named("r").dot(v).named("r·v"),
        Specular::Blinn => n.dot(halfway(v, l)).named("n·h"),
        Specular::BlinnUnnormalised => n.dot(halfway_unnormalised(v, l)).named("n·(v + l)"),
    };
    cosine.lobe(shininess).named("FS")
}

/// `CS = LS * MS * FS` with Phong's `FS = max(r·v, 0)^S`. Source: 000 §6.3.
pub fn specular_phong<R: Real>(light: Rgb<R>, material: Rgb<R>, r: Vec3<R>, v: Vec3<R>, shininess: R) -> Rgb<R> {
    specular(light, material, r.dot(v).named("r·v").lobe(shininess).named("FS"))
}

/// `CS = LS * MS * FS` with Blinn's `FS = max(n·h, 0)^S`. Source: 000 §6.4, 004.
pub fn specular_blinn<R: Real>(light: Rgb<R>, material: Rgb<R>, n: Vec3<R>, h: Vec3<R>, shininess: R) -> Rgb<R> {
    specular(light, material, n.dot(h).named("n·h").lobe(shininess).named("FS"))
}

/// `CS = LS * MS * max(r.z, 0)^S`: the viewer at infinity, v = (0, 0, 1). Source: 000 §6.4.
pub fn specular_nonlocal<R: Real>(light: Rgb<R>, material: Rgb<R>, r: Vec3<R>, shininess: R) -> Rgb<R> {
    specular(light, material, r.z().lobe(shininess).named("FS"))
}

fn specular<R: Real>(light: Rgb<R>, material: Rgb<R>, fs: R) -> Rgb<R> {
    Vector::product([light, material, Vector::splat(fs)]).named("CS")
}

/// CA, CD and CS of one light for unit n, l and v; `atten` multiplies diffuse and specular.
pub fn terms<R: Real>(
    (model, gate): (Specular, SpecularGate),
    light: &Light<R>,
    material: &Material<R>,
    [n, l, v]: [Vec3<R>; 3],
    atten: R,
) -> Terms<R> {
    let (zero, atten) = (R::literal(0.0), Vector::splat(atten));
    let fs = || highlight(model, n, l, v, material.shininess);
    let fs = match gate {
        SpecularGate::Documents => fs(),
        SpecularGate::OpenGl => R::if_ge(zero, l.dot(n), || zero, fs),
    };
    Terms {
        ambient: ambient(light.ambient, material.ambient),
        diffuse: Vector::product([light.diffuse, material.diffuse, Vector::splat(incidence(l, n)), atten]).named("CD"),
        specular: Vector::product([light.specular, material.specular, Vector::splat(fs), atten]).named("CS"),
    }
}

fn to_eye<R: Real>(p: Vec3<R>) -> Vec3<R> {
    (-p).normalize().named("v")
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
    let l = (-direction).normalize().named("l");
    let terms = terms(dialect, light, material, [n.normalize().named("n"), l, to_eye(p)], R::literal(1.0));
    terms.sum().extend(R::literal(1.0))
}

/// The same with the light's direction taken as a unit vector and not normalised. Source: 000 §6.4.
pub fn unit_light<R: Real>(light: &Light<R>, material: &Material<R>, [p, n, direction]: [Vec3<R>; 3]) -> Rgba<R> {
    let vectors = [n.normalize().named("n"), -direction, to_eye(p)];
    terms((Specular::Phong, SpecularGate::Documents), light, material, vectors, R::literal(1.0))
        .sum()
        .extend(R::literal(1.0))
}

/// The viewer at infinity, v = (0, 0, 1), and a unit light: 000 §6.4's faster program.
pub fn nonlocal<R: Real>(light: &Light<R>, material: &Material<R>, n: Vec3<R>, direction: Vec3<R>) -> Rgba<R> {
    let (n, l) = (n.normalize().named("n"), -direction);
    let r = reflect(-l, n).named("r");
    Terms {
        ambient: ambient(light.ambient, material.ambient),
        diffuse: diffuse_toward(light.diffuse, material.diffuse, l, n),
        specular: specular_nonlocal(light.specular, material.specular, r, material.shininess),
    }
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
    let atten = attenuation::point(falloff.kc, falloff.kl, falloff.kq, position, p).named("atten");
    let vectors = [n.normalize().named("n"), toward(position, p), to_eye(p)];
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
    let atten = attenuation::point(falloff.kc, falloff.kl, falloff.kq, position, p).named("atten");
    let vectors = [n.normalize().named("n"), toward(position, p), to_eye(p)];
    let mut terms = terms((Specular::Blinn, SpecularGate::OpenGl), light, material, vectors, atten);
    terms.ambient = Vector::product([light.ambient, material.ambient, Vector::splat(atten)]).named("atten·CA");
    terms.sum().extend(alpha)
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
    let cone = attenuation::spot_exponent(l, axis.normalize(), cutoff_cosine, exponent).named("spot");
    let atten = attenuation::point(falloff.kc, falloff.kl, falloff.kq, position, p).named("atten");
    let vectors = [n.normalize().named("n"), l, to_eye(p)];
    let dialect = (Specular::Phong, SpecularGate::Documents);
    terms(dialect, light, material, vectors, R::product([cone, atten])).sum().extend(R::literal(1.0))
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
    let vectors = [n.normalize().named("n"), toward(position, p), to_eye(p)];
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
    let fs = highlight(Specular::Blinn, n, l, v, shininess);
    [
        Vector::product([diffuse, color, Vector::splat(incidence(l, n))]).named("CD"),
        Vector::product([specular, color, Vector::splat(fs)]).named("CS"),
    ]
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
    let (n, v) = (n.normalize().named("n"), to_eye(p));
    let [d0, s0] = compute_light(colors[0], material, shininess, [n, direction.normalize().named("l0"), v]);
    let [d1, s1] = compute_light(colors[1], material, shininess, [n, toward(position, p), v]);
    Vector::sum([ambient, d0, s0, d1, s1])
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
    kd * incidence(l, n) + ks * highlight(Specular::Phong, n, l, v, shininess)
}

/// Gouraud shading between two vertices: lit at both, `(1 − t)·I(a) + t·I(b)`. Source: 000 §6.3, 004.
pub fn gouraud<R: Real>(a: Vertex<R>, b: Vertex<R>, t: R, position: Vec3<R>, material: [R; 3]) -> R {
    let lit = |vertex: Vertex<R>| {
        let vectors = [vertex.n.normalize(), toward(position, vertex.p), to_eye(vertex.p)];
        intensity(vectors, material).named("I")
    };
    R::mix(lit(a), lit(b), t)
}

/// Phong shading between two vertices: position and normal interpolated, the normal normalised again, then lit.
/// Source: 000 §6.3, 004.
pub fn phong<R: Real>(a: Vertex<R>, b: Vertex<R>, t: R, position: Vec3<R>, material: [R; 3]) -> R {
    let p = a.p.mix(b.p, t).named("p");
    let n = a.n.mix(b.n, t).normalize().named("n");
    intensity([n, toward(position, p), to_eye(p)], material)
}

/// Phong shading as document 003 has it: n, l and v all computed at the vertices, interpolated, and normalised at the
/// point. Source: 003.
pub fn phong_interpolated<R: Real>(a: Vertex<R>, b: Vertex<R>, t: R, position: Vec3<R>, material: [R; 3]) -> R {
    let n = a.n.mix(b.n, t).normalize().named("n");
    let l = (position - a.p).mix(position - b.p, t).normalize().named("l");
    let v = (-a.p).mix(-b.p, t).normalize().named("v");
    intensity([n, l, v], material)
}

/// Flat shading: one normal for the face, lit at its first vertex. Source: 004.
pub fn flat<R: Real>(face: [Vec3<R>; 3], position: Vec3<R>, material: [R; 3]) -> R {
    let [a, b, c] = face;
    intensity([face_normal(a, b, c), toward(position, a), to_eye(a)], material)
}

/// `t/(S − S·t + t)` for `t = max(a·b, 0)`: an approximation of `t^S` without a power, of its value and slope at 1 and of its
/// value at 0. Source: Schlick 1994.
pub fn cosine_power_by_schlick<R: Real>(a: Vec3<R>, b: Vec3<R>, exponent: R) -> R {
    let t = a.dot(b).max(R::literal(0.0)).named("t");
    t / R::sum([exponent, -(exponent * t), t])
}

/// [`cosine_power`] without the `max`: no value where the cosine is negative.
pub fn cosine_power_unguarded<R: Real>(a: Vec3<R>, b: Vec3<R>, exponent: R) -> R {
    a.dot(b).named("a·b").pow(exponent)
}

/// A directional light with Blinn's highlight, stable throughout: every vector normalised at any length, no highlight where
/// n·l ≤ 0, and its power by the chord. With OpenGL's gate it is [`directional`]'s Blinn.
pub fn blinn_stable<R: Real>(light: &Light<R>, material: &Material<R>, [p, n, direction]: [Vec3<R>; 3]) -> Rgba<R> {
    let zero = R::literal(0.0);
    let [n, l, v] = [n, -direction, -p].map(Vector::normalize_scaled);
    let h = (v + l).normalize_scaled().named("h");
    let lit = || cosine_power_by_chord(n, h, material.shininess).named("FS");
    let fs = R::if_ge(zero, l.dot(n), || zero, lit);
    Terms {
        ambient: ambient(light.ambient, material.ambient),
        diffuse: diffuse_toward(light.diffuse, material.diffuse, l, n),
        specular: specular(light.specular, material.specular, fs),
    }
    .sum()
    .extend(R::literal(1.0))
}
