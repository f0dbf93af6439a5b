//! Mistakes, pairs of them and wrong parameters, tried as explanations of some outputs of a renderer's answers.

use super::common::{in_common, share};
use super::concerned::concerned;
use super::evidence::{EXCLUDED, Fit, Foretold, LEAST_EVIDENCE, MOST_FORETOLD, Right, bits_left, is_inside, is_wrong};
use super::explanation::{FormulaDiagnosis, TriedMistake, is_equal, rank, told};
use super::factor::{self, Scaled};
use super::fault::Concerned;
use super::variation::Variation;
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::Member;
use lightmeter_document::report::{Diagnosis, FailingOutput, Telling};
use lightmeter_judge::diagnose::Answered;
use lightmeter_judge::telling;
use std::ops::Range;

/// The largest share of cases that may speak against an explanation: failing cases whose answer it does not allow, and passing cases whose
/// answer it does not allow. Both are counted relative to the number of failing cases. The first constant counts random cases only and is
/// stricter, because at a formula's edges two renderers that make the same mistake may guard against special inputs differently. Where
/// every answer is 0 or 1, no passing case may contradict an explanation.
const MOST_OFF_OF_RANDOM: f64 = 0.015;
const MOST_OFF: f64 = 0.1;
/// The share of the random passing cases that would fail by it.
const MOST_MISSING: f64 = 0.1;
/// The most bits of evidence that an output contributes where all answers to it are the same number although the mistake would have given
/// another number in some case.
const MOST_CONSTANT: f64 = 4.0;
/// The bits that a wrong number tells at least where the mistake computes exactly that number.
const OWN: f64 = 2.0;
/// The share of the wrong numbers that a mistake gives at least: that very number, or one within an interval that tells something. Of the tables'
/// mistakes some leave much open, as a power of what is greater than 1 does. Those that follow from a formula's steps are many, so more is asked of
/// them, and nearly all of two mistakes of which one is such.
const LEAST_GIVEN: f64 = 0.1;
const LEAST_GIVEN_BY_GENERATED: f64 = 0.9;
const LEAST_GIVEN_BY_COMPOSED: f64 = 0.99;
/// The bits that it takes to say by which factor which parameter is off.
const FACTOR_BITS: f64 = 24.0;
/// The fewest failing cases for which two mistakes at once are tried. Fewer cases could be explained by too many different pairs.
const FEWEST_OF_TWO: usize = 16;
/// Failing cases that a mistake is tried on first.
const PROBES: usize = 24;
/// Failing cases that a pair of mistakes is tried on first; all but one of them must be explained.
const PAIR_PROBES: usize = 8;

/// Tries what is known as explanations of some places of the outputs, the only ones that the rows have.
pub(super) fn diagnose_places(
    member: &Member,
    rows: &[Answered<'_>],
    profile: &Profile,
    places: Range<usize>,
) -> FormulaDiagnosis {
    let failing: Vec<Answered<'_>> = rows.iter().filter(|row| row.is_wrong).copied().collect();
    let passing: Vec<Answered<'_>> = rows.iter().filter(|row| !row.is_wrong).copied().collect();
    let right = Right::new(places.len(), &failing, &passing);
    let is_whole = places.len() == member.spec.output_len();
    let mut trial = Trial { member, profile, places, failing: &failing, passing: &passing, right, found: vec![] };
    if !failing.is_empty() {
        trial.singles();
        let is_told_by_two = failing.len() >= FEWEST_OF_TWO;
        if !trial.is_explained() && !trial.right.is_constant() {
            trial.parameters();
        }
        if !trial.is_explained() && is_told_by_two {
            trial.pairs();
        }
        if !trial.is_explained() && is_told_by_two && !trial.right.is_constant() {
            trial.faults_and_parameters();
        }
    }
    let mut explanations = std::mem::take(&mut trial.found);
    rank(&mut explanations, part(MOST_OFF_OF_RANDOM, failing.len()));
    let next = explanations.iter().skip(1).find(|other| {
        let best = &explanations[0];
        !is_equal(best, other) && !best.faults.iter().all(|fault| other.faults.contains(fault))
    });
    let telling = next.and_then(|next| Some((next, trial.telling(&explanations[0], next)?)));
    let told = told(&explanations);
    let place_of =
        |next: &TriedMistake| told.iter().position(|(place, _)| std::ptr::eq(next, &raw const explanations[*place]));
    let telling = telling.and_then(|(next, case)| Some(Telling { case, next: place_of(next)?, shown: None }));
    let diagnosis = Diagnosis {
        failing: failing.len() as u64,
        looked_at: failing.len() as u64,
        in_common: if told.is_empty() { in_common(member, &trial.places, &failing, &passing) } else { vec![] },
        outputs: if is_whole { trial.outputs(explanations.first()) } else { vec![] },
        explanations: told.into_iter().map(|(_, one)| one).collect(),
        telling,
        ..Diagnosis::default()
    };
    FormulaDiagnosis { failing: failing.len(), passing: passing.len(), explanations, diagnosis, parts: vec![] }
}

struct Trial<'a> {
    member: &'a Member,
    profile: &'a Profile,
    /// The outputs that the rows have.
    places: Range<usize>,
    failing: &'a [Answered<'a>],
    passing: &'a [Answered<'a>],
    right: Right,
    found: Vec<TriedMistake>,
}

