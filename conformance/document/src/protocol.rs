//! What a renderer that runs as a process is told and asked, a line each: `lightmeter.protocol/1`.

use crate::Word;
use crate::list::ListedFormula;
use crate::made_by::LayerRequest;
use lightmeter_scene::target::TargetFormat;
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::fmt;

/// The protocol's name.
pub const PROTOCOL: &str = "lightmeter.protocol/1";

/// The first line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Greeting {
    /// `lightmeter.protocol/1`.
    #[schemars(extend("const" = PROTOCOL))]
    pub hello: Word,
    /// The version of lightmeter.
    pub version: Word,
    /// The folder that images are written to.
    pub folder: String,
}

/// The line that describes a formula. It is written before the formula's first case if the renderer's hello has `"describe": true`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FormulaDescription {
    /// The formula, as a pack's manifest has it, without the number of cases.
    pub describe: ListedFormula,
}

/// A case of a formula; of a blend state on a target, with the states that it is drawn by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CaseRequest {
    /// The case's id, which the answer has too.
    pub id: String,
    /// The formula's id.
    pub formula: String,
    /// The inputs by name: a number each, or an array of the components; `"NaN"`, `"Inf"` and `"-Inf"` for what JSON has no number for.
    pub inputs: Map<String, Value>,
    /// The target's format.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<TargetFormat>,
    /// The states, one for each layer in turn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blend: Option<Vec<LayerRequest>>,
}

/// An operation on special values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ProbeRequest {
    /// The probe's id.
    pub id: String,
    /// Its table.
    pub formula: String,
    /// The operation, in words.
    pub operation: Word,
    /// WGSL's function for it, where it has one.
    pub function: Option<Word>,
    /// The operands as numbers.
    pub inputs: Map<String, Value>,
    /// The same bit for bit.
    pub inputs_hex: Map<String, Value>,
}

/// A scene to be drawn.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SceneRequest {
    /// The scene's id.
    pub id: String,
    /// Where its file is: `lightmeter.frame/1`.
    pub scene: String,
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// The target's format.
    pub format: TargetFormat,
}

/// The end of a batch: all cases before it are to be answered now.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct BatchEnd {
    /// The number of the batch, from 1.
    pub batch: u64,
}

/// All cases of a batch of a formula. Behind the line follow `bytes` bytes: an array for each input, one behind the other, of the cases'
/// numbers in C's order, f32, little-endian.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ColumnsRequest {
    /// The formula's id.
    pub columns: String,
    /// The number of the batch, which the answer has too.
    pub batch: u64,
    /// How many cases there are.
    pub count: usize,
    /// The inputs, in the order of their arrays.
    pub inputs: Vec<RequestedColumn>,
    /// The outputs, in the order in which their arrays are to come.
    pub outputs: Vec<RequestedColumn>,
    /// Bytes behind the line.
    pub bytes: usize,
}

/// An input or an output of a request in columns.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RequestedColumn {
    /// Its name.
    pub name: Word,
    /// Numbers of a case.
    pub components: usize,
}

/// The answer to a request in columns. Where it has `bytes`, that many bytes follow the line: an array for each output.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct ColumnsAnswer {
    /// The formula's id.
    pub columns: String,
    /// The number of the batch.
    pub batch: u64,
    /// `<f4`, which it is without, or `<f8`.
    pub dtype: Option<String>,
    /// Bytes behind the line.
    pub bytes: Option<usize>,
    /// Why the renderer does none of these cases.
    pub skip: Option<String>,
    /// Why it could do none of them.
    pub error: Option<String>,
    /// Whether the cases are to be asked by lines.
    pub lines: bool,
}

/// A line that a renderer reads, which the published schema describes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ProtocolLine {
    /// The first line.
    Greeting(Greeting),
    /// An operation on special values.
    Probe(ProbeRequest),
    /// A scene to be drawn.
    Scene(SceneRequest),
    /// What a formula takes, gives and is computed by.
    Description(FormulaDescription),
    /// A case of a formula.
    Case(CaseRequest),
    /// A batch of a formula in columns.
    Columns(ColumnsRequest),
    /// The end of a batch.
    Batch(BatchEnd),
}

/// The JSON Schema of a line.
#[must_use]
pub fn schema() -> Schema {
    crate::schema::<ProtocolLine>()
}

macro_rules! lines {
    ($($line:ty)*) => {
        $(
            /// The line, without its line feed.
            impl fmt::Display for $line {
                fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                    f.write_str(&serde_json::to_string(self).map_err(|_| fmt::Error)?)
                }
            }
        )*
    };
}

lines! { Greeting FormulaDescription CaseRequest ProbeRequest SceneRequest ColumnsRequest }

/// The line, without its line feed. It has always had its space.
impl fmt::Display for BatchEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{{\"batch\": {}}}", self.batch)
    }
}
