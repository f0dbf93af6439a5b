//! The intervals' soundness: an f32 arithmetic that draws order, rounding, form, fusion and flush at random, as freely as
//! the accuracy rules let a compiler and a device choose, must always lie inside. And that they are not idle.

use lightmeter::arithmetic::profile::{VULKAN, WGSL};
use lightmeter::arithmetic::{Accept, F32, Format as _, Hardware, Profile};
use lightmeter::cases::{Formula, Kind, Reader, Spec, Visitor, Writer, visit};
use lightmeter::select::{CaseRef, catalogue};
use lightmeter_reference::{Components, Real};
use std::cell::Cell;
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

thread_local! {
    static STATE: Cell<u64> = const { Cell::new(1) };
    static PROFILE: Cell<Profile> = const { Cell::new(WGSL) };
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
    usize::try_from(random() >> 33).expect("31 bits fit") % n
}

/// −1 or 1 half the time, else evenly between: errors are sought at their bounds.
fn share() -> f64 {
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
struct Draw {
    value: f64,
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

impl Draw {
    fn of(x: f64) -> Self {
        let value = round(x);
        Self { value, unrounded: value }
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
        constants.reduce(|sum, c| c + self * sum).expect("a coefficient at least")
    }

    /// The term of a sum: as rounded, or, fused, as the exact product.
    fn term(self) -> f64 {
        if coin() { self.unrounded } else { self.value }
    }
}

impl Add for Draw {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        // A fused multiply-add takes one product unrounded.
        let exact = if coin() { self.term() + other.value } else { self.value + other.term() };
        Self::of(exact)
    }
}

impl Neg for Draw {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, unrounded: -self.unrounded }
    }
}

impl Sub for Draw {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Draw {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let unrounded = self.value * other.value;
        Self { unrounded, ..Self::of(unrounded) }
    }
}

impl Div for Draw {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let exact = self.value / other.value;
        if exact == 0.0 { Self::of(0.0) } else { Self::within(exact, PROFILE.get().divide_ulp * F32::ulp(exact)) }
    }
}

/// Any order of a chain: two of what is left are combined until one is.
fn chain(items: &[Draw], combine: impl Fn(Draw, Draw) -> Draw) -> Draw {
    let mut left = items.to_vec();
    while left.len() > 1 {
        let a = left.swap_remove(below(left.len()));
        let b = left.swap_remove(below(left.len()));
        left.push(combine(a, b));
    }
    left[0]
}

