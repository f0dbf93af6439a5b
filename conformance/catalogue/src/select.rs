//! Which cases a run is made of: ids, and the choice among them by filter and shard.

use crate::cases::blend::{Program, Samples};
use crate::cases::{self, AnyFormula, Boundaries, Drawing, Kind, Spec};
use crate::filter::Filter;
use lightmeter_scene::blend::Separate;
use std::cell::OnceCell;
use std::num::NonZeroU64;

/// A case of a formula, in the order in which a run takes them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CaseRef {
    /// A named hard case, by its place in the description.
    Hard(usize),
    /// The k-th case within a few ULP of a named one.
    Near(usize, u64),
    /// The k-th case drawn close to where the formula decides or degenerates.
    Boundary(u64),
    /// The k-th random case.
    Random(u64),
}

/// Cases near each hard one.
const NEAR: u64 = 32;

/// What a number of a row is where it is not drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Held {
    /// The same in every case.
    Number(f32),
    /// What the number at another place is.
    SameAs(usize),
}

/// A formula with its description.
pub struct Member {
    /// The formula.
    pub formula: Box<dyn AnyFormula>,
    /// Its description.
    pub spec: Spec,
    /// A number for its id, which another formula hardly ever has.
    pub number: u64,
    /// Numbers of a row that are not drawn, by their places: what whoever is judged has as a constant, or in common with another input.
    pub held: Vec<(usize, Held)>,
    /// Numbers of its outputs that whoever is judged does not give, by their places.
    pub missing: Vec<usize>,
}

impl Member {
    /// A formula with its description.
    #[must_use]
    pub fn new(formula: Box<dyn AnyFormula>) -> Self {
        let spec = formula.spec();
        let number = spec.id.bytes().fold(0, |number, byte| cases::mix(number ^ u64::from(byte)));
        Self { spec, number, formula, held: vec![], missing: vec![] }
    }

    /// Whether it is one of the many blend states, whose cases stand right below it.
    fn is_state(&self) -> bool {
        matches!(self.spec.kind, Kind::Blend(Program::Draw(..)))
    }

    /// The path of the random cases.
    fn random_path(&self) -> String {
        if self.is_state() { self.spec.id.clone() } else { format!("{}/random", self.spec.id) }
    }

    /// The case's id: `fog/linear/random/000017`, `blend/add/zero/one/0007`, `fog/linear/hard/dmin-equals-dmax`.
    #[must_use]
    pub fn case_id(&self, case: CaseRef) -> String {
        match case {
            CaseRef::Random(k) if self.is_state() => format!("{}/{k:04}", self.random_path()),
            CaseRef::Random(k) => format!("{}/{k:06}", self.random_path()),
            CaseRef::Hard(place) => format!("{}/hard/{}", self.spec.group(), self.spec.hard[place].name),
            CaseRef::Near(place, k) => format!("{}/near/{k:02}", self.case_id(CaseRef::Hard(place))),
            CaseRef::Boundary(k) => format!("{}/boundary/{k:04}", self.spec.id),
        }
    }

    /// Whether the formula has a case.
    #[must_use]
    pub fn has(&self, case: CaseRef) -> bool {
        match case {
            CaseRef::Hard(place) => place < self.spec.hard.len(),
            CaseRef::Near(place, k) => place < self.spec.hard.len() && k < self.near(),
            CaseRef::Boundary(k) => k < self.boundary(),
            CaseRef::Random(_) => true,
        }
    }

    /// The case of that id, if it is one of this formula's.
    #[must_use]
    pub fn case(&self, id: &str) -> Option<CaseRef> {
        if let Some(name) = id.strip_prefix(self.spec.group()).and_then(|rest| rest.strip_prefix("/hard/")) {
            let place = |name: &str| self.spec.hard.iter().position(|hard| hard.name == name);
            return match name.split_once("/near/") {
                None => place(name).map(CaseRef::Hard),
                Some((name, k)) => {
                    k.parse().ok().filter(|&k| k < self.near()).and_then(|k| Some(CaseRef::Near(place(name)?, k)))
                }
            };
        }
        if let Some(number) = id.strip_prefix(&*self.spec.id).and_then(|rest| rest.strip_prefix("/boundary/")) {
            return number.parse().ok().filter(|&k| k < self.boundary()).map(CaseRef::Boundary);
        }
        let number = id.strip_prefix(&self.random_path())?.strip_prefix('/')?;
        number.parse().ok().map(CaseRef::Random)
    }

    /// Cases near each hard one: of arithmetic, whose inputs may be anything.
    #[must_use]
    pub fn near(&self) -> u64 {
        if matches!(self.spec.kind, Kind::Arithmetic) { NEAR } else { 0 }
    }

