//! Rounding to a format and distances in it, against the formats' own tables of values.

#![expect(clippy::float_cmp, reason = "a format's values are compared to the last bit")]

use super::oracle::{Grid, power_of_two, ulp};
use crate::format::error_ulp;
use crate::{F16, F32, Format, Hardware};

#[test]
fn the_constants_are_those_of_ieee_754() {
    let f32_constants = [F32::EPSILON, F32::MIN_NORMAL, F32::MIN_SUBNORMAL, F32::MAX];
    let of_f32 = [f32::EPSILON, f32::MIN_POSITIVE, f32::from_bits(1), f32::MAX].map(f64::from);
    assert_eq!((f32_constants, F32::FRACTION_BITS), (of_f32, f32::MANTISSA_DIGITS - 1));
    // The greatest is 2¹⁶ less half a unit in the last place.
    let of_f16 = [power_of_two(-10), power_of_two(-14), power_of_two(-24), power_of_two(16) - power_of_two(5)];
    assert_eq!([F16::EPSILON, F16::MIN_NORMAL, F16::MIN_SUBNORMAL, F16::MAX], of_f16);
    assert_eq!((F16::FRACTION_BITS, F16::IS_HARDWARE, F32::IS_HARDWARE), (10, false, false));
    type Unit = Hardware<F16>;
    assert_eq!([Unit::EPSILON, Unit::MIN_NORMAL, Unit::MIN_SUBNORMAL, Unit::MAX], of_f16);
    assert_eq!((Unit::FRACTION_BITS, Unit::IS_HARDWARE), (10, true));
}

/// Each value of binary16 that is normal, and a little on either side of it.
fn around_each_f16() -> impl Iterator<Item = f64> {
    let values = (1..=30).flat_map(|binade| (0..1024).map(move |k| f64::from(1024 + k) * power_of_two(binade - 25)));
    // What lies beyond the greatest or below the least normal number has its own rules.
    let values = values.filter(|x| *x > F16::MIN_NORMAL && *x < F16::MAX);
    values.flat_map(|x| [x, x.next_up(), x.next_down(), x * (1.0 + 0.3 * power_of_two(-11))]).flat_map(|x| [x, -x])
}

#[test]
fn f16_rounds_to_its_neighbours() {
    for x in around_each_f16() {
        assert_eq!((F16::round_down(x), F16::round_up(x)), (F16::below(x), F16::above(x)), "{x:e}");
    }
    assert_eq!((F16::round_down(0.0), F16::round_up(0.0)), (0.0, 0.0));
}

#[test]
fn f32_rounds_to_its_neighbours() {
    let mut draws = super::oracle::Draws(1);
    for _ in 0..20_000 {
        let (a, b) = (f64::from(draws.number(-60, 60)), f64::from(draws.number(-60, 60)));
        for x in [a, a * b, a / b] {
            assert_eq!((F32::round_down(x), F32::round_up(x)), (F32::below(x), F32::above(x)), "{x:e}");
        }
    }
}

#[test]
fn an_ulp_is_the_narrowest_bracket() {
    for x in around_each_f16() {
        assert_eq!(F16::ulp(x), ulp::<F16>(x), "{x:e}");
    }
    for x in super::oracle::boundaries().into_iter().filter(|x| x.abs() < f32::MAX).map(f64::from) {
        for x in [x, x * (1.0 + power_of_two(-30)), x * (1.0 - power_of_two(-30))] {
            assert_eq!(F32::ulp(x), ulp::<F32>(x), "{x:e}");
        }
    }
}

#[test]
fn an_ulp_is_known_at_the_boundaries() {
    // Name, value, ULP.
    let rows = [
        ("just above 1, spacing is 2⁻²³", 1.5, power_of_two(-23)),
        ("at a power of two, the narrower side counts", 1.0, power_of_two(-24)),
        ("below a power of two", 1.0_f64.next_down(), power_of_two(-24)),
        ("the sign does not matter", -1.5, power_of_two(-23)),
        ("at the least normal number both sides are even", F32::MIN_NORMAL, F32::MIN_SUBNORMAL),
        ("at twice that", 2.0 * F32::MIN_NORMAL, F32::MIN_SUBNORMAL),
        ("among subnormals", 0.3 * F32::MIN_NORMAL, F32::MIN_SUBNORMAL),
        ("at 0", 0.0, F32::MIN_SUBNORMAL),
        ("at the greatest", F32::MAX, power_of_two(104)),
    ];
    for (name, x, expected) in rows {
        assert_eq!(F32::ulp(x), expected, "{name}");
    }
}

#[test]
fn errors_are_counted_in_ulp_of_the_reference() {
    let nan = f32::NAN;
    // Name, value, reference, error.
    let rows = [
        ("equal", 1.5, 1.5, 0.0),
        ("one step up", 1.5_f32.next_up(), 1.5, 1.0),
        ("one step down", 1.5_f32.next_down(), 1.5, 1.0),
        ("three steps, of a power of two's narrower side", 1.0 - 3.0 * 2.0_f32.powi(-24), 1.0, 3.0),
        ("half a step", 1.5, 1.5 + power_of_two(-24), 0.5),
        ("opposite signs", -1.5, 1.5, 3.0 * power_of_two(23)),
        ("both NaN", nan, f64::NAN, 0.0),
        ("NaN for a number", nan, 1.0, f64::INFINITY),
        ("a number for NaN", 1.0, f64::NAN, f64::INFINITY),
        ("infinite for a number", f32::INFINITY, 1.0, f64::INFINITY),
        ("a number for infinity", 1.0, f64::INFINITY, f64::INFINITY),
        ("the same infinity", f32::INFINITY, f64::INFINITY, 0.0),
        ("the other infinity", f32::NEG_INFINITY, f64::INFINITY, f64::INFINITY),
    ];
    for (name, value, reference, expected) in rows {
        assert_eq!(error_ulp::<F32>(value, reference), expected, "{name}");
    }
    assert_eq!(error_ulp::<F16>(1.5, 1.5 + power_of_two(-11)), 0.5, "half a step of binary16");
}
