//! A run's result for people to read.

use super::{Failure, Group, Number, Report, Totals};
use std::fmt::{Result, Write};

/// How much is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// A row for each family and stage.
    Families,
    /// A row for each group.
    Groups,
}

/// Writes the report.
///
/// # Errors
/// Where the writer fails.
pub fn write(report: &Report, detail: Detail, timing: bool, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        writeln!(out, "{:<14} {} · {} · {}", adapter.name, adapter.device, adapter.backend, adapter.driver)?;
    }
    writeln!(out)?;
    let rows = match detail {
        Detail::Families => families(&report.groups),
        Detail::Groups => report.groups.iter().map(Row::of).collect(),
    };
    table(&rows, out)?;
    for group in report.groups.iter().filter(|group| group.totals.failed > 0 || group.problem.is_some()) {
        let (failed, verdicts) = (thousands(group.totals.failed), thousands(group.totals.verdicts));
        write!(out, "\n✗ {} on {}, {}: {failed} of {verdicts} failed", group.id, group.adapter, group.stage)?;
        if let Some(problem) = &group.problem {
            write!(out, "; {problem}")?;
        }
    }
    if !report.failures.is_empty() {
        writeln!(out)?;
    }
    // One failure a formula and adapter explains more than many; the JSON has the first of every stage.
    let mut told: Vec<(&str, &str)> = vec![];
    for failure in &report.failures {
        let formula = failure.id.rsplit_once('/').map_or(failure.id.as_str(), |(formula, _)| formula);
        if !told.contains(&(formula, &failure.adapter)) {
            told.push((formula, &failure.adapter));
            writeln!(out)?;
            self::failure(failure, out)?;
        }
    }
    writeln!(out)?;
    notes(report, out)?;
    if timing {
        let t = report.timing;
        writeln!(
            out,
            "time: devices {:.2} s (their compilers included), pipelines {:.2} s, reference {:.2} s, inputs {:.2} s, \
             judging {:.2} s",
            t.devices, t.compile, t.reference, t.generate, t.judge
        )?;
    }
    verdict(report, out)
}

fn notes(report: &Report, out: &mut impl Write) -> Result {
    for deviation in &report.deviations {
        let state = if deviation.still_needed {
            "still seen, so it is granted".to_owned()
        } else {
            format!("no longer seen: take it out ({})", deviation.reason)
        };
        writeln!(
            out,
            "deviation {} on {}: {state}; {} verdicts excused",
            deviation.name,
            deviation.adapter,
            thousands(deviation.excused)
        )?;
    }
    for group in report.groups.iter().filter(|group| group.skip_reason.is_some()) {
        let reason = group.skip_reason.unwrap_or_default();
        writeln!(out, "skipped {} on {}, {}: {reason}", group.id, group.adapter, group.stage)?;
    }
    let mut told = vec![];
    for group in &report.groups {
        if let Some(target) = group.target.filter(|target| !told.contains(&(group.adapter.as_str(), *target))) {
            told.push((&group.adapter, target));
            writeln!(out, "blend unit of {}: on {target}, errors in its ULP", group.adapter)?;
        }
    }
    if !report.routes.is_empty() {
        let states: u64 = report.routes.values().filter_map(serde_json::Value::as_u64).sum();
        let routes: Vec<String> = report.routes.iter().map(|(route, states)| format!("{states} {route}")).collect();
        writeln!(
            out,
            "blend states: {} judged ({}), {} more are aliases of those",
            thousands(states),
            routes.join(", "),
            thousands(report.aliases)
        )?;
    }
    Ok(())
}

fn verdict(report: &Report, out: &mut impl Write) -> Result {
    let t = &report.totals;
    #[expect(clippy::cast_precision_loss, reason = "a share")]
    let share = 100.0 * t.indeterminate as f64 / t.verdicts.max(1) as f64;
    writeln!(
        out,
        "{} {} verdicts on {} cases: {} passed, {} failed, {} indeterminate ({share:.3} %), {} expected failures, \
         {} unexpected passes, {} cases skipped, in {:.1} s",
        if report.is_success() { "✓" } else { "✗" },
        thousands(t.verdicts),
        thousands(t.cases),
        thousands(t.passed),
        thousands(t.failed),
        thousands(t.indeterminate),
        thousands(t.expected_failures),
        thousands(t.unexpected_passes),
        thousands(t.skipped),
        report.seconds
    )
}

