//! What the diagnosis of a group's rows says: of a run's own, and of those that shards kept.

use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::cases::Stage;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::report::{Diagnosis, OtherFormulas};
use lightmeter_judge::diagnose::{Diagnose, Told};
use lightmeter_judge::formula::RowSample;
use lightmeter_judge::kept::KeptRow;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// Failing formulas of a group that are diagnosed: those that fail most often.
const MOST_DIAGNOSED: usize = 16;

/// Rows of a group in a stage of a subject.
pub(crate) struct GroupRows<'a> {
    pub(crate) members: &'a [&'a Member],
    pub(crate) stage: Stage,
    /// How many rows of each formula fail.
    pub(crate) failing: &'a BTreeMap<usize, u64>,
    /// Some of them.
    pub(crate) wrong: &'a RowSample,
    /// Some of the others.
    pub(crate) right: &'a RowSample,
}

impl GroupRows<'_> {
    /// The mistake that explains the failing rows; if none does, the systematic error that all rows show together. In a group of several
    /// formulas, those that fail most often are diagnosed one by one, and the mistake that explains most of them is told. `granted` is what is
    /// legal on the subject with all that is known of it.
    pub(crate) fn told(&self, diagnose: Option<&dyn Diagnose>, granted: &Profile) -> Told {
        let (members, wrong, right) = (self.members, self.wrong.rows(), self.right.rows());
        let Some(diagnose) = diagnose else { return Told::default() };
        // A rasteriser or a depth test has no parameters that could be slightly off, so a systematic error is only looked for in shaders.
        if wrong.is_empty() && (members.len() > 1 || !is_shader(self.stage)) {
            return Told::default();
        }
        let mut failing: Vec<(usize, u64)> = self.failing.iter().map(|(member, count)| (*member, *count)).collect();
        failing.sort_unstable_by_key(|(member, count)| (Reverse(*count), *member));
        let told_of = |(place, count): (usize, u64)| {
            let member = members[place];
            let rows = [&wrong, &right].map(|rows| of_member(place, rows));
            Told::of(diagnose, member, [&rows[0], &rows[1]], count, granted)
        };
        if members.len() == 1 || failing.is_empty() {
            return told_of(failing.first().copied().unwrap_or_default());
        }
        failing.truncate(MOST_DIAGNOSED);
        let mut found: Vec<Diagnosis> = failing.iter().map(|of| told_of(*of).diagnosis.unwrap_or_default()).collect();
        let alike = |one: &Diagnosis| {
            let same = found.iter().filter(|other| !one.mistakes().is_empty() && other.mistakes() == one.mistakes());
            same.count()
        };
        // Of those that explain as many, the first: it fails most often.
        let shared: Vec<usize> = found.iter().map(alike).collect();
        let best = (0..found.len()).max_by_key(|&place| (shared[place], Reverse(place))).unwrap_or_default();
        let others = OtherFormulas { explained: shared[best].saturating_sub(1) as u64, of: shared.len() as u64 - 1 };
        let diagnosis = Diagnosis {
            formula: Some(members[failing[best].0].spec.id.clone()),
            others: (shared[best] > 0 && shared.len() > 1).then_some(others),
            ..found.swap_remove(best)
        };
        Told { diagnosis: Some(diagnosis), ..Told::default() }
    }
}

/// Whether a stage evaluates formulas by a shading language, or as one.
pub(crate) const fn is_shader(stage: Stage) -> bool {
    matches!(stage, Stage::Compute | Stage::Fragment | Stage::Answer)
}

/// The rows of one formula, by its place among the group's.
fn of_member<'a>(place: usize, rows: &[((usize, CaseRef), &'a KeptRow)]) -> Vec<(CaseRef, &'a KeptRow)> {
    rows.iter().filter(|((of, _), _)| *of == place).map(|((_, case), row)| (*case, *row)).collect()
}
