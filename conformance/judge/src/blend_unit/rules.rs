//! The rules that a blend unit follows, and the faulty ones that tell which mistake was made.

use super::pixel::{nearest_step, step_above, step_below};
use lightmeter_catalogue::cases::blend::UnitCase;
use lightmeter_document::stores::StoreCounts;
use lightmeter_reference::blend::{Operands, Saturate, blend_separate, factor};
use lightmeter_reference::{Real, Rgba};
use lightmeter_scene::blend::{Equation, Factor, Separate, State, WriteMask};
use lightmeter_scene::target::{Encoding, TargetFormat};
use std::borrow::Cow;

/// What is clamped to [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clamp {
    /// Nothing, as on float targets.
    Nothing,
    /// The operands and the result, as on unorm targets.
    Operands,
    /// The result alone.
    Result,
}

/// How a blend unit computes.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    factor: Option<fn(Factor) -> Factor>,
    equation: Option<fn(Equation) -> Equation>,
    saturate: Saturate,
    alpha_state_for_color: bool,
    factors_in_min_and_max: bool,
    red_and_blue_exchanged: bool,
    layers_reversed: bool,
    mask_ignored: bool,
    srgb_ignored: bool,
    alpha_encoded: bool,
    factors_exchanged: bool,
    /// What is clamped on unorm targets; [`Clamp::Result`] stands for float targets too.
    pub clamp: Clamp,
    /// How a result becomes one of the target's steps …
    pub store: Store,
    /// … where a wrong one is used: of alpha alone, …
    only_alpha: bool,
    /// … in one state alone.
    only_in: Option<State>,
}

/// How a real number of steps from 0 to 255 becomes a whole one, in the order of [`StoreCounts::STORES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Store {
    /// The nearest.
    Nearest,
    /// The one below.
    Truncated,
    /// Multiplied by 256 rather than 255, and truncated.
    Times256,
    /// The one above.
    RoundedUp,
    /// One above the nearest.
    StepUp,
    /// One below the nearest.
    StepDown,
}

impl Store {
    /// Each, the right one first.
    pub const ALL: [Self; 6] =
        [Self::Nearest, Self::Truncated, Self::Times256, Self::RoundedUp, Self::StepUp, Self::StepDown];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        StoreCounts::STORES[self as usize]
    }

    /// The step that it stores.
    #[must_use]
    pub fn step(self, steps: f64) -> f64 {
        let step = match self {
            Self::Nearest => nearest_step(steps),
            Self::Truncated => step_below(steps),
            Self::Times256 => step_below(steps * (256.0 / 255.0)),
            Self::RoundedUp => step_above(steps),
            Self::StepUp => nearest_step(steps) + 1.0,
            Self::StepDown => nearest_step(steps) - 1.0,
        };
        step.clamp(0.0, 255.0)
    }
}

impl Rules {
    /// What OpenGL, Vulkan and WebGPU define.
    pub const RIGHT: Self = Self {
        factor: None,
        equation: None,
        saturate: Saturate::SourceAndDestination,
        alpha_state_for_color: false,
        factors_in_min_and_max: false,
        red_and_blue_exchanged: false,
        layers_reversed: false,
        mask_ignored: false,
        srgb_ignored: false,
        alpha_encoded: false,
        factors_exchanged: false,
        clamp: Clamp::Operands,
        store: Store::Nearest,
        only_alpha: false,
        only_in: None,
    };

    /// How a result becomes one of the target's steps.
    #[must_use]
    pub const fn stores_as(&self) -> Store {
        self.store
    }

    /// What is clamped on a target.
    #[must_use]
    pub(super) fn clamps(&self, target: TargetFormat) -> Clamp {
        if target.is_unorm() || self.clamp == Clamp::Result { self.clamp } else { Clamp::Nothing }
    }

