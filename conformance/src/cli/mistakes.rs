//! `lightmeter mistakes`.

use super::Status;
use super::options::Format;
use anyhow::bail;
use clap::Args;
use lightmeter::cases::Kind;
use lightmeter::document::Document as _;
use lightmeter::document::mistakes::{KnownMistake, MistakeOf, MistakesDocument, SCHEMA};
use lightmeter::faults::scene::{SCENE_FAULTS, SceneFault, looks};
use lightmeter::faults::{Fault, concerning, faults, generated, look};
use lightmeter::filter::Filter;
use lightmeter::nearest::did_you_mean;
use lightmeter::report;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::select::scene_id;
use lightmeter::select::{Member, catalogue};
use rayon::prelude::*;
use std::path::PathBuf;

/// List the mistakes that the suite names: what each does, where it was seen, and which formulas it concerns
///
/// `lightmeter mistakes 'fog-*'` tells more of some of them. `eval`, `show` and `render` take `--mistake NAME` to compute as a renderer
/// that makes it.
#[derive(Debug, Args)]
pub(crate) struct Mistakes {
    /// Names of mistakes, as globs: `fog-radial` or `shininess-*`; without any, all
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Only mistakes that concern one of these formulas, or show in one of these scenes: globs of ids, as for `run`
    #[arg(long, value_name = "FILTER")]
    formula: Vec<String>,
    /// How they are written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Write them to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Mistakes {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let document = document(&self.names, &self.formula)?;
        let text = match self.format {
            Format::Text => report::mistakes::text(&document, !self.names.is_empty()),
            Format::Json => document.to_json()?,
        };
        self.format.emit(&text, self.out.as_deref())?;
        Ok(Status::Success)
    }
}

/// The mistakes of these names that concern one of these formulas; without any, all.
pub(crate) fn document(names: &[String], formulas: &[String]) -> anyhow::Result<MistakesDocument> {
    let is_known = |name: &str| {
        let only = Filter::new(&[name.to_owned()]);
        all_names().any(|known| only.as_ref().is_ok_and(|only| only.selects(known)))
    };
    if let Some(name) = names.iter().find(|name| !is_known(name)) {
        bail!(unknown(name));
    }
    let is_about_some = !names.is_empty() || !formulas.is_empty();
    let (asked, named) = (formulas, Filter::new(names)?);
    let formulas = Filter::new(formulas)?;
    let members: Vec<Member> = catalogue().into_iter().filter(|member| formulas.selects(&member.spec.id)).collect();
    let is_scene = |id: &str| formulas.selects(id);
    let has_scenes = (0..SCENES.len()).any(|place| is_scene(&scene_id(place)));
    if members.is_empty() && !has_scenes {
        bail!("no formula or scene matches `{}`: see `lightmeter list`", asked.join(" "));
    }
    let concerned: Vec<Vec<&'static Fault>> = members.par_iter().map(concerning).collect();
    // Those that follow from a formula's steps are many: they are told where one is asked for.
    let derived = if is_about_some { generated() } else { &[] };
    let all = faults().iter().chain(derived).copied();
    let selected: Vec<&'static Fault> = all.filter(|fault| named.selects(fault.name)).collect();
    let mut mistakes: Vec<KnownMistake> =
        selected.into_par_iter().map(|fault| known(fault, &members, &concerned)).collect();
    mistakes.retain(|mistake| !mistake.formulas.is_empty());
    let mut in_scenes = of_scenes(&named);
    if is_about_some {
        shown_in(&mut in_scenes, is_scene)?;
    }
    mistakes.extend(in_scenes);
    if mistakes.is_empty() {
        bail!("no mistake of these names concerns `{}`", asked.join(" "));
    }
    Ok(MistakesDocument { schema: SCHEMA.into(), mistakes })
}

pub(crate) fn all_names() -> impl Iterator<Item = &'static str> {
    faults().iter().chain(generated()).map(|fault| fault.name).chain(SCENE_FAULTS.iter().map(|fault| fault.name))
}

