//! Cases of blending: every distinct state of the 15 × 15 × 5, states with another one for alpha, the named modes, write
//! masks, buffers without alpha and overlapping layers. Formulas: `lightmeter_reference::blend`.

use super::Visitor;
use super::formula::{AnyFormula, Formula, formula};
use super::rows::{Reader, Writer};
use super::spec::{Domain, Hard, Input, Kind, Output, Shape, Spec};
use lightmeter_reference::blend::{
    Mode, Operands, Saturate, alpha_clamped, blend, blend_separate, layers, masked, without_alpha,
};
use lightmeter_reference::{Real, Vector};
use lightmeter_scene::blend::{Equation, Factor, Separate, State, WriteMask};
use std::collections::BTreeSet;

/// The most draws that overlap in a case.
pub const MOST_LAYERS: usize = 16;

/// What the blend unit draws for a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Program {
    /// One draw. Inputs: source, destination, constant.
    Draw(Separate, WriteMask),
    /// One draw of NaN or infinity, which float targets alone can hold. Inputs: source, destination, constant.
    Special(State),
    /// One draw on a back buffer without alpha, which reads as 1: alpha begins as 1 and is not written. Inputs: source,
    /// destination's colour.
    WithoutAlpha(State),
    /// Up to 16 draws that overlap, in order, the modes in turn. Inputs: destination, count, 16 sources.
    Layers(&'static [Mode]),
}

/// A case as the blend unit is given it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitCase {
    /// The source of each draw.
    pub sources: [[f32; 4]; MOST_LAYERS],
    /// How many draws.
    pub layers: usize,
    /// What is there before.
    pub dst: [f32; 4],
    /// The blend constant.
    pub constant: [f32; 4],
}

impl Program {
    /// The state and the write mask of a layer.
    #[must_use]
    pub fn layer(self, number: usize) -> (Separate, WriteMask) {
        match self {
            Self::Draw(state, mask) => (state, mask),
            Self::Special(state) => (state.into(), WriteMask::ALL),
            Self::WithoutAlpha(state) => (state.into(), WriteMask::COLOR),
            Self::Layers(modes) => (modes[number % modes.len()].state().into(), WriteMask::ALL),
        }
    }

    /// Whether only float targets are drawn on.
    #[must_use]
    pub const fn is_special(self) -> bool {
        matches!(self, Self::Special(_))
    }

    /// A row of inputs as the unit is given it.
    ///
    /// # Panics
    /// Where the row has fewer numbers than the program's inputs.
    #[must_use]
    pub fn case(self, row: &[f32]) -> UnitCase {
        let color = |at: usize| [row[at], row[at + 1], row[at + 2], row[at + 3]];
        let mut case = UnitCase { sources: [[0.0; 4]; MOST_LAYERS], layers: 1, dst: [0.0; 4], constant: [0.0; 4] };
        match self {
            Self::Draw(..) | Self::Special(_) => {
                case.sources[0] = color(0);
                case.dst = color(4);
                case.constant = color(8);
            }
            Self::WithoutAlpha(_) => {
                case.sources[0] = color(0);
                case.dst = [row[4], row[5], row[6], 1.0];
            }
            Self::Layers(_) => {
                case.dst = color(0);
                case.layers = (1..=MOST_LAYERS).rev().find(|&n| row[4] >= layer_count(n)).unwrap_or(1);
                for (number, source) in case.sources.iter_mut().enumerate() {
                    *source = color(5 + 4 * number);
                }
            }
        }
        case
    }
}

