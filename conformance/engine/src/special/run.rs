//! The probes on adapters, and their verdicts.

use crate::device::{Code, DeviceError, Probed};
use crate::subject::Subject;
use lightmeter_catalogue::special::{Class, DEVIATIONS, PROBES, Probe, Promise, Source, deviation_of};
use lightmeter_document::Word;
use lightmeter_document::event::{Event, Observer, Stop};
use lightmeter_document::report::Identity;
use lightmeter_document::special::{
    self, ProbeClass, ProbeResult, ProbeRow, ProbeSource, ProbeVerdict, RecordUse, Skipped, SpecialReport,
};
use lightmeter_judge::special::record::{OnRecord, recorded, whose};
use lightmeter_scene::target::SENTINEL;

/// Why the embedded implementation is skipped.
pub const EMBEDDED: &str = "the embedded implementation has no shading language";

/// The embedded implementation as a stage that is lacking: it has no shading language, and so no stage that a probe is of.
#[must_use]
pub fn skipped_embedded(adapter: &str) -> Skipped {
    Skipped { adapter: adapter.into(), stage: "compute".into(), reason: EMBEDDED.into() }
}

/// The verdict on a result. `recorded` is what is on record where that binds; `deviates` says that the promise is known to
/// be broken.
#[must_use]
pub fn verdict(promise: Promise, bits: u32, recorded: Option<u32>, deviates: bool) -> ProbeVerdict {
    let is_kept = promise.allows(bits);
    match promise {
        _ if !is_kept && (!deviates || bits == SENTINEL) => ProbeVerdict::Broken,
        _ if recorded.is_some_and(|recorded| recorded != bits) => ProbeVerdict::Changed,
        _ if !is_kept => ProbeVerdict::Deviates,
        Promise::Indeterminate => ProbeVerdict::Indeterminate,
        _ => ProbeVerdict::Kept,
    }
}

/// Evaluates every probe on every device, one after the other until somebody stops it. The embedded implementation has no shading
/// language and is left out.
///
/// # Errors
/// Where a shader is invalid, or a device fails.
pub fn run(
    subjects: &[Subject],
    code: &Code,
    stop: &Stop,
    observer: &mut dyn Observer,
) -> Result<SpecialReport, DeviceError> {
    let mut report = nothing_yet();
    let probes: Vec<&'static Probe> = PROBES.iter().collect();
    observer.see(&Event::Begun(subjects.len() as u64));
    for subject in subjects {
        observer.see(&Event::Group(&subject.identity.name));
        // A subject is probed as a whole: who is not begun is what is missing.
        report.interrupted = stop.interrupted("the probes", &subject.identity.name);
        if report.interrupted.is_some() {
            break;
        }
        if let Some(results) = evaluate(subject, code, &probes)? {
            report.adapters.push(subject.identity.clone());
            report.outcomes.extend(results.outcomes);
            report.skipped.extend(results.skipped);
            report.records.extend(results.record);
        }
        observer.see(&Event::Advanced(1));
    }
    let place = |outcome: &ProbeResult| PROBES.iter().position(|probe| outcome.probe == probe.name);
    report.outcomes.sort_by_key(place);
    Ok(report)
}

/// What became of some probes on one subject.
pub struct Results {
    /// The results, stage by stage.
    pub outcomes: Vec<ProbeResult>,
    /// Stages that the subject lacks.
    pub skipped: Vec<Skipped>,
    /// What is on record for its driver.
    pub record: Option<RecordUse>,
}

/// Evaluates some probes on a subject; `None` for the embedded implementation, which has no shading language.
///
/// # Errors
/// Where a shader is invalid, or the device fails.
pub fn evaluate(subject: &Subject, code: &Code, probes: &[&'static Probe]) -> Result<Option<Results>, DeviceError> {
    let Some(device) = subject.device() else { return Ok(None) };
    let Probed { words, skipped } = device.special(code, probes)?;
    let on_record = OnRecord::of(&subject.identity);
    let record = on_record.map(|on_record| {
        let (adapter, of) = (subject.identity.name.clone(), whose(on_record.record()));
        RecordUse { adapter, of, binds: on_record.binds }
    });
    let adapter = &subject.identity.name;
    let skip =
        |(stage, reason)| Skipped { adapter: adapter.clone(), stage: Word::from(stage), reason: Word::from(reason) };
    let results = Results { outcomes: vec![], skipped: skipped.into_iter().map(skip).collect(), record };
    let mut sink = Sink { adapter: &subject.identity, on_record, results };
    for (probe, stage, bits) in words {
        sink.put(probe, stage, bits);
    }
    Ok(Some(sink.results))
}

/// Where the results of one adapter go.
struct Sink<'a> {
    adapter: &'a Identity,
    on_record: Option<OnRecord>,
    results: Results,
}

