//! Steps of shaders as SARIF 2.1.0, which code scanning and editors read.

use lightmeter_document::report::{ShaderReview, ShaderStep, StepVerdict};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The document's schema.
const SCHEMA: &str = "https://json.schemastore.org/sarif-2.1.0.json";

/// A file's name as an address, relative as the file was named.
fn address(file: &str) -> String {
    let mut text = String::from(if file.starts_with('/') { "file://" } else { "" });
    for byte in file.replace('\\', "/").bytes() {
        if byte.is_ascii_alphanumeric() || b"/-_.~".contains(&byte) {
            text.push(char::from(byte));
        } else {
            let _ = write!(text, "%{byte:02X}");
        }
    }
    text
}

fn place(file: &str, line: u32) -> Value {
    let mut place = json!({ "artifactLocation": { "uri": address(file) } });
    if line > 0 {
        place["region"] = json!({ "startLine": line });
    }
    json!([{ "physicalLocation": place }])
}

/// What a step that is not right is an instance of: its name, or the kind of step.
fn rule_of(step: &ShaderStep) -> &str {
    if step.name.is_empty() { &step.kind } else { &step.name }
}

fn level(step: &ShaderStep, is_strict: bool) -> &'static str {
    let counts = StepVerdict::Mistake == step.verdict || is_strict && step.verdict == StepVerdict::Dialect;
    match step.verdict {
        _ if counts => "error",
        StepVerdict::Perhaps => "warning",
        _ => "note",
    }
}

/// The document: a result for each step that is not right, and what was not read among the notifications.
#[must_use]
pub fn of_shaders(shaders: &[ShaderReview], is_strict: bool, notes: &[String]) -> Value {
    let found = || {
        let open = |shader: &'_ ShaderReview| {
            let steps = shader.steps.iter().filter(|step| step.verdict != StepVerdict::Right);
            steps.map(|step| (shader.file.clone(), step.clone())).collect::<Vec<_>>()
        };
        shaders.iter().flat_map(open)
    };
    let mut rules: BTreeMap<String, String> = BTreeMap::new();
    for (_, step) in found() {
        rules.entry(rule_of(&step).to_owned()).or_insert(format!("{} of a step `{}`", rule_of(&step), step.kind));
    }
    let result = |(file, step): (String, ShaderStep)| {
        let rule = rule_of(&step);
        let mut result = json!({
            "ruleId": rule,
            "ruleIndex": rules.keys().position(|own| own == rule),
            "level": level(&step, is_strict),
            "message": { "text": format!("{}: {}", step.kind, step.says()) },
            "locations": place(&file, step.line),
        });
        if step.accepted {
            result["suppressions"] = json!([{ "kind": "external" }]);
        }
        result
    };
    let results: Vec<Value> = found().map(result).collect();
    let unread = shaders.iter().filter_map(|own| own.unread.as_ref().map(|why| (own, 0, why)));
    let refused = shaders.iter().flat_map(|own| own.refused.iter().map(move |what| (own, what.line, &what.says)));
    let mut told: Vec<Value> = unread
        .chain(refused)
        .map(|(own, line, why)| json!({ "level": "error", "message": { "text": why }, "locations": place(&own.file, line) }))
        .collect();
    let is_whole = told.is_empty();
    let note = |file: &str, text: &String| json!({ "level": "note", "message": { "text": text }, "locations": place(file, 0) });
    told.extend(shaders.iter().flat_map(|own| own.notes.iter().map(|text| note(&own.file, text))));
    told.extend(notes.iter().map(|text| json!({ "level": "warning", "message": { "text": text } })));
    let rules: Vec<Value> =
        rules.iter().map(|(id, text)| json!({ "id": id, "shortDescription": { "text": text } })).collect();
    json!({
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": { "name": "lightmeter", "semanticVersion": env!("CARGO_PKG_VERSION"), "rules": rules } },
            "invocations": [{ "executionSuccessful": is_whole, "toolExecutionNotifications": told }],
            "results": results,
        }],
    })
}
