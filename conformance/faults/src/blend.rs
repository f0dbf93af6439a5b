//! Blending with mistakes: the state that is drawn with is another one, or an operand is.

use super::change::{After, Before};
use super::row::{InputRow, put};
use lightmeter_catalogue::cases::blend::{MOST_LAYERS, Program};
use lightmeter_catalogue::cases::{Domain, Input, Kind, Spec};
use lightmeter_reference::blend::{Mode, Operands, Saturate, blend, masked};
use lightmeter_reference::{Real, Vec4, Vector};
use lightmeter_scene::blend::{Equation, Factor, Separate, State, WriteMask};

/// A step that goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Twist {
    /// The factors exchanged.
    FactorsExchanged,
    /// Source less destination for destination less source, and the reverse.
    OperandsReversed,
    /// A subtraction taken for an addition.
    AlwaysAdd,
    /// MIN for MAX, and the reverse.
    MinForMax,
    /// The constant's alpha for its colour.
    ConstantAlphaForColor,
    /// The constant's colour for its alpha.
    ConstantColorForAlpha,
    /// 1 − forgotten in the destination's factor.
    OneMinusForgotten,
    /// 1 − forgotten in the source's factor.
    OneMinusForgottenInSource,
    /// Source for destination in what a factor reads.
    SourceForDestination,
    /// Destination for source.
    DestinationForSource,
    /// Alpha for colour.
    AlphaForColor,
    /// Colour for alpha.
    ColorForAlpha,
    /// The source drawn as if it were premultiplied: factor ONE for SRC_ALPHA.
    AsPremultiplied,
    /// DST_COLOR and ONE_MINUS_SRC_ALPHA for DST_COLOR and ZERO.
    MultipliedByCoverage,
    /// SRC_ALPHA_SATURATE as SRC_ALPHA.
    NotSaturated,
    /// SRC_ALPHA_SATURATE by the source's own alpha.
    SaturatedBySource,
    /// The alpha blended by the state of the colour.
    AlphaByTheColorsState,
    /// The alpha of the source kept.
    AlphaReplaced,
    /// The destination's alpha kept.
    AlphaKept,
    /// The write mask ignored.
    MaskIgnored,
    /// Red and blue exchanged in the write mask.
    MaskRedBlue,
    /// SRC_ALPHA_SATURATE in alpha too, where it is 1.
    SaturatedInAlpha,
    /// What is there before ignored.
    NotBlended,
    /// Operands and result limited to [0, 1].
    Clamped,
    /// Nothing drawn of a source whose alpha is 0 or less.
    NothingWithoutAlpha,
    /// The last layer alone.
    LastLayerAlone,
    /// The layers in reverse.
    LayersReversed,
}

/// How a draw is blended.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Model {
    program: Program,
    state: Separate,
    saturate: Saturate,
    alpha: Alpha,
    masked: bool,
    mask_red_blue: bool,
    saturated_in_alpha: bool,
    clamped: bool,
    discards: bool,
    last_alone: bool,
    reversed: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Alpha {
    Right,
    Source,
    Destination,
}

fn right(spec: &Spec) -> Option<Model> {
    let program = match spec.kind {
        Kind::Blend(Program::Special(_)) => return None,
        Kind::Blend(program) => program,
        _ => match spec.id.as_str() {
            "blend/over" | "blend/over-incremental" => Program::WithoutAlpha(Mode::Alpha.state()),
            _ => return None,
        },
    };
    Some(Model {
        program,
        state: program.layer(0).0,
        saturate: Saturate::SourceAndDestination,
        alpha: Alpha::Right,
        masked: true,
        mask_red_blue: false,
        saturated_in_alpha: false,
        clamped: false,
        discards: false,
        last_alone: false,
        reversed: false,
    })
}

impl Model {
    fn each(&mut self, f: impl Fn(State) -> State) {
        if !matches!(self.program, Program::Layers(_)) {
            self.state = Separate { color: f(self.state.color), alpha: f(self.state.alpha) };
        }
    }

