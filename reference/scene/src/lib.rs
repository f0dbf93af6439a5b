//! Plain data that the reference, the GPU and the suite share.
//!
//! There is no formula here and no I/O: a blend state is a name, not what it computes. Both sides of a comparison may
//! therefore depend on this crate without sharing any arithmetic.

pub mod along;
pub mod blend;
pub mod depth;
pub mod effects;
pub mod frame;
pub mod model;
pub mod raster;
pub mod shading;
pub mod stage;
pub mod target;
mod words;
