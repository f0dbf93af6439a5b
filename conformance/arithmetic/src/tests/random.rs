//! Legal evaluations drawn at random: each draw is legal by the oracles, and what is legal is drawn.

use super::oracle::{Draws, Ends, power_of_two, product, sum, ulp, within};
use crate::profile::{Profile, WGSL};
use crate::random::{seed, share};
use crate::{Accept, F32, Format, RandomLegal};
use lightmeter_reference::Real;
use std::collections::{BTreeMap, BTreeSet};

fn exactly(x: f64) -> RandomLegal {
    let drawn = RandomLegal::of(x);
    assert_eq!(drawn.value.to_bits(), x.to_bits(), "a value of binary32");
    drawn
}

/// SplitMix64 by Steele, Lea and Flood, as published.
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
}

#[test]
fn shares_are_those_of_a_published_generator() {
    // The generator's known outputs for the seed 1234567.
    let known = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
    let mut published = SplitMix(1_234_567);
    assert_eq!([(); 3].map(|()| published.next()), known);
    let mut published = SplitMix(1_234_567);
    seed(1_234_567);
    let (mut at_ends, mut total) = ([0; 2], 0.0);
    for _ in 0..20_000 {
        let (even, choice) = (published.next(), published.next());
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let even = (even >> 11) as f64 * 2.0_f64.powi(-52) - 1.0;
        let expected = [1.0, -1.0, even, even][usize::try_from(choice >> 62).expect("two bits")];
        let drawn = share();
        assert_eq!(drawn.to_bits(), expected.to_bits());
        at_ends[0] += usize::from(drawn <= -1.0);
        at_ends[1] += usize::from(drawn >= 1.0);
        total += drawn;
    }
    // A quarter at either end; the rest is even.
    assert!(at_ends.iter().all(|count| (4_700..5_300).contains(count)), "{at_ends:?}");
    assert!(total.abs() < 500.0, "{total}");
}

#[test]
fn a_seed_draws_the_same_values_everywhere() {
    // The nearest number where the generator's upper bit is 1, the other neighbour elsewhere.
    let mut published = SplitMix(1_234_567);
    seed(1_234_567);
    let nearest = 1.0_f32 / 3.0;
    for _ in 0..100 {
        let expected = if published.next() >> 63 == 1 { nearest } else { nearest.next_down() };
        assert_eq!(RandomLegal::of(1.0 / 3.0).narrow().to_bits(), expected.to_bits());
    }
}

/// How often each value is drawn.
fn counts(draw: impl Fn() -> RandomLegal) -> BTreeMap<u32, usize> {
    let mut counts = BTreeMap::new();
    seed(5);
    for _ in 0..800 {
        *counts.entry(draw().narrow().to_bits()).or_default() += 1;
    }
    counts
}

/// The drawn values are these, in about these shares of 8.
fn assert_shares(name: &str, draw: impl Fn() -> RandomLegal, expected: &[(f32, usize)]) {
    let counts = counts(draw);
    let bits: BTreeMap<u32, usize> = expected.iter().map(|(x, share)| (x.to_bits(), *share)).collect();
    assert_eq!(counts.keys().collect::<Vec<_>>(), bits.keys().collect::<Vec<_>>(), "{name}");
    for (x, count) in counts {
        let share = 100 * bits[&x];
        let spare = if share == 800 { 0 } else { 60 };
        assert!((share - spare..=share + spare).contains(&count), "{name}: {} drawn {count} times", f32::from_bits(x));
    }
}

