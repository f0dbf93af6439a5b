//! The JSON of `list`: the cases, `lightmeter.cases/1`, or with `--formulas` the formulas, `lightmeter.formulas/1`.

use crate::made_by::MadeBy;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The schema of [`CasesDocument`].
pub const CASES: &str = "lightmeter.cases/1";
/// The schema of [`FormulasDocument`].
pub const FORMULAS: &str = "lightmeter.formulas/1";

/// The JSON of `list`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CasesDocument {
    /// `lightmeter.cases/1`.
    #[schemars(extend("const" = CASES))]
    pub schema: Word,
    /// What the filter selects: formulas first, then tables of special values, scenes and deviations.
    pub cases: Vec<ListedCases>,
}

/// The cases of one formula, table, scene or deviation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ListedCases {
    /// Of a formula.
    Formula(FormulaCases),
    /// Of a table of special values.
    Table(TableCases),
    /// Of a scene.
    Scene(SceneCases),
    /// The witness of a named deviation.
    Deviation(DeviationCase),
}

/// The cases of a formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FormulaCases {
    /// The id of the formula.
    pub formula: String,
    /// The number of random cases.
    pub random: u64,
    /// The hard cases.
    pub hard: Vec<HardCase>,
    /// The number of cases close to where the formula decides or degenerates: `…/boundary/0000` and those that follow.
    #[serde(default)]
    pub boundary: u64,
    /// Other ids of the same formula.
    pub aliases: Vec<String>,
    /// The id of the first random case, where the random cases are numbered from there on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first: Option<Vec<String>>,
    /// The ids of the random cases, where the filter selects single ones.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ids: Option<Vec<String>>,
}

/// A hard case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HardCase {
    /// The id of the case.
    pub id: String,
    /// What the case pins.
    pub pins: Word,
    /// The condition number. The cases of blend states have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub condition: Option<Number>,
    /// The number of cases within a few ULP of it, given where there is a condition number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near: Option<u64>,
    /// The naive form that fails at this case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub naive: Option<NaiveForm>,
}

/// A naive form of a stable formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NaiveForm {
    /// The id of the naive formula.
    pub formula: Word,
    /// What goes wrong with it, in words.
    pub fails: Word,
    /// Its error is at least this many roundings; infinite where it gives no usable number.
    pub at_least: Number,
}

/// A table of special values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TableCases {
    /// The id of the table.
    pub table: String,
    /// What the table is about.
    pub title: Word,
    /// The probes, each of which is a case.
    pub probes: Vec<ListedProbe>,
}

/// A probe of a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ListedProbe {
    /// The id of the probe.
    pub id: String,
    /// What is computed.
    pub computes: Word,
    /// What is promised, in words.
    pub promise: String,
    /// The section that promises it.
    pub source: Word,
}

/// A scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SceneCases {
    /// The id of the scene.
    pub scene: String,
    /// Its title.
    pub title: String,
    /// What is to be seen.
    pub shows: String,
    /// The number of selected pixels, each of which is a case.
    pub pixels: u64,
}

/// The witness of a named deviation, which is one case.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct DeviationCase {
    /// The id of the deviation.
    pub deviation: String,
    /// Why the deviation is granted.
    pub reason: Word,
}

/// The JSON of `list --formulas`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FormulasDocument {
    /// `lightmeter.formulas/1`.
    #[schemars(extend("const" = FORMULAS))]
    pub schema: Word,
    /// The formulas that the filter selects.
    pub formulas: Vec<ListedFormula>,
}

