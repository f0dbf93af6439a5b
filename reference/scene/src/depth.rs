//! Depth tests, as OpenGL, Vulkan and WebGPU name them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// When a fragment's depth passes against the depth that is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Compare {
    /// Never.
    Never,
    /// new < old
    Less,
    /// new = old
    Equal,
    /// new ≤ old
    LessEqual,
    /// new > old
    Greater,
    /// new ≠ old
    NotEqual,
    /// new ≥ old
    GreaterEqual,
    /// Always.
    Always,
}

impl Compare {
    /// All 8, in the order of their codes.
    pub const ALL: [Self; 8] = [
        Self::Never,
        Self::Less,
        Self::Equal,
        Self::LessEqual,
        Self::Greater,
        Self::NotEqual,
        Self::GreaterEqual,
        Self::Always,
    ];

    /// The name used in case ids, JSON and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Never => "never",
            Self::Less => "less",
            Self::Equal => "equal",
            Self::LessEqual => "less-equal",
            Self::Greater => "greater",
            Self::NotEqual => "not-equal",
            Self::GreaterEqual => "greater-equal",
            Self::Always => "always",
        }
    }

    /// Its place in [`Compare::ALL`], which is the selector that the shaders take: bit 0 passes less, bit 1 equal, bit 2
    /// greater.
    #[must_use]
    pub const fn code(self) -> u32 {
        self as u32
    }
}

/// A depth test, and whether a fragment that passes leaves its depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub struct DepthTest {
    /// When it passes.
    pub compare: Compare,
    /// Whether the depth is written. Always without writing is no test at all: what is drawn last stays.
    pub write: bool,
}

impl DepthTest {
    /// Each of the 16.
    pub fn all() -> impl Iterator<Item = Self> {
        Compare::ALL.into_iter().flat_map(|compare| [true, false].map(|write| Self { compare, write }))
    }
}

impl fmt::Display for DepthTest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.compare.name(), if self.write { "write" } else { "keep" })
    }
}

#[cfg(test)]
mod tests {
    use super::Compare;

    #[test]
    fn codes_say_what_passes() {
        let passes = |compare: Compare, bit: u32| compare.code() >> bit & 1 == 1;
        for (compare, less, equal, greater) in [
            (Compare::Never, false, false, false),
            (Compare::LessEqual, true, true, false),
            (Compare::NotEqual, true, false, true),
            (Compare::Always, true, true, true),
        ] {
            assert_eq!((passes(compare, 0), passes(compare, 1), passes(compare, 2)), (less, equal, greater));
        }
    }
}
