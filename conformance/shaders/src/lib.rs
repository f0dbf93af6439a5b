//! A shader as people have it: read, made a graph, its steps found by what they compute.
//!
//! A shader is a sum of steps: a Lambert factor, a highlight, an attenuation, fog, a gamma curve. Each is right, a dialect, or wrong.
//! [`read`] gets a file into naga's intermediate language, whoever can read it. `lower` makes its functions a [`graph`], calls inlined.
//! `unify` compares parts of the graph with `templates` on random inputs: syntax and names do not matter. `review` takes what fits best, finds
//! what each vector is for by what is done with it, and looks at what multiplies what.
//!
//! [`accepted`] marks the steps that a project means as they are.
//!
//! Nothing here knows a GPU.

pub mod accepted;
mod function;
pub mod graph;
mod lower;
mod templates;
mod unify;

pub use function::EvaluatedFunction;
pub use review::Reviewer;
pub mod read;
mod review;

use lightmeter_document::report::{StepFunction, StepVerdict};

/// Each form that steps are compared with as a function, with what a step of it is.
///
/// # Errors
/// Which form is not as it should be: none that is built in.
pub fn forms() -> Result<Vec<(StepVerdict, StepFunction)>, String> {
    Ok(templates::functions()?.into_iter().map(|(worth, own)| (worth.into(), own)).collect())
}
