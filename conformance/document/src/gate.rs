//! What became of a gate: `lightmeter.gate/1`.

use crate::pack::Choice;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The schema's name.
pub const SCHEMA: &str = "lightmeter.gate/1";

/// A gate's result. What a baseline is compared by is required of a file; the rest may be missing.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct GateReport {
    /// `lightmeter.gate/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The command.
    #[serde(default)]
    pub command: String,
    /// The version of lightmeter.
    #[serde(default)]
    pub version: Word,
    /// What chose the cases.
    pub choice: Choice,
    /// The version of what draws them.
    pub generator: u64,
    /// The accuracy rules.
    pub profile: String,
    /// Who answered.
    #[serde(default)]
    pub renderer: RendererIdentity,
    /// How long it took.
    #[serde(default)]
    pub seconds: f64,
    /// Counts over all groups.
    #[serde(default)]
    pub totals: GateTotals,
    /// Lines that cannot be read as answers, or answer what nobody asked.
    #[serde(default)]
    pub problems: Problems,
    /// What went wrong with the process.
    #[serde(default)]
    pub incidents: Vec<String>,
    /// Crashes and hangs that are expected.
    #[serde(default)]
    pub expected_incidents: Vec<String>,
    /// How often it was started.
    #[serde(default)]
    pub starts: u64,
    /// The number of the signal that ended the gate before its time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub signal: Option<i32>,
    /// Formulas and scenes.
    pub groups: Vec<GateGroup>,
    /// The first failures of each.
    #[serde(default)]
    pub failures: Vec<GateFailure>,
    /// Cases whose answer changed: the first 1,000 of them.
    #[serde(default)]
    pub unstable: Vec<String>,
    /// Known failures, and what became of them.
    #[serde(default)]
    pub expectations: Vec<KnownFailure>,
    /// What is worse than in the baseline.
    #[serde(default)]
    pub regressions: Vec<String>,
}

/// A renderer.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct RendererIdentity {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
}

/// Counts of cases, but for the verdicts, which are of scalars.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct GateTotals {
    /// Asked for.
    pub asked: u64,
    /// Answered, and every verdict passed or permits anything.
    pub passed: u64,
    /// Failed.
    pub failed: u64,
    /// Of them, those at which the renderer ended or hung.
    #[serde(default)]
    pub broken: u64,
    /// Failed as is expected.
    pub expected_failures: u64,
    /// Expectations none of whose cases failed, though one was to.
    pub unexpected_passes: u64,
    /// Skipped by the renderer.
    pub skipped: u64,
    /// Never answered.
    pub missing: u64,
    /// Answered in another way when asked once more.
    pub unstable: u64,
    /// Cases that the renderer does not declare, and that were not asked.
    pub not_asked: u64,
    /// Scalars judged.
    pub verdicts: u64,
    /// Of them, those where anything is legal.
    pub indeterminate: u64,
}

/// A formula or a scene.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct GateGroup {
    /// Its id.
    pub id: String,
    /// Cases that were asked.
    pub asked: u64,
    /// Failed.
    pub failed: u64,
    /// Of them, those at which the renderer ended or hung.
    #[serde(default)]
    pub broken: u64,
    /// Of them, those that are expected to.
    pub expected_failures: u64,
    /// Skipped.
    pub skipped: u64,
    /// Never answered.
    pub missing: u64,
    /// Scalars judged.
    pub verdicts: u64,
    /// Of them, those where anything is legal.
    pub indeterminate: u64,
    /// The largest error in ULP of binary32; of a scene, in its target's ULP or steps.
    pub error_max: Number,
    /// The largest error of a case that passes.
    pub error_passing: Number,
    /// The mean error of the cases that pass.
    pub error_mean: Number,
    /// The largest margin.
    pub margin_max: Number,
    /// The case that it is of.
    pub worst: Option<String>,
    /// The cases that were asked and did not pass, by `failed`, `skipped` and `missing`: each by the end of its id, cases in a row
    /// as `random/000003..000017`.
    pub not_passed: BTreeMap<String, Vec<String>>,
    /// Why it was not asked, or why its cases were skipped.
    pub reason: Option<String>,
    /// What is wrong with the whole, where no single case shows it.
    pub problem: Option<String>,
    /// What explains its failures.
    pub diagnosis: Option<String>,
    /// The failing case with the simplest inputs.
    pub smallest: Option<String>,
}

impl GateGroup {
    /// Whether something fails that is not expected to.
    #[must_use]
    pub const fn is_failed(&self) -> bool {
        self.failed > self.expected_failures || self.missing > 0 || self.problem.is_some()
    }
}

impl GateReport {
    /// Whether the renderer broke off, or wrote what is no answer.
    #[must_use]
    pub fn is_broken(&self) -> bool {
        !self.incidents.is_empty() || !self.problems.is_empty()
    }

    /// Whether anything fails that is not expected to, or passes that is.
    #[must_use]
    pub fn is_failed(&self) -> bool {
        let totals = &self.totals;
        totals.unstable + totals.unexpected_passes > 0
            || !self.regressions.is_empty()
            || self.groups.iter().any(GateGroup::is_failed)
    }

    /// Whether anything was judged at all.
    #[must_use]
    pub const fn has_judged(&self) -> bool {
        self.totals.verdicts > self.totals.indeterminate
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

/// A case that failed.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct GateFailure {
    /// The case.
    pub id: String,
    /// Its inputs, row by row of the formula's description.
    pub inputs: Vec<Number>,
    /// The same by their names.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub named: serde_json::Map<String, serde_json::Value>,
    /// The units of those that have one.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub units: BTreeMap<String, Word>,
    /// The names of the outputs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outputs: Vec<String>,
    /// What the reference has.
    pub reference: Vec<Number>,
    /// From where to where values are legal.
    pub interval: Vec<[Number; 2]>,
    /// What was answered.
    pub value: Vec<Number>,
    /// The largest error in ULP.
    pub error_ulp: Number,
    /// What is wrong, where it is not a value.
    pub problem: Option<String>,
}

/// A known failure, and what became of its cases.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct KnownFailure {
    /// A glob of cases.
    pub id: String,
    /// Why they fail.
    pub reason: String,
    /// Cases of it that failed.
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

/// `1 case`, `12 cases`.
#[must_use]
pub fn cases(count: u64) -> String {
    if count == 1 { "1 case".into() } else { format!("{count} cases") }
}
