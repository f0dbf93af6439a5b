//! Mutants: WGSL in which one constant, operator or argument is another one, and whether the suite tells each from what is right.
//!
//! A mutant is *killed* where a run of the cases that its function takes part in fails. One that survives is classified by more inputs than a run
//! draws. It is *equal* where it gives the same bits on a million inputs of each formula and on all hard cases, *legal* where all that it gives there
//! is within the interval, and else *missed*. The inputs of scenes are random frames, a million pixels of them. Of what fixed functions draw (the rasteriser,
//! the depth test, the blend unit) a million answers are judged, without comparing bits: it is *legal* or *missed*. The tables of special values have no other inputs.

mod campaign;
mod generate;
mod survivors;
pub(crate) mod tokens;

pub use campaign::{Campaign, MutantClass, Scope};
pub use generate::{Mutant, mutants};
pub use survivors::{SURVIVORS, Survivors};
