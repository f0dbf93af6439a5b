//! Chains, whose order is open, and the functions whose form is open.
//!
//! A sum of n terms errs by at most ((1 + ε)ⁿ⁻¹ − 1)·Σ|x| in any order, and every order that is tried lies inside.

use super::oracle::{
    Draws, Ends, Grid, assert_between, assert_is, ends, flushed, hull, over_pairs, power_of_two, product, sum, within,
};
use crate::profile::{OPENGL, Profile, WGSL};
use crate::{Accept, F16, F32, Format, Hardware, RandomLegal, random};
use lightmeter_reference::Real;

fn exactly<F: Format>(x: f32) -> Accept<F> {
    Accept::exactly(x.into())
}

fn between([low, high]: [f32; 2]) -> Accept {
    Accept::from_bounds(low.into(), high.into())
}

#[expect(clippy::cast_possible_truncation, reason = "the ends of an oracle are values of binary32")]
fn narrow(x: f64) -> f32 {
    x as f32
}

/// Every value that some order and rounding of a chain of operations reaches.
fn outcomes(items: &[f32], operation: &dyn Fn(f32, f32) -> Ends, take: &mut impl FnMut(f32)) {
    if let [only] = items {
        return take(*only);
    }
    for i in 0..items.len() {
        for j in i + 1..items.len() {
            let mut rest = items.to_vec();
            let (b, a) = (rest.remove(j), rest.remove(i));
            let (low, high) = operation(a, b).expect("a finite result");
            rest.push(narrow(low));
            outcomes(&rest, operation, take);
            if low < high {
                *rest.last_mut().expect("the result") = narrow(high);
                outcomes(&rest, operation, take);
            }
        }
    }
}

/// (1 + ε)ⁿ⁻¹ − 1.
fn growth(n: i32, epsilon: f64) -> f64 {
    (1.0 + epsilon).powi(n - 1) - 1.0
}

/// The values within an error, less and more the slack of f64.
fn around<F: Grid>(exact: (f64, f64), error: f64, magnitude: f64) -> [Ends; 2] {
    [-1.0, 1.0].map(|sign| {
        let error = error + sign * magnitude * power_of_two(-44);
        within::<F>(exact.0 - error, exact.1 + error)
    })
}

/// The same rounded outward.
fn outward<F: Grid>(exact: (f64, f64), error: f64, magnitude: f64) -> [Ends; 2] {
    [-1.0, 1.0].map(|sign| {
        let error = error + sign * magnitude * power_of_two(-44);
        Some((F::below(exact.0 - error), F::above(exact.1 + error)))
    })
}

#[test]
fn every_order_of_a_sum_lies_inside_and_the_bound_is_reached() {
    let mut draws = Draws(1);
    WGSL.scope(|| {
        for _ in 0..1_500 {
            let four: [f32; 4] = std::array::from_fn(|_| draws.number(-8, 8));
            let three = [four[0], four[1], four[2]];
            for (terms, got) in [
                (&three[..], Accept::sum(three.map(exactly::<F32>))),
                (&four[..], Accept::sum(four.map(exactly::<F32>))),
            ] {
                outcomes(terms, &sum, &mut |x| assert!(got.contains(x.into()), "{x} of {terms:?} outside of {got:?}"));
                let exact: f64 = terms.iter().map(|&x| f64::from(x)).sum();
                let magnitude: f64 = terms.iter().map(|&x| f64::from(x).abs()).sum();
                let n = i32::try_from(terms.len()).expect("few");
                let error = growth(n, F32::EPSILON) * magnitude;
                // A sum that is exact in any order was seen to be by all outcomes being inside of it.
                if !ends(got).is_some_and(|(low, high)| low >= high) {
                    assert_between("sum", &terms, got, around::<F32>((exact, exact), error, magnitude));
                }
                let over = Accept::sum_over(terms.iter().copied().map(exactly::<F32>));
                assert_eq!(over, got, "a sum over {terms:?}");
            }
        }
    });
}

