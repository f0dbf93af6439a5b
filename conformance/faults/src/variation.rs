//! A formula with one mistake or two, in any arithmetic.

use super::blend;
use super::body;
use super::fault::{Fault, Step};
use super::fog;
use super::lighting;
use super::row::Arithmetic;
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

/// The steps of all mistakes by what they change.
#[derive(Default)]
struct Parts {
    before: Vec<super::change::Before>,
    lighting: Vec<lighting::Twist>,
    fog: Vec<fog::Twist>,
    blend: Vec<blend::Twist>,
    bodies: Vec<body::Body>,
    instead: Vec<&'static Member>,
    after: Vec<super::change::After>,
}

impl Parts {
    fn new(spec: &Spec, steps: impl Iterator<Item = Step>) -> Self {
        let mut parts = Self::default();
        for step in steps {
            match step {
                Step::Before(before) => parts.before.push(before),
                Step::Lighting(twist) => parts.lighting.push(twist),
                Step::Fog(twist) => parts.fog.push(twist),
                Step::Blend(twist) => parts.blend.push(twist),
                Step::Body(body) => parts.bodies.push(body),
                Step::Instead(_) | Step::Naive => parts.instead.extend(step.instead(spec)),
                Step::After(after) => parts.after.push(after),
            }
        }
        parts
    }

    /// Whether all of them can be made at once: one body at most, and each step still makes a difference after the others.
    fn fit_together(&self, spec: &Spec) -> bool {
        let twisted = usize::from(!self.lighting.is_empty())
            + usize::from(!self.fog.is_empty())
            + usize::from(!self.blend.is_empty());
        let at_once = twisted + self.bodies.len() + self.instead.len() <= 1;
        at_once
            && (self.lighting.is_empty() || lighting::concerns(spec, &self.lighting))
            && (self.fog.is_empty() || fog::concerns(spec, &self.fog))
            && (self.blend.is_empty() || blend::concerns(spec, &self.blend))
    }
}

/// Room for the inputs of any formula.
const MOST_INPUTS: usize = 80;

impl<'a> Variation<'a> {
    /// The formula with these mistakes; `None` where one does not concern it, or they cannot be made together.
    #[must_use]
    pub fn new(member: &'a Member, faults: &[&'static Fault]) -> Option<Self> {
        let spec = &member.spec;
        let mut steps = vec![];
        for fault in faults {
            steps.extend_from_slice(fault.steps(spec)?);
        }
        let parts = Parts::new(spec, steps.into_iter());
        if !parts.fit_together(spec) || spec.input_len() > MOST_INPUTS {
            return None;
        }
        let (mut formula, mut kind): (&dyn AnyFormula, _) = (&*member.formula, spec.kind);
        if let [other] = parts.instead[..] {
            (formula, kind) = (&*other.formula, other.spec.kind);
        }
        Some(Self { member, faults: faults.to_vec(), parts, formula, kind })
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

    /// The same of a row that is changed already.
    pub(super) fn evaluate_row<R: Arithmetic>(&self, row: &mut [R], out: &mut [R]) {
        let (spec, parts) = (&self.member.spec, &self.parts);
        for before in &parts.before {
            before.apply(spec, row);
        }
        let wrong = if !parts.lighting.is_empty() {
            lighting::evaluate(spec, &parts.lighting, row, out)
        } else if !parts.fog.is_empty() {
            fog::evaluate(spec, &parts.fog, row, out)
        } else if !parts.blend.is_empty() {
            blend::evaluate(spec, &parts.blend, row, out)
        } else if let Some(&body) = parts.bodies.first() {
            body::evaluate(spec, body, row, out)
        } else {
            None
        };
        if wrong.is_none() {
            R::evaluate(self.formula, row, out);
        }
        for after in &parts.after {
            after.apply(spec, out);
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
            for after in &self.parts.after {
                after.apply(spec, out);
            }
        });
    }
}
