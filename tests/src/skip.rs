//! A test is skipped by name where something that it needs is missing.

use std::fs::File;
use std::io::Write as _;

/// The file that `./x test` reads the names of skipped tests from.
const SKIPPED: &str = "LIGHTMETER_SKIPPED";
/// With `CI=true`: needs that may be missing, by their names.
const MAY_SKIP: &str = "LIGHTMETER_MAY_SKIP";

/// A Vulkan driver as a need: its name, and what provides it.
pub const DRIVER: (&str, &str) =
    ("driver", "needs a Vulkan driver (Debian: apt-get install libvulkan1 mesa-vulkan-drivers)");

/// Whether this thread's test is skipped for want of something, which is then said by the test's name.
///
/// # Panics
/// With `CI=true`, where nobody has said that this may be missing.
#[must_use]
pub fn lacks(is_missing: bool, need: (&str, &str)) -> bool {
    is_missing && {
        let skipped = skip(std::thread::current().name().unwrap_or("a test"), need);
        skipped.unwrap_or_else(|message| panic!("{message}"));
        true
    }
}

/// Says that a test is skipped, and for want of what.
///
/// # Errors
/// With `CI=true`, where nobody has said that this may be missing.
pub fn skip(test: &str, (name, missing): (&str, &str)) -> Result<(), String> {
    let variable = |name: &str| std::env::var(name).unwrap_or_default();
    let may_skip = variable(MAY_SKIP).split(' ').any(|one| one == name);
    if variable("CI") == "true" && !may_skip {
        return Err(format!("{test} {missing}; with CI=true that is a failure"));
    }
    let line = format!("skipped: {test} {missing}\n");
    let file = std::env::var_os(SKIPPED).and_then(|path| File::options().append(true).open(path).ok());
    // Standard error is not captured in this way. Where neither can be written, nobody reads it.
    let _ = match file {
        Some(mut file) => file.write_all(line.as_bytes()),
        None => std::io::stderr().write_all(line.as_bytes()),
    };
    Ok(())
}
