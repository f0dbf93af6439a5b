//! Blend factors, equations and states, as OpenGL, Vulkan and WebGPU name them.
//!
//! A [`State`] is a pair of factors and an equation, of which there are 15 × 15 × 5. Colour and alpha have one each: alike, or
//! [`Separate`].

use crate::words::words;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

words! {
    /// What multiplies the source (`S`) or the destination (`D`) colour.
    pub enum Factor {
        /// 0
        Zero = "zero",
        /// 1
        One = "one",
        /// Cs; As
        SrcColor = "src-color",
        /// 1 − Cs; 1 − As
        OneMinusSrcColor = "one-minus-src-color",
        /// Cd; Ad
        DstColor = "dst-color",
        /// 1 − Cd; 1 − Ad
        OneMinusDstColor = "one-minus-dst-color",
        /// As
        SrcAlpha = "src-alpha",
        /// 1 − As
        OneMinusSrcAlpha = "one-minus-src-alpha",
        /// Ad
        DstAlpha = "dst-alpha",
        /// 1 − Ad
        OneMinusDstAlpha = "one-minus-dst-alpha",
        /// Cc; Ac
        ConstantColor = "constant-color",
        /// 1 − Cc; 1 − Ac
        OneMinusConstantColor = "one-minus-constant-color",
        /// Ac
        ConstantAlpha = "constant-alpha",
        /// 1 − Ac
        OneMinusConstantAlpha = "one-minus-constant-alpha",
        /// min(As, 1 − Ad); 1
        SrcAlphaSaturate = "src-alpha-saturate",
    }
}

impl Factor {
    /// What it is in the colour, and in the alpha.
    #[must_use]
    pub const fn formulas(self) -> [&'static str; 2] {
        match self {
            Self::Zero => ["0", "0"],
            Self::One => ["1", "1"],
            Self::SrcColor => ["Cs", "As"],
            Self::OneMinusSrcColor => ["1 − Cs", "1 − As"],
            Self::DstColor => ["Cd", "Ad"],
            Self::OneMinusDstColor => ["1 − Cd", "1 − Ad"],
            Self::SrcAlpha => ["As", "As"],
            Self::OneMinusSrcAlpha => ["1 − As", "1 − As"],
            Self::DstAlpha => ["Ad", "Ad"],
            Self::OneMinusDstAlpha => ["1 − Ad", "1 − Ad"],
            Self::ConstantColor => ["Cc", "Ac"],
            Self::OneMinusConstantColor => ["1 − Cc", "1 − Ac"],
            Self::ConstantAlpha => ["Ac", "Ac"],
            Self::OneMinusConstantAlpha => ["1 − Ac", "1 − Ac"],
            Self::SrcAlphaSaturate => ["min(As, 1 − Ad)", "1"],
        }
    }

    /// Whether it reads the blend constant's colour in its RGB part.
    #[must_use]
    pub const fn reads_constant_color(self) -> bool {
        matches!(self, Self::ConstantColor | Self::OneMinusConstantColor)
    }

    /// Whether it reads the blend constant's alpha in its RGB part.
    #[must_use]
    pub const fn reads_constant_alpha(self) -> bool {
        matches!(self, Self::ConstantAlpha | Self::OneMinusConstantAlpha)
    }
}

words! {
    /// How the two products are combined.
    pub enum Equation {
        /// Cs·S + Cd·D
        Add = "add",
        /// Cs·S − Cd·D
        Subtract = "subtract",
        /// Cd·D − Cs·S
        ReverseSubtract = "reverse-subtract",
        /// min(Cs, Cd), factors ignored
        Min = "min",
        /// max(Cs, Cd), factors ignored
        Max = "max",
    }
}

impl Equation {
    /// MIN and MAX do not read the factors.
    #[must_use]
    pub const fn ignores_factors(self) -> bool {
        matches!(self, Self::Min | Self::Max)
    }
}

/// One blend state: a factor a side and an equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub struct State {
    /// The equation.
    pub equation: Equation,
    /// The source's factor.
    pub src: Factor,
    /// The destination's factor.
    pub dst: Factor,
}

impl State {
    /// Every one of the 15 × 15 × 5 states.
    pub fn all() -> impl Iterator<Item = Self> {
        Equation::ALL.into_iter().flat_map(|equation| {
            Factor::ALL
                .into_iter()
                .flat_map(move |src| Factor::ALL.into_iter().map(move |dst| Self { equation, src, dst }))
        })
    }

    /// The state that computes the same under the name that is judged: MIN and MAX stand with factors ONE, ONE.
    #[must_use]
    pub const fn canonical(self) -> Self {
        if self.equation.ignores_factors() {
            Self { equation: self.equation, src: Factor::One, dst: Factor::One }
        } else {
            self
        }
    }

    /// Whether the blend constant matters.
    #[must_use]
    pub const fn reads_constant(self) -> bool {
        !self.equation.ignores_factors()
            && (self.src.reads_constant_color()
                || self.src.reads_constant_alpha()
                || self.dst.reads_constant_color()
                || self.dst.reads_constant_alpha())
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}/{}", self.equation.name(), self.src.name(), self.dst.name())
    }
}

