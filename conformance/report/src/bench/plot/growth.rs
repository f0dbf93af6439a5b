//! Time against work, a panel for each kind of work, with the law that was fitted.

use super::axis::Axis;
use super::label::Area;
use super::mark::{mark, style};
use super::panels::unit;
use super::svg::{SIZE, WIDTH, across, escaped, frame, open, shortened, text, up, upward};
use crate::bench::text::law;
use lightmeter_document::bench::{Fit, Scaling};
use lightmeter_document::thousands;
use std::fmt::{Error, Result as Written, Write};

const COLUMNS: usize = 2;
const PANEL: f64 = WIDTH / 2.0;
const HEIGHT: f64 = 334.0;
const HEAD: f64 = 58.0;

/// A picture with a panel for each kind of work that has steps.
pub(super) fn svg(scalings: &[Scaling], title: &str) -> Result<Option<String>, Error> {
    let scalings: Vec<&Scaling> = scalings.iter().filter(|scaling| !scaling.points.is_empty()).collect();
    if scalings.is_empty() {
        return Ok(None);
    }
    let mut out = String::new();
    let mut top = HEAD;
    let height = HEAD + HEIGHT * (0..scalings.len().div_ceil(COLUMNS)).map(|_| 1.0).sum::<f64>() - 4.0;
    let below = "points: the median and the middle half of the turns; line: the fitted law";
    open(height, title, below, &mut out)?;
    for pair in scalings.chunks(COLUMNS) {
        let mut left = 0.0;
        for scaling in pair {
            panel(scaling, [left, top], &mut out)?;
            left += PANEL;
        }
        top += HEIGHT;
    }
    out.push_str("</svg>\n");
    Ok(Some(out))
}

#[expect(clippy::cast_precision_loss, reason = "work is far below 2⁵³, and this is a picture")]
fn panel(scaling: &Scaling, [left, top]: [f64; 2], out: &mut String) -> Written {
    let area = Area { left: left + 66.0, top: top + 58.0, width: PANEL - 66.0 - 16.0, height: HEIGHT - 58.0 - 76.0 };
    let (right, bottom) = (area.left + area.width, area.top + area.height);
    let room = PANEL - 80.0;
    writeln!(
        out,
        r#"<text x="{:.1}" y="{:.1}" font-size="14" font-weight="bold">{}</text>"#,
        area.left,
        top + 14.0,
        escaped(&scaling.id)
    )?;
    text([area.left, top + 32.0], "start", true, &shortened(&scaling.what, 12.0, room), out)?;
    text([area.left, top + 49.0], "start", true, &shortened(&law(scaling), 12.0, room), out)?;
    let x = Axis::over(scaling.points.iter().map(|point| point.work as f64), 0.7, [area.left, right]);
    let times = scaling.points.iter().flat_map(|point| [point.ns, point.quartiles_ns[0], point.quartiles_ns[1]]);
    let y = Axis::over(times, 1.0, [bottom, area.top]);
    let (scale, name) = unit(y.ends()[1]);
    up(&y, [area.left, right], 7, scale, out)?;
    across(&x, [area.top, bottom], 7, 1.0, out)?;
    frame(area, out)?;
    upward([left + 18.0, area.top + area.height / 2.0], &format!("time, {name}"), out)?;
    text([right, bottom + 34.0], "end", true, &format!("{}, by {}", scaling.unit, scaling.clock), out)?;
    if let Some(fit) = &scaling.fit {
        curve(fit, &x, &y, scaling, out)?;
    }
    for point in &scaling.points {
        let at = x.at(point.work as f64);
        let [low, high] = point.quartiles_ns.map(|ns| y.at(ns));
        writeln!(out, r##"<path d="M{at:.1} {low:.1}V{high:.1}" stroke="#0072B2" stroke-width="1.4"/>"##)?;
        mark(style("f32", 0), [at, y.at(point.ns)], 4.5, false, out)?;
    }
    let lacking: Vec<String> =
        scaling.unavailable.iter().map(|(work, why)| format!("{} not reached: {why}", thousands(*work))).collect();
    text([area.left - 54.0, bottom + 50.0], "start", true, &shortened(&lacking.join("; "), SIZE, PANEL - 24.0), out)
}

#[expect(clippy::cast_precision_loss, reason = "as above")]
fn curve(fit: &Fit, x: &Axis, y: &Axis, scaling: &Scaling, out: &mut String) -> Written {
    let (Some(first), Some(last)) = (scaling.points.first(), scaling.points.last()) else { return Ok(()) };
    let (from, to) = ((first.work as f64).max(1.0), (last.work as f64).max(1.0));
    let mut path = String::new();
    for step in 0..=48 {
        let work = from * (to / from).powf(f64::from(step) / 48.0);
        let ns = fit.fixed_ns + fit.factor_ns * work.powf(fit.exponent);
        write!(path, "{}{:.1} {:.1}", if step == 0 { 'M' } else { 'L' }, x.at(work), y.at(ns))?;
    }
    let [start, end] = y.pixels();
    debug_assert!(start > end, "upward");
    writeln!(out, r##"<path d="{path}" fill="none" stroke="#D55E00" stroke-width="1.6"/>"##)
}