#[expect(clippy::cast_precision_loss, reason = "at most 16")]
const fn layer_count(n: usize) -> f32 {
    n as f32
}

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
            kind: Kind::Blend(Program::Draw(state.into(), WriteMask::ALL)),
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
        (Equation::Add, Factor::One, Factor::One) => &[Hard {
            name: "half-overflow",
            pins: "on binary16 65504 and infinity are both legal",
            inputs: &[("src", &[60_000.0, 60_000.0, -60_000.0, 1.0]), ("dst", &[60_000.0, 1.0, -60_000.0, 1.0])],
        }],
        (Equation::Add, Factor::One, Factor::Zero) => &[Hard {
            name: "beyond-half",
            pins: "a source that binary16 cannot hold",
            inputs: &[("src", &[1e6, -1e6, 65_519.0, 65_504.0]), ("dst", &[0.0, 0.0, 0.0, 0.0])],
        }],
        (Equation::Subtract, Factor::One, Factor::One) => &[Hard {
            name: "below-zero",
            pins: "a float target does not clamp",
            inputs: &[("src", &[0.25, 0.0, 0.5, 0.0]), ("dst", &[0.75, 1.0, 0.5, 1.0])],
        }],
        _ => &[],
    }
}

/// One state for the colour and one for the alpha.
#[derive(Clone, Copy, Debug)]
struct SeparateState(Separate);

impl Formula for SeparateState {
    fn spec(&self) -> Spec {
        Spec {
            id: format!("blend/separate/{}", self.0),
            text: "color.rgb by one state, color.a by another",
            kind: Kind::Blend(Program::Draw(self.0, WriteMask::ALL)),
            ..unit_spec()
        }
    }

    fn evaluate<R: Real>(&self, x: &mut Reader<'_, R>, out: &mut Writer<'_, R>) {
        let operands = Operands { src: x.vector(), dst: x.vector(), constant: x.vector() };
        out.vector(blend_separate(self.0, &operands, Saturate::SourceAndDestination));
    }
}

/// Source-over that writes some components.
#[derive(Clone, Copy, Debug)]
struct Masked(WriteMask);

impl Formula for Masked {
    fn spec(&self) -> Spec {
        Spec {
            id: format!("blend/write-mask/{}", self.0),
            text: "color = src·As + dst·(1 − As) where it is written, dst elsewhere",
            kind: Kind::Blend(Program::Draw(Mode::Alpha.state().into(), self.0)),
            ..unit_spec()
        }
    }

    fn evaluate<R: Real>(&self, x: &mut Reader<'_, R>, out: &mut Writer<'_, R>) {
        let operands = Operands { src: x.vector(), dst: x.vector(), constant: x.vector() };
        let written = blend(Mode::Alpha.state(), &operands, Saturate::SourceAndDestination);
        out.vector(masked(self.0, written, operands.dst));
    }
}

