//! Lines that GitHub Actions shows as annotations.

use crate::against::Against;
use crate::gate::{sentence, smallest, whole};
use crate::text::{failing_group, formula_of, plain};
use lightmeter_document::by_case::SourcePlace;
use lightmeter_document::gate::{GateReport, cases};
use lightmeter_document::run::{Failure, Group, Report, ShaderUse};

fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

fn annotation(kind: &str, title: &str, text: &str) -> String {
    let separator = if kind.contains(' ') { "," } else { " " };
    format!("::{kind}{separator}title={}::{}\n", property(title), data(text))
}

/// An error at the line of a shader in which a formula's mistake is made, or at the shader's file where that is not known.
fn at_line(shader: &ShaderUse, id: &str) -> String {
    let line = shader.places(id).next().map_or_else(String::new, |place| format!(",line={}", place.line));
    format!("error file={}{line}", property(&shader.file))
}

/// An error at the line where the renderer's code of a group stands, as far as its hello says so.
fn at_source(source: Option<&SourcePlace>) -> String {
    let Some(SourcePlace { file, line }) = source else { return "error".into() };
    let line = line.map_or_else(String::new, |line| format!(",line={line}"));
    format!("error file={}{line}", property(file))
}

/// The annotations of a gate.
#[must_use]
pub fn of_gate(report: &GateReport) -> String {
    let mut out = String::new();
    if let Some(config) = &report.config {
        out += &annotation("notice", "settings", &config.to_string());
    }
    for group in report.groups.iter().filter(|group| group.is_failed()) {
        let case = smallest(group, report).map_or_else(String::new, |case| format!("\nsmallest failing case {case}"));
        out += &annotation(&at_source(group.source.as_ref()), &group.name(), &(sentence(group) + &case));
    }
    for warning in &report.warnings {
        out += &annotation("warning", "doubtful", warning);
    }
    for (title, what) in whole(report) {
        out += &annotation("error", &title, &what);
    }
    let totals = &report.totals;
    let (name, of) = (&report.renderer.name, cases(totals.asked));
    let said = format!("{name}: {} of {of} pass, {} fail", totals.passed, totals.failed);
    out + &annotation("notice", "lightmeter", &said)
}

/// The annotations of a run: one for each group that fails, with its first failing case.
#[must_use]
pub fn of_run(report: &Report) -> String {
    let mut out = String::new();
    if let Some(config) = &report.config {
        out += &annotation("notice", "settings", &config.to_string());
    }
    for group in report.groups.iter().filter(|group| group.totals.failed > 0 || group.problem.is_some()) {
        let mut said = String::new();
        let Ok(()) = failing_group(group, " of", &mut said) else { unreachable!("a string takes all") };
        if let Some(failure) = report.failures.iter().find(|failure| is_of(failure, group)) {
            said += &one_line(failure);
        }
        let kind = report.shader.as_ref().map_or_else(|| "error".into(), |shader| at_line(shader, &group.id));
        out += &annotation(&kind, &group.id, said.trim_end());
    }
    for deviation in report.deviations.iter().filter(|deviation| !deviation.still_needed) {
        let title = format!("deviation/{}", deviation.name);
        out += &annotation("error", &title, "unexpected pass: the deviation is no longer needed");
    }
    for (title, what) in Against::of_run(report).lines() {
        out += &annotation("error", &title, &what);
    }
    if let Some(interrupted) = &report.interrupted {
        let what = format!("{} was under way: {}", interrupted.under_way, interrupted.message);
        out += &annotation("error", "interrupted", &what);
    }
    let totals = &report.totals;
    let said = format!("{} of {} verdicts pass, {} fail", totals.passed, totals.verdicts, totals.failed);
    out + &annotation("notice", "lightmeter", &said)
}

fn is_of(failure: &Failure, group: &Group) -> bool {
    let place = (&failure.adapter, &failure.stage, &failure.target) == (&group.adapter, &group.stage, &group.target);
    place && group.has_case(formula_of(failure))
}

/// A failure on one line.
fn one_line(failure: &Failure) -> String {
    let inputs: Vec<String> = failure.inputs.iter().map(|(name, value)| format!("{name} = {}", plain(value))).collect();
    let Failure { id, output, value, interval: [low, high], rerun, .. } = failure;
    format!("{id}: {output} is {value} of {}; legal: [{low}, {high}]\n{rerun}", inputs.join(", "))
}
