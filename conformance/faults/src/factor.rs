//! A parameter some factor times what was asked: found by a search over factors, refined by Gauss and Newton's method, and
//! held against the interval of the scaled input.

use super::row::Arithmetic;
use super::variation::Variation;
use lightmeter_arithmetic::{Accept, F32, Format as _, Profile};
use lightmeter_catalogue::cases::{Domain, Spec};
use lightmeter_judge::diagnose::Answered;
use lightmeter_reference::Real as _;
use serde::Serialize;
use std::ops::Range;

/// An input, or an output, and how many times what it should be it seems to be.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scaled {
    /// Its name.
    pub name: &'static str,
    /// Whether it is an output.
    pub is_output: bool,
    /// The factor.
    pub factor: f64,
    /// What the factor is uncertain by, relatively: three standard errors.
    pub uncertainty: f64,
    #[serde(skip)]
    range: Range<usize>,
}

/// Cases that a factor is sought on.
const ROWS: usize = 64;
/// Steps of the refinement.
const STEPS: usize = 16;
/// Factors from 2⁻⁸ to 2⁸ in steps of a sixth of an octave: at the ends and beyond, what seems to be one is something else. Exponents are taken
/// times 128 where a shininess from 0 to 1 is meant.
const OCTAVES: i32 = 8;
const STEPS_AN_OCTAVE: i32 = 6;
/// The same where mistakes are tried with parameters, cases, and how many of those are sought well.
const ROUGH_STEPS: i32 = 2;
const FEW_ROWS: usize = 6;
const NEAREST: usize = 12;
/// Cases that every mistake with every parameter is tried on first, and the part that is then tried on more: one in this number.
const FEWER_ROWS: usize = 2;
const NEAR: usize = 4;
/// What is left of the cost of the parameter as it was asked, at most.
const MOST_COST: f64 = 0.9;

impl Scaled {
    const fn one(name: &'static str, range: Range<usize>, is_output: bool) -> Self {
        Self { name, is_output, factor: 1.0, uncertainty: 0.0, range }
    }

    /// In words: "as if shininess were 4.00 times what was asked".
    #[must_use]
    pub fn says(&self) -> String {
        self.says_of(self.name)
    }

    /// The same, of what is called so.
    pub(super) fn says_of(&self, name: &str) -> String {
        let percent = (self.factor - 1.0) * 100.0;
        let asked = if self.is_output { "what it should be" } else { "what was asked" };
        if percent.abs() < 10.0 {
            let way = if percent < 0.0 { "smaller" } else { "larger" };
            format!("as if {name} were {} % {way}", digits(percent.abs(), 2))
        } else {
            format!("as if {name} were {} times {asked}", digits(self.factor, 3))
        }
    }

    /// What is legal with the input so much greater, the factor known as well as it is.
    pub(super) fn interval(&self, variation: &Variation<'_>, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        let factor =
            Accept::from_bounds(self.factor * (1.0 - self.uncertainty), self.factor * (1.0 + self.uncertainty));
        profile.scope(|| {
            let mut row: Vec<Accept> = inputs.iter().map(|&x| Accept::input(x)).collect();
            self.scaled(variation, factor, &mut row, out);
        });
    }

    /// The outputs in f32.
    pub(super) fn evaluate(&self, variation: &Variation<'_>, inputs: &[f32], out: &mut [f32]) {
        #[expect(clippy::cast_possible_truncation, reason = "the factor in f32")]
        self.scaled(variation, self.factor as f32, &mut inputs.to_vec(), out);
    }

    fn scaled<R: Arithmetic>(&self, variation: &Variation<'_>, factor: R, row: &mut [R], out: &mut [R]) {
        let scale =
            |row: &mut [R]| row.get_mut(self.range.clone()).into_iter().flatten().for_each(|x| *x = *x * factor);
        if !self.is_output {
            scale(row);
        }
        variation.evaluate_row(row, out);
        if self.is_output {
            scale(out);
        }
    }
}

/// A number to `digits` significant digits.
pub(super) fn digits(x: f64, significant: i32) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    #[expect(clippy::cast_possible_truncation, reason = "an exponent of f64 is a small number")]
    let magnitude = x.abs().log10().floor() as i32;
    if !(-6..=9).contains(&magnitude) {
        let places = usize::try_from(significant - 1).unwrap_or_default();
        return format!("{x:.places$e}");
    }
    let places = usize::try_from(significant - 1 - magnitude).unwrap_or_default();
    format!("{x:.places$}")
}

