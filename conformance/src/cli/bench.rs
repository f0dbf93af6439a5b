//! `lightmeter bench`.

use super::clock::now;
use super::options::Choice;
use super::progress::Bar;
use super::shader::ShaderChoice;
use super::signals::{status_of, stopped_by_signals};
use super::terminal::level;
use super::visit::opened;
use super::{NothingToRun, Status, emit, show, writable};
use clap::{Args, ValueEnum};
use lightmeter::arithmetic::Profile;
use lightmeter::bench::{BenchOptions, bench};
use lightmeter::document::Document as _;
use lightmeter::document::bench::BenchDocument;
use lightmeter::document::bench::recommendation::Inputs;
use lightmeter::filter::Filter;
use lightmeter::nearest::did_you_mean;
use lightmeter::report::bench::recommend::{self, Limit, recommend};
use lightmeter::report::bench::{page, text};
use lightmeter::report::html;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::load;
use lightmeter::scene::select::scene_id;
use lightmeter::select::catalogue;
use lightmeter::subject_gpu::device_error;
use lightmeter_gpu::{ClockKind, Shaders};
use std::path::{Path, PathBuf};

/// Measure what accuracy costs in time: each technique at each rung of the ladder, its error and its time.
#[derive(Debug, Args)]
pub(crate) struct Bench {
    /// Groups to measure, as globs: `fog`, `lighting/blinn`, `technique/*`, `stable/**`, `scene/teapot`, `scaling/lights`; or
    /// a scene's file, whose name ends in .json
    filter: Vec<String>,
    /// Fewer groups, cases and turns: done within a minute
    #[arg(long)]
    quick: bool,
    /// Adapter to measure, as for `run`; without it: lavapipe, or the first there is
    #[arg(long, value_name = "NAME")]
    adapter: Vec<String>,
    /// How GPU times are told; without it: by timestamps where the adapter has them
    #[arg(long, value_enum, value_name = "CLOCK")]
    clock: Option<Clock>,
    /// Seed of the random cases
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Accuracy rules: wgsl, vulkan or opengl
    #[arg(long, value_name = "NAME", default_value = "wgsl", value_parser = Choice::profile)]
    profile: &'static Profile,
    #[command(flatten)]
    shaders: ShaderChoice,
    /// Name the cheapest row of each group whose largest error is at most this: absolute as `1e-4`, or `4ulp`, or `0.5/255`
    #[arg(long, value_name = "ERROR", allow_hyphen_values = true)]
    recommend: Option<Limit>,
    /// The inputs that it must hold on: random, hard or all
    #[arg(long, value_name = "INPUTS", default_value = "all", requires = "recommend")]
    inputs: Inputs,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Text: every formula, row by row
    #[arg(long)]
    details: bool,
    /// Write it to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// How output is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Json,
    /// A table for a README
    Markdown,
    /// A page to look at, one file with everything in it
    Html,
}

/// How GPU times are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Clock {
    /// By the device's timestamps
    Timestamps,
    /// By the clock on the wall
    Wall,
}

