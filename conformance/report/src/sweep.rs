//! A sweep's result for people.

use lightmeter_document::report::Identity;
use lightmeter_document::sweep::{
    Description, ExactFloat, Statistics, StoreCounts, SweepDocument, SweepInput, SweepVerdict,
};
use lightmeter_document::{Number, error_told, is_worse, thousands};
use std::fmt::{Result, Write};

/// Characters of the longest bar.
const BAR: usize = 40;

/// Writes a result. `text` is the formula on a line, and `rerun` what to add to a command that sweeps one input again.
///
/// # Errors
/// Where the writer fails.
pub fn write(document: &SweepDocument, text: &str, rerun: &str, out: &mut impl Write) -> Result {
    let (sweep, found) = (&document.sweep, &document.statistics);
    writeln!(out, "{}: {text}", sweep.formula)?;
    inputs(sweep, out)?;
    place_and_progress(document, out)?;
    verdicts(found, out)?;
    // What is beyond its limit is not at it.
    let is_beyond = found.nearest_to_limit.is_some_and(|seen| is_worse(seen.margin.0, 1.0));
    let nearest = if is_beyond { "farthest" } else { "at limit" };
    for (what, seen) in [("worst", &found.worst), (nearest, &found.nearest_to_limit)] {
        if let Some(seen) = seen {
            write_seen(document, &format!("{what:<10}"), seen, rerun, out)?;
        }
    }
    for seen in &found.failures {
        write_seen(document, "FAIL      ", seen, rerun, out)?;
    }
    writeln!(out)?;
    bars(document, out)?;
    let has_judged = found.indeterminate < found.inputs;
    let (mark, state) = match (found.failed, document.is_finished()) {
        (0, true) if !has_judged => ("– ", ": nothing is promised of any, so nothing was judged".into()),
        (0, true) => ("✓ ", String::new()),
        (0, false) => ("", format!(" so far: {} of {} blocks are swept", document.done, document.blocks)),
        (_, true) => ("✗ ", String::new()),
        (_, false) => ("✗ ", format!(", with {} of {} blocks swept", document.done, document.blocks)),
    };
    writeln!(out, "{mark}{} of {} inputs outside the bound{state}", thousands(found.failed), thousands(found.inputs))
}

/// Over what is swept, and what is fixed.
fn inputs(sweep: &Description, out: &mut impl Write) -> Result {
    match (sweep.from, sweep.to) {
        (Some(ExactFloat(from)), Some(ExactFloat(to))) => writeln!(
            out,
            "over       every {} from {} to {}: {} floats, output {}",
            sweep.over,
            Number(from.into()),
            Number(to.into()),
            thousands(sweep.inputs),
            sweep.output
        )?,
        _ => writeln!(
            out,
            "over       every byte of source, destination and alpha: {} inputs on rgba8unorm",
            thousands(sweep.inputs)
        )?,
    }
    let fixed: Vec<String> =
        sweep.fixed.iter().map(|(name, ExactFloat(x))| format!("{name} {}", Number((*x).into()).narrow())).collect();
    if fixed.is_empty() { Ok(()) } else { writeln!(out, "fixed      {}", fixed.join(", ")) }
}

/// On what it is swept, and how far that came.
fn place_and_progress(document: &SweepDocument, out: &mut impl Write) -> Result {
    let (stage, adapter) = (&document.sweep.stage, &document.sweep.adapter);
    let Identity { name, device, backend, driver } = adapter;
    writeln!(out, "on         {name}, {stage}: {device} · {backend} · {driver}")?;
    if document.shard != "1/1" {
        writeln!(out, "shard      {}", document.shard)?;
    }
    let state = if document.is_finished() {
        String::new()
    } else {
        format!(", not finished: {} of {} blocks", document.done, document.blocks)
    };
    writeln!(
        out,
        "done       {} inputs in {:.1} s, {} a second{state}",
        thousands(document.statistics.inputs),
        document.seconds,
        thousands(rate(document))
    )
}

/// The counts.
fn verdicts(found: &Statistics, out: &mut impl Write) -> Result {
    writeln!(
        out,
        "outside    {} inputs; {} indeterminate, {} NaN",
        thousands(found.failed),
        thousands(found.indeterminate),
        thousands(found.histogram.nan())
    )?;
    for (name, count) in &found.excused {
        writeln!(out, "deviation  {name} says {} of what is outside the promised bound", thousands(*count))?;
    }
    let Some(stored) = &found.stored else { return Ok(()) };
    let (store, share) = likeliest(&stored.counts);
    let model = match (stored.predicted, stored.departing) {
        (0, _) => String::new(),
        (of, departing) => {
            format!("; {} of {} values depart from the known model", thousands(departing), thousands(of))
        }
    };
    let tiers = stored.tiers.named().map(|(name, count)| format!("{name} {}", percent(count, found.inputs)));
    writeln!(out, "tiers      {}", tiers.join(", "))?;
    writeln!(out, "stored     {store}: {:.2} % of the values that tell{model}", 100.0 * share)
}

