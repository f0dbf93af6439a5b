//! Vectors and transforms (000 §6.3, 003, 004). Symbols as in the crate's conventions.

use crate::algebra::{Mat3, Mat4, Vec3, Vec4, Vector, binary_scale};
use crate::real::Real;
use crate::step::step;

/// `r = i − 2(i·n)n`: the light's direction of travel mirrored about the unit normal.
///
/// Where n is not of length 1, |r| is not |i|. Source: 000 §6.3.
pub fn reflect<R: Real>(i: Vec3<R>, n: Vec3<R>) -> Vec3<R> {
    step!("r", |i, n| {
        let i_dot_n = i.dot(n).named("i·n");
        i - n.map(|x| R::product([R::literal(2.0), i_dot_n, x]))
    })
}

/// `r = −l + 2(l·n)n`: the same mirrored light from the vector that points to the light. Source: 004.
pub fn reflect_toward<R: Real>(l: Vec3<R>, n: Vec3<R>) -> Vec3<R> {
    step!("r", |l, n| {
        let l_dot_n = l.dot(n).named("l·n");
        -l + n.map(|x| R::product([R::literal(2.0), l_dot_n, x]))
    })
}

/// `h = ⟨v + l⟩`, and 0 where v = −l. Source: 004; ruling 3.
pub fn halfway<R: Real>(v: Vec3<R>, l: Vec3<R>) -> Vec3<R> {
    let sum = halfway_unnormalised(v, l);
    step!("h", |sum| sum.normalize())
}

/// `h = v + l`, as document 000 §6.4 writes it: a dialect.
pub fn halfway_unnormalised<R: Real>(v: Vec3<R>, l: Vec3<R>) -> Vec3<R> {
    step!("v + l", |v, l| v + l)
}

/// `⟨v⟩ = v/|v|`, and 0 for the zero vector.
pub fn normalize<R: Real>(v: Vec3<R>) -> Vec3<R> {
    step!("⟨v⟩", |v| v.normalize())
}

/// `modelview · (n, 0)`: right, up to its length, for rigid motion and uniform scale only. Source: 000, 003.
pub fn normal_modelview<R: Real>(modelview: &Mat3<R>, n: Vec3<R>) -> Vec3<R> {
    let modelview = *modelview;
    step!("normal by the modelview", |modelview, n| modelview.transform(n))
}

/// `modelview⁻ᵀ · n` by cofactors over the determinant: right for every invertible matrix, a reflection too.
///
/// Where the determinant is 0 there is no value. Source: 004; ruling 6.
pub fn normal_inverse_transpose<R: Real>(modelview: &Mat3<R>, n: Vec3<R>) -> Vec3<R> {
    let modelview = *modelview;
    step!("modelview⁻ᵀ·n", |modelview, n| NormalMatrix::new(&modelview).transform(n))
}

/// `modelview⁻ᵀ`, not yet divided: what [`normal_inverse_transpose`] works out of the matrix alone, once for all normals.
#[derive(Clone, Copy, Debug)]
pub struct NormalMatrix<R> {
    cofactors: Mat3<R>,
    determinant: R,
}

impl<R: Real> NormalMatrix<R> {
    /// The cofactors and the determinant.
    pub fn new(modelview: &Mat3<R>) -> Self {
        let cofactors = modelview.cofactors();
        let determinant = modelview.0[0].dot(cofactors.0[0]).named("determinant");
        Self { cofactors, determinant }
    }

    /// `cofactors · n / determinant`.
    pub fn transform(&self, n: Vec3<R>) -> Vec3<R> {
        self.cofactors.transform(n).named("cofactors·n").map(|x| x / self.determinant)
    }
}

/// `view · (direction, 0)`: a light's direction in eye space. Source: 000 §6.3.
pub fn light_direction<R: Real>(view: &Mat4<R>, direction: Vec3<R>) -> Vec3<R> {
    let view = *view;
    step!("view·direction", |view, direction| view.transform(direction.extend(R::literal(0.0))).xyz())
}

/// `(modelview · position)` divided by its w: a light's position in eye space.
///
/// With w = 0 the light is infinitely far away and the direction towards it comes out, undivided. Source: 004.
pub fn light_position<R: Real>(modelview: &Mat4<R>, position: Vec4<R>) -> Vec3<R> {
    let modelview = *modelview;
    let eye = step!("modelview·position", |modelview, position| modelview.transform(position));
    step!("xyz/w", |eye| dehomogenise(eye))
}

