//! The page on what accuracy costs, and the README's part of it, in Markdown.

use super::figures::{compilation, count, digits, error, holding, spread, standing, time};
use super::plot::{Plot, subject};
use super::text::{is_stable_form, law, steps};
use lightmeter_document::bench::ladder::{RungSummary, rungs};
use lightmeter_document::bench::pareto::is_processor;
use lightmeter_document::bench::{BenchDocument, BenchGroup, BenchRow, Claim, Family, GroupKind, Measured};
use lightmeter_document::thousands;
use std::fmt::{Result, Write};

/// The page. `pictures` lie in `folder`, as the page names it: `bench/`, or nothing where they lie beside it.
///
/// # Errors
/// Where the writer fails.
pub fn markdown<W: Write>(document: &BenchDocument, pictures: &[Plot], folder: &str, out: &mut W) -> Result {
    writeln!(out, "# What accuracy costs: techniques and the ladder of precision\n")?;
    made(document, out)?;
    body(document, pictures, folder, out)
}

/// The page but for its title and how it was made.
///
/// # Errors
/// Where the writer fails.
pub fn body<W: Write>(document: &BenchDocument, pictures: &[Plot], folder: &str, out: &mut W) -> Result {
    reading(out)?;
    claims(document, out)?;
    for measured in &document.adapters {
        let picture = |subject: &str, out: &mut W| {
            let of = |one: &&Plot| one.adapter == measured.adapter && one.subject == subject;
            pictures.iter().filter(of).try_for_each(|one| embed(one, folder, out))
        };
        writeln!(out, "\n## {}", measured.adapter)?;
        ladder(measured, out)?;
        measured.families.iter().try_for_each(|family| picture(&family.id, out))?;
        techniques(measured, &picture, out)?;
        stable_forms(measured, out)?;
        scenes(measured, out)?;
        picture("scenes", out)?;
        growth(measured, out)?;
        measured.scalings.iter().try_for_each(|scaling| picture(&subject(&scaling.id), out))?;
        left_out(measured, out)?;
        formulas(measured, out)?;
    }
    Ok(())
}

fn embed(picture: &Plot, folder: &str, out: &mut impl Write) -> Result {
    writeln!(out, "\n![{}]({folder}{}.svg)", picture.title, picture.stem())
}

fn made(document: &BenchDocument, out: &mut impl Write) -> Result {
    let BenchDocument { command, version, seed, seconds, cores, .. } = document;
    writeln!(out, "Made by\n\n```\n{command}\n```\n")?;
    let quick = if document.quick { " It was a quick one: fewer formulas, fewer turns." } else { "" };
    writeln!(
        out,
        "Version {version}, seed {seed}, {} of the processor, {seconds:.0} s.{quick}\n",
        count(*cores, "core")
    )?;
    for measured in &document.adapters {
        let Measured { adapter, device, backend, driver, is_cpu, clock, .. } = measured;
        let processor = if *is_cpu { "; it computes on the processor, so its times are the processor's" } else { "" };
        let note = clock.note.as_ref().map(|note| format!(" ({})", plain(note))).unwrap_or_default();
        let rejected = match clock.rejected {
            0 => "all of them plausible".to_owned(),
            n => format!("{} of them could not be true and are in no figure", thousands(n)),
        };
        let (kind, readings) = (clock_name(&clock.kind), thousands(clock.readings));
        let grain = clock.grain_ns.map(|ns| format!(" in steps of {}", grain(ns))).unwrap_or_default();
        writeln!(
            out,
            "* **{adapter}**: {device}, {backend}, {driver}{processor}. Clock: {kind}{grain}{note}; {readings} readings, {rejected}.{}",
            compilation(measured).map(|told| format!(" Compilation is in no time: {told}.")).unwrap_or_default()
        )?;
    }
    Ok(())
}

/// A step of a clock.
fn grain(ns: u64) -> String {
    match ns {
        0..1_000 => format!("{ns} ns"),
        1_000..1_000_000 => format!("{} µs", f64::from(u32::try_from(ns).unwrap_or(u32::MAX)) / 1e3),
        _ => format!("{} ms", f64::from(u32::try_from(ns / 1_000).unwrap_or(u32::MAX)) / 1e3),
    }
}

