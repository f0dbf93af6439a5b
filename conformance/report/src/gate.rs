//! A gate's result for people.

use crate::Level;
use crate::against::{self, Against, listed};
use crate::table::{Align, TextTable};
use crate::text::plain;
use lightmeter_document::by_case::Coverage;
use lightmeter_document::gate::{GateFailure, GateGroup, GateReport, Problems, RendererIdentity, cases};
use lightmeter_document::run::Interrupted;
use lightmeter_document::{Number, error_told, thousands};
use std::fmt::{Result, Write};

/// Missing cases, or rows of them, that are named.
const MOST_NAMED: usize = 8;
/// Groups that fail, of which all is told.
pub const MOST_TOLD: usize = 24;

/// How a gate's result is written for people.
#[derive(Clone, Debug, Default)]
pub struct GateStyle {
    /// How much is said.
    pub level: Level,
    /// Whether the renderer, and the groups that fail, were told as they were judged.
    pub is_told: bool,
    /// The command that asks the renderer for the case whose id is put behind it; nothing where answers are read from files.
    pub again: Option<String>,
}

/// The first line: who is judged, and by which accuracy rules.
///
/// # Errors
/// Where the writer fails.
pub fn begun(renderer: &RendererIdentity, profile: &str, out: &mut impl Write) -> Result {
    writeln!(out, "{renderer} · profile {profile}")
}

/// Writes it for people.
///
/// # Errors
/// Where the writer fails.
pub fn text(report: &GateReport, style: &GateStyle, out: &mut impl Write) -> Result {
    let renderer = &report.renderer;
    // What a file says may be why something passes.
    if let Some(config) = &report.config {
        writeln!(out, "{config}")?;
    }
    if style.level > Level::Quiet && !style.is_told {
        begun(renderer, &report.profile, out)?;
    }
    let failed: Vec<&GateGroup> = report.groups.iter().filter(|group| group.is_failed()).collect();
    for group in failed.iter().take(MOST_TOLD).filter(|_| !style.is_told) {
        told(group, &report.failures, style, out)?;
    }
    if failed.len() > MOST_TOLD {
        let more: Vec<String> = failed[MOST_TOLD..].iter().map(|group| group.name()).take(200).collect();
        writeln!(out, "\n{} more fail: {}", failed.len() - MOST_TOLD, more.join(", "))?;
    }
    if style.level > Level::Quiet {
        if !failed.is_empty() {
            writeln!(out)?;
        }
        families(report, style.level, out)?;
    }
    against::text(Against::of_gate(report), out)?;
    listed("crashes and hangs are expected", &report.expected_incidents, out)?;
    listed("went wrong with the process", &report.incidents, out)?;
    problems(&report.problems, out)?;
    report.warnings.iter().try_for_each(|warning| writeln!(out, "\nwarning: {warning}"))?;
    if let Some(why) = &report.interrupted {
        writeln!(out, "\n{}", interrupted(why))?;
    }
    verdict(report, style.level, out)
}

/// Lines that are no answers.
fn problems(problems: &Problems, out: &mut impl Write) -> Result {
    const MOST: usize = 4;
    if problems.is_empty() {
        return Ok(());
    }
    let counts: Vec<String> =
        problems.counts.iter().map(|(kind, count)| format!("{} {kind}", thousands(*count))).collect();
    writeln!(out, "\nlines that cannot be read as answers: {}", counts.join(", "))?;
    problems.first.iter().take(MOST).try_for_each(|what| writeln!(out, "  {what}"))?;
    if problems.first.len() > MOST { writeln!(out, "  …") } else { Ok(()) }
}