#[test]
fn a_sum_of_which_every_partial_sum_is_a_number_is_exact() {
    let mut draws = Draws(3);
    // Multiples of a bit, which sum to no more than 2²⁴ of it.
    for _ in 0..2_000 {
        let bit = power_of_two(i32::try_from(draws.bits() % 200).expect("few") - 126);
        let terms: [f32; 4] = std::array::from_fn(|_| {
            let multiple = i32::try_from(draws.bits() >> 9).expect("few") - (1 << 22);
            narrow(f64::from(multiple) * bit)
        });
        let exact: f64 = terms.iter().map(|&x| f64::from(x)).sum();
        let got = WGSL.scope(|| Accept::sum(terms.map(exactly::<F32>)));
        outcomes(&terms, &sum, &mut |x| assert!((f64::from(x) - exact).abs() <= 0.0, "{terms:?}"));
        assert_is("a sum", &terms, got, Some((exact, exact)));
    }
    let most = narrow(power_of_two(24));
    let least = narrow(F32::MIN_NORMAL);
    // Name, terms, profile, whether it is exact.
    let rows = [
        ("2²⁴ of the last bit", [1.0, most / 2.0, most / 2.0 - 1.0], &WGSL, true),
        ("one more", [1.0, most / 2.0, most / 2.0], &WGSL, false),
        ("the least normal number", [least, 2.0 * least, -3.0 * least], &WGSL, true),
        ("a partial sum may be flushed", [1.5 * least, -2.0 * least, -least], &WGSL, false),
        ("additions of one part in 10⁵", [1.0, 2.0, -3.0], &OPENGL, false),
    ];
    for (name, terms, profile, is_exact) in rows {
        let got = profile.scope(|| Accept::sum(terms.map(exactly::<F32>)));
        let (low, high) = ends(got).expect("finite");
        assert_eq!(low >= high, is_exact, "{name}: {got:?}");
    }
    let range = WGSL.scope(|| Accept::sum([between([0.0, 1.0]), exactly(2.0), exactly(3.0)]));
    assert!(range.contains(5.0) && range.contains(6.0), "{range:?}");
}

#[test]
fn sums_of_ranges_err_by_the_greatest_magnitude() {
    let mut draws = Draws(2);
    for profile in [&WGSL, &OPENGL] {
        for _ in 0..2_000 {
            let ranges: [[f32; 2]; 3] = std::array::from_fn(|_| draws.range(-8, 8));
            let got = profile.scope(|| Accept::sum(ranges.map(between)));
            let total = |f: &dyn Fn([f64; 2]) -> f64| ranges.iter().map(|range| f(range.map(f64::from))).sum::<f64>();
            let magnitude = total(&|[low, high]| low.abs().max(high.abs()));
            let exact = (total(&|[low, _]| low), total(&|[_, high]| high));
            let error = growth(3, profile.relative.max(F32::EPSILON)) * magnitude;
            assert_between("sum", &ranges, got, around::<F32>(exact, error, magnitude));
        }
    }
}

#[test]
fn zeros_in_a_sum_round_nothing() {
    let (zero, a, b) = (exactly::<F32>(0.0), exactly(0.1), exactly(1.0 / 3.0));
    WGSL.scope(|| {
        let two = ends(Accept::sum([a, b]));
        assert_eq!(two, sum(0.1, 1.0 / 3.0), "two terms are one addition");
        // Name, result, ends.
        let rows = [
            ("no term", Accept::sum([]), Some((0.0, 0.0))),
            ("one term", Accept::sum([a]), ends(a)),
            ("one term and zeros", Accept::sum([zero, a, zero]), ends(a)),
            ("zeros", Accept::sum([zero, zero, zero]), Some((0.0, 0.0))),
            ("two terms and zeros", Accept::sum([zero, a, zero, b, zero]), two),
            ("one range is not rounded", Accept::sum([between([0.0, 1.0]), zero]), Some((0.0, 1.0))),
        ];
        for (name, got, expected) in rows {
            assert_is(name, &"the row", got, expected);
        }
        let range = between([0.0, 1.0]);
        assert_is("a range from 0 counts", &range, Accept::sum([range, a, b]), {
            let (low, high) =
                (f64::from(0.1_f32) + f64::from(1.0_f32 / 3.0), 1.0 + f64::from(0.1_f32) + f64::from(1.0_f32 / 3.0));
            let error = growth(3, F32::EPSILON) * high;
            within::<F32>(low - error, high + error)
        });
    });
}

