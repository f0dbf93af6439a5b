//! What a result was held against: known failures, an earlier result, the same cases asked once more.

use lightmeter_document::by_case::KnownFailure;
use lightmeter_document::report::{Interrupted, Report};
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
    said.extend(report.regressions.iter().map(|what| (BASELINE.to_owned(), what.clone())));
    let passes = passing(report).into_iter();
    said.extend(passes.map(|one| (one.id.clone(), format!("passes, and is expected to fail: {}", one.reason))));
    said
}

/// Writes for people what a result was held against, and what came of it.
///
/// # Errors
/// Where the writer fails.
pub(crate) fn text(report: &Report, out: &mut impl Write) -> Result {
    listed("changed when they were asked once more", &report.unstable_cases, out)?;
    listed("are worse than in the baseline", &report.regressions, out)?;
    let unexpected = passing(report);
    for one in report.expectations.iter().filter(|one| one.failed + one.passed > 0) {
        let said = match (one.failed, unexpected.contains(&one)) {
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
    for group in &report.groups {
        if let Some(problem) = group.expected_problem() {
            writeln!(out, "\nas expected: {}: {problem}", group.name())?;
        }
    }
    Ok(())
}

/// Writes a list with its number, the first of it.
///
/// # Errors
/// Where the writer fails.
pub(crate) fn listed(what: &str, all: &[String], out: &mut impl Write) -> Result {
    if !all.is_empty() {
        writeln!(out, "\n{} {what}:", all.len())?;
        all.iter().take(20).try_for_each(|one| writeln!(out, "  {one}"))?;
    }
    Ok(())
}
