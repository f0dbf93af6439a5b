//! Blending: `Cf = Cs·S (op) Cd·D` (000 §6.6, 002).
//!
//! Symbols: `src` (Cs, As) the colour drawn, `dst` (Cd, Ad) the colour there before, `constant` (Cc, Ac) the blend
//! constant; S and D the factors. Nothing is clamped here: clamping belongs to the target's format.

use crate::algebra::{Rgb, Rgba, Vector};
use crate::real::{Components as _, Real};
use crate::step::step;
use lightmeter_scene::blend::{Equation, Factor, Separate, State, WriteMask};

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
    let [a, b] = match state.equation {
        Equation::Add => [s(), d()],
        Equation::Subtract => [s(), -d()],
        Equation::ReverseSubtract => [d(), -s()],
        Equation::Min => return of.src.zip(of.dst, R::min),
        Equation::Max => return of.src.zip(of.dst, R::max),
    };
    Vector::sum([a, b])
}

/// The colour by one state, the alpha by another. Source: 000 §6.6.
pub fn blend_separate<R: Real>(state: Separate, of: &Operands<R>, saturate: Saturate) -> Rgba<R> {
    let color = blend(state.color, of, saturate);
    if state.color == state.alpha {
        return color;
    }
    color.xyz().extend(blend(state.alpha, of, saturate).w())
}

/// What a draw leaves: components that are not written stay as they were. Source: the write masks of OpenGL and WebGPU.
pub fn masked<R: Copy>(mask: WriteMask, written: Rgba<R>, dst: Rgba<R>) -> Rgba<R> {
    let keep = |k: usize| if mask.0[k] { written.0[k] } else { dst.0[k] };
    Vector([keep(0), keep(1), keep(2), keep(3)])
}

/// Overlapping draws, one after the other, each over what those before it left; the modes in turn. Source: 002.
pub fn layers<R: Real, const N: usize>(modes: &[Mode], count: R, sources: [Rgba<R>; N], dst: Rgba<R>) -> Rgba<R> {
    let zero = Vector::splat(R::literal(0.0));
    let (mut below, mut number) = (dst, 0.0);
    for (src, mode) in sources.into_iter().zip(modes.iter().cycle()) {
        number += 1.0;
        let of = Operands { src, dst: below, constant: zero };
        let drawn = || blend(mode.state(), &of, Saturate::SourceAndDestination);
        below = R::if_ge(count, R::literal(number), drawn, || below);
    }
    below
}

/// The named modes of document 002.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// `src`: what is there is replaced.
    Solid,
    /// `src·As + dst·(1 − As)`.
    Alpha,
    /// `src * dst`: lightmaps.
    Mul,
    /// `src·As + dst`.
    Add,
}

impl Mode {
    /// The state that computes it.
    #[must_use]
    pub const fn state(self) -> State {
        let (src, dst) = match self {
            Self::Solid => (Factor::One, Factor::Zero),
            Self::Alpha => (Factor::SrcAlpha, Factor::OneMinusSrcAlpha),
            Self::Mul => (Factor::DstColor, Factor::Zero),
            Self::Add => (Factor::SrcAlpha, Factor::One),
        };
        State { equation: Equation::Add, src, dst }
    }
}

/// A named mode on a back buffer without alpha, which reads as 1. Source: 002.
///
/// What shaders write for [`Mode::Alpha`] is `mix(dst, src, As)`, so that either form of a mix is legal in it; [`over`] is the formula
/// that promises all of an opaque source.
pub fn without_alpha<R: Real>(mode: Mode, src: Rgba<R>, dst: Rgb<R>) -> Rgb<R> {
    if mode == Mode::Alpha {
        return step!(quiet "over", |src, dst| dst.mix(src.xyz(), src.w()));
    }
    let (one, zero) = (R::literal(1.0), R::literal(0.0));
    let of = Operands { src, dst: dst.extend(one), constant: Vector::splat(zero) };
    blend(mode.state(), &of, Saturate::SourceAndDestination).xyz()
}

/// Source-over on a target of [0, 1], as every unorm target is: source, destination and result are clamped.
pub fn alpha_clamped<R: Real>(src: Rgba<R>, dst: Rgba<R>) -> Rgba<R> {
    let unit = |c: Rgba<R>| c.map(|x| x.clamp(R::literal(0.0), R::literal(1.0)));
    let of = Operands { src: unit(src), dst: unit(dst), constant: Vector::splat(R::literal(0.0)) };
    unit(blend(Mode::Alpha.state(), &of, Saturate::SourceAndDestination))
}

/// `src·As + dst(1 − As)`: all of the source, to the last bit, where it is opaque. Straight alpha; no alpha in the destination.
pub fn over<R: Real>(src: Rgba<R>, dst: Rgb<R>) -> Rgb<R> {
    let one = R::literal(1.0);
    step!(quiet "over", |src, dst| src.xyz().zip(dst, |s, d| s * src.w() + d * (one - src.w())))
}

/// `dst + As(src − dst)`: one multiplication less; over a bright destination it misses an opaque source.
pub fn over_incremental<R: Real>(src: Rgba<R>, dst: Rgb<R>) -> Rgb<R> {
    src.xyz().zip(dst, |s, d| d + src.w() * (s - d))
}

/// `1 − (1 − α)ⁿ`: how much n layers of one alpha hide, by a subtraction that cancels for thin ones.
pub fn opacity_of_layers<R: Real>(alpha: R, layers: R) -> R {
    let one = R::literal(1.0);
    one - (one - alpha).pow(layers)
}

/// The same as `−expm1(n·ln(1 − α))`. For α < 1.
pub fn opacity_of_layers_expm1<R: Real>(alpha: R, layers: R) -> R {
    -(layers * (-alpha).ln_1p()).exp_m1()
}

/// `color/α`: straight from premultiplied alpha; no value where nothing is there.
pub fn unpremultiply<R: Real>(color: Rgb<R>, alpha: R) -> Rgb<R> {
    color.map(|c| c / alpha)
}

/// The same, and 0 where α is 0 or too small to divide by, below 2⁻¹²⁶.
pub fn unpremultiply_guarded<R: Real>(color: Rgb<R>, alpha: R) -> Rgb<R> {
    let least = R::literal(f64::from(f32::MIN_POSITIVE));
    R::if_ge(alpha, least, || unpremultiply(color, alpha), || Vector::splat(R::literal(0.0)))
}

/// `src·S − dst·D`: what FUNC_SUBTRACT computes, each product rounded.
pub fn subtract<R: Real>(src: R, s: R, dst: R, d: R) -> R {
    src * s - dst * d
}

/// The same with a small relative error however nearly the products cancel.
pub fn subtract_compensated<R: Real>(src: R, s: R, dst: R, d: R) -> R {
    R::difference_of_products([src, s], [dst, d])
}
