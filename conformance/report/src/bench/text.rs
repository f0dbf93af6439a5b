//! A bench for people to read on a terminal. Tables have room in 80 columns, but for those with all figures.

use super::figures::{compilation, count, digits, error, spread, standing, time};
use crate::Level;
use crate::table::{Align, TABLE_WIDTH, TextTable};
use lightmeter_document::bench::ladder::{RungSummary, rungs};
use lightmeter_document::bench::{BenchDocument, BenchGroup, BenchRow, Family, GroupKind, Measured, Scaling};
use lightmeter_document::thousands;
use std::fmt::{Result, Write};

/// Writes the document: families, techniques and scenes as a whole, or with `details` every row of every group.
///
/// # Errors
/// Where the writer fails.
pub fn write(document: &BenchDocument, details: bool, level: Level, out: &mut impl Write) -> Result {
    let BenchDocument { command, version, seed, seconds, cores, .. } = document;
    let quick = if document.quick { "quick: fewer formulas and turns; " } else { "" };
    let head = format!("{command}: {quick}version {version}, seed {seed}, {}, {seconds:.0} s", count(*cores, "core"));
    told("", &head, out)?;
    if let Some(interrupted) = &document.interrupted {
        told("interrupted: ", &interrupted.to_string(), out)?;
    }
    for measured in &document.adapters {
        if level > Level::Quiet {
            adapter(measured, out)?;
        }
        claims(measured, out)?;
        if level == Level::Quiet {
            continue;
        }
        families(measured, out)?;
        let has_families = !measured.families.is_empty();
        if details || !has_families {
            let formulas = measured.groups.iter().filter(|group| group.kind == GroupKind::Formula);
            formulas.into_iter().try_for_each(|group| block(group, level, out))?;
        }
        let techniques = || measured.groups.iter().filter(|group| group.kind == GroupKind::Technique);
        techniques()
            .filter(|group| details || !is_stable_form(group))
            .try_for_each(|group| block(group, level, out))?;
        if !details {
            stable_forms(techniques().filter(|group| is_stable_form(group)), out)?;
        }
        scenes(measured, out)?;
        if details {
            let scenes = measured.groups.iter().filter(|group| group.kind == GroupKind::Scene);
            scenes.into_iter().try_for_each(|group| block(group, level, out))?;
        }
        scalings(measured, details, out)?;
        if !details {
            left_out(measured, out)?;
        }
    }
    if level == Level::Quiet { Ok(()) } else { legend(out) }
}

/// Whether a group holds a published form against its stable one.
pub(super) fn is_stable_form(group: &BenchGroup) -> bool {
    group.id.starts_with("stable/")
}

fn adapter(measured: &Measured, out: &mut impl Write) -> Result {
    let Measured { adapter, device, backend, driver, clock, .. } = measured;
    writeln!(out)?;
    let processor = if measured.is_cpu { " · computes on the processor" } else { "" };
    told(&format!("{adapter:<14} "), &format!("{device} · {backend} · {driver}{processor}"), out)?;
    let note = clock.note.as_ref().map(|note| format!(": {note}")).unwrap_or_default();
    let rejected = match clock.rejected {
        0 => "none rejected".to_owned(),
        n => format!("{} could not be true and are in no figure", thousands(n)),
    };
    let clock = format!("{}{note}; {} readings, {rejected}", clock.kind, thousands(clock.readings));
    told("  clock        ", &clock, out)?;
    if let Some(taken) = compilation(measured) {
        told("  compilation  ", &taken, out)?;
    }
    for rung in &measured.rungs {
        let why = rung.unavailable.as_ref().map(|why| format!(" — unavailable: {why}")).unwrap_or_default();
        told(&format!("  {:<12} ", rung.name), &format!("{}{why}", rung.what), out)?;
    }
    Ok(())
}

fn claims(measured: &Measured, out: &mut impl Write) -> Result {
    if !measured.claims.is_empty() {
        writeln!(out, "\nclaims")?;
    }
    for claim in &measured.claims {
        let mark = match claim.holds {
            Some(true) => '✓',
            Some(false) => '✗',
            None => '?',
        };
        let text = format!("{} [{}]", claim.sentence, claim.source);
        told(&format!("  {mark} "), &text, out)?;
    }
    Ok(())
}

