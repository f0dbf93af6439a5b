//! Acceptance intervals: every value that the accuracy rules of a shading language permit.
//!
//! The method is that of the WebGPU conformance suite's `fp_primer`, carried through whole formulas. An interval's ends
//! are f64 numbers on the grid of the format, rounded outward. Rules, each where it is used:
//!
//! * `+ − ×` are correctly rounded, up *or* down, so one operation reaches both neighbours of the exact result. A fused
//!   multiply-add keeps the exact product, which lies between those neighbours and so inside.
//! * A chain may be reassociated: any order of Σxᵢ over n terms errs by at most ((1+ε)ⁿ⁻¹ − 1)·Σ|xᵢ| with ε = 2⁻²³ for
//!   directed rounding; a product of n factors by the same factor of its value.
//! * A value that may be subnormal may be flushed: the hull with 0.
//! * Built-ins are widened by the bound that the [`Profile`](super::Profile) states; the values of the format within it
//!   are legal.
//! * Where rules permit anything (overflow, a divisor that may be 0) the value is [`Accept::ANY`].

#![expect(clippy::float_cmp, reason = "ends of intervals are compared exactly: a point is a point to the last bit")]

mod chain;

use super::format::{F32, F64_SLACK, Format};
use super::order::{greater, lesser};
use super::paths;
use super::profile::{Excess, GrowingUlp, assert_in_force, current, relative};
use chain::chain_error;
use lightmeter_reference::{Components, Real};
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// An interval of legal values of a format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accept<F = F32> {
    low: f64,
    high: f64,
    format: PhantomData<F>,
}

impl<F: Format> Accept<F> {
    /// The rules permit any value, NaN included.
    pub const ANY: Self = Self::raw(f64::NEG_INFINITY, f64::INFINITY);

    const fn raw(low: f64, high: f64) -> Self {
        Self { low, high, format: PhantomData }
    }

    /// Exactly one value, which must be one of the format.
    #[must_use]
    pub const fn exactly(x: f64) -> Self {
        Self::raw(x, x)
    }

    /// All values of the format from `low` to `high`, rounded outward.
    #[must_use]
    pub fn from_bounds(low: f64, high: f64) -> Self {
        Self::seal(low, high)
    }

    /// The least legal value.
    #[must_use]
    pub const fn low(&self) -> f64 {
        self.low
    }

    /// The greatest legal value.
    #[must_use]
    pub const fn high(&self) -> f64 {
        self.high
    }

    /// Whether the rules permit anything here.
    #[must_use]
    pub fn is_any(&self) -> bool {
        self.low == f64::NEG_INFINITY && self.high == f64::INFINITY
    }

    /// Whether `x` is a legal value. A NaN is legal only where anything is.
    #[must_use]
    pub fn contains(&self, x: f64) -> bool {
        self.is_any() || (self.low <= x && x <= self.high)
    }

