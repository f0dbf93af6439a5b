//! What became of a gate: `lightmeter.gate/1`.

use crate::by_case::{CaseCounts, ComparedBy, Coverage, FailedAnswer, RendererUse, SourcePlace, is_zero};
pub use crate::by_case::{KnownFailure, Problems, RendererIdentity};
use crate::explained::Explained;
use crate::pack::Choice;
use crate::run::{
    ConfigUse, Failure, Group, Identity, ImageUse, Interrupted, Report, StoresOfShard, Totals, WorstAnswer,
};
use crate::{Number, Word, thousands};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashSet};

/// The schema's name.
pub const SCHEMA: &str = "lightmeter.gate/1";
/// Failures with their numbers in a report, besides the smallest of each group.
const MOST_FAILURES: usize = 1000;

/// A gate's result. What a baseline is compared by is required of a file; the rest may be missing.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct GateReport {
    /// `lightmeter.gate/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The command.
    #[serde(default)]
    pub command: String,
    /// The command that asks for one case again, but for the case's id.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub again: Option<String>,
    /// The version of lightmeter.
    #[serde(default)]
    pub version: Word,
    /// When it was made, in UTC, such as `2026-05-01T12:00:00Z`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_at: Option<String>,
    /// What chose the cases.
    pub choice: Choice,
    /// The version of what draws them.
    pub generator: u64,
    /// The same with what else chose the cases: targets and the shard.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compared_by: Option<ComparedBy>,
    /// The accuracy rules.
    pub profile: String,
    /// Who answered.
    #[serde(default)]
    pub renderer: RendererIdentity,
    /// What its hello declared besides, by the hello's fields; those that say nothing are left out.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub declares: serde_json::Map<String, serde_json::Value>,
    /// What makes the verdicts doubtful, though nothing failed by it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// How long it took.
    #[serde(default)]
    pub seconds: f64,
    /// The part of the chosen cases that had to be judged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub required: Option<Number>,
    /// Counts over all groups.
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
    /// Why the gate ended before its time. What was not answered until then counts as missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interrupted: Option<Interrupted>,
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
    /// What is better than in the baseline.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mended: Vec<String>,
    /// What the baseline has not.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub added: Vec<String>,
    /// What explains the first failing case of each formula and, where few were judged, the worst case of those that pass.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub explained: Vec<Explained>,
    /// What a project's `lightmeter.toml` said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub config: Option<ConfigUse>,
}

/// Counts of cases, but for the verdicts, which are of scalars.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
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
    /// Of them, those of which nobody declared that they would be.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub undeclared: u64,
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
#[non_exhaustive]
pub struct GateGroup {
    /// Its id.
    pub id: String,
    /// The format that was blended on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<Word>,
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
    /// Of them, those of which nobody declared that they would be.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub undeclared: u64,
    /// Never answered.
    pub missing: u64,
    /// Not asked, since the renderer does not declare it.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub not_asked: u64,
    /// Scalars judged.
    pub verdicts: u64,
    /// Of them, those where anything is legal.
    pub indeterminate: u64,
    /// What a shard's values say of how a target stores them, for the whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stores: Option<StoresOfShard>,
    /// The largest error in ULP of binary32; of a scene, in its target's ULP or steps.
    pub error_max: Number,
    /// The largest error of a case that passes.
    pub error_passing: Number,
    /// The mean error of the cases that pass.
    pub error_mean: Number,
    /// How many errors that is the mean of.
    #[serde(default)]
    pub errors: u64,
    /// The largest margin.
    pub margin_max: Number,
    /// The case that it is of.
    pub worst: Option<String>,
    /// What was answered to it, at the output that the margin is of; missing where no row of inputs was answered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst_answer: Option<WorstAnswer>,
    /// The cases that were asked and did not pass, by `failed`, `skipped` and `missing`: each by the end of its id, cases in a row
    /// as `random/000003..000017`.
    pub not_passed: BTreeMap<String, Vec<String>>,
    /// Why it was not asked, or why its cases were skipped.
    pub reason: Option<String>,
    /// What is wrong with the whole, where no single case shows it.
    pub problem: Option<String>,
    /// The same, where a known failure says that it is so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected_problem: Option<String>,
    /// What explains its failures.
    pub diagnosis: Option<String>,
    /// What the renderer did wrong, in words, without how many failures it explains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cause: Option<String>,
    /// The names of the mistakes that explain them together.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mistakes: Vec<String>,
    /// The failing case with the simplest inputs.
    pub smallest: Option<String>,
    /// Of a scene whose image is wrong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<ImageUse>,
    /// Where the renderer's code of it stands, where its hello says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<SourcePlace>,
}