#[test]
fn a_number_rounds_either_way_and_a_subnormal_may_be_flushed() {
    let (normal, least) = (f32::MIN_POSITIVE, f32::from_bits(1));
    let between = |a: f32, b: f32| f64::midpoint(a.into(), b.into());
    let (third, minus_third) = (1.0_f32 / 3.0, -1.0_f32 / 3.0);
    assert!(f64::from(third) > 1.0 / 3.0);
    assert_shares("a value", || RandomLegal::of(0.75), &[(0.75, 8)]);
    assert_shares("⅓", || RandomLegal::of(1.0 / 3.0), &[(third, 4), (third.next_down(), 4)]);
    assert_shares("−⅓", || RandomLegal::of(-1.0 / 3.0), &[(minus_third, 4), (minus_third.next_up(), 4)]);
    assert_shares("nearest below", || RandomLegal::of(1.0 + 1e-9), &[(1.0, 4), (1.0_f32.next_up(), 4)]);
    assert_shares("the least normal number", || RandomLegal::of(normal.into()), &[(normal, 8)]);
    assert_shares("its negative", || RandomLegal::of((-normal).into()), &[(-normal, 8)]);
    assert_shares("a subnormal", || RandomLegal::of(least.into()), &[(least, 4), (0.0, 4)]);
    assert_shares("an input", || Real::input(least), &[(least, 4), (0.0, 4)]);
    assert_shares("a normal input", || Real::input(0.1), &[(0.1, 8)]);
    assert_shares("a literal", || Real::literal(1.0 / 3.0), &[(third, 4), (third.next_down(), 4)]);
    let drawn = || RandomLegal::of(between(normal, normal.next_down()));
    assert_shares("around the least normal number", drawn, &[(normal, 4), (normal.next_down(), 2), (0.0, 2)]);
}

#[test]
fn operations_reach_both_ends_and_no_more() {
    let mut draws = Draws(1);
    seed(2);
    type Operation = fn(RandomLegal, RandomLegal) -> RandomLegal;
    type Oracle = fn(f32, f32) -> Ends;
    let operations: [(&str, Operation, Oracle); 4] = [
        ("+", |a, b| a + b, sum),
        ("−", |a, b| a - b, |a, b| sum(a, -b)),
        ("·", |a, b| a * b, product),
        ("−(a·b)", |a, b| -(a * b), |a, b| product(-a, b)),
    ];
    for (name, operation, oracle) in operations {
        for _ in 0..1_000 {
            let (a, b) = (draws.number(-9, 9), draws.number(-9, 9));
            let drawn = [(); 24].map(|()| operation(Real::input(a), Real::input(b)).value);
            let seen = drawn.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            assert_eq!(Some(seen), oracle(a, b), "{a} {name} {b}");
        }
    }
}

/// The values that are drawn lie within an error of the exact one, and come near to both ends.
fn assert_reaches(name: &str, exact: f64, error: f64, mut draw: impl FnMut() -> RandomLegal) {
    let legal = within::<F32>(exact - error * (1.0 + power_of_two(-20)), exact + error * (1.0 + power_of_two(-20)));
    let (low, high) = legal.expect("a finite range");
    let mut seen = (f64::INFINITY, f64::NEG_INFINITY);
    for _ in 0..64 {
        let drawn = draw().value;
        assert!(low <= drawn && drawn <= high, "{name}: {drawn} outside of {low} … {high}");
        seen = (seen.0.min(drawn), seen.1.max(drawn));
    }
    let spare = power_of_two(-23) * exact.abs() * 1.01;
    assert!(seen.0 <= low + spare && seen.1 >= high - spare, "{name}: {seen:?} of {low} … {high}");
}

#[test]
fn built_ins_reach_their_promised_errors() {
    let mut draws = Draws(2);
    seed(3);
    WGSL.scope(|| {
        for _ in 0..200 {
            let (a, b) = (f64::from(draws.number(-6, 6)), f64::from(draws.number(-6, 6)));
            let (x, y) = (exactly(a.abs()), f64::from(draws.number(-4, 3)));
            let ulps = |exact: f64, ulps: f64| (exact, ulps * ulp::<F32>(exact));
            let log = if (0.5..=2.0).contains(&a.abs()) {
                (a.abs().log2(), power_of_two(-21))
            } else {
                ulps(a.abs().log2(), 3.0)
            };
            let root = ulps(a.abs().sqrt().recip(), 2.0);
            let (exp, exp2) = (ulps(y.exp(), 3.0 + 2.0 * y.abs()), ulps(y.exp2(), 3.0 + 2.0 * y.abs()));
            let (quotient, y) = (ulps(a / b, 2.5), exactly(y));
            assert_reaches("/", quotient.0, quotient.1, || exactly(a) / exactly(b));
            assert_reaches("1/√", root.0, root.1, || x.inverse_sqrt());
            assert_reaches("exp", exp.0, exp.1, || y.exp());
            assert_reaches("exp2", exp2.0, exp2.1, || y.exp2());
            assert_reaches("log2", log.0, log.1, || x.log2());
        }
        for x in [0.5, 2.0] {
            assert_reaches("log2 at the ends of the middle", x.log2(), power_of_two(-21), || exactly(x).log2());
        }
        // The bounds themselves are legal, and drawn.
        let at_bounds = bits([1.0 - power_of_two(-21), 1.0 + power_of_two(-21)].map(narrow));
        assert!(drawn(200, || exactly(2.0).log2()).is_superset(&at_bounds), "log2 of 2 at its bounds");
        for x in [0.5_f32.next_down(), 2.0_f32.next_up()].map(f64::from) {
            let error = 3.0 * ulp::<F32>(x.log2());
            assert_reaches("log2 beyond", x.log2(), error, || exactly(x).log2());
        }
    });
}

