//! Sums and products of several numbers, whose order is open.

use super::super::format::{self, Format};
use super::super::order::{greater, lesser};
use super::super::profile::{assert_in_force, relative};
use super::{Accept, epsilon};

impl<F: Format> Accept<F> {
    /// A sum that errs by one ULP of its terms' magnitudes for each addition: fixed hardware's bound does not follow from
    /// roundings. v − ε|v| grows with v, so the ends of the terms give the ends of the sum. Terms that are exactly 0 round nothing.
    fn sum_of_hardware(terms: impl Iterator<Item = Self>) -> Self {
        let (mut low, mut high, mut below, mut above) = (0.0, 0.0, 0.0, 0.0);
        let (mut count, mut last) = (0, Self::exactly(0.0));
        for term in terms {
            if term.is_exactly(0.0) {
                continue;
            }
            (count, last) = (count + 1, term);
            low += term.low;
            high += term.high;
            below += term.low.abs();
            above += term.high.abs();
        }
        if count <= 1 {
            return last;
        }
        let error = chain_error::<F>(count);
        let flushed = |magnitude: f64| {
            // Partial sums that cancel to a subnormal may be flushed; above this magnitude the rounding term covers that.
            if magnitude < F::MIN_NORMAL / F::EPSILON * 16.0 {
                (0..count).fold(0.0, |sum, _| sum + F::MIN_NORMAL)
            } else {
                0.0
            }
        };
        Self::seal(low - error * below - flushed(below), high + error * above + flushed(above))
    }

    /// x₀ + x₁ + … in any order.
    #[inline]
    pub(super) fn chain_of_sums(terms: impl Iterator<Item = Self>) -> Self {
        if F::IS_HARDWARE {
            return Self::sum_of_hardware(terms);
        }
        // Adding an exact 0 causes no rounding, so such terms are skipped. If two terms remain, the sum is a single addition.
        let (mut low, mut high, mut magnitude, mut count) = (0.0, 0.0, 0.0, 0);
        let (mut all_are_points, mut finest) = (true, u64::MAX);
        let mut last_two = [Self::exactly(0.0); 2];
        for term in terms {
            if term.is_exactly(0.0) {
                continue;
            }
            count += 1;
            last_two = [last_two[1], term];
            low += term.low;
            high += term.high;
            magnitude += term.magnitude();
            all_are_points &= term.is_point();
            if all_are_points {
                finest = finest.min(last_bit(term.low));
            }
        }
        match count {
            0 => return Self::exactly(0.0),
            1 => return last_two[1],
            2 => return last_two[0] + last_two[1],
            _ => {}
        }
        // A partial sum may overflow in another order than this one.
        if magnitude.is_nan() || magnitude > F::MAX {
            return Self::ANY;
        }
        if all_are_points && is_exact_in_any_order::<F>(magnitude, finest) {
            return Self::exactly(low);
        }
        let mut error = chain_error::<F>(count) * magnitude;
        // Partial sums that cancel to a subnormal may be flushed; above this magnitude the rounding term covers that.
        if magnitude < F::MIN_NORMAL / F::EPSILON * 16.0 {
            error += (0..count).fold(0.0, |e, _| e + F::MIN_NORMAL);
        }
        // The last addition's result is one of the format's values. (A product may stay unrounded in a fused operation.)
        Self::of_results(low - error, high + error)
    }

    /// x₀ · x₁ · … in any order.
    #[inline]
    pub(super) fn chain_of_products<const N: usize>(factors: [Self; N]) -> Self {
        let (mut range, mut rounded) = ((1.0, 1.0), 0);
        // The greatest and the least magnitude that some order of partial products can reach.
        let (mut greatest, mut least) = (1.0_f64, 1.0_f64);
        let mut any_zero = false;
        for x in factors {
            if x.is_exactly(1.0) {
                continue;
            }
            range = if range.0 > 0.0 && x.low > 0.0 {
                (range.0 * x.low, range.1 * x.high)
            } else {
                Self::product_range(range, (x.low, x.high))
            };
            greatest *= greater(x.magnitude(), 1.0);
            let smallest = if x.contains_zero() { 0.0 } else { lesser(x.low.abs(), x.high.abs()) };
            least *= lesser(smallest, 1.0);
            any_zero |= x.is_exactly(0.0);
            // Scaling by a power of two rounds nothing.
            let power_of_two = x.is_point() && x.low.to_bits() & ((1 << 52) - 1) == 0;
            rounded += usize::from(!power_of_two);
        }
        if greatest.is_nan() || greatest > F::MAX {
            return Self::ANY;
        }
        if any_zero {
            return Self::exactly(0.0);
        }
        let mut error = if rounded > 2 { chain_error::<F>(rounded) } else { relative() };
        assert_in_force(error);
        if rounded <= 2 && least >= F::MIN_NORMAL {
            return Self::rounded(range.0, range.1);
        }
        error *= greater(range.0.abs(), range.1.abs());
        // A partial product below the normal range may be flushed, and what it lost is then scaled up again.
        if least < F::MIN_NORMAL {
            error += 2.0 * F::MIN_NORMAL * greatest;
        }
        Self::seal(range.0 - error, range.1 + error)
    }
}

/// The exponent, biased as f64's is, of the last bit of x that is not 0.
#[inline]
fn last_bit(x: f64) -> u64 {
    let bits = x.to_bits();
    let zeros = u64::from((bits | 1 << 52).trailing_zeros());
    ((bits >> 52) & 0x7ff) + zeros
}

/// Whether every partial sum of terms is a value of the format, given the sum of their magnitudes and the finest of their last bits: all are
/// whole multiples of that bit, and none has more of them than the significand can hold. What is exact, correct rounding leaves alone.
#[inline]
fn is_exact_in_any_order<F: Format>(magnitude: f64, finest: u64) -> bool {
    // `last_bit` counts from 52 places below the leading bit.
    let most = finest + u64::from(F::FRACTION_BITS) + 1;
    let has_all_bits = finest >= 52 + (F::MIN_NORMAL.to_bits() >> 52) && (53..52 + 0x7ff).contains(&most);
    has_all_bits && magnitude <= f64::from_bits((most - 52) << 52) && relative() <= F::EPSILON
}

/// [`format::chain_error`] by the profile in force.
#[inline]
pub(super) fn chain_error<F: Format>(n: usize) -> f64 {
    match F::CHAIN_ERRORS.get(n) {
        Some(&error) if relative() == 0.0 => error,
        _ => format::chain_error(n, epsilon::<F>()),
    }
}
