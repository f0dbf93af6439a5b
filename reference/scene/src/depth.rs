//! Depth tests, as OpenGL, Vulkan and WebGPU name them.

use crate::words::words;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

words! {
    /// When a fragment's depth passes against the depth that is stored. Bit 0 of its code passes less, bit 1 equal, bit 2 greater.
    #[derive(Default)]
    pub enum Compare {
        /// Never.
        Never = "never",
        /// new < old
        #[default]
        Less = "less",
        /// new = old
        Equal = "equal",
        /// new ≤ old
        LessEqual = "less-equal",
        /// new > old
        Greater = "greater",
        /// new ≠ old
        NotEqual = "not-equal",
        /// new ≥ old
        GreaterEqual = "greater-equal",
        /// Always.
        Always = "always",
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
