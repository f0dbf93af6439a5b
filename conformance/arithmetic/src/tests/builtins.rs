//! Intervals of built-in functions: the values of the format within the promised error, and no more.

use super::oracle::{Draws, Ends, Grid, assert_between, assert_is, hull, power_of_two, ulp, within};
use crate::profile::{Excess, GrowingUlp, OPENGL, Profile, WGSL};
use crate::{Accept, F16, F32, Format, Hardware};
use lightmeter_reference::Real;

/// A function with its promise by WGSL.
struct Builtin<F> {
    name: &'static str,
    apply: fn(Accept<F>) -> Accept<F>,
    exact: fn(f64) -> f64,
    /// The absolute error at an argument, from the ULP of the result.
    error: fn(f64, f64) -> f64,
    /// Exponents of the arguments that are tried.
    exponents: (i32, i32),
    takes_negative: bool,
}

const fn builtins<F: Grid>() -> [Builtin<F>; 4] {
    [
        Builtin {
            name: "inverseSqrt",
            apply: Real::inverse_sqrt,
            exact: |x| 1.0 / x.sqrt(),
            error: |_, ulp| 2.0 * ulp,
            exponents: (-14, 14),
            takes_negative: false,
        },
        Builtin {
            name: "exp",
            apply: Real::exp,
            exact: f64::exp,
            error: |x, ulp| (3.0 + 2.0 * x.abs()) * ulp,
            exponents: (-12, 2),
            takes_negative: true,
        },
        Builtin {
            name: "exp2",
            apply: Real::exp2,
            exact: f64::exp2,
            error: |x, ulp| (3.0 + 2.0 * x.abs()) * ulp,
            exponents: (-12, 2),
            takes_negative: true,
        },
        Builtin {
            name: "log2",
            apply: Real::log2,
            exact: f64::log2,
            error: |x, ulp| if (0.5..=2.0).contains(&x) { power_of_two(-21) } else { 3.0 * ulp },
            exponents: (-14, 14),
            takes_negative: false,
        },
    ]
}

impl<F: Grid> Builtin<F> {
    /// What is legal at one argument, and what the slack of f64 may add.
    fn at(&self, x: f64) -> [Ends; 2] {
        let y = (self.exact)(x);
        let sharp = (self.error)(x, ulp::<F>(y));
        // At a result that is a power of two f64 cannot tell on which side of it the exact one lies.
        let loose = (self.error)(x, ulp::<F>(y).max(ulp::<F>(y.next_up()))) + y.abs() * power_of_two(-47);
        [sharp, loose].map(|error| within::<F>(y - error, y + error))
    }

    /// The same of a range, where an ULP is at most ε of the value.
    fn over(&self, [low, high]: [f64; 2]) -> [Ends; 2] {
        let error = |y: f64| {
            let promise = |x: f64| (self.error)(x, y.abs() * F::EPSILON);
            let corner = [low, high, low.max(0.5).min(high), low.max(2.0).min(high)];
            corner.into_iter().map(promise).fold(0.0, f64::max)
        };
        let [a, b] = [low, high].map(|x| (self.exact)(x));
        let (a, b) = if a < b { (a, b) } else { (b, a) };
        [-1.0, 1.0].map(|sign| {
            let slack = |y: f64| sign * y.abs() * power_of_two(-47);
            within::<F>(a - error(a) - slack(a), b + error(b) + slack(b))
        })
    }

    fn argument(&self, draws: &mut Draws) -> f64 {
        let x = F::below(draws.number(self.exponents.0, self.exponents.1).into());
        if self.takes_negative { x } else { x.abs() }
    }

    fn check(&self, draws: &mut Draws, rows: usize) {
        let mut decided = 0;
        for _ in 0..rows {
            let x = self.argument(draws);
            let expected = self.at(x);
            assert_between(self.name, &x, (self.apply)(Accept::exactly(x)), expected);
            decided += usize::from(expected[0] == expected[1]);
            let y = self.argument(draws);
            let range = [x.min(y), x.max(y)];
            let got = (self.apply)(Accept::from_bounds(range[0], range[1]));
            if range[0] < range[1] {
                assert_between(self.name, &range, got, self.over(range));
                let inside = F::below(f64::midpoint(x, y));
                assert_between(self.name, &range, got, [hull([x, y, inside].map(|x| self.at(x)[0])), None]);
            }
        }
        assert!(decided * 100 > rows * 95, "{}: the rule decides only {decided} of {rows} rows", self.name);
    }
}

#[test]
fn binary32_reaches_the_promised_errors() {
    let mut draws = Draws(1);
    WGSL.scope(|| builtins::<F32>().iter().for_each(|builtin| builtin.check(&mut draws, 4_000)));
}

