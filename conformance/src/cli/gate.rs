//! `lightmeter gate`.

use super::clock::now;
use super::comparison::{Comparison, Earlier, matches_something};
use super::config::used;
use super::observed::is_time_told;
use super::options::{AlsoJson, ReportFormat, Required, ShardArgument, Targets};
use super::pack::{Cases, nothing_to_ask};
use super::progress::{Bar, Stream};
use super::result::{status, written};
use super::say;
use super::signals::stopped_by_signals;
use super::terminal::level;
use super::{Status, command, quoted, show, writable};
use anyhow::{Context as _, bail};
use clap::Args;
use lightmeter::arithmetic::Profile;
use lightmeter::cases::GENERATOR_VERSION;
use lightmeter::device::Code;
use lightmeter::document::Document as _;
use lightmeter::document::by_case::ComparedBy;
use lightmeter::document::event::Stop;
use lightmeter::document::pack::Choice;
use lightmeter::document::report::{Report, Sentence};
use lightmeter::faults::{Mistakes, explain};
use lightmeter::files::lines;
use lightmeter::filter::Filter;
use lightmeter::gate::answers::{AnswerFile, FileRenderer};
use lightmeter::gate::baseline::{Standard, Subjects};
use lightmeter::gate::expectations::Expectations;
use lightmeter::gate::pack;
use lightmeter::gate::plan::{GatePlan, unmatched};
use lightmeter::gate::process::{Asking, Limits, ProcessRenderer, Starter};
use lightmeter::options::Options;
use lightmeter::report::{Level, text};
use lightmeter::run::run;
use lightmeter::select::Shard;
use lightmeter::special::verdict;
use lightmeter::subject::Subject;
use lightmeter_scene::target::TargetFormat;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Judge another renderer, by its files or as a process: see docs/gate.md.
///
/// `gate PACK ANSWERS` judges the answers to a pack that `lightmeter pack` wrote; more ANSWERS are of further runs of the same
/// renderer, and must be the same. `gate --exec COMMAND [FILTER…]` starts a renderer that speaks JSON lines.
#[derive(Debug, Args)]
pub(crate) struct Gate {
    /// PACK ANSWERS [ANSWERS…]; with --exec: globs of the cases
    #[arg(value_name = "PACK ANSWERS | FILTER")]
    given: Vec<OsString>,
    /// Start this command, by `sh -c`, and ask it
    #[arg(long, value_name = "COMMAND")]
    exec: Option<String>,
    #[command(flatten)]
    cases: Cases,
    /// Format to blend on, among those that the renderer declares: rgba32float, rgba16float, rgba8unorm, rgba8unorm-srgb or bgra8unorm;
    /// again for several; `all`. Without it: all
    #[arg(long, value_name = "NAME", requires = "exec", value_parser = super::options::Choice::target)]
    target: Vec<Targets>,
    /// Only a part of the cases: the I-th of N
    #[arg(long, value_name = "I/N", default_value = "1/1", allow_hyphen_values = true)]
    shard: ShardArgument,
    /// Accuracy rules: wgsl, vulkan or opengl; without it: what the renderer asks for, or wgsl
    #[arg(long, value_name = "NAME", value_parser = super::options::Choice::profile)]
    profile: Option<&'static Profile>,
    /// Seconds that a case may take
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0, requires = "exec", value_parser = seconds)]
    case_timeout: f64,
    /// Seconds that a scene may take
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, requires = "exec", value_parser = seconds)]
    scene_timeout: f64,
    /// Seconds that all may take; without it: as long as it takes
    #[arg(long, value_name = "SECONDS", requires = "exec", value_parser = seconds)]
    timeout: Option<f64>,
    /// MiB of address space that each process of the renderer may have; without it: as much as there is
    #[arg(long, value_name = "MIB", requires = "exec", value_parser = clap::value_parser!(u64).range(1..=1 << 30))]
    memory: Option<u64>,
    /// How many times to ask everything; an answer that changes is unstable. With 1, what failed is asked once more
    #[arg(long, value_name = "N", default_value_t = 1, requires = "exec", value_parser = clap::value_parser!(u64).range(1..=1000))]
    runs: u64,
    /// Keep the images of a process in this folder, and reference, result and error map of each scene that fails
    #[arg(long, value_name = "DIR", requires = "exec")]
    images: Option<PathBuf>,
    /// End with the first formula or scene that fails
    #[arg(long)]
    fail_fast: bool,
    #[command(flatten)]
    comparison: Comparison,
    /// Of a shard: leave the samples out by which `merge` tells what explains failures
    #[arg(long, requires = "shard")]
    no_samples: bool,
    #[command(flatten)]
    required: Required,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: ReportFormat,
    /// Write the result to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    also_json: AlsoJson,
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "expected seconds, such as 10 or 0.5".to_owned())?;
    if seconds > 0.0 && seconds <= 1e9 { Ok(seconds) } else { Err("expected seconds above 0".into()) }
}

