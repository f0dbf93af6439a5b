//! Shards of a gate or of a run that are not of one run: `merge` names what differs, and in which files.

use super::process::command_of;
use super::{answered, edit_as, folder, text};
use crate::{code, lightmeter, stderr, stdout};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A shard of a gate over answers that begin with a hello.
fn shard(pack: &Path, answers: &Path, name: &str, of: &str, hello: &str) -> PathBuf {
    let answers =
        edit_as(answers, name, |k, line| if k == 0 { format!("{hello}\n{line}\n") } else { line.to_owned() + "\n" });
    let out = pack.with_file_name(format!("{name}.json"));
    let args = ["gate", text(pack), text(&answers), "--shard", of, "--format", "json", "--out", text(&out)];
    let output = lightmeter(&args);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    out
}

/// What `merge` says of two files that it refuses.
fn refused(files: &[&Path]) -> String {
    let files: Vec<&str> = files.iter().map(|file| text(file)).collect();
    let output = lightmeter(&[&["merge"], &files[..]].concat());
    assert_eq!(code(&output), 2, "{}", stderr(&output));
    stderr(&output)
}

#[test]
fn what_a_renderer_declares_is_the_same_in_all_shards_or_named() {
    let (pack, answers) = answered("merged", &["fog/exp", "fog/linear"]);
    let first = r#"{"renderer": "r", "version": "1.0", "formulas": ["fog"]}"#;
    let one = shard(&pack, &answers, "one", "1/2", first);
    let two = shard(&pack, &answers, "two", "2/2", first);
    let merged = lightmeter(&["merge", text(&one), text(&two)]);
    assert_eq!(code(&merged), 0, "{}", stderr(&merged));
    assert!(stdout(&merged).contains("warning: whether all shards judged the same code is not known"));
    for (field, hello, values) in [
        ("renderer.version", first.replace("1.0", "1.1"), ["\"1.0\"", "\"1.1\""]),
        ("renderer.name", first.replace("\"r\"", "\"s\""), ["\"r\"", "\"s\""]),
        ("renderer.driver", first.replace('}', ", \"driver\": \"D 3\"}"), ["nothing", "\"D 3\""]),
        ("declares.build", first.replace('}', ", \"build\": \"3f2a91c\"}"), ["nothing", "\"3f2a91c\""]),
        ("profile", first.replace('}', ", \"profile\": \"opengl\"}"), ["\"wgsl\"", "\"opengl\""]),
        ("declares.excludes", first.replace('}', ", \"excludes\": [\"shape:mat4\"]}"), ["nothing", "[\"shape:mat4\"]"]),
        (
            "declares.skips[0].id",
            first.replace('}', ", \"skips\": [{\"id\": \"fog/exp/hard\", \"reason\": \"r\"}]}"),
            ["nothing", "\"fog/exp/hard\""],
        ),
    ] {
        let other = shard(&pack, &answers, "other", "2/2", &hello);
        let said = refused(&[&one, &other]);
        let line = format!("  {field}: {} in {}; {} in {}", values[0], text(&one), values[1], text(&other));
        assert!(said.lines().any(|told| told == line), "no `{line}` in {said}");
        assert!(said.contains("different runs"), "{said}");
    }
}

#[test]
fn shards_of_a_process_whose_code_changed_in_between_are_refused() {
    let folder = folder("merged-builds");
    let shard = |of: &str, build: &str| {
        let out = folder.join(format!("{}-{build}.json", &of[..1]));
        let args = ["gate", "fog/exp", "--cases", "8", "--shard", of, "--format", "json", "--out", text(&out)];
        let exec = command_of(&format!("build={build}"));
        assert_eq!(code(&lightmeter(&[&args[..], &["--exec", &exec]].concat())), 0);
        out
    };
    let [one, two, other] = [("1/2", "a1"), ("2/2", "a1"), ("2/2", "b2")].map(|(of, build)| shard(of, build));
    let merged = lightmeter(&["merge", text(&one), text(&two)]);
    assert_eq!((code(&merged), stdout(&merged).contains("warning")), (0, false));
    let line = format!("  declares.build: \"a1\" in {}; \"b2\" in {}", text(&one), text(&other));
    let said = refused(&[&one, &other]);
    assert!(said.lines().any(|told| told == line), "no `{line}` in {said}");
}

#[test]
fn the_version_of_lightmeter_and_the_driver_of_an_adapter_are_compared() {
    let folder = folder("merged-runs");
    let [one, two] = ["1/2", "2/2"].map(|shard| {
        let out = folder.join(format!("{}.json", &shard[..1]));
        let args = ["run", "fog/exp", "--adapter", "cpu", "--cases", "8", "--format", "json", "--shard", shard];
        assert_eq!(code(&lightmeter(&[&args[..], &["--out", text(&out)]].concat())), 0);
        out
    });
    let right = std::fs::read_to_string(&two).expect("it was written");
    let right: Value = serde_json::from_str(&right).expect("it is JSON");
    for (pointer, field) in [
        ("/version", "version"),
        ("/profile", "profile"),
        ("/adapters/0/driver", "adapters[0].driver"),
        ("/adapters/0/device", "adapters[0].device"),
        ("/compared_by/generator", "generator"),
        ("/compared_by/choice/seed", "choice.seed"),
        ("/compared_by/choice/cases", "choice.cases"),
        ("/compared_by/choice/filter", "choice.filter"),
    ] {
        let mut other = right.clone();
        let value = other.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}"));
        let before = value.to_string();
        *value = match value {
            Value::Number(_) => 77.into(),
            Value::Array(_) => serde_json::json!(["fog/linear"]),
            _ => "other".into(),
        };
        let after = value.to_string();
        std::fs::write(&two, other.to_string()).expect("it can be written");
        let said = refused(&[&one, &two]);
        let told: Vec<&str> = said.lines().filter(|line| line.starts_with("  ")).collect();
        let line = format!("  {field}: {before} in {}; {after} in {}", text(&one), text(&two));
        assert_eq!(told, [line], "{said}");
    }
}
