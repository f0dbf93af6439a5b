//! A gate's result for people, for CI servers and for GitHub.

use crate::Level;
use crate::against::{self, Against, listed};
use crate::text::plain;
use lightmeter_document::Number;
use lightmeter_document::by_case::Coverage;
use lightmeter_document::gate::{GateFailure, GateGroup, GateReport, cases};
use quick_junit::{NonSuccessKind, Report as Document, SerializeError, TestCase, TestCaseStatus, TestSuite};
use std::fmt::{Result, Write};

/// Missing cases, or rows of them, that are named.
const MOST_NAMED: usize = 8;
/// Groups that fail, of which all is told.
pub const MOST_TOLD: usize = 24;

/// Writes it for people. Where the groups that fail were told as they were judged, they are not told again.
///
/// # Errors
/// Where the writer fails.
pub fn text(report: &GateReport, is_told: bool, level: Level, out: &mut impl Write) -> Result {
    let renderer = &report.renderer;
    // What a file says may be why something passes.
    if let Some(config) = &report.config {
        writeln!(out, "{config}")?;
    }
    if level > Level::Quiet {
        let version = if renderer.version.is_empty() { String::new() } else { format!(" {}", renderer.version) };
        writeln!(out, "{}{version} · profile {} · {:.1} s", renderer.name, report.profile, report.seconds)?;
        families(report, level, out)?;
    }
    let failed: Vec<&GateGroup> = report.groups.iter().filter(|group| group.is_failed()).collect();
    for group in failed.iter().take(MOST_TOLD).filter(|_| !is_told) {
        told(group, &report.failures, out)?;
    }
    if failed.len() > MOST_TOLD {
        let more: Vec<String> = failed[MOST_TOLD..].iter().map(|group| group.name()).take(200).collect();
        writeln!(out, "\n{} more fail: {}", failed.len() - MOST_TOLD, more.join(", "))?;
    }
    against::text(Against::of_gate(report), out)?;
    listed("crashes and hangs are expected", &report.expected_incidents, out)?;
    listed("went wrong with the process", &report.incidents, out)?;
    if !report.problems.is_empty() {
        let counts: Vec<String> =
            report.problems.counts.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
        writeln!(out, "\nlines that cannot be read as answers: {}", counts.join(", "))?;
        report.problems.first.iter().take(20).try_for_each(|what| writeln!(out, "  {what}"))?;
    }
    if let Some(signal) = report.signal {
        writeln!(out, "\n{}", interrupted(signal))?;
    }
    let totals = &report.totals;
    write!(out, "\n{} of {} pass, {} fail", totals.passed, cases(totals.asked), totals.failed)?;
    for (count, what) in [
        (totals.broken, "of them by ending or hanging"),
        (totals.expected_failures, "of them as expected"),
        (totals.unexpected_passes, "expected failures pass"),
        (totals.unstable, "are unstable"),
        (totals.missing, "were never answered"),
        (totals.skipped, "were skipped"),
        (totals.undeclared, "of them without having been declared"),
        (totals.not_asked, "were not asked: the renderer does not declare them"),
    ] {
        if count > 0 {
            write!(out, ", {count} {what}")?;
        }
    }
    write!(out, "; {} verdicts", totals.verdicts)?;
    match totals.indeterminate {
        0 => writeln!(out)?,
        undecided => writeln!(out, ", {undecided} of them undecided: there the accuracy rules permit any value")?,
    }
    let Coverage { chosen, judged, excluded } = report.coverage();
    if excluded > 0 {
        writeln!(out, "of {} chosen {judged} were judged and {excluded} excluded", cases(chosen))
    } else {
        Ok(())
    }
}

