//! Makes a shader as somebody wrote it the function of a formula.
//!
//! A shader has uniforms, varyings and textures of its own names; a formula has inputs. The shader's text is read as all are
//! (`lightmeter_shaders::read`). Its uniforms, inputs and textures become variables of the
//! invocation, and its entry point a function ([`program`]). Each variable is bound to an expression over the formula's inputs, by its name
//! or as was asked for ([`bind`]), and the formula's own WGSL function is replaced by one that sets them and calls the shader's
//! (`wrapper`). From there on it is judged as any other shader is.
//!
//! Nothing here computes a formula: what a bound expression normalises or multiplies, the shader's own driver computes.

pub mod bind;
pub mod constant;
mod ending;
mod error;
mod meaning;
mod name;
pub mod place;
pub mod program;
pub mod step;
mod suggest;
mod synonyms;
mod unanswered;
mod wrapper;

pub use error::AdaptError;
pub use program::{Part, ShaderProgram};
pub use suggest::{in_language, stable_form};
pub use synonyms::synonyms;
pub use unanswered::MOST_TURNS;
pub use wrapper::replaced;
