//! `lightmeter pack` and `lightmeter gate`: other renderers, by their files and as processes, right ones and all sorts of wrong.

use super::{code, command, lightmeter, stderr, stdout};
use serde_json::Value;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};

/// A folder of this test's own.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gate").join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// Packs cases and answers them by the reference, as `eval` does.
fn answered(test: &str, filter: &[&str]) -> (PathBuf, PathBuf) {
    let folder = folder(test);
    let (pack, answers) = (folder.join("pack"), folder.join("answers.jsonl"));
    let output = lightmeter(&[&["pack", text(&pack)], filter, &["--cases", "64"]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let cases = std::fs::File::open(pack.join("cases.jsonl")).expect("there are cases");
    let output = command(&["eval"]).stdin(cases).output().expect("the binary starts");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    std::fs::write(&answers, &output.stdout).expect("answers can be written");
    (pack, answers)
}

fn judged(pack: &Path, answers: &Path, more: &[&str]) -> (i32, Value) {
    let args = [&["gate", text(pack), text(answers), "--format", "json"], more].concat();
    report(&lightmeter(&args))
}

fn report(output: &Output) -> (i32, Value) {
    let report = serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {}", stderr(output)));
    (code(output), report)
}

fn edit(answers: &Path, edit: impl Fn(usize, &str) -> String) -> PathBuf {
    let before = std::fs::read_to_string(answers).expect("there are answers");
    let after: String = before.lines().enumerate().map(|(k, line)| edit(k, line)).collect();
    let path = answers.with_extension("edited.jsonl");
    std::fs::write(&path, after).expect("answers can be written");
    path
}

/// An answer with another value that is legal: the greatest.
fn at_the_end(line: &str) -> String {
    let mut answer: Value = serde_json::from_str(line).expect("it is JSON");
    answer["value"][1] = answer["high"][1].clone();
    format!("{answer}\n")
}

/// A gate over the example renderer, with something that goes wrong in it.
fn process(filter: &[&str], fault: &str, more: &[&str]) -> Output {
    let binary = Path::new(env!("CARGO_BIN_EXE_lightmeter"));
    let renderer = binary.parent().expect("it lies in a folder").join("examples/renderer");
    assert!(
        renderer.exists(),
        "it is built by `cargo test` of the whole workspace, and by `cargo build --example renderer`"
    );
    let exec = format!("'{}' {fault}", text(&renderer));
    let args = [&["gate", "--exec", &exec, "--format", "json", "--cases", "64"], filter, more].concat();
    lightmeter(&args)
}

fn count(report: &Value, of: &str) -> u64 {
    report["totals"][of].as_u64().unwrap_or_else(|| panic!("no {of}: {}", report["totals"]))
}

#[test]
fn right_answers_pass_and_the_report_is_whole() {
    let (pack, answers) = answered("right", &["fog", "vector/reflect"]);
    let (status, report) = judged(&pack, &answers, &[]);
    assert_eq!((status, report["schema"].as_str()), (0, Some("lightmeter.gate/1")), "{report}");
    let lines = std::fs::read_to_string(pack.join("cases.jsonl")).expect("there are cases").lines().count() as u64;
    assert_eq!((count(&report, "asked"), count(&report, "passed"), count(&report, "failed")), (lines, lines, 0));
    let manifest = std::fs::read_to_string(pack.join("manifest.json")).expect("there is a manifest");
    let manifest: Value = serde_json::from_str(&manifest).expect("it is JSON");
    assert_eq!(manifest["schema"], "lightmeter.pack/1");
    assert_eq!(manifest["formulas"].as_array().map(Vec::len), report["groups"].as_array().map(Vec::len));
}

#[test]
fn each_wrong_line_is_named_and_every_good_answer_is_judged() {
    let (pack, answers) = answered("wrong", &["fog/exp"]);
    let all = std::fs::read_to_string(&answers).expect("there are answers").lines().count() as u64;
    type Edit = fn(usize, &str) -> String;
    // What goes wrong in line 5; what is counted, and the exit code.
    let rows: [(&str, Edit, &str, u64, i32); 7] = [
        (
            "malformed",
            |k, line| if k == 5 { line[..30].to_owned() + "\n" } else { line.to_owned() + "\n" },
            "missing",
            1,
            4,
        ),
        (
            "duplicate",
            |k, line| if k == 5 { format!("{line}\n{line}\n") } else { line.to_owned() + "\n" },
            "missing",
            0,
            4,
        ),
        (
            "unknown",
            |k, line| line.replace("fog/exp/", if k == 5 { "fog/out/" } else { "fog/exp/" }) + "\n",
            "missing",
            1,
            4,
        ),
        (
            "oversized",
            |k, line| if k == 5 { "x".repeat(2 << 20) + "\n" } else { line.to_owned() + "\n" },
            "missing",
            1,
            4,
        ),
        ("", |k, line| if k == 5 { String::new() } else { line.to_owned() + "\n" }, "missing", 1, 1),
        (
            "",
            |k, line| if k == 5 { line.replacen("[", "[\"NaN\",", 1) + "\n" } else { line.to_owned() + "\n" },
            "failed",
            1,
            1,
        ),
        (
            "",
            |k, line| {
                if k == 5 { line.replacen("\"value\":[", "\"value\":[9", 1) + "\n" } else { line.to_owned() + "\n" }
            },
            "failed",
            1,
            1,
        ),
    ];
    for (problem, wrong, counted, expected, status) in rows {
        let (found, report) = judged(&pack, &edit(&answers, wrong), &[]);
        assert_eq!((found, count(&report, counted)), (status, expected), "{problem}: {report}");
        assert!(count(&report, "passed") >= all - 1, "{problem}: {report}");
        if problem.is_empty() {
            assert_eq!(report["problems"]["counts"], serde_json::json!({}), "{report}");
        } else {
            assert_eq!(report["problems"]["counts"][problem], 1, "{report}");
        }
    }
}

#[test]
fn a_second_run_must_answer_the_same() {
    let (pack, answers) = answered("again", &["fog/exp"]);
    let number = std::fs::read_to_string(&answers).expect("there are answers").lines().count() - 1;
    let again = edit(&answers, |k, line| if k == number { at_the_end(line) } else { line.to_owned() + "\n" });
    let (status, report) = judged(&pack, &answers, &[text(&answers)]);
    assert_eq!((status, count(&report, "unstable")), (0, 0), "{report}");
    let (status, report) = judged(&pack, &answers, &[text(&again)]);
    assert_eq!((status, count(&report, "unstable")), (1, 1), "{report}");
}

#[test]
fn a_process_that_fails_in_any_way_costs_that_case_alone() {
    let case = "fog/exp/random/000017";
    // The fault; the exit code; cases that fail, and that are never answered; what is said.
    let rows: [(&str, i32, u64, &str); 9] = [
        ("", 0, 0, ""),
        ("crash-at", 4, 1, "it ended"),
        ("hang-at", 4, 1, "longer"),
        ("nan-at", 1, 1, ""),
        ("truncated-at", 4, 0, "malformed"),
        ("long-at", 4, 0, "oversized"),
        ("unknown-at", 4, 0, "fog/none"),
        ("twice-at", 4, 0, "more than once"),
        ("short-at", 1, 1, "expected 4"),
    ];
    for (fault, status, failed, said) in rows {
        let fault = format!("{fault}={case}");
        let output = process(&["fog/exp", "vector"], &fault, &["--case-timeout", "1.5"]);
        let (found, report) = report(&output);
        assert_eq!((found, count(&report, "failed")), (status, failed), "{fault}: {report}");
        assert_eq!(count(&report, "passed"), count(&report, "asked") - failed, "{fault}: {report}");
        assert!(report.to_string().contains(said), "{fault}: {report}");
    }
    let (status, found) = report(&process(&["fog/exp"], "unstable-at=fog/exp/random/000003", &[]));
    assert_eq!((status, count(&found, "unstable")), (1, 1), "{found}");
    let dropped = process(&["fog/exp"], &format!("drop-at={case}"), &["--case-timeout", "1.5"]);
    let (status, found) = report(&dropped);
    assert_eq!((status, count(&found, "failed")), (4, 1), "{found}");
}

#[test]
fn scenes_are_drawn_and_judged() {
    let output = process(&["scene/phong-blinn", "scene/flat"], "", &[]);
    let (status, found) = report(&output);
    assert_eq!((status, count(&found, "passed")), (0, 2), "{found}");
    for (fault, said) in [("half-at", "the scene is"), ("elsewhere-at", "leaves the folder")] {
        let (status, found) = report(&process(&["scene/flat"], &format!("{fault}=scene/flat"), &[]));
        assert_eq!((status, count(&found, "failed")), (1, 1), "{found}");
        assert!(found.to_string().contains(said), "{found}");
    }
}

#[test]
fn a_renderer_that_never_starts_is_told() {
    for (exec, said) in [
        ("exit 3", "ended before its hello"),
        ("echo what", "first; expected a hello"),
        ("/no/such/renderer", "not found"),
    ] {
        let output = lightmeter(&["gate", "fog", "--exec", exec]);
        assert_eq!(code(&output), 4, "{exec}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{exec}: {}", stderr(&output));
    }
}

#[test]
fn packs_that_are_damaged_or_of_another_kind_are_refused() {
    let (pack, answers) = answered("damaged", &["fog/exp"]);
    let manifest = pack.join("manifest.json");
    let right = std::fs::read_to_string(&manifest).expect("there is a manifest");
    let rows = [
        ("lightmeter.pack/1", "lightmeter.pack/9", "its schema is `lightmeter.pack/9`"),
        ("\"generator\": 2", "\"generator\": 1", "drawn by generator 1"),
        ("\"cases.jsonl\"", "\"../answers.jsonl\"", "leaves the folder"),
        ("\"crc32\": \"", "\"crc32\": \"0", "not what was packed"),
        ("\"files\"", "\"", "damaged"),
        ("{", "", "damaged"),
    ];
    for (what, wrong, said) in rows {
        assert!(right.contains(what), "{what}");
        std::fs::write(&manifest, right.replacen(what, wrong, 1)).expect("it can be written");
        let output = lightmeter(&["gate", text(&pack), text(&answers)]);
        assert_eq!(code(&output), 2, "{wrong}: {}", stdout(&output));
        assert!(stderr(&output).contains(said), "{wrong}: {}", stderr(&output));
    }
    for (args, said) in [
        (&["gate"][..], "expected PACK ANSWERS"),
        (&["gate", text(&pack)][..], "expected PACK ANSWERS"),
        (&["gate", "nowhere", "nothing"][..], "nowhere"),
        (&["pack", "/dev/null/x", "fog"][..], "cannot write"),
        (&["gate", "--exec", "true", "fog/none"][..], "no case matches"),
    ] {
        let output = lightmeter(args);
        assert!(code(&output) >= 2 && stderr(&output).contains(said), "{args:?}: {}", stderr(&output));
    }
}

#[test]
fn nothing_gets_worse_than_the_baseline() {
    let (pack, answers) = answered("baseline", &["fog/exp", "fog/linear"]);
    let file = pack.with_file_name("baseline.json");
    let missing = lightmeter(&["gate", text(&pack), text(&answers), "--baseline", text(&file)]);
    assert_eq!(code(&missing), 2, "nothing is written unless it is asked for");
    let (status, _) = judged(&pack, &answers, &["--baseline", text(&file), "--update-baseline"]);
    assert!(status == 0 && file.exists());
    let (status, report) = judged(&pack, &answers, &["--baseline", text(&file)]);
    assert_eq!((status, report["regressions"].as_array().map(Vec::len)), (0, Some(0)), "{report}");
    let number = std::fs::read_to_string(&answers).expect("there are answers").lines().count() - 1;
    let worse = edit(&answers, |k, line| if k == number { at_the_end(line) } else { line.to_owned() + "\n" });
    let (status, report) = judged(&pack, &worse, &["--baseline", text(&file)]);
    let regressions = report["regressions"].to_string();
    assert!(status == 1 && count(&report, "failed") == 0 && regressions.contains("errs by"), "{report}");
    let (status, _) = judged(&pack, &worse, &["--baseline", text(&file), "--growth", "100"]);
    assert_eq!(status, 0);
    let (others, more) = answered("other-baseline", &["fog/exp"]);
    let output = lightmeter(&["gate", text(&others), text(&more), "--baseline", text(&file)]);
    assert!(code(&output) == 2 && stderr(&output).contains("is of other cases: filter"), "{}", stderr(&output));
}

#[test]
fn known_failures_are_expected_and_told_when_they_pass() {
    let (pack, answers) = answered("expected", &["fog/exp"]);
    let wrong = edit(
        &answers,
        |k, line| if k == 5 { line.replacen("\"value\":[", "\"value\":[9", 1) } else { line.into() } + "\n",
    );
    let file = pack.with_file_name("expected.toml");
    std::fs::write(&file, "[[expected]]\nid = \"fog/exp\"\nreason = \"known\"\n").expect("it can be written");
    let (status, report) = judged(&pack, &wrong, &["--expect", text(&file)]);
    assert_eq!((status, count(&report, "expected_failures")), (0, 1), "{report}");
    let (status, report) = judged(&pack, &answers, &["--expect", text(&file)]);
    assert_eq!((status, count(&report, "unexpected_passes")), (1, 1), "{report}");
    std::fs::write(&file, "[[expected]]\nid = \"fog/exp\"\n").expect("it can be written");
    let output = lightmeter(&["gate", text(&pack), text(&answers), "--expect", text(&file)]);
    assert!(code(&output) == 2 && stderr(&output).contains("missing field `reason`"), "{}", stderr(&output));
}

#[test]
fn results_are_written_for_servers() {
    let (pack, answers) = answered("outputs", &["fog/exp"]);
    let wrong = edit(
        &answers,
        |k, line| if k == 5 { line.replacen("\"value\":[", "\"value\":[9", 1) } else { line.into() } + "\n",
    );
    for (format, said) in
        [("junit", "<failure message=\"1 of"), ("github", "::error title=fog/exp::1 of"), ("text", "✗ fog/exp: 1 of")]
    {
        let output = lightmeter(&["gate", text(&pack), text(&wrong), "--format", format]);
        assert!(code(&output) == 1 && stdout(&output).contains(said), "{format}: {}", stdout(&output));
    }
}

#[test]
fn nothing_declared_is_nothing_judged() {
    let folder = folder("nothing");
    let (pack, _) = answered("nothing-pack", &["fog/exp"]);
    let answers = folder.join("answers.jsonl");
    std::fs::write(&answers, "{\"renderer\": \"none\", \"formulas\": []}\n").expect("it can be written");
    let output = lightmeter(&["gate", text(&pack), text(&answers)]);
    assert_eq!(code(&output), 3, "{}", stdout(&output));
    let mut child = command(&["gate", text(&pack), "/dev/stdin"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    child.stdin.take().expect("a pipe").write_all(b"").expect("it is read");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(code(&output), 1, "every case is missing: {}", stdout(&output));
}
