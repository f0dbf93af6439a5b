//! An f64 value and its acceptance interval side by side, which records the steps that a formula names.

use super::Accept;
use lightmeter_reference::{Components, NamedStep, Parts, Real};
use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The reference value and the interval of one intermediate result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trace {
    /// In f64.
    pub value: f64,
    /// What is legal.
    pub interval: Accept,
}

/// One recorded step.
#[derive(Clone, Debug)]
pub struct TraceStep {
    /// The formula's own name for it.
    pub name: &'static str,
    /// Which number it is of a step that has several, from 0; `None` of a number alone.
    pub component: Option<usize>,
    /// What it was.
    pub result: Trace,
    /// Whether it was recorded with all numbers of its step, so that the component is known.
    is_whole: bool,
}

thread_local! {
    static STEPS: RefCell<Vec<TraceStep>> = const { RefCell::new(Vec::new()) };
}

/// The most components of a vector.
const MOST_COMPONENTS: usize = 4;

/// Runs `f` and returns what it named, in order, beside its result.
pub fn record<T>(f: impl FnOnce() -> T) -> (T, Vec<TraceStep>) {
    STEPS.with_borrow_mut(Vec::clear);
    let result = f();
    let mut steps = STEPS.with_borrow_mut(std::mem::take);
    for run in steps.chunk_by_mut(|a, b| a.name == b.name && !a.is_whole && !b.is_whole) {
        // A vector is named component by component.
        if !run[0].is_whole && (2..=MOST_COMPONENTS).contains(&run.len()) {
            run.iter_mut().enumerate().for_each(|(place, step)| step.component = Some(place));
        }
    }
    (result, steps)
}

macro_rules! both {
    ($($method:ident($($other:ident),*)),+ $(,)?) => {$(
        fn $method(self $(, $other: Self)*) -> Self {
            Self {
                value: Real::$method(self.value $(, $other.value)*),
                interval: self.interval.$method($($other.interval),*),
            }
        }
    )+};
}

macro_rules! operator {
    ($($trait:ident::$method:ident),+ $(,)?) => {$(
        impl $trait for Trace {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self { value: self.value.$method(other.value), interval: self.interval.$method(other.interval) }
            }
        }
    )+};
}

operator!(Add::add, Sub::sub, Mul::mul, Div::div);

impl Neg for Trace {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, interval: -self.interval }
    }
}

impl Real for Trace {
    fn input(x: f32) -> Self {
        Self { value: Real::input(x), interval: Real::input(x) }
    }
    fn literal(x: f64) -> Self {
        Self { value: x, interval: Real::literal(x) }
    }
    both!(
        max(other),
        min(other),
        abs(),
        round(),
        sqrt(),
        inverse_sqrt(),
        exp(),
        exp2(),
        log2(),
        pow(e),
        lobe(e),
        ln_1p(),
        exp_m1()
    );
    fn difference_of_products([a, b]: [Self; 2], [c, d]: [Self; 2]) -> Self {
        Self {
            value: Real::difference_of_products([a.value, b.value], [c.value, d.value]),
            interval: Real::difference_of_products([a.interval, b.interval], [c.interval, d.interval]),
        }
    }
    fn if_ge<T: Components<Self>>(a: Self, b: Self, then: impl FnOnce() -> T, otherwise: impl FnOnce() -> T) -> T {
        // The value follows its own branch; the interval takes the hull where it cannot decide.
        let hull = |value_first: bool| {
            move |x: Self, y: Self| Self {
                value: if value_first { x.value } else { y.value },
                interval: x.interval.hull(y.interval),
            }
        };
        if a.interval.low() >= b.interval.high() && !a.interval.is_any() {
            then()
        } else if a.interval.high() < b.interval.low() {
            otherwise()
        } else {
            then().zip(otherwise(), hull(a.value >= b.value))
        }
    }
    fn floor_then<T: Components<Self>>(self, then: impl Fn(f64) -> T) -> T {
        // The value uses the floor of the value itself; the interval also covers the floors of both ends of the interval.
        let own = then(self.value.floor());
        let (first, last) = (self.interval.low().floor(), self.interval.high().floor());
        let beyond = |x: Self, y: Self| Self { value: x.value, interval: x.interval.hull(y.interval) };
        own.zip(then(first), beyond).zip(then(last), beyond)
    }
    fn sum_over(terms: impl Iterator<Item = Self>) -> Self {
        let (values, intervals): (Vec<f64>, Vec<Accept>) = terms.map(|x| (x.value, x.interval)).unzip();
        Self { value: Real::sum_over(values.into_iter()), interval: Real::sum_over(intervals.into_iter()) }
    }
    fn sum<const N: usize>(terms: [Self; N]) -> Self {
        Self { value: Real::sum(terms.map(|x| x.value)), interval: Real::sum(terms.map(|x| x.interval)) }
    }
    fn product<const N: usize>(factors: [Self; N]) -> Self {
        Self { value: Real::product(factors.map(|x| x.value)), interval: Real::product(factors.map(|x| x.interval)) }
    }
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
    fn mix(a: Self, b: Self, t: Self) -> Self {
        Self { value: Real::mix(a.value, b.value, t.value), interval: Real::mix(a.interval, b.interval, t.interval) }
    }
    fn mix_of_differences([to_a, to_b]: [Self; 2], from: Self, [a, b]: [Self; 2], t: Self) -> Self {
        Self {
            value: Real::mix_of_differences([to_a.value, to_b.value], from.value, [a.value, b.value], t.value),
            interval: Real::mix_of_differences(
                [to_a.interval, to_b.interval],
                from.interval,
                [a.interval, b.interval],
                t.interval,
            ),
        }
    }
    fn normalize<const N: usize>(v: [Self; N]) -> [Self; N] {
        let values = <f64 as Real>::normalize(v.map(|x| x.value));
        let intervals = Accept::normalize(v.map(|x| x.interval));
        std::array::from_fn(|k| Self { value: values[k], interval: intervals[k] })
    }
    fn or_dark(self, vectors: [[Self; 3]; 3]) -> Self {
        Self { interval: self.interval.or_dark(vectors.map(|v| v.map(|x| x.interval))), ..self }
    }
    fn quadratic(c: [Self; 3], x: Self) -> Self {
        Self {
            value: Real::quadratic(c.map(|c| c.value), x.value),
            interval: Real::quadratic(c.map(|c| c.interval), x.interval),
        }
    }
    fn named(self, name: &'static str) -> Self {
        STEPS.with_borrow_mut(|steps| steps.push(TraceStep { name, component: None, result: self, is_whole: false }));
        self
    }
    fn step<A: Parts<Self>, T: Parts<Self>>(step: &'static NamedStep, from: A, compute: impl Fn(A) -> T) -> T {
        let result = compute(from);
        if step.is_quiet {
            return result;
        }
        let is_vector = (2..=MOST_COMPONENTS).contains(&T::COUNT);
        let mut place = 0;
        result.each(|result| {
            let component = is_vector.then_some(place);
            place += 1;
            STEPS.with_borrow_mut(|steps| steps.push(TraceStep { name: step.name, component, result, is_whole: true }));
            result
        })
    }
}
