//! What explains a case: its formula with the steps that it names, a mistake in it, and its course along one input.

use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What explains a failing case, worked out without the renderer.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Explained {
    /// The case.
    pub id: String,
    /// The formula, on a line.
    pub formula: Word,
    /// The rules that the formula on a line does not state.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rules: Vec<Word>,
    /// Where the formula is from.
    pub source: Word,
    /// The inputs by name, where no failure has them.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub inputs: serde_json::Map<String, serde_json::Value>,
    /// The units of those that have one.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub units: BTreeMap<String, Word>,
    /// The steps that the formula names.
    pub steps: Vec<ShownStep>,
    /// What a renderer with the mistake gives that explains the failure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mistake: Option<ShownMistake>,
    /// The failing output along one of the inputs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub course: Option<OutputCourse>,
}

/// A step of a formula.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ShownStep {
    /// The name of the step; the components of a vector have the same one.
    pub name: Word,
    /// Which component of a vector it is, such as `x`, or of a colour, such as `r`; missing for a number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub component: Option<Word>,
    /// The f64 reference.
    pub value: Number,
    /// The least and the greatest legal value.
    pub interval: [Number; 2],
}

/// What a renderer with a mistake gives.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ShownMistake {
    /// The mistake's name.
    pub name: Word,
    /// What it does, as the end of a sentence.
    pub says: Word,
    /// The outputs, each with its value in f64 and what such a renderer may give.
    pub outputs: Vec<ShownStep>,
    /// The steps at which it shows, in the order in which they are computed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub steps: Vec<MistakenStep>,
}

/// A number of a step that is another one with a mistake.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MistakenStep {
    /// The step's name.
    pub name: Word,
    /// As the published formula has it.
    pub right: Number,
    /// With the mistake.
    pub made: Number,
}

/// An output of a formula along one number of its inputs, all others held.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OutputCourse {
    /// The number of the inputs, such as `p.z`.
    pub input: String,
    /// Its unit, where it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<Word>,
    /// The number of the outputs, such as `color.r`.
    pub output: String,
    /// What the input is in the case.
    pub at: Number,
    /// What all other numbers of the inputs are, which are the same at each point.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub held: Vec<HeldNumber>,
    /// Whether inputs are spaced by their logarithms.
    pub is_logarithmic: bool,
    /// The points, from the least input to the greatest.
    pub points: Vec<CoursePoint>,
}

/// A number of the inputs that is the same along a course.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeldNumber {
    /// Its name, such as `p.z`.
    pub name: String,
    /// Its value.
    pub value: Number,
    /// Its unit, where it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<Word>,
}

/// A point of a course.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CoursePoint {
    /// The input.
    pub x: Number,
    /// The f64 reference.
    pub reference: Number,
    /// The least and the greatest legal value.
    pub interval: [Number; 2],
    /// What a renderer with the mistake gives.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mistaken: Option<Number>,
}
