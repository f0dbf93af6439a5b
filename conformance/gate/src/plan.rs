//! Which cases another renderer is asked, and where each stands.

use lightmeter_catalogue::cases::blend::Program;
use lightmeter_catalogue::cases::{GENERATOR_VERSION, Kind};
use lightmeter_catalogue::filter::{Filter, FilterError};
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::select::{builtin, scene_id};
use lightmeter_catalogue::select::{CaseRef, Member, Random, Selected, Shard, alias_members, catalogue, select};
use lightmeter_catalogue::special::{FAMILY, Probe};
use lightmeter_document::pack::Choice;
use lightmeter_engine::renderer::pixel_id;
use lightmeter_engine::selection::blended_states;
use lightmeter_engine::special::verdict::{self, Table};
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;
use std::collections::HashMap;

/// The cases that are chosen.
pub struct GatePlan {
    /// What chose them.
    pub choice: Choice,
    /// Every formula, and behind them the other names of blend states, where targets are asked for.
    pub catalogue: Vec<Member>,
    /// The formulas that have cases in it.
    pub formulas: Vec<PlannedFormula>,
    /// The targets that blend states are asked for on.
    pub targets: Vec<TargetFormat>,
    /// The blend states that have cases on each of the targets, under each of their names.
    pub states: Vec<PlannedFormula>,
    /// The special values, where they are asked for: those that are functions.
    pub probes: Vec<&'static Probe>,
    /// The scenes, by their places among the built-in ones.
    pub scenes: Vec<usize>,
    /// Where the cases of the formulas stand.
    of_formulas: Index,
    /// Where the cases of the blend states stand.
    of_states: Index,
}

/// Why there is no plan of a choice.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A glob cannot be read.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// A target is unknown.
    #[error("no target `{0}`; expected {formats}", formats = TargetFormat::ALL.map(TargetFormat::name).join(", "))]
    Target(String),
}

/// Looks up a formula or a case of the plan by its id.
#[derive(Default)]
struct Index {
    /// For the common prefix of random cases' ids, the formula's index.
    random: HashMap<String, usize>,
    /// For the id of a hard case or of one near it, the formula's index and the case.
    named: HashMap<String, (usize, CaseRef)>,
    /// For a formula's id, its index.
    places: HashMap<String, usize>,
}

/// A formula with the cases that are chosen of it.
pub struct PlannedFormula {
    /// What is chosen.
    pub selected: Selected,
    /// How many hard cases, and cases near hard ones, there are. They come before the random cases.
    named: usize,
    /// The places of the named cases.
    places: HashMap<CaseRef, usize>,
}

/// A case of the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum CasePlace {
    /// The formula's place among the plan's, and the case's among its own.
    Case {
        /// Of the formula.
        formula: usize,
        /// Of the case.
        case: usize,
    },
    /// A case of a blend state on a target: the state's place among the plan's, and the case's among its own.
    Pixel {
        /// What it is blended on.
        target: TargetFormat,
        /// Of the state.
        state: usize,
        /// Of the case.
        case: usize,
    },
    /// The special value's place among the plan's.
    Probe(usize),
    /// The scene's place among the plan's.
    Scene(usize),
}

/// The first of these globs that matches nothing that a renderer is ever asked.
#[must_use]
pub fn unmatched<'a>(ids: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let mut ids = ids.peekable();
    ids.peek()?;
    let everything = Choice { filter: vec![], cases: 1, seed: 1, special: true, ..Choice::default() };
    let all = GatePlan::new(everything).ok()?;
    ids.find(|id| !all.is_matched(id))
}

impl GatePlan {
    /// Whether a glob matches something of all that there is.
    #[must_use]
    pub fn is_matched(&self, id: &str) -> bool {
        let Ok(filter) = Filter::new(&[id]) else { return false };
        // Any number of a random case may be meant.
        let path = id.rsplit_once('/').filter(|(_, number)| number.bytes().all(|byte| byte.is_ascii_digit()));
        let is_random =
            |member: &str| path.is_some_and(|(path, _)| path.strip_suffix("/random").unwrap_or(path) == member);
        let has_formula = (0..self.formulas.len()).any(|formula| {
            let member = &self.member(formula).spec.id;
            filter.selects(member) || filter.reaches_below(member) || is_random(member) || {
                let cases = 0..self.formulas[formula].count();
                let is_of = |ancestor: &str| id.strip_prefix(ancestor).is_some_and(|rest| rest.starts_with('/'));
                (is_of(member) || is_of(self.member(formula).spec.group()))
                    && cases.into_iter().any(|case| filter.selects(&self.id(CasePlace::Case { formula, case })))
            }
        });
        let has_scene = || (0..self.scenes.len()).any(|scene| filter.selects(&self.id(CasePlace::Scene(scene))));
        has_formula || has_scene() || self.probes.iter().any(|probe| filter.selects(&probe.id()))
    }

