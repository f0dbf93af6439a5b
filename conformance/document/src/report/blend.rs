//! What the JSON of `run` has of blend units: tiers and stores, each blend state, NaN and infinity.

use crate::count::counters;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

counters! {
    /// Values on a target of 8 bits by how near they come.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct Tiers {
        /// The formula gives a whole step, and it came out.
        pub exact: u64,
        /// The nearest step.
        pub nearest: u64,
        /// The other neighbour.
        pub neighbour: u64,
        /// Farther, but within the format's bound.
        pub bound: u64,
        /// Outside.
        pub outside: u64,
    }
}

impl Tiers {
    /// Each with its name.
    #[must_use]
    pub const fn named(&self) -> [(&'static str, u64); 5] {
        [
            ("exact", self.exact),
            ("nearest", self.nearest),
            ("neighbour", self.neighbour),
            ("bound", self.bound),
            ("outside", self.outside),
        ]
    }
}

/// How a target's values are stored, told from many of them together.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct StoreUse {
    /// The store that most values speak for, or the model that all of them follow.
    pub identified: Word,
    /// The share of the values that are as it would have them.
    pub share: f64,
    /// Values that tell stores apart.
    pub of: u64,
    /// Their mean error with its sign, in steps.
    pub bias: f64,
}

/// A blend state by one route on a target.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct BlendState {
    /// The state's id.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The target's format.
    pub target: Word,
    /// How the state reached the unit.
    pub route: Word,
    /// Pixels.
    pub cases: u64,
    /// Components outside what is legal.
    pub failed: u64,
    /// The greatest error: ULP on float targets, steps on those of 8 bits.
    pub error_max: Number,
    /// On targets of 8 bits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tiers: Option<Tiers>,
    /// Why it was not drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skip_reason: Option<Word>,
}

impl BlendState {
    /// Whether it was drawn.
    #[must_use]
    pub const fn is_drawn(&self) -> bool {
        self.skip_reason.is_none()
    }

    /// Its tiers, none where it was not drawn on a target of 8 bits.
    #[must_use]
    pub fn tiers(&self) -> Tiers {
        self.tiers.unwrap_or_default()
    }
}

/// NaN or infinity in a blend unit.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct SpecialUse {
    /// The case.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The target's format.
    pub target: Word,
    /// What was left of the colour.
    pub seen: String,
    /// What is on record for the driver.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recorded: Option<Word>,
}

impl SpecialUse {
    /// Whether it is what is on record, if anything is.
    #[must_use]
    pub fn is_as_recorded(&self) -> bool {
        self.recorded.as_ref().is_none_or(|recorded| *recorded == self.seen)
    }
}

/// What an interface says of NaN and infinity in blending.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct BlendPromise {
    /// The interface.
    pub interface: Word,
    /// What it says.
    pub says: Word,
}
