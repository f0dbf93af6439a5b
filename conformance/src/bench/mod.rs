//! What accuracy costs in time: techniques and rungs of the ladder, each with its error against the f64 reference and with the
//! time that it takes.

pub mod document;
pub mod errors;
pub mod turns;
