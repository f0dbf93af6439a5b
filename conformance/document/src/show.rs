//! The JSON of `show`: a case of a formula, a probe of a special value, or a pixel of a scene.

pub use crate::explained::{MistakenStep, ShownMistake, ShownStep};
use crate::report::Examined;
use crate::special::{ProbeResult, Skipped};
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The schema of [`ShowDocument`].
pub const SCHEMA: &str = "lightmeter.show/1";

/// The JSON of `show`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ShowDocument {
    /// A case of a formula.
    Case(Box<ShownCase>),
    /// A probe of a special value.
    Probe(ShownProbe),
    /// A pixel of a scene.
    Pixel(ShownPixel),
}

/// A case of a formula.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ShownCase {
    /// `lightmeter.show/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The id of the case; of an alias, the id of what it is an alias of.
    pub id: String,
    /// The formula, on a line.
    pub formula: Word,
    /// The rules that the formula on a line does not state.
    #[serde(default)]
    pub rules: Vec<Word>,
    /// Where the formula is from.
    pub source: Word,
    /// What each input means.
    #[serde(default)]
    pub inputs_mean: Vec<ShownMeaning>,
    /// The inputs by name.
    pub inputs: serde_json::Map<String, serde_json::Value>,
    /// Their bits.
    pub inputs_hex: serde_json::Map<String, serde_json::Value>,
    /// The steps that the formula names.
    pub steps: Vec<ShownStep>,
    /// The outputs.
    pub outputs: Vec<ShownOutput>,
    /// How well the case can be computed, and how well the form promises to.
    pub conditioning: Conditioning,
    /// What each adapter gives in each stage.
    pub answers: Vec<ShownAnswer>,
    /// Of a hard case: its stable and its naive form.
    pub forms: Vec<Examined>,
    /// What a renderer with the mistake that was asked for gives.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mistake: Option<ShownMistake>,
}

/// What an input means.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ShownMeaning {
    /// The name of the input.
    pub name: Word,
    /// What it means.
    pub means: Word,
}

/// A number of the output.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ShownOutput {
    /// Its name, such as `color.g`.
    pub name: String,
    /// What the output means that it is a number of.
    #[serde(default)]
    pub means: Word,
    /// The f64 reference.
    pub reference: Number,
    /// The least and the greatest legal value.
    pub interval: [Number; 2],
    /// The condition number.
    pub condition: Number,
}

/// How well a case can be computed, and how well its form promises to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Conditioning {
    /// How many roundings of the result come of one rounding of each input.
    pub condition: Number,
    /// How many roundings the legal values reach from the reference; infinite where anything is legal.
    pub reach: Number,
    /// What follows.
    pub standing: FormStanding,
}

/// What the legal values of a form say of it at a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FormStanding {
    /// The result moves by no more than a few roundings, and so do the legal values.
    Stable,
    /// The inputs' own roundings move the result too far for any method.
    IllConditioned,
    /// The legal values reach much farther than the condition explains.
    Unstable,
    /// The rules permit anything, though the result is a number.
    NothingPromised,
    /// There is no value, or the least change of an input gives another one.
    Singular,
}

/// What an adapter gives in a stage.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ShownAnswer {
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
    /// Why the case was not evaluated there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skipped: Option<Word>,
    /// The values, where the case was evaluated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub values: Option<Vec<ShownValue>>,
}

/// A value that an adapter gives.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ShownValue {
    /// The name of the output's number.
    pub output: String,
    /// The value; of a blend unit in the target's units.
    pub value: Number,
    /// The bits; a blend unit's answer has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hex: Option<String>,
    /// The reference in the target's units, of a blend unit alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<Number>,
    /// The least and the greatest legal value, with what is known of the adapter.
    pub interval: [Number; 2],
    /// The verdict's name.
    pub outcome: Word,
    /// The error in ULP of the output's format, or in its steps.
    pub error_ulp: Number,
}

/// A probe of a special value.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ShownProbe {
    /// `lightmeter.show/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The id of the probe.
    pub id: String,
    /// What is computed.
    pub formula: Word,
    /// The section that makes the promise.
    pub source: Word,
    /// The operands.
    pub inputs: Vec<Number>,
    /// Their bits.
    pub inputs_hex: Vec<String>,
    /// What is promised, in words.
    pub promise: String,
    /// What each adapter gives in each stage.
    pub answers: Vec<ProbeResult>,
    /// Stages that an adapter lacks.
    pub skipped: Vec<Skipped>,
}

/// A pixel of a scene.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ShownPixel {
    /// `lightmeter.show/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The id of the pixel.
    pub id: String,
    /// The title of the scene.
    pub title: String,
    /// The format of the target.
    pub target: Word,
    /// Where the pixel is.
    pub pixel: PixelPlace,
    /// Each intermediate result, and at the end the colour.
    pub stages: Vec<ShownIntermediate>,
}

/// A pixel's column and row, from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PixelPlace {
    /// The column.
    pub x: usize,
    /// The row.
    pub y: usize,
}

/// An intermediate result of a pixel, or its colour.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ShownIntermediate {
    /// The name of the intermediate result, or `color`.
    pub stage: Word,
    /// The f64 reference; a colour is in the target's units.
    pub reference: [Number; 4],
    /// What is legal and what came out, adapter by adapter.
    pub seen: Vec<SeenIntermediate>,
}

/// What is legal of an intermediate result on an adapter, and what came out.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct SeenIntermediate {
    /// The adapter's short name; without an adapter, the name of the profile.
    pub adapter: String,
    /// The least legal values.
    pub low: [Number; 4],
    /// The greatest legal values.
    pub high: [Number; 4],
    /// Whether several outcomes are legal.
    pub marked: bool,
    /// What came out, where the scene was drawn.
    pub value: Option<[Number; 4]>,
}