fn families(measured: &Measured, out: &mut impl Write) -> Result {
    if measured.families.is_empty() {
        return Ok(());
    }
    let rungs_of = |family: &Family| family.rungs.iter().map(RungSummary::from).collect::<Vec<_>>();
    let rows: Vec<_> = measured.families.iter().map(|family| (&family.id, rungs_of(family), &family.front)).collect();
    let mut names: Vec<&str> = measured.rungs.iter().map(|rung| rung.name.as_str()).collect();
    for rung in measured.families.iter().flat_map(|family| &family.rungs) {
        if !names.contains(&rung.name.as_str()) {
            names.push(&rung.name);
        }
    }
    let titles = [
        "families: time over f32, the geometric mean of the formulas'",
        "families: error, the median of the formulas' largest on random inputs, absolute",
    ];
    for (place, title) in titles.into_iter().enumerate() {
        let figure = |rung: &RungSummary| if place == 0 { digits(rung.ratio) } else { error(rung.error) };
        for names in in_width(&names) {
            let rungs = names.iter().map(|name| (*name, Align::Right));
            let mut table = TextTable::new(&std::iter::once(("", Align::Left)).chain(rungs).collect::<Vec<_>>());
            for (id, rungs, front) in &rows {
                let cells = names.iter().map(|name| {
                    let rung = rungs.iter().find(|rung| rung.name == *name && rung.groups > 0);
                    let mark = if front.iter().any(|on_front| on_front == name) { "●" } else { "" };
                    rung.map_or_else(|| "—".into(), |rung| format!("{mark}{}", figure(rung)))
                });
                table.row(std::iter::once((*id).clone()).chain(cells));
            }
            write!(out, "\n{title}\n{}", table.text(""))?;
        }
    }
    for (id, rungs, _) in &rows {
        let parts: Vec<String> = rungs.iter().filter_map(shortfall).collect();
        if !parts.is_empty() {
            told(&format!("  {id:<14}"), &parts.join("; "), out)?;
        }
    }
    Ok(())
}

/// How many formulas of a family lack the rung, or are wrong at it.
fn shortfall(rung: &RungSummary) -> Option<String> {
    let counts = [(rung.disqualified, "disqualified at"), (rung.unavailable, "unavailable at")];
    let counts: Vec<String> =
        counts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{what} {}", count(*n, "formula"))).collect();
    (!counts.is_empty()).then(|| format!("{} {}", rung.name, counts.join(", ")))
}

fn column(name: &str) -> usize {
    name.chars().count().max(8) + 2
}

/// Columns side by side as they have room.
fn in_width<'a, 'b>(names: &'b [&'a str]) -> Vec<&'b [&'a str]> {
    let mut parts = vec![];
    let (mut start, mut width) = (0, 14);
    for (place, name) in names.iter().enumerate() {
        if width + column(name) > TABLE_WIDTH {
            parts.push(&names[start..place]);
            (start, width) = (place, 14);
        }
        width += column(name);
    }
    parts.push(&names[start..]);
    parts
}

/// A group with all of its rows: what they are compared by, or with more said all figures.
fn block(group: &BenchGroup, level: Level, out: &mut impl Write) -> Result {
    writeln!(out)?;
    told("", &format!("{}: {}", group.id, group.title), out)?;
    let over =
        format!("over {}, for one {}; {}; errors against {}", group.baseline, group.unit, group.work, group.ideal);
    told("  ", &over, out)?;
    let is_verbose = level == Level::Verbose;
    let columns: &[&str] = if is_verbose {
        &["time", "ratio", "spread", "", "ULP max", "p99", "mean", "absolute", "1/255", "hard ULP"]
    } else {
        &["time", "ratio", "", "ULP max", "1/255", "hard ULP"]
    };
    let names = [("", Align::Left), ("", Align::Left)];
    let mut table = TextTable::new(
        &names
            .into_iter()
            .chain(columns.iter().map(|name| (*name, if name.is_empty() { Align::Left } else { Align::Right })))
            .collect::<Vec<_>>(),
    );
    for row in &group.rows {
        table.row(cells(group, row, is_verbose));
    }
    let mut lines = table.lines().into_iter();
    lines.next().map_or(Ok(()), |heading| writeln!(out, "{heading}"))?;
    for (row, line) in group.rows.iter().zip(lines) {
        match &row.unavailable {
            Some(why) => told(&format!("— {} ", row.name), &format!("unavailable: {why}"), out)?,
            None => writeln!(out, "{line}")?,
        }
        remarks(row).iter().try_for_each(|remark| told("      ", remark, out))?;
    }
    Ok(())
}

