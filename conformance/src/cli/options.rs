//! Options that several commands share, read into what the library takes.

use super::shader::ShaderChoice;
use super::visit::opened;
use super::{Status, emit, say, show, writable};
use anyhow::bail;
use clap::Args;
use lightmeter::arithmetic::Profile;
use lightmeter::device::Code;
use lightmeter::document::by_case::Coverage;
use lightmeter::document::{Number, thousands};
use lightmeter::filter::Filter;
use lightmeter::nearest::did_you_mean;
use lightmeter::options::{DEFAULT_CASES, DEFAULT_TARGETS, MOST_CASES, Options};
use lightmeter::scene::library::SCENES;
use lightmeter::scene::select::scene_id;
use lightmeter::select::Shard;
use lightmeter::subject::Subject;
use lightmeter_scene::target::TargetFormat;
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// What `--target` names: one format, or all.
#[derive(Clone, Debug)]
pub(crate) struct Targets(Vec<TargetFormat>);

impl Targets {
    /// The formats that were asked for, each once, in the order of reports; `None` where none was.
    pub(crate) fn asked(asked: &[Self]) -> Option<Vec<TargetFormat>> {
        let asked: Vec<TargetFormat> = asked.iter().flat_map(|targets| targets.0.iter().copied()).collect();
        let each = TargetFormat::ALL.into_iter().filter(|target| asked.contains(target)).collect();
        (!asked.is_empty()).then_some(each)
    }
}

/// How output is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Format {
    Text,
    Json,
}

/// How the result of a run or a gate is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ReportFormat {
    Text,
    Json,
    Junit,
    /// Lines that GitHub Actions shows as annotations
    Github,
    /// A page to look at, one file with everything in it
    Html,
}

/// How the result of a sweep or a self-test is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum PageFormat {
    Text,
    Json,
    /// A page to look at, one file with everything in it
    Html,
}

impl PageFormat {
    /// Writes the result to a file, or shows it.
    pub(crate) fn emit(self, text: &str, file: Option<&Path>) -> anyhow::Result<()> {
        if self == Self::Text { show(text, file) } else { emit(text, file) }
    }
}

impl Format {
    /// Writes the result to a file, or shows it.
    pub(crate) fn emit(self, text: &str, file: Option<&Path>) -> anyhow::Result<()> {
        if self == Self::Text { show(text, file) } else { emit(text, file) }
    }
}

impl ReportFormat {
    /// Writes the result to a file, or shows it.
    pub(crate) fn emit(self, text: &str, file: Option<&Path>) -> anyhow::Result<()> {
        if self == Self::Text { show(text, file) } else { emit(text, file) }
    }
}

/// The file that the result is also written to as JSON.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct AlsoJson {
    /// Write the result to a file as JSON too, whatever --format is
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

impl AlsoJson {
    /// The file.
    pub(crate) const fn file(&mut self) -> Option<&mut PathBuf> {
        self.json.as_mut()
    }

    /// That the file can be written, and is none of those that the options name besides, before anything is judged.
    pub(crate) fn is_writable(&self, others: [(&str, Option<&Path>); 3]) -> anyhow::Result<()> {
        let Some(json) = &self.json else { return Ok(()) };
        let place = |path: &Path| path.canonicalize().or_else(|_| std::path::absolute(path)).unwrap_or_default();
        if let Some((name, _)) = others.iter().find(|(_, other)| other.is_some_and(|other| place(other) == place(json)))
        {
            bail!("`--json` and `--{name}` both name {}; choose two files", json.display());
        }
        writable(Some(json))
    }

    /// Writes it, where that was asked for.
    pub(crate) fn emit<E>(&self, json: impl FnOnce() -> Result<String, E>) -> anyhow::Result<()>
    where
        anyhow::Error: From<E>,
    {
        self.json.as_deref().map_or(Ok(()), |file| emit(&json()?, Some(file)))
    }
}

/// Which cases, on what, by which rules.
#[derive(Clone, Debug, Args)]
pub(crate) struct Choice {
    /// Adapter to run on, by its short name in `lightmeter adapters`; `cpu` for the embedded implementation; `all`.
    /// Again for several. Without it: lavapipe, or the first adapter there is
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Vec<String>,
    /// Accuracy rules: wgsl, vulkan or opengl
    #[arg(long, value_name = "NAME", default_value = "wgsl", value_parser = Choice::profile)]
    pub(crate) profile: &'static Profile,
    /// Format to blend on: rgba32float, rgba16float, rgba8unorm, rgba8unorm-srgb or bgra8unorm; again for several; `all`.
    /// Without it: rgba32float and rgba8unorm
    #[arg(long, value_name = "NAME", value_parser = Choice::target)]
    pub(crate) target: Vec<Targets>,
    /// Pixels of the longer side of every scene; without it: the scenes' own, and 256 in a run of everything
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8192))]
    pub(crate) size: Option<u32>,
    /// Seed of the random cases
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) shaders: ShaderChoice,
}

