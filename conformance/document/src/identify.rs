//! The JSON of `identify`: which formula a shader computes.

use crate::Word;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The schema of [`IdentifyDocument`].
pub const SCHEMA: &str = "lightmeter.identify/1";

/// The JSON of `identify`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct IdentifyDocument {
    /// `lightmeter.identify/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The shader's file.
    pub file: String,
    /// The function of it, where it is not the shader as a whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub function: Option<String>,
    /// The adapter that it ran on.
    pub adapter: String,
    /// The formulas that it computes: every case of theirs passes. Forms of one formula that no case tells apart stand there together.
    pub is: Vec<String>,
    /// The formulas whose inputs its variables can be bound to, those with the fewest failures first.
    pub candidates: Vec<FormulaCandidate>,
}

/// A formula that a shader might compute.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FormulaCandidate {
    /// Its id.
    pub formula: String,
    /// Values judged.
    pub verdicts: u64,
    /// Of them, those that are wrong.
    pub failed: u64,
    /// What explains them: the mistake that leads from the formula to the shader.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explanation: Option<String>,
    /// What is wrong with its values all together, where each alone is legal: a systematic error, or a result that changes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
    /// The names of the mistakes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mistakes: Vec<String>,
    /// Outputs of the formula that the shader does not give.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub missing: Vec<String>,
}
