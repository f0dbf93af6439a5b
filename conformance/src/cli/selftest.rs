//! `lightmeter selftest`.

use super::clock::now;
use super::observed::happens;
use super::options::{Choice, PageFormat, Targets};
use super::signals::{status_of, stopped_by_signals};
use super::{Status, writable};
use anyhow::bail;
use clap::{Args, ValueEnum};
use lightmeter::arithmetic::Profile;
use lightmeter::blend_unit::selftest::selftest;
use lightmeter::document::Document as _;
use lightmeter::document::event::Stop;
use lightmeter::document::report::Interrupted;
use lightmeter::document::selftest::{
    Mistake, NamedFrom, NoiseRecord, Record, Resolution, SCHEMA, SceneRecord, SceneResolution, SelftestDocument,
    UnitFinding, UnitRow,
};
use lightmeter::faults::calibrate::{CASES, calibrate};
use lightmeter::faults::noise::noise;
use lightmeter::faults::scene::calibrate::calibrate as measure;
use lightmeter::faults::scene::noise::noise as scene_noise;
use lightmeter::faults::scene::selftest as scenes;
use lightmeter::faults::selftest as formulas;
use lightmeter::faults::{Fault, LEAST_SHARE, LEAST_Z, faults, generated};
use lightmeter::filter::Filter;
use lightmeter::nearest::did_you_mean;
use lightmeter::report::html;
use lightmeter::report::page::selftest::SelftestRun;
use lightmeter::report::selftest as report;
use lightmeter::report::table::{Align, TextTable};
use lightmeter::scene::select::SIZE_AMONG_ALL;
use lightmeter::select::catalogue;
use lightmeter_scene::target::TargetFormat;
use std::collections::HashSet;
use std::fmt::Write as _;
use std::io::IsTerminal as _;
use std::path::PathBuf;

/// Pixels of the longer side of each scene.
const SCENE_SIZE: u32 = 64;

/// What is tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Mistakes in formulas.
    Formulas,
    /// Mistakes of a blend unit.
    BlendUnit,
    /// Mistakes of whole renderers, in the built-in scenes.
    Scenes,
    /// Noise in the place of formulas and scenes, which nothing may explain. It takes long, and runs only where it is named.
    Noise,
}

/// Show that the suite catches the mistakes that it knows and tells them by name: in formulas, in scenes, and of a blend unit
#[derive(Debug, Args)]
pub(crate) struct Selftest {
    /// Formulas to make mistakes in: globs of ids, as for `run`; without any, all, and scenes and the blend unit too
    #[arg(value_name = "FILTER")]
    filter: Vec<String>,
    /// Only one of them
    #[arg(long, value_enum, value_name = "PART")]
    only: Option<Part>,
    /// Random cases for each formula; a quarter of them for each of the many blend states
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u64).range(16..=65_536))]
    formula_cases: u64,
    /// Legal evaluations of each case, drawn at random, that must not be flagged
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u64).range(0..=1024))]
    draws: u64,
    /// Measure the smallest errors that are told, for each parameter of each formula, by 4,096 cases, and of each scene
    #[arg(long)]
    calibrate: bool,
    /// Accuracy rules, as for `run`
    #[arg(long, value_name = "NAME", default_value = "wgsl", value_parser = Choice::profile)]
    profile: &'static Profile,
    /// Seed of the random cases
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Format to blend on, as for `run`; without it: all
    #[arg(long, value_name = "NAME", value_parser = Choice::target)]
    target: Vec<Targets>,
    /// Pairs of source and destination for each of the 1,125 states
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u64).range(16..=65_536))]
    cases: u64,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: PageFormat,
    /// Write it to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// What was found out; `None` of a part that was not tested.
#[derive(Default)]
struct Tested {
    formulas: Option<Record>,
    resolutions: Vec<Resolution>,
    scenes: Option<SceneRecord>,
    scene_resolutions: Vec<SceneResolution>,
    unit: Option<Vec<UnitRow>>,
    noise: Option<NoiseRecord>,
    interrupted: Option<Interrupted>,
}

