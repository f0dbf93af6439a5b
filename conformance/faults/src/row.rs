//! A row of inputs by name, in any arithmetic.

use lightmeter_arithmetic::mistaken::{Alter, Mistaken};
use lightmeter_arithmetic::{Accept, F16, F32, Format};
use lightmeter_catalogue::cases::{AnyFormula, Spec};
use lightmeter_reference::{Real, Vector};
use std::cmp::Ordering;

/// An arithmetic that the formulas of the catalogue can be evaluated in, steps going wrong, once their types are forgotten.
pub trait Arithmetic: Alter {
    /// The formula's outputs for a row of inputs.
    fn evaluate(formula: &dyn AnyFormula, inputs: &[Mistaken<Self>], out: &mut [Mistaken<Self>]);

    /// In half precision, overflow to infinity, subnormal numbers kept or not.
    #[must_use]
    fn in_half(self, by: Narrowing) -> Self;

    /// In bfloat16.
    #[must_use]
    fn in_bfloat(self, by: Narrowing) -> Self;

    /// 1/√self by half its bits taken from a constant, and one step of Newton's method.
    #[must_use]
    fn fast_inverse_sqrt(self) -> Self;
}

/// How a number comes to have fewer bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Narrowing {
    /// It becomes the nearest, the even one at a tie.
    Rounded,
    /// Its last bits are cut off.
    Cut,
}

/// bfloat16: the range of binary32, 8 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Bf16;

impl Format for Bf16 {
    const FRACTION_BITS: u32 = 7;
    const EPSILON: f64 = 1.0 / 128.0;
    const MIN_NORMAL: f64 = F32::MIN_NORMAL;
    const MIN_SUBNORMAL: f64 = F32::MIN_NORMAL / 128.0;
    const MAX: f64 = 338_953_138_925_153_547_590_470_800_371_487_866_880.0;
}

/// A number of a format: the nearest one, infinite from half a step beyond the greatest, or the next one towards 0,
/// infinite from a step beyond.
fn narrow<F: Format>(x: f64, by: Narrowing) -> f64 {
    if !x.is_finite() {
        return x;
    }
    let step = F::EPSILON * F::MIN_NORMAL;
    if x.abs() < F::MIN_NORMAL {
        return match by {
            Narrowing::Rounded => (x / step).round_ties_even() * step,
            Narrowing::Cut => (x / step).trunc() * step,
        };
    }
    let (low, high) = (F::round_down(x), F::round_up(x));
    if by == Narrowing::Cut {
        let cut = if x > 0.0 { low } else { high };
        return if cut.abs() > F::MAX { f64::INFINITY.copysign(x) } else { cut };
    }
    let is_even = |x: f64| x.to_bits() & (1 << (52 - F::FRACTION_BITS)) == 0;
    let rounded = match (x - low).total_cmp(&(high - x)) {
        Ordering::Less => low,
        Ordering::Greater => high,
        Ordering::Equal if is_even(low) => low,
        Ordering::Equal => high,
    };
    if rounded.abs() > F::MAX { f64::INFINITY.copysign(x) } else { rounded }
}

/// The numbers of a format that those of an interval become.
fn narrow_each<F: Format>(x: Accept, by: Narrowing) -> Accept {
    let (low, high) = (narrow::<F>(x.low(), by), narrow::<F>(x.high(), by));
    if x.is_any() || low.is_infinite() || high.is_infinite() {
        return Accept::ANY;
    }
    // What is too small for a normal number may be lost.
    let (low, high) =
        if low < F::MIN_NORMAL && high > -F::MIN_NORMAL { (low.min(0.0), high.max(0.0)) } else { (low, high) };
    Accept::from_bounds(low, high)
}

impl Arithmetic for f64 {
    fn evaluate(formula: &dyn AnyFormula, inputs: &[Mistaken<Self>], out: &mut [Mistaken<Self>]) {
        formula.on_mistaken_f64(inputs, out);
    }

    fn in_half(self, by: Narrowing) -> Self {
        narrow::<F16>(self, by)
    }

