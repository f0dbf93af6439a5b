//! `lightmeter page`.

use super::contact_sheet;
use super::{Status, emit, say};
use anyhow::{Context as _, anyhow, bail};
use clap::{Args, ValueEnum};
use lightmeter::document::bench::BenchDocument;
use lightmeter::document::report::{ImageUse, Report};
use lightmeter::document::selftest::SelftestDocument;
use lightmeter::document::sweep::SweepDocument;
use lightmeter::document::{Document as _, is_of};
use lightmeter::files::read;
use lightmeter::report;
use lightmeter::report::bench::{page, plot};
use lightmeter::report::html;
use lightmeter::report::page::scenes::ToldScene;
use lightmeter::report::page::sweep::Swept;
use lightmeter::report::page::{BlendRun, markdown, renderers, scenes, selftest, special, stability, svg};
use lightmeter::rulings;
use lightmeter::select::catalogue;
use lightmeter::sweep::{Asked, PRESETS, SweepPlan, file, is_over_inputs_of};
use std::path::{Path, PathBuf};

/// What a page is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Subject {
    /// What accuracy costs in time, from the JSON of `bench`, with pictures.
    Bench,
    /// Blend states against routes and drivers.
    Blend,
    /// Formulas by the subjects of several runs or gates; HTML where the file's name ends in .html.
    Matrix,
    /// Renderers, a row each, from the JSON of their gates.
    Renderers,
    /// A page to look at, from the JSON of `run`, `gate`, `merge`, `bench`, `sweep` or `selftest`: one file with everything in it.
    Report,
    /// Where formulas are from, what is ruled where the documents are wrong, and words with a meaning of their own; of no run.
    Rulings,
    /// The built-in scenes, with a contact sheet.
    Scenes,
    /// What the suite catches and how small an error it names, from the JSON of `selftest`.
    Selftest,
    /// NaN, infinity, subnormals and signed zero, from the JSON of `special`.
    Special,
    /// Hard cases by their stable and their naive forms, with a picture.
    Stability,
    /// Sweeps, of as many results as are given.
    Sweep,
}

/// Write a page of the docs from a run's JSON, most with a picture beside it.
#[derive(Debug, Args)]
pub(crate) struct Page {
    /// What it is about
    #[arg(value_enum)]
    subject: Subject,
    /// The JSON of `lightmeter run --format json`, or of `special`, `selftest` or `bench` with the same; of sweeps, that of each
    runs: Vec<PathBuf>,
    /// Write the page to a file, and its picture to one of the same name that ends in .svg or .png; those of a bench to a folder of
    /// that name
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Page {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        if self.subject == Subject::Sweep {
            if self.runs.is_empty() {
                bail!("a sweep page needs the JSON results of at least one sweep");
            }
            emit(&self.sweeps()?, self.out.as_deref())?;
            return Ok(Status::Success);
        }
        if self.subject == Subject::Matrix {
            emit(&self.matrix()?, self.out.as_deref())?;
            return Ok(Status::Success);
        }
        if self.subject == Subject::Renderers {
            emit(&self.renderers()?, self.out.as_deref())?;
            return Ok(Status::Success);
        }
        if self.subject == Subject::Rulings {
            if let Some(run) = self.runs.first() {
                bail!("the page of rulings takes no run; remove {}", run.display());
            }
            emit(&rulings::markdown(), self.out.as_deref())?;
            return Ok(Status::Success);
        }
        let [run] = self.runs.as_slice() else {
            bail!("this page needs the JSON result of exactly one run");
        };
        let name = run.display();
        let json = read::text(run, read::MOST_TEXT).with_context(|| format!("cannot read {name}"))?;
        let text = match self.subject {
            Subject::Bench => self.bench(&json),
            Subject::Blend => self.blend(&json),
            Subject::Report => report_of(&json, run.parent().unwrap_or(Path::new(""))),
            Subject::Scenes | Subject::Sweep | Subject::Rulings | Subject::Matrix | Subject::Renderers => {
                self.scenes(&json)
            }
            Subject::Selftest => selftest_page(&json),
            Subject::Special => special(&json),
            Subject::Stability => self.stability(&json),
        };
        emit(&text.with_context(|| format!("{name} makes no page"))?, self.out.as_deref())?;
        Ok(Status::Success)
    }