    /// high − low.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.high - self.low
    }

    /// The smallest interval that holds both.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self::raw(lesser(self.low, other.low), greater(self.high, other.high))
    }

    /// Outward to the format's grid, then the hull with 0 where a subnormal may be flushed.
    #[inline]
    fn seal(low: f64, high: f64) -> Self {
        let (down, up) = (F::round_down(low), F::round_up(high));
        if F::is_normal(down) && F::is_normal(up) {
            return Self::raw(down, up);
        }
        Self::seal_beyond_normal(low, high)
    }

    /// [`Accept::seal`] where an end is 0, subnormal or not finite.
    #[inline(never)]
    fn seal_beyond_normal(low: f64, high: f64) -> Self {
        // Both ends are 0, above all those of a product with an exact 0.
        if low == 0.0 && high == 0.0 {
            return Self::raw(low, high);
        }
        // A NaN fails this too.
        if !(low >= -F::MAX && high <= F::MAX) {
            return if F::IS_HARDWARE { Self::overflow(low, high) } else { Self::ANY };
        }
        let (low, high) = (F::round_down(low), F::round_up(high));
        if low < F::MIN_NORMAL && high > -F::MIN_NORMAL {
            return Self::flush(low, high);
        }
        Self::raw(low, high)
    }

    /// [`Accept::seal`] of a sum's or a product's exact range, widened where the profile promises less than correct rounding.
    #[inline]
    fn rounded(low: f64, high: f64) -> Self {
        if relative() == 0.0 { Self::seal(low, high) } else { Self::rounded_by_profile(low, high) }
    }

    #[inline(never)]
    fn rounded_by_profile(low: f64, high: f64) -> Self {
        let relative = relative();
        assert_in_force(relative);
        Self::seal(low - relative * low.abs(), high + relative * high.abs())
    }

    /// [`Accept::seal`] of fixed hardware, where what is too great becomes infinite or the greatest finite number.
    #[cold]
    fn overflow(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::ANY;
        }
        let low = if low < -F::MAX { f64::NEG_INFINITY } else { F::round_down(low.min(F::MAX)) };
        let high = if high > F::MAX { f64::INFINITY } else { F::round_up(high.max(-F::MAX)) };
        Self::raw(low, high)
    }

    /// [`Accept::seal`] for an interval that reaches into the subnormal range, where the grid is even.
    fn flush(low: f64, high: f64) -> Self {
        let subnormal = |x: f64| x != 0.0 && x.abs() < F::MIN_NORMAL;
        let grid = F::MIN_SUBNORMAL;
        let low = match subnormal(low) {
            true if low > 0.0 => 0.0,
            true => (low / grid).floor() * grid,
            false => low,
        };
        let high = match subnormal(high) {
            true if high < 0.0 => 0.0,
            true => (high / grid).ceil() * grid,
            false => high,
        };
        Self::raw(low, high)
    }

    fn is_exactly(&self, x: f64) -> bool {
        self.low == x && self.high == x
    }

    fn is_point(&self) -> bool {
        self.low == self.high
    }

    fn magnitude(&self) -> f64 {
        greater(self.low.abs(), self.high.abs())
    }

    /// Whether it holds a value of at most that magnitude.
    fn reaches_within(&self, magnitude: f64) -> bool {
        self.low <= magnitude && self.high >= -magnitude
    }

    fn contains_zero(&self) -> bool {
        self.low <= 0.0 && self.high >= 0.0
    }

    /// low·low′ … high·high′: the exact range of the product, unrounded.
    #[inline]
    fn product_range(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
        let (p, q, r, s) = (a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1);
        (lesser(lesser(p, q), lesser(r, s)), greater(greater(p, q), greater(r, s)))
    }

    /// Widened on both ends by a number of ULP and sealed. `f` is monotone, and its values at the interval's ends, of
    /// stated relative error below [`F64_SLACK`], are given. For a point the ULP is that of the value; within a wide
    /// interval a value just past a power of two has twice the ULP of one just before, so the relative bound stands in.
    fn widen(point: bool, low: f64, high: f64, ulps: f64) -> Self {
        let error = |x: f64| {
            let ulp = if point { F::ulp(x) } else { greater(x.abs() * F::EPSILON, F::MIN_SUBNORMAL) };
            ulps * ulp + x.abs() * F64_SLACK
        };
        Self::of_results(low - error(low), high + error(high))
    }

    /// The values of the format between two real bounds: a built-in's result is one of them, so the bounds round inward.
    fn of_results(low: f64, high: f64) -> Self {
        let (low, high) = (F::round_up(low), F::round_down(high));
        if F::is_normal(low) && F::is_normal(high) {
            return Self::raw(low, high);
        }
        Self::seal_beyond_normal(low, high)
    }

    /// An exponential `f` with a bound that grows with |x|.
    fn exponential(self, f: impl Fn(f64) -> f64, bound: GrowingUlp, excess: Option<Excess>) -> Self {
        if self.is_any() {
            return Self::ANY;
        }
        let mut ulps = bound.slope.mul_add(self.magnitude(), bound.base);
        if let Some(excess) = excess
            && self.high >= excess.from
            && self.low <= excess.to
        {
            ulps *= excess.factor;
        }
        // exp(1e-20) rounds to 1 in f64, where the ULP below is half that above: a step up asks for the one above.
        let low = f(self.low).next_up();
        let high = if self.is_point() { low } else { f(self.high).next_up() };
        Self::widen(self.is_point(), low, high, ulps)
    }

    /// 0 for exponents above 0; with exponent 0 both 0 and 1 are legal. (Ruling 12, at a cosine ≤ 0.)
    fn lobe_at_no_cosine(exponent: Self) -> Self {
        let zero = Self::exactly(0.0);
        if exponent.contains_zero() { zero.hull(Self::exactly(1.0)) } else { zero }
    }

    /// x·x, which is never negative: the two factors are one value.
    fn square(self) -> Self {
        let x = self.abs();
        Self::rounded(x.low * x.low, x.high * x.high)
    }
}

