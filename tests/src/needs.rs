//! What a test needs that not every machine has.

use crate::skip::{DRIVER, lacks};
use lightmeter::adapters;
use lightmeter::special::record::OnRecord;
use std::sync::LazyLock;

/// lavapipe, the adapter that is taken where none is named.
const LAVAPIPE: (&str, &str) = ("lavapipe", "needs lavapipe (Debian: apt-get install libvulkan1 mesa-vulkan-drivers)");
/// That lavapipe in a version and on a processor whose results are on record, as the documentation quotes them.
const RECORDED: (&str, &str) = (
    "recorded-lavapipe",
    "needs a lavapipe that conformance/judge/records has results of: Mesa 22.3.6, as in Debian 12",
);

/// Whether this thread's test is skipped for want of any driver.
#[must_use]
pub fn lacks_driver() -> bool {
    lacks(has_no_driver(), DRIVER)
}

/// Whether no driver is there, and none is named that would have to be.
#[must_use]
pub fn has_no_driver() -> bool {
    let is_named = |variable: &&str| std::env::var_os(variable).is_some_and(|value| !value.is_empty());
    !adapters::names().is_ok_and(|names| !names.is_empty())
        && !["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].iter().any(is_named)
}

/// Whether this thread's test is skipped for want of lavapipe.
#[must_use]
pub fn lacks_lavapipe() -> bool {
    lacks(!is_lavapipe_there(), LAVAPIPE)
}

/// Whether this thread's test is skipped for want of a lavapipe of which results are on record.
#[must_use]
pub fn lacks_recorded_lavapipe() -> bool {
    static IS_THERE: LazyLock<bool> = LazyLock::new(|| {
        let subjects = if is_lavapipe_there() { adapters::open(&[]).unwrap_or_default() } else { vec![] };
        subjects.iter().any(|subject| OnRecord::of(&subject.identity).is_some_and(|found| found.binds))
    });
    lacks(!*IS_THERE, RECORDED)
}

fn is_lavapipe_there() -> bool {
    static IS_THERE: LazyLock<bool> =
        LazyLock::new(|| adapters::names().is_ok_and(|names| names.iter().any(|name| name == "lavapipe")));
    *IS_THERE
}
