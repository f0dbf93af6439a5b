//! What is found in a shader, step by step: the JSON of `check`.

use crate::thousands;
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
    /// A mistake, if the names in the shader mean what they say; or what the review and the judgement by a formula disagree on.
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
    /// The step as a function, by which it can be judged; none of a step that is no form of a value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub function: Option<StepFunction>,
    /// What became of it where it was judged as a formula.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub judged: Option<JudgedStep>,
}

/// A step as a function: what a shader computes between the values that the step is of and the step's own.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct StepFunction {
    /// Which form it is.
    pub form: String,
    /// A function of the name `shader_step`, in WGSL.
    pub wgsl: String,
    /// The form's parameters, in the order in which the form has them.
    pub parameters: Vec<StepParameter>,
}

/// A parameter of a form, as a shader has it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct StepParameter {
    /// The form's name of it: `n`, `density`, …
    pub name: String,
    /// Whether the shader has its negative.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_negated: bool,
    /// The bits of its numbers, where it is a constant in the shader, which `shader_step` is not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bits: Vec<u32>,
}

/// A case of a formula that a step fails.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FailingStep {
    /// The case.
    pub id: String,
    /// What it gives there, and what is legal.
    pub says: String,
}

/// How a step is judged as a formula.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct JudgedStep {
    /// The formula.
    pub formula: String,
    /// Who computed the step: an adapter, or the suite's own evaluation in f32.
    pub by: String,
    /// Random cases that were judged.
    pub random: u64,
    /// Those of them of which no implementation may give the value.
    pub random_wrong: u64,
    /// Hard cases, and cases at boundaries, that were judged.
    pub hard: u64,
    /// Those of them of which no implementation may give the value.
    pub hard_wrong: u64,
    /// A case that it fails, a random one where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failing: Option<FailingStep>,
    /// The mistake that explains what fails, in a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explanation: Option<String>,
    /// Why it could not be judged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
}

impl JudgedStep {
    /// Whether random cases show that it is wrong: one of a hundred at least.
    #[must_use]
    pub const fn is_wrong(&self) -> bool {
        self.random_wrong > 0 && self.random_wrong.saturating_mul(100) >= self.random
    }

    /// What is to be said of it, where there is something.
    #[must_use]
    pub fn says(&self) -> Option<String> {
        let Self { formula, random, random_wrong, hard, hard_wrong, .. } = self;
        if let Some(problem) = &self.problem {
            return Some(format!("cannot be judged as {formula}: {problem}"));
        }
        let (wrong, all, which) = match (random_wrong, hard_wrong) {
            (0, 0) => return None,
            (0, _) => (hard_wrong, hard, "hard"),
            _ => (random_wrong, random, "random"),
        };
        let case = self.failing.as_ref().map_or_else(String::new, |own| format!(": in {}, {}", own.id, own.says));
        let (wrong, all) = (thousands(*wrong), thousands(*all));
        let are = if wrong == "1" { "is" } else { "are" };
        Some(format!("by {formula}, {wrong} of {all} {which} cases {are} wrong{case}"))
    }
}

impl ShaderStep {
    /// What is to be said of it, with what became of it as a formula.
    #[must_use]
    pub fn says(&self) -> String {
        match self.judged_says() {
            Some(said) => format!("{}; {said}", self.sentence),
            None => self.sentence.clone(),
        }
    }

    /// What is to be said of it as a formula, where its sentence does not say so.
    #[must_use]
    pub fn judged_says(&self) -> Option<String> {
        self.judged.as_ref()?.says().filter(|said| !self.sentence.contains(said.as_str()))
    }

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
