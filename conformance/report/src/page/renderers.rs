//! The table of renderers, made from the JSON of their gates: a row for each result, in the order in which they are given.

use super::super::html;
use lightmeter_document::report::{Group, Report};
use lightmeter_document::thousands;
use std::fmt::{Result, Write};

/// Writes the table in Markdown.
///
/// # Errors
/// Where the writer fails.
pub fn markdown(gates: &[Report], out: &mut impl Write) -> Result {
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
    let whys: Vec<Option<String>> = gates.iter().map(html::why_not).collect();
    gates.iter().zip(&whys).try_for_each(|(gate, why)| row(gate, why.is_none(), out))?;
    let failing = gates.iter().zip(&whys).filter_map(|(gate, why)| Some((gate, why.as_ref()?)));
    failing.enumerate().try_for_each(|(place, (gate, why))| {
        let before = if place == 0 { "\n" } else { "" };
        writeln!(out, "{before}* ✗ {}: {}", escaped(&name(gate)), escaped(why))
    })
}

/// A renderer's name and version, and which shard of its cases this is.
fn name(gate: &Report) -> String {
    let shard = gate.compared_by.as_ref().and_then(|by| by.shard.as_ref());
    let shard = shard.map_or_else(String::new, |shard| format!(", shard {shard} alone"));
    let name =
        gate.renderer.as_ref().map(|renderer| format!("{} {}", renderer.identity.name, renderer.identity.version));
    name.unwrap_or_default().trim().to_owned() + &shard
}

/// The row of a gate.
fn row(gate: &Report, is_success: bool, out: &mut impl Write) -> Result {
    let totals = gate.cases();
    let who = gate.renderer.as_ref().map(|renderer| renderer.identity.clone()).unwrap_or_default();
    let asked = |is_scene: bool| {
        let is_it = |group: &&Group| group.id.starts_with("scene/") == is_scene && group.blended_on().is_none();
        let is_asked = |group: &&Group| group.by_case.as_ref().is_some_and(|counts| counts.totals.asked > 0);
        gate.groups.iter().filter(is_it).filter(is_asked).count() as u64
    };
    let words = [
        if is_success { "✓".to_owned() } else { "✗".to_owned() },
        name(gate),
        who.device.unwrap_or_default(),
        who.driver.unwrap_or_default(),
        gate.profile.to_string(),
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
