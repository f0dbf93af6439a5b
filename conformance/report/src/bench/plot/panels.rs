//! Groups of techniques, a panel each: time across, the largest absolute error upward.

use super::axis::{Axis, ErrorAxis};
use super::label::{Area, Room};
use super::mark::{mark, style};
use super::svg::{Named, SIZE, WIDTH, across, errors, escaped, frame, markers, open, shortened, text, text_width};
use lightmeter_document::bench::ladder::BASELINE;
use lightmeter_document::bench::pareto::is_processor;
use lightmeter_document::bench::{BenchGroup, BenchRow, RungUse};
use std::fmt::{Error, Result as Written, Write};

const COLUMNS: usize = 2;
const PANEL: f64 = WIDTH / 2.0;
const HEIGHT: f64 = 286.0;
const HEAD: f64 = 58.0;

/// A picture with a panel for each group that has rows to show, and a mark for each of the rungs.
pub(super) fn svg(groups: &[&BenchGroup], rungs: &[RungUse], title: &str) -> Result<Option<String>, Error> {
    let groups: Vec<&&BenchGroup> =
        groups.iter().filter(|group| group.rows.iter().any(|row| place(row).is_some())).collect();
    if groups.is_empty() {
        return Ok(None);
    }
    let mut out = String::new();
    let mut top = HEAD;
    let height = HEAD + HEIGHT * (0..groups.len().div_ceil(COLUMNS)).map(|_| 1.0).sum::<f64>() + 52.0;
    open(height, title, "across: time; upward: the largest absolute error on random inputs", &mut out)?;
    for pair in groups.chunks(COLUMNS) {
        let mut left = 0.0;
        for group in pair {
            panel(group, [left, top], &mut out)?;
            left += PANEL;
        }
        top += HEIGHT;
    }
    let words =
        "line and bold names: nothing else is both faster and closer; whiskers: the middle half of the turns; small:";
    text([12.0, height - 32.0], "start", false, words, &mut out)?;
    let mut x = 18.0;
    for rung in rungs.iter().filter(|rung| rung.name != BASELINE && !is_processor(&rung.name)) {
        mark(style(&rung.name, 0), [x, height - 15.0], 5.0, false, &mut out)?;
        let name = format!("at {}", rung.name);
        text([x + 10.0, height - 11.0], "start", false, &name, &mut out)?;
        x += 38.0 + text_width(&name, SIZE);
    }
    out.push_str("</svg>\n");
    Ok(Some(out))
}

/// A row's time and its quartiles, where it has them and errors. What the processor takes is told in tables.
fn place(row: &BenchRow) -> Option<(f64, [f64; 2])> {
    row.random.as_ref().filter(|_| !is_processor(&row.name))?;
    row.time.as_ref().map(|time| (time.ns, time.quartiles_ns))
}

fn panel(group: &BenchGroup, [left, top]: [f64; 2], out: &mut String) -> Written {
    let area = Area { left: left + 66.0, top: top + 40.0, width: PANEL - 66.0 - 14.0, height: HEIGHT - 40.0 - 52.0 };
    let (right, bottom) = (area.left + area.width, area.top + area.height);
    let id = escaped(group.id.trim_start_matches("technique/"));
    let room_for = |size: f64| PANEL - 80.0 - size;
    writeln!(out, r#"<text x="{:.1}" y="{:.1}" font-size="14" font-weight="bold">{id}</text>"#, area.left, top + 14.0)?;
    text([area.left, top + 32.0], "start", true, &shortened(&group.title, 12.0, room_for(0.0)), out)?;
    let rows: Vec<(&BenchRow, f64, [f64; 2], f64)> = (group.rows.iter())
        .filter_map(|row| place(row).map(|(ns, quartiles)| (row, ns, quartiles)))
        .filter_map(|(row, ns, quartiles)| Some((row, ns, quartiles, row.random.as_ref()?.absolute.max.0)))
        .collect();
    let x = Axis::over(rows.iter().flat_map(|row| [row.1, row.2[0], row.2[1]]), 0.7, [area.left, right]);
    let y = ErrorAxis::over(rows.iter().map(|row| row.3), [area.top, bottom], 12.0);
    let (scale, unit) = unit(x.ends()[1]);
    errors(&y, [area.left, right], 7, out)?;
    across(&x, [area.top, bottom], 8, scale, out)?;
    frame(area, out)?;
    text([right, bottom + 34.0], "end", true, &format!("{unit} per {}", group.unit), out)?;
    let mut lacking: Vec<&str> = (group.rows.iter())
        .filter(|row| place(row).is_none() && !is_processor(&row.name))
        .map(|row| row.name.as_str())
        .collect();
    if !lacking.is_empty() {
        lacking.insert(0, "not measured:");
        text([area.left, bottom + 34.0], "start", true, &shortened(&lacking.join(" "), 12.0, room_for(110.0)), out)?;
    }
    let mut room = Room::new(area);
    for (_, _, [low, high], error) in &rows {
        let (from, to, at) = (x.at(*low), x.at(*high), y.at(*error));
        room.take_line([from, at], [to, at], 2.0);
        writeln!(out, r##"<path d="M{from:.1} {at:.1}H{to:.1}" stroke="#777777" stroke-width="1.2"/>"##)?;
    }
    let named = rows.iter().enumerate().map(|(place, (row, ns, _, error))| {
        let front = group.front.iter().position(|name| *name == row.name);
        // A technique at another rung looks like that rung, and has no name of its own where it is on no front.
        let rung = row.name.rsplit_once(' ').map(|(_, rung)| rung);
        Named {
            name: if rung.is_some() && front.is_none() { String::new() } else { row.name.clone() },
            at: [x.at(*ns), y.at(*error)],
            r: if rung.is_some() { 5.0 } else { 6.5 },
            style: style(rung.unwrap_or(&row.name), place),
            front,
            is_hollow: row.disqualified.is_some(),
        }
    });
    markers(&named.collect::<Vec<_>>(), room, out)
}

/// Nanoseconds of the unit that reads best on an axis up to that, and its name.
pub(super) fn unit(ns: f64) -> (f64, &'static str) {
    match ns {
        x if x >= 2e9 => (1e9, "s"),
        x if x >= 2e6 => (1e6, "ms"),
        x if x >= 2e3 => (1e3, "µs"),
        x if x >= 0.1 => (1.0, "ns"),
        _ => (1e-3, "ps"),
    }
}
