//! What a mistake does to what is drawn: the pixels of a triangle, or the plane of two depths, as it is right and with the mistake.

use crate::sketch::{difference, short, span};
use lightmeter_catalogue::cases::{Domain, Kind, ValueShape};
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_faults::Variation;
use lightmeter_scene::raster::{Raster, TARGET_SIZE};
use maud::{Markup, html};

/// The most cells of a side.
const CELLS: usize = 20;
/// Random cases among which one is chosen, beside the hard ones.
const CASES: u64 = 24;
/// The side of a panel.
const SIDE: f64 = 100.0;
/// The least mean difference that is seen.
const SEEN: f64 = 0.002;

/// A formula's output over a plane of two of its inputs, right and with a mistake.
pub(crate) struct Grid {
    /// The output.
    output: String,
    /// What lies along the axes, in words.
    plane: &'static str,
    cells: usize,
    right: Vec<f64>,
    mistaken: Vec<f64>,
    /// Triangles, in cells.
    outlines: Vec<[[f64; 2]; 3]>,
}

/// Two numbers of the inputs that are varied, and what they are at the plane's corner and from cell to cell.
struct Plane {
    numbers: [usize; 2],
    corner: [f64; 2],
    step: f64,
    cells: usize,
    outlines: Vec<[[f64; 2]; 3]>,
}

impl Plane {
    fn of(member: &Member, row: &[f32]) -> Option<Self> {
        let first = |name: &str| {
            let mut inputs = member.spec.inputs.iter();
            let before = inputs.by_ref().take_while(|input| input.name != name);
            before.map(|input| input.shape.components()).sum::<usize>()
        };
        let has = |name: &str| member.spec.inputs.iter().any(|input| input.name == name);
        if has("new") && has("old") {
            #[expect(clippy::cast_precision_loss, reason = "some cells")]
            let step = 1.0 / (CELLS - 1) as f64;
            let numbers = [first("new"), first("old")];
            return Some(Self { numbers, corner: [0.0, 0.0], step, cells: CELLS, outlines: vec![] });
        }
        let pixel =
            member.spec.inputs.iter().any(|input| matches!(input.domain, Domain::Pixel)).then(|| first("pixel"))?;
        let outlines = outlines(member, row)?;
        let [low, high]: [[f64; 2]; 2] = [f64::min, f64::max].map(|of: fn(f64, f64) -> f64| {
            [0, 1].map(|axis| outlines.iter().flatten().map(|corner| corner[axis]).reduce(of).unwrap_or(0.0))
        });
        let corner = low.map(|x| (x.floor() - 1.0).clamp(0.0, f64::from(TARGET_SIZE)));
        let size = [0, 1].map(|axis| (high[axis].ceil() + 1.0).min(f64::from(TARGET_SIZE)) - corner[axis]);
        let extent = size[0].max(size[1]).max(4.0);
        #[expect(clippy::cast_precision_loss, reason = "some cells")]
        let step = (extent / CELLS as f64).ceil();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some cells")]
        let cells = (extent / step).ceil() as usize;
        Some(Self { numbers: [pixel, pixel + 1], corner, step, cells, outlines })
    }

    /// Whether the middle of a row's pixel lies in what is drawn; of a plane of depths always.
    fn is_inside(&self, row: &[f32]) -> bool {
        let middle = self.numbers.map(|number| f64::from(row[number]) + 0.5);
        self.outlines.is_empty() || self.outlines.iter().any(|&outline| is_in(outline, middle))
    }

    /// Each output over the plane's cells, by whoever evaluates a row.
    fn values(
        &self,
        member: &Member,
        row: &mut [f32],
        outputs: usize,
        mut evaluate: impl FnMut(&[f32], &mut [f64]),
    ) -> Vec<Vec<f64>> {
        let (mut values, mut courses) = (vec![0.0; outputs], vec![vec![]; outputs]);
        for y in 0..self.cells {
            for x in 0..self.cells {
                self.set(row, [x, y]);
                evaluate(row, &mut values);
                let is_inside = self.is_inside(row);
                for (output, course) in courses.iter_mut().enumerate() {
                    // Outside of what is drawn nothing but the coverage is a value.
                    let is_value = is_inside || is_coverage(member, output);
                    course.push(if is_value { values[output] } else { f64::NAN });
                }
            }
        }
        courses
    }

