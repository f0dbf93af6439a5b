//! The certificate of the f64 reference and of the intervals: every formula on random, hard and edge inputs against 115 digits.
//!
//! Of each output it is held that
//!
//! * the reference lies no farther from the exact value than the roundings of its own steps may have moved it
//!   ([`Running`]), which has no allowance that anyone chose;
//! * where its condition is at most 100 it errs by at most 1e-13 of the value, and by condition × 1e-15 of it elsewhere, the
//!   named [`EXCEPTIONS`] apart. The condition is that of the formula in its inputs, and a formula may be worse than that;
//! * its choices are the right ones, or lie within the roundings of what was compared, and are told;
//! * the interval of legal values holds the exact one, and of a blend state also those of a target of binary32 or binary16.

mod finding;
mod page;
mod rows;

pub use finding::{EXCEPTIONS, Exception, FormulaFinding, Worst, problems};
pub use page::{groups, page};

use crate::exact::{self, Exact};
use crate::running::{self, Running, TakenChoice};
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::arithmetic::{Accept, Dual, F16, F32, Format, Hardware};
use lightmeter::cases::blend::Samples;
use lightmeter::cases::{Formula, Kind, Reader, Spec, Visitor, Wanted, Writer, visit_all};
use lightmeter::select::{Member, catalogue};
use lightmeter_reference::Real;
use rayon::prelude::*;
use rows::rows;

/// Random cases of a formula on the page.
pub const CASES: u64 = 1024;
/// The greatest relative error where the condition is at most [`WELL_CONDITIONED`].
pub const WELL: f64 = 1e-13;
/// A hundred times [`PER_CONDITION`] is [`WELL`].
pub const WELL_CONDITIONED: f64 = 100.0;
/// The greatest relative error for each unit of condition: nine roundings.
pub const PER_CONDITION: f64 = 1e-15;

/// Whatever a formula is certified by: [`Exact`] and [`Running`] need its type.
trait Certify: Send + Sync {
    fn id(&self) -> String;
    fn row(&self, spec: &Spec, row: &[f32]) -> Evaluation;
}

/// One case in all arithmetics.
struct Evaluation {
    exact: Vec<Exact>,
    course: exact::Course,
    running: Vec<Running>,
    choices: Vec<TakenChoice>,
    /// Σ|xᵢ·∂y/∂xᵢ| of each output.
    moved: Vec<f64>,
    /// Of a blend state, what is legal on a target of binary32; else nothing.
    on_f32: Vec<Accept<Hardware<F32>>>,
    /// The same of binary16.
    on_f16: Vec<Accept<Hardware<F16>>>,
}

impl<F: Formula> Certify for F {
    fn id(&self) -> String {
        Formula::spec(self).id
    }

    fn row(&self, spec: &Spec, row: &[f32]) -> Evaluation {
        let outputs = spec.output_len();
        exact::clear();
        let exact = evaluate(self, row.iter().map(|&x| Exact::input(x)), outputs);
        let course = exact::course();
        let _ = running::take_choices();
        let running = evaluate(self, row.iter().map(|&x| Running::input(x)), outputs);
        let choices = running::take_choices();
        let mut moved = vec![0.0; outputs];
        for at in (0..row.len()).filter(|&at| row[at] != 0.0) {
            let variable = |(k, &x): (usize, &f32)| if k == at { Dual::variable(x.into()) } else { Dual::input(x) };
            for (moved, out) in moved.iter_mut().zip(evaluate(self, row.iter().enumerate().map(variable), outputs)) {
                *moved += (f64::from(row[at]) * out.slope).abs();
            }
        }
        let (mut on_f32, mut on_f16) = (vec![], vec![]);
        if matches!(spec.kind, Kind::Blend(_)) {
            on_f32 = WGSL.scope(|| evaluate(self, row.iter().map(|&x| Accept::input(x)), outputs));
            on_f16 = WGSL.scope(|| evaluate(self, row.iter().map(|&x| Accept::input(x)), outputs));
        }
        Evaluation { exact, course, running, choices, moved, on_f32, on_f16 }
    }
}

fn evaluate<F: Formula, R: Real>(formula: &F, inputs: impl Iterator<Item = R>, outputs: usize) -> Vec<R> {
    let (inputs, mut out): (Vec<R>, _) = (inputs.collect(), vec![R::literal(0.0); outputs]);
    formula.evaluate(&Reader::new(&inputs), &mut Writer::new(&mut out, Wanted::ALL));
    out
}

/// Certifies every formula of the catalogue, each on a number of random cases and on all hard and edge inputs.
///
/// # Panics
/// Where the catalogue and the formulas that a visitor is shown are not the same.
#[must_use]
pub fn certify(cases: u64) -> Vec<FormulaFinding> {
    struct Collect(Vec<Box<dyn Certify>>);
    impl Visitor for Collect {
        fn formula<F: Formula>(&mut self, formula: F) {
            self.0.push(Box::new(formula));
        }
    }
    let mut formulas = Collect(vec![]);
    visit_all(&Samples::default(), &mut formulas);
    let members = catalogue();
    assert_eq!(members.len(), formulas.0.len(), "a visitor is shown every formula of the catalogue");
    formulas.0.par_iter().zip(&members).map(|(formula, member)| of(formula.as_ref(), member, cases)).collect()
}

/// Certifies one formula, of the catalogue or not.
#[must_use]
pub fn certify_one<F: Formula + Copy>(formula: F, cases: u64) -> FormulaFinding {
    let member = Member::new(Box::new(formula));
    of(&formula, &member, cases)
}

