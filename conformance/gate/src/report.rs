//! What became of a gate: `lightmeter.gate/1`.

use super::answer::clipped;
use super::expectations::KnownFailure;
use super::ledger::{Ledger, Problems};
use super::plan::{Choice, Place};
use super::process::Ending;
use super::tally::{AnswerTally, Sample};
use super::verdict::GateFailure;
use lightmeter_document::Number;
use lightmeter_faults::{Answered, diagnose, group_verdict};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The schema's name.
pub const SCHEMA: &str = "lightmeter.gate/1";
/// Failures with their numbers in a report.
const MOST_FAILURES: usize = 1000;
/// The part of a group's random verdicts that may permit anything.
const MOST_INDETERMINATE: f64 = 0.01;

/// A gate's result.
#[derive(Clone, Debug, Serialize)]
pub struct GateReport {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// The command.
    pub command: String,
    /// The version of lightmeter.
    pub version: &'static str,
    /// What chose the cases.
    pub choice: Choice,
    /// The version of what draws them.
    pub generator: u64,
    /// The accuracy rules.
    pub profile: String,
    /// Who answered.
    pub renderer: Named,
    /// How long it took.
    pub seconds: f64,
    /// Counts over all groups.
    pub totals: GateTotals,
    /// Lines that are no answers.
    pub problems: Problems,
    /// What went wrong with the process.
    pub incidents: Vec<String>,
    /// Crashes and hangs that are expected.
    pub expected_incidents: Vec<String>,
    /// How often it was started.
    pub starts: u64,
    /// Formulas and scenes.
    pub groups: Vec<GateGroup>,
    /// The first failures of each.
    pub failures: Vec<GateFailure>,
    /// Cases whose answer changed: the first 1,000 of them.
    pub unstable: Vec<String>,
    /// Known failures, and what became of them.
    pub expectations: Vec<KnownFailure>,
    /// What is worse than in the baseline.
    pub regressions: Vec<String>,
}

/// A renderer.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Named {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
}