    const fn has_alpha(&self) -> bool {
        matches!(self.program, Program::Draw(..))
    }

    fn writes(&self, component: usize) -> bool {
        !matches!(self.program, Program::Draw(_, mask) if !mask.0[component])
    }

    /// Makes the mistake; `false` where the state has no such step, or the outcome is the same.
    fn twist(&mut self, twist: Twist) -> bool {
        let before = *self;
        self.change(twist);
        self.differs_from(&before)
    }

    /// Whether it computes or writes anything else than another model of the same program.
    fn differs_from(&self, before: &Self) -> bool {
        let same = |a: State, b: State| a.canonical() == b.canonical();
        let state_differs = {
            let color = !same(self.state.color, before.state.color) && (0..3).any(|k| self.shows(k));
            let alpha = !same(self.state.alpha, before.state.alpha) && self.has_alpha() && self.shows(3);
            color || alpha
        };
        state_differs || Self { state: before.state, ..*self } != *before
    }

    /// Changes the step that the mistake is about, if there is one.
    fn change(&mut self, twist: Twist) {
        let is_plain = matches!(self.program, Program::Draw(state, _) if state.color == state.alpha);
        match twist {
            Twist::FactorsExchanged => self.each(|s| State { src: s.dst, dst: s.src, ..s }),
            Twist::OperandsReversed => self.equations(reversed),
            Twist::AlwaysAdd => self.equations(addition_for_subtraction),
            Twist::MinForMax => self.equations(min_for_max),
            Twist::ConstantAlphaForColor => self.color_factors(constant_alpha_for_color),
            Twist::ConstantColorForAlpha => self.color_factors(constant_color_for_alpha),
            Twist::OneMinusForgotten => self.each(|s| State { dst: without_one_minus(s.dst), ..s }),
            Twist::OneMinusForgottenInSource => self.each(|s| State { src: without_one_minus(s.src), ..s }),
            Twist::SourceForDestination => self.factors(source_for_destination),
            Twist::DestinationForSource => self.factors(destination_for_source),
            Twist::AlphaForColor => self.color_factors(alpha_for_color),
            Twist::ColorForAlpha => self.color_factors(color_for_alpha),
            Twist::MultipliedByCoverage => {
                if matches!(self.program, Program::WithoutAlpha(_)) {
                    self.each(multiplied_by_coverage);
                }
            }
            Twist::AsPremultiplied => {
                self.each(|s| if s.src == Factor::SrcAlpha { State { src: Factor::One, ..s } } else { s })
            }
            Twist::NotSaturated => self.color_factors(|f| match f {
                Factor::SrcAlphaSaturate => Factor::SrcAlpha,
                other => other,
            }),
            Twist::SaturatedBySource => {
                let reads = |s: State| s.src == Factor::SrcAlphaSaturate || s.dst == Factor::SrcAlphaSaturate;
                if reads(self.state.color) && !self.state.color.equation.ignores_factors() {
                    self.saturate = Saturate::SourceOnly;
                }
            }
            Twist::AlphaByTheColorsState if self.has_alpha() && !is_plain => self.state.alpha = self.state.color,
            Twist::AlphaReplaced if self.has_alpha() && is_plain && self.writes(3) => {
                let alone = State { equation: Equation::Add, src: Factor::One, dst: Factor::Zero };
                if !is_source_alone(self.state.alpha) {
                    self.state.alpha = alone;
                    self.alpha = Alpha::Source;
                }
            }
            Twist::AlphaKept
                if self.has_alpha() && is_plain && self.writes(3) && !is_destination_alone(self.state.alpha) =>
            {
                self.alpha = Alpha::Destination;
            }
            Twist::MaskIgnored | Twist::MaskRedBlue | Twist::SaturatedInAlpha => self.change_of_alpha_or_mask(twist),
            Twist::NotBlended => {
                self.each(|_| State { equation: Equation::Add, src: Factor::One, dst: Factor::Zero });
            }
            Twist::Clamped => self.clamped = true,
            Twist::NothingWithoutAlpha => self.discards = !matches!(self.program, Program::Layers(_)),
            Twist::LastLayerAlone => self.last_alone = matches!(self.program, Program::Layers(_)),
            Twist::LayersReversed => self.reversed = matches!(self.program, Program::Layers(_)),
            _ => {}
        }
    }

