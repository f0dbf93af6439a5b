//! The table of renderers, made from the JSON of their gates: a row for each result, in the order in which they are given.

use super::super::html;
use lightmeter_document::gate::{GateGroup, GateReport};
use lightmeter_document::thousands;
use std::fmt::{Result, Write};

/// Writes the table in Markdown.
///
/// # Errors
/// Where the writer fails.
pub fn markdown(gates: &[GateReport], out: &mut impl Write) -> Result {
    writeln!(out, "# Renderers\n")?;
    writeln!(
        out,
        "A renderer passes, ✓, where its gate ends with 0: nothing fails but what is known to. Formulas and scenes are those that it was asked, cases those of them.\n"
    )?;
    writeln!(
        out,
        "| | renderer | device | driver | profile | formulas | scenes | cases | pass | known failures | other failures | skipped | unanswered | seconds |"
    )?;
    writeln!(out, "|---|---|---|---|---|{}", "--:|".repeat(9))?;
    gates.iter().try_for_each(|gate| row(gate, out))
}

/// The row of a gate.
fn row(gate: &GateReport, out: &mut impl Write) -> Result {
    let (totals, who) = (&gate.totals, &gate.renderer);
    let asked = |is_scene: bool| {
        let is_it = |group: &&GateGroup| group.id.starts_with("scene/") == is_scene && group.target.is_none();
        gate.groups.iter().filter(is_it).filter(|group| group.asked > 0).count() as u64
    };
    let words = [
        if html::is_success(gate) { "✓".to_owned() } else { "✗".to_owned() },
        format!("{} {}", who.name, who.version),
        who.device.clone().unwrap_or_default(),
        who.driver.clone().unwrap_or_default(),
        gate.profile.clone(),
    ];
    let counts = [
        asked(false),
        asked(true),
        totals.asked,
        totals.passed,
        totals.expected_failures,
        totals.failed.saturating_sub(totals.expected_failures),
        totals.skipped,
        totals.missing,
    ];
    let words = words.map(|word| escaped(word.trim()));
    writeln!(out, "| {} | {} | {:.0} |", words.join(" | "), counts.map(thousands).join(" | "), gate.seconds)
}

/// What a renderer says of itself, as a cell of a table.
fn escaped(word: &str) -> String {
    let mut out = String::with_capacity(word.len());
    for c in word.chars() {
        if matches!(c, '|' | '\\' | '<' | '>' | '[' | ']' | '`' | '*' | '_' | '&') {
            out.push('\\');
        }
        out.push(if c.is_control() { ' ' } else { c });
    }
    out
}
