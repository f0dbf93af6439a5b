//! What is left of a bench, a self-test and probes that a signal ends.

use crate::held::stopped_at;
use crate::{code, folder, stderr, stdout};
use lightmeter::cases::FAMILIES;
use lightmeter::scene::library::SCENES;
use rustix::process::Signal;
use serde_json::Value;
use std::collections::BTreeSet;
use std::process::Output;

/// Both signals, each with the exit code of a command that it ends.
const SIGNALS: [(Signal, i32); 2] = [(Signal::INT, 130), (Signal::TERM, 143)];

/// The JSON of a command that a signal ended, which says so.
fn document(output: &Output, status: i32) -> Value {
    assert_eq!(code(output), status, "{}", stderr(output));
    let said = stderr(output);
    assert!(said.contains("error: a signal ended ") && said.contains(" was under way"), "{said}");
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON and nothing else");
    assert_eq!(document["interrupted"]["signal"], status - 128, "{}", document["interrupted"]);
    document
}

/// The text of one, which has the reason on a line of its own.
fn text(output: &Output, status: i32) -> String {
    let text = stdout(output);
    assert_eq!(code(output), status, "{text}{}", stderr(output));
    let is_told = |line: &str| line.starts_with("interrupted: ") && line.contains(" was under way: a signal ended ");
    assert!(text.lines().any(is_told), "{text}");
    text
}

fn list<'a>(document: &'a Value, field: &str) -> &'a [Value] {
    document[field].as_array().map_or(&[], Vec::as_slice)
}

/// Formulas on the embedded implementation: many short measurements.
const BENCH: [&str; 3] = ["bench", "--adapter", "cpu"];
/// The group after the first, in the first of the sittings.
const SECOND: &str = "group:2";

#[test]
fn a_bench_that_a_signal_ends_has_the_groups_that_were_measured() {
    for (signal, status) in SIGNALS {
        let document = document(&stopped_at(SECOND, &[&BENCH[..], &["--format", "json"]].concat(), signal), status);
        let groups = list(&document["adapters"][0], "groups");
        assert!(!groups.is_empty(), "{document}");
        for group in groups {
            let row = list(group, "rows").iter().find(|row| row["name"] == "cpu-f32").expect("it is everywhere");
            assert!(row["time"]["ns"].as_f64() > Some(0.0) && !row["random"].is_null(), "{row}");
            // 3 turns in the first of 3 sittings.
            assert_eq!(row["time"]["turns"], 3, "it was not ended: {row}");
        }
        let last = FAMILIES.last().copied().expect("there are families");
        assert!(groups.iter().all(|group| group["family"] != last), "it was not ended: {document}");
    }
}

#[test]
fn a_bench_that_a_signal_ends_says_so_in_every_format() {
    let told = text(&stopped_at(SECOND, &BENCH, Signal::INT), 130);
    assert!(told.contains("cpu-accept"), "{told}");
    let advice = [&BENCH[..], &["--recommend", "4ulp"]].concat();
    text(&stopped_at(SECOND, &advice, Signal::TERM), 143);
    let recommended = stopped_at(SECOND, &[&advice[..], &["--format", "json"]].concat(), Signal::INT);
    assert!(!list(&document(&recommended, 130), "groups").is_empty());
    let table = stopped_at(SECOND, &[&BENCH[..], &["--format", "markdown"]].concat(), Signal::TERM);
    assert!(code(&table) == 143 && stdout(&table).starts_with("Interrupted: "), "{}", stdout(&table));
}

/// Mistakes in a formula are tried first, then its legal evaluations.
const FORMULAS: [&str; 6] = ["selftest", "fog", "lighting", "--calibrate", "--draws", "1024"];

