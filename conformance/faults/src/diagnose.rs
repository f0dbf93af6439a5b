//! Which mistake a renderer made, from its answers: mistakes, pairs of them and wrong parameters are tried as explanations.

use super::catalogue::concerning;
use super::factor::{self, Scaled};
use super::fault::Fault;
use super::variation::Variation;
use lightmeter_arithmetic::{Accept, F32, Format as _, Profile};
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::Member;
use lightmeter_judge::diagnose::Answered;
use serde::Serialize;
use std::cmp::Ordering;

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
    /// Failing cases in which who makes the mistake may answer anything.
    pub open: usize,
    /// Passing cases whose answer would be too.
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
}

impl Diagnosis {
    /// The outcome where the failing cases are a sample of so many.
    #[must_use]
    pub fn sentence_of(&self, all: usize) -> String {
        if all == self.failing {
            return self.sentence.clone();
        }
        format!("in an even sample of the {all} failing cases, {}", self.sentence)
    }
}

/// Explanations that are kept.
const MOST_EXPLANATIONS: usize = 5;
/// The share of the failing cases that makes an explanation of them all; below, it is told as one of a part. Of the passing ones
/// so many must not contradict it.
const WHOLE: f64 = 0.9;
/// The share below which it is told as none.
const PART: f64 = 0.5;
/// The share of failing cases that lie inside, where the mistake promises something, at least.
const LEAST: f64 = 0.1;
/// Failing cases that a mistake is tried on first.
const PROBES: usize = 24;
/// Failing cases that a pair of mistakes is tried on first; all but one of them must be explained.
const PAIR_PROBES: usize = 8;

/// Tries what the catalogue knows as explanations of a renderer's answers to one formula.
///
/// Ranked by the failing cases that are explained, then by the passing ones that are consistent, then by how little is left
/// open, then single mistakes before pairs and both before wrong parameters, then in the order of the catalogue. Pairs,
/// parameters, and mistakes with a parameter are tried where no single mistake explains every failing case.
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
        if !trial.is_explained() {
            trial.faults_and_parameters();
        }
    }
    let mut explanations = trial.found;
    explanations.sort_by(better);
    explanations.truncate(MOST_EXPLANATIONS);
    Diagnosis {
        failing: failing.len(),
        passing: passing.len(),
        sentence: sentence(failing.len(), &explanations),
        explanations,
    }
}

/// The better of two explanations first.
fn better(a: &Explanation, b: &Explanation) -> Ordering {
    let many = |a: usize, b: usize| b.cmp(&a);
    // Single mistakes, pairs, parameters, mistakes with a parameter.
    let kind = |e: &Explanation| if e.parameter.is_some() { 3 + e.faults.len() } else { e.faults.len() };
    many(a.explained + a.open, b.explained + b.open)
        .then(many(a.explained, b.explained))
        .then(many(a.consistent, b.consistent))
        .then(a.openness.total_cmp(&b.openness))
        .then(kind(a).cmp(&kind(b)))
}

fn sentence(failing: usize, explanations: &[Explanation]) -> String {
    let cases = if failing == 1 { "case is" } else { "cases are" };
    match explanations.first() {
        _ if failing == 0 => "nothing fails".into(),
        None if failing == 1 => "nothing in the catalogue explains the failing case".into(),
        None => format!("nothing in the catalogue explains the {failing} failing cases"),
        Some(best) => {
            let Explanation { explained, open, .. } = best;
            let says = together(best, explanations);
            let told = format!("{explained} of {failing} failing {cases} explained by: {says}");
            let rest = failing - explained - open;
            match open {
                _ if share(explained + open, failing) < WHOLE => {
                    format!("{told}; nothing in the catalogue explains {rest} others")
                }
                0 => told,
                open => format!("{told}; in {open} it may give anything"),
            }
        }
    }
}

/// What the best explanation says, with the parameters that explain just as much by the same factor: nothing tells them apart.
fn together(best: &Explanation, explanations: &[Explanation]) -> String {
    let Some(scaled) = &best.parameter else { return best.says.clone() };
    let is_same = |other: &&Explanation| {
        let counts = |e: &Explanation| (e.explained, e.open, e.consistent);
        let factor = other.parameter.as_ref().map_or(f64::NAN, |other| other.factor);
        counts(other) == counts(best) && other.faults == best.faults && (factor / scaled.factor - 1.0).abs() < 1e-3
    };
    let names: Vec<&str> =
        explanations.iter().filter(is_same).filter_map(|e| Some(e.parameter.as_ref()?.name)).collect();
    // Before it may stand a mistake.
    let parts = best.says.split_once(&format!("as if {} ", scaled.name)).filter(|_| names.len() > 1);
    let Some((mistake, phrase)) = parts else { return best.says.clone() };
    format!("{mistake}as if {} (nothing tells which) {phrase}", names.join(" or "))
}

