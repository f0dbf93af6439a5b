//! Fixed-point intervals against units of 8 bits that are computed in integers, for every operand.

#![expect(clippy::float_cmp, reason = "the units' errors are compared to the last bit")]

use crate::Fixed;
use crate::fixed::{Narrow, STEP, Unit, Wide};
use lightmeter_reference::Real;

fn ends<U: Unit>(x: Fixed<U>) -> (f64, f64) {
    (x.low(), x.high())
}

fn narrow(low: f64, high: f64) -> Fixed<Narrow> {
    Fixed::between(low, high)
}

/// Slack for the rounding of f64 itself, far below a step.
const SLACK: f64 = 1e-15;

fn assert_close(name: &str, got: (f64, f64), expected: (f64, f64)) {
    let is_close = |a: f64, b: f64| (a - b).abs() <= SLACK;
    assert!(is_close(got.0, expected.0) && is_close(got.1, expected.1), "{name}: {got:?}, expected {expected:?}");
}

#[test]
fn units_err_by_steps_of_their_formats() {
    assert_eq!([Narrow::OPERAND, Narrow::SUM, Wide::OPERAND], [1.0 / 510.0, 0.0, 0.0]);
    assert_eq!([Wide::PRODUCT, Wide::SUM], [f64::from(f32::EPSILON), 2.0 * f64::from(f32::EPSILON)]);
    assert_close("a step", (STEP * 255.0, Narrow::PRODUCT * 255.0), (1.0, 0.5 + 1.0 / 510.0));
}

#[test]
fn an_operand_holds_each_neighbour_and_no_farther() {
    for k in 0..=2550_u32 {
        let x = f64::from(k) / 2550.0;
        let operand = Fixed::<Narrow>::operand(x);
        // The nearest of 256 numbers, by integers: k/10 rounded, at a tie both.
        for nearest in [(k + 4) / 10, (k + 5) / 10] {
            let held = f64::from(nearest) * STEP;
            assert!(operand.low() <= held + SLACK && held <= operand.high() + SLACK, "{k}: {operand:?}");
        }
        let expected = if k % 2550 == 0 { (x, x) } else { ((x - 0.5 * STEP).max(0.0), (x + 0.5 * STEP).min(1.0)) };
        assert_close("an operand", ends(operand), expected);
        assert_eq!(ends(Fixed::<Wide>::operand(x)), (x, x), "a wide unit takes {x} as it is");
    }
}

#[test]
fn a_product_holds_what_shifts_and_what_rounding_make_of_it() {
    for (a, b) in (0..=255_u32).flat_map(|a| (0..=255_u32).map(move |b| (a, b))) {
        let [x, y] = [a, b].map(|k| f64::from(k) * STEP);
        let product = narrow(x, x) * narrow(y, y);
        let by_shifts = (a * b + ((a * b) >> 8) + 128) >> 8;
        let by_rounding = (2 * a * b + 255) / 510;
        for held in [by_shifts, by_rounding].map(|k| f64::from(k) * STEP) {
            assert!(product.low() <= held + SLACK && held <= product.high() + SLACK, "{a}·{b}: {product:?}");
        }
        let is_exact = [a, b].iter().any(|k| [0, 255].contains(k));
        let error = if is_exact { 0.0 } else { 0.5 + 1.0 / 510.0 };
        assert_close("a product", ends(product), (x * y - error * STEP, x * y + error * STEP));
    }
}

#[test]
fn products_of_ranges_reach_the_corners() {
    // Name, a, b, the exact range.
    let rows = [
        ("both positive", (0.2, 0.4), (0.3, 0.5), (0.06, 0.2)),
        ("both negative", (-0.4, -0.2), (-0.5, -0.3), (0.06, 0.2)),
        ("opposite", (-0.4, -0.2), (0.3, 0.5), (-0.2, -0.06)),
        ("opposite, turned", (0.3, 0.5), (-0.4, -0.2), (-0.2, -0.06)),
        ("one over zero", (-0.4, 0.2), (0.3, 0.5), (-0.2, 0.1)),
        ("one over zero and a negative", (-0.2, 0.4), (-0.5, 0.3), (-0.2, 0.12)),
    ];
    for (name, (a, b), (c, d), (low, high)) in rows {
        let got = narrow(a, b) * narrow(c, d);
        assert_close(name, ends(got), (low - Narrow::PRODUCT, high + Narrow::PRODUCT));
        let got = Fixed::<Wide>::between(a, b) * Fixed::between(c, d);
        assert_close(name, ends(got), (low - Wide::PRODUCT, high + Wide::PRODUCT));
    }
}

