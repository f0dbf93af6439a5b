//! The JSON of `run` and of `special`: each type reads what it writes. The types of the gate, sweeps, the bench and the self-test are
//! still in their own rooms.
//!
//! Nothing here judges or draws.

mod number;
pub mod run;
pub mod special;

pub use number::{Number, thousands};

/// A word that is written from a constant and read from a file.
pub type Word = std::borrow::Cow<'static, str>;
