//! What a sweep is of and what was found: `lightmeter.sweep/1`.

mod histogram;
pub mod presets;
mod statistics;

pub use crate::stores::StoreCounts;
pub use histogram::Histogram;
pub use statistics::{ExactFloat, Statistics, StoreStatistics, SweepInput, SweepPart, SweepVerdict};

use crate::Word;
use crate::hash::hash;
use crate::report::Identity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The schema of a sweep's file.
pub const SCHEMA: &str = "lightmeter.sweep/1";

/// A sweep's file.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SweepDocument {
    /// `lightmeter.sweep/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The command, but for where its result goes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// The version of lightmeter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<Word>,
    /// When it was made, in UTC, such as `2026-05-01T12:00:00Z`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_at: Option<String>,
    /// What is swept.
    pub sweep: Description,
    /// Which part of it, as `2/8`.
    pub shard: String,
    /// Blocks of that part that are done, the first ones.
    pub done: u64,
    /// Blocks of that part.
    pub blocks: u64,
    /// How long that took.
    pub seconds: f64,
    /// What was found.
    pub statistics: Statistics,
    /// A hash of all above.
    #[serde(default)]
    pub checksum: String,
}

impl SweepDocument {
    /// Whether every block is done.
    #[must_use]
    pub const fn is_finished(&self) -> bool {
        self.done == self.blocks
    }
}

/// What is swept, on what, by which rules: files of the same sweep have the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// The formula's id.
    pub formula: String,
    /// What is free.
    pub over: String,
    /// The least float.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub from: Option<ExactFloat>,
    /// The greatest.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub to: Option<ExactFloat>,
    /// The other inputs by name.
    pub fixed: Vec<(String, ExactFloat)>,
    /// The output.
    pub output: String,
    /// What errors are counted in: `ULP` or `step`.
    pub unit: String,
    /// The stage.
    pub stage: String,
    /// The adapter.
    pub adapter: Identity,
    /// The accuracy rules.
    pub profile: String,
    /// A hash of the shader's text; of the version, where the embedded implementation is swept.
    pub shader: String,
    /// All inputs.
    pub inputs: u64,
    /// Inputs of a block.
    pub block: u64,
}

impl SweepDocument {
    /// The checksum of all but the checksum itself.
    ///
    /// # Errors
    /// Where it is no JSON, which cannot be.
    pub(crate) fn sum(&self) -> serde_json::Result<String> {
        let unsigned = Self { checksum: String::new(), ..self.clone() };
        Ok(hash(serde_json::to_string(&unsigned)?.as_bytes()))
    }
}
