//! Verdicts on blocks of consecutive floats, most of them without an interval.
//!
//! *A float next to the reference is legal.* The exact value lies between two floats, or is one. Every operation of [`Accept`] keeps
//! the exact value inside, and ends are rounded outward to floats, or widened by two ULP and more before they are rounded inward,
//! so those floats are inside too. A value is next to the reference where it is nearer than the ULP of the smaller of the two: beyond a
//! power of two an ULP is twice as long, and reaches to the next float but one. So nearer values pass at once, and of the others
//! alone the interval is computed.
//!
//! *Unless nothing is promised there.* Then no value passes. For a run of inputs the interval is computed once, with the free
//! input anywhere between the first and the last: where that one is bounded, so is that of each input. Where it is not, each
//! input's own is.

use lightmeter_arithmetic::format::error_ulp;
use lightmeter_arithmetic::{Accept, F32, Format as _, Profile};
use lightmeter_catalogue::cases::AnyFormula;
use lightmeter_document::Number;
use lightmeter_document::adapters::Deviation;
use lightmeter_document::sweep::{ExactFloat, Statistics, SweepInput, SweepPart, SweepVerdict};
use lightmeter_judge::devices::grant;
use lightmeter_judge::{Outcome, judge};
use lightmeter_scene::along::{Along, float_of};
use rayon::prelude::*;

/// Inputs of a run, for which one interval tells whether anything is promised.
const RUN: usize = 256;
/// Inputs that a task of the pool takes at once.
const TASK: usize = 64 * RUN;

/// What a block's values are judged by.
pub struct Judge<'a> {
    /// The formula.
    pub formula: &'a dyn AnyFormula,
    /// The row, without selectors, and the numbers concerned.
    pub along: Along<'a>,
    /// The accuracy rules.
    pub profile: &'static Profile,
    /// What is granted besides.
    pub deviations: &'a [&'static Deviation],
    /// The key of the first float of the whole sweep, and how many floats it has.
    pub whole: (u32, u64),
}

/// Parts of a sweep whose errors are told one by one.
const PARTS: u64 = 256;

/// Buffers of a run.
struct Run {
    inputs: [f32; RUN],
    references: [f64; RUN],
    asked: Vec<usize>,
    asked_inputs: Vec<f32>,
    intervals: [Accept; RUN],
}

impl Judge<'_> {
    /// Judges the results of the floats from the one of that key on.
    #[must_use]
    pub fn block(&self, first: u32, words: &[u32]) -> Statistics {
        let tasks: Vec<Statistics> = words
            .par_chunks(TASK)
            .zip((0..words.len()).into_par_iter().step_by(TASK))
            .map(|(words, done)| self.task(first + small(done), words))
            .collect();
        let mut sum = Statistics::default();
        tasks.into_iter().for_each(|task| sum.add(task));
        sum
    }

    fn task(&self, first: u32, words: &[u32]) -> Statistics {
        let mut run = Run {
            inputs: [0.0; RUN],
            references: [0.0; RUN],
            asked: Vec::with_capacity(RUN),
            asked_inputs: Vec::with_capacity(RUN),
            intervals: [Accept::ANY; RUN],
        };
        let mut sum = Statistics { inputs: words.len() as u64, ..Statistics::default() };
        for (words, first) in words.chunks(RUN).zip((first..).step_by(RUN)) {
            for (input, key) in run.inputs.iter_mut().zip(first..).take(words.len()) {
                *input = float_of(key);
            }
            self.run(&mut run, words, &mut sum);
        }
        sum.see_part(SweepPart {
            part: self.part(first),
            error_max: sum.worst.map_or(Number(0.0), |worst| worst.error),
            failed: sum.failed,
            margin_max: sum.nearest_to_limit.map_or(Number(0.0), |nearest| nearest.margin),
        });
        sum
    }

    /// The part of the sweep that a float lies in.
    fn part(&self, key: u32) -> usize {
        let (first, inputs) = self.whole;
        usize::try_from(u64::from(key.wrapping_sub(first)) * PARTS / inputs.max(1)).unwrap_or_default()
    }

    fn run(&self, run: &mut Run, words: &[u32], sum: &mut Statistics) {
        let count = words.len();
        let (inputs, references) = (&run.inputs[..count], &mut run.references[..count]);
        self.formula.reference_along(&self.along, inputs, references);
        let is_promised =
            !self.formula.interval_between(&self.along, inputs[0], inputs[count - 1], self.profile).is_any();

        run.asked.clear();
        run.asked_inputs.clear();
        let (mut near, mut most, mut worst) = ([0; 3], -1.0, 0);
        for (k, (&bits, &reference)) in words.iter().zip(&*references).enumerate() {
            let value = f64::from(f32::from_bits(bits));
            let distance = (value - reference).abs();
            if is_promised && is_next(value, reference, distance) {
                let error = distance / F32::ulp(reference);
                near[usize::from(error > 0.0) + usize::from(error > 0.5)] += 1;
                if error > most {
                    (most, worst) = (error, k);
                }
            } else {
                run.asked.push(k);
                run.asked_inputs.push(inputs[k]);
            }
        }
        sum.histogram.count_near(near);
        sum.passed += near.iter().sum::<u64>();
        if most >= 0.0 && sum.worst.is_none_or(|seen| most > seen.error.0) {
            let mut interval = [Accept::ANY];
            self.formula.interval_along(&self.along, &inputs[worst..=worst], self.profile, &mut interval);
            sum.see_error(seen(inputs[worst], words[worst], references[worst], &interval[0]));
        }
        if run.asked.is_empty() {
            return;
        }
        let intervals = &mut run.intervals[..run.asked.len()];
        self.formula.interval_along(&self.along, &run.asked_inputs, self.profile, intervals);
        for (&k, interval) in run.asked.iter().zip(intervals) {
            self.verdict(inputs[k], words[k], references[k], interval, sum);
        }
    }

    /// The verdict on one value, in full.
    fn verdict(&self, input: f32, bits: u32, reference: f64, interval: &Accept, sum: &mut Statistics) {
        let outcome = judge(bits, reference, interval).outcome;
        if outcome == Outcome::Indeterminate {
            sum.indeterminate += 1;
            return;
        }
        let seen = seen(input, bits, reference, interval);
        if f32::from_bits(bits).is_nan() && !reference.is_nan() {
            sum.histogram.count_nan();
        } else {
            sum.histogram.count(seen.error.0);
        }
        sum.see_error(seen);
        sum.see_margin(seen);
        if outcome == Outcome::Pass {
            sum.passed += 1;
        } else if let Some(name) = self.excuse(input, bits, reference) {
            sum.expected_failures += 1;
            *sum.excused.entry(name.into()).or_default() += 1;
        } else {
            sum.failed += 1;
            sum.see_failure(seen);
        }
    }

    /// The named deviation that makes a value legal, if one does.
    fn excuse(&self, input: f32, bits: u32, reference: f64) -> Option<&'static str> {
        self.deviations.iter().find_map(|deviation| {
            let mut interval = [Accept::ANY];
            self.formula.interval_along(&self.along, &[input], &grant(deviation, *self.profile), &mut interval);
            (judge(bits, reference, &interval[0]).outcome == Outcome::Pass).then_some(&*deviation.name)
        })
    }
}

