//! An arithmetic of 115 digits, each number with a bound of its error: what the f64 reference is certified against.
//!
//! `+ − ×` keep 640 bits, so that sums and products of f32 inputs are exact: a product of two spans at most
//! 2·(128 + 149) bits. Quotients, roots and functions are dashu's, correctly rounded to 384 bits (115 digits). A number
//! carries the binary logarithm of a bound of its error, or that it is exact; the bound grows with each operation by that
//! operation's derivative, so cancellation is seen and never assumed away. Nothing of f64's arithmetic is shared.
//!
//! A number is a handle into an arena of its thread, which [`clear`] empties; handles of before are then meaningless.

use dashu_float::ops::Abs as _;
use dashu_float::round::{Rounded, mode::HalfEven};
use dashu_float::{ConstCache, Context, FBig, FpError, Repr};
use lightmeter_reference::{Components, Real};
use std::cell::RefCell;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number of many binary digits.
pub type Float = FBig<HalfEven, 2>;

/// Bits that sums and products keep.
const SUM_BITS: usize = 640;
/// Bits to which all else is correctly rounded.
const FUNCTION_BITS: usize = 384;
/// Arguments of exp from which the result counts as out of any range: e^(2²⁴) has 7 million digits before the point.
const MOST_EXPONENT: i64 = 24;

/// What an evaluation met on its way.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Course {
    /// The side or the whole number that each choice came to, in order; 1 for `then`.
    pub choices: Vec<i64>,
    /// Which of them lay within the error of what was compared: taken as equal.
    pub undecided: Vec<usize>,
    /// Whether some intermediate value is too great for f64.
    pub beyond_f64: bool,
}

/// A value and the bound of its error.
#[derive(Clone, Debug)]
struct Number {
    value: Float,
    /// |value − true value| ≤ 2^error; exact where there is none.
    error: Option<i64>,
}

#[derive(Default)]
struct Arena {
    numbers: Vec<Number>,
    course: Course,
    constants: ConstCache,
}

thread_local! {
    static ARENA: RefCell<Arena> = RefCell::default();
}

/// A real number to 115 digits, or none where the formula has no value.
#[derive(Clone, Copy, Debug)]
pub struct Exact(Option<usize>);

/// Empties this thread's arena and returns what was met since it was last emptied.
pub fn clear() -> Course {
    ARENA.with_borrow_mut(|arena| {
        arena.numbers.clear();
        std::mem::take(&mut arena.course)
    })
}

/// What was met since then.
#[must_use]
pub fn course() -> Course {
    ARENA.with_borrow(|arena| arena.course.clone())
}

/// |x| < 2^magnitude, and ≥ half of that; the least there is for 0.
fn magnitude(x: &Float) -> i64 {
    if x.repr().significand() == &0.into() {
        return i64::MIN / 4;
    }
    let digits = i64::try_from(x.repr().digits()).unwrap_or(i64::MAX / 4);
    digits + i64::try_from(x.repr().exponent()).unwrap_or(i64::MAX / 4)
}

/// The logarithm of a bound of 2^a + 2^b.
fn both(a: Option<i64>, b: Option<i64>) -> Option<i64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.max(b) + 1),
        (one, other) => one.or(other),
    }
}

impl Number {
    const fn exact(value: Float) -> Self {
        Self { value, error: None }
    }

    /// A result rounded to `bits` bits, of operands whose errors come to `carried`.
    fn rounded(result: Result<Rounded<Float>, FpError>, bits: usize, carried: Option<i64>) -> Option<Self> {
        let bits = i64::try_from(bits).unwrap_or(i64::MAX / 4);
        let (value, inexact) = match result.ok()? {
            Rounded::Exact(value) => (value, false),
            Rounded::Inexact(value, _) => (value, true),
        };
        if value.repr().is_infinite() {
            return None;
        }
        let own = inexact.then(|| magnitude(&value) - bits);
        Some(Self { value, error: both(carried, own) })
    }

