//! What a run tells while it goes on, and what is left of one that is told to stop.

use crate::held::stopped_at;
use crate::{code, command, edited, json, lightmeter, stderr, stdout};
use rustix::process::Signal;
use serde_json::Value;
use std::process::Stdio;

#[test]
fn what_fails_is_told_first_with_its_cause_and_counted_once() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("told-first", "fog.wgsl", |text| text.replace("(dmax - dmin)", "dmax"));
    let dir = dir.to_str().expect("UTF-8");
    // Enough groups for scouts; the mistake is in the last of the two families.
    let args = ["run", "color", "fog", "--cases", "512", "--shaders", dir];
    let output = lightmeter(&args);
    let text = stdout(&output);
    assert_eq!(code(&output), 1, "{text}{}", stderr(&output));
    let first = text.lines().next().unwrap_or_default();
    assert!(first.starts_with("✗ fog/linear on ") && first.contains(" of the first "), "{text}");
    let second = text.lines().nth(1).unwrap_or_default();
    assert!(second.starts_with("  ") && second.contains("linear fog begins at the eye (fog-from-the-eye)"), "{text}");
    assert_eq!(text.matches("FAIL fog/linear/").count(), 1, "one failing case of a formula is told: {text}");
    let fails = text.find("FAIL fog/linear/random/").expect("an ordinary case");
    assert!(fails < text.find("   family  ").expect("the table comes at the end"), "{text}");
    // What was told is not told again: the end has a line for each formula.
    let heads = text.lines().filter(|line| line.starts_with("✗ fog/linear on ")).count();
    let places = text.lines().filter(|line| line.starts_with("✗  fog ")).count();
    assert_eq!(heads, places, "a head for each stage: {text}");
    let end = text.split("failed, as is told above\n").nth(1).expect("the end says what failed");
    assert!(end.starts_with("  fog/linear on ") && end.contains(" (fog-from-the-eye)"), "{end}");
    // For programs the result is alone on standard output, and what fails is told beside it.
    let output = lightmeter(&[&args[..], &["--format", "json"]].concat());
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON and nothing else");
    assert!(stderr(&output).contains("✗ fog/linear on "), "{}", stderr(&output));
    let named = |group: &Value| {
        group["id"] == "fog/linear" && group["diagnosis"]["explanations"][0]["mistakes"][0] == "fog-from-the-eye"
    };
    assert!(report["groups"].as_array().is_some_and(|groups| groups.iter().any(named)), "{report}");
    let group = |report: &Value| {
        let groups = report["groups"].as_array().expect("an array").clone();
        groups
            .into_iter()
            .find(|group| group["id"] == "fog/linear" && group["stage"] == "compute")
            .expect("it is there")
    };
    let explanation = group(&report)["diagnosis"].to_string();
    assert!(explanation.contains("linear fog begins at the eye"), "{explanation}");
    let alone = json(&["run", "fog/linear", "--cases", "512", "--shaders", dir, "--format", "json"]);
    for count in ["cases", "verdicts", "failed", "passed", "indeterminate"] {
        assert_eq!(group(&report)[count], group(&alone)[count], "{count}: what the scouts judged is counted once");
    }
}

#[test]
fn values_that_are_legal_one_by_one_and_wrong_together_fail() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("a-little-off", "vector.wgsl", |text| {
        text.replace("pow(cosine, exponent)", "pow(cosine, 1.0000003 * exponent)")
    });
    let report =
        json(&["run", "lighting/specular-blinn", "--shaders", dir.to_str().expect("UTF-8"), "--format", "json"]);
    for group in report["groups"].as_array().expect("an array") {
        assert_eq!(group["failed"], 0, "{group}");
        assert!(group["problems"].to_string().contains("as if shininess were"), "{group}");
    }
    assert_eq!(report["totals"]["failed_groups"], 2, "{}", report["totals"]);
}

#[test]
fn a_run_that_is_told_to_stop_reports_what_was_judged() {
    let args = ["run", "fog/exp", "--adapter", "cpu", "--cases", "1000000000", "--format", "json"];
    for (signal, status) in [(Signal::INT, 130), (Signal::TERM, 143)] {
        let output = stopped_at("advanced:1", &args, signal);
        assert_eq!(code(&output), status, "{}", stderr(&output));
        let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(report["interrupted"]["signal"], status - 128, "{report}");
        assert_eq!(report["interrupted"]["under_way"], "fog/exp", "{report}");
        let count = |name: &str| report["totals"][name].as_u64().unwrap_or_default();
        assert!(count("verdicts") > 0 && count("failed") == 0, "{report}");
    }
}

/// The scouts of a group come to the report whether the run comes to the group or not.
#[test]
fn a_run_that_is_told_to_stop_reports_its_scouts() {
    let args = ["run", "color", "fog", "--cases", "512", "--adapter", "cpu", "--format", "json"];
    let cases = |report: &Value| -> Vec<u64> {
        let groups = report["groups"].as_array().expect("an array");
        groups.iter().map(|group| group["cases"].as_u64().unwrap_or_default()).collect()
    };
    let whole = cases(&json(&args));
    // Each group's scouts advance the run once.
    let among_scouts = stopped_at("advanced:2", &args, Signal::INT);
    let after_scouts = stopped_at(&format!("advanced:{}", whole.len() + 1), &args, Signal::INT);
    for (output, has_all) in [(among_scouts, false), (after_scouts, true)] {
        assert_eq!(code(&output), 130, "{}", stderr(&output));
        let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let cases = cases(&report);
        assert_eq!(cases.len() == whole.len(), has_all, "{report}");
        assert!(cases.len() > 1 && cases.iter().all(|&count| count > 0), "{report}");
        assert!(!has_all || cases.last().is_some_and(|last| last < &whole[whole.len() - 1]), "{report}");
        assert_eq!(report["totals"]["failed"], 0, "{report}");
    }
}

#[test]
fn a_sweep_that_is_told_to_stop_reports_what_was_judged() {
    let args = ["sweep", "fog/exp", "--over", "density", "--adapter", "cpu", "--format", "json"];
    let output = stopped_at("block:1", &args, Signal::INT);
    assert_eq!(code(&output), 130, "{}", stderr(&output));
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let count = |name: &str| document[name].as_u64().unwrap_or_default();
    assert!(count("done") > 0 && count("done") < count("blocks"), "{document}");
}

#[test]
fn a_closed_output_changes_no_verdict() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("closed-output", "fog.wgsl", |text| text.replace("(dmax - dmin)", "dmax"));
    let args = ["run", "fog/linear", "--cases", "64", "--shaders", dir.to_str().expect("UTF-8"), "--format", "json"];
    let mut started = command(&args).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("the binary starts");
    drop(started.stdout.take());
    assert_eq!(started.wait().expect("it ends").code(), Some(1));
}
