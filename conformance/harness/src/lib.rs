//! An engine's formulas, judged within its own `cargo test`.
//!
//! One line in a test target without a harness of its own makes one test of each formula, which takes the feature `suite`:
//!
//! ```no_run
//! # #[cfg(feature = "suite")]
//! # use lightmeter_harness::{Formulas, Suite};
//! # use std::process::ExitCode;
//! # #[cfg(not(feature = "suite"))]
//! # fn main() {}
//! # #[cfg(feature = "suite")]
//! fn main() -> ExitCode {
//!     let engine = Formulas::new("my-engine", "1.0").with("vector/toward", |x| {
//!         let [light, p] = [x.vec3("light"), x.vec3("p")];
//!         let v = [light[0] - p[0], light[1] - p[1], light[2] - p[2]];
//!         let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
//!         v.map(|x| x / length)
//!     });
//!     Suite::new(engine).main()
//! }
//! ```
//!
//! [`assert_formula`] judges one within an ordinary test:
//!
//! ```
//! # use lightmeter_harness::assert_formula;
//! assert_formula("color/modulate", |x| {
//!     let (texel, color) = (x.vec4("texel"), x.vec4("color"));
//!     [0, 1, 2, 3].map(|k| texel[k] * color[k])
//! });
//! ```
//!
//! Both judge by the cases, the intervals of legal values and the diagnosis of `lightmeter gate`, and print what it prints.

mod engine;
mod judging;
mod one;
#[cfg(feature = "suite")]
mod suite;
mod values;

pub use engine::{Engine, Formulas};
pub use judging::HarnessError;
pub use lightmeter_document::by_case::SourcePlace;
pub use one::assert_formula;
#[cfg(feature = "suite")]
pub use suite::Suite;
pub use values::{FormulaInputs, FormulaOutputs};
