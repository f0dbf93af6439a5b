//! What each driver was seen to make of the probes, a file a driver in `conformance/judge/records/special/`.
//!
//! `lightmeter special --record DIR` writes them. A record *binds* a driver that tells its version, where device and driver
//! are those of the record: another result than there is a failure. To others of the same name it is shown alone.

use crate::devices::version;
use lightmeter_catalogue::special::Probe;
use lightmeter_document::report::Identity;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The files.
const FILES: [(&str, &str); 3] = [
    ("lavapipe.json", include_str!("../../records/special/lavapipe.json")),
    ("llvmpipe-gl.json", include_str!("../../records/special/llvmpipe-gl.json")),
    ("swiftshader.json", include_str!("../../records/special/swiftshader.json")),
];

const SCHEMA: &str = "lightmeter.special-record/1";

/// A driver's results: bits as `0x…` by stage, by the probe's name. Where the driver leaves a result to the processor's instructions, which
/// differ between processors of one architecture, all that were seen stand beside each other: `0xffffffff or 0x00000000`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DriverRecord {
    schema: String,
    /// The adapter's short name.
    pub name: String,
    /// The device as the driver named it.
    pub device: String,
    /// `vulkan` or `gl`.
    pub backend: String,
    /// The driver and its version.
    pub driver: String,
    /// Of the processor: which NaN an invalid operation gives is the processor's choice.
    pub processor: String,
    results: BTreeMap<String, BTreeMap<String, String>>,
}

/// A record as it concerns an adapter.
#[derive(Clone, Copy, Debug)]
pub struct OnRecord {
    record: &'static DriverRecord,
    /// Whether another result fails.
    pub binds: bool,
}

static RECORDS: LazyLock<Vec<DriverRecord>> = LazyLock::new(|| {
    let read = |(name, text): &(&str, &str)| {
        serde_json::from_str(text).unwrap_or_else(|error| panic!("conformance/judge/records/special/{name}: {error}"))
    };
    FILES.iter().map(read).collect()
});

impl DriverRecord {
    /// A record without results.
    #[must_use]
    pub fn new(identity: &Identity) -> Self {
        Self {
            schema: SCHEMA.into(),
            name: identity.name.clone(),
            device: identity.device.clone(),
            backend: identity.backend.to_string(),
            driver: identity.driver.clone(),
            processor: std::env::consts::ARCH.into(),
            results: BTreeMap::new(),
        }
    }

    /// Notes a result.
    pub fn note(&mut self, probe: &str, stage: &str, bits: u32) {
        self.results.entry(probe.into()).or_default().insert(stage.into(), format!("0x{bits:08x}"));
    }

    /// The bits on record; of several those that are given, where they are among them.
    #[must_use]
    pub fn get(&self, probe: &Probe, stage: &str, given: u32) -> Option<u32> {
        let mut first = None;
        for bits in self.all(probe, stage) {
            if bits == given {
                return Some(bits);
            }
            first.get_or_insert(bits);
        }
        first
    }

    /// All bits on record.
    fn all(&self, probe: &Probe, stage: &str) -> impl Iterator<Item = u32> {
        let text = self.results.get(probe.name).and_then(|stages| stages.get(stage)).map_or("", String::as_str);
        text.split(" or ").filter_map(|one| u32::from_str_radix(one.strip_prefix("0x")?, 16).ok())
    }

    fn binds(&self, identity: &Identity, processor: &str) -> bool {
        version(&identity.driver).is_some()
            && self.device == identity.device
            && self.driver == identity.driver
            && self.processor == processor
    }

    /// For people: `llvmpipe, Mesa 22.3.6 (LLVM 15.0.6)`.
    #[must_use]
    pub fn whose(&self) -> String {
        if self.driver.contains(&self.device) || version(&self.driver).is_some() {
            self.driver.clone()
        } else {
            format!("{} ({})", self.driver, self.device)
        }
    }
}

impl OnRecord {
    /// What is on record of an adapter: the record that binds it, or else one of the same name.
    #[must_use]
    pub fn of(identity: &Identity) -> Option<Self> {
        Self::among(&RECORDS, identity, std::env::consts::ARCH)
    }