fn of(formula: &dyn Certify, member: &Member, cases: u64) -> FormulaFinding {
    let spec = &member.spec;
    assert_eq!(formula.id(), spec.id, "a visitor is shown the catalogue in its order");
    let mut finding = FormulaFinding { id: spec.id.clone(), formulas: 1, ..FormulaFinding::default() };
    for row in rows(member, cases) {
        finding.case(member, &row, &formula.row(spec, &row.inputs));
    }
    finding
}

/// How the reference's choices compare with the exact ones.
#[derive(PartialEq)]
enum Choices {
    Alike,
    /// The first that differs lies within the roundings of what was compared.
    Tied,
    Differ,
}

fn choices(evaluation: &Evaluation) -> Choices {
    let (course, choices) = (&evaluation.course, &evaluation.choices);
    match course.choices.iter().zip(choices).position(|(exact, choice)| *exact != choice.taken) {
        None if course.choices.len() == choices.len() => Choices::Alike,
        Some(at) if choices[at].is_close => Choices::Tied,
        _ => Choices::Differ,
    }
}

impl FormulaFinding {
    fn case(&mut self, member: &Member, row: &rows::Row, evaluation: &Evaluation) {
        let spec = &member.spec;
        let outputs = spec.output_len();
        let mut reference = vec![0.0; outputs];
        member.formula.reference(&row.inputs, &mut reference);
        let mut legal = vec![Accept::ANY; outputs];
        member.formula.promised_interval(spec.kind, &row.inputs, &WGSL, &mut legal);
        self.cases += 1;
        let choices = choices(evaluation);
        // Beside an output without a value the choices on the way to it have no right side.
        let has_values = evaluation.exact.iter().all(|exact| exact.get().is_some());
        if has_values {
            if !evaluation.course.undecided.is_empty() {
                self.undecided.push(row.name.clone());
            }
            match choices {
                Choices::Alike => {}
                Choices::Tied => self.ties.push(row.name.clone()),
                Choices::Differ => self.broken.push(format!("{}: chooses otherwise than is right", row.name)),
            }
        }
        for (output, &value) in reference.iter().enumerate() {
            let at = || format!("{} of {}", spec.output_name(output), row.name);
            let (exact, running) = (evaluation.exact[output], &evaluation.running[output]);
            if running.value.to_bits() != value.to_bits() && !(running.value.is_nan() && value.is_nan()) {
                self.broken.push(format!("{}: {value:e} by f64, {:e} with its bound", at(), running.value));
            }
            if exact.get().is_none() {
                let count = if value.is_finite() { &mut self.past_no_value } else { &mut self.no_value };
                *count += 1;
                continue;
            }
            self.interval(exact, &legal[output], at);
            evaluation.on_f32.get(output).into_iter().for_each(|legal| self.interval(exact, legal, at));
            evaluation.on_f16.get(output).into_iter().for_each(|legal| self.interval(exact, legal, at));
            if choices == Choices::Alike || !has_values {
                let is_beyond = evaluation.course.beyond_f64 && !running.error.is_finite();
                self.beyond_f64 += u64::from(is_beyond);
                if !is_beyond {
                    self.output(exact, running, evaluation.moved[output], at);
                }
            }
        }
    }

    fn interval<F: Format>(&mut self, exact: Exact, legal: &Accept<F>, at: impl FnOnce() -> String) {
        if legal.is_any() {
            self.open += 1;
        } else if exact.lies_within(legal.low(), legal.high()) {
            self.intervals += 1;
        } else {
            self.broken.push(format!("{}: {:?} outside {legal:?}", at(), exact.get()));
        }
    }

    /// `moved` is Σ|xᵢ·∂y/∂xᵢ|: how far the value moves if all inputs do by their own size.
    fn output(&mut self, exact: Exact, running: &Running, moved: f64, at: impl Fn() -> String) {
        self.compared += 1;
        if running.value.is_infinite() && running.error.is_infinite() && exact.get().is_some() {
            // A divisor that cancelled to 0: its own roundings leave everything open.
            self.by_steps += 1;
            self.by_steps_worst.raise(f64::INFINITY, &at);
            return;
        }
        if running.value == 0.0 && exact.is_not_told_from_zero() {
            self.zeros += 1;
            return;
        }
        let Some((error, relative)) = exact.distance(running.value) else {
            self.broken.push(format!("{}: {:e} where {:?} is right", at(), running.value, exact.get()));
            return;
        };
        if error == 0.0 {
            return;
        }
        let size = error / relative;
        self.digits = self.digits.into_iter().chain(exact.digits_beside(size.max(moved))).min();
        self.of_steps.raise(error / running.error, &at);
        if error > running.error || !running.error.is_finite() {
            let (value, bound) = (running.value, running.error);
            self.broken.push(format!("{}: {value:e} errs by {error:e}, its steps by {bound:e} at most", at()));
        }
        if size.max(moved) < f64::MIN_POSITIVE {
            self.subnormal += 1;
            return;
        }
        let is_held = if moved / size <= WELL_CONDITIONED {
            self.well.raise(relative, &at);
            relative <= WELL
        } else {
            self.ill.raise(error / (moved * PER_CONDITION), &at);
            error <= moved * PER_CONDITION
        };
        if !is_held {
            self.by_steps += 1;
            self.by_steps_worst.raise(relative, &at);
        }
    }
}
