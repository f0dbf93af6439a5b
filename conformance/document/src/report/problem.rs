//! What is wrong with a group as a whole, although each of its values may be legal.

use crate::Word;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::{self, Display, Formatter};

/// Why a group fails as a whole.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Problem {
    /// Of what kind.
    pub kind: ProblemKind,
    /// In words.
    pub says: Sentence,
    /// The way in which values are stored, where one is told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub store: Option<Word>,
}

/// Of what kind it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProblemKind {
    /// Too many verdicts permit anything.
    Indeterminate,
    /// All values together show a parameter that is a little off.
    Systematic,
    /// The pixels of an image lie to one side.
    Bias,
    /// A component is stored in another way than by the nearest step, in all blend states together.
    Store,
    /// The same in one state.
    StoreOfState,
    /// Values are not stored as the device's known model has them.
    Model,
    /// A special value is not the one that is on record for the driver.
    Special,
    /// A stable form does not keep its bound.
    Stability,
}

/// Words for people: they can be shown and written, and nothing is decided by them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Sentence(String);

impl Problem {
    /// A problem of a kind, in words.
    #[must_use]
    pub fn new(kind: ProblemKind, says: impl Into<String>) -> Self {
        Self { kind, says: Sentence(says.into()), store: None }
    }
}

impl From<String> for Sentence {
    fn from(says: String) -> Self {
        Self(says)
    }
}

impl Display for Problem {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.says.fmt(f)
    }
}

impl Display for Sentence {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