/// A formula with its inputs and outputs. Packs and the protocol have what a renderer needs of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ListedFormula {
    /// The id of the formula.
    pub id: String,
    /// The formula, on a line.
    pub formula: Word,
    /// The rules that the formula on a line does not state: divisors of 0, vectors of length 0, edges and ties, what is clamped.
    #[serde(default)]
    pub rules: Vec<Word>,
    /// Where the formula is from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<Word>,
    /// What computes it or draws it.
    #[serde(default)]
    pub made_by: MadeBy,
    /// The stages that judge it: `compute`, `fragment`, `fixed-function` or `raster`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<Word>,
    /// What the formula claims, where it is a stable form.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stable: Option<StableClaim>,
    /// The inputs, in the order of a case's numbers.
    pub inputs: Vec<ListedValue>,
    /// The outputs, in the order of an answer's numbers.
    pub outputs: Vec<ListedValue>,
    /// Other ids of the same formula.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub aliases: Vec<String>,
    /// How many cases a pack has of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
}

impl ListedFormula {
    /// The same without rules, meanings and what computes it. They explain the cases and do not choose them, and packs of older versions have none.
    #[must_use]
    pub fn without_explanations(&self) -> Self {
        let plain = |values: &[ListedValue]| {
            values.iter().map(|value| ListedValue { means: Word::default(), ..value.clone() }).collect()
        };
        Self {
            rules: vec![],
            made_by: MadeBy::default(),
            inputs: plain(&self.inputs),
            outputs: plain(&self.outputs),
            ..self.clone()
        }
    }
}

/// The claim of a stable form: at its hard cases and near them it errs by no more than this.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StableClaim {
    /// The largest error, in roundings.
    pub bound: f64,
    /// What a rounding is relative to: `own`, the result's length, or `unit`, that length or 1 if that is greater.
    pub size: Word,
    /// The reason for the bound, and where the form may be used.
    pub because: Word,
}

/// An input or an output of a formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ListedValue {
    /// Its name.
    pub name: Word,
    /// `scalar`, `vec2`, `vec3`, `vec4`, `mat3` or `mat4`; matrices are column by column.
    pub shape: Word,
    /// Its unit.
    pub unit: Word,
    /// What it means: which way it points, whether the formula normalises it, in which space it is.
    #[serde(default)]
    pub means: Word,
    /// What random cases draw it from, where it is an input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub domain: Option<Domain>,
}

/// What random cases draw an input from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Domain {
    /// Evenly from low to high, each component.
    Uniform(f32, f32),
    /// Evenly in the logarithm, each component.
    LogUniform(f32, f32),
    /// Colour components: evenly from 0 to 1, now and then exactly 0 or 1.
    Unit,
    /// A unit vector, as near as f32 holds one.
    Direction,
    /// A vector of any direction and of a length drawn evenly in the logarithm.
    Vector(f32, f32),
    /// Barycentric weights: they sum to 1 as nearly as f32 allows.
    Weights,
    /// Whole numbers, the ends included.
    Whole(u32, u32),
    /// Multiples of 1/2 from low to high.
    Halves(f32, f32),
    /// A rotation, a scale of each axis drawn evenly in the logarithm, mirrored half the time, and a shear; in a 4 × 4
    /// matrix also a translation and a last row near (0, 0, 0, 1).
    Transform(f32, f32),
    /// A vertex in clip coordinates: its place 8 to 60 pixels from the case's pixel, w from 0.5 to 8.
    Around,
    /// A pixel of the middle of the rasteriser's target, another for each of 16,384 consecutive cases.
    Pixel,
}

/// What random cases are drawn from, in words.
impl std::fmt::Display for Domain {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Uniform(low, high) => write!(f, "{low} to {high}"),
            Self::LogUniform(low, high) => write!(f, "{low} to {high}, evenly in the logarithm"),
            Self::Unit => f.write_str("0 to 1"),
            Self::Direction => f.write_str("a unit vector"),
            Self::Vector(low, high) => write!(f, "of length {low} to {high}"),
            Self::Weights => f.write_str("weights that sum to 1"),
            Self::Whole(low, high) => write!(f, "whole, {low} to {high}"),
            Self::Halves(low, high) => write!(f, "halves, {low} to {high}"),
            Self::Transform(low, high) => write!(f, "a transform with scales of {low} to {high}"),
            Self::Around => f.write_str("a vertex around the pixel"),
            Self::Pixel => f.write_str("a pixel"),
        }
    }
}
