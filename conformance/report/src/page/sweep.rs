//! The page on sweeps, made from their results.

use crate::sweep::{bars, likeliest, margin, rate};
use lightmeter_document::sweep::{Description, ExactFloat, SweepDocument, SweepInput, SweepVerdict};
use lightmeter_document::{Number, distance_told, error_figure, is_worse, thousands};
use std::fmt::{Result, Write};
use std::ops::Deref;

/// A finished sweep.
#[derive(Clone, Debug)]
pub struct Swept {
    /// Its result.
    pub document: SweepDocument,
    /// What its formula's ready-made sweep shows, where there is one.
    pub what: Option<&'static str>,
    /// Whether it is over the inputs of that one.
    pub is_ready_made: bool,
}

impl Deref for Swept {
    type Target = SweepDocument;

    fn deref(&self) -> &SweepDocument {
        &self.document
    }
}

/// The page in Markdown.
///
/// # Errors
/// Where the writer fails.
pub fn markdown(results: &[Swept], out: &mut impl Write) -> Result {
    writeln!(out, "# Sweeps: every float of a range, every byte of a blend mode\n")?;
    writeln!(out, "Made from the results of `lightmeter sweep`, one file each:\n\n```")?;
    for (place, result) in results.iter().enumerate() {
        writeln!(out, "./x sweep {} --format json --out {}.json", command(result), stem(results, place))?;
    }
    writeln!(out, "./x page sweep *.json --out docs/sweep.md\n```\n")?;
    let mut adapters: Vec<_> = results.iter().map(|result| &result.sweep.adapter).collect();
    adapters.dedup();
    for (place, adapter) in adapters.iter().enumerate() {
        if !adapters[..place].contains(adapter) {
            writeln!(out, "* **{}**: {}, {}, {}", adapter.name, adapter.device, adapter.backend, adapter.driver)?;
        }
    }
    writeln!(out)?;
    body(results, out)
}

/// The page but for its title and how it was made.
///
/// # Errors
/// Where the writer fails.
pub fn body(results: &[Swept], out: &mut impl Write) -> Result {
    writeln!(
        out,
        "An error is in ULP at the reference, and in steps of 1/255 where the blend unit stores. A value is *outside* where no"
    )?;
    writeln!(
        out,
        "evaluation that the rules permit gives it. The *margin* is its distance from the reference over the distance to the end of"
    )?;
    writeln!(
        out,
        "what is legal on that side, the greatest of the values that are not next to the reference, as both floats there are legal;"
    )?;
    writeln!(
        out,
        "at most 1 is legal. A range from 0 begins with −0. Errors are large where a result underflows: flushed to 0, it is legal and millions of ULP away.\n"
    )?;
    table(results, out)?;
    results.iter().try_for_each(|result| section(result, out))
}

/// What a result was asked for by, as on the command line: what its ready-made sweep says is left out.
pub(crate) fn command(result: &Swept) -> String {
    let sweep = &result.sweep;
    let mut command = sweep.formula.clone();
    if !result.is_ready_made {
        command += &options(sweep);
    }
    if sweep.stage == "fragment" {
        command += " --stage fragment";
    }
    if sweep.profile != "wgsl" {
        command += &format!(" --profile {}", sweep.profile);
    }
    if result.shard != "1/1" {
        command += &format!(" --shard {}", result.shard);
    }
    command + &format!(" --adapter {}", sweep.adapter.name)
}

/// A sweep's inputs as options of the command line.
fn options(sweep: &Description) -> String {
    let (Some(ExactFloat(from)), Some(ExactFloat(to))) = (sweep.from, sweep.to) else { return String::new() };
    let fixed: String = sweep.fixed.iter().map(|(name, ExactFloat(x))| format!(" --set {name}={x}")).collect();
    format!(" --over {} --from {from} --to {to}{fixed} --output {}", sweep.over, sweep.output)
}

/// A file's name that no other of these results has.
fn stem(results: &[Swept], place: usize) -> String {
    let named = |result: &Swept| {
        format!("{}-{}-{}", result.sweep.formula.replace('/', "-"), result.sweep.adapter.name, result.sweep.stage)
    };
    let name = named(&results[place]);
    let earlier = results[..place].iter().filter(|result| named(result) == name).count();
    if earlier == 0 { name } else { format!("{name}-{}", earlier + 1) }
}

