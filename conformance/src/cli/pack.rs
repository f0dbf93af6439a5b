//! `lightmeter pack`.

use super::options::Targets;
use super::run::matching;
use super::{NothingToRun, Status};
use clap::Args;
use lightmeter::cases::blend::Samples;
use lightmeter::document::pack::Choice;
use lightmeter::gate::pack;
use lightmeter::gate::plan::GatePlan;
use lightmeter_scene::target::TargetFormat;
use std::path::PathBuf;

/// Which cases a renderer is asked.
#[derive(Debug, Args)]
pub(crate) struct Cases {
    /// Random cases for each formula
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    cases: u64,
    /// Seed of the random cases
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Pixels of the longer side of every scene; without it: the scenes' own
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8192))]
    size: Option<u32>,
}

impl Cases {
    /// The plan of globs, each of which must match something, and of targets.
    pub(crate) fn plan(&self, globs: &[String], targets: &[TargetFormat]) -> anyhow::Result<GatePlan> {
        matching(globs, self.cases, &Samples::default(), self.size)?;
        let targets = targets.iter().map(|target| target.name().to_owned()).collect();
        let choice = Choice { filter: globs.to_vec(), cases: self.cases, seed: self.seed, size: self.size, targets };
        let plan = GatePlan::new(choice)?;
        if plan.cases() + plan.pixels() == 0 && plan.scenes.is_empty() {
            let message = "of these cases nothing is promised, so that no renderer is asked them";
            return Err(NothingToRun(message.into()).into());
        }
        Ok(plan)
    }
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
    #[command(flatten)]
    cases: Cases,
}

impl Pack {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let plan = self.cases.plan(&self.filter, &Targets::asked(&self.target).unwrap_or_default())?;
        let manifest = pack::write(&plan, &self.dir)?;
        let on_targets: u64 = manifest.on_targets.values().sum();
        let besides = if on_targets > 0 { format!("{on_targets} on targets, ") } else { String::new() };
        eprintln!(
            "{}: {} cases of {} formulas, {besides}{} scenes, {} files; judge the answers by `lightmeter gate {} ANSWERS`",
            self.dir.display(),
            plan.cases(),
            manifest.formulas.len(),
            manifest.scenes.len(),
            manifest.files.len() + 1,
            self.dir.display()
        );
        Ok(Status::Success)
    }
}