    /// [`Model::change`] of what is about the mask, or about alpha alone.
    fn change_of_alpha_or_mask(&mut self, twist: Twist) {
        match twist {
            Twist::MaskIgnored => {
                if matches!(self.program, Program::Draw(_, mask) if mask.0 != [true; 4]) {
                    self.masked = false;
                }
            }
            Twist::MaskRedBlue => {
                self.mask_red_blue = matches!(self.program, Program::Draw(_, mask) if mask.0[0] != mask.0[2]);
            }
            Twist::SaturatedInAlpha => {
                let s = self.state.alpha;
                let reads = s.src == Factor::SrcAlphaSaturate || s.dst == Factor::SrcAlphaSaturate;
                self.saturated_in_alpha = self.has_alpha() && reads && !s.equation.ignores_factors() && self.writes(3);
            }
            _ => {}
        }
    }

    fn shows(&self, component: usize) -> bool {
        self.writes(component) || !self.masked
    }

    fn equations(&mut self, f: impl Fn(Equation) -> Equation) {
        self.each(|s| State { equation: f(s.equation), ..s });
    }

    fn factors(&mut self, f: impl Fn(Factor) -> Factor) {
        self.each(|s| State { src: f(s.src), dst: f(s.dst), ..s });
    }

    /// What differs between colour and alpha is the same for alpha itself.
    fn color_factors(&mut self, f: impl Fn(Factor) -> Factor) {
        if !matches!(self.program, Program::Layers(_)) {
            let s = self.state.color;
            self.state.color = State { src: f(s.src), dst: f(s.dst), ..s };
        }
    }

    fn evaluate<R: Real>(&self, x: &InputRow<'_, R>, out: &mut [R]) -> Option<()> {
        let unit = |c: Vec4<R>| if self.clamped { c.map(|x| x.clamp(R::literal(0.0), R::literal(1.0))) } else { c };
        let zero = Vector::splat(R::literal(0.0));
        match self.program {
            Program::Layers(modes) => put(out, 0, self.layers(modes, x)?),
            Program::WithoutAlpha(_) => {
                let dst = x.vector::<3>("dst")?.extend(R::literal(1.0));
                let operands = Operands { src: unit(x.vector("src")?), dst: unit(dst), constant: zero };
                let blended = unit(blend(self.state.color, &operands, self.saturate));
                put(out, 0, self.kept(blended, &operands).xyz());
            }
            Program::Draw(_, mask) => {
                let operands = Operands {
                    src: unit(x.vector("src")?),
                    dst: unit(x.vector("dst")?),
                    constant: unit(x.vector("constant")?),
                };
                let blended = unit(self.blended(&operands));
                let blended = match self.alpha {
                    Alpha::Right => blended,
                    Alpha::Source => blended.xyz().extend(operands.src.w()),
                    Alpha::Destination => blended.xyz().extend(operands.dst.w()),
                };
                let blended = self.kept(blended, &operands);
                let [r, g, b, a] = mask.0;
                let mask = if self.mask_red_blue { WriteMask([b, g, r, a]) } else { mask };
                put(out, 0, if self.masked { masked(mask, blended, x.vector("dst")?) } else { blended });
            }
            Program::Special(_) => return None,
        }
        Some(())
    }

    /// What is left on the target: what was blended, or what was there before.
    fn kept<R: Real>(&self, blended: Vec4<R>, operands: &Operands<R>) -> Vec4<R> {
        if self.discards { R::if_ge(R::literal(0.0), operands.src.w(), || operands.dst, || blended) } else { blended }
    }

