//! Colours and how they are stored (000 §6.2, 002, 004).
//!
//! Symbols: `c` a linear component, nominally 0 to 1; `e` an sRGB-encoded one; `byte` a whole number from 0 to 255.

use crate::algebra::{Rgb, Rgba, Vector};
use crate::real::Real;
use crate::step::step;

/// `byte = round(255·clamp(c, 0, 1))`. At a tie either neighbour is legal. Source: 000 §6.2.
pub fn to_unorm8<R: Real>(c: R) -> R {
    step!("byte", |c| (R::literal(255.0) * c.clamp(R::literal(0.0), R::literal(1.0))).named("255·c").round())
}

/// `c = byte / 255`. Source: 000 §6.2.
pub fn from_unorm8<R: Real>(byte: R) -> R {
    step!("byte/255", |byte| byte / R::literal(255.0))
}

/// `e = 12.92·c` for c ≤ 0.0031308, else `1.055·c^(1/2.4) − 0.055`; for 0 ≤ c ≤ 1. Source: IEC 61966-2-1.
pub fn srgb_encode<R: Real>(c: R) -> R {
    step!("encoded", |c| {
        R::if_ge(
            R::literal(0.003_130_8),
            c,
            || R::literal(12.92) * c,
            || R::literal(1.055) * c.pow(R::literal(1.0 / 2.4)).named("c^(1/2.4)") - R::literal(0.055),
        )
    })
}

/// `c = e/12.92` for e ≤ 0.04045, else `((e + 0.055)/1.055)^2.4`; for 0 ≤ e ≤ 1. Source: IEC 61966-2-1.
pub fn srgb_decode<R: Real>(e: R) -> R {
    step!("decoded", |e| {
        // No binary float is 0.04045. The nearest binary32 lies below it, so a shader's `<` and `<=` differ there, and both are right.
        R::if_ge(
            e,
            R::literal(0.040_45),
            || ((e + R::literal(0.055)) / R::literal(1.055)).pow(R::literal(2.4)),
            || e / R::literal(12.92),
        )
    })
}

/// [`srgb_encode`] without its straight piece: wrong below c = 0.0031308, and without a value below 0.
pub fn srgb_encode_power<R: Real>(c: R) -> R {
    step!("encoded by the power alone", |c| R::literal(1.055) * c.pow(R::literal(1.0 / 2.4)) - R::literal(0.055))
}

/// `e = c^(1/2.2)`: the power that stands in for sRGB's two pieces. For c > 0.
pub fn gamma_encode<R: Real>(c: R) -> R {
    step!("c^(1/2.2)", |c| c.pow(R::literal(1.0 / 2.2)))
}

/// An sRGB target's encoding of a colour: each of R, G, B by [`srgb_encode`], alpha as it is.
pub fn srgb_encode_rgba<R: Real>(c: Rgba<R>) -> Rgba<R> {
    let alpha = c.w();
    c.xyz().map(srgb_encode).extend(step!(quiet "alpha of an encoded color", |alpha| alpha))
}

/// An sRGB target's colour read back: each of R, G, B by [`srgb_decode`], alpha as it is.
pub fn srgb_decode_rgba<R: Real>(e: Rgba<R>) -> Rgba<R> {
    let alpha = e.w();
    e.xyz().map(srgb_decode).extend(step!(quiet "alpha of a decoded color", |alpha| alpha))
}

/// `texel·color`: a texture, or a lightmap, that modulates. Source: 002 (DIFFUSE × LIGHTMAP).
pub fn modulate<R: Real>(texel: Rgba<R>, color: Rgba<R>) -> Rgba<R> {
    step!("texel·color", |texel, color| texel * color)
}

/// `texel`: a texture that replaces the colour. Source: 004.
pub fn replace<R: Real>(texel: Rgba<R>, _color: Rgba<R>) -> Rgba<R> {
    texel
}

/// `clamp(a + b, 0, 1)`: sums on the colour cube, as red + green = yellow. Source: 004.
pub fn sum<R: Real>(a: Rgb<R>, b: Rgb<R>) -> Rgb<R> {
    let sum = a + b;
    step!(quiet "clamp", |sum| sum.map(|x| x.clamp(R::literal(0.0), R::literal(1.0))))
}

/// `(color, 1)`: a fixed or uniform colour is written as it is, with alpha 1. Source: 000 §6.2.
pub fn uniform<R: Real>(color: Rgb<R>) -> Rgba<R> {
    color.extend(R::literal(1.0))
}

/// `Σ weightᵢ·colorᵢ, 1`: a colour bound to the vertices and interpolated over a triangle. Source: 000 §6.2.
pub fn per_vertex<R: Real>(weights: [R; 3], colors: [Rgb<R>; 3]) -> Rgba<R> {
    let [a, b, c] = colors;
    let sum = step!("Σ weight·color", |weights, a, b, c| {
        let [alpha, beta, gamma] = weights;
        Vector::sum([a.scale(alpha), b.scale(beta), c.scale(gamma)])
    });
    sum.extend(R::literal(1.0))
}