impl Trial<'_> {
    fn is_explained(&self) -> bool {
        self.found.iter().any(|found| found.explained + found.open == self.failing.len())
    }

    /// So many of the failing cases, evenly spread.
    fn probes(&self, count: usize) -> impl Iterator<Item = &Answered<'_>> {
        self.failing.iter().step_by((self.failing.len() / count).max(1)).take(count)
    }

    /// Whether at most `most` of some failing cases lie outside the intervals.
    fn is_likely(&self, probes: usize, most: usize, tried: &impl Wrong) -> bool {
        let mut legal = vec![Accept::ANY; self.member.spec.output_len()];
        let mut outside = 0;
        self.probes(probes).all(|row| {
            tried.interval(row.inputs, self.profile, &mut legal);
            outside += usize::from(!is_inside(row.values, &legal[self.places.clone()]));
            outside <= most
        })
    }

    fn singles(&mut self) {
        let concerned = concerned(self.member);
        let prior = bits_of(concerned.len());
        for fault in concerned.iter() {
            let Some(variation) = Variation::of(self.member, &[*fault]) else { continue };
            if self.is_likely(PROBES, PROBES / 8, &variation) {
                let says = variation.says();
                self.take(&variation, says.clone(), Some(says), None, prior);
            }
        }
    }

    /// Tries two mistakes at once. Most pairs are ruled out cheaply, because their values in f64 are already too far from the answers.
    fn pairs(&mut self) {
        let concerned = concerned(self.member);
        let prior = 2.0 * bits_of(concerned.len());
        let near: Vec<Near> =
            self.probes(PAIR_PROBES).filter_map(|row| Near::new(self.member, row, &self.places)).collect();
        let paired = paired(self.member);
        for (place, first) in paired.iter().enumerate() {
            // One of the two is of the tables: of those that follow from a formula's steps, some two make nearly anything.
            for second in
                paired[place + 1..].iter().filter(|second| !(first.fault.is_generated && second.fault.is_generated))
            {
                let Some(variation) = Variation::of(self.member, &[*first, *second]) else { continue };
                let mut far = 0;
                let mut right = 0;
                let is_near = near.iter().all(|row| {
                    let value = row.value(&variation);
                    far += usize::from(!row.allows(&value));
                    right += usize::from(is_inside_f64(&value, &row.legal));
                    far <= 1
                });
                // Two mistakes that undo each other only round in another way, which explains anything that is nearly right.
                let is_near = is_near && right <= near.len() / 2;
                if is_near && self.is_likely(PAIR_PROBES, 1, &variation) {
                    let says = variation.says();
                    self.take(&variation, says.clone(), Some(says), None, prior);
                }
            }
        }
    }

    /// Parameters, and the outputs themselves, some factor times what was asked.
    fn parameters(&mut self) {
        if !matches!(self.member.spec.kind, Kind::Raster(_)) {
            let right = Variation::right(self.member);
            factor::candidates(&right, self.failing, &self.places)
                .into_iter()
                .for_each(|scaled| self.try_scaled(&right, scaled));
        }
    }

    /// A mistake, and an input some factor times what was asked: those that come nearest by a rough search.
    fn faults_and_parameters(&mut self) {
        let spec = &self.member.spec;
        if matches!(spec.kind, Kind::Raster(_)) {
            return;
        }
        let member = self.member;
        let variations: Vec<Variation<'_>> =
            paired(member).iter().filter_map(|fault| Variation::of(member, &[*fault])).collect();
        for (variation, scaled) in factor::nearest(&variations, self.failing, &self.places) {
            self.try_scaled(variation, scaled);
        }
    }

    fn try_scaled(&mut self, variation: &Variation<'_>, scaled: Scaled) {
        let tried = (variation, &scaled);
        if self.is_likely(PROBES, PROBES / 4, &tried) {
            let mistake = variation.says();
            let says = if mistake.is_empty() { scaled.says() } else { format!("{mistake}, and {}", scaled.says()) };
            let prior = FACTOR_BITS + if mistake.is_empty() { 0.0 } else { bits_of(concerned(self.member).len()) };
            let mistake = (!mistake.is_empty()).then_some(mistake);
            self.take(&tried, says, mistake, Some(scaled.clone()), prior);
        }
    }

    /// The formula with the mistakes of a candidate.
    fn variation(&self, one: &TriedMistake) -> Option<Variation<'_>> {
        let find = |name: &&'static str| concerned(self.member).iter().find(|of| of.fault.name == *name).copied();
        Variation::of(self.member, &one.faults.iter().map(find).collect::<Option<Vec<Concerned>>>()?)
    }

    /// The legal values of an implementation with a candidate's mistakes.
    fn legal(&self, one: &TriedMistake, variation: &Variation<'_>, row: &Answered<'_>, out: &mut [Accept]) {
        match &one.parameter {
            Some(scaled) => scaled.interval(variation, row.inputs, self.profile, out),
            None => variation.interval(row.inputs, self.profile, out),
        }
    }

    /// The outputs at which failing answers are wrong, and how many of these answers the best explanation accounts for.
    fn outputs(&self, best: Option<&TriedMistake>) -> Vec<FailingOutput> {
        let spec = &self.member.spec;
        let best = best.and_then(|best| Some((best, self.variation(best)?)));
        let mut legal = vec![Accept::ANY; spec.output_len()];
        let mut counts = vec![[0, 0]; spec.outputs.len()];
        for row in self.failing {
            if let Some((best, variation)) = &best {
                self.legal(best, variation, row, &mut legal);
            }
            let mut start = 0;
            for (output, [failing, explained]) in spec.outputs.iter().zip(&mut counts) {
                let of = start..start + output.shape.components();
                start = of.end;
                let is_within = |legal: &[Accept]| of.clone().all(|k| legal[k].contains(row.values[k].into()));
                let is_wrong = !is_within(row.legal);
                *failing += u64::from(is_wrong);
                *explained += u64::from(is_wrong && best.is_some() && is_within(&legal));
            }
        }
        let outputs = spec.outputs.iter().zip(counts).filter(|(_, [failing, _])| *failing > 0);
        outputs
            .map(|(output, [failing, explained])| FailingOutput { name: output.name.into(), failing, explained })
            .collect()
    }

    /// The simplest case whose answer one explanation allows and another does not.
    fn telling(&self, best: &TriedMistake, next: &TriedMistake) -> Option<String> {
        let variations = [self.variation(best)?, self.variation(next)?];
        let mut legal = vec![Accept::ANY; self.member.spec.output_len()];
        let mut allows = |row: &Answered<'_>, one: usize| {
            self.legal([best, next][one], &variations[one], row, &mut legal);
            is_inside(row.values, &legal[self.places.clone()])
        };
        let simple = |row: &&Answered<'_>| telling(row.inputs, row.is_random());
        let mut rows: Vec<&Answered<'_>> = self.failing.iter().chain(self.passing).collect();
        rows.sort_by_key(simple);
        let told = rows.into_iter().find(|row| !allows(row, 1) && allows(row, 0))?;
        Some(self.member.case_id(told.case))
    }

    /// How many cases may be off: of all, and of random ones.
    fn most_off(&self) -> [usize; 2] {
        let random = self.failing.iter().filter(|row| row.is_random()).count();
        [part(MOST_OFF, self.failing.len()), part(MOST_OFF_OF_RANDOM, random)]
    }

    /// Whether every answer is 0 or 1.
    fn is_of_bits(&self) -> bool {
        let is_bit = |row: &Answered<'_>| row.values.iter().all(|value| [0.0, 1.0].contains(value));
        self.failing.iter().chain(self.passing).all(is_bit)
    }

    /// Keeps an explanation that holds for the failing cases. `prior` are the bits that it takes to say which it is.
    fn take(
        &mut self,
        tried: &impl Wrong,
        says: String,
        mistake: Option<String>,
        parameter: Option<Scaled>,
        prior: f64,
    ) {
        let Some(mut tally) = self.tally_failing(tried) else { return };
        let Some(consistent) = self.tally_passing(tried, &mut tally) else { return };
        let Tally { explained, open, wrong, given, by_output, varies, foretold } = tally;
        let of_output = |place: usize| {
            let is_constant = self.right.constant[place].is_some() && varies[place];
            if is_constant { by_output[place].min(MOST_CONSTANT) } else { by_output[place] }
        };
        let mut evidence = (0..by_output.len()).map(of_output).sum::<f64>();
        // Which cases fail follows from answers that are all the same, whatever made them so.
        let is_all_alike = self.right.constant.iter().all(Option::is_some);
        evidence += if is_all_alike { 0.0 } else { foretold.bits().min(MOST_FORETOLD) } - prior;
        evidence -= part_of(EXCLUDED, self.failing.len() - explained - open + self.passing.len() - consistent);
        // A mistake that permits any answer explains nothing by permitting it.
        let least = match (tried.is_generated(), tried.is_composed()) {
            (false, _) => LEAST_GIVEN,
            (true, false) => LEAST_GIVEN_BY_GENERATED,
            (true, true) => LEAST_GIVEN_BY_COMPOSED,
        };
        if explained > 0 && share(given, wrong) >= least && evidence >= LEAST_EVIDENCE {
            let faults = tried.faults();
            self.found.push(TriedMistake { faults, says, mistake, parameter, explained, open, consistent, evidence });
        }
    }

    /// Room for what is legal and for what is computed, of all outputs.
    fn room(&self) -> (Vec<Accept>, Vec<f32>) {
        let outputs = self.member.spec.output_len();
        (vec![Accept::ANY; outputs], vec![0.0; outputs])
    }

    /// What an explanation says of the failing cases; `None` where it excludes too many.
    fn tally_failing(&self, tried: &impl Wrong) -> Option<Tally> {
        let outputs = self.places.len();
        let (mut legal, mut own) = self.room();
        let mut tally = Tally::default();
        let [most, most_of_random] = self.most_off();
        let (mut excluded, mut of_random) = (0, 0);
        tally.by_output = vec![0.0; outputs];
        tally.varies = vec![false; outputs];
        for (row, chance) in self.failing.iter().zip(self.right.bits.chunks(outputs)) {
            tried.interval(row.inputs, self.profile, &mut legal);
            tried.evaluate(row.inputs, &mut own);
            let (legal, own) = (&legal[self.places.clone()], &own[self.places.clone()]);
            tally.foretold.take(true, is_wrong(own, row.legal));
            let is_own = |place: usize| {
                let (a, b) = (row.values[place], own[place]);
                a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
            };
            match self.right.fit(row, legal, own) {
                Fit::Outside => {
                    excluded += 1;
                    of_random += usize::from(row.is_random());
                    if excluded > most || of_random > most_of_random {
                        return None;
                    }
                    // Guards at a formula's edges differ from renderer to renderer, which two mistakes may not be made up of.
                    if tried.is_composed() {
                        tally.wrong += (0..outputs).filter(|&place| !row.is_right(place)).count();
                    }
                    continue;
                }
                // Where the mistake permits nearly any number, it explains one only if it computes exactly that number in f32.
                Fit::Open if !(0..outputs).all(|place| row.is_right(place) || is_own(place)) => {
                    tally.open += 1;
                    tally.wrong += (0..outputs).filter(|&place| !row.is_right(place)).count();
                    continue;
                }
                Fit::Open | Fit::Inside => tally.explained += 1,
            }
            for (place, chance) in chance.iter().enumerate() {
                let is_given = is_own(place) || !self.right.is_wide(place, &legal[place]);
                if !row.is_right(place) {
                    tally.wrong += 1;
                    tally.given += usize::from(is_given);
                }
                if is_own(place) {
                    tally.by_output[place] += if row.is_right(place) { *chance } else { chance.max(OWN) };
                } else if is_given {
                    tally.by_output[place] += (chance - bits_left(row.values[place], &legal[place])).max(0.0);
                }
                tally.varies[place] |= !is_own(place);
            }
        }
        Some(tally)
    }

    /// The number of passing cases that the explanation allows, or `None` where the passing cases contradict it, because the mistake would
    /// have made them fail. Random cases decide: at a formula's edges, a renderer that makes this mistake may guard against special inputs
    /// differently.
    fn tally_passing(&self, tried: &impl Wrong, tally: &mut Tally) -> Option<usize> {
        let (mut legal, mut own) = self.room();
        let random = self.passing.iter().filter(|row| row.is_random()).count();
        let (most, most_of_random) = match self.is_of_bits() {
            true => (0, 0),
            false => self.most_off().into(),
        };
        let (mut contradicted, mut of_random, mut missing) = (0, 0, 0);
        for row in self.passing {
            tried.interval(row.inputs, self.profile, &mut legal);
            tried.evaluate(row.inputs, &mut own);
            let (legal, own) = (&legal[self.places.clone()], &own[self.places.clone()]);
            let (would_fail, is_contradicted) = (is_wrong(own, row.legal), !is_inside(row.values, legal));
            tally.foretold.take(false, would_fail);
            for (place, varies) in tally.varies.iter_mut().enumerate() {
                *varies |= own[place].to_bits() != row.values[place].to_bits();
            }
            contradicted += usize::from(is_contradicted);
            if row.is_random() {
                of_random += usize::from(is_contradicted);
                missing += usize::from(would_fail);
            }
            if contradicted > most || of_random > most_of_random {
                return None;
            }
        }
        // A mistake that only concerns rounding need not make a case fail: the renderer's own roundings may happen to be legal where ours
        // are not.
        let is_seldom = tried.is_rounding() || missing <= part(MOST_MISSING, random).max(1);
        is_seldom.then(|| self.passing.len() - contradicted)
    }
}

