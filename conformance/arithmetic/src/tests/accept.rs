//! Intervals of the basic operations, against integers and the values of the format.
//!
//! `+ − ×` reach both neighbours of the exact result, 0 where one of them is subnormal, and nothing else. `/` reaches the
//! values within 2.5 ULP for a divisor whose magnitude lies in [2⁻¹²⁶, 2¹²⁶]. Beyond the format's range anything is legal.

use super::oracle::{
    Draws, Ends, Grid, assert_between, assert_is, boundaries, ends, flushed, hull, over_pairs, power_of_two, product,
    rounded, sum, ulp, within,
};
use crate::profile::{OPENGL, WGSL};
use crate::{Accept, F16, F32, Format, Hardware};
use lightmeter_reference::Real;

/// What an input may be held as: itself, and 0 for a subnormal.
fn held(x: f32) -> Vec<f32> {
    if x.is_subnormal() { vec![x, 0.0] } else { vec![x] }
}

fn input(x: f32) -> Accept {
    Accept::input(x)
}

fn between(low: f32, high: f32) -> Accept {
    Accept::from_bounds(low.into(), high.into())
}

#[test]
fn an_interval_tells_its_ends() {
    let x: Accept = Accept::from_bounds(-0.5, 1.5);
    assert_eq!((x.low(), x.high(), x.width(), x.is_any()), (-0.5, 1.5, 2.0, false));
    assert_eq!(Accept::<F32>::exactly(0.75), Accept::from_bounds(0.75, 0.75));
    // Name, value, whether it is legal.
    let rows = [
        ("the low end", -0.5, true),
        ("the high end", 1.5, true),
        ("inside", 0.0, true),
        ("just below", (-0.5_f64).next_down(), false),
        ("just above", 1.5_f64.next_up(), false),
        ("NaN", f64::NAN, false),
        ("infinity", f64::INFINITY, false),
    ];
    for (name, value, is_legal) in rows {
        assert_eq!(x.contains(value), is_legal, "{name}");
        assert!(Accept::<F32>::ANY.contains(value), "{name} where anything is legal");
    }
    // One infinite end is not everything.
    let upward: Accept = Accept::exactly(f64::INFINITY).hull(Accept::exactly(0.0));
    let downward: Accept = Accept::exactly(f64::NEG_INFINITY).hull(Accept::exactly(0.0));
    assert!(Accept::<F32>::ANY.is_any() && !upward.is_any() && !downward.is_any());
    assert!(!upward.contains(f64::NAN) && !upward.contains(-1.0) && upward.contains(1.0));
}

#[test]
fn a_hull_reaches_the_outer_ends() {
    // Name, a, b, the hull.
    let rows = [
        ("apart", (0.0, 1.0), (2.0, 3.0), (0.0, 3.0)),
        ("apart, turned", (2.0, 3.0), (0.0, 1.0), (0.0, 3.0)),
        ("one within the other", (0.0, 3.0), (1.0, 2.0), (0.0, 3.0)),
        ("overlapping", (-2.0, 1.0), (-1.0, 2.0), (-2.0, 2.0)),
    ];
    for (name, a, b, expected) in rows {
        let [a, b]: [Accept; 2] = [a, b].map(|(low, high)| Accept::from_bounds(low, high));
        assert_is(name, &(a, b), a.hull(b), Some(expected));
    }
}

