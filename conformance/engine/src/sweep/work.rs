//! The work on a block of a sweep.

use crate::device::DeviceError;
use lightmeter_document::sweep::Statistics;

/// What does a block's work: starts it, and later says what came of it.
pub(super) trait Work {
    /// A block under way.
    type Job;
    /// Starts on `count` inputs, from the one numbered `first`.
    fn start(&mut self, first: u64, count: u64) -> Self::Job;
    /// What came of it.
    fn finish(&mut self, job: Self::Job) -> Result<Statistics, DeviceError>;
}
