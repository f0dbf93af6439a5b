//! Verdicts on the rows of a formula: on a chunk of a group's cases, in a stage of a subject.

use crate::cases::{Answers, CaseTally, ExpectedFailure, Unanswered};
use crate::chunk::{Chunk, TASK};
use crate::devices::{Known, grant};
use crate::diagnose::Made;
use crate::kept::KeptRow;
use crate::sample::{Sample, row_number};
use crate::tally::{KEPT, Tally};
use crate::{Outcome, judge, telling, worse};
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_catalogue::cases::{Kind, Stage};
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::adapters::Deviation;
use lightmeter_document::by_case::FailedAnswer;
use lightmeter_document::report::{Failure, WorstAnswer};
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
    /// What random cases are drawn from.
    pub seed: u64,
    /// Failures that are expected.
    pub expected: &'a [ExpectedFailure],
    /// Whether all is counted by cases too.
    pub counts_cases: bool,
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

/// Verdicts on a group's rows in a stage of a subject. Of a row that fails all is kept.
pub type RowTally = Tally<RowPlace, KeptRow>;
/// Rows of a group, by the formula's place among the group's and the case.
pub type RowSample = Sample<(usize, CaseRef), KeptRow>;

/// Failing rows that are kept for the diagnosis.
pub const KEPT_FAILING: usize = 2048;
/// Values of rows without a failure that are kept for it, and for the verdict on all of them together.
const KEPT_PASSING: usize = 8192;

/// Rows without a failure that are kept, of formulas with this number of outputs.
#[must_use]
pub fn most_passing(outputs: usize) -> usize {
    KEPT_PASSING / outputs.max(1)
}

/// What a group's rows have come to in a stage of a subject.
#[derive(Clone, Debug)]
pub struct RowStanding {
    /// The verdicts.
    pub tally: RowTally,
    /// The row that has the greatest margin.
    worst: Option<KeptRow>,
    /// How many rows of each formula fail.
    pub failing: BTreeMap<usize, u64>,
    /// Some of them.
    pub wrong: RowSample,
    /// Some of the others. A row that a named deviation excuses is in neither.
    pub right: RowSample,
    /// The rows counted as cases, where that is asked for, and those without a value.
    pub cases: CaseTally,
    /// While a chunk is judged: those of its rows that may be kept, by their numbers in it, the wrong ones and the others. What is kept of a
    /// row is copied once the chunk has been judged and it is known which stay.
    chosen: [Sample<RowId, usize>; 2],
}

/// A formula of a group and a case of it.
type RowId = (usize, CaseRef);

impl RowStanding {
    /// The standing before anything is judged, of formulas with this number of outputs.
    #[must_use]
    pub fn new(outputs: usize) -> Self {
        Self {
            tally: RowTally::default(),
            worst: None,
            failing: BTreeMap::new(),
            wrong: Sample::new(KEPT_FAILING),
            right: Sample::new(most_passing(outputs)),
            cases: CaseTally::default(),
            chosen: [Sample::new(0), Sample::new(0)],
        }
    }

    fn part(&self) -> Self {
        Self {
            tally: RowTally::default(),
            worst: None,
            failing: BTreeMap::new(),
            wrong: self.wrong.part(),
            right: self.right.part(),
            cases: CaseTally::default(),
            chosen: self.chosen(),
        }
    }

    /// No rows yet of a chunk.
    const fn chosen(&self) -> [Sample<RowId, usize>; 2] {
        [self.wrong.part(), self.right.part()]
    }

    /// Judges what a stage gave for a chunk, on all cores, and adds the verdicts.
    pub fn judge(&mut self, chunk: &Chunk<'_>, answers: &Answers, stage: Stage, by: &Judging<'_>) {
        let parts: Vec<Self> = (0..chunk.cases.len().div_ceil(TASK))
            .into_par_iter()
            .map(|task| {
                let mut part = self.part();
                for case in task * TASK..chunk.cases.len().min((task + 1) * TASK) {
                    part.judge_case(chunk, answers, case, stage, by);
                }
                part
            })
            .collect();
        let [mut wrong, mut right] = self.chosen();
        for part in parts {
            let worst = part.tally.worst;
            self.tally.add(part.tally);
            if worst.is_some_and(|(_, place)| self.tally.worst.is_some_and(|(_, own)| own == place)) {
                self.worst = part.worst;
            }
            for (member, count) in part.failing {
                *self.failing.entry(member).or_default() += count;
            }
            let [more_wrong, more_right] = part.chosen;
            wrong.add(more_wrong);
            right.add(more_right);
            self.cases.add(part.cases);
        }
        let kept = |_, case| kept(chunk, &answers.words, case, stage, by);
        self.wrong.add(wrong.with(kept));
        self.right.add(right.with(kept));
    }

