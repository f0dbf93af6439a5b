//! How a light weakens with distance, and where a spotlight's cone ends (000 §6.4, 004).
//!
//! Symbols: `d` distance surface → light in eye-space units; `kc kl kq` the coefficients of attenuation in 1, 1/unit and
//! 1/unit²; `l` the unit vector surface → light; `axis` the unit direction in which the spotlight points.

use crate::algebra::Vec3;
use crate::real::Real;
use crate::step::step;
use crate::vector::power_by_chord;

/// `atten = 1 / (kc + kl·d + kq·d²)`.
///
/// The product `kl·d` is 0 for a light at infinity only if `kl` is: a directional light is not attenuated, which is
/// the caller's to say. Where all three coefficients are 0 there is no value. Source: 004.
pub fn polynomial<R: Real>(kc: R, kl: R, kq: R, d: R) -> R {
    step!("atten", |kc, kl, kq, d| R::literal(1.0) / R::quadratic([kc, kl, kq], d).named("kc + kl·d + kq·d²"))
}

/// The falloff of a distant light: (kc, kl, kq) = (1, 0, 0), so `atten = 1`. Source: 004.
pub fn constant<R: Real>(d: R) -> R {
    falloff(1.0, 0.0, 0.0, d)
}

/// The falloff of a tube light: (0, 1, 0), so `atten = 1/d`. No value at d = 0. Source: 004.
pub fn linear<R: Real>(d: R) -> R {
    falloff(0.0, 1.0, 0.0, d)
}

/// The falloff of a point light: (0, 0, 1), so `atten = 1/d²`. No value at d = 0. Source: 004.
pub fn square<R: Real>(d: R) -> R {
    falloff(0.0, 0.0, 1.0, d)
}

fn falloff<R: Real>(kc: f64, kl: f64, kq: f64, d: R) -> R {
    polynomial(R::literal(kc), R::literal(kl), R::literal(kq), d)
}

/// `atten` of a point light at `light` on the surface point `p`, with `d = |light − p|`. Source: 004.
pub fn point<R: Real>(kc: R, kl: R, kq: R, light: Vec3<R>, p: Vec3<R>) -> R {
    polynomial(kc, kl, kq, distance(light, p))
}

fn distance<R: Real>(light: Vec3<R>, p: Vec3<R>) -> R {
    let between = step!(quiet "what d is the length of", |light, p| light - p);
    step!("d", |between| between.length())
}

/// 1 where the surface lies inside the cone, `−l·axis ≥ cos(cutoff)`, and 0 outside. Source: 000 §6.4.
pub fn spot_cutoff<R: Real>(l: Vec3<R>, axis: Vec3<R>, cutoff_cosine: R) -> R {
    let cosine = step!("−l·axis", |l, axis| (-l).dot(axis));
    let (zero, one) = (R::literal(0.0), R::literal(1.0));
    step!("spot", |cosine, cutoff_cosine| R::if_ge(cosine, cutoff_cosine, || one, || zero))
}

/// `max(−l·axis, 0)^e` inside the cone and 0 outside, as OpenGL's fixed function has it.
///
/// With e = 0 the cone is evenly lit in front of the light; where it reaches behind it, 0 and 1 are both legal there (ruling 12). Source:
/// OpenGL 2.1 §2.14.1; the cutoff is 000's.
pub fn spot_exponent<R: Real>(l: Vec3<R>, axis: Vec3<R>, cutoff_cosine: R, exponent: R) -> R {
    let cosine = step!("−l·axis", |l, axis| (-l).dot(axis));
    step!("spot", |cosine, cutoff_cosine, exponent| {
        R::if_ge(cosine, cutoff_cosine, || cosine.lobe(exponent), || R::literal(0.0))
    })
}

/// `1 / (kc + kl·d + kq·(d·d))`: d² before its coefficient, and too great or too small before it.
pub fn polynomial_expanded<R: Real>(kc: R, kl: R, kq: R, d: R) -> R {
    step!("atten", |kc, kl, kq, d| R::literal(1.0) / R::sum([kc, kl * d, kq * (d * d)]))
}

/// `1 / clamp(kc + d(kl + d·kq), 2⁻¹²⁶, 2¹²⁶)`: Horner's scheme, and a denominator by which a shader may divide. Without any
/// coefficient it is 2¹²⁶.
pub fn polynomial_bounded<R: Real>(kc: R, kl: R, kq: R, d: R) -> R {
    // 2¹²⁶.
    const MOST: f64 = 85_070_591_730_234_615_865_843_651_857_942_052_864.0;
    step!("atten", |kc, kl, kq, d| {
        let denominator = (kc + d * (kl + d * kq)).named("kc + d(kl + d·kq)");
        R::literal(1.0) / denominator.clamp(R::literal(1.0 / MOST), R::literal(MOST))
    })
}

/// [`point`] with a distance that neither overflows nor underflows.
pub fn point_scaled<R: Real>(kc: R, kl: R, kq: R, light: Vec3<R>, p: Vec3<R>) -> R {
    let between = step!(quiet "what d is the length of", |light, p| light - p);
    polynomial_bounded(kc, kl, kq, step!("d", |between| between.length_scaled()))
}

/// [`spot_exponent`] with the power of the cosine by the chord between −l and the axis.
pub fn spot_exponent_by_chord<R: Real>(l: Vec3<R>, axis: Vec3<R>, cutoff_cosine: R, exponent: R) -> R {
    let cosine = step!("−l·axis", |l, axis| (-l).dot(axis));
    step!("spot", |cosine, cutoff_cosine, exponent| {
        R::if_ge(cosine, cutoff_cosine, || power_by_chord(-l, axis, exponent), || R::literal(0.0))
    })
}
