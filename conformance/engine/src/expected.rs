//! Known failures of what is no row of numbers: images, pixels of blend units, special values.

use crate::options::Options;
use lightmeter_document::run::Report;

/// Notes at the expectations that have a case whether it failed; whether its failure was expected.
pub(crate) fn expect(report: &mut Report, options: &Options, id: &str, has_failed: bool) -> bool {
    let mut is_expected = false;
    for (known, expected) in report.expectations.iter_mut().zip(&options.expected) {
        if expected.has(id) {
            is_expected = true;
            let count = if has_failed { &mut known.failed } else { &mut known.passed };
            *count += 1;
        }
    }
    is_expected && has_failed
}
