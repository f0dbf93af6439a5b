//! Mutants: WGSL in which one constant, operator or argument is another one, and whether the suite tells each from what is right.
//!
//! A mutant is *killed* where a run of the cases that its function takes part in fails. One that survives is classified by bits: *equal* where it gives
//! the same bits on a million inputs of each formula and on all hard cases, *legal* where all that it gives there is within the interval, and else
//! *missed*. In scenes, where no million inputs are to be had, it is *legal* where it changes a pixel, since no pixel failed, and else *unshown*.

mod campaign;
mod generate;
mod survivors;
pub(crate) mod tokens;

pub use campaign::{Campaign, MutantClass, Scope};
pub use generate::{Mutant, mutants};
pub use survivors::{SURVIVORS, Survivors};
