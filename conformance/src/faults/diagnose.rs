//! Which mistake a renderer made, from its answers: mistakes, pairs of them and wrong parameters are tried as explanations.

use super::catalogue::{Fault, concerning};
use super::factor::{self, Scaled};
use super::variation::Variation;
use crate::arithmetic::{Accept, F32, Format as _, Profile};
use crate::cases::Kind;
use crate::select::Member;
use serde::Serialize;
use std::cmp::Ordering;

/// A renderer's answer to one case.
#[derive(Clone, Copy, Debug)]
pub struct Answered<'a> {
    /// The case's inputs.
    pub inputs: &'a [f32],
    /// What the renderer answered.
    pub values: &'a [f32],
    /// Whether a verdict on it failed.
    pub is_wrong: bool,
}

/// What may have been done in a formula's place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// The mistake's name, or those of a pair; none for a wrong parameter.
    pub faults: Vec<&'static str>,
    /// In words, as the end of a sentence.
    pub says: String,
    /// The parameter that is wrong, and how many times what was asked it seems to be.
    pub parameter: Option<Scaled>,
    /// Failing cases whose answer is legal for who makes the mistake.
    pub explained: usize,
    /// Passing cases whose answer is.
    pub consistent: usize,
    /// How much the mistake leaves open: the mean of log₂(1 + the interval's width in ULP).
    pub openness: f64,
}

/// What a renderer did wrong in a formula.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Diagnosis {
    /// Cases that failed.
    pub failing: usize,
    /// Cases that passed.
    pub passing: usize,
    /// The best first; only those that explain half of the failing cases or more.
    pub explanations: Vec<Explanation>,
    /// The outcome as a sentence.
    pub sentence: String,
    /// Which of the failing cases has the simplest inputs, by its place among the rows.
    pub smallest: Option<usize>,
}

/// Explanations that are kept.
const MOST_EXPLANATIONS: usize = 5;
/// The share of the failing cases that makes an explanation of them all; below, it is told as one of a part.
const WHOLE: f64 = 0.9;
/// The share below which it is told as none.
const PART: f64 = 0.5;
/// Failing cases that a mistake is tried on first.
const PROBES: usize = 24;
/// Failing cases that a pair of mistakes is tried on first; all but one of them must be explained.
const PAIR_PROBES: usize = 8;

