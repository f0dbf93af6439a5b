//! `lightmeter page`.

use super::{Status, emit};
use anyhow::Context as _;
use clap::{Args, ValueEnum};
use lightmeter::report::page::{Run, markdown, svg};
use std::path::PathBuf;

/// What a page is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Subject {
    /// Blend states against routes and drivers.
    Blend,
}

/// Write a page of the docs from a run's JSON, with a picture beside it.
#[derive(Debug, Args)]
pub(crate) struct Page {
    /// What it is about
    #[arg(value_enum)]
    subject: Subject,
    /// The JSON of `lightmeter run --format json`
    run: PathBuf,
    /// Write the page to a file, and its picture to one of the same name that ends in .svg
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Page {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let Subject::Blend = self.subject;
        let name = self.run.display();
        let json = std::fs::read_to_string(&self.run).with_context(|| format!("cannot read {name}"))?;
        let run = Run::read(&json).with_context(|| format!("{name} makes no page"))?;
        let picture = self.out.as_ref().map(|out| out.with_extension("svg"));
        if let Some(path) = &picture {
            let mut text = String::new();
            svg(&run, &mut text)?;
            emit(&text, Some(path))?;
        }
        let picture = picture.as_ref().and_then(|path| path.file_name()).map(|name| name.to_string_lossy());
        let mut text = String::new();
        markdown(&run, picture.as_deref(), &mut text)?;
        emit(&text, self.out.as_deref())?;
        Ok(Status::Success)
    }
}
