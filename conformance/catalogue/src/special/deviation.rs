//! Promises that drivers are known to break.

use super::probe::Probe;
use lightmeter_document::Word;
use lightmeter_document::special::SpecialDeviation;
use std::borrow::Cow;

/// Every promise that is known to be broken. Where a record binds, it also says by which value.
pub static DEVIATIONS: &[SpecialDeviation] = &[SpecialDeviation {
    name: Word::Borrowed("gl-unclamped-conversions"),
    backend: Word::Borrowed("gl"),
    probes: Cow::Borrowed(&[
        Word::Borrowed("negative-to-u32"),
        Word::Borrowed("too-large-to-u32"),
        Word::Borrowed("too-large-to-i32"),
        Word::Borrowed("too-small-to-i32"),
    ]),
    reason: Word::Borrowed(
        "naga 30 clamps a float before it becomes an integer in SPIR-V, not in GLSL, where a value out of range is undefined",
    ),
}];

/// What is known of a probe on an interface.
#[must_use]
pub fn deviation_of(probe: &Probe, backend: &str) -> Option<&'static SpecialDeviation> {
    let concerns =
        |known: &&SpecialDeviation| known.backend == backend && known.probes.iter().any(|name| name == probe.name);
    DEVIATIONS.iter().find(concerns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_name_probes_that_are_promised_something() {
        for name in DEVIATIONS.iter().flat_map(|deviation| deviation.probes.iter()) {
            let probe = Probe::by_name(name).unwrap_or_else(|| panic!("no probe {name}"));
            assert!(probe.promise.is_definite(), "{name}");
            assert!(deviation_of(probe, "gl").is_some() && deviation_of(probe, "vulkan").is_none(), "{name}");
        }
    }
}
