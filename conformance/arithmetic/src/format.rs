//! Floating-point formats and distances in them.

#![expect(clippy::float_cmp, reason = "values are told apart to the last bit")]

use super::order::greater;
use std::fmt::Debug;

/// A binary floating-point format, as constants, so that interval operations compile to straight code.
pub trait Format: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// Bits of the significand after the leading one.
    const FRACTION_BITS: u32;
    /// 2 to the power of minus [`Format::FRACTION_BITS`]: the largest relative error of one directed rounding.
    const EPSILON: f64;
    /// The least positive normal number.
    const MIN_NORMAL: f64;
    /// The least positive number, which is the spacing of subnormals.
    const MIN_SUBNORMAL: f64;
    /// The greatest finite number.
    const MAX: f64;

    /// The bits of an f64 that the significand does not have.
    const BELOW: u64 = (1 << (52 - Self::FRACTION_BITS)) - 1;

    /// How far a sum of n terms or a product of n factors may be off in any order, relatively, by n: an upper bound of (1 + ε)ⁿ⁻¹ − 1, for
    /// operations that are correctly rounded, up or down.
    const CHAIN_ERRORS: [f64; 16] = {
        let mut errors = [0.0; 16];
        let mut n = 0;
        while n < errors.len() {
            errors[n] = chain_error(n, Self::EPSILON);
            n += 1;
        }
        errors
    };

    /// Whether it is fixed hardware's: a sum errs relative to the sum of its terms' magnitudes rather than to its result, and
    /// what is too great for the format has a result, infinite or the greatest finite number.
    const IS_HARDWARE: bool = false;

    /// The greatest value of the format that is ≤ x, for |x| at least [`Format::MIN_NORMAL`] or 0.
    #[inline]
    #[must_use]
    fn round_down(x: f64) -> f64 {
        // Sign and magnitude: dropping bits moves towards zero, adding them first moves away from it.
        let bits = x.to_bits();
        let away = Self::BELOW * (bits >> 63);
        f64::from_bits((bits + away) & !Self::BELOW)
    }

    /// The least value of the format that is ≥ x, for |x| at least [`Format::MIN_NORMAL`] or 0.
    #[inline]
    #[must_use]
    fn round_up(x: f64) -> f64 {
        let bits = x.to_bits();
        let away = Self::BELOW * (!bits >> 63);
        f64::from_bits((bits + away) & !Self::BELOW)
    }

    /// Whether x, which is a value of the format or beyond its ends, is a normal number of it.
    #[inline]
    #[must_use]
    fn is_normal(x: f64) -> bool {
        let least = Self::MIN_NORMAL.to_bits() << 1;
        // Without the sign, from the least of them on: what is less wraps around.
        (x.to_bits() << 1).wrapping_sub(least) <= (Self::MAX.to_bits() << 1) - least
    }

    /// The distance between the two values of the format that bracket x most narrowly (Muller 2005); never below the
    /// spacing of subnormals.
    #[inline]
    #[must_use]
    fn ulp(x: f64) -> f64 {
        let x = greater(Self::MIN_NORMAL, x.abs());
        let power = f64::from_bits(x.to_bits() & (0x7ff << 52));
        let ulp = power * Self::EPSILON;
        // At a power of two the bracket below is half as wide.
        if x == power && x > Self::MIN_NORMAL { ulp * 0.5 } else { ulp }
    }
}

/// An upper bound of (1 + ε)ⁿ⁻¹ − 1 that exceeds it by no more than f64 rounding errors in the last bits.
pub(crate) const fn chain_error(n: usize, epsilon: f64) -> f64 {
    let (mut growth, mut k) = (1.0, 1);
    while k < n {
        growth *= 1.0 + epsilon;
        k += 1;
    }
    growth - 1.0 + F64_SLACK
}

/// f64 endpoints computed by a few correctly rounded operations err by less than this, relatively.
pub(crate) const F64_SLACK: f64 = 16.0 * f64::EPSILON;

/// binary32.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct F32;

impl Format for F32 {
    const FRACTION_BITS: u32 = 23;
    const EPSILON: f64 = 1.0 / 8_388_608.0;
    const MIN_NORMAL: f64 = f64::from_bits((1023 - 126) << 52);
    const MIN_SUBNORMAL: f64 = f64::from_bits((1023 - 149) << 52);
    const MAX: f64 = 340_282_346_638_528_859_811_704_183_484_516_925_440.0;
}

/// binary16.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct F16;

impl Format for F16 {
    const FRACTION_BITS: u32 = 10;
    const EPSILON: f64 = 1.0 / 1024.0;
    const MIN_NORMAL: f64 = f64::from_bits((1023 - 14) << 52);
    const MIN_SUBNORMAL: f64 = f64::from_bits((1023 - 24) << 52);
    const MAX: f64 = 65_504.0;
}

/// The arithmetic of fixed hardware on a format: one ULP for each conversion, factor, product and sum, a sum's relative to
/// the magnitudes of its terms. No interface promises a blend unit more; lavapipe's takes out a factor that both sides share.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hardware<F>(F);

impl<F: Format> Format for Hardware<F> {
    const FRACTION_BITS: u32 = F::FRACTION_BITS;
    const EPSILON: f64 = F::EPSILON;
    const MIN_NORMAL: f64 = F::MIN_NORMAL;
    const MIN_SUBNORMAL: f64 = F::MIN_SUBNORMAL;
    const MAX: f64 = F::MAX;
    const IS_HARDWARE: bool = true;
}

/// The error of `value` against `reference` in units in the last place of the format at the reference.
///
/// 0 where both are equal or both NaN; infinite where only one of them is finite.
#[must_use]
pub fn error_ulp<F: Format>(value: f32, reference: f64) -> f64 {
    let value = f64::from(value);
    if value == reference || (value.is_nan() && reference.is_nan()) {
        0.0
    } else if value.is_finite() && reference.is_finite() {
        (value - reference).abs() / F::ulp(reference)
    } else {
        f64::INFINITY
    }
}