    /// Cases close to where it decides or degenerates.
    #[must_use]
    pub fn boundary(&self) -> u64 {
        cases::boundary_cases(&self.spec)
    }

    /// The hard cases, then those near them.
    pub fn hard_and_near(&self) -> impl Iterator<Item = CaseRef> + use<> {
        let (hard, near) = (self.spec.hard.len(), self.near());
        let near = (0..hard).flat_map(move |place| (0..near).map(move |k| CaseRef::Near(place, k)));
        (0..hard).map(CaseRef::Hard).chain(near)
    }

    /// All cases that are the same whatever the seed: the hard ones, those near them, and those at boundaries.
    pub fn fixed(&self) -> impl Iterator<Item = CaseRef> + use<> {
        self.hard_and_near().chain((0..self.boundary()).map(CaseRef::Boundary))
    }

    /// The case's inputs, appended to a row. Of many cases [`Member::draws`] gives them sooner.
    pub fn inputs(&self, case: CaseRef, seed: u64, row: &mut Vec<f32>) {
        self.draws(seed).inputs(case, row);
    }

    /// Draws cases one after another.
    #[must_use]
    pub const fn draws(&self, seed: u64) -> Draws<'_> {
        Draws { member: self, seed, random: OnceCell::new(), boundaries: OnceCell::new() }
    }

    /// Sets the inputs of a row that are held.
    pub fn hold(&self, row: &mut [f32]) {
        for &(place, held) in &self.held {
            row[place] = match held {
                Held::Number(value) => value,
                Held::SameAs(other) => row[other],
            };
        }
    }

    /// The inputs of a hard case, appended to a row.
    fn hard_inputs(&self, place: usize, row: &mut Vec<f32>) {
        let start = row.len();
        for input in self.spec.inputs {
            input.middle(row);
        }
        for (name, values) in self.spec.hard[place].inputs {
            let range = self.spec.place(name).unwrap_or_default();
            row[start..][range].copy_from_slice(values);
        }
    }
}

/// The cases of a formula by one seed, drawn one after another: what they have in common is worked out once, when it is asked for.
pub struct Draws<'a> {
    member: &'a Member,
    seed: u64,
    random: OnceCell<Drawing<'a>>,
    boundaries: OnceCell<Boundaries<'a>>,
}

impl Draws<'_> {
    /// The case's inputs, appended to a row.
    pub fn inputs(&self, case: CaseRef, row: &mut Vec<f32>) {
        let (member, spec, start) = (self.member, &self.member.spec, row.len());
        match case {
            CaseRef::Random(k) => self.random.get_or_init(|| Drawing::new(spec, self.seed)).inputs(k, row),
            CaseRef::Boundary(k) => self.boundaries.get_or_init(|| Boundaries::new(spec)).inputs(k, row),
            CaseRef::Hard(place) => member.hard_inputs(place, row),
            CaseRef::Near(place, k) => {
                member.hard_inputs(place, row);
                cases::move_by_ulps(spec, &spec.hard[place], k, &mut row[start..]);
            }
        }
        member.hold(&mut row[start..]);
    }
}

/// Random cases of a formula in a run of `cases`: all of them, or a quarter where colour and alpha have states of their own;
/// none of NaN and infinity, whose cases are all named.
#[must_use]
pub fn random_cases(spec: &Spec, cases: u64) -> u64 {
    match spec.kind {
        Kind::Blend(Program::Special(_)) => 0,
        Kind::Blend(Program::Draw(state, _)) if state.color != state.alpha => cases.div_ceil(4),
        _ => cases,
    }
}

/// A part of a run: cases whose number leaves `index` when divided by `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 0.
    pub index: u64,
    /// How many shards make the whole.
    pub count: NonZeroU64,
}

impl Shard {
    /// The whole.
    pub const WHOLE: Self = Self { index: 0, count: NonZeroU64::MIN };

    /// Whether it has the case of this number.
    #[must_use]
    pub const fn has(self, number: u64) -> bool {
        number % self.count.get() == self.index
    }
}

/// The cases of one formula that are selected.
#[derive(Clone, Debug)]
pub enum Random {
    /// All of the first n.
    First(u64),
    /// Some.
    Some(Vec<u64>),
}

/// What is selected of one formula.
#[derive(Clone, Debug)]
pub struct Selected {
    /// The formula's place in the catalogue.
    pub member: usize,
    /// Its random cases.
    pub random: Random,
    /// Its hard cases.
    pub hard: Vec<usize>,
    /// Those near a hard case: its place, and which.
    pub near: Vec<(usize, u64)>,
    /// Those at boundaries.
    pub boundary: Vec<u64>,
    shard: Shard,
}

