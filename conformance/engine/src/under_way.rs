//! What is told while a run goes on, and when it is over before its time.

use crate::device::DeviceError;
use crate::options::Options;
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::report::{Failure, Group, Interrupted, Report};

/// Tells each group with its failures.
pub(crate) fn tell(groups: &[Group], failures: &[Failure], is_scouted: bool, observer: &mut dyn Observer) {
    for group in groups {
        let is_of_group = |failure: &&Failure| {
            let place = (&failure.adapter, &failure.stage) == (&group.adapter, &group.stage);
            let smallest = group.by_case.as_ref().and_then(|counts| counts.smallest.as_ref());
            let is_of_group = group.has_case(&failure.id) || smallest == Some(&failure.id);
            place && failure.target == group.target && is_of_group
        };
        let failures = failures.iter().filter(is_of_group).collect();
        observer.see(&Event::Judged { group, failures, is_scouted });
    }
}

/// Whether nothing more is to be judged: a device failed, or somebody stopped the run. The report says what was under way.
pub(crate) fn is_over(
    judged: Result<(), DeviceError>,
    under_way: &str,
    options: &Options,
    report: &mut Report,
) -> Result<bool, DeviceError> {
    match (judged, options.stop.interrupted("the run", under_way)) {
        (Err(error), _) if error.is_of_device() => {
            let interrupted = Interrupted::by_device(under_way, &error);
            report.interrupted.get_or_insert(interrupted);
            Ok(true)
        }
        (Err(error), _) => Err(error),
        (Ok(()), None) => Ok(false),
        (Ok(()), Some(interrupted)) => {
            report.interrupted.get_or_insert(interrupted);
            Ok(true)
        }
    }
}