#[test]
fn bounds_round_outward_and_flush() {
    let (normal, subnormal, max) = (F32::MIN_NORMAL, F32::MIN_SUBNORMAL, F32::MAX);
    // Name, bounds, ends.
    let rows: [(&str, (f64, f64), Ends); 20] = [
        ("to the neighbours", (0.1, 0.2), Some((F32::below(0.1), F32::above(0.2)))),
        ("values stay", (0.5, 0.75), Some((0.5, 0.75))),
        ("the least normal number stays", (normal, normal), Some((normal, normal))),
        ("its negative stays", (-normal, -normal), Some((-normal, -normal))),
        ("a positive subnormal may be 0", (3.0 * subnormal, 1.0), Some((0.0, 1.0))),
        ("a negative subnormal may be 0", (-1.0, -3.0 * subnormal), Some((-1.0, 0.0))),
        ("the subnormal grid is even", (-2.5 * subnormal, 2.5 * subnormal), Some((-3.0 * subnormal, 3.0 * subnormal))),
        ("subnormals stay on it", (-2.0 * subnormal, 5.0 * subnormal), Some((-2.0 * subnormal, 5.0 * subnormal))),
        ("just under the least normal number", (normal - subnormal, normal), Some((0.0, normal))),
        ("just above its negative", (-normal, subnormal - normal), Some((-normal, 0.0))),
        ("zero", (0.0, 0.0), Some((0.0, 0.0))),
        ("around 0 with normal ends", (-1.0, 1.0), Some((-1.0, 1.0))),
        ("the whole range", (-max, max), Some((-max, max))),
        ("above it", (0.0, max.next_up()), None),
        ("below it", (-max.next_up(), 0.0), None),
        ("beyond it as a whole", (2.0 * max, 3.0 * max), None),
        ("NaN at the low end", (f64::NAN, 1.0), None),
        ("NaN at the high end", (1.0, f64::NAN), None),
        ("to infinity", (0.0, f64::INFINITY), None),
        ("from infinity", (f64::NEG_INFINITY, 0.0), None),
    ];
    for (name, (low, high), expected) in rows {
        assert_is::<F32>(name, &(low, high), Accept::from_bounds(low, high), expected);
    }
}

#[test]
fn inputs_and_literals_are_rounded() {
    for x in boundaries() {
        assert_is("an input", &x, input(x), rounded::<F32>(x.into()));
        let narrow = <Accept<F16> as Real>::input(x);
        assert_is("an input of binary16", &x, narrow, rounded::<F16>(x.into()));
    }
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_is("an input", &x, input(x), None);
    }
    for x in [0.1, -0.1, 1.0, 1.0 / 3.0, 1e300] {
        assert_is("a literal", &x, <Accept as Real>::literal(x), rounded::<F32>(x));
    }
}

type Operation = fn(Accept, Accept) -> Accept;
type Oracle = fn(f32, f32) -> Ends;

const EXACT_OPERATIONS: [(&str, Operation, Oracle); 3] =
    [("+", |a, b| a + b, sum), ("−", |a, b| a - b, |a, b| sum(a, -b)), ("·", |a, b| a * b, product)];

#[test]
fn numbers_at_the_boundaries_round_up_or_down() {
    let numbers = boundaries();
    WGSL.scope(|| {
        for (a, b) in numbers.iter().flat_map(|&a| numbers.iter().map(move |&b| (a, b))) {
            for (name, operation, oracle) in EXACT_OPERATIONS {
                let expected = over_pairs(&held(a), &held(b), oracle);
                assert_is(name, &(a, b), operation(input(a), input(b)), expected);
            }
        }
    });
}

#[test]
fn random_numbers_and_ranges_round_up_or_down() {
    let mut draws = Draws(2);
    WGSL.scope(|| {
        for (least, most) in [(-12, 12), (-90, 90), (-126, -100), (-70, -55), (60, 66)] {
            for _ in 0..2_000 {
                let (a, b) = (draws.range(least, most), draws.range(least, most));
                for (name, operation, oracle) in EXACT_OPERATIONS {
                    let numbers = operation(input(a[0]), input(b[1]));
                    assert_is(name, &(a[0], b[1]), numbers, oracle(a[0], b[1]));
                    let ranges = operation(between(a[0], a[1]), between(b[0], b[1]));
                    assert_is(name, &(a, b), ranges, over_pairs(&a, &b, oracle));
                }
            }
        }
    });
}

