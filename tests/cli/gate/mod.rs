//! `lightmeter pack` and `lightmeter gate`: other renderers, by their files and as processes, right ones and all sorts of wrong.

mod columns;
mod declared;
mod ending;
mod hello;
mod merged;
pub(crate) mod process;
mod special;
mod targets;

use super::{code, command, lightmeter, stderr, stdout};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Output;

/// A folder of this test's own.
pub(crate) fn folder(test: &str) -> PathBuf {
    crate::folder(&format!("gate-{test}"))
}

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// Packs cases and answers them by the reference, as `eval` does.
pub(crate) fn answered(test: &str, filter: &[&str]) -> (PathBuf, PathBuf) {
    answered_of(test, filter, 64)
}

/// The same with `cases` random cases.
fn answered_of(test: &str, filter: &[&str], cases: u32) -> (PathBuf, PathBuf) {
    let folder = folder(test);
    let (pack, answers) = (folder.join("pack"), folder.join("answers.jsonl"));
    let output = lightmeter(&[&["pack", text(&pack)], filter, &["--cases", &cases.to_string()]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let given = std::fs::File::open(pack.join("cases.jsonl")).expect("there are cases");
    let output = command(&["eval"]).stdin(given).output().expect("the binary starts");
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

pub(crate) fn edit(answers: &Path, edit: impl Fn(usize, &str) -> String) -> PathBuf {
    edit_as(answers, "edited", edit)
}

fn edit_as(answers: &Path, name: &str, edit: impl Fn(usize, &str) -> String) -> PathBuf {
    let before = std::fs::read_to_string(answers).expect("there are answers");
    let after: String = before.lines().enumerate().map(|(k, line)| edit(k, line)).collect();
    let path = answers.with_extension(format!("{name}.jsonl"));
    std::fs::write(&path, after).expect("answers can be written");
    path
}

/// An answer with another value that is legal: the greatest.
fn at_the_end(line: &str) -> String {
    let mut answer: Value = serde_json::from_str(line).expect("it is JSON");
    answer["value"][1] = answer["high"][1].clone();
    format!("{answer}\n")
}

/// The groups of a result, but for who answered and how long it took.
fn groups(report: &Value) -> Value {
    let mut groups = report["groups"].clone();
    for group in groups.as_array_mut().into_iter().flatten() {
        group["seconds"] = Value::Null;
        group["adapter"] = Value::Null;
    }
    groups
}

fn count(report: &Value, of: &str) -> u64 {
    let [cases, verdicts] = [&report["by_case"], &report["totals"]];
    let count = match of {
        "unstable" => report["unstable"].as_u64().or(Some(0)),
        _ => cases[of].as_u64().or(verdicts[of].as_u64()),
    };
    count.unwrap_or_else(|| panic!("no {of}: {cases}, {verdicts}"))
}

#[test]
fn right_answers_pass_and_the_report_is_whole() {
    let (pack, answers) = answered("right", &["fog", "vector/reflect"]);
    let (status, report) = judged(&pack, &answers, &[]);
    assert_eq!((status, report["schema"].as_str()), (0, Some("lightmeter.report/2")), "{report}");
    let lines = std::fs::read_to_string(pack.join("cases.jsonl")).expect("there are cases").lines().count() as u64;
    assert_eq!((count(&report, "asked"), count(&report, "passed"), count(&report, "failed")), (lines, lines, 0));
    let manifest = std::fs::read_to_string(pack.join("manifest.json")).expect("there is a manifest");
    let manifest: Value = serde_json::from_str(&manifest).expect("it is JSON");
    assert_eq!(manifest["schema"], "lightmeter.pack/1");
    assert_eq!(manifest["formulas"].as_array().map(Vec::len), report["groups"].as_array().map(Vec::len));
}

#[test]
fn the_order_of_answers_changes_nothing_that_is_told() {
    let (pack, answers) = answered("order", &["fog/exp", "vector/reflect"]);
    let wrong = edit_as(&answers, "wrong", |k, line| {
        let mut answer: Value = serde_json::from_str(line).expect("it is JSON");
        if k % 3 > 0 {
            answer["value"][1] = 0.75.into();
        }
        format!("{answer}\n")
    });
    let lines = std::fs::read_to_string(&wrong).expect("it was written");
    let backwards = answers.with_extension("backwards.jsonl");
    std::fs::write(&backwards, lines.lines().rev().map(|line| format!("{line}\n")).collect::<String>())
        .expect("a file");
    let told = |answers: &Path| {
        let (status, mut report) = judged(&pack, answers, &[]);
        for group in report["groups"].as_array_mut().expect("groups") {
            // A sum of floats.
            group["by_case"]["error_mean"] = Value::Null;
            group["seconds"] = Value::Null;
        }
        (status, report["totals"].clone(), report["groups"].clone(), report["failures"].clone())
    };
    let (status, totals, groups, failures) = told(&wrong);
    assert!(status == 1 && totals["failed"].as_u64() > Some(50), "{totals}");
    let back = told(&backwards);
    assert_eq!((status, totals, groups), (back.0, back.1, back.2));
    assert_eq!(failures, back.3);
}

#[test]
fn each_wrong_line_is_named_and_every_good_answer_is_judged() {
    let (pack, answers) = answered("wrong", &["fog/exp"]);
    let all = std::fs::read_to_string(&answers).expect("there are answers").lines().count() as u64;
    type Edit = fn(&str) -> String;
    // What becomes of line 5; what is counted, and the exit code.
    let rows: [(&str, Edit, &str, u64, i32); 7] = [
        ("malformed", |line| line[..30].to_owned() + "\n", "missing", 1, 4),
        ("duplicate", |line| format!("{line}\n{line}\n"), "missing", 0, 4),
        ("unknown", |line| line.replace("fog/exp/", "fog/out/") + "\n", "missing", 1, 4),
        ("oversized", |_| "x".repeat(2 << 20) + "\n", "missing", 1, 4),
        ("", |_| String::new(), "missing", 1, 1),
        ("", |line| line.replacen("[", "[\"NaN\",", 1) + "\n", "failed", 1, 1),
        ("", |line| line.replacen("\"value\":[", "\"value\":[9", 1) + "\n", "failed", 1, 1),
    ];
    for (problem, wrong, counted, expected, status) in rows {
        let edited = edit(&answers, |k, line| if k == 5 { wrong(line) } else { line.to_owned() + "\n" });
        let (found, report) = judged(&pack, &edited, &[]);
        assert_eq!((found, count(&report, counted)), (status, expected), "{problem}: {report}");
        assert!(count(&report, "passed") >= all - 1, "{problem}: {report}");
        if problem.is_empty() {
            assert_eq!(report["renderer"]["problems"]["counts"], serde_json::json!({}), "{report}");
        } else {
            assert_eq!(report["renderer"]["problems"]["counts"][problem], 1, "{report}");
            let line = if problem == "duplicate" { "line 7" } else { "line 6" };
            assert!(
                report["renderer"]["problems"]["first"][0].as_str().is_some_and(|what| what.contains(line)),
                "{report}"
            );
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
    // What the second run leaves out, says twice, or alone says.
    let fewer = edit(&answers, |k, line| if k == number { String::new() } else { line.to_owned() + "\n" });
    for given in [[&answers, &fewer], [&fewer, &answers]] {
        let (status, report) = judged(&pack, given[0], &[text(given[1])]);
        assert!(status == 1 && count(&report, "unstable") == 1, "{report}");
    }
    let twice = edit(&answers, |k, line| if k == 5 { format!("{line}\n{line}\n") } else { line.to_owned() + "\n" });
    let (status, report) = judged(&pack, &answers, &[text(&twice)]);
    assert!(status == 4 && report["renderer"]["problems"]["counts"]["duplicate"] == 1, "{report}");
    assert!(
        report["renderer"]["problems"]["first"][0].as_str().is_some_and(|what| what.contains("edited.jsonl")),
        "{report}"
    );
    let other =
        edit(&answers, |k, line| if k == 0 { "{\"renderer\": \"another\"}\n" } else { "" }.to_owned() + line + "\n");
    let (status, report) = judged(&pack, &answers, &[text(&other)]);
    // The first file says no name.
    assert!(status == 4 && report.to_string().contains("first file: `renderer` was"), "{report}");
}

#[test]
fn what_is_off_by_less_than_any_answer_shows_is_named() {
    let (pack, answers) = answered_of("systematic", &["vector/normalize/random"], 4096);
    let (status, report) = judged(&pack, &answers, &[]);
    assert_eq!((status, report["groups"][0]["problems"].is_null()), (0, true), "{report}");
    // Between what the group verdict names and what a single one does: see docs/selftest.md.
    let off = edit(&answers, |_, line| {
        let mut answer: Value = serde_json::from_str(line).expect("it is JSON");
        for value in answer["value"].as_array_mut().into_iter().flatten() {
            *value = (value.as_f64().expect("a number") * 1.000_000_4).into();
        }
        format!("{answer}\n")
    });
    let (status, report) = judged(&pack, &off, &[]);
    let problem = report["groups"][0]["problems"].to_string();
    assert_eq!((status, count(&report, "failed")), (1, 0), "{report}");
    assert!(problem.contains("as if v were") && problem.contains("larger"), "{problem}");
    let file = pack.with_file_name("expected.toml");
    std::fs::write(&file, "[[expected]]\nid = \"vector/normalize\"\nreason = \"known\"\n").expect("it can be written");
    let (status, report) = judged(&pack, &off, &["--expect", text(&file)]);
    let group = &report["groups"][0];
    assert!(status == 0 && group["problems"].is_null(), "{report}");
    assert!(group["expected_problems"].to_string().contains("as if v were"), "{group}");
}

#[test]
fn the_smallest_failing_case_is_told_with_its_numbers() {
    let (pack, answers) = answered("smallest", &["fog/exp"]);
    let wrong = edit(&answers, |_, line| line.replacen("\"value\":[", "\"value\":[9", 1) + "\n");
    let (status, report) = judged(&pack, &wrong, &[]);
    let smallest = report["groups"][0]["by_case"]["smallest"].as_str().expect("something fails");
    let failure = report["failures"].as_array().into_iter().flatten().find(|failure| failure["id"] == smallest);
    let failure = failure.unwrap_or_else(|| panic!("no numbers of {smallest}"));
    assert!(
        status == 1 && failure["answer"]["inputs"].as_array().is_some_and(|inputs| inputs.len() == 10),
        "{failure}"
    );
    for format in ["text", "github", "junit"] {
        let output = lightmeter(&["gate", text(&pack), text(&wrong), "--format", format]);
        assert!(stdout(&output).contains("smallest failing case"), "{}", stdout(&output));
        assert!(stdout(&output).contains(smallest), "{}", stdout(&output));
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn failures_tell_the_interval_of_the_profile_that_they_were_judged_by() {
    let (pack, answers) = answered("profile", &["fog", "lighting/blinn"]);
    let wrong = edit(&answers, |_, line| line.replacen("\"value\":[0", "\"value\":[90", 1) + "\n");
    for profile in ["wgsl", "opengl"] {
        let (status, report) = judged(&pack, &wrong, &["--profile", profile]);
        assert_eq!((status, &report["profile"]), (1, &Value::from(profile)));
        let given = std::fs::File::open(pack.join("cases.jsonl")).expect("there are cases");
        let legal = command(&["eval", "--profile", profile]).stdin(given).output().expect("the binary starts");
        let legal = stdout(&legal);
        let legal = legal.lines().map(|line| serde_json::from_str::<Value>(line).expect("it is JSON"));
        let legal: std::collections::HashMap<String, Value> =
            legal.map(|line| (line["id"].as_str().expect("it has an id").to_owned(), line)).collect();
        let failures = report["failures"].as_array().expect("something fails");
        assert!(failures.len() > 16, "{report}");
        for failure in failures {
            let legal = &legal[failure["id"].as_str().expect("it has an id")];
            let ends =
                |k: usize| failure["answer"]["interval"].as_array().into_iter().flatten().map(move |of| of[k].clone());
            assert_eq!(Value::from_iter(ends(0)), legal["low"], "{profile}: {failure}");
            assert_eq!(Value::from_iter(ends(1)), legal["high"], "{profile}: {failure}");
        }
    }
}

#[test]
fn packs_that_are_damaged_or_of_another_kind_are_refused() {
    let (pack, answers) = answered("damaged", &["fog/exp"]);
    let manifest = pack.join("manifest.json");
    let right = std::fs::read_to_string(&manifest).expect("there is a manifest");
    let rows = [
        ("lightmeter.pack/1", "lightmeter.pack/9", "its schema is `lightmeter.pack/9`"),
        ("\"generator\": 4", "\"generator\": 2", "drawn by generator 2"),
        ("\"cases.jsonl\"", "\"../answers.jsonl\"", "leaves the folder"),
        ("\"crc32\": \"", "\"crc32\": \"0", "not what was packed"),
        ("\"files\"", "\"", "damaged"),
        ("{", "", "damaged"),
        ("\"cases\": 64", "\"cases\": 63", "its formulas are not those"),
        ("\"seed\"", "\"is_unfinished\": true, \"seed\"", "not written to its end"),
        ("\"cases\": 64", "\"cases\": 0", "expected 1 to"),
        ("\"cases\": 64", "\"cases\": 999999999999", "expected 1 to"),
        ("\"size\": null", "\"size\": 100000", "expected 1 to"),
        ("\"id\": \"fog/exp\"", "\"id\": \"fog/linear\"", "its formulas are not those"),
        ("\"seed\": 1", "\"seed\": 2", "its `pack` is not `"),
        ("\"pack\": \"", "\"pack\": \"0", "its `pack` is not `"),
    ];
    for (what, wrong, said) in rows {
        assert!(right.contains(what), "{what}");
        std::fs::write(&manifest, right.replacen(what, wrong, 1)).expect("it can be written");
        let output = lightmeter(&["gate", text(&pack), text(&answers)]);
        assert_eq!(code(&output), 2, "{wrong}: {}", stdout(&output));
        assert!(stderr(&output).contains(said), "{wrong}: {}", stderr(&output));
    }
    // Lists that are emptied.
    for list in ["files", "formulas"] {
        let mut emptied: Value = serde_json::from_str(&right).expect("it is JSON");
        emptied[list] = serde_json::json!([]);
        std::fs::write(&manifest, emptied.to_string()).expect("it can be written");
        let output = lightmeter(&["gate", text(&pack), text(&answers)]);
        assert_eq!(code(&output), 2, "{list}: {}", stdout(&output));
        assert!(stderr(&output).contains(&format!("its {list} are not those")), "{}", stderr(&output));
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
fn a_pack_without_rules_and_meanings_is_read() {
    let (pack, answers) = answered("older", &["fog/exp"]);
    let manifest = pack.join("manifest.json");
    let right = std::fs::read_to_string(&manifest).expect("there is a manifest");
    let mut older: Value = serde_json::from_str(&right).expect("it is JSON");
    for formula in older["formulas"].as_array_mut().expect("formulas") {
        formula.as_object_mut().expect("an object").remove("rules").expect("it has rules");
        for list in ["inputs", "outputs"] {
            for value in formula[list].as_array_mut().expect("values") {
                value.as_object_mut().expect("an object").remove("means").expect("it has a meaning");
            }
        }
    }
    std::fs::write(&manifest, older.to_string()).expect("it can be written");
    let output = lightmeter(&["gate", text(&pack), text(&answers)]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
}

#[test]
fn another_failing_case_is_a_regression_though_they_are_as_many() {
    let (pack, answers) = answered("regression", &["fog/exp", "fog/linear"]);
    let file = pack.with_file_name("baseline.json");
    let spoiled = |number: usize| {
        edit(
            &answers,
            |k, line| if k == number { line.replacen("\"value\":[", "\"value\":[9", 1) } else { line.into() } + "\n",
        )
    };
    let (status, _) = judged(&pack, &spoiled(40), &["--baseline", text(&file), "--update-baseline"]);
    assert_eq!(status, 1);
    let (status, report) = judged(&pack, &spoiled(40), &["--baseline", text(&file)]);
    assert_eq!((status, report["regressions"].as_array().map(Vec::len)), (1, None), "{report}");
    let (_, report) = judged(&pack, &spoiled(41), &["--baseline", text(&file)]);
    let regressions = report["regressions"].to_string();
    assert!(regressions.contains("1 case newly failed: "), "{regressions}");
    // One that was answered and is not; what is skipped in its place.
    let missing = edit(&answers, |k, line| if k == 40 { String::new() } else { line.to_owned() + "\n" });
    let (_, report) = judged(&pack, &missing, &["--baseline", text(&file)]);
    assert!(report["regressions"].to_string().contains("1 case newly missing"), "{report}");
    let skipped = edit(&answers, |k, line| match k {
        41 => line.split_once("\"value\"").map_or(String::new(), |(id, _)| format!("{id}\"skip\":\"no\"}}\n")),
        _ => line.to_owned() + "\n",
    });
    let (_, report) = judged(&pack, &skipped, &["--baseline", text(&file)]);
    assert!(report["regressions"].to_string().contains("1 case newly skipped"), "{report}");
}

#[test]
fn a_run_that_broke_off_is_no_baseline() {
    let (pack, answers) = answered("unfit", &["fog/exp"]);
    let file = pack.with_file_name("baseline.json");
    let twice = edit(&answers, |k, line| if k == 5 { format!("{line}\n{line}\n") } else { line.to_owned() + "\n" });
    let other = edit_as(&answers, "other", |k, line| if k == 60 { at_the_end(line) } else { line.to_owned() + "\n" });
    for (given, why) in [(&[text(&twice)][..], "no answer"), (&[text(&answers), text(&other)], "answers changed")] {
        let args = [&["gate", text(&pack)], given, &["--baseline", text(&file), "--update-baseline"]].concat();
        let output = lightmeter(&args);
        let status = if why == "no answer" { 4 } else { 1 };
        assert!(code(&output) == status && !file.exists() && stderr(&output).contains(why), "{}", stderr(&output));
        // The result is there all the same.
        assert!(stdout(&output).contains("pass"), "{}", stdout(&output));
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
    assert_eq!((status, report["regressions"].as_array().map(Vec::len)), (0, None), "{report}");
    let number = std::fs::read_to_string(&answers).expect("there are answers").lines().count() - 1;
    let worse = edit(&answers, |k, line| if k == number { at_the_end(line) } else { line.to_owned() + "\n" });
    let (status, report) = judged(&pack, &worse, &["--baseline", text(&file)]);
    let regressions = report["regressions"].to_string();
    assert!(status == 1 && count(&report, "failed") == 0 && regressions.contains(" ULP; in the baseline"), "{report}");
    let (status, _) = judged(&pack, &worse, &["--baseline", text(&file), "--growth", "100"]);
    assert_eq!(status, 0);
    // A part of its cases is compared with that part; more than it has cannot be.
    let (part, of_part) = answered("part-of-baseline", &["fog/exp"]);
    let (status, report) = judged(&part, &of_part, &["--baseline", text(&file)]);
    assert_eq!((status, report["regressions"].as_array().map(Vec::len)), (0, None), "{report}");
    let (more, of_more) = answered("more-than-baseline", &["fog/exp", "vector/reflect"]);
    let output = lightmeter(&["gate", text(&more), text(&of_more), "--baseline", text(&file)]);
    assert!(code(&output) == 2 && stderr(&output).contains("and vector/reflect here"), "{}", stderr(&output));
}

#[test]
fn a_fix_is_no_regression_and_an_expected_failure_is_none() {
    let (pack, answers) = answered("fixed", &["fog/exp"]);
    let file = pack.with_file_name("baseline.json");
    // Every case but one was wrong; those that are mended err by more than that one did.
    let wrong = |line: &str| line.replacen("\"value\":[", "\"value\":[9", 1) + "\n";
    let broken = edit(&answers, |k, line| if k > 1 { wrong(line) } else { line.to_owned() + "\n" });
    let (status, _) = judged(&pack, &broken, &["--baseline", text(&file), "--update-baseline"]);
    assert_eq!(status, 1);
    let (status, report) = judged(&pack, &answers, &["--baseline", text(&file), "--growth", "1"]);
    assert_eq!((status, report["regressions"].as_array().map(Vec::len)), (0, None), "a fix: {report}");
    // The other way round: right before, wrong now, in one case that is expected to fail.
    let (status, _) = judged(&pack, &answers, &["--baseline", text(&file), "--update-baseline"]);
    assert_eq!(status, 0);
    let one = edit(&answers, |k, line| if k == 5 { wrong(line) } else { line.to_owned() + "\n" });
    let (status, report) = judged(&pack, &one, &["--baseline", text(&file)]);
    assert!(status == 1 && report["regressions"].to_string().contains("newly failed"), "{report}");
    let id = report["failures"][0]["id"].as_str().expect("an id").to_owned();
    let expected = pack.with_file_name("expected.toml");
    std::fs::write(&expected, format!("[[expected]]\nid = \"{id}\"\nreason = \"known\"\n")).expect("written");
    let (status, report) = judged(&pack, &one, &["--baseline", text(&file), "--expect", text(&expected)]);
    assert_eq!((status, report["regressions"].as_array().map(Vec::len)), (0, None), "expected: {report}");
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
fn expectations_may_pass_where_they_say_so_and_must_match_something() {
    let (pack, answers) = answered("may-pass", &["fog/exp"]);
    let file = pack.with_file_name("expected.toml");
    std::fs::write(&file, "[[expected]]\nid = \"fog/exp\"\nreason = \"at times\"\nmay_pass = true\n").expect("written");
    let (status, report) = judged(&pack, &answers, &["--expect", text(&file)]);
    assert_eq!((status, count(&report, "unexpected_passes")), (0, 0), "{report}");
    for (id, is_one) in [
        ("fog/exq", false),
        ("fog/exp/random/000300", true),
        ("fog/exp/random/xyz", false),
        ("fog/*/hard", true),
        ("scene/flat", true),
        ("scene/flot", false),
        ("fog/exp/at-the-ey", false),
    ] {
        std::fs::write(&file, format!("[[expected]]\nid = \"{id}\"\nreason = \"r\"\n")).expect("written");
        let output = lightmeter(&["gate", text(&pack), text(&answers), "--expect", text(&file)]);
        // What matches passes, where it was asked: that is not expected.
        assert_eq!(code(&output) < 2, is_one, "{id}: {}", stderr(&output));
        assert!(is_one || stderr(&output).contains("matches no case"), "{id}: {}", stderr(&output));
    }
}

#[test]
fn a_case_counts_for_every_expectation_that_has_it() {
    let (pack, answers) = answered("every", &["fog/exp"]);
    let file = pack.with_file_name("expected.toml");
    let text_of = "[[expected]]\nid = \"fog/exp\"\nreason = \"at times\"\nmay_pass = true\n\
                   [[expected]]\nid = \"fog/exp/random/000003\"\nreason = \"known\"\n";
    std::fs::write(&file, text_of).expect("it can be written");
    let (status, report) = judged(&pack, &answers, &["--expect", text(&file)]);
    assert_eq!((status, count(&report, "unexpected_passes")), (1, 1), "{report}");
}

#[test]
fn what_is_missing_is_named() {
    let (pack, answers) = answered("named", &["fog/exp/random"]);
    let fewer =
        edit(&answers, |k, line| if [3, 5, 6, 7].contains(&k) { String::new() } else { line.to_owned() + "\n" });
    for format in ["text", "junit", "github"] {
        let output = lightmeter(&["gate", text(&pack), text(&fewer), "--format", format]);
        assert!(
            code(&output) == 1 && stdout(&output).contains("never answered: random/000003, random/000005..000007"),
            "{}",
            stdout(&output)
        );
    }
    for (hello, said) in [
        ("{\"renderer\": \"r\", \"version\": 1.2}", "`version` is no string"),
        ("{\"hello\": \"lightmeter.protocol/2\", \"renderer\": \"r\"}", "expected `lightmeter.protocol/1`"),
    ] {
        let wrong = edit(&answers, |k, line| if k == 0 { format!("{hello}\n") } else { String::new() } + line + "\n");
        let output = lightmeter(&["gate", text(&pack), text(&wrong)]);
        assert!(code(&output) == 2 && stderr(&output).contains(said), "{}", stderr(&output));
    }
}

#[test]
fn a_pack_is_written_over_a_pack_and_nothing_else() {
    let folder = folder("over");
    let pack = folder.join("pack");
    let packed = |filter: &str| lightmeter(&["pack", text(&pack), filter, "--cases", "8", "--size", "16"]);
    assert_eq!(code(&packed("scene/flat")), 0);
    std::fs::write(pack.join("answers.jsonl"), "mine").expect("it can be written");
    assert_eq!(code(&packed("fog/exp")), 0);
    assert!(!pack.join("scenes/flat/scene.json").exists(), "an earlier pack's files go");
    assert_eq!(std::fs::read_to_string(pack.join("answers.jsonl")).expect("what is no pack's stays"), "mine");
    // One that was broken off is written over.
    std::fs::write(pack.join("manifest.json"), "{\"schema\":\"lightmeter.pack/1\",\"is_unfinished\":true}")
        .expect("written");
    assert_eq!(code(&lightmeter(&["gate", text(&pack), text(&pack)])), 2);
    assert_eq!(code(&packed("fog/exp")), 0);
    // A web application's manifest, and one that would have files elsewhere removed.
    for other in ["{\"name\":\"my application\"}", "{\"schema\":\"other/1\"}", "[]", "{"] {
        std::fs::write(pack.join("manifest.json"), other).expect("it can be written");
        let output = packed("fog/exp");
        assert!(code(&output) == 2 && stderr(&output).contains("it holds something else"), "{}", stderr(&output));
    }
    let outside = folder.join("outside.txt");
    std::fs::write(&outside, "mine").expect("it can be written");
    let manifest = "{\"schema\":\"lightmeter.pack/1\",\"files\":[{\"name\":\"../outside.txt\"}]}";
    std::fs::write(pack.join("manifest.json"), manifest).expect("it can be written");
    assert_eq!(code(&packed("fog/exp")), 0);
    assert!(outside.exists());
}

#[test]
fn a_result_that_is_there_stays_until_there_is_another() {
    let (pack, answers) = answered("out", &["fog/exp"]);
    let out = pack.with_file_name("result.json");
    std::fs::write(&out, "before").expect("it can be written");
    for (args, status) in [(&[text(&pack), "nowhere"][..], 2), (&["fog", "--exec", "exit 3"], 4)] {
        let output = lightmeter(&[&["gate", "--out", text(&out)], args].concat());
        let there = std::fs::read_to_string(&out).expect("it is there");
        assert_eq!((code(&output), there.as_str()), (status, "before"), "{}", stderr(&output));
    }
    let output = lightmeter(&["gate", text(&pack), text(&answers), "--out", text(&out)]);
    assert!(code(&output) == 0 && std::fs::read_to_string(&out).expect("it is there").contains("cases pass"));
    let output = lightmeter(&["gate", text(&pack), text(&answers), "--out", "/dev/null/x"]);
    assert!(code(&output) == 2 && stderr(&output).contains("cannot write /dev/null/x"), "{}", stderr(&output));
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
fn a_known_mistake_is_the_cause_in_the_document_and_in_the_page() {
    let (pack, answers) = answered("cause", &["fog/exp", "fog/linear"]);
    let given = std::fs::File::open(pack.join("cases.jsonl")).expect("there are cases");
    let output = command(&["eval", "--mistake", "fog-radial"]).stdin(given).output().expect("the binary starts");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    std::fs::write(&answers, &output.stdout).expect("answers can be written");
    let (status, report) = judged(&pack, &answers, &[]);
    let cause = "fog uses radial distance (fog-radial)";
    let first = &report["groups"][0]["diagnosis"]["explanations"][0];
    assert_eq!(
        (status, &first["mistakes"], &first["says"]),
        (1, &serde_json::json!(["fog-radial"]), &"fog uses radial distance".into())
    );
    let page = lightmeter(&["gate", text(&pack), text(&answers), "--format", "html"]);
    assert!(stdout(&page).contains(&format!("<td>{cause}</td>")), "{}", stdout(&page));
}
