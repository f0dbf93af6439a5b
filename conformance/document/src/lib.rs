//! The JSON that goes out and comes in again: each type reads what it writes, and has a JSON Schema.
//!
//! Nothing here judges or draws.

pub mod adapters;
pub mod bench;
pub mod by_case;
mod count;
pub mod effects;
mod error;
pub mod eval;
pub mod event;
pub mod explained;
pub mod frame;
mod hash;
pub mod identify;
pub mod list;
pub mod made_by;
pub mod mistakes;
mod number;
pub mod pack;
pub mod protocol;
pub mod report;
pub mod selftest;
pub mod show;
pub mod special;
pub mod stores;
pub mod sweep;
mod unique;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde::de::DeserializeOwned;
use serde_json::Value;

pub use error::{distance_told, error_figure, error_told, superscript};
pub use hash::hash;
pub use number::{Number, is_worse, thousands, worse};
pub use unique::Unique;

/// A word that is written from a constant and read from a file.
pub type Word = std::borrow::Cow<'static, str>;

/// Why a text is not the document that it should be.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// It is not JSON.
    #[error("not JSON: {0}; expected {1}")]
    Json(String, &'static str),
    /// It is another document.
    #[error("its schema is {found}; expected {schema}, {what}")]
    Schema {
        /// The schema that it names, in backquotes, or `none`.
        found: String,
        /// The schema that is expected.
        schema: &'static str,
        /// What has that schema.
        what: &'static str,
    },
    /// It is of an earlier version.
    #[error(
        "it is of an earlier version, `{found}`; expected {schema}, {what}: judge once more by the same command, with `--update-baseline` where it is a baseline"
    )]
    Earlier {
        /// The schema that it names.
        found: &'static str,
        /// The schema that stands in its place.
        schema: &'static str,
        /// What has that schema.
        what: &'static str,
    },
    /// It is of a later version than this program knows.
    #[error(
        "it is of a later version, `{found}`; expected {schema}, {what}: read it with a lightmeter that is not older than the one that wrote it"
    )]
    Later {
        /// The schema that it names.
        found: String,
        /// The schema that this program reads.
        schema: &'static str,
        /// What has that schema.
        what: &'static str,
    },
    /// A field is missing, or is not what it should be.
    #[error("not {1}: {0}")]
    Field(String, &'static str),
    /// A number is so large that nothing was counted that way.
    #[error("`{0}` is {1}; expected {MOST_COUNT} at most")]
    Count(String, u64),
    /// It was changed after it was written.
    #[error("its checksum does not hold")]
    Checksum,
}

/// Schemas of earlier versions, and what stands in their place.
const EARLIER: [(&str, &str); 2] = [("lightmeter.run/1", report::SCHEMA), ("lightmeter.gate/1", report::SCHEMA)];

/// `1 case`, `12 cases`.
#[must_use]
pub fn cases(count: u64) -> String {
    if count == 1 { "1 case".into() } else { format!("{} cases", thousands(count)) }
}

/// What a command writes as a whole. The code that writes and reads it is made here, once, and not in each room that does.
pub trait Document: Sized {
    /// The name of its schema.
    const SCHEMA: &'static str;
    /// What it is, in words: `the JSON of …`.
    const WHAT: &'static str;

    /// The JSON, for people to read too, with a line feed at its end.
    ///
    /// # Errors
    /// Where a map has a key that is no text: none does.
    fn to_json(&self) -> serde_json::Result<String>;

    /// Reads the JSON. The schema is compared first, so that the error for another kind of document names that kind.
    ///
    /// # Errors
    /// Where it is another document, or damaged.
    fn read(json: &str) -> Result<Self, ReadError>;

    /// The JSON Schema of the document as it is written.
    fn schema() -> Schema;
}

fn schema<T: JsonSchema>() -> Schema {
    SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<T>()
}

/// Whether a schema is a document's, of whatever version: [`Document::read`] says of another one what would do.
#[must_use]
pub fn is_of<T: Document>(schema: &str) -> bool {
    schema == T::SCHEMA || EARLIER.contains(&(schema, T::SCHEMA)) || is_later(schema, T::SCHEMA)
}

/// Whether a schema is another's of a later version.
fn is_later(found: &str, known: &str) -> bool {
    let parts = |schema: &str| -> Option<(String, u32)> {
        let (name, version) = schema.rsplit_once('/')?;
        Some((name.to_owned(), version.parse().ok()?))
    };
    parts(found).zip(parts(known)).is_some_and(|(found, known)| found.0 == known.0 && found.1 > known.1)
}

