//! Special values that a renderer is asked for, an operation at a time: as a process and by a file.

use super::process::{command_of, process};
use super::{count, folder, groups, judged, report, text};
use crate::{code, lightmeter, stderr, stdout};
use serde_json::Value;
use std::process::Command;

/// The tables of a report, by their ids.
fn tables(report: &Value) -> Vec<&Value> {
    let groups = report["groups"].as_array().expect("an array");
    groups.iter().filter(|group| group["id"].as_str().is_some_and(|id| id.starts_with("special/"))).collect()
}

#[test]
fn a_renderer_that_keeps_every_promise_passes() {
    let (status, found) = report(&process(&["special", "vector/reflect"], "special=true", &[]));
    assert_eq!((status, count(&found, "failed"), count(&found, "missing")), (0, 0, 0), "{}", found["totals"]);
    let ids: Vec<&str> = tables(&found).iter().filter_map(|group| group["id"].as_str()).collect();
    let all = ["nan", "infinity", "subnormal", "signed-zero", "rounding"].map(|class| format!("special/{class}"));
    assert_eq!(ids, all);
    let nan = tables(&found)[0];
    let reason = nan["by_case"]["reason"].to_string();
    assert!(reason.contains("a rasteriser carries it") && reason.contains("no packing"), "{nan}");
    assert!(nan["by_case"]["not_passed"]["skipped"].to_string().contains("varying-flat-nan"), "{nan}");
    assert!(nan["verdicts"].as_u64() > nan["indeterminate"].as_u64(), "{nan}");
}

#[test]
fn a_broken_promise_is_told_with_its_operands() {
    let (status, found) = report(&process(&["special"], "special=swaps-select", &[]));
    // Each table has one operation that selects, but for those of infinity and of rounding.
    assert_eq!((status, count(&found, "failed")), (1, 3), "{}", found["totals"]);
    let id = "special/nan/select-other-than-nan";
    let failure = found["failures"].as_array().into_iter().flatten().find(|failure| failure["id"] == id);
    let failure = failure.unwrap_or_else(|| panic!("{}", found["failures"]));
    assert_eq!(failure["inputs"], serde_json::json!({ "x": "NaN", "y": 0.5, "z": 1.0 }), "{failure}");
    assert_eq!(
        (&failure["answer"]["value"][0], &failure["answer"]["reference"][0]),
        (&"NaN".into(), &0.5.into()),
        "{failure}"
    );
    let problem = failure["answer"]["problem"].as_str().unwrap_or_default();
    assert!(problem.starts_with("select(NaN, 0.5, true) gives NaN 0x7fc00000; promised is 0.5, by"), "{problem}");
    let nan = tables(&found)[0];
    assert_eq!(
        (&nan["by_case"]["smallest"], &nan["by_case"]["not_passed"]["failed"][0]),
        (&id.into(), &"select-other-than-nan".into())
    );
    let exec = command_of("special=swaps-select");
    for format in ["text", "github", "junit"] {
        let told = stdout(&lightmeter(&["gate", "special/nan", "--exec", &exec, "--format", format]));
        assert!(told.contains(id), "{told}");
    }
}

#[test]
fn special_values_that_are_not_declared_are_not_asked_for() {
    let (status, found) = report(&process(&["special", "vector/reflect"], "", &[]));
    assert_eq!((status, tables(&found).len()), (0, 0), "{}", found["totals"]);
    let output = process(&["special/nan"], "", &[]);
    assert!(code(&output) == 3 && stderr(&output).contains("nothing was judged"), "{}", stderr(&output));
}

