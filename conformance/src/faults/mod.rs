//! Named mistakes that renderers make, and what they explain.
//!
//! A mistake is a variation of a formula, stated over any arithmetic like the formula itself: in f32 it is an implementation
//! that is wrong, in f64 its value, in intervals all that a renderer with the mistake may legally answer.

mod blend;
mod body;
mod catalogue;
mod change;
mod diagnose;
mod factor;
mod fog;
mod lighting;
mod row;
mod table;
mod variation;

pub use catalogue::{Fault, concerning, faults};
pub use diagnose::{Answered, Diagnosis, Explanation, diagnose};
pub use factor::Scaled;
pub use row::Arithmetic;
pub use variation::Variation;