    /// Whether the value's own sign is the true one, or 0 exactly.
    fn is_decided(&self) -> bool {
        self.error.is_none_or(|error| magnitude(&self.value) > error + 1)
    }

    /// Whether the error is below an eighth of the value, so that a derivative there holds for the true one within a factor 2.
    fn is_clear_of_zero(&self) -> bool {
        self.error.is_none_or(|error| error <= magnitude(&self.value) - 4)
    }

    fn sign(&self) -> Ordering {
        self.value.partial_cmp(&Float::ZERO).unwrap_or(Ordering::Equal)
    }

    fn repr(&self) -> &Repr<2> {
        self.value.repr()
    }

    fn add(&self, other: &Self) -> Option<Self> {
        let carried = both(self.error, other.error);
        Self::rounded(sums().add(self.repr(), other.repr()), SUM_BITS, carried)
    }

    fn negated(&self) -> Self {
        Self { value: -self.value.clone(), error: self.error }
    }

    fn mul(&self, other: &Self) -> Option<Self> {
        let (a, b) = (magnitude(&self.value), magnitude(&other.value));
        let crossed = self.error.zip(other.error).map(|(e, f)| e + f);
        let carried = both(both(other.error.map(|e| a + e), self.error.map(|e| b + e)), crossed);
        Self::rounded(sums().mul(self.repr(), other.repr()), SUM_BITS, carried)
    }

    fn div(&self, divisor: &Self) -> Option<Self> {
        if divisor.sign().is_eq() || !divisor.is_clear_of_zero() {
            return None;
        }
        let quotient = Self::rounded(functions().div(self.repr(), divisor.repr()), FUNCTION_BITS, None)?;
        // (e + |q|·f)/(|d| − f), and |d| − f ≥ 2^(magnitude − 2).
        let moved = both(self.error, divisor.error.map(|f| f + magnitude(&quotient.value) + 1));
        let carried = moved.map(|moved| moved - (magnitude(&divisor.value) - 2));
        Some(Self { error: both(quotient.error, carried), ..quotient })
    }

    fn sqrt(&self) -> Option<Self> {
        if !self.is_clear_of_zero() {
            // Somewhere from 0 to √(|value| + 2^error).
            let most = magnitude(&self.value).max(self.error?) + 1;
            return Some(Self { value: Float::ZERO, error: Some(most.div_euclid(2) + 1) });
        }
        if self.sign().is_lt() {
            return None;
        }
        let carried = self.error.map(|e| e - (magnitude(&self.value) - 2).div_euclid(2));
        Self::rounded(functions().sqrt(self.repr()), FUNCTION_BITS, carried)
    }

    fn exp(&self, constants: &mut ConstCache) -> Option<Self> {
        // e^(x ± 2^e) errs by at most 2^(e + 1) of itself for e < 0.
        if self.error.is_some_and(|error| error > -1) {
            return None;
        }
        if magnitude(&self.value) > MOST_EXPONENT {
            let vanished = Self { value: Float::ZERO, error: Some(-(1 << MOST_EXPONENT)) };
            return self.sign().is_lt().then_some(vanished);
        }
        let plain = Self::rounded(functions().exp(self.repr(), Some(constants)), FUNCTION_BITS, None)?;
        let carried = self.error.map(|e| magnitude(&plain.value) + e + 1);
        Some(Self { error: both(plain.error, carried), ..plain })
    }

    fn ln(&self, constants: &mut ConstCache) -> Option<Self> {
        if self.sign().is_le() || !self.is_clear_of_zero() {
            return None;
        }
        let carried = self.error.map(|e| e - (magnitude(&self.value) - 2));
        Self::rounded(functions().ln(self.repr(), Some(constants)), FUNCTION_BITS, carried)
    }

    /// The sign of self − other, and whether it is beyond doubt.
    fn compare(&self, other: &Self) -> Option<(Ordering, bool)> {
        let difference = self.add(&other.negated())?;
        Some((difference.sign(), difference.is_decided()))
    }
}