/// Tries what the catalogue knows as explanations of a renderer's answers to one formula.
///
/// Ranked by the failing cases that are explained, then by the passing ones that are consistent, then by how little is left
/// open, then single mistakes before pairs and both before wrong parameters, then in the order of the catalogue. Pairs and
/// parameters are tried where no single mistake explains every failing case.
#[must_use]
pub fn diagnose(member: &Member, rows: &[Answered<'_>], profile: &Profile) -> Diagnosis {
    let spec = &member.spec;
    let fits = |row: &&Answered<'_>| row.inputs.len() == spec.input_len() && row.values.len() == spec.output_len();
    let failing: Vec<Answered<'_>> = rows.iter().filter(fits).filter(|row| row.is_wrong).copied().collect();
    let passing: Vec<Answered<'_>> = rows.iter().filter(fits).filter(|row| !row.is_wrong).copied().collect();
    let mut trial = Trial { member, profile, failing: &failing, passing: &passing, found: vec![] };
    if !failing.is_empty() {
        trial.singles();
        if !trial.is_explained() {
            trial.pairs();
            trial.parameters();
        }
    }
    let mut explanations = trial.found;
    explanations.sort_by(better);
    explanations.truncate(MOST_EXPLANATIONS);
    Diagnosis {
        failing: failing.len(),
        passing: passing.len(),
        sentence: sentence(failing.len(), explanations.first()),
        explanations,
        smallest: smallest(rows),
    }
}

/// The better of two explanations first.
fn better(a: &Explanation, b: &Explanation) -> Ordering {
    let many = |a: usize, b: usize| b.cmp(&a);
    // Parameters last, then pairs.
    let kind = |e: &Explanation| if e.parameter.is_some() { 3 } else { e.faults.len() };
    many(a.explained, b.explained)
        .then(many(a.consistent, b.consistent))
        .then(a.openness.total_cmp(&b.openness))
        .then(kind(a).cmp(&kind(b)))
}

fn sentence(failing: usize, best: Option<&Explanation>) -> String {
    let cases = if failing == 1 { "case is" } else { "cases are" };
    match best {
        _ if failing == 0 => "nothing fails".into(),
        None => format!("nothing in the catalogue explains the failing cases, of which there are {failing}"),
        Some(best) => {
            let Explanation { explained, says, .. } = best;
            let told = format!("{explained} of {failing} failing {cases} explained by: {says}");
            if share(*explained, failing) < WHOLE {
                let rest = failing - explained;
                format!("{told}; nothing in the catalogue explains the other {rest}")
            } else {
                told
            }
        }
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts of cases are far below 2⁵³")]
pub(super) fn share(part: usize, whole: usize) -> f64 {
    part as f64 / whole as f64
}

/// The failing case whose inputs take the least to write down.
fn smallest(rows: &[Answered<'_>]) -> Option<usize> {
    let digits = |x: f32| match x.abs() {
        0.0 => 0,
        1.0 => 1,
        x if x.is_finite() => 26 - x.to_bits().trailing_zeros().min(23),
        _ => 64,
    };
    let failing = rows.iter().enumerate().filter(|(_, row)| row.is_wrong);
    failing.min_by_key(|(_, row)| row.inputs.iter().map(|&x| digits(x)).sum::<u32>()).map(|(place, _)| place)
}

/// What a row's answer says of an interval of each output.
pub(super) struct Fit {
    /// Every output lies in its interval, and one of them at least is bound to.
    pub(super) is_explained: bool,
    openness: f64,
}

/// Whether an answer is one that these intervals allow.
pub(super) fn fit(values: &[f32], legal: &[Accept]) -> Fit {
    let mut openness = 0.0;
    let (mut inside, mut bound) = (true, false);
    for (&value, legal) in values.iter().zip(legal) {
        inside &= legal.contains(value.into());
        // A value that is no number is bound by nothing more than that nothing is promised.
        bound |= !legal.is_any() || !value.is_finite();
        let ulps =
            if legal.is_any() { 1e9 } else { legal.width() / F32::ulp(f64::from(value)).max(F32::MIN_SUBNORMAL) };
        openness += (1.0 + ulps.min(1e9)).log2();
    }
    Fit { is_explained: inside && bound, openness: openness / share(values.len().max(1), 1) }
}

struct Trial<'a> {
    member: &'a Member,
    profile: &'a Profile,
    failing: &'a [Answered<'a>],
    passing: &'a [Answered<'a>],
    found: Vec<Explanation>,
}

impl Trial<'_> {
    fn is_explained(&self) -> bool {
        self.found.iter().any(|found| found.explained == self.failing.len())
    }

    /// So many of the failing cases, evenly spread.
    fn probes(&self, count: usize) -> impl Iterator<Item = &Answered<'_>> {
        self.failing.iter().step_by((self.failing.len() / count).max(1)).take(count)
    }

    fn counts(&self, count: usize, interval: impl Fn(&[f32], &mut [Accept])) -> (usize, usize) {
        let mut legal = vec![Accept::ANY; self.member.spec.output_len()];
        let (mut explained, mut tried) = (0, 0);
        for row in self.probes(count) {
            interval(row.inputs, &mut legal);
            explained += usize::from(fit(row.values, &legal).is_explained);
            tried += 1;
        }
        (explained, tried)
    }

    fn singles(&mut self) {
        for fault in concerning(&self.member.spec) {
            self.try_faults(&[fault], PROBES, |explained, tried| 2 * explained >= tried);
        }
    }

    fn pairs(&mut self) {
        let concerned: Vec<&'static Fault> = concerning(&self.member.spec).collect();
        for (place, first) in concerned.iter().enumerate() {
            for second in &concerned[place + 1..] {
                self.try_faults(&[first, second], PAIR_PROBES, |explained, tried| explained + 1 >= tried);
            }
        }
    }

    fn try_faults(&mut self, faults: &[&'static Fault], probes: usize, is_likely: impl Fn(usize, usize) -> bool) {
        let Some(variation) = Variation::new(self.member, faults) else { return };
        let interval = |inputs: &[f32], out: &mut [Accept]| variation.interval(inputs, self.profile, out);
        let (explained, tried) = self.counts(probes, interval);
        if !is_likely(explained, tried) {
            return;
        }
        let names = faults.iter().map(|fault| fault.name).collect();
        let says = faults.iter().map(|fault| fault.says).collect::<Vec<_>>().join(", and ");
        self.take(names, says, None, interval);
    }

    /// Parameters, and the outputs themselves, some factor times what was asked.
    fn parameters(&mut self) {
        if matches!(self.member.spec.kind, Kind::Raster(_)) {
            return;
        }
        for scaled in factor::candidates(self.member, self.failing, self.profile) {
            let says = scaled.says();
            let (member, profile) = (self.member, self.profile);
            let interval = |inputs: &[f32], out: &mut [Accept]| scaled.interval(member, inputs, profile, out);
            let (explained, tried) = self.counts(PROBES, interval);
            if 2 * explained >= tried {
                self.take(vec![], says, Some(scaled.clone()), interval);
            }
        }
    }

    fn take(
        &mut self,
        faults: Vec<&'static str>,
        says: String,
        parameter: Option<Scaled>,
        interval: impl Fn(&[f32], &mut [Accept]),
    ) {
        let mut legal = vec![Accept::ANY; self.member.spec.output_len()];
        let (mut counts, mut openness) = ([0, 0], 0.0);
        for (count, rows) in counts.iter_mut().zip([self.failing, self.passing]) {
            for row in rows {
                interval(row.inputs, &mut legal);
                let fit = fit(row.values, &legal);
                *count += usize::from(fit.is_explained);
                openness += fit.openness;
            }
        }
        let [explained, consistent] = counts;
        if share(explained, self.failing.len()) >= PART {
            let openness = openness / share(self.failing.len() + self.passing.len(), 1);
            self.found.push(Explanation { faults, says, parameter, explained, consistent, openness });
        }
    }
}
