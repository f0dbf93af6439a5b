//! The JSON that the suite writes and reads. Each type of it is here, once, and reads what it writes.
//!
//! Nothing here judges or draws: pages, reports and tests work from these documents alone.

mod number;
pub mod run;
pub mod special;

pub use number::{Number, thousands};

/// A word that is written from a constant and read from a file.
pub type Word = std::borrow::Cow<'static, str>;
