//! What is found in a shader, step by step: the JSON of `check`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is found of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StepVerdict {
    /// As the formula has it.
    Right,
    /// Another form that has a name.
    Dialect,
    /// A mistake that has a name.
    Mistake,
    /// A mistake, if the names in the shader mean what they say.
    Perhaps,
}

/// A step of a shader.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ShaderStep {
    /// The line of the file, from 1; 0 where none is known.
    pub line: u32,
    /// Other lines that compute the same.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<u32>,
    /// Which step it is: `lambert`, `fog`, …
    pub kind: String,
    /// Whether it is right.
    pub verdict: StepVerdict,
    /// The dialect's or the mistake's name; empty of what is simply right.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// What is to be said of it.
    pub sentence: String,
    /// Whether it is meant as it is: a comment in the file accepts its name, or whoever asked does.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub accepted: bool,
    /// What the shader computes there.
    pub code: String,
}

impl ShaderStep {
    /// Whether it counts as wrong: a mistake that nobody accepts, and a dialect where that is asked for.
    #[must_use]
    pub fn is_wrong(&self, is_strict: bool) -> bool {
        let counts = self.verdict == StepVerdict::Mistake || is_strict && self.verdict == StepVerdict::Dialect;
        counts && !self.accepted
    }
}

/// What an output of a shader is made of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ShaderSum {
    /// The line of the file, from 1; 0 where none is known.
    pub line: u32,
    /// The output's name.
    pub output: String,
    /// Its terms: factors with `·` between them.
    pub terms: Vec<String>,
    /// What is done with their sum, in order: fog, encoding.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub then: Vec<String>,
}

/// A comment that accepts a name that no dialect and no mistake has.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RefusedName {
    /// The line of the file, from 1.
    pub line: u32,
    /// What is wrong, and which name may be meant.
    pub says: String,
}

/// What is found in a file.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ShaderReview {
    /// The file, as it was named.
    pub file: String,
    /// Why it is not read, and what would do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unread: Option<String>,
    /// Its language, with the version that it names.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub language: String,
    /// Who read it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub reader: String,
    /// What was taken for what is not there, and what was left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Comments that accept a name that no dialect and no mistake has.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refused: Vec<RefusedName>,
    /// Its steps, by line.
    pub steps: Vec<ShaderStep>,
    /// What its outputs are made of.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sums: Vec<ShaderSum>,
}

impl ShaderReview {
    /// How many of its steps have a verdict that nobody accepts.
    #[must_use]
    pub fn open(&self, verdict: StepVerdict) -> usize {
        self.steps.iter().filter(|step| step.verdict == verdict && !step.accepted).count()
    }
}
