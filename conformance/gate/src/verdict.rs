//! What an answer to a case is worth.

use super::plan::{Place, Plan};
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_document::Number;
use lightmeter_document::gate::GateFailure;
use lightmeter_judge::{Outcome, Verdict, judge, worse};

/// The verdicts of a case together.
#[derive(Clone, Copy, Debug, Default)]
pub struct Verdicts {
    /// Scalars judged.
    pub all: u64,
    /// Of them, those outside of what is legal.
    pub failed: u64,
    /// Of them, those where anything is legal.
    pub indeterminate: u64,
    /// The largest error in ULP, where something is promised.
    pub error: f64,
    /// The largest margin.
    pub margin: f64,
    /// The sum of the finite errors, and how many there are.
    pub errors: (f64, u64),
}

/// The reference and what is legal, of a case.
struct ExpectedCase {
    inputs: Vec<f32>,
    reference: Vec<f64>,
    legal: Vec<Accept>,
}

impl ExpectedCase {
    fn new(plan: &Plan, formula: usize, case: usize, profile: &Profile) -> Self {
        let member = plan.member(formula);
        let outputs = member.spec.output_len();
        let inputs = plan.inputs(formula, case);
        let (mut reference, mut legal) = (vec![0.0; outputs], vec![Accept::ANY; outputs]);
        member.formula.reference(&inputs, &mut reference);
        member.formula.promised_interval(member.spec.kind, &inputs, profile, &mut legal);
        Self { inputs, reference, legal }
    }

    fn judge(&self, values: &[f32]) -> Verdicts {
        let mut all = Verdicts::default();
        for (k, value) in values.iter().enumerate() {
            let Verdict { outcome, error: error_ulp, margin } =
                judge(value.to_bits(), self.reference[k], &self.legal[k]);
            all.all += 1;
            match outcome {
                Outcome::Indeterminate => all.indeterminate += 1,
                Outcome::Fail => all.failed += 1,
                Outcome::Pass => {}
            }
            if outcome != Outcome::Indeterminate {
                all.error = worse(all.error, error_ulp);
                all.margin = worse(all.margin, margin);
                if error_ulp.is_finite() {
                    all.errors = (all.errors.0 + error_ulp, all.errors.1 + 1);
                }
            }
        }
        all
    }
}

/// Judges the values that were answered to a case, as many as it has outputs; and its inputs.
#[must_use]
pub fn values(plan: &Plan, formula: usize, case: usize, values: &[f32], profile: &Profile) -> (Verdicts, Vec<f32>) {
    let expected = ExpectedCase::new(plan, formula, case, profile);
    (expected.judge(values), expected.inputs)
}

/// A case whose values are wrong.
#[must_use]
pub fn failure(plan: &Plan, formula: usize, case: usize, values: &[f32], profile: &Profile) -> GateFailure {
    let expected = ExpectedCase::new(plan, formula, case, profile);
    let error = expected.judge(values).error;
    let narrow = |numbers: &[f32]| numbers.iter().map(|&x| Number(x.into())).collect();
    GateFailure {
        id: plan.id(Place::Case { formula, case }),
        inputs: narrow(&expected.inputs),
        reference: expected.reference.into_iter().map(Number).collect(),
        interval: expected.legal.iter().map(|legal| [Number(legal.low()), Number(legal.high())]).collect(),
        value: narrow(values),
        error_ulp: Number(error),
        problem: None,
    }
}

/// A case whose answer cannot be judged.
#[must_use]
pub const fn unjudged(id: String, problem: String) -> GateFailure {
    GateFailure {
        id,
        inputs: vec![],
        reference: vec![],
        interval: vec![],
        value: vec![],
        error_ulp: Number(f64::INFINITY),
        problem: Some(problem),
    }
}