/// `xyz / w`, and `xyz` where w = 0. Source: 004.
pub fn dehomogenise<R: Real>(p: Vec4<R>) -> Vec3<R> {
    let zero = R::literal(0.0);
    let divided = || p.xyz().map(|x| x / p.w());
    R::if_ge(p.w(), zero, || R::if_ge(zero, p.w(), || p.xyz(), divided), divided)
}

/// `view · (model · (position, 1))`: a light that moves with a model. Source: 004.
pub fn light_with_model<R: Real>(view: &Mat4<R>, model: &Mat4<R>, position: Vec3<R>) -> Vec3<R> {
    let (view, model) = (*view, *model);
    step!("view·model·position", |view, model, position| {
        view.transform(model.transform(position.extend(R::literal(1.0)))).xyz()
    })
}

/// `⟨light − p⟩`: from the surface point to a positional light. Ruling 2: it points to the light. Source: 000 §6.4, 003.
pub fn toward<R: Real>(light: Vec3<R>, p: Vec3<R>) -> Vec3<R> {
    let to_light = step!(quiet "light − p", |light, p| light - p);
    step!("l", |to_light| to_light.normalize())
}

/// `⟨n₀ + n₁ + n₂⟩`: face normals averaged at a vertex. Source: 004.
pub fn average_normal<R: Real>(faces: [Vec3<R>; 3]) -> Vec3<R> {
    let sum = Vector::sum(faces).named("Σn");
    step!("⟨Σn⟩", |sum| sum.normalize())
}

/// `⟨(b − a) × (c − a)⟩`: the normal of a face wound counter-clockwise.
pub fn face_normal<R: Real>(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>) -> Vec3<R> {
    let cross = step!("(b − a)×(c − a)", |a, b, c| (b - a).cross(c - a));
    step!("face's n", |cross| cross.normalize())
}

/// `v/|v|` of a vector that is not zero, which nothing checks.
pub fn normalize_unguarded<R: Real>(v: Vec3<R>) -> Vec3<R> {
    step!("⟨v⟩", |v| Vector(R::normalize(v.0)))
}

/// `⟨v⟩` of any vector whose largest component is a normal number: [`Vector::normalize_scaled`].
pub fn normalize_scaled<R: Real>(v: Vec3<R>) -> Vec3<R> {
    step!("⟨v⟩", |v| v.normalize_scaled())
}

/// `|v| = √(v·v)`.
pub fn length<R: Real>(v: Vec3<R>) -> R {
    step!("|v|", |v| v.length())
}

/// `|v|` of any vector whose length is a normal number: [`Vector::length_scaled`].
pub fn length_scaled<R: Real>(v: Vec3<R>) -> R {
    step!("|v|", |v| v.length_scaled())
}

/// `h = (v + l)/|v + l|`, which has no value where v = −l.
pub fn halfway_unguarded<R: Real>(v: Vec3<R>, l: Vec3<R>) -> Vec3<R> {
    let sum = halfway_unnormalised(v, l);
    step!("h", |sum| Vector(R::normalize(sum.0)))
}

/// `r = i − 2(i·⟨n⟩)⟨n⟩`: the mirror about a normal of any length, so that |r| = |i|.
pub fn reflect_any_normal<R: Real>(i: Vec3<R>, n: Vec3<R>) -> Vec3<R> {
    reflect(i, step!("⟨n⟩", |n| n.normalize_scaled()))
}

/// `⟨modelview⁻ᵀ·n⟩` by cofactors over the determinant.
pub fn normal_by_determinant<R: Real>(modelview: &Mat3<R>, n: Vec3<R>) -> Vec3<R> {
    let turned = normal_inverse_transpose(modelview, n);
    step!("⟨n⟩", |turned| turned.normalize())
}

