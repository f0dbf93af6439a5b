//! Lines that cannot be read as answers: counted by kind, the first of them in words.

use super::words::clipped;
use lightmeter_document::by_case::Problems;

/// Problems of each kind that are kept in words.
const KEPT: u64 = 32;

/// Notes a problem of a kind.
pub(super) fn note(problems: &mut Problems, kind: &'static str, what: impl FnOnce() -> String) {
    let count = problems.counts.entry(kind.into()).or_default();
    *count += 1;
    if *count <= KEPT {
        problems.first.push(clipped(&what()));
    }
}