impl State {
    /// The same in one segment of an id: `add.src-alpha.zero`, `min`.
    #[must_use]
    pub fn segment(self) -> String {
        if self.equation.ignores_factors() {
            self.equation.name().into()
        } else {
            format!("{}.{}.{}", self.equation.name(), self.src.name(), self.dst.name())
        }
    }

    /// The state of such a segment.
    #[must_use]
    pub fn from_segment(segment: &str) -> Option<Self> {
        let mut parts = segment.split('.');
        let name = parts.next()?;
        let equation = Equation::ALL.into_iter().find(|equation| equation.name() == name)?;
        let mut factor = || {
            let name = parts.next()?;
            Factor::ALL.into_iter().find(|factor| factor.name() == name)
        };
        let state = if equation.ignores_factors() {
            Self { equation, src: Factor::One, dst: Factor::One }
        } else {
            Self { equation, src: factor()?, dst: factor()? }
        };
        parts.next().is_none().then_some(state)
    }
}

/// A state for the colour and one for the alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub struct Separate {
    /// Of red, green and blue.
    pub color: State,
    /// Of alpha.
    pub alpha: State,
}

impl Separate {
    /// The same where factors are ignored: see [`State::canonical`].
    #[must_use]
    pub const fn canonical(self) -> Self {
        Self { color: self.color.canonical(), alpha: self.alpha.canonical() }
    }

    /// Whether the blend constant matters.
    #[must_use]
    pub const fn reads_constant(self) -> bool {
        self.color.reads_constant() || self.alpha.reads_constant()
    }
}

impl From<State> for Separate {
    fn from(state: State) -> Self {
        Self { color: state, alpha: state }
    }
}

impl fmt::Display for Separate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.color.segment(), self.alpha.segment())
    }
}

/// Which components a draw writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct WriteMask(pub [bool; 4]);

impl WriteMask {
    /// Red, green, blue and alpha.
    pub const ALL: Self = Self([true; 4]);
    /// Red, green and blue: what a buffer without alpha has.
    pub const COLOR: Self = Self([true, true, true, false]);

    /// Each of the 16.
    pub fn each() -> impl Iterator<Item = Self> {
        (0..16_u8).map(|bits| Self([0, 1, 2, 3].map(|component| bits >> component & 1 == 1)))
    }
}

impl fmt::Display for WriteMask {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letters: String = "rgba".chars().zip(self.0).filter(|(_, on)| *on).map(|(letter, _)| letter).collect();
        f.write_str(if letters.is_empty() { "none" } else { &letters })
    }
}

words! {
    /// How a state reaches a blend unit, which in WebGPU has no factor of the constant's alpha.
    pub enum Route {
        /// The unit's own factors.
        Native = "native",
        /// The constant's alpha given as all four components of the constant.
        ConstantReplicated = "constant-replicated",
        /// The source's colour multiplied by its constant factor in the shader, and ONE in the unit: one side reads the
        /// constant's colour and the other its alpha. On a unorm target the source is clamped first, as the unit would have.
        FoldedIntoSource = "folded-into-source",
        /// The same states with the constant's alpha as the alpha of a second source colour.
        DualSource = "dual-source",
    }
}

/// The routes of a state, the first of which every adapter has.
///
/// The alpha component's constant factors all read the constant's alpha, so only the colour's decide.
#[must_use]
pub const fn routes(state: Separate) -> &'static [Route] {
    let State { equation, src, dst } = state.color;
    if equation.ignores_factors() {
        return &[Route::Native];
    }
    let alpha = src.reads_constant_alpha() || dst.reads_constant_alpha();
    let color = src.reads_constant_color() || dst.reads_constant_color();
    match (alpha, color) {
        (false, _) => &[Route::Native],
        (true, false) => &[Route::ConstantReplicated],
        (true, true) => &[Route::FoldedIntoSource, Route::DualSource],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn there_are_1125_states_of_which_677_differ() {
        assert_eq!(State::all().count(), 1125);
        let distinct: BTreeSet<_> = State::all().map(State::canonical).collect();
        assert_eq!(distinct.len(), 15 * 15 * 3 + 2);
    }

    #[test]
    fn codes_are_places_in_the_tables() {
        for (place, factor) in Factor::ALL.into_iter().enumerate() {
            assert_eq!(usize::try_from(factor.code()).ok(), Some(place));
        }
        for (place, equation) in Equation::ALL.into_iter().enumerate() {
            assert_eq!(usize::try_from(equation.code()).ok(), Some(place));
        }
    }

    #[test]
    fn segments_read_back() {
        for state in State::all().map(State::canonical) {
            assert_eq!(State::from_segment(&state.segment()), Some(state));
        }
        for wrong in ["", "add", "add.zero", "add.zero.two", "add.zero.one.one", "min.one.one", "mul.one.one"] {
            assert_eq!(State::from_segment(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn masks_are_named_by_their_letters() {
        let names: Vec<String> = WriteMask::each().map(|mask| mask.to_string()).collect();
        assert_eq!((names.len(), names[0].as_str(), names[5].as_str(), names[15].as_str()), (16, "none", "rb", "rgba"));
    }
}