/// The same without the division: the cofactors' direction, turned round where the determinant is negative. Each column is
/// brought near 1 by a power of two sᵢ first, so that nothing overflows or underflows, and n divided by it: `Σ nᵢ·sᵢ·cofactorᵢ`
/// of the scaled columns has the same direction. Source: Lengyel.
pub fn normal_by_cofactors<R: Real>(modelview: &Mat3<R>, n: Vec3<R>) -> Vec3<R> {
    let modelview = *modelview;
    step!("⟨modelview⁻ᵀ·n⟩", |modelview, n| {
        let scales = modelview.0.map(|column| binary_scale(column.largest()).0);
        let scaled = Mat3(std::array::from_fn(|k| modelview.0[k].scale(scales[k])));
        let cofactors = scaled.cofactors();
        let weights = near_one(near_one(n) * Vector(scales));
        let normal = cofactors.transform(weights).normalize_scaled().named("⟨cofactors·n⟩");
        let determinant = scaled.0[0].dot(near_one(cofactors.0[0])).named("determinant, scaled");
        R::if_ge(determinant, R::literal(0.0), || normal, || -normal)
    })
}

/// A vector brought near 1 by a power of two.
fn near_one<R: Real>(v: Vec3<R>) -> Vec3<R> {
    v.scale(binary_scale(v.largest()).0)
}

/// [`face_normal`] with the edges brought near 1 and a cross product that keeps its relative error small: right for faces of
/// any size, and for slivers whose corners' differences are exact.
pub fn face_normal_compensated<R: Real>(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>) -> Vec3<R> {
    let cross = near_one(b - a).cross_compensated(near_one(c - a));
    step!("face's n", |cross| cross.normalize_scaled())
}

/// A vertex's normal as it is handed to the points between.
pub(crate) fn at_vertex<R: Real>(n: Vec3<R>) -> Vec3<R> {
    step!(quiet "n at a vertex", |n| n)
}

/// `⟨n0(1 − t) + n1·t⟩`: the normal between two vertices.
pub fn interpolated_normal<R: Real>(n0: Vec3<R>, n1: Vec3<R>, t: R) -> Vec3<R> {
    let n = at_vertex(n0).mix(at_vertex(n1), t).named("n");
    step!("⟨n⟩", |n| n.normalize())
}

/// The same, and the face's own normal where less than 2⁻¹⁰ is left of the interpolated one: what remains of opposite normals
/// is their rounding.
pub fn interpolated_normal_guarded<R: Real>(n0: Vec3<R>, n1: Vec3<R>, face: Vec3<R>, t: R) -> Vec3<R> {
    let n = at_vertex(n0).mix(at_vertex(n1), t).named("n");
    step!("⟨n⟩", |n| R::if_ge(n.dot(n), R::literal(1.0 / 1_048_576.0), || n.normalize(), || face.normalize()))
}

/// `max(a·b, 0)^exponent` of two unit vectors: a highlight's power as published, the cosine by a dot product.
pub fn cosine_power<R: Real>(a: Vec3<R>, b: Vec3<R>, exponent: R) -> R {
    let cosine = step!("a·b", |a, b| a.dot(b));
    power(cosine, exponent)
}

/// The power of the cosine between two vectors that are unit but for rounding: `(1 − q)^exponent` with `q = ½|a − b|²`,
/// which is as exact as a and b are, where 1 − q has lost all of q below 2⁻²⁴.
///
/// From an exponent of 64 and for angles below 60° by `exp(exponent·ln(1 − q))`; as published elsewhere.
pub fn cosine_power_by_chord<R: Real>(a: Vec3<R>, b: Vec3<R>, exponent: R) -> R {
    step!("FS", |a, b, exponent| power_by_chord(a, b, exponent))
}

/// The same of whatever the power is of.
pub(crate) fn power_by_chord<R: Real>(a: Vec3<R>, b: Vec3<R>, exponent: R) -> R {
    let between = a - b;
    let half = R::literal(0.5);
    let q = (half * between.dot(between)).named("q");
    let published = || a.dot(b).named("a·b").lobe(exponent);
    let chord = || (exponent * (-q).ln_1p().named("ln(1 − q)")).exp();
    R::if_ge(R::literal(64.0), exponent, published, || R::if_ge(q, half, published, chord))
}

/// `FS = max(cosine, 0)^exponent`.
pub(crate) fn power<R: Real>(cosine: R, exponent: R) -> R {
    step!("FS", |cosine, exponent| cosine.lobe(exponent))
}