impl Bench {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let (files, globs): (Vec<String>, Vec<String>) = self
            .filter
            .iter()
            .cloned()
            .partition(|name| Path::new(name).extension().is_some_and(|end| end.eq_ignore_ascii_case("json")));
        let scenes = files.iter().map(|file| {
            let name = Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let loaded = load::scene(file).map_err(|error| anyhow::anyhow!("{file}: {error}"))?;
            Ok((name, loaded))
        });
        let filter = Filter::new(&globs)?;
        let accepted = self.shaders.accepted(&filter, &self.adapter, true)?;
        let options = BenchOptions {
            filter,
            scenes: scenes.collect::<anyhow::Result<_>>()?,
            quick: self.quick,
            seed: self.seed,
            clock: self.clock.map(|clock| match clock {
                Clock::Timestamps => ClockKind::Timestamps,
                Clock::Wall => ClockKind::Wall,
            }),
            profile: self.profile,
            shaders: if accepted.adapted.is_empty() { accepted.shaders()? } else { Shaders::built_in()? },
            own: self.shaders.own.beside(&accepted)?,
            command: self.command(),
            stop: stopped_by_signals()?,
        };
        let mut names: Vec<&str> = options.scenes.iter().map(|(name, _)| name.as_str()).collect();
        names.sort_unstable();
        if let Some(twice) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            anyhow::bail!(
                "two files are called `{0}.json`: their groups would both be scene/{0}; rename one",
                twice[0]
            );
        }
        if self.recommend.is_some() && matches!(self.format, Format::Markdown | Format::Html) {
            anyhow::bail!("a recommendation is written as text or json");
        }
        writable(self.out.as_deref())?;
        let subjects = opened(&self.adapter)?;
        if self.adapter == ["cpu"] && !self.measures_formulas(&options.filter) {
            let message = "the embedded implementation has no shaders: formulas alone are measured of it";
            return Err(NothingToRun(message.into()).into());
        }
        let mut bar = Bar::new(None, "groups");
        let document = bench(&subjects, &options, &mut bar);
        bar.bar.finish_and_clear();
        let document = BenchDocument { made_at: now(), ..document.map_err(device_error)? };
        let is_whole = document.interrupted.is_none();
        if is_whole && document.adapters.iter().all(|adapter| adapter.groups.is_empty() && adapter.scalings.is_empty())
        {
            let formulas = catalogue().into_iter().map(|member| member.spec.id);
            let names: Vec<String> = formulas.chain((0..SCENES.len()).map(scene_id)).collect();
            let glob = self.filter.first().map_or("", String::as_str);
            let meant = did_you_mean(glob, names.iter().map(String::as_str));
            anyhow::bail!(
                "no group matches `{glob}`{meant} There are the formulas, as fog/exp, technique/*, stable/**, scene/* and scaling/*"
            );
        }
        let (text, file) = (self.write(&document)?, self.out.as_deref());
        if self.format == Format::Text {
            show(&text, file)?
        } else {
            emit(&text, file)?
        }
        Ok(document.interrupted.as_ref().map_or(Status::Success, status_of))
    }

    fn write(&self, document: &BenchDocument) -> anyhow::Result<String> {
        let mut out = String::new();
        match (self.recommend, self.format) {
            (None, Format::Json) => out = document.to_json()?,
            (None, Format::Text) => text::write(document, self.details, level(), &mut out)?,
            (None, Format::Markdown) => page::readme(document, &mut out)?,
            (None, Format::Html) => out = html::of_bench(document).map_err(anyhow::Error::from_boxed)?,
            (Some(limit), format) => {
                let recommendation = recommend(document, limit, self.inputs);
                match format {
                    Format::Json => out = recommendation.to_json()?,
                    Format::Text => recommend::write(&recommendation, &mut out)?,
                    Format::Markdown | Format::Html => unreachable!("it was refused"),
                }
            }
        }
        Ok(out)
    }

    /// The command, but for where its result goes.
    fn command(&self) -> String {
        let mut command = "lightmeter bench".to_owned();
        for filter in &self.filter {
            command += &format!(" '{filter}'");
        }
        for adapter in &self.adapter {
            command += &format!(" --adapter {adapter}");
        }
        if self.quick {
            command += " --quick";
        }
        if let Some(clock) = self.clock.and_then(|clock| clock.to_possible_value()) {
            command += &format!(" --clock {}", clock.get_name());
        }
        if self.seed != 1 {
            command += &format!(" --seed {}", self.seed);
        }
        if self.profile.name != "wgsl" {
            command += &format!(" --profile {}", self.profile.name);
        }
        command += &self.shaders.rerun().unwrap_or_default();
        command
    }

    /// Whether any formula is asked for.
    fn measures_formulas(&self, filter: &Filter) -> bool {
        let asked = |id: &str| filter.selects(id);
        let has_files = self.filter.len() > filter.globs().count();
        (!has_files || !filter.is_empty())
            && catalogue().iter().any(|member| asked(&member.spec.id) || asked(member.spec.group()))
    }
}
