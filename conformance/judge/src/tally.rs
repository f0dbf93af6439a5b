//! Verdicts counted: of the cases of formulas, of the pixels of blend units and images, and of other renderers' answers.
//!
//! Tallies of parts add up to the tally of the whole, whatever the parts and their order, so that threads, chunks and shards
//! can be put together. What is kept of some cases only, the worst and the first to fail, is therefore kept by their places.

use crate::{Outcome, is_worse, worse};
use lightmeter_document::report::{Problem, ProblemKind, Totals};
use std::collections::BTreeMap;
use std::iter::Sum;

/// Failures that are kept: the first by their places.
pub const KEPT: usize = 16;
/// Failures that are reported of each group.
pub const KEPT_FAILURES: usize = 5;

/// Counts of verdicts, and the cases to report. `P` is a case's place in the order of its group, `F` what a report says of a failure.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally<P, F = ()> {
    /// The counts.
    pub totals: Totals,
    /// Verdicts of random cases, and the indeterminate ones among them.
    pub random: (u64, u64),
    /// The greatest error.
    pub error_max: f64,
    /// The greatest margin, and where: of equal ones the first.
    pub worst: Option<(f64, P)>,
    /// The first failures.
    pub failures: BTreeMap<P, F>,
    /// The failure of the simplest inputs, and how simple they are: of equally simple ones the first.
    pub simplest: Option<(u32, P, F)>,
    /// Verdicts that each named deviation excused.
    pub excused: BTreeMap<&'static str, u64>,
}

impl<P, F> Default for Tally<P, F> {
    fn default() -> Self {
        Self {
            totals: Totals::default(),
            random: (0, 0),
            error_max: 0.0,
            worst: None,
            failures: BTreeMap::new(),
            simplest: None,
            excused: BTreeMap::new(),
        }
    }
}

impl<P: Ord + Clone, F: Clone> Tally<P, F> {
    /// Counts a verdict. Where it is that of a failure, a named deviation may excuse it.
    pub fn count(&mut self, outcome: Outcome, excused: Option<&'static str>, is_random: bool) {
        match excused.filter(|_| outcome == Outcome::Fail) {
            None => self.count_many(outcome, 1, is_random),
            Some(name) => {
                self.totals.verdicts += 1;
                self.random.0 += u64::from(is_random);
                self.totals.expected_failures += 1;
                *self.excused.entry(name).or_default() += 1;
            }
        }
    }

    /// Counts verdicts of one outcome, none of them excused.
    pub fn count_many(&mut self, outcome: Outcome, many: u64, are_random: bool) {
        let random = if are_random { many } else { 0 };
        self.totals.verdicts += many;
        self.random.0 += random;
        match outcome {
            Outcome::Pass => self.totals.passed += many,
            Outcome::Fail => self.totals.failed += many,
            Outcome::Indeterminate => {
                self.totals.indeterminate += many;
                self.random.1 += random;
            }
        }
    }

    /// Keeps an error where it is the greatest.
    pub fn see_error(&mut self, error: f64) {
        self.error_max = worse(self.error_max, error);
    }

    /// Keeps a margin where it is the greatest, and says whether it is.
    pub fn see_margin(&mut self, margin: f64, place: P) -> bool {
        match &self.worst {
            // Most margins are smaller: told by one comparison.
            Some((most, _)) if margin < *most => false,
            Some((most, first)) if !is_worse(margin, *most) && (is_worse(*most, margin) || place >= *first) => false,
            _ => {
                self.worst = Some((margin, place));
                true
            }
        }
    }

    /// Keeps a failure where it is among the first, or that of the simplest inputs.
    pub fn fail(&mut self, place: P, simplicity: u32, failure: impl FnOnce() -> F) {
        let (is_first, is_simplest) = (self.is_among_the_first(&place), self.is_simplest(simplicity, &place));
        if is_first || is_simplest {
            let failure = failure();
            if is_simplest {
                self.simplest = Some((simplicity, place.clone(), failure.clone()));
            }
            if is_first {
                self.keep(place, failure);
            }
        }
    }

    fn is_among_the_first(&self, place: &P) -> bool {
        self.failures.len() < KEPT || self.failures.last_key_value().is_some_and(|(last, _)| place < last)
    }

    fn is_simplest(&self, simplicity: u32, place: &P) -> bool {
        self.simplest.as_ref().is_none_or(|(least, first, _)| (simplicity, place) < (*least, first))
    }

    /// Keeps a failure where it is among the first; of how simple its inputs are nothing is said.
    pub fn fail_in_turn(&mut self, place: P, failure: impl FnOnce() -> F) {
        if self.is_among_the_first(&place) {
            self.keep(place, failure());
        }
    }

    fn keep(&mut self, place: P, failure: F) {
        self.failures.insert(place, failure);
        if self.failures.len() > KEPT {
            self.failures.pop_last();
        }
    }

    /// Adds another part.
    pub fn add(&mut self, other: Self) {
        self.totals.add(&other.totals);
        self.random.0 += other.random.0;
        self.random.1 += other.random.1;
        self.see_error(other.error_max);
        if let Some((margin, place)) = other.worst {
            self.see_margin(margin, place);
        }
        for (place, failure) in other.failures {
            self.keep(place, failure);
        }
        if let Some((simplicity, place, failure)) = other.simplest
            && self.is_simplest(simplicity, &place)
        {
            self.simplest = Some((simplicity, place, failure));
        }
        for (name, count) in other.excused {
            *self.excused.entry(name).or_default() += count;
        }
    }

