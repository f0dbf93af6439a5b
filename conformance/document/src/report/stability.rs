//! What the JSON of `run` has of hard cases: what stable forms claim, the errors of stable and naive forms, and their costs.

use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A formula in a stable form, and what it claims: at its hard cases and near them it errs by no more.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StableForm {
    /// The formula.
    pub formula: String,
    /// The largest error, in roundings.
    pub bound: f64,
    /// The reason for the bound, and where the form may be used.
    pub because: Word,
}

/// A hard case by its stable and its naive form, on an adapter in a stage. Errors are in roundings, the greatest at the case
/// and within a few ULP of it; infinite where a value is NaN or infinite.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Examined {
    /// The case, of the stable formula.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The stage's name.
    pub stage: Word,
    /// How much the result amplifies the inputs' errors at the case itself.
    pub condition: Number,
    /// What the stable form claims.
    pub bound: f64,
    /// The stable form's error.
    pub stable: Number,
    /// The case near by where that is.
    pub stable_at: String,
    /// The naive formula.
    pub naive_formula: Word,
    /// What goes wrong with it.
    pub fails: Word,
    /// By how much at least.
    pub naive_at_least: Number,
    /// The naive form's error.
    pub naive: Number,
    /// Its error against its own exact value: where that is far less, it computes another function.
    pub naive_rounding: Number,
}

impl Examined {
    /// Whether the stable form keeps its claim.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.stable.0 <= self.bound
    }

    /// Whether the naive form fails as it is said to.
    #[must_use]
    pub fn naive_fails(&self) -> bool {
        self.naive.0 >= self.naive_at_least.0
    }
}

/// What a stable form takes beside a naive one, in the compute stage: nanoseconds of wall time for an evaluation, medians of
/// turns in which each is measured, less what reading the inputs takes.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Cost {
    /// The stable formula.
    pub formula: String,
    /// The naive one.
    pub naive: Word,
    /// The adapter's short name.
    pub adapter: String,
    /// Of the stable form.
    pub stable_ns: f64,
    /// Of the naive form.
    pub naive_ns: f64,
    /// Of reading the inputs, which is in neither.
    pub idle_ns: f64,
    /// Median of the stable form's time over the naive one's, turn by turn, reading included in both.
    pub ratio: f64,
    /// Its lower and upper quartile.
    pub quartiles: [f64; 2],
}