#[test]
fn binary16_rounds_up_or_down() {
    let mut draws = Draws(3);
    WGSL.scope(|| {
        for _ in 0..10_000 {
            let [a, b] = [(); 2].map(|()| F16::below(draws.number(-14, 13).into()));
            let [x, y] = [a, b].map(Accept::<F16>::exactly);
            for (name, got, exact) in [("+", x + y, a + b), ("−", x - y, a - b), ("·", x * y, a * b)] {
                assert_is(name, &(a, b), got, rounded::<F16>(exact));
            }
        }
    });
}

#[test]
fn what_may_be_anything_stays_anything() {
    let (any, one, zero) = (Accept::<F32>::ANY, input(1.0), input(0.0));
    WGSL.scope(|| {
        let rows = [
            ("ANY + 1", any + one),
            ("1 − ANY", one - any),
            ("ANY − ANY", any - any),
            ("ANY · 0", any * zero),
            ("0 · ANY", zero * any),
            ("ANY / 1", any / one),
            ("1 / ANY", one / any),
            ("−ANY", -any),
            ("max(ANY, 1)", any.max(one)),
            ("max(1, ANY)", one.max(any)),
            ("min(ANY, 1)", any.min(one)),
            ("min(1, ANY)", one.min(any)),
            ("|ANY|", any.abs()),
            ("√ANY", any.sqrt()),
            ("1/√ANY", any.inverse_sqrt()),
            ("exp(ANY)", any.exp()),
            ("exp2(ANY)", any.exp2()),
            ("log2(ANY)", any.log2()),
            ("ln(1 + ANY)", any.ln_1p()),
            ("exp(ANY) − 1", any.exp_m1()),
            ("round(ANY)", any.round()),
        ];
        for (name, got) in rows {
            assert!(got.is_any(), "{name}: {got:?}");
        }
    });
}

#[test]
fn a_profile_with_a_relative_error_widens_the_exact_range() {
    let mut draws = Draws(4);
    for _ in 0..5_000 {
        let (a, b) = (draws.number(-8, 8), draws.number(-8, 8));
        let (x, y) = (f64::from(a), f64::from(b));
        let (total, product) = OPENGL.scope(|| (input(a) + input(b), input(a) * input(b)));
        for (name, got, exact) in [("+", total, x + y), ("·", product, x * y)] {
            let (least, most) = (1e-5 * exact.abs() * (1.0 - 1e-9), 1e-5 * exact.abs() * (1.0 + 1e-9));
            let required = Some((F32::below(exact - least), F32::above(exact + least)));
            let permitted = Some((F32::below(exact - most), F32::above(exact + most)));
            assert_between(name, &(a, b), got, [required, permitted]);
        }
    }
}

/// The values within 2.5 ULP of a/b, and those that the slack of f64 may add.
fn quotient<F: Grid>(a: f64, b: f64) -> [Ends; 2] {
    if !(F::MIN_NORMAL..=1.0 / F::MIN_NORMAL).contains(&b.abs()) {
        return [None, None];
    }
    let exact = a / b;
    if exact == 0.0 {
        return [Some((0.0, 0.0)); 2];
    }
    let error = 2.5 * ulp::<F>(exact);
    // Bounds below the normal range are rounded outward.
    let outward = if exact.abs() - error < F::MIN_NORMAL { F::MIN_SUBNORMAL } else { 0.0 };
    let loose = error + exact.abs() * power_of_two(-47) + outward;
    [error, loose].map(|error| within::<F>(exact - error, exact + error))
}

#[test]
fn quotients_of_numbers_reach_two_and_a_half_ulp() {
    let (numbers, mut draws, mut count) = (boundaries(), Draws(5), 0);
    let pairs = numbers.iter().flat_map(|&a| numbers.iter().map(move |&b| (a, b)));
    let random: Vec<(f32, f32)> = (0..10_000).map(|_| (draws.number(-60, 60), draws.number(-60, 60))).collect();
    WGSL.scope(|| {
        for (a, b) in pairs.chain(random).filter(|(a, b)| !a.is_subnormal() && !b.is_subnormal()) {
            let expected = quotient::<F32>(a.into(), b.into());
            assert_between("/", &(a, b), input(a) / input(b), expected);
            count += usize::from(expected[0] == expected[1]);
        }
        for _ in 0..5_000 {
            let [a, b] = [(); 2].map(|()| F16::below(draws.number(-14, 14).into()));
            let got = Accept::<F16>::exactly(a) / Accept::exactly(b);
            assert_between("/ of binary16", &(a, b), got, quotient::<F16>(a, b));
        }
    });
    assert!(count > 12_000, "the rule decides on both sides of only {count} rows");
}

