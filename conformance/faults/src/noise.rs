//! Noise as a subject: answers that come of no mistake. None of them may be explained, unless the mistaken formula itself gives them.

use super::common::share;
use super::diagnose::diagnose;
use super::evidence::Right;
use super::explanation::TriedMistake;
use super::group::group_verdict;
use super::selftest::{Bench, SelftestOptions};
use super::variation::Variation;
use crate::concerned::concerned;
use lightmeter_arithmetic::Accept;
use lightmeter_catalogue::cases::mix;
use lightmeter_catalogue::select::{Member, Shard, catalogue, select};
use lightmeter_document::selftest::{ExplainedNoise, NoiseRecord};
use lightmeter_judge::diagnose::Answered;
use rayon::prelude::*;
use std::fmt;
use std::ops::Range;

/// What is answered in a formula's place.
enum Noise<'a> {
    /// The same number in every output of every case.
    Constant(f32),
    /// Another number in each output, the same in every case.
    Constants([f32; 4]),
    /// Numbers from 0 to 1 that depend on nothing.
    Unit,
    /// Numbers between the least and the greatest right one of the output.
    InRange,
    /// The inputs from this one on, one for each output.
    Echo(usize),
    /// What another formula gives for the same numbers.
    Other(&'a Member),
}

impl fmt::Display for Noise<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(x) => write!(f, "always {x}"),
            Self::Constants(all) => write!(f, "always {all:?}"),
            Self::Unit => f.write_str("random numbers from 0 to 1"),
            Self::InRange => f.write_str("random numbers within the range of the right ones"),
            Self::Echo(first) => write!(f, "the inputs from number {first} on"),
            Self::Other(member) => write!(f, "{} of the same numbers", member.spec.id),
        }
    }
}

/// Formulas that stand in another's place.
const OTHERS: usize = 6;
/// Echoes of inputs.
const ECHOES: usize = 6;
/// The part of the failing values that a mistaken formula has to give itself for the noise to be what it makes.
pub(crate) const LEAST_GIVEN: f64 = 0.99;

/// Answers every kind of noise, with and without the right alpha, in every formula that a filter selects, and lists what is explained all the
/// same. Once it is told to stop, it tries no other formula.
#[must_use]
pub fn noise(options: &SelftestOptions, tried: &(dyn Fn(&str) + Sync)) -> NoiseRecord {
    let members = catalogue();
    let selected = select(&members, &options.filter, options.cases, Shard::WHOLE);
    let of_formula = |place: usize| {
        let member = &members[selected[place].member];
        let others = (1..).map(|k| &members[selected[(place + 37 * k) % selected.len()].member]);
        let found = of_formula(member, others.take(OTHERS), options);
        tried(&member.spec.id);
        found
    };
    let parts: Vec<NoiseRecord> =
        (0..selected.len()).into_par_iter().filter(|_| !options.stop.is_set()).map(of_formula).collect();
    parts.into_iter().fold(NoiseRecord::default(), |mut all, part| {
        all.tried += part.tried;
        all.explained.extend(part.explained);
        all
    })
}

fn of_formula<'a>(member: &Member, others: impl Iterator<Item = &'a Member>, options: &SelftestOptions) -> NoiseRecord {
    let bench = Bench::new(member, options, options.cases);
    let inputs = member.spec.input_len();
    let constants = [0.0, 1.0, -1.0, 0.5, 9.0, f32::NAN].map(Noise::Constant);
    let echoes = (0..ECHOES.min(inputs)).map(|k| Noise::Echo(k * inputs / ECHOES.min(inputs)));
    let all =
        constants.into_iter().chain([Noise::Constants([9.0, 8.0, 7.0, 1.0]), Noise::Constants([0.1, 0.7, 0.3, 0.0])]);
    let all = all.chain([Noise::Unit, Noise::InRange]).chain(echoes).chain(others.map(Noise::Other));
    let alpha = alpha(member);
    let mut record = NoiseRecord::default();
    for noise in all {
        for keeps_alpha in [false, true] {
            if keeps_alpha && alpha.is_none() {
                continue;
            }
            let values = answers(&bench, &noise, alpha.filter(|_| keeps_alpha));
            record.tried += 1;
            record.explained.extend(explained(&bench, &values, options).into_iter().map(|one| ExplainedNoise {
                formula: member.spec.id.clone(),
                noise: if keeps_alpha { format!("{noise}, with the right alpha") } else { noise.to_string() },
                ..one
            }));
        }
    }
    record
}

/// The place of the alpha among a formula's outputs.
fn alpha(member: &Member) -> Option<usize> {
    let spec = &member.spec;
    (0..spec.output_len()).find(|&k| spec.output_len() > 1 && spec.output_name(k).ends_with(".a"))
}

