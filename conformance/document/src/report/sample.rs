//! What a shard keeps of its groups besides their counts, by which those who join the shards diagnose the whole.

use crate::Word;
use crate::stores::StoreCounts;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Of a group on one subject in one stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroupSample {
    /// The group's formulas, by their ids.
    pub formulas: Vec<String>,
    /// How many cases of each fail.
    pub failing: Vec<u64>,
    /// Verdicts on random cases, and those of them that permit anything.
    pub random: [u64; 2],
    /// Some of the cases that fail, with what was answered.
    pub wrong: SampledRows,
    /// Some of the others.
    pub right: SampledRows,
    /// What values on a target of 8 bits say of how they are stored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stores: Option<SampledStores>,
}

/// Cases of a group with the least hashes, which are the same whatever the shards are. Their inputs are those that the cases have by the seed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SampledRows {
    /// How many cases these are of.
    pub of: u64,
    /// The cases in their order, in base 16. Of each: the place of its formula, its kind (0 a hard case, 1 one near it, 2 one at a boundary, 3 a
    /// random one), one number or for kind 1 two, each as LEB128, and the answer's words, four bytes each, least first.
    pub rows: String,
}

/// How values on a target of 8 bits are stored: too few of them by themselves may tell nothing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SampledStores {
    /// By component, of all states together.
    pub components: [StoreCounts; 4],
    /// The same of each state by each route that was drawn.
    pub states: Vec<StoresOfState>,
    /// Values that the device's declared model predicts, and how many are another.
    pub model: [u64; 2],
    /// The first case whose value is another.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub departure: Option<String>,
}

/// How the values of a blend state are stored.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StoresOfState {
    /// The state's id.
    pub id: String,
    /// How it reached the blend unit.
    pub route: Word,
    /// By component.
    pub components: [StoreCounts; 4],
}
