//! The JSON of `run`, `special`, `bench` and `selftest`: each type reads what it writes. The types of the gate and of sweeps are still
//! in their own rooms.
//!
//! Nothing here judges or draws.

pub mod bench;
mod number;
pub mod run;
pub mod selftest;
pub mod special;

pub use number::{Number, thousands};

/// A word that is written from a constant and read from a file.
pub type Word = std::borrow::Cow<'static, str>;
