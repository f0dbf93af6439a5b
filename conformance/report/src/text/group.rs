//! Groups that fail, for people: what fails, what explains it, and a failing case.

use super::failure::{failure, formula_of};
use super::{Style, is_told_by};
use lightmeter_document::by_case::CaseCounts;
use lightmeter_document::report::{Failure, Group, ImageUse, Report, Totals};
use lightmeter_document::{cases, thousands};
use std::fmt::{Result, Write};

/// Missing cases, or rows of them, that are named.
const MOST_NAMED: usize = 8;
/// Groups of a renderer that fail, of which all is told.
pub(crate) const MOST_TOLD: usize = 24;

/// Writes each group that fails, with what explains it, and of each formula on a subject one failing case.
///
/// # Errors
/// Where the writer fails.
pub fn failing(report: &Report, style: Style, out: &mut impl Write) -> Result {
    let failing: Vec<&Group> = report.groups.iter().filter(|group| group.is_failed()).collect();
    if report.renderer.is_some() {
        for group in failing.iter().take(MOST_TOLD) {
            asked(group, &report.failures.iter().collect::<Vec<_>>(), style, out)?;
        }
        return Ok(());
    }
    for (place, group) in failing.iter().enumerate() {
        if place == 0 {
            writeln!(out)?;
        }
        judged(group, " of", out)?;
    }
    // One failure a formula and adapter explains more than many; the JSON has the first of every stage.
    let mut told: Vec<(&str, &str)> = vec![];
    let fails =
        |failure: &&Failure| report.groups.iter().any(|group| group.totals.failed > 0 && is_told_by(group, failure));
    for one in report.failures.iter().filter(fails) {
        let formula = formula_of(one);
        if !told.contains(&(formula, &one.adapter)) {
            told.push((formula, &one.adapter));
            writeln!(out)?;
            failure(one, style.level, out)?;
        }
    }
    Ok(())
}

/// A line for each formula or scene that fails on an adapter, where all that is known of it was told as it was judged; of a renderer, the names
/// of those that were not.
pub(super) fn told_above(report: &Report, out: &mut impl Write) -> Result {
    if report.renderer.is_some() {
        return Ok(());
    }
    let mut formulas: Vec<Vec<&Group>> = vec![];
    for group in report.groups.iter().filter(|group| group.is_failed()) {
        match formulas.iter_mut().find(|own| own[0].id == group.id && own[0].adapter == group.adapter) {
            Some(own) => own.push(group),
            None => formulas.push(vec![group]),
        }
    }
    if formulas.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nfailed, as is told above")?;
    for groups in formulas {
        let places: Vec<String> = groups.iter().map(|group| group.place()).collect();
        let sum = |count: fn(&Totals) -> u64| thousands(groups.iter().map(|group| count(&group.totals)).sum());
        let (failed, verdicts) = (sum(|totals| totals.failed), sum(|totals| totals.verdicts));
        let cause = groups.iter().find_map(|group| group.cause().or_else(|| group.problem()));
        let cause = cause.map_or_else(String::new, |cause| format!(": {cause}"));
        let (id, adapter) = (&groups[0].id, &groups[0].adapter);
        writeln!(out, "  {id} on {adapter}, {}: {failed} of {verdicts}{cause}", places.join(" and "))?;
    }
    Ok(())
}

/// The names of a renderer's groups that fail, beyond those of which all is told.
pub(super) fn more(report: &Report, out: &mut impl Write) -> Result {
    let failing: Vec<String> =
        report.groups.iter().filter(|group| group.asked().is_some() && group.is_failed()).map(Group::name).collect();
    if failing.len() <= MOST_TOLD {
        return Ok(());
    }
    let more: Vec<String> = failing[MOST_TOLD..].iter().take(200).cloned().collect();
    writeln!(out, "\n{} more fail: {}", failing.len() - MOST_TOLD, more.join(", "))
}

/// Writes that a group fails whose verdicts are counted, with what explains it. Its counts are `of` some of its verdicts.
pub(crate) fn judged(group: &Group, of: &str, out: &mut impl Write) -> Result {
    let [failed, verdicts] = [group.totals.failed, group.totals.verdicts].map(thousands);
    writeln!(out, "✗ {}: {failed}{of} {verdicts} failed", group.name())?;
    why(group, out)
}