/// A row of the table.
struct Row {
    id: String,
    adapter: String,
    stage: &'static str,
    groups: usize,
    totals: Totals,
    error_ulp_max: f64,
    margin_max: f64,
    worst: Option<String>,
    seconds: f64,
}

impl Row {
    fn of(group: &Group) -> Self {
        Self {
            id: group.id.clone(),
            adapter: group.adapter.clone(),
            stage: group.stage,
            groups: 1,
            totals: group.totals,
            error_ulp_max: group.error_ulp_max.0,
            margin_max: group.margin_max.0,
            worst: group.worst.clone(),
            seconds: group.seconds,
        }
    }

    fn add(&mut self, other: &Self) {
        self.groups += 1;
        self.totals.add(&other.totals);
        self.error_ulp_max = self.error_ulp_max.max(other.error_ulp_max);
        if other.margin_max > self.margin_max {
            self.margin_max = other.margin_max;
            self.worst.clone_from(&other.worst);
        }
        self.seconds += other.seconds;
    }
}

fn families(groups: &[Group]) -> Vec<Row> {
    let mut rows: Vec<Row> = vec![];
    for group in groups {
        let mut row = Row::of(group);
        row.id = group.id.split('/').next().unwrap_or_default().into();
        match rows.iter_mut().find(|r| r.id == row.id && r.adapter == row.adapter && r.stage == row.stage) {
            Some(known) => known.add(&row),
            None => rows.push(row),
        }
    }
    rows
}

fn table(rows: &[Row], out: &mut impl Write) -> Result {
    let id = rows.iter().map(|row| row.id.len()).max().unwrap_or(0).max(13);
    let adapter = rows.iter().map(|row| row.adapter.len()).max().unwrap_or(0).max(8);
    writeln!(
        out,
        "{:<id$}  {:<adapter$}  {:<14} {:>8} {:>11} {:>7} {:>7} {:>9} {:>7}  nearest to its limit",
        "", "adapter", "stage", "formulas", "verdicts", "failed", "indet.", "max ULP", "margin"
    )?;
    for row in rows {
        writeln!(
            out,
            "{:<id$}  {:<adapter$}  {:<14} {:>8} {:>11} {:>7} {:>7} {:>9} {:>7.3}  {}",
            row.id,
            row.adapter,
            row.stage,
            row.groups,
            thousands(row.totals.verdicts),
            thousands(row.totals.failed),
            thousands(row.totals.indeterminate),
            short(row.error_ulp_max),
            row.margin_max,
            row.worst.as_deref().unwrap_or("—")
        )?;
    }
    Ok(())
}

/// A failure with all that is needed to understand it and to run it again.
///
/// # Errors
/// Where the writer fails.
pub fn failure(failure: &Failure, out: &mut impl Write) -> Result {
    let Failure { id, adapter, stage, output, .. } = failure;
    writeln!(out, "FAIL {id} on {adapter}, {stage}: {output}")?;
    for ((name, value), bits) in failure.inputs.iter().zip(failure.inputs_hex.values()) {
        writeln!(out, "  {name:<14} {}  {}", plain(value), plain(bits))?;
    }
    writeln!(out, "  {:<14} {}", "reference", failure.reference)?;
    writeln!(out, "  {:<14} {} to {}", "legal", failure.interval[0], failure.interval[1])?;
    if failure.unwritten {
        writeln!(out, "  {:<14} never written", "value")?;
    } else {
        let (value, bits, error) = (failure.value, &failure.value_hex, short(failure.error_ulp.0));
        writeln!(out, "  {:<14} {value}  {bits}, {error} ULP from the reference", "value")?;
    }
    writeln!(out, "  {:<14} {}", "again", failure.rerun)
}

/// JSON without quotes and commas: `[0.5 1]`.
fn plain(value: &serde_json::Value) -> String {
    match value {
        serde_json::Value::Array(values) => format!("[{}]", values.iter().map(plain).collect::<Vec<_>>().join(" ")),
        serde_json::Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// Two digits after the point, or an exponent.
fn short(x: f64) -> String {
    if x.is_finite() && x >= 1e6 {
        format!("{x:.1e}")
    } else if x.is_finite() {
        format!("{x:.2}")
    } else {
        Number(x).to_string()
    }
}

/// 1234567 as 1,234,567.
#[must_use]
pub fn thousands(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbers_are_grouped() {
        assert_eq!([0, 999, 1000, 1_234_567].map(super::thousands), ["0", "999", "1,000", "1,234,567"]);
    }
}
