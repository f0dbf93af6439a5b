//! Named deviations of drivers, whatever they concern, and their witnesses: where a driver that a deviation concerns no longer
//! shows it, the deviation is no longer needed.

use crate::blend_unit;
use crate::options::Options;
use lightmeter_catalogue::filter::Filter;
use lightmeter_document::adapters::{BlendDeviation, Deviation};
use lightmeter_document::special::SpecialDeviation;
use lightmeter_judge::devices;
use lightmeter_judge::devices::{exact, grant, interval, probe};
use lightmeter_judge::{Outcome, judge};

use crate::device::{Code, DeviceError};
use crate::special;
use crate::subject::Subject;
use lightmeter_arithmetic::Profile;
use lightmeter_arithmetic::profile::WGSL;
use lightmeter_catalogue::select::{CaseRef, Member, Random, Selected};
use lightmeter_catalogue::special as special_values;
use lightmeter_catalogue::special::Probe;
use lightmeter_document::event::Silent;
use lightmeter_document::report::{DeviationUse, Report, Totals};
use lightmeter_document::special::ProbeResult;

/// The first segment of the ids.
pub const FAMILY: &str = "deviation";

/// A named deviation.
#[derive(Clone, Copy, Debug)]
pub enum NamedDeviation {
    /// Of the accuracy of a built-in function.
    Accuracy(&'static Deviation),
    /// Of a blend unit.
    Blend(&'static BlendDeviation),
    /// Of what is promised of NaN, infinity, subnormals and signed zero.
    Special(&'static SpecialDeviation),
}

impl NamedDeviation {
    /// All of them, in the order of reports.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let accuracy = devices::DEVIATIONS.iter().map(Self::Accuracy);
        let blend = devices::BLEND_DEVIATIONS.iter().map(Self::Blend);
        accuracy.chain(blend).chain(special_values::DEVIATIONS.iter().map(Self::Special)).collect()
    }

    /// Those that a filter selects by their ids.
    #[must_use]
    pub fn named(filter: &Filter) -> Vec<Self> {
        Self::all().into_iter().filter(|deviation| filter.selects(&deviation.id())).collect()
    }

    /// Its id: `deviation/llvmpipe-exp`.
    #[must_use]
    pub fn id(self) -> String {
        format!("{FAMILY}/{}", self.name())
    }

    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Accuracy(deviation) => &deviation.name,
            Self::Blend(deviation) => &deviation.name,
            Self::Special(deviation) => &deviation.name,
        }
    }

    /// Why it is granted.
    #[must_use]
    pub fn reason(self) -> &'static str {
        match self {
            Self::Accuracy(deviation) => &deviation.reason,
            Self::Blend(deviation) => &deviation.reason,
            Self::Special(deviation) => &deviation.reason,
        }
    }

    /// Whether its witness still shows it on a subject; `None` where it does not concern the subject, or the subject cannot
    /// evaluate the witness. The driver is asked, by the built-in shaders, not the shaders under test.
    ///
    /// # Errors
    /// Where the device fails.
    pub fn is_still_seen(
        self,
        subject: &mut Subject,
        catalogue: &[Member],
        options: &Options,
    ) -> Result<Option<bool>, DeviceError> {
        let Some(device) = subject.device() else { return Ok(None) };
        let code = device.built_in()?;
        match self {
            Self::Accuracy(deviation) => accuracy(deviation, subject, &code, options.profile),
            Self::Blend(deviation) => blend(deviation, subject, catalogue, Options { code, ..options.clone() }),
            Self::Special(deviation) => special(deviation, subject, &code),
        }
    }
}

/// Whether the function's value at the witness is the deviation that is described: outside of what is promised, and inside of what is
/// granted. Wronger than that is another mistake, which the cases will show.
fn shows(deviation: &Deviation, bits: u32, profile: &Profile) -> bool {
    let promised = interval(deviation.builtin, deviation.witness, profile);
    let granted = interval(deviation.builtin, deviation.witness, &grant(deviation, *profile));
    let exact = exact(deviation.builtin, deviation.witness);
    let outcome = |legal| judge(bits, exact, legal).outcome;
    outcome(&promised) == Outcome::Fail && outcome(&granted) == Outcome::Pass
}

/// Whether the witness of a function's accuracy shows its deviation, by these shaders; `None` as for [`NamedDeviation::is_still_seen`].
///
/// # Errors
/// Where the device fails.
pub fn accuracy(
    deviation: &Deviation,
    subject: &Subject,
    code: &Code,
    profile: &Profile,
) -> Result<Option<bool>, DeviceError> {
    if !subject.known.deviations.iter().any(|known| known.name == deviation.name) {
        return Ok(None);
    }
    let Some(device) = subject.device() else { return Ok(None) };
    let Some(bits) = device.probe(code, probe(deviation.builtin), deviation.witness)? else { return Ok(None) };
    let is_shown = shows(deviation, bits, profile);
    // If the rules of the chosen profile allow the driver's value, it is no deviation under that profile, so there is nothing to report.
    let is_allowed = !is_shown && shows(deviation, bits, &WGSL);
    Ok((!is_allowed).then_some(is_shown))
}

