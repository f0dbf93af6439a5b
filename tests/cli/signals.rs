//! What is left of a bench, a self-test and probes that a signal ends.

use crate::{code, command, stderr, stdout};
use lightmeter::cases::FAMILIES;
use lightmeter::scene::library::SCENES;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Child, Output, Stdio};
use std::time::{Duration, Instant};

/// Both signals, each with the exit code of a command that it ends.
const SIGNALS: [(Signal, i32); 2] = [(Signal::INT, 130), (Signal::TERM, 143)];

fn start(args: &[&str]) -> Child {
    command(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the binary starts")
}

fn send(child: &Child, signal: Signal) {
    let pid = i32::try_from(child.id()).ok().and_then(Pid::from_raw).expect("a number");
    kill_process(pid, signal).expect("it runs");
}

/// Processor time of a process in seconds, however busy the machine is: fields 14 and 15 of its `stat`, in hundredths.
fn seconds_of(child: &Child) -> f64 {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", child.id())).expect("it runs");
    let (_, fields) = stat.rsplit_once(") ").expect("its name is in brackets");
    fields.split(' ').skip(11).take(2).filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / 100.0
}

/// What a command leaves that gets a signal after some seconds, a small part of what its work takes.
pub(crate) fn stopped_after(seconds: f64, args: &[&str], signal: Signal) -> Output {
    let mut child = start(args);
    let until = Instant::now() + Duration::from_secs(600);
    while seconds_of(&child) < seconds {
        let ended = child.try_wait().expect("its state is known");
        assert!(ended.is_none() && Instant::now() < until, "{args:?}: {ended:?}");
        std::thread::sleep(Duration::from_millis(10));
    }
    send(&child, signal);
    child.wait_with_output().expect("it ends")
}

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

/// Every formula on the embedded implementation: some 15 seconds of short measurements.
const BENCH: [&str; 3] = ["bench", "--adapter", "cpu"];

#[test]
fn a_bench_that_a_signal_ends_has_the_groups_that_were_measured() {
    for (signal, status) in SIGNALS {
        let document = document(&stopped_after(1.0, &[&BENCH[..], &["--format", "json"]].concat(), signal), status);
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
    let told = text(&stopped_after(1.5, &BENCH, Signal::INT), 130);
    assert!(told.contains("cpu-accept"), "{told}");
    let advice = [&BENCH[..], &["--recommend", "4ulp"]].concat();
    text(&stopped_after(1.5, &advice, Signal::TERM), 143);
    let recommended = stopped_after(1.5, &[&advice[..], &["--format", "json"]].concat(), Signal::INT);
    assert!(!list(&document(&recommended, 130), "groups").is_empty());
    let table = stopped_after(1.5, &[&BENCH[..], &["--format", "markdown"]].concat(), Signal::TERM);
    assert!(code(&table) == 143 && stdout(&table).starts_with("Interrupted: "), "{}", stdout(&table));
}

/// Mistakes in formulas are tried within a second, legal evaluations for minutes.
const FORMULAS: [&str; 6] = ["selftest", "fog", "lighting", "--calibrate", "--draws", "1024"];

#[test]
fn a_self_test_that_a_signal_ends_has_what_was_tried_and_never_says_that_all_was() {
    for (signal, status) in SIGNALS {
        let output = stopped_after(2.0, &[&FORMULAS[..], &["--format", "json"]].concat(), signal);
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
    let text = text(&stopped_after(2.0, &FORMULAS, Signal::INT), 130);
    assert!(text.contains(" mistakes in formulas, not all that there are: "), "{text}");
}

#[test]
fn a_self_test_of_scenes_that_a_signal_ends_calls_no_mistake_missed() {
    let args = ["selftest", "--only", "scenes"];
    let document = document(&stopped_after(2.0, &[&args[..], &["--format", "json"]].concat(), Signal::TERM), 143);
    let judged = document["scenes"]["judged"].as_u64().expect("how many scenes were judged");
    assert!(judged < SCENES.len() as u64, "it was not ended: {document}");
    for row in list(&document["scenes"], "rows") {
        assert!(list(row, "caught").len() as u64 <= judged, "{row}");
    }
    let text = text(&stopped_after(2.0, &args, Signal::INT), 130);
    assert!(text.contains(&format!(" of {} that were judged", SCENES.len())) && !text.contains('✗'), "{text}");
}

#[test]
fn a_self_test_of_the_blend_unit_ends_within_a_target() {
    let args = ["selftest", "--only", "blend-unit", "--cases", "65536"];
    let output = stopped_after(1.0, &[&args[..], &["--format", "json"]].concat(), Signal::INT);
    let document = document(&output, 130);
    assert!(list(&document, "rows").is_empty(), "it was not ended: {document}");
    let under_way = document["interrupted"]["under_way"].as_str();
    assert!(under_way.is_some_and(|what| what.starts_with("every fault on ")), "{under_way:?}");
    let text = text(&stopped_after(1.0, &args, Signal::TERM), 143);
    assert!(!text.contains("clean") && !text.contains("named"), "{text}");
}

/// Probes take less than a second, so that these are ended before they begin: while the device is opened.
#[test]
fn probes_that_a_signal_ends_say_so() {
    for (signal, status) in SIGNALS {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("stopped-special-{status}"));
        let _ = std::fs::remove_dir_all(&folder);
        let args = ["special", "--record", folder.to_str().expect("UTF-8")];
        let ended = |more: &[&str]| stopped_after(0.03, &[&args[..], more].concat(), signal);
        let document = document(&ended(&["--format", "json"]), status);
        assert!(list(&document, "outcomes").is_empty() && list(&document, "adapters").is_empty(), "{document}");
        let text = text(&ended(&[]), status);
        assert!(text.contains("\n✗ ") && !text.contains("\n✓ "), "{text}");
        let records = std::fs::read_dir(&folder).expect("it was made");
        assert_eq!(records.count(), 0, "an adapter that was not probed has no record");
    }
}

#[test]
fn what_a_signal_ended_makes_no_page() {
    let args = [&BENCH[..], &["--format", "json"]].concat();
    for (args, page) in [(&args[..], "bench"), (&["selftest", "--only", "scenes", "--format", "json"], "selftest")] {
        let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("stopped-{page}.json"));
        let file = file.to_str().expect("UTF-8");
        let output = stopped_after(1.5, &[args, &["--out", file]].concat(), Signal::INT);
        assert_eq!(code(&output), 130, "{}", stderr(&output));
        let made = crate::lightmeter(&["page", page, file]);
        assert!(code(&made) == 2 && stderr(&made).contains("it was interrupted: "), "{}", stderr(&made));
    }
}