#[test]
fn a_sum_that_may_overflow_in_some_order_may_give_anything() {
    let third = narrow(power_of_two(126));
    WGSL.scope(|| {
        // Name, terms, whether the sum is bounded.
        let rows = [
            ("Σ|x| below the greatest number", [third, third, -third], true),
            ("Σ|x| = 2¹²⁸ with a sum of 2¹²⁶", [2.0 * third, third, -third], false),
            ("a sum that overflows", [2.0 * third, 2.0 * third, third], false),
        ];
        for (name, terms, is_bounded) in rows {
            let got: Accept = Accept::sum(terms.map(exactly::<F32>));
            assert_eq!(!got.is_any(), is_bounded, "{name}: {got:?}");
        }
        // Terms whose magnitudes sum to the greatest number, and their sum to nearly 0.
        let at_most = [f32::MAX / 2.0, -f32::MAX / 4.0, -f32::MAX / 4.0];
        assert!(!Accept::<F32>::sum(at_most.map(exactly::<F32>)).is_any());
        assert!(Accept::sum([Accept::<F32>::ANY, exactly(1.0), exactly(1.0)]).is_any());
    });
}

#[test]
fn partial_sums_may_be_flushed_below_a_magnitude() {
    let threshold = F32::MIN_NORMAL / F32::EPSILON * 16.0;
    let rows = [
        ("at the threshold rounding covers it", 1.0, 0.0),
        ("below it", 0.5, 3.0),
        ("far below", power_of_two(-20), 3.0),
    ];
    WGSL.scope(|| {
        for (name, scale, flushes) in rows {
            // With a last bit of 1, so that halves of it do not sum exactly in every order.
            let half = narrow(threshold * scale / 2.0).next_up();
            let got: Accept = Accept::sum([half, -half / 2.0, -half / 2.0].map(exactly::<F32>));
            let magnitude = 2.0 * f64::from(half);
            let error = growth(3, F32::EPSILON) * magnitude + flushes * F32::MIN_NORMAL;
            assert_between(name, &half, got, around::<F32>((0.0, 0.0), error, magnitude));
        }
        // 1.5·2⁻¹²⁶ − 2⁻¹²⁶ is subnormal, and may be 0 before 2⁻¹²⁷ is added.
        let tiny = f32::MIN_POSITIVE;
        let got: Accept = Accept::sum([1.5 * tiny, -tiny, 3.0 * tiny].map(exactly::<F32>));
        assert!(got.contains(f64::from(3.0 * tiny)) && got.contains(f64::from(3.5 * tiny)), "{got:?}");
    });
}

#[test]
fn every_order_of_a_product_lies_inside_and_the_bound_is_reached() {
    let mut draws = Draws(3);
    for profile in [&WGSL, &OPENGL] {
        for _ in 0..1_500 {
            let four: [f32; 4] = std::array::from_fn(|_| draws.number(-8, 8));
            let three = [four[0], four[1], four[2]];
            let intervals = profile
                .scope(|| [Accept::product(three.map(exactly::<F32>)), Accept::product(four.map(exactly::<F32>))]);
            for (factors, got) in [&three[..], &four[..]].into_iter().zip(intervals) {
                outcomes(factors, &product, &mut |x| {
                    assert!(got.contains(x.into()), "{x} of {factors:?} outside of {got:?}");
                });
                let exact: f64 = factors.iter().map(|&x| f64::from(x)).product();
                let n = i32::try_from(factors.len()).expect("few");
                let error = growth(n, profile.relative.max(F32::EPSILON)) * exact.abs();
                let expected = outward::<F32>((exact, exact), error, exact.abs());
                assert_between("product", &factors, got, expected);
            }
        }
    }
}