const fn sums() -> Context<HalfEven> {
    Context::new(SUM_BITS)
}

const fn functions() -> Context<HalfEven> {
    Context::new(FUNCTION_BITS)
}

impl Arena {
    fn put(&mut self, number: Option<Number>) -> Exact {
        let Some(number) = number else { return Exact(None) };
        let size = magnitude(&number.value);
        self.course.beyond_f64 |= size > 1024;
        self.numbers.push(number);
        Exact(Some(self.numbers.len() - 1))
    }

    fn choose(&mut self, choice: i64, is_decided: bool) {
        if !is_decided {
            self.course.undecided.push(self.course.choices.len());
        }
        self.course.choices.push(choice);
    }
}

fn unary(x: Exact, f: impl FnOnce(&Number, &mut ConstCache) -> Option<Number>) -> Exact {
    ARENA.with_borrow_mut(|arena| {
        let result = x.0.and_then(|x| f(&arena.numbers[x], &mut arena.constants));
        arena.put(result)
    })
}

fn binary(a: Exact, b: Exact, f: impl FnOnce(&Number, &Number) -> Option<Number>) -> Exact {
    ARENA.with_borrow_mut(|arena| {
        let result = a.0.zip(b.0).and_then(|(a, b)| f(&arena.numbers[a], &arena.numbers[b]));
        arena.put(result)
    })
}

impl Add for Exact {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        binary(self, other, Number::add)
    }
}

impl Sub for Exact {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Exact {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        binary(self, other, Number::mul)
    }
}

impl Div for Exact {
    type Output = Self;
    fn div(self, divisor: Self) -> Self {
        binary(self, divisor, Number::div)
    }
}

impl Neg for Exact {
    type Output = Self;
    fn neg(self) -> Self {
        unary(self, |x, _| Some(x.negated()))
    }
}

/// A whole number over another.
fn ratio(numerator: u64, denominator: u128) -> Option<Number> {
    let [numerator, denominator] = [Float::from(numerator), Float::from(denominator)].map(Number::exact);
    numerator.div(&denominator)
}

/// The number that a literal of a source text stands for: the short decimal, or the ratio of small numbers, to which it is
/// the nearest f64; else itself.
fn written(x: f64) -> Option<Number> {
    /// Digits of a decimal that someone wrote.
    const MOST_DIGITS: usize = 10;
    let text = format!("{:e}", x.abs());
    let (digits, exponent) = text.split_once('e')?;
    let whole = digits.replace('.', "");
    let places = exponent.parse::<i64>().ok()? - i64::try_from(whole.len()).ok()? + 1;
    let signed = |number: Number| if x < 0.0 { number.negated() } else { number };
    if whole.len() <= MOST_DIGITS {
        let (digits, scale) = (whole.parse().ok()?, 10_u128.checked_pow(u32::try_from(places.abs()).ok()?)?);
        let number = if places < 0 {
            ratio(digits, scale)?
        } else {
            Number::exact(Float::from(digits)).mul(&Number::exact(Float::from(scale)))?
        };
        return Some(signed(number));
    }
    for denominator in 1..=1000_u32 {
        let numerator = (x.abs() * f64::from(denominator)).round();
        #[expect(clippy::float_cmp, reason = "the ratio's nearest f64 is the literal itself or it is not")]
        if numerator / f64::from(denominator) == x.abs() && numerator < 1e6 {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below a million")]
            return ratio(numerator as u64, denominator.into()).map(signed);
        }
    }
    Float::try_from(x).ok().map(Number::exact)
}

impl Real for Exact {
    fn input(x: f32) -> Self {
        ARENA.with_borrow_mut(|arena| {
            let number = if x.is_finite() { Float::try_from(f64::from(x)).ok() } else { None };
            arena.put(number.map(Number::exact))
        })
    }

    fn literal(x: f64) -> Self {
        ARENA.with_borrow_mut(|arena| arena.put(written(x)))
    }

