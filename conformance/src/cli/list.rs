//! `lightmeter list`.

use super::options::{Amount, Format};
use super::run::matching;
use super::{Status, emit};
use anyhow::bail;
use clap::Args;
use lightmeter::cases::blend::{Samples, aliases, separate_of};
use lightmeter::cases::{Kind, Naive};
use lightmeter::document::Number;
use lightmeter::document::thousands;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::load::{self, Loaded};
use lightmeter::scene::select::Chosen;
use lightmeter::select::{CaseRef, Member, Random, Selected, catalogue_of, select};
use lightmeter::special::verdict::{self, Table};
use lightmeter::special::{FAMILY, Probe};
use lightmeter::stability;
use lightmeter::witness::{self, NamedDeviation};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

/// List the cases as a tree, or the formulas with their inputs and outputs.
#[derive(Debug, Args)]
pub(crate) struct List {
    /// Globs that match an id or an ancestor of it
    filter: Vec<String>,
    /// Every formula's inputs and outputs with units and ranges
    #[arg(long)]
    formulas: bool,
    #[command(flatten)]
    amount: Amount,
    /// How the list is written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Write the list to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl List {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let named = self.filter.iter().filter_map(|glob| separate_of(glob)).collect();
        let samples = Samples { named, ..Samples::default() };
        let filter = matching(&self.filter, self.amount.cases, &samples, None)?;
        let catalogue = catalogue_of(&samples);
        let selected = select(&catalogue, &filter, self.amount.cases, self.amount.shard.0);
        let shard = self.amount.shard.0;
        let scenes = if self.formulas { vec![] } else { lightmeter::scene::select::select(&filter, shard, None) };
        let tables = if self.formulas { vec![] } else { verdict::select(&filter, shard) };
        let deviations = if self.formulas { vec![] } else { NamedDeviation::named(&filter) };
        if self.formulas && selected.is_empty() {
            bail!(
                "no formula matches the filter: special values, scenes and deviations are listed without `--formulas`"
            );
        }
        let text = match (self.format, self.formulas) {
            (Format::Junit, _) => bail!("a list is written as text or json"),
            (Format::Json, _) => {
                let mut by_canonical = BTreeMap::<String, Vec<String>>::new();
                for (alias, canonical) in aliases() {
                    by_canonical.entry(canonical).or_default().push(alias);
                }
                let key = if self.formulas { "formulas" } else { "cases" };
                let mut entries: Vec<Value> = selected
                    .iter()
                    .map(|chosen| {
                        let member = &catalogue[chosen.member];
                        let aliases = by_canonical.get(&member.spec.id).map_or(&[][..], Vec::as_slice);
                        if self.formulas { formula(member, aliases) } else { cases(member, chosen, aliases) }
                    })
                    .collect();
                entries.extend(tables.iter().map(table));
                for chosen in &scenes {
                    let loaded = load::builtin(SCENES[chosen.place].0)?;
                    let pixels = chosen.pixels.as_ref().map_or_else(|| pixels(&loaded), |some| some.len() as u64);
                    let id = lightmeter::scene::select::scene_id(chosen.place);
                    entries
                        .push(json!({ "scene": id, "title": loaded.title, "shows": loaded.shows, "pixels": pixels }));
                }
                entries.extend(deviations.iter().map(|one| json!({ "deviation": one.id(), "reason": one.reason() })));
                serde_json::to_string_pretty(&json!({ "schema": format!("lightmeter.{key}/1"), key: entries }))? + "\n"
            }
            (Format::Text, true) => signatures(&catalogue, &selected)?,
            (Format::Text, false) => tree(&catalogue, &selected, &tables, &scenes, &deviations)?,
        };
        emit(&text, self.out.as_deref())?;
        Ok(Status::Success)
    }
}

fn formula(member: &Member, aliases: &[String]) -> Value {
    let spec = &member.spec;
    json!({
        "id": spec.id, "formula": spec.text, "source": spec.source,
        "stages": spec.stages(), "stable": spec.stable, "inputs": spec.inputs, "outputs": spec.outputs, "aliases": aliases,
    })
}

fn cases(member: &Member, chosen: &Selected, aliases: &[String]) -> Value {
    let hard: Vec<Value> = chosen.hard.iter().map(|&place| hard_case(member, place)).collect();
    let random: Vec<String> = chosen
        .cases()
        .filter(|case| matches!(case, CaseRef::Random(_)))
        .enumerate()
        .filter(|(place, _)| matches!(chosen.random, Random::Some(_)) || *place == 0)
        .map(|(_, case)| member.case_id(case))
        .collect();
    let count = chosen.random_count();
    let mut entry = json!({ "formula": member.spec.id, "random": count, "hard": hard, "aliases": aliases });
    let key = if matches!(chosen.random, Random::First(_)) { "first" } else { "ids" };
    entry[key] = json!(random);
    entry
}

/// The condition number of a hard case; of NaN and infinity in blending there is none.
fn condition(member: &Member, place: usize) -> Option<f64> {
    let mut inputs = vec![];
    member.inputs(CaseRef::Hard(place), 1, &mut inputs);
    let has_one = !matches!(member.spec.kind, Kind::Blend(_));
    has_one.then(|| stability::condition(member.formula.as_ref(), &inputs, stability::size(&member.spec)))
}

