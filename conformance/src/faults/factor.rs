//! A parameter some factor times what was asked: found by a search over factors, refined by Gauss and Newton's method, and
//! held against the interval of the scaled input.

use super::diagnose::Answered;
use crate::arithmetic::{Accept, F32, Format as _, Profile};
use crate::cases::{Domain, Spec};
use crate::select::Member;
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
/// Factors from 2⁻¹⁰ to 2¹⁰ in steps of a sixth of an octave.
const OCTAVES: i32 = 10;
const STEPS_AN_OCTAVE: i32 = 6;

impl Scaled {
    /// In words: "as if shininess were 4.00 times what was asked".
    #[must_use]
    pub fn says(&self) -> String {
        let (name, percent) = (self.name, (self.factor - 1.0) * 100.0);
        let asked = if self.is_output { "what it should be" } else { "what was asked" };
        if percent.abs() < 10.0 {
            let way = if percent < 0.0 { "smaller" } else { "larger" };
            format!("as if {name} were {} % {way}", digits(percent.abs(), 2))
        } else {
            format!("as if {name} were {} times {asked}", digits(self.factor, 3))
        }
    }

    /// What is legal with the input so much greater, the factor known as well as it is.
    pub(super) fn interval(&self, member: &Member, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        let factor =
            Accept::from_bounds(self.factor * (1.0 - self.uncertainty), self.factor * (1.0 + self.uncertainty));
        profile.scope(|| {
            let mut row: Vec<Accept> = inputs.iter().map(|&x| Accept::input(x)).collect();
            let scale = |row: &mut [Accept]| {
                row.get_mut(self.range.clone()).into_iter().flatten().for_each(|x| *x = *x * factor);
            };
            if !self.is_output {
                scale(&mut row);
            }
            member.formula.on_accept(&row, out);
            if self.is_output {
                scale(out);
            }
        });
    }
}

/// A number to so many significant digits.
pub(super) fn digits(x: f64, significant: i32) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    #[expect(clippy::cast_possible_truncation, reason = "an exponent of f64 is a small number")]
    let magnitude = x.abs().log10().floor() as i32;
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
pub(super) fn candidates(member: &Member, failing: &[Answered<'_>], profile: &Profile) -> Vec<Scaled> {
    let spec = &member.spec;
    let rows: Vec<Row> = failing
        .iter()
        .step_by((failing.len() / ROWS).max(1))
        .take(ROWS)
        .filter_map(|row| Row::new(member, row, profile))
        .collect();
    if rows.is_empty() {
        return vec![];
    }
    let mut start = 0;
    let outputs: Vec<_> = spec
        .outputs
        .iter()
        .map(|output| {
            let range = start..start + output.shape.components();
            start = range.end;
            (output.name, range, true)
        })
        .collect();
    let inputs = parameters(spec).map(|(name, range)| (name, range, false));
    inputs
        .chain(outputs)
        .filter_map(|(name, range, is_output)| {
            let scaled = Scaled { name, is_output, factor: 1.0, uncertainty: 0.0, range };
            search(member, &rows, scaled)
        })
        .collect()
}

/// An answer with the size of what its error is measured by.
struct Row {
    inputs: Vec<f64>,
    values: Vec<f64>,
    tolerance: Vec<f64>,
}

impl Row {
    fn new(member: &Member, row: &Answered<'_>, profile: &Profile) -> Option<Self> {
        let mut legal = vec![Accept::ANY; member.spec.output_len()];
        profile.scope(|| member.formula.interval(row.inputs, &mut legal));
        let tolerance = legal.iter().zip(row.values).map(|(legal, &value)| {
            let half = if legal.is_any() { f64::INFINITY } else { legal.width() * 0.5 };
            half.max(F32::ulp(f64::from(value).abs().max(1e-6)))
        });
        let tolerance: Vec<f64> = tolerance.collect();
        let values: Vec<f64> = row.values.iter().map(|&x| x.into()).collect();
        let is_number = values.iter().all(|x| x.is_finite());
        is_number.then(|| Self { inputs: row.inputs.iter().map(|&x| x.into()).collect(), values, tolerance })
    }

    /// The residual of each output at a factor, in tolerances.
    fn residuals(&self, member: &Member, scaled: &Scaled, factor: f64, out: &mut Vec<f64>) {
        let mut inputs = self.inputs.clone();
        let mut outputs = vec![0.0; self.values.len()];
        let scale =
            |row: &mut [f64]| row.get_mut(scaled.range.clone()).into_iter().flatten().for_each(|x| *x *= factor);
        if !scaled.is_output {
            scale(&mut inputs);
        }
        member.formula.on_f64(&inputs, &mut outputs);
        if scaled.is_output {
            scale(&mut outputs);
        }
        for ((value, output), tolerance) in self.values.iter().zip(&outputs).zip(&self.tolerance) {
            let residual = (value - output) / tolerance;
            out.push(if residual.is_finite() { residual } else { 0.0 });
        }
    }
}

/// The factor of least residuals: the best of a wide range, refined.
fn search(member: &Member, rows: &[Row], mut scaled: Scaled) -> Option<Scaled> {
    let mut residuals = vec![];
    let mut all = |scaled: &Scaled, factor: f64| {
        residuals.clear();
        for row in rows {
            row.residuals(member, scaled, factor, &mut residuals);
        }
        residuals.clone()
    };
    // Logarithms, so that one case far off does not decide.
    let cost = |residuals: &[f64]| residuals.iter().map(|r| (1.0 + r.abs()).ln()).sum::<f64>();
    let of_step = |step: i32| (f64::from(step) / f64::from(STEPS_AN_OCTAVE)).exp2();
    let most = OCTAVES * STEPS_AN_OCTAVE;
    let best = (-most..=most).map(|step| (cost(&all(&scaled, of_step(step))), of_step(step)));
    let (mut least, mut factor) = best.min_by(|a, b| a.0.total_cmp(&b.0))?;
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
    // Nothing wrong with this parameter.
    let is_one = (factor - 1.0).abs() <= scaled.uncertainty;
    (!is_one).then_some(Scaled { factor, ..scaled })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_significant_digits() {
        let rows =
            [(4.0, 3, "4.00"), (0.42, 2, "0.42"), (128.4, 3, "128"), (0.00314, 2, "0.0031"), (12345.0, 3, "12345")];
        for (x, significant, text) in rows {
            assert_eq!(digits(x, significant), text);
        }
    }
}
