//! What explains a renderer's wrong answers, ranked.

use super::catalogue::place_of;
use super::factor::Scaled;
use lightmeter_document::Word;
use lightmeter_document::report::{Diagnosis, Explanation, Standing, WrongParameter};
use serde::Serialize;
use std::ops::Range;

/// What may have been done in a formula's place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TriedMistake {
    /// The mistake's name, or those of a pair; none for a wrong parameter.
    pub faults: Vec<&'static str>,
    /// In words, as the end of a sentence.
    pub says: String,
    /// What its mistakes alone say, where it has any.
    pub mistake: Option<String>,
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
pub struct FormulaDiagnosis {
    /// Cases that failed.
    pub failing: usize,
    /// Cases that passed.
    pub passing: usize,
    /// The best first; only those that explain nearly all of the failing cases.
    pub explanations: Vec<TriedMistake>,
    /// What a report says of it, of these cases alone.
    pub diagnosis: Diagnosis,
    /// Where nothing explains whole answers: the places of each output that is wrong, and what explains it by itself.
    #[serde(skip)]
    pub parts: Vec<(Range<usize>, Vec<TriedMistake>)>,
}

/// Explanations that are kept.
const MOST_EXPLANATIONS: usize = 5;
/// The bits within which two explanations are equally good.
const EQUAL: f64 = 8.0;
/// Whether another explanation is as good as the best.
pub(super) fn is_equal(best: &TriedMistake, other: &TriedMistake) -> bool {
    (best.evidence - other.evidence).abs() <= EQUAL
}

/// Puts the best first: those with the most evidence, and of equally good ones the simplest, in the order of the catalogue.
///
/// What makes a difference in so few cases as may be off is no part of the first: an explanation that lacks it alone comes before.
pub(super) fn rank(explanations: &mut Vec<TriedMistake>, most_off: usize) {
    let kind = |e: &TriedMistake| if e.parameter.is_some() { 3 + e.faults.len() } else { e.faults.len() };
    let order = |e: &TriedMistake| -> Vec<usize> { e.faults.iter().filter_map(|name| place_of(name)).collect() };
    explanations.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    let most = explanations.first().map_or(0.0, |best| best.evidence);
    let equal = explanations.partition_point(|e| most - e.evidence <= EQUAL);
    explanations[..equal].sort_by(|a, b| kind(a).cmp(&kind(b)).then_with(|| order(a).cmp(&order(b))));
    if let Some(best) = explanations.first() {
        let accounts = |e: &TriedMistake| e.explained + e.open;
        let simpler = |e: &TriedMistake| e.is_part_of(best) && accounts(e) + most_off >= accounts(best);
        let simplest = explanations.iter().enumerate().filter(|(_, e)| simpler(e)).min_by_key(|(_, e)| kind(e));
        if let Some((place, _)) = simplest {
            explanations[..=place].rotate_right(1);
        }
    }
    explanations.truncate(MOST_EXPLANATIONS);
}

/// Explanations as a report has them, each with its place among the ranked: the best first, of which parameters that explain just as much by
/// the same factor are one.
pub(super) fn told(ranked: &[TriedMistake]) -> Vec<(usize, Explanation)> {
    let Some(best) = ranked.first() else { return vec![] };
    let others = ranked.iter().enumerate().skip(1).filter(|(_, other)| !is_same(best, other));
    let standing = |other: &TriedMistake| {
        let is_as_simple = other.parameter.is_none() && other.faults.len() <= best.faults.len();
        if is_as_simple && is_equal(best, other) { Standing::Equal } else { Standing::Next }
    };
    let first = best.told(Standing::Best, together(best, ranked));
    let others = others.map(|(place, other)| {
        let own = other.parameter.iter().map(|scaled| scaled.name.to_owned()).collect();
        (place, other.told(standing(other), (other.says.clone(), own)))
    });
    std::iter::once((0, first)).chain(others).collect()
}

impl TriedMistake {
    /// Whether another one has all that it has, and more.
    fn is_part_of(&self, other: &Self) -> bool {
        let has_parameter = self.parameter.is_some();
        let is_less = self.faults.len() < other.faults.len() || !has_parameter && other.parameter.is_some();
        is_less
            && !self.faults.is_empty()
            && !has_parameter
            && self.faults.iter().all(|name| other.faults.contains(name))
    }

    fn told(&self, standing: Standing, (says, names): (String, Vec<String>)) -> Explanation {
        Explanation {
            says,
            mistakes: self.faults.iter().map(|name| Word::from(*name)).collect(),
            parameter: self.parameter.as_ref().map(|scaled| WrongParameter { names, factor: scaled.factor }),
            explained: self.explained as u64,
            open: self.open as u64,
            standing,
        }
    }
}

/// Whether another explanation differs in nothing but which parameter is meant.
fn is_same(best: &TriedMistake, other: &TriedMistake) -> bool {
    let Some([scaled, others]) = best.parameter.as_ref().zip(other.parameter.as_ref()).map(|(a, b)| [a, b]) else {
        return false;
    };
    let counts = |e: &TriedMistake| (e.explained, e.open, e.consistent);
    counts(other) == counts(best) && other.faults == best.faults && (others.factor / scaled.factor - 1.0).abs() < 1e-3
}

/// What the best explanation says, with the parameters that explain just as much by the same factor: nothing tells them apart.
fn together(best: &TriedMistake, ranked: &[TriedMistake]) -> (String, Vec<String>) {
    let Some(scaled) = &best.parameter else { return (best.says.clone(), vec![]) };
    let same = ranked.iter().filter(|other| is_same(best, other));
    let mut names: Vec<String> = same.filter_map(|e| Some(e.parameter.as_ref()?.name.to_owned())).collect();
    // An input and an output may have the same name.
    names.dedup();
    if names.len() < 2 {
        return (best.says.clone(), names);
    }
    let mistake = best.mistake.as_ref().map(|mistake| format!("{mistake}, and ")).unwrap_or_default();
    let which = format!("{} (nothing tells which)", names.join(" or "));
    (format!("{mistake}{}", scaled.says_of(&which)), names)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tried(faults: &[&'static str], explained: usize, evidence: f64) -> TriedMistake {
        let (says, mistake, parameter) = (faults.join(", and "), None, None);
        let faults = faults.to_vec();
        TriedMistake { faults, says, mistake, parameter, explained, open: 0, consistent: 0, evidence }
    }

    #[test]
    fn a_mistake_that_hardly_matters_is_no_part_of_the_first_explanation() {
        let first = |alone: usize, most_off: usize| {
            let mut explanations =
                vec![tried(&["fog-radial"], alone, 900.0), tried(&["fog-radial", "fog-twice"], 1000, 1900.0)];
            rank(&mut explanations, most_off);
            explanations[0].faults.clone()
        };
        assert_eq!(first(990, 15), ["fog-radial"]);
        assert_eq!(first(980, 15), ["fog-radial", "fog-twice"]);
    }
}
