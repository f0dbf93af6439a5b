//! `lightmeter sweep`.

use super::clock::now;
use super::observed::happens;
use super::options::{Choice, PageFormat, ShardArgument};
use super::page::swept;
use super::say;
use super::shader::ShaderChoice;
use super::signals::stopped_by_signals;
use super::values::{float, setting};
use super::{NothingToRun, Status, abandon, command, writable};
use anyhow::{Context as _, bail};
use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use lightmeter::arithmetic::Profile;
use lightmeter::cases::Stage;
use lightmeter::document::Document as _;
use lightmeter::document::sweep::presets::{ListedPreset, PresetsDocument, SCHEMA};
use lightmeter::document::sweep::{Description, SweepDocument};
use lightmeter::document::thousands;
use lightmeter::filter::Filter;
use lightmeter::report::html;
use lightmeter::report::sweep as text;
use lightmeter::select::{Shard, catalogue};
use lightmeter::sweep::file::{self, DocumentError, name_of};
use lightmeter::sweep::{Asked, Free, Over, PRESETS, Preset, Refused, SweepError, SweepPlan, describe, span, sweep};
use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How often the checkpoint is written after the first block.
const SAVED_EVERY: Duration = Duration::from_secs(1);

/// Judge a formula along one of its inputs over every float of a range, or a blend mode over every byte.
///
/// Without a formula it lists the ready-made sweeps.
#[derive(Debug, Args)]
pub(crate) struct Sweep {
    /// The formula, as `fog/exp`
    formula: Option<String>,
    /// The free number, as `p.z`; without it: the ready-made sweep's
    #[arg(long, value_name = "NAME")]
    over: Option<String>,
    /// The least float; decimal, or its bits as 0x3f800000
    #[arg(long, value_name = "X", value_parser = float, allow_hyphen_values = true)]
    from: Option<f32>,
    /// The greatest
    #[arg(long, value_name = "X", value_parser = float, allow_hyphen_values = true)]
    to: Option<f32>,
    /// Another input, as `density=0.01`, `p.x=1` or `fog=0.5,0.5,1`; again for several. Those not set are the ready-made sweep's, or in the
    /// middle of their domain, or drawn where the output depends on the free number
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, allow_hyphen_values = true)]
    set: Vec<(String, Vec<f32>)>,
    /// The output, as `color.r`; without it: the ready-made sweep's, or the one that depends on the free number the most
    #[arg(long, value_name = "NAME")]
    output: Option<String>,
    /// The stage: compute, fragment, or fixed-function for the blend modes
    #[arg(long, value_name = "STAGE", value_parser = stage)]
    stage: Option<Stage>,
    /// Adapter to run on, as for `run`; without it: lavapipe, or the first there is
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Accuracy rules: wgsl, vulkan or opengl
    #[arg(long, value_name = "NAME", default_value = "wgsl", value_parser = Choice::profile)]
    profile: &'static Profile,
    #[command(flatten)]
    shaders: ShaderChoice,
    /// Only a part of the inputs: the I-th of N; `lightmeter merge` joins them
    #[arg(long, value_name = "I/N", default_value = "1/1", allow_hyphen_values = true)]
    shard: ShardArgument,
    /// Where the state is kept, so that the same command goes on where an interrupted one was
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Do this number of blocks now and leave the rest for another time; the exit code is 1 until all are done
    #[arg(long, value_name = "N", requires = "checkpoint", value_parser = clap::value_parser!(u64).range(1..))]
    blocks: Option<u64>,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: PageFormat,
    /// Write it to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Sweep {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let Some(formula) = &self.formula else { return self.list() };
        let catalogue = catalogue();
        let plan = SweepPlan::new(&catalogue, formula, &self.asked()).map_err(|why| match why {
            Refused::Independent(why) => anyhow::Error::from(NothingToRun(why)),
            wrong @ Refused::Wrong(_) => wrong.into(),
        })?;
        let shard = self.shard.0;
        check_shard(&plan, shard)?;
        self.check_files()?;
        let choice = self.choice();
        self.shaders.own.without_constants()?;
        let filter = Filter::new(std::slice::from_ref(&plan.member.spec.id))?;
        let accepted = self.shaders.accepted(&filter, &choice.adapter, false)?;
        let output = plan.output_name();
        let is_swept = |name: &String| output.split('.').next() == Some(name);
        if accepted.adapted.iter().any(|adapted| adapted.missing.iter().any(is_swept)) {
            bail!("the shader does not give {output}; name an output that it gives by `--output`");
        }
        let code = accepted.code()?;
        let mut subjects = choice.subjects()?;
        let [subject] = subjects.as_mut_slice() else {
            bail!("a sweep runs on exactly one adapter; name it with --adapter");
        };
        let mut document = self.start(describe(&plan, subject, self.profile, &code))?;
        document.command = Some(command());
        document.made_at = now();

        writable(self.out.as_deref())?;
        let stop = stopped_by_signals()?;
        let bar = bar(&document, shard);
        let mut saved: Option<Instant> = None;
        let mut tell = |document: &SweepDocument| {
            bar.set_position(document.statistics.inputs);
            if saved.is_none_or(|saved| saved.elapsed() >= SAVED_EVERY) {
                self.save(document)?;
                saved = Some(Instant::now());
                happens("saved", document.done);
            }
            happens("block", document.done);
            Ok(if stop.is_set() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        };
        let swept = sweep(&plan, subject, &code, self.profile, &mut document, self.blocks, &mut tell);
        bar.finish_and_clear();
        self.save(&document)?;
        match swept {
            Ok(()) => {
                let status = self.finish(&document, &plan)?;
                Ok(stop.signal().filter(|_| !document.is_finished()).map_or(status, Status::of_signal))
            }
            Err(SweepError::Device(error)) => {
                if let Some(path) = self.checkpoint.as_ref().filter(|_| error.is_of_device()) {
                    let (done, blocks) = (document.done, document.blocks);
                    say(&format!("{done} of {blocks} blocks were done, which are in {}", path.display()));
                }
                // Closing a device that hangs would hang as well.
                abandon(subjects);
                Err(error.into())
            }
            Err(error @ SweepError::Lacks { .. }) => Err(NothingToRun(error.to_string()).into()),
            Err(error) => Err(error.into()),
        }
    }

    /// Lists the ready-made sweeps.
    fn list(&self) -> anyhow::Result<Status> {
        if self.asked() != Asked::default() || self.checkpoint.is_some() || self.shard.0 != Shard::WHOLE {
            bail!(
                "no formula was given; name one, such as fog/exp. `lightmeter sweep` without options lists the ready-made sweeps"
            );
        }
        self.format.emit(&presets(self.format)?, self.out.as_deref())?;
        Ok(Status::Success)
    }

    /// The result and the checkpoint are two files.
    fn check_files(&self) -> anyhow::Result<()> {
        if let (Some(out), Some(checkpoint)) = (&self.out, &self.checkpoint)
            && place_of(out) == place_of(checkpoint)
        {
            bail!("--out and --checkpoint name one file; expected two");
        }
        Ok(())
    }

    /// The state to go on from: the checkpoint's, or a new one. Its files are written to now, not after hours of work.
    fn start(&self, description: Description) -> anyhow::Result<SweepDocument> {
        let shard = self.shard.0;
        let resumed = self.checkpoint.as_deref().map(|path| file::resume(path, &description, shard)).transpose()?;
        let document = resumed.flatten().unwrap_or_else(|| file::begun(description, shard));
        self.save(&document)?;
        if let Some(path) = &self.out {
            // What stands there stays until there is a result.
            let opened = std::fs::OpenOptions::new().append(true).create(true).open(path);
            opened.with_context(|| format!("cannot write {}", path.display()))?;
        }
        Ok(document)
    }

    /// Writes the checkpoint, where one is kept.
    fn save(&self, document: &SweepDocument) -> Result<(), DocumentError> {
        self.checkpoint.as_deref().map_or(Ok(()), |path| file::write(document, path))
    }

    /// Writes the result.
    fn finish(&self, document: &SweepDocument, plan: &SweepPlan<'_>) -> anyhow::Result<Status> {
        self.format.emit(&written(document, self.format, &self.rerun(plan))?, self.out.as_deref())?;
        if !document.is_finished()
            && let Some(path) = &self.checkpoint
        {
            say(&format!("not finished; the same command goes on from {}", path.display()));
        }
        // Green is only what was judged.
        Ok(if document.is_finished() { status(document) } else { Status::Failed })
    }

    fn asked(&self) -> Asked {
        Asked {
            over: self.over.clone(),
            from: self.from,
            to: self.to,
            set: self.set.clone(),
            output: self.output.clone(),
            stage: self.stage,
        }
    }

    fn choice(&self) -> Choice {
        Choice {
            adapter: self.adapter.iter().cloned().collect(),
            profile: self.profile,
            target: vec![],
            size: None,
            seed: 1,
            shaders: self.shaders.clone(),
        }
    }

    /// What a command that sweeps one input again is given besides the formula and the range.
    fn rerun(&self, plan: &SweepPlan<'_>) -> String {
        let mut rerun = String::new();
        if let Over::Number { .. } = plan.over {
            let _ = write!(rerun, " --over {} --output {}", plan.over_name(), plan.output_name());
        }
        let drawn = plan.drawn();
        for (name, values) in if drawn.is_empty() { &self.set } else { &drawn } {
            let values: Vec<String> = values.iter().map(f32::to_string).collect();
            let _ = write!(rerun, " --set {name}={}", values.join(","));
        }
        if plan.stage != Stage::Compute {
            let _ = write!(rerun, " --stage {}", plan.stage.name());
        }
        if let Some(adapter) = &self.adapter {
            let _ = write!(rerun, " --adapter {adapter}");
        }
        if self.profile.name != "wgsl" {
            let _ = write!(rerun, " --profile {}", self.profile.name);
        }
        rerun += &self.shaders.rerun().unwrap_or_default();
        rerun
    }
}

