//! Known failures of what is no row of numbers: images, special values, and groups as a whole.

use crate::options::Options;
use lightmeter_catalogue::filter::Filter;
use lightmeter_document::by_case::KnownFailure;
use lightmeter_document::report::{Diagnosis, Group, Report};

/// Notes at the expectations that have a case on a stage or a target whether it failed; whether its failure was expected. A failure has a
/// diagnosis where mistakes may explain it.
pub(crate) fn expect(
    report: &mut Report,
    options: &Options,
    id: &str,
    on: &[&str],
    has_failed: bool,
    found: Option<&Diagnosis>,
) -> bool {
    let mut is_expected = false;
    for (known, expected) in report.expectations.iter_mut().zip(&options.expected) {
        let is_explained = || found.is_some_and(|found| found.is_all_by(&known.mistake));
        if expected.has(id, on) && (!has_failed || known.mistake.is_empty() || is_explained()) {
            is_expected = true;
            let count = if has_failed { &mut known.failed } else { &mut known.passed };
            *count += 1;
        }
    }
    is_expected && has_failed
}

/// Takes back that problems of a shard's groups are expected, since the whole may have others.
pub(crate) fn expect_nothing(report: &mut Report) {
    let Report { groups, expectations, .. } = report;
    for group in groups.iter_mut().filter(|group| !group.expected_problems.is_empty()) {
        selecting(group, expectations).for_each(|known| known.failed = known.failed.saturating_sub(1));
        group.problems.append(&mut group.expected_problems);
    }
}

/// The expectations of a group's problems. A mistake excuses cases alone.
fn selecting<'a>(group: &Group, expectations: &'a mut [KnownFailure]) -> impl Iterator<Item = &'a mut KnownFailure> {
    let on = [Some(group.stage.to_string()), group.target.as_ref().map(ToString::to_string)];
    let id = group.id.clone();
    expectations.iter_mut().filter(move |known| {
        known.mistake.is_empty()
            && (known.on.is_none() || on.contains(&known.on))
            && Filter::new(std::slice::from_ref(&known.id)).is_ok_and(|filter| filter.selects(&id))
    })
}

/// Moves to the expected ones what is wrong with whole groups that an expectation selects.
pub(crate) fn expect_problems(groups: &mut [Group], expectations: &mut [KnownFailure]) {
    for group in groups.iter_mut().filter(|group| !group.problems.is_empty()) {
        let mut known = selecting(group, expectations).peekable();
        if known.peek().is_some() {
            known.for_each(|known| known.failed += 1);
            group.expected_problems = std::mem::take(&mut group.problems);
            group.totals.failed_groups = 0;
        }
    }
}
