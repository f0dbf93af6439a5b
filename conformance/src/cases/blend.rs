//! Cases of blending: every distinct state of the 15 × 15 × 5, and the named modes. Formulas: `lightmeter_reference::blend`.

use super::Visitor;
use super::formula::{Formula, formula};
use super::rows::{Reader, Writer};
use super::spec::{Domain, Hard, Input, Kind, Output, Shape, Spec};
use lightmeter_reference::blend::{Mode, Operands, Saturate, alpha_clamped, blend, without_alpha};
use lightmeter_reference::{Real, Vector};
use lightmeter_scene::blend::{Equation, Factor, State};

/// Numbers that a blend state gives.
pub(super) const OUTPUTS: usize = 4;

const INPUTS: &[Input] = &[Input::rgba("src"), Input::rgba("dst"), Input::rgba("constant")];
const COLOR: &[Output] = &[Output::new("color", Shape::Vec4, "color")];

/// A blend state.
#[derive(Clone, Copy, Debug)]
struct BlendState(State);

impl Formula for BlendState {
    fn spec(&self) -> Spec {
        let state = self.0;
        Spec {
            id: format!("blend/{state}"),
            text: match state.equation {
                Equation::Add => "color = src·S + dst·D",
                Equation::Subtract => "color = src·S − dst·D",
                Equation::ReverseSubtract => "color = dst·D − src·S",
                Equation::Min => "color = min(src, dst), factors ignored",
                Equation::Max => "color = max(src, dst), factors ignored",
            },
            source: "000 §6.6; ruling 1",
            function: "blend_state",
            kind: Kind::Blend(state),
            selectors: vec![state.equation.code(), state.src.code(), state.dst.code()],
            inputs: INPUTS,
            outputs: COLOR,
            fit: None,
            hard: hard(state),
        }
    }

    fn evaluate<R: Real>(&self, x: &mut Reader<'_, R>, out: &mut Writer<'_, R>) {
        let operands = Operands { src: x.vector(), dst: x.vector(), constant: x.vector() };
        out.vector(blend(self.0, &operands, Saturate::SourceAndDestination));
    }
}

fn hard(state: State) -> &'static [Hard] {
    match (state.equation, state.src, state.dst) {
        (Equation::Add, Factor::SrcAlpha, Factor::OneMinusSrcAlpha) => &[
            Hard {
                name: "blue-over-red",
                pins: "document 000's figure",
                inputs: &[("src", &[0.0, 0.0, 1.0, 0.6]), ("dst", &[1.0, 0.0, 0.0, 1.0])],
            },
            Hard {
                name: "red-over-blue",
                pins: "document 002's figure",
                inputs: &[("src", &[1.0, 0.0, 0.0, 0.5]), ("dst", &[0.0, 0.0, 1.0, 1.0])],
            },
        ],
        (Equation::Add, Factor::SrcAlphaSaturate, Factor::One) => &[
            Hard {
                name: "no-room-left",
                pins: "an opaque destination takes nothing",
                inputs: &[("src", &[1.0, 1.0, 1.0, 0.5]), ("dst", &[0.25, 0.25, 0.25, 1.0])],
            },
            Hard {
                name: "alpha-above-one",
                pins: "a float target does not clamp: min(As, 1 − Ad) is negative",
                inputs: &[("src", &[1.0, 1.0, 1.0, 0.5]), ("dst", &[0.25, 0.25, 0.25, 1.5])],
            },
        ],
        (Equation::Subtract, Factor::One, Factor::One) => &[Hard {
            name: "below-zero",
            pins: "a float target does not clamp",
            inputs: &[("src", &[0.25, 0.0, 0.5, 0.0]), ("dst", &[0.75, 1.0, 0.5, 1.0])],
        }],
        _ => &[],
    }
}

formula!(
    /// SRC_ALPHA_SATURATE as document 000 writes it.
    SaturateSourceOnly: "blend/saturate-source-only" by "blend_saturate_source_only",
    "color = src·(min(As, 1 − As), 1) + dst", "000 §6.6, a dialect of ruling 1",
    [Input::rgba("src"), Input::new("dst", Shape::Vec4, "color", Domain::Unit)] ->
    [Output::new("color", Shape::Vec4, "color")],
    |x, out| {
        let operands = Operands { src: x.vector(), dst: x.vector(), constant: Vector::splat(R::literal(0.0)) };
        let state = State { equation: Equation::Add, src: Factor::SrcAlphaSaturate, dst: Factor::One };
        out.vector(blend(state, &operands, Saturate::SourceOnly));
    },
);

macro_rules! mode {
    ($name:ident, $id:literal, $function:literal, $mode:expr, $text:literal $(, hard [$($hard:expr),* $(,)?])?) => {
        formula!(
            /// A named mode on a back buffer without alpha.
            $name: $id by $function, $text, "002",
            [Input::rgba("src"), Input::rgb("dst")] -> [Output::new("color", Shape::Vec3, "color")],
            |x, out| { out.vector(without_alpha($mode, x.vector(), x.vector())); }
            $(, hard [$($hard),*])?
        );
    };
}

mode!(Solid, "blend/mode-solid", "blend_solid", Mode::Solid, "color = src");
mode!(
    Alpha, "blend/mode-alpha", "blend_alpha", Mode::Alpha, "color = src·As + dst·(1 − As)",
    hard [
        Hard { name: "half-red-over-blue", pins: "document 002's figure", inputs: &[("src", &[1.0, 0.0, 0.0, 0.5]), ("dst", &[0.0, 0.0, 1.0])] },
    ]
);
mode!(Mul, "blend/mode-mul", "blend_mul", Mode::Mul, "color = src * dst");
mode!(Add, "blend/mode-add", "blend_additive", Mode::Add, "color = src·As + dst");
formula!(
    /// Source-over as a unorm target has it.
    AlphaClamped: "blend/alpha-clamped" by "blend_alpha_clamped",
    "color = clamp(clamp(src)·As + clamp(dst)·(1 − As)), as on a target of [0, 1]", "000 §6.6",
    [
        Input::new("src", Shape::Vec4, "color", Domain::Uniform(-0.5, 1.5)),
        Input::new("dst", Shape::Vec4, "color", Domain::Uniform(-0.5, 1.5)),
    ] -> [Output::new("color", Shape::Vec4, "color")],
    |x, out| { out.vector(alpha_clamped(x.vector(), x.vector())); },
    hard [
        Hard { name: "alpha-above-one", pins: "1 − As would be negative: clamped before, not after", inputs: &[("src", &[0.5, 0.5, 0.5, 1.5]), ("dst", &[1.0, 1.0, 1.0, 1.0])] },
    ],
);

/// The states that are the same as another and judged under its name, with that name.
pub fn aliases() -> impl Iterator<Item = (String, String)> {
    State::all()
        .filter(|state| *state != state.canonical())
        .map(|state| (format!("blend/{state}"), format!("blend/{}", state.canonical())))
}

pub(super) fn visit(visitor: &mut impl Visitor) {
    for state in State::all().filter(|state| *state == state.canonical()) {
        visitor.formula(BlendState(state));
    }
    visitor.formula(SaturateSourceOnly);
    visitor.formula(Solid);
    visitor.formula(Alpha);
    visitor.formula(Mul);
    visitor.formula(Add);
    visitor.formula(AlphaClamped);
}