    fn max(self, other: Self) -> Self {
        binary(self, other, |a, b| {
            let (order, is_decided) = a.compare(b)?;
            let greater = if order.is_ge() { a } else { b };
            let error = if is_decided { greater.error } else { both(a.error, b.error) };
            Some(Number { value: greater.value.clone(), error })
        })
    }

    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }

    fn abs(self) -> Self {
        unary(self, |x, _| Some(Number { value: x.value.clone().abs(), error: x.error }))
    }

    fn round(self) -> Self {
        ARENA.with_borrow_mut(|arena| {
            let Some(x) = self.0.map(|x| arena.numbers[x].clone()) else { return Self(None) };
            // To the nearest whole number, ties to even, as the type has it.
            let whole = x.value.to_int().value();
            let middle = Number::exact(Float::from(2 * whole.clone() + 1) / Float::from(2));
            let below = Number::exact(Float::from(2 * whole.clone() - 1) / Float::from(2));
            let is_decided = [middle, below].iter().all(|tie| x.compare(tie).is_some_and(|(_, decided)| decided));
            arena.choose(i64::try_from(&whole).unwrap_or(i64::MAX), is_decided);
            arena.put(Some(Number::exact(Float::from(whole))))
        })
    }

    fn sqrt(self) -> Self {
        unary(self, |x, _| x.sqrt())
    }

    fn inverse_sqrt(self) -> Self {
        Self::literal(1.0) / self.sqrt()
    }

    fn exp(self) -> Self {
        unary(self, Number::exp)
    }

    fn exp2(self) -> Self {
        unary(self, |x, constants| x.mul(&Number::exact(Float::from(2)).ln(constants)?)?.exp(constants))
    }

    fn ln_1p(self) -> Self {
        unary(self, |x, constants| Number::exact(Float::from(1)).add(x)?.ln(constants))
    }

    fn exp_m1(self) -> Self {
        unary(self, |x, constants| x.exp(constants)?.add(&Number::exact(Float::from(-1))))
    }

    fn log2(self) -> Self {
        unary(self, |x, constants| x.ln(constants)?.div(&Number::exact(Float::from(2)).ln(constants)?))
    }

    fn pow(self, exponent: Self) -> Self {
        ARENA.with_borrow_mut(|arena| {
            let power = self.0.zip(exponent.0).and_then(|(x, exponent)| {
                let logarithm = arena.numbers[x].clone().ln(&mut arena.constants)?;
                logarithm.mul(&arena.numbers[exponent])?.exp(&mut arena.constants)
            });
            arena.put(power)
        })
    }

    fn if_ge<T: Components<Self>>(a: Self, b: Self, then: impl FnOnce() -> T, otherwise: impl FnOnce() -> T) -> T {
        let side = ARENA.with_borrow_mut(|arena| {
            let (order, is_decided) = a.0.zip(b.0).and_then(|(a, b)| arena.numbers[a].compare(&arena.numbers[b]))?;
            // What no digit of 115 tells apart is taken as equal.
            let side = order.is_ge() || !is_decided;
            arena.choose(side.into(), is_decided);
            Some(side)
        });
        match side {
            Some(true) => then(),
            Some(false) => otherwise(),
            // Nothing follows from a condition on no value.
            None => then().zip(otherwise(), |_, _| Self(None)),
        }
    }

    fn floor_then<T: Components<Self>>(self, then: impl Fn(f64) -> T) -> T {
        let whole = ARENA.with_borrow_mut(|arena| {
            let x = arena.numbers[self.0?].clone();
            let floor = x.value.floor();
            let next = Number::exact(floor.clone() + Float::ONE);
            let is_decided = [Number::exact(floor.clone()), next]
                .iter()
                .all(|edge| x.error.is_none() || x.compare(edge).is_some_and(|(_, decided)| decided));
            let whole = floor.to_f64().value();
            #[expect(clippy::cast_possible_truncation, reason = "a whole number, told apart from its neighbours")]
            arena.choose(whole as i64, is_decided);
            Some(whole)
        });
        match whole {
            Some(whole) => then(whole),
            None => then(0.0).zip(then(0.0), |_, _| Self(None)),
        }
    }
}