    fn sweeps(&self) -> anyhow::Result<String> {
        let mut results = vec![];
        for path in &self.runs {
            let result = file::read(path)?;
            if !result.is_finished() {
                bail!(
                    "{} is unfinished; to finish it, run the same `lightmeter sweep` command again with `--checkpoint` set to this file",
                    path.display()
                );
            }
            results.push(swept(result));
        }
        let mut text = String::new();
        report::page::sweep::markdown(&results, &mut text)?;
        Ok(text)
    }

    /// Formulas by the subjects of all results, each of which is called by its file where there are several.
    fn matrix(&self) -> anyhow::Result<String> {
        if self.runs.is_empty() {
            bail!("a matrix needs the JSON result of at least one run or gate");
        }
        let mut reports = vec![];
        for path in &self.runs {
            let failed = || format!("cannot read {}", path.display());
            let json = read::text(path, read::MOST_TEXT).with_context(failed)?;
            reports.push((
                path.file_stem().unwrap_or_default().to_string_lossy(),
                Report::read(&json).with_context(failed)?,
            ));
        }
        let named: Vec<(&str, &Report)> = reports.iter().map(|(name, report)| (&**name, report)).collect();
        let is_html = self.out.as_ref().and_then(|out| out.extension()).is_some_and(|end| end == "html");
        if is_html {
            return Ok(html::of_matrix(&named));
        }
        let mut text = String::new();
        html::matrix_markdown(&named, &mut text)?;
        Ok(text)
    }

    /// A row for each gate.
    fn renderers(&self) -> anyhow::Result<String> {
        if self.runs.is_empty() {
            bail!("a table of renderers needs the JSON result of at least one gate");
        }
        let mut gates = vec![];
        for path in &self.runs {
            let failed = || format!("cannot read {}", path.display());
            let json = read::text(path, read::MOST_TEXT).with_context(failed)?;
            let report = Report::read(&json).with_context(failed)?;
            if report.renderer.is_none() {
                bail!("{}: it is the JSON of `run`; expected that of `gate`", path.display());
            }
            gates.push(report);
        }
        let mut text = String::new();
        renderers::markdown(&gates, &mut text)?;
        Ok(text)
    }

    fn bench(&self, json: &str) -> anyhow::Result<String> {
        let document = BenchDocument::read(json)?;
        if let Some(interrupted) = &document.interrupted {
            bail!("it was interrupted: {interrupted}; expected one that is complete");
        }
        let mut pictures = vec![];
        let mut folder = String::new();
        if let Some(out) = &self.out {
            let dir = out.with_extension("");
            folder = format!("{}/", dir.file_name().unwrap_or_default().to_string_lossy());
            std::fs::create_dir_all(&dir).with_context(|| format!("cannot make the folder {}", dir.display()))?;
            pictures = plot::pictures(&document).map_err(anyhow::Error::from_boxed)?;
            for picture in &pictures {
                emit(&picture.svg, Some(&dir.join(picture.stem()).with_extension("svg")))?;
            }
        }
        let mut text = String::new();
        page::markdown(&document, &pictures, &folder, &mut text)?;
        Ok(text)
    }

    fn blend(&self, json: &str) -> anyhow::Result<String> {
        let run = BlendRun::read(json)?;
        let picture = self.picture("svg");
        if let Some((path, _)) = &picture {
            emit(&svg(&run).map_err(anyhow::Error::from_boxed)?, Some(path))?;
        }
        let mut text = String::new();
        markdown(&run, picture.as_ref().map(|(_, name)| name.as_str()), &mut text)?;
        Ok(text)
    }

    fn stability(&self, json: &str) -> anyhow::Result<String> {
        let run = stability::StabilityRun::read(json).map_err(|message| anyhow!(message))?;
        let picture = self.picture("svg");
        if let Some((path, _)) = &picture {
            emit(&stability::svg(&run).map_err(anyhow::Error::from_boxed)?, Some(path))?;
        }
        let mut text = String::new();
        stability::markdown(&run, picture.as_ref().map(|(_, name)| name.as_str()), &mut text)?;
        Ok(text)
    }

