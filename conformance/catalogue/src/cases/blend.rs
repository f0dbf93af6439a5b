//! Cases of blending: every distinct state of the 15 × 15 × 5, states with another one for alpha, the named modes, write
//! masks, buffers without alpha and overlapping layers. Formulas: `lightmeter_reference::blend`.

mod separate;
mod special;
mod written;

pub use super::program::{MOST_LAYERS, Program, UnitCase};
pub use separate::{Samples, covering_array, separate_of};
pub use written::{COMMON, Common, written_state};

use super::Visitor;
use super::formula::{AnyFormula, Formula, bind, formula};
use super::rows::{Reader, Writer, slot};
use super::spec::{Domain, Hard, Input, Kind, Output, Spec, ValueShape};
use lightmeter_reference::blend::{
    Mode, Operands, Saturate, alpha_clamped, blend, blend_separate, layers, masked, opacity_of_layers,
    opacity_of_layers_expm1, over, over_incremental, subtract, subtract_compensated, unpremultiply,
    unpremultiply_guarded, without_alpha,
};
use lightmeter_reference::{Real, Vec3, Vector};
use lightmeter_scene::blend::{Equation, Factor, Separate, State, WriteMask};
use special::SPECIAL;
use std::collections::BTreeSet;

const INPUTS: &[Input] = &[Input::rgba("src"), Input::rgba("dst"), Input::rgba("constant")];
const COLOR: &[Output] = &[Output::new("color", ValueShape::Vec4, "color")];

/// What a blend state takes.
fn operands<R: Real>(x: &Reader<'_, R>) -> Operands<R> {
    bind!(x, INPUTS => src, dst, constant);
    Operands { src, dst, constant }
}

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
            within: None,
            hard: hard(state),
            stable: None,
            is_normalised: false,
        }
    }

    fn evaluate<R: Real>(&self, x: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        let operands = operands(x);
        out.vector(blend(self.0, &operands, Saturate::SourceAndDestination));
    }
}

const OVER: &[Hard] = &[
    Hard::new(
        "blue-over-red",
        "document 000's figure",
        &[("src", &[0.0, 0.0, 1.0, 0.6]), ("dst", &[1.0, 0.0, 0.0, 1.0])],
    ),
    Hard::new(
        "red-over-blue",
        "document 002's figure",
        &[("src", &[1.0, 0.0, 0.0, 0.5]), ("dst", &[0.0, 0.0, 1.0, 1.0])],
    ),
];

const BEYOND: &[Hard] = &[
    Hard::new(
        "both-below-black",
        "the comparison goes on below 0",
        &[("src", &[-0.5, -2.0, -0.25, -0.5]), ("dst", &[-1.5, -0.75, -0.125, -0.75])],
    ),
    Hard::new(
        "both-above-white",
        "the comparison goes on above 1",
        &[("src", &[1.5, 2.0, 1.25, 1.5]), ("dst", &[2.5, 1.75, 1.125, 1.75])],
    ),
];

