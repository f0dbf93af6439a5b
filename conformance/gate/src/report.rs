//! What became of a gate, drawn up from its ledger.

use super::answer::clipped;
use super::ledger::Ledger;
use super::plan::{CasePlace, GatePlan};
use super::process::Ending;
use super::tally::AnswerTally;
use super::verdict;
use lightmeter_document::Number;
use lightmeter_document::gate::{
    GateFailure, GateGroup, GateReport, GateTotals, KnownFailure, RendererIdentity, SCHEMA, cases,
};
use lightmeter_faults::Mistakes;
use lightmeter_judge::diagnose::{self as explained, Row};
use lightmeter_judge::sample::Sample;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Failures with their numbers in a report.
const MOST_FAILURES: usize = 1000;
/// The part of a group's random verdicts that may permit anything.
const MOST_INDETERMINATE: f64 = 0.01;

/// What a ledger holds.
#[must_use]
pub fn report(ledger: &mut Ledger<'_>, outcome: Ending, command: String, seconds: f64) -> GateReport {
    ledger.close();
    let plan = ledger.plan();
    let mut totals = GateTotals { unstable: ledger.unstable_count, ..GateTotals::default() };
    let (mut groups, mut failures) = (vec![], vec![]);
    let told: Vec<(GateGroup, Option<GateFailure>)> =
        ledger.tallies.par_iter().enumerate().map(|(k, tally)| group(ledger, k, tally)).collect();
    for (k, (tally, (group, smallest))) in ledger.tallies.iter().zip(told).enumerate() {
        totals.asked += tally.asked;
        totals.failed += tally.failed;
        totals.broken += tally.broken;
        totals.expected_failures += tally.expected;
        totals.skipped += tally.skipped;
        totals.missing += tally.missing;
        totals.verdicts += tally.verdicts.totals.verdicts;
        totals.indeterminate += tally.verdicts.totals.indeterminate;
        totals.passed += tally.answered() - (tally.failed - tally.unjudged);
        if tally.undeclared.is_some() {
            totals.not_asked += plan.formulas.get(k).map_or(1, |formula| formula.count() as u64);
        }
        // The smallest is there whatever else has no room.
        let rest = tally.verdicts.failures.values().filter(|one| smallest.as_ref().is_none_or(|own| own.id != one.id));
        let room = MOST_FAILURES.saturating_sub(failures.len());
        failures.extend(smallest.iter().chain(rest.take(room)).cloned());
        groups.push(group);
    }
    let expectations: Vec<KnownFailure> = ledger.expectations.iter().map(|expected| expected.known.clone()).collect();
    totals.unexpected_passes = expectations.iter().filter(|one| one.passes_unexpectedly()).count() as u64;
    GateReport {
        schema: SCHEMA.into(),
        command,
        version: env!("CARGO_PKG_VERSION").into(),
        choice: plan.choice.clone(),
        generator: lightmeter_catalogue::cases::GENERATOR_VERSION,
        profile: ledger.profile().name.into(),
        renderer: RendererIdentity { name: clipped(&outcome.hello.renderer), version: clipped(&outcome.hello.version) },
        seconds,
        totals,
        problems: ledger.problems.clone(),
        incidents: outcome.incidents,
        expected_incidents: outcome.expected_incidents,
        starts: outcome.starts,
        signal: outcome.signal,
        groups,
        failures,
        unstable: ledger.unstable.clone(),
        expectations,
        regressions: vec![],
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
                smallest: tally.verdicts.failures.values().next().cloned(),
                ..Self::default()
            };
        }
        let member = plan.member(k);
        let [failing, passing] = &tally.rows;
        let told = explained::Told::of(
            &Mistakes,
            member,
            [&rows(plan, k, failing), &rows(plan, k, passing)],
            failing.seen,
            ledger.profile(),
        );
        let Some((_, smallest)) = &tally.smallest else {
            return Self { systematic: told.systematic, ..Self::default() };
        };
        let mut diagnosis = told.explanation.unwrap_or_default();
        if tally.unjudged > 0 {
            diagnosis += &format!("; besides, {} were not answered by values", cases(tally.unjudged));
        }
        let smallest = verdict::failure(plan, k, smallest.case, &smallest.values, ledger.profile());
        Self { diagnosis: Some(diagnosis), smallest: Some(smallest), ..Self::default() }
    }
}

/// The rows of a sample of a formula, with their inputs.
fn rows<'a>(plan: &GatePlan, formula: usize, sample: &'a Sample<usize>) -> Vec<Row<'a>> {
    let is_random = |case| plan.formulas[formula].is_random(case);
    let row = |(case, values)| (plan.inputs(formula, case), values, is_random(case));
    sample.rows().into_iter().map(row).collect()
}

fn group(ledger: &Ledger<'_>, k: usize, tally: &AnswerTally) -> (GateGroup, Option<GateFailure>) {
    let plan = ledger.plan();
    let told = Told::new(ledger, k, tally);
    let id = if k < plan.formulas.len() {
        plan.member(k).spec.id.clone()
    } else {
        plan.id(CasePlace::Scene(k - plan.formulas.len()))
    };
    let (random, indeterminate) = tally.verdicts.random;
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
        broken: tally.broken,
        expected_failures: tally.expected,
        skipped: tally.skipped,
        missing: tally.missing,
        verdicts: tally.verdicts.totals.verdicts,
        indeterminate: tally.verdicts.totals.indeterminate,
        error_max: Number(tally.verdicts.error_max),
        error_passing: Number(tally.error_passing),
        error_mean: Number(ratio(tally.errors.0, tally.errors.1)),
        margin_max: Number(tally.verdicts.worst.map_or(0.0, |(margin, _)| margin)),
        worst: tally.verdicts.worst.map(|(_, place)| plan.id(place)),
        not_passed,
        reason,
        problem: problem.or(told.systematic),
        diagnosis: told.diagnosis,
        smallest: told.smallest.as_ref().map(|failure| failure.id.clone()),
    };
    (group, told.smallest)
}