/// The cells of a row, the mark and the name first.
fn cells(group: &BenchGroup, row: &BenchRow, is_verbose: bool) -> Vec<String> {
    let none = || "—".to_owned();
    let mark = match row {
        // It has a line of its own.
        BenchRow { unavailable: Some(_), .. } => return vec![none()],
        BenchRow { disqualified: Some(_), .. } => "✗",
        _ if group.front.contains(&row.name) => "●",
        _ => "",
    };
    let mut cells = vec![mark.to_owned(), row.name.clone()];
    match &row.time {
        Some(taken) => {
            cells.extend([time(taken.ns), digits(taken.ratio)]);
            cells.extend(is_verbose.then(|| spread(taken.spread)));
            cells.push(standing(taken).to_owned());
        }
        None => cells.extend(std::iter::once(none()).chain(vec![String::new(); if is_verbose { 3 } else { 2 }])),
    }
    match &row.random {
        Some(errors) if is_verbose => {
            let of = [&errors.ulp.max, &errors.ulp.p99, &errors.ulp.mean, &errors.absolute.max, &errors.steps.max];
            cells.extend(of.map(|figure| error(figure.0)));
        }
        Some(errors) => cells.extend([error(errors.ulp.max.0), error(errors.steps.max.0)]),
        None => cells.extend(std::iter::once(none()).chain(vec![String::new(); if is_verbose { 4 } else { 1 }])),
    }
    cells.push(row.hard.as_ref().map_or_else(none, |errors| error(errors.ulp.max.0)));
    cells
}

/// What else is to be said of a row.
fn remarks(row: &BenchRow) -> Vec<String> {
    let mut remarks = vec![];
    if let Some(why) = &row.disqualified {
        remarks.push(format!("disqualified: {why}"));
    }
    let lost: u64 = [&row.random, &row.hard].into_iter().flatten().map(|errors| errors.lost).sum();
    if lost > 0 {
        remarks.push(format!("{} values are NaN or infinite where the reference is a number", thousands(lost)));
    }
    if let Some(rounding) = &row.rounding {
        remarks.push(format!("rounding alone: {} ULP", error(rounding.ulp.max.0)));
    }
    if let Some(time) = &row.time {
        if time.rejected > 0 {
            remarks.push(format!("{} could not be true", count(time.rejected, "reading")));
        }
        remarks.extend(time.note.clone());
    }
    remarks
}

fn stable_forms<'a>(groups: impl Iterator<Item = &'a BenchGroup>, out: &mut impl Write) -> Result {
    let groups: Vec<&BenchGroup> = groups.collect();
    if groups.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nforms of hard cases, largest errors in ULP")?;
    let (left, right) = (Align::Left, Align::Right);
    let mut table = TextTable::new(&[
        ("", left),
        ("time", right),
        ("ratio", right),
        ("", left),
        ("random", right),
        ("hard", right),
    ]);
    let rows: Vec<(&BenchGroup, &BenchRow)> =
        groups.iter().flat_map(|group| group.rows.iter().map(move |row| (*group, row))).collect();
    for (_, row) in &rows {
        let [random, hard] = [&row.random, &row.hard].map(|of| of.as_ref().map(|errors| error(errors.ulp.max.0)));
        let [random, hard] = [random, hard].map(|of| of.unwrap_or_else(|| "—".into()));
        let [ns, ratio, says] = row
            .time
            .as_ref()
            .map_or_else(Default::default, |taken| [time(taken.ns), digits(taken.ratio), standing(taken).to_owned()]);
        table.row([row.name.clone(), ns, ratio, says, random, hard]);
    }
    let mut lines = table.lines().into_iter();
    lines.next().map_or(Ok(()), |heading| writeln!(out, "    {heading}"))?;
    let mut told_of = "";
    for ((group, row), line) in rows.into_iter().zip(lines) {
        if group.id != told_of {
            told_of = &group.id;
            writeln!(out, "  {}", group.id)?;
        }
        match (&row.unavailable, &row.disqualified) {
            (Some(why), _) => told("    ", &format!("{}, unavailable: {why}", row.name), out)?,
            (None, wrong) => {
                writeln!(out, "    {line}")?;
                wrong.as_ref().map_or(Ok(()), |why| told("      ✗ ", why, out))?;
            }
        }
    }
    Ok(())
}

