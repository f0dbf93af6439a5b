//! Charts with logarithmic axes, drawn as SVG by `plotters`.
//!
//! What has no logarithm is shown all the same: a 0 lies in a band at the bottom, what is infinite or no number in one at the top. Every
//! series is named in a legend beside the chart, so that no name lies upon a point.

mod axis;
mod marker;

use axis::Axis;
pub(crate) use axis::power;
pub(crate) use marker::{Marker, marker};
use plotters::coord::Shift;
use plotters::prelude::{
    BLACK, Cartesian2d, ChartBuilder, ChartContext, Circle, Color as _, DrawingArea, EmptyElement, FontStyle,
    IntoDrawingArea as _, IntoFont as _, PathElement, Polygon, RGBColor, Rectangle, SVGBackend, Text, WHITE,
};

/// Pixels across: what a page has room for.
const WIDTH: u32 = 940;
const HEIGHT: u32 = 520;
/// Pixels above the chart, of the legend beside it, and of one of its lines.
const HEAD: u32 = 66;
const LEGEND: u32 = 250;
const LINE: i32 = 22;
/// Pixels of a marker from its middle to its side.
const LARGE: f64 = 7.0;

/// A chart.
#[derive(Clone, Debug, Default)]
pub(crate) struct Chart {
    pub(crate) title: String,
    /// A line below the title, which says what the marks are.
    pub(crate) below: String,
    /// What is shown from left to right.
    pub(crate) across: Quantity,
    /// What is shown upwards.
    pub(crate) upwards: Quantity,
    pub(crate) series: Vec<Series>,
    /// What a line is, and the points that it leads through.
    pub(crate) line: Option<(String, Vec<[f64; 2]>)>,
    /// What else is said below the legend.
    pub(crate) notes: Vec<String>,
}

/// What an axis shows.
#[derive(Clone, Debug)]
pub(crate) struct Quantity {
    /// With its unit.
    pub(crate) name: String,
    /// A value as it is written beside the axis.
    pub(crate) written: fn(f64) -> String,
}

impl Default for Quantity {
    fn default() -> Self {
        Self { name: String::new(), written: axis::power }
    }
}

impl Quantity {
    /// A quantity whose values are written as numbers or powers of ten.
    pub(crate) fn new(name: &str) -> Self {
        Self { name: name.into(), ..Self::default() }
    }
}

/// Points of one kind.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    pub(crate) name: String,
    pub(crate) marker: Marker,
    /// Points that stand for the whole series.
    pub(crate) large: Vec<[f64; 2]>,
    /// Single values.
    pub(crate) small: Vec<[f64; 2]>,
    /// Ranges, from one point to another.
    pub(crate) ranges: Vec<[[f64; 2]; 2]>,
    /// Whether its name is bold.
    pub(crate) is_bold: bool,
    /// Whether its marks are hollow.
    pub(crate) is_hollow: bool,
}

