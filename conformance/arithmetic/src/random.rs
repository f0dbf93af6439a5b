//! Legal evaluations drawn at random: an f32 arithmetic that chooses order, rounding, form, fusion and flush as freely as the
//! accuracy rules let a compiler and a device choose. Whatever it draws must lie inside the intervals of
//! [`Accept`](super::Accept).

#![expect(clippy::float_cmp, reason = "a tie is one to the last bit")]

use super::format::{F32, Format as _};
use super::profile::current;
use lightmeter_reference::{Components, Real};
use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

thread_local! {
    static STATE: Cell<u64> = const { Cell::new(1) };
}

/// Starts this thread's draws at a seed.
pub fn seed(seed: u64) {
    STATE.set(seed);
}

fn random() -> u64 {
    let x = STATE.get().wrapping_add(0x9e37_79b9_7f4a_7c15);
    STATE.set(x);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

fn coin() -> bool {
    random() >> 63 == 1
}

fn below(n: usize) -> usize {
    usize::try_from(random() >> 33).unwrap_or_default() % n
}

/// −1 or 1 half the time, else evenly between: errors are sought at their bounds.
pub fn share() -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a random share")]
    let even = (random() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
    match random() >> 62 {
        0 => 1.0,
        1 => -1.0,
        _ => even,
    }
}

/// A value as some device may hold it, and the product that it was rounded from, which a fused operation would use.
#[derive(Clone, Copy, Debug)]
pub struct RandomLegal {
    /// The f32 that it is.
    pub value: f64,
    unrounded: f64,
}

/// One of the two neighbours in f32, and perhaps 0 for a subnormal.
fn round(x: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding is the point")]
    let nearest = x as f32;
    let wide = f64::from(nearest);
    let other = match wide.partial_cmp(&x) {
        Some(std::cmp::Ordering::Less) => nearest.next_up(),
        Some(std::cmp::Ordering::Greater) => nearest.next_down(),
        _ => nearest,
    };
    flush(if coin() { wide } else { f64::from(other) })
}

fn flush(x: f64) -> f64 {
    if x.abs() < F32::MIN_NORMAL && coin() { 0.0 } else { x }
}

impl RandomLegal {
    /// A number, rounded.
    #[must_use]
    pub fn of(x: f64) -> Self {
        let value = round(x);
        Self { value, unrounded: value }
    }

    /// The f32 that it is.
    #[must_use]
    pub const fn narrow(self) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "the value is an f32 already")]
        let narrow = self.value as f32;
        narrow
    }

    /// A built-in that errs by at most so much: some f32 within.
    fn within(x: f64, error: f64) -> Self {
        let (low, high) = (x - error, x + error);
        let value = round(x + share() * error);
        #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is a start")]
        let mut narrow = value as f32;
        while f64::from(narrow) > high {
            narrow = narrow.next_down();
        }
        while f64::from(narrow) < low {
            narrow = narrow.next_up();
        }
        let value = flush(f64::from(narrow));
        Self { value, unrounded: value }
    }

    /// c₀ + x(c₁ + x(c₂ + …)).
    fn polynomial(self, coefficients: &[f64]) -> Self {
        let constants = coefficients.iter().rev().map(|&c| Self::literal(c));
        constants.reduce(|sum, c| c + self * sum).unwrap_or_else(|| Self::literal(0.0))
    }

    /// The term of a sum: as rounded, or, fused, as the exact product.
    fn term(self) -> f64 {
        if coin() { self.unrounded } else { self.value }
    }
}

impl Add for RandomLegal {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        // A fused multiply-add takes one product unrounded.
        let exact = if coin() { self.term() + other.value } else { self.value + other.term() };
        Self::of(exact)
    }
}

impl Neg for RandomLegal {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, unrounded: -self.unrounded }
    }
}

impl Sub for RandomLegal {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for RandomLegal {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let unrounded = self.value * other.value;
        Self { unrounded, ..Self::of(unrounded) }
    }
}

impl Div for RandomLegal {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let exact = self.value / other.value;
        if exact == 0.0 { Self::of(0.0) } else { Self::within(exact, current(|p| p.divide_ulp) * F32::ulp(exact)) }
    }
}

/// Any order of a chain: two of what is left are combined until one is.
fn chain(items: &[RandomLegal], combine: impl Fn(RandomLegal, RandomLegal) -> RandomLegal) -> RandomLegal {
    let mut left = items.to_vec();
    while left.len() > 1 {
        let a = left.swap_remove(below(left.len()));
        let b = left.swap_remove(below(left.len()));
        left.push(combine(a, b));
    }
    left[0]
}