#[test]
fn two_factors_round_once_and_powers_of_two_never() {
    let mut draws = Draws(4);
    WGSL.scope(|| {
        for _ in 0..2_000 {
            let (a, b) = (draws.number(-8, 8), draws.number(-8, 8));
            for (name, got, scale) in [
                ("a·b", Accept::product([a, b].map(exactly::<F32>)), 1.0),
                ("a·2·b", Accept::product([a, 2.0, b].map(exactly::<F32>)), 2.0),
                ("¼·a·1·b·−1", Accept::product([0.25, a, 1.0, b, -1.0].map(exactly::<F32>)), -0.25),
            ] {
                assert_is(name, &(a, b), got, product(a * scale, b));
            }
            let (x, y) = (draws.range(-8, 8), draws.range(-8, 8));
            let got = Accept::product([x, y].map(between));
            assert_is("ranges", &(x, y), got, over_pairs(&x, &y, product));
            // A range from a power of two to another is not one.
            let z = [2.0, 4.0];
            let got = Accept::product([x, y, z].map(between));
            let exact = hull(
                x.into_iter()
                    .flat_map(|x| y.map(|y| f64::from(x) * f64::from(y)))
                    .flat_map(|xy| [Some((2.0 * xy, 2.0 * xy)), Some((4.0 * xy, 4.0 * xy))]),
            );
            let (low, high) = exact.expect("finite");
            let error = growth(3, F32::EPSILON) * low.abs().max(high.abs());
            let expected = outward::<F32>((low, high), error, low.abs().max(high.abs()));
            assert_between("three ranges", &(x, y), got, expected);
        }
        // Name, result, ends.
        let rows: [(&str, Accept, Ends); 6] = [
            ("no factor", Accept::product([]), Some((1.0, 1.0))),
            ("ones", Accept::product([1.0, 1.0].map(exactly::<F32>)), Some((1.0, 1.0))),
            ("one factor", Accept::product([0.1].map(exactly::<F32>)), Some((0.1_f32.into(), 0.1_f32.into()))),
            (
                "a zero among inexact factors",
                Accept::product([0.1, 0.0, 0.3, 0.7].map(exactly::<F32>)),
                Some((0.0, 0.0)),
            ),
            ("a zero beside ANY", Accept::product([exactly(0.0), Accept::ANY]), None),
            ("ANY", Accept::product([Accept::ANY, exactly(0.5)]), None),
        ];
        for (name, got, expected) in rows {
            assert_is(name, &"the row", got, expected);
        }
        // A partial product of a range that holds 0 may be flushed from 2⁻¹²⁶ downwards.
        let got = Accept::product([between([0.0, 1.0]), exactly(0.5)]);
        assert!(got.low() < 0.0 && got.low() >= -2.0 * F32::MIN_NORMAL && got.contains(0.5), "{got:?}");
        assert!(got.high() < 0.5 * (1.0 + 4.0 * F32::EPSILON), "{got:?}");
    });
}

#[test]
fn a_product_that_overflows_or_underflows_in_some_order() {
    let [up, down] = [2.0_f32.powi(100), 2.0_f32.powi(-100)];
    let product = |factors: [f32; 3]| -> Accept { WGSL.scope(|| Accept::product(factors.map(exactly::<F32>))) };
    // Partial products overflow in some order, whatever the last one is.
    for factors in [[up, up, down], [up, down, up], [-up, up, down], [up, 2.0_f32.powi(28), 1e-30]] {
        assert!(product(factors).is_any(), "{factors:?}");
    }
    assert_is("the greatest that does not", &up, product([up, 2.0_f32.powi(27), 1.0]), {
        Some((power_of_two(127), power_of_two(127)))
    });
    assert!(!product([f32::MAX, 1.0, 0.5]).is_any(), "the greatest number itself");
    // 2⁻²⁰⁰ may be flushed, and what it lost is 2⁻¹⁰⁰ of the result.
    let lost = 2.0 * F32::MIN_NORMAL * power_of_two(100);
    let exact = power_of_two(-100);
    assert_is("an underflow on the way", &down, product([down, down, up]), Some((exact - lost, exact + lost)));
    let got = product([down, -down, up]);
    assert_is("the same of a negative product", &down, got, Some((-exact - lost, -exact + lost)));
    // 2⁻¹²⁶ is normal, and half of it is not.
    let least = 2.0_f32.powi(-26);
    assert_is("the least normal product", &down, product([down, least, 1.0]), {
        Some((F32::MIN_NORMAL, F32::MIN_NORMAL))
    });
    let got = product([down, least / 2.0, 2.0]);
    let (low, high) = (F32::MIN_NORMAL * (1.0 - 4.0), F32::MIN_NORMAL * (1.0 + 4.0));
    assert_is("half of it on the way", &down, got, Some((low, high)));
}

