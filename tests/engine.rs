//! The example engine, a package outside of the workspace: its own `cargo test` finds its bug, and names it.

use std::path::Path;
use std::process::Command;

#[test]
fn the_example_engine_finds_its_bug_by_its_own_tests() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/engine");
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("engine");
    let test = |name: &str| {
        let output = Command::new(env!("CARGO"))
            .args(["test", "--quiet", "--locked", "--test", name, "--target-dir"])
            .arg(&target)
            // Built once and run for a moment: what optimising takes would not be won back.
            .args(["--config", "profile.dev.package.\"*\".opt-level=0", "--config", "profile.dev.debug=false"])
            .args(["--config", "profile.dev.incremental=false"])
            .current_dir(&folder)
            .output()
            .expect("cargo starts");
        let told = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
        (output.status.success(), told)
    };
    let (passes, told) = test("one_formula");
    assert!(passes, "{told}");
    let (passes, told) = test("conformance");
    assert!(!passes && told.contains("4 passed; 1 failed"), "{told}");
    for what in ["lighting/blinn: ", "(half-vector-as-mean)", "legal from"] {
        assert!(told.contains(what), "no {what} in {told}");
    }
    // The README's five bugs.
    let (passes, told) = test("thirty");
    assert!(!passes && told.contains("25 passed; 5 failed"), "{told}");
    let readme = std::fs::read_to_string(folder.join("README.md")).expect("it is there");
    let names = [
        "half-vector-as-mean",
        "reflect-once",
        "normal-reversed",
        "attenuation-quadratic-of-distance",
        "fog-exp2-document",
    ];
    for name in names {
        assert!(told.contains(&format!("({name})")), "no {name} in {told}");
        assert!(readme.contains(&format!("`{name}`")), "no {name} in the README");
    }
}
