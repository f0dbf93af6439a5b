//! Integer models of blend units on 8 bits: what a driver is known to compute, bit for bit.

use super::pixel::Units;
use lightmeter_catalogue::cases::blend::{Program, UnitCase};
use lightmeter_scene::blend::Route;
use lightmeter_scene::blend::{Equation, Factor, State};

/// A model of a blend unit on targets of 8 linear bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlendUnitModel {
    /// Mesa's llvmpipe: operands `q(x) = rint(255·clamp(x))`, products `m(a, b) = (ab + (ab >> 8) + 128) >> 8`, result
    /// `sat(m(S, F) ± m(D, G))`.
    Llvmpipe,
}

impl BlendUnitModel {
    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Llvmpipe => "llvmpipe-unorm8",
        }
    }

    /// The steps that it leaves.
    #[must_use]
    pub fn predict(self, program: Program, route: Route, case: &UnitCase, start: Units) -> Units {
        let constant = quantise(case.constant);
        let mut below = start.map(whole);
        for number in 0..case.layers {
            let (state, mask) = program.layer(number);
            let mut source = case.sources[number];
            let mut color = state.color;
            if route == Route::FoldedIntoSource {
                source = folded(color.src, source, case.constant);
                color.src = Factor::One;
            }
            let operands = [quantise(source), below, constant];
            let written: [i32; 4] =
                std::array::from_fn(|k| component(if k < 3 { color } else { state.alpha }, operands, k));
            below = std::array::from_fn(|k| if mask.0[k] { written[k] } else { below[k] });
        }
        below.map(f64::from)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "steps from 0 to 255")]
const fn whole(steps: f64) -> i32 {
    steps as i32
}

fn quantise(color: [f32; 4]) -> [i32; 4] {
    color.map(|c| whole(f64::from((255.0 * c.clamp(0.0, 1.0)).round_ties_even())))
}

/// What the shader multiplies into the source where the unit has no factor for it, in f32.
fn folded(by: Factor, [r, g, b, a]: [f32; 4], constant: [f32; 4]) -> [f32; 4] {
    let [cr, cg, cb, ca] = constant.map(|c| c.clamp(0.0, 1.0));
    let constant = if by.reads_constant_alpha() { [ca; 3] } else { [cr, cg, cb] };
    let is_complement = matches!(by, Factor::OneMinusConstantColor | Factor::OneMinusConstantAlpha);
    let [x, y, z] = constant.map(|c| if is_complement { 1.0 - c } else { c });
    [r.clamp(0.0, 1.0) * x, g.clamp(0.0, 1.0) * y, b.clamp(0.0, 1.0) * z, a]
}

fn component(state: State, of: [[i32; 4]; 3], k: usize) -> i32 {
    let (s, d) = (of[0][k], of[1][k]);
    let product = |a: i32, b: i32| (a * b + ((a * b) >> 8) + 128) >> 8;
    let (source, destination) = (product(s, factor(state.src, of, k)), product(d, factor(state.dst, of, k)));
    let result = match state.equation {
        Equation::Add => source + destination,
        Equation::Subtract => source - destination,
        Equation::ReverseSubtract => destination - source,
        Equation::Min => s.min(d),
        Equation::Max => s.max(d),
    };
    result.clamp(0, 255)
}

fn factor(factor: Factor, [src, dst, constant]: [[i32; 4]; 3], k: usize) -> i32 {
    match factor {
        Factor::Zero => 0,
        Factor::One => 255,
        Factor::SrcColor => src[k],
        Factor::OneMinusSrcColor => 255 - src[k],
        Factor::DstColor => dst[k],
        Factor::OneMinusDstColor => 255 - dst[k],
        Factor::SrcAlpha => src[3],
        Factor::OneMinusSrcAlpha => 255 - src[3],
        Factor::DstAlpha => dst[3],
        Factor::OneMinusDstAlpha => 255 - dst[3],
        Factor::ConstantColor => constant[k],
        Factor::OneMinusConstantColor => 255 - constant[k],
        Factor::ConstantAlpha => constant[3],
        Factor::OneMinusConstantAlpha => 255 - constant[3],
        Factor::SrcAlphaSaturate if k == 3 => 255,
        Factor::SrcAlphaSaturate => src[3].min(255 - dst[3]),
    }
}