    /// The case as it is drawn.
    pub(super) fn case<'a>(&self, case: &'a UnitCase) -> Cow<'a, UnitCase> {
        if !self.layers_reversed && !self.red_and_blue_exchanged {
            return Cow::Borrowed(case);
        }
        let mut drawn = *case;
        if self.layers_reversed {
            drawn.sources[..case.layers].reverse();
        }
        if self.red_and_blue_exchanged {
            drawn.sources.iter_mut().for_each(|source| source.swap(0, 2));
            drawn.constant.swap(0, 2);
        }
        Cow::Owned(drawn)
    }

    /// The target as it is blended on.
    pub(super) fn target(&self, target: TargetFormat) -> TargetFormat {
        if self.srgb_ignored && target == TargetFormat::Rgba8UnormSrgb { TargetFormat::Rgba8Unorm } else { target }
    }

    /// The component of an encoded target as which one is stored: of alpha, which is linear, itself.
    pub(super) const fn stored_as(&self, component: usize) -> usize {
        if self.alpha_encoded { 0 } else { component }
    }

    /// How a component is stored in a state.
    pub(super) fn store_in(&self, state: Separate, component: usize) -> Store {
        let spared = (self.only_alpha && component != 3) || self.only_in.is_some_and(|only| only != state.color);
        if spared { Store::Nearest } else { self.store }
    }

    /// The one state that a wrong store is used in.
    #[must_use]
    pub const fn only_state(&self) -> Option<State> {
        self.only_in
    }

    /// Whether a wrong store is used throughout.
    #[must_use]
    pub fn stores_wrong_throughout(&self) -> bool {
        self.store != Store::Nearest && !self.only_alpha && self.only_in.is_none()
    }

    /// The components that are written.
    pub(super) const fn mask(&self, mask: WriteMask) -> WriteMask {
        if self.mask_ignored { WriteMask::ALL } else { mask }
    }

    /// A state as it is drawn by.
    #[inline]
    pub(super) fn state(&self, state: Separate) -> Separate {
        let is_itself = self.factor.is_none() && self.equation.is_none();
        if is_itself && !self.factors_exchanged && !self.alpha_state_for_color { state } else { self.changed(state) }
    }

    /// Whether a draw by a [`Self::state`] of these rules reads the blend constant.
    pub(super) const fn reads_constant(&self, drawn: Separate) -> bool {
        self.factors_in_min_and_max || drawn.reads_constant()
    }

    fn changed(&self, state: Separate) -> Separate {
        let alpha = self.of(state.alpha);
        Separate { color: if self.alpha_state_for_color { alpha } else { self.of(state.color) }, alpha }
    }

    /// A draw by these rules and a [`Self::state`] of them, not yet clamped.
    pub(super) fn blend<R: Real>(&self, drawn: Separate, of: &Operands<R>) -> Rgba<R> {
        let Separate { color, alpha } = drawn;
        if self.factors_in_min_and_max && (color.equation.ignores_factors() || alpha.equation.ignores_factors()) {
            let (color, alpha) = (self.scaled(color, of), self.scaled(alpha, of));
            return color.xyz().extend(alpha.w());
        }
        blend_separate(drawn, of, self.saturate)
    }

    fn of(&self, state: State) -> State {
        let state = if self.factors_exchanged { State { src: state.dst, dst: state.src, ..state } } else { state };
        let factor = |factor| self.factor.map_or(factor, |exchanged| exchanged(factor));
        let equation = self.equation.map_or(state.equation, |exchanged| exchanged(state.equation));
        State { equation, src: factor(state.src), dst: factor(state.dst) }
    }

    /// MIN and MAX of the products.
    fn scaled<R: Real>(&self, state: State, of: &Operands<R>) -> Rgba<R> {
        let one = State { src: Factor::One, dst: Factor::One, ..state };
        if !state.equation.ignores_factors() {
            return blend_separate(state.into(), of, self.saturate);
        }
        let src = of.src * factor(state.src, of, self.saturate);
        let dst = of.dst * factor(state.dst, of, self.saturate);
        blend_separate(one.into(), &Operands { src, dst, constant: of.constant }, self.saturate)
    }
}

/// A mistake that a blend unit, or who sets it up, may make.
#[derive(Clone, Copy, Debug)]
pub struct UnitFault {
    /// Its name.
    pub name: &'static str,
    /// It is as if …
    pub says: &'static str,
    /// The rules that it follows.
    pub rules: Rules,
}

impl UnitFault {
    const fn new(name: &'static str, says: &'static str, rules: Rules) -> Self {
        Self { name, says, rules }
    }

    /// Whether it can be made on a target at all: steps are of unorm targets, and only they clamp operands.
    #[must_use]
    pub fn concerns(&self, target: TargetFormat) -> bool {
        match self.name {
            "clamp-after" => target.is_unorm(),
            "clamp-on-float" => !target.is_unorm(),
            "srgb-ignored" | "alpha-encoded" => target.encoding() == Encoding::Srgb8,
            _ => self.rules.store == Store::Nearest || target.is_unorm(),
        }
    }
}

