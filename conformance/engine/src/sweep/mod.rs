//! A formula along one of its inputs over every float of a range, and the named blend modes over every byte of source,
//! destination and alpha.
//!
//! `preset` has the ready-made sweeps, `plan` works out what is swept, `telling` along which row, `span` cuts it into blocks and
//! shares them out, `run` has a device evaluate them, `judge` and `blend` judge, `description` says what is swept, `file` is the
//! document that holds what is found, which is a checkpoint meanwhile.

mod blend;
mod description;
pub mod file;
mod judge;
mod plan;
mod preset;
mod run;
mod span;
mod telling;
mod work;

pub use description::{describe, is_over_inputs_of, span};
pub use file::DocumentError;
pub use judge::Judge;
pub use plan::{Asked, Over, Refused, SweepPlan};
pub use preset::{Free, PRESETS, Preset};
pub use run::{SweepError, UNDER_WAY, sweep};
pub use span::Span;