/// A hard case with its condition number, and the naive form that fails there.
fn hard_case(member: &Member, place: usize) -> Value {
    let hard = &member.spec.hard[place];
    let mut entry = json!({ "id": member.case_id(CaseRef::Hard(place)), "pins": hard.pins });
    if let Some(condition) = condition(member, place) {
        entry["condition"] = json!(Number(condition));
        entry["near"] = json!(member.near());
    }
    if let Some(Naive { formula, fails, at_least }) = hard.naive {
        entry["naive"] = json!({ "formula": formula, "fails": fails, "at_least": Number(at_least) });
    }
    entry
}

fn signatures(catalogue: &[Member], selected: &[Selected]) -> anyhow::Result<String> {
    let mut text = String::new();
    for chosen in selected {
        let spec = &catalogue[chosen.member].spec;
        writeln!(text, "{}\n  {}  ({})", spec.id, spec.text, spec.source)?;
        for input in spec.inputs {
            let shape = format!("{:?}", input.shape).to_lowercase();
            writeln!(text, "  in   {:<16} {shape:<7} {:<8} {:?}", input.name, input.unit, input.domain)?;
        }
        for output in spec.outputs {
            let shape = format!("{:?}", output.shape).to_lowercase();
            writeln!(text, "  out  {:<16} {shape:<7} {}", output.name, output.unit)?;
        }
    }
    Ok(text)
}

/// Pixels of a scene, each of which is a case.
fn pixels(loaded: &Loaded) -> u64 {
    u64::from(loaded.frame.target.width) * u64::from(loaded.frame.target.height)
}

/// Deviations, whose witnesses every run asks.
fn witnesses(deviations: &[NamedDeviation]) -> anyhow::Result<String> {
    let mut text = String::new();
    if !deviations.is_empty() {
        writeln!(text, "{}", witness::FAMILY)?;
    }
    for deviation in deviations {
        writeln!(text, "  {:<32} {}", deviation.name(), deviation.reason())?;
    }
    Ok(text)
}

/// A table of special values with its probes.
fn table(table: &Table) -> Value {
    let probe = |probe: &&Probe| {
        json!({
            "id": probe.id(), "computes": probe.what, "promise": probe.promise.words(probe.gives),
            "source": probe.source.section(),
        })
    };
    let probes: Vec<Value> = table.probes.iter().map(probe).collect();
    json!({ "table": table.id(), "title": table.class.title(), "probes": probes })
}

fn tree(
    catalogue: &[Member],
    selected: &[Selected],
    tables: &[Table],
    scenes: &[Chosen],
    deviations: &[NamedDeviation],
) -> anyhow::Result<String> {
    let mut text = String::new();
    let mut family = "";
    let mut total = 0;
    for group in selected.chunk_by(|a, b| catalogue[a.member].spec.group() == catalogue[b.member].spec.group()) {
        let spec = &catalogue[group[0].member].spec;
        if spec.family() != family {
            family = spec.family();
            writeln!(text, "{family}")?;
        }
        let random: u64 = group.iter().map(|chosen| chosen.random_count()).sum();
        total += group.iter().map(Selected::count).sum::<u64>();
        let name = spec.group().rsplit('/').next().unwrap_or_default();
        let states = if group.len() > 1 { format!(" in {} states", group.len()) } else { String::new() };
        writeln!(text, "  {name:<32} {:>9}{states}  {}", thousands(random), spec.text)?;
        for chosen in group {
            let member = &catalogue[chosen.member];
            for &place in &chosen.hard {
                let hard = &member.spec.hard[place];
                let condition = condition(member, place).map_or(String::new(), |x| format!("; condition {x:.1e}"));
                writeln!(text, "    hard/{:<28} {}{condition}", hard.name, hard.pins)?;
                if let Some(naive) = hard.naive {
                    writeln!(text, "    {:<33} fails: {}, {}", "", naive.formula, naive.fails)?;
                }
            }
        }
    }
    if !tables.is_empty() {
        writeln!(text, "{FAMILY}")?;
    }
    for table in tables {
        let count = table.probes.len() as u64;
        total += count;
        writeln!(text, "  {:<32} {:>9}  {}", table.class.name(), thousands(count), table.class.title())?;
        for probe in &table.probes {
            writeln!(text, "    {:<33} {}; promised: {}", probe.name, probe.what, probe.promise.words(probe.gives))?;
        }
    }
    if !scenes.is_empty() {
        writeln!(text, "scene")?;
    }
    for chosen in scenes {
        let loaded = load::builtin(SCENES[chosen.place].0)?;
        let count = chosen.pixels.as_ref().map_or_else(|| pixels(&loaded), |some| some.len() as u64);
        total += count;
        writeln!(text, "  {:<32} {:>9}  {}", loaded.name, thousands(count), loaded.title)?;
    }
    text += &witnesses(deviations)?;
    writeln!(text, "{} cases", thousands(total))?;
    Ok(text)
}
