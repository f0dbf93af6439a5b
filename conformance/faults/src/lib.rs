//! Named mistakes that renderers make, and what they explain.
//!
//! A mistake is a variation of a formula, stated over any arithmetic like the formula itself: in f32 it is an implementation
//! that is wrong, in f64 its value, in intervals all that a renderer with the mistake may legally answer.

mod blend;
mod body;
pub mod calibrate;
mod catalogue;
mod change;
mod diagnose;
mod factor;
mod fault;
mod fog;
mod group;
mod lighting;
mod mistakes;
mod row;
pub mod scene;
pub mod selftest;
mod table;
mod variation;

pub use catalogue::{concerning, faults};
pub use diagnose::{Diagnosis, Explanation, diagnose};
pub use factor::Scaled;
pub use fault::Fault;
pub use group::{LEAST_ERROR, LEAST_SHARE, LEAST_VALUES, LEAST_Z, group_verdict};
pub use mistakes::Mistakes;
pub use row::Arithmetic;
pub use variation::Variation;

/// A share in percent; 100 of nothing.
#[must_use]
pub fn percent(part: usize, whole: usize) -> f64 {
    if whole == 0 { 100.0 } else { 100.0 * diagnose::share(part, whole) }
}

/// Holds a model without a mistake against the formulas that it is of; how many cases that were.
#[cfg(test)]
pub(crate) fn agrees_with_formulas(
    is_of: impl Fn(&lightmeter_catalogue::cases::Spec) -> bool,
    evaluate: impl Fn(&lightmeter_catalogue::cases::Spec, &[f64], &mut [f64]) -> Option<()>,
) -> usize {
    let mut seen = 0;
    for member in fault::formulas().iter().filter(|member| is_of(&member.spec)) {
        for k in 0..256 {
            let mut row = vec![];
            member.inputs(lightmeter_catalogue::select::CaseRef::Random(k), 1, &mut row);
            let wide: Vec<f64> = row.iter().map(|&x| x.into()).collect();
            let outputs = member.spec.output_len();
            let (mut model, mut formula) = (vec![f64::NAN; outputs], vec![0.0; outputs]);
            evaluate(&member.spec, &wide, &mut model).expect("a model");
            member.formula.reference(&row, &mut formula);
            for (a, b) in model.iter().zip(&formula) {
                assert!((a - b).abs() <= 1e-9 * b.abs().max(1.0), "{} {k}: {a} for {b}", member.spec.id);
            }
            seen += 1;
        }
    }
    seen
}
