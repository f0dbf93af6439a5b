//! NaN, infinity, subnormals and signed zero in shader arithmetic: what the language promises, and what each driver does.
//!
//! A *probe* is one operation on stated operands, evaluated in the compute and in the fragment stage, or carried through the
//! rasteriser. Where the language promises something definite, another result is a broken promise. Where it promises nothing
//! the result is indeterminate. Either way it is compared with what is on record for that driver: a renderer that depends
//! on it should know when it changes. Blending has a policy of its own, in `blend_unit/policy.rs`.

mod deviation;
mod gives;
mod probe;
mod promise;
mod source;
mod table;

pub use deviation::{DEVIATIONS, deviation_of};
pub use gives::Gives;
pub use probe::{Class, FAMILY, Probe, Way};
pub use promise::Promise;
pub use source::Source;
pub use table::PROBES;
