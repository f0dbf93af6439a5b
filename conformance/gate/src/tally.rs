//! What became of the cases of a formula, or of a scene.

use super::picture::Found;
use super::plan::CasePlace;
use super::verdict::Verdicts;
use lightmeter_document::gate::GateFailure;
use lightmeter_document::run::Totals;
use lightmeter_faults::LEAST_VALUES;
use lightmeter_judge::tally::Tally;
use lightmeter_judge::{simplicity, worse};

/// Failing rows that are kept of each formula, for the diagnosis.
const KEPT_FAILING: usize = 2048;
/// Values that are kept of passing rows, for the group verdict. Half as many are left where the sample gets thinner.
const KEPT_PASSING: usize = 2 * LEAST_VALUES;
/// Reasons of skips that are kept.
const KEPT_REASONS: usize = 16;

/// Counts of cases, but for the verdicts, which are of scalars.
#[derive(Clone, Debug, Default)]
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
    /// Rows that fail and rows that do not, for the diagnosis.
    pub rows: [Sample; 2],
    /// The failing row with the simplest inputs, and how simple they are.
    pub smallest: Option<(u32, AnswerRow)>,
    /// Cases that were asked for and never answered.
    pub missing: u64,
    /// Failed cases whose answer could not be judged.
    pub unjudged: u64,
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
        Self { rows, ..Self::default() }
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

/// So many rows at most, evenly spread over all that came.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    cases: Vec<usize>,
    /// The rows' values, one after the other.
    values: Vec<f32>,
    outputs: usize,
    /// How many came.
    pub seen: usize,
    stride: usize,
    most: usize,
}

impl Sample {
    const fn new(outputs: usize, most: usize) -> Self {
        Self { cases: vec![], values: vec![], outputs, seen: 0, stride: 1, most }
    }

    /// The cases' places and what was answered to each.
    pub fn rows(&self) -> impl Iterator<Item = (usize, &[f32])> {
        self.cases.iter().copied().zip(self.values.chunks_exact(self.outputs.max(1)))
    }

    fn push(&mut self, case: usize, values: &[f32]) {
        if self.seen.is_multiple_of(self.stride) {
            if self.cases.len() == self.most {
                // Every other one.
                let kept = self.cases.len().div_ceil(2);
                for k in 0..kept {
                    self.cases[k] = self.cases[2 * k];
                    let from = 2 * k * self.outputs;
                    self.values.copy_within(from..from + self.outputs, k * self.outputs);
                }
                self.cases.truncate(kept);
                self.values.truncate(kept * self.outputs);
                self.stride *= 2;
            }
            if self.seen.is_multiple_of(self.stride) {
                self.cases.push(case);
                self.values.extend_from_slice(values);
            }
        }
        self.seen += 1;
    }
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
    pub(super) fn keep(&mut self, case: usize, values: &[f32], inputs: &[f32], has_failed: bool) {
        if has_failed {
            let simple = simplicity(inputs);
            if self.smallest.as_ref().is_none_or(|(least, row)| (simple, case) < (*least, row.case)) {
                self.smallest = Some((simple, AnswerRow { case, values: values.to_vec() }));
            }
        }
        self.rows[usize::from(!has_failed)].push(case, values);
    }

    /// Counts a skip.
    pub(super) fn skip(&mut self, reason: String) {
        self.skipped += 1;
        if !self.reasons.contains(&reason) && self.reasons.len() < KEPT_REASONS {
            self.reasons.push(reason);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_spread_over_all_that_came() {
        for count in [0, 5, 8, 9, 100, 12_345] {
            let mut sample = Sample::new(2, 8);
            let value = |case: usize| f32::from(u16::try_from(case).expect("it is small"));
            (0..count).for_each(|case| sample.push(case, &[value(case), -1.0]));
            let cases: Vec<usize> = sample.rows().map(|(case, _)| case).collect();
            assert_eq!(sample.seen, count);
            assert!(sample.rows().all(|(case, values)| values == [value(case), -1.0]));
            assert!(cases.len() == count.min(8) || (4..=8).contains(&cases.len()), "{cases:?}");
            assert!(cases.windows(2).all(|pair| pair[1] - pair[0] == sample.stride), "{cases:?}");
            assert!(cases.last().is_none_or(|last| last + sample.stride >= count), "{cases:?} of {count}");
        }
    }
}
