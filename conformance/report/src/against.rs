//! What a result was held against: known failures, an earlier result, the same cases asked once more.

use lightmeter_document::gate::{GateGroup, GateReport, KnownFailure};
use lightmeter_document::run::{Group, Report};
use std::fmt::{Result, Write};

/// Cases that are named.
const MOST_NAMED: usize = 24;

/// The title of what is worse than in the baseline.
pub(crate) const BASELINE: &str = "baseline";

/// What a result was held against, and what came of it.
#[derive(Clone, Debug)]
pub(crate) struct Against<'a> {
    /// Whether the cases are a shard, of which nobody can tell that an expected failure passes.
    is_shard: bool,
    expectations: &'a [KnownFailure],
    unstable: &'a [String],
    regressions: &'a [String],
    /// What is wrong with whole groups as known failures say, each with its group.
    problems: Vec<String>,
}

impl<'a> Against<'a> {
    /// Of a gate.
    pub(crate) fn of_gate(report: &'a GateReport) -> Self {
        let GateReport { expectations, unstable, regressions, .. } = report;
        let is_shard = report.compared_by.as_ref().is_some_and(|by| by.shard.is_some());
        let told = |group: &GateGroup| Some(format!("{}: {}", group.name(), group.expected_problem.as_ref()?));
        let problems = report.groups.iter().filter_map(told).collect();
        Self { is_shard, expectations, unstable, regressions, problems }
    }

    /// Of a run.
    pub(crate) fn of_run(report: &'a Report) -> Self {
        let Report { expectations, unstable_cases: unstable, regressions, .. } = report;
        let is_shard = report.compared_by.as_ref().is_some_and(|by| by.shard.is_some());
        let told = |group: &Group| {
            let problem = group.expected_problem.as_ref()?;
            Some(format!("{} on {}, {}: {problem}", group.id, group.adapter, group.place()))
        };
        let problems = report.groups.iter().filter_map(told).collect();
        Self { is_shard, expectations, unstable, regressions, problems }
    }

    /// What is wrong, each on a line with its title.
    pub(crate) fn lines(self) -> Vec<(String, String)> {
        let changed = |id: &String| (id.clone(), "its answer changed when it was asked once more".to_owned());
        let mut said: Vec<(String, String)> = self.unstable.iter().take(MOST_NAMED).map(changed).collect();
        said.extend(self.regressions.iter().map(|what| (BASELINE.to_owned(), what.clone())));
        let passes = self.expectations.iter().filter(|one| !self.is_shard && one.passes_unexpectedly());
        said.extend(passes.map(|one| (one.id.clone(), format!("passes, and is expected to fail: {}", one.reason))));
        said
    }
}

/// Writes it for people.
///
/// # Errors
/// Where the writer fails.
pub(crate) fn text(against: Against<'_>, out: &mut impl Write) -> Result {
    listed("changed when they were asked once more", against.unstable, out)?;
    listed("are worse than in the baseline", against.regressions, out)?;
    for one in against.expectations.iter().filter(|one| one.failed + one.passed > 0) {
        let said = match (one.failed, one.passes_unexpectedly() && !against.is_shard) {
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
    against.problems.iter().try_for_each(|problem| writeln!(out, "\nas expected: {problem}"))?;
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
