//! Images of frames: vertices, coverage, attributes, lighting, fog, depth, blending and order brought together.
//!
//! [`Shader`] is what happens at a vertex and at a fragment, over any arithmetic. [`render`] draws a whole frame in a plain
//! one: f64 is the reference. What a rasteriser may do instead has no place here.

mod attributes;
mod image;
mod raster;
mod shader;

pub use attributes::Attributes;
pub use image::{Image, render, render_at};
pub use raster::{Geometry, Triangle};
pub use shader::{Fragment, Scratch, Shader};