#[expect(clippy::cast_precision_loss, reason = "counts of cases are far below 2⁵³")]
pub(super) fn share(part: usize, whole: usize) -> f64 {
    part as f64 / whole as f64
}

/// What a row's answer says of the intervals of its outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fit {
    /// Every output lies in its interval, and one of them at least is bound to something.
    Inside,
    /// Nothing is promised.
    Open,
    /// An output lies outside.
    Outside,
}

/// Whether an answer is one that these intervals allow, and how much they leave open.
pub(super) fn fit(values: &[f32], legal: &[Accept]) -> (Fit, f64) {
    // What counts as the width of an interval that anything lies in.
    const WIDEST_ULP: f64 = 1e9;
    let (mut inside, mut bound, mut openness) = (true, false, 0.0);
    for (&value, legal) in values.iter().zip(legal) {
        inside &= legal.contains(value.into());
        bound |= !legal.is_any();
        let ulps = legal.width() / F32::ulp(f64::from(value)).max(F32::MIN_SUBNORMAL);
        openness += (1.0 + ulps.min(WIDEST_ULP)).log2();
    }
    let fit = match (inside, bound) {
        (false, _) => Fit::Outside,
        (true, false) => Fit::Open,
        (true, true) => Fit::Inside,
    };
    (fit, openness / share(values.len().max(1), 1))
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
        self.found.iter().any(|found| found.explained + found.open == self.failing.len())
    }

    /// So many of the failing cases, evenly spread.
    fn probes(&self, count: usize) -> impl Iterator<Item = &Answered<'_>> {
        self.failing.iter().step_by((self.failing.len() / count).max(1)).take(count)
    }

    /// How many of some failing cases lie outside the intervals, and how many are tried.
    fn contradicted(&self, count: usize, tried: &impl Wrong) -> (usize, usize) {
        let mut legal = vec![Accept::ANY; self.member.spec.output_len()];
        let (mut outside, mut seen) = (0, 0);
        for row in self.probes(count) {
            tried.interval(row.inputs, self.profile, &mut legal);
            outside += usize::from(fit(row.values, &legal).0 == Fit::Outside);
            seen += 1;
        }
        (outside, seen)
    }

    fn singles(&mut self) {
        for fault in concerning(&self.member.spec) {
            self.try_faults(&[fault], PROBES, |outside, tried| 2 * outside <= tried);
        }
    }

    fn pairs(&mut self) {
        let concerned: Vec<&'static Fault> = concerning(&self.member.spec).collect();
        for (place, first) in concerned.iter().enumerate() {
            for second in &concerned[place + 1..] {
                self.try_faults(&[first, second], PAIR_PROBES, |outside, _| outside <= 1);
            }
        }
    }

    fn try_faults(&mut self, faults: &[&'static Fault], probes: usize, is_likely: impl Fn(usize, usize) -> bool) {
        let Some(variation) = Variation::new(self.member, faults) else { return };
        let (outside, tried) = self.contradicted(probes, &variation);
        if is_likely(outside, tried) {
            let says = variation.says();
            self.take(&variation, says, None);
        }
    }

    /// Parameters, and the outputs themselves, some factor times what was asked.
    fn parameters(&mut self) {
        if !matches!(self.member.spec.kind, Kind::Raster(_)) {
            let right = Variation::right(self.member);
            factor::candidates(&right, self.failing, self.profile)
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
        let (member, profile) = (self.member, self.profile);
        let variations: Vec<Variation<'_>> =
            concerning(spec).filter_map(|fault| Variation::new(member, &[fault])).collect();
        for (variation, scaled) in factor::nearest(&variations, self.failing, profile) {
            self.try_scaled(variation, scaled);
        }
    }

    fn try_scaled(&mut self, variation: &Variation<'_>, scaled: Scaled) {
        let tried = (variation, &scaled);
        let (outside, probes) = self.contradicted(PROBES, &tried);
        if 2 * outside <= probes {
            let mistake = variation.says();
            let says = if mistake.is_empty() { scaled.says() } else { format!("{mistake}, and {}", scaled.says()) };
            self.take(&tried, says, Some(scaled.clone()));
        }
    }

    fn take(&mut self, tried: &impl Wrong, says: String, parameter: Option<Scaled>) {
        let outputs = self.member.spec.output_len();
        let (mut legal, mut own) = (vec![Accept::ANY; outputs], vec![0.0; outputs]);
        let (mut explained, mut open, mut consistent, mut openness) = (0, 0, 0, 0.0);
        let mut held = |row: &Answered<'_>| {
            tried.interval(row.inputs, self.profile, &mut legal);
            let (fit, left_open) = fit(row.values, &legal);
            openness += left_open;
            if fit == Fit::Open {
                // Where nothing is promised, an answer is explained by who computes just that.
                tried.evaluate(row.inputs, &mut own);
                let is_same = |(&a, &b): (&f32, &f32)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
                return if row.values.iter().zip(&own).all(is_same) { Fit::Inside } else { Fit::Open };
            }
            fit
        };
        for row in self.failing {
            match held(row) {
                Fit::Inside => explained += 1,
                Fit::Open => open += 1,
                Fit::Outside => {}
            }
        }
        for row in self.passing {
            consistent += usize::from(held(row) != Fit::Outside);
        }
        // What may give anything explains nothing by that alone, and what answers that pass contradict is not what was done.
        let (failing, passing) = (self.failing.len(), self.passing.len());
        let is_borne_out = passing == 0 || share(consistent, passing) >= WHOLE;
        if is_borne_out && share(explained + open, failing) >= PART && share(explained, failing) >= LEAST {
            let openness = openness / share(failing + passing, 1);
            let faults = tried.faults();
            self.found.push(Explanation { faults, says, parameter, explained, open, consistent, openness });
        }
    }
}

