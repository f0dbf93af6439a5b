//! Images under judgement: what each pixel of a frame may hold, and how an implementation's image compares.
//!
//! `bound` is what a rasteriser may make of a triangle's place and attributes, `pixel` the ways in which one pixel may come
//! about, `expect` the legal values of all of them; `judge` compares an image with them,
//! `drawn` is one image by a subject, `diagnose` says where a wrong one first departs, `select` chooses scenes and pixels, `run` takes them through
//! both, `cost` measures what effects cost that are not called for, and `file` writes PNG and EXR.

mod bound;
mod cost;
pub mod diagnose;
pub mod drawn;
pub mod expect;
pub mod file;
pub mod judge;
mod pixel;
pub mod run;

pub use expect::{Expected, expect};
