//! The figures of chapters, computed from the formulas that the chapters tell of. A chapter names one as the address of a picture: `![caption](figure:name)`.

use lightmeter_arithmetic::Accept;
use lightmeter_arithmetic::profile::WGSL;
use lightmeter_catalogue::select::{CaseRef, Member, catalogue};
use maud::{Markup, html};

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 220.0;
const LEFT: f64 = 44.0;
const AROUND: f64 = 16.0;

/// A name, and what draws it.
type Figure = (&'static str, fn() -> Markup);

/// All figures.
const FIGURES: [Figure; 4] = [
    ("legal-floats", legal_floats),
    ("narrow-band", narrow_band),
    ("open-pixels", open_pixels),
    ("missed-highlight", missed_highlight),
];

/// The address of a figure's picture in a chapter begins so.
pub(crate) const FIGURE: &str = "figure:";

/// A chapter's HTML with its figures in their places.
pub(crate) fn with_figures(html: &str) -> String {
    let mut text = html.to_owned();
    for (name, draw) in FIGURES {
        let begin = format!("<p><img src=\"{FIGURE}{name}\" alt=\"");
        while let Some((before, rest)) = text.split_once(&begin) {
            let Some((caption, after)) = rest.split_once("\" /></p>") else { break };
            let figure = html! { figure.plot { (draw()) figcaption { (maud::PreEscaped(caption)) } } };
            text = format!("{before}{}{after}", figure.0);
        }
    }
    text
}

/// A formula with the inputs of one of its cases, some of them set.
struct Set {
    member: Member,
    row: Vec<f32>,
}

impl Set {
    fn new(id: &str, case: CaseRef, values: &[(&str, &[f32])]) -> Self {
        let member = catalogue().into_iter().find(|member| member.spec.id == id);
        let member = member.unwrap_or_else(|| unreachable!("{id} is a formula"));
        let mut row = vec![];
        member.inputs(case, 1, &mut row);
        let mut own = Self { member, row };
        values.iter().for_each(|(name, values)| own.set(name, values));
        own
    }

    fn set(&mut self, name: &str, values: &[f32]) {
        let place = self.member.spec.place(name).unwrap_or_else(|| unreachable!("{name} is an input"));
        self.row[place].copy_from_slice(values);
    }

    /// The first number of the outputs, as binary32 gives it and as the reference does.
    fn values(&self) -> [f64; 2] {
        let outputs = self.member.spec.output_len();
        let (mut value, mut reference) = (vec![0.0; outputs], vec![0.0; outputs]);
        self.member.formula.embedded(&self.row, &mut value);
        self.member.formula.reference(&self.row, &mut reference);
        [f64::from(value[0]), reference[0]]
    }

    fn legal(&self) -> Accept {
        let mut legal = vec![Accept::ANY; self.member.spec.output_len()];
        self.member.formula.interval(&self.row, &WGSL, &mut legal);
        legal[0]
    }
}

/// The field of a plot, in which values are placed.
struct Field {
    x: [f64; 2],
    y: [f64; 2],
}

impl Field {
    fn x(&self, x: f64) -> f64 {
        LEFT + (WIDTH - LEFT - AROUND) * (x - self.x[0]) / (self.x[1] - self.x[0])
    }

    fn y(&self, y: f64) -> f64 {
        HEIGHT - 2.0 * AROUND - (HEIGHT - 3.0 * AROUND) * (y - self.y[0]) / (self.y[1] - self.y[0])
    }

    fn path(&self, points: impl Iterator<Item = [f64; 2]>) -> String {
        let at = |(k, [x, y]): (usize, [f64; 2])| {
            format!("{}{:.1} {:.1}", if k == 0 { "M" } else { "L" }, self.x(x), self.y(y))
        };
        points.enumerate().map(at).collect()
    }

    /// A plot with numbers beside it and names below and within.
    fn framed(&self, ticks: [&[(f64, &str)]; 2], name: &str, within: &Markup) -> Markup {
        let [bottom, top] = self.y.map(|y| self.y(y));
        html! {
            svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label=(name) {
                rect.frame x=(LEFT) y=(top) width=(WIDTH - LEFT - AROUND) height=(bottom - top) {}
                (within)
                @for (x, says) in ticks[0] { text.tick x=(format!("{:.1}", self.x(*x))) y=(HEIGHT - AROUND) text-anchor="middle" { (says) } }
                @for (y, says) in ticks[1] { text.tick x=(LEFT - 5.0) y=(format!("{:.1}", self.y(*y) + 4.0)) text-anchor="end" { (says) } }
            }
        }
    }
}

/// The floats around a result, and which of them are legal.
fn legal_floats() -> Markup {
    const BESIDE: i32 = 3;
    let fog = Set::new("fog/exp", CaseRef::Random(0), &[("p", &[0.0, 0.0, -8.0]), ("density", &[0.0625])]);
    let ([value, reference], legal) = (fog.values(), fog.legal());
    #[expect(clippy::cast_possible_truncation, reason = "the ends are floats")]
    let (low, high) = (legal.low() as f32, legal.high() as f32);
    let mut float = (0..BESIDE).fold(low, |x, _| x.next_down());
    let end = (0..BESIDE).fold(high, |x, _| x.next_up());
    let mut floats = vec![];
    while float <= end {
        floats.push(float);
        float = float.next_up();
    }
    let field = Field { x: [f64::from(floats[0].next_down()), f64::from(end.next_up())], y: [0.0, 1.0] };
    let [from, to] = [low, high].map(|x| field.x(f64::from(x)));
    let (top, middle, bottom) = (field.y(1.0), field.y(0.5), field.y(0.0));
    let within = html! {
        rect.band x=(format!("{from:.1}")) y=(top) width=(format!("{:.1}", to - from)) height=(bottom - top) {}
        line.axis x1=(LEFT) x2=(WIDTH - AROUND) y1=(middle) y2=(middle) {}
        line.reference x1=(format!("{:.1}", field.x(reference))) x2=(format!("{:.1}", field.x(reference))) y1=(top) y2=(bottom) {}
        @for x in &floats {
            @let is_legal = low <= *x && *x <= high;
            circle class=(if is_legal { "float legal" } else { "float" }) cx=(format!("{:.1}", field.x(f64::from(*x)))) cy=(middle) r="5" {}
        }
        circle.float.given cx=(format!("{:.1}", field.x(value))) cy=(middle) r="9" {}
        text x=(format!("{:.1}", field.x(reference) + 4.0)) y=(top + 14.0) { "exact: " (format!("{reference:.8}")) }
        text.tick x=(format!("{:.1}", field.x(f64::from(floats[1])))) y=(bottom - 8.0) text-anchor="middle" { "not legal" }
        text.tick x=(format!("{:.1}", field.x(f64::from(floats[floats.len() - 2])))) y=(bottom - 8.0) text-anchor="middle" { "not legal" }
        text.tick x=(format!("{:.1}", f64::midpoint(from, field.x(reference)))) y=(bottom - 8.0) text-anchor="middle" { "legal" }
    };
    let ends = [low, high].map(|x| (f64::from(x), format!("{x:.8}")));
    let ticks = ends.each_ref().map(|(x, says)| (*x, says.as_str()));
    field.framed([&ticks, &[]], "floats around exp(−0.5)", &within)
}

/// Linear fog in a narrow band far away: what is legal of its stable form, and of the naive one.
fn narrow_band() -> Markup {
    let band = |id: &str| Set::new(id, CaseRef::Random(0), &[("dmin", &[99_999.0]), ("dmax", &[100_000.0])]);
    // From the least legal values along the floats, and back by the greatest.
    let legal = |id: &str| -> Vec<[f64; 2]> {
        let mut fog = band(id);
        let (mut z, mut low, mut high) = (99_999.5_f32, vec![], vec![]);
        while z <= 99_999.8 {
            fog.set("p", &[0.0, 0.0, -z]);
            let legal = fog.legal();
            low.push([f64::from(z), legal.low()]);
            high.push([f64::from(z), legal.high()]);
            z = z.next_up();
        }
        low.into_iter().chain(high.into_iter().rev()).collect()
    };
    let (stable, naive) = (legal("fog/linear"), legal("fog/linear-multiply-add"));
    let field = Field { x: [99_999.5, 99_999.8], y: [0.15, 0.55] };
    let within = html! {
        path.band d=(field.path(naive.into_iter())) {}
        path.reference d=(field.path(stable.into_iter())) {}
        text x=(LEFT + 10.0) y=(HEIGHT - 3.0 * AROUND) { "line: (dmax − z)/(dmax − dmin)   band: z·scale + offset" }
    };
    let x = [(99_999.5, "z = 99999.5"), (99_999.6, "99999.6"), (99_999.7, "99999.7")];
    field.framed([&x, &[(0.2, "0.2"), (0.3, "0.3"), (0.4, "0.4"), (0.5, "0.5")]], "fog in a narrow band", &within)
}

/// Pixels of a triangle: covered, not covered, and those whose centre is so near an edge that both are legal.
fn open_pixels() -> Markup {
    const SIDE: f64 = 34.0;
    const PIXELS: [usize; 2] = [16, 6];
    // A vertex moves by less than a step of a sixteenth in either direction.
    let reach = 2.0_f64.sqrt() / 16.0;
    let corners: [[f64; 2]; 3] = [[1.2, 0.3], [15.06, 2.74], [3.1, 5.7]];
    let mut edge = Set::new("interpolation/edge", CaseRef::Random(0), &[]);
    #[expect(clippy::cast_possible_truncation, reason = "inputs are f32")]
    let narrow = |point: [f64; 2]| point.map(|x| x as f32);
    // How far a point is inside of each edge, in pixels: twice an area over the edge's length.
    let mut inside = |point: [f64; 2]| {
        (0..3)
            .map(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                edge.set("a", &narrow(a));
                edge.set("b", &narrow(b));
                edge.set("p", &narrow(point));
                edge.values()[1] / (b[0] - a[0]).hypot(b[1] - a[1])
            })
            .fold(f64::INFINITY, f64::min)
    };
    #[expect(clippy::cast_precision_loss, reason = "some pixels")]
    let centers = (0..PIXELS[1]).flat_map(|y| (0..PIXELS[0]).map(move |x| [x as f64 + 0.5, y as f64 + 0.5]));
    let points = corners.map(|[x, y]| format!("{:.1},{:.1}", x * SIDE, y * SIDE)).join(" ");
    #[expect(clippy::cast_precision_loss, reason = "some pixels")]
    let [width, height] = PIXELS.map(|pixels| pixels as f64 * SIDE);
    html! {
        svg viewBox={ "0 0 " (width) " " (height) } role="img" aria-label="pixels of a triangle" {
            @for [x, y] in centers {
                @let depth = inside([x, y]);
                @let class = if depth.abs() <= reach { "pixel open" } else if depth > 0.0 { "pixel in" } else { "pixel" };
                rect class=(class) x=(format!("{:.1}", (x - 0.5) * SIDE)) y=(format!("{:.1}", (y - 0.5) * SIDE)) width=(SIDE) height=(SIDE) {}
                circle.point cx=(format!("{:.1}", x * SIDE)) cy=(format!("{:.1}", y * SIDE)) r="2" {}
            }
            polygon.freedom points=(points) stroke-width=(format!("{:.1}", 2.0 * reach * SIDE)) {}
            polygon.outline points=(points) {}
        }
    }
}