/// Inputs that are scaled as a whole, with their names and places. A direction's length, mostly normalised away, is none.
pub(super) fn parameters(spec: &Spec) -> impl Iterator<Item = (&'static str, Range<usize>)> {
    let scalable = |domain: Domain| {
        !matches!(domain, Domain::Direction | Domain::Weights | Domain::Pixel | Domain::Around | Domain::Whole(..))
    };
    spec.inputs
        .iter()
        .filter(move |input| scalable(input.domain))
        .filter_map(|input| Some((input.name, spec.place(input.name)?)))
}

/// Factors of each parameter that would explain the answers best, whether they do or not.
pub(super) fn candidates(variation: &Variation<'_>, failing: &[Answered<'_>], places: &Range<usize>) -> Vec<Scaled> {
    let rows = rows(failing, places, ROWS);
    if rows.is_empty() {
        return vec![];
    }
    let spec = &variation.member.spec;
    let mut start = 0;
    let outputs = spec.outputs.iter().map(|output| {
        let range = start..start + output.shape.components();
        start = range.end;
        Scaled::one(output.name, range, true)
    });
    let outputs: Vec<Scaled> = outputs.collect();
    let inputs = parameters(spec).map(|(name, range)| Scaled::one(name, range, false));
    inputs.chain(outputs).filter_map(|scaled| search(variation, &rows, scaled)).collect()
}