    /// The cases of a choice. NaN and infinity in blending, of which nothing is promised, are no cases here.
    ///
    /// # Errors
    /// Where a glob cannot be read, or a target is unknown.
    pub fn new(choice: Choice) -> Result<Self, PlanError> {
        let filter = Filter::new(&choice.filter)?;
        let named = |name: &String| TargetFormat::by_name(name).ok_or_else(|| PlanError::Target(name.clone()));
        let asked: Vec<TargetFormat> = choice.targets.iter().map(named).collect::<Result<_, _>>()?;
        let mut catalogue = catalogue();
        let canonical = catalogue.len();
        if !asked.is_empty() {
            catalogue.extend(alias_members());
        }
        let tables = if choice.special { verdict::select(&filter, Shard::WHOLE) } else { vec![] };
        let mut plan = Self {
            probes: tables.iter().flat_map(Table::functions).collect(),
            scenes: (0..SCENES.len()).filter(|&place| filter.selects(&scene_id(place))).collect(),
            formulas: vec![],
            targets: TargetFormat::ALL.into_iter().filter(|target| asked.contains(target)).collect(),
            states: vec![],
            of_formulas: Index::default(),
            of_states: Index::default(),
            catalogue,
            choice,
        };
        for selected in select(&plan.catalogue[..canonical], &filter, plan.choice.cases, Shard::WHOLE) {
            let member = &plan.catalogue[selected.member];
            if !matches!(member.spec.kind, Kind::Blend(Program::Special(_))) {
                plan.formulas.push(plan.of_formulas.add(plan.formulas.len(), member, selected));
            }
        }
        if !plan.targets.is_empty() {
            for selected in blended_states(&plan.catalogue, &filter, plan.choice.cases, Shard::WHOLE) {
                let member = &plan.catalogue[selected.member];
                plan.states.push(plan.of_states.add(plan.states.len(), member, selected));
            }
        }
        Ok(plan)
    }

    /// What tells packs of different cases apart: the checksum of what chose them, and of what draws them, as 8 digits of base 16.
    ///
    /// # Panics
    /// Never: a choice is an object of JSON.
    #[must_use]
    pub fn pack(&self) -> String {
        let chosen = serde_json::to_string(&(GENERATOR_VERSION, &self.choice)).expect("a choice is an object of JSON");
        format!("{:08x}", crc32fast::hash(chosen.as_bytes()))
    }

    /// Its formulas and scenes by their ids, and how many cases each has.
    #[must_use]
    pub fn counts(&self) -> Vec<(String, u64)> {
        let count = |formula: usize| self.formulas[formula].count() as u64;
        let formulas = (0..self.formulas.len()).map(|formula| (self.member(formula).spec.id.clone(), count(formula)));
        formulas.chain((0..self.scenes.len()).map(|scene| (self.id(CasePlace::Scene(scene)), 1))).collect()
    }

    /// How many cases of formulas there are.
    #[must_use]
    pub fn cases(&self) -> u64 {
        self.formulas.iter().map(|formula| formula.selected.count()).sum()
    }