#[test]
fn factors_of_0_and_1_are_exact() {
    let x = Fixed::<Wide>::between(0.25, 0.75);
    let [zero, one] = [0.0, 1.0].map(|k| Fixed::between(k, k));
    // Name, result, expected.
    let rows = [
        ("1·x", one * x, x),
        ("x·1", x * one, x),
        ("0·x", zero * x, zero),
        ("x·0", x * zero, zero),
        ("x + 0", x + zero, x),
        ("0 + x", zero + x, x),
        ("x − 0", x - zero, x),
    ];
    for (name, got, expected) in rows {
        assert_eq!(got, expected, "{name}");
    }
    // What reaches 0 or 1 with one end alone is not exact.
    for (name, other) in
        [("from 0", (0.0, 0.5)), ("up to 1", (0.5, 1.0)), ("to 0", (-0.5, 0.0)), ("from 1", (1.0, 2.0))]
    {
        let other = Fixed::between(other.0, other.1);
        let product = other * x;
        assert!(product.high() > other.high().max(0.0) * 0.75, "{name}: {product:?}");
        assert!((other + x).high() > other.high() + 0.75, "{name}");
    }
}

#[test]
fn sums_err_in_a_wide_unit_alone() {
    let [a, b] = [(0.25, 0.5), (0.125, 0.75)];
    let wide = Fixed::<Wide>::between(a.0, a.1) + Fixed::between(b.0, b.1);
    assert_close("wide", ends(wide), (0.375 - Wide::SUM, 1.25 + Wide::SUM));
    let difference = Fixed::<Wide>::between(a.0, a.1) - Fixed::between(b.0, b.1);
    assert_close("wide difference", ends(difference), (-0.5 - Wide::SUM, 0.375 + Wide::SUM));
    assert_eq!(ends(narrow(a.0, a.1) + narrow(b.0, b.1)), (0.375, 1.25));
    assert_eq!(ends(narrow(a.0, a.1) - narrow(b.0, b.1)), (-0.5, 0.375));
    assert_eq!(ends(-narrow(a.0, a.1)), (-0.5, -0.25));
    // A sum that is exactly 1 is one of the unit's numbers.
    let half = Fixed::<Wide>::between(0.5, 0.5);
    assert_eq!(ends(half + half), (1.0, 1.0));
}

#[test]
fn exact_operations_move_the_ends() {
    let x = narrow(-0.25, 0.75);
    // Name, result, expected.
    let rows = [
        ("max", x.max(narrow(0.0, 0.5)), (0.0, 0.75)),
        ("min", x.min(narrow(0.0, 0.5)), (-0.25, 0.5)),
        ("|x| of a negative range", narrow(-0.75, -0.25).abs(), (0.25, 0.75)),
        ("|x| of a positive range", narrow(0.25, 0.75).abs(), (0.25, 0.75)),
        ("either neighbour is stored", narrow(1.25, 2.5).round(), (1.0, 3.0)),
        ("a whole number is stored as it is", narrow(2.0, 2.0).round(), (2.0, 2.0)),
        ("the part in [0, 1]", narrow(-0.5, 1.5).within_unit(), (0.0, 1.0)),
        ("a part below", narrow(-0.5, 0.5).within_unit(), (0.0, 0.5)),
        ("a literal is exact", <Fixed<Narrow> as Real>::literal(0.3), (0.3, 0.3)),
        ("an operand between two", Fixed::operand_between(0.25, 0.5), (0.25 - Narrow::OPERAND, 0.5 + Narrow::OPERAND)),
        ("an input is an operand", <Fixed<Narrow> as Real>::input(0.5), (0.5 - Narrow::OPERAND, 0.5 + Narrow::OPERAND)),
    ];
    for (name, got, expected) in rows {
        assert_eq!(ends(got), expected, "{name}");
    }
}

#[test]
fn what_blending_does_not_use_may_be_anything() {
    let x = narrow(0.25, 0.75);
    let rows = [
        ("/", x / x),
        ("√", x.sqrt()),
        ("1/√", x.inverse_sqrt()),
        ("exp", x.exp()),
        ("exp2", x.exp2()),
        ("log2", x.log2()),
        ("pow", x.pow(x)),
        ("floor", x.floor_then(|k| narrow(k, k))),
    ];
    for (name, got) in rows {
        assert_eq!(ends(got), (f64::NEG_INFINITY, f64::INFINITY), "{name}");
    }
}

#[test]
fn an_undecided_condition_gives_the_hull() {
    let if_ge = |a: (f64, f64), b: (f64, f64)| {
        ends(Fixed::if_ge(narrow(a.0, a.1), narrow(b.0, b.1), || narrow(1.0, 2.0), || narrow(-4.0, -3.0)))
    };
    let (then, otherwise, hull) = ((1.0, 2.0), (-4.0, -3.0), (-4.0, 2.0));
    // Name, a, b, expected.
    let rows = [
        ("above", (0.5, 0.6), (0.1, 0.4), then),
        ("touching from above is ≥", (0.5, 0.6), (0.1, 0.5), then),
        ("below", (0.1, 0.4), (0.5, 0.6), otherwise),
        ("touching from below is undecided", (0.1, 0.5), (0.5, 0.6), hull),
        ("overlapping", (0.1, 0.55), (0.5, 0.6), hull),
        ("equal numbers are ≥", (0.5, 0.5), (0.5, 0.5), then),
    ];
    for (name, a, b, expected) in rows {
        assert_eq!(if_ge(a, b), expected, "{name}");
    }
}
