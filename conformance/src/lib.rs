//! The suite: cases, acceptance, verdicts, the runner and its reports, as a library for the `lightmeter` binary and others.

pub mod bench;
pub mod blend_unit;
pub mod device;
pub mod evaluate;
pub mod faults;
pub mod gate;
pub mod image;
pub mod options;
pub mod report;
pub mod run;
pub mod selection;
pub mod special;
pub mod stability;
pub mod subject;
pub mod subject_gpu;
pub mod sweep;
pub mod witness;

pub use lightmeter_arithmetic as arithmetic;
pub use lightmeter_catalogue::{cases, filter, scene, select};
pub use lightmeter_document as document;
pub use lightmeter_judge as judge;
pub use lightmeter_judge::{devices, tally};
pub use subject_gpu::adapters;