/// How many pass and fail, and what else there is to count, each on a line of its own.
fn verdict(report: &GateReport, level: Level, out: &mut impl Write) -> Result {
    let totals = &report.totals;
    if level > Level::Quiet {
        writeln!(out)?;
    }
    let [passed, failed] = [totals.passed, totals.failed].map(thousands);
    writeln!(out, "{passed} of {} pass, {failed} fail, in {:.1} s", cases(totals.asked), report.seconds)?;
    for (count, what) in [
        (totals.broken, "fail because the renderer ended or hung"),
        (totals.expected_failures, "fail as expected"),
        (totals.unexpected_passes, "are expected to fail, and pass"),
        (totals.unstable, "are unstable: the renderer answers them differently when it is asked again"),
        (totals.missing, "were never answered"),
        (totals.skipped, "were skipped"),
        (totals.undeclared, "of those without having been declared"),
    ] {
        if count > 0 {
            writeln!(out, "  {} {what}", thousands(count))?;
        }
    }
    let Coverage { chosen, judged, excluded } = report.coverage();
    if excluded > 0 {
        let why = match totals.not_asked {
            0 => String::new(),
            all if all == excluded => ", which the renderer does not declare or excludes".into(),
            some => format!(", {} of which the renderer does not declare or excludes", thousands(some)),
        };
        let [chosen, judged, excluded] = [chosen, judged, excluded].map(thousands);
        writeln!(out, "of {chosen} chosen cases {judged} were judged and {excluded} excluded{why}")?;
    }
    let undecided = totals.indeterminate;
    if level == Level::Verbose && undecided > 0 {
        let (undecided, all) = (thousands(undecided), thousands(totals.verdicts));
        writeln!(out, "  {undecided} of {all} numbers could be anything: there the accuracy rules promise nothing")?;
    }
    Ok(())
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
    let (left, right) = (Align::Left, Align::Right);
    let mut table = TextTable::new(&[("", left), ("", left), ("", right), ("", left), ("", right), ("", left)]);
    for name in names {
        let of: Vec<&GateGroup> =
            report.groups.iter().filter(|group| group.asked > 0 && family(group) == name).collect();
        let sum = |count: fn(&GateGroup) -> u64| of.iter().map(|group| count(group)).sum::<u64>();
        let (asked, failed, missing) =
            (sum(|group| group.asked), sum(|group| group.failed), sum(|group| group.missing));
        let failing = of.iter().filter(|group| group.is_failed()).count();
        let judged = asked.saturating_sub(of.iter().map(|group| group.skipped + group.missing).sum());
        let mark = match (failing, judged) {
            (0, 0) => "–",
            (0, _) => "✓",
            _ => "✗",
        };
        let whats = match name.as_str() {
            "scene" => ["scene", "scenes"],
            "special" => ["table", "tables"],
            _ => ["formula", "formulas"],
        };
        let mut notes = vec![];
        if failing > 0 {
            let fail = if failed == 1 { "fails" } else { "fail" };
            notes.push(format!("{} {fail} in {failing} {}", thousands(failed), whats[usize::from(failing != 1)]));
        }
        if missing > 0 {
            notes.push(format!("{} never answered", thousands(missing)));
        }
        if judged == 0 {
            notes.push("none judged".into());
        } else if level == Level::Verbose && failing == 0 {
            let error = of.iter().map(|group| group.error_max.0).fold(0.0, lightmeter_document::worse);
            let margin = of.iter().map(|group| group.margin_max.0).fold(0.0, lightmeter_document::worse);
            let unit = if name == "scene" { "ULP or steps" } else { "ULP" };
            let error = error_told(Number(error), unit);
            notes.push(format!("errors up to {error}, {} % of what is legal", short(100.0 * margin)));
        }
        let count = format!("{} {}", of.len(), whats[usize::from(of.len() != 1)]);
        table.row([mark.into(), name, thousands(asked), "cases".into(), count, notes.join(", ")]);
    }
    out.write_str(&table.text(""))
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
pub fn told(group: &GateGroup, failures: &[GateFailure], style: &GateStyle, out: &mut impl Write) -> Result {
    let (count, what) = match group.failed {
        0 if group.undeclared > 0 => (group.undeclared, "were skipped"),
        0 if group.missing > 0 => (group.missing, "were never answered"),
        1 => (1, "fails"),
        failed => (failed, "fail"),
    };
    writeln!(out, "\n✗ {}: {} of {} {what}", group.name(), thousands(count), cases(group.asked))?;
    if let Some(source) = &group.source {
        writeln!(out, "  source {source}")?;
    }
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
        writeln!(out, "  at {} of them it ended or hung", thousands(group.broken))?;
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
    if smallest.is_some() {
        writeln!(out, "  the smallest failing case:")?;
    }
    let Some(told) = smallest.or(of.first()) else { return Ok(()) };
    failure(told, out)?;
    commands(told, group, style, out)
}

/// The commands that explain a failing case, and ask for it once more.
fn commands(failure: &GateFailure, group: &GateGroup, style: &GateStyle, out: &mut impl Write) -> Result {
    let target = failure.target.as_ref().map(|target| format!(" --target {target}")).unwrap_or_default();
    let mistake = match group.mistakes.as_slice() {
        [one] => format!(" --mistake {one}"),
        _ => String::new(),
    };
    // A pixel has no case with a mistake in it: the whole scene is drawn with one.
    let scene = failure.id.strip_prefix("scene/").and_then(|rest| rest.split('/').next());
    match scene.filter(|_| !mistake.is_empty()) {
        Some(scene) => writeln!(out, "    explained  lightmeter render {scene}{mistake} --out {scene}.png")?,
        None => writeln!(out, "    explained  lightmeter show {}{target}{mistake}", failure.id)?,
    }
    match &style.again {
        Some(again) => writeln!(out, "    again      {again}{target} {}", failure.id),
        None => Ok(()),
    }
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
    let columns = ["", "", "value", "legal from", "to", "reference"].map(|heading| (heading, Align::Left));
    let mut table = TextTable::new(&columns);
    for (k, [low, high]) in failure.interval.iter().enumerate() {
        let (Some(value), Some(reference)) = (failure.value.get(k), failure.reference.get(k)) else { break };
        let name = failure.outputs.get(k).map_or("value", String::as_str);
        let is_legal = low.0 <= value.0 && value.0 <= high.0;
        let [value, low, high] = [value, low, high].map(|number| number.narrow().to_string());
        let mark = if is_legal { "" } else { "✗" };
        table.row([mark.into(), name.into(), value, low, high, brief(reference.0)]);
    }
    out.write_str(&table.text("  "))
}

/// Nine digits, which tell any two numbers of f32 apart.
fn brief(x: f64) -> String {
    let rounded: f64 = format!("{x:.8e}").parse().unwrap_or(x);
    Number(rounded).to_string()
}

/// What is wrong with a group, on one line.
pub(crate) fn sentence(group: &GateGroup) -> String {
    let mut said = format!("{} of {} fail", thousands(group.failed), cases(group.asked));
    if group.broken > 0 {
        said += &format!(", at {} of them it ended or hung", thousands(group.broken));
    }
    if group.missing > 0 {
        said += &format!(", {} never answered: {}", thousands(group.missing), missing(group));
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

/// Why the gate ended before its time.
fn interrupted(why: &Interrupted) -> String {
    format!("{why}; what was not answered until then counts as never answered")
}

/// What is wrong with all of it, each on a line with its title.
pub(crate) fn whole(report: &GateReport) -> Vec<(String, String)> {
    let mut said = vec![];
    said.extend(report.interrupted.as_ref().map(|why| ("interrupted".to_owned(), interrupted(why))));
    said.extend(report.incidents.iter().map(|what| ("process".to_owned(), what.clone())));
    said.extend(report.problems.first.iter().map(|what| ("answers".to_owned(), what.clone())));
    said.extend(Against::of_gate(report).lines());
    said
}
