//! Named mistakes that renderers make, and what they explain.
//!
//! A mistake is a variation of a formula, stated over any arithmetic like the formula itself: in f32 it is an implementation
//! that is wrong, in f64 its value, in intervals all that a renderer with the mistake may legally answer.

mod alteration;
mod blend;
pub mod calibrate;
mod catalogue;
mod change;
mod common;
mod concerned;
mod diagnose;
mod evidence;
mod explained;
mod explanation;
mod factor;
mod fault;
mod generated;
mod group;
mod look;
mod made;
mod mistakes;
pub mod noise;
mod op;
mod row;
pub mod scene;
mod seen;
pub mod selftest;
mod steps;
mod table;
mod touched;
mod trial;
mod variation;

pub use catalogue::{faults, generated};
pub use concerned::{concerning, listed};
pub use diagnose::diagnose;
pub use explained::{explain, shown_mistake, shown_step, typical_course};
pub use explanation::{FormulaDiagnosis, TriedMistake};
pub use factor::Scaled;
pub use fault::Fault;
pub use group::{LEAST_ERROR, LEAST_SHARE, LEAST_VALUES, LEAST_Z, group_verdict};
pub use look::look;
pub use made::KnownMistakes;
pub use mistakes::Mistakes;
pub use row::Arithmetic;
pub use seen::SeenStep;
pub use touched::Touched;
pub use variation::Variation;

/// A share in percent; 100 of nothing.
#[must_use]
pub fn percent(part: usize, whole: usize) -> f64 {
    if whole == 0 { 100.0 } else { 100.0 * common::share(part, whole) }
}