    /// How many cases of blend states there are on each target.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        self.states.iter().map(|state| state.selected.count()).sum()
    }

    /// Whether there is nothing to ask.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.formulas.is_empty() && self.states.is_empty() && self.probes.is_empty() && self.scenes.is_empty()
    }

    /// The description of a formula of the plan.
    #[must_use]
    pub fn member(&self, formula: usize) -> &Member {
        &self.catalogue[self.formulas[formula].selected.member]
    }

    /// The description of a blend state of the plan.
    #[must_use]
    pub fn state_member(&self, state: usize) -> &Member {
        &self.catalogue[self.states[state].selected.member]
    }

    /// The place of a formula; `None` where the plan has none of its cases.
    #[must_use]
    pub fn formula(&self, id: &str) -> Option<usize> {
        self.of_formulas.places.get(id).copied()
    }

    /// The place of a blend state; `None` where the plan has none of its cases on targets.
    #[must_use]
    pub fn state(&self, id: &str) -> Option<usize> {
        self.of_states.places.get(id).copied()
    }

    /// The place of an id; `None` where the plan has no such case.
    #[must_use]
    pub fn find(&self, id: &str) -> Option<CasePlace> {
        if let Some(name) = id.strip_prefix("scene/") {
            let scene = self.scenes.iter().position(|&place| SCENES[place].0 == name)?;
            return Some(CasePlace::Scene(scene));
        }
        if id.split('/').next() == Some(FAMILY) {
            return self.probes.iter().position(|probe| probe.id() == id).map(CasePlace::Probe);
        }
        if let Some((id, target)) = id.split_once('@') {
            let target = TargetFormat::by_name(target).filter(|target| self.targets.contains(target))?;
            let (state, case) = self.of_states.find(id, &self.states, &self.catalogue)?;
            return Some(CasePlace::Pixel { target, state, case });
        }
        let (formula, case) = self.of_formulas.find(id, &self.formulas, &self.catalogue)?;
        Some(CasePlace::Case { formula, case })
    }

    /// The id at a place.
    #[must_use]
    pub fn id(&self, place: CasePlace) -> String {
        match place {
            CasePlace::Scene(scene) => scene_id(self.scenes[scene]),
            CasePlace::Probe(probe) => self.probes[probe].id(),
            CasePlace::Case { formula, case } => self.member(formula).case_id(self.formulas[formula].case(case)),
            CasePlace::Pixel { target, state, case } => {
                pixel_id(self.state_member(state), self.states[state].case(case), target)
            }
        }
    }

    /// The inputs of a case.
    #[must_use]
    pub fn inputs(&self, formula: usize, case: usize) -> Vec<f32> {
        self.rows(formula)(case)
    }

    /// The inputs of a case of a blend state, which are the same on each target.
    #[must_use]
    pub fn state_inputs(&self, state: usize, case: usize) -> Vec<f32> {
        self.row(&self.states[state])(case)
    }

    /// Inputs of many cases of a formula, by the cases' places.
    pub(super) fn rows(&self, formula: usize) -> impl Fn(usize) -> Vec<f32> {
        self.row(&self.formulas[formula])
    }

    fn row<'a>(&'a self, planned: &'a PlannedFormula) -> impl Fn(usize) -> Vec<f32> + 'a {
        let member = &self.catalogue[planned.selected.member];
        let draws = member.draws(self.choice.seed);
        move |case| {
            let mut row = Vec::with_capacity(member.spec.input_len());
            draws.inputs(planned.case(case), &mut row);
            row
        }
    }

    /// A scene's title and frame.
    ///
    /// # Errors
    /// Where it is refused, which a test rules out.
    pub fn frame(&self, scene: usize) -> Result<(String, Frame), lightmeter_catalogue::scene::SceneError> {
        let loaded = builtin(self.scenes[scene], self.choice.size)?;
        Ok((loaded.title, loaded.frame))
    }
}

impl Index {
    /// Adds what is selected of a formula, whose place among the plan's is given.
    fn add(&mut self, formula: usize, member: &Member, selected: Selected) -> PlannedFormula {
        self.places.insert(member.spec.id.clone(), formula);
        if selected.random_count() > 0 {
            let first = member.case_id(CaseRef::Random(0));
            let path = first.rsplit_once('/').map_or("", |(path, _)| path);
            self.random.insert(path.to_owned(), formula);
        }
        let mut places = HashMap::new();
        for (place, case) in selected.cases().take_while(|case| !matches!(case, CaseRef::Random(_))).enumerate() {
            self.named.insert(member.case_id(case), (formula, case));
            places.insert(case, place);
        }
        PlannedFormula { named: places.len(), selected, places }
    }

    /// The place of the formula and the place of the case that an id names.
    fn find(&self, id: &str, formulas: &[PlannedFormula], catalogue: &[Member]) -> Option<(usize, usize)> {
        if let Some(&(formula, case)) = self.named.get(id) {
            return Some((formula, *formulas[formula].places.get(&case)?));
        }
        let (path, number) = id.rsplit_once('/')?;
        let &formula = self.random.get(path)?;
        let planned = &formulas[formula];
        let case = planned.random(number.parse().ok()?)?;
        // `17` is no id of case `000017`.
        (catalogue[planned.selected.member].case_id(planned.case(case)) == id).then_some((formula, case))
    }
}

impl PlannedFormula {
    /// How many cases it has.
    #[must_use]
    pub fn count(&self) -> usize {
        usize::try_from(self.selected.count()).unwrap_or(usize::MAX)
    }

    /// The case at a place.
    ///
    /// # Panics
    /// Where there is none.
    #[must_use]
    pub fn case(&self, place: usize) -> CaseRef {
        if place < self.named {
            return self.selected.cases().nth(place).expect("named cases come first");
        }
        let random = place - self.named;
        CaseRef::Random(match &self.selected.random {
            Random::First(_) => random as u64,
            Random::Some(some) => some[random],
        })
    }

