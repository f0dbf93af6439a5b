//! What was found of a formula, and what of it does not hold.

use super::PER_CONDITION;
#[cfg(doc)]
use super::WELL_CONDITIONED;

/// A figure and the case that it is from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Worst {
    /// The greatest figure met.
    pub figure: f64,
    /// The output's name and the case's.
    pub at: String,
}

impl Worst {
    pub(super) fn raise(&mut self, figure: f64, at: impl FnOnce() -> String) {
        if figure > self.figure {
            *self = Self { figure, at: at() };
        }
    }

    fn merge(&mut self, other: &Self) {
        if other.figure > self.figure {
            self.clone_from(other);
        }
    }
}

/// What was found of a formula, or of a group of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FormulaFinding {
    /// The formula's id, or the group's.
    pub id: String,
    /// Formulas.
    pub formulas: u64,
    /// Cases.
    pub cases: u64,
    /// Values that were compared.
    pub compared: u64,
    /// Outputs that have no value, and the reference gives none.
    pub no_value: u64,
    /// Outputs that a step without a value leads to, though the reference comes to a number: max(NaN, 0) is 0.
    pub past_no_value: u64,
    /// Outputs on the way to which the reference exceeds what f64 holds.
    pub beyond_f64: u64,
    /// Values below f64's normal range, which keep fewer digits; their steps bound them.
    pub subnormal: u64,
    /// Cases in which the reference chose otherwise than is right, within the roundings of what it compared.
    pub ties: Vec<String>,
    /// Values that the reference has as 0, and 115 digits do not tell from 0.
    pub zeros: u64,
    /// Cases in which 115 digits do not tell two numbers apart; they are taken as equal.
    pub undecided: Vec<String>,
    /// Intervals that hold the exact value.
    pub intervals: u64,
    /// Intervals that permit anything.
    pub open: u64,
    /// The relative error where the condition is at most [`WELL_CONDITIONED`].
    pub well: Worst,
    /// The error over condition × [`PER_CONDITION`], elsewhere.
    pub ill: Worst,
    /// The error over what the steps' roundings come to.
    pub of_steps: Worst,
    /// Values that err by more than their condition allows, and by no more than their steps' roundings.
    pub by_steps: u64,
    /// The greatest relative error of those.
    pub by_steps_worst: Worst,
    /// The fewest digits that an exact value was known to.
    pub digits: Option<u32>,
    /// Whatever does not hold.
    pub broken: Vec<String>,
}

impl FormulaFinding {
    /// Adds what was found of another.
    pub fn merge(&mut self, other: &Self) {
        self.formulas += other.formulas;
        self.cases += other.cases;
        self.compared += other.compared;
        self.no_value += other.no_value;
        self.past_no_value += other.past_no_value;
        self.beyond_f64 += other.beyond_f64;
        self.subnormal += other.subnormal;
        self.intervals += other.intervals;
        self.open += other.open;
        self.by_steps += other.by_steps;
        self.zeros += other.zeros;
        for (mine, others) in
            [(&mut self.ties, &other.ties), (&mut self.undecided, &other.undecided), (&mut self.broken, &other.broken)]
        {
            mine.extend_from_slice(others);
        }
        for (mine, others) in [
            (&mut self.well, &other.well),
            (&mut self.ill, &other.ill),
            (&mut self.of_steps, &other.of_steps),
            (&mut self.by_steps_worst, &other.by_steps_worst),
        ] {
            mine.merge(others);
        }
        self.digits = self.digits.into_iter().chain(other.digits).min();
    }
}

/// Formulas of which some values err by more than their condition allows, and why.
pub struct Exception {
    /// What it is.
    pub reason: &'static str,
    /// Whether it is granted to a formula.
    pub covers: fn(&str) -> bool,
}