impl Sink<'_> {
    fn put(&mut self, probe: &'static Probe, stage: &'static str, bits: u32) {
        let recorded = self.on_record.and_then(|of| recorded(of.record(), probe, stage, bits));
        let binding = recorded.filter(|_| self.on_record.is_some_and(|of| of.binds));
        let deviation = deviation_of(probe, &self.adapter.backend);
        self.results.outcomes.push(ProbeResult {
            probe: probe.name.into(),
            adapter: self.adapter.name.clone(),
            stage: stage.into(),
            bits,
            value: probe.gives.word(bits),
            verdict: verdict(probe.promise, bits, binding, deviation.is_some()),
            recorded,
            recorded_value: recorded.map(|bits| probe.gives.word(bits)),
        });
    }
}

/// A report without results. It says what is asked and what is promised.
fn nothing_yet() -> SpecialReport {
    let class = |class: Class| ProbeClass { name: class.name().into(), title: class.title().into() };
    let source = |source: Source| ProbeSource { section: source.section().into(), says: source.says().into() };
    SpecialReport {
        schema: special::SCHEMA.into(),
        command: None,
        version: Some(env!("CARGO_PKG_VERSION").into()),
        made_at: None,
        adapters: vec![],
        records: vec![],
        probes: PROBES.iter().map(row).collect(),
        classes: Class::ALL.map(class).to_vec(),
        sources: Source::ALL.map(source).to_vec(),
        deviations: DEVIATIONS.to_vec(),
        skipped: vec![],
        outcomes: vec![],
        interrupted: None,
    }
}

fn row(probe: &Probe) -> ProbeRow {
    ProbeRow {
        name: probe.name.into(),
        class: probe.class.name().into(),
        what: probe.what.into(),
        inputs: probe.inputs.iter().map(|bits| format!("0x{bits:08x}")).collect(),
        promise: probe.promise.words(probe.gives),
        definite: probe.promise.is_definite(),
        source: probe.source.section().into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAN: u32 = 0x7fc0_0000;

    #[test]
    fn a_broken_promise_is_worse_than_a_changed_record() {
        let rows = [
            (Promise::Exactly(1), 1, None, false, ProbeVerdict::Kept),
            (Promise::Exactly(1), NAN, None, false, ProbeVerdict::Broken),
            (Promise::Exactly(1), NAN, Some(NAN), false, ProbeVerdict::Broken),
            (Promise::Exactly(1), NAN, Some(NAN), true, ProbeVerdict::Deviates),
            (Promise::Exactly(1), NAN, None, true, ProbeVerdict::Deviates),
            (Promise::Exactly(1), 1, Some(NAN), true, ProbeVerdict::Changed),
            (Promise::Exactly(1), SENTINEL, None, true, ProbeVerdict::Broken),
            (Promise::OneOf(&[1, 2]), 2, Some(1), false, ProbeVerdict::Changed),
            (Promise::OneOf(&[1, 2]), 2, None, false, ProbeVerdict::Kept),
            (Promise::Indeterminate, NAN, Some(NAN), false, ProbeVerdict::Indeterminate),
            (Promise::Indeterminate, NAN, Some(NAN + 1), false, ProbeVerdict::Changed),
            (Promise::Indeterminate, NAN, None, false, ProbeVerdict::Indeterminate),
            (Promise::Indeterminate, SENTINEL, None, false, ProbeVerdict::Broken),
        ];
        for (promise, bits, recorded, deviates, expected) in rows {
            assert_eq!(verdict(promise, bits, recorded, deviates), expected, "{promise:?} {bits:x} {recorded:?}");
        }
    }
}