#[test]
fn a_quotient_of_zero_is_zero_and_a_subnormal_may_be_flushed() {
    WGSL.scope(|| {
        assert_shares("0/3", || exactly(0.0) / exactly(3.0), &[(0.0, 8)]);
        // 8 of the least numbers, each of which is an ULP: those within 2.5 of it, and 0 half the time.
        let quotient = || exactly(F32::MIN_NORMAL) / exactly(1_048_576.0);
        let counts = counts(quotient);
        assert!((300..=500).contains(&counts[&0]), "{counts:?}");
        assert_eq!(counts.keys().copied().collect::<Vec<_>>(), [0, 6, 7, 8, 9, 10]);
    });
}

#[test]
fn built_ins_err_by_the_profile_in_force() {
    // The control: a profile that promises less.
    let worse = Profile { divide_ulp: 50.0, inverse_sqrt_ulp: 50.0, log2_absolute: 1e-3, log2_ulp: 50.0, ..WGSL };
    seed(4);
    worse.scope(|| {
        let (one, three) = (exactly(1.0), exactly(3.0));
        assert_reaches("/", 1.0 / 3.0, 50.0 * power_of_two(-25), || one / three);
        assert_reaches("1/√", 3.0_f64.sqrt().recip(), 50.0 * power_of_two(-24), || three.inverse_sqrt());
        assert_reaches("log2", 1.5_f64.log2(), 1e-3, || exactly(1.5).log2());
        assert_reaches("log2 beyond", 3.0_f64.log2(), 50.0 * power_of_two(-23), || three.log2());
        assert_reaches("ln(1 + x)", 0.5_f64.ln_1p(), 1e-3, || exactly(0.5).ln_1p());
        assert_reaches("ln(1 + x) beyond", 3.0_f64.ln_1p(), 50.0 * power_of_two(-23), || three.ln_1p());
    });
}

#[test]
fn exact_functions_draw_what_they_are() {
    let x = exactly;
    // Name, drawn, expected.
    let rows = [
        ("max", x(1.0).max(x(2.0)), 2.0),
        ("max, turned", x(2.0).max(x(1.0)), 2.0),
        ("min", x(1.0).min(x(2.0)), 1.0),
        ("min, turned", x(2.0).min(x(1.0)), 1.0),
        ("|x|", x(-1.5).abs(), 1.5),
        ("|x| of a positive number", x(1.5).abs(), 1.5),
        ("|0| keeps its sign", x(0.0).abs(), 0.0),
        ("round down", x(2.25).round(), 2.0),
        ("round up", x(2.75).round(), 3.0),
        ("round a negative number up", x(-2.25).round(), -2.0),
        ("round a negative number down", x(-2.75).round(), -3.0),
        ("round a whole number", x(-3.0).round(), -3.0),
        ("then", RandomLegal::if_ge(x(1.0), x(1.0), || x(5.0), || x(6.0)), 5.0),
        ("otherwise", RandomLegal::if_ge(x(0.5), x(1.0), || x(5.0), || x(6.0)), 6.0),
        ("floor", x(-0.5).floor_then(exactly), -1.0),
        ("no term", RandomLegal::sum_over(std::iter::empty()), 0.0),
        ("an exact sum", RandomLegal::sum_over([1.0, 2.0, 4.0].map(exactly).into_iter()), 7.0),
        ("an exact product", RandomLegal::product([1.5, 2.0, 4.0].map(exactly)), 12.0),
    ];
    for (name, drawn, expected) in rows {
        assert_eq!((drawn.value, drawn.narrow().to_bits()), (expected, narrow(expected).to_bits()), "{name}");
    }
    assert_shares("a tie", || x(2.5).round(), &[(2.0, 4), (3.0, 4)]);
    assert_shares("a negative tie", || x(-2.5).round(), &[(-2.0, 4), (-3.0, 4)]);
}

