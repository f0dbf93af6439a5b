//! The picture of the page: the largest error of each state, a panel for each equation and driver.

use super::{BlendRun, READING};
use lightmeter_document::run::BlendState;
use lightmeter_scene::blend::{Factor, State};
use std::fmt::{Result, Write};

/// Pixels of a cell, of the gap between panels, and of the names beside them.
const CELL: usize = 13;
const GAP: usize = 26;
const NAMES: usize = 190;
/// So wide is the legend.
const MIN_WIDTH: usize = 520;
/// A scale that gets darker, readable in print and by the colour-blind: up to half a step, one, one and a half, two, more.
const SHADES: [(f64, &str); 5] =
    [(0.505, "#f1eef6"), (1.0, "#bdc9e1"), (1.5, "#74a9cf"), (2.0, "#2b8cbe"), (f64::INFINITY, "#045a8d")];

/// A picture of the largest error of each state: a panel for each equation and driver.
///
/// # Errors
/// Where the writer fails.
pub fn svg(run: &BlendRun, out: &mut impl Write) -> Result {
    let target = run.pictured();
    let panel = CELL * Factor::ALL.len();
    let (columns, rows) = (run.adapters.len(), READING.len());
    let (width, height) = ((NAMES + columns * (panel + GAP)).max(MIN_WIDTH), 34 + rows * (panel + GAP) + NAMES);
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="10">"#
    )?;
    writeln!(out, r##"<rect width="100%" height="100%" fill="#ffffff"/>"##)?;
    for (column, adapter) in run.adapters.iter().enumerate() {
        let left = NAMES + column * (panel + GAP);
        writeln!(out, r#"<text x="{left}" y="14" font-size="13">{}, {target}</text>"#, adapter.name)?;
        for (row, equation) in READING.into_iter().enumerate() {
            let top = 34 + row * (panel + GAP);
            writeln!(out, r#"<text x="{left}" y="{}" font-size="11">{}</text>"#, top - 4, equation.name())?;
            for (y, src) in Factor::ALL.into_iter().enumerate() {
                for (x, dst) in Factor::ALL.into_iter().enumerate() {
                    let shade = shade(run.row(adapter, target, State { equation, src, dst }));
                    let (x, y) = (left + x * CELL, top + y * CELL);
                    writeln!(
                        out,
                        r##"<rect x="{x}" y="{y}" width="{CELL}" height="{CELL}" fill="{shade}" stroke="#ffffff"/>"##
                    )?;
                }
            }
            if row == rows - 1 {
                for (x, dst) in Factor::ALL.into_iter().enumerate() {
                    let (x, y) = (left + x * CELL + 10, top + panel + 6);
                    writeln!(out, r#"<text transform="translate({x},{y}) rotate(90)">{}</text>"#, dst.name())?;
                }
            }
            if column == 0 {
                for (y, src) in Factor::ALL.into_iter().enumerate() {
                    let y = top + y * CELL + 10;
                    writeln!(out, r#"<text x="{}" y="{y}" text-anchor="end">{}</text>"#, left - 6, src.name())?;
                }
            }
        }
    }
    legend(height - 30, out)?;
    writeln!(out, "</svg>")
}

fn shade(row: Option<&BlendState>) -> &'static str {
    match row {
        None => "#dddddd",
        Some(row) if row.failed > 0 => "#d7301f",
        Some(row) => {
            SHADES.into_iter().find(|(most, _)| row.error_max.0 <= *most).map_or("#045a8d", |(_, shade)| shade)
        }
    }
}

fn legend(y: usize, out: &mut impl Write) -> Result {
    writeln!(
        out,
        r#"<text x="8" y="{y}">largest error in steps of 1/255; rows are source factors, columns destination factors:</text>"#
    )?;
    let words = ["≤ ½", "≤ 1", "≤ 1½", "≤ 2", "more"];
    let others = [("fails", "#d7301f"), ("not drawn", "#dddddd")];
    let all = words.into_iter().zip(SHADES.map(|(_, shade)| shade)).chain(others);
    for (place, (word, shade)) in all.enumerate() {
        let x = 8 + 70 * place;
        writeln!(
            out,
            r#"<rect x="{x}" y="{}" width="12" height="12" fill="{shade}"/><text x="{}" y="{}">{word}</text>"#,
            y + 8,
            x + 16,
            y + 18
        )?;
    }
    Ok(())
}
