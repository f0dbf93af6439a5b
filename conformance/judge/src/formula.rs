//! Verdicts on the rows of a formula: on a chunk of a group's cases, in a stage of a subject.

use crate::chunk::{Chunk, TASK};
use crate::devices::Known;
use crate::sample::Sample;
use crate::tally::Tally;
use crate::{Outcome, judge, telling};
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_catalogue::cases::{Kind, Stage};
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::run::Failure;
use lightmeter_document::{Number, Word};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Whose answers are judged, and by what.
#[derive(Clone, Copy)]
pub struct Judging<'a> {
    /// The adapter's short name.
    pub adapter: &'a str,
    /// What is known of it.
    pub known: &'a Known,
    /// The accuracy rules.
    pub profile: &'static Profile,
    /// What to add to a command that runs one case again.
    pub rerun: &'a str,
}

/// An output of a case of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct RowPlace {
    /// The formula's place among the group's.
    pub member: usize,
    /// The case.
    pub case: CaseRef,
    /// The number of the output.
    pub output: usize,
}

/// Verdicts on a group's rows in a stage of a subject.
pub type RowTally = Tally<RowPlace, Failure>;
/// Rows of a group, by the formula's place among the group's and the case.
pub type RowSample = Sample<(usize, CaseRef)>;

/// Failing rows that are kept for the diagnosis.
pub const KEPT_FAILING: usize = 2048;
/// Values of rows without a failure that are kept for it, and for the verdict on all of them together.
pub const KEPT_PASSING: usize = 8192;

/// What a group's rows have come to in a stage of a subject.
#[derive(Clone, Debug)]
pub struct RowStanding {
    /// The verdicts.
    pub tally: RowTally,
    /// How many rows of each formula fail.
    pub failing: BTreeMap<usize, u64>,
    /// Some of them.
    pub wrong: RowSample,
    /// Some of the others. A row that a named deviation excuses is in neither.
    pub right: RowSample,
}

impl RowStanding {
    /// The standing before anything is judged, of formulas with this number of outputs.
    #[must_use]
    pub fn new(outputs: usize) -> Self {
        let outputs = outputs.max(1);
        Self {
            tally: RowTally::default(),
            failing: BTreeMap::new(),
            wrong: Sample::new(outputs, KEPT_FAILING),
            right: Sample::new(outputs, KEPT_PASSING / outputs),
        }
    }

    fn part(&self) -> Self {
        let tally = RowTally::default();
        Self { tally, failing: BTreeMap::new(), wrong: self.wrong.part(), right: self.right.part() }
    }

    /// Judges the words that a stage gave for a chunk, on all cores, and adds the verdicts.
    pub fn judge(&mut self, chunk: &Chunk<'_>, words: &[u32], stage: Stage, by: &Judging<'_>) {
        let parts: Vec<Self> = (0..chunk.cases.len().div_ceil(TASK))
            .into_par_iter()
            .map(|task| {
                let mut part = self.part();
                for case in task * TASK..chunk.cases.len().min((task + 1) * TASK) {
                    judge_case(chunk, words, case, stage, by, &mut part);
                }
                part
            })
            .collect();
        for part in parts {
            self.tally.add(part.tally);
            for (member, count) in part.failing {
                *self.failing.entry(member).or_default() += count;
            }
            self.wrong.add(&part.wrong);
            self.right.add(&part.right);
        }
    }
}

/// The intervals of one case as a profile makes them for a stage of a subject.
pub fn intervals(member: &Member, inputs: &[f32], stage: Stage, known: &Known, profile: &Profile, out: &mut [Accept]) {
    match member.spec.kind {
        Kind::Raster(kind) if stage == Stage::Raster => {
            member.formula.raster_interval(kind, inputs, &known.profile(profile), out);
        }
        _ => member.formula.interval(inputs, profile, out),
    }
}

