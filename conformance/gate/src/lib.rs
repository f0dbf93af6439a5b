//! The gate: any renderer, in any language, judged by the cases of the catalogue and the built-in scenes.
//!
//! A [`plan::GatePlan`] says which cases there are; a renderer is asked them by a [`pack`], by a [`process`] or through the trait
//! [`renderer::Renderer`]; a [`ledger::Ledger`] judges its answers as they come, and a [`report`] says what became of them.

pub mod answer;
pub mod answers;
pub mod baseline;
pub mod error;
pub mod expectations;
pub mod frame;
pub mod known;
pub mod ledger;
pub mod pack;
pub mod picture;
pub mod plan;
mod problems;
pub mod process;
pub mod renderer;
pub mod report;
pub mod tally;
pub mod verdict;