/// A line a family.
fn families(report: &GateReport, level: Level, out: &mut impl Write) -> Result {
    let family = |group: &GateGroup| group.id.split('/').next().unwrap_or_default().to_owned();
    let mut names: Vec<String> = vec![];
    for group in report.groups.iter().filter(|group| group.asked > 0) {
        if !names.contains(&family(group)) {
            names.push(family(group));
        }
    }
    for name in names {
        let of: Vec<&GateGroup> =
            report.groups.iter().filter(|group| group.asked > 0 && family(group) == name).collect();
        let sum = |count: fn(&GateGroup) -> u64| of.iter().map(|group| count(group)).sum::<u64>();
        let (asked, failed, missing) =
            (sum(|group| group.asked), sum(|group| group.failed), sum(|group| group.missing));
        let failing = of.iter().filter(|group| group.is_failed()).count();
        let judged = asked.saturating_sub(of.iter().map(|group| group.skipped + group.missing).sum());
        let mark = match (failing, judged) {
            (0, 0) => '–',
            (0, _) => '✓',
            _ => '✗',
        };
        let error = of.iter().map(|group| group.error_max.0).fold(0.0, lightmeter_document::worse);
        let margin = of.iter().map(|group| group.margin_max.0).fold(0.0, lightmeter_document::worse);
        let whats = match name.as_str() {
            "scene" => ["scene", "scenes"],
            "special" => ["table", "tables"],
            _ => ["formula", "formulas"],
        };
        let what = whats[usize::from(of.len() != 1)];
        write!(out, "{mark} {name:<14} {:>4} {what:<9} {asked:>9} cases", of.len())?;
        if failing > 0 {
            let fail = if failed == 1 { "fails" } else { "fail" };
            write!(out, ", {failed} {fail} in {failing} {}", whats[usize::from(failing != 1)])?;
        }
        if missing > 0 {
            write!(out, ", {missing} never answered")?;
        }
        if judged == 0 {
            writeln!(out, ", none judged")?;
        } else if level == Level::Verbose {
            writeln!(out, ", errors up to {} ULP, {} % of what is legal", short(error), short(100.0 * margin))?;
        } else {
            writeln!(out)?;
        }
    }
    Ok(())
}

fn short(x: f64) -> String {
    match x {
        x if !x.is_finite() => Number(x).to_string(),
        x if x == 0.0 || (0.01..1e6).contains(&x) => format!("{x:.2}"),
        x => format!("{x:.1e}"),
    }
}

/// What fails in a group, what explains it, and the first failure.
///
/// # Errors
/// Where the writer fails.
pub fn told(group: &GateGroup, failures: &[GateFailure], out: &mut impl Write) -> Result {
    let (count, what) = match group.failed {
        0 if group.undeclared > 0 => (group.undeclared, "were skipped"),
        0 if group.missing > 0 => (group.missing, "were never answered"),
        1 => (1, "fails"),
        failed => (failed, "fail"),
    };
    writeln!(out, "\n✗ {}: {count} of {} {what}", group.name(), cases(group.asked))?;
    if group.missing > 0 {
        let was = if group.missing == 1 { "was" } else { "were" };
        writeln!(out, "  {} {was} never answered: {}", cases(group.missing), missing(group))?;
    }
    if group.undeclared > 0 {
        let why = group.reason.as_deref().unwrap_or("no reason was given");
        writeln!(out, "  {} skipped without having been declared: {why}", cases(group.undeclared))?;
        writeln!(out, "  declare such cases by `skips` in the hello, or by [[skipped]] in a file of expectations")?;
    }
    if group.broken > 0 {
        writeln!(out, "  at {} of them it ended or hung", group.broken)?;
    }
    for what in group.diagnosis.iter().chain(&group.problem) {
        writeln!(out, "  {what}")?;
    }
    let below = format!("{}/", group.id);
    let is_of = |failure: &&GateFailure| {
        if failure.target != group.target {
            return false;
        }
        failure.id == group.id || failure.id.starts_with(&below) || group.smallest.as_ref() == Some(&failure.id)
    };
    let of: Vec<&GateFailure> = failures.iter().filter(is_of).collect();
    let smallest = of.iter().find(|failure| group.smallest.as_ref() == Some(&failure.id));
    if let Some(smallest) = smallest {
        writeln!(out, "  the smallest failing case:")?;
        failure(smallest, out)?;
    } else if let Some(first) = of.first() {
        failure(first, out)?;
    }
    Ok(())
}

/// The cases of a group that were never answered: the first of them, by the end of their ids.
fn missing(group: &GateGroup) -> String {
    let all = group.not_passed.get("missing").map_or(&[][..], Vec::as_slice);
    let named = all.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
    if all.len() > MOST_NAMED { named + ", …" } else { named }
}

