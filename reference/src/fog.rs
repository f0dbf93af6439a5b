//! Fog: a factor from the distance, then a mix towards the fog's colour (000 §6.5).
//!
//! Symbols: `distance` ≥ 0 in eye-space units, either |z| (the document's) or |p| (the radial dialect); `f` the share of
//! the surface's own colour, 1 where the air is clear and 0 where only fog is seen; `density` in 1/unit, or 1/unit² in
//! the document's exponential-squared form.

use crate::algebra::{Rgb, Vec3};
use crate::real::Real;
pub use lightmeter_scene::shading::Distance;

/// The distance of a point in eye space.
pub fn distance<R: Real>(p: Vec3<R>, kind: Distance) -> R {
    match kind {
        Distance::Planar => p.z().abs(),
        Distance::Radial => p.length(),
    }
    .named("distance")
}

/// `f = clamp((dmax − distance) / (dmax − dmin), 0, 1)`.
///
/// With dmin = dmax it is a step: 1 before dmax, 0 from dmax on. With dmax < dmin the fog is turned round, as in OpenGL.
/// Source: 000 §6.5; the clamp is in its shader.
pub fn linear<R: Real>(distance: R, dmin: R, dmax: R) -> R {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    let ramp = || ((dmax - distance) / (dmax - dmin)).named("(dmax − distance)/(dmax − dmin)").clamp(zero, one);
    let step = || R::if_ge(distance, dmax, || zero, || one);
    R::if_ge(dmin, dmax, || R::if_ge(dmax, dmin, step, ramp), ramp).named("f")
}

/// `f = clamp(exp(−density·distance), 0, 1)`. Source: 000 §6.5.
pub fn exp<R: Real>(distance: R, density: R) -> R {
    factor((-(density * distance)).named("−density·distance").exp())
}

/// `f = clamp(exp(−density·distance²), 0, 1)`, as document 000 §6.5 writes it.
pub fn exp2_document<R: Real>(distance: R, density: R) -> R {
    factor((-R::product([density, distance, distance])).named("−density·distance²").exp())
}

/// `f = clamp(exp(−(density·distance)²), 0, 1)`, as OpenGL's fixed function has it.
pub fn exp2_opengl<R: Real>(distance: R, density: R) -> R {
    factor((-R::product([density, distance, density, distance])).named("−(density·distance)²").exp())
}

fn factor<R: Real>(f: R) -> R {
    f.clamp(R::literal(0.0), R::literal(1.0)).named("f")
}

/// `color = mix(fog, shaded, f)`: the fog where f = 0, the surface where f = 1. Source: 000 §6.5.
pub fn apply<R: Real>(fog: Rgb<R>, shaded: Rgb<R>, f: R) -> Rgb<R> {
    fog.mix(shaded, f)
}
