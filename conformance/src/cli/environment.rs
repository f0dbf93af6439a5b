//! The environment that the process needs from its start on.

use super::observed::{EVENTS, HOLD};
use std::process::Command;

/// What has glibc keep memory that is let go. Images, chunks of cases and a software driver's copies of them are megabytes each, made
/// and let go thousands of times; as it comes, glibc gives them back to the system, which zeroes their pages anew every time.
const KEEPS_MEMORY: (&str, &str) =
    ("GLIBC_TUNABLES", "glibc.malloc.mmap_threshold=1073741824:glibc.malloc.trim_threshold=1073741824");
/// Where no desktop runs, one of Mesa's layers complains on standard error unless this is set.
const IS_SILENT: (&str, &str) = ("NODEVICE_SELECT", "1");

/// Says that the process was started anew already. A system may keep a variable from a program that has more rights than who starts it.
const IS_COMPLETE: (&str, &str) = ("LIGHTMETER_STARTED_ANEW", "1");

/// Variables that the environment lacks, each with its value.
fn missing() -> Vec<(&'static str, &'static str)> {
    let is_set = |name: &str| std::env::var_os(name).is_some();
    let mut missing = vec![];
    if is_set(IS_COMPLETE.0) {
        return missing;
    }
    if cfg!(unix) && !is_set("XDG_RUNTIME_DIR") && !is_set(IS_SILENT.0) {
        missing.push(IS_SILENT);
    }
    if cfg!(all(target_os = "linux", target_env = "gnu")) && !is_set(KEEPS_MEMORY.0) {
        missing.push(KEEPS_MEMORY);
    }
    missing
}

/// Starts the process anew where its environment lacks something, which is heard of at the start alone.
pub(crate) fn complete() {
    let missing = missing();
    #[cfg(unix)]
    if !missing.is_empty()
        && let Ok(program) = std::env::current_exe()
    {
        use std::os::unix::process::CommandExt as _;
        let mut given = std::env::args_os();
        let own = given.next().unwrap_or_else(|| program.clone().into());
        // It returns only where the program cannot be started.
        let _ = Command::new(program).arg0(own).args(given).envs(missing).env(IS_COMPLETE.0, IS_COMPLETE.1).exec();
    }
    #[cfg(not(unix))]
    drop(missing);
}

/// Removes the variables that are for this process alone from a child's environment.
pub(crate) fn spare(command: &mut Command) -> &mut Command {
    let (name, own) = KEEPS_MEMORY;
    let command = command.env_remove(IS_COMPLETE.0).env_remove(EVENTS).env_remove(HOLD);
    if std::env::var_os(name).is_some_and(|value| value == own) { command.env_remove(name) } else { command }
}