impl Selected {
    /// Random cases of the formula at a place.
    #[must_use]
    pub const fn whole(member: usize, random: Random) -> Self {
        Self { member, random, hard: vec![], near: vec![], boundary: vec![], shard: Shard::WHOLE }
    }

    /// The cases, hard ones first.
    pub fn cases(&self) -> impl Iterator<Item = CaseRef> + '_ {
        let random: Box<dyn Iterator<Item = u64>> = match &self.random {
            Random::First(n) => {
                Box::new((self.shard.index..*n).step_by(usize::try_from(self.shard.count.get()).unwrap_or(usize::MAX)))
            }
            Random::Some(some) => Box::new(some.iter().copied()),
        };
        let near = self.near.iter().map(|&(place, k)| CaseRef::Near(place, k));
        let boundary = self.boundary.iter().copied().map(CaseRef::Boundary);
        self.hard.iter().copied().map(CaseRef::Hard).chain(near).chain(boundary).chain(random.map(CaseRef::Random))
    }

    /// What of them is evaluated in stages that take rows of numbers: a sixteenth of the many blend states' cases, since it
    /// is one function for all.
    #[must_use]
    pub fn rows(&self, member: &Member) -> Self {
        match self.random {
            Random::First(n) if member.is_state() => Self { random: Random::First(n.div_ceil(16)), ..self.clone() },
            _ => self.clone(),
        }
    }

    /// A few of them: the hard cases and the first random ones; where there is neither, the first of the others.
    #[must_use]
    pub fn few(&self, random: usize) -> Self {
        let number = |case| match case {
            CaseRef::Random(number) => Some(number),
            CaseRef::Hard(_) | CaseRef::Near(..) | CaseRef::Boundary(_) => None,
        };
        let few: Vec<u64> = self.cases().filter_map(number).take(random).collect();
        let others = if few.is_empty() && self.hard.is_empty() { random } else { 0 };
        let near = self.near.iter().copied().take(others).collect();
        let boundary = self.boundary.iter().copied().take(others).collect();
        Self { random: Random::Some(few), near, boundary, ..self.clone() }
    }

    /// How many cases there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.random_count() + (self.hard.len() + self.near.len() + self.boundary.len()) as u64
    }

    /// How many of them are random.
    #[must_use]
    pub fn random_count(&self) -> u64 {
        match &self.random {
            Random::First(n) if *n > self.shard.index => (n - self.shard.index).div_ceil(self.shard.count.get()),
            Random::First(_) => 0,
            Random::Some(some) => some.len() as u64,
        }
    }
}

/// The formulas in order.
#[must_use]
pub fn catalogue() -> Vec<Member> {
    catalogue_of(&Samples::default())
}

/// The formulas in order, with the states that are to be sampled.
#[must_use]
pub fn catalogue_of(samples: &Samples) -> Vec<Member> {
    cases::all(samples).into_iter().map(Member::new).collect()
}

/// The blend states that are judged under another's name, under their own.
#[must_use]
pub fn alias_members() -> Vec<Member> {
    cases::blend::alias_formulas().into_iter().map(Member::new).collect()
}

/// A state with another one for alpha, whether the catalogue has it or not.
#[must_use]
pub fn separate_member(state: Separate) -> Member {
    let formula = cases::blend::separate_formula(state);
    Member::new(formula)
}

/// The cases of a catalogue that a filter and a shard select, of `cases` random ones for each formula.
///
/// A state that is judged under another's name is selected by its own name too.
#[must_use]
pub fn select(catalogue: &[Member], filter: &Filter, cases: u64, shard: Shard) -> Vec<Selected> {
    let aliased: Vec<String> = if filter.is_empty() {
        vec![]
    } else {
        cases::blend::aliases().filter(|(alias, _)| filter.selects(alias)).map(|(_, canonical)| canonical).collect()
    };
    // A case that is named exactly is selected however many random cases are asked for.
    let named: Vec<String> = filter.literals().map(canonical_id).collect();
    let mut selected = vec![];
    for (place, member) in catalogue.iter().enumerate() {
        let count = random_cases(&member.spec, cases);
        let path = member.random_path();
        let random = if filter.selects(&path) || aliased.contains(&member.spec.id) {
            Random::First(count)
        } else {
            let mut some: Vec<u64> = named
                .iter()
                .filter_map(|id| member.case(id).filter(|&case| member.case_id(case) == *id))
                .filter_map(|case| if let CaseRef::Random(k) = case { Some(k) } else { None })
                .collect();
            if filter.reaches_below(&path) {
                some.extend((0..count).filter(|&k| filter.selects(&member.case_id(CaseRef::Random(k)))));
            }
            some.retain(|&k| shard.has(k));
            some.sort_unstable();
            some.dedup();
            Random::Some(some)
        };
        let hard = (0..member.spec.hard.len())
            .filter(|&k| shard.has(k as u64) && filter.selects(&member.case_id(CaseRef::Hard(k))))
            .collect();
        let near = (0..member.spec.hard.len())
            .flat_map(|k| {
                let chosen = below(filter, member.near(), move |near| member.case_id(CaseRef::Near(k, near)));
                chosen.map(move |near| (k, near))
            })
            .filter(|&(_, near)| shard.has(near))
            .collect();
        let boundary = below(filter, member.boundary(), |k| member.case_id(CaseRef::Boundary(k)));
        let boundary = boundary.filter(|&k| shard.has(k)).collect();
        let chosen = Selected { member: place, random, hard, near, boundary, shard };
        if chosen.count() > 0 {
            selected.push(chosen);
        }
    }
    selected
}

