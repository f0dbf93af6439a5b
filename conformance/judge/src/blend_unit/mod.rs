//! What a fixed-function blend unit may leave in a pixel of any target, and what pixels are worth.
//!
//! `pixel` is a target's own bits and units, `expect` what a case should leave and what it may, `tally` the verdicts, `store` what
//! many values say together of how they are stored, `model` what a driver is known to compute bit for bit, `rules` the right ones
//! and the faulty, `embedded` a unit in f32 that takes the faults, `policy` what is said of NaN and infinity.

pub mod embedded;
pub mod expect;
pub mod model;
pub mod pixel;
pub mod policy;
pub mod rules;
pub mod store;
pub mod tally;