    /// The place of a case.
    #[must_use]
    pub fn place(&self, case: CaseRef) -> Option<usize> {
        match case {
            CaseRef::Random(number) => self.random(number),
            named => self.places.get(&named).copied(),
        }
    }

    /// The place of a random case.
    fn random(&self, number: u64) -> Option<usize> {
        let random = match &self.selected.random {
            Random::First(count) => usize::try_from(number).ok().filter(|_| number < *count),
            Random::Some(some) => some.binary_search(&number).ok(),
        };
        random.map(|random| self.named + random)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    fn plan(filter: &[&str], targets: &[&str]) -> Result<GatePlan, PlanError> {
        let [filter, targets] = [filter, targets].map(|words| words.iter().map(|&word| word.to_owned()).collect());
        GatePlan::new(Choice { filter, cases: 5, seed: 1, size: Some(32), targets, held: vec![], special: true })
    }

    #[test]
    fn every_case_is_found_by_its_id_and_no_other() {
        let filter = ["fog", "blend/add/zero", "vector/reflect", "blend/add/one/one/0003", "scene/phong"];
        let plan = plan(&filter, &[]).expect("the choice is right");
        let mut seen = 0;
        for formula in 0..plan.formulas.len() {
            for case in 0..plan.formulas[formula].count() {
                let place = CasePlace::Case { formula, case };
                assert_eq!(plan.find(&plan.id(place)), Some(place), "{}", plan.id(place));
                assert_eq!(plan.inputs(formula, case).len(), plan.member(formula).spec.input_len());
                seen += 1;
            }
        }
        assert_eq!(seen, plan.cases());
        assert_eq!(plan.find("scene/phong"), Some(CasePlace::Scene(0)));
        for id in
            ["fog/exp/random/17", "fog/exp/random/000005", "fog/exp", "scene/teapot", "blend/add/one/one/0002", ""]
        {
            assert_eq!(plan.find(id), None, "{id}");
        }
    }

    #[test]
    fn every_case_on_a_target_is_found_by_its_id_and_no_other() {
        let filter = ["blend/{add,min}/zero", "blend/layers", "blend/add/one/one/0003"];
        let plan = plan(&filter, &["bgra8unorm", "rgba8unorm", "rgba8unorm"]).expect("the choice is right");
        assert_eq!(plan.targets, [TargetFormat::Rgba8Unorm, TargetFormat::Bgra8Unorm]);
        let mut seen = HashSet::new();
        for state in 0..plan.states.len() {
            for case in 0..plan.states[state].count() {
                for &target in &plan.targets {
                    let place = CasePlace::Pixel { target, state, case };
                    let id = plan.id(place);
                    assert_eq!(plan.find(&id), Some(place), "{id}");
                    assert_eq!(plan.state_inputs(state, case).len(), plan.state_member(state).spec.input_len());
                    seen.insert(id);
                }
            }
        }
        assert_eq!(seen.len() as u64, 2 * plan.pixels());
        // Each name of MIN with a factor of 0 has cases of its own.
        assert!(seen.contains("blend/min/zero/src-color/0004@rgba8unorm"));
        for id in [
            "blend/min/zero/src-color/0004",
            "blend/min/zero/src-color/0004@rgba16float",
            "blend/min/zero/src-color/0004@unknown",
            "blend/min/zero/src-color/0004@",
            "blend/min/zero/src-color/0005@rgba8unorm",
            "blend/min/zero/src-color@rgba8unorm",
            "unknown@rgba8unorm",
        ] {
            assert_eq!(plan.find(id), None, "{id}");
        }
    }

    #[test]
    fn an_unknown_target_is_refused_by_its_name() {
        let error = plan(&["fog"], &["rgba8unorm", "rgb565"]).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.starts_with("no target `rgb565`; expected rgba32float"), "{error}");
    }

    #[test]
    fn special_values_are_found_where_they_are_asked_for() {
        let mut plan = plan(&["special/nan"], &[]).expect("the choice is right");
        assert!(plan.probes.len() > 50 && plan.cases() == 0, "{}", plan.probes.len());
        for probe in 0..plan.probes.len() {
            let place = CasePlace::Probe(probe);
            assert_eq!(plan.find(&plan.id(place)), Some(place), "{}", plan.id(place));
        }
        // Of another table, of a rasteriser, of no table, and where none is asked for.
        for id in ["special/infinity/sum-overflow", "special/nan/varying-nan", "special/nan/none", "special"] {
            assert_eq!(plan.find(id), None, "{id}");
        }
        plan = GatePlan::new(Choice { special: false, ..plan.choice }).expect("the choice is right");
        assert_eq!((plan.find("special/nan/negate-nan"), plan.probes.len()), (None, 0));
    }
}