/// What an explanation says of the failing cases.
#[derive(Default)]
struct Tally {
    explained: usize,
    open: usize,
    /// Numbers that are wrong, of cases that it does not exclude, and how many of them the mistake gives.
    wrong: usize,
    given: usize,
    /// The bits that each output tells.
    by_output: Vec<f64>,
    /// Whether the mistake's own numbers of an output are others than the answers in some case.
    varies: Vec<bool>,
    foretold: Foretold,
}

/// So much of a count, rounded down.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a count of cases")]
fn part(share: f64, count: usize) -> usize {
    part_of(share, count) as usize
}

#[expect(clippy::cast_precision_loss, reason = "counts of cases are far below 2⁵³")]
fn part_of(each: f64, count: usize) -> f64 {
    each * count as f64
}

/// The mistakes that are tried in combination with another mistake or with a wrong parameter: all but those of rounding alone.
fn paired(member: &Member) -> Vec<Concerned> {
    concerned(member).iter().filter(|concerned| !concerned.fault.is_rounding).copied().collect()
}

/// The bits that it takes to say which one of a number of things is meant.
fn bits_of(count: usize) -> f64 {
    share(count.max(1), 1).log2()
}

/// Whether numbers lie within their intervals.
fn is_inside_f64(values: &[f64], legal: &[Accept]) -> bool {
    values.iter().zip(legal).all(|(&value, legal)| legal.contains(value))
}

