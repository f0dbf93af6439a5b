//! Folders for the files of tests: new for each process, so that two runs share none, and removed by a later one.

use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// What the folder of a process is called, and the file in it that the process locks as long as it lives.
const PREFIX: &str = "lightmeter-tests-";
const LOCK: &str = "lock";

/// The folder of this process, whose lock ends with it.
static OWN: LazyLock<(PathBuf, File)> = LazyLock::new(|| {
    // Of cargo's for tests where it says so, which is none that other programs share.
    let all = option_env!("CARGO_TARGET_TMPDIR").map_or_else(std::env::temp_dir, PathBuf::from);
    remove_dead(&all);
    let own = all.join(format!("{PREFIX}{}", std::process::id()));
    std::fs::create_dir_all(&own).expect("a folder can be made");
    let lock = File::create(own.join(LOCK)).expect("a file can be made");
    lock.try_lock().expect("no other process has this number");
    (own, lock)
});

/// Removes the folders of processes that have ended.
fn remove_dead(all: &Path) {
    for entry in std::fs::read_dir(all).into_iter().flatten().flatten() {
        let is_of_tests = entry.file_name().to_string_lossy().starts_with(PREFIX);
        let lock = File::open(entry.path().join(LOCK)).ok().filter(|_| is_of_tests);
        if lock.is_some_and(|lock| !matches!(lock.try_lock(), Err(TryLockError::WouldBlock))) {
            // Another process may be removing it.
            let _ = std::fs::remove_dir_all(entry.path());
        }
    }
}

/// An empty folder that nothing else has, with a name that says whose it is.
///
/// # Panics
/// Where it cannot be made.
#[must_use]
pub fn folder(test: &str) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let folder = OWN.0.join(format!("{test}-{}", COUNT.fetch_add(1, Ordering::Relaxed)));
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}
