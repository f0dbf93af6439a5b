//! The self-test of formulas as text.

use lightmeter_document::selftest::{Clean, Finding, Kill, Mistake, Record, Resolution, SceneResolution, family_of};
use std::fmt::{Result, Write};

/// The kill matrix by mistake, what went wrong, and the resolution where it was measured.
///
/// # Errors
/// Where the writer fails.
pub fn text(record: &Record, mistakes: &[Mistake], resolutions: &[Resolution], out: &mut impl Write) -> Result {
    writeln!(
        out,
        "{:<34} {:>8} {:>8} {:>8} {:>10} {:>10}",
        "mistake", "formulas", "caught", "named", "cases", "at most"
    )?;
    for fault in mistakes {
        let kills: Vec<&Kill> = record.kills.iter().filter(|kill| kill.fault == fault.name).collect();
        if kills.is_empty() {
            continue;
        }
        let caught = kills.iter().filter(|kill| kill.finding != Finding::Survived).count();
        let named = kills.iter().filter(|kill| kill.finding == Finding::Named).count();
        let (median, most) = smallest(&kills);
        writeln!(out, "{:<34} {:>8} {caught:>8} {named:>8} {median:>10} {most:>10}", fault.name, kills.len())?;
    }
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
    if !resolutions.is_empty() {
        writeln!(out, "\n{:<32} {:<22} {:<8} {:>12} {:>12}", "formula", "parameter", "error", "single", "group")?;
    }
    for resolution in resolutions {
        let number = |x: Option<f64>| x.map_or("—".into(), |x| format!("{x:.2e}"));
        writeln!(
            out,
            "{:<32} {:<22} {:<8} {:>12} {:>12}",
            resolution.formula,
            resolution.name(),
            resolution.error.name(),
            number(resolution.single),
            number(resolution.group)
        )?;
    }
    Ok(())
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
    if !resolutions.is_empty() {
        writeln!(out, "\n{:<32} {:<22} {:>10} {:>10}", "smallest errors in scenes", "of", "pixel", "image")?;
    }
    let percent = |x: Option<f64>| x.map_or("–".into(), |x| format!("{:.4} %", 100.0 * x));
    for SceneResolution { scene, parameter, pixel, image, .. } in resolutions {
        writeln!(out, "{scene:<32} {parameter:<22} {:>10} {:>10}", percent(*pixel), percent(*image))?;
    }
    Ok(())
}
