//! Blending: `Cf = Cs·S (op) Cd·D` (000 §6.6, 002).
//!
//! Symbols: `src` (Cs, As) the colour drawn, `dst` (Cd, Ad) the colour there before, `constant` (Cc, Ac) the blend
//! constant; S and D the factors. Nothing is clamped here: clamping belongs to the target's format.

use crate::algebra::{Rgba, Vector};
use crate::real::{Components as _, Real};
use lightmeter_scene::blend::{Equation, Factor, State};

/// The three colours that a factor may read.
#[derive(Clone, Copy, Debug)]
pub struct Operands<R> {
    /// Cs, As.
    pub src: Rgba<R>,
    /// Cd, Ad.
    pub dst: Rgba<R>,
    /// Cc, Ac.
    pub constant: Rgba<R>,
}

/// What SRC_ALPHA_SATURATE is in its RGB part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Saturate {
    /// min(As, 1 − Ad), as OpenGL, Vulkan and WebGPU define it.
    SourceAndDestination,
    /// min(As, 1 − As), as document 000 writes it: a dialect.
    SourceOnly,
}

/// The factor of each component, colour then alpha. Source: 000 §6.6.
pub fn factor<R: Real>(factor: Factor, of: &Operands<R>, saturate: Saturate) -> Rgba<R> {
    let one = R::literal(1.0);
    let (a_s, a_d, a_c) = (of.src.w(), of.dst.w(), of.constant.w());
    let both = Vector::splat;
    let one_minus = |c: Rgba<R>| c.map(|x| one - x);
    match factor {
        Factor::Zero => both(R::literal(0.0)),
        Factor::One => both(one),
        Factor::SrcColor => of.src,
        Factor::OneMinusSrcColor => one_minus(of.src),
        Factor::DstColor => of.dst,
        Factor::OneMinusDstColor => one_minus(of.dst),
        Factor::SrcAlpha => both(a_s),
        Factor::OneMinusSrcAlpha => both(one - a_s),
        Factor::DstAlpha => both(a_d),
        Factor::OneMinusDstAlpha => both(one - a_d),
        Factor::ConstantColor => of.constant,
        Factor::OneMinusConstantColor => one_minus(of.constant),
        Factor::ConstantAlpha => both(a_c),
        Factor::OneMinusConstantAlpha => both(one - a_c),
        Factor::SrcAlphaSaturate => {
            let other = match saturate {
                Saturate::SourceAndDestination => a_d,
                Saturate::SourceOnly => a_s,
            };
            Vector::<R, 3>::splat(a_s.min(one - other)).extend(one)
        }
    }
}

/// `Cs·S + Cd·D`, `Cs·S − Cd·D`, `Cd·D − Cs·S`, `min(Cs, Cd)` or `max(Cs, Cd)`. Source: 000 §6.6.
pub fn blend<R: Real>(state: State, of: &Operands<R>, saturate: Saturate) -> Rgba<R> {
    let s = || (of.src * factor(state.src, of, saturate).named("S")).named("Cs·S");
    let d = || (of.dst * factor(state.dst, of, saturate).named("D")).named("Cd·D");
    match state.equation {
        Equation::Add => Vector::sum([s(), d()]),
        Equation::Subtract => Vector::sum([s(), -d()]),
        Equation::ReverseSubtract => Vector::sum([d(), -s()]),
        Equation::Min => of.src.zip(of.dst, R::min),
        Equation::Max => of.src.zip(of.dst, R::max),
    }
}
