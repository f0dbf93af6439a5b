//! The JSON that goes out and comes in again: each type reads what it writes, and has a JSON Schema.
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

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};

pub use number::{Number, thousands};

/// A word that is written from a constant and read from a file.
pub type Word = std::borrow::Cow<'static, str>;

/// The JSON Schema of a document as it is written.
#[must_use]
pub fn schema<T: JsonSchema>() -> Schema {
    SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<T>()
}