#[test]
fn three_inexact_factors_may_lose_a_subnormal_too() {
    let (a, b, c) = (3.0_f32.recip(), 2.0_f32.powi(-126) * 1.7, 3.3e20_f32);
    let got: Accept = WGSL.scope(|| Accept::product([a, b, c].map(exactly::<F32>)));
    outcomes(&[a, b, c], &product, &mut |x| assert!(got.contains(x.into()), "{x:e} outside of {got:?}"));
    assert!(got.contains(0.0), "{got:?}");
    let exact = f64::from(a) * f64::from(b) * f64::from(c);
    let error = growth(3, F32::EPSILON) * exact + 2.0 * F32::MIN_NORMAL * f64::from(c);
    assert_between("product", &(a, b, c), got, outward::<F32>((exact, exact), error, exact));
}

#[test]
fn a_difference_of_products_errs_by_its_magnitudes() {
    let mut draws = Draws(5);
    for profile in [&WGSL, &OPENGL] {
        for _ in 0..2_000 {
            let ranges: [[f32; 2]; 4] = std::array::from_fn(|k| {
                let [low, high] = draws.range(-8, 8);
                if k % 2 == 0 { [low, low] } else { [low, high] }
            });
            let [a, b, c, d] = ranges.map(between);
            let got = profile.scope(|| Accept::difference_of_products([a, b], [c, d]));
            let range = |a: [f32; 2], b: [f32; 2]| {
                let corner = |a: f32, b: f32| Some((f64::from(a) * f64::from(b), f64::from(a) * f64::from(b)));
                over_pairs(&a, &b, corner).expect("finite")
            };
            let (ab, cd) = (range(ranges[0], ranges[1]), range(ranges[2], ranges[3]));
            let magnitude = ab.0.abs().max(ab.1.abs()) + cd.0.abs().max(cd.1.abs());
            // 12 terms, whose magnitudes sum to at most 4(|ab| + |cd|).
            let error = growth(12, profile.relative.max(F32::EPSILON)) * 4.0 * magnitude;
            let expected = outward::<F32>((ab.0 - cd.1, ab.1 - cd.0), error, magnitude);
            assert_between("a·b − c·d", &ranges, got, expected);
        }
    }
    // A small magnitude may lose 12 subnormals besides.
    let threshold = F32::MIN_NORMAL / (F32::EPSILON * F32::EPSILON) * 16.0;
    for (name, scale, flushes) in [("at the threshold", 1.0, 0.0), ("below it", power_of_two(-7), 12.0)] {
        let half = Accept::<F32>::exactly(threshold * scale / 2.0);
        let one = exactly(1.0);
        let got = WGSL.scope(|| Accept::difference_of_products([half, one], [half, one]));
        let error = growth(12, F32::EPSILON) * 4.0 * threshold * scale + flushes * F32::MIN_NORMAL;
        assert_between(name, &half, got, outward::<F32>((0.0, 0.0), error, threshold * scale));
    }
}

