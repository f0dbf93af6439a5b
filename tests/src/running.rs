//! f64 with a running bound of its own error: the reference's value, and how far the roundings on the way may have moved it.
//!
//! Each operation of f64 is correctly rounded (so are core-math's functions) and errs by at most 2⁻⁵³ of its result, or
//! 2⁻¹⁰⁷⁵ where that is subnormal. An operation passes on its operands' errors by its derivative, bounded over the whole
//! interval that they leave open. There is no other allowance, so a value farther from the exact one is not the formula's.

use lightmeter_reference::{Components, Real};
use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value in f64, and a bound of |value − true value|.
#[derive(Clone, Copy, Debug)]
pub struct Running {
    /// What the reference computes, bit for bit.
    pub value: f64,
    /// How far the exact value may be; infinite where nothing bounds it.
    pub error: f64,
}

/// A choice that the reference made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TakenChoice {
    /// The side or the whole number; 1 for `then`.
    pub taken: i64,
    /// Whether the other lies within the bound.
    pub is_close: bool,
}

thread_local! {
    static CHOICES: RefCell<Vec<TakenChoice>> = const { RefCell::new(Vec::new()) };
}

/// The choices on this thread since they were last taken.
#[must_use]
pub fn take_choices() -> Vec<TakenChoice> {
    CHOICES.take()
}

fn choose(taken: i64, is_close: bool) {
    CHOICES.with_borrow_mut(|choices| choices.push(TakenChoice { taken, is_close }));
}

/// Half a unit in the last place, relative to the value.
const UNIT: f64 = f64::EPSILON / 2.0;
/// The least number above 0, twice what a subnormal errs by.
const LEAST: f64 = f64::from_bits(1);
/// The bound is computed in f64 too, by fewer operations than this accounts for.
const OWN: f64 = 1.0 + 16.0 * f64::EPSILON;

impl Running {
    /// A number that is exactly itself.
    #[must_use]
    pub const fn exactly(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// A rounded result whose operands' errors come to `carried`.
    fn rounded(value: f64, carried: f64) -> Self {
        let own = if value.abs() < f64::MIN_POSITIVE { LEAST } else { value.abs() * UNIT };
        Self::bounded(value, carried + own)
    }

    fn bounded(value: f64, error: f64) -> Self {
        let error = error * OWN;
        Self { value, error: if error.is_nan() || !value.is_finite() { f64::INFINITY } else { error } }
    }

    /// The rounded result of a function of monotone derivative: `steepest` is the greatest on what the error leaves open.
    fn through(self, value: f64, steepest: f64) -> Self {
        Self::rounded(value, if self.error == 0.0 { 0.0 } else { self.error * steepest })
    }
}

impl Add for Running {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let value = self.value + other.value;
        // A sum that is 0 is exact, and so is one with 0.
        if value == 0.0 || self.value == 0.0 || other.value == 0.0 {
            return Self::bounded(value, self.error + other.error);
        }
        Self::rounded(value, self.error + other.error)
    }
}

