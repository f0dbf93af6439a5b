//! The self-test of formulas as text.

use crate::table::{Align, TextTable};
use lightmeter_document::selftest::{
    Clean, Finding, Kill, Mistake, NoiseRecord, Record, Resolution, SceneResolution, family_of,
};
use lightmeter_document::thousands;
use std::fmt::{Result, Write};

/// The kill matrix by mistake, what went wrong, and the resolution where it was measured.
///
/// # Errors
/// Where the writer fails.
pub fn text(record: &Record, mistakes: &[Mistake], resolutions: &[Resolution], out: &mut impl Write) -> Result {
    let numbers = ["formulas", "caught", "named", "cases", "at most"].map(|heading| (heading, Align::Right));
    let mut table = TextTable::new(&[&[("mistake", Align::Left)], &numbers[..]].concat());
    for fault in mistakes {
        let kills: Vec<&Kill> = record.kills.iter().filter(|kill| kill.fault == fault.name).collect();
        if kills.is_empty() {
            continue;
        }
        let caught = kills.iter().filter(|kill| kill.finding != Finding::Survived).count();
        let named = kills.iter().filter(|kill| kill.finding == Finding::Named).count();
        let (median, most) = smallest(&kills);
        let numbers = [kills.len(), caught, named, median, most].map(|number| number.to_string());
        table.row(std::iter::once(fault.name.to_string()).chain(numbers));
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
        "noise in the place of formulas: {} answers, {wrong} explained, and {made} that the mistaken formula gives itself\n",
        thousands(record.tried)
    );
    for one in &record.explained {
        let mark = if one.is_made { ' ' } else { '✗' };
        text +=
            &format!("{mark} {}: {}: {} ({:.0} % as it gives)\n", one.formula, one.noise, one.says, 100.0 * one.given);
    }
    text
}