#[test]
fn both_forms_of_a_function_are_legal() {
    let mut draws = Draws(6);
    let forms = |x: [Accept; 4]| {
        let [a, b, c, t] = x;
        let one = exactly(1.0);
        [
            ("mix", Accept::mix(a, b, t), a * (one - t) + b * t, a + t * (b - a)),
            (
                "mix of differences",
                Accept::mix_of_differences([c - a, c - b], c, [a, b], t),
                Accept::mix(c - a, c - b, t),
                c - Accept::mix(a, b, t),
            ),
            ("quadratic", Accept::quadratic([a, b, c], t), a + t * (b + t * c), {
                Accept::sum([a, b * t, Accept::product([c, t, t])])
            }),
        ]
    };
    let (mut told_apart, mut rows) = (0, 0);
    WGSL.scope(|| {
        for _ in 0..2_000 {
            let numbers: [f32; 4] = std::array::from_fn(|_| draws.number(-8, 8));
            let ranges: [[f32; 2]; 4] = std::array::from_fn(|_| draws.range(-2, 2));
            for inputs in [numbers.map(exactly::<F32>), ranges.map(between)] {
                for (name, got, first, second) in forms(inputs) {
                    assert_is(name, &inputs, got, hull([ends(first), ends(second)]));
                    told_apart += usize::from(ends(first) != ends(got)) + usize::from(ends(second) != ends(got));
                    rows += 1;
                }
            }
        }
    });
    assert!(told_apart > rows, "either form falls short in {told_apart} of {rows} rows");
}

#[test]
fn a_direction_is_a_quotient_or_a_product() {
    let mut draws = Draws(7);
    WGSL.scope(|| {
        for _ in 0..2_000 {
            let v: [f32; 3] = std::array::from_fn(|_| draws.number(-8, 8));
            let x = v.map(exactly::<F32>);
            let square = Accept::sum(x.map(|x| x * x));
            for (k, got) in Accept::normalize(x).into_iter().enumerate() {
                let forms = [x[k] / square.sqrt(), x[k] * square.inverse_sqrt()];
                assert_is("normalize", &v, got, hull(forms.map(ends)));
                let exact = f64::from(v[k]) / v.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
                assert!(got.contains(F32::below(exact)) && got.contains(F32::above(exact)), "{v:?}: {got:?}");
                assert!(got.width() < 20.0 * F32::EPSILON * exact.abs(), "{v:?}: {got:?}");
            }
        }
        // A range over 0 has a square that is never negative.
        let [x, y] = Accept::normalize([between([-2.0, 1.0]), exactly(1.0)]);
        let slack = 20.0 * F32::EPSILON;
        assert!(x.contains(-2.0) && x.low() > -2.0 - slack && x.contains(1.0) && x.high() < 1.0 + slack, "{x:?}");
        let least = 5.0_f64.sqrt().recip();
        assert!(y.contains(least) && y.low() > least - slack && y.contains(1.0) && y.high() < 1.0 + slack, "{y:?}");
        // And one that is negative as a whole the square of its opposite.
        let [z] = Accept::normalize([between([-2.0, -1.0])]);
        assert!(z.low() > -2.0 - slack && z.contains(-2.0) && z.contains(-0.5) && z.high() < -0.5 + slack, "{z:?}");
        assert!(Accept::normalize([exactly::<F32>(0.0); 3]).iter().all(Accept::is_any));
    });
}

