//! What is listed, as the documents of `list`.

use super::{condition, pixels};
use lightmeter::cases::blend::aliases;
use lightmeter::cases::{self, Naive};
use lightmeter::document::list::{
    CASES, CasesDocument, DeviationCase, FORMULAS, FormulaCases, FormulasDocument, HardCase, ListedCases,
    ListedFormula, ListedProbe, ListedValue, NaiveForm, SceneCases, StableClaim, TableCases,
};
use lightmeter::document::{Number, Word};
use lightmeter::gate::pack::described;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::load;
use lightmeter::scene::select::{Chosen, scene_id};
use lightmeter::select::{CaseRef, Member, Random, Selected};
use lightmeter::special::Probe;
use lightmeter::special::verdict::Table;
use lightmeter::witness::NamedDeviation;
use std::collections::BTreeMap;

/// The formulas with their inputs and outputs.
pub(super) fn formulas(catalogue: &[Member], selected: &[Selected]) -> FormulasDocument {
    let aliases = Aliases::all();
    let formulas = selected.iter().map(|chosen| formula(&catalogue[chosen.member], &aliases)).collect();
    FormulasDocument { schema: FORMULAS.into(), formulas }
}

/// The cases of formulas, tables of special values, scenes and deviations.
pub(super) fn cases(
    catalogue: &[Member],
    selected: &[Selected],
    tables: &[Table],
    scenes: &[Chosen],
    deviations: &[NamedDeviation],
) -> anyhow::Result<CasesDocument> {
    let aliases = Aliases::all();
    let of_formula = |chosen: &Selected| formula_cases(&catalogue[chosen.member], chosen, &aliases);
    let mut cases: Vec<ListedCases> = selected.iter().map(|one| ListedCases::Formula(of_formula(one))).collect();
    cases.extend(tables.iter().map(|one| ListedCases::Table(table(one))));
    for chosen in scenes {
        cases.push(ListedCases::Scene(scene(chosen)?));
    }
    let deviation = |one: &NamedDeviation| DeviationCase { deviation: one.id(), reason: one.reason().into() };
    cases.extend(deviations.iter().map(|one| ListedCases::Deviation(deviation(one))));
    Ok(CasesDocument { schema: CASES.into(), cases })
}

/// The aliases of formulas, by the id that they stand for.
struct Aliases(BTreeMap<String, Vec<String>>);

impl Aliases {
    fn all() -> Self {
        let mut by_canonical = BTreeMap::<String, Vec<String>>::new();
        for (alias, canonical) in aliases() {
            by_canonical.entry(canonical).or_default().push(alias);
        }
        Self(by_canonical)
    }

    fn of(&self, id: &str) -> Vec<String> {
        self.0.get(id).cloned().unwrap_or_default()
    }
}

fn formula(member: &Member, aliases: &Aliases) -> ListedFormula {
    let spec = &member.spec;
    let stable = |claim: cases::Stable| StableClaim {
        bound: claim.bound,
        size: claim.size.name().into(),
        because: claim.because.into(),
    };
    let described = described(spec);
    let with_domain =
        |(value, input): (ListedValue, &cases::Input)| ListedValue { domain: Some(input.domain), ..value };
    ListedFormula {
        source: Some(spec.source.into()),
        stages: spec.stages().iter().map(|stage| Word::from(stage.name())).collect(),
        stable: spec.stable.map(stable),
        inputs: described.inputs.into_iter().zip(spec.inputs).map(with_domain).collect(),
        aliases: aliases.of(&spec.id),
        ..described
    }
}

fn formula_cases(member: &Member, chosen: &Selected, aliases: &Aliases) -> FormulaCases {
    let is_whole = matches!(chosen.random, Random::First(_));
    let random = chosen.cases().filter(|case| matches!(case, CaseRef::Random(_)));
    let named = random.take(if is_whole { 1 } else { usize::MAX }).map(|case| member.case_id(case)).collect();
    let (first, ids) = if is_whole { (Some(named), None) } else { (None, Some(named)) };
    FormulaCases {
        formula: member.spec.id.clone(),
        random: chosen.random_count(),
        hard: chosen.hard.iter().map(|&place| hard_case(member, place)).collect(),
        boundary: chosen.boundary.len() as u64,
        aliases: aliases.of(&member.spec.id),
        first,
        ids,
    }
}

/// A hard case with its condition number, and the naive form that fails there.
fn hard_case(member: &Member, place: usize) -> HardCase {
    let hard = &member.spec.hard[place];
    let condition = condition(member, place);
    let naive = |naive: Naive| NaiveForm {
        formula: naive.formula.into(),
        fails: naive.fails.into(),
        at_least: Number(naive.at_least),
    };
    HardCase {
        id: member.case_id(CaseRef::Hard(place)),
        pins: hard.pins.into(),
        condition: condition.map(Number),
        near: condition.map(|_| member.near()),
        naive: hard.naive.map(naive),
    }
}

/// A table of special values with its probes.
fn table(table: &Table) -> TableCases {
    let probe = |probe: &&Probe| ListedProbe {
        id: probe.id(),
        computes: probe.what.into(),
        promise: probe.promise.words(probe.gives),
        source: probe.source.section().into(),
    };
    TableCases {
        table: table.id(),
        title: table.class.title().into(),
        probes: table.probes.iter().map(probe).collect(),
    }
}

fn scene(chosen: &Chosen) -> anyhow::Result<SceneCases> {
    let loaded = load::builtin(SCENES[chosen.place].0)?;
    let pixels = pixels(chosen, &loaded);
    Ok(SceneCases { scene: scene_id(chosen.place), title: loaded.title, shows: loaded.shows, pixels })
}
