//! What each driver was seen to make of the probes, a file a driver in `conformance/judge/records/special/`.
//!
//! `lightmeter special --record DIR` writes them. A record *binds* a driver that tells its version, where device and driver
//! are those of the record: another result than there is a failure. To others of the same name it is shown alone.

use crate::devices::version;
use lightmeter_catalogue::special::Probe;
use lightmeter_document::report::Identity;
use lightmeter_document::special::record::SpecialRecord;
use std::sync::LazyLock;

/// The files.
const FILES: [(&str, &str); 3] = [
    ("lavapipe.json", include_str!("../../records/special/lavapipe.json")),
    ("llvmpipe-gl.json", include_str!("../../records/special/llvmpipe-gl.json")),
    ("swiftshader.json", include_str!("../../records/special/swiftshader.json")),
];

/// A record as it concerns an adapter.
#[derive(Clone, Copy, Debug)]
pub struct OnRecord {
    record: &'static SpecialRecord,
    /// Whether another result fails.
    pub binds: bool,
}

static RECORDS: LazyLock<Vec<SpecialRecord>> = LazyLock::new(|| {
    let read = |(name, text): &(&str, &str)| {
        serde_json::from_str(text).unwrap_or_else(|error| panic!("conformance/judge/records/special/{name}: {error}"))
    };
    FILES.iter().map(read).collect()
});

/// The bits on record of a probe in a stage; of several those that are given, where they are among them.
#[must_use]
pub fn recorded(record: &SpecialRecord, probe: &Probe, stage: &str, given: u32) -> Option<u32> {
    let mut first = None;
    for bits in all(record, probe, stage) {
        if bits == given {
            return Some(bits);
        }
        first.get_or_insert(bits);
    }
    first
}

/// All bits on record. Where the driver leaves a result to the processor's instructions, which differ between processors of one architecture,
/// all that were seen stand beside each other: `0xffffffff or 0x00000000`.
fn all(record: &SpecialRecord, probe: &Probe, stage: &str) -> impl Iterator<Item = u32> {
    let text = record.results.get(probe.name).and_then(|stages| stages.get(stage)).map_or("", String::as_str);
    text.split(" or ").filter_map(|one| u32::from_str_radix(one.strip_prefix("0x")?, 16).ok())
}

fn binds(record: &SpecialRecord, identity: &Identity, processor: &str) -> bool {
    version(&identity.driver).is_some()
        && record.device == identity.device
        && record.driver == identity.driver
        && record.processor == processor
}

/// For people: `llvmpipe, Mesa 22.3.6 (LLVM 15.0.6)`.
#[must_use]
pub fn whose(record: &SpecialRecord) -> String {
    if record.driver.contains(&record.device) || version(&record.driver).is_some() {
        record.driver.clone()
    } else {
        format!("{} ({})", record.driver, record.device)
    }
}

impl OnRecord {
    /// What is on record of an adapter: the record that binds it, or else one of the same name.
    #[must_use]
    pub fn of(identity: &Identity) -> Option<Self> {
        Self::among(&RECORDS, identity, std::env::consts::ARCH)
    }

    fn among(records: &'static [SpecialRecord], identity: &Identity, processor: &str) -> Option<Self> {
        let mut same = records.iter().filter(|r| r.backend == identity.backend);
        let found = same.clone().find(|record| binds(record, identity, processor));
        let binds = found.is_some();
        let record = found.or_else(|| same.find(|record| record.name == identity.name))?;
        Some(Self { record, binds })
    }

    /// The record.
    #[must_use]
    pub const fn record(&self) -> &'static SpecialRecord {
        self.record
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::special::{PROBES, Way, deviation_of};
    use lightmeter_document::special::record::SCHEMA;
    use std::collections::BTreeMap;

    fn identity(device: &str, driver: &str) -> Identity {
        Identity { name: "lavapipe".into(), device: device.into(), backend: "vulkan".into(), driver: driver.into() }
    }

    fn record(identity: &Identity) -> SpecialRecord {
        let Identity { name, device, backend, driver } = identity.clone();
        let (processor, results) = (std::env::consts::ARCH.into(), BTreeMap::new());
        SpecialRecord { schema: SCHEMA.into(), name, device, backend, driver, processor, results }
    }

    fn one(identity: &Identity) -> &'static [SpecialRecord] {
        let mut record = record(identity);
        let given = BTreeMap::from([("compute".to_owned(), "0xffc00000".to_owned())]);
        record.results.insert("nan-plus-one".into(), given);
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
        let again: SpecialRecord = serde_json::from_str(&text).expect("it reads back");
        assert_eq!(&again, record);
        let probe = Probe::by_name("nan-plus-one").expect("it is in the table");
        let get = |stage| recorded(&again, probe, stage, 0);
        assert_eq!((get("compute"), get("fragment")), (Some(0xffc0_0000), None));
    }

    #[test]
    fn of_several_results_on_record_each_is_as_recorded_and_no_other() {
        let mut record = record(&identity("a", "b"));
        let probe = Probe::by_name("nan-to-u32").expect("it is in the table");
        let both = BTreeMap::from([("compute".to_owned(), "0xffffffff or 0x00000000".to_owned())]);
        record.results.insert(probe.name.into(), both);
        let get = |given| recorded(&record, probe, "compute", given);
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
                        all(record, probe, stage).next().is_some(),
                        "{} has no {}, {stage}",
                        record.name,
                        probe.name
                    );
                    let is_known = deviation_of(probe, &record.backend).is_some();
                    for bits in all(record, probe, stage) {
                        let (name, of) = (probe.name, &record.name);
                        assert!(is_known || probe.promise.allows(bits), "{name} on {of}, {stage}: 0x{bits:08x}");
                    }
                }
            }
        }
    }
}