    /// Judges a case of a chunk, or counts it as one without a value.
    fn judge_case(&mut self, chunk: &Chunk<'_>, answers: &Answers, case: usize, stage: Stage, by: &Judging<'_>) {
        let place = (chunk.of[case], chunk.cases[case]);
        let id = || chunk.members[place.0].case_id(place.1);
        if let Some(why) = answers.unanswered.get(&case) {
            self.tally.totals.cases += 1;
            let totals = &mut self.tally.totals;
            totals.skipped += u64::from(matches!(why, Unanswered::Skipped(_) | Unanswered::Undeclared(_)));
            if self.cases.unanswered(place, why) && !by.expected.is_empty() {
                self.cases.expect(by.expected, &id(), &[stage.name()], true, |_| false);
            }
            return;
        }
        let failed = self.tally.totals.failed;
        let (error, errors) = judge_values(chunk, &answers.words, case, stage, by, self);
        let failed = self.tally.totals.failed - failed;
        if by.counts_cases {
            self.cases.judged(place, chunk.inputs_of(case), failed > 0, error, errors);
        }
        if by.expected.is_empty() {
            return;
        }
        let explains = |made: &dyn Made| {
            let row = kept(chunk, &answers.words, case, stage, by);
            made.explains(chunk.members[place.0], &row.answers(place.1, true), by.profile)
        };
        if self.cases.expect(by.expected, &id(), &[stage.name()], failed > 0, explains) {
            self.tally.totals.failed -= failed;
            self.tally.totals.expected_failures += failed;
        }
    }

    /// What was answered to the case of the greatest margin.
    #[must_use]
    pub fn worst_answer(&self, members: &[&Member]) -> Option<WorstAnswer> {
        let ((_, place), row) = (self.tally.worst?, self.worst.as_ref()?);
        let (member, k) = (members[place.member], place.output);
        Some(WorstAnswer {
            inputs: numbers(&row.inputs),
            output: member.spec.output_name(k),
            value: Number(row.values[k].into()),
            reference: Number(row.reference[k]),
            interval: bounds(&row.legal[k]),
        })
    }

    /// The failures that are reported, one of each case: the case of the simplest inputs first.
    #[must_use]
    pub fn failures(&self, members: &[&Member], stage: Stage, by: &Judging<'_>) -> Vec<Failure> {
        let told =
            |(place, row): (RowPlace, KeptRow)| (place, failure(members[place.member], place, &row, stage, by.adapter));
        let mut failing = self.tally.clone().reported(RowPlace::eq).map(told);
        let simplest = failing.next().map(|(_, failure)| failure);
        let refused = self.cases.refused.iter().map(|(&(member, case), why)| {
            let id = members[member].case_id(case);
            (RowPlace { member, case, output: 0 }, unjudged(id, why.message(), stage.name(), by.adapter))
        });
        let mut rest: Vec<(RowPlace, Failure)> = failing.chain(refused).collect();
        rest.sort_by_key(|(place, _)| *place);
        rest.truncate(KEPT);
        simplest.into_iter().chain(rest.into_iter().map(|(_, one)| one)).collect()
    }
}

/// The intervals of one case as a profile makes them for a stage of a subject.
pub fn intervals(member: &Member, inputs: &[f32], stage: Stage, known: &Known, profile: &Profile, out: &mut [Accept]) {
    match member.spec.kind {
        Kind::Raster(kind) if !is_arithmetic(member, stage) => {
            member.formula.raster_interval(kind, inputs, &known.profile(profile), out);
        }
        _ => member.formula.interval(inputs, profile, out),
    }
}

