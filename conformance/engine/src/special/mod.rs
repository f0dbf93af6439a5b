//! The probes of special values on adapters: what each gives, what is on record for its driver, and the verdicts; and on renderers that
//! are asked case by case.

pub(crate) mod asked;
pub mod run;
pub mod verdict;
