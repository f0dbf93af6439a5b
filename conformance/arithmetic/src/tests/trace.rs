//! A trace is the plain value beside the interval, and records what a formula names.

use super::oracle::{Draws, ends};
use crate::profile::WGSL;
use crate::{Accept, Trace, trace};
use lightmeter_reference::Real;

type Function<R> = fn([R; 4]) -> R;

/// Functions of four numbers, each by one operation alone.
fn functions<R: Real>() -> [(&'static str, Function<R>); 24] {
    [
        ("+", |[a, b, ..]| a + b),
        ("−", |[a, b, ..]| a - b),
        ("·", |[a, b, ..]| a * b),
        ("/", |[a, b, ..]| a / b),
        ("−a", |[a, ..]| -a),
        ("max", |[a, b, ..]| a.max(b)),
        ("min", |[a, b, ..]| a.min(b)),
        ("abs", |[a, ..]| a.abs()),
        ("round", |[a, ..]| a.round()),
        ("sqrt", |[a, ..]| a.sqrt()),
        ("inverse_sqrt", |[a, ..]| a.inverse_sqrt()),
        ("exp", |[a, ..]| a.exp()),
        ("exp2", |[a, ..]| a.exp2()),
        ("log2", |[a, ..]| a.log2()),
        ("pow", |[a, b, ..]| a.pow(b)),
        ("lobe", |[a, b, ..]| a.lobe(b)),
        ("ln_1p", |[a, ..]| a.ln_1p()),
        ("exp_m1", |[a, ..]| a.exp_m1()),
        ("difference_of_products", |[a, b, c, d]| R::difference_of_products([a, b], [c, d])),
        ("sum", R::sum),
        ("sum_over", |x| R::sum_over(x.into_iter())),
        ("product", R::product),
        ("mix", |[a, b, c, _]| R::mix(a, b, c)),
        ("quadratic", |[a, b, c, d]| R::quadratic([a, b, c], d)),
    ]
}

#[test]
fn each_operation_is_that_of_the_value_and_that_of_the_interval() {
    let mut draws = Draws(1);
    WGSL.scope(|| {
        for (((name, traced), (_, value)), (_, interval)) in
            functions::<Trace>().into_iter().zip(functions::<f64>()).zip(functions::<Accept>())
        {
            for _ in 0..20 {
                let inputs: [f32; 4] = std::array::from_fn(|_| draws.number(-3, 2));
                let got = traced(inputs.map(Real::input));
                let (value, interval) = (value(inputs.map(Real::input)), interval(inputs.map(Real::input)));
                assert_eq!(got.value.to_bits(), value.to_bits(), "{name} of {inputs:?}");
                assert_eq!(ends(got.interval), ends(interval), "{name} of {inputs:?}");
            }
        }
        let v = [0.5, -1.25, 3.0];
        let traced = Trace::normalize(v.map(Real::input));
        let values = <f64 as Real>::normalize(v.map(f64::from));
        let intervals = <Accept as Real>::normalize(v.map(Real::input));
        assert_eq!(traced.map(|x| x.value.to_bits()), values.map(f64::to_bits));
        assert_eq!(traced.map(|x| x.interval), intervals);
        let [x, zero, one]: [Trace; 3] = [1.5, 0.0, 1.0].map(Real::input);
        assert_eq!((x.clamp(zero, one), (-x).clamp(zero, one), one.clamp(zero, x)), (one, zero, one));
        let third = <Trace as Real>::literal(1.0 / 3.0);
        assert_eq!((third.value, third.interval), (1.0 / 3.0, <Accept as Real>::literal(1.0 / 3.0)));
    });
}

fn trace(value: f64, low: f64, high: f64) -> Trace {
    Trace { value, interval: Accept::from_bounds(low, high) }
}

#[test]
fn the_value_follows_its_side_and_the_interval_the_hull() {
    let then = trace(1.5, 1.0, 2.0);
    let otherwise = trace(-3.5, -4.0, -3.0);
    let if_ge = |a: Trace, b: Trace| Trace::if_ge(a, b, || then, || otherwise);
    let half = trace(0.5, 0.5, 0.5);
    let any = Trace { value: 0.75, interval: Accept::ANY };
    // Name, a, b, the result.
    let rows = [
        ("above", trace(0.75, 0.625, 0.875), half, then),
        ("touching from above is ≥", trace(0.75, 0.5, 0.875), half, then),
        ("below", trace(0.25, 0.125, 0.375), half, otherwise),
        ("touching from below, below by value", trace(0.25, 0.125, 0.5), half, trace(-3.5, -4.0, 2.0)),
        ("touching from below, equal by value", trace(0.5, 0.125, 0.5), half, trace(1.5, -4.0, 2.0)),
        ("overlapping, above by value", trace(0.75, 0.25, 0.875), half, trace(1.5, -4.0, 2.0)),
        ("anything against a number", any, half, trace(1.5, -4.0, 2.0)),
        ("a number against anything", half, any, trace(-3.5, -4.0, 2.0)),
        ("anything against anything", any, any, trace(1.5, -4.0, 2.0)),
    ];
    for (name, a, b, expected) in rows {
        assert_eq!(if_ge(a, b), expected, "{name}");
    }
}

#[test]
fn a_floor_holds_that_of_the_value_and_of_the_ends() {
    let squared = |value: f64, low: f64, high: f64| {
        trace(value, low, high).floor_then(|k| Trace { value: k * k, interval: Accept::exactly(k * k) })
    };
    // Name, result, expected.
    let rows = [
        ("one floor", squared(2.5, 2.25, 2.75), trace(4.0, 4.0, 4.0)),
        ("the value's is below", squared(2.75, 2.5, 3.25), trace(4.0, 4.0, 9.0)),
        ("the value's is above", squared(3.0, 2.5, 3.25), trace(9.0, 4.0, 9.0)),
        ("between the ends'", squared(0.5, -1.5, 2.5), trace(0.0, 0.0, 4.0)),
    ];
    for (name, got, expected) in rows {
        assert_eq!(got, expected, "{name}");
    }
}

#[test]
fn steps_are_recorded_in_order_and_once() {
    let names = |steps: &[trace::TraceStep]| steps.iter().map(|step| step.name).collect::<Vec<_>>();
    let [two, three] = [2.0, 3.0].map(|x| trace(x, x, x));
    let (result, steps) = trace::record(|| {
        let sum = WGSL.scope(|| (two.named("a") + three.named("b")).named("a + b"));
        sum.value
    });
    assert_eq!((result, names(&steps)), (5.0, vec!["a", "b", "a + b"]));
    assert_eq!([steps[0].result, steps[1].result, steps[2].result], [two, three, trace(5.0, 5.0, 5.0)]);
    let ((), none) = trace::record(|| ());
    assert!(none.is_empty(), "a record starts afresh: {:?}", names(&none));
    let _stray = two.named("stray");
    let (_, steps) = trace::record(|| three.named("own"));
    assert_eq!(names(&steps), ["own"], "what was named outside is not recorded");
}
