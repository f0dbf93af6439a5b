//! Known failures of what is no row of numbers: images, special values, and groups as a whole.

use crate::options::Options;
use lightmeter_catalogue::filter::Filter;
use lightmeter_document::by_case::KnownFailure;
use lightmeter_document::run::{Group, Report};

/// Notes at the expectations that have a case on a stage or a target whether it failed; whether its failure was expected.
pub(crate) fn expect(report: &mut Report, options: &Options, id: &str, on: &[&str], has_failed: bool) -> bool {
    let mut is_expected = false;
    for (known, expected) in report.expectations.iter_mut().zip(&options.expected) {
        if expected.has(id, on) {
            is_expected = true;
            let count = if has_failed { &mut known.failed } else { &mut known.passed };
            *count += 1;
        }
    }
    is_expected && has_failed
}

/// Moves to the expected ones what is wrong with whole groups that an expectation selects.
pub(crate) fn expect_problems(groups: &mut [Group], expectations: &mut [KnownFailure]) {
    for group in groups.iter_mut().filter(|group| group.problem.is_some()) {
        let on = [Some(group.stage.to_string()), group.target.as_ref().map(ToString::to_string)];
        let selects = |known: &&mut KnownFailure| {
            (known.on.is_none() || on.contains(&known.on))
                && Filter::new(std::slice::from_ref(&known.id)).is_ok_and(|filter| filter.selects(&group.id))
        };
        let mut known = expectations.iter_mut().filter(selects).peekable();
        if known.peek().is_some() {
            known.for_each(|known| known.failed += 1);
            group.expected_problem = group.problem.take();
            group.totals.failed_groups = 0;
        }
    }
}
