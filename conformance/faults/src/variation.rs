//! A formula with one mistake or two, in any arithmetic.

use super::alteration::At;
use super::blend;
use super::fault::{Concerned, Fault, Step};
use super::row::Arithmetic;
use lightmeter_arithmetic::mistaken::{Alteration, Mistaken, making};
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_catalogue::cases::{AnyFormula, Kind, Spec};
use lightmeter_catalogue::select::Member;

/// A formula with mistakes: the same source is the f32 implementation that makes them, its value in f64, and the interval of
/// what a renderer that makes them may legally answer.
pub struct Variation<'a> {
    pub(super) member: &'a Member,
    /// What the mistakes are.
    pub faults: Vec<&'static Fault>,
    parts: Parts,
    /// The formula that is evaluated where no body is wrong.
    formula: &'a dyn AnyFormula,
    /// Its kind, which another formula in its place may change.
    kind: Kind,
}

/// The parts of all mistakes by what they change.
#[derive(Default)]
struct Parts {
    before: Vec<super::change::Before>,
    at: Vec<&'static At>,
    blend: Vec<blend::Twist>,
    instead: Vec<&'static Member>,
    after: Vec<super::change::After>,
    sums_alpha: bool,
}

impl Parts {
    fn new(spec: &Spec, steps: impl Iterator<Item = &'static Step>) -> Self {
        let mut parts = Self::default();
        for step in steps {
            match step {
                Step::Before(before) => parts.before.push(*before),
                Step::At(at) => parts.at.push(at),
                Step::Blend(twist) => parts.blend.push(*twist),
                Step::Instead(_) | Step::Test(_) | Step::Naive => parts.instead.extend(step.instead(spec)),
                Step::After(after) => parts.after.push(*after),
                Step::AlphaSummed => parts.sums_alpha = true,
            }
        }
        // The first is made of what the next ones come to.
        parts.at.sort_by_key(|at| at.replaces());
        parts
    }

    /// Whether all of them can be made at once: one formula instead at most, no step wrong in two ways, and each part of a blend
    /// state still makes a difference after the others.
    fn fit_together(&self, spec: &Spec) -> bool {
        let at_once = usize::from(!self.blend.is_empty()) + self.instead.len() <= 1;
        let is_twice = |(place, at): (usize, &&At)| self.at[..place].iter().any(|other| other.collides(at));
        at_once
            && !self.at.iter().enumerate().any(is_twice)
            && (self.blend.is_empty() || blend::concerns(spec, &self.blend))
    }
}

/// Room for the inputs of any formula.
const MOST_INPUTS: usize = 80;
/// Room for its outputs.
const MOST_OUTPUTS: usize = 16;

impl<'a> Variation<'a> {
    /// The formula with mistakes that are known to concern it; `None` where they cannot be made together.
    pub(super) fn of(member: &'a Member, faults: &[Concerned]) -> Option<Self> {
        let spec = &member.spec;
        let parts = Parts::new(spec, faults.iter().flat_map(|concerned| concerned.way));
        if !parts.fit_together(spec) || spec.input_len() > MOST_INPUTS {
            return None;
        }
        let (mut formula, mut kind): (&dyn AnyFormula, _) = (&*member.formula, spec.kind);
        if let [other] = parts.instead[..] {
            (formula, kind) = (&*other.formula, other.spec.kind);
        }
        let faults = faults.iter().map(|concerned| concerned.fault).collect();
        Some(Self { member, faults, parts, formula, kind })
    }

    /// The formula without a mistake.
    pub(super) fn right(member: &'a Member) -> Self {
        let (formula, kind) = (&*member.formula, member.spec.kind);
        Self { member, faults: vec![], parts: Parts::default(), formula, kind }
    }

    /// The mistakes in words, as the end of a sentence.
    #[must_use]
    pub fn says(&self) -> String {
        self.faults.iter().map(|fault| fault.says).collect::<Vec<_>>().join(", and ")
    }

    /// The outputs for a row of inputs, in any arithmetic.
    pub fn evaluate<R: Arithmetic>(&self, inputs: &[f32], out: &mut [R]) {
        let mut row = [R::literal(0.0); MOST_INPUTS];
        for (wide, &narrow) in row.iter_mut().zip(inputs) {
            *wide = R::input(narrow);
        }
        self.evaluate_row(&mut row[..inputs.len().min(MOST_INPUTS)], out);
    }

    /// The same in f64, while something observes the steps.
    pub(super) fn observed(&self, observer: &'static dyn Alteration, inputs: &[f32], out: &mut [f64]) {
        let mut row: Vec<f64> = inputs.iter().map(|&x| x.into()).collect();
        self.evaluate_around(Some(observer), &mut row, out);
    }

    /// The same of a row that is changed already.
    pub(super) fn evaluate_row<R: Arithmetic>(&self, row: &mut [R], out: &mut [R]) {
        self.evaluate_around(None, row, out);
    }

    fn evaluate_around<R: Arithmetic>(&self, observer: Option<&'static dyn Alteration>, row: &mut [R], out: &mut [R]) {
        let (spec, parts) = (&self.member.spec, &self.parts);
        for before in &parts.before {
            before.apply(spec, row);
        }
        self.computed(observer, row, out);
        if parts.sums_alpha && out.len() == 4 {
            let (mut white, mut sum) = (row.to_vec(), [R::literal(0.0); 4]);
            let colors = spec.inputs.iter().filter(|input| input.unit == "color");
            for place in colors.filter_map(|input| spec.place(input.name)).flatten() {
                white[place] = R::literal(1.0);
            }
            self.computed(None, &white, &mut sum);
            out[3] = sum[0];
        }
        for after in &parts.after {
            after.apply(spec, row, out);
        }
    }

    /// The outputs for inputs that are changed already, before they are changed themselves.
    fn computed<R: Arithmetic>(&self, observer: Option<&'static dyn Alteration>, row: &[R], out: &mut [R]) {
        let (spec, parts) = (&self.member.spec, &self.parts);
        let is_blended = !parts.blend.is_empty() && blend::evaluate(spec, &parts.blend, row, out).is_some();
        if !is_blended {
            let zero = Mistaken(R::literal(0.0));
            let (mut inputs, mut outputs) = ([zero; MOST_INPUTS], [zero; MOST_OUTPUTS]);
            inputs.iter_mut().zip(row).for_each(|(to, &x)| *to = Mistaken(x));
            let alterations = parts.at.iter().map(|&at| at as &'static dyn Alteration);
            making(observer.into_iter().chain(alterations), || {
                R::evaluate(self.formula, &inputs[..row.len()], &mut outputs)
            });
            out.iter_mut().zip(outputs).for_each(|(to, x)| *to = x.0);
        }
    }

    /// What a renderer that makes the mistakes may legally answer. A rasteriser is given inputs that are changed in f32.
    pub fn interval(&self, inputs: &[f32], profile: &Profile, out: &mut [Accept]) {
        let spec = &self.member.spec;
        profile.scope(|| {
            let Kind::Raster(_) = self.kind else {
                self.evaluate(inputs, out);
                return;
            };
            let mut row = inputs.to_vec();
            for before in &self.parts.before {
                before.apply(spec, &mut row);
            }
            self.formula.promised_interval(self.kind, &row, profile, out);
            let row: Vec<Accept> = row.iter().map(|&x| lightmeter_reference::Real::input(x)).collect();
            for after in &self.parts.after {
                after.apply(spec, &row, out);
            }
        });
    }
}
