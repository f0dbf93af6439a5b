//! A bench for people to read on a terminal, 120 columns wide.

use super::figures::{compilation, count, digits, error, spread, standing, time};
use lightmeter_document::bench::ladder::{RungSummary, rungs};
use lightmeter_document::bench::{BenchDocument, BenchGroup, BenchRow, Family, GroupKind, Measured, Scaling};
use lightmeter_document::thousands;
use std::fmt::{Result, Write};

/// Columns of the terminal.
const WIDTH: usize = 120;
/// Columns of a row's name; a longer one has a line of its own.
const NAME: usize = 22;

/// Writes the document: families, techniques and scenes as a whole, or with `details` every row of every group.
///
/// # Errors
/// Where the writer fails.
pub fn write(document: &BenchDocument, details: bool, out: &mut impl Write) -> Result {
    let BenchDocument { command, version, seed, seconds, cores, .. } = document;
    let quick = if document.quick { "quick: fewer formulas and turns; " } else { "" };
    let head = format!("{command}: {quick}version {version}, seed {seed}, {}, {seconds:.0} s", count(*cores, "core"));
    wrapped("", "  ", &head, out)?;
    if let Some(interrupted) = &document.interrupted {
        wrapped("interrupted: ", "  ", &interrupted.to_string(), out)?;
    }
    for measured in &document.adapters {
        adapter(measured, out)?;
        claims(measured, out)?;
        families(measured, out)?;
        let has_families = !measured.families.is_empty();
        if details || !has_families {
            let formulas = measured.groups.iter().filter(|group| group.kind == GroupKind::Formula);
            formulas.into_iter().try_for_each(|group| block(group, out))?;
        }
        let techniques = || measured.groups.iter().filter(|group| group.kind == GroupKind::Technique);
        techniques().filter(|group| details || !is_stable_form(group)).try_for_each(|group| block(group, out))?;
        if !details {
            stable_forms(techniques().filter(|group| is_stable_form(group)), out)?;
        }
        scenes(measured, out)?;
        if details {
            let scenes = measured.groups.iter().filter(|group| group.kind == GroupKind::Scene);
            scenes.into_iter().try_for_each(|group| block(group, out))?;
        }
        scalings(measured, details, out)?;
        if !details {
            left_out(measured, out)?;
        }
    }
    legend(out)
}

/// Whether a group holds a published form against its stable one.
pub(super) fn is_stable_form(group: &BenchGroup) -> bool {
    group.id.starts_with("stable/")
}

fn adapter(measured: &Measured, out: &mut impl Write) -> Result {
    let Measured { adapter, device, backend, driver, clock, .. } = measured;
    writeln!(out)?;
    let processor = if measured.is_cpu { " · computes on the processor" } else { "" };
    wrapped(&format!("{adapter:<14} "), &" ".repeat(15), &format!("{device} · {backend} · {driver}{processor}"), out)?;
    let note = clock.note.as_ref().map(|note| format!(": {note}")).unwrap_or_default();
    let rejected = match clock.rejected {
        0 => "none rejected".to_owned(),
        n => format!("{} could not be true and are in no figure", thousands(n)),
    };
    let clock = format!("{}{note}; {} readings, {rejected}", clock.kind, thousands(clock.readings));
    wrapped("  clock        ", &" ".repeat(15), &clock, out)?;
    if let Some(told) = compilation(measured) {
        wrapped("  compilation  ", &" ".repeat(15), &told, out)?;
    }
    for rung in &measured.rungs {
        let why = rung.unavailable.as_ref().map(|why| format!(" — unavailable: {why}")).unwrap_or_default();
        wrapped(&format!("  {:<12} ", rung.name), &" ".repeat(15), &format!("{}{why}", rung.what), out)?;
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
        wrapped(&format!("  {mark} "), "    ", &text, out)?;
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
            writeln!(out, "\n{title}")?;
            write!(out, "{:<14}", "")?;
            names.iter().try_for_each(|name| write!(out, "{name:>width$}", width = column(name)))?;
            writeln!(out)?;
            for (id, rungs, front) in &rows {
                write!(out, "{id:<14}")?;
                for name in names {
                    let rung = rungs.iter().find(|rung| rung.name == *name && rung.groups > 0);
                    let mark = if front.iter().any(|on_front| on_front == name) { "●" } else { "" };
                    let cell = rung.map_or_else(|| "—".into(), |rung| format!("{mark}{}", figure(rung)));
                    write!(out, "{cell:>width$}", width = column(name))?;
                }
                writeln!(out)?;
            }
        }
    }
    for (id, rungs, _) in &rows {
        let parts: Vec<String> = rungs.iter().filter_map(shortfall).collect();
        if !parts.is_empty() {
            wrapped(&format!("  {id:<14}"), &" ".repeat(16), &parts.join("; "), out)?;
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
        if width + column(name) > WIDTH {
            parts.push(&names[start..place]);
            (start, width) = (place, 14);
        }
        width += column(name);
    }
    parts.push(&names[start..]);
    parts
}

