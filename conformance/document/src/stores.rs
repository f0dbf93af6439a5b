//! How a target of 8 bits stores results, counted over many values.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Values that tell the stores of a target of 8 bits apart, by the stores that would have given them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StoreCounts {
    /// How many.
    pub of: u64,
    /// How many are as each store would have them: nearest, truncated, ×256 for ×255, rounded up, one step up, one step down.
    pub as_by: [u64; 6],
    /// The sum of their distances from the nearest step, with the sign.
    pub error: f64,
}

impl StoreCounts {
    /// Adds another's counts.
    pub fn add(&mut self, other: &Self) {
        self.of += other.of;
        self.error += other.error;
        for (sum, count) in self.as_by.iter_mut().zip(other.as_by) {
            *sum += count;
        }
    }
}