/// A highlight lit at each fragment, and at vertices 8° apart with the colours between them interpolated.
fn missed_highlight() -> Markup {
    const APART: f64 = 8.0;
    let mut power =
        Set::new("lighting/cosine-power", CaseRef::Random(0), &[("a", &[0.0, 0.0, 1.0]), ("exponent", &[100.0])]);
    let mut lit = |degrees: f64| {
        // The mirrored ray turns twice as far as the normal.
        let (sine, cosine) = (2.0 * degrees).to_radians().sin_cos();
        #[expect(clippy::cast_possible_truncation, reason = "inputs are f32")]
        power.set("b", &[sine as f32, 0.0, cosine as f32]);
        power.values()[1]
    };
    let at = |k: i32| (f64::from(k) + 0.5) * APART;
    let field = Field { x: [-2.5 * APART, 2.5 * APART], y: [0.0, 1.05] };
    let vertices: Vec<[f64; 2]> = (-3..=2).map(|k| [at(k), lit(at(k))]).collect();
    let fragments: Vec<[f64; 2]> =
        (-200..=200).map(|k| f64::from(k) * APART / 80.0).map(|degrees| [degrees, lit(degrees)]).collect();
    let within = html! {
        path.mistaken d=(field.path(vertices.iter().copied())) {}
        path.reference d=(field.path(fragments.into_iter())) {}
        @for [x, y] in &vertices { circle.float cx=(format!("{:.1}", field.x(*x))) cy=(format!("{:.1}", field.y(*y))) r="4" {} }
        text x=(LEFT + 8.0) y=(3.0 * AROUND) { "solid: Phong shading" }
        text x=(LEFT + 8.0) y=(4.0 * AROUND) { "dashed: Gouraud, vertices" }
    };
    let x = [(-APART, "−8°"), (0.0, "0°, the highlight"), (APART, "8°")];
    field.framed([&x, &[(0.0, "0"), (0.5, "0.5"), (1.0, "1")]], "a highlight between vertices", &within)
}

#[cfg(test)]
mod tests {
    use super::{FIGURE, FIGURES, with_figures};

    /// Every figure stands in a chapter, and every figure of a chapter is there.
    #[test]
    fn figures_are_those_that_chapters_name() {
        let chapters = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/book");
        let mut named = vec![];
        for chapter in std::fs::read_dir(chapters).expect("the chapters are there") {
            let text = std::fs::read_to_string(chapter.expect("a file").path()).expect("text");
            let begin = format!("]({FIGURE}");
            let of_text = text.split(&begin).skip(1).filter_map(|rest| rest.split(')').next());
            named.extend(of_text.map(str::to_owned));
        }
        named.sort();
        let mut all = FIGURES.map(|(name, _)| name);
        all.sort_unstable();
        assert_eq!(named, all);
    }

    #[test]
    fn figures_stand_in_place_of_their_names() {
        let html = with_figures("a<p><img src=\"figure:legal-floats\" alt=\"which &amp; why\" /></p>b");
        assert!(html.starts_with("a<figure") && html.ends_with("which &amp; why</figcaption></figure>b"), "{html}");
        // Eight floats are legal, as the chapter says.
        assert_eq!(html.matches("float legal").count(), 8, "{html}");
    }
}