#[test]
fn a_process_that_fails_at_a_special_value_costs_that_value_alone() {
    let id = "special/nan/select-other-than-nan";
    for (fault, status, counted, unstable) in [
        ("crash-at", 4, "failed", 0),
        ("short-at", 1, "failed", 0),
        ("nan-at", 1, "failed", 0),
        ("unstable-at", 1, "failed", 1),
        ("twice-at", 4, "missing", 0),
    ] {
        let (found, told) = report(&process(&["special/nan"], &format!("special=true {fault}={id}"), &[]));
        let number = u64::from(counted == "failed");
        assert_eq!((found, count(&told, counted), count(&told, "unstable")), (status, number, unstable), "{fault}");
        assert!(number == 0 || told["failures"][0]["id"] == id, "{fault}: {}", told["failures"]);
    }
    let expected = folder("special-expected").join("expected.toml");
    std::fs::write(&expected, format!("[[expected]]\nid = \"{id}\"\nreason = \"known\"\n")).expect("it can be written");
    for (fault, status, counted) in
        [(format!("nan-at={id}"), 0, "expected_failures"), (String::new(), 1, "unexpected_passes")]
    {
        let output = process(&["special/nan"], &format!("special=true {fault}"), &["--expect", text(&expected)]);
        let (found, told) = report(&output);
        assert_eq!((found, count(&told, counted)), (status, 1), "{}", told["totals"]);
    }
}

#[test]
fn shards_of_special_values_merge_into_the_whole() {
    let folder = folder("special-shards");
    let parts = ["1/2", "2/2"].map(|shard| {
        let path = folder.join(format!("{}.json", &shard[..1]));
        let output = process(&["special"], "special=swaps-select", &["--shard", shard]);
        std::fs::write(&path, &output.stdout).expect("it can be written");
        path
    });
    let merged = lightmeter(&["merge", text(&parts[0]), text(&parts[1]), "--format", "json"]);
    let (status, merged) = report(&merged);
    let (_, whole) = report(&process(&["special"], "special=swaps-select", &[]));
    assert_eq!((status, &merged["totals"]), (1, &whole["totals"]));
    assert_eq!(groups(&merged), groups(&whole));
}

#[test]
fn a_pack_has_special_values_where_that_is_asked_for() {
    let folder = folder("special-pack");
    let (pack, answers) = (folder.join("pack"), folder.join("answers.jsonl"));
    let filter = ["special", "vector/reflect"];
    let packed = |more: &[&str]| {
        let output = lightmeter(&[&["pack", text(&pack), "--cases", "64"], &filter[..], more].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        std::fs::read_to_string(pack.join("manifest.json")).expect("there is a manifest")
    };
    assert!(!packed(&[]).contains("special\":"), "a pack without the option is what it was");
    let manifest = packed(&["--special"]);
    for fault in ["special=true", "special=swaps-select"] {
        let answer = format!("{} <'{}' >'{}'", command_of(fault), text(&pack.join("cases.jsonl")), text(&answers));
        assert!(Command::new("sh").args(["-c", &answer]).status().expect("the shell starts").success(), "{answer}");
        let expected = folder.join("expected.toml");
        let skips = "[[skipped]]\nid = \"special\"\nreason = \"no rasteriser\"\n";
        std::fs::write(&expected, skips).expect("it can be written");
        let (of_file, found) = judged(&pack, &answers, &[text(&answers), "--expect", text(&expected)]);
        let (of_process, asked) = report(&process(&filter, fault, &[]));
        assert_eq!((of_file, &found["totals"]), (of_process, &asked["totals"]), "{fault}");
        assert_eq!(groups(&found), groups(&asked), "{fault}");
    }
    // A hello that does not declare them: they are not asked for, and answers to them are told.
    let all = std::fs::read_to_string(&answers).expect("there are answers");
    let hello = r#"{"renderer": "r", "formulas": ["**"]}"#;
    std::fs::write(&answers, format!("{hello}\n{all}")).expect("answers can be written");
    let (status, found) = judged(&pack, &answers, &[]);
    assert_eq!((status, tables(&found).len()), (4, 0), "{}", found["renderer"]["problems"]);
    for (what, wrong) in [("\"special\": true", "\"special\": false"), ("\"probes\": ", "\"probes\": 1")] {
        assert!(manifest.contains(what), "{manifest}");
        std::fs::write(pack.join("manifest.json"), manifest.replacen(what, wrong, 1)).expect("it can be written");
        let output = lightmeter(&["gate", text(&pack), text(&answers)]);
        assert!(code(&output) == 2 && stderr(&output).contains("special values are not"), "{}", stderr(&output));
    }
    let output = lightmeter(&["pack", text(&pack), "special/nan"]);
    assert!(code(&output) == 3 && stderr(&output).contains("written with --special"), "{}", stderr(&output));
}
