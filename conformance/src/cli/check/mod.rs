//! `lightmeter check`.

mod files;
mod told;
mod worker;

pub(crate) use worker::Worker;

use super::clock::now;
use super::options::Format;
use super::progress::Bar;
use super::{Status, command, writable};
use clap::Args;
use lightmeter::document::Document as _;
use lightmeter::document::report::{Report, ShaderReview, StepVerdict};
use lightmeter::files::lines;
use std::path::PathBuf;

/// Find the steps of shaders, and what is wrong with them
///
/// A shader is a sum of steps: a Lambert factor, a highlight, an attenuation, fog, a gamma curve. They are found by what they compute, whatever
/// they are called. Each is right (✓), a dialect that has a name (~), a mistake (✗), or perhaps a mistake (?), where names alone say what a
/// vector is. The exit code is 1 where a step is wrong, else 2 where a file cannot be read, and 3 where no step is found.
#[derive(Debug, Args)]
pub(crate) struct Check {
    /// Shaders in GLSL, WGSL, SPIR-V or HLSL, folders of them, and globs
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    read: Read,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Write the result to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// What shaders are read with.
#[derive(Clone, Debug, Args)]
struct Read {
    /// Where included files are; again for several folders
    #[arg(short = 'I', value_name = "DIR")]
    include: Vec<PathBuf>,
    /// A macro that the host defines; again for several
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = definition)]
    define: Vec<(String, String)>,
}

/// A macro's name and what it stands for: 1 where nothing is said.
fn definition(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').unwrap_or((text, "1"));
    let is_name = name.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_alphanumeric() || c == '_');
    if !is_name || value.contains('\n') {
        return Err(format!("`{text}` is no macro; expected NAME or NAME=VALUE"));
    }
    Ok((name.to_owned(), value.to_owned()))
}

impl Check {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        writable(self.out.as_deref())?;
        if let Some(folder) = self.read.include.iter().find(|folder| !folder.is_dir()) {
            anyhow::bail!("`-I {}`: there is no such folder", folder.display());
        }
        let start = std::time::Instant::now();
        let files = files::all(&self.files)?;
        let mut bar = Bar::new(Some(files.len() as u64), "files");
        let shaders = worker::reviews(&files, &self.read, &mut bar)?;
        bar.bar.finish_and_clear();
        let status = status(&shaders);
        let text = match self.format {
            Format::Text => lines(&told::told(&shaders)).into_owned(),
            Format::Json => {
                let empty = Report::empty(0, "wgsl".into(), vec![], vec![]);
                let seconds = start.elapsed().as_secs_f64();
                Report { command: Some(command()), made_at: now(), seconds, shaders, ..empty }.to_json()?
            }
        };
        self.format.emit(&text, self.out.as_deref())?;
        Ok(status)
    }
}

fn status(shaders: &[ShaderReview]) -> Status {
    if shaders.iter().any(|own| own.count(StepVerdict::Mistake) > 0) {
        Status::Failed
    } else if shaders.iter().any(|own| own.unread.is_some()) {
        Status::BadInput
    } else if shaders.iter().all(|own| own.steps.is_empty()) {
        Status::Nothing
    } else {
        Status::Success
    }
}
