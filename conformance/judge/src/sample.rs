//! A random sample of rows, with an upper limit. Each row is as likely to be kept as any other, and the same rows are kept in whatever
//! order they come.

use lightmeter_catalogue::cases::mix;
use lightmeter_catalogue::select::CaseRef;
use rayon::prelude::*;

/// A number for a case of a formula, which has one itself. It does not depend on which other formulas are judged, so that shards keep the same
/// cases.
#[must_use]
pub fn row_number(formula: u64, case: CaseRef) -> u64 {
    let [kind, first, second] = match case {
        CaseRef::Hard(place) => [1, place as u64, 0],
        CaseRef::Near(place, k) => [2, place as u64, k],
        CaseRef::Random(k) => [3, k, 0],
        CaseRef::Boundary(k) => [4, k, 0],
    };
    [kind, first, second].into_iter().fold(mix(formula), |number, part| mix(number ^ part))
}

/// Rows with what is kept of each. It keeps those whose places have the least hashes, which no order of arrival changes.
#[derive(Clone, Debug)]
pub struct Sample<P, V> {
    /// Hash and place of each row that is kept, and what is kept of it.
    rows: Vec<(u64, P, V)>,
    most: usize,
    /// How many rows came.
    pub seen: u64,
    /// Rows with a greater hash are not kept.
    bound: u64,
}

impl<P: Copy + Ord, V> Sample<P, V> {
    /// An empty sample, which keeps at most `most` rows.
    #[must_use]
    pub const fn new(most: usize) -> Self {
        Self { rows: vec![], most, seen: 0, bound: u64::MAX }
    }

    /// An empty one to be added to this one later, which keeps nothing that this one would not.
    #[must_use]
    pub const fn part<W>(&self) -> Sample<P, W> {
        Sample { rows: vec![], most: self.most, seen: 0, bound: self.bound }
    }

    /// Takes a row, which has a number that another one hardly ever has.
    pub fn push(&mut self, place: P, number: u64, kept: impl FnOnce() -> V) {
        self.seen += 1;
        let hash = mix(number);
        if hash <= self.bound {
            self.rows.push((hash, place, kept()));
            self.thin(2 * self.most);
        }
    }

    /// Takes all rows of another part.
    pub fn add(&mut self, other: Self) {
        self.seen += other.seen;
        self.rows.extend(other.rows);
        self.thin(2 * self.most);
    }

    /// Where more than `room` rows are kept, only those of the least hashes stay.
    fn thin(&mut self, room: usize) {
        if self.rows.len() <= room {
            return;
        }
        self.rows.select_nth_unstable_by_key(self.most, |(hash, place, _)| (*hash, *place));
        self.rows.truncate(self.most);
        self.bound = self.rows.iter().map(|(hash, ..)| *hash).max().unwrap_or(0);
    }

    /// The rows in the order of their places, each with what is kept of it; at most as many as were asked for.
    #[must_use]
    pub fn rows(&self) -> Vec<(P, &V)> {
        let mut order: Vec<&(u64, P, V)> = self.rows.iter().collect();
        order.sort_unstable_by_key(|(hash, place, _)| (*hash, *place));
        order.truncate(self.most);
        let mut rows: Vec<(P, &V)> = order.into_iter().map(|(_, place, kept)| (*place, kept)).collect();
        rows.sort_unstable_by_key(|(place, _)| *place);
        rows
    }

    /// Whether it has the rows of another sample, each with the same of it.
    #[must_use]
    pub fn is_like(&self, other: &Self, is_same: impl Fn(&V, &V) -> bool) -> bool {
        let (own, others) = (self.rows(), other.rows());
        self.seen == other.seen
            && own.len() == others.len()
            && own.iter().zip(&others).all(|(a, b)| a.0 == b.0 && is_same(a.1, b.1))
    }

    /// The same rows with something else of each, worked out on all cores.
    #[must_use]
    pub fn with<W: Send>(mut self, kept: impl Fn(P, V) -> W + Sync) -> Sample<P, W>
    where
        P: Send,
        V: Send,
    {
        self.thin(self.most);
        let rows = self.rows.into_par_iter().map(|(hash, place, value)| (hash, place, kept(place, value)));
        Sample { rows: rows.collect(), most: self.most, seen: self.seen, bound: self.bound }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sample(places: &[usize]) -> Sample<usize, usize> {
        let mut sample = Sample::new(8);
        places.iter().for_each(|&place| sample.push(place, place as u64, || 3 * place));
        sample
    }

    proptest! {
        #[test]
        fn the_same_rows_are_kept_in_any_order_and_by_parts(count in 0..300_usize, cut in 0..300_usize, seed: u64) {
            let forth: Vec<usize> = (0..count).collect();
            let mut mixed = forth.clone();
            mixed.sort_by_key(|&place| mix(seed ^ place as u64));
            let whole = sample(&forth);
            prop_assert_eq!(whole.rows().len(), count.min(8));
            prop_assert_eq!(whole.seen, count as u64);
            prop_assert!(whole.rows().iter().all(|(place, kept)| **kept == 3 * place));
            prop_assert!(whole.is_like(&sample(&mixed), usize::eq));
            let (first, last) = mixed.split_at(cut.min(count));
            let mut sum = sample(last);
            let mut part = sum.part();
            first.iter().for_each(|&place| part.push(place, place as u64, || 3 * place));
            sum.add(part);
            prop_assert_eq!(sum.rows(), whole.rows());
            prop_assert_eq!(sum.seen, whole.seen);
        }
    }

    #[test]
    fn a_sample_is_spread_over_all_that_came() {
        let all: Vec<usize> = (0..60_000).collect();
        let mut sample = Sample::new(1024);
        all.iter().for_each(|&place| sample.push(place, place as u64, || ()));
        let mut of_tenth = [0; 10];
        sample.rows().iter().for_each(|(place, _)| of_tenth[place / 6000] += 1);
        // Of 102 in the mean, with a standard deviation of less than 10.
        assert!(of_tenth.iter().all(|count| (50..160).contains(count)), "{of_tenth:?}");
    }

    #[test]
    fn places_of_a_group_have_numbers_of_their_own() {
        let cases = |k: u64| [CaseRef::Hard(usize::try_from(k).unwrap_or(0)), CaseRef::Near(3, k), CaseRef::Random(k)];
        let all: Vec<u64> =
            (0..8).flat_map(|of| (0..100).flat_map(cases).map(move |case| row_number(of, case))).collect();
        let each: std::collections::HashSet<u64> = all.iter().copied().collect();
        assert_eq!(each.len(), all.len());
    }
}
