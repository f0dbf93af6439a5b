//! Intervals of fixed-point numbers: what a blend unit may hold on the way to a target of 8 bits.
//!
//! Blending happens at the target's precision or a better one, and either neighbour of the result may be stored. Two kinds of
//! unit are told apart, since their bounds are derived differently; what either may give is legal:
//!
//! * [`Wide`]: computes as binary32 does or better and rounds once, when it stores.
//! * [`Narrow`]: holds every operand, factor and product in 8 bits, rounded to nearest. A product of two such numbers is
//!   usually divided by 255 with shifts: `(ab + (ab >> 8) + 128) >> 8` errs by up to 1/510 of a step more than half a
//!   step, over all a and b. A sum of such numbers is one of them, so nothing is rounded when it stores. In all that is 1½
//!   steps for the source's term and 1 for the destination's, less where a factor is 0 or 1. (A unit of 8 bits that computes
//!   a product wider and then truncates is neither kind.)

#![expect(clippy::float_cmp, reason = "0 and 1 are exact")]

use super::order::{greater, lesser};
use lightmeter_reference::{Components, Real};
use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A step of a component of 8 bits.
pub const STEP: f64 = 1.0 / 255.0;

/// How much each operation may err by.
pub trait Unit: Copy + Debug + PartialEq + 'static {
    /// An operand brought to the unit's numbers.
    const OPERAND: f64;
    /// A product.
    const PRODUCT: f64;
    /// A sum, or a complement.
    const SUM: f64;
}

/// Computes as binary32 or better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wide;

impl Unit for Wide {
    const OPERAND: f64 = 0.0;
    // One ULP at 1, and at 2 for a sum.
    const PRODUCT: f64 = 1.0 / 8_388_608.0;
    const SUM: f64 = 1.0 / 4_194_304.0;
}

/// Computes in 8 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Narrow;

impl Unit for Narrow {
    const OPERAND: f64 = 0.5 * STEP;
    const PRODUCT: f64 = (0.5 + 1.0 / 510.0) * STEP;
    const SUM: f64 = 0.0;
}

/// An interval of what a unit may hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fixed<U> {
    low: f64,
    high: f64,
    unit: PhantomData<U>,
}

impl<U: Unit> Fixed<U> {
    /// Every number between.
    #[must_use]
    pub const fn between(low: f64, high: f64) -> Self {
        Self { low, high, unit: PhantomData }
    }

    /// An operand of [0, 1], brought to the unit's numbers. Whoever has one beyond clamps it first.
    #[must_use]
    pub fn operand(x: f64) -> Self {
        Self::operand_between(x, x)
    }

    /// The same of one that is known to lie between two.
    #[must_use]
    pub fn operand_between(low: f64, high: f64) -> Self {
        let given = Self::between(low, high);
        if U::OPERAND > 0.0 { given.widened(U::OPERAND).within_unit() } else { given }
    }

    /// The least.
    #[must_use]
    pub const fn low(self) -> f64 {
        self.low
    }

    /// The greatest.
    #[must_use]
    pub const fn high(self) -> f64 {
        self.high
    }

    /// The part in [0, 1].
    #[must_use]
    pub fn within_unit(self) -> Self {
        Self::between(self.low.clamp(0.0, 1.0), self.high.clamp(0.0, 1.0))
    }

    fn widened(self, error: f64) -> Self {
        // 0 and 1 are numbers of either unit, and stay what they are.
        if self.is(0.0) || self.is(1.0) { self } else { Self::between(self.low - error, self.high + error) }
    }

    fn is(self, x: f64) -> bool {
        self.low == x && self.high == x
    }

    /// Operations that blending has no use for: anything may come out.
    const fn anything() -> Self {
        Self::between(f64::NEG_INFINITY, f64::INFINITY)
    }
}

impl<U: Unit> Add for Fixed<U> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        if self.is(0.0) || other.is(0.0) {
            return Self::between(self.low + other.low, self.high + other.high);
        }
        Self::between(self.low + other.low, self.high + other.high).widened(U::SUM)
    }
}