    fn scenes(&self, json: &str) -> anyhow::Result<String> {
        let run = scenes::SceneRun::read(json).map_err(|message| anyhow!(message))?;
        let loaded = contact_sheet::scenes()?;
        let picture = self.picture("png");
        if let Some((path, _)) = &picture {
            contact_sheet::draw(&loaded).write(path)?;
        }
        let told: Vec<ToldScene> = loaded.iter().map(contact_sheet::told).collect();
        let mut text = String::new();
        scenes::markdown(&run, &told, picture.as_ref().map(|(_, name)| name.as_str()), &mut text)?;
        Ok(text)
    }

    /// The picture beside the page, and its name there.
    fn picture(&self, extension: &str) -> Option<(PathBuf, String)> {
        let path = self.out.as_ref()?.with_extension(extension);
        let name = path.file_name()?.to_string_lossy().into_owned();
        Some((path, name))
    }
}

/// A sweep with what it is, where it is a ready-made one.
pub(crate) fn swept(document: SweepDocument) -> Swept {
    let formula = &document.sweep.formula;
    let preset = PRESETS.iter().find(|preset| preset.formula == formula);
    let is_ready_made = preset.is_some()
        && SweepPlan::new(&catalogue(), formula, &Asked::default())
            .is_ok_and(|plan| is_over_inputs_of(&document.sweep, &plan));
    // What the ready-made one shows is true of its own inputs alone.
    let what = preset.filter(|_| is_ready_made).map(|preset| preset.what);
    Swept { what, is_ready_made, document }
}

/// The page of any result, by what its JSON says that it is. The pictures that it names lie where it says, or so from the folder of its file.
fn report_of(json: &str, folder: &Path) -> anyhow::Result<String> {
    let document: serde_json::Value = serde_json::from_str(json).context("it is not JSON")?;
    let schema = document["schema"].as_str().unwrap_or("none");
    if is_of::<Report>(schema) {
        let mut report = Report::read(json)?;
        found(report.groups.iter_mut().filter_map(|group| group.image.as_mut()), folder);
        Ok(html::of_report(&report))
    } else if is_of::<BenchDocument>(schema) {
        html::of_bench(&BenchDocument::read(json)?).map_err(anyhow::Error::from_boxed)
    } else if is_of::<SweepDocument>(schema) {
        Ok(html::of_sweeps(&[swept(file::parse(json).map_err(anyhow::Error::msg)?)])?)
    } else if is_of::<SelftestDocument>(schema) {
        Ok(html::of_selftest(&selftest::SelftestRun::read(json).map_err(anyhow::Error::msg)?)?)
    } else {
        bail!("its schema is `{schema}`; expected the JSON of a run, a gate, a bench, a sweep or a self-test")
    }
}

/// Says where pictures are, and tells of those that are not there.
fn found<'a>(images: impl Iterator<Item = &'a mut ImageUse>, folder: &Path) {
    let mut missing = vec![];
    for file in images.flat_map(|image| &mut image.files) {
        let beside = folder.join(&*file);
        if beside.is_file() {
            *file = beside.display().to_string();
        } else if !Path::new(file).is_file() {
            missing.push(file.clone());
        }
    }
    if let Some(first) = missing.first() {
        say(&format!(
            "{} pictures of the result are not there, such as {first}: the page is made without them",
            missing.len()
        ));
    }
}

fn special(json: &str) -> anyhow::Result<String> {
    let run = special::SpecialRun::read(json).map_err(|message| anyhow!(message))?;
    let mut text = String::new();
    special::markdown(&run, &mut text)?;
    Ok(text)
}

fn selftest_page(json: &str) -> anyhow::Result<String> {
    let run = selftest::SelftestRun::read(json).map_err(|message| anyhow!(message))?;
    let mut text = String::new();
    selftest::markdown(&run, &mut text)?;
    Ok(text)
}
