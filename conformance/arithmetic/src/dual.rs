//! Dual numbers: a value and its derivative, from which the condition number of a formula follows.

use lightmeter_reference::{Components, Real};
use std::f64::consts::LN_2;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `value + slope·ε` with ε² = 0: `slope` is the derivative with respect to the one input whose slope is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The value.
    pub value: f64,
    /// Its derivative.
    pub slope: f64,
}

impl Dual {
    /// The input with respect to which the derivative is taken.
    #[must_use]
    pub const fn variable(value: f64) -> Self {
        Self { value, slope: 1.0 }
    }

    /// An input that is held constant.
    #[must_use]
    pub const fn constant(value: f64) -> Self {
        Self { value, slope: 0.0 }
    }

    /// `f(value)` with `f′(value)`. A slope of 0 stays 0 where the derivative is infinite.
    fn chain(self, value: f64, derivative: f64) -> Self {
        Self { value, slope: if self.slope == 0.0 { 0.0 } else { self.slope * derivative } }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, slope: self.slope * other.value + self.value * other.slope }
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self { value, slope: (self.slope - value * other.slope) / other.value }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

impl Real for Dual {
    fn input(x: f32) -> Self {
        Self::constant(f64::from(x))
    }
    fn literal(x: f64) -> Self {
        Self::constant(x)
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
        Self::constant(self.value.round_ties_even())
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    fn inverse_sqrt(self) -> Self {
        let value = 1.0 / self.value.sqrt();
        self.chain(value, -0.5 * value / self.value)
    }
    fn exp(self) -> Self {
        let value = core_math::exp(self.value);
        self.chain(value, value)
    }
    fn exp2(self) -> Self {
        let value = core_math::exp2(self.value);
        self.chain(value, value * LN_2)
    }
    fn log2(self) -> Self {
        self.chain(core_math::log2(self.value), 1.0 / (self.value * LN_2))
    }
    fn pow(self, exponent: Self) -> Self {
        let value = core_math::pow(self.value, exponent.value);
        let by_base = self.chain(value, exponent.value * core_math::pow(self.value, exponent.value - 1.0)).slope;
        let by_exponent = exponent.chain(value, value * core_math::log(self.value)).slope;
        Self { value, slope: by_base + by_exponent }
    }
    fn ln_1p(self) -> Self {
        self.chain(core_math::log1p(self.value), 1.0 / (1.0 + self.value))
    }
    fn exp_m1(self) -> Self {
        self.chain(core_math::expm1(self.value), core_math::exp(self.value))
    }
    fn floor_then<T: Components<Self>>(self, then: impl Fn(f64) -> T) -> T {
        then(self.value.floor())
    }
    fn if_ge<T: Components<Self>>(a: Self, b: Self, then: impl FnOnce() -> T, otherwise: impl FnOnce() -> T) -> T {
        if a.value >= b.value { then() } else { otherwise() }
    }
}

/// How much an output amplifies the inputs' relative errors: Σᵢ |xᵢ·∂y/∂xᵢ| / |y|, from the dual outputs for each input
/// in turn. 0 for an output that does not depend on its inputs, infinite for one that cancels to 0.
#[must_use]
pub fn condition(inputs: &[f32], outputs_by_input: &[Vec<Dual>], output: usize) -> f64 {
    let moved: f64 = inputs
        .iter()
        .zip(outputs_by_input)
        .map(|(&x, outputs)| {
            let slope = outputs[output].slope;
            if x == 0.0 || slope == 0.0 { 0.0 } else { (f64::from(x) * slope).abs() }
        })
        .sum();
    match outputs_by_input.first() {
        Some(outputs) if moved != 0.0 => moved / outputs[output].value.abs(),
        _ => 0.0,
    }
}
