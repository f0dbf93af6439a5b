//! `lightmeter merge`.

use super::clock::now;
use super::options::{PageFormat, ReportFormat, Required};
use super::sweep::{status, written};
use super::terminal::level;
use super::{Status, command};
use anyhow::{Context as _, bail};
use clap::Args;
use lightmeter::arithmetic::Profile;
use lightmeter::document::report::Report;
use lightmeter::document::sweep::{ExactFloat, SweepDocument};
use lightmeter::document::{Document as _, is_of};
use lightmeter::faults::{Mistakes, explain};
use lightmeter::files::{read, shown};
use lightmeter::merge::merge;
use lightmeter::report::text;
use lightmeter::sweep::file;
use std::path::{Path, PathBuf};

/// Join the results of the shards of a run, of a gate or of a sweep.
#[derive(Debug, Args)]
pub(crate) struct Merge {
    /// The JSON of each shard, by `lightmeter run … --shard I/N --format json`, or by `gate` or `sweep`, or a sweep's finished checkpoint
    #[arg(required = true)]
    results: Vec<PathBuf>,
    #[command(flatten)]
    required: Required,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: ReportFormat,
    /// Write it to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Merge {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        if let Some(status) = self.of_runs()? {
            return Ok(status);
        }
        let mut parts = vec![];
        for path in &self.results {
            parts.push((path.clone(), file::read(path)?));
        }
        let whole = SweepDocument { command: Some(command()), made_at: now(), ..file::merge(&parts)? };
        self.format.emit(&written(&whole, self.of_sweep()?, &rerun(&whole))?, self.out.as_deref())?;
        Ok(status(&whole))
    }
}

impl Merge {
    /// Joins the shards of a run or of a gate; `None` where the first file is one of a sweep.
    fn of_runs(&self) -> anyhow::Result<Option<Status>> {
        let Some(first) = self.results.first() else { return Ok(None) };
        let schema = schema(first)?;
        if is_of::<SweepDocument>(&schema) {
            return Ok(None);
        }
        if !is_of::<Report>(&schema) {
            bail!(
                "{}: {}; expected the JSON that `run`, `gate` or `sweep` writes with --shard I/N and --format json",
                first.display(),
                if schema.is_empty() { "it is no result".to_owned() } else { format!("its schema is `{schema}`") }
            );
        }
        let mut parts = vec![];
        for path in &self.results {
            let failed = || format!("cannot read {}", path.display());
            let text = read::text(path, read::MOST_TEXT).with_context(failed)?;
            parts.push((path.clone(), Report::read(&text).with_context(failed)?));
        }
        let whole = merge(parts, &Mistakes)?;
        // What explains the first failing or the worst case of each formula: of the whole, which may be another one than a shard's.
        let explained = Profile::by_name(&whole.profile).map_or_else(Vec::new, |profile| explain(&whole, profile));
        let whole = Report {
            command: Some(command()),
            made_at: now(),
            explained,
            required: Some(self.required.part()),
            ..whole
        };
        let style = text::Style { level: level(), ..text::Style::default() };
        self.format.emit(&super::result::written(&whole, self.format, style)?, self.out.as_deref())?;
        Ok(Some(super::result::status(&whole, self.required)))
    }

    /// How the result of a sweep is written.
    fn of_sweep(&self) -> anyhow::Result<PageFormat> {
        Ok(match self.format {
            ReportFormat::Text => PageFormat::Text,
            ReportFormat::Json => PageFormat::Json,
            ReportFormat::Html => PageFormat::Html,
            ReportFormat::Junit | ReportFormat::Github => bail!("a sweep is written as text, json or html"),
        })
    }
}

/// The schema that a file names; nothing where it is not JSON, or names none.
fn schema(path: &Path) -> anyhow::Result<String> {
    let text = read::text(path, read::MOST_TEXT).with_context(|| format!("cannot read {}", path.display()))?;
    let value: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    Ok(shown(value["schema"].as_str().unwrap_or_default()).into_owned())
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
