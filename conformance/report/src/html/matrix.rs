//! Formulas by subjects: a cell says whether it passes, and how near its values come to the edge of what is legal.

use super::card::judged;
use super::number::written as as_written;
use lightmeter_document::by_case::CaseCounts;
use lightmeter_document::cases;
use lightmeter_document::report::{Group, Report};
use lightmeter_document::{Number, error_told, thousands};
use maud::{Markup, html};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{Result, Write};

/// The greatest share of what is legal that is told from more.
const MOST_SHARE: f64 = 1_000.0;

/// A stage of a subject.
pub(super) struct Column<'a> {
    /// The subject, with the name of its result where there are several.
    subject: String,
    /// The stage, and the target of a blend unit.
    place: String,
    groups: BTreeMap<&'a str, &'a Group>,
}

/// Whether a group is wrong: a value of it, the whole, or a case that was not answered though it was to be.
pub(super) fn is_failing(group: &Group) -> bool {
    group.is_failed()
}

/// What of a group's cases was not answered though it was to be, in sentences.
pub(super) fn unanswered(counts: &CaseCounts) -> Option<String> {
    let said: Vec<String> =
        [(counts.totals.missing, "never answered"), (counts.totals.undeclared, "skipped without having been declared")]
            .into_iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, what)| {
                let was = if count == 1 { "was" } else { "were" };
                format!("{} of {} {was} {what}.", thousands(count), cases(counts.totals.asked))
            })
            .collect();
    (!said.is_empty()).then(|| said.join(" "))
}

/// The columns of results.
pub(super) fn columns<'a>(reports: &[(&str, &'a Report)]) -> Vec<Column<'a>> {
    let mut columns: Vec<Column<'a>> = vec![];
    for (name, report) in reports {
        for adapter in &report.adapters {
            let mut own: Vec<Column<'a>> = vec![];
            for group in report.groups.iter().filter(|group| group.adapter == adapter.name) {
                // A scene's target is its own: all scenes share a column.
                let is_scene = group.id.starts_with("scene/");
                let place = if is_scene { group.stage.to_string() } else { group.place() };
                let column = match own.iter_mut().find(|column| column.place == place) {
                    Some(column) => column,
                    None => {
                        let subject =
                            if name.is_empty() { adapter.name.clone() } else { format!("{name}: {}", adapter.name) };
                        own.push(Column { subject, place, groups: BTreeMap::new() });
                        own.last_mut().unwrap_or_else(|| unreachable!("it was just added"))
                    }
                };
                column.groups.insert(&group.id, group);
            }
            columns.extend(own);
        }
    }
    columns
}

/// The ids of all rows, in the order of the first result.
fn ids<'a>(columns: &[Column<'a>]) -> Vec<&'a str> {
    columns.iter().flat_map(|column| column.groups.keys().copied()).collect::<BTreeSet<_>>().into_iter().collect()
}

fn family(id: &str) -> &str {
    id.split('/').next().unwrap_or_default()
}

/// What a cell is: its class, what it shows, and what it says in full.
fn cell(group: &Group) -> (&'static str, String, String) {
    let totals = &group.totals;
    if let Some(reason) = not_had(group) {
        return ("skip", String::new(), reason);
    }
    if let Some(reason) = &group.skip_reason {
        return ("skip", "–".into(), format!("skipped: {reason}"));
    }
    let (number, error) = (share(group.margin_max), error_told(group.error_ulp_max, unit(group)));
    let says = format!("{} cases; greatest error {error}, {number} of what is legal", thousands(totals.cases));
    if is_failing(group) {
        let not_answered = group.by_case.as_ref().filter(|_| totals.failed == 0 && group.problems.is_empty());
        if let Some(says) = not_answered.and_then(unanswered) {
            return ("fail", "✗".into(), says);
        }
        let (failed, of) = judged(group);
        let what = match totals.failed {
            0 => "as a whole it fails".into(),
            _ => format!("{} of {} fail", thousands(failed), thousands(of)),
        };
        return ("fail", format!("✗ {number}"), format!("{what}; {says}"));
    }
    if totals.expected_failures > 0 || !group.expected_problems.is_empty() {
        let what = match totals.expected_failures {
            0 => "as a whole it fails as known".into(),
            count => format!("{} fail as known", thousands(count)),
        };
        return ("known", format!("≈ {number}"), format!("{what}; {says}"));
    }
    if totals.verdicts == 0 {
        let reason =
            group.by_case.as_ref().and_then(|counts| counts.reason.as_deref()).unwrap_or("no reason was given");
        return ("skip", "–".into(), format!("skipped: {reason}"));
    }
    if totals.verdicts == totals.indeterminate {
        return ("skip", "?".into(), "the accuracy rules permit anything".into());
    }
    ("pass", number, says)
}