#[test]
fn a_lobe_is_zero_from_the_horizon_down() {
    let lobe = |cosine: (f64, f64), exponent: (f64, f64)| -> Accept {
        let [cosine, exponent] = [cosine, exponent].map(|(low, high)| Accept::from_bounds(low, high));
        WGSL.scope(|| cosine.lobe(exponent))
    };
    // Name, cosine, exponent, ends.
    type Range = (f64, f64);
    let rows: [(&str, Range, Range, Ends); 9] = [
        ("below the horizon", (-0.5, -0.25), (8.0, 8.0), Some((0.0, 0.0))),
        ("at the horizon", (0.0, 0.0), (8.0, 8.0), Some((0.0, 0.0))),
        ("up to the horizon", (-0.5, 0.0), (8.0, 8.0), Some((0.0, 0.0))),
        ("exponent 0 below the horizon is open", (-0.5, -0.25), (0.0, 0.0), Some((0.0, 1.0))),
        ("an exponent that may be 0", (-0.5, -0.25), (0.0, 2.0), Some((0.0, 1.0))),
        ("a negative exponent", (0.5, 0.5), (-1.0, -1.0), None),
        ("an exponent that may be negative", (-0.5, -0.5), (-1.0, 1.0), None),
        ("any cosine", (f64::NEG_INFINITY, f64::INFINITY), (8.0, 8.0), None),
        ("any exponent", (-0.5, -0.5), (f64::NEG_INFINITY, f64::INFINITY), None),
    ];
    for (name, cosine, exponent, expected) in rows {
        assert_is(name, &(cosine, exponent), lobe(cosine, exponent), expected);
    }
    let power = |x: (f64, f64), y: (f64, f64)| {
        WGSL.scope(|| Accept::<F32>::from_bounds(x.0, x.1).pow(Accept::from_bounds(y.0, y.1)))
    };
    assert_eq!(lobe((0.5, 0.75), (3.0, 3.0)), power((0.5, 0.75), (3.0, 3.0)), "above the horizon");
    // Across it, from 0 to what the greatest cosine may give, and 1 too where the exponent may be 0.
    let across = lobe((-0.5, 0.75), (3.0, 3.0));
    assert_eq!(across.high().to_bits(), power((0.75, 0.75), (3.0, 3.0)).high().to_bits());
    assert!((-1e-41..=0.0).contains(&across.low()), "{across:?}");
    assert_eq!(lobe((0.0, 0.75), (3.0, 3.0)), across, "from the horizon");
    let open = lobe((-0.5, 0.75), (0.0, 3.0));
    assert!((-1e-41..=0.0).contains(&open.low()) && open.contains(1.0) && open.high() < 1.001, "{open:?}");
    assert!(lobe((-0.5, 100.0), (30.0, 30.0)).is_any(), "an overflow above the horizon");
    // Where powers vanish, those of lesser cosines err by more: exp2 errs by ULP in proportion to its argument.
    let vanishing = lobe((-1e-8, 1e-7), (200.0, 200.0));
    for cosine in [1e-7_f64, 1e-12, 1e-30, 2e-38] {
        let one = power((cosine, cosine), (200.0, 200.0));
        assert!(vanishing.low() <= one.low() && one.high() <= vanishing.high(), "{cosine}: {one:?} in {vanishing:?}");
    }
}

#[test]
fn hardware_sums_err_relative_to_their_terms() {
    type Unit = Hardware<F32>;
    let mut draws = Draws(8);
    for profile in [&WGSL, &OPENGL] {
        for _ in 0..2_000 {
            let ranges: [[f32; 2]; 3] = std::array::from_fn(|_| draws.range(-8, 8));
            let intervals = ranges.map(|[low, high]| Accept::<Unit>::from_bounds(low.into(), high.into()));
            let total = |f: &dyn Fn([f64; 2]) -> f64, n: usize| -> f64 {
                ranges[..n].iter().map(|range| f(range.map(f64::from))).sum()
            };
            let [a, b, c] = intervals;
            for (n, got) in profile.scope(|| [(2, Accept::sum([a, b])), (3, Accept::sum([a, b, c]))]) {
                let (low, high) = (total(&|x| x[0], n), total(&|x| x[1], n));
                let (below, above) = (total(&|x| x[0].abs(), n), total(&|x| x[1].abs(), n));
                let factor = growth(i32::try_from(n).expect("few"), profile.relative.max(F32::EPSILON));
                let ends = [-1.0, 1.0].map(|sign| {
                    let factor = factor + sign * power_of_two(-44);
                    Some((F32::below(low - factor * below), F32::above(high + factor * above)))
                });
                assert_between("sum", &ranges, got, ends);
            }
        }
    }
    let [zero, x] = [0.0, 0.3].map(exactly::<Unit>);
    WGSL.scope(|| {
        assert_is("no term", &0, Accept::<Unit>::sum([]), Some((0.0, 0.0)));
        assert_is("zeros", &0, Accept::sum([zero, zero]), Some((0.0, 0.0)));
        assert_is("one term and a zero", &0, Accept::sum([zero, x]), ends(x));
        assert_eq!(Accept::sum([x, zero, x]), Accept::sum([x, x]), "a zero among terms");
    });
}