fn judge_case(
    chunk: &Chunk<'_>,
    words: &[u32],
    case: usize,
    stage: Stage,
    by: &Judging<'_>,
    standing: &mut RowStanding,
) {
    let (member, outputs) = (chunk.members[chunk.of[case]], chunk.members[0].spec.output_len());
    let range = case * outputs..(case + 1) * outputs;
    let mut own = [Accept::ANY; 16];
    let shared = matches!(stage, Stage::Compute | Stage::Fragment);
    let legal = if shared {
        &chunk.intervals[range.clone()]
    } else {
        intervals(member, chunk.inputs_of(case), stage, by.known, by.profile, &mut own[..outputs]);
        &own[..outputs]
    };
    let is_random = matches!(chunk.cases[case], CaseRef::Random(_));
    let tally = &mut standing.tally;
    let (failed, pardoned) = (tally.totals.failed, tally.totals.expected_failures);
    tally.totals.cases += 1;
    for (output, at) in range.clone().enumerate() {
        let (bits, reference) = (words[at], chunk.references[at]);
        let verdict = judge(bits, reference, &legal[output]);
        let excused = match verdict.outcome {
            Outcome::Fail => excuse(chunk, case, output, bits, stage, by),
            _ => None,
        };
        tally.count(verdict.outcome, excused, is_random);
        if verdict.outcome == Outcome::Indeterminate {
            continue;
        }
        let place = RowPlace { member: chunk.of[case], case: chunk.cases[case], output };
        if verdict.outcome == Outcome::Fail && excused.is_none() {
            let inputs = chunk.inputs_of(case);
            tally.fail(place, telling(inputs, is_random), || {
                let seen = Seen { bits, reference, interval: legal[output], error_ulp: verdict.error };
                failure(member, member.case_id(chunk.cases[case]), inputs, output, stage, by, &seen)
            });
        }
        tally.see_error(verdict.error);
        tally.see_margin(verdict.margin, place);
    }
    let values = words[range].iter().map(|&bits| f32::from_bits(bits));
    if standing.tally.totals.failed > failed {
        *standing.failing.entry(chunk.of[case]).or_default() += 1;
        standing.wrong.push((chunk.of[case], chunk.cases[case]), values);
    } else if standing.tally.totals.expected_failures == pardoned {
        standing.right.push((chunk.of[case], chunk.cases[case]), values);
    }
}