/// A group with all of its rows.
fn block(group: &BenchGroup, out: &mut impl Write) -> Result {
    writeln!(out)?;
    wrapped("", "  ", &format!("{}: {}", group.id, group.title), out)?;
    let over =
        format!("over {}, for one {}; {}; errors against {}", group.baseline, group.unit, group.work, group.ideal);
    wrapped("  ", "  ", &over, out)?;
    writeln!(
        out,
        "  {:<NAME$} {:>8} {:>7} {:>13} {:<8} {:>8} {:>8} {:>8} {:>8} {:>7} {:>8}",
        "", "time", "ratio", "spread", "", "ULP max", "p99", "mean", "absolute", "1/255", "hard ULP"
    )?;
    group.rows.iter().try_for_each(|row| line(group, row, out))
}

fn line(group: &BenchGroup, row: &BenchRow, out: &mut impl Write) -> Result {
    let is_on_front = group.front.contains(&row.name);
    let mark = match row {
        BenchRow { unavailable: Some(_), .. } => '—',
        BenchRow { disqualified: Some(_), .. } => '✗',
        _ if is_on_front => '●',
        _ => ' ',
    };
    if let Some(why) = &row.unavailable {
        return wrapped(&format!("{mark} {:<NAME$} ", row.name), "      ", &format!("unavailable: {why}"), out);
    }
    if row.name.chars().count() > NAME {
        writeln!(out, "{mark} {}", row.name)?;
        write!(out, "  {:<NAME$}", "")?;
    } else {
        write!(out, "{mark} {:<NAME$}", row.name)?;
    }
    match &row.time {
        Some(taken) => {
            let (ns, ratio, from_to) = (time(taken.ns), digits(taken.ratio), spread(taken.spread));
            write!(out, " {ns:>8} {ratio:>7} {from_to:>13} {:<8}", standing(taken))?;
        }
        None => write!(out, " {:>8} {:>7} {:>13} {:<8}", "—", "", "", "")?,
    }
    match &row.random {
        Some(errors) => {
            let ulp = [errors.ulp.max, errors.ulp.p99, errors.ulp.mean, errors.absolute.max].map(|of| error(of.0));
            ulp.iter().try_for_each(|figure| write!(out, " {figure:>8}"))?;
            write!(out, " {:>7}", error(errors.steps.max.0))?;
        }
        None => write!(out, " {:>8} {:>8} {:>8} {:>8} {:>7}", "—", "", "", "", "")?,
    }
    writeln!(out, " {:>8}", row.hard.as_ref().map_or_else(|| "—".into(), |errors| error(errors.ulp.max.0)))?;
    remarks(row).iter().try_for_each(|remark| wrapped("      ", "      ", remark, out))
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
    writeln!(out, "{:<57} {:>8} {:>7} {:>13} {:<8} {:>9} {:>9}", "", "time", "ratio", "spread", "", "random", "hard")?;
    for group in groups {
        for (place, row) in group.rows.iter().enumerate() {
            let id = if place == 0 { &group.id } else { "" };
            if let Some(why) = &row.unavailable {
                wrapped(
                    &format!("  {id:<28} {:<26} ", row.name),
                    &" ".repeat(31),
                    &format!("unavailable: {why}"),
                    out,
                )?;
                continue;
            }
            let [random, hard] = [&row.random, &row.hard].map(|of| of.as_ref().map(|errors| error(errors.ulp.max.0)));
            let [random, hard] = [random, hard].map(|of| of.unwrap_or_else(|| "—".into()));
            let [ns, ratio, from_to, says] = row.time.as_ref().map_or_else(Default::default, |taken| {
                [time(taken.ns), digits(taken.ratio), spread(taken.spread), standing(taken).to_owned()]
            });
            let wrong = row.disqualified.as_ref().map(|why| format!("✗ {why}"));
            writeln!(
                out,
                "  {id:<28} {:<26} {ns:>8} {ratio:>7} {from_to:>13} {says:<8} {random:>9} {hard:>9}",
                row.name
            )?;
            wrong.map_or(Ok(()), |wrong| wrapped(&" ".repeat(31), &" ".repeat(33), &wrong, out))?;
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
    writeln!(
        out,
        "  {:<14} {:>7} {:>9} {:>9} {:>13} {:>13} {:>13}  worst scene",
        "", "scenes", "time", "ratio", "from–to", "median error", "largest"
    )?;
    for rung in rungs {
        let worst = rung.points.iter().max_by(|a, b| a.2.total_cmp(&b.2));
        let ratios = || rung.points.iter().map(|point| point.1);
        let (from, to) = (ratios().fold(f64::INFINITY, f64::min), ratios().fold(0.0, f64::max));
        let Some((id, _, largest)) = worst else {
            wrapped(&format!("— {:<14} ", rung.name), "  ", &shortfall_of_scenes(&rung), out)?;
            continue;
        };
        writeln!(
            out,
            "  {:<14} {:>7} {:>9} {:>9} {:>13} {:>13} {:>13}  {}",
            rung.name,
            rung.groups,
            time(rung.ns),
            digits(rung.ratio),
            spread([from, to]),
            error(rung.error),
            error(*largest),
            id.trim_start_matches("scene/")
        )?;
        if rung.disqualified + rung.unavailable > 0 {
            wrapped("      ", "      ", &shortfall_of_scenes(&rung), out)?;
        }
    }
    Ok(())
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
        wrapped(&format!("  {:<12} ", scaling.id), &" ".repeat(15), &text, out)?;
        for (work, why) in &scaling.unavailable {
            wrapped(&" ".repeat(15), &" ".repeat(17), &format!("{} not reached: {why}", thousands(*work)), out)?;
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
        wrapped("  ", "    ", &format!("{reason}; {first}{more}"), out)?;
    }
    Ok(())
}

fn legend(out: &mut impl Write) -> Result {
    writeln!(out, "\n● nothing else is both faster and closer · ✗ wrong in value, in no mean · — not measured here")?;
    writeln!(out, "tie: 1 lies within the spread, which is the range of all turns of all sittings")
}

/// Writes words in lines no longer than the terminal is wide: `head` before the first line, `indent` before the others.
pub(super) fn wrapped(head: &str, indent: &str, text: &str, out: &mut impl Write) -> Result {
    let mut line = head.to_owned();
    let mut is_begun = false;
    for word in text.split_whitespace() {
        let room = WIDTH.saturating_sub(line.chars().count() + usize::from(is_begun));
        if word.chars().count() > room && is_begun {
            writeln!(out, "{}", line.trim_end())?;
            indent.clone_into(&mut line);
            is_begun = false;
        }
        if is_begun {
            line.push(' ');
        }
        for letter in word.chars() {
            if line.chars().count() == WIDTH {
                writeln!(out, "{line}")?;
                indent.clone_into(&mut line);
            }
            line.push(letter);
        }
        is_begun = true;
    }
    writeln!(out, "{}", line.trim_end())
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::document;
    use super::*;

    fn text(details: bool) -> String {
        let mut text = String::new();
        write(&document(), details, &mut text).expect("a string takes all");
        text
    }

    #[test]
    fn lines_are_no_wider_than_the_terminal() {
        for details in [false, true] {
            let text = text(details);
            let widest = text.lines().max_by_key(|line| line.chars().count()).expect("there are lines");
            assert!(widest.chars().count() <= WIDTH, "{} columns: {widest}", widest.chars().count());
        }
        let mut long = String::new();
        wrapped("head ", "  ", &format!("{} {}", "x".repeat(300), "some words ".repeat(40)), &mut long)
            .expect("a string");
        assert!(long.lines().all(|line| line.chars().count() <= WIDTH), "{long}");
        assert_eq!(long.matches('x').count(), 300);
        assert_eq!(long.split_whitespace().filter(|word| *word == "words").count(), 40);
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
                    let name =
                        |line: &str| line.chars().skip(2).collect::<String>().split(' ').next() == Some(&row.name);
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
