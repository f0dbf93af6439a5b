//! The picture of the page: the largest error of each state, a panel for each equation and driver.

use super::{BlendRun, READING};
use crate::plot::Undrawn;
use lightmeter_document::report::BlendState;
use lightmeter_scene::blend::{Factor, State};
use plotters::prelude::{
    Color as _, FontTransform, IntoDrawingArea as _, IntoFont as _, IntoTextStyle as _, RGBColor, Rectangle,
    SVGBackend, Text, TextStyle, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Pixels of a cell, of the gap between panels, and of the names beside them.
const CELL: i32 = 14;
const GAP: i32 = 30;
const NAMES: i32 = 200;
/// Pixels above the panels.
const HEAD: i32 = 76;
/// Pixels of the legend.
const MIN_WIDTH: i32 = 540;
/// A scale that gets darker, readable in print and by the colour-blind: up to half a step, one, one and a half, two, more.
const SHADES: [(f64, RGBColor); 5] = [
    (0.505, RGBColor(241, 238, 246)),
    (1.0, RGBColor(189, 201, 225)),
    (1.5, RGBColor(116, 169, 207)),
    (2.0, RGBColor(43, 140, 190)),
    (f64::INFINITY, RGBColor(4, 90, 141)),
];
const FAILS: RGBColor = RGBColor(215, 48, 31);
const NOT_DRAWN: RGBColor = RGBColor(221, 221, 221);

/// A picture of the largest error of each state: a panel for each equation and driver.
///
/// # Errors
/// Where the library that draws it fails.
pub fn svg(run: &BlendRun) -> Result<String, Undrawn> {
    let target = run.pictured();
    let panel = CELL * length(Factor::ALL.len());
    let (columns, rows) = (length(run.adapters.len()), length(READING.len()));
    let width = (NAMES + columns * (panel + GAP)).max(MIN_WIDTH);
    let height = HEAD + rows * (panel + GAP) + NAMES;
    let mut svg = String::new();
    {
        let size = [width, height].map(|pixels| u32::try_from(pixels).unwrap_or_default());
        let root = SVGBackend::with_string(&mut svg, size.into()).into_drawing_area();
        root.fill(&WHITE)?;
        let text = |words: &str, at: (i32, i32), size: i32, anchor: HPos| {
            let style = ("sans-serif", size).into_text_style(&root).pos(Pos::new(anchor, VPos::Center));
            root.draw(&Text::new(words.to_owned(), at, style))
        };
        text("Largest error of each blend state", (8, 14), 18, HPos::Left)?;
        for (column, adapter) in (0..).zip(&run.adapters) {
            let left = NAMES + column * (panel + GAP);
            text(&format!("{}, {target}", adapter.name), (left, 40), 15, HPos::Left)?;
            for (row, equation) in (0..).zip(READING) {
                let top = HEAD + row * (panel + GAP);
                text(equation.name(), (left, top - 9), 13, HPos::Left)?;
                for (y, src) in (0..).zip(Factor::ALL) {
                    for (x, dst) in (0..).zip(Factor::ALL) {
                        let shade = shade(run.row(adapter, target, State { equation, src, dst }));
                        let (x, y) = (left + x * CELL, top + y * CELL);
                        root.draw(&Rectangle::new([(x, y), (x + CELL - 1, y + CELL - 1)], shade.filled()))?;
                    }
                    if column == 0 {
                        text(src.name(), (left - 6, top + y * CELL + CELL / 2), 12, HPos::Right)?;
                    }
                }
                if row == rows - 1 {
                    for (x, dst) in (0..).zip(Factor::ALL) {
                        let at = (left + x * CELL + CELL / 2, top + panel + 6);
                        let upright = ("sans-serif", 12).into_font().transform(FontTransform::Rotate90);
                        let style = TextStyle::from(upright).pos(Pos::new(HPos::Left, VPos::Center));
                        root.draw(&Text::new(dst.name(), at, style))?;
                    }
                }
            }
        }
        let y = height - 34;
        let says = "in steps of 1/255; rows are source factors, columns destination factors:";
        text(says, (8, y), 13, HPos::Left)?;
        let words = ["≤ ½", "≤ 1", "≤ 1½", "≤ 2", "more", "fails", "not drawn"];
        let shades = SHADES.map(|(_, shade)| shade).into_iter().chain([FAILS, NOT_DRAWN]);
        for ((place, word), shade) in (0..).zip(words).zip(shades) {
            let x = 8 + 72 * place;
            root.draw(&Rectangle::new([(x, y + 12), (x + 12, y + 24)], shade.filled()))?;
            text(word, (x + 18, y + 18), 13, HPos::Left)?;
        }
        root.present()?;
    }
    Ok(svg)
}

fn length(count: usize) -> i32 {
    i32::try_from(count).unwrap_or_default()
}

fn shade(row: Option<&BlendState>) -> RGBColor {
    match row {
        None => NOT_DRAWN,
        Some(row) if row.failed > 0 => FAILS,
        Some(row) => {
            SHADES.into_iter().find(|(most, _)| row.error_max.0 <= *most).map_or(SHADES[4].1, |(_, shade)| shade)
        }
    }
}