#[test]
fn a_self_test_that_a_signal_ends_has_what_was_tried_and_never_says_that_all_was() {
    for (signal, status) in SIGNALS {
        let output = stopped_at("tried:1", &[&FORMULAS[..], &["--format", "json"]].concat(), signal);
        let document = document(&output, status);
        let formulas = |field: &str| {
            let all = list(&document, field).iter();
            all.map(|one| one["formula"].as_str().expect("an id").to_owned()).collect::<BTreeSet<String>>()
        };
        let (kills, clean) = (formulas("kills"), formulas("clean"));
        assert!(!kills.is_empty() && !kills.is_subset(&clean), "it was not ended: {kills:?} {clean:?}");
        assert!(list(&document, "calibration").is_empty(), "{document}");
        assert!(document["interrupted"]["under_way"] == "every mistake in every formula that it concerns");
    }
    let text = text(&stopped_at("tried:1", &FORMULAS, Signal::INT), 130);
    assert!(text.contains(" mistakes in formulas, not all that there are: "), "{text}");
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_self_test_of_scenes_that_a_signal_ends_calls_no_mistake_missed() {
    let args = ["selftest", "--only", "scenes"];
    let document = document(&stopped_at(SECOND, &[&args[..], &["--format", "json"]].concat(), Signal::TERM), 143);
    let judged = document["scenes"]["judged"].as_u64().expect("how many scenes were judged");
    assert!(judged < SCENES.len() as u64, "it was not ended: {document}");
    for row in list(&document["scenes"], "rows") {
        assert!(list(row, "caught").len() as u64 <= judged, "{row}");
    }
    let text = text(&stopped_at(SECOND, &args, Signal::INT), 130);
    assert!(text.contains(&format!(" of {} that were judged", SCENES.len())) && !text.contains('✗'), "{text}");
}

#[test]
fn a_self_test_of_the_blend_unit_ends_within_a_target() {
    let args = ["selftest", "--only", "blend-unit", "--cases", "65536"];
    let output = stopped_at("group:1", &[&args[..], &["--format", "json"]].concat(), Signal::INT);
    let document = document(&output, 130);
    assert!(list(&document, "rows").is_empty(), "it was not ended: {document}");
    let under_way = document["interrupted"]["under_way"].as_str();
    assert!(under_way.is_some_and(|what| what.starts_with("every fault on ")), "{under_way:?}");
    let text = text(&stopped_at("group:1", &args, Signal::TERM), 143);
    assert!(!text.contains("clean") && !text.contains("named"), "{text}");
}

/// An adapter is probed as a whole, so that these are ended before they begin.
#[test]
fn probes_that_a_signal_ends_say_so() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for (signal, status) in SIGNALS {
        let folder = folder(&format!("stopped-special-{status}"));
        let args = ["special", "--record", folder.to_str().expect("UTF-8")];
        let ended = |more: &[&str]| stopped_at("group:1", &[&args[..], more].concat(), signal);
        let document = document(&ended(&["--format", "json"]), status);
        assert!(list(&document, "outcomes").is_empty() && list(&document, "adapters").is_empty(), "{document}");
        let text = text(&ended(&[]), status);
        assert!(text.contains("\n✗ ") && !text.contains("\n✓ "), "{text}");
        let records = std::fs::read_dir(&folder).expect("it was made");
        assert_eq!(records.count(), 0, "an adapter that was not probed has no record");
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn what_a_signal_ended_makes_no_page() {
    let args = [&BENCH[..], &["--format", "json"]].concat();
    for (args, page) in [(&args[..], "bench"), (&["selftest", "--only", "scenes", "--format", "json"], "selftest")] {
        let file = folder(&format!("stopped-{page}")).join("result.json");
        let file = file.to_str().expect("UTF-8");
        let output = stopped_at(SECOND, &[args, &["--out", file]].concat(), Signal::INT);
        assert_eq!(code(&output), 130, "{}", stderr(&output));
        let made = crate::lightmeter(&["page", page, file]);
        assert!(code(&made) == 2 && stderr(&made).contains("it was interrupted: "), "{}", stderr(&made));
    }
}
