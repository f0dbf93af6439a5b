//! A probe of a special value: what is promised of it, and what adapters give.

use super::super::options::Choice;
use lightmeter::document::Number;
use lightmeter::document::special::ProbeResult;
use lightmeter::special::run::{Results, evaluate, skipped_embedded};
use lightmeter::special::{FAMILY, Gives, Probe};
use lightmeter::subject::Subject;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The probe of an id such as `special/nan/nan-plus-one`.
pub(super) fn find(id: &str) -> anyhow::Result<Option<&'static Probe>> {
    if id != FAMILY && !id.starts_with(&format!("{FAMILY}/")) {
        return Ok(None);
    }
    match Probe::by_id(id) {
        Some(probe) => Ok(Some(probe)),
        None => anyhow::bail!("no case `{id}`; a case is as `special/nan/nan-plus-one`: see `lightmeter list special`"),
    }
}

/// The probe as text or as JSON.
pub(super) fn show(
    probe: &'static Probe,
    choice: &Choice,
    subjects: &[Subject],
    as_json: bool,
) -> anyhow::Result<String> {
    let code = choice.code()?;
    let mut results = vec![];
    for subject in subjects {
        let found = evaluate(subject, &code, &[probe])?.unwrap_or_else(|| Results {
            outcomes: vec![],
            skipped: vec![skipped_embedded(&subject.identity.name)],
            record: None,
        });
        results.push((subject, found));
    }
    if as_json {
        return Ok(serde_json::to_string_pretty(&json(probe, &results))? + "\n");
    }
    let mut text = String::new();
    writeln!(text, "{}\n  {}", probe.id(), probe.what)?;
    let operands: Vec<String> = probe.inputs.iter().map(|&bits| operand(bits)).collect();
    writeln!(text, "  operands  {}", operands.join("  "))?;
    writeln!(text, "  promised  {}", probe.promise.words(probe.gives))?;
    writeln!(text, "  {}: {}", probe.source.section(), probe.source.says())?;
    for (subject, found) in &results {
        writeln!(text, "\n{}", subject.identity.name)?;
        for skipped in &found.skipped {
            writeln!(text, "  {:<9} skipped: {}", skipped.stage, skipped.reason)?;
        }
        for outcome in &found.outcomes {
            let ProbeResult { stage, value, bits, .. } = outcome;
            let recorded = outcome.recorded.map(|recorded| format!("; on record: {}", probe.gives.word(recorded)));
            let verdict = outcome.verdict.name();
            writeln!(text, "  {stage:<9} {value}  0x{bits:08x}  {verdict}{}", recorded.unwrap_or_default())?;
        }
    }
    Ok(text)
}

fn operand(bits: u32) -> String {
    format!("{} (0x{bits:08x})", Gives::Float.word(bits))
}

fn json(probe: &Probe, results: &[(&Subject, Results)]) -> Value {
    let inputs: Vec<Value> = probe.inputs.iter().map(|&bits| json!(Number(f32::from_bits(bits).into()))).collect();
    let hex: Vec<String> = probe.inputs.iter().map(|bits| format!("0x{bits:08x}")).collect();
    let answers: Vec<Value> = results.iter().flat_map(|(_, found)| &found.outcomes).map(|one| json!(one)).collect();
    let skipped: Vec<Value> = results.iter().flat_map(|(_, found)| &found.skipped).map(|one| json!(one)).collect();
    json!({
        "schema": "lightmeter.show/1", "id": probe.id(), "formula": probe.what, "source": probe.source.section(),
        "inputs": inputs, "inputs_hex": hex, "promise": probe.promise.words(probe.gives), "answers": answers,
        "skipped": skipped,
    })
}