/// a + b in f64, stepped down where that rounded up.
#[inline]
fn add_down(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let (from_b, from_a) = (sum - a, sum - (sum - a));
    let error = (a - from_a) + (b - from_b);
    if error < 0.0 { sum.next_down() } else { sum }
}

/// How far an addition or a multiplication may be off, relatively: a rounding up or down, or what the profile says.
fn epsilon<F: Format>() -> f64 {
    let relative = relative();
    assert_in_force(relative);
    F::EPSILON.max(relative)
}

impl<F: Format> Add for Accept<F> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::rounded(add_down(self.low, other.low), -add_down(-self.high, -other.high))
    }
}

impl<F: Format> Neg for Accept<F> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::raw(-self.high, -self.low)
    }
}

impl<F: Format> Sub for Accept<F> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<F: Format> Mul for Accept<F> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        // ∞·0 is NaN.
        let is_infinite = |x: Self| x.low.is_infinite() || x.high.is_infinite();
        if F::IS_HARDWARE
            && greater(self.magnitude(), other.magnitude()) > F::MAX
            && ((is_infinite(self) && other.contains_zero()) || (is_infinite(other) && self.contains_zero()))
        {
            return Self::ANY;
        }
        // A product of two numbers of at most 24 bits is exact in f64.
        let (low, high) = Self::product_range((self.low, self.high), (other.low, other.high));
        Self::rounded(low, high)
    }
}

impl<F: Format> Div for Accept<F> {
    type Output = Self;
    #[inline]
    fn div(self, divisor: Self) -> Self {
        // The bound holds for divisors whose magnitude lies in [2⁻¹²⁶, 2¹²⁶]; beyond, nothing is promised.
        let (least, most) = (lesser(divisor.low.abs(), divisor.high.abs()), divisor.magnitude());
        if divisor.contains_zero() || least < F::MIN_NORMAL || most > 1.0 / F::MIN_NORMAL || self.is_any() {
            return Self::ANY;
        }
        // By a positive divisor: the end farther from 0 by the least of it, the end nearer to 0 by the greatest.
        let (dividend, divisor) = if divisor.low > 0.0 { (self, divisor) } else { (-self, -divisor) };
        let low = dividend.low / if dividend.low < 0.0 { divisor.low } else { divisor.high };
        let high = dividend.high / if dividend.high < 0.0 { divisor.high } else { divisor.low };
        if low == 0.0 && high == 0.0 {
            return Self::exactly(0.0);
        }
        Self::widen(low == high, low, high, current(|p| p.divide_ulp))
    }
}

impl<F: Format> Real for Accept<F> {
    #[inline]
    fn input(x: f32) -> Self {
        // On the grid already for binary32; a conversion, rounded up or down, for a narrower format.
        let wide = f64::from(x);
        if x == 0.0 { Self::raw(wide, wide) } else { Self::seal(wide, wide) }
    }

    #[inline]
    fn literal(x: f64) -> Self {
        Self::seal(x, x)
    }

