//! What a mistake does to a formula, as a small plot: an output along the input on which the mistake shows best.

use lightmeter_catalogue::cases::Domain;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_faults::Variation;
use lightmeter_report::html::written;
use maud::{Markup, html};
use std::collections::HashSet;

/// Points of a plot.
const POINTS: usize = 49;
/// Points by which the place is chosen where a mistake shows best.
const TRIED: usize = 9;
/// Random cases among which it is chosen, beside the hard ones.
const CASES: u64 = 12;
/// The most inputs of a case that are tried.
const MOST_INPUTS: usize = 40;
/// Pixels of a plot.
const WIDTH: f64 = 200.0;
const HEIGHT: f64 = 90.0;
/// The least mean share of a plot's height that is seen.
const SEEN: f64 = 0.003;
/// What a hard case counts, whose inputs are seldom those of a scene.
const OF_HARD_CASES: f64 = 0.1;
/// Plots show a mistake as well as the best one down to this share of its clarity, and this many are looked at.
const AS_WELL: f64 = 0.3;
const MOST_TRIED: usize = 24;

/// An output along one number of the inputs, by the formula and with a mistake.
pub(crate) struct Sketch {
    /// The number of the inputs, such as `p.z`.
    pub(crate) input: String,
    /// The number of the outputs.
    pub(crate) output: String,
    from: f64,
    to: f64,
    right: Vec<f64>,
    mistaken: Vec<f64>,
}

/// Where a plot begins and ends, and whether its inputs are spaced by their logarithms.
#[derive(Clone, Copy)]
pub(crate) struct Range {
    pub(crate) from: f64,
    pub(crate) to: f64,
    is_logarithmic: bool,
}

impl Range {
    /// The range of a number of the inputs; `None` where it is drawn from no range.
    pub(crate) fn of(member: &Member, row: &[f32], number: usize) -> Option<Self> {
        let mut start = 0;
        for input in member.spec.inputs {
            let end = start + input.shape.components();
            if (start..end).contains(&number) {
                let length = || row[start..end].iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
                let (from, to, is_logarithmic) = match input.domain {
                    Domain::Uniform(low, high) | Domain::Halves(low, high) => (low.into(), high.into(), false),
                    Domain::LogUniform(low, high) => (low.into(), high.into(), true),
                    Domain::Unit => (0.0, 1.0, false),
                    Domain::Vector(..) | Domain::Transform(..) => (-length(), length(), false),
                    Domain::Direction => (-1.0, 1.0, false),
                    Domain::Whole(low, high) => (low.into(), high.into(), false),
                    _ => return None,
                };
                return (from < to).then_some(Self { from, to, is_logarithmic });
            }
            start = end;
        }
        None
    }

    /// The k-th of several points.
    pub(crate) fn at(self, k: usize, points: usize) -> f32 {
        #[expect(clippy::cast_precision_loss, reason = "some points")]
        let share = k as f64 / (points - 1) as f64;
        let x = if self.is_logarithmic {
            self.from * (self.to / self.from).powf(share)
        } else {
            self.from + share * (self.to - self.from)
        };
        #[expect(clippy::cast_possible_truncation, reason = "an input is an f32")]
        let x = x as f32;
        x
    }
}

/// The cases among which a place is chosen, random ones and hard ones, and whether each is hard.
fn cases(member: &Member) -> impl Iterator<Item = (Vec<f32>, bool)> {
    let hard = (0..member.spec.hard.len()).map(CaseRef::Hard);
    (0..CASES).map(CaseRef::Random).chain(hard).map(|case| {
        let mut row = vec![];
        member.inputs(case, 1, &mut row);
        (row, matches!(case, CaseRef::Hard(_)))
    })
}

/// How far two courses differ on the mean, as a share of what both span.
pub(crate) fn difference(right: &[f64], mistaken: &[f64]) -> f64 {
    let [low, high] = span(right.iter().chain(mistaken));
    if low >= high {
        return 0.0;
    }
    let apart = |(a, b): (&f64, &f64)| if a.is_finite() && b.is_finite() { (a - b).abs() / (high - low) } else { 0.0 };
    #[expect(clippy::cast_precision_loss, reason = "some points")]
    let mean = right.iter().zip(mistaken).map(apart).sum::<f64>() / right.len() as f64;
    mean
}

/// How well a plot tells a mistake: by how far the two courses differ, and by how much the right one varies, since two level lines tell little.
fn clarity(right: &[f64], mistaken: &[f64]) -> f64 {
    const OF_LEVEL_LINES: f64 = 0.02;
    let ([low, high], [least, most]) = (span(right.iter()), span(right.iter().chain(mistaken)));
    let varies = if high > low { (4.0 * (high - low) / (most - least)).min(1.0) } else { 0.0 };
    difference(right, mistaken) * (OF_LEVEL_LINES + varies)
}

pub(crate) fn span<'a>(values: impl Iterator<Item = &'a f64>) -> [f64; 2] {
    let first = [f64::INFINITY, f64::NEG_INFINITY];
    values.filter(|x| x.is_finite()).fold(first, |[low, high], &x| [low.min(x), high.max(x)])
}