impl Exact {
    /// The value and the binary logarithm of the bound of its error; nothing where the formula has no value.
    #[must_use]
    pub fn get(self) -> Option<(Float, Option<i64>)> {
        self.0.map(|x| ARENA.with_borrow(|arena| (arena.numbers[x].value.clone(), arena.numbers[x].error)))
    }

    /// Whether it is not 0, and may be for all that its digits tell.
    #[must_use]
    pub fn is_not_told_from_zero(self) -> bool {
        self.get()
            .is_some_and(|(value, error)| value != Float::ZERO && error.is_some_and(|error| magnitude(&value) <= error))
    }

    /// Decimal digits of it that are sure beside a number of that size; nothing where all are.
    #[must_use]
    pub fn digits_beside(self, size: f64) -> Option<u32> {
        let error = self.get()?.1?;
        let bits = magnitude(&Float::try_from(size).ok()?) - 1 - error;
        // log₁₀ 2 is above 0.301.
        u32::try_from(bits.max(0).saturating_mul(301) / 1000).ok()
    }

    /// |x − self|, rounded to 53 bits, and the same over |self|, infinite where self may be 0 and x is not.
    #[must_use]
    pub fn distance(self, x: f64) -> Option<(f64, f64)> {
        let (value, _) = self.get().filter(|_| x.is_finite())?;
        let difference = (Float::try_from(x).ok()?.with_precision(SUM_BITS).value() - &value).abs();
        let zero = Float::ZERO;
        let relative = match (difference == zero, value == zero) {
            (true, _) => 0.0,
            (false, true) => f64::INFINITY,
            _ => functions().div(difference.repr(), value.repr()).ok()?.value().abs().to_f64().value(),
        };
        Some((difference.to_f64().value(), relative))
    }

