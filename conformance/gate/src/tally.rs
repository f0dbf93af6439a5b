//! What became of the cases of a formula, or of a scene.

use super::picture::Found;
use super::plan::CasePlace;
use super::verdict::Verdicts;
use lightmeter_document::gate::GateFailure;
use lightmeter_document::run::Totals;
use lightmeter_judge::formula::{KEPT_FAILING, KEPT_PASSING};
use lightmeter_judge::sample::Sample;
use lightmeter_judge::tally::Tally;
use lightmeter_judge::{telling, worse};

/// Reasons of skips that are kept.
const KEPT_REASONS: usize = 16;

/// Counts of cases, but for the verdicts, which are of scalars.
#[derive(Clone, Debug)]
pub struct AnswerTally {
    /// Verdicts on the cases that were answered with values or an image; errors in ULP of binary32, of a scene in its
    /// target's. Its failures are of cases, whether what was answered could be judged or not.
    pub verdicts: Tally<CasePlace, GateFailure>,
    /// Cases that were asked for.
    pub asked: u64,
    /// Cases that the renderer does not do.
    pub skipped: u64,
    /// Cases that failed: a value outside, an answer of a wrong form, an error.
    pub failed: u64,
    /// The largest error of a case that passes.
    pub error_passing: f64,
    /// The sum of the errors of cases that pass, and how many there are.
    pub errors: (f64, u64),
    /// Why cases were skipped, each reason once.
    pub reasons: Vec<String>,
    /// Rows that fail and rows that do not, for the diagnosis, by the places of their cases.
    pub rows: [Sample<usize>; 2],
    /// The failing row with the simplest inputs, and how simple they are.
    pub smallest: Option<(u32, AnswerRow)>,
    /// Cases that were asked for and never answered.
    pub missing: u64,
    /// Failed cases whose answer could not be judged.
    pub unjudged: u64,
    /// Cases at which the renderer ended or hung.
    pub broken: u64,
    /// Failed cases that are expected to.
    pub expected: u64,
    /// What explains the failures of a scene.
    pub diagnosis: Option<String>,
    /// Why nothing was asked of it.
    pub undeclared: Option<String>,
}

impl AnswerTally {
    /// Of a formula with that many outputs, before anything is answered.
    #[must_use]
    pub fn new(outputs: usize) -> Self {
        let outputs = outputs.max(1);
        let rows = [KEPT_FAILING, KEPT_PASSING / outputs].map(|most| Sample::new(outputs, most));
        Self {
            verdicts: Tally::default(),
            asked: 0,
            skipped: 0,
            failed: 0,
            error_passing: 0.0,
            errors: (0.0, 0),
            reasons: vec![],
            rows,
            smallest: None,
            missing: 0,
            unjudged: 0,
            broken: 0,
            expected: 0,
            diagnosis: None,
            undeclared: None,
        }
    }
}

/// A case and the values that were answered.
#[derive(Clone, Debug)]
pub struct AnswerRow {
    /// The case's place.
    pub case: usize,
    /// What was answered.
    pub values: Vec<f32>,
}

impl AnswerTally {
    /// Cases that were answered with values or an image.
    #[must_use]
    pub const fn answered(&self) -> u64 {
        self.verdicts.totals.cases
    }

    /// Counts an answer with values.
    pub(super) fn values(&mut self, verdicts: Verdicts) {
        let Verdicts { tally, errors } = verdicts;
        if tally.totals.failed > 0 {
            self.failed += 1;
        } else {
            self.error_passing = worse(self.error_passing, tally.error_max);
            self.errors = (self.errors.0 + errors.0, self.errors.1 + errors.1);
        }
        self.verdicts.add(tally);
    }

    /// Counts an answer with an image.
    pub(super) fn image(&mut self, place: CasePlace, found: &Found) {
        let Totals { verdicts, failed, indeterminate, .. } = found.totals;
        self.verdicts.totals.add(&Totals { cases: 1, verdicts, failed, indeterminate, ..Totals::default() });
        self.verdicts.see_error(found.error_max);
        self.verdicts.see_margin(found.margin_max, place);
        self.diagnosis.clone_from(&found.diagnosis);
        if failed > 0 {
            self.failed += 1;
        } else {
            self.error_passing = found.error_max;
        }
    }

    /// Keeps a row for the diagnosis.
    pub(super) fn keep(&mut self, case: usize, values: &[f32], inputs: &[f32], [is_random, has_failed]: [bool; 2]) {
        if has_failed {
            let simple = telling(inputs, is_random);
            if self.smallest.as_ref().is_none_or(|(least, row)| (simple, case) < (*least, row.case)) {
                self.smallest = Some((simple, AnswerRow { case, values: values.to_vec() }));
            }
        }
        self.rows[usize::from(!has_failed)].push(case, values.iter().copied());
    }

    /// Counts a skip.
    pub(super) fn skip(&mut self, reason: String) {
        self.skipped += 1;
        if !self.reasons.contains(&reason) && self.reasons.len() < KEPT_REASONS {
            self.reasons.push(reason);
        }
    }
}
