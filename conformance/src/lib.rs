//! The suite: cases, acceptance, verdicts, the runner and its reports, as a library for the `lightmeter` binary and others.

pub mod adapters;
pub mod bench;
pub mod blend_unit;
pub mod devices;
pub mod evaluate;
pub mod faults;
pub mod gate;
pub mod image;
pub mod judge;
pub mod options;
pub mod report;
pub mod run;
pub mod selection;
pub mod special;
pub mod stability;
pub mod subject;
pub mod sweep;
pub mod tally;
pub mod witness;

pub use lightmeter_arithmetic as arithmetic;
pub use lightmeter_catalogue::{cases, filter, scene, select};
pub use lightmeter_document as document;
