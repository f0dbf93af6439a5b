//! Where the language states its promises on special values.

/// Where a promise, or the lack of one, is stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// There may be assumed to be neither overflow, infinity nor NaN.
    FiniteMath,
    /// Inputs and outputs of operations may be flushed to zero, and what passes through a bitcast.
    Flush,
    /// The sign of a zero may be ignored.
    ZeroSign,
    /// The table of accuracies: outside a domain named there nothing is promised.
    Accuracy,
    /// Fusion, where it is at least as accurate.
    Fusion,
    /// Conversions.
    Conversion,
    /// The reinterpretation of bits.
    Bitcast,
    /// Packing and unpacking.
    Packing,
    /// A choice between values, which computes nothing.
    Selection,
}

impl Source {
    /// The section.
    #[must_use]
    pub const fn section(self) -> &'static str {
        match self {
            Self::FiniteMath | Self::Flush | Self::ZeroSign => "WGSL §15.7.2",
            Self::Accuracy => "WGSL §15.7.4",
            Self::Fusion => "WGSL §15.7.5",
            Self::Conversion => "WGSL §15.7.6",
            Self::Bitcast => "WGSL §17.2.1",
            Self::Packing => "WGSL §17.9",
            Self::Selection => "WGSL §17.3",
        }
    }

    /// What it says.
    #[must_use]
    pub const fn says(self) -> &'static str {
        match self {
            Self::FiniteMath => {
                "overflow, infinity and NaN may be assumed absent: where one is present the result is an indeterminate value"
            }
            Self::Flush => {
                "subnormals may be flushed to zero as inputs and outputs of an operation, and on their way through a bitcast"
            }
            Self::ZeroSign => "the sign of a zero may be ignored",
            Self::Accuracy => {
                "accuracy is promised on a domain; a function that inherits it from an expression inherits the expression's domain"
            }
            Self::Fusion => "operations may be fused where that is at least as accurate; fma need not be",
            Self::Conversion => {
                "a float is clamped to the range of an integer; an integer between two floats may become either"
            }
            Self::Bitcast => "bits of a NaN or an infinity become an indeterminate value of a float type",
            Self::Packing => {
                "a component that binary16 cannot hold is an indeterminate value; a subnormal may be flushed"
            }
            Self::Selection => "one of two values is taken as it is",
        }
    }

    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::FiniteMath,
        Self::Flush,
        Self::ZeroSign,
        Self::Accuracy,
        Self::Fusion,
        Self::Conversion,
        Self::Bitcast,
        Self::Packing,
        Self::Selection,
    ];
}
