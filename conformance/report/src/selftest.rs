//! The self-test of formulas as text.

use crate::table::{Align, TextTable};
use lightmeter_document::selftest::{
    Clean, Finding, Kill, Mistake, NoiseRecord, Record, Resolution, SceneResolution, family_of,
};
use lightmeter_document::thousands;
use std::collections::HashMap;
use std::fmt::{Result, Write};

/// The kill matrix by mistake, what went wrong, and the resolution where it was measured.
///
/// # Errors
/// Where the writer fails.
pub fn text(record: &Record, mistakes: &[Mistake], resolutions: &[Resolution], out: &mut impl Write) -> Result {
    let numbers = ["formulas", "caught", "named", "cases", "at most"].map(|heading| (heading, Align::Right));
    let mut table = TextTable::new(&[&[("mistake", Align::Left)], &numbers[..]].concat());
    for MistakeRow { name, kills, .. } in rows(record, mistakes) {
        let caught = kills.iter().filter(|kill| kill.finding != Finding::Survived).count();
        let named = kills.iter().filter(|kill| kill.finding == Finding::Named).count();
        let (median, most) = smallest(&kills);
        let numbers = [kills.len(), caught, named, median, most].map(|number| number.to_string());
        table.row(std::iter::once(name).chain(numbers));
    }
    out.write_str(&table.text(""))?;
    let total = record.kills.len();
    let aliases = record.kills.iter().filter(|kill| kill.alias).count();
    writeln!(
        out,
        "\n{total} mistakes in formulas{}: {} caught, {} named first ({aliases} of them by an alias of the same values)",
        if record.is_complete { "" } else { ", not all that there are" },
        total - record.count(Finding::Survived),
        record.count(Finding::Named),
    )?;
    for family in record.families() {
        let verdicts: u64 = of_family(record, family).map(|clean| clean.verdicts).sum();
        let failed: u64 = of_family(record, family).map(|clean| clean.failed).sum();
        if verdicts > 0 {
            writeln!(out, "{family:<14} {verdicts:>10} verdicts without a mistake, {failed} failed")?;
        }
    }
    for kill in record.kills.iter().filter(|kill| kill.finding != Finding::Named) {
        let word = if kill.finding == Finding::Survived { "SURVIVED" } else { "caught, not named" };
        writeln!(out, "{} in {}: {word}: {}", kill.fault, kill.formula, kill.sentence)?;
    }
    for clean in record.clean.iter().filter(|clean| clean.failed > 0 || clean.systematic.is_some()) {
        let named = clean.systematic.as_ref().map_or("", |systematic| systematic.says.as_str());
        writeln!(out, "FALSE ALARM in {}: {} failed {named}", clean.formula, clean.failed)?;
    }
    let (left, right) = (Align::Left, Align::Right);
    let columns = [("formula", left), ("parameter", left), ("error", left), ("single", right), ("group", right)];
    let mut table = TextTable::new(&columns);
    for resolution in resolutions {
        let number = |x: Option<f64>| x.map_or("—".into(), |x| format!("{x:.2e}"));
        table.row([
            resolution.formula.clone(),
            resolution.name().to_string(),
            resolution.error.name().to_string(),
            number(resolution.single),
            number(resolution.group),
        ]);
    }
    if resolutions.is_empty() { Ok(()) } else { write!(out, "\n{}", table.text("")) }
}

/// A row of a table of mistakes, with where each was made.
pub(super) struct MistakeRow<'a> {
    pub(super) name: String,
    pub(super) says: &'a str,
    pub(super) seen_in: &'a str,
    pub(super) kills: Vec<&'a Kill>,
}

/// The mistakes that were made, a row each. Those that follow from the steps and inputs of formulas are one row together.
pub(super) fn rows<'a>(record: &'a Record, mistakes: &'a [Mistake]) -> Vec<MistakeRow<'a>> {
    let mut by_name: HashMap<&str, Vec<&Kill>> = HashMap::new();
    record.kills.iter().for_each(|kill| by_name.entry(&kill.fault).or_default().push(kill));
    let (mut rows, mut derived, mut count) = (vec![], vec![], 0);
    for Mistake { name, says, seen_in, generated } in mistakes {
        let Some(kills) = by_name.remove(&**name) else { continue };
        if *generated {
            derived.extend(kills);
            count += 1;
        } else {
            let seen_in = seen_in.as_deref().unwrap_or_default();
            rows.push(MistakeRow { name: name.to_string(), says, seen_in, kills });
        }
    }
    if count > 0 {
        let (name, says) = (format!("{} generated", thousands(count)), "follow from the steps and inputs of formulas");
        rows.push(MistakeRow { name, says, seen_in: "", kills: derived });
    }
    rows
}

fn of_family<'a>(record: &'a Record, family: &'a str) -> impl Iterator<Item = &'a Clean> {
    record.clean.iter().filter(move |clean| family_of(&clean.formula) == family)
}

/// The median and the greatest of the smallest numbers of cases.
pub(super) fn smallest(kills: &[&Kill]) -> (usize, usize) {
    let mut counts: Vec<usize> = kills.iter().filter_map(|kill| kill.smallest).collect();
    counts.sort_unstable();
    (counts.get(counts.len() / 2).copied().unwrap_or_default(), counts.last().copied().unwrap_or_default())
}

/// So many per cent; all of nothing.
#[expect(clippy::cast_precision_loss, reason = "counts of mistakes")]
pub(super) fn percent(part: usize, whole: usize) -> f64 {
    if whole == 0 { 100.0 } else { 100.0 * part as f64 / whole as f64 }
}

/// The smallest errors that scenes tell, by scene and parameter.
///
/// # Errors
/// Where the writer fails.
pub fn scene_resolutions(resolutions: &[SceneResolution], out: &mut impl Write) -> Result {
    let (left, right) = (Align::Left, Align::Right);
    let mut table =
        TextTable::new(&[("smallest errors in scenes", left), ("of", left), ("pixel", right), ("image", right)]);
    let percent = |x: Option<f64>| x.map_or("–".into(), |x| format!("{:.4} %", 100.0 * x));
    for SceneResolution { scene, parameter, pixel, image, .. } in resolutions {
        table.row([scene.to_string(), parameter.to_string(), percent(*pixel), percent(*image)]);
    }
    if resolutions.is_empty() { Ok(()) } else { write!(out, "\n{}", table.text("")) }
}
/// What noise was explained.
#[must_use]
pub fn noise(record: &NoiseRecord) -> String {
    let wrong = record.explained.iter().filter(|one| !one.is_made).count();
    let made = record.explained.len() - wrong;
    let mut text = format!(
        "noise in the place of formulas and scenes: {} answers, {wrong} explained, and {made} that the mistaken formula gives itself\n",
        thousands(record.tried)
    );
    for one in &record.explained {
        let mark = if one.is_made { ' ' } else { '✗' };
        text +=
            &format!("{mark} {}: {}: {} ({:.0} % as it gives)\n", one.formula, one.noise, one.says, 100.0 * one.given);
    }
    text
}