    /// A picture of the plane that is still empty.
    fn grid(&self, member: &Member, output: usize) -> Grid {
        let in_cells = |p: [f64; 2]| [0, 1].map(|axis| (p[axis] - self.corner[axis]) / self.step);
        let is_of_depths = self.outlines.is_empty();
        let plane = if is_of_depths {
            "the new depth to the right, the old one upwards"
        } else {
            "over the pixels of a triangle"
        };
        Grid {
            output: member.spec.output_name(output),
            plane,
            cells: self.cells,
            right: vec![],
            mistaken: vec![],
            outlines: self.outlines.iter().map(|outline| outline.map(in_cells)).collect(),
        }
    }

    /// The inputs of a cell.
    fn set(&self, row: &mut [f32], cell: [usize; 2]) {
        for (axis, k) in cell.into_iter().enumerate() {
            #[expect(
                clippy::cast_precision_loss,
                clippy::cast_possible_truncation,
                reason = "some cells; an input is an f32"
            )]
            let x = (self.corner[axis] + k as f64 * self.step) as f32;
            row[self.numbers[axis]] = x;
        }
    }
}

/// The triangles that are drawn, in pixels; `None` where a vertex lies behind the eye.
fn outlines(member: &Member, row: &[f32]) -> Option<Vec<[[f64; 2]; 3]>> {
    let mut corners = vec![];
    let mut start = 0;
    for input in member.spec.inputs {
        let numbers: Vec<f64> = row[start..start + input.shape.components()].iter().map(|&x| x.into()).collect();
        start += numbers.len();
        match (input.name, input.shape) {
            ("a" | "b" | "c" | "d", ValueShape::Vec2) => corners.push([numbers[0], numbers[1]]),
            ("a" | "b" | "c", ValueShape::Vec4) if numbers[3] > 0.0 => {
                let half = 0.5 * f64::from(TARGET_SIZE);
                let ndc = [numbers[0] / numbers[3], numbers[1] / numbers[3]];
                corners.push([(1.0 + ndc[0]) * half, (1.0 - ndc[1]) * half]);
            }
            ("a" | "b" | "c", ValueShape::Vec4) => return None,
            _ => {}
        }
    }
    match corners[..] {
        [a, b] => Some(vec![[a, b, b]]),
        [a, b, c] => Some(vec![[a, b, c]]),
        [a, b, c, d] => Some(vec![[a, b, c], [a, c, d]]),
        _ => None,
    }
}

/// Whether a pixel's middle lies in a triangle, or within a pixel of a line, whose last two corners are one.
fn is_in([a, b, c]: [[f64; 2]; 3], p: [f64; 2]) -> bool {
    if b.map(f64::to_bits) == c.map(f64::to_bits) {
        let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
        let t = (along[0] * to[0] + along[1] * to[1]) / (along[0].powi(2) + along[1].powi(2));
        let off = [0, 1].map(|axis| to[axis] - t.clamp(0.0, 1.0) * along[axis]);
        return off[0].hypot(off[1]) < 1.0;
    }
    let side = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|&e| e >= 0.0) || sides.iter().all(|&e| e <= 0.0)
}

/// Whether an output says by how many triangles a pixel is covered. Of culling the pixel is one that the triangle covers.
fn is_coverage(member: &Member, output: usize) -> bool {
    let is_culling = matches!(member.spec.kind, Kind::Raster(Raster::Culled { .. }));
    !is_culling && matches!(member.spec.output_name(output).as_str(), "covered" | "count")
}

/// The picture on which a mistake shows best; `None` where there is no plane to show it on.
pub(crate) fn grid(member: &Member, variation: &Variation<'_>) -> Option<Grid> {
    if !matches!(member.spec.kind, Kind::Raster(_) | Kind::Depth(_)) {
        return None;
    }
    let hard = (0..member.spec.hard.len()).map(CaseRef::Hard);
    let cases = (0..CASES).map(CaseRef::Random).chain(hard).filter_map(|case| {
        let mut row = vec![];
        member.inputs(case, 1, &mut row);
        drawn(member, variation, row)
    });
    let (seen, grid) = cases.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    (seen > SEEN).then_some(grid)
}

