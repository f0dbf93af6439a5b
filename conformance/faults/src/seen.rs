//! The steps of a formula as whoever makes a mistake computes them.

use super::variation::Variation;
use lightmeter_arithmetic::Accept;
use lightmeter_arithmetic::mistaken::{Alteration, Taken};
use lightmeter_catalogue::select::Member;
use lightmeter_reference::NamedStep;
use std::cell::RefCell;

/// A number of a step, right and as it is computed with mistakes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenStep {
    /// The step's name.
    pub name: &'static str,
    /// As the published formula has it.
    pub right: f64,
    /// As it is with the mistakes.
    pub made: f64,
}

thread_local! {
    static SEEN: RefCell<Vec<(&'static str, f64)>> = const { RefCell::new(Vec::new()) };
}

/// Changes nothing, and notes what each step gives.
#[derive(Debug)]
struct Observer;

static OBSERVER: Observer = Observer;

impl Alteration for Observer {
    fn concerns(&self, step: &'static NamedStep) -> bool {
        !step.is_quiet
    }

    fn on_f64(&self, taken: &mut Taken<'_, f64>) {
        taken.compute();
        SEEN.with_borrow_mut(|seen| seen.extend(taken.out.iter().map(|x| (taken.step.name, *x))));
    }

    fn on_f32(&self, taken: &mut Taken<'_, f32>) {
        taken.compute();
    }

    fn on_accept(&self, taken: &mut Taken<'_, Accept>) {
        taken.compute();
    }
}

impl Variation<'_> {
    /// The steps at which the mistakes show for a row of inputs, in the order in which they are computed. Empty where another formula is
    /// computed in place of the published one, whose steps are not comparable.
    #[must_use]
    pub fn steps(&self, inputs: &[f32]) -> Vec<SeenStep> {
        let (right, made) = (seen(&Variation::right(self.member), inputs), seen(self, inputs));
        let names = |steps: &[(&'static str, f64)]| steps.iter().map(|(name, _)| *name).collect::<Vec<_>>();
        if names(&right) != names(&made) {
            return vec![];
        }
        let pairs = right.into_iter().zip(made).map(|((name, right), (_, made))| SeenStep { name, right, made });
        pairs.filter(|step| step.right.to_bits() != step.made.to_bits()).collect()
    }
}

fn seen(variation: &Variation<'_>, inputs: &[f32]) -> Vec<(&'static str, f64)> {
    let member: &Member = variation.member;
    SEEN.take();
    variation.observed(&OBSERVER, inputs, &mut vec![0.0_f64; member.spec.output_len()]);
    SEEN.take()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::{Fault, formulas};
    use lightmeter_catalogue::select::CaseRef;

    /// Of the first drawn case in which the mistake shows.
    fn steps(formula: &str, mistake: &str) -> Vec<SeenStep> {
        let member = formulas().iter().find(|member| member.spec.id == formula).expect(formula);
        let variation = Variation::new(member, &[Fault::by_name(mistake).expect(mistake)]).expect("it concerns it");
        let mut row = vec![];
        let of_case = |index| {
            member.inputs(CaseRef::Random(index), 1, &mut row);
            variation.steps(&row)
        };
        (0..256).map(of_case).find(|steps| !steps.is_empty()).expect("a case in which the mistake shows")
    }

    #[test]
    fn the_first_step_that_differs_is_the_one_that_goes_wrong() {
        let found = steps("fog/exp", "fog-radial");
        assert_eq!(found[0].name, "distance");
        assert!(found[0].made > found[0].right && found.iter().any(|step| step.name == "f"), "{found:?}");
        // What is computed before the mistake is as it should be.
        let found = steps("lighting/blinn", "no-diffuse");
        assert!(found.iter().all(|step| step.name != "h"), "{found:?}");
    }
}