/// An answer, and how far from it a value in f64 may be that is worth a closer look.
struct Near {
    inputs: Vec<f64>,
    values: Vec<f32>,
    reach: Vec<f64>,
    legal: Vec<Accept>,
    places: Range<usize>,
}

impl Near {
    fn new(member: &Member, row: &Answered<'_>, places: &Range<usize>) -> Option<Self> {
        if matches!(member.spec.kind, Kind::Raster(_)) {
            return None;
        }
        let reach = row.legal.iter().zip(row.values).map(|(legal, &value)| {
            let reach = 4096.0 * legal.width() + f64::from(value).abs() / 64.0;
            if reach.is_finite() { reach } else { f64::INFINITY }
        });
        let inputs = row.inputs.iter().map(|&x| x.into()).collect();
        let (values, legal, places) = (row.values.to_vec(), row.legal.to_vec(), places.clone());
        Some(Self { inputs, values, reach: reach.collect(), legal, places })
    }

    /// What the mistakes come to in f64.
    fn value(&self, variation: &Variation<'_>) -> Vec<f64> {
        let mut row = self.inputs.clone();
        let mut out = vec![0.0; variation.member.spec.output_len()];
        variation.evaluate_row(&mut row, &mut out);
        out.drain(..self.places.start);
        out.truncate(self.places.len());
        out
    }

