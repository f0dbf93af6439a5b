//! A formula some of whose named steps go wrong, in any arithmetic.

use super::Accept;
use lightmeter_reference::{Components, NamedStep, Parts, Real};
use std::cell::RefCell;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Range, Sub};

/// A number of a formula whose steps may go wrong: inside [`making`] each step is given to what is made there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Mistaken<R>(pub R);

/// What goes wrong in a step.
pub trait Alteration: Debug + Sync {
    /// Whether it is this step that goes wrong.
    fn concerns(&self, step: &'static NamedStep) -> bool;
    /// Computes the step in f64.
    fn on_f64(&self, taken: &mut Taken<'_, f64>);
    /// Computes the step in f32.
    fn on_f32(&self, taken: &mut Taken<'_, f32>);
    /// Computes the step in intervals.
    fn on_accept(&self, taken: &mut Taken<'_, Accept>);
}

/// An arithmetic that alterations know.
pub trait Alter: Real {
    /// Computes a step as a alteration does.
    fn alter(alteration: &dyn Alteration, taken: &mut Taken<'_, Self>);
}

impl Alter for f64 {
    fn alter(alteration: &dyn Alteration, taken: &mut Taken<'_, Self>) {
        alteration.on_f64(taken);
    }
}

impl Alter for f32 {
    fn alter(alteration: &dyn Alteration, taken: &mut Taken<'_, Self>) {
        alteration.on_f32(taken);
    }
}

impl Alter for Accept {
    fn alter(alteration: &dyn Alteration, taken: &mut Taken<'_, Self>) {
        alteration.on_accept(taken);
    }
}

/// What a formula makes of a step's numbers.
type Right<'a, R> = &'a dyn Fn(&[R], &mut [R]);

/// A step as it is computed: the numbers that it is given, and where its own go.
pub struct Taken<'a, R> {
    /// Its name, and the names of what it is given.
    pub step: &'static NamedStep,
    /// How many numbers each of those has.
    pub sizes: &'static [usize],
    /// The numbers that it is given.
    pub from: &'a mut [R],
    /// Its own numbers.
    pub out: &'a mut [R],
    right: Right<'a, R>,
}

impl<R: Real> Taken<'_, R> {
    /// Computes it as the formula does, of the numbers that it is given by now.
    pub fn compute(&mut self) {
        (self.right)(self.from, self.out);
    }

    /// The place of what it is given under a name.
    #[must_use]
    pub fn place(&self, name: &str) -> Option<Range<usize>> {
        place(self.step, self.sizes, name)
    }

    /// What it is given under a name.
    #[must_use]
    pub fn given(&self, name: &str) -> Option<&[R]> {
        self.from.get(self.place(name)?)
    }

    /// The same as a list of numbers.
    #[must_use]
    pub fn array<const N: usize>(&self, name: &str) -> Option<[R; N]> {
        self.given(name)?.try_into().ok()
    }
}

/// The place among a step's numbers of what it is given under a name.
#[must_use]
pub fn place(step: &NamedStep, sizes: &[usize], name: &str) -> Option<Range<usize>> {
    let number = step.of.iter().position(|given| *given == name)?;
    let start = sizes.iter().take(number).sum();
    Some(start..start + sizes.get(number)?)
}

thread_local! {
    static ALTERATIONS: RefCell<Vec<&'static dyn Alteration>> = const { RefCell::new(Vec::new()) };
}

/// Runs `f`, in which evaluations over [`Mistaken`] make these alterations.
///
/// # Panics
/// Where it is called inside itself.
pub fn making<T>(alterations: impl Iterator<Item = &'static dyn Alteration>, f: impl FnOnce() -> T) -> T {
    ALTERATIONS.with_borrow_mut(|made| {
        assert!(made.is_empty(), "alterations are made one evaluation at a time");
        made.extend(alterations);
    });
    let _made = Made;
    f()
}

/// Alterations that are being made, until it is dropped.
struct Made;

impl Drop for Made {
    fn drop(&mut self) {
        ALTERATIONS.with(|made| {
            // An evaluation that panics still has them borrowed.
            if let Ok(mut made) = made.try_borrow_mut() {
                made.clear();
            }
        });
    }
}

/// Room for the numbers that a step is given.
const MOST_GIVEN: usize = 40;
/// Room for those that it gives.
const MOST_OUT: usize = 16;

/// A step as the first of these alterations makes it that concerns it, around what the others make of it.
fn alter<R: Alter>(
    alterations: &[&'static dyn Alteration],
    (step, sizes): (&'static NamedStep, &'static [usize]),
    from: &[R],
    out: &mut [R],
    right: Right<'_, R>,
) {
    let Some(first) = alterations.iter().position(|alteration| alteration.concerns(step)) else {
        right(from, out);
        return;
    };
    let others = |from: &[R], out: &mut [R]| alter(&alterations[first + 1..], (step, sizes), from, out, right);
    let mut changed = [R::literal(0.0); MOST_GIVEN];
    changed[..from.len()].copy_from_slice(from);
    let from = &mut changed[..from.len()];
    R::alter(alterations[first], &mut Taken { step, sizes, from, out, right: &others });
}

/// Puts what consists of numbers on a row; how many they were.
fn spread<R: Real, T: Parts<Mistaken<R>>>(parts: T, row: &mut [R]) -> usize {
    let mut count = 0;
    parts.put(&mut |x| {
        row[count] = x.0;
        count += 1;
    });
    count
}

fn gather<R: Real, T: Parts<Mistaken<R>>>(row: &[R]) -> T {
    let mut numbers = row.iter();
    T::take(&mut || Mistaken(*numbers.next().expect("a row has the numbers of what is taken from it")))
}

/// Alternatives of a branch, over the arithmetic beneath.
struct Beneath<T>(T);

impl<R: Real, T: Components<Mistaken<R>>> Components<R> for Beneath<T> {
    fn zip(self, other: Self, mut f: impl FnMut(R, R) -> R) -> Self {
        Self(self.0.zip(other.0, |a, b| Mistaken(f(a.0, b.0))))
    }
}

macro_rules! operator {
    ($($trait:ident::$method:ident),+ $(,)?) => {$(
        impl<R: Real> $trait for Mistaken<R> {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )+};
}

operator!(Add::add, Sub::sub, Mul::mul, Div::div);

impl<R: Real> Neg for Mistaken<R> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! beneath {
    ($($method:ident($($other:ident),*)),+ $(,)?) => {$(
        #[inline]
        fn $method(self $(, $other: Self)*) -> Self {
            Self(self.0.$method($($other.0),*))
        }
    )+};
}

impl<R: Alter> Real for Mistaken<R> {
    fn input(x: f32) -> Self {
        Self(R::input(x))
    }
    fn literal(x: f64) -> Self {
        Self(R::literal(x))
    }
    beneath!(
        max(other),
        min(other),
        abs(),
        round(),
        sqrt(),
        inverse_sqrt(),
        exp(),
        exp2(),
        log2(),
        pow(exponent),
        lobe(exponent),
        ln_1p(),
        exp_m1(),
        clamp(low, high),
    );
    fn if_ge<T: Components<Self>>(a: Self, b: Self, then: impl FnOnce() -> T, otherwise: impl FnOnce() -> T) -> T {
        R::if_ge(a.0, b.0, || Beneath(then()), || Beneath(otherwise())).0
    }
    fn floor_then<T: Components<Self>>(self, then: impl Fn(f64) -> T) -> T {
        self.0.floor_then(|n| Beneath(then(n))).0
    }
    fn is_at_most(self, bound: f64) -> bool {
        self.0.is_at_most(bound)
    }
    fn sum<const N: usize>(terms: [Self; N]) -> Self {
        Self(R::sum(terms.map(|x| x.0)))
    }
    fn sum_over(terms: impl Iterator<Item = Self>) -> Self {
        Self(R::sum_over(terms.map(|x| x.0)))
    }
    fn product<const N: usize>(factors: [Self; N]) -> Self {
        Self(R::product(factors.map(|x| x.0)))
    }
    fn mix(a: Self, b: Self, t: Self) -> Self {
        Self(R::mix(a.0, b.0, t.0))
    }
    fn normalize<const N: usize>(v: [Self; N]) -> [Self; N] {
        R::normalize(v.map(|x| x.0)).map(Self)
    }
    fn or_dark(self, vectors: [[Self; 3]; 3]) -> Self {
        Self(self.0.or_dark(vectors.map(|v| v.map(|x| x.0))))
    }
    fn quadratic(c: [Self; 3], x: Self) -> Self {
        Self(R::quadratic(c.map(|c| c.0), x.0))
    }
    fn difference_of_products([a, b]: [Self; 2], [c, d]: [Self; 2]) -> Self {
        Self(R::difference_of_products([a.0, b.0], [c.0, d.0]))
    }
    fn step<A: Parts<Self>, T: Parts<Self>>(step: &'static NamedStep, from: A, compute: impl Fn(A) -> T) -> T {
        const { assert!(A::COUNT <= MOST_GIVEN && T::COUNT <= MOST_OUT, "a step has room for its numbers") };
        ALTERATIONS.with_borrow(|alterations| {
            if !alterations.iter().any(|alteration| alteration.concerns(step)) {
                return compute(from);
            }
            let (mut given, mut out) = ([R::literal(0.0); MOST_GIVEN], [R::literal(0.0); MOST_OUT]);
            let count = spread(from, &mut given);
            let right = |from: &[R], out: &mut [R]| {
                spread(compute(gather(from)), out);
            };
            alter(alterations, (step, A::SIZES), &given[..count], &mut out[..T::COUNT], &right);
            gather(&out)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_reference::{Vector, fog, vector};

    /// Gives this number.
    #[derive(Debug)]
    struct Gives(&'static str, f32);

    impl Gives {
        fn fill<R: Real>(&self, taken: &mut Taken<'_, R>) {
            taken.compute();
            taken.out.iter_mut().for_each(|x| *x = *x * R::input(self.1));
        }
    }

    impl Alteration for Gives {
        fn concerns(&self, step: &'static NamedStep) -> bool {
            step.name == self.0
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

    #[test]
    fn a_step_goes_wrong_inside_alone() {
        static TWICE: Gives = Gives("f", 2.0);
        static THRICE: Gives = Gives("f", 3.0);
        let f = || fog::linear(Mistaken(10.0), Mistaken(0.0), Mistaken(20.0)).0;
        let made = |alterations: &[&'static dyn Alteration]| making(alterations.iter().copied(), f);
        assert_eq!((f(), made(&[&TWICE]), made(&[&TWICE, &THRICE]), f()), (0.5, 1.0, 3.0, 0.5));
    }

    #[test]
    fn vectors_are_taken_apart_and_put_together() {
        static HALF: Gives = Gives("r", 0.5);
        let v = |x: [f32; 3]| Vector(x.map(Mistaken::<f32>::input));
        let r = || vector::reflect(v([1.0, -2.0, 0.5]), v([0.0, 1.0, 0.0])).0.map(|x| x.0);
        let halved = making(std::iter::once(&HALF as &dyn Alteration), r);
        assert_eq!(halved.map(f32::to_bits), [0.5_f32, 1.0, 0.25].map(f32::to_bits));
    }
}
