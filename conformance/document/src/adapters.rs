//! The JSON of `adapters`.

use crate::Word;
use lightmeter_scene::target::TargetFormat;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The schema of [`AdaptersDocument`].
pub const SCHEMA: &str = "lightmeter.adapters/1";

/// The JSON of `adapters`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AdaptersDocument {
    /// `lightmeter.adapters/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The adapters; the embedded implementation, `cpu`, is not among them.
    pub adapters: Vec<ListedAdapter>,
}

/// An adapter, and what is known of its driver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ListedAdapter {
    /// The short name.
    pub name: String,
    /// The device as the driver names it.
    pub device: String,
    /// `vulkan` or `gl`.
    pub backend: Word,
    /// The driver and its version.
    pub driver: String,
    /// Whether the driver computes on the processor.
    pub is_cpu: bool,
    /// Subpixel bits of the rasteriser, where they are known.
    pub subpixel_bits: Option<u32>,
    /// Known departures of built-in functions.
    pub deviations: Vec<Deviation>,
    /// The integer model that the blend unit follows bit for bit, where one is known.
    pub blend_model: Option<Word>,
    /// Known departures of the blend unit.
    pub blend_deviations: Vec<BlendDeviation>,
}

/// A known departure of a built-in function from its promised accuracy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Deviation {
    /// The name in reports.
    pub name: Word,
    /// A part of the driver's own description.
    pub driver: Word,
    /// The first version concerned: major, minor, patch.
    pub from: [u32; 3],
    /// The first version no longer concerned.
    pub until: [u32; 3],
    /// The reason, with the evidence.
    pub reason: Word,
    /// The built-in function.
    pub builtin: Builtin,
    /// The least argument concerned.
    pub low: f64,
    /// The greatest argument concerned.
    pub high: f64,
    /// How many times the promised bound is granted there.
    pub factor: f64,
    /// An argument at which the driver is seen outside the promised bound.
    pub witness: f32,
}

/// A built-in function that a deviation concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Builtin {
    /// exp.
    Exp,
    /// exp2, and so pow.
    Exp2,
}

/// A known departure of a blend unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BlendDeviation {
    /// The name in reports.
    pub name: Word,
    /// A part of the driver's own description.
    pub driver: Word,
    /// The reason, with the evidence.
    pub reason: Word,
    /// The target concerned.
    pub target: TargetFormat,
    /// The least magnitude of the results concerned.
    pub from: f64,
    /// Whether such results are granted a NaN.
    pub becomes_nan: bool,
    /// A case in which the driver is seen to do so.
    pub witness: Word,
}