/// NaN and infinity in a state.
#[derive(Clone, Copy, Debug)]
struct SpecialValues(State, &'static [Hard]);

impl Formula for SpecialValues {
    fn spec(&self) -> Spec {
        Spec {
            id: format!("blend/special/{}", self.0.segment()),
            text: "NaN and infinity on float targets, of which nothing is promised",
            kind: Kind::Blend(Program::Special(self.0)),
            hard: self.1,
            ..unit_spec()
        }
    }

    fn evaluate<R: Real>(&self, x: &mut Reader<'_, R>, out: &mut Writer<'_, R>) {
        let operands = Operands { src: x.vector(), dst: x.vector(), constant: x.vector() };
        out.vector(blend(self.0, &operands, Saturate::SourceAndDestination));
    }
}

/// A factor of the destination's alpha, where there is none.
#[derive(Clone, Copy, Debug)]
struct AlphaReadsAsOne(State);

impl Formula for AlphaReadsAsOne {
    fn spec(&self) -> Spec {
        const INPUTS: &[Input] = &[Input::rgba("src"), Input::rgb("dst")];
        const OUTPUTS: &[Output] = &[Output::new("color", Shape::Vec3, "color")];
        Spec {
            id: format!("blend/without-alpha/{}", self.0.segment()),
            text: "color = src·S + dst·D, where Ad reads as 1",
            kind: Kind::Blend(Program::WithoutAlpha(self.0)),
            inputs: INPUTS,
            outputs: OUTPUTS,
            ..unit_spec()
        }
    }

    fn evaluate<R: Real>(&self, x: &mut Reader<'_, R>, out: &mut Writer<'_, R>) {
        let (src, dst) = (x.vector(), x.vector::<3>().extend(R::literal(1.0)));
        let operands = Operands { src, dst, constant: Vector::splat(R::literal(0.0)) };
        out.vector(blend(self.0, &operands, Saturate::SourceAndDestination).xyz());
    }
}

/// Overlapping draws.
#[derive(Clone, Copy, Debug)]
struct Layered(&'static str, &'static [Mode]);

impl Formula for Layered {
    fn spec(&self) -> Spec {
        const fn layer(name: &'static str) -> Input {
            Input::rgba(name)
        }
        const INPUTS: &[Input] = &[
            Input::rgba("dst"),
            Input::scalar("count", "1", Domain::Whole(1, 16)),
            layer("src-1"),
            layer("src-2"),
            layer("src-3"),
            layer("src-4"),
            layer("src-5"),
            layer("src-6"),
            layer("src-7"),
            layer("src-8"),
            layer("src-9"),
            layer("src-10"),
            layer("src-11"),
            layer("src-12"),
            layer("src-13"),
            layer("src-14"),
            layer("src-15"),
            layer("src-16"),
        ];
        Spec {
            id: format!("blend/layers/{}", self.0),
            text: "color = srcₙ over … over src₁ over dst, the modes in turn",
            source: "002",
            kind: Kind::Blend(Program::Layers(self.1)),
            inputs: INPUTS,
            ..unit_spec()
        }
    }

    fn evaluate<R: Real>(&self, x: &mut Reader<'_, R>, out: &mut Writer<'_, R>) {
        let (dst, count) = (x.vector(), x.scalar());
        out.vector(layers::<R, MOST_LAYERS>(self.1, count, x.vectors(), dst));
    }
}

/// One mode, whose layers overlap within a draw, and several, which overlap from draw to draw.
const LAYERS: [Layered; 2] = [Layered("alpha", &[Mode::Alpha]), Layered("mixed", &[Mode::Alpha, Mode::Mul, Mode::Add])];

/// What formulas that only the unit evaluates have in common.
fn unit_spec() -> Spec {
    Spec {
        id: String::new(),
        text: "",
        source: "000 §6.6",
        function: "",
        kind: Kind::Arithmetic,
        selectors: vec![],
        inputs: INPUTS,
        outputs: COLOR,
        fit: None,
        hard: &[],
    }
}

const INF: f32 = f32::INFINITY;
const NAN: f32 = f32::NAN;

macro_rules! special {
    ($name:literal, $pins:literal, $src:expr, $dst:expr) => {
        Hard { name: $name, pins: $pins, inputs: &[("src", &$src), ("dst", &$dst)] }
    };
}

/// NaN and infinity by state. Red, green and blue are alike where nothing else is said.
const SPECIAL: &[(State, &[Hard])] = &[
    (
        State { equation: Equation::Add, src: Factor::Zero, dst: Factor::One },
        &[
            special!("nan-source-times-zero", "0·NaN", [NAN, NAN, NAN, 0.5], [0.25; 4]),
            special!("infinite-source-times-zero", "0·∞", [INF, INF, INF, 0.5], [0.25; 4]),
        ],
    ),
    (
        State { equation: Equation::Add, src: Factor::One, dst: Factor::Zero },
        &[
            special!("nan-destination-times-zero", "NaN·0", [0.25; 4], [NAN, NAN, NAN, 0.5]),
            special!("infinite-destination-times-zero", "∞·0", [0.25; 4], [INF, INF, INF, 0.5]),
            special!("nan-source", "NaN is stored", [NAN, NAN, NAN, 0.5], [0.25; 4]),
            special!("infinite-source", "∞ is stored", [INF, INF, INF, 0.5], [0.25; 4]),
            special!("negative-infinite-source", "−∞ is stored", [-INF, -INF, -INF, 0.5], [0.25; 4]),
        ],
    ),
    (
        State { equation: Equation::Add, src: Factor::One, dst: Factor::One },
        &[
            special!("infinities-of-both-signs", "∞ + −∞", [INF, INF, INF, 0.5], [-INF, -INF, -INF, 0.5]),
            special!("nan-plus-number", "NaN + 0.25", [NAN, NAN, NAN, 0.5], [0.25; 4]),
        ],
    ),
    (
        State { equation: Equation::Subtract, src: Factor::One, dst: Factor::One },
        &[special!("infinity-minus-infinity", "∞ − ∞", [INF, INF, INF, 0.5], [INF, INF, INF, 0.5])],
    ),
    (
        State { equation: Equation::Add, src: Factor::SrcAlpha, dst: Factor::OneMinusSrcAlpha },
        &[
            special!("opaque-over-infinity", "∞·(1 − 1)", [0.25, 0.25, 0.25, 1.0], [INF, INF, INF, 0.5]),
            special!("transparent-nan", "NaN·0 by a factor that is not constant", [NAN, NAN, NAN, 0.0], [0.25; 4]),
        ],
    ),
    (
        State { equation: Equation::Min, src: Factor::One, dst: Factor::One },
        &[
            special!("min-of-nan-source", "min(NaN, 0.25)", [NAN, NAN, NAN, 0.5], [0.25; 4]),
            special!("min-of-nan-destination", "min(0.25, NaN)", [0.25; 4], [NAN, NAN, NAN, 0.5]),
            special!("min-of-infinity", "min(∞, 0.25)", [INF, INF, INF, 0.5], [0.25; 4]),
        ],
    ),
    (
        State { equation: Equation::Max, src: Factor::One, dst: Factor::One },
        &[
            special!("max-of-nan-source", "max(NaN, 0.25)", [NAN, NAN, NAN, 0.5], [0.25; 4]),
            special!("max-of-nan-destination", "max(0.25, NaN)", [0.25; 4], [NAN, NAN, NAN, 0.5]),
            special!("max-of-infinity", "max(∞, 0.25)", [INF, INF, INF, 0.5], [0.25; 4]),
        ],
    ),
];

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
            kind Kind::Blend(Program::WithoutAlpha($mode.state())),
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
    for mask in WriteMask::each() {
        visitor.formula(Masked(mask));
    }
    for factor in [Factor::DstAlpha, Factor::OneMinusDstAlpha, Factor::SrcAlphaSaturate] {
        let state = |src, dst| State { equation: Equation::Add, src, dst };
        visitor.formula(AlphaReadsAsOne(state(factor, Factor::One)));
        visitor.formula(AlphaReadsAsOne(state(Factor::One, factor)));
    }
    for layers in LAYERS {
        visitor.formula(layers);
    }
    for (state, hard) in SPECIAL {
        visitor.formula(SpecialValues(*state, hard));
    }
}

