//! The fixed-function blend unit under judgement: every state on every target format.
//!
//! `pixel` is a target's own bits and units, `expect` what a case should leave and what it may, `tally` the verdicts, `store`
//! what many values say together of how they are stored, `model` what a driver is known to compute bit for bit, `rules` the right ones and the faulty, `embedded`
//! a unit in f32 that takes the faults, `draw`, `run` and `standing` the way of the data, and `selftest` whether faults are found.

pub mod draw;
pub mod embedded;
pub mod expect;
pub mod model;
pub mod pixel;
pub mod policy;
pub mod rules;
pub mod run;
pub mod selftest;
mod standing;
pub mod store;
pub mod tally;