/// How many cases.
#[derive(Clone, Debug, Args)]
pub(crate) struct Amount {
    /// Random cases for each formula, and pairs for each blend state; a sixteenth of them for a state in a shader
    #[arg(long, value_name = "N", default_value_t = DEFAULT_CASES, value_parser = clap::value_parser!(u64).range(1..=MOST_CASES))]
    pub(crate) cases: u64,
    /// Only a part of the cases: the I-th of N
    #[arg(long, value_name = "I/N", default_value = "1/1", allow_hyphen_values = true)]
    pub(crate) shard: ShardArgument,
}

/// `I/N` on the command line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShardArgument(pub(crate) Shard);

impl FromStr for ShardArgument {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || format!("`{text}` is not a shard; expected I/N with 1 ≤ I ≤ N, as 2/8");
        let (index, count) = text.split_once('/').ok_or_else(expected)?;
        let (index, count): (u64, NonZeroU64) =
            (index.parse().map_err(|_| expected())?, count.parse().map_err(|_| expected())?);
        if index == 0 || index > count.get() {
            return Err(expected());
        }
        Ok(Self(Shard { index: index - 1, count }))
    }
}

impl std::fmt::Display for ShardArgument {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.0.index + 1, self.0.count)
    }
}

impl Choice {
    /// The profile of that name.
    pub(crate) fn profile(name: &str) -> Result<&'static Profile, String> {
        let near = || did_you_mean(name, lightmeter::arithmetic::profile::PROFILES.iter().map(|profile| profile.name));
        Profile::named(name).map_err(|error| error + &near())
    }

    /// The format of that name, or all.
    pub(crate) fn target(name: &str) -> Result<Targets, String> {
        let names: Vec<&str> = TargetFormat::ALL.iter().map(|target| target.name()).collect();
        if name == "all" {
            return Ok(Targets(TargetFormat::ALL.to_vec()));
        }
        let found = TargetFormat::by_name(name).map(|target| Targets(vec![target]));
        let near = || did_you_mean(name, names.iter().copied());
        found.ok_or_else(|| format!("no such format; expected one of {} and all{}", names.join(", "), near()))
    }

    /// The formats to blend on, each once, in the order of reports.
    pub(crate) fn targets(&self) -> Vec<TargetFormat> {
        Targets::asked(&self.target).unwrap_or_else(|| DEFAULT_TARGETS.to_vec())
    }

    /// The shaders to judge, those of scenes among them or not.
    pub(crate) fn code(&self, filter: &Filter, has_scenes: bool) -> anyhow::Result<Code> {
        // Only a run holds inputs in its cases.
        self.shaders.own.without_constants()?;
        self.shaders.accepted(filter, &self.adapter, has_scenes)?.code()
    }

    /// The library's options for a filter.
    pub(crate) fn options(&self, filter: Filter, cases: u64, shard: Shard) -> anyhow::Result<Options> {
        let has_scenes = (0..SCENES.len()).any(|place| filter.selects(&scene_id(place)));
        let accepted = self.shaders.accepted(&filter, &self.adapter, has_scenes)?;
        let mut options = Options::by(accepted.code()?, None, self.seed, self.profile);
        options.adapted = accepted.adapted.clone();
        options.rerun += &self.shaders.rerun()?;
        Ok(Options { filter, cases, shard, targets: self.targets(), size: self.size, ..options })
    }

    /// The adapters that were named.
    pub(crate) fn adapters(&self) -> &[String] {
        &self.adapter
    }

    /// The subjects that were asked for, opened.
    pub(crate) fn subjects(&self) -> anyhow::Result<Vec<Subject>> {
        opened(&self.adapter)
    }
}

/// The part of what is chosen that must be judged.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct Required {
    /// The part of the chosen cases that must be judged, from 0 to 1: with less the command ends with 1
    #[arg(long, value_name = "SHARE", default_value_t = Coverage::REQUIRED, value_parser = share)]
    require: f64,
}

fn share(text: &str) -> Result<f64, String> {
    let share: Option<f64> = text.parse().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "expected a part of 1, such as 0.25".to_owned())
}

impl Default for Required {
    fn default() -> Self {
        Self { require: Coverage::REQUIRED }
    }
}

impl Required {
    /// The part, as a result says it.
    pub(crate) const fn part(self) -> Number {
        Number(self.require)
    }

    /// Success where enough was judged.
    pub(crate) fn status(self, coverage: Coverage) -> Status {
        let Coverage { chosen, judged, excluded } = coverage;
        if coverage.is_enough(self.require) {
            return Status::Success;
        }
        #[expect(clippy::cast_precision_loss, reason = "counts of cases")]
        let share = judged as f64 / chosen.max(1) as f64;
        // Two digits, rounded downwards, so that what is accepted is what there was.
        let digits = 10_f64.powf(1.0 - share.log10().floor());
        let accepted = if share > 0.0 { (share * digits).floor() / digits } else { 0.0 };
        let [chosen, judged, excluded] = [chosen, judged, excluded].map(thousands);
        say(&format!(
            "error: of {chosen} chosen cases {judged} were judged and {excluded} excluded, which is less than the part of {} that is \
             required\n  choose what can be judged by a filter such as 'fog/*', or accept this share by `--require {accepted}`",
            self.require
        ));
        Status::Failed
    }
}
