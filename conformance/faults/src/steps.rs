//! The named steps that a formula takes, found by evaluating it.

use super::row::Arithmetic;
use lightmeter_arithmetic::Accept;
use lightmeter_arithmetic::mistaken::{Alteration, Mistaken, Taken, making};
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_reference::{NamedStep, Real};
use std::cell::RefCell;

/// A step that a formula takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    pub(super) step: &'static NamedStep,
    /// How many numbers it is given under each name.
    pub(super) sizes: &'static [usize],
    /// How many it gives.
    pub(super) out: usize,
}

/// Random cases that a formula's steps are sought in, besides its hard ones: not every case takes every branch.
const CASES: u64 = 64;

thread_local! {
    static SEEN: RefCell<Vec<Seen>> = const { RefCell::new(Vec::new()) };
}

/// Computes each step as it is to be, and notes it.
#[derive(Debug)]
struct Recorder;

impl Recorder {
    fn note<R: Real>(taken: &mut Taken<'_, R>) {
        let seen = Seen { step: taken.step, sizes: taken.sizes, out: taken.out.len() };
        SEEN.with_borrow_mut(|all| {
            if !all.contains(&seen) {
                all.push(seen);
            }
        });
        taken.compute();
    }
}

impl Alteration for Recorder {
    fn concerns(&self, _: &'static NamedStep) -> bool {
        true
    }
    fn on_f64(&self, taken: &mut Taken<'_, f64>) {
        Self::note(taken);
    }
    fn on_f32(&self, taken: &mut Taken<'_, f32>) {
        Self::note(taken);
    }
    fn on_accept(&self, taken: &mut Taken<'_, Accept>) {
        Self::note(taken);
    }
}

/// The steps that a formula takes in some case, each once.
pub(super) fn steps_of(member: &Member) -> Vec<Seen> {
    static RECORDER: Recorder = Recorder;
    let hard = (0..member.spec.hard.len()).map(CaseRef::Hard);
    let (mut row, mut out) = (vec![], vec![Mistaken(0.0); member.spec.output_len()]);
    for case in hard.chain((0..CASES).map(CaseRef::Random)) {
        row.clear();
        member.inputs(case, 0, &mut row);
        let wide: Vec<Mistaken<f64>> = row.iter().map(|&x| Mistaken(x.into())).collect();
        let alterations = std::iter::once(&RECORDER as &'static dyn Alteration);
        making(alterations, || f64::evaluate(&*member.formula, &wide, &mut out));
    }
    SEEN.with_borrow_mut(std::mem::take)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::formulas;

    #[test]
    fn a_formula_tells_its_steps() {
        let member = formulas().iter().find(|member| member.spec.id == "lighting/blinn").expect("lighting/blinn");
        let names: Vec<&str> = steps_of(member).iter().map(|seen| seen.step.name).collect();
        for name in ["n", "l", "v", "v + l", "h", "n·h", "FS", "l·n", "FI", "CA", "CD", "CS", "CF"] {
            assert!(names.contains(&name), "{name} among {names:?}");
        }
    }
}