/// The named deviation that makes a value legal, if one does.
fn excuse(
    chunk: &Chunk<'_>,
    case: usize,
    output: usize,
    bits: u32,
    stage: Stage,
    by: &Judging<'_>,
) -> Option<&'static str> {
    let member = chunk.members[chunk.of[case]];
    by.known.deviations.iter().find_map(|deviation| {
        let mut legal = vec![Accept::ANY; member.spec.output_len()];
        let granted = deviation.grant(*by.profile);
        intervals(member, chunk.inputs_of(case), stage, by.known, &granted, &mut legal);
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

fn failure(
    member: &Member,
    id: String,
    inputs: &[f32],
    output: usize,
    stage: Stage,
    by: &Judging<'_>,
    seen: &Seen,
) -> Failure {
    Failure {
        rerun: format!("lightmeter run '{id}' --adapter {}{}", by.adapter, by.rerun),
        id,
        adapter: by.adapter.to_owned(),
        stage: stage.name().into(),
        target: None,
        route: None,
        output: member.spec.output_name(output),
        inputs: by_name(member, inputs, |x| serde_json::to_value(Number(x.into())).unwrap_or_default()),
        units: units(member),
        inputs_hex: by_name(member, inputs, |x| format!("0x{:08x}", x.to_bits()).into()),
        reference: Number(seen.reference),
        interval: [Number(seen.interval.low()), Number(seen.interval.high())],
        promise: None,
        value: Number(f32::from_bits(seen.bits).into()),
        value_hex: format!("0x{:08x}", seen.bits),
        unwritten: seen.bits == lightmeter_scene::target::SENTINEL,
        error_ulp: Number(seen.error_ulp),
    }
}

/// The unit of each input that has one.
#[must_use]
pub fn units(member: &Member) -> BTreeMap<String, Word> {
    let with_unit = member.spec.inputs.iter().filter(|input| !matches!(input.unit, "" | "1"));
    with_unit.map(|input| (input.name.to_owned(), input.unit.into())).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chunk::{draw, refer};
    use crate::simplicity;
    use crate::tally::{KEPT, KEPT_FAILURES};
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::select::catalogue;

    /// Quiet, negative, signalling, every bit set, and with a payload.
    const NANS: [u32; 5] = [0x7fc0_0000, 0xffc0_0000, 0x7fa0_0001, 0xffff_ffff, 0x7fc1_2345];
    /// More than two tasks of the pool.
    const CASES: usize = 2 * TASK + 77;

    /// A chunk of random cases and the right words for them, handed on with the number of outputs of a case.
    fn with_chunk(id: &str, test: impl Fn(&mut Chunk<'_>, &[u32], usize)) {
        let catalogue = catalogue();
        let members: Vec<&Member> = catalogue.iter().filter(|member| member.spec.id == id).collect();
        assert_eq!(members.len(), 1, "{id}");
        let cases: Vec<(usize, CaseRef)> = (0..CASES as u64).map(|k| (0, CaseRef::Random(k))).collect();
        let mut chunk = draw(&members, &cases, 1);
        refer(&mut chunk, &WGSL);
        #[expect(clippy::cast_possible_truncation, reason = "the nearest float")]
        let words: Vec<u32> = chunk.references.iter().map(|reference| (*reference as f32).to_bits()).collect();
        test(&mut chunk, &words, members[0].spec.output_len());
    }

    fn judged(chunk: &Chunk<'_>, words: &[u32]) -> RowTally {
        standing(chunk, words).tally
    }

    fn standing(chunk: &Chunk<'_>, words: &[u32]) -> RowStanding {
        let known = Known::default();
        let by = Judging { adapter: "cpu", known: &known, profile: &WGSL, rerun: "" };
        let mut standing = RowStanding::new(chunk.members[0].spec.output_len());
        standing.judge(chunk, words, Stage::Compute, &by);
        standing
    }

    /// The first, a middle and the last of so many.
    fn places(of: usize) -> [usize; 3] {
        [0, of / 2, of - 1]
    }

    #[test]
    fn a_nan_fails_wherever_it_stands() {
        for id in ["vector/reflect", "fog/linear"] {
            with_chunk(id, |chunk, right, outputs| {
                let clean = judged(chunk, right);
                assert_eq!(clean.totals.failed, 0, "{id}");
                for (case, output, nan) in everywhere(outputs) {
                    let mut words = right.to_vec();
                    words[case * outputs + output] = nan;
                    let tally = judged(chunk, &words);
                    let what = format!("{id}, case {case}, output {output}, 0x{nan:08x}");
                    assert_eq!((tally.totals.failed, tally.totals.passed), (1, clean.totals.passed - 1), "{what}");
                    assert_eq!(tally.totals.indeterminate, clean.totals.indeterminate, "{what}");
                    let name = format!("{id}/random/{case:06}");
                    let (margin, worst) = tally.worst.expect("something was judged");
                    let worst = chunk.members[worst.member].case_id(worst.case);
                    assert!(margin == f64::INFINITY && worst == name, "{what}: {margin} in {worst}");
                    assert!(tally.error_max == f64::INFINITY, "{what}");
                    let (_, failure) = tally.failures.first_key_value().expect("it is kept");
                    assert!(failure.id == name && failure.value.0.is_nan(), "{what}: {failure:?}");
                    assert_eq!(failure.value_hex, format!("0x{nan:08x}"), "{what}");
                    assert_eq!(failure.output, chunk.members[0].spec.output_name(output), "{what}");
                }
            });
        }
    }

    #[test]
    fn a_nan_is_indeterminate_where_anything_is_legal_and_never_a_pass() {
        with_chunk("vector/reflect", |chunk, right, outputs| {
            let clean = judged(chunk, right);
            for (case, output, nan) in everywhere(outputs) {
                let at = case * outputs + output;
                let (mut words, legal) = (right.to_vec(), chunk.intervals[at]);
                words[at] = nan;
                chunk.intervals[at] = Accept::ANY;
                let tally = judged(chunk, &words);
                chunk.intervals[at] = legal;
                let counts = (tally.totals.passed, tally.totals.failed, tally.totals.indeterminate);
                let expected = (clean.totals.passed - 1, 0, clean.totals.indeterminate + 1);
                assert_eq!(counts, expected, "case {case}, output {output}, 0x{nan:08x}");
            }
        });
    }

    #[test]
    fn the_failure_of_the_simplest_inputs_is_reported_first_and_once() {
        with_chunk("vector/reflect", |chunk, right, outputs| {
            let simplest = |from: usize| (from..CASES).min_by_key(|&case| simplicity(chunk.inputs_of(case)));
            let lies_beyond = |from: &usize| simplest(*from).is_some_and(|case| case >= from + KEPT);
            let from = (0..CASES).find(lies_beyond).expect("a simplest case beyond those that are kept");
            let mut words = right.to_vec();
            words[from * outputs..].fill(NANS[0]);
            let reported: Vec<Failure> = judged(chunk, &words).reported().collect();
            let id = |case: usize| format!("vector/reflect/random/{case:06}");
            assert_eq!(Some(reported[0].id.clone()), simplest(from).map(id));
            assert_eq!((reported.len(), reported[1].id.clone()), (KEPT_FAILURES, id(from)));
        });
    }

    #[test]
    fn nothing_but_nan_passes_nothing() {
        with_chunk("vector/reflect", |chunk, right, _| {
            for nan in NANS {
                let tally = judged(chunk, &vec![nan; right.len()]);
                assert_eq!(tally.totals.passed, 0);
                assert_eq!(tally.totals.failed + tally.totals.indeterminate, right.len() as u64);
            }
        });
    }

    fn everywhere(outputs: usize) -> impl Iterator<Item = (usize, usize, u32)> {
        let places = places(CASES).into_iter().flat_map(move |case| self::places(outputs).map(|output| (case, output)));
        places.flat_map(|(case, output)| NANS.map(|nan| (case, output, nan)))
    }
}