    fn blended<R: Real>(&self, operands: &Operands<R>) -> Vec4<R> {
        let blend_by = |state: State, of: &Operands<R>| blend(state, of, self.saturate);
        let (color, mut alpha) = (blend_by(self.state.color, operands), blend_by(self.state.alpha, operands).w());
        if self.saturated_in_alpha {
            // What is said of a colour, of alpha in each place.
            let [src, dst, constant] = [operands.src, operands.dst, operands.constant].map(|c| Vector::splat(c.w()));
            alpha = blend_by(self.state.alpha, &Operands { src, dst, constant }).x();
        }
        color.xyz().extend(alpha)
    }

    fn layers<R: Real>(&self, modes: &[Mode], x: &InputRow<'_, R>) -> Option<Vec4<R>> {
        let (dst, count): (Vec4<R>, R) = (x.vector("dst")?, x.scalar("count")?);
        let unit = |c: Vec4<R>| if self.clamped { c.map(|x| x.clamp(R::literal(0.0), R::literal(1.0))) } else { c };
        let mut sources = vec![];
        for number in 1..=MOST_LAYERS {
            sources.push(x.vector::<4>(&format!("src-{number}"))?);
        }
        let mut below = unit(dst);
        let places: Vec<usize> =
            if self.reversed { (0..MOST_LAYERS).rev().collect() } else { (0..MOST_LAYERS).collect() };
        for place in places {
            let at = if self.last_alone { dst } else { below };
            let mode = modes[place % modes.len()];
            let of = Operands { src: unit(sources[place]), dst: at, constant: Vector::splat(R::literal(0.0)) };
            let drawn = || unit(blend(mode.state(), &of, self.saturate));
            let number = u32::try_from(place + 1).map_or(f64::INFINITY, f64::from);
            below = R::if_ge(count, R::literal(number), drawn, || below);
        }
        Some(below)
    }
}

fn is_source_alone(state: State) -> bool {
    state.equation == Equation::Add && state.src == Factor::One && state.dst == Factor::Zero
}

fn is_destination_alone(state: State) -> bool {
    matches!(state.equation, Equation::Add | Equation::ReverseSubtract)
        && state.src == Factor::Zero
        && state.dst == Factor::One
}

const fn reversed(equation: Equation) -> Equation {
    match equation {
        Equation::Subtract => Equation::ReverseSubtract,
        Equation::ReverseSubtract => Equation::Subtract,
        other => other,
    }
}

const fn addition_for_subtraction(equation: Equation) -> Equation {
    match equation {
        Equation::Subtract | Equation::ReverseSubtract => Equation::Add,
        other => other,
    }
}

const fn min_for_max(equation: Equation) -> Equation {
    match equation {
        Equation::Min => Equation::Max,
        Equation::Max => Equation::Min,
        other => other,
    }
}

const fn multiplied_by_coverage(state: State) -> State {
    match (state.equation, state.src, state.dst) {
        (Equation::Add, Factor::DstColor, Factor::Zero) => State { dst: Factor::OneMinusSrcAlpha, ..state },
        _ => state,
    }
}

const fn constant_alpha_for_color(factor: Factor) -> Factor {
    match factor {
        Factor::ConstantColor => Factor::ConstantAlpha,
        Factor::OneMinusConstantColor => Factor::OneMinusConstantAlpha,
        other => other,
    }
}

const fn constant_color_for_alpha(factor: Factor) -> Factor {
    match factor {
        Factor::ConstantAlpha => Factor::ConstantColor,
        Factor::OneMinusConstantAlpha => Factor::OneMinusConstantColor,
        other => other,
    }
}

const fn without_one_minus(factor: Factor) -> Factor {
    match factor {
        Factor::OneMinusSrcColor => Factor::SrcColor,
        Factor::OneMinusDstColor => Factor::DstColor,
        Factor::OneMinusSrcAlpha => Factor::SrcAlpha,
        Factor::OneMinusDstAlpha => Factor::DstAlpha,
        Factor::OneMinusConstantColor => Factor::ConstantColor,
        Factor::OneMinusConstantAlpha => Factor::ConstantAlpha,
        other => other,
    }
}

