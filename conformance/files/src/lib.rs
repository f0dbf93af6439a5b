//! What comes from others, and what is left to others: files that are read within limits, files that are written whole or not at all,
//! and text of others that is made fit to be shown.

pub mod read;
mod shown;
mod whole;

pub use shown::{Shown, lines, shown};
pub use whole::{Whole, can_be_written, whole};