/// The mistakes with an input some factor times what was asked that come nearest to the answers to a few cases by rough factors,
/// each with its factor sought well.
pub(super) fn nearest<'a, 'b>(
    variations: &'b [Variation<'a>],
    failing: &[Answered<'_>],
    places: &Range<usize>,
) -> Vec<(&'b Variation<'a>, Scaled)> {
    let (few, all) = (rows(failing, places, FEW_ROWS), rows(failing, places, ROWS));
    if few.is_empty() {
        return vec![];
    }
    let mut tried: Vec<(&Variation<'_>, Scaled)> = vec![];
    for variation in variations {
        let scaled = parameters(&variation.member.spec).map(|(name, range)| Scaled::one(name, range, false));
        tried.extend(scaled.map(|scaled| (variation, scaled)));
    }
    // What is far off in two cases is not tried on more.
    let count = tried.len();
    let near = cheapest(tried, &few[..few.len().min(FEWER_ROWS)], (count / NEAR).max(NEAREST));
    let sought = cheapest(near, &few, NEAREST).into_iter();
    sought.filter_map(|(variation, scaled)| Some((variation, search(variation, &all, scaled)?))).collect()
}

/// So many of them that come nearest to the answers by rough factors.
fn cheapest<'a, 'b>(
    tried: Vec<(&'b Variation<'a>, Scaled)>,
    rows: &[FactorRow],
    count: usize,
) -> Vec<(&'b Variation<'a>, Scaled)> {
    let cost = |(variation, scaled): &(&Variation<'_>, Scaled)| {
        roughly(variation, rows, scaled, OCTAVES, ROUGH_STEPS).map_or(f64::INFINITY, |(cost, _)| cost)
    };
    let mut costs: Vec<_> = tried.into_iter().map(|one| (cost(&one), one)).collect();
    costs.sort_by(|a, b| a.0.total_cmp(&b.0));
    costs.into_iter().take(count).map(|(_, one)| one).collect()
}

/// So many of the failing cases, evenly spread.
fn rows(failing: &[Answered<'_>], places: &Range<usize>, count: usize) -> Vec<FactorRow> {
    let some = failing.iter().step_by((failing.len() / count).max(1)).take(count);
    some.filter_map(|row| FactorRow::new(row, places)).collect()
}

/// An answer with the size of what its error is measured by.
struct FactorRow {
    inputs: Vec<f64>,
    values: Vec<f64>,
    tolerance: Vec<f64>,
    /// The outputs that these are of.
    places: Range<usize>,
}

impl FactorRow {
    fn new(row: &Answered<'_>, places: &Range<usize>) -> Option<Self> {
        let tolerance = row.legal.iter().zip(row.values).map(|(legal, &value)| {
            let half = if legal.is_any() { f64::INFINITY } else { legal.width() * 0.5 };
            half.max(F32::ulp(f64::from(value).abs().max(1e-6)))
        });
        let tolerance: Vec<f64> = tolerance.collect();
        let values: Vec<f64> = row.values.iter().map(|&x| x.into()).collect();
        let is_number = values.iter().all(|x| x.is_finite());
        let inputs = row.inputs.iter().map(|&x| x.into()).collect();
        is_number.then(|| Self { inputs, values, tolerance, places: places.clone() })
    }

    /// The residual of each output at a factor, in tolerances.
    fn residuals(&self, variation: &Variation<'_>, scaled: &Scaled, factor: f64, out: &mut Vec<f64>) {
        let mut outputs = vec![0.0; variation.member.spec.output_len()];
        scaled.scaled(variation, factor, &mut self.inputs.clone(), &mut outputs);
        let outputs = &outputs[self.places.clone()];
        for ((value, output), tolerance) in self.values.iter().zip(outputs).zip(&self.tolerance) {
            let residual = (value - output) / tolerance;
            out.push(if residual.is_finite() { residual } else { 0.0 });
        }
    }
}

/// The residuals of all rows at a factor.
fn residuals(variation: &Variation<'_>, rows: &[FactorRow], scaled: &Scaled, factor: f64) -> Vec<f64> {
    let mut residuals = vec![];
    rows.iter().for_each(|row| row.residuals(variation, scaled, factor, &mut residuals));
    residuals
}

/// Logarithms, so that one case far off does not decide.
fn cost(residuals: &[f64]) -> f64 {
    residuals.iter().map(|r| (1.0 + r.abs()).ln()).sum()
}

/// The best factor of a wide range, and its cost.
fn roughly(
    variation: &Variation<'_>,
    rows: &[FactorRow],
    scaled: &Scaled,
    octaves: i32,
    steps_an_octave: i32,
) -> Option<(f64, f64)> {
    let of_step = |step: i32| (f64::from(step) / f64::from(steps_an_octave)).exp2();
    let most = octaves * steps_an_octave;
    let costs = (-most..=most).map(|step| (cost(&residuals(variation, rows, scaled, of_step(step))), of_step(step)));
    costs.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The factor of least residuals: the best of a wide range, refined.
fn search(variation: &Variation<'_>, rows: &[FactorRow], mut scaled: Scaled) -> Option<Scaled> {
    let all = |scaled: &Scaled, factor: f64| residuals(variation, rows, scaled, factor);
    let (mut least, mut factor) = roughly(variation, rows, &scaled, OCTAVES, STEPS_AN_OCTAVE)?;
    for _ in 0..STEPS {
        let (here, step) = (all(&scaled, factor), factor * 1e-6);
        let beyond = all(&scaled, factor + step);
        let (mut slopes, mut moments) = (0.0, 0.0);
        for (r, s) in here.iter().zip(&beyond) {
            // Far residuals weigh less: they are of cases that something else is wrong with, or of a factor still far off.
            let (slope, weight) = ((r - s) / step, 1.0 / (1.0 + r.abs()));
            slopes += weight * slope * slope;
            moments += weight * slope * r;
        }
        if slopes == 0.0 {
            return None;
        }
        let mut stride = (moments / slopes).clamp(-0.2 * factor, 0.2 * factor);
        let mut moved = false;
        for _ in 0..8 {
            let cost = cost(&all(&scaled, factor + stride));
            if cost < least {
                (least, factor, moved) = (cost, factor + stride, true);
                break;
            }
            stride *= 0.5;
        }
        let spread: f64 = here.iter().map(|r| r.abs().min(1.0)).sum::<f64>();
        let count: f64 = here.iter().map(|_| 1.0).sum();
        scaled.uncertainty = (3.0 * (spread / count) / slopes.sqrt() / factor).max(2.0_f64.powi(-22)).min(0.01);
        if !moved || stride.abs() < 1e-9 * factor {
            break;
        }
    }
    // A parameter that makes no difference explains none.
    if least > MOST_COST * cost(&all(&scaled, 1.0)) {
        return None;
    }
    // Nothing wrong with this parameter.
    let is_one = (factor - 1.0).abs() <= scaled.uncertainty;
    let is_beyond = factor.log2().abs() > f64::from(OCTAVES) - 0.5;
    (!is_one && !is_beyond).then_some(Scaled { factor, ..scaled })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_significant_digits() {
        let rows = [
            (4.0, 3, "4.00"),
            (0.42, 2, "0.42"),
            (128.4, 3, "128"),
            (0.00314, 2, "0.0031"),
            (12345.0, 3, "12345"),
            (1.18e-38, 3, "1.18e-38"),
        ];
        for (x, significant, text) in rows {
            assert_eq!(digits(x, significant), text);
        }
    }
}
