//! What a mistake does to a named step of a formula.

mod computed;
mod form;

pub(super) use form::Form;

use super::op::Op;
use super::row::Arithmetic;
use computed::computed;
use lightmeter_arithmetic::Accept;
use lightmeter_arithmetic::mistaken::{Alteration, Taken, place};
use lightmeter_reference::{NamedStep, Real};

/// Stands for each step.
pub(super) const ANY: &str = "*";
/// Stands for each step that normalises a vector.
pub(super) const NORMALISED: &str = "⟨*⟩";
/// Their names.
const NORMALISED_STEPS: [&str; 9] = ["n", "l", "v", "h", "axis", "face's n", "⟨v⟩", "⟨n⟩", "⟨Σn⟩"];

/// A step that goes wrong, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct At {
    pub(super) step: &'static str,
    pub(super) what: Do,
}

/// How a step goes wrong. What it is given is named as the step names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Do {
    /// Its own numbers change.
    Result(Op),
    /// What it is given changes.
    Given(&'static str, Op),
    /// It gives what it is given.
    Pass(&'static str),
    /// The same, changed.
    PassAs(&'static str, Op),
    /// The step returns its first operand, with the operation applied to it, instead of computing its result.
    FirstAs(Op),
    /// It is given one in the place of the other, and the reverse.
    Swap(&'static str, &'static str),
    /// The first named operand is also used in place of the second.
    Copy(&'static str, &'static str),
    /// It gives the sum of the two.
    Sum(&'static str, &'static str),
    /// It gives more by what it is given.
    Plus(&'static str),
    /// It is multiplied by a number that it is given.
    Times(&'static str),
    /// It is computed by another formula.
    Form(Form),
}

impl At {
    fn is_at(&self, step: &NamedStep) -> bool {
        match self.step {
            ANY => true,
            NORMALISED => NORMALISED_STEPS.contains(&step.name),
            name => step.name == name,
        }
    }

    /// Whether this mistake can be made in a step. `sizes` says how many numbers each of the step's operands has, and `out` how many
    /// numbers the step returns.
    pub(super) fn fits(&self, step: &NamedStep, sizes: &[usize], out: usize) -> bool {
        let size = |name: &str| place(step, sizes, name).map(|range| range.len());
        let has = |name: &&'static str| size(name).is_some();
        self.is_at(step)
            && match self.what {
                Do::Result(op) => op.fits(out),
                Do::Given(name, op) => size(name).is_some_and(|count| op.fits(count)),
                Do::Pass(name) | Do::Plus(name) => size(name) == Some(out),
                Do::PassAs(name, op) => size(name).is_some_and(|count| op.fits(count) && count == out),
                Do::FirstAs(op) => sizes.first() == Some(&out) && op.fits(out),
                Do::Swap(a, b) | Do::Copy(a, b) => size(a).is_some() && size(a) == size(b),
                Do::Times(name) => size(name) == Some(1),
                Do::Sum(a, b) => size(a) == Some(out) && size(b) == Some(out),
                Do::Form(form) => form.needs().iter().any(|names| names.iter().all(has)),
            }
    }

    /// Whether two mistakes cannot be combined: they are the same one, or both replace the computation of the same step.
    pub(super) fn collides(&self, other: &Self) -> bool {
        self.step == other.step && (self.what == other.what || (self.replaces() && other.replaces()))
    }

    /// Whether it takes the place of the step's own computation, so that what changes the result comes after it.
    pub(super) const fn replaces(&self) -> bool {
        matches!(self.what, Do::Pass(_) | Do::PassAs(..) | Do::Sum(..) | Do::Form(_))
    }

    fn make<R: Arithmetic>(&self, taken: &mut Taken<'_, R>) {
        match self.what {
            Do::Result(op) => {
                taken.compute();
                op.apply(taken.out);
            }
            Do::Given(name, op) => {
                if let Some(range) = taken.place(name) {
                    op.apply(&mut taken.from[range]);
                }
                taken.compute();
            }
            Do::Pass(name) => pass(taken, name),
            Do::PassAs(name, op) => {
                pass(taken, name);
                op.apply(taken.out);
            }
            Do::FirstAs(op) => {
                taken.out.copy_from_slice(&taken.from[..taken.out.len()]);
                op.apply(taken.out);
            }
            Do::Swap(a, b) => {
                if let (Some(a), Some(b)) = (taken.place(a), taken.place(b)) {
                    a.zip(b).for_each(|(a, b)| taken.from.swap(a, b));
                }
                taken.compute();
            }
            Do::Copy(from, to) => {
                if let (Some(from), Some(to)) = (taken.place(from), taken.place(to)) {
                    taken.from.copy_within(from, to.start);
                }
                taken.compute();
            }
            Do::Sum(a, b) => {
                pass(taken, a);
                add(taken, b);
            }
            Do::Plus(name) => {
                taken.compute();
                add(taken, name);
            }
            Do::Times(name) => {
                taken.compute();
                if let Some([factor]) = taken.array(name) {
                    taken.out.iter_mut().for_each(|x| *x = *x * factor);
                }
            }
            Do::Form(form) => {
                if computed(form, taken).is_none() {
                    taken.compute();
                }
            }
        }
    }
}

impl Alteration for At {
    fn concerns(&self, step: &'static NamedStep) -> bool {
        self.is_at(step)
    }
    fn on_f64(&self, taken: &mut Taken<'_, f64>) {
        self.make(taken);
    }
    fn on_f32(&self, taken: &mut Taken<'_, f32>) {
        self.make(taken);
    }
    fn on_accept(&self, taken: &mut Taken<'_, Accept>) {
        self.make(taken);
    }
}

fn pass<R: Real>(taken: &mut Taken<'_, R>, name: &str) {
    if let Some(range) = taken.place(name).filter(|range| range.len() == taken.out.len()) {
        taken.out.copy_from_slice(&taken.from[range]);
    }
}

fn add<R: Real>(taken: &mut Taken<'_, R>, name: &str) {
    if let Some(range) = taken.place(name) {
        taken.out.iter_mut().zip(&taken.from[range]).for_each(|(x, &more)| *x = *x + more);
    }
}