    /// The same in the places of a greater whole, which are in the same order, with what is kept there.
    #[must_use]
    pub fn within<Q: Ord, G>(&self, place: impl Fn(&P) -> Q, kept: impl Fn(&P, &F) -> G) -> Tally<Q, G> {
        Tally {
            totals: self.totals,
            random: self.random,
            error_max: self.error_max,
            worst: self.worst.as_ref().map(|(margin, worst)| (*margin, place(worst))),
            failures: self.failures.iter().map(|(at, one)| (place(at), kept(at, one))).collect(),
            simplest: self.simplest.as_ref().map(|(least, at, one)| (*least, place(at), kept(at, one))),
            excused: self.excused.clone(),
        }
    }

    /// The failures in the order in which they are reported: the one of the simplest inputs, which explains most, then the first, without those
    /// that are the same case.
    pub fn reported(self, is_same: impl Fn(&P, &P) -> bool) -> impl Iterator<Item = (P, F)> {
        let simplest = self.simplest.map(|(_, place, failure)| (place, failure));
        let first = simplest.as_ref().map(|(place, _)| place.clone());
        let others = self.failures.into_iter();
        simplest
            .into_iter()
            .chain(others.filter(move |(place, _)| first.as_ref().is_none_or(|one| !is_same(one, place))))
    }

    /// What is wrong with all verdicts together: more than 1 % of them indeterminate, hard cases apart, make a run of little.
    #[must_use]
    pub fn problem(&self) -> Option<Problem> {
        problem(self.random, self.totals.verdicts, self.totals.indeterminate)
    }
}

impl<P: Ord + Clone, F: Clone> Sum for Tally<P, F> {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        parts.fold(Self::default(), |mut sum, part| {
            sum.add(part);
            sum
        })
    }
}

/// The share of indeterminate verdicts, hard cases apart, above which a group fails.
const MOST_INDETERMINATE: f64 = 0.01;

/// The group verdict on indeterminate values.
#[must_use]
pub fn problem(random: (u64, u64), verdicts: u64, indeterminate: u64) -> Option<Problem> {
    #[expect(clippy::cast_precision_loss, reason = "a share")]
    let share = random.1 as f64 / random.0.max(1) as f64;
    if share > MOST_INDETERMINATE {
        let says =
            format!("{:.1} % of the verdicts are indeterminate, hard cases apart; at most 1 % may be", 100.0 * share);
        return Some(Problem::new(ProblemKind::Indeterminate, says));
    }
    let is_nothing = random.0 > 0 && indeterminate == verdicts;
    is_nothing.then(|| Problem::new(ProblemKind::Indeterminate, "nothing but indeterminate verdicts"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A verdict: the place of its case, the outcome, the error, the margin and how simple the inputs are.
    fn verdicts() -> impl Strategy<Value = Vec<(u32, u8, u8, u8, u32)>> {
        proptest::collection::vec((0..200_u32, 0..4_u8, 0..4_u8, 0..5_u8, 0..6_u32), 0..120)
    }

    fn tally(verdicts: &[(u32, u8, u8, u8, u32)]) -> Tally<u32, String> {
        let mut tally = Tally::default();
        for &(place, outcome, error, margin, simplicity) in verdicts {
            let (outcome, excused) = match outcome {
                0 => (Outcome::Pass, None),
                1 => (Outcome::Indeterminate, None),
                2 => (Outcome::Fail, Some(if place % 2 == 0 { "flushed" } else { "saturated" })),
                _ => (Outcome::Fail, None),
            };
            tally.totals.cases += 1;
            tally.count(outcome, excused, place % 3 > 0);
            tally.see_error(f64::from(error));
            // The greatest of them is infinite.
            tally.see_margin(if margin == 4 { f64::INFINITY } else { f64::from(margin) }, place);
            if outcome == Outcome::Fail && excused.is_none() {
                tally.fail(place, simplicity, || format!("case {place}"));
            }
        }
        tally
    }

    proptest! {
        #[test]
        fn parts_add_up_to_the_whole_in_any_order(all in verdicts(), cut in 0..120_usize, other in 0..120_usize) {
            let (first, last) = (cut.min(other).min(all.len()), cut.max(other).min(all.len()));
            let parts = [&all[..first], &all[first..last], &all[last..]].map(tally);
            for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                let sum: Tally<u32, String> = order.into_iter().map(|part| parts[part].clone()).sum();
                prop_assert_eq!(&sum, &tally(&all));
            }
            let nested = {
                let mut last = parts[1].clone();
                last.add(parts[2].clone());
                let mut sum = parts[0].clone();
                sum.add(last);
                sum
            };
            prop_assert_eq!(nested, tally(&all));
        }
    }

    #[test]
    fn the_first_failures_are_kept_whenever_they_come() {
        let mut tally: Tally<usize> = Tally::default();
        for place in (0..100).rev() {
            tally.fail(place, 7, || ());
        }
        assert!(tally.failures.into_keys().eq(0..KEPT));
        assert_eq!(tally.simplest, Some((7, 0, ())), "of equally simple ones the first");
    }
}
