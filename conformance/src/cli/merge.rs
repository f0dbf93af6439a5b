//! `lightmeter merge`.

use super::options::Format;
use super::sweep::{status, written};
use super::{Status, emit};
use clap::Args;
use lightmeter::document::sweep::{ExactFloat, SweepDocument};
use lightmeter::sweep::file;
use std::path::PathBuf;

/// Join the results of a sweep's shards.
#[derive(Debug, Args)]
pub(crate) struct Merge {
    /// The JSON of each shard, by `lightmeter sweep … --shard I/N --format json`, or its finished checkpoint
    #[arg(required = true)]
    results: Vec<PathBuf>,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Write it to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Merge {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let mut parts = vec![];
        for path in &self.results {
            parts.push((path.clone(), file::read(path)?));
        }
        let whole = file::merge(&parts)?;
        emit(&written(&whole, self.format, &rerun(&whole))?, self.out.as_deref())?;
        Ok(status(&whole))
    }
}

/// What a command that sweeps one input again is given besides the formula and the range: all that the results tell, which is
/// everything but a folder of shaders.
fn rerun(document: &SweepDocument) -> String {
    let sweep = &document.sweep;
    let mut rerun = format!(" --over {} --output {} --adapter {}", sweep.over, sweep.output, sweep.adapter.name);
    for (name, ExactFloat(x)) in &sweep.fixed {
        rerun += &format!(" --set {name}=0x{:08x}", x.to_bits());
    }
    for (option, value, usual) in [("stage", &sweep.stage, "compute"), ("profile", &sweep.profile, "wgsl")] {
        if value != usual {
            rerun += &format!(" --{option} {value}");
        }
    }
    rerun
}
