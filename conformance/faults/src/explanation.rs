//! What explains a renderer's wrong answers, ranked and told as a sentence.

use super::catalogue::faults;
use super::factor::Scaled;
use serde::Serialize;

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
    /// By how many bits it beats chance: how much it tells of the failing answers that the right formula does not, less what it
    /// takes to say which of all explanations it is.
    pub evidence: f64,
}

/// What a renderer did wrong in a formula.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Diagnosis {
    /// Cases that failed.
    pub failing: usize,
    /// Cases that passed.
    pub passing: usize,
    /// The best first; only those that explain nearly all of the failing cases.
    pub explanations: Vec<Explanation>,
    /// The simplest case that tells the best from the next that is not as good: the best explains its answer, that one does not.
    pub telling: Option<String>,
    /// The outcome as a sentence.
    pub sentence: String,
}

impl Diagnosis {
    /// What the best explanation says, and by which names the catalogue knows it.
    #[must_use]
    pub fn cause(&self) -> Option<String> {
        self.explanations.first().map(|best| told(best, &self.explanations))
    }

    /// The outcome where the failing cases are a sample of `all`.
    #[must_use]
    pub fn sentence_of(&self, all: usize) -> String {
        if all == self.failing {
            return self.sentence.clone();
        }
        format!("of {all} failing cases {} were looked at: {}", self.failing, self.sentence)
    }
}

/// Explanations that are kept.
const MOST_EXPLANATIONS: usize = 5;
/// The bits within which two explanations are equally good.
const EQUAL: f64 = 8.0;
/// Explanations beyond the best that are told as equally good.
const MOST_EQUAL: usize = 2;
/// Whether another explanation is as good as the best.
pub(super) fn is_equal(best: &Explanation, other: &Explanation) -> bool {
    (best.evidence - other.evidence).abs() <= EQUAL
}

/// Puts the best first: those with the most evidence, and of equally good ones the simplest, in the order of the catalogue.
pub(super) fn rank(explanations: &mut Vec<Explanation>) {
    let kind = |e: &Explanation| if e.parameter.is_some() { 3 + e.faults.len() } else { e.faults.len() };
    let order = |e: &Explanation| -> Vec<usize> {
        e.faults.iter().filter_map(|name| faults().iter().position(|fault| fault.name == *name)).collect()
    };
    explanations.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    let most = explanations.first().map_or(0.0, |best| best.evidence);
    let equal = explanations.partition_point(|e| most - e.evidence <= EQUAL);
    explanations[..equal].sort_by(|a, b| kind(a).cmp(&kind(b)).then_with(|| order(a).cmp(&order(b))));
    explanations.truncate(MOST_EXPLANATIONS);
}

pub(super) fn sentence(failing: usize, explanations: &[Explanation]) -> String {
    let cases = if failing == 1 { "case is" } else { "cases are" };
    let Some(best) = explanations.first() else { return "nothing fails".into() };
    let Explanation { explained, open, .. } = best;
    let mut told = format!("{explained} of {failing} failing {cases} explained by: {}", told(best, explanations));
    let equal = |other: &&Explanation| {
        other.parameter.is_none() && other.faults.len() <= best.faults.len() && is_equal(best, other)
    };
    for other in explanations.iter().skip(1).filter(equal).take(MOST_EQUAL) {
        told = format!("{told}; or just as well by: {}{}", other.says, called(&other.faults));
    }
    match open {
        0 => told,
        open => format!("{told}; in {open} of them whoever makes this mistake may answer anything"),
    }
}

/// What the best explanation says, and its mistakes' names.
fn told(best: &Explanation, explanations: &[Explanation]) -> String {
    together(best, explanations) + &called(&best.faults)
}

/// The names under which `lightmeter mistakes` and `--mistake` know what explains answers.
pub(super) fn called(names: &[&str]) -> String {
    if names.is_empty() { String::new() } else { format!(" ({})", names.join(" and ")) }
}

/// What the best explanation says, with the parameters that explain just as much by the same factor: nothing tells them apart.
fn together(best: &Explanation, explanations: &[Explanation]) -> String {
    let Some(scaled) = &best.parameter else { return best.says.clone() };
    let is_same = |other: &&Explanation| {
        let counts = |e: &Explanation| (e.explained, e.open, e.consistent);
        let factor = other.parameter.as_ref().map_or(f64::NAN, |other| other.factor);
        counts(other) == counts(best) && other.faults == best.faults && (factor / scaled.factor - 1.0).abs() < 1e-3
    };
    let mut names: Vec<&str> =
        explanations.iter().filter(is_same).filter_map(|e| Some(e.parameter.as_ref()?.name)).collect();
    // An input and an output may have the same name.
    names.dedup();
    // Before it may stand a mistake.
    let parts = best.says.split_once(&format!("as if {} ", scaled.name)).filter(|_| names.len() > 1);
    let Some((mistake, phrase)) = parts else { return best.says.clone() };
    format!("{mistake}as if {} (nothing tells which) {phrase}", names.join(" or "))
}