/// The case that is the witness, on the target that the deviation is of.
fn blend(
    deviation: &BlendDeviation,
    subject: &mut Subject,
    catalogue: &[Member],
    options: Options,
) -> Result<Option<bool>, DeviceError> {
    if !subject.known.blend_deviations.iter().any(|known| known.name == deviation.name) {
        return Ok(None);
    }
    let found =
        catalogue.iter().enumerate().find_map(|(place, member)| Some((place, member.case(&deviation.witness)?)));
    let Some((place, CaseRef::Hard(hard))) = found else {
        unreachable!("a test finds the witness of {} among the hard cases", deviation.name)
    };
    let mut selected = Selected::whole(place, Random::Some(vec![]));
    selected.hard.push(hard);
    let options = Options { targets: vec![deviation.target], again: false, ..options };
    let mut report = options.report(std::slice::from_ref(subject));
    let subjects = std::slice::from_mut(subject);
    blend_unit::run::run_group(&[&catalogue[place]], &[selected], subjects, &options, &mut report, &mut Silent)?;
    let mut totals = Totals::default();
    report.groups.iter().for_each(|group| totals.add(&group.totals));
    let is_drawn = totals.verdicts > 0;
    Ok(is_drawn.then_some(totals.expected_failures > 0 && totals.failed == 0))
}

/// Whether every probe whose recorded result breaks its promise still gives exactly the recorded result. This is only checked for drivers
/// for which a recorded result is binding; for other drivers the deviation is permitted but not required.
fn special(deviation: &SpecialDeviation, subject: &Subject, code: &Code) -> Result<Option<bool>, DeviceError> {
    if subject.identity.backend != deviation.backend {
        return Ok(None);
    }
    let probes: Vec<&'static Probe> = deviation.probes.iter().filter_map(|name| Probe::by_name(name)).collect();
    let results = special::run::evaluate(subject, code, &probes)?;
    let Some(results) = results.filter(|results| results.record.as_ref().is_some_and(|record| record.binds)) else {
        return Ok(None);
    };
    let breaks = |outcome: &ProbeResult, bits: u32| {
        Probe::by_name(&outcome.probe).is_some_and(|probe| !probe.promise.allows(bits))
    };
    let known = |outcome: &&ProbeResult| outcome.recorded.is_some_and(|recorded| breaks(outcome, recorded));
    let mut known = results.outcomes.iter().filter(known).peekable();
    // Another broken promise than the one on record is not this deviation.
    Ok(Some(known.peek().is_some() && known.all(|outcome| outcome.recorded == Some(outcome.bits))))
}

/// Asks the witness of a deviation on every subject that it concerns, and notes what it shows.
///
/// # Errors
/// Where a device fails.
pub(crate) fn ask(
    deviation: NamedDeviation,
    catalogue: &[Member],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
) -> Result<(), DeviceError> {
    for subject in subjects {
        let Some(still_needed) = deviation.is_still_seen(subject, catalogue, options)? else { continue };
        report.deviations.push(DeviationUse {
            name: deviation.name().into(),
            adapter: subject.identity.name.clone(),
            reason: deviation.reason().into(),
            still_needed,
            excused: 0,
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::select::catalogue;

    #[test]
    fn every_witness_is_there() {
        let catalogue = catalogue();
        for deviation in NamedDeviation::all() {
            match deviation {
                NamedDeviation::Accuracy(_) => {}
                NamedDeviation::Blend(BlendDeviation { name, witness, .. }) => {
                    let case = catalogue.iter().find_map(|member| member.case(witness));
                    assert!(matches!(case, Some(CaseRef::Hard(_))), "{name}: {witness}");
                }
                NamedDeviation::Special(SpecialDeviation { name, probes, .. }) => {
                    let missing: Vec<_> = probes.iter().filter(|probe| Probe::by_name(probe).is_none()).collect();
                    assert!(!probes.is_empty() && missing.is_empty(), "{name}: {missing:?}");
                }
            }
        }
    }

    #[test]
    fn only_the_deviation_that_is_described_is_a_witness_of_itself() {
        use lightmeter_arithmetic::profile::PROFILES;
        for deviation in devices::DEVIATIONS {
            #[expect(clippy::cast_possible_truncation, reason = "the value nearest to the exact one")]
            let exact = exact(deviation.builtin, deviation.witness) as f32;
            let promised = interval(deviation.builtin, deviation.witness, PROFILES[0]);
            let shown = |value: f32| shows(deviation, value.to_bits(), PROFILES[0]);
            assert!(!shown(exact) && !shown(-exact) && !shown(f32::NAN) && !shown(1.01 * exact), "{}", deviation.name);
            // The first value beyond what is promised, on one side or the other: further ones are beyond what is granted.
            let beyond = |next: fn(f32) -> f32| {
                std::iter::successors(Some(exact), |x| Some(next(*x))).find(|x| !promised.contains((*x).into()))
            };
            let shown_beyond = [beyond(f32::next_up), beyond(f32::next_down)];
            assert!(shown_beyond.into_iter().flatten().any(shown), "{}", deviation.name);
        }
    }

    #[test]
    fn names_are_unique() {
        let names: std::collections::BTreeSet<&str> =
            NamedDeviation::all().into_iter().map(NamedDeviation::name).collect();
        assert_eq!(names.len(), NamedDeviation::all().len());
    }
}
