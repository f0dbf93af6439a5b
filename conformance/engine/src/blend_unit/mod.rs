//! The fixed-function blend unit under judgement: every state on every target format.
//!
//! `chunk` cuts a group into pieces, `draw` has a subject draw them, `standing` has what has come of them, and `run`
//! takes a group through all of these; `selftest` tells whether faults are found.

mod asked;
mod chunk;
pub mod draw;
pub mod run;
pub mod selftest;
pub(crate) mod standing;