    fn allows(&self, out: &[f64]) -> bool {
        let is_near = |((&value, out), reach): ((&f32, &f64), &f64)| {
            let apart = (f64::from(value) - out).abs();
            apart <= *reach || !apart.is_finite()
        };
        self.values.iter().zip(out).zip(&self.reach).all(is_near)
    }
}

/// A formula that is wrong in some way.
trait Wrong {
    /// The mistakes' names.
    fn faults(&self) -> Vec<&'static str>;
    /// Whether one of them is of rounding alone.
    fn is_rounding(&self) -> bool;
    /// Whether one of them follows from the formula's steps.
    fn is_generated(&self) -> bool;
    /// Whether such a one stands beside something else.
    fn is_composed(&self) -> bool;
    /// What it may legally answer.
    fn interval(&self, inputs: &[f32], profile: &Profile, out: &mut [Accept]);
    /// What it answers in f32.
    fn evaluate(&self, inputs: &[f32], out: &mut [f32]);
}

impl Wrong for Variation<'_> {
    fn faults(&self) -> Vec<&'static str> {
        self.faults.iter().map(|fault| fault.name).collect()
    }

    fn is_rounding(&self) -> bool {
        self.faults.iter().any(|fault| fault.is_rounding)
    }

    fn is_generated(&self) -> bool {
        self.faults.iter().any(|fault| fault.is_generated)
    }

    fn is_composed(&self) -> bool {
        self.faults.len() > 1 && self.is_generated()
    }

    fn interval(&self, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        Variation::interval(self, inputs, profile, out);
    }

    fn evaluate(&self, inputs: &[f32], out: &mut [f32]) {
        Variation::evaluate(self, inputs, out);
    }
}

impl Wrong for (&Variation<'_>, &Scaled) {
    fn faults(&self) -> Vec<&'static str> {
        self.0.faults()
    }

    fn is_rounding(&self) -> bool {
        self.0.is_rounding()
    }

    fn is_generated(&self) -> bool {
        self.0.is_generated()
    }

    fn is_composed(&self) -> bool {
        self.is_generated()
    }

    fn interval(&self, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        self.1.interval(self.0, inputs, profile, out);
    }

    fn evaluate(&self, inputs: &[f32], out: &mut [f32]) {
        self.1.evaluate(self.0, inputs, out);
    }
}