fn scenes(measured: &Measured, out: &mut impl Write) -> Result {
    let scenes = measured.groups.iter().filter(|group| group.kind == GroupKind::Scene);
    let rungs = rungs(scenes.clone(), |errors| errors.steps.max.0);
    if rungs.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n{}, a frame each; errors of pixels in 1/255", count(scenes.count(), "scene"))?;
    let (left, right) = (Align::Left, Align::Right);
    let columns = ["scenes", "time", "ratio", "from–to", "median", "largest"].map(|name| (name, right));
    let mut table = TextTable::new(&[&[("", left)], &columns[..], &[("worst scene", left)]].concat());
    let mut lacking = vec![];
    for rung in &rungs {
        let worst = rung.points.iter().max_by(|a, b| a.2.total_cmp(&b.2));
        let ratios = || rung.points.iter().map(|point| point.1);
        let (from, to) = (ratios().fold(f64::INFINITY, f64::min), ratios().fold(0.0, f64::max));
        if let Some((id, _, largest)) = worst {
            table.row([
                rung.name.clone(),
                rung.groups.to_string(),
                time(rung.ns),
                digits(rung.ratio),
                spread([from, to]),
                error(rung.error),
                error(*largest),
                id.trim_start_matches("scene/").to_owned(),
            ]);
        }
        if worst.is_none() || rung.disqualified + rung.unavailable > 0 {
            lacking.push(format!("{}: {}", rung.name, shortfall_of_scenes(rung)));
        }
    }
    out.write_str(&table.text("  "))?;
    lacking.iter().try_for_each(|rung| told("  — ", rung, out))
}

fn shortfall_of_scenes(rung: &RungSummary) -> String {
    format!("unavailable in {}, disqualified in {}", count(rung.unavailable, "scene"), rung.disqualified)
}

fn scalings(measured: &Measured, details: bool, out: &mut impl Write) -> Result {
    if !measured.scalings.is_empty() {
        writeln!(out, "\ngrowth of time with work")?;
    }
    for scaling in &measured.scalings {
        let text = format!("{}, {} by {}: {}", scaling.what, steps(scaling), scaling.clock, law(scaling));
        told(&format!("  {:<12} ", scaling.id), &text, out)?;
        for (work, why) in &scaling.unavailable {
            told(&" ".repeat(15), &format!("{} not reached: {why}", thousands(*work)), out)?;
        }
        if details {
            for point in &scaling.points {
                let [low, high] = point.quartiles_ns.map(time);
                let (work, ns) = (thousands(point.work), time(point.ns));
                writeln!(out, "{:15}{work:>14} {:<12} {ns:>10}  {low} to {high}", "", scaling.unit)?;
            }
        }
    }
    Ok(())
}

/// `8 steps from 1 to 1,024 lights`.
pub(super) fn steps(scaling: &Scaling) -> String {
    match (scaling.points.first(), scaling.points.last()) {
        (Some(first), Some(last)) => {
            let (from, to) = (thousands(first.work), thousands(last.work));
            format!("{} from {from} to {to} ({})", count(scaling.points.len(), "step"), scaling.unit)
        }
        _ => "no step".into(),
    }
}

/// `12 µs + 3.1 ns · light^1.02`, and how far off.
pub(super) fn law(scaling: &Scaling) -> String {
    scaling.fit.as_ref().map_or_else(
        || "no law was fitted".into(),
        |fit| {
            let (fixed, factor, unit) = (time(fit.fixed_ns), time(fit.factor_ns), &scaling.unit);
            let off = 100.0 * f64::exp_m1(fit.residual);
            format!("{fixed} + {factor} · {unit}^{:.2}, off by {off:.0} % at most", fit.exponent)
        },
    )
}

/// Rows that were not measured or are wrong, but for rungs that the adapter has not: those are told at its head.
fn left_out(measured: &Measured, out: &mut impl Write) -> Result {
    let mut reasons: Vec<(String, Vec<&str>)> = vec![];
    for group in &measured.groups {
        for row in &group.rows {
            let is_told = measured.rungs.iter().any(|rung| rung.name == row.name && rung.unavailable.is_some());
            let reason = match (&row.unavailable, &row.disqualified) {
                (Some(why), _) if !is_told => format!("— {}, unavailable: {why}", row.name),
                (None, Some(why)) => format!("✗ {}, disqualified: {why}", row.name),
                _ => continue,
            };
            match reasons.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, groups)) => groups.push(&group.id),
                None => reasons.push((reason, vec![&group.id])),
            }
        }
    }
    if !reasons.is_empty() {
        writeln!(out, "\nin no figure")?;
    }
    for (reason, groups) in reasons {
        let first = groups.iter().take(3).copied().collect::<Vec<_>>().join(", ");
        let more = if groups.len() > 3 { format!(" and {} more", groups.len() - 3) } else { String::new() };
        told("  ", &format!("{reason}; {first}{more}"), out)?;
    }
    Ok(())
}