#[test]
fn binary16_reaches_the_promised_errors() {
    let mut draws = Draws(2);
    // An absolute error of 2⁻²¹ leaves log2 of binary16 no neighbours, so it is tried for binary32 alone.
    WGSL.scope(|| builtins::<F16>()[..3].iter().for_each(|builtin| builtin.check(&mut draws, 2_000)));
}

#[test]
fn arguments_at_the_boundaries() {
    WGSL.scope(|| {
        let [inverse_sqrt, exp, exp2, log2] = builtins::<F32>();
        let rows: [(&Builtin<F32>, &[f64]); 4] = [
            (&inverse_sqrt, &[F32::MIN_NORMAL, 0.25, 0.5, 1.0, 4.0, 16.0, F32::MAX]),
            (&exp, &[0.0, 1.0, -1.0, 88.0, -80.0, power_of_two(-70), -power_of_two(-70)]),
            (&exp2, &[0.0, 1.0, -1.0, 0.5, 127.0, -120.0, 127.99, power_of_two(-70), -power_of_two(-70)]),
            (&log2, &[F32::MIN_NORMAL, 0.25, 0.5, 1.0, 1.5, 2.0, 4.0, 3.0, F32::MAX]),
        ];
        for (builtin, arguments) in rows {
            for x in arguments.iter().map(|&x| F32::below(x)) {
                assert_between(builtin.name, &x, (builtin.apply)(Accept::exactly(x)), builtin.at(x));
            }
        }
        for x in [0.5_f64.next_down(), 2.0_f64.next_up()].map(|x| if x < 1.0 { F32::below(x) } else { F32::above(x) }) {
            assert_between("log2 outside of [0.5, 2]", &x, Accept::<F32>::exactly(x).log2(), log2.at(x));
        }
    });
}

#[test]
fn arguments_outside_of_the_domain_may_give_anything() {
    WGSL.scope(|| {
        for x in [0.0, -1.0, -F32::MAX] {
            let [point, up_to_one]: [Accept; 2] = [Accept::exactly(x), Accept::from_bounds(x, 1.0)];
            for interval in [point, up_to_one] {
                assert_is("inverseSqrt", &x, interval.inverse_sqrt(), None);
                assert_is("sqrt", &x, interval.sqrt(), None);
                assert_is("log2", &x, interval.log2(), None);
                assert_is("pow", &x, interval.pow(Accept::exactly(2.0)), None);
            }
        }
        let exactly = Accept::<F32>::exactly;
        assert_is("exp2 that overflows", &128, exactly(128.0).exp2(), None);
        assert_is("exp that overflows", &89, exactly(89.0).exp(), None);
        for x in [-1.0, -1.5, -2.0] {
            assert_is("ln(1 + x)", &x, exactly(x).ln_1p(), None);
            assert_is("ln(1 + x)", &x, Accept::<F32>::from_bounds(x, 1.0).ln_1p(), None);
        }
    });
}

#[test]
fn a_value_exactly_at_its_bound_is_legal() {
    let step = power_of_two(-21);
    let log2 = |low: f64, high: f64| WGSL.scope(|| Accept::<F32>::from_bounds(low, high).log2());
    // Name, range, ends.
    let rows = [
        ("log2 of ½", (0.5, 0.5), (-1.0 - step, -1.0 + step)),
        ("log2 of 1", (1.0, 1.0), (-step, step)),
        ("log2 of 2", (2.0, 2.0), (1.0 - step, 1.0 + step)),
        ("log2 from ½ to 2", (0.5, 2.0), (-1.0 - step, 1.0 + step)),
    ];
    for (name, (low, high), expected) in rows {
        assert_is(name, &(low, high), log2(low, high), Some(expected));
    }
}

#[test]
fn hardware_has_no_infinite_end_where_the_domain_ends() {
    // What is too great for hardware is infinite, yet a function at the end of its domain may give anything.
    type Unit = Accept<Hardware<F32>>;
    WGSL.scope(|| {
        assert_is("inverseSqrt", &"[0, 1]", Unit::from_bounds(0.0, 1.0).inverse_sqrt(), None);
        assert_is("log2", &"[0, 1]", Unit::from_bounds(0.0, 1.0).log2(), None);
        assert_is("ln(1 + x)", &"[−1, 1]", Unit::from_bounds(-1.0, 1.0).ln_1p(), None);
        let overflow = Unit::from_bounds(0.0, 200.0).exp2();
        assert!(!overflow.is_any() && overflow.high() > F32::MAX && overflow.low() > 0.0, "{overflow:?}");
    });
}

#[test]
fn an_exponential_that_underflows_may_be_flushed() {
    WGSL.scope(|| {
        for x in [-126.5, -130.0, -149.0] {
            let got = Accept::<F32>::exactly(x).exp2();
            let exact = x.exp2();
            let error = (3.0 + 2.0 * x.abs()) * F32::MIN_SUBNORMAL;
            let required = within::<F32>(exact - error, exact + error);
            let loose = error + F32::MIN_SUBNORMAL;
            assert_between("exp2", &x, got, [required, within::<F32>(exact - loose, exact + loose)]);
            assert!(got.contains(0.0), "exp2({x}): {got:?}");
        }
    });
}

