//! The JSON that goes out and comes in again: each type reads what it writes.
//!
//! Nothing here judges or draws.

pub mod bench;
pub mod gate;
mod number;
pub mod pack;
pub mod run;
pub mod selftest;
pub mod special;
pub mod sweep;

pub use number::{Number, thousands};

/// A word that is written from a constant and read from a file.
pub type Word = std::borrow::Cow<'static, str>;