#[test]
fn quotients_of_ranges_reach_those_of_their_ends_and_a_whole_ulp() {
    let mut draws = Draws(6);
    WGSL.scope(|| {
        for _ in 0..10_000 {
            let (a, b) = (draws.range(-8, 8), draws.range(-8, 8));
            let got = between(a[0], a[1]) / between(b[0], b[1]);
            if b[0] <= 0.0 && b[1] >= 0.0 {
                assert!(got.is_any(), "{a:?} / {b:?}: {got:?}");
                continue;
            }
            let corners = over_pairs(&a, &b, |a, b| quotient::<F32>(a.into(), b.into())[0]);
            let exact = over_pairs(&a, &b, |a, b| Some((f64::from(a) / f64::from(b), f64::from(a) / f64::from(b))));
            let (low, high) = exact.expect("finite quotients");
            // Inside of a range an ULP is at most 2⁻²³ of the value.
            let error = |x: f64| 2.5 * power_of_two(-23) * x.abs() * (1.0 + power_of_two(-24));
            assert_between("/", &(a, b), got, [corners, within::<F32>(low - error(low), high + error(high))]);
            let widened = |sharp: f64| sharp * (1.0 - power_of_two(-40));
            let required = within::<F32>(low - widened(error(low)), high + widened(error(high)));
            assert_between("/, documented", &(a, b), got, [required, None]);
        }
    });
}

#[test]
fn divisors_at_the_ends_of_the_promise() {
    let (least, most) = (F32::MIN_NORMAL, power_of_two(126));
    // Name, the divisor, whether the quotient is bounded.
    let rows = [
        ("the least promised", (least, least), true),
        ("its negative", (-least, -least), true),
        ("the greatest promised", (most, most), true),
        ("its negative", (-most, -most), true),
        ("the whole promise", (least, most), true),
        ("the whole negative promise", (-most, -least), true),
        ("above it", (most, F32::above(most.next_up())), false),
        ("below its negative", (F32::below((-most).next_down()), -most), false),
        ("from a number that may be flushed", (0.0, 1.0), false),
        ("up to 0", (-1.0, 0.0), false),
        ("around 0", (-1.0, 1.0), false),
    ];
    for (name, (low, high), is_bounded) in rows {
        let divisor: Accept = Accept::from_bounds(low, high);
        let got = WGSL.scope(|| Accept::exactly(0.0) / divisor);
        assert_is(name, &divisor, got, is_bounded.then_some((0.0, 0.0)));
    }
    let small: Accept = Accept::exactly(least / 2.0);
    assert!(WGSL.scope(|| Accept::exactly(0.0) / small).is_any(), "a subnormal divisor");
    // Only a dividend that is 0 as a whole gives exactly 0.
    let up_to_one = WGSL.scope(|| Accept::<F32>::from_bounds(0.0, 1.0) / Accept::exactly(1.0));
    assert!(up_to_one.high() > 1.0 && up_to_one.low() < 0.0 && up_to_one.low() >= -3.0 * F32::MIN_SUBNORMAL);
    let from_minus_one = WGSL.scope(|| Accept::<F32>::from_bounds(-1.0, 0.0) / Accept::exactly(1.0));
    assert!(from_minus_one.low() < -1.0 && from_minus_one.high() > 0.0);
}

