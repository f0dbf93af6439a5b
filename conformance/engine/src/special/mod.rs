//! The probes of special values on adapters: what each gives, what is on record for its driver, and the verdicts.

pub mod run;
pub mod verdict;