/// The store that most values speak for, by its name, and their share.
#[must_use]
pub fn likeliest(counts: &StoreCounts) -> (&'static str, f64) {
    let (place, share) = counts.likeliest_place();
    (StoreCounts::STORES[place], share)
}

/// A verdict, under what it is.
fn write_seen(document: &SweepDocument, what: &str, seen: &SweepVerdict, rerun: &str, out: &mut impl Write) -> Result {
    let sweep = &document.sweep;
    // An error of many ULP is legal where, for instance, a subnormal number may be flushed to 0.
    let is_legal = if seen.margin.0 <= 1.0 { "legal there" } else { "not legal" };
    let share = margin(seen.margin);
    writeln!(out, "\n{what} {}: {is_legal}, {share} of the tolerance", error_told(seen.error, &sweep.unit))?;
    let ExactFloat(value) = seen.value;
    let unwritten = if value.to_bits() == lightmeter_scene::target::SENTINEL { ", never written" } else { "" };
    writeln!(out, "  input      {}", place(&sweep.over, seen.input))?;
    if sweep.from.is_some() {
        writeln!(out, "  value      {}  0x{:08x}{unwritten}", Number(value.into()), value.to_bits())?;
    } else {
        writeln!(out, "  value      {}", Number(value.into()))?;
    }
    writeln!(out, "  reference  {}", seen.reference)?;
    writeln!(out, "  legal      {} to {}", seen.low, seen.high)?;
    if let SweepInput::Float(ExactFloat(x)) = seen.input {
        let bits = x.to_bits();
        writeln!(out, "  again      lightmeter sweep {}{rerun} --from 0x{bits:08x} --to 0x{bits:08x}", sweep.formula)?;
    }
    Ok(())
}

/// An input as it is told.
#[must_use]
pub fn place(over: &str, place: SweepInput) -> String {
    match place {
        SweepInput::Float(ExactFloat(x)) => format!("{over} {}  0x{:08x}", Number(x.into()), x.to_bits()),
        SweepInput::Bytes { source, destination, alpha } => {
            format!("source {source}/255, destination {destination}/255, alpha {alpha}/255")
        }
    }
}

/// The histogram as aligned bars, the longest of them for the bin with the most inputs.
///
/// # Errors
/// Where the writer fails.
pub fn bars(document: &SweepDocument, out: &mut impl Write) -> Result {
    let (found, unit) = (&document.statistics, &document.sweep.unit);
    let bins = found.histogram.bins();
    let most = bins.iter().map(|(_, count)| *count).max().unwrap_or(0).max(1);
    let counts = found.inputs.max(1);
    let widest = bins.iter().map(|(_, count)| thousands(*count).len()).max().unwrap_or(0);
    writeln!(out, "error in {unit}")?;
    for (name, count) in bins {
        let label = if name.starts_with(|c: char| c.is_ascii_digit()) { format!("≤ {name}") } else { name };
        let length = usize::try_from(u128::from(count) * BAR as u128 / u128::from(most)).unwrap_or(BAR);
        let bar = if count > 0 { "█".repeat(length.max(1)) } else { String::new() };
        writeln!(
            out,
            "{}",
            format!("{label:>12}  {:>widest$}  {:>9}  {bar}", thousands(count), percent(count, counts)).trim_end()
        )?;
    }
    Ok(())
}

/// Inputs a second.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a rate that is read by people"
)]
pub fn rate(document: &SweepDocument) -> u64 {
    (document.statistics.inputs as f64 / document.seconds.max(1e-9)) as u64
}

/// A margin: 1 is the end of what is legal.
#[must_use]
pub fn margin(Number(x): Number) -> String {
    if x.is_finite() { format!("{x:.4}") } else { Number(x).to_string() }
}

/// A share of a count.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "a share that is read by people")]
pub fn percent(count: u64, of: u64) -> String {
    let share = 100.0 * count as f64 / of.max(1) as f64;
    if count > 0 && share < 0.005 { "< 0.01 %".into() } else { format!("{share:.2} %") }
}
