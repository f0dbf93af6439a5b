//! How much answers tell of how they came about, in bits.

use super::common::share;
use lightmeter_arithmetic::{Accept, F32, Format as _};
use lightmeter_judge::diagnose::Answered;
use std::collections::HashSet;

/// What a row's answer says of the intervals of its outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fit {
    /// Every output lies in its interval, and a wrong one in an interval that tells something.
    Inside,
    /// Every output lies in its interval, but those of all wrong ones are so wide that any number would.
    Open,
    /// An output lies outside.
    Outside,
}

/// An interval that is wider than this part of the range of right answers tells nothing of its output.
pub(crate) const WIDE: f64 = 1.0 / 16.0;

/// How unlikely chance must be, in bits, beyond the logarithm of the number of candidates that were tried.
pub(crate) const LEAST_EVIDENCE: f64 = 64.0;

/// The bits that an interval leaves open of a number in it.
pub(super) fn bits_left(value: f32, legal: &Accept) -> f64 {
    let ulps = legal.width() / F32::ulp(f64::from(value)).max(F32::MIN_SUBNORMAL);
    if ulps.is_finite() { (1.0 + ulps).log2().min(BITS) } else { BITS }
}

/// The bits of a number of which nothing is known.
const BITS: f64 = 28.0;
/// The bits that an answer costs which an explanation excludes.
pub(super) const EXCLUDED: f64 = 100.0;

/// The most bits that knowing which cases fail can give.
pub(crate) const MOST_FORETOLD: f64 = 128.0;

/// What the right formula says of the answers.
pub(super) struct Right {
    /// How many bits it takes to state each number of a failing answer when only the right formula is known: where the number is right, the
    /// bits that its interval leaves open; where it is wrong, all of its bits.
    pub(super) bits: Vec<f64>,
    /// The range of each output's right answers.
    ranges: Vec<f64>,
    /// For each output the number that every answer has there, failing or passing: such answers tell nothing of how they came about.
    pub(super) constant: Vec<Option<u32>>,
}

impl Right {
    pub(super) fn new(outputs: usize, failing: &[Answered<'_>], passing: &[Answered<'_>]) -> Self {
        let mut seen: Vec<HashSet<u32>> = vec![HashSet::new(); outputs];
        let mut bits = vec![];
        for row in failing {
            for ((&value, legal), seen) in row.values.iter().zip(row.legal).zip(&mut seen) {
                // A wrong number that is 0 or 1, or that has occurred before, is weak evidence.
                let is_plain =
                    value.to_bits() << 1 == 0 || value.to_bits() == 1.0_f32.to_bits() || !seen.insert(value.to_bits());
                bits.push(match legal.contains(value.into()) {
                    true => bits_left(value, legal),
                    false if is_plain => 1.0,
                    false => BITS,
                });
            }
        }
        let constant = |place: usize| {
            let mut all = failing.iter().chain(passing).map(|row| row.values[place].to_bits());
            let first = all.next()?;
            all.all(|other| other == first).then_some(first)
        };
        let range = |place: usize| {
            let all = failing.iter().chain(passing).map(|row| row.reference[place]).filter(|x| x.is_finite());
            let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
            (high - low).max(0.0)
        };
        Self { bits, ranges: (0..outputs).map(range).collect(), constant: (0..outputs).map(constant).collect() }
    }

    /// Whether what is right is the same number in each case, of which any other number is some multiple.
    pub(super) fn is_constant(&self) -> bool {
        self.ranges.iter().all(|range| *range == 0.0)
    }

    /// Whether an interval is so wide that it tells nothing of an output.
    pub(super) fn is_wide(&self, place: usize, legal: &Accept) -> bool {
        legal.is_any() || legal.width() > WIDE * self.ranges[place]
    }

    /// Whether an answer is one that these intervals allow. `own` is what the mistake computes in f32: it explains a NaN by giving one.
    pub(super) fn fit(&self, row: &Answered<'_>, legal: &[Accept], own: &[f32]) -> Fit {
        let is_unexplained = |(value, own): (&f32, &f32)| value.is_nan() && !own.is_nan();
        if !is_inside(row.values, legal) || row.values.iter().zip(own).any(is_unexplained) {
            return Fit::Outside;
        }
        let tells = |place: usize| !row.is_right(place) && !self.is_wide(place, &legal[place]);
        if (0..legal.len()).any(tells) { Fit::Inside } else { Fit::Open }
    }
}

/// Whether each number of an answer lies in its interval.
pub(super) fn is_inside(values: &[f32], legal: &[Accept]) -> bool {
    values.iter().zip(legal).all(|(&value, legal)| legal.contains(value.into()))
}

/// Which cases fail, and which would if a mistake were made: counts of cases.
#[derive(Default)]
pub(crate) struct Foretold {
    counts: [[usize; 2]; 2],
}

impl Foretold {
    pub(crate) fn take(&mut self, fails: bool, would_fail: bool) {
        self.counts[usize::from(fails)][usize::from(would_fail)] += 1;
    }

    /// How many bits knowing which cases the mistake would make fail tells about which cases do fail. 0 if cases that fail are no more
    /// likely to be predicted to fail than cases that pass.
    pub(crate) fn bits(&self) -> f64 {
        let [[a, b], [c, d]] = self.counts;
        let all = a + b + c + d;
        if c + d == 0 || a + b > 0 && share(d, c + d) <= share(b, a + b) {
            return 0.0;
        }
        let cell = |count: usize, line: usize, column: usize| match count {
            0 => 0.0,
            _ => share(count, 1) * (share(count, line) * share(all, column)).log2(),
        };
        cell(a, a + b, a + c) + cell(b, a + b, b + d) + cell(c, c + d, a + c) + cell(d, c + d, b + d)
    }
}

/// Whether a number of an answer is not legal. A subnormal one may have been flushed to 0.
pub(super) fn is_wrong(answer: &[f32], legal: &[Accept]) -> bool {
    let may_be = |x: f32, legal: &Accept| legal.contains(x.into()) || x.is_subnormal() && legal.contains(0.0);
    answer.iter().zip(legal).any(|(&x, legal)| !may_be(x, legal))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_subnormal_number_may_have_been_flushed() {
        let legal = [Accept::exactly(0.0)];
        assert!(!is_wrong(&[1e-40], &legal) && !is_wrong(&[0.0], &legal));
        assert!(is_wrong(&[1e-30], &legal) && is_wrong(&[1e-40], &[Accept::exactly(1.0)]));
    }
}
