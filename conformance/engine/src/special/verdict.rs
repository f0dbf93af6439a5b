//! The tables of special values as groups of a run: `special/nan`, `special/infinity`, …, a case for each probe.

use super::run::{EMBEDDED, Results, evaluate};
use crate::device::DeviceError;
use crate::expected::expect;
use crate::options::Options;
use crate::subject::Subject;
use lightmeter_catalogue::filter::Filter;
use lightmeter_catalogue::select::Shard;
use lightmeter_catalogue::special::{Class, PROBES, Probe, Way, deviation_of};
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::report::{DeviationUse, Failure, Group, Report, Totals};
use lightmeter_document::special::SpecialDeviation;
use lightmeter_document::special::{ProbeResult, ProbeVerdict, Skipped};
use lightmeter_document::{Number, Word};
use lightmeter_judge::simplicity;
use lightmeter_judge::tally::KEPT_FAILURES;
use lightmeter_scene::target::SENTINEL;
use std::collections::BTreeMap;
use std::time::Instant;

/// The stages that a probe may be evaluated in, in the order of reports.
const STAGES: [&str; 3] = ["compute", "fragment", "raster"];

/// A table, or some of its probes.
#[derive(Clone, Debug)]
pub struct Table {
    /// What the probes are about.
    pub class: Class,
    /// The probes, in the table's order.
    pub probes: Vec<&'static Probe>,
}

impl Table {
    /// The id: `special/nan`.
    #[must_use]
    pub fn id(&self) -> String {
        self.class.table()
    }

    /// How many results there are on each subject: one for each probe and stage.
    #[must_use]
    pub fn work(&self) -> u64 {
        STAGES.iter().map(|stage| self.in_stage(stage)).sum()
    }

    /// The probes that are functions, which can be asked for by themselves.
    pub fn functions(&self) -> impl Iterator<Item = &'static Probe> {
        self.probes.iter().copied().filter(|probe| probe.function().is_some())
    }

    /// Probes that a stage evaluates.
    fn in_stage(&self, stage: &str) -> u64 {
        let is_raster = stage == "raster";
        self.probes.iter().filter(|probe| matches!(probe.way, Way::Varying { .. }) == is_raster).count() as u64
    }
}

/// The tables that a filter and a shard select, with the probes that they select of them.
#[must_use]
pub fn select(filter: &Filter, shard: Shard) -> Vec<Table> {
    let chosen = |place: usize, probe: &Probe| shard.has(place as u64) && filter.selects(&probe.id());
    let table = |class: Class| {
        let probes = PROBES.iter().enumerate().filter(|&(place, probe)| probe.class == class && chosen(place, probe));
        Table { class, probes: probes.map(|(_, probe)| probe).collect() }
    };
    Class::ALL.into_iter().map(table).filter(|table| !table.probes.is_empty()).collect()
}

