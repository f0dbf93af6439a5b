//! `lightmeter special`.

use super::clock::now;
use super::options::Format;
use super::progress::Bar;
use super::signals::{status_of, stopped_by_signals};
use super::visit::opened;
use super::{NothingToRun, Status, emit, foreign, writable};
use anyhow::Context as _;
use clap::Args;
use lightmeter::document::Document as _;
use lightmeter::document::special::SpecialReport;
use lightmeter::document::special::record::SpecialRecord;
use lightmeter::report::special;
use lightmeter::special::run::run;
use lightmeter::subject_gpu::code_of;
use std::path::{Path, PathBuf};

/// Show what becomes of NaN, infinity, subnormals and signed zero: what is promised, and what each adapter does.
#[derive(Debug, Args)]
pub(crate) struct Special {
    /// Adapter to probe, by its short name in `lightmeter adapters`; `all`. Again for several. Without it: lavapipe, or the
    /// first adapter there is
    #[arg(long, value_name = "NAME")]
    adapter: Vec<String>,
    /// Take the WGSL in this folder in place of the built-in files of the same names
    #[arg(long, value_name = "DIR")]
    shaders: Option<PathBuf>,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Write it to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Write what each adapter gave to a record of its own in this folder, as conformance/judge/records/special holds them
    #[arg(long, value_name = "DIR")]
    record: Option<PathBuf>,
}

impl Special {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        // Before anything is read: a signal ends each command in the same way.
        writable(self.out.as_deref())?;
        let stop = stopped_by_signals()?;
        if let Some(folder) = &self.shaders {
            foreign::accept(folder, &self.adapter, false)?;
        }
        let code = code_of(self.shaders.as_deref())?;
        let subjects = opened(&self.adapter)?;
        let mut bar = Bar::new(None, "adapters");
        let report = run(&subjects, &code, &stop, &mut bar);
        bar.bar.finish_and_clear();
        let report = SpecialReport { command: Some(super::command()), made_at: now(), ..report? };
        if report.outcomes.is_empty() && report.interrupted.is_none() {
            let message = "nothing could be probed: the embedded implementation has no shading language";
            return Err(NothingToRun(message.into()).into());
        }
        if let Some(dir) = &self.record {
            write_records(&report, dir)?;
        }
        let text = if self.format == Format::Json {
            report.to_json()?
        } else {
            let mut text = String::new();
            special::write(&report, &mut text)?;
            text
        };
        self.format.emit(&text, self.out.as_deref())?;
        Ok(match &report.interrupted {
            Some(interrupted) => status_of(interrupted),
            None if report.is_success() => Status::Success,
            None => Status::Failed,
        })
    }
}

fn write_records(report: &SpecialReport, dir: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(dir).with_context(|| format!("cannot make {}", dir.display()))?;
    for adapter in &report.adapters {
        emit(&SpecialRecord::of(report, adapter).to_json()?, Some(&dir.join(format!("{}.json", adapter.name))))?;
    }
    Ok(())
}