#[test]
fn exact_functions_move_the_ends() {
    let mut draws = Draws(7);
    for _ in 0..5_000 {
        let (a, b) = (draws.range(-2, 1), draws.range(-2, 1));
        let (x, y) = (between(a[0], a[1]), between(b[0], b[1]));
        let point = |x: f32| Some((f64::from(x), f64::from(x)));
        assert_is("−", &a, -x, hull(a.map(|x| point(-x))));
        assert_is("max", &(a, b), x.max(y), over_pairs(&a, &b, |a, b| point(f32::max(a, b))));
        assert_is("min", &(a, b), x.min(y), over_pairs(&a, &b, |a, b| point(f32::min(a, b))));
        let zero = (a[0] <= 0.0 && a[1] >= 0.0).then(|| point(0.0));
        assert_is("abs", &a, x.abs(), hull(a.map(|x| point(x.abs())).into_iter().chain(zero)));
    }
    // Name, range, its absolute value.
    for (name, (low, high), expected) in [
        ("from 0", (0.0, 2.0), (0.0, 2.0)),
        ("up to 0", (-2.0, 0.0), (0.0, 2.0)),
        ("around 0", (-3.0, 2.0), (0.0, 3.0)),
        ("positive", (1.0, 2.0), (1.0, 2.0)),
        ("negative", (-2.0, -1.0), (1.0, 2.0)),
    ] {
        assert_is::<F32>(name, &(low, high), Accept::from_bounds(low, high).abs(), Some(expected));
    }
}

#[test]
fn a_tie_rounds_either_way() {
    // Name, range, ends.
    let rows = [
        ("a whole number", (3.0, 3.0), (3.0, 3.0)),
        ("down", (2.25, 2.25), (2.0, 2.0)),
        ("up", (2.75, 2.75), (3.0, 3.0)),
        ("a tie", (2.5, 2.5), (2.0, 3.0)),
        ("a tie with an odd number below", (3.5, 3.5), (3.0, 4.0)),
        ("a negative tie", (-2.5, -2.5), (-3.0, -2.0)),
        ("negative, up", (-2.25, -2.25), (-2.0, -2.0)),
        ("a range", (-1.75, 1.25), (-2.0, 1.0)),
        ("a range from a tie to a tie", (0.5, 1.5), (0.0, 2.0)),
    ];
    for (name, (low, high), expected) in rows {
        assert_is::<F32>(name, &(low, high), Accept::from_bounds(low, high).round(), Some(expected));
    }
}

#[test]
fn an_undecided_condition_gives_the_hull() {
    let [then, otherwise] = [(1.0, 2.0), (-4.0, -3.0)];
    let if_ge = |a: Accept, b: Accept| {
        Accept::if_ge(a, b, || Accept::from_bounds(1.0, 2.0), || Accept::<F32>::from_bounds(-4.0, -3.0))
    };
    // Name, a, b, the result.
    let rows = [
        ("above", (0.5, 0.75), (0.0, 0.25), then),
        ("touching from above is ≥", (0.5, 0.75), (0.0, 0.5), then),
        ("equal numbers are ≥", (0.5, 0.5), (0.5, 0.5), then),
        ("below", (0.0, 0.25), (0.5, 0.75), otherwise),
        ("touching from below is undecided", (0.0, 0.5), (0.5, 0.75), (-4.0, 2.0)),
        ("overlapping", (0.0, 0.625), (0.5, 0.75), (-4.0, 2.0)),
    ];
    for (name, a, b, expected) in rows {
        let [a, b] = [a, b].map(|(low, high)| Accept::from_bounds(low, high));
        assert_is(name, &(a, b), if_ge(a, b), Some(expected));
    }
    let one = Accept::exactly(1.0);
    for (name, a, b) in
        [("ANY ≥ 1", Accept::ANY, one), ("1 ≥ ANY", one, Accept::ANY), ("ANY", Accept::ANY, Accept::ANY)]
    {
        assert_is(name, &(a, b), if_ge(a, b), Some((-4.0, 2.0)));
    }
}

