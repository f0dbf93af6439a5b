//! Skips that a file of answers says of a formula as a whole, or of rows of its columns, whose cases have no ids.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// A skip of a formula's cases, by a line such as `{"id": "fog/exp", "skip": "not built"}`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct FormulaSkip {
    /// The rows of the formula's columns, as the line names them; `None` for all cases that the file does not answer.
    pub(super) rows: Option<Vec<usize>>,
    /// Why.
    pub(super) reason: String,
}

/// The skips of a formula, each with its reason among `reasons`.
#[derive(Default)]
struct Skipped {
    rows: HashMap<usize, usize>,
    /// That of all cases that are not answered.
    all: Option<usize>,
    reasons: Vec<String>,
}

/// The skips of formulas, by the places of these in the plan.
#[derive(Default)]
pub(super) struct FormulaSkips(HashMap<usize, Skipped>);

/// What a line skips that is skipped already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SkippedTwice {
    /// A row of columns.
    Row(usize),
    /// All cases of the formula that are not answered.
    All,
}

impl FormulaSkips {
    /// Adds one. What was skipped before stays as it was, and the first of that is told.
    pub(super) fn add(&mut self, formula: usize, skip: FormulaSkip) -> Result<(), SkippedTwice> {
        let skipped = self.0.entry(formula).or_default();
        let reason = skipped.reasons.len();
        skipped.reasons.push(skip.reason);
        let Some(rows) = skip.rows else {
            let is_first = skipped.all.is_none();
            skipped.all.get_or_insert(reason);
            return if is_first { Ok(()) } else { Err(SkippedTwice::All) };
        };
        let mut twice = None;
        for row in rows {
            match skipped.rows.entry(row) {
                Entry::Vacant(entry) => drop(entry.insert(reason)),
                Entry::Occupied(_) => drop(twice.get_or_insert(row)),
            }
        }
        twice.map_or(Ok(()), |row| Err(SkippedTwice::Row(row)))
    }

    /// Why a row of a formula's columns is skipped; `None` where it is not.
    pub(super) fn of_row(&self, formula: usize, row: usize) -> Option<&str> {
        let skipped = self.0.get(&formula)?;
        skipped.rows.get(&row).map(|&reason| skipped.reasons[reason].as_str())
    }

    /// Why all cases of a formula are skipped that are not answered; `None` where they are not.
    pub(super) fn of_all(&self, formula: usize) -> Option<&str> {
        let skipped = self.0.get(&formula)?;
        skipped.all.map(|reason| skipped.reasons[reason].as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_skipped_twice_is_told_and_the_first_reason_stays() {
        let mut skips = FormulaSkips::default();
        let skip = |rows: Option<&[usize]>, reason: &str| FormulaSkip {
            rows: rows.map(<[usize]>::to_vec),
            reason: reason.into(),
        };
        assert_eq!(skips.add(3, skip(Some(&[0, 17]), "a")), Ok(()));
        assert_eq!(skips.add(4, skip(Some(&[17]), "another formula's")), Ok(()));
        assert_eq!(skips.add(3, skip(Some(&[5, 5]), "b")), Err(SkippedTwice::Row(5)));
        assert_eq!(skips.add(3, skip(Some(&[6, 17]), "c")), Err(SkippedTwice::Row(17)));
        assert_eq!(skips.add(3, skip(None, "d")), Ok(()));
        assert_eq!(skips.add(3, skip(None, "e")), Err(SkippedTwice::All));
        let reasons = [0, 5, 6, 17, 18].map(|row| skips.of_row(3, row));
        assert_eq!(reasons, [Some("a"), Some("b"), Some("c"), Some("a"), None]);
        assert_eq!((skips.of_all(3), skips.of_all(4)), (Some("d"), None));
    }
}
