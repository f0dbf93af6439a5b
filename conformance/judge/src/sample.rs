//! A random sample of rows, with an upper limit. Each row is as likely to be kept as any other, and the same rows are kept in whatever
//! order they come.

use lightmeter_catalogue::cases::mix;
use lightmeter_catalogue::select::CaseRef;

/// What tells a row from all others.
pub trait RowNumber: Copy + Ord {
    /// A number for it, which another row hardly ever has.
    fn number(self) -> u64;
}

impl RowNumber for usize {
    fn number(self) -> u64 {
        self as u64
    }
}

/// The formula's place among its group's, and the case.
impl RowNumber for (usize, CaseRef) {
    fn number(self) -> u64 {
        let (member, case) = self;
        let [kind, first, second] = match case {
            CaseRef::Hard(place) => [1, place as u64, 0],
            CaseRef::Near(place, k) => [2, place as u64, k],
            CaseRef::Random(k) => [3, k, 0],
            CaseRef::Boundary(k) => [4, k, 0],
        };
        [member as u64, kind, first, second].into_iter().fold(0, |number, part| mix(number ^ part))
    }
}

/// Rows with what was answered to them. It keeps those whose places have the least hashes, which no order of arrival changes.
#[derive(Clone, Debug)]
pub struct Sample<P> {
    /// Hash and place of each row that is kept.
    rows: Vec<(u64, P)>,
    /// The rows' values, one after the other.
    values: Vec<f32>,
    /// Values of a row.
    outputs: usize,
    most: usize,
    /// How many rows came.
    pub seen: u64,
    /// Rows with a greater hash are not kept.
    bound: u64,
}

impl<P: RowNumber> Sample<P> {
    /// An empty sample of rows with `outputs` values each, which keeps at most `most` of them.
    #[must_use]
    pub const fn new(outputs: usize, most: usize) -> Self {
        Self { rows: vec![], values: vec![], outputs, most, seen: 0, bound: u64::MAX }
    }

    /// An empty one to be added to this one later, which keeps nothing that this one would not.
    #[must_use]
    pub fn part(&self) -> Self {
        Self { bound: self.bound, ..Self::new(self.outputs, self.most) }
    }

    /// Takes a row.
    pub fn push(&mut self, place: P, values: impl IntoIterator<Item = f32>) {
        self.seen += 1;
        let hash = mix(place.number());
        if hash <= self.bound {
            self.rows.push((hash, place));
            self.values.extend(values);
            self.thin(2 * self.most);
        }
    }

    /// Takes all rows of another part.
    pub fn add(&mut self, other: &Self) {
        self.seen += other.seen;
        self.rows.extend(&other.rows);
        self.values.extend(&other.values);
        self.thin(2 * self.most);
    }

    /// Where more than `room` rows are kept, only those of the least hashes stay.
    fn thin(&mut self, room: usize) {
        if self.rows.len() <= room {
            return;
        }
        let mut order: Vec<usize> = (0..self.rows.len()).collect();
        order.select_nth_unstable_by_key(self.most, |&row| self.rows[row]);
        order.truncate(self.most);
        self.bound = order.iter().map(|&row| self.rows[row].0).max().unwrap_or(0);
        let values = |row: usize| self.values[row * self.outputs..(row + 1) * self.outputs].iter().copied();
        self.values = order.iter().flat_map(|&row| values(row)).collect();
        self.rows = order.iter().map(|&row| self.rows[row]).collect();
    }

    /// The rows in the order of their places, each with its values; at most as many as were asked for.
    #[must_use]
    pub fn rows(&self) -> Vec<(P, &[f32])> {
        let mut order: Vec<usize> = (0..self.rows.len()).collect();
        order.sort_unstable_by_key(|&row| self.rows[row]);
        order.truncate(self.most);
        let row = |row: usize| (self.rows[row].1, &self.values[row * self.outputs..(row + 1) * self.outputs]);
        let mut rows: Vec<(P, &[f32])> = order.into_iter().map(row).collect();
        rows.sort_unstable_by_key(|(place, _)| *place);
        rows
    }
}

/// The same rows with the same values, to the bit.
impl<P: RowNumber> PartialEq for Sample<P> {
    fn eq(&self, other: &Self) -> bool {
        let (own, others) = (self.rows(), other.rows());
        let is_same = |a: &[f32], b: &[f32]| a.iter().map(|x| x.to_bits()).eq(b.iter().map(|x| x.to_bits()));
        self.seen == other.seen
            && own.len() == others.len()
            && own.iter().zip(&others).all(|(a, b)| a.0 == b.0 && is_same(a.1, b.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn value(place: usize) -> f32 {
        f32::from(u16::try_from(place).expect("it is small"))
    }

    fn sample(places: &[usize]) -> Sample<usize> {
        let mut sample = Sample::new(2, 8);
        places.iter().for_each(|&place| sample.push(place, [value(place), -1.0]));
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
            prop_assert!(whole.rows().iter().all(|(place, values)| *values == [value(*place), -1.0]));
            let other = sample(&mixed);
            prop_assert_eq!(whole.rows(), other.rows());
            let (first, last) = mixed.split_at(cut.min(count));
            let mut sum = sample(last);
            let mut part = sum.part();
            first.iter().for_each(|&place| part.push(place, [value(place), -1.0]));
            sum.add(&part);
            prop_assert_eq!(sum.rows(), whole.rows());
            prop_assert_eq!(sum.seen, whole.seen);
        }
    }

    #[test]
    fn a_sample_is_spread_over_all_that_came() {
        let all: Vec<usize> = (0..60_000).collect();
        let mut sample = Sample::new(1, 1024);
        all.iter().for_each(|&place| sample.push(place, [0.0]));
        let mut of_tenth = [0; 10];
        sample.rows().iter().for_each(|(place, _)| of_tenth[place / 6000] += 1);
        // Of 102 in the mean, with a standard deviation of less than 10.
        assert!(of_tenth.iter().all(|count| (50..160).contains(count)), "{of_tenth:?}");
    }

    #[test]
    fn places_of_a_group_have_numbers_of_their_own() {
        let cases = |k: u64| [CaseRef::Hard(usize::try_from(k).unwrap_or(0)), CaseRef::Near(3, k), CaseRef::Random(k)];
        let all: Vec<u64> =
            (0..8).flat_map(|of| (0..100).flat_map(cases).map(move |case| (of, case).number())).collect();
        let each: std::collections::HashSet<u64> = all.iter().copied().collect();
        assert_eq!(each.len(), all.len());
    }
}
