//! Fog: a factor from the distance, then a mix towards the fog's colour (000 §6.5).
//!
//! Symbols: `distance` ≥ 0 in eye-space units, either |z| (the document's) or |p| (the radial dialect); `f` the share of
//! the surface's own colour, 1 where the air is clear and 0 where only fog is seen; `density` in 1/unit, or 1/unit² in
//! the document's exponential-squared form.

use crate::algebra::{Rgb, Vec3};
use crate::real::Real;
use crate::step::step;
pub use lightmeter_scene::shading::Distance;

/// The distance of a point in eye space.
pub fn distance<R: Real>(p: Vec3<R>, kind: Distance) -> R {
    step!("distance", |p| match kind {
        Distance::Planar => p.z().abs(),
        Distance::Radial => p.length(),
    })
}

/// `f = clamp((dmax − distance) / (dmax − dmin), 0, 1)`.
///
/// With dmin = dmax it is a step: 1 before dmax, 0 from dmax on. With dmax < dmin the fog is turned round, as in OpenGL.
/// Source: 000 §6.5; the clamp is in its shader.
pub fn linear<R: Real>(distance: R, dmin: R, dmax: R) -> R {
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    step!("f", |distance, dmin, dmax| {
        let ramp = || clamped(((dmax - distance) / (dmax - dmin)).named("(dmax − distance)/(dmax − dmin)"));
        let at_once = || R::if_ge(distance, dmax, || zero, || one);
        R::if_ge(dmin, dmax, || R::if_ge(dmax, dmin, at_once, ramp), ramp)
    })
}

/// `f = clamp(exp(−density·distance), 0, 1)`. Source: 000 §6.5.
pub fn exp<R: Real>(distance: R, density: R) -> R {
    step!("f", |distance, density| power_of_e((-(density * distance)).named("−density·distance")))
}

/// `f = clamp(exp(−density·distance²), 0, 1)`, as document 000 §6.5 writes it.
pub fn exp2_document<R: Real>(distance: R, density: R) -> R {
    step!("f", |distance, density| {
        power_of_e((-R::product([density, distance, distance])).named("−density·distance²"))
    })
}

/// `f = clamp(exp(−(density·distance)²), 0, 1)`, as OpenGL's fixed function has it.
pub fn exp2_opengl<R: Real>(distance: R, density: R) -> R {
    step!("f", |distance, density| {
        power_of_e((-R::product([density, distance, density, distance])).named("−(density·distance)²"))
    })
}

/// [`linear`] as a multiplication and an addition, `f = distance·scale + offset` with both made beforehand: for a narrow band
/// far away both are great and nearly cancel, and for none there is no value.
pub fn linear_multiply_add<R: Real>(distance: R, dmin: R, dmax: R) -> R {
    step!("f", |distance, dmin, dmax| {
        let width = dmax - dmin;
        let (scale, offset) = ((R::literal(-1.0) / width).named("scale"), (dmax / width).named("offset"));
        clamped(distance * scale + offset)
    })
}

/// [`exp2_document`] with the distance squared before the density: too great or too small before it.
pub fn exp2_document_square<R: Real>(distance: R, density: R) -> R {
    step!("f", |distance, density| power_of_e(-(density * (distance * distance))))
}

/// [`exp2_opengl`] with density and distance each squared alone.
pub fn exp2_opengl_squares<R: Real>(distance: R, density: R) -> R {
    step!("f", |distance, density| power_of_e(-((density * density) * (distance * distance))))
}

/// `1 − exp(−density·distance)`: how much of the fog is seen, by a subtraction that cancels in thin fog.
pub fn opacity<R: Real>(distance: R, density: R) -> R {
    R::literal(1.0) - (-(density * distance)).exp()
}

/// The same as `−expm1(−density·distance)`, which keeps its relative error small in the thinnest fog.
pub fn opacity_expm1<R: Real>(distance: R, density: R) -> R {
    -(-(density * distance)).exp_m1()
}

/// |p| that neither overflows nor underflows.
pub fn radial_distance_scaled<R: Real>(p: Vec3<R>) -> R {
    step!("distance", |p| p.length_scaled())
}

fn power_of_e<R: Real>(exponent: R) -> R {
    clamped(step!(quiet "exp", |exponent| exponent.exp()))
}

fn clamped<R: Real>(f: R) -> R {
    step!(quiet "clamp", |f| f.clamp(R::literal(0.0), R::literal(1.0)))
}

/// `color = mix(fog, shaded, f)`: the fog where f = 0, the surface where f = 1. Source: 000 §6.5.
pub fn apply<R: Real>(fog: Rgb<R>, shaded: Rgb<R>, f: R) -> Rgb<R> {
    step!("color", |fog, shaded, f| fog.mix(shaded, f))
}
