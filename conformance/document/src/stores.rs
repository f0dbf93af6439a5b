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
    /// The names of the stores, in the order of `as_by`. The first is the right one.
    pub const STORES: [&'static str; 6] =
        ["nearest", "truncated", "×256 for ×255", "rounded up", "one step up", "one step down"];

    /// Adds another's counts.
    pub fn add(&mut self, other: &Self) {
        self.of += other.of;
        self.error += other.error;
        for (sum, count) in self.as_by.iter_mut().zip(other.as_by) {
            *sum += count;
        }
    }

    /// The share of nearest values.
    #[must_use]
    pub fn nearest(&self) -> f64 {
        self.share(self.as_by[0])
    }

    /// The mean distance from the nearest step, with its sign.
    #[must_use]
    pub fn bias(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a mean")]
        let of = self.of.max(1) as f64;
        self.error / of
    }

    /// The store that most values speak for, by its place in `as_by`, and their share. Of equals this is the first.
    #[must_use]
    pub fn likeliest_place(&self) -> (usize, f64) {
        let counts = self.as_by.into_iter().enumerate().rev();
        let (place, count) = counts.max_by_key(|(_, count)| *count).unwrap_or_default();
        (place, self.share(count))
    }

    #[expect(clippy::cast_precision_loss, reason = "a share")]
    fn share(&self, count: u64) -> f64 {
        count as f64 / self.of.max(1) as f64
    }
}
