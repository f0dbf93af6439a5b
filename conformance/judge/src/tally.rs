//! Verdicts on a chunk of a group's cases, and what they come to.

use crate::chunk::{Chunk, TASK};
use crate::devices::Known;
use crate::{Outcome, is_worse, judge, simplicity, worse};
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_catalogue::cases::{Kind, Stage};
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::Number;
use lightmeter_document::run::{Failure, Totals};
use rayon::prelude::*;

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

/// Failures that are kept for each group.
pub const KEPT_FAILURES: usize = 5;

/// What a group has come to on one subject in one stage.
#[derive(Default)]
pub struct Tally {
    /// The counts.
    pub totals: Totals,
    /// Verdicts of random cases, and the indeterminate ones among them.
    pub random: (u64, u64),
    /// The greatest error, in ULP.
    pub error_ulp_max: f64,
    /// The greatest margin, and the id of its case.
    pub worst: Option<(f64, String)>,
    /// The first failures.
    pub failures: Vec<Failure>,
    /// The failure of the simplest inputs, and how simple they are.
    pub simplest: Option<(u32, Failure)>,
    /// Verdicts that each named deviation excused.
    pub excused: Vec<(&'static str, u64)>,
    /// Time spent on the group.
    pub seconds: f64,
}

impl Tally {
    /// The sum of two.
    pub fn merge(&mut self, other: Self) {
        self.totals.add(&other.totals);
        self.random.0 += other.random.0;
        self.random.1 += other.random.1;
        self.error_ulp_max = worse(self.error_ulp_max, other.error_ulp_max);
        if other
            .worst
            .as_ref()
            .is_some_and(|(margin, _)| self.worst.as_ref().is_none_or(|(most, _)| is_worse(*margin, *most)))
        {
            self.worst = other.worst;
        }
        self.failures.extend(other.failures);
        self.failures.truncate(KEPT_FAILURES);
        keep_simplest(&mut self.simplest, other.simplest);
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

/// Keeps the failure of the simpler inputs, of equally simple ones the first.
pub fn keep_simplest(simplest: &mut Option<(u32, Failure)>, other: Option<(u32, Failure)>) {
    if let Some((simple, _)) = &other
        && simplest.as_ref().is_none_or(|(least, _)| simple < least)
    {
        *simplest = other;
    }
}

/// The failures that are reported of a group: the one of the simplest inputs, which explains most, then the first.
pub fn reported(simplest: Option<(u32, Failure)>, first: Vec<Failure>) -> impl Iterator<Item = Failure> {
    let simplest = simplest.map(|(_, failure)| failure);
    let is_other = {
        let key = simplest.as_ref().map(|one| (one.id.clone(), one.output.clone()));
        move |one: &Failure| key.as_ref().is_none_or(|(id, output)| (id, output) != (&one.id, &one.output))
    };
    simplest.into_iter().chain(first.into_iter().filter(is_other)).take(KEPT_FAILURES)
}

/// Judges the words that a stage gave for a chunk, on all cores.
#[must_use]
pub fn judge_chunk(chunk: &Chunk<'_>, words: &[u32], stage: Stage, by: &Judging<'_>) -> Tally {
    let tallies: Vec<Tally> = (0..chunk.cases.len().div_ceil(TASK))
        .into_par_iter()
        .map(|task| {
            let cases = task * TASK..chunk.cases.len().min((task + 1) * TASK);
            let mut tally = Tally::default();
            for case in cases {
                judge_case(chunk, words, case, stage, by, &mut tally);
            }
            tally
        })
        .collect();
    let mut sum = Tally::default();
    for tally in tallies {
        sum.merge(tally);
    }
    sum
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

fn judge_case(chunk: &Chunk<'_>, words: &[u32], case: usize, stage: Stage, by: &Judging<'_>, tally: &mut Tally) {
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
                if let Some(name) = excuse(chunk, case, output, bits, stage, by) {
                    tally.totals.expected_failures += 1;
                    tally.excuse(name, 1);
                } else {
                    tally.totals.failed += 1;
                    let inputs = chunk.inputs_of(case);
                    let simple = simplicity(inputs);
                    let is_simplest = tally.simplest.as_ref().is_none_or(|(least, _)| simple < *least);
                    if is_simplest || tally.failures.len() < KEPT_FAILURES {
                        let id = member.case_id(chunk.cases[case]);
                        let seen = Seen { bits, reference, interval: legal[output], error_ulp: verdict.error };
                        let failure = failure(member, id, inputs, output, stage, by, &seen);
                        if tally.failures.len() < KEPT_FAILURES {
                            tally.failures.push(failure.clone());
                        }
                        keep_simplest(&mut tally.simplest, Some((simple, failure)));
                    }
                }
            }
        }
        tally.error_ulp_max = worse(tally.error_ulp_max, verdict.error);
        if tally.worst.as_ref().is_none_or(|(most, _)| is_worse(verdict.margin, *most)) {
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

/// The share of indeterminate verdicts, hard cases apart, above which a group fails.
const MOST_INDETERMINATE: f64 = 0.01;

/// The group verdict on indeterminate values: more than 1 % of them, hard cases apart, make a run of little.
pub fn problem(random: (u64, u64), verdicts: u64, indeterminate: u64) -> Option<String> {
    #[expect(clippy::cast_precision_loss, reason = "a share")]
    let share = random.1 as f64 / random.0.max(1) as f64;
    if share > MOST_INDETERMINATE {
        return Some(format!(
            "{:.1} % of the verdicts are indeterminate, hard cases apart; at most 1 % may be",
            100.0 * share
        ));
    }
    (random.0 > 0 && indeterminate == verdicts).then(|| "nothing but indeterminate verdicts".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chunk::{draw, refer};
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

    fn judged(chunk: &Chunk<'_>, words: &[u32]) -> Tally {
        let known = Known::default();
        let by = Judging { adapter: "cpu", known: &known, profile: &WGSL, rerun: "" };
        judge_chunk(chunk, words, Stage::Compute, &by)
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
                    assert!(margin == f64::INFINITY && worst == name, "{what}: {margin} in {worst}");
                    assert!(tally.error_ulp_max == f64::INFINITY, "{what}");
                    let failure = &tally.failures[0];
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
        with_chunk("vector/reflect", |chunk, right, _| {
            let simple = |case: usize| simplicity(chunk.inputs_of(case));
            let simplest = (0..CASES).min_by_key(|&case| simple(case)).expect("there are cases");
            assert!(simplest >= KEPT_FAILURES, "a case beyond the first failures is to be found");
            let tally = judged(chunk, &vec![NANS[0]; right.len()]);
            let reported: Vec<Failure> = reported(tally.simplest, tally.failures).collect();
            assert_eq!(reported[0].id, format!("vector/reflect/random/{simplest:06}"));
            assert_eq!((reported.len(), reported[1].id.as_str()), (KEPT_FAILURES, "vector/reflect/random/000000"));
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