#[test]
fn partial_sums_of_hardware_may_be_flushed() {
    type Unit = Hardware<F16>;
    let threshold = F16::MIN_NORMAL / F16::EPSILON * 16.0;
    for (name, scale, flushes) in [("at the threshold", 1.0, 0.0), ("below it", 0.5, 2.0)] {
        let half = threshold * scale / 2.0;
        let got = WGSL.scope(|| Accept::<Unit>::sum([Accept::exactly(half), Accept::exactly(-half)]));
        let error = F16::EPSILON * threshold * scale + flushes * F16::MIN_NORMAL;
        let expected = outward::<F16>((0.0, 0.0), error, threshold);
        assert_between(name, &half, got, expected.map(|ends| ends.map(flushed::<F16>)));
    }
}

type Formula<R> = fn([R; 4]) -> R;

fn formulas<R: Real>() -> [(&'static str, Formula<R>); 16] {
    [
        ("a + b", |[a, b, ..]| a + b),
        ("a − b", |[a, b, ..]| a - b),
        ("a·b", |[a, b, ..]| a * b),
        ("a·b + c·d", |[a, b, c, d]| a * b + c * d),
        ("a/b", |[a, b, ..]| a / b),
        ("Σ", |x| R::sum(x)),
        ("Σ of products", |[a, b, c, d]| R::sum([a * b, c * d, a * d])),
        ("Π", |x| R::product(x)),
        ("mix", |[a, b, c, _]| R::mix(a, b, c)),
        ("normalize", |[a, b, c, _]| R::normalize([a, b, c])[1]),
        ("quadratic", |[a, b, c, d]| R::quadratic([a, b, c], d)),
        ("a·b − c·d", |[a, b, c, d]| R::difference_of_products([a, b], [c, d])),
        ("exp(−|a|)", |[a, ..]| (-a.abs()).exp()),
        ("pow(|a|, b)", |[a, b, ..]| a.abs().pow(b)),
        ("ln(1 + |a|)", |[a, ..]| a.abs().ln_1p()),
        ("exp(a) − 1", |[a, ..]| a.exp_m1()),
    ]
}

#[test]
fn every_legal_evaluation_lies_inside() {
    let mut draws = Draws(9);
    random::seed(9);
    let all = [&WGSL, &OPENGL];
    for ((name, interval), (_, drawn)) in formulas::<Accept>().into_iter().zip(formulas::<RandomLegal>()) {
        for profile in all {
            for (least, most) in [(-4, 1), (-126, -118)] {
                for _ in 0..60 {
                    let inputs: [f32; 4] = std::array::from_fn(|_| draws.number(least, most));
                    check(profile, name, inputs, interval, drawn);
                }
            }
        }
    }
}

fn check(profile: &Profile, name: &str, inputs: [f32; 4], interval: Formula<Accept>, drawn: Formula<RandomLegal>) {
    profile.scope(|| {
        let legal = interval(inputs.map(Real::input));
        for _ in 0..8 {
            let value = drawn(inputs.map(Real::input)).value;
            assert!(legal.contains(value), "{name} of {inputs:?} by {}: {value:e} outside of {legal:?}", profile.name);
        }
    });
}

#[test]
fn partial_products_at_the_smallest_normal_are_not_flushed() {
    WGSL.scope(|| {
        let width = |smallest: f64| {
            let product = <Accept>::product([1.25, 1.75, 1.5, smallest].map(Accept::exactly));
            (product.high() - product.low()) / F32::MIN_NORMAL
        };
        assert!(width(F32::MIN_NORMAL) < 1e-5, "{}", width(F32::MIN_NORMAL));
        assert!(width(F32::MIN_NORMAL / 2.0) > 1.0, "{}", width(F32::MIN_NORMAL / 2.0));
    });
}
