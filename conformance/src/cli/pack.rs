//! `lightmeter pack`.

use super::observed::happens;
use super::options::Targets;
use super::run::matching;
use super::say;
use super::{NothingToRun, Status};
use clap::Args;
use lightmeter::cases::blend::Samples;
use lightmeter::document::pack::Choice;
use lightmeter::gate::pack::{self, MOST_CASES};
use lightmeter::gate::plan::GatePlan;
use lightmeter::options::ASKED_CASES;
use std::path::PathBuf;

/// Which cases a renderer is asked.
#[derive(Debug, Args)]
pub(crate) struct Cases {
    /// Random cases for each formula; without it: 256
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MOST_CASES))]
    cases: Option<u64>,
    /// Seed of the random cases; without it: 1
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Pixels of the longer side of every scene; without it: the scenes' own
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8192))]
    size: Option<u32>,
}

impl Cases {
    /// What chooses the cases of globs.
    pub(crate) fn choice(&self, globs: &[String]) -> Choice {
        let (cases, seed) = (self.cases.unwrap_or(ASKED_CASES), self.seed.unwrap_or(1));
        Choice { filter: globs.to_vec(), cases, seed, size: self.size, ..Choice::default() }
    }

    /// The first of these options that is given.
    pub(crate) const fn asked(&self) -> Option<&'static str> {
        match self {
            Self { cases: Some(_), .. } => Some("--cases"),
            Self { seed: Some(_), .. } => Some("--seed"),
            Self { size: Some(_), .. } => Some("--size"),
            Self { cases: None, seed: None, size: None } => None,
        }
    }

    /// The plan of a choice, each of whose globs must match something.
    pub(crate) fn plan(&self, choice: Choice) -> anyhow::Result<GatePlan> {
        matching(&choice.filter, choice.cases, &Samples::default(), self.size)?;
        Ok(GatePlan::new(choice)?)
    }
}

/// That no renderer is asked for any of the cases.
pub(crate) fn nothing_to_ask() -> anyhow::Error {
    let message = "no renderer is asked these cases: nothing is promised of NaN and infinity in blending, deviations are those of drivers, \
                   and a pack has special values where it is written with --special";
    NothingToRun(message.into()).into()
}

/// Write the cases as files, for a renderer that answers by files: see docs/gate.md.
#[derive(Debug, Args)]
pub(crate) struct Pack {
    /// The folder to write
    dir: PathBuf,
    /// Globs that match an id or an ancestor of it: `fog`, `lighting/blinn`, `scene/phong*`; without them: all
    filter: Vec<String>,
    /// Ask for each blend state on this format as well: rgba32float, rgba16float, rgba8unorm, rgba8unorm-srgb or bgra8unorm; again for
    /// several; `all`. Without it: on none
    #[arg(long, value_name = "NAME", value_parser = super::options::Choice::target)]
    target: Vec<Targets>,
    /// Ask for special values as well: NaN, infinity, subnormals, signed zero and rounding, an operation at a time
    #[arg(long)]
    special: bool,
    /// Write the cases of formulas as arrays of NumPy's format, `columns/FORMULA/INPUT.npy`, a row a case, in the place of lines
    #[arg(long)]
    columns: bool,
    #[command(flatten)]
    cases: Cases,
}

impl Pack {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let targets = Targets::asked(&self.target).unwrap_or_default();
        let targets = targets.into_iter().map(|target| target.name().to_owned()).collect();
        let choice = Choice { targets, special: self.special, ..self.cases.choice(&self.filter) };
        let plan = self.cases.plan(choice)?;
        if plan.is_empty() {
            return Err(nothing_to_ask());
        }
        let manifest = pack::write(&plan, &self.dir, self.columns, &mut |file| happens("file", file))?;
        let on_targets: u64 = manifest.on_targets.values().sum();
        let besides = [(on_targets, "on targets"), (manifest.probes as u64, "special values")];
        let besides = besides.into_iter().filter(|(count, _)| *count > 0);
        let besides: String = besides.map(|(count, what)| format!("{count} {what}, ")).collect();
        let counted = |count: u64, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
        say(&format!(
            "{}: {}, {}, {besides}{}, {}; judge the answers by `lightmeter gate {} ANSWERS`",
            self.dir.display(),
            counted(plan.cases(), "case"),
            counted(manifest.formulas.len() as u64, "formula"),
            counted(manifest.scenes.len() as u64, "scene"),
            counted(manifest.files.len() as u64 + 1, "file"),
            self.dir.display()
        ));
        Ok(Status::Success)
    }
}
