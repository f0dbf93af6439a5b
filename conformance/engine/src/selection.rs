//! Everything that a run judges, and the parts that it falls into, each of which is judged and reported by itself.

use crate::options::Options;
use crate::special::verdict::{self, Table};
use crate::witness::NamedDeviation;
use lightmeter_catalogue::cases::blend::Program;
use lightmeter_catalogue::cases::{Kind, Spec};
use lightmeter_catalogue::filter::Filter;
use lightmeter_catalogue::scene::select::{Chosen, SIZE_AMONG_ALL};
use lightmeter_catalogue::select::{CaseRef, Member, Selected, Shard, alias_members, catalogue_of, select};
use std::collections::HashMap;
use std::sync::Arc;

/// States of a group that are judged as one part; a group of more falls into parts by its source factor.
const MOST_STATES: usize = 16;

/// What a run judges.
#[derive(Clone)]
pub struct Selection {
    /// Every formula; parts of a selection share it.
    pub catalogue: Arc<[Member]>,
    /// Cases of formulas, in the order of the catalogue.
    pub formulas: Vec<Selected>,
    /// Tables of special values.
    pub tables: Vec<Table>,
    /// Scenes.
    pub scenes: Vec<Chosen>,
    /// Deviations whose witnesses are asked.
    pub deviations: Vec<NamedDeviation>,
    /// Pixels of the longer side of every scene; `None` for the scenes' own.
    pub size: Option<u32>,
    /// Whether each formula is a group by itself, as it is for renderers that are asked case by case.
    pub is_by_formula: bool,
    /// Blend states that a renderer is asked for on targets, each under all of its names.
    pub blended: Vec<Selected>,
}

/// Whether something is promised of a formula's cases, as it is of all but NaN and infinity in blending.
const fn is_promised(member: &Member) -> bool {
    !matches!(member.spec.kind, Kind::Blend(program) if program.is_special())
}

/// The blend states of a catalogue that a renderer is asked for on targets, of `cases` random cases for each. Those of a group come one
/// after the other; an alias belongs to the group of its equation.
#[must_use]
pub fn blended_states(catalogue: &[Member], filter: &Filter, cases: u64, shard: Shard) -> Vec<Selected> {
    let mut blended = select(catalogue, filter, cases, shard);
    let is_blended = |member: &Member| matches!(member.spec.kind, Kind::Blend(_)) && is_promised(member);
    blended.retain(|chosen| is_blended(&catalogue[chosen.member]));
    let group = |chosen: &Selected| catalogue[chosen.member].spec.group();
    let mut order: HashMap<&str, usize> = HashMap::new();
    for chosen in &blended {
        let next = order.len();
        order.entry(group(chosen)).or_insert(next);
    }
    blended.sort_by_key(|chosen| order[group(chosen)]);
    blended
}

/// A part of a selection.
pub struct SelectionPart {
    /// Its path in the tree of cases: `fog/linear`, `blend/add/src-alpha`, `scene/teapot`, `deviation/llvmpipe-exp`.
    pub path: String,
    /// The filters that select it.
    pub filters: Vec<String>,
    /// What it judges.
    pub selection: Selection,
}

impl SelectionPart {
    /// The command that runs it alone on an adapter, as it is in a run of everything.
    #[must_use]
    pub fn command(&self, adapter: &str) -> String {
        let filter: String = self.filters.iter().map(|filter| format!(" '{filter}'")).collect();
        let is_scene = !self.selection.scenes.is_empty();
        let size = if is_scene { format!(" --size {SIZE_AMONG_ALL}") } else { String::new() };
        format!("lightmeter run{filter} --adapter {adapter}{size}")
    }

    /// A hard case has its group's id, not its formula's: where the part is less than a group, the filter does not select it.
    fn add_hard_cases(&mut self) {
        let Ok(filter) = Filter::new(&self.filters) else { unreachable!("ids are globs") };
        let catalogue = &self.selection.catalogue;
        let hard = |chosen: &Selected| {
            let member = &catalogue[chosen.member];
            chosen.hard.iter().map(|&place| member.case_id(CaseRef::Hard(place))).collect::<Vec<String>>()
        };
        let ids = self.selection.formulas.iter().flat_map(hard).filter(|id| !filter.selects(id));
        self.filters.extend(ids);
    }
}

impl Selection {
    /// What the options select. With any case the witnesses of all deviations are asked; without, those that the filter names.
    #[must_use]
    pub fn of(options: &Options) -> Self {
        let catalogue: Arc<[Member]> =
            catalogue_of(&options.samples).into_iter().map(|member| options.applied(member)).collect();
        let formulas = select(&catalogue, &options.filter, options.cases, options.shard);
        let tables = verdict::select(&options.filter, options.shard);
        let size = lightmeter_catalogue::scene::select::size(&options.filter, options.size);
        let scenes = lightmeter_catalogue::scene::select::select(&options.filter, options.shard, size);
        let has_cases = !(formulas.is_empty() && tables.is_empty() && scenes.is_empty());
        let deviations = if has_cases { NamedDeviation::all() } else { NamedDeviation::named(&options.filter) };
        Self { catalogue, formulas, tables, scenes, deviations, size, is_by_formula: false, blended: vec![] }
    }