impl<U: Unit> Neg for Fixed<U> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::between(-self.high, -self.low)
    }
}

impl<U: Unit> Sub for Fixed<U> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<U: Unit> Mul for Fixed<U> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if self.is(1.0) || other.is(0.0) {
            return other;
        }
        if other.is(1.0) || self.is(0.0) {
            return self;
        }
        let (p, q) = (self.low * other.low, self.low * other.high);
        let (r, s) = (self.high * other.low, self.high * other.high);
        Self::between(lesser(lesser(p, q), lesser(r, s)), greater(greater(p, q), greater(r, s))).widened(U::PRODUCT)
    }
}

impl<U: Unit> Div for Fixed<U> {
    type Output = Self;
    fn div(self, _divisor: Self) -> Self {
        Self::anything()
    }
}

impl<U: Unit> Real for Fixed<U> {
    fn input(x: f32) -> Self {
        Self::operand(x.into())
    }

    fn literal(x: f64) -> Self {
        Self::between(x, x)
    }

    fn max(self, other: Self) -> Self {
        Self::between(greater(self.low, other.low), greater(self.high, other.high))
    }

    fn min(self, other: Self) -> Self {
        Self::between(lesser(self.low, other.low), lesser(self.high, other.high))
    }

    fn abs(self) -> Self {
        self.max(-self)
    }

    fn round(self) -> Self {
        Self::between(self.low.floor(), self.high.ceil())
    }

    fn sqrt(self) -> Self {
        Self::anything()
    }

    fn inverse_sqrt(self) -> Self {
        Self::anything()
    }

    fn exp(self) -> Self {
        Self::anything()
    }

    fn exp2(self) -> Self {
        Self::anything()
    }

    fn log2(self) -> Self {
        Self::anything()
    }

    fn pow(self, _exponent: Self) -> Self {
        Self::anything()
    }

    fn floor_then<T: Components<Self>>(self, then: impl Fn(f64) -> T) -> T {
        then(self.low.floor()).zip(then(self.high.floor()), |_, _| Self::anything())
    }

    fn if_ge<T: Components<Self>>(a: Self, b: Self, then: impl FnOnce() -> T, otherwise: impl FnOnce() -> T) -> T {
        if a.low >= b.high {
            then()
        } else if a.high < b.low {
            otherwise()
        } else {
            then().zip(otherwise(), |x, y| Self::between(lesser(x.low, y.low), greater(x.high, y.high)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_by_shifts_errs_by_what_narrow_units_are_granted() {
        let mut most = 0.0_f64;
        for (a, b) in (0..=255_u32).flat_map(|a| (0..=255_u32).map(move |b| (a, b))) {
            let by_shifts = (a * b + ((a * b) >> 8) + 128) >> 8;
            most = most.max((f64::from(by_shifts) - f64::from(a * b) * STEP).abs() * STEP);
        }
        assert!((most - Narrow::PRODUCT).abs() < 1e-12, "{most}");
    }

    #[test]
    fn terms_err_by_what_is_derived() {
        let [s, f, d] = [0.4, 0.7, 0.6].map(Fixed::<Narrow>::operand);
        let exact = Fixed::<Narrow>::between(0.6, 0.6);
        let most = |term: Fixed<Narrow>, value: f64| (term.high() - value).max(value - term.low()) / STEP;
        // ½ for each operand, scaled by the other, and the product's own.
        assert!(most(s * f, 0.28) < 1.51 && most(exact * f, 0.42) < 1.01 && most(d, 0.6) < 0.51);
        assert!((s * Fixed::between(1.0, 1.0)) == s && (s * Fixed::between(0.0, 0.0)).high() == 0.0);
        let wide = Fixed::<Wide>::operand(0.4) * Fixed::operand(0.7);
        assert!(wide.low() < 0.28 && wide.high() > 0.28 && most(Fixed::between(wide.low(), wide.high()), 0.28) < 1e-4);
    }
}