/// Which states with another one for alpha are judged, besides the covering array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Samples {
    /// The seed that they are drawn by.
    pub seed: u64,
    /// How many of the (15 × 15 × 5)².
    pub count: u64,
    /// Some by name.
    pub named: Vec<Separate>,
}

impl Default for Samples {
    fn default() -> Self {
        Self { seed: 1, count: 256, named: vec![] }
    }
}

/// The states that an id below `blend/separate` names.
#[must_use]
pub fn separate_of(id: &str) -> Option<Separate> {
    let mut segments = id.strip_prefix("blend/separate/")?.split('/');
    let color = State::from_segment(segments.next()?)?;
    let alpha = State::from_segment(segments.next()?)?;
    Some(Separate { color, alpha })
}

/// Each of the 1,125 states as a formula, those that ignore their factors too.
#[must_use]
pub fn every_state() -> Vec<Box<dyn AnyFormula>> {
    State::all().map(|state| Box::new(BlendState(state)) as Box<dyn AnyFormula>).collect()
}

/// A state with another one for alpha as a formula.
#[must_use]
pub fn separate_formula(state: Separate) -> Box<dyn AnyFormula> {
    Box::new(SeparateState(state.canonical()))
}

pub(super) fn visit_separate(samples: &Samples, visitor: &mut impl Visitor) {
    let drawn = super::draw::separate_states(samples.seed, samples.count);
    let mut seen = BTreeSet::new();
    for state in covering_array().into_iter().chain(drawn).chain(samples.named.iter().copied()) {
        if seen.insert(state.canonical()) {
            visitor.formula(SeparateState(state.canonical()));
        }
    }
}