impl Gate {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        if cfg!(not(unix)) && self.memory.is_some() {
            anyhow::bail!("--memory needs the limits that Unix sets for a process; leave it out on this system");
        }
        let expectations = self.comparison.expectations()?;
        let earlier = self.comparison.earlier(true)?;
        matches_something(&expectations)?;
        let start = Instant::now();
        let (plan, answers) = self.asked()?;
        if let Some(Earlier { baseline, path, .. }) = &earlier {
            let counts = plan.counts();
            let asked = counts.iter().map(|(id, count)| (id.as_str(), *count));
            baseline.is_of(&plan.choice, (asked, false), None, path)?;
        }
        writable(self.out.as_deref())?;
        let [expect, baseline] = self.comparison.files();
        self.also_json.is_writable([("out", self.out.as_deref()), ("expect", expect), ("baseline", baseline)])?;
        let stop = stopped_by_signals()?;
        let images = Images::new(self.images.clone())?;
        let report = self.judge(plan, answers, (&expectations, earlier.as_ref()), &images, &stop);
        let mut report = match (report, stop.signal()) {
            (Err(error), Some(signal)) => {
                say(&format!("error: {error:#}"));
                return Ok(Status::of_signal(signal));
            }
            (report, _) => report?,
        };
        report.seconds = start.elapsed().as_secs_f64();
        report.required = Some(self.required.part());
        let identity = report.renderer.as_ref().map(|renderer| renderer.identity.clone()).unwrap_or_default();
        let others = expectations.of_others(&[(&identity.name, &identity.version)]);
        report.notes.extend(others.map(Sentence::from));
        // What was asked is told, even where the baseline turns out to be of other accuracy rules.
        // What was not asked for want of time is no regression.
        let whole = earlier.as_ref().filter(|_| report.interrupted.is_none());
        let regressions = whole.map(|earlier| earlier.compare(&Standard::from(&report), self.is_shard())).transpose();
        report.regressions = regressions.as_ref().map_or(vec![], |found| found.clone().unwrap_or_default());
        (report.mended, report.added) =
            whole.map(|earlier| earlier.progress(&Standard::from(&report))).unwrap_or_default();
        let emitted = self.format.emit(&self.write(&report)?, self.out.as_deref());
        let kept = self.also_json.emit(|| report.to_json());
        regressions?;
        self.comparison.update(&report)?;
        emitted.and(kept)?;
        Ok(status(&report, self.required))
    }

    /// The cases, and the files of answers.
    fn asked(&self) -> anyhow::Result<(GatePlan, Vec<AnswerFile>)> {
        if self.exec.is_some() {
            let globs = self.globs()?;
            let is_file =
                |given: &&String| Path::new(given).exists() && unmatched(std::iter::once(given.as_str())).is_some();
            if let Some(file) = globs.iter().find(is_file) {
                bail!(
                    "`{file}` is a file or folder; with --exec, all other arguments must be globs that select cases, such as `fog/*`"
                );
            }
            let plan = self.cases.plan(self.cases.choice(&globs))?;
            // What it declares is not known yet.
            let has_tables = !verdict::select(&Filter::new(&globs)?, Shard::WHOLE).is_empty();
            return if plan.is_empty() && !has_tables { Err(nothing_to_ask()) } else { Ok((plan, vec![])) };
        }
        let [folder, answers @ ..] = self.given.as_slice() else {
            bail!("expected PACK ANSWERS, or --exec COMMAND; `lightmeter pack DIR` writes a pack");
        };
        if answers.is_empty() {
            bail!("expected PACK ANSWERS: a file of JSON lines, or a folder with answers.jsonl");
        }
        if let Some(option) = self.cases.asked() {
            bail!(
                "the cases of a pack are fixed when it is written, so `{option}` has no effect here; give it to `lightmeter pack`, or use `--exec`"
            );
        }
        let plan = pack::read(Path::new(folder))?;
        let opened = answers.iter().map(|path| {
            AnswerFile::open(Path::new(path)).map_err(|error| {
                let glob = path.to_str().filter(|glob| !Path::new(path).exists() && plan.is_matched(glob));
                let hint =
                    "of a pack all cases are judged: those of a filter are written by `lightmeter pack DIR FILTER`";
                let error = anyhow::Error::from(error);
                match glob {
                    Some(glob) => error.context(format!("`{glob}` is a filter, and no file of answers; {hint}")),
                    None => error,
                }
            })
        });
        let opened = opened.collect::<anyhow::Result<_>>()?;
        Ok((plan, opened))
    }

    /// What was given as globs, which are text.
    fn globs(&self) -> anyhow::Result<Vec<String>> {
        let text = |given: &OsString| {
            let text = given.to_str().map(str::to_owned);
            text.with_context(|| format!("`{}` is not UTF-8; expected a glob, such as `fog/*`", given.display()))
        };
        self.given.iter().map(text).collect()
    }

    /// Has the engine judge what the renderer answers.
    fn judge(
        &self,
        plan: GatePlan,
        answers: Vec<AnswerFile>,
        (expectations, earlier): (&Expectations, Option<&Earlier>),
        images: &Images,
        stop: &Stop,
    ) -> anyhow::Result<Report> {
        let choice = plan.choice.clone();
        let runs = if self.exec.is_some() { self.runs } else { answers.len() as u64 };
        let asked = Targets::asked(&self.target).unwrap_or_else(|| TargetFormat::ALL.to_vec());
        let targets = if self.exec.is_some() { asked } else { plan.targets.clone() };
        let (hello, subject) = match &self.exec {
            Some(command) => {
                let mut process = ProcessRenderer::start(self.asking(command, images, stop))?;
                let hello = process.hello().clone();
                process.expect(expectations);
                (hello, Subject::renderer(process.identity(), Box::new(process)))
            }
            None => {
                let files = FileRenderer::read(plan, answers, expectations, stop.clone())?;
                (files.hello().clone(), Subject::renderer(files.identity(), Box::new(files)))
            }
        };
        if let Some(earlier) = earlier {
            earlier.is_by(&Subjects::Renderer(hello.identity().name))?;
        }
        let options = Options {
            filter: Filter::new(&choice.filter)?,
            cases: choice.cases,
            size: choice.size,
            targets,
            counts_cases: true,
            images: self.keeps_images().then(|| images.folder.clone()),
            shard: self.shard.0,
            diagnose: Some(&Mistakes),
            ask: self.again(),
            samples_kept: !self.no_samples,
            stop: stop.clone(),
            expected: expectations.of(&hello.renderer, &hello.version),
            runs,
            ..Options::by(Code::default(), None, choice.seed, hello.profile(self.profile)?)
        };
        let mut bar = Bar::new(None, "cases").fail_fast(self.fail_fast.then(|| stop.clone()));
        if self.is_read_by_people() {
            if level() > Level::Quiet {
                let mut line = String::new();
                text::begun(&hello.identity(), options.profile.name, &mut line)?;
                show(&lines(&line), None)?;
            }
            bar = bar.live(Stream::Output);
        }
        let report = run(&mut [subject], &options, &mut bar);
        bar.bar.finish_and_clear();
        let shard = self.is_shard().then(|| self.shard.to_string());
        let compared_by = ComparedBy {
            choice,
            generator: GENERATOR_VERSION,
            targets: options.targets.iter().map(|target| target.name().into()).collect(),
            declared: hello.targets.iter().cloned().map(Into::into).collect(),
            separate: None,
            shard,
        };
        let report = report?;
        // Of shards, `merge` works it out.
        let explained = if self.is_shard() { vec![] } else { explain(&report, options.profile) };
        let command = Some(command());
        Ok(Report { compared_by: Some(compared_by), config: used(), made_at: now(), command, explained, ..report })
    }

    /// Whether reference, result and error map of a scene that fails are written.
    fn keeps_images(&self) -> bool {
        self.images.is_some() || self.format == ReportFormat::Html
    }

    fn asking(&self, command: &str, images: &Images, stop: &Stop) -> Asking {
        let duration = Duration::from_secs_f64;
        let limits = Limits {
            case: duration(self.case_timeout),
            scene: duration(self.scene_timeout),
            total: self.timeout.map(duration),
            ..Limits::default()
        };
        let folder = images.folder.clone();
        // Only Unix has the limits and the signals of a starter; elsewhere, or where the own binary is not found, a shell starts it.
        let program = std::env::current_exe().ok().filter(|_| cfg!(unix));
        let starter = program.map(|program| Starter { program, memory: self.memory });
        let (runs, stop) = (self.runs, stop.clone());
        Asking { command: command.to_owned(), starter, folder, limits, runs, stop, is_time_told: is_time_told() }
    }

    /// The command that asks for one case again, but for the case's id; nothing of answers in files.
    fn again(&self) -> Option<String> {
        let exec = self.exec.as_ref()?;
        let mut words = format!("lightmeter gate --exec {}", quoted(exec));
        let Choice { seed, size, .. } = self.cases.choice(&[]);
        if seed != 1 {
            words += &format!(" --seed {seed}");
        }
        if let Some(size) = size {
            words += &format!(" --size {size}");
        }
        if let Some(profile) = self.profile {
            words += &format!(" --profile {}", profile.name);
        }
        Some(words)
    }

    const fn is_shard(&self) -> bool {
        self.shard.0.count.get() > 1
    }

    /// Whether the result is text on standard output.
    fn is_read_by_people(&self) -> bool {
        self.format == ReportFormat::Text && self.out.is_none()
    }

    fn write(&self, report: &Report) -> anyhow::Result<String> {
        let style = text::Style { is_told: self.is_read_by_people(), level: level(), ..text::Style::default() };
        written(report, self.format, style)
    }
}

/// Where a process writes its images: a folder that was asked for, or one that goes when the gate ends.
struct Images {
    folder: PathBuf,
    is_kept: bool,
}

impl Images {
    fn new(kept: Option<PathBuf>) -> anyhow::Result<Self> {
        let is_kept = kept.is_some();
        let own = || std::env::temp_dir().join(format!("lightmeter-gate-{}", std::process::id()));
        let folder = kept.unwrap_or_else(own);
        std::fs::create_dir_all(&folder).with_context(|| format!("cannot write {}", folder.display()))?;
        Ok(Self { folder: folder.canonicalize()?, is_kept })
    }
}

impl Drop for Images {
    fn drop(&mut self) {
        if !self.is_kept {
            let _ = std::fs::remove_dir_all(&self.folder);
        }
    }
}
