//! Packs with blend states on targets, answered by the example renderer as by a file.

use super::process::{command_of, process};
use super::{count, folder, groups, judged, report, text};
use crate::{code, command, lightmeter, stderr, stdout};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

const STATES: [&str; 3] = ["blend/{add,min}/src-alpha", "blend/write-mask", "blend/layers"];
const TARGETS: [&str; 4] = ["--target", "rgba8unorm", "--target", "rgba16float"];

/// Packs blend states with further options.
fn packed(test: &str, more: &[&str]) -> PathBuf {
    let pack = folder(test).join("pack");
    let output = lightmeter(&[&["pack", text(&pack), "--cases", "64"], &STATES[..], more].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    pack
}

/// The example renderer's answers to a pack, with something that goes wrong in it.
fn answered(pack: &Path, fault: &str) -> PathBuf {
    let answers = pack.with_file_name("answers.jsonl");
    let [from, to] = [pack.join("cases.jsonl"), answers.clone()].map(|path| text(&path).to_owned());
    let answer = format!("{} <'{from}' >'{to}'", command_of(fault));
    let status = Command::new("sh").args(["-c", &answer]).status().expect("the shell starts");
    assert!(status.success(), "{answer}");
    answers
}

/// The groups on a target whose JSON has some words.
fn named(report: &Value, target: &str, words: &str) -> usize {
    let groups = report["groups"].as_array().expect("an array");
    groups.iter().filter(|group| group["target"] == target && group.to_string().contains(words)).count()
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_pack_is_asked_on_targets_as_a_process_is() {
    let pack = packed("on-targets", &TARGETS);
    for fault in ["", "blends-by=truncate"] {
        let (status, of_file) = judged(&pack, &answered(&pack, fault), &[]);
        let (of_process, asked) = report(&process(&STATES, &format!("targets=all {fault}"), &TARGETS));
        assert_eq!(status, of_process, "{fault}: {}", of_file["totals"]);
        assert_eq!(of_file["totals"], asked["totals"], "{fault}");
        assert_eq!(groups(&of_file), groups(&asked), "{fault}");
        assert_eq!(named(&of_file, "rgba16float", ""), 4, "{fault}");
        let is_named = named(&of_file, "rgba8unorm", "stored truncated") >= 2;
        assert_eq!((status == 1, is_named), (!fault.is_empty(), !fault.is_empty()), "{}", of_file["totals"]);
    }
    // Both ask every case of the pack, once for each line.
    let lines = std::fs::read_to_string(pack.join("cases.jsonl")).expect("there are cases").lines().count() as u64;
    let answers = answered(&pack, "");
    let (_, whole) = judged(&pack, &answers, &[]);
    let parts = ["1/2", "2/2"].map(|shard| count(&judged(&pack, &answers, &["--shard", shard]).1, "passed"));
    assert_eq!((count(&whole, "passed"), parts.iter().sum()), (lines, lines), "{}", whole["totals"]);
}

#[test]
fn states_that_are_not_declared_are_not_asked_for_on_targets() {
    let (status, found) = report(&process(&STATES, "targets=all formulas=blend/add/src-alpha/one", &TARGETS));
    let groups = found["groups"].as_array().expect("an array");
    let asked = |group: &&Value| group["target"] == "rgba8unorm";
    let asked: Vec<(&Value, &Value)> =
        groups.iter().filter(asked).map(|one| (&one["id"], &one["by_case"]["asked"])).collect();
    assert_eq!((status, asked), (0, vec![(&"blend/add".into(), &64.into())]), "{}", found["totals"]);
}

#[test]
fn a_hello_restricts_the_targets_that_a_file_is_judged_on() {
    let pack = packed("declared-targets", &TARGETS);
    let answers = answered(&pack, "");
    let all = std::fs::read_to_string(&answers).expect("there are answers");
    let declared = |hello: &str, is_kept: &dyn Fn(&str) -> bool| {
        let kept: String = all.lines().filter(|line| is_kept(line)).map(|line| format!("{line}\n")).collect();
        let path = answers.with_extension("declared.jsonl");
        let hello = format!(r#"{{"renderer": "r", "formulas": ["**"]{hello}}}"#);
        std::fs::write(&path, format!("{hello}\n{kept}")).expect("answers can be written");
        let (status, found) = judged(&pack, &path, &[]);
        (status, ["rgba8unorm", "rgba16float", "bgra8unorm"].map(|target| named(&found, target, "")))
    };
    let on_bytes = |line: &str| !line.contains("@rgba16float");
    let two = r#", "targets": ["rgba8unorm", "bgra8unorm"]"#;
    assert_eq!(declared(two, &on_bytes), (0, [4, 0, 0]), "the pack has no cases on bgra8unorm");
    assert_eq!(declared(two, &|_| true), (4, [4, 0, 0]), "answers on what is not declared are told");
    assert_eq!(declared("", &|line| !line.contains('@')), (0, [0, 0, 0]), "none is declared");
}

#[test]
#[ignore = "long: ./x campaign long"]
fn what_a_file_answers_on_targets_is_held_to_its_cases() {
    let pack = packed("wrong-on-targets", &TARGETS);
    let answers = answered(&pack, "");
    let id = "blend/add/src-alpha/one/0003@rgba8unorm";
    // What becomes of the answer to a case; what is counted of it, and the exit code.
    for (wrong, counted, number, status) in [
        (&|line: &str| line.replace("@rgba8unorm", "@unknown"), "missing", 1, 4),
        (&|line: &str| line.replace("@rgba8unorm", "@bgra8unorm"), "missing", 1, 4),
        (&|line: &str| format!("{line}\n{line}"), "missing", 0, 4),
        (&|_: &str| String::new(), "missing", 1, 1),
        (&|line: &str| line.replace("\"value\":[", "\"value\":[9"), "failed", 1, 1),
        (&|line: &str| line.replace("\"value\":[", "\"value\":[9,"), "failed", 1, 1),
        (&|_: &str| format!(r#"{{"id": "{id}", "skip": "no bytes"}}"#), "undeclared", 1, 1),
    ] as [(&dyn Fn(&str) -> String, &str, u64, i32); 7]
    {
        let all = std::fs::read_to_string(&answers).expect("there are answers");
        let edit = |line: &str| if line.contains(id) { wrong(line) } else { line.to_owned() } + "\n";
        let edited = answers.with_extension("edited.jsonl");
        std::fs::write(&edited, all.lines().map(edit).collect::<String>()).expect("answers can be written");
        let (found, told) = judged(&pack, &edited, &[]);
        assert_eq!((found, count(&told, counted)), (status, number), "{}", told["totals"]);
        if status == 1 {
            let (found, again) = judged(&pack, &answers, &[text(&edited)]);
            assert_eq!((found, count(&again, "unstable")), (1, 1), "{}", again["totals"]);
            assert_eq!(again["unstable_cases"][0], "blend/add/src-alpha/one/0003 on rgba8unorm", "{again}");
        }
    }
}

#[test]
fn a_manifest_with_other_targets_is_refused() {
    let pack = packed("refused-targets", &TARGETS);
    let manifest = pack.join("manifest.json");
    let right = std::fs::read_to_string(&manifest).expect("there is a manifest");
    for (wrong, said) in [
        (right.replacen("\"rgba8unorm\"", "\"rgb565\"", 1), "no target `rgb565`; expected rgba32float"),
        (right.replacen("\"rgba8unorm\"", "\"bgra8unorm\"", 1), "its cases on targets are not those"),
    ] {
        assert_ne!(wrong, right);
        std::fs::write(&manifest, wrong).expect("it can be written");
        let output = command(&["gate", text(&pack), "/dev/null"]).output().expect("the binary starts");
        assert_eq!(code(&output), 2, "{}", stdout(&output));
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
    }
    let output = lightmeter(&["pack", text(&pack), "blend/add", "--target", "rgb565"]);
    assert!(code(&output) == 2 && stderr(&output).contains("no such format"), "{}", stderr(&output));
    // Without the option a pack is what it was before there was one.
    let plain = std::fs::read_to_string(packed("no-targets", &[]).join("manifest.json")).expect("there is a manifest");
    assert!(!plain.contains("\"targets\"") && !plain.contains("\"on_targets\""), "{plain}");
}
