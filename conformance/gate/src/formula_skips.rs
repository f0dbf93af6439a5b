//! Skips that a file of answers says of a formula as a whole, or of rows of its columns, whose cases have no ids.

use std::collections::{HashMap, HashSet};

/// A skip of a formula's cases, by a line such as `{"id": "fog/exp", "skip": "not built"}`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct FormulaSkip {
    /// The rows of the formula's columns; `None` for all cases that the file does not answer.
    pub(super) rows: Option<HashSet<usize>>,
    /// Why.
    pub(super) reason: String,
}

/// The skips of formulas, by the places of these in the plan.
#[derive(Default)]
pub(super) struct FormulaSkips(HashMap<usize, Vec<FormulaSkip>>);

impl FormulaSkips {
    /// Adds one.
    pub(super) fn add(&mut self, formula: usize, skip: FormulaSkip) {
        self.0.entry(formula).or_default().push(skip);
    }

    /// Why a row of a formula's columns is skipped; `None` where it is not.
    pub(super) fn of_row(&self, formula: usize, row: usize) -> Option<&str> {
        let has = |skip: &&FormulaSkip| skip.rows.as_ref().is_some_and(|rows| rows.contains(&row));
        self.0.get(&formula)?.iter().find(has).map(|skip| skip.reason.as_str())
    }

    /// Why all cases of a formula are skipped that are not answered; `None` where they are not.
    pub(super) fn of_all(&self, formula: usize) -> Option<&str> {
        self.0.get(&formula)?.iter().find(|skip| skip.rows.is_none()).map(|skip| skip.reason.as_str())
    }
}
