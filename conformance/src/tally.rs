//! Verdicts on a chunk of a group's cases, and what they come to.

use crate::arithmetic::{Accept, Profile};
use crate::cases::{Kind, Stage};
use crate::judge::{Outcome, judge};
use crate::report::{Failure, Number, Totals};
use crate::run::{Chunk, Options, TASK};
use crate::select::{CaseRef, Member};
use crate::subject::Subject;
use rayon::prelude::*;

/// Failures that are kept for each group.
pub(crate) const KEPT_FAILURES: usize = 5;

/// What a group has come to on one subject in one stage.
#[derive(Default)]
pub(crate) struct Tally {
    pub(crate) totals: Totals,
    /// Verdicts of random cases, and the indeterminate ones among them.
    pub(crate) random: (u64, u64),
    pub(crate) error_ulp_max: f64,
    pub(crate) worst: Option<(f64, String)>,
    pub(crate) failures: Vec<Failure>,
    pub(crate) excused: Vec<(&'static str, u64)>,
    pub(crate) seconds: f64,
}

impl Tally {
    pub(crate) fn merge(&mut self, other: Self) {
        self.totals.add(&other.totals);
        self.random.0 += other.random.0;
        self.random.1 += other.random.1;
        self.error_ulp_max = self.error_ulp_max.max(other.error_ulp_max);
        if other.worst.as_ref().is_some_and(|(margin, _)| self.worst.as_ref().is_none_or(|(most, _)| margin > most)) {
            self.worst = other.worst;
        }
        self.failures.extend(other.failures);
        self.failures.truncate(KEPT_FAILURES);
        for (name, count) in other.excused {
            self.excuse(name, count);
        }
        self.seconds += other.seconds;
    }

    fn excuse(&mut self, name: &'static str, count: u64) {
        match self.excused.iter_mut().find(|(known, _)| *known == name) {
            Some((_, excused)) => *excused += count,
            None => self.excused.push((name, count)),
        }
    }
}

pub(crate) fn judge_chunk(
    chunk: &Chunk<'_>,
    words: &[u32],
    stage: Stage,
    subject: &Subject,
    options: &Options,
) -> Tally {
    let tallies: Vec<Tally> = (0..chunk.cases.len().div_ceil(TASK))
        .into_par_iter()
        .map(|task| {
            options.profile.scope(|| {
                let cases = task * TASK..chunk.cases.len().min((task + 1) * TASK);
                let mut tally = Tally::default();
                for case in cases {
                    judge_case(chunk, words, case, stage, subject, options, &mut tally);
                }
                tally
            })
        })
        .collect();
    let mut sum = Tally::default();
    for tally in tallies {
        sum.merge(tally);
    }
    sum
}

/// The intervals of one case as they hold for a stage of a subject, by the profile given, which is the one in force.
pub fn intervals(
    member: &Member,
    inputs: &[f32],
    stage: Stage,
    subject: &Subject,
    profile: &Profile,
    out: &mut [Accept],
) {
    match member.spec.kind {
        Kind::Raster(kind) if stage == Stage::Raster => {
            let subpixel_bits = subject.known.subpixel_bits.unwrap_or(profile.subpixel_bits);
            member.formula.raster_interval(kind, inputs, subpixel_bits, out);
        }
        _ => member.formula.interval(inputs, out),
    }
}

fn judge_case(
    chunk: &Chunk<'_>,
    words: &[u32],
    case: usize,
    stage: Stage,
    subject: &Subject,
    options: &Options,
    tally: &mut Tally,
) {
    let (member, outputs) = (chunk.members[chunk.of[case]], chunk.members[0].spec.output_len());
    let range = case * outputs..(case + 1) * outputs;
    let mut own = [Accept::ANY; 16];
    let shared = matches!(stage, Stage::Compute | Stage::Fragment);
    let legal = if shared {
        &chunk.intervals[range.clone()]
    } else {
        intervals(member, chunk.inputs_of(case), stage, subject, options.profile, &mut own[..outputs]);
        &own[..outputs]
    };
    let is_random = matches!(chunk.cases[case], CaseRef::Random(_));
    tally.totals.cases += 1;
    tally.totals.verdicts += outputs as u64;
    if is_random {
        tally.random.0 += outputs as u64;
    }
    for (output, at) in range.enumerate() {
        let (bits, reference) = (words[at], chunk.references[at]);
        let verdict = judge(bits, reference, &legal[output]);
        match verdict.outcome {
            Outcome::Indeterminate => {
                tally.totals.indeterminate += 1;
                tally.random.1 += u64::from(is_random);
                continue;
            }
            Outcome::Pass => tally.totals.passed += 1,
            Outcome::Fail => {
                if let Some(name) = excuse(chunk, case, output, bits, stage, subject, options) {
                    tally.totals.expected_failures += 1;
                    tally.excuse(name, 1);
                } else {
                    tally.totals.failed += 1;
                    if tally.failures.len() < KEPT_FAILURES {
                        let inputs = chunk.inputs_of(case);
                        let id = member.case_id(chunk.cases[case]);
                        let seen = Seen { bits, reference, interval: legal[output], error_ulp: verdict.error_ulp };
                        tally.failures.push(failure(member, id, inputs, output, stage, subject, options, &seen));
                    }
                }
            }
        }
        tally.error_ulp_max = tally.error_ulp_max.max(verdict.error_ulp);
        if tally.worst.as_ref().is_none_or(|(most, _)| verdict.margin > *most) {
            tally.worst = Some((verdict.margin, member.case_id(chunk.cases[case])));
        }
    }
}

/// The named deviation that makes a value legal, if one does.
fn excuse(
    chunk: &Chunk<'_>,
    case: usize,
    output: usize,
    bits: u32,
    stage: Stage,
    subject: &Subject,
    options: &Options,
) -> Option<&'static str> {
    let member = chunk.members[chunk.of[case]];
    subject.known.deviations.iter().find_map(|deviation| {
        let mut legal = vec![Accept::ANY; member.spec.output_len()];
        deviation
            .grant(*options.profile)
            .scope(|| intervals(member, chunk.inputs_of(case), stage, subject, options.profile, &mut legal));
        let reference = chunk.references[case * legal.len() + output];
        (judge(bits, reference, &legal[output]).outcome == Outcome::Pass).then_some(deviation.name)
    })
}