/// Why a group is no cell of its subject: it was not asked, since the subject does not have it.
fn not_had(group: &Group) -> Option<String> {
    let counts = group.asked().filter(|_| group.is_not_asked())?;
    let reason = counts.reason.as_deref().or(group.skip_reason.as_deref()).unwrap_or("no reason was given");
    Some(format!("not asked: {reason}"))
}

/// What errors are counted in.
fn unit(group: &Group) -> &'static str {
    if group.target.as_deref().is_some_and(|target| target.contains('8')) { "steps" } else { "ULP" }
}

/// The greatest error as a share of what is legal. How far beyond a thousand it goes tells nobody anything.
fn share(margin: Number) -> String {
    match margin.0 {
        0.0 => "0".into(),
        beyond if beyond > MOST_SHARE => "> 1,000".into(),
        other => short(other),
    }
}

/// A number in about three digits, with a minus sign where it is negative.
pub(super) fn short(x: f64) -> String {
    let written = match x.abs() {
        _ if !x.is_finite() => Number(x).to_string(),
        0.0 => "0".into(),
        small if small < 0.001 => format!("{x:.1e}"),
        small if small < 10.0 => format!("{x:.2}"),
        middle if middle < 100.0 => format!("{x:.1}"),
        middle if middle < 1e5 => format!("{x:.0}"),
        _ => format!("{x:.2e}"),
    };
    let is_decimal = written.contains('.') && !written.contains('e');
    let written = if is_decimal { written.trim_end_matches('0').trim_end_matches('.') } else { &written };
    as_written(written)
}

