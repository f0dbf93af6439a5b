//! Which cases another renderer is asked, and where each stands.

use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::cases::blend::Program;
use lightmeter_catalogue::filter::{Filter, FilterError};
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::select::{builtin, scene_id};
use lightmeter_catalogue::select::{CaseRef, Member, Random, Selected, Shard, catalogue, select};
use lightmeter_document::pack::Choice;
use lightmeter_scene::frame::Frame;
use std::collections::HashMap;

/// The cases that are chosen.
pub struct GatePlan {
    /// What chose them.
    pub choice: Choice,
    /// Every formula.
    pub catalogue: Vec<Member>,
    /// The formulas that have cases in it.
    pub formulas: Vec<PlannedFormula>,
    /// The scenes, by their places among the built-in ones.
    pub scenes: Vec<usize>,
    /// The formula of a path of random cases.
    random: HashMap<String, usize>,
    /// The formula and the case of an id with a name.
    named: HashMap<String, (usize, CaseRef)>,
    /// The formula of an id.
    places: HashMap<String, usize>,
}

/// A formula with the cases that are chosen of it.
pub struct PlannedFormula {
    /// What is chosen.
    pub selected: Selected,
    /// Hard cases and those near them come first, and how many those are.
    named: usize,
    /// The places of the named cases.
    places: HashMap<CaseRef, usize>,
}

/// A case of the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CasePlace {
    /// The formula's place among the plan's, and the case's among its own.
    Case {
        /// Of the formula.
        formula: usize,
        /// Of the case.
        case: usize,
    },
    /// The scene's place among the plan's.
    Scene(usize),
}

impl GatePlan {
    /// The cases of a choice. NaN and infinity, of which nothing is promised, are no cases here.
    ///
    /// # Errors
    /// Where a glob cannot be read.
    pub fn new(choice: Choice) -> Result<Self, FilterError> {
        let filter = Filter::new(&choice.filter)?;
        let catalogue = catalogue();
        let mut plan = Self {
            scenes: (0..SCENES.len()).filter(|&place| filter.selects(&scene_id(place))).collect(),
            formulas: vec![],
            random: HashMap::new(),
            named: HashMap::new(),
            places: HashMap::new(),
            catalogue,
            choice,
        };
        for selected in select(&plan.catalogue, &filter, plan.choice.cases, Shard::WHOLE) {
            let member = &plan.catalogue[selected.member];
            if matches!(member.spec.kind, Kind::Blend(Program::Special(_))) {
                continue;
            }
            let formula = plan.formulas.len();
            plan.places.insert(member.spec.id.clone(), formula);
            if selected.random_count() > 0 {
                let first = member.case_id(CaseRef::Random(0));
                let path = first.rsplit_once('/').map_or("", |(path, _)| path);
                plan.random.insert(path.to_owned(), formula);
            }
            let mut places = HashMap::new();
            for (place, case) in selected.cases().take_while(|case| !matches!(case, CaseRef::Random(_))).enumerate() {
                plan.named.insert(member.case_id(case), (formula, case));
                places.insert(case, place);
            }
            plan.formulas.push(PlannedFormula { selected, named: places.len(), places });
        }
        Ok(plan)
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

    /// The description of a formula of the plan.
    #[must_use]
    pub fn member(&self, formula: usize) -> &Member {
        &self.catalogue[self.formulas[formula].selected.member]
    }

    /// The place of a formula; `None` where the plan has none of its cases.
    #[must_use]
    pub fn formula(&self, id: &str) -> Option<usize> {
        self.places.get(id).copied()
    }

    /// The place of an id; `None` where the plan has no such case.
    #[must_use]
    pub fn find(&self, id: &str) -> Option<CasePlace> {
        if let Some(name) = id.strip_prefix("scene/") {
            let scene = self.scenes.iter().position(|&place| SCENES[place].0 == name)?;
            return Some(CasePlace::Scene(scene));
        }
        if let Some(&(formula, case)) = self.named.get(id) {
            let case = *self.formulas[formula].places.get(&case)?;
            return Some(CasePlace::Case { formula, case });
        }
        let (path, number) = id.rsplit_once('/')?;
        let &formula = self.random.get(path)?;
        let case = self.formulas[formula].random(number.parse().ok()?)?;
        // `17` is no id of case `000017`.
        (self.member(formula).case_id(self.formulas[formula].case(case)) == id)
            .then_some(CasePlace::Case { formula, case })
    }

    /// The id at a place.
    #[must_use]
    pub fn id(&self, place: CasePlace) -> String {
        match place {
            CasePlace::Scene(scene) => scene_id(self.scenes[scene]),
            CasePlace::Case { formula, case } => self.member(formula).case_id(self.formulas[formula].case(case)),
        }
    }

    /// The inputs of a case.
    #[must_use]
    pub fn inputs(&self, formula: usize, case: usize) -> Vec<f32> {
        let member = self.member(formula);
        let mut row = Vec::with_capacity(member.spec.input_len());
        member.inputs(self.formulas[formula].case(case), self.choice.seed, &mut row);
        row
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

    fn plan(filter: &[&str]) -> GatePlan {
        let filter = filter.iter().map(|&glob| glob.to_owned()).collect();
        GatePlan::new(Choice { filter, cases: 5, seed: 1, size: Some(32) }).expect("the globs are valid")
    }

    #[test]
    fn every_case_is_found_by_its_id_and_no_other() {
        let plan = plan(&["fog", "blend/add/zero", "vector/reflect", "blend/add/one/one/0003", "scene/phong"]);
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
}
