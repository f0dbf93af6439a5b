//! What a driver was seen to make of the probes, which `special --record` writes: `lightmeter.special-record/1`.

use super::SpecialReport;
use crate::Word;
use crate::report::Identity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The schema of [`SpecialRecord`].
pub const SCHEMA: &str = "lightmeter.special-record/1";

/// A driver's results.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpecialRecord {
    /// `lightmeter.special-record/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The adapter's short name.
    pub name: String,
    /// The device as the driver named it.
    pub device: String,
    /// `vulkan` or `gl`.
    pub backend: Word,
    /// The driver and its version.
    pub driver: String,
    /// The architecture of the processor, which chooses the NaN that an invalid operation gives.
    pub processor: Word,
    /// Bits as `0x7fc00000` by stage, by the probe's name.
    pub results: BTreeMap<String, BTreeMap<String, String>>,
}

impl SpecialRecord {
    /// The results that a report has of an adapter on this processor.
    #[must_use]
    pub fn of(report: &SpecialReport, adapter: &Identity) -> Self {
        let mut results = BTreeMap::<String, BTreeMap<String, String>>::new();
        for outcome in report.outcomes.iter().filter(|outcome| outcome.adapter == adapter.name) {
            let stages = results.entry(outcome.probe.to_string()).or_default();
            stages.insert(outcome.stage.to_string(), format!("0x{:08x}", outcome.bits));
        }
        let Identity { name, device, backend, driver } = adapter.clone();
        Self { schema: SCHEMA.into(), name, device, backend, driver, processor: std::env::consts::ARCH.into(), results }
    }
}