#[test]
fn a_deviation_widens_exponentials_on_its_range_alone() {
    let excess = Some(Excess { from: -1.0, to: -0.25, factor: 3.0 });
    let [exp, exp2] = [Profile { exp_excess: excess, ..WGSL }, Profile { exp2_excess: excess, ..WGSL }];
    // Name, argument, how many times the promise is legal.
    let rows = [
        ("the least argument", -1.0, 3.0),
        ("just below it", F32::below((-1.0_f64).next_down()), 1.0),
        ("inside", -0.6, 3.0),
        ("the greatest argument", -0.25, 3.0),
        ("just above it", F32::above((-0.25_f64).next_up()), 1.0),
        ("far below", -3.0, 1.0),
        ("far above", 3.0, 1.0),
    ];
    for (name, x, factor) in rows {
        let x = F32::below(x);
        let legal = |profile: &Profile, f: fn(Accept) -> Accept| profile.scope(|| f(Accept::exactly(x)));
        let expected = |y: f64, factor: f64| {
            let error = factor * (3.0 + 2.0 * x.abs()) * ulp::<F32>(y);
            let loose = factor * (3.0 + 2.0 * x.abs()) * ulp::<F32>(y.next_up()) + y * power_of_two(-47);
            [error, loose].map(|error| within::<F32>(y - error, y + error))
        };
        assert_between(name, &("exp", x), legal(&exp, Real::exp), expected(x.exp(), factor));
        assert_between(name, &("exp2", x), legal(&exp2, Real::exp2), expected(x.exp2(), factor));
        assert_between(name, &("exp by exp2's", x), legal(&exp2, Real::exp), expected(x.exp(), 1.0));
        assert_between(name, &("exp2 by exp's", x), legal(&exp, Real::exp2), expected(x.exp2(), 1.0));
    }
}

#[test]
fn a_root_is_the_inverse_of_every_inverse_root() {
    let mut draws = Draws(3);
    WGSL.scope(|| {
        for _ in 0..4_000 {
            let x = f64::from(draws.number(-30, 30).abs());
            let inverse = builtins::<F32>()[0].at(x)[0].expect("a finite inverse root");
            let quotient = |r: f64, ulp: fn(f64) -> f64, sign: f64| {
                let error = 2.5 * ulp(1.0 / r);
                1.0 / r + sign * error
            };
            let legal = within::<F32>(quotient(inverse.1, ulp::<F32>, -1.0), quotient(inverse.0, ulp::<F32>, 1.0));
            let whole = |y: f64| y * F32::EPSILON * (1.0 + power_of_two(-20));
            let loose = within::<F32>(quotient(inverse.1, whole, -1.0), quotient(inverse.0, whole, 1.0));
            let got = Accept::<F32>::exactly(x).sqrt();
            assert!(got.contains(x.sqrt()), "√{x}: {got:?}");
            // Where an inverse root lies at a power of two, the slack of f64 may add a neighbour.
            let loose = loose.map(|(low, high)| (F32::below(low.next_down()), F32::above(high.next_up())));
            assert_between("sqrt", &x, got, [legal, loose]);
        }
    });
}

#[test]
fn a_power_is_exp2_of_the_exponent_times_log2() {
    let mut draws = Draws(4);
    WGSL.scope(|| {
        for _ in 0..4_000 {
            let (x, y) = (f64::from(draws.number(-3, 2).abs()), f64::from(draws.number(-2, 3)));
            let [_, _, exp2, log2] = builtins::<F32>();
            let (low, high) = log2.at(x)[0].expect("a finite logarithm");
            // The product is monotone in the logarithm, and so is the power.
            let ends = [low * y, high * y].map(|product| [F32::below(product), F32::above(product)]);
            let legal = hull(ends.into_iter().flatten().map(|product| exp2.at(product)[0]));
            let got = Accept::<F32>::exactly(x).pow(Accept::exactly(y));
            assert_between("pow", &(x, y), got, [legal, None]);
            let (low, high) = legal.expect("a finite power");
            let spare = 8.0 * (3.0 + 2.0 * (y * x.log2()).abs()) * F32::EPSILON * high;
            assert!(got.width() <= high - low + spare, "pow of {x}, {y}: {got:?}, legal {legal:?}");
            assert!(got.contains(x.powf(y)), "pow of {x}, {y}: {got:?}");
        }
    });
}