/// Nothing else may err by more than its condition allows, and each of these is still needed.
pub const EXCEPTIONS: [Exception; 9] = [
    Exception {
        reason: "a + 16·((b − a)/16) is b, but the steps are rounded at the size of a: what the formula is there to show",
        covers: |id| id == "interpolation/forward-differences",
    },
    Exception {
        reason: "1 − f of thin fog before a dark surface: f is rounded at the size of 1, and what is left is 1 − f",
        covers: |id| {
            let is_mixed = |rest: &str| rest.starts_with("exp") || rest == "linear";
            id.strip_prefix("fog/").is_some_and(is_mixed)
        },
    },
    Exception {
        reason: "naive forms lose in f64 too what their stable forms keep: 1 − f, 1 − (1 − α)ⁿ and 1 − α − β cancel",
        covers: |id| {
            ["fog/opacity", "blend/opacity-of-layers", "interpolation/last-weight-by-difference"].contains(&id)
        },
    },
    Exception {
        reason: "a scan line whose two ends nearly meet: xb − xa is little more than the rounding of both",
        covers: |id| id == "interpolation/scanline",
    },
    Exception {
        reason: "a distance beyond the planes is no depth: near·far over a difference that is the rounding of its terms",
        covers: |id| id.starts_with("depth/recovered"),
    },
    Exception {
        reason: "three points on a line but for a corner 1e-38 away: the exact area is what that leaves, and f64 has lost it",
        covers: |id| id == "interpolation/weights",
    },
    Exception {
        reason: "v + l of vectors that are nearly opposite, l·n of a face that the light grazes: more roundings than the nine that a unit of condition stands for",
        covers: |id| ["lighting/two-lights", "lighting/blinn", "lighting/flat"].contains(&id),
    },
    Exception {
        reason: "two points close to the origin beside a third that is not, a short vector beside a long one: products cancel that no input of their size moves",
        covers: |id| {
            let is_other_lighting = |rest: &str| !["two-lights", "blinn", "flat"].contains(&rest);
            id.strip_prefix("lighting/").is_some_and(is_other_lighting)
                || ["interpolation/edge", "interpolation/last-weight", "vector/face-normal"].contains(&id)
        },
    },
    Exception {
        reason: "s·d + d·(1 − s) is d, but both terms are rounded at the size of s·d", covers: terms_cancel
    },
];

/// Whether a state adds d for the source's factor and 1 − s for the destination's, or 1 − d and s: src·d + dst·(1 − s).
fn terms_cancel(id: &str) -> bool {
    const KINDS: [&str; 2] = ["color", "alpha"];
    let pairs = KINDS.into_iter().flat_map(|a| KINDS.into_iter().map(move |b| (a, b)));
    pairs.into_iter().any(|(a, b)| {
        // A state's own id, and its part of the id of two separate ones.
        ['/', '.'].into_iter().any(|to| {
            id.contains(&format!("add{to}dst-{a}{to}one-minus-src-{b}"))
                || id.contains(&format!("add{to}one-minus-dst-{a}{to}src-{b}"))
        })
    })
}

/// Digits to which an exact value must be known.
const DIGITS: u32 = 25;

/// Everything that does not hold, and how many formulas were tried.
#[must_use]
pub fn problems(findings: &[FormulaFinding]) -> Vec<String> {
    let mut problems: Vec<String> = findings.iter().flat_map(|finding| finding.broken.clone()).collect();
    for finding in findings {
        if finding.digits.is_some_and(|digits| digits < DIGITS) {
            problems.push(format!("{}: exact values to {:?} digits", finding.id, finding.digits));
        }
        if finding.by_steps > 0 && !EXCEPTIONS.iter().any(|exception| (exception.covers)(&finding.id)) {
            let Worst { figure, at } = &finding.by_steps_worst;
            problems.push(format!("{at}: errs by {figure:.2e} of itself, above condition × {PER_CONDITION:e}"));
        }
    }
    for exception in &EXCEPTIONS {
        if !findings.iter().any(|finding| finding.by_steps > 0 && (exception.covers)(&finding.id)) {
            problems.push(format!("an exception that is no longer needed: {}", exception.reason));
        }
    }
    problems
}
