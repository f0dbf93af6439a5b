//! What must be the same in all shards of one run, and which of it differs.

use lightmeter_document::by_case::{ComparedBy, KnownFailure};
use lightmeter_document::report::{Report, ShaderUse};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Fields that are told at most.
const MOST_FIELDS: usize = 16;
/// Characters of a value that are told.
const MOST_CHARACTERS: usize = 100;
/// Files that are named of each value.
const MOST_FILES: usize = 4;

/// The fields that differ between reports, a line each: its name, and each of its values with the files that have it. `None` where none
/// differs.
pub(super) fn differences(parts: &[(PathBuf, Report)]) -> Option<String> {
    let facts: Vec<Vec<(String, String)>> = parts.iter().map(|(_, report)| facts(report)).collect();
    let mut names: Vec<&String> = vec![];
    for (name, _) in facts.iter().flatten() {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let facts: Vec<BTreeMap<&String, &String>> =
        facts.iter().map(|of| of.iter().map(|(name, value)| (name, value)).collect()).collect();
    let mut lines = vec![];
    for name in names {
        let mut files_of: Vec<(Option<&String>, Vec<String>)> = vec![];
        for ((path, _), facts) in parts.iter().zip(&facts) {
            let (value, file) = (facts.get(name).copied(), path.display().to_string());
            match files_of.iter_mut().find(|(known, _)| *known == value) {
                Some((_, files)) => files.push(file),
                None => files_of.push((value, vec![file])),
            }
        }
        if files_of.len() > 1 {
            let values = files_of.iter().map(|(value, files)| told(*value, files)).collect::<Vec<_>>();
            lines.push(format!("  {name}: {}", values.join("; ")));
        }
    }
    let more = lines.len().saturating_sub(MOST_FIELDS);
    lines.truncate(MOST_FIELDS);
    if more > 0 {
        lines.push(format!("  and {more} more"));
    }
    (!lines.is_empty()).then(|| lines.join("\n"))
}

/// A value of a field, and the files that have it.
fn told(value: Option<&String>, files: &[String]) -> String {
    let mut named = files[..files.len().min(MOST_FILES)].join(", ");
    if files.len() > MOST_FILES {
        named += &format!(" and {} more", files.len() - MOST_FILES);
    }
    let value = value.map_or("nothing", String::as_str);
    let mut cut: String = value.chars().take(MOST_CHARACTERS).collect();
    if cut.len() < value.len() {
        cut.push('…');
    }
    format!("{cut} in {named}")
}

/// All that must be the same, by the names that the JSON has for it; what is empty is left out.
fn facts(report: &Report) -> Vec<(String, String)> {
    let mut out = vec![];
    let mut add = |name: &str, value: Value| flatten(name, &value, &mut out);
    add("version", json!(report.version));
    add("profile", json!(report.profile));
    add("seed", json!(report.seed));
    let by = report.compared_by.clone().map(|by| ComparedBy { shard: None, ..by });
    if let Value::Object(fields) = json!(by) {
        fields.iter().for_each(|(name, value)| add(name, value.clone()));
    }
    match &report.renderer {
        Some(renderer) => {
            add("renderer", json!(renderer.identity));
            add("declares", json!(renderer.declares));
        }
        // A renderer is an adapter as well, by the same names.
        None => add("adapters", json!(report.adapters)),
    }
    let expected: Vec<KnownFailure> =
        report.expectations.iter().map(|one| KnownFailure { failed: 0, passed: 0, ..one.clone() }).collect();
    add("expectations", json!(expected));
    add("shaders_hash", json!(report.shaders_hash));
    add("shader", json!(report.shader.as_ref().map(ShaderUse::without_mistakes)));
    out
}

/// A value by the paths of its fields. A list of plain values is one field.
fn flatten(name: &str, value: &Value, out: &mut Vec<(String, String)>) {
    let is_plain = |value: &Value| !value.is_object() && !value.is_array();
    match value {
        Value::Null => {}
        Value::Object(fields) => {
            let fields: &Map<String, Value> = fields;
            fields.iter().for_each(|(field, value)| flatten(&format!("{name}.{field}"), value, out));
        }
        Value::Array(items) if items.is_empty() => {}
        Value::Array(items) if !items.iter().all(is_plain) => {
            items.iter().enumerate().for_each(|(k, item)| flatten(&format!("{name}[{k}]"), item, out));
        }
        plain => out.push((name.to_owned(), plain.to_string())),
    }
}