impl Selftest {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        if !self.wants(Part::Formulas) && self.only != Some(Part::Noise) && !self.filter.is_empty() {
            bail!("a filter selects formulas; remove it, or remove the `--only` that leaves formulas out");
        }
        let targets = Targets::asked(&self.target).unwrap_or_else(|| TargetFormat::ALL.to_vec());
        writable(self.out.as_deref())?;
        let tested = self.test(&targets, &stopped_by_signals()?)?;
        let text = match self.format {
            PageFormat::Json => self.json(&tested)?,
            PageFormat::Html => {
                html::of_selftest(&SelftestRun::read(&self.json(&tested)?).map_err(anyhow::Error::msg)?)?
            }
            PageFormat::Text => tested.text(&targets)?,
        };
        self.format.emit(&text, self.out.as_deref())?;
        Ok(match &tested.interrupted {
            Some(interrupted) => status_of(interrupted),
            None if tested.is_good() => Status::Success,
            None => Status::Failed,
        })
    }

    fn json(&self, tested: &Tested) -> anyhow::Result<String> {
        let document = SelftestDocument {
            schema: SCHEMA.into(),
            command: Some(super::command()),
            version: Some(env!("CARGO_PKG_VERSION").into()),
            made_at: now(),
            seed: Some(self.seed),
            rows: tested.unit.clone().unwrap_or_default(),
            kills: tested.formulas.as_ref().map(|record| record.kills.clone()),
            clean: tested.formulas.as_ref().map(|record| record.clean.clone()),
            mistakes: tested.formulas.as_ref().map_or_else(Vec::new, mistakes),
            named_from: (!tested.resolutions.is_empty()).then_some(NAMED_FROM),
            calibration: tested.formulas.is_some().then(|| tested.resolutions.clone()),
            noise: tested.noise.clone(),
            scenes: tested.scenes.clone(),
            scene_calibration: tested.scene_resolutions.clone(),
            interrupted: tested.interrupted.clone(),
        };
        Ok(document.to_json()?)
    }

    fn wants(&self, part: Part) -> bool {
        self.only.is_none_or(|only| only == part)
    }

    fn test(&self, targets: &[TargetFormat], stop: &Stop) -> anyhow::Result<Tested> {
        let filter = Filter::new(&self.filter)?;
        let mut tested = Tested::default();
        let mut under_way = String::new();
        let mut say = |what: &str| {
            say(what);
            happens("group", what);
            what.clone_into(&mut under_way);
        };
        if self.wants(Part::Formulas) {
            self.test_formulas(filter, stop, &mut say, &mut tested)?;
        } else if self.only == Some(Part::Noise) {
            say("noise in the place of every formula");
            let options = self.options(filter, stop);
            let mut record = noise(&options, &|formula| happens("tried", formula));
            let mut progress = |id: &str| say(&format!("noise in the place of {id}"));
            let scenes = scene_noise(SCENE_SIZE, &options, &mut progress)?;
            record.tried += scenes.tried;
            record.explained.extend(scenes.explained);
            tested.noise = Some(record);
        }
        let is_asked = |part| self.wants(part) && self.filter.is_empty() && !stop.is_set();
        if is_asked(Part::Scenes) {
            let mut progress = |id: &str| say(&format!("every mistake in {id}"));
            tested.scenes = Some(scenes::selftest(SCENE_SIZE, self.profile, stop, &mut progress)?);
            if self.calibrate && !stop.is_set() {
                let mut progress = |id: &str| say(&format!("the smallest errors in {id}"));
                tested.scene_resolutions = measure(SIZE_AMONG_ALL, self.profile, stop, &mut progress)?;
            }
        }
        if is_asked(Part::BlendUnit) {
            for &target in targets {
                say(&format!("every fault on {}", target.name()));
                let Some(rows) = selftest(&[target], self.cases, stop, &mut |_| {})? else { break };
                tested.unit.get_or_insert_default().extend(rows);
            }
        }
        tested.interrupted = stop.interrupted("the self-test", &under_way);
        Ok(tested)
    }

    fn options(&self, filter: Filter, stop: &Stop) -> formulas::SelftestOptions {
        formulas::SelftestOptions {
            filter,
            cases: self.formula_cases,
            seed: self.seed,
            draws: self.draws,
            profile: self.profile,
            stop: stop.clone(),
        }
    }

    fn test_formulas(
        &self,
        filter: Filter,
        stop: &Stop,
        say: &mut impl FnMut(&str),
        tested: &mut Tested,
    ) -> anyhow::Result<()> {
        say("every mistake in every formula that it concerns");
        let options = self.options(filter, stop);
        let record = formulas::selftest(&options, &|formula| happens("tried", formula));
        if record.clean.is_empty() && !stop.is_set() {
            let catalogue = catalogue();
            let names = catalogue.iter().map(|member| member.spec.id.as_str());
            let meant = did_you_mean(self.filter.first().map_or("", String::as_str), names);
            bail!("no formula matches `{}`{meant} See `lightmeter list`", self.filter.join(" "));
        }
        tested.formulas = Some(record);
        if self.calibrate && !stop.is_set() {
            say("measuring the smallest errors that are named");
            tested.resolutions = calibrate(&options);
        }
        Ok(())
    }
}