/// The filters, whose state the page keeps in its address.
pub(super) fn filters(columns: &[Column<'_>]) -> Markup {
    let families: BTreeSet<&str> = ids(columns).into_iter().map(family).collect();
    let subjects: BTreeSet<&str> = columns.iter().map(|column| column.subject.as_str()).collect();
    html! {
        form #filters role="search" {
            label { "Name " input #q type="search" name="q" autocomplete="off" placeholder="fog, blinn …"; }
            label { "Show " select name="show" {
                option value="" { "all" }
                option value="fail" { "what fails" }
                option value="known" { "known failures" }
                option value="pass" { "what passes" }
                option value="skip" { "what was skipped" }
            } }
            label { "Family " select name="family" {
                option value="" { "all" }
                @for family in families { option { (family) } }
            } }
            @if subjects.len() > 1 {
                label { "Subject " select name="subject" {
                    option value="" { "all" }
                    @for subject in &subjects { option { (subject) } }
                } }
            }
            output #count role="status" {}
        }
    }
}

/// The table. Cells that fail lead to their cards, where the page has them.
pub(super) fn table(columns: &[Column<'_>], has_cards: bool) -> Markup {
    let mut subjects: Vec<(&str, usize)> = vec![];
    for column in columns {
        match subjects.last_mut().filter(|(name, _)| *name == column.subject) {
            Some((_, count)) => *count += 1,
            None => subjects.push((&column.subject, 1)),
        }
    }
    html! {
        div.wide tabindex="0" role="group" aria-label="all formulas" {
            table #matrix {
                thead {
                    tr { th rowspan="2" scope="col" { "formula" } @for (subject, count) in &subjects { th colspan=(count) scope="colgroup" data-subject=(subject) { (subject) } } }
                    tr { @for column in columns { th scope="col" data-subject=(column.subject) { (column.place) } } }
                }
                tbody {
                    @for id in ids(columns) {
                        tr data-family=(family(id)) {
                            th scope="row" { (broken(id)) }
                            @for column in columns { (told(id, column, has_cards)) }
                        }
                    }
                }
            }
        }
        p.hint { "The number of a cell is the greatest error as a share of what is legal: 1 is the edge. ✗ fails, ≈ fails as is known, – was skipped, ? may be anything; an empty cell was not asked. A cell's title has how many cases there are, and how many fail." }
    }
}

/// An id that a narrow window breaks behind a slash.
fn broken(id: &str) -> Markup {
    html! { @for (place, part) in id.split('/').enumerate() { @if place > 0 { "/" wbr; } (part) } }
}

fn told(id: &str, column: &Column<'_>, has_cards: bool) -> Markup {
    let Some(group) = column.groups.get(id) else {
        return html! { td title="this result does not have it" data-subject=(column.subject) {} };
    };
    let (class, shows, says) = cell(group);
    let card = (has_cards && class == "fail").then(|| card_id(id, &group.adapter));
    html! {
        td class=(class) title=(says) data-subject=(column.subject) {
            @if let Some(card) = card { a href={ "#" (card) } { (shows) } } @else { (shows) }
        }
    }
}

/// The name of the card of a group that fails.
pub(super) fn card_id(id: &str, adapter: &str) -> String {
    let plain = |text: &str| text.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect::<String>();
    format!("fails-{}-{}", plain(id), plain(adapter))
}

/// The table in Markdown: the counts of each family, and each formula that fails, is expected to, or was skipped somewhere.
pub(super) fn write_markdown(columns: &[Column<'_>], out: &mut impl Write) -> Result {
    writeln!(out, "# Formulas by subjects\n")?;
    writeln!(
        out,
        "Each cell has how many formulas pass, of those that were judged. It is empty where the subject has none of the family.\n"
    )?;
    write!(out, "| family |")?;
    columns.iter().try_for_each(|column| write!(out, " {}, {} |", column.subject, column.place))?;
    writeln!(out, "\n|---|{}", "--:|".repeat(columns.len()))?;
    let ids = ids(columns);
    let families: BTreeSet<&str> = ids.iter().map(|id| family(id)).collect();
    for name in families {
        write!(out, "| {name} |")?;
        for column in columns {
            let own: Vec<&&Group> =
                column.groups.values().filter(|group| family(&group.id) == name && not_had(group).is_none()).collect();
            let passing = own.iter().filter(|group| cell(group).0 == "pass").count();
            if own.is_empty() { write!(out, " |")? } else { write!(out, " {passing}/{} |", own.len())? }
        }
        writeln!(out)?;
    }
    let is_told = |id: &&&str| {
        columns
            .iter()
            .filter_map(|column| column.groups.get(**id))
            .any(|group| !matches!(cell(group).0, "pass" | "skip"))
    };
    let told: Vec<&&str> = ids.iter().filter(is_told).collect();
    if told.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n## What fails\n")?;
    writeln!(
        out,
        "A number is the greatest error as a share of what is legal: 1 is the edge. ✗ fails, ≈ fails as is known.\n"
    )?;
    write!(out, "| formula |")?;
    columns.iter().try_for_each(|column| write!(out, " {}, {} |", column.subject, column.place))?;
    writeln!(out, "\n|---|{}", "--:|".repeat(columns.len()))?;
    for id in told {
        write!(out, "| {id} |")?;
        for column in columns {
            write!(out, " {} |", column.groups.get(id).map_or_else(String::new, |group| cell(group).1))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_document::by_case::CaseTotals;
    use lightmeter_document::report::Totals;

    fn cell_of(verdicts: u64, counts: CaseCounts) -> (&'static str, String, String) {
        let totals = Totals { cases: counts.totals.asked, verdicts, ..Totals::default() };
        cell(&Group { totals, by_case: Some(counts), ..Group::new("fog/exp".into(), "renderer".into(), "answer") })
    }

    #[test]
    fn what_was_not_answered_or_not_asked_does_not_pass() {
        let missing = cell_of(
            0,
            CaseCounts {
                totals: CaseTotals { asked: 3, missing: 3, ..CaseTotals::default() },
                ..CaseCounts::default()
            },
        );
        assert_eq!(missing, ("fail", "✗".into(), "3 of 3 cases were never answered.".into()));
        let partly = cell_of(
            2,
            CaseCounts {
                totals: CaseTotals { asked: 3, passed: 2, missing: 1, ..CaseTotals::default() },
                ..CaseCounts::default()
            },
        );
        assert_eq!(partly, ("fail", "✗".into(), "1 of 3 cases was never answered.".into()));
        let reason = Some("the renderer does not declare it".to_owned());
        let not_asked = cell_of(
            0,
            CaseCounts {
                totals: CaseTotals { not_asked: 3, ..CaseTotals::default() },
                reason,
                ..CaseCounts::default()
            },
        );
        assert_eq!(not_asked, ("skip", String::new(), "not asked: the renderer does not declare it".into()));
        let passing = cell_of(
            3,
            CaseCounts { totals: CaseTotals { asked: 3, passed: 3, ..CaseTotals::default() }, ..CaseCounts::default() },
        );
        assert_eq!((passing.0, passing.1.as_str()), ("pass", "0"));
    }

    /// What stands in a cell, and in its title, of a group whose greatest error is this share of what is legal.
    fn told_of(margin: f64, failed: u64, expected: u64) -> (String, String) {
        let totals = Totals { cases: 9, verdicts: 9, failed, expected_failures: expected, ..Totals::default() };
        let group = Group {
            totals,
            margin_max: Number(margin),
            error_ulp_max: Number(7.134e44),
            ..Group::new("fog/exp".into(), "lavapipe".into(), "compute")
        };
        let (_, shows, says) = cell(&group);
        (shows, says)
    }

    #[test]
    fn the_number_of_every_cell_is_a_share_of_what_is_legal_and_counts_are_in_its_title() {
        let (fails, says) = told_of(3.25, 2, 0);
        assert_eq!(fails, "✗ 3.25");
        assert!(says.starts_with("2 of 9 fail; ") && says.contains("more than 2²⁴ ULP"), "{says}");
        let (known, says) = told_of(2e43, 0, 4);
        assert_eq!(known, "≈ > 1,000");
        assert!(says.starts_with("4 fail as known; "), "{says}");
        assert_eq!(told_of(0.5, 0, 0).0, "0.5");
    }

    #[test]
    fn formulas_that_a_renderer_does_not_have_are_counted_nowhere() {
        let reason = Some("the renderer does not declare it".to_owned());
        let counts = CaseCounts {
            totals: CaseTotals { not_asked: 3, ..CaseTotals::default() },
            reason,
            ..CaseCounts::default()
        };
        let lacks = Group { by_case: Some(counts), ..Group::new("fog/exp".into(), "renderer".into(), "answer") };
        let totals = Totals { cases: 1, verdicts: 1, ..Totals::default() };
        let has = Group { totals, ..Group::new("vector/dot".into(), "renderer".into(), "answer") };
        let groups = BTreeMap::from([("fog/exp", &lacks), ("vector/dot", &has)]);
        let column = Column { subject: "r".into(), place: "answer".into(), groups };
        let mut text = String::new();
        write_markdown(&[column], &mut text).expect("a string takes all");
        assert!(text.contains("| fog | |\n") && text.contains("| vector | 1/1 |\n"), "{text}");
    }
}