impl GateGroup {
    /// Its id, and the target that was blended on.
    #[must_use]
    pub fn name(&self) -> String {
        self.target.as_ref().map_or_else(|| self.id.clone(), |target| format!("{} on {target}", self.id))
    }

    /// Whether something fails that is not expected to.
    #[must_use]
    pub const fn is_failed(&self) -> bool {
        self.failed > self.expected_failures || self.missing > 0 || self.undeclared > 0 || self.problem.is_some()
    }
}

impl GateGroup {
    /// A group of a run, with the counts of its cases.
    #[must_use]
    pub fn of(group: &Group, counts: &CaseCounts) -> Self {
        Self {
            id: group.id.clone(),
            target: group.target.clone().filter(|_| !group.id.starts_with("scene/")),
            asked: counts.asked,
            failed: counts.failed,
            broken: counts.broken,
            expected_failures: counts.expected_failures,
            skipped: counts.skipped,
            undeclared: counts.undeclared,
            missing: counts.missing,
            not_asked: counts.not_asked,
            verdicts: group.totals.verdicts,
            indeterminate: group.totals.indeterminate,
            stores: group.stores.clone(),
            error_max: group.error_ulp_max,
            error_passing: counts.error_passing,
            error_mean: counts.error_mean,
            errors: counts.errors,
            margin_max: group.margin_max,
            worst: group.worst.clone(),
            worst_answer: group.worst_answer.clone(),
            not_passed: counts.not_passed.clone(),
            reason: counts.reason.clone(),
            problem: group.problem.clone(),
            expected_problem: group.expected_problem.clone(),
            diagnosis: group.explanation.clone(),
            cause: group.cause.clone(),
            mistakes: group.mistakes.clone(),
            smallest: counts.smallest.clone(),
            image: group.image.clone().filter(|image| !image.pixels.is_empty()),
            source: group.source.clone(),
        }
    }
}

impl GateFailure {
    /// A failure of a run; `None` where it is not one of a whole answer.
    #[must_use]
    pub fn of(failure: &Failure) -> Option<Self> {
        let answer = failure.answer.as_ref()?;
        Some(Self {
            id: failure.id.clone(),
            target: failure.target.clone().filter(|_| !failure.id.starts_with("scene/")),
            inputs: answer.inputs.clone(),
            named: failure.inputs.clone(),
            units: failure.units.clone(),
            outputs: answer.outputs.clone(),
            reference: answer.reference.clone(),
            interval: answer.interval.clone(),
            value: answer.value.clone(),
            error_ulp: failure.error_ulp,
            problem: answer.problem.clone(),
        })
    }
}