impl Series {
    /// A series without points.
    pub(crate) fn new(name: &str, marker: Marker) -> Self {
        let (large, small, ranges) = (vec![], vec![], vec![]);
        Self { name: name.into(), marker, large, small, ranges, is_bold: false, is_hollow: false }
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Plane<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<axis::Ticked, axis::Ticked>>;
/// Why the library could not write a chart.
pub(crate) type Undrawn = Box<dyn std::error::Error + Send + Sync>;

impl Chart {
    /// The picture.
    ///
    /// # Errors
    /// Where the library cannot write it.
    pub(crate) fn svg(&self) -> Result<String, Undrawn> {
        let lines = i32::try_from(self.series.len() + self.notes.len() + 2).unwrap_or_default();
        let height = HEIGHT.max(HEAD + u32::try_from(lines * LINE).unwrap_or_default());
        let mut svg = String::new();
        {
            let root = SVGBackend::with_string(&mut svg, (WIDTH, height)).into_drawing_area();
            root.fill(&WHITE)?;
            let (head, rest) = root.split_vertically(HEAD);
            head.draw(&Text::new(self.title.clone(), (14, 10), ("sans-serif", 19).into_font().style(FontStyle::Bold)))?;
            head.draw(&Text::new(self.below.clone(), (14, 38), ("sans-serif", 14)))?;
            let (plane, legend) = rest.split_horizontally(WIDTH - LEGEND);
            self.plane(&plane)?;
            self.legend(&legend)?;
            root.present()?;
        }
        Ok(svg)
    }

    fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        let series =
            self.series.iter().flat_map(|one| one.large.iter().chain(&one.small).chain(one.ranges.iter().flatten()));
        series.chain(self.line.iter().flat_map(|(_, points)| points)).copied()
    }

    fn plane(&self, area: &Area<'_>) -> Result<(), Undrawn> {
        let (x, y) = (Axis::over(self.points().map(|[x, _]| x)), Axis::over(self.points().map(|[_, y]| y)));
        let mut plane = ChartBuilder::on(area)
            .margin_right(14)
            .margin_left(10)
            .x_label_area_size(54)
            .y_label_area_size(88)
            .build_cartesian_2d(x.ticked(10), y.ticked(14))?;
        let ([left, right], [bottom, top]) = (x.ends(), y.ends());
        let bands = y.bands().into_iter().map(|band| [(left, band.ends[0]), (right, band.ends[1])]);
        let bands = bands.chain(x.bands().into_iter().map(|band| [(band.ends[0], bottom), (band.ends[1], top)]));
        plane.draw_series(bands.map(|corners| Rectangle::new(corners, RGBColor(240, 240, 240).filled())))?;
        let label = |axis: &Axis, quantity: &Quantity, at: f64| {
            let band = axis.bands().into_iter().find(|band| band.holds(at));
            band.map_or_else(|| (quantity.written)(10_f64.powf(at)), |band| band.name.into())
        };
        plane
            .configure_mesh()
            .max_light_lines(0)
            .bold_line_style(RGBColor(226, 226, 226))
            .axis_style(RGBColor(120, 120, 120))
            .label_style(("sans-serif", 14))
            .axis_desc_style(("sans-serif", 15))
            .x_desc(self.across.name.clone())
            .y_desc(self.upwards.name.clone())
            .x_label_formatter(&|at| label(&x, &self.across, *at))
            .y_label_formatter(&|at| label(&y, &self.upwards, *at))
            .draw()?;
        let at = |[a, b]: [f64; 2]| (x.at(a), y.at(b));
        for one in &self.series {
            // Of a series of many points most lie in the same place: each is faint.
            let small = one.small.iter().map(|point| Circle::new(at(*point), 3, one.marker.color.mix(0.35).filled()));
            plane.draw_series(small)?;
            let range = |[from, to]: &[[f64; 2]; 2]| PathElement::new(vec![at(*from), at(*to)], one.marker.color);
            plane.draw_series(one.ranges.iter().map(range))?;
        }
        if let Some((_, points)) = &self.line {
            let path: Vec<_> = points.iter().map(|point| at(*point)).collect();
            plane.draw_series(std::iter::once(PathElement::new(path, BLACK.stroke_width(2))))?;
        }
        for one in &self.series {
            one.large.iter().try_for_each(|point| mark(&mut plane, at(*point), one))?;
        }
        Ok(())
    }

    fn legend(&self, area: &Area<'_>) -> Result<(), Undrawn> {
        let mut y = LINE / 2;
        if let Some((name, _)) = &self.line {
            area.draw(&PathElement::new(vec![(8, y), (30, y)], BLACK.stroke_width(2)))?;
            area.draw(&Text::new(name.clone(), (40, y - 8), ("sans-serif", 14)))?;
            y += LINE;
        }
        for one in &self.series {
            let outline = one.marker.outline(LARGE);
            if one.is_hollow {
                let path = outline.iter().chain(outline.first()).copied().collect::<Vec<_>>();
                area.draw(&(EmptyElement::at((19, y)) + PathElement::new(path, one.marker.color.stroke_width(2))))?;
            } else {
                area.draw(&(EmptyElement::at((19, y)) + Polygon::new(outline, one.marker.color.filled())))?;
            }
            let weight = if one.is_bold { FontStyle::Bold } else { FontStyle::Normal };
            area.draw(&Text::new(one.name.clone(), (40, y - 8), ("sans-serif", 14).into_font().style(weight)))?;
            y += LINE;
        }
        for note in &self.notes {
            area.draw(&Text::new(note.clone(), (8, y - 8), ("sans-serif", 13)))?;
            y += LINE;
        }
        Ok(())
    }
}

/// Draws a large marker.
fn mark(plane: &mut Plane<'_, '_>, at: (f64, f64), series: &Series) -> Result<(), Undrawn> {
    let outline = series.marker.outline(LARGE);
    let path: Vec<_> = outline.iter().chain(outline.first()).copied().collect();
    if !series.is_hollow {
        plane
            .draw_series(std::iter::once(EmptyElement::at(at) + Polygon::new(outline, series.marker.color.filled())))?;
    }
    let edge = if series.is_hollow { series.marker.color.stroke_width(2) } else { WHITE.stroke_width(1) };
    plane.draw_series(std::iter::once(EmptyElement::at(at) + PathElement::new(path, edge)))?;
    Ok(())
}
