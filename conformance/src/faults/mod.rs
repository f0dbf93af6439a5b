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
mod fog;
mod group;
mod lighting;
mod row;
pub mod scene;
pub mod selftest;
mod table;
mod variation;

pub use catalogue::{Fault, concerning, faults};
pub use diagnose::{Answered, Diagnosis, Explanation, diagnose, simplicity};
pub use factor::Scaled;
pub use group::{Error, LEAST_SHARE, LEAST_VALUES, LEAST_Z, Systematic, group_verdict};
pub use row::Arithmetic;
pub use variation::Variation;

/// A share in percent; 100 of nothing.
#[must_use]
pub(crate) fn percent(part: usize, whole: usize) -> f64 {
    if whole == 0 { 100.0 } else { 100.0 * diagnose::share(part, whole) }
}
