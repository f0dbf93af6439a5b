//! What a report says by cases, beside the counts of verdicts: of subjects that are asked case by case, and wherever a run is compared
//! with another one.

use crate::count::counters;
use crate::pack::Choice;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

counters! {
    /// Counts of cases, each of which has a verdict for each scalar output.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
    pub struct CaseTotals {
        /// Cases that were asked.
        pub asked: u64,
        /// Cases that the renderer does not declare, and that were not asked.
        pub not_asked: u64,
        /// Every verdict passed, or permits anything.
        pub passed: u64,
        /// Failed.
        pub failed: u64,
        /// Of them, those whose answer could not be judged.
        pub unjudged: u64,
        /// Of them, those at which the renderer ended or hung.
        pub broken: u64,
        /// Failed as is expected.
        pub expected_failures: u64,
        /// Skipped.
        pub skipped: u64,
        /// Of them, those of which nobody declared that they would be.
        #[serde(default, skip_serializing_if = "is_zero")]
        pub undeclared: u64,
        /// Never answered.
        pub missing: u64,
    }
}

/// What became of a group's cases.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct CaseCounts {
    /// How many of them there are of each fate.
    #[serde(flatten)]
    pub totals: CaseTotals,
    /// The largest error of a case that passes.
    pub error_passing: Number,
    /// The mean error of the cases that pass.
    pub error_mean: Number,
    /// How many errors that is the mean of: a finite one of each verdict.
    pub errors: u64,
    /// The cases that were asked and did not pass, by `failed`, `skipped` and `missing`: each by the end of its id, cases in a row
    /// as `random/000003..000017`.
    pub not_passed: BTreeMap<String, Vec<String>>,
    /// Why it was not asked, or why its cases were skipped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The failing case with the simplest inputs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smallest: Option<String>,
}

impl CaseCounts {
    /// Whether something fails that is not expected to, or was not answered.
    #[must_use]
    pub const fn is_failed(&self) -> bool {
        let CaseTotals { failed, expected_failures, missing, undeclared, .. } = self.totals;
        failed > expected_failures || missing > 0 || undeclared > 0
    }
}

/// How much of what was chosen was judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coverage {
    /// Cases that were chosen: those that were asked, and those of formulas and scenes that the filter names and the renderer lacks.
    pub chosen: u64,
    /// Of them, those that were judged.
    pub judged: u64,
    /// Of them, those that were excluded by name or for want of a feature, or skipped.
    pub excluded: u64,
}

impl Coverage {
    /// The part that is required where nothing else is said.
    pub const REQUIRED: f64 = 0.5;

    /// Whether at least this part of what was chosen was judged.
    #[must_use]
    pub fn is_enough(self, required: f64) -> bool {
        #[expect(clippy::cast_precision_loss, reason = "counts of cases")]
        let [chosen, judged] = [self.chosen, self.judged].map(|count| count as f64);
        judged >= required * chosen
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
pub(crate) const fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// An answer to a case that is wrong, with all of its outputs.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct FailedAnswer {
    /// The inputs, one after the other.
    pub inputs: Vec<Number>,
    /// The outputs' names.
    pub outputs: Vec<String>,
    /// What the reference has.
    pub reference: Vec<Number>,
    /// From where to where values are legal.
    pub interval: Vec<[Number; 2]>,
    /// What was answered.
    pub value: Vec<Number>,
    /// What is wrong, where it is not a value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
}

/// What must be the same for two runs to be compared.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ComparedBy {
    /// What chose the cases.
    pub choice: Choice,
    /// The version of what draws them.
    pub generator: u64,
    /// The formats that were asked to be blended on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub targets: Vec<Word>,
    /// Of a renderer, those that it declares.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub declared: Vec<Word>,
    /// Sampled states with another one for alpha.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub separate: Option<u64>,
    /// Which part of them, as `2/8`; none for all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<String>,
}

/// A renderer that was asked, and what went wrong with it apart from its answers.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct RendererUse {
    /// Its name and version.
    #[serde(flatten)]
    pub identity: RendererIdentity,
    /// How often it was started.
    pub starts: u64,
    /// Lines that cannot be read as answers, or answer what nobody asked.
    pub problems: Problems,
    /// What went wrong with the process.
    pub incidents: Vec<String>,
    /// Crashes and hangs that are expected.
    pub expected_incidents: Vec<String>,
    /// What its hello declared besides, by the hello's fields; those that say nothing are left out.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub declares: serde_json::Map<String, serde_json::Value>,
    /// What makes the verdicts doubtful, though nothing failed by it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

impl RendererUse {
    /// Whether the renderer broke off, or wrote what is no answer.
    #[must_use]
    pub fn is_broken(&self) -> bool {
        !self.incidents.is_empty() || !self.problems.is_empty()
    }
}

/// A renderer.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct RendererIdentity {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// What it computes on, where it says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// The driver of that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub driver: Option<String>,
}

impl fmt::Display for RendererIdentity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, version, device, driver } = self;
        write!(f, "{name}{}{version}", if version.is_empty() { "" } else { " " })?;
        for (before, what) in [(" on ", device), (", ", driver)] {
            if let Some(what) = what {
                write!(f, "{before}{what}")?;
            }
        }
        Ok(())
    }
}

/// Where a renderer's code of a formula or a scene stands, as its hello says.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SourcePlace {
    /// The file, as it is called from the root of the repository where annotations are to stand in it.
    pub file: String,
    /// The line, from 1; the whole file is meant where it is missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<u64>,
}

impl fmt::Display for SourcePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        self.line.map_or(Ok(()), |line| write!(f, ":{line}"))
    }
}

/// Answers that cannot be read, or that nobody asked for.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct Problems {
    /// How many of each kind.
    pub counts: BTreeMap<Word, u64>,
    /// The first of them, in words.
    pub first: Vec<String>,
}

impl Problems {
    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }
}

/// A known failure, and what became of its cases.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct KnownFailure {
    /// A glob of cases.
    pub id: String,
    /// Why they fail.
    pub reason: String,
    /// The stage or the target that they fail on; any without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// The mistakes that make them fail: other failures of the same cases are not expected. Any without it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mistake: Vec<String>,
    /// Cases of it that failed, and groups of it that failed as a whole.
    pub failed: u64,
    /// Cases of it that passed.
    pub passed: u64,
    /// Whether the renderer may end or hang at them.
    pub crash: bool,
    /// Whether they may pass.
    pub may_pass: bool,
}

impl KnownFailure {
    /// Whether its cases were asked and none failed: it is to be taken out.
    #[must_use]
    pub const fn passes_unexpectedly(&self) -> bool {
        self.failed == 0 && self.passed > 0 && !self.may_pass
    }
}