/// A formula that is wrong in some way.
trait Wrong {
    /// The mistakes' names.
    fn faults(&self) -> Vec<&'static str>;
    /// What it may legally answer.
    fn interval(&self, inputs: &[f32], profile: &Profile, out: &mut [Accept]);
    /// What it answers in f32.
    fn evaluate(&self, inputs: &[f32], out: &mut [f32]);
}

impl Wrong for Variation<'_> {
    fn faults(&self) -> Vec<&'static str> {
        self.faults.iter().map(|fault| fault.name).collect()
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

    fn interval(&self, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        self.1.interval(self.0, inputs, profile, out);
    }

    fn evaluate(&self, inputs: &[f32], out: &mut [f32]) {
        self.1.evaluate(self.0, inputs, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::formulas;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::select::CaseRef;
    use lightmeter_judge::{Outcome, judge};

    /// The diagnosis of an implementation of a formula, of 256 cases.
    fn diagnosis(id: &str, implementation: impl Fn(&Member, &[f32], &mut [f32])) -> (Diagnosis, Vec<Vec<f32>>) {
        let member = formulas().iter().find(|member| member.spec.id == id).expect(id);
        let outputs = member.spec.output_len();
        let (mut inputs, mut values, mut wrong) = (vec![], vec![], vec![]);
        for k in 0..256 {
            let (mut row, mut out) = (vec![], vec![0.0; outputs]);
            member.inputs(CaseRef::Random(k), 1, &mut row);
            implementation(member, &row, &mut out);
            let (mut reference, mut legal) = (vec![0.0; outputs], vec![Accept::ANY; outputs]);
            member.formula.reference(&row, &mut reference);
            member.formula.interval(&row, &WGSL, &mut legal);
            let fails = |k: usize| judge(out[k].to_bits(), reference[k], &legal[k]).outcome == Outcome::Fail;
            wrong.push((0..outputs).any(fails));
            inputs.push(row);
            values.push(out);
        }
        let rows: Vec<Answered<'_>> =
            (0..256).map(|k| Answered { inputs: &inputs[k], values: &values[k], is_wrong: wrong[k] }).collect();
        (diagnose(member, &rows, &WGSL), inputs)
    }

    fn making(names: &'static [&'static str]) -> impl Fn(&Member, &[f32], &mut [f32]) {
        let faults: Vec<&'static Fault> = names.iter().map(|name| Fault::by_name(name).expect(name)).collect();
        move |member, inputs, out| Variation::new(member, &faults).expect("they fit").evaluate(inputs, out)
    }

    #[test]
    fn a_mistake_is_told_in_a_sentence() {
        let (found, inputs) = diagnosis("fog/exp", making(&["fog-radial"]));
        let n = found.failing;
        assert!(n > 100, "{n}");
        assert_eq!(found.sentence, format!("{n} of {n} failing cases are explained by: fog uses radial distance"));
        assert_eq!(found.failing + found.passing, inputs.len());
    }

    #[test]
    fn two_mistakes_are_told_together() {
        let (found, _) = diagnosis("fog/exp2-opengl", making(&["fog-radial", "red-and-blue-swapped"]));
        assert_eq!(found.explanations[0].faults, ["fog-radial", "red-and-blue-swapped"], "{}", found.sentence);
    }

    #[test]
    fn a_wrong_parameter_is_told_with_its_factor() {
        for (id, name, factor, says) in [
            ("lighting/phong", "shininess", 2.5, "as if shininess were 2.50 times what was asked"),
            ("fog/linear", "dmax", 1.02, "as if dmax were 2.0 % larger"),
            ("lighting/point-blinn", "kq", 0.3, "as if kq were 0.300 times what was asked"),
        ] {
            let (found, _) = diagnosis(id, |member, inputs, out| {
                let mut row = inputs.to_vec();
                row[member.spec.place(name).expect(name)].iter_mut().for_each(|x| *x *= factor);
                member.formula.embedded(&row, out);
            });
            assert!(found.sentence.ends_with(says), "{}", found.sentence);
        }
    }

    #[test]
    fn a_mistake_and_a_wrong_parameter_are_told_together() {
        let (found, _) = diagnosis("fog/exp", |member, inputs, out| {
            let mut row = inputs.to_vec();
            row[member.spec.place("density").expect("density")].iter_mut().for_each(|x| *x *= 1.7);
            making(&["fog-radial"])(member, &row, out);
        });
        let n = found.failing;
        // |p| and the density are only seen as a product.
        let says = |which: &str| {
            format!("fog uses radial distance, and as if {which} (nothing tells which) were 1.70 times what was asked")
        };
        let told = ["density or p", "p or density"]
            .map(says)
            .map(|says| format!("{n} of {n} failing cases are explained by: {says}"));
        assert!(told.contains(&found.sentence), "{}", found.sentence);
    }

    #[test]
    fn parameters_that_nothing_tells_apart_are_told_together() {
        let (found, _) = diagnosis("lighting/diffuse-toward", |member, inputs, out| {
            member.formula.embedded(inputs, out);
            out.iter_mut().for_each(|x| *x *= 3.0);
        });
        assert!(found.sentence.contains("(nothing tells which) were 3.00 times"), "{}", found.sentence);
    }

    #[test]
    fn a_naive_form_is_told_and_no_number_is_explained_by_what_leaves_all_open() {
        let member = formulas().iter().find(|member| member.spec.id == "lighting/blinn-stable").expect("it is there");
        let naive = formulas().iter().find(|member| member.spec.id == "lighting/blinn").expect("it is there");
        let outputs = member.spec.output_len();
        let cases = (0..member.spec.hard.len()).map(CaseRef::Hard);
        let inputs: Vec<Vec<f32>> = cases
            .map(|case| {
                let mut row = vec![];
                member.inputs(case, 1, &mut row);
                row
            })
            .collect();
        let diagnosis = |answer: &dyn Fn(&[f32], &mut [f32])| {
            let values: Vec<Vec<f32>> = (inputs.iter())
                .map(|row| {
                    let mut out = vec![0.0; outputs];
                    answer(row, &mut out);
                    out
                })
                .collect();
            let is_wrong = |row: &[f32], values: &[f32]| {
                let (mut reference, mut legal) = (vec![0.0; outputs], vec![Accept::ANY; outputs]);
                member.formula.reference(row, &mut reference);
                member.formula.interval(row, &WGSL, &mut legal);
                (0..outputs).any(|k| judge(values[k].to_bits(), reference[k], &legal[k]).outcome == Outcome::Fail)
            };
            let rows = inputs.iter().zip(&values);
            let rows: Vec<Answered<'_>> =
                rows.map(|(inputs, values)| Answered { inputs, values, is_wrong: is_wrong(inputs, values) }).collect();
            diagnose(member, &rows, &WGSL)
        };
        let found = diagnosis(&|row, out| naive.formula.embedded(row, out));
        assert!(found.failing > 1 && found.explanations[0].faults == ["naive-form"], "{}", found.sentence);
        let found = diagnosis(&|_, out| out.fill(f32::INFINITY));
        assert!(found.failing > 1 && found.explanations.is_empty(), "{}", found.sentence);
    }

    #[test]
    fn what_nothing_explains_is_said_to_be_so() {
        let (found, _) = diagnosis("lighting/blinn", |_, inputs, out| {
            out.iter_mut().zip(inputs).for_each(|(out, x)| *out = (x * 1000.0).sin() * 7.0);
        });
        assert_eq!((found.explanations.len(), found.failing), (0, 256));
        assert!(
            found.sentence.starts_with("nothing in the catalogue explains the 256 failing cases"),
            "{}",
            found.sentence
        );
    }

    #[test]
    fn answers_that_are_no_numbers_or_too_short_are_borne() {
        let (found, _) = diagnosis("lighting/spot", |_, _, out| out.fill(f32::NAN));
        assert!(found.failing == 256 && found.explanations.is_empty(), "{}", found.sentence);
        let member = formulas().iter().find(|member| member.spec.id == "fog/exp").expect("fog/exp");
        let short = [Answered { inputs: &[1.0], values: &[], is_wrong: true }];
        assert_eq!(diagnose(member, &short, &WGSL).sentence, "nothing fails");
        assert_eq!(diagnose(member, &[], &WGSL).sentence, "nothing fails");
    }
}
