//! A failing case, for people.

use crate::Level;
use crate::table::{Align, TextTable};
use lightmeter_document::by_case::FailedAnswer;
use lightmeter_document::report::Failure;
use lightmeter_document::{Number, distance_told};
use lightmeter_scene::target::TargetFormat;
use std::fmt::{Result, Write};

/// Writes a failure with all that is needed to understand it: of a renderer's answer all of its outputs, of others the one that is wrong, and the
/// command that runs it again.
///
/// # Errors
/// Where the writer fails.
pub fn failure(failure: &Failure, level: Level, out: &mut impl Write) -> Result {
    match &failure.answer {
        Some(answer) => answered(failure, answer, out),
        None => judged(failure, level, out),
    }
}

fn judged(failure: &Failure, level: Level, out: &mut impl Write) -> Result {
    let Failure { id, adapter, stage, output, .. } = failure;
    let target = failure.target.as_ref().map(|target| format!(" on {target}")).unwrap_or_default();
    writeln!(out, "FAIL {id} on {adapter}, {stage}{target}: {output}")?;
    // NaNs differ only in their bits, so the bits are shown.
    let has_bits = level == Level::Verbose || failure.promise.is_some() || failure.value.0.is_nan();
    for ((name, value), bits) in failure.inputs.iter().zip(failure.inputs_hex.values()) {
        let unit = failure.units.get(name).map(|unit| format!("  {unit}")).unwrap_or_default();
        let bits = if has_bits { format!("  {}", plain(bits)) } else { String::new() };
        writeln!(out, "  {name:<14} {}{bits}{unit}", plain(value))?;
    }
    match &failure.promise {
        Some(promise) => writeln!(out, "  {:<14} {promise}", "legal")?,
        None => {
            let [low, high] = failure.interval.map(Number::narrow);
            writeln!(out, "  {:<14} {}", "reference", failure.reference)?;
            writeln!(out, "  {:<14} {low} to {high}", "legal")?;
        }
    }
    if failure.unwritten {
        writeln!(out, "  {:<14} never written", "value")?;
    } else if failure.promise.is_some() || failure.value.0.is_nan() {
        writeln!(out, "  {:<14} {}  {}", "value", failure.value, failure.value_hex)?;
    } else {
        let bits = if has_bits { format!("  {}", failure.value_hex) } else { String::new() };
        let off = distance_told(failure.error_ulp, unit_of(failure), failure.value, failure.reference);
        writeln!(out, "  {:<14} {}{bits}, {off}", "value", failure.value.narrow())?;
    }
    // What was typed into a page has no command that judges it again.
    if failure.rerun.is_empty() { Ok(()) } else { writeln!(out, "  {:<14} {}", "again", failure.rerun) }
}

/// An answer: its inputs by name, and a row for each output, marked where its value is not legal.
fn answered(failure: &Failure, answer: &FailedAnswer, out: &mut impl Write) -> Result {
    writeln!(out, "  {}", failure.id)?;
    if let Some(problem) = &answer.problem {
        writeln!(out, "    {problem}")?;
    }
    for (name, value) in &failure.inputs {
        let unit = failure.units.get(name).map(|unit| format!("  {unit}")).unwrap_or_default();
        writeln!(out, "    {name:<14} {}{unit}", plain(value))?;
    }
    if answer.value.is_empty() {
        return Ok(());
    }
    let columns = ["", "", "value", "legal from", "to", "reference"].map(|heading| (heading, Align::Left));
    let mut table = TextTable::new(&columns);
    for (k, [low, high]) in answer.interval.iter().enumerate() {
        let (Some(value), Some(reference)) = (answer.value.get(k), answer.reference.get(k)) else { break };
        let name = answer.outputs.get(k).map_or("value", String::as_str);
        let is_legal = low.0 <= value.0 && value.0 <= high.0;
        let [value, low, high] = [value, low, high].map(|number| number.narrow().to_string());
        let mark = if is_legal { "" } else { "✗" };
        table.row([mark.into(), name.into(), value, low, high, brief(reference.0)]);
    }
    out.write_str(&table.text("  "))
}

/// A failure on one line, and where there is one, the command that runs it again on another.
pub(crate) fn one_line(failure: &Failure) -> String {
    let inputs: Vec<String> = failure.inputs.iter().map(|(name, value)| format!("{name} = {}", plain(value))).collect();
    let Failure { id, output, value, interval: [low, high], rerun, .. } = failure;
    let of = if inputs.is_empty() { String::new() } else { format!(" of {}", inputs.join(", ")) };
    let told = match &failure.answer {
        None => format!("{id}: {output} is {value}{of}; legal: [{low}, {high}]"),
        Some(answer) => {
            let list = answer.value.iter().map(Number::to_string).collect::<Vec<_>>().join(", ");
            let legal: Vec<String> = answer.interval.iter().map(|[low, high]| format!("[{low}, {high}]")).collect();
            format!("{id}: {list}{of}; legal: {}", legal.join(", "))
        }
    };
    if rerun.is_empty() { told } else { format!("{told}\n{rerun}") }
}

/// Nine digits, which tell any two numbers of f32 apart.
fn brief(x: f64) -> String {
    let rounded: f64 = format!("{x:.8e}").parse().unwrap_or(x);
    Number(rounded).to_string()
}

/// The formula, or the scene, that a failure is of.
pub(crate) fn formula_of(failure: &Failure) -> &str {
    let path = failure.id.rsplit_once('/').map_or(failure.id.as_str(), |(path, _)| path);
    path.split("/hard").next().unwrap_or(path).trim_end_matches("/random")
}

/// What the error of a failure is counted in.
pub(crate) fn unit_of(failure: &Failure) -> &'static str {
    unit_on(failure.target.as_deref())
}

/// What errors on a target are counted in; without a target there are no steps.
pub(super) fn unit_on(target: Option<&str>) -> &'static str {
    if target.and_then(TargetFormat::by_name).is_some_and(TargetFormat::is_unorm) { "steps" } else { "ULP" }
}

/// JSON without quotes and commas: `[0.5 1]`.
pub(crate) fn plain(value: &serde_json::Value) -> String {
    match value {
        serde_json::Value::Array(values) => format!("[{}]", values.iter().map(plain).collect::<Vec<_>>().join(" ")),
        serde_json::Value::String(text) => text.clone(),
        serde_json::Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), |x| Number(x).narrow()),
        other => other.to_string(),
    }
}