/// A failure: its inputs by name, and a row for each output, marked where its value is not legal.
fn failure(failure: &GateFailure, out: &mut impl Write) -> Result {
    writeln!(out, "  {}", failure.id)?;
    if let Some(problem) = &failure.problem {
        writeln!(out, "    {problem}")?;
    }
    for (name, value) in &failure.named {
        let unit = failure.units.get(name).map(|unit| format!("  {unit}")).unwrap_or_default();
        writeln!(out, "    {name:<14} {}{unit}", plain(value))?;
    }
    if failure.value.is_empty() {
        return Ok(());
    }
    for (k, [low, high]) in failure.interval.iter().enumerate() {
        let (Some(value), Some(reference)) = (failure.value.get(k), failure.reference.get(k)) else { break };
        let name = failure.outputs.get(k).map_or("value", String::as_str);
        let is_legal = low.0 <= value.0 && value.0 <= high.0;
        let mark = if is_legal { ' ' } else { '✗' };
        let (value, [low, high]) = (value.narrow(), [low, high].map(|end| end.narrow()));
        writeln!(out, "  {mark} {name:<14} {value}, legal from {low} to {high}, reference {}", reference.narrow())?;
    }
    let target = failure.target.as_ref().map(|target| format!(" --target {target}")).unwrap_or_default();
    writeln!(out, "    lightmeter show {}{target}", failure.id)
}

/// What is wrong with a group, on one line.
pub(crate) fn sentence(group: &GateGroup) -> String {
    let mut said = format!("{} of {} fail", group.failed, cases(group.asked));
    if group.broken > 0 {
        said += &format!(", at {} of them it ended or hung", group.broken);
    }
    if group.missing > 0 {
        said += &format!(", {} never answered: {}", group.missing, missing(group));
    }
    for more in group.diagnosis.iter().chain(&group.problem) {
        said += &format!("; {more}");
    }
    said
}

/// The smallest failing case of a group, on one line.
pub(crate) fn smallest(group: &GateGroup, report: &GateReport) -> Option<String> {
    let id = group.smallest.as_ref()?;
    let is_it = |failure: &&GateFailure| failure.id == *id && failure.target == group.target;
    let failure = report.failures.iter().find(is_it)?;
    let list = |numbers: &[Number]| numbers.iter().map(Number::to_string).collect::<Vec<_>>().join(", ");
    let legal: Vec<String> = failure.interval.iter().map(|[low, high]| format!("[{low}, {high}]")).collect();
    let inputs: Vec<String> = failure.named.iter().map(|(name, value)| format!("{name} = {}", plain(value))).collect();
    let of = if inputs.is_empty() { String::new() } else { format!(" of {}", inputs.join(", ")) };
    Some(format!("{id}: {}{of}; legal: {}", list(&failure.value), legal.join(", ")))
}

/// That a signal ended the gate.
fn interrupted(signal: i32) -> String {
    format!("signal {signal} ended the gate before its time: what was not answered until then counts as missing")
}

/// What is wrong with all of it, each on a line with its title.
pub(crate) fn whole(report: &GateReport) -> Vec<(String, String)> {
    let mut said = vec![];
    said.extend(report.signal.map(|signal| ("interrupted".to_owned(), interrupted(signal))));
    said.extend(report.incidents.iter().map(|what| ("process".to_owned(), what.clone())));
    said.extend(report.problems.first.iter().map(|what| ("answers".to_owned(), what.clone())));
    said.extend(Against::of_gate(report).lines());
    said
}

/// The result as JUnit XML: a test for each formula and scene.
///
/// # Errors
/// Where it cannot be written as XML.
pub fn junit(report: &GateReport) -> std::result::Result<String, SerializeError> {
    let mut document = Document::new("lightmeter gate");
    let mut suite = TestSuite::new(format!("{} {}", report.renderer.name, report.renderer.version));
    for group in &report.groups {
        let mut status = TestCaseStatus::success();
        if group.is_failed() {
            status = TestCaseStatus::non_success(NonSuccessKind::Failure);
            status.set_message(sentence(group));
            let mut description = String::new();
            // Writing to a string does not fail.
            let _ = told(group, &report.failures, &mut description);
            status.set_description(description);
        } else if group.asked == group.skipped {
            status = TestCaseStatus::skipped();
            status.set_message(group.reason.clone().unwrap_or_default());
        }
        let mut case = TestCase::new(group.name(), status);
        case.set_classname(group.id.split('/').next().unwrap_or_default());
        suite.add_test_case(case);
    }
    for (title, what) in whole(report) {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status.set_message(what);
        suite.add_test_case(TestCase::new(title, status));
    }
    document.add_test_suite(suite);
    document.to_string()
}