#[expect(clippy::cast_possible_truncation, reason = "a value of binary32")]
fn narrow(x: f64) -> f32 {
    x as f32
}

/// Each value that is drawn.
fn drawn(times: usize, draw: impl Fn() -> RandomLegal) -> BTreeSet<u32> {
    (0..times).map(|_| draw().narrow().to_bits()).collect()
}

fn bits(values: impl IntoIterator<Item = f32>) -> BTreeSet<u32> {
    values.into_iter().map(f32::to_bits).collect()
}

#[test]
fn a_sum_is_drawn_in_each_order() {
    // 2²⁴ + 1 is a tie between 2²⁴ and 2²⁴ + 2.
    let big = 16_777_216.0;
    seed(6);
    let of = |terms: [f64; 3]| drawn(400, move || RandomLegal::sum(terms.map(exactly)));
    let two = bits([big, big + 2.0, big + 4.0].map(narrow));
    assert_eq!(of([big, 1.0, 1.0]), two, "two small terms each rounded up or down, or together");
    for place in 0..3 {
        // The order in which the great terms cancel first is drawn, wherever they stand.
        let mut terms = [big, -big, 1.0];
        terms.rotate_left(place);
        assert_eq!(of(terms), bits([0.0, 1.0, 2.0]), "{terms:?}");
    }
    let product = drawn(400, || RandomLegal::product([59_049.0, 59_049.0, 0.5].map(exactly)));
    assert_eq!(product.len(), 2, "an inexact product rounds either way");
}

#[test]
fn a_product_may_be_fused_into_a_sum() {
    // (1 + 2⁻¹²)² − 1 − 2⁻¹¹ is 2⁻²⁴ where the product stays unrounded, and 0 or 2⁻²³ where it is rounded.
    let x = 1.0 + power_of_two(-12);
    let rest = 1.0 + power_of_two(-11);
    let values = bits([0.0, power_of_two(-24), power_of_two(-23)].map(narrow));
    seed(7);
    assert_eq!(drawn(200, || exactly(x) * exactly(x) - exactly(rest)), values, "on the left");
    let minus = || exactly(-rest) + exactly(x) * exactly(x);
    assert_eq!(drawn(200, minus), values, "on the right");
    let negated = || exactly(rest) - exactly(x) * exactly(x);
    assert_eq!(drawn(200, negated), bits([0.0, -power_of_two(-24), -power_of_two(-23)].map(narrow)), "negated");
    // A fused operation takes one of two products unrounded, so that two rounding errors never cancel unseen.
    let two = || exactly(x) * exactly(x) - exactly(x) * exactly(x);
    let both = [0.0, power_of_two(-24), power_of_two(-23)].map(narrow);
    let expected: BTreeSet<u32> = bits(both.into_iter().chain(both.into_iter().skip(1).map(|x| -x)));
    assert_eq!(drawn(400, two), expected, "two products");
}

#[test]
fn both_forms_of_a_function_are_drawn() {
    seed(8);
    WGSL.scope(|| {
        // 2²⁴ and 1 at t = 1: a + t(b − a) loses the 1, and a(1 − t) + b·t does not.
        let (big, one) = (16_777_216.0, 1.0);
        let mixed = drawn(200, || RandomLegal::mix(exactly(big), exactly(-one), exactly(1.0)));
        assert_eq!(mixed, bits([0.0, -1.0, -2.0]), "mix");
        let start = drawn(200, || RandomLegal::mix(exactly(one), exactly(big), exactly(0.0)));
        assert_eq!(start, bits([1.0]), "mix at 0");
        let half = drawn(200, || RandomLegal::mix(exactly(2.0), exactly(6.0), exactly(0.25)));
        assert_eq!(half, bits([3.0]), "an exact mix");
        let square = drawn(100, || RandomLegal::quadratic([1.0, 2.0, 4.0].map(exactly), exactly(0.5)));
        assert_eq!(square, bits([3.0]), "an exact quadratic");
        // 2²⁴ + x(1 − x·2⁻¹²) at x = 2¹²: 0 by Horner's scheme, and each term rounded by the other.
        let c = [1.0, big, -big].map(exactly);
        let cancelled = drawn(400, || RandomLegal::quadratic(c, exactly(1.0)));
        assert_eq!(cancelled, bits([0.0, 1.0, 2.0]), "quadratic");
    });
}

