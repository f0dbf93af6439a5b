//! The probes of NaN, infinity, subnormals and signed zero, for people to read.

use lightmeter_document::report::Identity;
use lightmeter_document::special::{
    ProbeClass, ProbeResult, ProbeRow, ProbeSource, ProbeVerdict, SpecialDeviation, SpecialReport,
};
use std::fmt::{Result, Write};

/// Writes the report: a row for each probe, a column for each adapter.
///
/// # Errors
/// Where the writer fails.
pub fn write(report: &SpecialReport, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        writeln!(out, "{:<14} {} · {} · {}", adapter.name, adapter.device, adapter.backend, adapter.driver)?;
        match report.records.iter().find(|record| record.adapter == adapter.name) {
            None => writeln!(out, "{:<14} nothing is on record: its results are shown", "")?,
            Some(record) if record.binds => writeln!(out, "{:<14} on record: another result fails", "")?,
            Some(record) => {
                writeln!(out, "{:<14} compared with the record of {}, which does not bind it", "", record.of)?;
            }
        }
    }
    for class in &report.classes {
        writeln!(out)?;
        table(report, class, out)?;
    }
    writeln!(
        out,
        "\na / b: in the compute and in the fragment stage · ✗ not as promised · ! the same, as a deviation says · ≠ not as on \
         record"
    )?;
    for ProbeSource { section, says } in &report.sources {
        writeln!(out, "{section}: {says}")?;
    }
    for SpecialDeviation { name, backend, reason, .. } in &report.deviations {
        if report.adapters.iter().any(|adapter| adapter.backend == *backend) {
            writeln!(out, "deviation {name} on {backend}: {reason}")?;
        }
    }
    for skipped in &report.skipped {
        writeln!(out, "skipped {} on {}: {}", skipped.stage, skipped.adapter, skipped.reason)?;
    }
    for outcome in &report.outcomes {
        if let Some(line) = failure(report, outcome) {
            writeln!(out, "{line}")?;
        }
    }
    if let Some(interrupted) = &report.interrupted {
        writeln!(out, "interrupted: {interrupted}")?;
    }
    verdict(report, out)
}

fn table(report: &SpecialReport, class: &ProbeClass, out: &mut impl Write) -> Result {
    let mut rows: Vec<Vec<String>> = vec![vec![class.title.to_string(), "computed".into(), "promised".into()]];
    rows[0].extend(report.adapters.iter().map(|adapter| adapter.name.clone()));
    for probe in report.of_class(class) {
        let mut row = vec![probe.name.to_string(), probe.what.to_string(), probe.promise.clone()];
        row.extend(report.adapters.iter().map(|adapter| cell(report, probe, adapter)));
        rows.push(row);
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or_default();
    let widths: Vec<usize> = (0..rows[0].len()).map(width).collect();
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:<width$}")).collect();
        writeln!(out, "{}", cells.join("  ").trim_end())?;
    }
    Ok(())
}

/// What an adapter gives, once where all stages agree.
fn cell(report: &SpecialReport, probe: &ProbeRow, adapter: &Identity) -> String {
    let marked = |outcome: &ProbeResult| match outcome.verdict {
        ProbeVerdict::Broken => format!("✗ {}", outcome.value),
        ProbeVerdict::Deviates => format!("! {}", outcome.value),
        _ if outcome.recorded.is_some_and(|recorded| recorded != outcome.bits) => format!("≠ {}", outcome.value),
        _ => outcome.value.clone(),
    };
    let mut words: Vec<String> = report.of(&probe.name, &adapter.name).map(marked).collect();
    words.dedup();
    if words.is_empty() { "—".into() } else { words.join(" / ") }
}

fn verdict(report: &SpecialReport, out: &mut impl Write) -> Result {
    let count = |verdict| report.outcomes.iter().filter(|outcome| outcome.verdict == verdict).count();
    let differ = |o: &&ProbeResult| o.recorded.is_some_and(|recorded| recorded != o.bits);
    writeln!(
        out,
        "{} {} probes, {} results: {} as promised, {} promises broken, {} deviate, {} indeterminate, {} changed; \
         {} are not as on record",
        if report.is_success() { "✓" } else { "✗" },
        report.probes.len(),
        report.outcomes.len(),
        count(ProbeVerdict::Kept),
        count(ProbeVerdict::Broken),
        count(ProbeVerdict::Deviates),
        count(ProbeVerdict::Indeterminate),
        count(ProbeVerdict::Changed),
        report.outcomes.iter().filter(differ).count()
    )
}

/// A failure in a line.
fn failure(report: &SpecialReport, outcome: &ProbeResult) -> Option<String> {
    let probe = report.probe(&outcome.probe)?;
    let ProbeResult { adapter, stage, bits, value, .. } = outcome;
    let is = format!("{} on {adapter}, {stage}: {} is {value} (0x{bits:08x})", probe.name, probe.what);
    match outcome.verdict {
        ProbeVerdict::Broken => Some(format!("BROKEN {is}, where {} promises {}", probe.source, probe.promise)),
        ProbeVerdict::Changed => {
            let recorded = outcome.recorded.unwrap_or_default();
            let whose = report.records.iter().find(|record| record.adapter == *adapter).map(|record| &record.of);
            let whose = whose.map_or("the driver", String::as_str);
            let word = outcome.recorded_value.as_deref().unwrap_or("the word");
            Some(format!("CHANGED {is}, where {whose} is on record with {word} (0x{recorded:08x})"))
        }
        ProbeVerdict::Kept | ProbeVerdict::Indeterminate | ProbeVerdict::Deviates => None,
    }
}
