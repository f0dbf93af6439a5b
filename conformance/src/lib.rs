//! Lightmeter as a library: the rooms of the suite under one roof, each by the name of its subject.

pub use lightmeter_arithmetic as arithmetic;
pub use lightmeter_bench as bench;
pub use lightmeter_catalogue::{cases, filter, scene, select};
pub use lightmeter_document as document;
pub use lightmeter_engine::{
    blend_unit, device, evaluate, image, options, piece, rows, run, selection, special, stability, subject, sweep,
    witness,
};
pub use lightmeter_faults as faults;
pub use lightmeter_gate as gate;
pub use lightmeter_judge as judge;
pub use lightmeter_judge::{devices, formula, tally};
pub use lightmeter_report as report;
pub use lightmeter_subject_gpu as subject_gpu;
pub use lightmeter_subject_gpu::adapters;