    /// Whether the true value may lie from `low` to `high`: it does, but for what the error leaves open.
    #[must_use]
    pub fn lies_within(self, low: f64, high: f64) -> bool {
        let Some((value, error)) = self.get() else { return false };
        let x = Number { value, error };
        let end = |end: f64, side: Ordering| {
            let Ok(end) = Float::try_from(end) else { return false };
            end.repr().is_infinite()
                || x.compare(&Number::exact(end)).is_some_and(|(order, decided)| order != side || !decided)
        };
        end(low, Ordering::Less) && end(high, Ordering::Greater)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The digits of published tables, of which 50 or more must agree.
    fn agrees(x: Exact, digits: &str) {
        let (value, _) = x.get().expect("there is a value");
        let sure = x.digits_beside(value.to_f64().value());
        let decimal = value.with_base_and_precision::<10>(90).value().to_string();
        let (digits, count) = (digits.replace(' ', ""), digits.chars().filter(char::is_ascii_digit).count());
        assert!(count > 50 && sure >= Some(90), "{sure:?} digits of {decimal}");
        assert!(decimal.starts_with(&digits), "{decimal} is not {digits}");
    }

    #[test]
    fn constants_are_those_of_the_tables() {
        let number = Exact::literal;
        agrees(number(1.0).exp(), "2.71828182845904523536028747135266249775724709369995957");
        agrees(number(2.0).sqrt(), "1.41421356237309504880168872420969807856967187537694807");
        agrees(number(2.0).inverse_sqrt(), "0.70710678118654752440084436210484903928483593768847403");
        agrees(number(1.0) / number(1.0).exp().log2(), "0.69314718055994530941723212145817656807550013436025525");
        agrees(number(10.0).log2(), "3.32192809488736234787031942948939017586483139302458061");
        agrees(number(0.5).exp2(), "1.41421356237309504880168872420969807856967187537694807");
        // 2^(5/12), a fourth of equal temperament: the exponent of sRGB is 5/12 and not its nearest f64.
        agrees(number(2.0).pow(number(1.0 / 2.4)), "1.33483985417003436483083188118445277491239021262519829");
    }

    #[test]
    fn laws_hold_to_what_is_promised() {
        clear();
        for k in 1..200_u16 {
            let x = Exact::input(f32::from(k) * 0.37 + 1e-3);
            let one = Exact::literal(1.0);
            let back = [
                x.log2().exp2(),
                x.sqrt() * x.sqrt(),
                one / (x.inverse_sqrt() * x.inverse_sqrt()),
                x.pow(Exact::literal(2.4)).pow(one / Exact::literal(2.4)),
                (x / Exact::literal(3.0)) * Exact::literal(3.0),
                one / (-x).exp().log2() * (-x) * one.exp().log2() * x,
            ];
            for (law, back) in back.into_iter().enumerate() {
                let (difference, error) = (back - x).get().expect("there is a value");
                assert!(error.is_none_or(|error| magnitude(&difference) <= error), "law {law} at {k}");
                assert!(magnitude(&difference) < -250, "law {law} at {k}: {}", magnitude(&difference));
            }
        }
    }

    #[test]
    fn sums_and_products_of_inputs_are_exact() {
        clear();
        let (least, most) = (Exact::input(f32::from_bits(1)), Exact::input(f32::MAX));
        let back = (most * most + least * least) - most * most;
        assert_eq!((back - least * least).get(), Some((Float::ZERO, None)));
        assert_eq!(
            Exact::literal(0.1).get().and_then(|x| x.1),
            Some(-3 - i64::try_from(FUNCTION_BITS).expect("a few hundred"))
        );
        assert_eq!((Exact::input(0.1) - Exact::literal(f64::from(0.1_f32))).get(), Some((Float::ZERO, None)));
    }

    #[test]
    fn errors_are_bounded() {
        clear();
        // The same to half as many digits must lie within the bound that those digits come with: cancellation is seen.
        let third = Exact::literal(1.0) / Exact::literal(3.0);
        let close = third * Exact::literal(3.0) - Exact::literal(1.0);
        let (value, error) = close.get().expect("there is a value");
        assert!(magnitude(&value) <= error.expect("some rounding") && close.digits_beside(1.0) >= Some(95));
        assert!(close.digits_beside(value.to_f64().value()) <= Some(1));
        Exact::if_ge(close, Exact::literal(0.0), || close, || third);
        let course = clear();
        assert_eq!((course.choices, course.undecided), (vec![1], vec![0]));
    }

    #[test]
    fn what_has_no_value_has_none() {
        clear();
        let (zero, one) = (Exact::literal(0.0), Exact::literal(1.0));
        for none in [one / zero, (-one).sqrt(), zero.log2(), Exact::input(f32::NAN), one.exp2() / (one - one)] {
            assert!(none.get().is_none() && (none + one).get().is_none() && none.max(one).get().is_none());
            assert!(Exact::if_ge(none, one, || one, || zero).get().is_none());
        }
        assert!(zero.sqrt().get().is_some_and(|x| x.0 == Float::ZERO));
    }

    #[test]
    fn rounding_goes_to_the_even_neighbour() {
        clear();
        for (x, rounded) in [(0.5, 0.0), (1.5, 2.0), (2.5, 2.0), (2.49, 2.0), (2.51, 3.0), (254.5, 254.0), (-0.7, -1.0)]
        {
            let (difference, error) = (Exact::literal(x).round() - Exact::literal(rounded)).get().expect("a value");
            assert_eq!((difference, error), (Float::ZERO, None), "{x}");
        }
        // A tie that is exact is decided; one that is not to be told from a tie is not.
        assert!(clear().undecided.is_empty());
        let half = Exact::literal(0.5).sqrt() * Exact::literal(0.5).sqrt();
        let rounded = half.round().get().map(|x| x.0);
        assert!(rounded == Some(Float::ONE) || rounded == Some(Float::ZERO), "{rounded:?}");
        assert_eq!(clear().undecided, [0]);
    }
}
