//! What goes out as JSON is read again by the types that wrote it, and written once more it is the same.

use super::{code, lightmeter, stderr};
use lightmeter::document::run::Report;
use lightmeter::document::special::SpecialReport;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Runs a command, reads its JSON by a type and writes it again.
fn read_and_written<T: Serialize + DeserializeOwned>(args: &[&str]) -> (T, Value) {
    let output = lightmeter(&[args, &["--format", "json"]].concat());
    assert!(code(&output) <= 1, "{args:?}: {}", stderr(&output));
    let written: Value = serde_json::from_slice(&output.stdout).expect("it is JSON");
    let read: T = serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{args:?}: {error}"));
    assert_eq!(serde_json::to_value(&read).expect("it is written"), written, "{args:?}");
    (read, written)
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