/// The picture of a formula that is right, of the case in which its output varies most; `None` where there is no plane to show it on.
pub(crate) fn plain(member: &Member) -> Option<Grid> {
    if !matches!(member.spec.kind, Kind::Raster(_) | Kind::Depth(_)) {
        return None;
    }
    let outputs = member.spec.output_len();
    let cases = (0..CASES).filter_map(|case| {
        let mut row = vec![];
        member.inputs(CaseRef::Random(case), 1, &mut row);
        let plane = Plane::of(member, &row)?;
        let courses = plane.values(member, &mut row, outputs, |row, values| member.formula.reference(row, values));
        let varies = |values: &[f64]| {
            let finite = || values.iter().filter(|x| x.is_finite());
            let [low, high] = span(finite());
            let is_high = |x: &&f64| **x > 0.5 * (low + high);
            // As evenly as the two halves of its values are shared out.
            let (above, all) = (finite().filter(is_high).count(), finite().count());
            if high > low { above.min(all - above) } else { 0 }
        };
        let (output, right) = courses.into_iter().enumerate().max_by_key(|(_, values)| varies(values))?;
        let seen = varies(&right);
        Some((seen, Grid { mistaken: vec![], right, ..plane.grid(member, output) }))
    });
    // Of equals the first.
    let (seen, grid) = cases.reduce(|best, other| if other.0 > best.0 { other } else { best })?;
    (seen > 0).then_some(grid)
}

/// A case's picture, and how well it shows the mistake.
fn drawn(member: &Member, variation: &Variation<'_>, mut row: Vec<f32>) -> Option<(f64, Grid)> {
    let plane = Plane::of(member, &row)?;
    let outputs = member.spec.output_len();
    let right = plane.values(member, &mut row, outputs, |row, values| member.formula.reference(row, values));
    let mistaken = plane.values(member, &mut row, outputs, |row, values| variation.evaluate(row, values));
    let seen = |(_, (a, b)): &(usize, (Vec<f64>, Vec<f64>))| difference(a, b);
    let best = right.into_iter().zip(mistaken).enumerate().max_by(|a, b| seen(a).total_cmp(&seen(b)))?;
    let seen = seen(&best);
    let (output, (right, mistaken)) = best;
    Some((seen, Grid { right, mistaken, ..plane.grid(member, output) }))
}

impl Grid {
    /// Both panels, or that of what is right alone.
    pub(crate) fn svg(&self) -> Markup {
        let [low, high] = span(self.right.iter().chain(&self.mistaken));
        if self.mistaken.is_empty() {
            return html! {
                figure.sketch.grid.alone {
                    svg viewBox={ "0 0 " (SIDE) " " (SIDE) } role="img" aria-label={ (self.output) " " (self.plane) } {
                        (self.panel(0.0, &self.right, [low, high]))
                    }
                    figcaption { (self.output) " " (self.plane) "; the more ink, the greater, " (short(low)) " to " (short(high)) }
                }
            };
        }
        html! {
            figure.sketch.grid {
                svg viewBox={ "0 0 " (2.0 * SIDE + 10.0) " " (SIDE) } role="img" aria-label={ (self.output) " " (self.plane) ": right, and with the mistake" } {
                    (self.panel(0.0, &self.right, [low, high]))
                    (self.panel(SIDE + 10.0, &self.mistaken, [low, high]))
                }
                figcaption { (self.output) " " (self.plane) ", right and with the mistake; the more ink, the greater, " (short(low)) " to " (short(high)) }
            }
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "some cells")]
    fn panel(&self, left: f64, values: &[f64], [low, high]: [f64; 2]) -> Markup {
        let size = SIDE / self.cells as f64;
        let mut cells: Vec<(f64, f64, f64, f64)> = vec![];
        for y in 0..self.cells {
            // Depth grows upwards, rows of pixels downwards.
            let row = if self.outlines.is_empty() { self.cells - 1 - y } else { y };
            let mut run: Option<(usize, f64)> = None;
            for x in 0..=self.cells {
                let value = (x < self.cells).then(|| values[row * self.cells + x]);
                let shade = value.filter(|value| value.is_finite()).map(|value| (value - low) / (high - low));
                if let Some((from, of)) = run.filter(|(_, of)| shade != Some(*of)) {
                    cells.push((left + from as f64 * size, y as f64 * size, (x - from) as f64 * size, of));
                    run = None;
                }
                run = run.or_else(|| shade.filter(|shade| *shade > 0.0).map(|shade| (x, shade)));
            }
        }
        html! {
            @for (x, y, width, shade) in cells {
                rect.shade x=(format!("{x:.1}")) y=(format!("{y:.1}")) width=(format!("{width:.1}")) height=(format!("{:.1}", size + 0.2)) fill-opacity=(format!("{:.2}", 0.1 + 0.7 * shade)) {}
            }
            @for outline in &self.outlines {
                polygon.side points=(outline.map(|[x, y]| format!("{:.1},{:.1}", left + (x * size).clamp(0.0, SIDE), (y * size).clamp(0.0, SIDE))).join(" ")) {}
            }
            rect.frame x=(left) y="0" width=(SIDE) height=(SIDE) {}
        }
    }
}