    fn among(records: &'static [DriverRecord], identity: &Identity, processor: &str) -> Option<Self> {
        let mut same = records.iter().filter(|r| r.backend == identity.backend);
        let found = same.clone().find(|record| record.binds(identity, processor));
        let binds = found.is_some();
        let record = found.or_else(|| same.find(|record| record.name == identity.name))?;
        Some(Self { record, binds })
    }

    /// The record.
    #[must_use]
    pub const fn record(&self) -> &'static DriverRecord {
        self.record
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::special::{PROBES, SpecialDeviation, Way};

    fn identity(device: &str, driver: &str) -> Identity {
        Identity { name: "lavapipe".into(), device: device.into(), backend: "vulkan".into(), driver: driver.into() }
    }

    fn one(identity: &Identity) -> &'static [DriverRecord] {
        let mut record = DriverRecord::new(identity);
        record.note("nan-plus-one", "compute", 0xffc0_0000);
        Box::leak(Box::new([record]))
    }

    #[test]
    fn a_record_binds_the_driver_that_it_was_made_of() {
        let mesa = identity("llvmpipe (256 bits)", "llvmpipe, Mesa 22.3.6");
        let records = one(&mesa);
        let binds = |identity: &Identity, processor| OnRecord::among(records, identity, processor).map(|of| of.binds);
        let here = std::env::consts::ARCH;
        assert_eq!(binds(&mesa, here), Some(true));
        assert_eq!(binds(&mesa, "another"), Some(false));
        assert_eq!(binds(&identity("llvmpipe (256 bits)", "llvmpipe, Mesa 23.0.0"), here), Some(false));
        assert_eq!(binds(&identity("llvmpipe (128 bits)", "llvmpipe, Mesa 22.3.6"), here), Some(false));
        let other = Identity { name: "radv".into(), ..identity("a card", "radv, Mesa 25.0.0") };
        assert_eq!(binds(&other, here), None);
        assert_eq!(binds(&Identity { backend: "gl".into(), ..mesa.clone() }, here), None);
    }

    #[test]
    fn a_driver_that_tells_no_version_is_not_bound() {
        let swiftshader = identity("SwiftShader Device (Subzero)", "SwiftShader driver");
        let found = OnRecord::among(one(&swiftshader), &swiftshader, std::env::consts::ARCH);
        assert!(!found.expect("there is a record").binds);
    }

    #[test]
    fn records_read_back_what_was_noted() {
        let whose = identity("a", "b");
        let record = &one(&whose)[0];
        let text = serde_json::to_string(record).expect("a record is JSON");
        let again: DriverRecord = serde_json::from_str(&text).expect("it reads back");
        assert_eq!(&again, record);
        let probe = Probe::by_name("nan-plus-one").expect("it is in the table");
        let get = |stage| again.get(probe, stage, 0);
        assert_eq!((get("compute"), get("fragment")), (Some(0xffc0_0000), None));
    }

    #[test]
    fn of_several_results_on_record_each_is_as_recorded_and_no_other() {
        let mut record = DriverRecord::new(&identity("a", "b"));
        let probe = Probe::by_name("nan-to-u32").expect("it is in the table");
        let both = BTreeMap::from([("compute".to_owned(), "0xffffffff or 0x00000000".to_owned())]);
        record.results.insert(probe.name.into(), both);
        let get = |given| record.get(probe, "compute", given);
        assert_eq!([get(u32::MAX), get(0), get(7)], [Some(u32::MAX), Some(0), Some(u32::MAX)]);
    }

    #[test]
    fn every_record_has_every_probe_and_no_other() {
        for record in RECORDS.iter() {
            assert_eq!(record.schema, SCHEMA, "{}", record.name);
            assert!(record.results.keys().all(|name| Probe::by_name(name).is_some()), "{}", record.name);
            for probe in PROBES {
                let stages: &[&str] =
                    if let Way::Function(_) = probe.way { &["compute", "fragment"] } else { &["raster"] };
                for stage in stages {
                    assert!(
                        record.all(probe, stage).next().is_some(),
                        "{} has no {}, {stage}",
                        record.name,
                        probe.name
                    );
                    let is_known = SpecialDeviation::of(probe, &record.backend).is_some();
                    for bits in record.all(probe, stage) {
                        let (name, of) = (probe.name, &record.name);
                        assert!(is_known || probe.promise.allows(bits), "{name} on {of}, {stage}: 0x{bits:08x}");
                    }
                }
            }
        }
    }
}
