//! What a result was held against: known failures, an earlier result, the same cases asked once more.

use lightmeter_document::by_case::KnownFailure;
use lightmeter_document::report::{Interrupted, Report};
use lightmeter_document::thousands;
use std::fmt::{Result, Write};

/// Cases that are named.
const MOST_NAMED: usize = 24;

/// The title of what is worse than in the baseline.
pub(crate) const BASELINE: &str = "baseline";

/// Why a result ended before its time.
pub(crate) fn interrupted(why: &Interrupted, report: &Report) -> String {
    let of_renderer =
        if report.renderer.is_some() { "; what was not answered until then counts as never answered" } else { "" };
    format!("{why}{of_renderer}")
}

/// Known failures that pass, and are to be taken out. Of a shard, which has a part of their cases, nobody can tell.
fn passing(report: &Report) -> Vec<&KnownFailure> {
    report.passing_unexpectedly().collect()
}

/// What is wrong with the whole: what broke off, and what it was held against; each on a line with its title.
pub(crate) fn wrong(report: &Report) -> Vec<(String, String)> {
    let mut said = vec![];
    said.extend(report.interrupted.as_ref().map(|why| ("interrupted".to_owned(), interrupted(why, report))));
    if let Some(renderer) = &report.renderer {
        said.extend(renderer.incidents.iter().map(|what| ("process".to_owned(), what.clone())));
        said.extend(renderer.problems.first.iter().map(|what| ("answers".to_owned(), what.clone())));
    }
    said.extend(lines(report));
    said
}

/// What changed, what is worse, and known failures that pass, each on a line with its title.
pub(crate) fn lines(report: &Report) -> Vec<(String, String)> {
    let mut said = vec![];
    let changed = |id: &String| (id.clone(), "its answer changed when it was asked once more".to_owned());
    said.extend(report.unstable_cases.iter().take(MOST_NAMED).map(changed));
    let more = report.unstable.saturating_sub(report.unstable_cases.len().min(MOST_NAMED) as u64);
    if more > 0 {
        said.push(("unstable".to_owned(), format!("{more} more answers changed when they were asked once more")));
    }
    said.extend(report.regressions.iter().map(|what| (BASELINE.to_owned(), what.clone())));
    let passes = passing(report).into_iter();
    said.extend(passes.map(|one| {
        let how = if one.mistake.is_empty() {
            "passes, and is expected to fail"
        } else {
            "no case fails by its mistake, which is expected"
        };
        (one.id.clone(), format!("{how}: {}", one.reason))
    }));
    said
}

/// Writes for people what a result was held against, and what came of it.
///
/// # Errors
/// Where the writer fails.
pub(crate) fn text(report: &Report, out: &mut impl Write) -> Result {
    listed(report.unstable, "changed when they were asked once more", &report.unstable_cases, out)?;
    let worse = &report.regressions;
    listed(worse.len() as u64, "are worse than in the baseline", worse, out)?;
    let unexpected = passing(report);
    for one in report.expectations.iter().filter(|one| one.failed + one.passed > 0) {
        let said = match (one.failed, unexpected.contains(&one)) {
            (0, true) if !one.mistake.is_empty() => "IS MADE IN NO CASE: take it out",
            (0, true) => "PASSES: take it out",
            (0, false) => "passes, as it may",
            _ => "fails as expected",
        };
        writeln!(
            out,
            "\nexpected failure `{}` {said} ({} failed, {} passed): {}",
            one.id, one.failed, one.passed, one.reason
        )?;
    }
    unused(report).iter().try_for_each(|said| writeln!(out, "\nnote: {said}"))?;
    for group in &report.groups {
        if let Some(problem) = group.expected_problem() {
            writeln!(out, "\nas expected: {}: {problem}", group.name())?;
        }
    }
    Ok(())
}

/// A line on known failures none of whose cases passed, or failed as expected. What was judged of a shard, or of an interrupted run, is a part.
pub(crate) fn unused(report: &Report) -> Option<String> {
    let is_part = report.interrupted.is_some() || report.compared_by.as_ref().is_some_and(|by| by.shard.is_some());
    let is_unused = |one: &&KnownFailure| !is_part && !one.crash && one.failed + one.passed == 0;
    let ids: Vec<String> = report.expectations.iter().filter(is_unused).map(|one| format!("`{}`", one.id)).collect();
    let said = "none of these known failures has a case that was judged, or that fails as it says";
    (!ids.is_empty()).then(|| format!("{said}: {}", ids.join(", ")))
}

/// What a renderer has of what was chosen, in one line; nothing where it has all.
pub(crate) fn declared(report: &Report) -> Option<String> {
    let [declared, all] = report.declared()?.map(|count| thousands(count as u64));
    let chosen = report.compared_by.as_ref().is_some_and(|by| !by.choice.filter.is_empty());
    let which = if chosen { " that the filter selects" } else { "" };
    Some(format!("the renderer declares {declared} of {all} formulas and scenes{which}; the others were not asked"))
}

/// Writes a list with its number, the first of it.
///
/// # Errors
/// Where the writer fails.
pub(crate) fn listed(count: u64, what: &str, named: &[String], out: &mut impl Write) -> Result {
    if count == 0 {
        return Ok(());
    }
    writeln!(out, "\n{} {what}:", thousands(count))?;
    let named = &named[..named.len().min(MOST_NAMED)];
    named.iter().try_for_each(|one| writeln!(out, "  {one}"))?;
    match count.saturating_sub(named.len() as u64) {
        0 => Ok(()),
        more => writeln!(out, "  and {} more", thousands(more)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_document::by_case::ComparedBy;

    #[test]
    fn known_failures_of_which_nothing_was_judged_are_told_of_a_whole() {
        let known = |id: &str, failed, crash| KnownFailure { id: id.into(), failed, crash, ..KnownFailure::default() };
        let mut report = Report::empty(1, "wgsl".into(), vec![], vec![]);
        report.expectations = vec![known("fog/exp", 0, false), known("fog/linear", 2, false), known("depth", 0, true)];
        let mut said = String::new();
        text(&report, &mut said).expect("a string takes it");
        assert!(said.contains("note: none of these known failures") && said.ends_with(": `fog/exp`\n"), "{said}");
        // Another shard may have its cases.
        report.compared_by = Some(ComparedBy { shard: Some("1/2".into()), ..ComparedBy::default() });
        assert_eq!(unused(&report), None);
    }
}
