//! A probe: one operation on stated operands.

use super::gives::Gives;
use super::promise::Promise;
use super::source::Source;

/// The first segment of the ids.
pub const FAMILY: &str = "special";

/// What a probe is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// NaN given, or what has no value.
    Nan,
    /// Infinity given, or overflow.
    Infinity,
    /// Subnormals given, or underflow.
    Subnormal,
    /// The sign of zero.
    SignedZero,
    /// Which neighbour a rounded result is.
    Rounding,
}

impl Class {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 5] = [Self::Nan, Self::Infinity, Self::Subnormal, Self::SignedZero, Self::Rounding];

    /// The name in ids: `special/nan/nan-plus-one`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nan => "nan",
            Self::Infinity => "infinity",
            Self::Subnormal => "subnormal",
            Self::SignedZero => "signed-zero",
            Self::Rounding => "rounding",
        }
    }

    /// The id of its table: `special/nan`.
    #[must_use]
    pub fn table(self) -> String {
        format!("{FAMILY}/{}", self.name())
    }

    /// The heading in reports.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Nan => "NaN",
            Self::Infinity => "Infinity and overflow",
            Self::Subnormal => "Subnormals and underflow",
            Self::SignedZero => "The sign of zero",
            Self::Rounding => "Rounding",
        }
    }
}

/// How a probe is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// A function of `special.wgsl`, in the compute and in the fragment stage.
    Function(&'static str),
    /// A value that every vertex of a primitive has, read from its fragment.
    Varying {
        /// Flat, or else interpolated.
        flat: bool,
    },
}

/// One operation on stated operands.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    /// Its name.
    pub name: &'static str,
    /// What it is about.
    pub class: Class,
    /// What is computed, for people.
    pub what: &'static str,
    /// How.
    pub way: Way,
    /// The operands' bits.
    pub inputs: &'static [u32],
    /// The result's type.
    pub gives: Gives,
    /// What is promised.
    pub promise: Promise,
    /// By which rule.
    pub source: Source,
}

impl Probe {
    /// The operands' names, in their order.
    pub const OPERANDS: [&str; 3] = ["x", "y", "z"];

    /// The function that evaluates it; `None` of what a rasteriser carries.
    #[must_use]
    pub const fn function(&self) -> Option<&'static str> {
        if let Way::Function(name) = self.way { Some(name) } else { None }
    }

    /// An operand as a number: the value of a float, or a word where the function takes one.
    #[must_use]
    pub fn operand(&self, bits: u32) -> f64 {
        let takes_word = matches!(self.way, Way::Function("special_from_u32" | "special_unpack_half"));
        let operands = if takes_word { Gives::Word } else { Gives::Float };
        operands.number(bits)
    }

    /// Its id: `special/nan/nan-plus-one`.
    #[must_use]
    pub fn id(&self) -> String {
        format!("{}/{}", self.class.table(), self.name)
    }
}