/// A clock's name in a sentence.
fn clock_name(kind: &str) -> &str {
    if kind == "wall" { "the clock on the wall" } else { kind }
}

fn reading(out: &mut impl Write) -> Result {
    writeln!(out, "\n## How to read\n")?;
    writeln!(
        out,
        "Rows of a group compute the same and are measured in turns beside the group's baseline, in three sittings (two of a quick one), each on devices of its own with everything \
         compiled anew. A *time* is the median of the turns; reading the inputs is taken off where the group's line of work says \
         so. A *ratio* is the median, turn by turn, of a row's time over the baseline's, of the processor's rungs over \
         `cpu-f32`, and of these the sittings' median; its spread goes from the least to the greatest of all turns, and where 1 lies within it is a *tie*. Errors are against the f64 reference of what the group is for: in \
         ULP of binary32, absolute, or in 1/255 of full scale. *Random* inputs are drawn over a formula's domain; *hard* ones \
         are its named hard cases and what lies within a few ULP of them. ∞ stands where a value was \
         NaN or infinite and the reference is a number.\n"
    )?;
    writeln!(
        out,
        "**Bold** is the Pareto front: nothing else is as fast, within the spreads, and closer. ✗ is wrong in value beyond what it is \
         meant to be, is on no front and never recommended. — was not measured. Rungs named `cpu-` run on one core of the \
         processor, are on no front, and are grey in pictures. In pictures an error of 0 lies in a band at the bottom."
    )
}

fn claims(document: &BenchDocument, out: &mut impl Write) -> Result {
    writeln!(out, "\n## What is claimed, and what was measured\n")?;
    let mut told: Vec<&str> = vec![];
    for claim in document.adapters.iter().flat_map(|measured| &measured.claims) {
        if told.contains(&claim.id.as_str()) {
            continue;
        }
        told.push(&claim.id);
        writeln!(out, "* **{}** ({})", plain(&claim.claim), claim.source)?;
        for measured in &document.adapters {
            for Claim { sentence, ratio, spread: from_to, holds, .. } in
                measured.claims.iter().filter(|one| one.id == claim.id)
            {
                let (name, sentence) = (&measured.adapter, plain(sentence));
                let said = format!("{}: ", plain(&claim.claim));
                let sentence = sentence.strip_prefix(&said).unwrap_or(&sentence).trim_end_matches('.');
                let says = holding(*holds);
                writeln!(out, "  * {name}: *{says}*. {sentence} (ratio {}, {}).", digits(*ratio), spread(*from_to))?;
            }
        }
    }
    if told.is_empty() {
        writeln!(out, "No claim was measured.")?;
    }
    Ok(())
}

