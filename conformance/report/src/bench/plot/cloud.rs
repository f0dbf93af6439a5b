//! Rungs over many groups: a large marker each, and a small one for each group.

use super::axis::{Axis, ErrorAxis};
use super::label::{Area, Room};
use super::mark::{mark, style};
use super::svg::{Named, SIZE, WIDTH, across, errors, frame, markers, open, shortened, text, upward};
use crate::bench::figures::count;
use lightmeter_document::bench::ladder::RungSummary;
use std::fmt::{Error, Result as Written, Write};

/// What is drawn.
pub(super) struct Cloud<'a> {
    pub(super) title: String,
    pub(super) rungs: &'a [RungSummary],
    pub(super) front: &'a [String],
    /// What a small point is: `formula`, `scene`.
    pub(super) of: &'a str,
    /// What errors are, and in what.
    pub(super) error: &'a str,
}

const PLOT: Area = Area { left: 78.0, top: 58.0, width: WIDTH - 78.0 - 16.0, height: 440.0 };
/// Pixels of a large marker, and of a small one.
const LARGE: f64 = 8.5;
const LITTLE: f64 = 3.2;

impl Cloud<'_> {
    /// The picture, if any rung was measured.
    pub(super) fn svg(&self) -> Result<Option<String>, Error> {
        let points = || self.rungs.iter().flat_map(|rung| &rung.points);
        if points().next().is_none() {
            return Ok(None);
        }
        let (right, bottom) = (PLOT.left + PLOT.width, PLOT.top + PLOT.height);
        let groups = self
            .rungs
            .iter()
            .map(|rung| rung.groups + rung.as_f32 + rung.disqualified + rung.unavailable)
            .max()
            .unwrap_or(0);
        let below = format!(
            "{}; large: the geometric mean of ratios and the median of largest errors; small: one {} each",
            count(groups, self.of),
            self.of
        );
        let mut out = String::new();
        open(bottom + 76.0, &self.title, &below, &mut out)?;
        let measured = || self.rungs.iter().filter(|rung| rung.groups > 0);
        let ratios = points().map(|point| point.1).chain(measured().map(|rung| rung.ratio));
        // How far legal values reach is shown as far as the others' errors go.
        let is_bounded = |rung: &&RungSummary| rung.name != "cpu-accept";
        let shown = || measured().filter(is_bounded);
        let of_points = shown().flat_map(|rung| &rung.points).map(|point| point.2);
        let largest = of_points.chain(shown().map(|rung| rung.error));
        let x = Axis::over(ratios, 0.6, [PLOT.left, right]);
        let y = ErrorAxis::over(largest, [PLOT.top, bottom], 15.0);
        errors(&y, [PLOT.left, right], 12, &mut out)?;
        across(&x, [PLOT.top, bottom], 14, 1.0, &mut out)?;
        frame(PLOT, &mut out)?;
        let mut room = Room::new(PLOT);
        self.points(&x, &y, &mut room, &mut out)?;
        let named = measured().enumerate().map(|(place, rung)| Named {
            name: rung.name.clone(),
            at: [x.at(rung.ratio), y.at(rung.error)],
            r: LARGE,
            style: style(&rung.name, place),
            front: self.front.iter().position(|name| *name == rung.name),
            is_hollow: false,
        });
        markers(&named.collect::<Vec<_>>(), room, &mut out)?;
        let middle = PLOT.left + PLOT.width / 2.0;
        text([middle, bottom + 36.0], "middle", false, "time over that of f32", &mut out)?;
        upward([18.0, PLOT.top + PLOT.height / 2.0], self.error, &mut out)?;
        self.footnote(bottom + 60.0, &mut out)?;
        out.push_str("</svg>\n");
        Ok(Some(out))
    }

    fn points(&self, x: &Axis, y: &ErrorAxis, room: &mut Room, out: &mut String) -> Written {
        writeln!(out, r#"<g opacity="0.4">"#)?;
        for (place, rung) in self.rungs.iter().filter(|rung| rung.groups > 0).enumerate() {
            for (point, (_, ratio, error)) in rung.points.iter().enumerate() {
                let at = [x.at(*ratio), y.at_place(*error, point)];
                mark(style(&rung.name, place), at, LITTLE, false, out)?;
                room.take(Area::around(at, LITTLE), 0.6);
            }
        }
        writeln!(out, "</g>")
    }

    fn footnote(&self, y: f64, out: &mut String) -> Written {
        let lacking: Vec<&str> =
            self.rungs.iter().filter(|rung| rung.groups == 0).map(|rung| rung.name.as_str()).collect();
        let mut words =
            "line and bold names: nothing else is both faster and closer; grey: on the processor".to_owned();
        if !lacking.is_empty() {
            write!(words, "; not measured: {}", lacking.join(", "))?;
        }
        text([12.0, y], "start", false, &shortened(&words, SIZE, WIDTH - 24.0), out)
    }
}