    fn max(self, other: Self) -> Self {
        if self.is_any() || other.is_any() {
            return Self::ANY;
        }
        Self::raw(greater(self.low, other.low), greater(self.high, other.high))
    }

    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }

    fn abs(self) -> Self {
        if self.is_any() {
            return Self::ANY;
        }
        let least = if self.contains_zero() { 0.0 } else { lesser(self.low.abs(), self.high.abs()) };
        Self::raw(least, self.magnitude())
    }

    fn round(self) -> Self {
        // Shading languages leave the direction at a tie open.
        let down = |x: f64| (x - 0.5).ceil();
        let up = |x: f64| (x + 0.5).floor();
        Self::raw(down(self.low), up(self.high))
    }

    fn sqrt(self) -> Self {
        Self::exactly(1.0) / self.inverse_sqrt()
    }

    fn inverse_sqrt(self) -> Self {
        if self.is_any() || self.low <= 0.0 {
            return Self::ANY;
        }
        let (low, high) = (1.0 / self.high.sqrt(), 1.0 / self.low.sqrt());
        Self::widen(self.is_point(), low, high, current(|p| p.inverse_sqrt_ulp))
    }

    fn exp(self) -> Self {
        let (bound, excess) = current(|p| (p.exp_ulp, p.exp_excess));
        self.exponential(core_math::exp, bound, excess)
    }

    fn exp2(self) -> Self {
        let (bound, excess) = current(|p| (p.exp2_ulp, p.exp2_excess));
        self.exponential(core_math::exp2, bound, excess)
    }

    fn log2(self) -> Self {
        if self.is_any() || self.low <= 0.0 {
            return Self::ANY;
        }
        let (absolute, ulps) = current(|p| (p.log2_absolute, p.log2_ulp));
        let touches_middle = self.low <= 2.0 && self.high >= 0.5;
        let low = core_math::log2(self.low);
        let high = if self.is_point() { low } else { core_math::log2(self.high) };
        let error = |y: f64| {
            let relative = if self.is_point() { F::ulp(y) } else { y.abs() * F::EPSILON };
            let relative = ulps * relative + y.abs() * F64_SLACK;
            match (touches_middle, self.is_point()) {
                (true, true) => absolute + y.abs() * F64_SLACK,
                // The bounds differ on the two sides of 0.5 and of 2: the greater serves for both.
                (true, false) => greater(absolute, relative) + y.abs() * F64_SLACK,
                (false, _) => relative,
            }
        };
        Self::of_results(low - error(low), high + error(high))
    }

    fn pow(self, exponent: Self) -> Self {
        (exponent * self.log2()).exp2()
    }

    fn ln_1p(self) -> Self {
        // Shaders evaluate a series of 6 terms for |x| ≤ 1/16, and log(1 + x) beyond (`elementary.wgsl`).
        const SERIES: f64 = 0.0625;
        if self.is_any() || self.low <= -1.0 {
            return Self::ANY;
        }
        let (may_be_series, may_be_log) = (self.reaches_within(SERIES), self.magnitude() > SERIES);
        let error = |y: f64| {
            // A term has at most 6 products, a rounded coefficient and 6 sums; against the sum of their magnitudes, at most
            // 1.07 times the result; the next term of the series is below ε/8.
            let series = 16.0 * epsilon::<F>() * 1.07 + F::EPSILON / 8.0;
            // 1 + x is rounded; log errs by 2⁻²¹ near 1 and by 3 ULP elsewhere.
            let log =
                current(|p| p.log2_absolute) + 1.02 * epsilon::<F>() + current(|p| p.log2_ulp) * F::EPSILON * y.abs();
            (if may_be_series { series * y.abs() } else { 0.0 }).max(if may_be_log { log } else { 0.0 })
        };
        let (low, high) = (core_math::log1p(self.low), core_math::log1p(self.high));
        Self::of_results((low - error(low)).next_down(), (high + error(high)).next_up())
    }

    fn exp_m1(self) -> Self {
        // A series of 8 terms for |x| ≤ 1/2, and exp(x) − 1 beyond (`elementary.wgsl`).
        const SERIES: f64 = 0.5;
        if self.is_any() {
            return Self::ANY;
        }
        let beyond = (self.magnitude() > SERIES).then(|| self.exp() - Self::exactly(1.0));
        if !self.reaches_within(SERIES) {
            return beyond.unwrap_or(Self::ANY);
        }
        // At most 8 products, a rounded coefficient and 8 sums a term; the magnitudes' sum is at most 1.65 times the result;
        // the next term is below ε/8.
        let error = 20.0 * epsilon::<F>() * 1.65 + F::EPSILON / 8.0;
        let (low, high) = (core_math::expm1(self.low.max(-SERIES)), core_math::expm1(self.high.min(SERIES)));
        let low = (low - error * low.abs()).next_down();
        let high = (high + error * high.abs()).next_up();
        let series = Self::of_results(low, high);
        beyond.map_or(series, |beyond| beyond.hull(series))
    }

    fn difference_of_products([a, b]: [Self; 2], [c, d]: [Self; 2]) -> Self {
        // The compensated form has 12 terms, whose magnitudes' sum is at most 4(|ab| + |cd|). The language lets a compiler sum
        // them in any order, so little more is promised than of a·b − c·d; the claim of a stable form is tighter.
        let (ab, cd) = (
            Self::product_range((a.low, a.high), (b.low, b.high)),
            Self::product_range((c.low, c.high), (d.low, d.high)),
        );
        let magnitude = greater(ab.0.abs(), ab.1.abs()) + greater(cd.0.abs(), cd.1.abs());
        let mut error = chain_error::<F>(12) * 4.0 * magnitude;
        if magnitude < F::MIN_NORMAL / (F::EPSILON * F::EPSILON) * 16.0 {
            error += 12.0 * F::MIN_NORMAL;
        }
        Self::seal(ab.0 - cd.1 - error, ab.1 - cd.0 + error)
    }

    fn if_ge<T: Components<Self>>(a: Self, b: Self, then: impl FnOnce() -> T, otherwise: impl FnOnce() -> T) -> T {
        if a.low >= b.high && !a.is_any() {
            then()
        } else if a.high < b.low {
            otherwise()
        } else {
            paths::choose(then, otherwise, |a, b| a.zip(b, Self::hull))
        }
    }

    fn floor_then<T: Components<Self>>(self, then: impl Fn(f64) -> T) -> T {
        // An interval that covers more whole numbers (texels) than this is too wide to be useful, so anything is allowed.
        const MOST: f64 = 64.0;
        let (first, last) = (self.low.floor(), self.high.floor());
        if last - first <= MOST {
            return paths::whole(first, last, then, |a, b| a.zip(b, Self::hull));
        }
        then(0.0).zip(then(0.0), |_, _| Self::ANY)
    }

    fn is_at_most(self, bound: f64) -> bool {
        self.high <= bound && !self.is_any()
    }

    #[inline]
    fn sum<const N: usize>(terms: [Self; N]) -> Self {
        // Not by value: iterators over references compile to less.
        Self::sum_over(terms.iter().copied())
    }

    #[inline]
    fn sum_over(terms: impl Iterator<Item = Self>) -> Self {
        Self::chain_of_sums(terms)
    }

    #[inline]
    fn product<const N: usize>(factors: [Self; N]) -> Self {
        Self::chain_of_products(factors)
    }

    fn mix(a: Self, b: Self, t: Self) -> Self {
        let (products, difference) = (a * (Self::exactly(1.0) - t) + b * t, a + t * (b - a));
        products.hull(difference)
    }

    fn mix_of_differences([to_a, to_b]: [Self; 2], from: Self, [a, b]: [Self; 2], t: Self) -> Self {
        Self::mix(to_a, to_b, t).hull(from - Self::mix(a, b, t))
    }

    fn normalize<const N: usize>(v: [Self; N]) -> [Self; N] {
        let inverse = Self::sum(v.map(Self::square)).inverse_sqrt();
        // The square root, by its rule.
        let length = Self::exactly(1.0) / inverse;
        v.map(|x| (x / length).hull(x * inverse))
    }

    fn quadratic([c0, c1, c2]: [Self; 3], x: Self) -> Self {
        let expanded = Self::sum([c0, c1 * x, Self::product([c2, x, x])]);
        expanded.hull(c0 + x * (c1 + x * c2))
    }

    fn or_dark(self, vectors: [[Self; 3]; 3]) -> Self {
        let is_nothing = |v: &[Self; 3]| v.iter().all(|x| x.low >= 0.0 && x.high <= 0.0);
        if !self.is_any() && vectors.iter().any(is_nothing) { self.hull(Self::exactly(0.0)) } else { self }
    }

    fn lobe(self, exponent: Self) -> Self {
        if self.is_any() || exponent.is_any() || exponent.low < 0.0 {
            return Self::ANY;
        }
        if self.high <= 0.0 {
            return Self::lobe_at_no_cosine(exponent);
        }
        if self.low > 0.0 {
            return self.pow(exponent);
        }
        // From 0 to the upper end: the power grows with the cosine. Where it vanishes, its error in ULP grows as the cosine gets smaller.
        let [top, least] = [self.high, F::MIN_SUBNORMAL].map(|cosine| Self::raw(cosine, cosine).pow(exponent));
        if top.is_any() || least.is_any() {
            return top.hull(least);
        }
        let whole = top.hull(least).hull(Self::lobe_at_no_cosine(exponent));
        // Between the two a power is no greater than the top's and errs by no more than the least's. Of a normal top that is covered: there the
        // power itself falls faster than its error grows.
        if top.high < 2.0 * F::MIN_NORMAL { Self::seal(whole.low, top.high + least.high) } else { whole }
    }
}
