//! An earlier result, than which nothing may be worse.

use super::plan::Choice;
use super::report::{Group, Report};
use crate::image::file::whole;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Errors up to this are no worse than others: half a step, half a ULP.
const FLOOR: f64 = 0.5;

/// What a baseline must have: a gate's JSON has it.
#[derive(Debug, Deserialize)]
pub struct Baseline {
    schema: String,
    choice: Choice,
    generator: u64,
    profile: String,
    groups: Vec<Group>,
}

/// Why a baseline cannot be compared with, or written.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// It cannot be read.
    #[error("cannot read {}: {message}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// It is of other cases.
    #[error("{} is of other cases: {}", .path.display(), .differences.join("; "))]
    Others {
        /// The file.
        path: PathBuf,
        /// What differs.
        differences: Vec<String>,
    },
    /// It cannot be written.
    #[error("cannot write {}: {message}", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
}

impl Baseline {
    /// Reads a gate's JSON.
    ///
    /// # Errors
    /// Where it is none.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let failed = |message: String| Error::Read { path: path.into(), message };
        let text = std::fs::read_to_string(path).map_err(|error| failed(error.to_string()))?;
        let expected = "expected the JSON of `lightmeter gate --format json`, or of --update-baseline";
        let baseline: Self = serde_json::from_str(&text).map_err(|error| failed(format!("{error}; {expected}")))?;
        if baseline.schema == super::report::SCHEMA {
            Ok(baseline)
        } else {
            Err(failed(format!("its schema is `{}`; {expected}", baseline.schema)))
        }
    }

    /// What is worse in the report, beyond `factor` where it is an error.
    ///
    /// # Errors
    /// Where the cases are others.
    pub fn compare(&self, report: &Report, factor: f64, path: &Path) -> Result<Vec<String>, Error> {
        let mut differences = vec![];
        let mut differs = |what: &str, before: String, now: String| {
            if before != now {
                differences.push(format!("{what} {before} there, {now} here"));
            }
        };
        let (before, now) = (&self.choice, &report.choice);
        differs("filter", format!("{:?}", before.filter), format!("{:?}", now.filter));
        differs("cases", before.cases.to_string(), now.cases.to_string());
        differs("seed", before.seed.to_string(), now.seed.to_string());
        differs("size", format!("{:?}", before.size), format!("{:?}", now.size));
        differs("generator", self.generator.to_string(), report.generator.to_string());
        differs("profile", self.profile.clone(), report.profile.clone());
        if !differences.is_empty() {
            return Err(Error::Others { path: path.into(), differences });
        }
        let mut worse = vec![];
        for before in &self.groups {
            match report.groups.iter().find(|group| group.id == before.id) {
                None => worse.push(format!("{}: it is not among the cases any more", before.id)),
                Some(now) => worse.extend(compare(before, now, factor)),
            }
        }
        Ok(worse)
    }
}

fn compare(before: &Group, now: &Group, factor: f64) -> Vec<String> {
    let id = &now.id;
    let mut worse = vec![];
    if now.asked < before.asked {
        worse.push(format!("{id}: {} cases are asked, {} were: the renderer declares less", now.asked, before.asked));
    }
    for (what, before, now) in [
        ("fail", before.failed, now.failed),
        ("are skipped", before.skipped, now.skipped),
        ("are missing", before.missing, now.missing),
    ] {
        if now > before {
            worse.push(format!("{id}: {now} cases {what}, {before} did"));
        }
    }
    if now.indeterminate > before.indeterminate {
        worse.push(format!("{id}: {} verdicts permit anything, {} did", now.indeterminate, before.indeterminate));
    }
    let (was, is) = (before.error_max.0, now.error_max.0);
    // A NaN is worse than any number.
    let limit = factor * was.max(FLOOR);
    if crate::judge::is_worse(is, limit) {
        worse.push(format!(
            "{id}: errs by {} at most, by {} before: more than {factor} times that",
            now.error_max, before.error_max
        ));
    }
    worse
}

/// Writes a report as a baseline, whole or not at all.
///
/// # Errors
/// Where it cannot be written.
pub fn update(report: &Report, path: &Path) -> Result<(), Error> {
    let failed = |message: String| Error::Write { path: path.into(), message };
    let text = serde_json::to_string_pretty(report).map_err(|error| failed(error.to_string()))? + "\n";
    whole(path, text.as_bytes()).map_err(|error| failed(error.to_string()))
}
