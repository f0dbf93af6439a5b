//! What formulas are evaluated in besides `f64` and `f32`: intervals of legal values, derivatives, recorded steps.

pub mod accept;
pub mod dual;
pub mod fixed;
pub mod format;
pub mod mistaken;
mod order;
pub mod paths;
pub mod profile;
pub mod random;
pub mod trace;

#[cfg(test)]
mod tests;

pub use accept::Accept;
pub use dual::Dual;
pub use fixed::Fixed;
pub use format::{F16, F32, Format, Hardware};
pub use profile::Profile;
pub use random::RandomLegal;
pub use trace::Trace;
