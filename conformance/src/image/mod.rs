//! Images under judgement: what each pixel of a frame may hold, and how an implementation's image compares.
//!
//! `bound` is what a rasteriser may make of a triangle's place and attributes, `pixel` the ways in which one pixel may come
//! about, `expect` the legal values of all of them; `file` writes PNG and EXR.

mod bound;
pub mod expect;
pub mod file;
mod pixel;

pub use expect::{Expected, expect};
