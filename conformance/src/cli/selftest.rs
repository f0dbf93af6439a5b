//! `lightmeter selftest`.

use super::options::{Choice, Format, Targets};
use super::{Status, emit};
use anyhow::bail;
use clap::Args;
use lightmeter::blend_unit::selftest::{Finding, Row, selftest};
use lightmeter_scene::target::TargetFormat;
use serde_json::json;
use std::fmt::Write as _;
use std::io::IsTerminal as _;
use std::path::PathBuf;

/// Show that the suite catches the mistakes that it knows and tells them by name. So far: those of a blend unit.
#[derive(Debug, Args)]
pub(crate) struct Selftest {
    /// Format to blend on, as for `run`; without it: all
    #[arg(long, value_name = "NAME", value_parser = Choice::target)]
    target: Vec<Targets>,
    /// Pairs of source and destination for each of the 1,125 states
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u64).range(16..=65_536))]
    cases: u64,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Write it to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Selftest {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let targets = Targets::asked(&self.target).unwrap_or_else(|| TargetFormat::ALL.to_vec());
        let shows = std::io::stderr().is_terminal();
        let rows = selftest(&targets, self.cases, &mut |target| {
            if shows {
                eprintln!("every fault on {target}");
            }
        })?;
        let text = match self.format {
            Format::Junit => bail!("the self-test is written as text or json"),
            Format::Json => {
                serde_json::to_string_pretty(&json!({ "schema": "lightmeter.selftest/1", "rows": rows }))? + "\n"
            }
            Format::Text => table(&targets, &rows)?,
        };
        emit(&text, self.out.as_deref())?;
        Ok(if rows.iter().all(|row| row.finding.is_good()) { Status::Success } else { Status::Failed })
    }
}

fn word(finding: Finding) -> &'static str {
    match finding {
        Finding::Named => "named",
        Finding::Caught => "caught, not named",
        Finding::Survived => "SURVIVED",
        Finding::NotApplicable => "—",
        Finding::Clean => "clean",
        Finding::FalseAlarm => "FALSE ALARM",
    }
}

fn table(targets: &[TargetFormat], rows: &[Row]) -> anyhow::Result<String> {
    let mut text = String::new();
    write!(text, "{:<30}", "blend unit")?;
    for target in targets {
        write!(text, " {:<17}", target.name())?;
    }
    writeln!(text)?;
    let first = targets.first().map(|target| target.name()).unwrap_or_default();
    for name in rows.iter().filter(|row| row.target == first).map(|row| row.fault) {
        write!(text, "{name:<30}")?;
        for row in rows.iter().filter(|row| row.fault == name) {
            write!(text, " {:<17}", word(row.finding))?;
        }
        writeln!(text)?;
    }
    for row in rows.iter().filter(|row| !row.finding.is_good()) {
        writeln!(text, "\n{} on {}: {}", row.fault, row.target, word(row.finding))?;
        for said in &row.said {
            writeln!(text, "  {said}")?;
        }
    }
    Ok(text)
}
