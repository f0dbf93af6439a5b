//! `lightmeter check`.

mod files;
mod judged;
mod project;
mod told;
mod worker;

pub(crate) use worker::Worker;

use super::clock::now;
use super::options::Choice;
use super::progress::Bar;
use super::{Status, command, emit, show, writable};
use clap::Args;
use lightmeter::arithmetic::Profile;
use lightmeter::document::Document as _;
use lightmeter::document::report::{Report, Sentence, ShaderReview};
use lightmeter::files::lines;
use lightmeter::nearest::did_you_mean;
use lightmeter::report::{github, html, junit, sarif};
use lightmeter_shaders::accepted;
use std::path::PathBuf;

/// Random cases of a step: mistakes show in as many.
const CASES: u64 = 256;
/// More of them show nothing more, and take minutes.
const MOST_CASES: u64 = 1_000_000;

/// Find the steps of shaders, and what is wrong with them
///
/// A shader is a sum of steps: a Lambert factor, a highlight, an attenuation, fog, a gamma curve. They are found by what they compute, whatever
/// they are called. Each is right (✓), a dialect that has a name (~), a mistake (✗), or perhaps a mistake (?), where names alone say what a
/// vector is. Steps that are a formula's are judged as that too, by random and hard cases and the intervals of legal values. The exit code is 1 where a step is wrong, else 2 where a file cannot be read, and 3 where no step is found.
///
/// A dialect or a mistake that is intended is accepted by its name: `// lightmeter: accept NAME` behind the step, on the line above it or on
/// top of the file, or `--accept NAME` for all files. Without FILE, those are checked that `[[shader]]` in `lightmeter.toml` lists.
#[derive(Debug, Args)]
pub(crate) struct Check {
    /// Shaders in GLSL, WGSL, SPIR-V or HLSL, folders of them, and globs; without any, those that lightmeter.toml lists
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    read: Read,
    /// Adapter that computes the steps; without it, the suite's own evaluation of shaders in f32
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Accuracy rules: wgsl, vulkan or opengl
    #[arg(long, value_name = "NAME", default_value = "wgsl", value_parser = Choice::profile)]
    profile: &'static Profile,
    /// Random cases of each step
    #[arg(long, value_name = "N", default_value_t = CASES, value_parser = clap::value_parser!(u64).range(1..=MOST_CASES))]
    cases: u64,
    /// Count a dialect as wrong, unless it is accepted
    #[arg(long)]
    strict: bool,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: CheckFormat,
    /// Write the result to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// How the steps of shaders are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum CheckFormat {
    Text,
    Json,
    /// A suite for each file, a test for each step
    Junit,
    /// Lines that GitHub Actions shows as annotations
    Github,
    /// For code scanning and editors
    Sarif,
    /// A page with each source and its steps beside it
    Html,
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
    /// The name of a dialect or a mistake that is intended; again for several
    #[arg(long, value_name = "NAME", value_parser = accepted_name)]
    accept: Vec<String>,
}

/// A name that a step may have.
fn accepted_name(text: &str) -> Result<String, String> {
    let known = accepted::names();
    if known.iter().any(|own| own == text) {
        return Ok(text.to_owned());
    }
    Err(format!("no dialect and no mistake is called `{text}`{}", did_you_mean(text, known.iter().map(String::as_str))))
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
        let mut judge = judged::Judge::new(self.adapter.as_deref(), self.profile, self.cases)?;
        let sets = project::sets(&self.files, &self.read)?;
        let number: usize = sets.iter().map(|set| set.files.len()).sum();
        let mut bar = Bar::new(Some(number as u64), "files");
        let (mut shaders, mut notes) = (vec![], vec![]);
        for set in &sets {
            let found = worker::reviews(&set.files, &set.read, &mut judge, &mut bar)?;
            // A name on the command line is for the files of all sets.
            let of_set = set.read.accept.iter().filter(|name| !self.read.accept.contains(name));
            notes.extend(of_set.filter_map(|name| unneeded(name, &found)));
            shaders.extend(found);
        }
        notes.extend(self.read.accept.iter().filter_map(|name| unneeded(name, &shaders)));
        bar.bar.finish_and_clear();
        let status = status(&shaders, self.strict);
        let text = match self.format {
            CheckFormat::Text => lines(&told::told(&shaders, self.strict, &notes)).into_owned(),
            CheckFormat::Json => {
                let empty = Report::empty(0, "wgsl".into(), vec![], vec![]);
                let seconds = start.elapsed().as_secs_f64();
                let notes = notes.into_iter().map(Sentence::from).collect();
                Report { command: Some(command()), made_at: now(), seconds, shaders, notes, ..empty }.to_json()?
            }
            CheckFormat::Junit => junit::of_shaders(&shaders, self.strict, &notes)?,
            CheckFormat::Github => github::of_shaders(&shaders, self.strict, &notes),
            CheckFormat::Sarif => format!("{:#}\n", sarif::of_shaders(&shaders, self.strict, &notes)),
            CheckFormat::Html => {
                let with_source = |own| (own, source_of(own));
                html::of_shaders(&shaders.iter().map(with_source).collect::<Vec<_>>(), self.strict, &notes)
            }
        };
        match self.format {
            CheckFormat::Text => show(&text, self.out.as_deref())?,
            _ => emit(&text, self.out.as_deref())?,
        }
        Ok(status)
    }
}

/// The text of a file, with each line's end as \n.
fn source_of(shader: &ShaderReview) -> String {
    let text = std::fs::read(&shader.file).unwrap_or_default();
    String::from_utf8_lossy(&text).replace("\r\n", "\n").replace('\r', "\n")
}

/// A note for an accepted name that none of the files has a step of; none where a file could not be read, as it may have one.
fn unneeded(name: &str, found: &[ShaderReview]) -> Option<String> {
    let is_open = found.iter().any(|own| own.unread.is_some());
    let is_found = found.iter().flat_map(|own| &own.steps).any(|step| step.accepted && step.name == name);
    (!is_open && !is_found).then(|| format!("`{name}` is accepted, and no step has it: take it out"))
}

fn status(shaders: &[ShaderReview], is_strict: bool) -> Status {
    if shaders.iter().flat_map(|own| &own.steps).any(|step| step.is_wrong(is_strict)) {
        Status::Failed
    } else if shaders.iter().any(|own| own.unread.is_some() || !own.refused.is_empty()) {
        Status::BadInput
    } else if shaders.iter().all(|own| own.steps.is_empty()) {
        Status::Nothing
    } else {
        Status::Success
    }
}