    fn in_bfloat(self, by: Narrowing) -> Self {
        narrow::<Bf16>(self, by)
    }

    fn fast_inverse_sqrt(self) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "its bits are those of binary32")]
        let x = (self as f32).fast_inverse_sqrt();
        x.into()
    }
}

impl Arithmetic for f32 {
    fn evaluate(formula: &dyn AnyFormula, inputs: &[Mistaken<Self>], out: &mut [Mistaken<Self>]) {
        formula.on_mistaken_f32(inputs, out);
    }

    #[expect(clippy::cast_possible_truncation, reason = "a number of half precision is one of f32")]
    fn in_half(self, by: Narrowing) -> Self {
        narrow::<F16>(self.into(), by) as Self
    }

    #[expect(clippy::cast_possible_truncation, reason = "a number of bfloat16 is one of f32")]
    fn in_bfloat(self, by: Narrowing) -> Self {
        narrow::<Bf16>(self.into(), by) as Self
    }

    fn fast_inverse_sqrt(self) -> Self {
        let rough = Self::from_bits(0x5f37_59df_u32.wrapping_sub(self.to_bits() >> 1));
        rough * (1.5 - 0.5 * self * rough * rough)
    }
}

impl Arithmetic for Accept {
    fn evaluate(formula: &dyn AnyFormula, inputs: &[Mistaken<Self>], out: &mut [Mistaken<Self>]) {
        formula.on_mistaken_accept(inputs, out);
    }

    fn in_half(self, by: Narrowing) -> Self {
        narrow_each::<F16>(self, by)
    }

    fn in_bfloat(self, by: Narrowing) -> Self {
        narrow_each::<Bf16>(self, by)
    }

    fn fast_inverse_sqrt(self) -> Self {
        // It falls as its argument grows, but for the rounding of its steps.
        const ROUNDING: f64 = 1.0 / 2_097_152.0;
        if self.is_any() || self.low() <= 0.0 {
            return Self::ANY;
        }
        let (least, greatest) = (self.high().fast_inverse_sqrt(), self.low().fast_inverse_sqrt());
        Self::from_bounds(least.min(greatest) * (1.0 - ROUNDING), least.max(greatest) * (1.0 + ROUNDING))
    }
}

/// A formula's inputs by name.
#[derive(Clone, Copy, Debug)]
pub(super) struct InputRow<'a, R> {
    spec: &'a Spec,
    numbers: &'a [R],
}

impl<'a, R: Real> InputRow<'a, R> {
    pub(super) const fn new(spec: &'a Spec, numbers: &'a [R]) -> Self {
        Self { spec, numbers }
    }

    /// An input of `N` numbers; `None` where the formula has none of that name and size.
    pub(super) fn array<const N: usize>(&self, name: &str) -> Option<[R; N]> {
        self.numbers.get(self.spec.place(name)?)?.try_into().ok()
    }

    pub(super) fn scalar(&self, name: &str) -> Option<R> {
        self.array(name).map(|[x]| x)
    }

    pub(super) fn vector<const N: usize>(&self, name: &str) -> Option<Vector<R, N>> {
        self.array(name).map(Vector)
    }
}

/// Puts a vector on a row of outputs, as far as that goes.
pub(super) fn put<R: Copy, const N: usize>(out: &mut [R], at: usize, v: Vector<R, N>) {
    for (to, x) in out.iter_mut().skip(at).zip(v.0) {
        *to = x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::formulas;

    #[test]
    fn inputs_are_found_by_name_and_size() {
        let member = formulas().iter().find(|member| member.spec.id == "fog/linear").expect("fog/linear");
        let numbers: Vec<f64> = (0..11).map(f64::from).collect();
        let row = InputRow::new(&member.spec, &numbers);
        assert_eq!((row.scalar("dmin"), row.scalar("p"), row.scalar("density")), (Some(3.0), None, None));
        assert_eq!(row.vector::<3>("shaded"), Some(Vector([8.0, 9.0, 10.0])));
    }
}