#[test]
fn a_floor_is_followed_for_each_whole_number() {
    let squared = |low: f64, high: f64| Accept::<F32>::from_bounds(low, high).floor_then(|k| Accept::exactly(k * k));
    // Name, range, the hull of the squares of its floors.
    let rows: [(&str, (f64, f64), Ends); 8] = [
        ("one floor", (2.25, 2.75), Some((4.0, 4.0))),
        ("a whole number", (3.0, 3.0), Some((9.0, 9.0))),
        ("just below a whole number", (2.5, 3.0_f64.next_down()), Some((4.0, 9.0))),
        ("three floors, the least inside", (-1.5, 0.5), Some((0.0, 4.0))),
        ("six floors, the least inside", (-2.5, 2.5), Some((0.0, 9.0))),
        ("65 floors", (0.0, 64.0), Some((0.0, 4096.0))),
        ("more", (0.0, 65.0), None),
        ("the whole range", (-F32::MAX, F32::MAX), None),
    ];
    for (name, (low, high), expected) in rows {
        assert_is(name, &(low, high), squared(low, high), expected);
    }
    assert!(Accept::<F32>::ANY.floor_then(Accept::<F32>::exactly).is_any());
}

#[test]
fn at_most_is_without_doubt() {
    let x: Accept = Accept::from_bounds(-1.0, 0.5);
    assert!(x.is_at_most(0.5) && x.is_at_most(1.0) && !x.is_at_most(0.25) && !x.is_at_most(-1.0));
    assert!(!Accept::<F32>::ANY.is_at_most(f64::INFINITY), "a NaN is not at most anything");
}

type Unit = Accept<Hardware<F16>>;

#[test]
fn hardware_overflows_to_infinity_or_the_greatest() {
    let (max, infinity) = (F16::MAX, f64::INFINITY);
    let exactly = Unit::exactly;
    let past = Unit::from_bounds(max, infinity);
    WGSL.scope(|| {
        // Name, result, ends.
        let rows: [(&str, Unit, Ends); 19] = [
            ("60000 + 60000", exactly(60_000.0) + exactly(60_000.0), Some((max, infinity))),
            ("−60000 − 60000", exactly(-60_000.0) - exactly(60_000.0), Some((-infinity, -max))),
            ("60000 · [−2, 2]", exactly(60_000.0) * Unit::from_bounds(-2.0, 2.0), None),
            ("60000 · [1, 2]", exactly(60_000.0) * Unit::from_bounds(1.0, 2.0), Some((60_000.0, infinity))),
            ("−60000 · [1, 2]", exactly(-60_000.0) * Unit::from_bounds(1.0, 2.0), Some((-infinity, -60_000.0))),
            ("from the least number", Unit::from_bounds(-max, 1e6), Some((-max, infinity))),
            ("to the greatest number", Unit::from_bounds(-1e6, max), Some((-infinity, max))),
            ("the finite end is rounded outward", Unit::from_bounds(1.0 + 1e-9, 1e6), Some((1.0, infinity))),
            ("and so is the other", Unit::from_bounds(-1e6, 1.0 + 1e-9), Some((-infinity, 1.0 + F16::EPSILON))),
            ("what fits is as everywhere", Unit::from_bounds(-max, max), Some((-max, max))),
            ("infinity + 1", past + exactly(1.0), Some((max, infinity))),
            ("infinity − infinity", past - past, None),
            ("infinity · 2", past * exactly(2.0), Some((max, infinity))),
            ("infinity · 0", past * exactly(0.0), None),
            ("0 · infinity", exactly(0.0) * past, None),
            ("0 · −infinity", exactly(0.0) * -past, None),
            ("−infinity · what reaches 0", -past * Unit::from_bounds(0.0, 1.0), None),
            ("NaN below", Unit::from_bounds(f64::NAN, 1.0), None),
            ("NaN above", Unit::from_bounds(1.0, f64::NAN), None),
        ];
        for (name, got, expected) in rows {
            assert_is(name, &"the row", got, expected);
        }
        let zero = exactly(0.0) * exactly(1.0);
        assert_eq!((ends(zero), ends(exactly(0.0) * exactly(0.0))), (Some((0.0, 0.0)), Some((0.0, 0.0))));
        assert_eq!(flushed::<F16>((0.0, 0.0)), (0.0, 0.0));
    });
}