/// Judges the outputs of a case: the greatest error, and the sum and the number of the finite ones.
fn judge_values(
    chunk: &Chunk<'_>,
    words: &[u32],
    case: usize,
    stage: Stage,
    by: &Judging<'_>,
    standing: &mut RowStanding,
) -> (f64, (f64, u64)) {
    let (member, outputs) = (chunk.members[chunk.of[case]], chunk.members[0].spec.output_len());
    let range = case * outputs..(case + 1) * outputs;
    let mut own = [Accept::ANY; 16];
    let legal = legal(chunk, case, stage, by, &mut own);
    let is_random = matches!(chunk.cases[case], CaseRef::Random(_));
    let kept = || kept(chunk, words, case, stage, by);
    let tally = &mut standing.tally;
    let (failed, pardoned) = (tally.totals.failed, tally.totals.expected_failures);
    let (mut greatest, mut errors) = (0.0, (0.0, 0));
    let mut granted = None;
    tally.totals.cases += 1;
    for (output, at) in range.clone().enumerate() {
        if member.missing.contains(&output) {
            continue;
        }
        let (bits, reference) = (words[at], chunk.references[at]);
        let verdict = judge(bits, reference, &legal[output]);
        let excused = match verdict.outcome {
            Outcome::Fail => {
                let granted = granted.get_or_insert_with(|| granted_at(chunk, case, stage, by));
                let excuses =
                    |(_, legal): &&(&str, Vec<Accept>)| judge(bits, reference, &legal[output]).outcome == Outcome::Pass;
                granted.iter().find(excuses).map(|(name, _)| *name)
            }
            _ => None,
        };
        let is_first = tally.totals.failed == failed;
        tally.count(verdict.outcome, excused, is_random);
        if verdict.outcome == Outcome::Indeterminate {
            continue;
        }
        let place = RowPlace { member: chunk.of[case], case: chunk.cases[case], output };
        if verdict.outcome == Outcome::Fail && excused.is_none() && is_first {
            tally.fail(place, telling(chunk.inputs_of(case), is_random), kept);
        }
        tally.see_error(verdict.error);
        if tally.see_margin(verdict.margin, place) {
            standing.worst = Some(kept());
        }
        greatest = worse(greatest, verdict.error);
        if verdict.error.is_finite() {
            errors = (errors.0 + verdict.error, errors.1 + 1);
        }
    }
    let number = row_number(member.number, chunk.cases[case]);
    if standing.tally.totals.failed > failed {
        *standing.failing.entry(chunk.of[case]).or_default() += 1;
        standing.chosen[0].push((chunk.of[case], chunk.cases[case]), number, || case);
    } else if standing.tally.totals.expected_failures == pardoned {
        standing.chosen[1].push((chunk.of[case], chunk.cases[case]), number, || case);
    }
    (greatest, errors)
}

/// What is legal of a case's outputs in a stage; `own` has room for it where the chunk has not.
fn legal<'a>(
    chunk: &'a Chunk<'_>,
    case: usize,
    stage: Stage,
    by: &Judging<'_>,
    own: &'a mut [Accept; 16],
) -> &'a [Accept] {
    let (member, outputs) = (chunk.members[chunk.of[case]], chunk.members[0].spec.output_len());
    if is_arithmetic(member, stage) {
        return &chunk.intervals[case * outputs..(case + 1) * outputs];
    }
    intervals(member, chunk.inputs_of(case), stage, by.known, by.profile, &mut own[..outputs]);
    &own[..outputs]
}

/// A case of a chunk with what was answered.
fn kept(chunk: &Chunk<'_>, words: &[u32], case: usize, stage: Stage, by: &Judging<'_>) -> KeptRow {
    let outputs = chunk.members[0].spec.output_len();
    let range = case * outputs..(case + 1) * outputs;
    let mut own = [Accept::ANY; 16];
    KeptRow {
        inputs: chunk.inputs_of(case).to_vec(),
        values: words[range.clone()].iter().map(|&bits| f32::from_bits(bits)).collect(),
        reference: chunk.references[range].to_vec(),
        legal: legal(chunk, case, stage, by, &mut own).to_vec(),
    }
}

/// Whether a stage computes a formula by the shading language's arithmetic alone.
const fn is_arithmetic(member: &Member, stage: Stage) -> bool {
    match stage {
        Stage::Compute | Stage::Fragment => true,
        Stage::Answer => !matches!(member.spec.kind, Kind::Raster(_)),
        Stage::FixedFunction | Stage::Raster => false,
    }
}

/// What each named deviation makes legal of a case's outputs.
fn granted_at(chunk: &Chunk<'_>, case: usize, stage: Stage, by: &Judging<'_>) -> Vec<(&'static str, Vec<Accept>)> {
    let member = chunk.members[chunk.of[case]];
    let of_deviation = |deviation: &&'static Deviation| {
        let mut legal = vec![Accept::ANY; member.spec.output_len()];
        let granted = grant(deviation, *by.profile);
        intervals(member, chunk.inputs_of(case), stage, by.known, &granted, &mut legal);
        (&*deviation.name, legal)
    };
    by.known.deviations.iter().map(of_deviation).collect()
}

