//! What a result is held against: known failures, and an earlier result. The same for `run` and `gate`.

use super::say;
use anyhow::bail;
use clap::Args;
use lightmeter::document::report::Report;
use lightmeter::gate::baseline::{self, Baseline, BaselineError, Standard, Subjects};
use lightmeter::gate::expectations::Expectations;
use lightmeter::gate::plan::unmatched;
use std::path::{Path, PathBuf};

/// What a result is held against.
#[derive(Clone, Debug, Args)]
pub(crate) struct Comparison {
    /// Known failures with their reasons, a TOML file
    #[arg(long, value_name = "FILE")]
    expect: Option<PathBuf>,
    /// An earlier result, than which nothing may be worse
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// By how much an error may grow against the baseline
    #[arg(long, value_name = "FACTOR", default_value_t = 2.0, requires = "baseline", value_parser = factor)]
    growth: f64,
    /// Compare with a baseline of another adapter or renderer, formula by formula
    #[arg(long, requires = "baseline")]
    across: bool,
    /// Write the result to the baseline's file instead of comparing with it
    #[arg(long, requires = "baseline")]
    update_baseline: bool,
}

impl Comparison {
    /// The files of known failures and of the earlier result.
    pub(crate) fn files(&self) -> [Option<&Path>; 2] {
        [self.expect.as_deref(), self.baseline.as_deref()]
    }
}

fn factor(text: &str) -> Result<f64, String> {
    let factor: f64 = text.parse().map_err(|_| "expected a factor, such as 1.5".to_owned())?;
    if factor >= 1.0 && factor.is_finite() { Ok(factor) } else { Err("expected a factor of 1 or more".into()) }
}

/// An earlier result, and where it lies.
pub(crate) struct Earlier {
    pub(crate) path: PathBuf,
    pub(crate) baseline: Baseline,
    growth: f64,
    across: bool,
}

impl Earlier {
    /// What is worse now.
    pub(crate) fn compare(&self, now: &Standard, is_shard: bool) -> Result<Vec<String>, BaselineError> {
        self.baseline.compare(now, self.growth, (is_shard, self.across), &self.path)
    }

    /// Checks, before anything is judged, that it is of those who are.
    pub(crate) fn is_by(&self, now: &Subjects) -> Result<(), BaselineError> {
        self.baseline.is_by(now, self.across, &self.path)
    }

    /// What is better now, and what is new.
    pub(crate) fn progress(&self, now: &Standard) -> (Vec<String>, Vec<String>) {
        self.baseline.progress(now, self.across)
    }
}

impl Comparison {
    /// The known failures.
    pub(crate) fn expectations(&self) -> anyhow::Result<Expectations> {
        Ok(self.expect.as_deref().map(Expectations::read).transpose()?.unwrap_or_default())
    }

    /// The earlier result, of a renderer that is asked or of a run; `None` where there is none to compare with.
    pub(crate) fn earlier(&self, is_asked: bool) -> Result<Option<Earlier>, BaselineError> {
        let path = self.baseline.as_ref().filter(|_| !self.update_baseline);
        let earlier = |path: &PathBuf| {
            Ok(Earlier {
                path: path.clone(),
                baseline: Baseline::read(path, is_asked)?,
                growth: self.growth,
                across: self.across,
            })
        };
        path.map(earlier).transpose()
    }

    /// Writes the result as the baseline, where that is asked for.
    pub(crate) fn update(&self, report: &Report) -> Result<(), BaselineError> {
        let Some(path) = self.baseline.as_ref().filter(|_| self.update_baseline) else { return Ok(()) };
        match baseline::update(report, path) {
            Ok(true) => say(&format!("the baseline {} is this result now", path.display())),
            Ok(false) => say(&format!("the baseline {} is this result already, and stays as it is", path.display())),
            // The result itself says how the command ends.
            Err(error @ BaselineError::Unfit { .. }) => say(&format!("{error}")),
            Err(error) => return Err(error),
        }
        Ok(())
    }
}

/// An expectation of what no renderer is ever asked is a mistake in its file.
pub(crate) fn matches_something(expectations: &Expectations) -> anyhow::Result<()> {
    match unmatched(expectations.ids()) {
        Some(id) => bail!("the expectation `{id}` matches no case of any formula and no scene: see `lightmeter list`"),
        None => Ok(()),
    }
}