/// A shard has inputs.
fn check_shard(plan: &SweepPlan<'_>, shard: Shard) -> anyhow::Result<()> {
    if plan.span().blocks_of(shard) == 0 {
        let (blocks, name) = (plan.span().blocks(), name_of(shard));
        let most =
            if blocks == 1 { "one block, so one shard".into() } else { format!("{blocks} blocks, so {blocks} shards") };
        bail!("shard {name} has no inputs: the range has {most} at most");
    }
    Ok(())
}

/// A result as text or JSON.
pub(crate) fn written(document: &SweepDocument, format: PageFormat, rerun: &str) -> anyhow::Result<String> {
    match format {
        PageFormat::Json => Ok(document.to_json()?),
        PageFormat::Html => Ok(html::of_sweeps(&[swept(document.clone())])?),
        PageFormat::Text => {
            let catalogue = catalogue();
            let formula = catalogue.iter().find(|member| member.spec.id == document.sweep.formula);
            let mut out = String::new();
            text::write(document, formula.map_or("", |member| member.spec.text), rerun, &mut out)?;
            Ok(out)
        }
    }
}

/// Where a file is, however its path is written.
fn place_of(path: &Path) -> PathBuf {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match (parent.canonicalize(), path.file_name()) {
        (Ok(parent), Some(name)) => path.canonicalize().unwrap_or_else(|_| parent.join(name)),
        _ => path.to_owned(),
    }
}