/// The values within an error of ln(1 + x) or exp(x) − 1, and those that the slack of f64 may add.
fn documented(y: f64, error: f64) -> [Ends; 2] {
    [-1.0, 1.0].map(|sign| {
        let error = error * (1.0 + sign * power_of_two(-20));
        within::<F32>(y - error, y + error)
    })
}

#[test]
fn ln_1p_is_a_series_near_0_and_a_logarithm_beyond() {
    let epsilon = F32::EPSILON;
    for profile in [&WGSL, &OPENGL] {
        let step = profile.relative.max(epsilon);
        let series = |y: f64| (16.0 * 1.07 * step + epsilon / 8.0) * y.abs();
        let log = |y: f64| profile.log2_absolute + 1.02 * step + profile.log2_ulp * epsilon * y.abs();
        // Name, range, the error at the low and at the high end.
        type Error<'a> = &'a dyn Fn(f64) -> f64;
        let greater = |y: f64| series(y).max(log(y));
        let rows: [(&str, (f64, f64), Error); 10] = [
            ("near 0", (0.001, 0.001), &series),
            ("near 0, negative", (-0.03, -0.03), &series),
            ("at the end of the series", (0.0625, 0.0625), &series),
            ("at its negative end", (-0.0625, -0.0625), &series),
            ("just beyond it", (0.0625 + 1e-8, 0.0625 + 1e-8), &log),
            ("just beyond its negative end", (-0.0625 - 1e-8, -0.0625 - 1e-8), &log),
            ("near −1", (-0.99, -0.99), &log),
            ("far", (1000.0, 1000.0), &log),
            ("from the series to the logarithm", (0.01, 1000.0), &greater),
            ("both sides of 0", (-0.5, 0.01), &greater),
        ];
        for (name, (low, high), error) in rows {
            let (low, high) = (F32::below(low), F32::above(high));
            let got = profile.scope(|| Accept::<F32>::from_bounds(low, high).ln_1p());
            let (a, b) = (low.ln_1p(), high.ln_1p());
            let ends = [documented(a, error(a)), documented(b, error(b))];
            let both = |k: usize| ends[0][k].zip(ends[1][k]).map(|((low, _), (_, high))| (low, high));
            assert_between(name, &(profile.name, low, high), got, [both(0), both(1)]);
        }
    }
    assert_is("at 0", &0, WGSL.scope(|| Accept::<F32>::exactly(0.0).ln_1p()), Some((0.0, 0.0)));
}

#[test]
fn exp_m1_is_a_series_near_0_and_a_difference_beyond() {
    for profile in [&WGSL, &OPENGL] {
        let error = |y: f64| (20.0 * 1.65 * profile.relative.max(F32::EPSILON) + F32::EPSILON / 8.0) * y.abs();
        let apply = |low: f64, high: f64| profile.scope(|| Accept::<F32>::from_bounds(low, high).exp_m1());
        for x in [0.001, -0.001, 0.3, -0.3, 0.5, -0.5] {
            let x = F32::below(x);
            assert_between("the series", &(profile.name, x), apply(x, x), documented(x.exp_m1(), error(x.exp_m1())));
        }
        for x in [0.5, -0.5].map(|x: f64| x * (1.0 + F32::EPSILON)).into_iter().chain([1.0, -3.0, 20.0]) {
            let difference = profile.scope(|| Accept::<F32>::exactly(x).exp() - Accept::exactly(1.0));
            assert_eq!(apply(x, x), difference, "beyond, {x} by {}", profile.name);
        }
        // Ranges that reach beyond hold the series up to its end and the difference of the whole.
        for (low, high) in [(-0.25, 2.0), (-2.0, 0.25), (-3.0, 3.0), (0.5, 1.0), (-1.0, -0.5)] {
            let (a, b) = (f64::exp_m1(f64::max(low, -0.5)), f64::exp_m1(f64::min(high, 0.5)));
            let difference = profile.scope(|| Accept::<F32>::from_bounds(low, high).exp() - Accept::exactly(1.0));
            let ends = [documented(a, error(a)), documented(b, error(b))];
            let both = |k: usize| {
                let series = ends[0][k].zip(ends[1][k]).map(|((low, _), (_, high))| (low, high));
                hull([series, super::oracle::ends(difference)])
            };
            assert_between("a range", &(profile.name, low, high), apply(low, high), [both(0), both(1)]);
        }
    }
    // The end of the series does not reach the exponential, however far that may be off.
    let off = Profile { exp_ulp: GrowingUlp { base: 1e4, slope: 0.0 }, ..WGSL };
    for x in [0.5, -0.5] {
        let legal = |profile: &Profile| profile.scope(|| Accept::<F32>::exactly(x).exp_m1());
        assert_eq!(legal(&off), legal(&WGSL), "{x}");
    }
    assert_is("at 0", &0, WGSL.scope(|| Accept::<F32>::exactly(0.0).exp_m1()), Some((0.0, 0.0)));
}