impl Real for Draw {
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
        Self::within(exact, PROFILE.get().inverse_sqrt_ulp * F32::ulp(exact))
    }
    fn exp(self) -> Self {
        let (exact, bound) = (core_math::exp(self.value), PROFILE.get().exp_ulp);
        Self::within(exact, (bound.base + bound.slope * self.value.abs()) * F32::ulp(exact))
    }
    fn exp2(self) -> Self {
        let (exact, bound) = (core_math::exp2(self.value), PROFILE.get().exp2_ulp);
        Self::within(exact, (bound.base + bound.slope * self.value.abs()) * F32::ulp(exact))
    }
    fn log2(self) -> Self {
        let (exact, profile) = (core_math::log2(self.value), PROFILE.get());
        let in_middle = (0.5..=2.0).contains(&self.value);
        Self::within(exact, if in_middle { profile.log2_absolute } else { profile.log2_ulp * F32::ulp(exact) })
    }
    fn pow(self, exponent: Self) -> Self {
        (exponent * self.log2()).exp2()
    }
    fn ln_1p(self) -> Self {
        if self.value.abs() > 0.0625 {
            let sum = (Self::literal(1.0) + self).value;
            let (exact, profile) = (core_math::log(sum), PROFILE.get());
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

/// Draws every arithmetic formula many times over and counts what was seen.
struct Check {
    profile: &'static Profile,
    cases: u64,
    draws: usize,
    drawn: u64,
    /// The rows of the named hard cases by formula.
    hard: HashMap<String, Vec<Vec<f32>>>,
    /// Widths of intervals over the spread of what was drawn, for intervals that are neither points nor everything.
    ratios: Vec<f64>,
}

impl Visitor for Check {
    fn formula<F: Formula>(&mut self, formula: F) {
        let spec = formula.spec();
        if matches!(spec.kind, Kind::Raster(_)) {
            return;
        }
        let cases = if matches!(spec.kind, Kind::Blend(_)) { self.cases.div_ceil(16) } else { self.cases };
        let hard = self.hard.get(&spec.id).cloned().unwrap_or_default();
        for row in (0..cases).map(|k| random_row(&spec, k)).chain(hard) {
            self.row(&formula, &spec, &row);
        }
    }
}

fn random_row(spec: &Spec, k: u64) -> Vec<f32> {
    let mut row = vec![];
    lightmeter::cases::inputs(spec, 11, k, &mut row);
    row
}

fn hard_rows() -> HashMap<String, Vec<Vec<f32>>> {
    let rows = catalogue().into_iter().map(|member| {
        let rows = (0..member.spec.hard.len()).map(|place| {
            let mut row = vec![];
            member.inputs(CaseRef::Hard(place), 0, &mut row);
            row
        });
        (member.spec.id.clone(), rows.collect())
    });
    rows.collect()
}

impl Check {
    fn row<F: Formula>(&mut self, formula: &F, spec: &Spec, row: &[f32]) {
        let outputs = spec.output_len();
        let mut legal = vec![Accept::<F32>::ANY; outputs];
        let inputs: Vec<Accept> = row.iter().map(|&x| Accept::input(x)).collect();
        self.profile.scope(|| formula.evaluate(&mut Reader::new(&inputs), &mut Writer::new(&mut legal)));
        let mut seen = vec![(f64::INFINITY, f64::NEG_INFINITY); outputs];
        for _ in 0..self.draws {
            let inputs: Vec<Draw> = row.iter().map(|&x| Draw::input(x)).collect();
            let mut out = vec![Draw::of(0.0); outputs];
            formula.evaluate(&mut Reader::new(&inputs), &mut Writer::new(&mut out));
            self.drawn += outputs as u64;
            for ((out, legal), seen) in out.iter().zip(&legal).zip(&mut seen) {
                assert!(legal.contains(out.value), "{}: {} outside {legal:?}, inputs {row:?}", spec.id, out.value);
                *seen = (seen.0.min(out.value), seen.1.max(out.value));
            }
        }
        for (legal, (low, high)) in legal.iter().zip(seen) {
            if !legal.is_any() && high > low {
                self.ratios.push(legal.width() / (high - low));
            }
        }
    }
}

fn check(profile: &'static Profile, cases: u64, draws: usize) -> Check {
    STATE.set(2026);
    PROFILE.set(*profile);
    let mut check = Check { profile, cases, draws, drawn: 0, hard: hard_rows(), ratios: vec![] };
    visit(&mut check);
    check.ratios.sort_by(f64::total_cmp);
    check
}

#[test]
fn every_legal_evaluation_lies_inside_and_intervals_are_not_idle() {
    let check = check(&WGSL, 256, 64);
    assert!(check.drawn > 4_000_000, "only {} values were drawn", check.drawn);
    let at = |share: usize| check.ratios[check.ratios.len() * share / 100];
    eprintln!(
        "{} values drawn; interval width over the spread of 64 draws: median {:.2}, 90 % below {:.2}, 99 % below {:.2}",
        check.drawn,
        at(50),
        at(90),
        at(99)
    );
    // Legal evaluations reach a good part of what is called legal: a bound that grew loose would show here.
    assert!(at(50) < 4.0, "the median interval is {} times as wide as what was drawn", at(50));
}

#[test]
fn every_legal_evaluation_by_vulkans_rules_lies_inside() {
    assert!(check(&VULKAN, 64, 16).drawn > 100_000);
}

#[test]
fn an_arithmetic_that_errs_more_is_caught() {
    // The control: a division off by twice its bound.
    STATE.set(1);
    PROFILE.set(Profile { divide_ulp: 5.0, ..WGSL });
    let legal: Accept = Accept::literal(1.0) / Accept::literal(3.0);
    let outside = (0..1000).filter(|_| !legal.contains((Draw::of(1.0) / Draw::of(3.0)).value)).count();
    assert!(outside > 100, "{outside} of 1000");
}

#[test]
fn a_blend_unit_may_take_out_a_shared_factor() {
    // What lavapipe does where both factors are one: (s + d)·f for s·f + d·f. Legal in hardware, not always in a shader.
    STATE.set(7);
    PROFILE.set(WGSL);
    let mut outside_a_shaders_rules = 0;
    for _ in 0..100_000 {
        let [s, d, f] = [0; 3].map(|_| Draw::of(share().abs()));
        let factored = ((s + d) * f).value;
        let legal = hardware([s.value, d.value, f.value]);
        assert!(legal.contains(factored), "{factored} outside {legal:?}: {s:?} {d:?} {f:?}");
        let [s, d, f] = [s, d, f].map(|x| Accept::<F32>::exactly(x.value));
        outside_a_shaders_rules += u32::from(!(s * f + d * f).contains(factored));
    }
    assert!(outside_a_shaders_rules > 100, "only {outside_a_shaders_rules}");
}

fn hardware([s, d, f]: [f64; 3]) -> Accept<Hardware<F32>> {
    let [s, d, f] = [s, d, f].map(Accept::exactly);
    Accept::sum([s * f, d * f])
}

#[test]
fn chains_reach_their_bounds_and_not_beyond() {
    let ulp = f64::from(f32::EPSILON);
    // Rounded up at each step, 1 and ever so little comes to a ULP more for each term.
    let dust: Accept = Accept::exactly(2.0_f64.powi(-60));
    let one: Accept = Accept::exactly(1.0);
    let sums = [
        Accept::sum([one, dust, dust]),
        Accept::sum([one, dust, dust, dust]),
        Accept::sum([one, dust, dust, dust, dust]),
    ];
    for (terms, sum) in (3..).zip(sums) {
        let most = 1.0 + f64::from(terms - 1) * ulp;
        assert!(sum.contains(most), "{terms} terms: {most} in {sum:?}");
        assert!(!sum.contains(most + ulp), "{terms} terms: {sum:?}");
    }
    // The same of products: each factor is the one of many that is rounded up the furthest.
    STATE.set(3);
    let factor = || F32::round_up(1.0 + 0.03 * share().abs());
    let mut nearest = 0.0_f64;
    for _ in 0..2_000 {
        let mut factors = [factor(); 4];
        let mut up = factors[0];
        for next in &mut factors[1..] {
            let lost = |x: &f64| F32::round_up(up * x) - up * x;
            let candidates: [f64; 100] = std::array::from_fn(|_| factor());
            *next = candidates.into_iter().max_by(|a, b| lost(a).total_cmp(&lost(b))).expect("a hundred");
            up = F32::round_up(up * *next);
        }
        let exact: f64 = factors.iter().product();
        let legal: Accept = Accept::product(factors.map(Accept::exactly));
        assert!(legal.contains(up), "{up} outside {legal:?}: {factors:?}");
        nearest = nearest.max((up - exact) / (legal.high() - exact));
    }
    // Three roundings of the four ULP that the bound comes to once it is on the grid.
    assert!(nearest > 0.74, "rounding up comes no nearer to the bound than {nearest}");
}

#[test]
fn single_operations_are_sharp() {
    let number = |x: f32| -> Accept { Accept::input(x) };
    let third = number(1.0) + number(2.0_f32.powi(-25));
    assert_eq!((third.low(), third.high()), (1.0, f64::from(1.0_f32.next_up())));
    assert_eq!(number(0.1) * number(0.0), number(0.0));
    assert_eq!(number(0.25) + number(0.5), number(0.75));
    assert_eq!(number(3.0) * number(0.5), number(1.5));
    assert!(!(number(1.0) / number(3.0)).contains(1.0 / 3.0 + 3.0 * F32::ulp(1.0 / 3.0)));
    assert!(
        (number(1.0) / number(0.0)).is_any() && number(-1.0).sqrt().is_any() && (number(3e38) * number(10.0)).is_any()
    );
    // Just above 1 a ULP is twice what it is just below, though f64 cannot tell exp(1e-20) from 1.
    assert!(number(1e-20).exp().contains(1.0 + 3.0 * f64::from(f32::EPSILON)));
    let flushed = number(1e-30) * number(1e-10);
    assert!(flushed.contains(0.0) && flushed.contains(f64::from(1e-40_f32)));
}
