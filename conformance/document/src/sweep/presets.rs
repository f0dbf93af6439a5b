//! The list of ready-made sweeps, which `sweep --format json` writes without a formula: `lightmeter.presets/1`.

use crate::Word;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The schema of [`PresetsDocument`].
pub const SCHEMA: &str = "lightmeter.presets/1";

/// The list of ready-made sweeps.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PresetsDocument {
    /// `lightmeter.presets/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The sweeps.
    pub presets: Vec<ListedPreset>,
}

/// A ready-made sweep.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ListedPreset {
    /// The id of the formula.
    pub formula: Word,
    /// The free input with its range, in words.
    pub over: String,
    /// What the sweep is of, on a line.
    pub what: Word,
}
