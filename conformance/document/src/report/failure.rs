//! A failing case, as a report has it.

use crate::by_case::FailedAnswer;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A value outside its interval.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Failure {
    /// The case.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The stage's name.
    pub stage: Word,
    /// The format that the blend unit worked on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<Word>,
    /// How the state reached the blend unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub route: Option<Word>,
    /// Which sample of its pixel it is, from 0, where pixels have more than one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<u32>,
    /// The scalar output's name.
    pub output: String,
    /// The inputs by name.
    pub inputs: serde_json::Map<String, serde_json::Value>,
    /// The units of those that have one.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub units: BTreeMap<String, Word>,
    /// Their bits.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub inputs_hex: serde_json::Map<String, serde_json::Value>,
    /// The f64 reference.
    pub reference: Number,
    /// The least and the greatest legal value.
    pub interval: [Number; 2],
    /// What is legal in words, where an interval does not say it: of a special value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub promise: Option<String>,
    /// What came out.
    pub value: Number,
    /// Its bits.
    pub value_hex: String,
    /// Whether it was never written.
    pub unwritten: bool,
    /// The error in ULP of the output's format, or in its steps.
    pub error_ulp: Number,
    /// The command that runs the case alone.
    pub rerun: String,
    /// All that was answered to the case, where it was answered as a whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub answer: Option<FailedAnswer>,
}

impl Failure {
    /// The format that was blended on; of a scene, which is drawn on one as well, none.
    #[must_use]
    pub fn blended_on(&self) -> Option<&Word> {
        self.target.as_ref().filter(|_| !self.id.starts_with("scene/"))
    }

    /// A failure without inputs and numbers.
    #[must_use]
    pub fn new(id: String, adapter: String, stage: impl Into<Word>) -> Self {
        let none = Number(f64::NAN);
        Self {
            id,
            adapter,
            stage: stage.into(),
            target: None,
            route: None,
            sample: None,
            output: String::new(),
            inputs: serde_json::Map::new(),
            units: BTreeMap::new(),
            inputs_hex: serde_json::Map::new(),
            reference: none,
            interval: [none; 2],
            promise: None,
            value: none,
            value_hex: String::new(),
            unwritten: false,
            error_ulp: none,
            rerun: String::new(),
            answer: None,
        }
    }
}