struct Seen {
    bits: u32,
    reference: f64,
    interval: Accept,
    error_ulp: f64,
}

#[expect(clippy::too_many_arguments, reason = "a failure tells everything about its verdict")]
fn failure(
    member: &Member,
    id: String,
    inputs: &[f32],
    output: usize,
    stage: Stage,
    subject: &Subject,
    options: &Options,
    seen: &Seen,
) -> Failure {
    Failure {
        rerun: format!("lightmeter run '{id}' --adapter {}{}", subject.identity.name, options.rerun),
        id,
        adapter: subject.identity.name.clone(),
        stage: stage.name(),
        target: None,
        route: None,
        output: member.spec.output_name(output),
        inputs: by_name(member, inputs, |x| serde_json::to_value(Number(x.into())).unwrap_or_default()),
        inputs_hex: by_name(member, inputs, |x| format!("0x{:08x}", x.to_bits()).into()),
        reference: Number(seen.reference),
        interval: [Number(seen.interval.low()), Number(seen.interval.high())],
        value: Number(f32::from_bits(seen.bits).into()),
        value_hex: format!("0x{:08x}", seen.bits),
        unwritten: seen.bits == lightmeter_gpu::SENTINEL,
        error_ulp: Number(seen.error_ulp),
    }
}

/// A row of inputs as an object: a number for a scalar, an array for the rest.
#[must_use]
pub fn by_name(
    member: &Member,
    inputs: &[f32],
    value: impl Fn(f32) -> serde_json::Value,
) -> serde_json::Map<String, serde_json::Value> {
    let mut rest = inputs;
    let named = member.spec.inputs.iter().map(|input| {
        let (these, others) = rest.split_at(input.shape.components());
        rest = others;
        let value = match these {
            [x] => value(*x),
            many => many.iter().map(|&x| value(x)).collect(),
        };
        (input.name.to_owned(), value)
    });
    named.collect()
}
