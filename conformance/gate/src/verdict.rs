//! What an answer to a case is worth.

use super::plan::{CasePlace, GatePlan};
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_document::Number;
use lightmeter_document::gate::GateFailure;
use lightmeter_judge::formula::{by_name, units};
use lightmeter_judge::tally::Tally;
use lightmeter_judge::{Outcome, Verdict, judge};
use std::collections::BTreeMap;

/// The verdicts of a case together.
#[derive(Clone, Debug, Default)]
pub struct Verdicts {
    /// On its scalars; errors in ULP.
    pub tally: Tally<CasePlace, GateFailure>,
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
    fn new(plan: &GatePlan, formula: usize, case: usize, profile: &Profile) -> Self {
        let member = plan.member(formula);
        let outputs = member.spec.output_len();
        let inputs = plan.inputs(formula, case);
        let (mut reference, mut legal) = (vec![0.0; outputs], vec![Accept::ANY; outputs]);
        member.formula.reference(&inputs, &mut reference);
        member.formula.promised_interval(member.spec.kind, &inputs, profile, &mut legal);
        Self { inputs, reference, legal }
    }

    fn judge(&self, values: &[f32], place: CasePlace, is_random: bool) -> Verdicts {
        let mut verdicts = Verdicts::default();
        verdicts.tally.totals.cases = 1;
        for (k, value) in values.iter().enumerate() {
            let Verdict { outcome, error, margin } = judge(value.to_bits(), self.reference[k], &self.legal[k]);
            verdicts.tally.count(outcome, None, is_random);
            if outcome != Outcome::Indeterminate {
                verdicts.tally.see_error(error);
                verdicts.tally.see_margin(margin, place);
                if error.is_finite() {
                    verdicts.errors = (verdicts.errors.0 + error, verdicts.errors.1 + 1);
                }
            }
        }
        verdicts
    }
}

/// Judges the values that were answered to a case, as many as it has outputs; and its inputs.
#[must_use]
pub fn values(plan: &GatePlan, formula: usize, case: usize, values: &[f32], profile: &Profile) -> (Verdicts, Vec<f32>) {
    let expected = ExpectedCase::new(plan, formula, case, profile);
    let is_random = plan.formulas[formula].is_random(case);
    (expected.judge(values, CasePlace::Case { formula, case }, is_random), expected.inputs)
}

/// A case whose values are wrong.
#[must_use]
pub fn failure(plan: &GatePlan, formula: usize, case: usize, values: &[f32], profile: &Profile) -> GateFailure {
    let expected = ExpectedCase::new(plan, formula, case, profile);
    let (place, member) = (CasePlace::Case { formula, case }, plan.member(formula));
    let error = expected.judge(values, place, false).tally.error_max;
    let narrow = |numbers: &[f32]| numbers.iter().map(|&x| Number(x.into())).collect();
    GateFailure {
        id: plan.id(place),
        inputs: narrow(&expected.inputs),
        named: by_name(member, &expected.inputs, |x| serde_json::to_value(Number(x.into())).unwrap_or_default()),
        units: units(member),
        outputs: (0..values.len()).map(|k| member.spec.output_name(k)).collect(),
        reference: expected.reference.into_iter().map(Number).collect(),
        interval: expected.legal.iter().map(|legal| [Number(legal.low()), Number(legal.high())]).collect(),
        value: narrow(values),
        error_ulp: Number(error),
        problem: None,
    }
}

/// A case whose answer cannot be judged.
#[must_use]
pub fn unjudged(id: String, problem: String) -> GateFailure {
    GateFailure {
        id,
        inputs: vec![],
        named: serde_json::Map::new(),
        units: BTreeMap::new(),
        outputs: vec![],
        reference: vec![],
        interval: vec![],
        value: vec![],
        error_ulp: Number(f64::INFINITY),
        problem: Some(problem),
    }
}
