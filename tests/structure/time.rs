//! No test depends on time: what a test may know of it stands in one list.

use crate::root;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What has to do with time in the text of a test.
const WORDS: [&str; 6] = ["sleep", "Duration", "Instant", "imeout", "elapsed()", "/proc"];

/// The only lines of tests in which one of these words stands: the file, what is in the line, and why no test passes or fails by it but one
/// that has failed already.
const ALLOWED: &[(&str, &str, &str)] = &[
    ("cli/held.rs", "use std::time::Duration;", "for the next row"),
    ("cli/held.rs", "const LIMIT: Duration", "ends a test that waits for an event in vain"),
    ("cli/held.rs", "recv_timeout(LIMIT)", "the same"),
    ("cli/gate/ending.rs", "use std::time::{Duration, Instant};", "for the next rows"),
    ("cli/gate/ending.rs", "const LIMIT: Duration", "ends a test that waits for another process in vain"),
    ("cli/gate/ending.rs", "LIMIT;", "the same"),
    ("cli/gate/ending.rs", "Instant::now() < until", "the same"),
    ("cli/gate/ending.rs", "std::thread::sleep(Duration::from_millis(5));", "between two looks at another process"),
    ("cli/gate/ending.rs", "sleep 0.01", "between two looks at a file"),
    ("cli/gate/ending.rs", "/proc/{number}/stat", "whether a process that has ended waits for its parent to ask"),
    (
        "cli/gate/ending.rs",
        "sleep 600",
        "a process that never answers and is ended; the limit of one expires however fast the machine is",
    ),
    ("cli/gate/ending.rs", "\"--case-timeout\", \"1e6\"", "no limit"),
    ("cli/gate/ending.rs", "`timeout` ", "a comment"),
    ("cli/gate/ending.rs", "\"--timeout\", \"0.5\"", "by the renderer's clock"),
    ("cli/gate/process.rs", "sleep 600", "a process that never answers and is ended"),
    ("cli/gate/process.rs", "\"--case-timeout\", \"1\"", "by the renderer's clock"),
    ("cli/gate/process.rs", "sleep 0.1", "between two ticks of the renderer's clock, in a process that is ended"),
    ("cli/hostile.rs", "Command::new(\"timeout\")", "ends a test that waits in vain"),
    ("cli/hostile.rs", "timeout 300", "the same"),
    ("cli/hostile.rs", "\"--timeout\", \"2\"", "by the renderer's clock"),
    ("examples/mutants.rs", "Instant", "is printed"),
    ("examples/mutants.rs", "elapsed()", "is printed"),
    ("src/harness/mod.rs", "Instant", "is printed"),
    ("src/harness/mod.rs", "elapsed()", "is printed"),
    ("browser/limit.mjs", "imeout", "ends a test that waits in vain, or a pause between two looks"),
    ("../conformance/examples/renderer.rs", "Duration", "the renderer's clock"),
    (
        "../conformance/examples/renderer.rs",
        "std::thread::sleep(",
        "where no test has taken the clock, and what never answers",
    ),
    ("../conformance/browser/src/play.rs", "const LONG: Duration", "ends a test that waits in vain"),
    ("../conformance/browser/src/play.rs", "Duration::from_millis(1)", "nobody answers, however long that is"),
    ("../conformance/browser/src/play.rs", "Duration::ZERO", "does not wait"),
    ("../conformance/browser/src/tests.rs", "Duration", "does not wait"),
    ("../conformance/gate/src/process/clock.rs", "Duration", "the renderer's clock, tested without time"),
    ("../conformance/src/cli/mod.rs", "GpuError::Timeout(60)", "an error as a value"),
];

/// The files below a folder with one of these endings, but for what was installed there.
fn files(folder: &Path, endings: &[&str], found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() && !path.ends_with("node_modules") && !path.ends_with("target") {
            files(&path, endings, found);
        } else if path.extension().is_some_and(|ending| endings.iter().any(|one| ending == *one)) {
            found.push(path);
        }
    }
}

/// The lines of tests: all of a file of tests, and those from a module of unit tests on elsewhere.
fn lines() -> Vec<(String, String)> {
    let tests = root().join("tests");
    let mut of_tests = vec![root().join("conformance/examples/renderer.rs")];
    files(&tests, &["rs", "mjs"], &mut of_tests);
    let mut others = vec![];
    for folder in ["conformance", "gpu", "reference"] {
        files(&root().join(folder), &["rs"], &mut others);
    }
    let mut found = vec![];
    for path in of_tests.iter().chain(others.iter().filter(|path| !of_tests.contains(path))) {
        let text = std::fs::read_to_string(path).expect("a source can be read");
        let is_of_tests = of_tests.contains(path) || path.ends_with("tests.rs");
        let start = if is_of_tests { Some(0) } else { text.find("#[cfg(test)]\nmod") };
        let name = match path.strip_prefix(&tests) {
            Ok(own) => own.to_owned(),
            Err(_) => Path::new("..").join(path.strip_prefix(root()).expect("it lies there")),
        };
        let name = name.to_str().expect("UTF-8").to_owned();
        found.extend(text[start.unwrap_or(text.len())..].lines().map(|line| (name.clone(), line.trim().to_owned())));
    }
    found
}

#[test]
fn no_test_knows_of_time_but_what_ends_one_that_fails() {
    let mut needed = BTreeSet::new();
    let mut others = vec![];
    for (file, line) in lines() {
        if file == "structure/time.rs" || WORDS.iter().all(|word| !line.contains(word)) {
            continue;
        }
        match ALLOWED.iter().position(|(of, part, _)| *of == file && line.contains(part)) {
            Some(row) => drop(needed.insert(row)),
            None => others.push(format!("{file}: {line}")),
        }
    }
    assert!(
        others.is_empty(),
        "wait for an event instead (tests/cli/held.rs), or tell the gate's time (LIGHTMETER_CLOCK): {others:#?}"
    );
    let stale: Vec<_> = (0..ALLOWED.len()).filter(|row| !needed.contains(row)).map(|row| ALLOWED[row]).collect();
    assert!(stale.is_empty(), "these rows allow nothing any more: {stale:#?}");
}
