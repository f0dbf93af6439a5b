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

/// What a command writes as a whole. The code that writes it is made here, once, and not in each room that does.
pub trait Document {
    /// The JSON, for people to read too, with a line feed at its end.
    ///
    /// # Errors
    /// Where a map has a key that is no text: none does.
    fn to_json(&self) -> serde_json::Result<String>;

    /// The JSON Schema of the document as it is written.
    fn schema() -> Schema;
}

fn schema<T: JsonSchema>() -> Schema {
    SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<T>()
}

macro_rules! documents {
    ($($document:ty),+ $(,)?) => {
        $(impl Document for $document {
            fn to_json(&self) -> serde_json::Result<String> {
                Ok(serde_json::to_string_pretty(self)? + "\n")
            }

            fn schema() -> Schema {
                schema::<Self>()
            }
        })+
    };
}

documents!(
    bench::BenchDocument,
    gate::GateReport,
    pack::Manifest,
    run::Report,
    selftest::SelftestDocument,
    special::SpecialReport,
    sweep::SweepDocument,
);
