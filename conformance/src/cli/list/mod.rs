//! `lightmeter list`.

mod document;

use super::options::{Amount, Format};
use super::run::matching;
use super::{Status, say};
use anyhow::bail;
use clap::Args;
use lightmeter::cases::Kind;
use lightmeter::cases::blend::{Samples, separate_of};
use lightmeter::document::{Document as _, thousands};
use lightmeter::scene::library::SCENES;
use lightmeter::scene::load::{self, Loaded};
use lightmeter::scene::select::Chosen;
use lightmeter::select::{CaseRef, Member, Selected, catalogue_of, select};
use lightmeter::special::FAMILY;
use lightmeter::special::verdict::{self, Table};
use lightmeter::stability;
use lightmeter::witness::{self, NamedDeviation};
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
        let filter = match matching(&self.filter, self.amount.cases, &samples, None) {
            Ok(filter) => filter,
            Err(error) => {
                // A part of a name finds whatever has it.
                let wider: Vec<String> =
                    self.filter.iter().map(|part| format!("*/*{}*", part.trim_matches('*'))).collect();
                let is_part = self.filter.iter().all(|part| part.len() >= 3 && !part.contains('/'));
                let wider = is_part.then(|| matching(&wider, self.amount.cases, &samples, None).ok()).flatten();
                let Some(wider) = wider else { return Err(error) };
                say(&format!("note: no case matches `{}`: these have it in their names", self.filter.join(" ")));
                wider
            }
        };
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
            (Format::Json, true) => document::formulas(&catalogue, &selected).to_json()?,
            (Format::Json, false) => {
                document::cases(&catalogue, &selected, &tables, &scenes, &deviations)?.to_json()?
            }
            (Format::Text, true) => signatures(&catalogue, &selected)?,
            (Format::Text, false) => tree(&catalogue, &selected, &tables, &scenes, &deviations)?,
        };
        self.format.emit(&text, self.out.as_deref())?;
        Ok(Status::Success)
    }
}

/// The condition number of a hard case; of NaN and infinity in blending there is none.
fn condition(member: &Member, place: usize) -> Option<f64> {
    let mut inputs = vec![];
    member.inputs(CaseRef::Hard(place), 1, &mut inputs);
    let has_one = !matches!(member.spec.kind, Kind::Blend(_));
    has_one.then(|| stability::condition(member.formula.as_ref(), &inputs, stability::size(&member.spec)))
}

/// A condition number in few digits.
fn conditioned(x: f64) -> String {
    if x.is_finite() && x < 1e4 { format!("{x:.1}") } else { format!("{x:.1e}") }
}

fn signatures(catalogue: &[Member], selected: &[Selected]) -> anyhow::Result<String> {
    let mut text = String::new();
    for chosen in selected {
        let spec = &catalogue[chosen.member].spec;
        writeln!(text, "{}\n  {}  ({})", spec.id, spec.text, spec.source)?;
        for rule in spec.rules() {
            writeln!(text, "  rule {rule}")?;
        }
        for input in spec.inputs {
            let (shape, means, domain) = (input.shape.name(), spec.input_means(input), input.domain);
            let unit = with_unit(input.unit);
            writeln!(text, "  in   {:<14} {shape}{unit}: {means}; {domain}", input.name)?;
        }
        for output in spec.outputs {
            let (shape, means) = (output.shape.name(), spec.output_means(output));
            writeln!(text, "  out  {:<14} {shape}{}: {means}", output.name, with_unit(output.unit))?;
        }
    }
    Ok(text)
}

/// A unit as it stands behind a shape.
pub(super) fn with_unit(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(", {unit}") }
}

/// The number of selected pixels of a scene, each of which is a case.
fn pixels(chosen: &Chosen, loaded: &Loaded) -> u64 {
    let all = || u64::from(loaded.frame.target.width) * u64::from(loaded.frame.target.height);
    chosen.pixels.as_ref().map_or_else(all, |some| some.len() as u64)
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
            if !chosen.boundary.is_empty() {
                let count = thousands(chosen.boundary.len() as u64);
                writeln!(text, "    {:<33} {count} close to where it decides or degenerates", "boundary")?;
            }
            for &place in &chosen.hard {
                let hard = &member.spec.hard[place];
                let condition =
                    condition(member, place).map_or(String::new(), |x| format!("; condition {}", conditioned(x)));
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
        let count = pixels(chosen, &loaded);
        total += count;
        writeln!(text, "  {:<32} {:>9}  {}", loaded.name, thousands(count), loaded.title)?;
    }
    text += &witnesses(deviations)?;
    writeln!(text, "{} cases", thousands(total))?;
    Ok(text)
}
