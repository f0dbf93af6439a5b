//! A probe of a special value: what is promised of it, and what adapters give.

use super::super::options::Choice;
use lightmeter::document::show::{SCHEMA, ShowDocument, ShownProbe};
use lightmeter::document::special::ProbeResult;
use lightmeter::document::{Document as _, Number};
use lightmeter::filter::Filter;
use lightmeter::special::run::{Results, evaluate, skipped_embedded};
use lightmeter::special::{FAMILY, Gives, Probe};
use lightmeter::subject::Subject;
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
    let code = choice.code(&Filter::default(), false)?;
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
        return Ok(document(probe, results).to_json()?);
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

fn document(probe: &Probe, results: Vec<(&Subject, Results)>) -> ShowDocument {
    let (mut answers, mut skipped) = (vec![], vec![]);
    for (_, found) in results {
        answers.extend(found.outcomes);
        skipped.extend(found.skipped);
    }
    ShowDocument::Probe(ShownProbe {
        schema: SCHEMA.into(),
        id: probe.id(),
        formula: probe.what.into(),
        source: probe.source.section().into(),
        inputs: probe.inputs.iter().map(|&bits| Number(f32::from_bits(bits).into())).collect(),
        inputs_hex: probe.inputs.iter().map(|bits| format!("0x{bits:08x}")).collect(),
        promise: probe.promise.words(probe.gives),
        answers,
        skipped,
    })
}