fn legend(out: &mut impl Write) -> Result {
    writeln!(out, "\n● nothing else is both faster and closer")?;
    writeln!(out, "✗ wrong in value, and in no mean · — not measured here")?;
    writeln!(out, "tie: 1 lies within the spread, which is the range of all turns of all sittings")
}

/// A line: on a terminal it is wrapped where it is shown.
pub(super) fn told(head: &str, text: &str, out: &mut impl Write) -> Result {
    writeln!(out, "{head}{text}")
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::document;
    use super::*;

    fn text(details: bool) -> String {
        let mut text = String::new();
        write(&document(), details, Level::Normal, &mut text).expect("a string takes all");
        text
    }

    #[test]
    fn tables_have_room_on_a_terminal() {
        for details in [false, true] {
            let text = text(details);
            // A line of a table has several columns; words are wrapped where they are shown.
            let columns = |line: &str| line.split("  ").filter(|cell| !cell.trim().is_empty()).count();
            let rows = text.lines().filter(|line| columns(line) >= 4);
            let widest = rows.max_by_key(|line| line.chars().count()).expect("there are tables");
            assert!(widest.chars().count() <= TABLE_WIDTH, "{} columns: {widest}", widest.chars().count());
        }
    }

    #[test]
    fn details_have_every_row_of_every_group() {
        let (document, text) = (document(), text(true));
        for measured in &document.adapters {
            let start = text.find(&format!("\n{:<14} {}", measured.adapter, measured.device)).expect("its head");
            let mut rest = &text[start..];
            let of = |kind| measured.groups.iter().filter(move |group| group.kind == kind);
            let kinds = [GroupKind::Formula, GroupKind::Technique, GroupKind::Scene];
            for group in kinds.into_iter().flat_map(of) {
                rest = &rest[rest.find(&format!("\n{}: ", group.id)).unwrap_or_else(|| panic!("no {}", group.id))..];
                let end = rest[1..].find("\n\n").unwrap_or(rest.len() - 1) + 1;
                let lines: Vec<&str> = rest[..end].lines().collect();
                for row in &group.rows {
                    let name = |line: &str| {
                        let name: String = line.chars().skip(1).collect();
                        name.trim_start().split(' ').next() == Some(&row.name)
                    };
                    let found = lines.iter().find(|line| name(line));
                    let line = found.unwrap_or_else(|| panic!("no {} in {}", row.name, group.id));
                    let mark = line.chars().next().expect("a mark");
                    let expected = match (&row.unavailable, &row.disqualified, group.front.contains(&row.name)) {
                        (Some(_), ..) => '—',
                        (_, Some(_), _) => '✗',
                        (.., true) => '●',
                        _ => ' ',
                    };
                    assert_eq!(mark, expected, "{line}");
                    if let Some(time) = &row.time {
                        assert!(line.contains(&super::time(time.ns)) && line.contains(standing(time)), "{line}");
                    }
                }
            }
        }
        assert!(text.contains("disqualified: lies outside the acceptance intervals"));
        assert!(text.contains("unavailable: no shader-f64"));
        assert!(text.contains("2 readings could not be true") && text.contains("compiled anew"));
    }

    #[test]
    fn the_short_form_tells_adapters_clocks_claims_and_what_is_left_out() {
        let text = text(false);
        for expected in [
            "timestamps; 41,234 readings, 3 could not be true",
            "wall: timestamps stood still",
            "f16          arithmetic of f16 — unavailable: the driver has no shader-f16",
            "✓ infinite takes 0.70 times as long as local",
            "✗ gamma-2.2 takes",
            "? horner takes",
            "technique/viewer: ",
            "32 scenes, a frame each",
            "90.0 µs + 300 µs · ",
            "not reached: more than a storage buffer holds",
            "no law was fitted",
            "✗ table-64, disqualified: differs from its own formula",
            "∞",
        ] {
            assert!(text.contains(expected), "no {expected:?} in\n{text}");
        }
        let left_out: Vec<&str> = text.lines().filter(|line| line.contains(", unavailable: ")).collect();
        assert!(
            left_out.iter().any(|line| line.contains("— double-float, unavailable: no double-float form")),
            "{left_out:?}"
        );
        assert!(!left_out.iter().any(|line| line.contains("f16")), "the adapter's head tells that: {left_out:?}");
        assert!(!text.contains("fog/form-05: "), "formulas are in the long form");
        assert!(text.lines().count() < 450, "{} lines", text.lines().count());
    }
}