/// What is answered to each case, with the nearest right number where alpha is to be right.
fn answers(bench: &Bench<'_>, noise: &Noise<'_>, alpha: Option<usize>) -> Vec<Vec<f32>> {
    let outputs = bench.outputs();
    let range = |k: usize| {
        let all = bench.reference.iter().skip(k).step_by(outputs).filter(|x| x.is_finite());
        let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &x| [low.min(x), high.max(x)]);
        if low <= high { [low, high] } else { [0.0, 1.0] }
    };
    let ranges: Vec<[f64; 2]> = (0..outputs).map(range).collect();
    let answer = |case: usize| {
        let row = &bench.inputs[case];
        let mut out: Vec<f32> = (0..outputs)
            .map(|k| match noise {
                Noise::Constant(x) => *x,
                Noise::Constants(all) => all[k % 4],
                Noise::Unit => narrow(random(case, k)),
                Noise::InRange => {
                    let [low, high] = ranges[k];
                    narrow(low + random(case, k) * (high - low))
                }
                Noise::Echo(first) => row[(first + k) % row.len()],
                Noise::Other(_) => 0.0,
            })
            .collect();
        if let Noise::Other(other) = noise {
            let inputs: Vec<f32> = row.iter().copied().cycle().take(other.spec.input_len()).collect();
            let mut given = vec![0.0; other.spec.output_len()];
            other.formula.embedded(&inputs, &mut given);
            out = given.into_iter().cycle().take(outputs).collect();
        }
        if let Some(k) = alpha {
            out[k] = narrow(bench.reference[case * outputs + k]);
        }
        out
    };
    (0..bench.inputs.len()).map(answer).collect()
}

/// A number from 0 to 1 that depends on nothing.
pub(crate) fn random(case: usize, output: usize) -> f64 {
    let bits = mix(mix(case as u64) ^ output as u64) >> 32;
    f64::from(u32::try_from(bits).unwrap_or_default()) / f64::from(u32::MAX)
}

#[expect(clippy::cast_possible_truncation, reason = "an answer is an f32")]
const fn narrow(x: f64) -> f32 {
    x as f32
}

/// The explanation of answers that fail; of answers that all pass, what is wrong with them together.
fn explained(bench: &Bench<'_>, values: &[Vec<f32>], options: &SelftestOptions) -> Vec<ExplainedNoise> {
    let rows = bench.answered(values);
    let (failing, passing): (Vec<Answered<'_>>, Vec<Answered<'_>>) = rows.iter().copied().partition(|row| row.is_wrong);
    let one = |says: String, given: f64| ExplainedNoise {
        says,
        given,
        is_made: given >= LEAST_GIVEN,
        ..ExplainedNoise::default()
    };
    if failing.is_empty() {
        let found = group_verdict(bench.member, &rows);
        return found.into_iter().map(|found| one(found.says, 0.0)).collect();
    }
    let found = diagnose(bench.member, &rows, options.profile);
    let right = Right::new(bench.outputs(), &failing, &passing);
    let whole = (0..bench.outputs(), found.explanations);
    let explained = std::iter::once(&whole).chain(&found.parts);
    let explained = explained.filter_map(|(places, explanations)| Some((places, explanations.first()?)));
    let given = |(places, best)| given(bench, best, (&failing, &right, places), options);
    explained.map(|of: (&Range<usize>, &TriedMistake)| one(of.1.says.clone(), given(of))).collect()
}

/// The part of the wrong numbers that the mistaken formula gives: the very number, or one within an interval that tells something.
fn given(
    bench: &Bench<'_>,
    best: &TriedMistake,
    (failing, right, places): (&[Answered<'_>], &Right, &Range<usize>),
    options: &SelftestOptions,
) -> f64 {
    let known = concerned(bench.member);
    let find = |name: &&'static str| known.iter().find(|of| of.fault.name == *name).copied();
    let faults: Option<Vec<_>> = best.faults.iter().map(find).collect();
    let Some(variation) = faults.and_then(|faults| Variation::of(bench.member, &faults)) else { return 0.0 };
    let outputs = bench.outputs();
    let (mut own, mut legal) = (vec![0.0_f32; outputs], vec![Accept::ANY; outputs]);
    let (mut wrong, mut as_made) = (0_usize, 0_usize);
    for row in failing {
        match &best.parameter {
            Some(scaled) => {
                scaled.evaluate(&variation, row.inputs, &mut own);
                scaled.interval(&variation, row.inputs, options.profile, &mut legal);
            }
            None => {
                variation.evaluate(row.inputs, &mut own);
                variation.interval(row.inputs, options.profile, &mut legal);
            }
        }
        for k in places.clone().filter(|&k| !row.is_right(k)) {
            let value = row.values[k];
            let is_own = value.to_bits() == own[k].to_bits() || value.is_nan() && own[k].is_nan();
            wrong += 1;
            as_made += usize::from(is_own || !right.is_wide(k, &legal[k]) && legal[k].contains(value.into()));
        }
    }
    if wrong == 0 { 0.0 } else { share(as_made, wrong) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::filter::Filter;
    use lightmeter_document::event::Stop;

    #[test]
    fn noise_in_lights_with_cones_is_explained_by_nothing() {
        let filter =
            Filter::new(&["lighting/spot".to_owned(), "lighting/point-blinn".to_owned()]).expect("they are globs");
        let (seed, draws, stop) = (1, 0, Stop::default());
        let options = SelftestOptions { filter, cases: 256, seed, draws, profile: &WGSL, stop };
        let record = noise(&options, &|_| {});
        let false_ones: Vec<_> = record.explained.iter().filter(|one| !one.is_made).collect();
        assert!(record.tried > 40 && false_ones.is_empty(), "{false_ones:#?}");
    }
}