/// States of which every pair of values of two of the six parameters (two factors and an equation for the colour, the same
/// for the alpha) stands in some row *where neither is ignored*.
///
/// 225 rows hold the factors as an orthogonal array of strength 2: over i, j in ℤ/15 the columns i, j, i + j and i + 2j, of
/// which any two determine i and j, so that every pair of factors stands in exactly one row. Their equations read the
/// factors. 60 rows put MIN and MAX on one side and every factor on the other, 4 on both sides.
#[must_use]
pub fn covering_array() -> Vec<Separate> {
    let factor = |n: usize| Factor::ALL[n % 15];
    let (reading, ignoring) =
        ([Equation::Add, Equation::Subtract, Equation::ReverseSubtract], [Equation::Min, Equation::Max]);
    let state = |equation, src, dst| State { equation, src, dst };
    let mut rows = vec![];
    for (i, j) in (0..15).flat_map(|i| (0..15).map(move |j| (i, j))) {
        rows.push(Separate {
            color: state(reading[(i + j / 3) % 3], factor(i), factor(j)),
            alpha: state(reading[(i / 3 + j) % 3], factor(i + j), factor(i + 2 * j)),
        });
    }
    for equation in ignoring {
        let ignores = state(equation, Factor::One, Factor::One);
        for i in 0..15 {
            let reads = state(reading[i % 3], factor(i), factor(i + 1));
            rows.push(Separate { color: ignores, alpha: reads });
            rows.push(Separate { color: reads, alpha: ignores });
        }
        rows.extend(ignoring.map(|other| Separate { color: ignores, alpha: state(other, Factor::One, Factor::One) }));
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The six parameters, and which of them are ignored.
    fn parameters(state: Separate) -> [(u32, bool); 6] {
        let of = |state: State| {
            let ignored = state.equation.ignores_factors();
            [(state.equation.code(), false), (state.src.code(), ignored), (state.dst.code(), ignored)]
        };
        let ([a, b, c], [d, e, f]) = (of(state.color), of(state.alpha));
        [a, b, c, d, e, f]
    }

    #[test]
    fn every_pair_of_parameters_takes_effect_in_some_row() {
        let rows: Vec<_> = covering_array().into_iter().map(parameters).collect();
        assert_eq!(rows.len(), 225 + 60 + 4);
        let levels = [5, 15, 15, 5, 15, 15];
        for (p, q) in (0..6).flat_map(|p| (p + 1..6).map(move |q| (p, q))) {
            let mut seen = BTreeSet::new();
            for row in &rows {
                if !row[p].1 && !row[q].1 {
                    seen.insert((row[p].0, row[q].0));
                }
            }
            // A factor beside its own side's MIN or MAX is ignored, so those pairs have no effect to cover.
            let same_side = p / 3 == q / 3 && p % 3 == 0;
            let wanted = if same_side { 3 * 15 } else { levels[p] * levels[q] };
            assert_eq!(seen.len(), wanted, "parameters {p} and {q}");
        }
    }

    #[test]
    fn corners_are_all_there_in_4096_pairs() {
        let spec = Formula::spec(&BlendState(Mode::Alpha.state()));
        let mut corners = BTreeSet::new();
        let mut row = vec![];
        for k in 0..4096 {
            row.clear();
            super::super::inputs(&spec, 1, k, &mut row);
            for c in 0..3 {
                corners.insert([row[c], row[3], row[4 + c], row[7]].map(f32::to_bits));
            }
        }
        let values =
            [0.0, 1.0, 0.5, 1.0 / 255.0, 254.0 / 255.0, 1.0_f32.next_down(), 1.0_f32.next_up()].map(f32::to_bits);
        for [a, b] in values.iter().flat_map(|a| values.iter().map(move |b| [*a, *b])) {
            for [c, d] in values.iter().flat_map(|c| values.iter().map(move |d| [*c, *d])) {
                assert!(corners.contains(&[a, b, c, d]), "{a:x} {b:x} {c:x} {d:x}");
            }
        }
    }
}