/// A row that was not judged here, with the reference and what is legal worked out.
#[must_use]
pub fn evaluated(
    member: &Member,
    inputs: Vec<f32>,
    values: Vec<f32>,
    (stage, known, profile): (Stage, &Known, &Profile),
) -> KeptRow {
    let outputs = member.spec.output_len();
    let (mut reference, mut legal) = (vec![0.0; outputs], vec![Accept::ANY; outputs]);
    member.formula.reference(&inputs, &mut reference);
    intervals(member, &inputs, stage, known, profile, &mut legal);
    KeptRow { inputs, values, reference, legal }
}

/// Numbers of f32, as documents have them.
fn numbers(values: &[f32]) -> Vec<Number> {
    values.iter().map(|&x| Number(x.into())).collect()
}

fn bounds(legal: &Accept) -> [Number; 2] {
    [Number(legal.low()), Number(legal.high())]
}

/// A row that fails at an output. Of a renderer that answers by cases all outputs are told.
fn failure(member: &Member, place: RowPlace, row: &KeptRow, stage: Stage, adapter: &str) -> Failure {
    let KeptRow { inputs, values, reference, legal } = row;
    let (k, bits) = (place.output, values[place.output].to_bits());
    let error = |k: usize| judge(values[k].to_bits(), reference[k], &legal[k]).error;
    let by_cases = stage == Stage::Answer;
    Failure {
        rerun: String::new(),
        id: member.case_id(place.case),
        adapter: adapter.to_owned(),
        stage: stage.name().into(),
        target: None,
        route: None,
        sample: None,
        output: member.spec.output_name(k),
        inputs: by_name(member, inputs, |x| serde_json::to_value(Number(x.into())).unwrap_or_default()),
        units: units(member),
        // An answer has its inputs in a row.
        inputs_hex: if by_cases { serde_json::Map::new() } else { by_name(member, inputs, bits_in_hex) },
        reference: Number(reference[k]),
        interval: bounds(&legal[k]),
        promise: None,
        value: Number(values[k].into()),
        value_hex: format!("0x{bits:08x}"),
        unwritten: bits == lightmeter_scene::target::SENTINEL,
        error_ulp: Number(if by_cases { (0..values.len()).map(error).fold(0.0, worse) } else { error(k) }),
        answer: by_cases.then(|| FailedAnswer {
            inputs: numbers(inputs),
            outputs: (0..values.len()).map(|k| member.spec.output_name(k)).collect(),
            reference: reference.iter().map(|&x| Number(x)).collect(),
            interval: legal.iter().map(bounds).collect(),
            value: numbers(values),
            problem: None,
        }),
    }
}

/// The bits of a number.
#[must_use]
pub fn bits_in_hex(x: f32) -> serde_json::Value {
    format!("0x{:08x}", x.to_bits()).into()
}

/// A case whose answer cannot be judged: there is no number to show.
#[must_use]
pub fn unjudged(id: String, message: &str, stage: &'static str, adapter: &str) -> Failure {
    Failure {
        error_ulp: Number(f64::INFINITY),
        answer: Some(FailedAnswer { problem: Some(message.to_owned()), ..FailedAnswer::default() }),
        ..Failure::new(id, adapter.to_owned(), stage)
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
        let by = judging(&known);
        let mut standing = RowStanding::new(chunk.members[0].spec.output_len());
        standing.judge(chunk, &words.to_vec().into(), Stage::Compute, &by);
        standing
    }

    fn judging(known: &Known) -> Judging<'_> {
        Judging { adapter: "cpu", known, profile: &WGSL, seed: 1, expected: &[], counts_cases: true }
    }

    fn reported(chunk: &Chunk<'_>, words: &[u32]) -> Vec<Failure> {
        standing(chunk, words).failures(chunk.members, Stage::Compute, &judging(&Known::default()))
    }

    /// The first, a middle and the last of `of` places.
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
                    let failure = &reported(chunk, &words)[0];
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
            let reported = reported(chunk, &words);
            let id = |case: usize| format!("vector/reflect/random/{case:06}");
            assert_eq!(Some(reported[0].id.clone()), simplest(from).map(id));
            assert_eq!((reported.len(), reported[1].id.clone()), (KEPT + 1, id(from)));
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
