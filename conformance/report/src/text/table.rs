//! The table of families or groups.

use super::Detail;
use super::failure::unit_on;
use crate::Level;
use crate::table::{Align, TextTable};
use lightmeter_document::by_case::CaseTotals;
use lightmeter_document::report::{Group, Report, Totals};
use lightmeter_document::{Number, Word, error_told, is_worse, thousands, worse};
use std::fmt::{Result, Write};

/// A row of the table.
struct TableRow {
    id: String,
    adapter: String,
    stage: Word,
    groups: usize,
    totals: Totals,
    error_ulp_max: f64,
    unit: &'static str,
    margin_max: f64,
    worst: Option<String>,
    seconds: f64,
}

impl TableRow {
    fn of(group: &Group) -> Self {
        Self {
            id: group.id.clone(),
            adapter: group.adapter.clone(),
            // A blend unit is told by its target.
            stage: group.target.as_ref().filter(|_| group.image.is_none()).unwrap_or(&group.stage).clone(),
            groups: 1,
            totals: group.totals,
            error_ulp_max: group.error_ulp_max.0,
            unit: unit_on(group.target.as_deref()),
            margin_max: group.margin_max.0,
            worst: group.worst.clone(),
            seconds: group.seconds,
        }
    }

    fn add(&mut self, other: &Self) {
        self.groups += 1;
        self.totals.add(&other.totals);
        self.error_ulp_max = worse(self.error_ulp_max, other.error_ulp_max);
        if is_worse(other.margin_max, self.margin_max) {
            self.margin_max = other.margin_max;
            self.worst.clone_from(&other.worst);
        }
        self.seconds += other.seconds;
    }
}

/// Writes a row for each family and stage, or for each group.
pub(super) fn judged(report: &Report, detail: Detail, level: Level, out: &mut impl Write) -> Result {
    let rows = match detail {
        Detail::Families => families(&report.groups),
        Detail::Groups => report.groups.iter().map(TableRow::of).collect(),
    };
    if rows.is_empty() { Ok(()) } else { table(&rows, report.adapters.len() > 1, level, out) }
}

fn families(groups: &[Group]) -> Vec<TableRow> {
    let mut rows: Vec<TableRow> = vec![];
    for group in groups {
        let mut row = TableRow::of(group);
        row.id = group.id.split('/').next().unwrap_or_default().into();
        match rows.iter_mut().find(|r| r.id == row.id && r.adapter == row.adapter && r.stage == row.stage) {
            Some(known) => known.add(&row),
            None => rows.push(row),
        }
    }
    rows
}

fn table(rows: &[TableRow], has_adapters: bool, level: Level, out: &mut impl Write) -> Result {
    let (left, right) = (Align::Left, Align::Right);
    let mut columns = vec![("", left), ("family", left), ("adapter", left), ("stage", left)];
    columns.extend([("formulas", right), ("verdicts", right), ("failed", right)]);
    if !has_adapters {
        columns.remove(2);
    }
    let mut table = TextTable::new(&columns);
    for row in rows {
        let (verdicts, failed) = (row.totals.verdicts, row.totals.failed);
        let mark = match (failed + row.totals.failed_groups, verdicts) {
            (0, 0) => '–',
            (0, _) => '✓',
            _ => '✗',
        };
        let mut cells = vec![mark.to_string(), row.id.clone(), row.adapter.clone(), row.stage.to_string()];
        cells.extend([row.groups.to_string(), thousands(verdicts), thousands(failed)]);
        if !has_adapters {
            cells.remove(2);
        }
        table.row(cells);
    }
    let mut lines = table.lines().into_iter();
    lines.next().map_or(Ok(()), |heading| writeln!(out, "{heading}"))?;
    for (row, line) in rows.iter().zip(lines) {
        writeln!(out, "{line}")?;
        if level == Level::Verbose
            && let Some(worst) = &row.worst
        {
            let (margin, error) = (short(100.0 * row.margin_max), error_told(Number(row.error_ulp_max), row.unit));
            writeln!(out, "    {worst} takes {margin} % of its tolerance, the largest error is {error}")?;
        }
    }
    Ok(())
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

/// A line for each family of a renderer, counted by cases.
pub(super) fn asked(report: &Report, level: Level, out: &mut impl Write) -> Result {
    let family = |group: &Group| group.id.split('/').next().unwrap_or_default().to_owned();
    let groups: Vec<(&Group, CaseTotals)> = (report.groups.iter())
        .filter_map(|group| Some((group, group.by_case.as_ref()?.totals)))
        .filter(|(_, totals)| totals.asked > 0)
        .collect();
    let mut names: Vec<String> = vec![];
    for (group, _) in &groups {
        if !names.contains(&family(group)) {
            names.push(family(group));
        }
    }
    let (left, right) = (Align::Left, Align::Right);
    let mut table = TextTable::new(&[("", left), ("", left), ("", right), ("", left), ("", right), ("", left)]);
    for name in names {
        let of: Vec<&(&Group, CaseTotals)> = groups.iter().filter(|(group, _)| family(group) == name).collect();
        let mut sum = CaseTotals::default();
        of.iter().for_each(|(_, totals)| sum.add(totals));
        let CaseTotals { asked, failed, missing, skipped, .. } = sum;
        let failing = of.iter().filter(|(group, _)| group.is_failed()).count();
        let judged = asked.saturating_sub(skipped).saturating_sub(missing);
        let mark = match (failing, judged) {
            (0, 0) => "–",
            (0, _) => "✓",
            _ => "✗",
        };
        let whats = match name.as_str() {
            "scene" => ["scene", "scenes"],
            "special" => ["table", "tables"],
            _ => ["formula", "formulas"],
        };
        let mut notes = vec![];
        if failing > 0 {
            let fail = if failed == 1 { "fails" } else { "fail" };
            notes.push(format!("{} {fail} in {failing} {}", thousands(failed), whats[usize::from(failing != 1)]));
        }
        if missing > 0 {
            notes.push(format!("{} never answered", thousands(missing)));
        }
        if judged == 0 {
            notes.push("none judged".into());
        } else if level == Level::Verbose && failing == 0 {
            let error = of.iter().map(|(group, _)| group.error_ulp_max.0).fold(0.0, worse);
            let margin = of.iter().map(|(group, _)| group.margin_max.0).fold(0.0, worse);
            let unit = if name == "scene" { "ULP or steps" } else { "ULP" };
            let error = error_told(Number(error), unit);
            notes.push(format!("errors up to {error}, {} % of what is legal", short(100.0 * margin)));
        }
        let count = format!("{} {}", of.len(), whats[usize::from(of.len() != 1)]);
        table.row([mark.into(), name, thousands(asked), "cases".into(), count, notes.join(", ")]);
    }
    out.write_str(&table.text(""))
}
