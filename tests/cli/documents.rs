//! What goes out as JSON is read again by the types that wrote it, and written once more it is the same.

use super::{code, command, lightmeter, stderr};
use lightmeter::document::bench::BenchDocument;
use lightmeter::document::gate::GateReport;
use lightmeter::document::pack::Manifest;
use lightmeter::document::run::Report;
use lightmeter::document::selftest::SelftestDocument;
use lightmeter::document::special::SpecialReport;
use lightmeter::document::sweep::SweepDocument;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Runs a command, reads its JSON by a type and writes it again.
fn read_and_written<T: Serialize + DeserializeOwned>(args: &[&str]) -> (T, Value) {
    let output = lightmeter(&[args, &["--format", "json"]].concat());
    assert!(code(&output) <= 1, "{args:?}: {}", stderr(&output));
    again(&output.stdout)
}

/// Reads a document by a type and writes it again.
fn again<T: Serialize + DeserializeOwned>(text: &[u8]) -> (T, Value) {
    let written: Value = serde_json::from_slice(text).expect("it is JSON");
    let read: T = serde_json::from_slice(text).unwrap_or_else(|error| panic!("{}: {error}", written["schema"]));
    assert_eq!(serde_json::to_value(&read).expect("it is written"), written);
    (read, written)
}

/// A pack, and answers to it of which some are wrong, some are skipped and one is not JSON.
fn packed() -> (PathBuf, PathBuf) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("documents");
    let (pack, answers) = (folder.join("pack"), folder.join("answers.jsonl"));
    let dir = pack.to_str().expect("UTF-8");
    let output = lightmeter(&["pack", dir, "fog/exp", "vector/reflect", "scene/flat", "--cases", "16", "--size", "16"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let given = std::fs::File::open(pack.join("cases.jsonl")).expect("there are cases");
    let output = command(&["eval"]).stdin(given).output().expect("the binary starts");
    let mut written = "no answer\n".to_owned();
    for (place, line) in String::from_utf8(output.stdout).expect("UTF-8").lines().enumerate() {
        let mut answer: Value = serde_json::from_str(line).expect("it is JSON");
        match place % 5 {
            0 => answer["value"][0] = 0.123.into(),
            1 => answer = serde_json::json!({ "id": answer["id"], "skip": "it has none" }),
            _ => {}
        }
        written += &format!("{answer}\n");
    }
    std::fs::write(&answers, written).expect("answers can be written");
    (pack, answers)
}

#[test]
fn a_run_is_read_again() {
    let filters = ["fog/linear", "attenuation/*/hard", "blend/special", "blend/add/one", "special", "scene/flat"];
    let args = [&["run", "--adapter", "lavapipe", "--cases", "16", "--size", "16"], &filters[..]].concat();
    let (report, _) = read_and_written::<Report>(&args);
    assert!(!report.groups.is_empty() && !report.stability.is_empty() && !report.special.is_empty());
    assert!(!report.blend_states.is_empty() && !report.blend_promises.is_empty() && report.unstable_beyond.is_some());
    assert!(report.groups.iter().any(|group| group.image.is_some()), "a scene is among them");
}

#[test]
fn failures_are_read_again() {
    let head = "fn fog_exp_factor(distance: f32, density: f32) -> f32 {";
    let wrong = |text: &str| text.replace(head, &format!("{head}\n    if density > 0.0 {{ return 0.5; }}"));
    let dir = super::edited("documents", "fog.wgsl", wrong);
    let dir = dir.to_str().expect("UTF-8");
    let (report, _) = read_and_written::<Report>(&["run", "fog/exp", "--cases", "16", "--shaders", dir]);
    assert!(!report.failures.is_empty(), "the shader is wrong");
}

#[test]
fn special_values_are_read_again() {
    let (report, written) = read_and_written::<SpecialReport>(&["special", "--adapter", "lavapipe"]);
    assert!(report.outcomes.len() > 100 && report.probes.len() > 100);
    let bits = written["outcomes"][0]["bits"].as_str().expect("bits are written in hex");
    assert_eq!(bits, format!("0x{:08x}", report.outcomes[0].bits));
}

#[test]
fn a_pack_and_a_gate_are_read_again() {
    let (pack, answers) = packed();
    let manifest = std::fs::read(pack.join("manifest.json")).expect("there is a manifest");
    let (manifest, _) = again::<Manifest>(&manifest);
    assert!(!manifest.formulas.is_empty() && !manifest.scenes.is_empty() && !manifest.files.is_empty());
    let args = ["gate", pack.to_str().expect("UTF-8"), answers.to_str().expect("UTF-8"), "--format", "json"];
    let (report, _) = again::<GateReport>(&lightmeter(&args).stdout);
    assert!(!report.failures.is_empty() && !report.problems.is_empty() && report.totals.skipped > 0);
    assert_eq!(report.choice, manifest.choice);
}

#[test]
fn sweeps_are_read_again() {
    let range = ["--from", "1", "--to", "1.01", "--adapter"];
    for adapter in ["cpu", "lavapipe"] {
        let (document, _) =
            read_and_written::<SweepDocument>(&[&["sweep", "fog/exp"], &range[..], &[adapter]].concat());
        assert!(document.is_finished() && document.statistics.worst.is_some());
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("documents");
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    let checkpoint = folder.join("blend.json");
    let _ = std::fs::remove_file(&checkpoint);
    let place = checkpoint.to_str().expect("UTF-8");
    let args = ["sweep", "blend/mode-alpha", "--adapter", "lavapipe", "--checkpoint", place, "--blocks", "1"];
    let (document, _) = read_and_written::<SweepDocument>(&args);
    assert!(!document.is_finished() && document.statistics.stored.is_some());
}

#[test]
fn a_bench_is_read_again() {
    let args = ["bench", "fog/exp", "technique/power", "scaling/pixels", "--quick", "--adapter", "lavapipe"];
    let (document, _) = read_and_written::<BenchDocument>(&args);
    let measured = &document.adapters[0];
    assert!(!measured.groups.is_empty() && !measured.scalings.is_empty() && !measured.families.is_empty());
}

#[test]
fn a_self_test_is_read_again() {
    let (document, _) = read_and_written::<SelftestDocument>(&["selftest", "fog/exp", "--calibrate"]);
    assert!(document.kills.is_some_and(|kills| !kills.is_empty()) && document.calibration.is_some());
    let args = ["selftest", "--only", "blend-unit", "--target", "rgba8unorm", "--cases", "16"];
    let (document, _) = read_and_written::<SelftestDocument>(&args);
    assert!(!document.rows.is_empty() && document.kills.is_none());
}
