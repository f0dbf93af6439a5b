//! Promises that drivers are known to break.

use super::probe::Probe;

/// A promise that is known to be broken.
#[derive(Clone, Copy, Debug)]
pub struct SpecialDeviation {
    /// Its name in reports.
    pub name: &'static str,
    /// Of which interface.
    pub backend: &'static str,
    /// Of which probes.
    pub probes: &'static [&'static str],
    /// Why.
    pub reason: &'static str,
}

/// Every promise that is known to be broken. Where a record binds, it also says by which value.
pub const DEVIATIONS: &[SpecialDeviation] = &[SpecialDeviation {
    name: "gl-unclamped-conversions",
    backend: "gl",
    probes: &["negative-to-u32", "too-large-to-u32", "too-large-to-i32", "too-small-to-i32"],
    reason: "naga 30 clamps a float before it becomes an integer in SPIR-V, not in GLSL, where a value out of range is undefined",
}];

impl SpecialDeviation {
    /// What is known of a probe on an interface.
    #[must_use]
    pub fn of(probe: &Probe, backend: &str) -> Option<&'static Self> {
        DEVIATIONS.iter().find(|deviation| deviation.backend == backend && deviation.probes.contains(&probe.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_name_probes_that_are_promised_something() {
        for name in DEVIATIONS.iter().flat_map(|deviation| deviation.probes) {
            let probe = Probe::by_name(name).unwrap_or_else(|| panic!("no probe {name}"));
            assert!(probe.promise.is_definite(), "{name}");
            assert!(
                SpecialDeviation::of(probe, "gl").is_some() && SpecialDeviation::of(probe, "vulkan").is_none(),
                "{name}"
            );
        }
    }
}
