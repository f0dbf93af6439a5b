//! Tables of special values on a renderer that is asked case by case: what it answers, by the same promises as an adapter. No driver is
//! on record for it, and no deviation is known.

use super::run::{Results, verdict};
use super::verdict::{Table, failure};
use crate::again::{changed, digest, has_changed, number};
use crate::device::DeviceError;
use crate::expected::expect;
use crate::options::Options;
use crate::subject::Subject;
use lightmeter_catalogue::cases::Stage;
use lightmeter_catalogue::special::Probe;
use lightmeter_document::Number;
use lightmeter_document::by_case::{CaseCounts, FailedAnswer};
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::report::{Failure, Group, Report, Totals};
use lightmeter_document::special::{ProbeResult, ProbeVerdict};
use lightmeter_judge::cases::Unanswered;
use lightmeter_judge::formula::unjudged;
use std::time::Instant;

/// Why a probe that is no function is not asked for.
const CARRIED: &str = "a rasteriser carries it, which no renderer is asked for by itself";

/// A probe that was asked, what stands for the answer, and whether that failed.
pub(crate) type NotedProbe = (&'static Probe, u32, bool);

/// Judges a table on a renderer.
///
/// # Errors
/// Where it cannot be asked.
pub(crate) fn run_table(
    table: &Table,
    subject: &mut Subject,
    options: &Options,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<Vec<NotedProbe>, DeviceError> {
    let functions: Vec<&'static Probe> = table.functions().collect();
    let Some(renderer) = subject.asked_mut() else { unreachable!("only such a renderer is asked here") };
    let clock = Instant::now();
    let answers = renderer.probes(&functions)?;
    let seconds = clock.elapsed().as_secs_f64();
    report.timing.devices += seconds;
    let mut standing = TableStanding {
        subject,
        options,
        report,
        counts: CaseCounts::default(),
        totals: Totals::default(),
        failures: vec![],
    };
    for probe in table.probes.iter().filter(|probe| probe.function().is_none()) {
        standing.refuse(probe, &Unanswered::Skipped(CARRIED.into()));
    }
    let mut noted = vec![];
    for (probe, answer) in functions.into_iter().zip(answers) {
        let (digest, has_failed) = match &answer {
            Ok(bits) => (digest_of(&answer), standing.judge(probe, *bits)),
            Err(why) => (digest_of(&answer), standing.refuse(probe, why)),
        };
        noted.push((probe, digest, has_failed));
    }
    standing.finish(table, seconds);
    observer.see(&Event::Advanced(noted.len() as u64));
    Ok(noted)
}

/// Asks a renderer once more for all probes that were asked, or for those that failed, and notes each whose answer is another one.
///
/// # Errors
/// Where it cannot be asked.
pub(crate) fn ask_again(
    noted: &[NotedProbe],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
) -> Result<(), DeviceError> {
    let Some(renderer) = subjects.iter_mut().find_map(Subject::asked_mut) else { return Ok(()) };
    let again: Vec<&NotedProbe> = noted.iter().filter(|(.., has_failed)| options.runs > 1 || *has_failed).collect();
    let probes: Vec<&'static Probe> = again.iter().map(|(probe, ..)| *probe).collect();
    if probes.is_empty() {
        return Ok(());
    }
    for ((probe, before, _), now) in again.into_iter().zip(renderer.probes(&probes)?) {
        if has_changed(*before, digest_of(&now)) {
            changed(report, || probe.id());
        }
    }
    Ok(())
}

/// What stands for an answer.
fn digest_of(answer: &Result<u32, Unanswered>) -> u32 {
    match answer {
        Ok(bits) => digest(std::iter::once(u64::from(*bits))),
        Err(why) => number(why),
    }
}

/// What a table has come to.
struct TableStanding<'a> {
    subject: &'a Subject,
    options: &'a Options,
    report: &'a mut Report,
    counts: CaseCounts,
    totals: Totals,
    /// Each with how simple its operands are; what is no value comes last.
    failures: Vec<(u32, Failure)>,
}

impl TableStanding<'_> {
    /// Notes a probe that did not pass, and why.
    fn not_passed(&mut self, state: &str, probe: &Probe) {
        self.counts.not_passed.entry(state.to_owned()).or_default().push(probe.name.to_owned());
    }

    /// Counts a probe that failed; whether that is expected.
    fn failed(&mut self, probe: &Probe) -> bool {
        let is_expected = expect(self.report, self.options, &probe.id(), &[Stage::Answer.name()], true, None);
        self.counts.totals.failed += 1;
        self.counts.totals.expected_failures += u64::from(is_expected);
        self.not_passed("failed", probe);
        is_expected
    }

    /// Judges a result; whether it fails.
    fn judge(&mut self, probe: &'static Probe, bits: u32) -> bool {
        self.counts.totals.asked += 1;
        self.totals.cases += 1;
        self.totals.verdicts += 1;
        let verdict = verdict(probe.promise, bits, None, false);
        if !verdict.is_failure() {
            expect(self.report, self.options, &probe.id(), &[Stage::Answer.name()], false, None);
            self.counts.totals.passed += 1;
            let is_promised = verdict != ProbeVerdict::Indeterminate;
            let count = if is_promised { &mut self.totals.passed } else { &mut self.totals.indeterminate };
            *count += 1;
            return false;
        }
        let is_expected = self.failed(probe);
        let count = if is_expected { &mut self.totals.expected_failures } else { &mut self.totals.failed };
        *count += 1;
        let outcome = ProbeResult {
            probe: probe.name.into(),
            adapter: self.subject.identity.name.clone(),
            stage: Stage::Answer.name().into(),
            bits,
            value: probe.gives.word(bits),
            verdict,
            recorded: None,
            recorded_value: None,
        };
        let nothing_else = Results { outcomes: vec![], skipped: vec![], record: None };
        let Some((simple, told)) = failure(&outcome, &nothing_else, self.subject) else {
            unreachable!("the probe is one of the tables'")
        };
        let promised = told.promise.as_deref().unwrap_or_default();
        let answer = FailedAnswer {
            inputs: probe.inputs.iter().map(|&bits| Number(probe.operand(bits))).collect(),
            outputs: vec![probe.what.to_owned()],
            reference: vec![told.reference],
            interval: vec![told.interval],
            value: vec![told.value],
            problem: Some(format!("{} gives {}; promised is {promised}", probe.what, outcome.value)),
        };
        self.failures.push((simple, Failure { answer: Some(answer), ..told }));
        true
    }

    /// Counts a probe without a result; whether it is to be asked for once more.
    fn refuse(&mut self, probe: &Probe, why: &Unanswered) -> bool {
        self.counts.totals.asked += 1;
        self.totals.cases += 1;
        match why {
            Unanswered::Skipped(reason) | Unanswered::Undeclared(reason) => {
                self.counts.totals.skipped += 1;
                self.counts.totals.undeclared += u64::from(matches!(why, Unanswered::Undeclared(_)));
                self.totals.skipped += 1;
                self.not_passed("skipped", probe);
                let reasons = self.counts.reason.get_or_insert_default();
                if !reasons.split("; ").any(|known| known == reason) {
                    let separator = if reasons.is_empty() { "" } else { "; " };
                    *reasons += &format!("{separator}{reason}");
                }
                false
            }
            Unanswered::Missing | Unanswered::Unasked => {
                self.counts.totals.missing += 1;
                self.not_passed("missing", probe);
                false
            }
            Unanswered::Unjudged(message) | Unanswered::Broken(message) => {
                self.failed(probe);
                self.counts.totals.unjudged += 1;
                self.counts.totals.broken += u64::from(matches!(why, Unanswered::Broken(_)));
                let (stage, adapter) = (Stage::Answer.name(), &self.subject.identity.name);
                self.failures.push((u32::MAX, unjudged(probe.id(), message, stage, adapter)));
                matches!(why, Unanswered::Unjudged(_))
            }
        }
    }

    /// Adds the table's group and its failures to the report, the one with the simplest operands first.
    fn finish(mut self, table: &Table, seconds: f64) {
        self.failures.sort_by_key(|(simple, _)| *simple);
        // In the order that the parts of a table have when they are merged.
        self.counts.not_passed.values_mut().for_each(|names| names.sort_unstable());
        let with_values = self.failures.iter().find(|(simple, _)| *simple < u32::MAX);
        self.counts.smallest = with_values.map(|(_, failure)| failure.id.clone());
        self.report.failures.extend(self.failures.into_iter().map(|(_, failure)| failure));
        let name = self.subject.identity.name.clone();
        self.report.groups.push(Group {
            totals: self.totals,
            seconds,
            by_case: Some(self.counts),
            ..Group::new(table.id(), name, Stage::Answer.name())
        });
    }
}