/// Rungs in the adapter's order, then others that some family has.
fn names(measured: &Measured) -> Vec<&str> {
    let mut names: Vec<&str> = measured.rungs.iter().map(|rung| rung.name.as_str()).collect();
    let formulas = measured.groups.iter().filter(|group| group.kind == GroupKind::Formula);
    let rows = formulas.flat_map(|group| &group.rows).map(|row| row.name.as_str());
    for name in measured.families.iter().flat_map(|family| &family.rungs).map(|rung| rung.name.as_str()).chain(rows) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn head(first: &str, names: &[&str], out: &mut impl Write) -> Result {
    writeln!(out, "| {first} | {} |", names.join(" | "))?;
    let rest = first.matches('|').count() + names.len();
    writeln!(out, "|---|{}", "--:|".repeat(rest))
}

fn ladder(measured: &Measured, out: &mut impl Write) -> Result {
    writeln!(out, "\n### The ladder\n\n| rung | what it is | why it was not measured |\n|---|---|---|")?;
    for rung in &measured.rungs {
        let why = rung.unavailable.as_ref().map(|why| format!("unavailable: {}", plain(why))).unwrap_or_default();
        writeln!(out, "| {} | {} | {why} |", rung.name, plain(&rung.what))?;
    }
    if measured.families.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "\nTime over that of f32 (the geometric mean of a family's formulas), then the absolute error (the median of their largest on \
         random inputs). Where no step of a formula has such a form, f32's figures count:\n"
    )?;
    let names = names(measured);
    head("family", &names, out)?;
    for Family { id, rungs, front } in &measured.families {
        write!(out, "| {id} |")?;
        for name in &names {
            let rung = rungs.iter().find(|rung| rung.name == *name && rung.formulas > 0);
            let cell = rung.map(|rung| format!("{} · {}", digits(rung.ratio), error(rung.error_max.0)));
            write!(out, " {} |", marked(cell, front.iter().any(|one| one == name)))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// A cell, bold on the front, a dash where there is nothing.
fn marked(cell: Option<String>, is_on_front: bool) -> String {
    match cell {
        Some(cell) if is_on_front => format!("**{cell}**"),
        Some(cell) => cell,
        None => "—".into(),
    }
}

fn techniques<W: Write>(measured: &Measured, picture: &impl Fn(&str, &mut W) -> Result, out: &mut W) -> Result {
    let techniques =
        measured.groups.iter().filter(|group| group.kind == GroupKind::Technique && !is_stable_form(group));
    let techniques: Vec<&BenchGroup> = techniques.collect();
    if !techniques.is_empty() {
        writeln!(out, "\n### Techniques")?;
    }
    for group in techniques {
        writeln!(
            out,
            "\n#### {}\n\n{}. Over {}, for one {}; {}; errors against {}.\n",
            group.id,
            plain(&group.title),
            group.baseline,
            group.unit,
            plain(&group.work),
            plain(&group.ideal)
        )?;
        writeln!(
            out,
            "| row | what | time | ratio | spread | against the baseline | ULP, largest | 99 % | mean | absolute | 1/255 | hard, ULP | hard, absolute |"
        )?;
        writeln!(out, "|---|---|--:|--:|--:|---|--:|--:|--:|--:|--:|--:|--:|")?;
        for row in &group.rows {
            technique(group, row, out)?;
        }
        picture(&subject(&group.id), out)?;
    }
    Ok(())
}

fn technique(group: &BenchGroup, row: &BenchRow, out: &mut impl Write) -> Result {
    let name = marked(Some(row.name.clone()), group.front.contains(&row.name));
    if let Some(why) = &row.unavailable {
        return writeln!(
            out,
            "| — {name} | {}; not measured: {} | | | | | | | | | | | |",
            plain(&row.what),
            plain(why)
        );
    }
    let (mark, wrong) =
        row.disqualified.as_ref().map_or(("", String::new()), |why| ("✗ ", format!("; {}", plain(why))));
    let note = row.time.as_ref().and_then(|time| time.note.as_ref()).map(|note| format!("; {}", plain(note)));
    write!(out, "| {mark}{name} | {}{wrong}{} |", plain(&row.what), note.unwrap_or_default())?;
    let figures = timed(row).into_iter();
    figures.chain(erring(row)).try_for_each(|cell| write!(out, " {cell} |"))?;
    writeln!(out)
}

/// Time, ratio, spread and what they say.
fn timed(row: &BenchRow) -> [String; 4] {
    row.time.as_ref().map_or_else(Default::default, |taken| {
        [time(taken.ns), digits(taken.ratio), spread(taken.spread), standing(taken).to_owned()]
    })
}

fn erring(row: &BenchRow) -> [String; 7] {
    let random = row.random.as_ref().map(|of| [of.ulp.max, of.ulp.p99, of.ulp.mean, of.absolute.max, of.steps.max]);
    let hard = row.hard.as_ref().map(|of| [of.ulp.max, of.absolute.max]);
    let random = random.map_or_else(Default::default, |all| all.map(|one| error(one.0)));
    let hard = hard.map_or_else(|| ["—".into(), "—".into()], |all| all.map(|one| error(one.0)));
    let ([a, b, c, d, e], [f, g]) = (random, hard);
    [a, b, c, d, e, f, g]
}

fn stable_forms(measured: &Measured, out: &mut impl Write) -> Result {
    let groups: Vec<&BenchGroup> = measured.groups.iter().filter(|group| is_stable_form(group)).collect();
    if groups.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n### Published and stable forms of hard cases\n")?;
    writeln!(out, "The largest error on random inputs and on hard cases, in ULP.\n")?;
    writeln!(
        out,
        "| case | form | time | ratio | spread | against the baseline | random | hard |\n|---|---|--:|--:|--:|---|--:|--:|"
    )?;
    for group in groups {
        for (place, row) in group.rows.iter().enumerate() {
            let id = if place == 0 { format!("`{}`", group.id) } else { String::new() };
            let name = marked(Some(row.name.clone()), group.front.contains(&row.name));
            let why = row.unavailable.as_ref().or(row.disqualified.as_ref()).map(|why| plain(why));
            let mark = if row.disqualified.is_some() { "✗ " } else { "" };
            let why = why.map(|why| format!(": {why}")).unwrap_or_default();
            write!(out, "| {id} | {mark}{name}{why} |")?;
            timed(row).into_iter().try_for_each(|cell| write!(out, " {cell} |"))?;
            let largest = [&row.random, &row.hard].map(|of| of.as_ref().map(|errors| error(errors.ulp.max.0)));
            let [random, hard] = largest.map(|of| of.unwrap_or_else(|| "—".into()));
            writeln!(out, " {random} | {hard} |")?;
        }
    }
    Ok(())
}

fn scenes(measured: &Measured, out: &mut impl Write) -> Result {
    let scenes: Vec<&BenchGroup> = measured.groups.iter().filter(|group| group.kind == GroupKind::Scene).collect();
    let rungs = rungs(scenes.iter().copied(), |errors| errors.steps.max.0);
    if rungs.is_empty() {
        return Ok(());
    }
    let names: Vec<&str> = rungs.iter().map(|rung| rung.name.as_str()).collect();
    writeln!(out, "\n### Scenes\n")?;
    writeln!(out, "Time over that of the baseline, then the largest error of a pixel in 1/255.\n")?;
    head("scene | frame of the baseline", &names, out)?;
    let all = |rung: &RungSummary| (rung.groups > 0).then(|| format!("{} · {}", digits(rung.ratio), error(rung.error)));
    write!(out, "| *mean, median* | |")?;
    rungs.iter().try_for_each(|rung| write!(out, " {} |", marked(all(rung), false)))?;
    writeln!(out)?;
    for group in scenes {
        let baseline = group.rows.iter().find(|row| row.name == group.baseline).and_then(|row| row.time.as_ref());
        let baseline = baseline.map_or_else(|| "—".into(), |taken| time(taken.ns));
        write!(out, "| {} | {baseline} |", group.id.trim_start_matches("scene/"))?;
        cells(group, &names, |row| [row.random.as_ref().map(|of| of.steps.max.0), None], out)?;
    }
    Ok(())
}

/// A cell for each row by name: its ratio, and its largest errors on random and on hard inputs.
fn cells(
    group: &BenchGroup,
    names: &[&str],
    largest: impl Fn(&BenchRow) -> [Option<f64>; 2],
    out: &mut impl Write,
) -> Result {
    for name in names {
        let row = group.rows.iter().find(|row| row.name == *name && row.unavailable.is_none());
        let figures = row.map(|row| {
            let ratio = row.time.as_ref().map_or_else(|| "—".into(), |time| digits(time.ratio));
            let wrong = if row.disqualified.is_some() { "✗ " } else { "" };
            let [random, hard] = largest(row);
            let hard = hard.map(|hard| format!(" · {}", error(hard))).unwrap_or_default();
            format!("{wrong}{ratio} · {}{hard}", random.map_or_else(|| "—".into(), error))
        });
        write!(out, " {} |", marked(figures, group.front.iter().any(|one| one == name)))?;
    }
    writeln!(out)
}

fn growth(measured: &Measured, out: &mut impl Write) -> Result {
    if measured.scalings.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n### Growth of time with work\n")?;
    writeln!(
        out,
        "| work that grows | what | steps | clock | law | exponent | not reached |\n|---|---|---|---|---|--:|---|"
    )?;
    for scaling in &measured.scalings {
        let exponent = scaling.fit.as_ref().map_or_else(|| "—".into(), |fit| format!("{:.3}", fit.exponent));
        let lacking = scaling.unavailable.iter().map(|(work, why)| format!("{}: {}", thousands(*work), plain(why)));
        writeln!(
            out,
            "| {} | {} | {} | {} | {} | {exponent} | {} |",
            scaling.id,
            plain(&scaling.what),
            steps(scaling),
            scaling.clock,
            law(scaling),
            lacking.collect::<Vec<_>>().join("; ")
        )?;
    }
    Ok(())
}

/// Rows of any kind that are in no figure, by reason; for rungs that the adapter has not, their table is enough.
fn left_out(measured: &Measured, out: &mut impl Write) -> Result {
    let is_told =
        |row: &BenchRow| measured.rungs.iter().any(|rung| rung.name == row.name && rung.unavailable == row.unavailable);
    let rows = || measured.groups.iter().flat_map(|group| group.rows.iter().map(move |row| (group, row)));
    let unavailable = rows().filter(|(_, row)| !is_told(row));
    let unavailable = unavailable.filter_map(|(group, row)| Some((group, row, row.unavailable.as_ref()?)));
    listed("What was not measured, and why", unavailable, out)?;
    let disqualified = rows().filter(|(_, row)| row.unavailable.is_none());
    let disqualified = disqualified.filter_map(|(group, row)| Some((group, row, row.disqualified.as_ref()?)));
    listed("What is wrong in value", disqualified, out)
}

fn listed<'a>(
    title: &str,
    rows: impl Iterator<Item = (&'a BenchGroup, &'a BenchRow, &'a String)>,
    out: &mut impl Write,
) -> Result {
    let mut reasons: Vec<(&str, &str, Vec<&str>)> = vec![];
    for (group, row, why) in rows {
        match reasons.iter_mut().find(|(name, known, _)| *name == row.name && known == why) {
            Some((.., groups)) => groups.push(&group.id),
            None => reasons.push((&row.name, why, vec![&group.id])),
        }
    }
    if !reasons.is_empty() {
        writeln!(out, "\n### {title}\n")?;
    }
    for (name, why, groups) in reasons {
        writeln!(out, "* {name}: {} ({})", plain(why), groups.join(", "))?;
    }
    Ok(())
}

fn formulas(measured: &Measured, out: &mut impl Write) -> Result {
    let formulas: Vec<&BenchGroup> = measured.groups.iter().filter(|group| group.kind == GroupKind::Formula).collect();
    if formulas.is_empty() {
        return Ok(());
    }
    let names = names(measured);
    writeln!(out, "\n### Every formula\n")?;
    writeln!(
        out,
        "Time over that of f32, then the largest error in ULP on random inputs, and on hard cases and near them.\n"
    )?;
    head("formula | time of f32", &names, out)?;
    for group in formulas {
        let baseline = group.rows.iter().find(|row| row.name == group.baseline).and_then(|row| row.time.as_ref());
        write!(out, "| `{}` | {} |", group.id, baseline.map_or_else(|| "—".into(), |taken| time(taken.ns)))?;
        cells(group, &names, |row| [&row.random, &row.hard].map(|of| of.as_ref().map(|of| of.ulp.max.0)), out)?;
    }
    Ok(())
}

/// Formulas that the README shows, where they were measured.
const SHOWN: [&str; 2] = ["lighting/blinn", "fog/exp"];

/// The README's part: the ladder over all formulas and at a few, and the claims' sentences.
///
/// # Errors
/// Where the writer fails.
pub fn readme(document: &BenchDocument, out: &mut impl Write) -> Result {
    if let Some(interrupted) = &document.interrupted {
        writeln!(out, "Interrupted: {}.\n", plain(&interrupted.to_string()))?;
    }
    for measured in &document.adapters {
        let is_in_shaders = |group: &&BenchGroup| group.kind == GroupKind::Formula && !is_processor(&group.baseline);
        let formulas = measured.groups.iter().filter(is_in_shaders);
        let all = rungs(formulas.clone(), |errors| errors.absolute.max.0);
        let shown: Vec<&BenchGroup> =
            SHOWN.into_iter().filter_map(|id| formulas.clone().find(|group| group.id == id)).collect();
        let Measured { adapter, device, clock, .. } = measured;
        let count = count(formulas.count(), "formula");
        writeln!(out, "{adapter} ({device}), {count}, timed by {}:\n", clock_name(&clock.kind))?;
        write!(out, "| rung | time over f32 | ns | error |")?;
        shown.iter().try_for_each(|group| write!(out, " `{0}`, ns | error |", group.id))?;
        writeln!(out, "\n|---|--:|--:|--:|{}", "--:|--:|".repeat(shown.len()))?;
        let front = lightmeter_document::bench::ladder::front(&all);
        for name in names(measured) {
            let Some(rung) = all.iter().find(|rung| rung.name == name) else { continue };
            let figures =
                |figure: fn(&RungSummary) -> String| if rung.groups > 0 { figure(rung) } else { "—".into() };
            let name = marked(Some(rung.name.clone()), front.contains(&rung.name));
            let [ratio, ns] = [figures(|rung| digits(rung.ratio)), figures(|rung| digits(rung.ns))];
            write!(out, "| {name} | {ratio} | {ns} | {} |", figures(|rung| error(rung.error)))?;
            for group in &shown {
                let row = group.rows.iter().find(|row| row.name == rung.name);
                let ns = row.and_then(|row| row.time.as_ref()).map_or_else(|| "—".into(), |time| digits(time.ns));
                let errs = row.and_then(|row| row.random.as_ref()).map(|errors| error(errors.absolute.max.0));
                write!(out, " {ns} | {} |", errs.unwrap_or_else(|| "—".into()))?;
            }
            writeln!(out)?;
        }
        writeln!(out)?;
        for claim in &measured.claims {
            let sentence = plain(&claim.sentence);
            writeln!(out, "* {} ({}: *{}*)", sentence, claim.source, holding(claim.holds))?;
        }
        writeln!(out)?;
    }
    let on_processor =
        document.adapters.iter().flat_map(|measured| &measured.rungs).any(|rung| is_processor(&rung.name));
    let grey = if on_processor { " Rungs named `cpu-` run on one core of the processor." } else { "" };
    writeln!(
        out,
        "Times are geometric means over the formulas, errors the median of their largest on random inputs; bold is what nothing \
         else is both faster and closer than.{grey}"
    )
}

/// Words that a cell of a table takes: in one line, and without what would end the cell.
fn plain(words: &str) -> String {
    words.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::super::plot;
    use super::super::synthetic::document;
    use super::*;

    fn page() -> String {
        let document = document();
        let pictures = plot::pictures(&document).expect("a string takes all");
        let mut page = String::new();
        markdown(&document, &pictures, "bench/", &mut page).expect("a string takes all");
        page
    }

    /// The cells of a line of a table.
    fn cells_of(line: &str) -> Vec<String> {
        line.replace("\\|", "/").trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
    }

    /// From a heading to the next of its kind.
    fn section<'a>(page: &'a str, heading: &str) -> &'a str {
        let from = page.find(heading).unwrap_or_else(|| panic!("no {heading:?}"));
        let kind = format!("\n{} ", heading.trim_start().split(' ').next().expect("it is a heading"));
        let rest = &page[from + heading.len()..];
        &rest[..rest.find(&kind).unwrap_or(rest.len())]
    }

    #[test]
    fn every_row_of_every_group_is_there() {
        let (document, page) = (document(), page());
        for measured in &document.adapters {
            let part = section(&page, &format!("\n## {}", measured.adapter));
            for group in &measured.groups {
                let expected = |row: &BenchRow, cell: &str| {
                    assert_eq!(cell == "—", row.unavailable.is_some(), "{}: {} is {cell}", group.id, row.name);
                    assert_eq!(cell.contains('✗'), row.disqualified.is_some() && row.unavailable.is_none(), "{cell}");
                    assert_eq!(cell.contains("**"), group.front.contains(&row.name), "{}: {cell}", group.id);
                };
                match group.kind {
                    GroupKind::Technique if !is_stable_form(group) => {
                        let part = section(part, &format!("\n#### {}", group.id));
                        for row in &group.rows {
                            let of = |line: &&str| {
                                cells_of(line)[0].trim_start_matches(['✗', '—', ' ']).trim_matches('*') == row.name
                            };
                            let line =
                                part.lines().find(of).unwrap_or_else(|| panic!("no {} in {}", row.name, group.id));
                            assert_eq!(cells_of(line).len(), 13, "{line}");
                        }
                    }
                    GroupKind::Technique => {
                        let part = section(part, "\n### Published and stable forms");
                        let lines = part.lines().skip_while(|line| cells_of(line)[0] != format!("`{}`", group.id));
                        for (row, line) in group.rows.iter().zip(lines) {
                            assert!(cells_of(line)[1].contains(&row.name) && cells_of(line).len() == 8, "{line}");
                        }
                    }
                    GroupKind::Formula | GroupKind::Scene => {
                        let (title, id) = match group.kind {
                            GroupKind::Formula => ("\n### Every formula", format!("`{}`", group.id)),
                            _ => ("\n### Scenes", group.id.trim_start_matches("scene/").to_owned()),
                        };
                        let part = section(part, title);
                        let head = part.lines().find(|line| line.starts_with("| ")).map(cells_of).expect("a head");
                        let line = part.lines().map(cells_of).find(|cells| cells[0] == id).expect("a line");
                        assert_eq!(head.len(), line.len(), "{id}");
                        for row in &group.rows {
                            let place = head.iter().position(|name| *name == row.name).expect("a column");
                            expected(row, &line[place]);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn tables_are_even_and_pictures_are_shown() {
        let page = page();
        let mut columns = None;
        for line in page.lines() {
            if line.starts_with('|') {
                let count = cells_of(line).len();
                assert_eq!(*columns.get_or_insert(count), count, "{line}");
            } else {
                columns = None;
            }
        }
        for stem in ["lavapipe-fog", "lavapipe-technique-viewer", "h100-scenes"] {
            assert!(page.contains(&format!("](bench/{stem}.svg)")), "{stem}");
        }
        let claims = page.find("## What is claimed").expect("claims");
        assert!(claims < page.find("### The ladder").expect("the ladder"), "claims come first");
        for expected in [
            "./x bench --adapter all",
            "2 cores of the processor",
            "41,234 readings, 3 of them could not be true",
            "it computes on the processor",
            "Clock: the clock on the wall in steps of 100 µs (timestamps stood still",
            "lavapipe: *holds*. infinite takes 0.70 times as long as local, and is off by 3.2/255 at most (ratio 0.700, 0.679–0.721).",
            "*does not hold*",
            "*left open by a tie*",
            "| 1.010 |",
            "1,048,576: more than a storage buffer holds",
            "* double-float: no double-float form of pow is written \\| none is published (",
            "* table-64: differs from its own formula by 0.02 beyond z = 80: the table ends there (technique/fog-exp)",
        ] {
            assert!(page.contains(expected), "no {expected:?}");
        }
    }

    #[test]
    fn every_column_of_every_table_has_a_heading() {
        let document = document();
        let mut text = String::new();
        markdown(&document, &[], "", &mut text).expect("a string takes all");
        let lines: Vec<&str> = text.lines().collect();
        let heads: Vec<&&str> =
            lines.windows(2).filter(|pair| pair[1].starts_with("|---")).map(|pair| &pair[0]).collect();
        assert!(heads.len() > 5, "{} tables", heads.len());
        for head in heads {
            assert!(head.trim_matches('|').split('|').all(|cell| !cell.trim().is_empty()), "{head}");
        }
    }

    #[test]
    fn the_readme_has_the_ladder_and_the_claims() {
        let mut text = String::new();
        let document = document();
        readme(&document, &mut text).expect("a string takes all");
        for measured in &document.adapters {
            for rung in &measured.rungs {
                let of = |line: &&str| cells_of(line)[0].trim_matches('*') == rung.name;
                let line = text.lines().find(of).expect("a line each");
                assert_eq!(cells_of(line).len(), 8, "{line}");
            }
            assert!(measured.claims.iter().all(|claim| {
                let sentence = claim.sentence.trim_start_matches(&format!("{}: ", claim.claim));
                text.contains(sentence.trim_end_matches('.'))
            }));
        }
        assert!(text.contains("| f16 | — | — | — | — | — | — | — |"), "{text}");
        assert!(text.contains("`lighting/blinn`, ns | error |"));
    }
}
