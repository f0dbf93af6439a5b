//! Classical lighting, fog and blending, each formula stated once over an arithmetic.
//!
//! A formula is a free function over [`Real`]. What it is evaluated in decides what comes out: `f64` gives the reference
//! value, `f32` an embedded implementation, an interval arithmetic the set of all values that a shading language permits.
//!
//! # Conventions
//!
//! * Eye space, right-handed, the eye at the origin looking down −z; distances in eye-space units, angles in radians.
//! * Vectors point away from the surface: `n` normal, `l` surface → light, `v` surface → eye, `r` mirrored light,
//!   `h` halfway. `i = −l` is the direction in which light travels.
//! * Colours are linear with straight alpha, nominally 0 to 1; `*` between colours is component-wise.
//! * Every input is an f32, widened exactly, so that both sides of a comparison see the same number.
//! * Chains of three or more terms go through [`Real::sum`] and [`Real::product`], because a shading language may
//!   reassociate them; a choice goes through [`Real::if_ge`], because an interval may not be able to decide it.
//!
//! # Sources
//!
//! The documents are named by number: 000 "Tema 6. Color e iluminación", 002 "Mezclado de colores",
//! 003 "Modelo de iluminación Phong", 004 "Online Lecture 7: OpenGL Shading". Where one is ambiguous or wrong, the ruling
//! is said at the formula and the document's own form is kept beside it under a name of its own.

pub mod algebra;
pub mod attenuation;
pub mod blend;
pub mod color;
pub mod departure;
pub mod depth;
pub mod fog;
pub mod interpolation;
pub mod lighting;
pub mod real;
pub mod render;
mod step;
pub mod texture;
pub mod vector;

pub use algebra::{Mat3, Mat4, Rgb, Rgba, Vec2, Vec3, Vec4, Vector};
pub use real::{Components, NamedStep, Parts, Real};