impl GateReport {
    /// What a run of a renderer came to, counted by its cases.
    #[must_use]
    pub fn of(report: &Report, command: String, again: Option<String>) -> Self {
        let mut totals = GateTotals { unstable: report.unstable, ..GateTotals::default() };
        let mut groups = vec![];
        for group in &report.groups {
            let Some(counts) = &group.by_case else { continue };
            totals.asked += counts.asked;
            totals.passed += counts.passed;
            totals.failed += counts.failed;
            totals.broken += counts.broken;
            totals.expected_failures += counts.expected_failures;
            totals.skipped += counts.skipped;
            totals.undeclared += counts.undeclared;
            totals.missing += counts.missing;
            totals.not_asked += counts.not_asked;
            totals.verdicts += group.totals.verdicts;
            totals.indeterminate += group.totals.indeterminate;
            groups.push(GateGroup::of(group, counts));
        }
        totals.unexpected_passes = report.passing_unexpectedly().count() as u64;
        let renderer = report.renderer.clone().unwrap_or_default();
        let compared_by = report.compared_by.clone().unwrap_or_default();
        Self {
            schema: SCHEMA.into(),
            command,
            again,
            version: env!("CARGO_PKG_VERSION").into(),
            made_at: report.made_at.clone(),
            choice: compared_by.choice,
            generator: compared_by.generator,
            compared_by: report.compared_by.clone(),
            profile: report.profile.to_string(),
            renderer: renderer.identity,
            declares: renderer.declares,
            warnings: renderer.warnings,
            seconds: report.seconds,
            required: report.required,
            totals,
            problems: renderer.problems,
            incidents: renderer.incidents,
            expected_incidents: renderer.expected_incidents,
            starts: renderer.starts,
            signal: report.interrupted.as_ref().and_then(|interrupted| interrupted.signal),
            interrupted: report.interrupted.clone(),
            groups,
            failures: failures(report),
            unstable: report.unstable_cases.clone(),
            expectations: report.expectations.clone(),
            regressions: report.regressions.clone(),
            mended: report.mended.clone(),
            added: report.added.clone(),
            explained: report.explained.clone(),
            config: report.config.clone(),
        }
    }

