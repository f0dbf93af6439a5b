//! What each pixel of a frame may hold, and how an image compares.
//!
//! `bound` is what a rasteriser may make of a triangle's place and attributes, `prepared` a draw with all of its triangles,
//! `pixel` the ways in which one pixel may come about, `expect` the legal values of all of them; `judge` compares an image with them, `bias` tells what all of its pixels say together, and `file` writes PNG and EXR.

pub mod bias;
mod bound;
pub mod expect;
pub mod file;
pub mod judge;
pub mod map;
mod pixel;
mod prepared;

pub use expect::expect;
pub use pixel::LegalPixel;
