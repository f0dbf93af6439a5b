//! The lines of `eval`: a request each way in, an answer each way out.
//!
//! The cases of a pack are such requests, and a renderer's answers may be such answers.

use crate::{Number, Unique};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// A line that `eval` reads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EvalRequest {
    /// Any value; the answer has the same one.
    pub id: Value,
    /// The id of the formula.
    pub formula: String,
    /// The inputs by name: a number each, or an array of the components.
    #[schemars(schema_with = "inputs")]
    pub inputs: Map<String, Value>,
}

/// A line that `eval` writes. The arrays have an entry for each number of the output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EvalAnswer {
    /// The id of the request.
    pub id: Value,
    /// The f64 reference.
    pub value: Vec<Number>,
    /// The least legal values.
    pub low: Vec<Number>,
    /// The greatest legal values.
    pub high: Vec<Number>,
    /// The greatest condition number.
    pub condition: Number,
}

/// What `eval` writes for a line that it cannot answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EvalRefusal {
    /// The id of the line, null where it has none.
    pub id: Value,
    /// What is wrong with it, and where.
    pub error: String,
}

/// A line of either kind, which the published schema describes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum EvalLine {
    /// A line that `eval` reads.
    Request(EvalRequest),
    /// A line that `eval` writes.
    Answer(EvalAnswer),
    /// What it writes for a line that it cannot answer.
    Refusal(EvalRefusal),
}

/// Why a line is not a request.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RequestError {
    /// It is not JSON.
    #[error("not JSON: {0}")]
    Json(String),
    /// It is JSON, and no object.
    #[error("expected an object such as {{\"id\": 1, \"formula\": \"fog/linear\", \"inputs\": {{…}}}}")]
    Object,
    /// A field that no request has.
    #[error("field `{0}` is not known; expected `id`, `formula` and `inputs`")]
    Unknown(String),
    /// There is no id.
    #[error("field `id` is missing; expected a string or a number")]
    Id,
    /// There is no formula.
    #[error("field `formula` is missing or not a string; expected one such as \"fog/linear\"")]
    Formula,
    /// There are no inputs.
    #[error("field `inputs` is missing or not an object of numbers by name")]
    Inputs,
}

impl EvalRequest {
    /// Reads a line. The inputs are left as they are: what they should be depends upon the formula.
    ///
    /// # Errors
    /// Where the line is not a request; the error names the field.
    pub fn read(line: &str) -> Result<Self, RequestError> {
        let Unique(value) = serde_json::from_str(line).map_err(|error| RequestError::Json(error.to_string()))?;
        let Value::Object(mut fields) = value else { return Err(RequestError::Object) };
        if let Some(name) = fields.keys().find(|name| !["id", "formula", "inputs"].contains(&name.as_str())) {
            return Err(RequestError::Unknown(name.clone()));
        }
        let id = fields.remove("id").ok_or(RequestError::Id)?;
        let Some(Value::String(formula)) = fields.remove("formula") else { return Err(RequestError::Formula) };
        let Some(Value::Object(inputs)) = fields.remove("inputs") else { return Err(RequestError::Inputs) };
        Ok(Self { id, formula, inputs })
    }
}

/// The JSON Schema of a line.
#[must_use]
pub fn schema() -> Schema {
    crate::schema::<EvalLine>()
}

fn inputs(generator: &mut SchemaGenerator) -> Schema {
    let number = generator.subschema_for::<Number>();
    json_schema!({
        "type": "object",
        "additionalProperties": { "anyOf": [number, { "type": "array", "items": number }] }
    })
}