/// Which of the first cases of a path a filter selects, whose ids differ in the last segment alone: those are looked at only where the path does
/// not tell.
fn below(filter: &Filter, count: u64, id: impl Fn(u64) -> String) -> impl Iterator<Item = u64> {
    let first = if count == 0 { String::new() } else { id(0) };
    let path = first.rsplit_once('/').map_or("", |(path, _)| path);
    let are_all = filter.selects(path);
    let names_one = || filter.literals().any(|id| id.rsplit_once('/').is_some_and(|(of, _)| of == path));
    let last = if are_all || filter.reaches_below(path) || names_one() { count } else { 0 };
    (0..last).filter(move |&k| are_all || filter.selects(&id(k)))
}

/// The id under which a case is judged: that of its own name, or of the state that its state is an alias of.
#[must_use]
pub fn canonical_id(id: &str) -> String {
    let renamed = cases::blend::aliases().find_map(|(alias, canonical)| {
        id.strip_prefix(&alias).filter(|rest| rest.starts_with('/')).map(|rest| canonical + rest)
    });
    renamed.unwrap_or_else(|| id.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a filter says of the id of each case that is not random, one after the other.
    fn by_id(member: &Member, filter: &Filter, shard: Shard) -> Vec<CaseRef> {
        let hard = (0..member.spec.hard.len()).map(CaseRef::Hard);
        let near = (0..member.spec.hard.len()).flat_map(|k| (0..member.near()).map(move |near| CaseRef::Near(k, near)));
        let all = hard.chain(near).chain((0..member.boundary()).map(CaseRef::Boundary));
        all.filter(|&case| {
            let number = match case {
                CaseRef::Hard(k) => k as u64,
                CaseRef::Near(_, k) | CaseRef::Boundary(k) | CaseRef::Random(k) => k,
            };
            shard.has(number) && filter.selects(&member.case_id(case))
        })
        .collect()
    }

    #[test]
    fn cases_that_are_selected_together_are_those_that_are_selected_one_by_one() {
        let catalogue: Vec<Member> = catalogue().into_iter().filter(|one| one.spec.id.starts_with("fog/")).collect();
        let some = ["fog/exp/boundary/0003", "fog/exp/hard/*/near/01"];
        for globs in [
            &["fog"][..],
            &["fog/exp"],
            &["fog/*/boundary"],
            &["fog/*/boundary/00?1"],
            &["**/0007"],
            &["fog/**/near/{00,02}"],
            &["fog/exp/hard/*"],
            &["fog/linear/random"],
            &some,
            &[],
        ] {
            let filter = Filter::new(globs).expect("the globs are valid");
            for shard in [Shard::WHOLE, Shard { index: 1, count: NonZeroU64::MIN.saturating_add(2) }] {
                let selected = select(&catalogue, &filter, 5, shard);
                for (place, member) in catalogue.iter().enumerate() {
                    let chosen = selected.iter().find(|chosen| chosen.member == place);
                    let of_chosen = |chosen: &Selected| {
                        let hard = chosen.hard.iter().map(|&k| CaseRef::Hard(k));
                        let near = chosen.near.iter().map(|&(k, near)| CaseRef::Near(k, near));
                        let boundary = chosen.boundary.iter().map(|&k| CaseRef::Boundary(k));
                        hard.chain(near).chain(boundary).collect::<Vec<_>>()
                    };
                    let found = chosen.map(of_chosen).unwrap_or_default();
                    assert_eq!(found, by_id(member, &filter, shard), "{globs:?}, {}", member.spec.id);
                }
            }
        }
    }
}