/// What is said of a name that no mistake has.
fn unknown(name: &str) -> String {
    if name.contains(['*', '?', '[', '{']) {
        let matching =
            Filter::new(&[name.to_owned()]).map(|filter| all_names().filter(|known| filter.selects(known)).count());
        return match matching {
            Ok(0) | Err(_) => format!("no mistake's name matches `{name}`: see `lightmeter mistakes`"),
            Ok(count) => format!("`{name}` matches {count} names; expected the name of one mistake"),
        };
    }
    if name.is_empty() {
        return "a mistake's name is missing: see `lightmeter mistakes`".into();
    }
    format!("no mistake `{name}`{} `lightmeter mistakes` lists them", did_you_mean(name, all_names()))
}

/// The mistake of a name, which `--mistake` asks for.
pub(crate) fn by_name(name: &str) -> Result<&'static Fault, String> {
    Fault::by_name(name).ok_or_else(|| match SCENE_FAULTS.iter().any(|fault| fault.name == name) {
        true => format!("`{name}` is a mistake in scenes: ask `render` for it"),
        false => unknown(name),
    })
}

/// The mistake in scenes of a name.
pub(crate) fn of_scenes_by_name(name: &str) -> Result<&'static SceneFault, String> {
    SCENE_FAULTS.iter().find(|fault| fault.name == name).ok_or_else(|| match Fault::by_name(name) {
        Some(_) => format!("`{name}` is a mistake in formulas: ask `eval` or `show` for it"),
        None => unknown(name),
    })
}

fn known(fault: &'static Fault, members: &[Member], concerned: &[Vec<&'static Fault>]) -> KnownMistake {
    let is_made = |of: &&(&Member, &Vec<&'static Fault>)| of.1.iter().any(|one| std::ptr::eq(*one, fault));
    let pairs: Vec<(&Member, &Vec<&'static Fault>)> = members.iter().zip(concerned).collect();
    let of: Vec<&Member> = pairs.iter().filter(is_made).map(|(member, _)| *member).collect();
    let is_one_of_many = |member: &&&Member| matches!(member.spec.kind, Kind::Blend(_)) && !is_mode(member);
    KnownMistake {
        name: fault.name.into(),
        says: fault.says.into(),
        of: MistakeOf::Formulas,
        seen_in: fault.seen_in.map(Into::into),
        formulas: of.iter().map(|member| member.spec.id.clone()).collect(),
        looks: of.iter().filter(|member| !is_one_of_many(member)).filter_map(|member| look(member, fault)).collect(),
    }
}

fn is_mode(member: &Member) -> bool {
    member.spec.id.starts_with("blend/mode-")
}

/// Draws the scenes that are asked for with each mistake; what shows in none of them is not of them.
fn shown_in(mistakes: &mut Vec<KnownMistake>, is_scene: impl Fn(&str) -> bool) -> anyhow::Result<()> {
    let is_of = |fault: &&SceneFault| mistakes.iter().any(|mistake| &*mistake.name == fault.name);
    let faults: Vec<&'static SceneFault> = SCENE_FAULTS.iter().filter(is_of).collect();
    for (mistake, looks) in mistakes.iter_mut().zip(looks(&faults, is_scene)?) {
        mistake.formulas = looks.iter().map(|look| look.formula.clone()).collect();
        mistake.looks = looks;
    }
    mistakes.retain(|mistake| !mistake.formulas.is_empty());
    Ok(())
}

fn of_scenes(names: &Filter) -> Vec<KnownMistake> {
    let selected = SCENE_FAULTS.iter().filter(|fault| names.selects(fault.name));
    let known = selected.map(|fault| KnownMistake {
        name: fault.name.into(),
        says: fault.says.into(),
        of: MistakeOf::Scenes,
        seen_in: fault.seen_in.map(Into::into),
        formulas: vec![],
        looks: vec![],
    });
    known.collect()
}