/// Judges a table on every subject.
///
/// # Errors
/// Where a shader is invalid, or a device fails.
pub(crate) fn run_table(
    table: &Table,
    subjects: &[Subject],
    options: &Options,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<(), DeviceError> {
    for subject in subjects {
        let clock = Instant::now();
        let results = evaluate(subject, &options.code, &table.probes)?;
        let seconds = clock.elapsed().as_secs_f64();
        report.timing.devices += seconds;
        match results {
            None => {
                let group = Group { stage: STAGES[0].into(), ..table.group(subject) };
                let cases = table.probes.len() as u64;
                report.groups.push(skipped(group, cases, EMBEDDED.into()));
            }
            Some(results) => table.judge(&results, subject, seconds, options, report),
        }
        observer.see(&Event::Advanced(table.work()));
    }
    Ok(())
}

fn skipped(group: Group, cases: u64, reason: Word) -> Group {
    Group { skip_reason: Some(reason), totals: Totals { cases, skipped: cases, ..Totals::default() }, ..group }
}

impl Table {
    fn group(&self, subject: &Subject) -> Group {
        Group::new(self.id(), subject.identity.name.clone(), STAGES[0])
    }

    fn judge(&self, results: &Results, subject: &Subject, seconds: f64, options: &Options, report: &mut Report) {
        for stage in STAGES.into_iter().filter(|stage| self.in_stage(stage) > 0) {
            let group = Group { stage: stage.into(), ..self.group(subject) };
            if let Some(Skipped { reason, .. }) = results.skipped.iter().find(|skipped| skipped.stage == stage) {
                report.groups.push(skipped(group, self.in_stage(stage), reason.clone()));
                continue;
            }
            let of_stage: Vec<&ProbeResult> =
                results.outcomes.iter().filter(|outcome| outcome.stage == stage).collect();
            let mut totals =
                Totals { cases: of_stage.len() as u64, verdicts: of_stage.len() as u64, ..Totals::default() };
            for outcome in &of_stage {
                let id = Probe::by_name(&outcome.probe).map(Probe::id).unwrap_or_default();
                let is_expected = expect(report, options, &id, &[stage], outcome.verdict.is_failure(), None);
                match outcome.verdict {
                    ProbeVerdict::Kept => totals.passed += 1,
                    ProbeVerdict::Broken | ProbeVerdict::Changed if is_expected => totals.expected_failures += 1,
                    ProbeVerdict::Broken | ProbeVerdict::Changed => totals.failed += 1,
                    ProbeVerdict::Indeterminate => totals.indeterminate += 1,
                    ProbeVerdict::Deviates => {
                        totals.expected_failures += 1;
                        let probe = Probe::by_name(&outcome.probe);
                        let deviation = probe.and_then(|probe| deviation_of(probe, &subject.identity.backend));
                        if let Some(deviation) = deviation {
                            granted(deviation, &subject.identity.name, report);
                        }
                    }
                }
            }
            let failing = of_stage.into_iter().filter(|outcome| outcome.verdict.is_failure());
            let mut failures: Vec<(u32, Failure)> =
                failing.filter_map(|outcome| failure(outcome, results, subject)).collect();
            failures.sort_by_key(|(simple, _)| *simple);
            report.failures.extend(failures.into_iter().map(|(_, failure)| failure).take(KEPT_FAILURES));
            #[expect(clippy::cast_precision_loss, reason = "a share of a short time")]
            let share = totals.verdicts as f64 / results.outcomes.len().max(1) as f64;
            report.groups.push(Group { totals, seconds: seconds * share, ..group });
        }
    }
}

/// Counts a verdict that a deviation excused. Where no witness is asked, the verdict alone says that the deviation is needed.
fn granted(deviation: &SpecialDeviation, adapter: &str, report: &mut Report) {
    if !report.deviations.iter().any(|known| known.name == deviation.name && known.adapter == adapter) {
        report.deviations.push(DeviationUse {
            name: deviation.name.clone(),
            adapter: adapter.into(),
            reason: deviation.reason.clone(),
            still_needed: true,
            excused: 0,
        });
    }
    report.excuse(&deviation.name, adapter, 1);
}

/// What is known of a result that fails, and how simple its operands are.
pub(super) fn failure(outcome: &ProbeResult, results: &Results, subject: &Subject) -> Option<(u32, Failure)> {
    let probe = Probe::by_name(&outcome.probe)?;
    let (reference, interval) = probe.promise.bounds(probe.gives);
    let legal = match (outcome.verdict, outcome.recorded) {
        (ProbeVerdict::Changed, Some(recorded)) => {
            let whose = results.record.as_ref().map_or("the driver", |record| &record.of);
            format!("{}, by the record of {whose}", probe.gives.word(recorded))
        }
        _ => format!("{}, by {}", probe.promise.words(probe.gives), probe.source.section()),
    };
    let named = |value: &dyn Fn(u32) -> serde_json::Value| {
        Probe::OPERANDS.iter().zip(probe.inputs).map(|(name, &bits)| ((*name).to_owned(), value(bits))).collect()
    };
    let operands: Vec<f32> = probe.inputs.iter().map(|&bits| f32::from_bits(bits)).collect();
    let told = Failure {
        rerun: String::new(),
        id: probe.id(),
        adapter: subject.identity.name.clone(),
        stage: outcome.stage.clone(),
        target: None,
        route: None,
        sample: None,
        output: probe.what.into(),
        inputs: named(&|bits| serde_json::to_value(Number(probe.operand(bits))).unwrap_or_default()),
        units: BTreeMap::new(),
        inputs_hex: named(&|bits| format!("0x{bits:08x}").into()),
        reference: Number(reference),
        interval: interval.map(Number),
        promise: Some(legal),
        value: Number(probe.gives.number(outcome.bits)),
        value_hex: format!("0x{:08x}", outcome.bits),
        unwritten: outcome.bits == SENTINEL,
        error_ulp: Number(f64::INFINITY),
        answer: None,
    };
    Some((simplicity(&operands), told))
}