/// Whether some input is outside its bound, or none was judged.
pub(crate) fn status(document: &SweepDocument) -> Status {
    let found = &document.statistics;
    // Where nothing is promised in a shard, another one may tell something.
    let is_whole = document.shard == name_of(Shard::WHOLE);
    match (found.failed, is_whole && found.indeterminate == found.inputs) {
        (0, true) => {
            say(
                "error: nothing was judged: nothing is promised of any input; sweep another range, or give other inputs by --set",
            );
            Status::Nothing
        }
        (0, false) => Status::Success,
        _ => Status::Failed,
    }
}

fn presets(format: PageFormat) -> anyhow::Result<String> {
    let range = |free: Free| match free {
        Free::Number { over, from, to, .. } => format!("{over} from {from} to {to}"),
        Free::Bytes => "source, destination, alpha".into(),
    };
    match format {
        PageFormat::Json => {
            let listed = |preset: &Preset| ListedPreset {
                formula: preset.formula.into(),
                over: range(preset.free),
                what: preset.what.into(),
            };
            let presets = PRESETS.iter().map(listed).collect();
            Ok(PresetsDocument { schema: SCHEMA.into(), presets }.to_json()?)
        }
        PageFormat::Html => anyhow::bail!("the list of ready-made sweeps is text or json"),
        PageFormat::Text => {
            let mut out = String::new();
            for preset in PRESETS {
                writeln!(out, "{:<28} {:<28} {}", preset.formula, range(preset.free), preset.what)?;
            }
            Ok(out)
        }
    }
}

/// A bar on standard error, where that is a terminal.
fn bar(document: &SweepDocument, shard: Shard) -> ProgressBar {
    let inputs = span(&document.sweep).inputs_of(shard, document.blocks);
    let bar = ProgressBar::with_draw_target(Some(inputs), ProgressDrawTarget::stderr());
    let template = "{bar:30} {human_pos}/{human_len} inputs  {rate} a second  {elapsed}, {eta} to go";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.with_key("rate", |state: &ProgressState, out: &mut dyn std::fmt::Write| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a rate that is read by people"
            )]
            let rate = state.per_sec() as u64;
            // A bar that cannot be written is left out.
            let _ = out.write_str(&thousands(rate));
        }));
    }
    bar.set_position(document.statistics.inputs);
    bar.reset_eta();
    bar
}

fn stage(text: &str) -> Result<Stage, String> {
    let stages = [Stage::Compute, Stage::Fragment, Stage::FixedFunction];
    let found = stages.into_iter().find(|stage| stage.name() == text);
    found.ok_or_else(|| "no such stage; expected compute, fragment or fixed-function".into())
}