fn hard(state: State) -> &'static [Hard] {
    match (state.equation, state.src, state.dst) {
        (Equation::Add, Factor::SrcAlpha, Factor::OneMinusSrcAlpha) => OVER,
        (Equation::Add, Factor::SrcAlphaSaturate, Factor::One) => {
            const {
                &[
                    Hard::new(
                        "no-room-left",
                        "an opaque destination takes nothing",
                        &[("src", &[1.0, 1.0, 1.0, 0.5]), ("dst", &[0.25, 0.25, 0.25, 1.0])],
                    ),
                    Hard::new(
                        "alpha-above-one",
                        "a float target does not clamp: min(As, 1 − Ad) is negative",
                        &[("src", &[1.0, 1.0, 1.0, 0.5]), ("dst", &[0.25, 0.25, 0.25, 1.5])],
                    ),
                ]
            }
        }
        (Equation::Add, Factor::One, Factor::One) => {
            const {
                &[Hard::new(
                    "half-overflow",
                    "on binary16 65504 and infinity are both legal",
                    &[("src", &[60_000.0, 60_000.0, -60_000.0, 1.0]), ("dst", &[60_000.0, 1.0, -60_000.0, 1.0])],
                )]
            }
        }
        (Equation::Min | Equation::Max, Factor::One, Factor::One) => BEYOND,
        (Equation::Add, Factor::One, Factor::Zero) => {
            const {
                &[Hard::new(
                    "beyond-half",
                    "a source that binary16 cannot hold",
                    &[("src", &[1e6, -1e6, 65_519.0, 65_504.0]), ("dst", &[0.0, 0.0, 0.0, 0.0])],
                )]
            }
        }
        (Equation::Subtract, Factor::One, Factor::One) => {
            const {
                &[Hard::new(
                    "below-zero",
                    "a float target does not clamp",
                    &[("src", &[0.25, 0.0, 0.5, 0.0]), ("dst", &[0.75, 1.0, 0.5, 1.0])],
                )]
            }
        }
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

    fn evaluate<R: Real>(&self, x: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        let operands = operands(x);
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

    fn evaluate<R: Real>(&self, x: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        let operands = operands(x);
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

    fn evaluate<R: Real>(&self, x: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        let operands = operands(x);
        out.vector(blend(self.0, &operands, Saturate::SourceAndDestination));
    }
}

const OVER_RGB: &[Input] = &[Input::rgba("src"), Input::rgb("dst")];

/// MIN or MAX with factors that are not 1, as arithmetic: pipelines of wgpu refuse such factors.
#[derive(Clone, Copy, Debug)]
struct FactorsIgnored(Equation);

impl Formula for FactorsIgnored {
    fn spec(&self) -> Spec {
        let equation = self.0;
        let text = match equation {
            Equation::Min => "color = min(src, dst), with the factors S = constant and D = 1",
            _ => "color = max(src, dst), with the factors S = constant and D = 1",
        };
        Spec {
            id: format!("blend/{}-factors-ignored", equation.name()),
            text,
            source: "000 §6.6; ruling 1",
            function: "blend_state",
            selectors: vec![equation.code(), Factor::ConstantColor.code(), Factor::One.code()],
            ..unit_spec()
        }
    }

    fn evaluate<R: Real>(&self, x: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        let state = State { equation: self.0, src: Factor::ConstantColor, dst: Factor::One };
        out.vector(blend(state, &operands(x), Saturate::SourceAndDestination));
    }
}

/// A factor of the destination's alpha, where there is none.
#[derive(Clone, Copy, Debug)]
struct AlphaReadsAsOne(State);

impl Formula for AlphaReadsAsOne {
    fn spec(&self) -> Spec {
        const OUTPUTS: &[Output] = &[Output::new("color", ValueShape::Vec3, "color")];
        Spec {
            id: format!("blend/without-alpha/{}", self.0.segment()),
            text: "color = src·S + dst·D, where Ad reads as 1",
            kind: Kind::Blend(Program::WithoutAlpha(self.0)),
            inputs: OVER_RGB,
            outputs: OUTPUTS,
            ..unit_spec()
        }
    }

    fn evaluate<R: Real>(&self, x: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        bind!(x, OVER_RGB => src, dst);
        let opaque: Vec3<R> = dst;
        let operands = Operands { src, dst: opaque.extend(R::literal(1.0)), constant: Vector::splat(R::literal(0.0)) };
        out.vector(blend(self.0, &operands, Saturate::SourceAndDestination).xyz());
    }
}

const LAYER_INPUTS: &[Input] = &[
    Input::rgba("dst"),
    Input::scalar("count", "1", Domain::Whole(1, 16)),
    Input::rgba("src-1"),
    Input::rgba("src-2"),
    Input::rgba("src-3"),
    Input::rgba("src-4"),
    Input::rgba("src-5"),
    Input::rgba("src-6"),
    Input::rgba("src-7"),
    Input::rgba("src-8"),
    Input::rgba("src-9"),
    Input::rgba("src-10"),
    Input::rgba("src-11"),
    Input::rgba("src-12"),
    Input::rgba("src-13"),
    Input::rgba("src-14"),
    Input::rgba("src-15"),
    Input::rgba("src-16"),
];

/// Overlapping draws.
#[derive(Clone, Copy, Debug)]
struct Layered(&'static str, &'static [Mode]);

impl Formula for Layered {
    fn spec(&self) -> Spec {
        Spec {
            id: format!("blend/layers/{}", self.0),
            text: "color = srcₙ over … over src₁ over dst, the modes in turn",
            source: "002",
            kind: Kind::Blend(Program::Layers(self.1)),
            inputs: LAYER_INPUTS,
            ..unit_spec()
        }
    }

    fn evaluate<R: Real>(&self, x: &Reader<'_, R>, out: &mut Writer<'_, R>) {
        bind!(x, LAYER_INPUTS => dst, count);
        let sources = x.at(const { slot(LAYER_INPUTS, "src-1").through(slot(LAYER_INPUTS, "src-16")) });
        out.vector(layers::<R, MOST_LAYERS>(self.1, count, sources, dst));
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
        within: None,
        hard: &[],
        stable: None,
        is_normalised: false,
    }
}

formula!(
    /// SRC_ALPHA_SATURATE as document 000 writes it.
    SaturateSourceOnly: "blend/saturate-source-only" by "blend_saturate_source_only",
    "color = src·(min(As, 1 − As), 1) + dst", "000 §6.6, a dialect of ruling 1",
    [Input::rgba("src"), Input::new("dst", ValueShape::Vec4, "color", Domain::Unit)] ->
    [Output::new("color", ValueShape::Vec4, "color")],
    |src, dst; out| {
        let operands = Operands { src, dst, constant: Vector::splat(R::literal(0.0)) };
        let state = State { equation: Equation::Add, src: Factor::SrcAlphaSaturate, dst: Factor::One };
        out.vector(blend(state, &operands, Saturate::SourceOnly));
    },
);

macro_rules! mode {
    ($name:ident, $id:literal, $function:literal, $mode:expr, $text:literal $(, hard [$($hard:expr),* $(,)?])?) => {
        formula!(
            /// A named mode on a back buffer without alpha.
            $name: $id by $function, $text, "002",
            [Input::rgba("src"), Input::rgb("dst")] -> [Output::new("color", ValueShape::Vec3, "color")],
            kind Kind::Blend(Program::WithoutAlpha($mode.state())),
            |src, dst; out| { out.vector(without_alpha($mode, src, dst)); }
            $(, hard [$($hard),*])?
        );
    };
}

mode!(Solid, "blend/mode-solid", "blend_solid", Mode::Solid, "color = src");
mode!(
    Alpha, "blend/mode-alpha", "blend_alpha", Mode::Alpha, "color = src·As + dst·(1 − As)",
    hard [
        Hard::new("half-red-over-blue", "document 002's figure", &[("src", &[1.0, 0.0, 0.0, 0.5]), ("dst", &[0.0, 0.0, 1.0])]),
        Hard::new("transparent-over-dark", "a source of alpha 0 changes nothing, to the last bit", &[("src", &[1.0, 0.85, 0.6, 0.0]), ("dst", &[0.006, 0.0012, 0.000_3])]),
        Hard::new("alpha-above-one", "alpha is not clamped", &[("src", &[1.0, 0.5, 0.25, 1.5]), ("dst", &[1.0, 0.5, 0.25])]),
        Hard::new("alpha-below-zero", "alpha is not clamped", &[("src", &[1.0, 0.5, 0.25, -0.5]), ("dst", &[1.0, 0.75, 0.25])]),
        Hard::new("dark-over-bright", "an almost opaque source, darker by ½: dst·As is far greater than the result", &[("src", &[0.007_812_5, 0.015_625, 0.031_25, 0.99]), ("dst", &[0.507_812_5, 0.515_625, 0.531_25])]),
    ]
);
mode!(Mul, "blend/mode-mul", "blend_mul", Mode::Mul, "color = src * dst");
mode!(Add, "blend/mode-add", "blend_additive", Mode::Add, "color = src·As + dst");
formula!(
    /// Source-over as a unorm target has it.
    AlphaClamped: "blend/alpha-clamped" by "blend_alpha_clamped",
    "color = clamp(clamp(src)·As + clamp(dst)·(1 − As)), as on a target of [0, 1]", "000 §6.6",
    [
        Input::new("src", ValueShape::Vec4, "color", Domain::Uniform(-0.5, 1.5)),
        Input::new("dst", ValueShape::Vec4, "color", Domain::Uniform(-0.5, 1.5)),
    ] -> [Output::new("color", ValueShape::Vec4, "color")],
    |src, dst; out| { out.vector(alpha_clamped(src, dst)); },
    hard [
        Hard::new("alpha-above-one", "1 − As would be negative: clamped before, not after", &[("src", &[0.5, 0.5, 0.5, 1.5]), ("dst", &[1.0, 1.0, 1.0, 1.0])]),
    ],
);

/// The states that are the same as another and judged under its name, with that name.
pub fn aliases() -> impl Iterator<Item = (String, String)> {
    State::all()
        .filter(|state| *state != state.canonical())
        .map(|state| (format!("blend/{state}"), format!("blend/{}", state.canonical())))
}

const BRIGHT: Input = Input::rgb("dst");
const RGB: Output = Output::new("color", ValueShape::Vec3, "color");
const SHOWN: Output = Output::new("opacity", ValueShape::Scalar, "1");
const LAYER_ALPHA: Input = Input::scalar("alpha", "color", Domain::Uniform(0.01, 0.9));
const LAYER_COUNT: Input = Input::scalar("layers", "1", Domain::Whole(1, 16));

formula!(
    /// Source-over as arithmetic.
    Over: "blend/over" by "blend_over",
    "color = src·As + dst(1 − As)", "000 §6.6, 002",
    [Input::rgba("src"), BRIGHT] -> [RGB],
    stable 4.0 Own "two products and a sum of one sign",
    |src, dst; out| { out.vector(over(src, dst)); },
    hard [
        Hard::new("alpha-above-one-over", "alpha is not clamped", &[("src", &[1.0, 0.5, 0.25, 1.5]), ("dst", &[1.0, 0.5, 0.25])]),
        Hard::new("opaque-over-1e8", "all of an opaque source, over the brightest light", &[("src", &[0.3, 0.5, 0.7, 1.0]), ("dst", &[1e8, 1e8, 1e8])])
            .naive("blend/over-incremental", "src − dst has lost src", 1e6),
        Hard::new("opaque-over-1e4", "all of an opaque source, over the sun", &[("src", &[0.3, 0.5, 0.7, 1.0]), ("dst", &[1e4, 2e4, 3e4])])
            .naive("blend/over-incremental", "src − dst has lost 14 bits of src", 100.0),
    ],
);
formula!(
    /// Source-over by a difference.
    OverIncremental: "blend/over-incremental" by "blend_over_incremental",
    "color = dst + As(src − dst)", "a shortcut",
    [Input::rgba("src"), BRIGHT] -> [RGB],
    |src, dst; out| { out.vector(over_incremental(src, dst)); },
    hard [
        Hard::new("alpha-above-one", "alpha is not clamped", &[("src", &[1.0, 0.5, 0.25, 1.5]), ("dst", &[0.0, 0.0, 0.0])]),
    ],
);
formula!(
    /// What many layers hide.
    OpacityOfLayers: "blend/opacity-of-layers" by "blend_opacity_of_layers",
    "opacity = 1 − (1 − α)ⁿ", "002, of n layers",
    [LAYER_ALPHA, LAYER_COUNT] -> [SHOWN],
    |alpha, layers; out| { out.scalar(opacity_of_layers(alpha, layers)); },
    hard [
        Hard::new("two-of-almost-opaque", "1 − 0.05²", &[("alpha", &[0.95]), ("layers", &[2.0])]),
    ],
);
formula!(
    /// What many layers hide, however thin.
    OpacityOfLayersExpm1: "blend/opacity-of-layers-expm1" by "blend_opacity_of_layers_expm1",
    "opacity = −expm1(n·ln(1 − α)), short series for small ones", "002, of n layers",
    [LAYER_ALPHA, LAYER_COUNT] -> [SHOWN],
    stable 104.0 Own "two series summed in any order, 34 and 66, and a product; beyond 1/16, log's 2⁻²¹ of at least 0.06",
    |alpha, layers; out| { out.scalar(opacity_of_layers_expm1(alpha, layers)); },
    hard [
        Hard::new("one-of-1e-8", "a layer thinner than a rounding of 1", &[("alpha", &[1e-8]), ("layers", &[1.0])])
            .naive("blend/opacity-of-layers", "1 − α is 1", 1e6),
        Hard::new("a-hundred-of-1e-7", "thin layers add up", &[("alpha", &[1.3e-7]), ("layers", &[100.0])])
            .naive("blend/opacity-of-layers", "1 − α has one bit of α", 1e5),
        Hard::new("ten-of-1e-4", "thin layers add up", &[("alpha", &[1.1e-4]), ("layers", &[10.0])])
            .naive("blend/opacity-of-layers", "1 − α has lost 13 bits of α", 300.0),
        Hard::new("a-million-of-1e-6", "thin layers add up to most of it", &[("alpha", &[1.1e-6]), ("layers", &[1e6])])
            .naive("blend/opacity-of-layers", "what 1 − α has lost, a million times", 1e4),
    ],
);
formula!(
    /// Straight alpha from premultiplied.
    Unpremultiply: "blend/unpremultiply" by "blend_unpremultiply",
    "color/α", "a shortcut",
    [Input::rgb("color"), Input::scalar("alpha", "color", Domain::Uniform(0.01, 1.0))] -> [RGB],
    |color, alpha; out| { out.vector(unpremultiply(color, alpha)); },
    hard [
        Hard::new("hardly-there", "an alpha of 1e-5 divides like any other", &[("color", &[0.5, 0.25, 0.125]), ("alpha", &[1e-5])]),
    ],
);
formula!(
    /// Straight alpha from premultiplied, where nothing is there too.
    UnpremultiplyGuarded: "blend/unpremultiply-guarded" by "blend_unpremultiply_guarded",
    "color/α, and 0 for α < 2⁻¹²⁶", "000 §6.6 undone",
    [Input::rgb("color"), Input::scalar("alpha", "color", Domain::Uniform(0.01, 1.0))] -> [RGB],
    stable 6.0 Own "a division of at most 2½ ULP",
    |color, alpha; out| { out.vector(unpremultiply_guarded(color, alpha)); },
    hard [
        Hard::new("nothing", "0/0 is no colour", &[("color", &[0.0, 0.0, 0.0]), ("alpha", &[0.0])])
            .naive("blend/unpremultiply", "NaN, which spreads through every blur", f64::INFINITY),
        Hard::new("glow", "light without cover: nothing straight alpha could hold", &[("color", &[0.5, 0.25, 0.125]), ("alpha", &[0.0])])
            .naive("blend/unpremultiply", "∞", f64::INFINITY),
    ],
);
formula!(
    /// The subtraction of two products.
    SubtractProducts: "blend/subtract-products" by "blend_subtract",
    "src·S − dst·D", "000 §6.6, FUNC_SUBTRACT",
    [Input::scalar("src", "color", Domain::Unit), Input::scalar("s", "1", Domain::Unit), Input::scalar("dst", "color", Domain::Unit), Input::scalar("d", "1", Domain::Unit)] -> [Output::new("color", ValueShape::Scalar, "color")],
    |src, s, dst, d; out| { out.scalar(subtract(src, s, dst, d)); },
);
formula!(
    /// The subtraction of two products that nearly cancel.
    SubtractCompensated: "blend/subtract-compensated" by "blend_subtract_compensated",
    "src·S − dst·D, a difference of products with their errors", "Cornea, Harrison & Tang 2002",
    [Input::scalar("src", "color", Domain::Unit), Input::scalar("s", "1", Domain::Unit), Input::scalar("dst", "color", Domain::Unit), Input::scalar("d", "1", Domain::Unit)] -> [Output::new("color", ValueShape::Scalar, "color")],
    stable 2.0 Own "2 roundings (Cornea, Harrison & Tang)",
    |src, s, dst, d; out| { out.scalar(subtract_compensated(src, s, dst, d)); },
    hard [
        Hard::new("the-same-but-a-bit", "products that agree to the last bits", &[("src", &[0.3]), ("s", &[0.7]), ("dst", &[0.6]), ("d", &[0.350_000_03])])
            .naive("blend/subtract-products", "not one digit is right", 1e5),
        Hard::new("the-same-to-5-digits", "products that agree to 5 digits", &[("src", &[0.3]), ("s", &[0.7]), ("dst", &[0.6]), ("d", &[0.350_003])])
            .naive("blend/subtract-products", "the rounding of the products is what is left", 1e3),
    ],
);

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
    for equation in Equation::ALL.into_iter().filter(|equation| equation.ignores_factors()) {
        visitor.formula(FactorsIgnored(equation));
    }
    for layers in LAYERS {
        visitor.formula(layers);
    }
    for (state, hard) in SPECIAL {
        visitor.formula(SpecialValues(*state, hard));
    }
    visitor.formula(Over);
    visitor.formula(OverIncremental);
    visitor.formula(OpacityOfLayers);
    visitor.formula(OpacityOfLayersExpm1);
    visitor.formula(Unpremultiply);
    visitor.formula(UnpremultiplyGuarded);
    visitor.formula(SubtractProducts);
    visitor.formula(SubtractCompensated);
}

/// Each of the 1,125 states as a formula, those that ignore their factors too.
#[must_use]
pub fn every_state() -> Vec<Box<dyn AnyFormula>> {
    State::all().map(|state| Box::new(BlendState(state)) as Box<dyn AnyFormula>).collect()
}

/// The states that are the same as another, as formulas under their own names: for subjects whose interface can tell the names apart.
#[must_use]
pub fn alias_formulas() -> Vec<Box<dyn AnyFormula>> {
    let aliases = State::all().filter(|state| *state != state.canonical());
    aliases.map(|state| Box::new(BlendState(state)) as Box<dyn AnyFormula>).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_all_there_in_4096_pairs() {
        let spec = Formula::spec(&BlendState(Mode::Alpha.state()));
        let (drawing, mut corners) = (super::super::Drawing::new(&spec, 1), BTreeSet::new());
        let mut row = vec![];
        for k in 0..4096 {
            row.clear();
            drawing.inputs(k, &mut row);
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