#[test]
fn a_lobe_is_zero_or_open_from_the_horizon_down() {
    WGSL.scope(|| {
        let lobe = |x: f64, y: f64| move || exactly(x).lobe(exactly(y));
        assert_shares("below the horizon", lobe(-0.5, 2.0), &[(0.0, 8)]);
        assert_shares("at the horizon", lobe(0.0, 2.0), &[(0.0, 8)]);
        assert_shares("exponent 0 below it", lobe(-0.5, 0.0), &[(0.0, 4), (1.0, 4)]);
        seed(9);
        let above: Accept = Accept::exactly(0.75).pow(Accept::exactly(2.0));
        let values = drawn(200, lobe(0.75, 2.0));
        assert!(values.len() > 5, "{values:?}");
        assert!(values.iter().all(|&x| above.contains(f32::from_bits(x).into())), "{values:?} outside of {above:?}");
    });
}

#[test]
fn composed_functions_stay_near_their_values() {
    let mut draws = Draws(3);
    seed(10);
    let epsilon = F32::EPSILON;
    WGSL.scope(|| {
        for _ in 0..500 {
            let (a, b) = (f64::from(draws.number(-5, 3)).abs(), f64::from(draws.number(-3, 2)));
            let signed = f64::from(draws.number(-9, 0));
            let v: [f64; 3] = std::array::from_fn(|_| draws.number(-3, 3).into());
            let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            let near_log =
                |x: f64| if x.abs() > 0.0625 { 4.0 * power_of_two(-21) } else { 20.0 * epsilon * x.ln_1p().abs() };
            // Name, drawn, exact, the absolute error that the rules leave.
            let rows = [
                ("√", exactly(a).sqrt().value, a.sqrt(), 5.0 * epsilon * a.sqrt()),
                ("pow", exactly(a).pow(exactly(b)).value, a.powf(b), {
                    let logarithm = a.log2().abs();
                    a.powf(b)
                        * (b.abs() * (power_of_two(-20) + 5.0 * epsilon * logarithm)
                            + epsilon * (4.0 + 2.0 * (b * logarithm).abs()))
                }),
                ("ln(1 + x)", exactly(signed.max(-0.875)).ln_1p().value, signed.max(-0.875).ln_1p(), {
                    near_log(signed.max(-0.875)) * if signed < -0.5 { 6.0 } else { 1.0 }
                }),
                ("exp(x) − 1", exactly(signed).exp_m1().value, signed.exp_m1(), 12.0 * epsilon * signed.exp_m1().abs()),
                (
                    "normalize",
                    RandomLegal::normalize(v.map(exactly))[0].value,
                    v[0] / length,
                    12.0 * epsilon * v[0].abs() / length,
                ),
            ];
            for (name, drawn, exact, error) in rows {
                assert!((drawn - exact).abs() <= error, "{name} of {a}, {b}, {signed}, {v:?}: {drawn}, exact {exact}");
            }
        }
    });
}

#[test]
fn series_keep_their_accuracy_up_to_where_they_end() {
    seed(11);
    WGSL.scope(|| {
        let check = |name: &str, exact: f64, draw: &dyn Fn() -> f64, each: f64| {
            let errors: Vec<f64> = (0..2_000).map(|_| (draw() - exact) / exact.abs() / F32::EPSILON).collect();
            #[expect(clippy::cast_precision_loss, reason = "a small count")]
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            let greatest = errors.iter().fold(0.0_f64, |greatest, error| greatest.max(error.abs()));
            assert!(mean.abs() < 2.0, "{name}: mean error of {mean} ε");
            assert!(greatest < each, "{name}: an error of {greatest} ε");
        };
        for x in [0.0625_f64, -0.0625] {
            check("ln(1 + x)", x.ln_1p(), &|| exactly(x).ln_1p().value, 4.0);
        }
        for x in [0.5_f64, -0.5] {
            check("exp(x) − 1", x.exp_m1(), &|| exactly(x).exp_m1().value, 4.0);
        }
    });
}