fn read<T: Document + DeserializeOwned>(json: &str) -> Result<T, ReadError> {
    let Unique(value) = serde_json::from_str(json).map_err(|error| {
        let wrong = if error.is_data() { ReadError::Field } else { ReadError::Json };
        wrong(error.to_string(), T::WHAT)
    })?;
    if value["schema"] != T::SCHEMA {
        if let Some((found, schema)) =
            EARLIER.into_iter().find(|(found, by)| value["schema"] == *found && *by == T::SCHEMA)
        {
            return Err(ReadError::Earlier { found, schema, what: T::WHAT });
        }
        if let Some(found) = value["schema"].as_str().filter(|found| is_later(found, T::SCHEMA)) {
            return Err(ReadError::Later { found: found.into(), schema: T::SCHEMA, what: T::WHAT });
        }
        let found = value["schema"].as_str().map_or_else(|| "none".into(), |name| format!("`{name}`"));
        return Err(ReadError::Schema { found, schema: T::SCHEMA, what: T::WHAT });
    }
    counted(&value, "the whole")?;
    serde_json::from_value(value).map_err(|error| ReadError::Field(error.to_string(), T::WHAT))
}

/// What is counted, at most: the sum of all counts of a document is a number of 64 bits.
const MOST_COUNT: u64 = 1 << 48;

/// Holds all counts of a value to what can be counted. A seed is any number of 64 bits.
fn counted(value: &Value, name: &str) -> Result<(), ReadError> {
    match value {
        Value::Number(number) => match number.as_u64() {
            Some(count) if count > MOST_COUNT && name != "seed" => Err(ReadError::Count(name.into(), count)),
            _ => Ok(()),
        },
        Value::Array(values) => values.iter().try_for_each(|value| counted(value, name)),
        Value::Object(fields) => fields.iter().try_for_each(|(name, value)| counted(value, name)),
        Value::Null | Value::Bool(_) | Value::String(_) => Ok(()),
    }
}

macro_rules! documents {
    ($($document:ty: $schema:expr, $what:literal;)+) => {
        $(impl Document for $document {
            const SCHEMA: &'static str = $schema;
            const WHAT: &'static str = $what;

            fn to_json(&self) -> serde_json::Result<String> {
                Ok(serde_json::to_string_pretty(self)? + "\n")
            }

            fn read(json: &str) -> Result<Self, ReadError> {
                read(json)
            }

            fn schema() -> Schema {
                schema::<Self>()
            }
        })+
    };
}

documents! {
    adapters::AdaptersDocument: adapters::SCHEMA, "the JSON of `lightmeter adapters --format json`";
    bench::BenchDocument: bench::SCHEMA, "the JSON of `lightmeter bench --format json`";
    bench::recommendation::Recommendation: bench::recommendation::SCHEMA, "the JSON of `lightmeter bench --recommend`";
    effects::EffectsDocument: effects::SCHEMA, "the JSON of `lightmeter effects --format json`";
    mistakes::MistakesDocument: mistakes::SCHEMA, "the JSON of `lightmeter mistakes --format json`";
    identify::IdentifyDocument: identify::SCHEMA, "the JSON of `lightmeter identify --format json`";
    list::CasesDocument: list::CASES, "the JSON of `lightmeter list --format json`";
    list::FormulasDocument: list::FORMULAS, "the JSON of `lightmeter list --formulas --format json`";
    pack::Manifest: pack::SCHEMA, "the manifest of `lightmeter pack`";
    selftest::SelftestDocument: selftest::SCHEMA, "the JSON of `lightmeter selftest --format json`";
    show::ShowDocument: show::SCHEMA, "the JSON of `lightmeter show --format json`";
    special::SpecialReport: special::SCHEMA, "the JSON of `lightmeter special --format json`";
    special::record::SpecialRecord: special::record::SCHEMA, "a record of `lightmeter special --record`";
    sweep::presets::PresetsDocument: sweep::presets::SCHEMA, "the list of ready-made sweeps";
}

/// A shard's is read by programs alone, and has no spaces.
impl Document for report::Report {
    const SCHEMA: &'static str = report::SCHEMA;
    const WHAT: &'static str = "the JSON of `run`, `gate` or `merge` with `--format json`";

    fn to_json(&self) -> serde_json::Result<String> {
        let is_shard = self.compared_by.as_ref().is_some_and(|by| by.shard.is_some());
        let json = if is_shard { serde_json::to_string(self)? } else { serde_json::to_string_pretty(self)? };
        Ok(json + "\n")
    }

    fn read(json: &str) -> Result<Self, ReadError> {
        read(json)
    }

    fn schema() -> Schema {
        schema::<Self>()
    }
}

/// A sweep takes hours, so that it is signed by a checksum over all else.
impl Document for sweep::SweepDocument {
    const SCHEMA: &'static str = sweep::SCHEMA;
    const WHAT: &'static str = "the JSON of `lightmeter sweep --format json`";

    fn to_json(&self) -> serde_json::Result<String> {
        let signed = Self { checksum: self.sum()?, ..self.clone() };
        Ok(serde_json::to_string_pretty(&signed)? + "\n")
    }

    fn read(json: &str) -> Result<Self, ReadError> {
        let document: Self = read(json)?;
        if document.sum().ok().as_deref() == Some(&document.checksum) { Ok(document) } else { Err(ReadError::Checksum) }
    }

    fn schema() -> Schema {
        schema::<Self>()
    }
}