    /// What the options select of these formulas, whether or not they are those of the catalogue, and nothing besides.
    #[must_use]
    pub fn of_formulas(catalogue: Arc<[Member]>, options: &Options) -> Self {
        Self {
            formulas: select(&catalogue, &options.filter, options.cases, options.shard),
            catalogue,
            tables: vec![],
            scenes: vec![],
            deviations: vec![],
            size: None,
            is_by_formula: false,
            blended: vec![],
        }
    }

    /// What the options select for renderers that are asked case by case: formulas, blend states and scenes. The tables of
    /// special values are for those alone that declare them. NaN and infinity in blending are left out, for which no specification
    /// promises a result.
    #[must_use]
    pub fn of_renderer(options: &Options) -> Self {
        let mut catalogue = lightmeter_catalogue::select::catalogue();
        let canonical = catalogue.len();
        catalogue.extend(alias_members());
        let catalogue: Arc<[Member]> = catalogue.into_iter().map(|member| options.applied(member)).collect();
        let mut formulas = select(&catalogue[..canonical], &options.filter, options.cases, options.shard);
        formulas.retain(|chosen| is_promised(&catalogue[chosen.member]));
        let blended = blended_states(&catalogue, &options.filter, options.cases, options.shard);
        let scenes = lightmeter_catalogue::scene::select::select(&options.filter, options.shard, options.size);
        Self {
            catalogue,
            formulas,
            tables: vec![],
            scenes,
            deviations: vec![],
            size: options.size,
            is_by_formula: true,
            blended,
        }
    }

    /// The blend states that a renderer is asked for on targets, by groups.
    pub fn blended_groups(&self) -> impl Iterator<Item = &[Selected]> {
        let id = |chosen: &Selected| self.catalogue[chosen.member].spec.group();
        self.blended.chunk_by(move |a, b| id(a) == id(b))
    }

    /// The formulas, by groups that are judged together.
    pub fn groups(&self) -> impl Iterator<Item = &[Selected]> {
        let id = |chosen: &Selected| {
            let spec = &self.catalogue[chosen.member].spec;
            if self.is_by_formula { spec.id.as_str() } else { spec.group() }
        };
        self.formulas.chunk_by(move |a, b| id(a) == id(b))
    }

    /// Whether there is no case.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.formulas.is_empty() && self.tables.is_empty() && self.scenes.is_empty() && self.deviations.is_empty()
    }

    /// Its parts, in the order of reports: each formula, group of blend states, depth test, table of special values, scene and
    /// deviation. Together they judge what the whole does, each case once.
    #[must_use]
    pub fn parts(&self) -> Vec<SelectionPart> {
        let mut nothing = self.clone();
        (nothing.formulas, nothing.tables, nothing.scenes) = (vec![], vec![], vec![]);
        (nothing.deviations, nothing.blended) = (vec![], vec![]);
        let mut parts = Parts { nothing, parts: vec![], places: HashMap::new() };
        for deviation in &self.deviations {
            parts.of(deviation.id(), vec![deviation.id()]).deviations.push(*deviation);
        }
        for table in &self.tables {
            parts.of(table.id(), vec![table.id()]).tables.push(table.clone());
        }
        let mut formulas_of: HashMap<&str, usize> = HashMap::new();
        for member in &*self.catalogue {
            *formulas_of.entry(member.spec.group()).or_default() += 1;
        }
        for chosen in &self.formulas {
            let member = &self.catalogue[chosen.member];
            let (path, filter) = path(&member.spec, formulas_of[member.spec.group()]);
            parts.of(path, vec![filter]).formulas.push(chosen.clone());
        }
        for scene in &self.scenes {
            let id = lightmeter_catalogue::scene::select::scene_id(scene.place);
            parts.of(id.clone(), vec![id]).scenes.push(scene.clone());
        }
        for part in &mut parts.parts {
            part.add_hard_cases();
        }
        parts.parts
    }
}

/// The parts found so far.
struct Parts {
    /// A selection of nothing.
    nothing: Selection,
    parts: Vec<SelectionPart>,
    places: HashMap<String, usize>,
}

impl Parts {
    /// What the part of a path judges.
    fn of(&mut self, path: String, filters: Vec<String>) -> &mut Selection {
        let place = *self.places.entry(path.clone()).or_insert_with(|| {
            self.parts.push(SelectionPart { path, filters, selection: self.nothing.clone() });
            self.parts.len() - 1
        });
        &mut self.parts[place].selection
    }
}

/// The path of the part that a formula belongs to, whose group has `formulas` formulas, and the filter that selects the part.
fn path(spec: &Spec, formulas: usize) -> (String, String) {
    let same = |path: &str| (path.to_owned(), path.to_owned());
    match spec.kind {
        Kind::Depth(_) => same(&spec.id),
        Kind::Blend(Program::Draw(..)) if formulas > MOST_STATES => {
            let end = spec.id.match_indices('/').nth(2).map_or(spec.id.len(), |(at, _)| at);
            let states = &spec.id[..end];
            // Of states with another one for alpha, as `blend/separate/add.src-alpha.one`, the source factor is not the end.
            match states.match_indices('.').nth(1) {
                Some((end, _)) => (states[..end].to_owned(), format!("{}.*", &states[..end])),
                None => same(states),
            }
        }
        _ => same(spec.group()),
    }
}