/// The mistakes that are told by name.
pub const FAULTS: &[UnitFault] = &[
    UnitFault::new("truncate", "results were truncated", Rules { store: Store::Truncated, ..Rules::RIGHT }),
    UnitFault::new(
        "truncate-alpha",
        "alpha were truncated",
        Rules { store: Store::Truncated, only_alpha: true, ..Rules::RIGHT },
    ),
    UnitFault::new(
        "truncate-one-state",
        "results of DST_COLOR, SRC_COLOR were truncated",
        Rules {
            store: Store::Truncated,
            only_in: Some(State { equation: Equation::Add, src: Factor::DstColor, dst: Factor::SrcColor }),
            ..Rules::RIGHT
        },
    ),
    UnitFault::new(
        "times-256",
        "results were multiplied by 256 for 255",
        Rules { store: Store::Times256, ..Rules::RIGHT },
    ),
    UnitFault::new("round-up", "results were rounded up", Rules { store: Store::RoundedUp, ..Rules::RIGHT }),
    UnitFault::new("step-up", "a step were added", Rules { store: Store::StepUp, ..Rules::RIGHT }),
    UnitFault::new("step-down", "a step were taken off", Rules { store: Store::StepDown, ..Rules::RIGHT }),
    UnitFault::new(
        "clamp-after",
        "the result alone were clamped, and not the operands",
        Rules { clamp: Clamp::Result, ..Rules::RIGHT },
    ),
    UnitFault::new(
        "clamp-on-float",
        "a float target clamped its result",
        Rules { clamp: Clamp::Result, ..Rules::RIGHT },
    ),
    UnitFault::new(
        "src-alpha-for-one",
        "SRC_ALPHA and ONE were exchanged",
        Rules {
            factor: Some(|factor| match factor {
                Factor::SrcAlpha => Factor::One,
                Factor::One => Factor::SrcAlpha,
                other => other,
            }),
            ..Rules::RIGHT
        },
    ),
    UnitFault::new(
        "one-minus-src-alpha-for-zero",
        "ONE_MINUS_SRC_ALPHA and ZERO were exchanged",
        Rules {
            factor: Some(|factor| match factor {
                Factor::OneMinusSrcAlpha => Factor::Zero,
                Factor::Zero => Factor::OneMinusSrcAlpha,
                other => other,
            }),
            ..Rules::RIGHT
        },
    ),
    UnitFault::new(
        "saturate-by-source",
        "SRC_ALPHA_SATURATE were min(As, 1 − As)",
        Rules { saturate: Saturate::SourceOnly, ..Rules::RIGHT },
    ),
    UnitFault::new(
        "subtract-reversed",
        "the two subtractions were exchanged",
        Rules {
            equation: Some(|equation| match equation {
                Equation::Subtract => Equation::ReverseSubtract,
                Equation::ReverseSubtract => Equation::Subtract,
                other => other,
            }),
            ..Rules::RIGHT
        },
    ),
    UnitFault::new(
        "constant-color-for-alpha",
        "the constant's colour were read for its alpha",
        Rules {
            factor: Some(|factor| match factor {
                Factor::ConstantAlpha => Factor::ConstantColor,
                Factor::OneMinusConstantAlpha => Factor::OneMinusConstantColor,
                other => other,
            }),
            ..Rules::RIGHT
        },
    ),
    UnitFault::new(
        "alpha-factor-for-color",
        "colour factors gave their alpha to every component",
        Rules {
            factor: Some(|factor| match factor {
                Factor::SrcColor => Factor::SrcAlpha,
                Factor::OneMinusSrcColor => Factor::OneMinusSrcAlpha,
                Factor::DstColor => Factor::DstAlpha,
                Factor::OneMinusDstColor => Factor::OneMinusDstAlpha,
                Factor::ConstantColor => Factor::ConstantAlpha,
                Factor::OneMinusConstantColor => Factor::OneMinusConstantAlpha,
                other => other,
            }),
            ..Rules::RIGHT
        },
    ),
    UnitFault::new(
        "alpha-state-for-color",
        "the alpha's factors and equation were used for the colour",
        Rules { alpha_state_for_color: true, ..Rules::RIGHT },
    ),
    UnitFault::new(
        "factors-in-min",
        "MIN and MAX were of colours multiplied by their factors",
        Rules { factors_in_min_and_max: true, ..Rules::RIGHT },
    ),
    UnitFault::new(
        "red-and-blue-exchanged",
        "red and blue were exchanged",
        Rules { red_and_blue_exchanged: true, ..Rules::RIGHT },
    ),
    UnitFault::new(
        "layers-reversed",
        "layers were drawn last one first",
        Rules { layers_reversed: true, ..Rules::RIGHT },
    ),
    UnitFault::new("mask-ignored", "every component were written", Rules { mask_ignored: true, ..Rules::RIGHT }),
    UnitFault::new("alpha-encoded", "alpha were encoded too", Rules { alpha_encoded: true, ..Rules::RIGHT }),
    UnitFault::new(
        "factors-exchanged",
        "each side were multiplied by the other's factor",
        Rules { factors_exchanged: true, ..Rules::RIGHT },
    ),
    UnitFault::new("srgb-ignored", "the target were not encoded", Rules { srgb_ignored: true, ..Rules::RIGHT }),
];

/// The encoding's name where errors are told in it.
#[must_use]
pub const fn unit_name(target: TargetFormat) -> &'static str {
    match target.encoding() {
        Encoding::Float32 | Encoding::Float16 => "ULP",
        Encoding::Unorm8 | Encoding::Srgb8 => "steps",
    }
}