impl Neg for Running {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl Sub for Running {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Running {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let carried = product(self.value.abs(), other.error)
            + product(other.value.abs(), self.error)
            + product(self.error, other.error);
        let value = self.value * other.value;
        if self.value == 0.0 || other.value == 0.0 {
            Self::bounded(value, carried)
        } else {
            Self::rounded(value, carried)
        }
    }
}

impl Div for Running {
    type Output = Self;
    fn div(self, divisor: Self) -> Self {
        let value = self.value / divisor.value;
        let least = divisor.value.abs() - divisor.error;
        if least.is_nan() || least <= 0.0 {
            return Self { value, error: f64::INFINITY };
        }
        let moved = self.error + if divisor.error == 0.0 { 0.0 } else { value.abs() * divisor.error };
        if self.value == 0.0 { Self::bounded(value, moved / least) } else { Self::rounded(value, moved / least) }
    }
}

impl Real for Running {
    fn input(x: f32) -> Self {
        Self::exactly(x.into())
    }
    fn literal(x: f64) -> Self {
        // A literal stands for the number that is written, which its nearest f64 may miss by half a unit. Those of at most 24
        // bits are themselves.
        #[expect(clippy::cast_possible_truncation, reason = "whether it survives is the question")]
        let is_short = f64::from(x as f32).to_bits() == x.to_bits();
        if is_short { Self::exactly(x) } else { Self::rounded(x, 0.0) }
    }
    fn max(self, other: Self) -> Self {
        Self { value: Real::max(self.value, other.value), error: self.error.max(other.error) }
    }
    fn min(self, other: Self) -> Self {
        Self { value: Real::min(self.value, other.value), error: self.error.max(other.error) }
    }
    fn abs(self) -> Self {
        Self { value: self.value.abs(), ..self }
    }
    fn round(self) -> Self {
        let value = Real::round(self.value);
        #[expect(clippy::cast_possible_truncation, reason = "whole numbers of a byte; others are only told apart")]
        choose(value as i64, (self.value - value).abs() + self.error >= 0.5);
        Self::exactly(value)
    }
    fn sqrt(self) -> Self {
        let least = self.value - self.error;
        if self.error > 0.0 && least <= 0.0 {
            // Both roots lie from 0 to that of the greatest.
            return Self::bounded(self.value.sqrt(), (self.value + self.error).sqrt() * OWN);
        }
        self.through(self.value.sqrt(), 0.5 / least.sqrt())
    }
    fn inverse_sqrt(self) -> Self {
        Self::exactly(1.0) / Real::sqrt(self)
    }
    fn exp(self) -> Self {
        let value = Real::exp(self.value);
        self.through(value, Real::exp((self.value + self.error).next_up()) * OWN)
    }
    fn exp2(self) -> Self {
        let value = Real::exp2(self.value);
        self.through(value, Real::exp2((self.value + self.error).next_up()) * OWN)
    }
    fn ln_1p(self) -> Self {
        let least = 1.0 + (self.value - self.error);
        let steepest = if least > 0.0 { 1.0 / least } else { f64::INFINITY };
        self.through(Real::ln_1p(self.value), steepest * OWN)
    }
    fn exp_m1(self) -> Self {
        let value = Real::exp_m1(self.value);
        self.through(value, Real::exp((self.value + self.error).next_up()) * OWN)
    }
    fn difference_of_products([a, b]: [Self; 2], [c, d]: [Self; 2]) -> Self {
        let values = |x: Self, y: Self| [x.value, y.value];
        let value = <f64 as Real>::difference_of_products(values(a, b), values(c, d));
        // Kahan's difference errs by at most 2 units; a product passes on its operands' errors as everywhere.
        let carried = |x: Self, y: Self| x.value.abs() * y.error + y.value.abs() * x.error + x.error * y.error;
        Self::rounded(value, carried(a, b) + carried(c, d) + value.abs() * UNIT)
    }
    fn log2(self) -> Self {
        let least = self.value - self.error;
        let steepest = if least > 0.0 { std::f64::consts::LOG2_E / least } else { f64::INFINITY };
        self.through(Real::log2(self.value), steepest * OWN)
    }
    fn pow(self, exponent: Self) -> Self {
        let value = Real::pow(self.value, exponent.value);
        if self.error == 0.0 && exponent.error == 0.0 {
            return Self::rounded(value, 0.0);
        }
        let least = self.value - self.error;
        if least.is_nan() || least <= 0.0 {
            return Self { value, error: f64::INFINITY };
        }
        // The power's logarithm moves by |y|·e/(x − e) + f·|ln x|, and by the two together.
        let logarithm = (self.value.ln().abs() * OWN + self.error / least) * OWN;
        let moved = (exponent.value.abs() * (self.error / least) + exponent.error * logarithm) * OWN;
        if moved <= 1.0 {
            // e^m − 1 ≤ m·e^m.
            return Self::rounded(value, value * moved * Real::exp(moved) * OWN);
        }
        // Farther than a derivative tells: a power is monotone in both, so its ends are at the corners.
        let ends = |x: Self| [(x.value - x.error).next_down(), (x.value + x.error).next_up()];
        let corners = ends(self).map(|x| ends(exponent).map(|y| (Real::pow(x, y) - value).abs().next_up()));
        Self::rounded(value, corners.into_iter().flatten().fold(0.0, f64::max))
    }
    fn if_ge<T: Components<Self>>(a: Self, b: Self, then: impl FnOnce() -> T, otherwise: impl FnOnce() -> T) -> T {
        let taken = a.value >= b.value;
        // A NaN is close to all.
        let is_clear = (a.value - b.value).abs() > (a.error + b.error) * OWN || (a.error + b.error == 0.0);
        choose(taken.into(), !is_clear);
        if taken { then() } else { otherwise() }
    }
    fn floor_then<T: Components<Self>>(self, then: impl Fn(f64) -> T) -> T {
        let floor = self.value.floor();
        #[expect(clippy::cast_possible_truncation, reason = "whole numbers of texels")]
        choose(floor as i64, self.value - floor <= self.error || floor + 1.0 - self.value <= self.error);
        then(floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_carried_by_the_derivative() {
        let third = Running::exactly(1.0) / Running::exactly(3.0);
        assert!(third.error >= UNIT / 3.0 && third.error < UNIT / 2.9);
        let lost = third * Running::exactly(3.0) - Running::exactly(1.0);
        assert!(lost.error > UNIT && lost.error < 3.0 * UNIT, "{lost:?}");
        assert!((Running::exactly(1.0) / lost).error.is_infinite());
        let power = third.pow(Running::exactly(100.0));
        assert!(power.error > 99.0 * UNIT * power.value && power.error < 102.0 * UNIT * power.value);
        // 0.7^1e30 is 0, whatever its last bits; and what is farther than a derivative tells stays a bound.
        let near = Running { value: 0.7, error: 0.01 };
        let vanished = near.pow(Running::exactly(1e30));
        assert!(vanished.value == 0.0 && vanished.error < 1e-300, "{vanished:?}");
        let wide = near.pow(Running::exactly(100.0));
        assert!(wide.error >= 0.71_f64.powi(100) - 0.7_f64.powi(100) && wide.error < 0.72_f64.powi(100), "{wide:?}");
    }

    #[test]
    fn a_choice_within_the_error_is_close() {
        let third = Running::exactly(1.0) / Running::exactly(3.0);
        let one = third * Running::exactly(3.0);
        Running::if_ge(one, Running::exactly(1.0), || one, || third);
        Running::if_ge(one, third, || one, || third);
        Running::if_ge(Running::exactly(1.0), Running::exactly(1.0), || one, || third);
        assert_eq!(take_choices().iter().map(|choice| choice.is_close).collect::<Vec<_>>(), [true, false, false]);
    }
}
