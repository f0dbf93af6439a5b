//! A formula along one of its inputs over every float of a range, and the named blend modes over every byte of source,
//! destination and alpha.
//!
//! `preset` has the ready-made sweeps, `plan` works out what is swept, `span` cuts it into blocks and shares them out, `run` has
//! a device evaluate them, `judge` and `blend` judge, `statistics` and `histogram` are what is found, `description` says what is swept, `document` is the file that
//! holds it, which is a checkpoint meanwhile, and `text` writes it for people.

mod blend;
mod description;
mod document;
mod histogram;
mod judge;
mod plan;
mod preset;
mod run;
mod span;
mod statistics;
pub mod text;

pub use description::Description;
pub use document::{DocumentError, SCHEMA, SweepDocument, name_of};
pub use histogram::Histogram;
pub use judge::Judge;
pub use plan::{Asked, Over, Plan, Refused};
pub use preset::{Free, PRESETS, Preset};
pub use run::{SweepError, UNDER_WAY, sweep};
pub use span::Span;
pub use statistics::{Exact, Place, Seen, Statistics, Stored};
