//! Derivatives against central differences and known values.

#![expect(clippy::float_cmp, reason = "slopes that are exact are compared exactly")]

use crate::Dual;
use crate::dual::condition;
use lightmeter_reference::Real;

type Function = (&'static str, fn(Dual, Dual) -> Dual);

const FUNCTIONS: [Function; 16] = [
    ("a + b", |a, b| a + b),
    ("a − b", |a, b| a - b),
    ("a·b", |a, b| a * b),
    ("a/b", |a, b| a / b),
    ("−a", |a, _| -a),
    ("max", Real::max),
    ("min", Real::min),
    ("|a − b|", |a, b| (a - b).abs()),
    ("√a", |a, _| a.sqrt()),
    ("1/√a", |a, _| a.inverse_sqrt()),
    ("eᵃ", |a, _| a.exp()),
    ("2ᵃ", |a, _| a.exp2()),
    ("log₂ a", |a, _| a.log2()),
    ("aᵇ", Real::pow),
    ("ln(1 + a)", |a, _| a.ln_1p()),
    ("eᵃ − 1", |a, _| a.exp_m1()),
];

/// The same functions in plain f64, by the standard library.
fn plain(name: &str, a: f64, b: f64) -> f64 {
    match name {
        "a + b" => a + b,
        "a − b" => a - b,
        "a·b" => a * b,
        "a/b" => a / b,
        "−a" => -a,
        "max" => f64::max(a, b),
        "min" => f64::min(a, b),
        "|a − b|" => (a - b).abs(),
        "√a" => a.sqrt(),
        "1/√a" => a.sqrt().recip(),
        "eᵃ" => a.exp(),
        "2ᵃ" => a.exp2(),
        "log₂ a" => a.log2(),
        "aᵇ" => a.powf(b),
        "ln(1 + a)" => a.ln_1p(),
        "eᵃ − 1" => a.exp_m1(),
        _ => unreachable!("each function has a plain form"),
    }
}

fn assert_close(what: &str, got: f64, expected: f64, relative: f64) {
    assert!((got - expected).abs() <= relative * expected.abs().max(1e-3), "{what}: {got}, expected {expected}");
}

#[test]
fn slopes_are_those_of_central_differences() {
    const STEP: f64 = 1e-5;
    for (name, f) in FUNCTIONS {
        for (a, b) in [(0.3, 1.7), (2.5, 0.75), (1.25, 3.0), (4.0, 2.0), (0.0625, 0.5)] {
            let difference = |da: f64, db: f64| {
                let at = |t: f64| plain(name, a + t * da * STEP, b + t * db * STEP);
                (at(1.0) - at(-1.0)) / (2.0 * STEP)
            };
            let by_a = f(Dual::variable(a), Dual::constant(b));
            let by_b = f(Dual::constant(a), Dual::variable(b));
            let by_both = f(Dual::variable(a), Dual::variable(b));
            assert_close(&format!("{name} at {a}, {b}"), by_a.value, plain(name, a, b), 1e-14);
            assert_close(&format!("{name} by a at {a}, {b}"), by_a.slope, difference(1.0, 0.0), 1e-6);
            assert_close(&format!("{name} by b at {a}, {b}"), by_b.slope, difference(0.0, 1.0), 1e-6);
            assert_close(&format!("{name} by both at {a}, {b}"), by_both.slope, difference(1.0, 1.0), 1e-6);
        }
    }
}

#[test]
fn inputs_and_literals_are_constants() {
    assert_eq!(<Dual as Real>::input(0.1), Dual::constant(f64::from(0.1_f32)));
    assert_eq!(<Dual as Real>::literal(0.1), Dual { value: 0.1, slope: 0.0 });
    assert_eq!(Dual::variable(0.1), Dual { value: 0.1, slope: 1.0 });
}

#[test]
fn sides_are_taken_by_value() {
    let (a, b) = (Dual { value: 1.0, slope: 5.0 }, Dual { value: 2.0, slope: 7.0 });
    let twin = Dual { value: 1.0, slope: -5.0 };
    let zero = Dual { value: 0.0, slope: 3.0 };
    let side = |x: Dual, y: Dual| Dual::if_ge(x, y, || a, || b);
    // Name, result, expected.
    let rows = [
        ("max of unequal", a.max(b), b),
        ("max of unequal, turned", b.max(a), b),
        ("max of equal is the first", a.max(twin), a),
        ("min of unequal", a.min(b), a),
        ("min of unequal, turned", b.min(a), a),
        ("min of equal is the first", a.min(twin), a),
        ("|x| of a positive number", a.abs(), a),
        ("|x| of a negative number", (-a).abs(), a),
        ("|x| at 0 keeps the slope", zero.abs(), zero),
        ("a ≥ b is false", side(a, b), b),
        ("b ≥ a", side(b, a), a),
        ("equal is ≥", side(a, twin), a),
        ("a rounded number is flat", Dual { value: 2.5, slope: 9.0 }.round(), Dual::constant(2.0)),
        ("up from above a half", Dual { value: 2.75, slope: 9.0 }.round(), Dual::constant(3.0)),
        ("a floor is handed on", Dual { value: -0.5, slope: 9.0 }.floor_then(Dual::constant), Dual::constant(-1.0)),
    ];
    for (name, got, expected) in rows {
        assert_eq!(got, expected, "{name}");
    }
}

#[test]
fn a_constant_stays_one_where_the_derivative_is_infinite() {
    // Name, result.
    let zero = Dual::constant(0.0);
    let rows = [
        ("√0", zero.sqrt()),
        ("log₂ 0", zero.log2()),
        ("0^½", zero.pow(Dual::constant(0.5))),
        ("0²", zero.pow(Dual::constant(2.0))),
    ];
    for (name, got) in rows {
        assert_eq!(got.slope, 0.0, "{name}");
    }
    assert_eq!(Dual::variable(0.0).sqrt().slope, f64::INFINITY, "√ of a variable 0");
}

#[test]
fn the_condition_sums_what_each_input_amplifies() {
    let by = |slopes: [f64; 2], value: f64| -> Vec<Vec<Dual>> {
        slopes.map(|slope| vec![Dual::constant(9.0), Dual { value, slope }]).to_vec()
    };
    // Name, inputs, slopes, the output's value, the condition.
    let rows = [
        ("(|2·3| + |−4·0.5|) / 16", [2.0, -4.0], [3.0, 0.5], 16.0, 0.5),
        ("the signs of slopes and of the value do not matter", [2.0, -4.0], [-3.0, 0.5], -16.0, 0.5),
        ("an input of 0 with an infinite slope counts nothing", [0.0, 4.0], [f64::INFINITY, 2.0], 4.0, 2.0),
        ("a slope of 0 at an infinite input counts nothing", [f32::INFINITY, 4.0], [0.0, 2.0], 4.0, 2.0),
        ("a constant output is 0, even where it is 0", [2.0, 4.0], [0.0, 0.0], 0.0, 0.0),
        ("a cancelled output is infinite", [2.0, 4.0], [1.0, 1.0], 0.0, f64::INFINITY),
    ];
    for (name, inputs, slopes, value, expected) in rows {
        assert_eq!(condition(&inputs, &by(slopes, value), 1), expected, "{name}");
    }
    assert_eq!(condition(&[], &[], 0), 0.0, "without an input");
}
