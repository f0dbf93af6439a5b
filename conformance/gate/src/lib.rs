//! The gate: any renderer, in any language, judged by the cases of the catalogue and the built-in scenes.
//!
//! A renderer is asked by files ([`pack`], [`answers`]), as a [`process`], or through the trait [`renderer::Renderer`]. Each of the three
//! is a subject of the engine like any adapter: what it answers is judged there.

pub mod answer;
pub mod answers;
pub mod baseline;
#[cfg(feature = "scenes")]
mod columns;
#[cfg(not(feature = "scenes"))]
#[path = "columns_absent.rs"]
mod columns;
pub mod error;
mod excludes;
pub mod expectations;
mod formula_skips;
pub mod frame;
mod given;
pub mod hello;
pub mod pack;
pub mod picture;
pub mod plan;
mod problems;
pub mod process;
pub mod renderer;
pub mod words;