    /// How many of the cases that were chosen were judged.
    #[must_use]
    pub const fn coverage(&self) -> Coverage {
        let totals = &self.totals;
        Coverage {
            chosen: totals.asked + totals.not_asked,
            judged: totals.asked.saturating_sub(totals.skipped).saturating_sub(totals.missing),
            excluded: totals.not_asked + totals.skipped,
        }
    }

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

impl RendererIdentity {
    /// The same as a run tells of an adapter.
    #[must_use]
    pub fn of_run(&self) -> Identity {
        Identity {
            name: self.name.clone(),
            device: self.device.clone().unwrap_or_else(|| self.name.clone()),
            backend: "renderer".into(),
            driver: self.driver.clone().unwrap_or_else(|| self.version.clone()),
        }
    }
}

/// The run that a gate is a view of, as far as that tells.
impl From<GateReport> for Report {
    fn from(gate: GateReport) -> Self {
        let identity = gate.renderer.of_run();
        // Earlier versions wrote the signal alone.
        let by_signal = gate.signal.map(|signal| Interrupted {
            under_way: "the gate".into(),
            message: "a signal ended the gate".into(),
            signal: Some(signal),
            at_first_failure: false,
        });
        let interrupted = gate.interrupted.or(by_signal);
        let compared_by = gate.compared_by.unwrap_or_else(|| ComparedBy {
            choice: gate.choice.clone(),
            generator: gate.generator,
            ..ComparedBy::default()
        });
        let renderer = RendererUse {
            identity: gate.renderer,
            starts: gate.starts,
            problems: gate.problems,
            incidents: gate.incidents,
            expected_incidents: gate.expected_incidents,
            declares: gate.declares,
            warnings: gate.warnings,
        };
        let name = &identity.name;
        Self {
            groups: gate.groups.into_iter().map(|group| group.of_run(name)).collect(),
            failures: gate.failures.into_iter().map(|failure| failure.of_run(name, gate.again.as_deref())).collect(),
            seconds: gate.seconds,
            required: gate.required,
            renderer: Some(renderer),
            unstable: gate.totals.unstable,
            unstable_cases: gate.unstable,
            expectations: gate.expectations,
            regressions: gate.regressions,
            mended: gate.mended,
            added: gate.added,
            explained: gate.explained,
            command: Some(gate.command),
            version: Some(gate.version),
            made_at: gate.made_at,
            config: gate.config,
            interrupted,
            compared_by: Some(compared_by),
            ..Self::empty(gate.choice.seed, gate.profile.into(), gate.choice.filter, vec![identity.clone()])
        }
    }
}

impl GateGroup {
    /// The group of a run.
    fn of_run(self, adapter: &str) -> Group {
        // Verdicts are counted by cases here: a gate does not say how many of them failed.
        let totals = Totals {
            failed: self.failed - self.expected_failures.min(self.failed),
            cases: self.asked,
            verdicts: self.verdicts,
            skipped: self.skipped,
            indeterminate: self.indeterminate,
            ..Totals::default()
        };
        let counts = CaseCounts {
            asked: self.asked,
            not_asked: self.not_asked,
            passed: self.asked.saturating_sub(self.failed).saturating_sub(self.skipped).saturating_sub(self.missing),
            failed: self.failed,
            unjudged: 0,
            broken: self.broken,
            expected_failures: self.expected_failures,
            skipped: self.skipped,
            undeclared: self.undeclared,
            missing: self.missing,
            error_passing: self.error_passing,
            error_mean: self.error_mean,
            errors: self.errors,
            not_passed: self.not_passed,
            reason: self.reason,
            smallest: self.smallest,
        };
        Group {
            target: self.target,
            stores: self.stores,
            totals,
            error_ulp_max: self.error_max,
            margin_max: self.margin_max,
            worst: self.worst,
            worst_answer: self.worst_answer,
            explanation: self.diagnosis,
            cause: self.cause,
            mistakes: self.mistakes,
            problem: self.problem,
            expected_problem: self.expected_problem,
            by_case: Some(counts),
            image: self.image,
            source: self.source,
            ..Group::new(self.id, adapter.to_owned(), "answer")
        }
    }
}

impl GateFailure {
    /// The failure of a run.
    fn of_run(self, adapter: &str, again: Option<&str>) -> Failure {
        let on = self.target.as_ref().map(|target| format!(" --target {target}")).unwrap_or_default();
        let is_out = |k: &usize| {
            let ([low, high], value) = (self.interval[*k], self.value[*k]);
            !(low.0 <= value.0 && value.0 <= high.0)
        };
        let judged = self.value.len().min(self.interval.len()).min(self.outputs.len()).min(self.reference.len());
        let wrong = (0..judged).find(is_out);
        Failure {
            rerun: again.map(|again| format!("{again}{on} {}", self.id)).unwrap_or_default(),
            output: wrong.map_or_else(Default::default, |k| self.outputs[k].clone()),
            value: wrong.map_or(Number(f64::NAN), |k| self.value[k]),
            reference: wrong.map_or(Number(f64::NAN), |k| self.reference[k]),
            interval: wrong.map_or([Number(f64::NAN); 2], |k| self.interval[k]),
            target: self.target,
            inputs: self.named,
            units: self.units,
            error_ulp: self.error_ulp,
            answer: Some(FailedAnswer {
                inputs: self.inputs,
                outputs: self.outputs,
                reference: self.reference,
                interval: self.interval,
                value: self.value,
                problem: self.problem,
            }),
            ..Failure::new(self.id, adapter.to_owned(), "answer")
        }
    }
}

/// The failures with their numbers: the smallest of each group, and of the rest as many as there is room for.
fn failures(report: &Report) -> Vec<GateFailure> {
    let counts = report.groups.iter().filter_map(|group| group.by_case.as_ref());
    let smallest: HashSet<&str> = counts.filter_map(|counts| counts.smallest.as_deref()).collect();
    let mut room = MOST_FAILURES;
    let has_room = |failure: &&Failure| {
        let is_smallest = smallest.contains(failure.id.as_str());
        let has_room = is_smallest || room > 0;
        room = if is_smallest { room } else { room.saturating_sub(1) };
        has_room
    };
    report.failures.iter().filter(has_room).filter_map(GateFailure::of).collect()
}

/// A case that failed.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct GateFailure {
    /// The case.
    pub id: String,
    /// The format that was blended on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<Word>,
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

/// `1 case`, `12 cases`.
#[must_use]
pub fn cases(count: u64) -> String {
    if count == 1 { "1 case".into() } else { format!("{} cases", thousands(count)) }
}