fn table(results: &[Swept], out: &mut impl Write) -> Result {
    writeln!(
        out,
        "| formula | over | adapter, stage | inputs | outside | deviations | indeterminate | NaN | worst error | at | margin | inputs a second |"
    )?;
    writeln!(out, "|---|---|---|--:|--:|--:|--:|--:|--:|---|--:|--:|")?;
    for result in results {
        let (sweep, found) = (&result.sweep, &result.statistics);
        let worst = found.worst.map_or("".into(), |seen| format!("{} {}", error_figure(seen.error), sweep.unit));
        writeln!(
            out,
            "| {} | {} | {}, {} | {} | {} | {} | {} | {} | {worst} | {} | {} | {} |",
            sweep.formula,
            range(result),
            sweep.adapter.name,
            sweep.stage,
            thousands(found.inputs),
            thousands(found.failed),
            thousands(found.expected_failures),
            thousands(found.indeterminate),
            thousands(found.histogram.nan()),
            found.worst.map_or(String::new(), |seen| place(&seen)),
            found.nearest_to_limit.map_or("—".into(), |seen| margin(seen.margin)),
            thousands(rate(result))
        )?;
    }
    Ok(())
}

fn range(result: &Swept) -> String {
    let sweep = &result.sweep;
    let part = if result.shard == "1/1" { String::new() } else { format!(", shard {}", result.shard) };
    match (sweep.from, sweep.to) {
        (Some(ExactFloat(from)), Some(ExactFloat(to))) => {
            format!("{} from {} to {}{part}", sweep.over, Number(from.into()).narrow(), Number(to.into()).narrow())
        }
        _ => format!("{}{part}", sweep.over),
    }
}

fn place(seen: &SweepVerdict) -> String {
    match seen.input {
        SweepInput::Float(ExactFloat(x)) => format!("{} `0x{:08x}`", Number(x.into()).narrow(), x.to_bits()),
        SweepInput::Bytes { source, destination, alpha } => format!("{source}, {destination}, {alpha}"),
    }
}

fn section(result: &Swept, out: &mut impl Write) -> Result {
    let (sweep, found) = (&result.sweep, &result.statistics);
    writeln!(out, "\n## {} on {}, {}\n", sweep.formula, sweep.adapter.name, sweep.stage)?;
    let fixed: Vec<String> =
        sweep.fixed.iter().map(|(name, ExactFloat(x))| format!("{name} {}", Number((*x).into()).narrow())).collect();
    let fixed = if fixed.is_empty() { String::new() } else { format!("; {}", fixed.join(", ")) };
    let what = result.what.map_or(String::new(), |what| format!("{what}: "));
    writeln!(out, "{what}{}, output {}{fixed}.\n", range(result), sweep.output)?;
    // What is beyond its limit is not near to it.
    let is_beyond = found.nearest_to_limit.is_some_and(|seen| is_worse(seen.margin.0, 1.0));
    let nearest = if is_beyond { "Farthest beyond its limit" } else { "Nearest to its limit" };
    for (name, seen) in [("Greatest error", found.worst), (nearest, found.nearest_to_limit)] {
        if let Some(seen) = seen {
            let (ExactFloat(value), at) = (seen.value, place(&seen));
            writeln!(
                out,
                "{name}: at {at} the value is {}, the reference {}, legal {} to {}: {}, margin {}.",
                Number(value.into()).narrow(),
                seen.reference,
                seen.low.narrow(),
                seen.high.narrow(),
                distance_told(seen.error, &sweep.unit, Number(value.into()), seen.reference),
                margin(seen.margin)
            )?;
        }
    }
    for (name, count) in &found.excused {
        writeln!(out, "Deviation *{name}*: {} inputs.", thousands(*count))?;
    }
    if let Some(stored) = &found.stored {
        let (store, share) = likeliest(&stored.counts);
        let tiers = stored.tiers.named().map(|(name, count)| format!("{name} {}", thousands(count)));
        writeln!(
            out,
            "\nTiers: {}. Stored: {}, {:.2} % of the values that tell.",
            tiers.join(", "),
            store,
            100.0 * share
        )?;
        if stored.predicted > 0 {
            let (of, departing) = (thousands(stored.predicted), thousands(stored.departing));
            writeln!(out, "The device's integer model has {of} values; {departing} are another.")?;
        }
    }
    writeln!(out, "\n```")?;
    bars(result, out)?;
    writeln!(out, "```")
}
