//! Mistakes in named steps: where nothing is altered a formula is unchanged, and an alteration reaches its step alone.

#![expect(clippy::float_cmp, reason = "the numbers are whole and exact")]

use super::oracle::Draws;
use crate::Accept;
use crate::mistaken::{Alteration, Mistaken, Taken, making, place};
use crate::profile::WGSL;
use lightmeter_reference::{NamedStep, Real};
use std::panic::catch_unwind;

type Function<R> = fn([R; 3]) -> R;

/// Functions of three numbers, each by one operation alone.
fn functions<R: Real>() -> [(&'static str, Function<R>); 28] {
    [
        ("+", |[a, b, _]| a + b),
        ("−", |[a, b, _]| a - b),
        ("·", |[a, b, _]| a * b),
        ("/", |[a, b, _]| a / b),
        ("−a", |[a, ..]| -a),
        ("max", |[a, b, _]| a.max(b)),
        ("min", |[a, b, _]| a.min(b)),
        ("abs", |[a, ..]| a.abs()),
        ("round", |[a, ..]| a.round()),
        ("sqrt", |[a, ..]| a.sqrt()),
        ("inverse_sqrt", |[a, ..]| a.inverse_sqrt()),
        ("exp", |[a, ..]| a.exp()),
        ("exp2", |[a, ..]| a.exp2()),
        ("log2", |[a, ..]| a.log2()),
        ("pow", |[a, b, _]| a.pow(b)),
        ("lobe", |[a, b, _]| a.lobe(b)),
        ("ln_1p", |[a, ..]| a.ln_1p()),
        ("exp_m1", |[a, ..]| a.exp_m1()),
        ("clamp", |[a, b, c]| a.clamp(b, c)),
        ("sum", R::sum),
        ("sum_over", |x| R::sum_over(x.into_iter())),
        ("product", R::product),
        ("mix", |[a, b, c]| R::mix(a, b, c)),
        ("normalize", |x| R::normalize(x)[1]),
        ("quadratic", |[a, b, c]| R::quadratic([a, b, c], b)),
        ("difference_of_products", |[a, b, c]| R::difference_of_products([a, b], [b, c])),
        ("if_ge", |[a, b, c]| R::if_ge(a, b, || c, || R::literal(0.3))),
        ("floor_then", |[a, ..]| a.floor_then(R::literal)),
    ]
}

#[test]
fn an_arithmetic_without_mistakes_is_the_one_beneath() {
    let mut draws = Draws(1);
    let plain = functions::<f64>().into_iter().zip(functions::<Mistaken<f64>>());
    for (((name, plain), (_, mistaken)), ((_, legal), (_, over_legal))) in
        plain.zip(functions::<Accept>().into_iter().zip(functions::<Mistaken<Accept>>()))
    {
        for _ in 0..20 {
            let inputs: [f32; 3] = std::array::from_fn(|_| draws.number(-3, 2));
            let (expected, got) = (plain(inputs.map(Real::input)), mistaken(inputs.map(Real::input)).0);
            assert_eq!(got.to_bits(), expected.to_bits(), "{name} of {inputs:?}");
            WGSL.scope(|| {
                assert_eq!(
                    over_legal(inputs.map(Real::input)).0,
                    legal(inputs.map(Real::input)),
                    "{name} of {inputs:?}"
                );
            });
        }
    }
    assert!(Mistaken(0.5).is_at_most(0.5) && !Mistaken(0.5).is_at_most(0.25));
}

#[test]
fn a_branch_of_intervals_is_the_hull() {
    let open: Accept = Accept::from_bounds(-1.0, 1.0);
    let [zero, one, two] = [0.0, 1.0, 2.0].map(|x| Mistaken(Accept::exactly(x)));
    let branch = Mistaken::if_ge(Mistaken(open), zero, || one, || two);
    assert_eq!(branch.0, Accept::from_bounds(1.0, 2.0));
}

static STEP: NamedStep = NamedStep { name: "s", of: &["a", "b"], is_quiet: false };
static OTHER: NamedStep = NamedStep { name: "t", of: &["a"], is_quiet: false };

#[test]
fn what_a_step_is_given_has_its_place() {
    let sizes = [3, 1];
    // Name, what is asked for, its place.
    let rows = [("the first", "a", Some(0..3)), ("after it", "b", Some(3..4)), ("what it is not given", "c", None)];
    for (name, of, expected) in rows {
        assert_eq!(place(&STEP, &sizes, of), expected, "{name}");
    }
    assert_eq!(place(&STEP, &[3], "b"), None, "without a size");
}

/// Checks what it is handed, doubles what is given as `b`, and adds to what comes out.
#[derive(Debug)]
struct Doubles {
    step: &'static str,
    plus: f32,
}

impl Doubles {
    fn fill<R: Real>(&self, taken: &mut Taken<'_, R>) {
        if taken.step.name == "s" {
            assert_eq!(taken.place("b"), Some(2..3));
            assert_eq!((taken.given("a").map(<[R]>::len), taken.given("c").map(<[R]>::len)), (Some(2), None));
            assert!(taken.array::<2>("a").is_some() && taken.array::<3>("a").is_none(), "as many as there are");
            taken.from[2] = taken.from[2] + taken.from[2];
        }
        taken.compute();
        taken.out[0] = taken.out[0] + R::input(self.plus);
    }
}

impl Alteration for Doubles {
    fn concerns(&self, step: &'static NamedStep) -> bool {
        step.name == self.step
    }
    fn on_f64(&self, taken: &mut Taken<'_, f64>) {
        self.fill(taken);
    }
    fn on_f32(&self, taken: &mut Taken<'_, f32>) {
        self.fill(taken);
    }
    fn on_accept(&self, taken: &mut Taken<'_, Accept>) {
        self.fill(taken);
    }
}

/// (x + y)·b, and then 100 times that in another step.
fn formula<R: crate::mistaken::Alter>(x: f64, y: f64, b: f64) -> R {
    let [x, y, b] = [x, y, b].map(|x| Mistaken(R::literal(x)));
    let first = Mistaken::step(&STEP, (lightmeter_reference::Vector([x, y]), b), |(v, b)| (v.0[0] + v.0[1]) * b);
    Mistaken::step(&OTHER, first, |a| a * Mistaken(R::literal(100.0))).0
}

static IN_S: Doubles = Doubles { step: "s", plus: 0.5 };
static IN_T: Doubles = Doubles { step: "t", plus: 7.0 };

#[test]
fn an_alteration_changes_what_its_step_takes_and_gives() {
    let run = |alterations: &[&'static dyn Alteration]| {
        making(alterations.iter().copied(), || {
            WGSL.scope(|| {
                let legal = formula::<Accept>(1.0, 2.0, 4.0);
                assert_eq!(legal.low().to_bits(), legal.high().to_bits());
                (formula::<f64>(1.0, 2.0, 4.0), f64::from(formula::<f32>(1.0, 2.0, 4.0)), legal.low())
            })
        })
    };
    let all = |x: f64| (x, x, x);
    // Name, what is altered, the result in each arithmetic.
    let rows: [(&str, &[&'static dyn Alteration], f64); 5] = [
        ("nothing", &[], 1200.0),
        ("the first step: 3·8 + ½", &[&IN_S], 2450.0),
        ("the second", &[&IN_T], 1207.0),
        ("both", &[&IN_S, &IN_T], 2457.0),
        ("the first one twice, one around the other: 3·16 + ½ + ½", &[&IN_S, &IN_S], 4900.0),
    ];
    for (name, alterations, expected) in rows {
        assert_eq!(run(alterations), all(expected), "{name}");
    }
    assert_eq!(formula::<f64>(1.0, 2.0, 4.0), 1200.0, "afterwards");
}

#[test]
fn alterations_end_with_a_panic_and_are_not_made_inside_each_other() {
    let one = || std::iter::once(&IN_S as &dyn Alteration);
    let nested = catch_unwind(|| making(one(), || making(one(), || ())));
    assert!(nested.is_err(), "alterations inside of alterations");
    assert!(catch_unwind(|| making(one(), || panic!("on the way"))).is_err());
    assert_eq!(formula::<f64>(1.0, 2.0, 4.0), 1200.0, "after a panic");
    assert_eq!(making(one(), || formula::<f64>(1.0, 2.0, 4.0)), 2450.0, "and again");
}
