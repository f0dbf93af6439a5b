//! What some renderers compute in a formula's place: not of the source documents, and here only to be told when an answer is one.

use crate::algebra::Vec3;
use crate::real::Real;
use crate::vector::halfway;

/// The highlight of three.js's MeshPhongMaterial, to be multiplied by the light's colour: Blinn's lobe normalised, times n·l, and
/// Schlick's Fresnel term, which takes the material's colour to white at grazing angles.
#[derive(Clone, Copy, Debug)]
pub struct FresnelHighlight<R> {
    /// `max(n·l, 0)`.
    pub incidence: R,
    /// `(S/2 + 1) · max(n·h, 0)^S / 4`.
    pub density: R,
    /// Schlick's `(1 − v·h)⁵`, by the exponential that engines have taken from Karis 2013.
    pub fresnel: R,
}

impl<R: Real> FresnelHighlight<R> {
    /// Of a unit normal, a unit vector to the light and one to the eye.
    pub fn new(n: Vec3<R>, l: Vec3<R>, v: Vec3<R>, incidence: R, shininess: R) -> Self {
        let (zero, one) = (R::literal(0.0), R::literal(1.0));
        let h = halfway(v, l);
        let cosine = v.dot(h).max(zero);
        let exponent = (R::literal(-5.55473) * cosine - R::literal(6.98316)) * cosine;
        let lobe = n.dot(h).lobe(shininess);
        let density = (shininess * R::literal(0.5) + one) * lobe * R::literal(0.25);
        Self { incidence, density, fresnel: exponent.exp2() }
    }

    /// A component of the material's colour as it is seen.
    pub fn tinted(self, material: R) -> R {
        material * (R::literal(1.0) - self.fresnel) + self.fresnel
    }
}

/// A normal on the side of a surface that something is seen from.
pub fn turned_to<R: Real>(eye: Vec3<R>, n: Vec3<R>) -> Vec3<R> {
    let side = R::if_ge(eye.dot(n), R::literal(0.0), || R::literal(1.0), || R::literal(-1.0));
    n.map(|x| x * side)
}

/// Half-Life's diffuse term, of n·l.
pub fn half_lambert<R: Real>(cosine: R) -> R {
    let half = R::literal(0.5);
    let wrapped = half * cosine + half;
    wrapped * wrapped
}

/// The shading languages' smoothstep.
pub fn smoothstep<R: Real>(low: R, high: R, x: R) -> R {
    let t = ((x - low) / (high - low)).clamp(R::literal(0.0), R::literal(1.0));
    R::product([t, t, R::literal(3.0) - R::literal(2.0) * t])
}