/// Whether a value is one of the floats between which the reference lies; a NaN is not.
#[inline]
fn is_next(value: f64, reference: f64, distance: f64) -> bool {
    distance < F32::ulp(value.abs().min(reference.abs()))
}

/// A block has at most 2²² inputs.
fn small(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

fn seen(input: f32, bits: u32, reference: f64, interval: &Accept) -> SweepVerdict {
    let verdict = judge(bits, reference, interval);
    let value = f32::from_bits(bits);
    SweepVerdict {
        input: SweepInput::Float(ExactFloat(input)),
        value: ExactFloat(value),
        reference: Number(reference),
        low: Number(interval.low()),
        high: Number(interval.high()),
        error: Number(error_ulp::<F32>(value, reference)),
        margin: Number(verdict.margin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::cases::Kind;
    use lightmeter_catalogue::select::{CaseRef, Member, catalogue};
    use lightmeter_scene::along::key_of;

    fn swept() -> Vec<Member> {
        // One function evaluates all of the many blend states: every 37th stands for them.
        let is_swept = |(place, member): &(usize, Member)| match member.spec.kind {
            Kind::Arithmetic => true,
            Kind::Blend(_) => !member.spec.function.is_empty() && place % 37 == 0,
            Kind::Raster(_) | Kind::Depth(_) => false,
        };
        catalogue().into_iter().enumerate().filter(is_swept).map(|(_, member)| member).collect()
    }

    /// Rows of a formula, with a number that is free in each.
    fn rows(member: &Member) -> impl Iterator<Item = (Vec<f32>, usize)> + '_ {
        (0..96).map(|k| {
            let mut row = vec![];
            member.inputs(CaseRef::Random(k), 7, &mut row);
            let free = usize::try_from(k).unwrap_or(0) % row.len();
            (row, free)
        })
    }

    fn narrow(x: f64) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is wanted")]
        let narrow = x as f32;
        narrow
    }

    #[test]
    fn a_float_next_to_the_reference_is_legal() {
        let mut checked = 0_u64;
        for member in swept() {
            let outputs = member.spec.output_len();
            for (row, free) in rows(&member) {
                // Around the drawn input and at odd places: near 0, and among subnormals.
                for input in [row[free], row[free] * 1e-3, row[free] * 1e-30, row[free] * 1e-40] {
                    let mut row = row.clone();
                    row[free] = input;
                    let (mut references, mut intervals) = (vec![0.0; outputs], vec![Accept::ANY; outputs]);
                    member.formula.reference(&row, &mut references);
                    member.formula.interval(&row, &WGSL, &mut intervals);
                    for (&reference, interval) in references.iter().zip(&intervals) {
                        let nearest = narrow(reference);
                        let around = [nearest.next_down(), nearest, nearest.next_up()];
                        for value in [around[0].next_down(), around[0], nearest, around[2], around[2].next_up()] {
                            if is_next(value.into(), reference, (f64::from(value) - reference).abs()) {
                                checked += 1;
                                assert!(
                                    interval.contains(value.into()),
                                    "{}: {row:?}: {value:e} at {reference:e} in {interval:?}",
                                    member.spec.id
                                );
                            }
                        }
                    }
                }
            }
        }
        assert!(checked > 80_000, "{checked}");
    }

    #[test]
    #[ignore = "long: ./x campaign long"]
    fn where_something_is_promised_of_a_run_it_is_of_each_input() {
        let (mut bounded, mut open) = (0_u64, 0_u64);
        for member in swept() {
            for (row, free) in rows(&member) {
                let outputs = 0..member.spec.output_len();
                for (input, output) in
                    [row[free], 0.0, 1e30].into_iter().flat_map(|x| outputs.clone().map(move |k| (x, k)))
                {
                    let along = Along { row: &row, free, output };
                    let first = key_of(input);
                    let inputs: Vec<f32> = (first..).take(RUN).map(float_of).collect();
                    let mut each = [Accept::ANY; RUN];
                    member.formula.interval_along(&along, &inputs, &WGSL, &mut each);
                    let hull = member.formula.interval_between(&along, inputs[0], inputs[RUN - 1], &WGSL);
                    if hull.is_any() {
                        open += 1;
                        continue;
                    }
                    bounded += 1;
                    let any = each.iter().position(Accept::is_any);
                    assert_eq!(any, None, "{}: {row:?}, {free} free, output {output}", member.spec.id);
                }
            }
        }
        assert!(bounded > 10_000 && open > 0, "{bounded} {open}");
    }

    /// Verdicts one by one, in full.
    fn by_hand(judge: &Judge<'_>, first: u32, words: &[u32]) -> Statistics {
        let mut sum = Statistics { inputs: words.len() as u64, ..Statistics::default() };
        for (input, &bits) in (first..).map(float_of).zip(words) {
            let mut row = judge.along.row.to_vec();
            row[judge.along.free] = input;
            let (mut references, mut intervals) = ([0.0; 16], [Accept::ANY; 16]);
            judge.formula.reference(&row, &mut references);
            judge.formula.interval(&row, &WGSL, &mut intervals);
            let output = judge.along.output;
            judge.verdict(input, bits, references[output], &intervals[output], &mut sum);
        }
        sum
    }

    #[test]
    fn blocks_come_to_what_single_verdicts_come_to() {
        let mut indeterminate = 0;
        for member in swept() {
            // Where the free number is 0 or great, nothing may be promised.
            let each = rows(&member).step_by(31);
            for ((row, free), x) in each.flat_map(|row| [None, Some(0.0), Some(1e30)].map(|x| (row.clone(), x))) {
                let along = Along { row: &row, free, output: usize::from(member.spec.output_len() > 1) };
                let first = key_of(x.unwrap_or(row[free]));
                let whole = (first, 3 * RUN as u64 + 17);
                let judge = Judge { formula: &*member.formula, along, profile: &WGSL, deviations: &[], whole };
                let inputs: Vec<f32> = (first..).take(3 * RUN + 17).map(float_of).collect();
                let mut out = vec![0.0; inputs.len()];
                member.formula.embedded_along(&along, &inputs, &mut out);
                // Right values, and some that are a few ULP off, NaN, or never written.
                let words: Vec<u32> = (0..)
                    .zip(out)
                    .map(|(k, value): (u32, f32)| match k % 61 {
                        0..40 => value.to_bits(),
                        58 => f32::NAN.to_bits(),
                        59 => lightmeter_scene::target::SENTINEL,
                        60 => f32::INFINITY.to_bits(),
                        off => value.to_bits().wrapping_add(1 << (off - 40)),
                    })
                    .collect();
                let (block, hand) = (judge.block(first, &words), by_hand(&judge, first, &words));
                let counts = |of: &Statistics| [of.inputs, of.passed, of.failed, of.indeterminate];
                let id = &member.spec.id;
                assert_eq!(counts(&block), counts(&hand), "{id}");
                assert_eq!(block.histogram, hand.histogram, "{id}");
                let place = |seen: Option<SweepVerdict>| seen.map(|seen| seen.input);
                assert_eq!(place(block.worst), place(hand.worst), "{id}");
                assert_eq!(block.problem(), None, "{id}");
                indeterminate += block.indeterminate;
            }
        }
        assert!(indeterminate > 1000, "{indeterminate}");
    }
}
