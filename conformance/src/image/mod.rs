//! Images under judgement: what each pixel of a frame may hold, and how an implementation's image compares.
//!
//! `bound` is what a rasteriser may make of a triangle's place and attributes, `expect` the legal values of every pixel,
//! `pixel` the ways in which one pixel may come about.

mod bound;
pub mod expect;
mod pixel;

pub use expect::{Expected, expect};
