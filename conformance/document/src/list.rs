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

/// A formula with its inputs and outputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ListedFormula {
    /// The id of the formula.
    pub id: String,
    /// The formula, on a line.
    pub formula: Word,
    /// The rules that the formula on a line does not state: divisors of 0, vectors of length 0, edges and ties, what is clamped.
    #[serde(default)]
    pub rules: Vec<Word>,
    /// Where the formula is from.
    pub source: Word,
    /// What computes it or draws it.
    #[serde(default)]
    pub made_by: MadeBy,
    /// The stages that judge it: `compute`, `fragment`, `fixed-function` or `raster`.
    pub stages: Vec<Word>,
    /// What the formula claims, where it is a stable form.
    pub stable: Option<StableClaim>,
    /// The inputs, in their order.
    pub inputs: Vec<ListedInput>,
    /// The outputs, in their order.
    pub outputs: Vec<ListedOutput>,
    /// Other ids of the same formula.
    pub aliases: Vec<String>,
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

/// An input of a formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ListedInput {
    /// The name of the input.
    pub name: Word,
    /// `scalar`, `vec2`, `vec3`, `vec4`, `mat3` or `mat4`; matrices are column by column.
    pub shape: Word,
    /// The unit.
    pub unit: Word,
    /// What the input means: which way it points, whether the formula normalises it, in which space it is.
    #[serde(default)]
    pub means: Word,
    /// What random cases draw the input from.
    pub domain: ListedDomain,
}

/// An output of a formula.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ListedOutput {
    /// The name of the output.
    pub name: Word,
    /// `scalar`, `vec2`, `vec3`, `vec4`, `mat3` or `mat4`; matrices are column by column.
    pub shape: Word,
    /// The unit.
    pub unit: Word,
    /// What the output means.
    #[serde(default)]
    pub means: Word,
}

/// What random cases draw an input from. Bounds are those of f32, widened exactly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "Domain")]
pub enum ListedDomain {
    /// Evenly from low to high, each component.
    Uniform(f64, f64),
    /// Evenly in the logarithm, each component.
    LogUniform(f64, f64),
    /// Colour components: evenly from 0 to 1, now and then exactly 0 or 1.
    Unit,
    /// A unit vector, as near as f32 holds one.
    Direction,
    /// A vector of any direction and of a length drawn evenly in the logarithm.
    Vector(f64, f64),
    /// Barycentric weights: they sum to 1 as nearly as f32 allows.
    Weights,
    /// Whole numbers, the ends included.
    Whole(u32, u32),
    /// Multiples of 1/2 from low to high.
    Halves(f64, f64),
    /// A rotation, a scale of each axis drawn evenly in the logarithm, and a shear.
    Transform(f64, f64),
    /// A vertex in clip coordinates near the case's pixel.
    Around,
    /// A pixel of the middle of the rasteriser's target.
    Pixel,
}
