//! What each thing that a step is given does in it, found by changing it.

use crate::row::Arithmetic;
use lightmeter_arithmetic::Accept;
use lightmeter_arithmetic::mistaken::{Alteration, Mistaken, Taken, making};
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_reference::NamedStep;
use std::cell::RefCell;
use std::ops::Range;

/// A step, and what does what in it.
#[derive(Clone, Debug)]
pub(super) struct Probed {
    pub(super) step: &'static NamedStep,
    /// How many numbers it gives.
    pub(super) out: usize,
    /// What it is given, by the names of the step.
    pub(super) operands: Vec<Operand>,
}

/// What a step is given under a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Operand {
    pub(super) name: &'static str,
    /// How many numbers it has.
    pub(super) size: usize,
    /// Whether it is all that the step is given.
    pub(super) is_alone: bool,
    /// Whether the step reads it at all.
    pub(super) is_read: bool,
    /// Whether twice of it gives something else.
    is_moving: bool,
    /// Whether it is one number, or as many as the step gives, each of which enters that of its place alone.
    is_single: bool,
    /// Whether twice of it gives twice as much.
    is_scaling: bool,
    /// Whether the result is a straight line in it.
    is_linear: bool,
    /// Whether something is left where it is 0.
    is_added: bool,
}

impl Operand {
    /// Whether the step's result is a multiple of it.
    pub(super) const fn is_factor(self) -> bool {
        self.is_moving && self.is_single && self.is_scaling
    }

    /// Whether it is added to something else.
    pub(super) const fn is_term(self) -> bool {
        self.is_moving && self.is_single && self.is_linear && self.is_added && !self.is_scaling
    }

    /// What holds of it in one more case.
    const fn join(&mut self, other: Self) {
        self.is_read |= other.is_read;
        self.is_moving |= other.is_moving;
        self.is_single &= other.is_single;
        self.is_scaling &= other.is_scaling;
        self.is_linear &= other.is_linear;
        self.is_added |= other.is_added;
    }
}

/// Random cases in which steps are looked at.
const CASES: u64 = 32;

thread_local! {
    static SEEN: RefCell<Vec<Probed>> = const { RefCell::new(Vec::new()) };
}

#[derive(Debug)]
struct Prober;

impl Alteration for Prober {
    fn concerns(&self, _: &'static NamedStep) -> bool {
        true
    }

    fn on_f64(&self, taken: &mut Taken<'_, f64>) {
        let operands = operands(taken);
        let (step, out) = (taken.step, taken.out.len());
        SEEN.with_borrow_mut(|all| {
            let same = |probed: &&mut Probed| std::ptr::eq(probed.step, step) && probed.out == out;
            match all.iter_mut().find(same) {
                None => all.push(Probed { step, out, operands }),
                Some(probed) => probed.operands.iter_mut().zip(operands).for_each(|(known, now)| known.join(now)),
            }
        });
        taken.compute();
    }

    fn on_f32(&self, taken: &mut Taken<'_, f32>) {
        taken.compute();
    }

    fn on_accept(&self, taken: &mut Taken<'_, Accept>) {
        taken.compute();
    }
}

/// What a step is given in one case, and what each of it does there.
fn operands(taken: &mut Taken<'_, f64>) -> Vec<Operand> {
    let given = taken.from.to_vec();
    let right = computed(taken, &given);
    let mut start = 0;
    let mut operands = vec![];
    for (&name, &size) in taken.step.of.iter().zip(taken.sizes) {
        let range = start..start + size;
        start += size;
        let mut changed = |change: &dyn Fn(f64) -> f64, range: Range<usize>| {
            let mut from = given.clone();
            from[range].iter_mut().for_each(|x| *x = change(*x));
            computed(taken, &from)
        };
        let (twice, none) = (changed(&|x| 2.0 * x, range.clone()), changed(&|_| 0.0, range.clone()));
        // A vector's first number, of which the step's others may not depend.
        let first = changed(&|x| 2.0 * x + 0.25, range.start..range.start + size.min(1));
        let is_apart = || first.iter().zip(&right).skip(1).all(|(a, b)| a.to_bits() == b.to_bits());
        let pairs = || twice.iter().zip(&right);
        operands.push(Operand {
            name,
            size,
            is_alone: taken.sizes.len() == 1,
            is_read: [&twice, &none, &first].iter().any(|other| !is_same(other, &right)),
            is_moving: !is_same(&twice, &right),
            is_single: size == 1 || size == right.len() && is_apart(),
            is_scaling: pairs().all(|(twice, once)| is_near(*twice, 2.0 * once)),
            is_linear: pairs().zip(&none).all(|((twice, once), none)| is_near(twice - once, once - none)),
            is_added: none.iter().any(|x| *x != 0.0),
        });
    }
    taken.from.copy_from_slice(&given);
    operands
}

/// What the step gives of these numbers.
fn computed(taken: &mut Taken<'_, f64>, from: &[f64]) -> Vec<f64> {
    taken.from.copy_from_slice(from);
    taken.compute();
    taken.out.to_vec()
}

fn is_same(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

/// Whether two numbers are the same but for their rounding.
fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs()).max(1.0)
}

/// The steps that a formula takes in some case, and what does what in them.
pub(super) fn probed(member: &Member) -> Vec<Probed> {
    static PROBER: Prober = Prober;
    let (mut row, mut out) = (vec![], vec![Mistaken(0.0); member.spec.output_len()]);
    for case in (0..CASES).map(CaseRef::Random) {
        row.clear();
        member.inputs(case, 0, &mut row);
        let wide: Vec<Mistaken<f64>> = row.iter().map(|&x| Mistaken(x.into())).collect();
        let alterations = std::iter::once(&PROBER as &'static dyn Alteration);
        making(alterations, || f64::evaluate(&*member.formula, &wide, &mut out));
    }
    SEEN.with_borrow_mut(std::mem::take)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::formulas;

    #[test]
    fn factors_and_terms_are_told_apart() {
        let member =
            formulas().iter().find(|member| member.spec.id == "lighting/point-blinn").expect("it is a formula");
        let steps = probed(member);
        let operand = |step: &str, name: &str| {
            let step = steps.iter().find(|probed| probed.step.name == step).expect(step);
            *step.operands.iter().find(|operand| operand.name == name).expect(name)
        };
        for (step, name) in [("CD", "light"), ("CD", "material"), ("CD", "incidence"), ("CS", "fs"), ("CS", "atten")] {
            assert!(operand(step, name).is_factor() && !operand(step, name).is_term(), "{name} of {step}");
        }
        for name in ["ambient", "diffuse", "specular"] {
            assert!(operand("CF", name).is_term() && !operand("CF", name).is_factor(), "{name} of CF");
        }
        // An exponent of 0 changes nothing when it is doubled, which makes it no term.
        let cutoff = formulas().iter().find(|member| member.spec.id == "attenuation/spot-cutoff").expect("it is one");
        let mut given = probed(cutoff).into_iter().flat_map(|probed| probed.operands);
        assert!(!given.any(|operand| operand.name == "exponent" && (operand.is_term() || operand.is_factor())));
        assert!(!operand("CA", "atten").is_read && !operand("FS", "exponent").is_factor());
        assert!(!operand("l·n", "n").is_factor(), "a product of vectors is no multiple number by number");
    }
}