/// Counts of cases, but for the verdicts, which are of scalars.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct GateTotals {
    /// Asked for.
    pub asked: u64,
    /// Answered, and every verdict passed or permits anything.
    pub passed: u64,
    /// Failed.
    pub failed: u64,
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
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GateGroup {
    /// Its id.
    pub id: String,
    /// Cases that were asked.
    pub asked: u64,
    /// Failed.
    pub failed: u64,
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
    /// What a ledger holds.
    #[must_use]
    pub fn new(ledger: &mut Ledger<'_>, outcome: Ending, command: String, seconds: f64) -> Self {
        ledger.close();
        let plan = ledger.plan();
        let mut totals = GateTotals { unstable: ledger.unstable_count, ..GateTotals::default() };
        let (mut groups, mut failures) = (vec![], vec![]);
        let told: Vec<(GateGroup, Option<GateFailure>)> =
            ledger.tallies.par_iter().enumerate().map(|(k, tally)| group(ledger, k, tally)).collect();
        for (k, (tally, (group, smallest))) in ledger.tallies.iter().zip(told).enumerate() {
            totals.asked += tally.asked;
            totals.failed += tally.failed;
            totals.expected_failures += tally.expected;
            totals.skipped += tally.skipped;
            totals.missing += tally.missing;
            totals.verdicts += tally.verdicts;
            totals.indeterminate += tally.indeterminate;
            totals.passed += tally.answered - (tally.failed - tally.unjudged);
            if tally.undeclared.is_some() {
                totals.not_asked += plan.formulas.get(k).map_or(1, |formula| formula.count() as u64);
            }
            // The smallest is there whatever else has no room.
            let rest = tally.failures.iter().filter(|one| smallest.as_ref().is_none_or(|own| own.id != one.id));
            let room = MOST_FAILURES.saturating_sub(failures.len());
            failures.extend(smallest.iter().chain(rest.take(room)).cloned());
            groups.push(group);
        }
        let expectations = ledger.expectations.clone();
        totals.unexpected_passes = expectations.iter().filter(|one| one.passes_unexpectedly()).count() as u64;
        Self {
            schema: SCHEMA,
            command,
            version: env!("CARGO_PKG_VERSION"),
            choice: plan.choice.clone(),
            generator: lightmeter_catalogue::cases::GENERATOR_VERSION,
            profile: ledger.profile().name.into(),
            renderer: Named { name: clipped(&outcome.hello.renderer), version: clipped(&outcome.hello.version) },
            seconds,
            totals,
            problems: ledger.problems.clone(),
            incidents: outcome.incidents,
            expected_incidents: outcome.expected_incidents,
            starts: outcome.starts,
            groups,
            failures,
            unstable: ledger.unstable.clone(),
            expectations,
            regressions: vec![],
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

/// What explains the failures of a formula, what is wrong with all of its values, and its simplest failing case.
#[derive(Default)]
struct Told {
    diagnosis: Option<String>,
    systematic: Option<String>,
    smallest: Option<GateFailure>,
}

impl Told {
    fn new(ledger: &Ledger<'_>, k: usize, tally: &AnswerTally) -> Self {
        let plan = ledger.plan();
        if k >= plan.formulas.len() {
            return Self {
                diagnosis: tally.diagnosis.clone(),
                smallest: tally.failures.first().cloned(),
                ..Self::default()
            };
        }
        let member = plan.member(k);
        let of = |is_wrong: bool, sample: &Sample| -> Vec<(usize, Vec<f32>, Vec<f32>, bool)> {
            sample.rows().map(|(case, values)| (case, plan.inputs(k, case), values.to_vec(), is_wrong)).collect()
        };
        let [failing, passing] = &tally.rows;
        let rows: Vec<_> = of(true, failing).into_iter().chain(of(false, passing)).collect();
        let answered: Vec<Answered<'_>> =
            rows.iter().map(|(_, inputs, values, is_wrong)| Answered { inputs, values, is_wrong: *is_wrong }).collect();
        let Some((_, smallest)) = &tally.smallest else {
            // Hard cases are where formulas are steep, and say nothing of a parameter.
            let random: Vec<Answered<'_>> = (rows.iter().zip(&answered))
                .filter(|(row, _)| plan.formulas[k].is_random(row.0))
                .map(|(_, answered)| *answered)
                .collect();
            let systematic = group_verdict(member, &random, ledger.profile()).map(|systematic| systematic.says);
            return Self { systematic, ..Self::default() };
        };
        let mut diagnosis = diagnose(member, &answered, ledger.profile()).sentence_of(failing.seen);
        if tally.unjudged > 0 {
            diagnosis += &format!("; besides, {} were not answered by values", cases(tally.unjudged));
        }
        let smallest = GateFailure::of_values(plan, k, smallest.case, &smallest.values, ledger.profile());
        Self { diagnosis: Some(diagnosis), smallest: Some(smallest), ..Self::default() }
    }
}

/// So many cases, in words.
#[must_use]
pub(super) fn cases(count: u64) -> String {
    if count == 1 { "1 case".into() } else { format!("{count} cases") }
}

fn group(ledger: &Ledger<'_>, k: usize, tally: &AnswerTally) -> (GateGroup, Option<GateFailure>) {
    let plan = ledger.plan();
    let told = Told::new(ledger, k, tally);
    let id = if k < plan.formulas.len() {
        plan.member(k).spec.id.clone()
    } else {
        plan.id(Place::Scene(k - plan.formulas.len()))
    };
    let [random, indeterminate] = tally.random;
    #[expect(clippy::cast_precision_loss, reason = "counts of verdicts")]
    let ratio = |part: f64, whole: u64| if whole == 0 { 0.0 } else { part / whole as f64 };
    #[expect(clippy::cast_precision_loss, reason = "counts of verdicts")]
    let share = ratio(indeterminate as f64, random);
    let problem = (share > MOST_INDETERMINATE).then(|| {
        let rules = ledger.profile().name;
        format!("{:.1} % of its random verdicts permit anything under the profile {rules}", 100.0 * share)
    });
    let reason = tally.undeclared.clone().or_else(|| (!tally.reasons.is_empty()).then(|| tally.reasons.join("; ")));
    let not_passed = if tally.asked > 0 { ledger.known().not_passed(plan, k) } else { BTreeMap::new() };
    let group = GateGroup {
        id,
        asked: tally.asked,
        failed: tally.failed,
        expected_failures: tally.expected,
        skipped: tally.skipped,
        missing: tally.missing,
        verdicts: tally.verdicts,
        indeterminate: tally.indeterminate,
        error_max: Number(tally.error_max),
        error_passing: Number(tally.error_passing),
        error_mean: Number(ratio(tally.errors.0, tally.errors.1)),
        margin_max: Number(tally.margin_max),
        worst: tally.worst.map(|place| plan.id(place)),
        not_passed,
        reason,
        problem: problem.or(told.systematic),
        diagnosis: told.diagnosis,
        smallest: told.smallest.as_ref().map(|failure| failure.id.clone()),
    };
    (group, told.smallest)
}
