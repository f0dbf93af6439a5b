//! What `bench --recommend` writes: the cheapest row of each group within an error limit, `lightmeter.recommendation/1`.

use crate::report::Interrupted;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// The schema of [`Recommendation`].
pub const SCHEMA: &str = "lightmeter.recommendation/1";

/// The inputs that a limit must hold on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Inputs {
    /// Random ones.
    Random,
    /// Hard cases and those near them.
    Hard,
    /// Both; where a group has no hard cases, random ones alone.
    #[default]
    All,
}

/// The error for an unknown name of inputs.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown inputs `{0}`; expected random, hard or all")]
pub struct InputsError(String);

impl FromStr for Inputs {
    type Err = InputsError;

    fn from_str(text: &str) -> Result<Self, InputsError> {
        match text {
            "random" => Ok(Self::Random),
            "hard" => Ok(Self::Hard),
            "all" => Ok(Self::All),
            _ => Err(InputsError(text.to_owned())),
        }
    }
}

/// What is recommended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Recommendation {
    /// `lightmeter.recommendation/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The limit, as it would be asked for.
    pub limit: String,
    /// The inputs that it must hold on.
    pub inputs: Inputs,
    /// The groups, adapter by adapter.
    pub groups: Vec<Advice>,
    /// What was under way when a signal ended the bench: groups are missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interrupted: Option<Interrupted>,
}

/// What is recommended of a group.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Advice {
    /// The adapter's short name.
    pub adapter: String,
    /// The group.
    pub group: String,
    /// What is compared.
    pub title: String,
    /// What a time is of.
    pub unit: String,
    /// The cheapest row within the limit.
    pub chosen: Option<Candidate>,
    /// Where none is, the row that misses the limit by the least.
    pub closest: Option<Candidate>,
    /// Where none is chosen, why.
    pub reason: Option<String>,
}

/// A row that could be taken.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Candidate {
    /// The name of the row.
    pub row: String,
    /// What the row is.
    pub what: String,
    /// Nanoseconds.
    pub ns: f64,
    /// Its time over the baseline's.
    pub ratio: f64,
    /// The range of that ratio.
    pub spread: [f64; 2],
    /// The largest error on those inputs, in the limit's unit.
    pub error: Number,
}