const fn source_for_destination(factor: Factor) -> Factor {
    match factor {
        Factor::DstColor => Factor::SrcColor,
        Factor::OneMinusDstColor => Factor::OneMinusSrcColor,
        Factor::DstAlpha => Factor::SrcAlpha,
        Factor::OneMinusDstAlpha => Factor::OneMinusSrcAlpha,
        other => other,
    }
}

const fn destination_for_source(factor: Factor) -> Factor {
    match factor {
        Factor::SrcColor => Factor::DstColor,
        Factor::OneMinusSrcColor => Factor::OneMinusDstColor,
        Factor::SrcAlpha => Factor::DstAlpha,
        Factor::OneMinusSrcAlpha => Factor::OneMinusDstAlpha,
        other => other,
    }
}

const fn alpha_for_color(factor: Factor) -> Factor {
    match factor {
        Factor::SrcColor => Factor::SrcAlpha,
        Factor::OneMinusSrcColor => Factor::OneMinusSrcAlpha,
        Factor::DstColor => Factor::DstAlpha,
        Factor::OneMinusDstColor => Factor::OneMinusDstAlpha,
        other => other,
    }
}

const fn color_for_alpha(factor: Factor) -> Factor {
    match factor {
        Factor::SrcAlpha => Factor::SrcColor,
        Factor::OneMinusSrcAlpha => Factor::OneMinusSrcColor,
        Factor::DstAlpha => Factor::DstColor,
        Factor::OneMinusDstAlpha => Factor::OneMinusDstColor,
        other => other,
    }
}

/// Whether the formula has these steps, and each makes a difference to it.
pub(super) fn concerns(spec: &Spec, twists: &[Twist]) -> bool {
    right(spec).is_some_and(|mut model| twists.iter().all(|&twist| model.twist(twist)))
}

/// Whether a formula of the blend unit becomes another function of its operands.
///
/// Blending is a polynomial of its operands, but for a least or a greatest: two that agree at a dozen points that nothing
/// connects are one.
pub(super) fn differs(spec: &Spec, before: &[Before], twists: &[Twist], after: &[After]) -> bool {
    const POINTS: u32 = 12;
    const LEAST: f64 = 1e-4;
    if right(spec).is_none() {
        return true;
    }
    // A draw's cases go beyond [0, 1].
    let is_draw = matches!(spec.kind, Kind::Blend(Program::Draw(..)));
    let mut number = 0.0_f64;
    let mut next = |input: &Input| {
        // Multiples of an irrational number, modulo the domain.
        number += 0.618_033_988_749_894_8;
        match input.domain {
            Domain::Whole(low, high) => f64::from(low) + (number.fract() * f64::from(high - low)).round(),
            _ if is_draw => number.fract() * 2.0 - 0.5,
            _ => number.fract(),
        }
    };
    (0..POINTS).any(|point| {
        let mut row: Vec<f64> = vec![];
        for input in spec.inputs {
            row.extend((0..input.shape.components()).map(|_| next(input)));
            // Cases have an alpha of 0 now and then.
            if point == 0 && input.shape.components() == 4 && input.name.starts_with("src") {
                row.pop();
                row.push(0.0);
            }
        }
        let (mut right, mut wrong) = (vec![0.0; spec.output_len()], vec![0.0; spec.output_len()]);
        let is_known = evaluate(spec, &[], &row, &mut right).is_some();
        before.iter().for_each(|before| before.apply(spec, &mut row));
        let is_known = is_known && evaluate(spec, twists, &row, &mut wrong).is_some();
        after.iter().for_each(|after| after.apply(spec, &row, &mut wrong));
        !is_known || right.iter().zip(&wrong).any(|(a, b)| (a - b).abs() > LEAST)
    })
}

/// The formula with these steps wrong.
pub(super) fn evaluate<R: Real>(spec: &Spec, twists: &[Twist], numbers: &[R], out: &mut [R]) -> Option<()> {
    let mut model = right(spec)?;
    for &twist in twists {
        model.twist(twist);
    }
    model.evaluate(&InputRow::new(spec, numbers), out)
}
