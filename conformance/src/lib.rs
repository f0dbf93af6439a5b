//! Lightmeter as a library: the crates of the suite in one library, each module named by its subject.
//!
//! [`harness`] judges an engine's formulas within its own tests. For that alone, without wgpu and the command, depend upon it with
//! `default-features = false`; the features `harness`, `scenes`, `report`, `gpu` and `cli` add the rest.

pub use lightmeter_arithmetic as arithmetic;
#[cfg(feature = "gpu")]
pub use lightmeter_bench as bench;
#[cfg(feature = "cli")]
pub use lightmeter_book as book;
#[cfg(feature = "gpu")]
pub use lightmeter_browser as browser;
pub use lightmeter_catalogue::{cases, dialects, filter, nearest, rulings, scene, select};
pub use lightmeter_document as document;
pub use lightmeter_engine::{device, evaluate, merge, options, piece, rows, run, selection, subject, sweep, witness};
pub use lightmeter_faults as faults;
pub use lightmeter_files as files;
pub use lightmeter_gate as gate;
pub use lightmeter_harness as harness;
pub use lightmeter_judge as judge;
pub use lightmeter_judge::{devices, formula, tally};
pub use lightmeter_report as report;
#[cfg(feature = "gpu")]
pub use lightmeter_subject_gpu as subject_gpu;
#[cfg(feature = "gpu")]
pub use lightmeter_subject_gpu::adapters;

/// Blend units: what is legal of them, and how they are run.
pub mod blend_unit {
    pub use lightmeter_engine::blend_unit::{draw, run, selftest};
    pub use lightmeter_judge::blend_unit::{embedded, expect, model, pixel, policy, rules, store, tally};
}

/// Images: what is legal of them, and how they are drawn and judged.
pub mod image {
    pub use lightmeter_engine::image::{diagnose, drawn, run, verdict};
    pub use lightmeter_judge::image::{LegalPixel, expect, file, judge, map};
}

/// Special values: what is asked and promised, what is on record, and how they are run.
pub mod special {
    pub use lightmeter_catalogue::special::{
        Class, DEVIATIONS, FAMILY, Gives, PROBES, Probe, Promise, Source, Way, deviation_of,
    };
    pub use lightmeter_engine::special::{run, verdict};
    pub use lightmeter_judge::special::record;
}

/// Hard cases on both sides, and the conditions of formulas.
pub mod stability {
    pub use lightmeter_engine::stability::*;
    pub use lightmeter_judge::stability::{
        ILL_CONDITIONED, ROUNDING, UNSTABLE, condition, conditioning, roundings, size, text,
    };
}