impl Tested {
    fn is_good(&self) -> bool {
        self.interrupted.is_none()
            && self.unit.iter().flatten().all(|row| row.finding.is_good())
            && self.formulas.iter().all(Record::is_good)
            && self.scenes.iter().all(SceneRecord::is_good)
            && self.noise.iter().all(NoiseRecord::is_good)
    }

    /// The parts that were tested, an empty line between them.
    fn text(&self, targets: &[TargetFormat]) -> anyhow::Result<String> {
        let mut parts = vec![];
        if let Some(record) = &self.formulas {
            let mut text = String::new();
            report::text(record, &mistakes(record), &self.resolutions, &mut text)?;
            parts.push(text);
        }
        if let Some(scenes) = &self.scenes {
            let mut text = String::new();
            scenes::text(scenes, &mut text)?;
            report::scene_resolutions(&self.scene_resolutions, &mut text)?;
            parts.push(text);
        }
        if let Some(rows) = &self.unit {
            parts.push(table(targets, rows)?);
        }
        parts.extend(self.noise.as_ref().map(report::noise));
        parts.extend(self.interrupted.as_ref().map(|interrupted| format!("interrupted: {interrupted}\n")));
        Ok(parts.join("\n"))
    }
}

/// Says what is under way, where somebody reads it.
fn say(what: &str) {
    if std::io::stderr().is_terminal() {
        super::say(what);
    }
}

/// From where on the suite names errors.
const NAMED_FROM: NamedFrom = NamedFrom { cases: CASES, least_z: LEAST_Z, least_share: LEAST_SHARE };

/// The mistakes that were tried: all of the tables, and of those that follow from a formula's steps what concerned one.
fn mistakes(record: &Record) -> Vec<Mistake> {
    let mistake = |fault: &&Fault| Mistake {
        name: fault.name.into(),
        says: fault.says.into(),
        seen_in: fault.seen_in.map(Into::into),
        generated: fault.is_generated,
    };
    let tried: HashSet<&str> = record.kills.iter().map(|kill| &*kill.fault).collect();
    let derived = generated().iter().filter(|fault| tried.contains(fault.name));
    faults().iter().chain(derived).map(mistake).collect()
}

fn word(finding: UnitFinding) -> &'static str {
    match finding {
        UnitFinding::Named => "named",
        UnitFinding::Caught => "caught, not named",
        UnitFinding::Survived => "SURVIVED",
        UnitFinding::NotApplicable => "—",
        UnitFinding::Clean => "clean",
        UnitFinding::FalseAlarm => "FALSE ALARM",
    }
}

fn table(targets: &[TargetFormat], rows: &[UnitRow]) -> anyhow::Result<String> {
    let mut text = String::new();
    let targets: Vec<&TargetFormat> =
        targets.iter().filter(|target| rows.iter().any(|row| row.target == target.name())).collect();
    let names = targets.iter().map(|target| (target.name(), Align::Left));
    let mut table = TextTable::new(&std::iter::once(("blend unit", Align::Left)).chain(names).collect::<Vec<_>>());
    let first = targets.first().map(|target| target.name()).unwrap_or_default();
    for name in rows.iter().filter(|row| row.target == first).map(|row| &row.fault) {
        let words = rows.iter().filter(|row| row.fault == *name).map(|row| word(row.finding).to_owned());
        table.row(std::iter::once(name.to_string()).chain(words));
    }
    text.push_str(&table.text(""));
    for row in rows.iter().filter(|row| !row.finding.is_good()) {
        writeln!(text, "\n{} on {}: {}", row.fault, row.target, word(row.finding))?;
        for said in &row.said {
            writeln!(text, "  {said}")?;
        }
    }
    Ok(text)
}
