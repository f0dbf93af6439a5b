//! The fixed-function blend unit under judgement: every state on every target format.
//!
//! `draw`, `run` and `standing` are the way of the data, and `selftest` tells whether faults are found.

pub mod draw;
pub mod run;
pub mod selftest;
mod standing;

pub use lightmeter_judge::blend_unit::*;