/// The plot on which a mistake shows best; `None` where it is too small for one. Of plots that show it nearly as well one is taken that does not
/// look like another of the page, whose looks `shown` holds.
pub(crate) fn sketch(member: &Member, variation: &Variation<'_>, shown: &mut HashSet<Vec<i32>>) -> Option<Sketch> {
    let outputs = member.spec.output_len();
    let mut found: Vec<(f64, Vec<f32>, usize, usize)> = vec![];
    let (mut right, mut mistaken) = (vec![0.0; outputs], vec![0.0; outputs]);
    for (row, is_hard) in cases(member) {
        for input in 0..row.len().min(MOST_INPUTS) {
            let Some(range) = Range::of(member, &row, input) else { continue };
            let mut moved = row.clone();
            let mut courses = vec![(vec![], vec![]); outputs];
            for k in 0..TRIED {
                moved[input] = range.at(k, TRIED);
                member.formula.reference(&moved, &mut right);
                variation.evaluate(&moved, &mut mistaken);
                for (output, (a, b)) in courses.iter_mut().enumerate() {
                    a.push(right[output]);
                    b.push(mistaken[output]);
                }
            }
            for (output, (a, b)) in courses.iter().enumerate() {
                let seen = clarity(a, b) * if is_hard { OF_HARD_CASES } else { 1.0 };
                if seen > 0.0 {
                    found.push((seen, row.clone(), input, output));
                }
            }
        }
    }
    found.sort_by(|(a, ..), (b, ..)| b.total_cmp(a));
    let most = found.first()?.0;
    let near = found.into_iter().take_while(|(clarity, ..)| *clarity > AS_WELL * most).take(MOST_TRIED);
    let mut drawn = near.filter_map(|(_, row, input, output)| drawn(member, variation, row, input, output));
    let best = drawn.next()?;
    let sketch = if shown.contains(&best.look()) { drawn.find(|one| !shown.contains(&one.look())) } else { None };
    let sketch = sketch.unwrap_or(best);
    shown.insert(sketch.look());
    Some(sketch)
}

fn drawn(member: &Member, variation: &Variation<'_>, mut row: Vec<f32>, input: usize, output: usize) -> Option<Sketch> {
    let range = Range::of(member, &row, input)?;
    let outputs = member.spec.output_len();
    let (mut right, mut mistaken) = (vec![0.0; outputs], vec![0.0; outputs]);
    let mut sketch = Sketch {
        input: member.spec.input_name(input),
        output: member.spec.output_name(output),
        from: range.from,
        to: range.to,
        right: vec![],
        mistaken: vec![],
    };
    for k in 0..POINTS {
        row[input] = range.at(k, POINTS);
        member.formula.reference(&row, &mut right);
        variation.evaluate(&row, &mut mistaken);
        sketch.right.push(right[output]);
        sketch.mistaken.push(mistaken[output]);
    }
    (difference(&sketch.right, &sketch.mistaken) > SEEN && sketch.is_readable()).then_some(sketch)
}

impl Sketch {
    /// Whether its upper and its lower end differ in the digits that are told of them, and are not both next to nothing: what lies between is
    /// otherwise rounding, enlarged until it is seen, and told better by numbers.
    fn is_readable(&self) -> bool {
        const LEAST: f64 = 1e-12;
        let [low, high] = span(self.right.iter().chain(&self.mistaken));
        short(low) != short(high) && high.abs().max(low.abs()) >= LEAST
    }

    /// How it looks: both courses in steps of the plot's height.
    fn look(&self) -> Vec<i32> {
        const STEPS: f64 = 24.0;
        let [low, high] = span(self.right.iter().chain(&self.mistaken));
        #[expect(clippy::cast_possible_truncation, reason = "a few steps")]
        let step = |x: &f64| if x.is_finite() { (STEPS * (x - low) / (high - low)).round() as i32 } else { -1 };
        self.right.iter().chain(&self.mistaken).map(step).collect()
    }

    /// The plot.
    pub(crate) fn svg(&self) -> Markup {
        let [low, high] = span(self.right.iter().chain(&self.mistaken));
        let path = |values: &[f64]| {
            let (mut path, mut is_begun) = (String::new(), false);
            for (k, value) in values.iter().enumerate() {
                if !value.is_finite() {
                    is_begun = false;
                    continue;
                }
                #[expect(clippy::cast_precision_loss, reason = "some points")]
                let x = 4.0 + (WIDTH - 8.0) * k as f64 / (POINTS - 1) as f64;
                let y = 4.0 + (HEIGHT - 8.0) * (high - value) / (high - low);
                path += &format!("{}{x:.0} {y:.1}", if is_begun { "L" } else { "M" });
                is_begun = true;
            }
            path
        };
        html! {
            figure.sketch {
                svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label={ (self.output) " along " (self.input) ": right, and with the mistake" } {
                    rect.frame x="1" y="1" width=(WIDTH - 2.0) height=(HEIGHT - 2.0) {}
                    path.reference d=(path(&self.right)) {}
                    path.mistaken d=(path(&self.mistaken)) {}
                }
                figcaption { (self.output) ", " (short(low)) " to " (short(high)) " upwards, along " (self.input) ", " (short(self.from)) " to " (short(self.to)) }
            }
        }
    }
}

/// A number in a few digits.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        let text = format!("{x:.4}");
        written(text.trim_end_matches('0').trim_end_matches('.'))
    } else {
        format!("{x:.2e}").replace('-', "−")
    }
}