impl Real for RandomLegal {
    fn input(x: f32) -> Self {
        let value = flush(f64::from(x));
        Self { value, unrounded: value }
    }
    fn literal(x: f64) -> Self {
        Self::of(x)
    }
    fn max(self, other: Self) -> Self {
        if self.value >= other.value { self } else { other }
    }
    fn min(self, other: Self) -> Self {
        if self.value <= other.value { self } else { other }
    }
    fn abs(self) -> Self {
        if self.value < 0.0 { -self } else { self }
    }
    fn round(self) -> Self {
        let (floor, fraction) = (self.value.floor(), self.value.fract().rem_euclid(1.0));
        let up = fraction > 0.5 || (fraction == 0.5 && coin());
        let value = if up { floor + 1.0 } else { floor };
        Self { value, unrounded: value }
    }
    fn sqrt(self) -> Self {
        Self::of(1.0) / self.inverse_sqrt()
    }
    fn inverse_sqrt(self) -> Self {
        let exact = 1.0 / self.value.sqrt();
        Self::within(exact, current(|p| p.inverse_sqrt_ulp) * F32::ulp(exact))
    }
    fn exp(self) -> Self {
        let (exact, bound) = (core_math::exp(self.value), current(|p| p.exp_ulp));
        Self::within(exact, (bound.base + bound.slope * self.value.abs()) * F32::ulp(exact))
    }
    fn exp2(self) -> Self {
        let (exact, bound) = (core_math::exp2(self.value), current(|p| p.exp2_ulp));
        Self::within(exact, (bound.base + bound.slope * self.value.abs()) * F32::ulp(exact))
    }
    fn log2(self) -> Self {
        let (exact, profile) = (core_math::log2(self.value), current(|p| *p));
        let in_middle = (0.5..=2.0).contains(&self.value);
        Self::within(exact, if in_middle { profile.log2_absolute } else { profile.log2_ulp * F32::ulp(exact) })
    }
    fn pow(self, exponent: Self) -> Self {
        (exponent * self.log2()).exp2()
    }
    fn ln_1p(self) -> Self {
        if self.value.abs() > 0.0625 {
            let sum = (Self::literal(1.0) + self).value;
            let (exact, profile) = (core_math::log(sum), current(|p| *p));
            let in_middle = (0.5..=2.0).contains(&sum);
            let error = if in_middle { profile.log2_absolute } else { profile.log2_ulp * F32::ulp(exact) };
            return Self::within(exact, error);
        }
        let coefficients = [1.0, -1.0 / 2.0, 1.0 / 3.0, -1.0 / 4.0, 1.0 / 5.0, -1.0 / 6.0];
        self * self.polynomial(&coefficients)
    }
    fn exp_m1(self) -> Self {
        if self.value.abs() > 0.5 {
            return self.exp() - Self::literal(1.0);
        }
        let factorials = [1.0, 2.0, 6.0, 24.0, 120.0, 720.0, 5040.0, 40320.0];
        self * self.polynomial(&factorials.map(|factorial| 1.0 / factorial))
    }
    fn difference_of_products([a, b]: [Self; 2], [c, d]: [Self; 2]) -> Self {
        // The upper 12 bits of a significand, as the shader masks them.
        #[expect(clippy::cast_possible_truncation, reason = "the value is an f32 already")]
        let upper = |x: Self| Self::of(f64::from(f32::from_bits((x.value as f32).to_bits() & 0xffff_f000)));
        let product = |a: Self, b: Self| {
            let (p, a1, b1) = (a * b, upper(a), upper(b));
            let (a2, b2) = (a - a1, b - b1);
            [p, a1 * b1, -p, a1 * b2, a2 * b1, a2 * b2]
        };
        let terms: Vec<Self> = product(a, b).into_iter().chain(product(c, d).map(Neg::neg)).collect();
        chain(&terms, Add::add)
    }
    fn if_ge<T: Components<Self>>(a: Self, b: Self, then: impl FnOnce() -> T, otherwise: impl FnOnce() -> T) -> T {
        if a.value >= b.value { then() } else { otherwise() }
    }
    fn floor_then<T: Components<Self>>(self, then: impl Fn(f64) -> T) -> T {
        then(self.value.floor())
    }
    fn sum<const N: usize>(terms: [Self; N]) -> Self {
        chain(&terms, Add::add)
    }
    fn sum_over(terms: impl Iterator<Item = Self>) -> Self {
        let terms: Vec<Self> = terms.collect();
        if terms.is_empty() { Self::of(0.0) } else { chain(&terms, Add::add) }
    }
    fn product<const N: usize>(factors: [Self; N]) -> Self {
        chain(&factors, Mul::mul)
    }
    fn mix(a: Self, b: Self, t: Self) -> Self {
        if coin() { a + t * (b - a) } else { a * (Self::of(1.0) - t) + b * t }
    }
    fn mix_of_differences([to_a, to_b]: [Self; 2], from: Self, [a, b]: [Self; 2], t: Self) -> Self {
        if coin() { from - Self::mix(a, b, t) } else { Self::mix(to_a, to_b, t) }
    }
    fn normalize<const N: usize>(v: [Self; N]) -> [Self; N] {
        let square = Self::sum(v.map(|x| x * x));
        if coin() {
            let length = square.sqrt();
            v.map(|x| x / length)
        } else {
            let inverse = square.inverse_sqrt();
            v.map(|x| x * inverse)
        }
    }
    fn or_dark(self, vectors: [[Self; 3]; 3]) -> Self {
        let is_nothing = |v: &[Self; 3]| v.iter().all(|x| x.value == 0.0);
        if vectors.iter().any(is_nothing) && coin() { Self::of(0.0) } else { self }
    }
    fn quadratic([c0, c1, c2]: [Self; 3], x: Self) -> Self {
        if coin() { c0 + x * (c1 + x * c2) } else { Self::sum([c0, c1 * x, Self::product([c2, x, x])]) }
    }
    fn lobe(self, exponent: Self) -> Self {
        if self.value > 0.0 {
            self.pow(exponent)
        } else {
            Self::of(if exponent.value == 0.0 && coin() { 1.0 } else { 0.0 })
        }
    }
}