/// What is known of why a group fails, a line each.
fn why(group: &Group, out: &mut impl Write) -> Result {
    let image = group.image.as_ref();
    if let Some(ImageUse { wrong, departs_in, show: Some(_), .. }) = image {
        writeln!(out, "  {wrong} pixels")?;
        departs_in.iter().try_for_each(|departure| writeln!(out, "  {departure}"))?;
    }
    group.reasons().try_for_each(|reason| writeln!(out, "  {reason}"))?;
    let Some(ImageUse { show: Some(command), files, .. }) = image else { return Ok(()) };
    writeln!(out, "  worst pixel\n    {command}")?;
    files.iter().try_for_each(|file| writeln!(out, "    {file}"))
}

/// Writes what fails in a group of a renderer, what explains it, and the smallest failing case.
pub(crate) fn asked(group: &Group, failures: &[&Failure], style: Style, out: &mut impl Write) -> Result {
    let Some(CaseCounts { totals, reason, smallest, .. }) = group.asked() else { return Ok(()) };
    let (count, what) = match totals.failed {
        0 if totals.undeclared > 0 => (totals.undeclared, "were skipped"),
        0 if totals.missing > 0 => (totals.missing, "were never answered"),
        1 => (1, "fails"),
        failed => (failed, "fail"),
    };
    writeln!(out, "\n✗ {}: {} of {} {what}", group.name(), thousands(count), cases(totals.asked))?;
    if let Some(source) = &group.source {
        writeln!(out, "  source {source}")?;
    }
    if totals.missing > 0 {
        let was = if totals.missing == 1 { "was" } else { "were" };
        writeln!(out, "  {} {was} never answered: {}", cases(totals.missing), missing(group))?;
    }
    if totals.undeclared > 0 {
        let why = reason.as_deref().unwrap_or("no reason was given");
        writeln!(out, "  {} skipped without having been declared: {why}", cases(totals.undeclared))?;
        writeln!(out, "  declare such cases by `skips` in the hello, or by [[skipped]] in a file of expectations")?;
    }
    if totals.broken > 0 {
        writeln!(out, "  at {} of them it ended or hung", thousands(totals.broken))?;
    }
    why(group, out)?;
    let of: Vec<&&Failure> = failures.iter().filter(|failure| is_told_by(group, failure)).collect();
    let least = of.iter().find(|failure| smallest.as_ref() == Some(&failure.id));
    if least.is_some() {
        writeln!(out, "  the smallest failing case:")?;
    }
    let Some(told) = least.or(of.first()) else { return Ok(()) };
    failure(told, style.level, out)?;
    commands(told, group, out)
}

/// The commands that explain a failing case of a renderer, and ask for it once more.
fn commands(failure: &Failure, group: &Group, out: &mut impl Write) -> Result {
    let target = failure.blended_on().map(|target| format!(" --target {target}")).unwrap_or_default();
    let mistake = match &group.mistakes()[..] {
        [one] => format!(" --mistake {one}"),
        _ => String::new(),
    };
    // A pixel has no case with a mistake in it: the whole scene is drawn with one.
    let scene = failure.id.strip_prefix("scene/").and_then(|rest| rest.split('/').next());
    match scene.filter(|_| !mistake.is_empty()) {
        Some(scene) => writeln!(out, "    explained  lightmeter render {scene}{mistake} --out {scene}.png")?,
        None => writeln!(out, "    explained  lightmeter show {}{target}{mistake}", failure.id)?,
    }
    if failure.rerun.is_empty() { Ok(()) } else { writeln!(out, "    again      {}", failure.rerun) }
}

/// The cases of a group that were never answered: the first of them, by the end of their ids.
fn missing(group: &Group) -> String {
    let all = group.by_case.as_ref().and_then(|counts| counts.not_passed.get("missing")).map_or(&[][..], Vec::as_slice);
    let named = all.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
    if all.len() > MOST_NAMED { named + ", …" } else { named }
}

/// What is wrong with a group, on one line.
pub(crate) fn sentence(group: &Group) -> String {
    let mut said = match group.asked() {
        None => format!("{} of {} verdicts failed", thousands(group.totals.failed), thousands(group.totals.verdicts)),
        Some(CaseCounts { totals, .. }) => {
            let mut said = format!("{} of {} fail", thousands(totals.failed), cases(totals.asked));
            if totals.broken > 0 {
                said += &format!(", at {} of them it ended or hung", thousands(totals.broken));
            }
            if totals.missing > 0 {
                said += &format!(", {} never answered: {}", thousands(totals.missing), missing(group));
            }
            said
        }
    };
    for more in group.reasons() {
        said += &format!("; {more}");
    }
    said
}
