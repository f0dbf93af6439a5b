//! What is known of each case: a few bytes, so that a gate does not grow with what is answered.

use super::plan::{CasePlace, GatePlan};
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// What became of a case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum CaseState {
    /// Nothing has been answered.
    #[default]
    Open,
    /// Every verdict passed, or permits anything.
    Passed,
    /// The renderer does not do it.
    Skipped,
    /// A verdict failed.
    Failed,
    /// What was answered cannot be judged.
    Unjudged,
    /// The renderer ended or hung at it.
    Broken,
}

impl CaseState {
    /// Its name in a report; none for what passed.
    const fn name(self) -> Option<&'static str> {
        match self {
            Self::Passed => None,
            Self::Open => Some("missing"),
            Self::Skipped => Some("skipped"),
            Self::Failed | Self::Unjudged | Self::Broken => Some("failed"),
        }
    }
}

/// How an answer stands to what was known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// The case had no answer.
    First,
    /// It was answered so in an earlier run.
    Same,
    /// It was answered in another way in an earlier run.
    Changed,
    /// It was answered in this run.
    Twice,
}

/// The states of all cases.
pub struct Register {
    /// Of each formula, and then of each scene, which has one case.
    groups: Vec<RegisterGroup>,
    formulas: usize,
    /// Whether this run follows another one.
    pub is_again: bool,
}

struct RegisterGroup {
    states: Vec<CaseState>,
    /// What was answered, hashed.
    digests: Vec<u32>,
    /// Whether a run that follows another one has answered it.
    again: Vec<bool>,
}

impl Register {
    /// Nothing is known of the cases of a plan.
    #[must_use]
    pub fn new(plan: &GatePlan) -> Self {
        let counts = plan.formulas.iter().map(super::plan::PlannedFormula::count).chain(plan.scenes.iter().map(|_| 1));
        let group = |count: usize| RegisterGroup {
            states: vec![CaseState::Open; count],
            digests: vec![0; count],
            again: vec![],
        };
        Self { groups: counts.map(group).collect(), formulas: plan.formulas.len(), is_again: false }
    }

    /// The number of a place's formula, or of its scene behind the formulas.
    #[must_use]
    pub const fn group(&self, place: CasePlace) -> usize {
        match place {
            CasePlace::Case { formula, .. } => formula,
            CasePlace::Scene(scene) => self.formulas + scene,
        }
    }

    const fn case(place: CasePlace) -> usize {
        match place {
            CasePlace::Case { case, .. } => case,
            CasePlace::Scene(_) => 0,
        }
    }

    /// The place of a case of a group.
    #[must_use]
    pub const fn place(&self, group: usize, case: usize) -> CasePlace {
        if group < self.formulas {
            CasePlace::Case { formula: group, case }
        } else {
            CasePlace::Scene(group - self.formulas)
        }
    }

    /// What became of a case.
    #[must_use]
    pub fn state(&self, place: CasePlace) -> CaseState {
        self.groups[self.group(place)].states[Self::case(place)]
    }

    /// A run begins in which every case may be answered once more.
    pub fn begin_again(&mut self) {
        self.is_again = true;
        for group in &mut self.groups {
            group.again = vec![false; group.states.len()];
        }
    }

    /// Notes an answer.
    pub fn answer(&mut self, place: CasePlace, state: CaseState, digest: u32) -> Turn {
        let (group, case) = (self.group(place), Self::case(place));
        let is_again = self.is_again;
        let group = &mut self.groups[group];
        let (own, known) = (&mut group.states[case], &mut group.digests[case]);
        if !is_again {
            if *own != CaseState::Open {
                return Turn::Twice;
            }
            (*own, *known) = (state, digest);
            return Turn::First;
        }
        if std::mem::replace(&mut group.again[case], true) {
            Turn::Twice
        } else if (*own, *known) == (state, digest) {
            Turn::Same
        } else {
            Turn::Changed
        }
    }

    /// The cases of a group in some states.
    pub fn of(&self, group: usize, is_one: impl Fn(CaseState) -> bool) -> impl Iterator<Item = CasePlace> {
        let states = &self.groups[group].states;
        (0..states.len()).filter(move |&case| is_one(states[case])).map(move |case| self.place(group, case))
    }

    /// The cases that an earlier run answered and this one did not.
    pub fn unanswered_again(&self) -> impl Iterator<Item = CasePlace> {
        self.groups.iter().enumerate().flat_map(move |(number, group)| {
            let is_left = |&case: &usize| group.states[case] != CaseState::Open && !group.again[case];
            (0..group.again.len()).filter(is_left).map(move |case| self.place(number, case))
        })
    }

    /// The cases of a group that did not pass, by what became of them: each by the end of its id, and cases in a row as `000003..000017`.
    #[must_use]
    pub fn not_passed(&self, plan: &GatePlan, group: usize) -> BTreeMap<String, Vec<String>> {
        let mut all: BTreeMap<String, Vec<Run>> = BTreeMap::new();
        for (case, &state) in self.groups[group].states.iter().enumerate() {
            let Some(name) = state.name() else { continue };
            let id = ending(plan, self.place(group, case));
            let runs = all.entry(name.to_owned()).or_default();
            match runs.last_mut() {
                Some(run) if run.goes_on(case, &id) => (run.last, run.end) = (case, id),
                _ => runs.push(Run { first: id.clone(), last: case, end: id }),
            }
        }
        all.into_iter().map(|(name, runs)| (name, runs.into_iter().map(Run::text).collect())).collect()
    }
}

/// The end of a case's id behind that of its formula; a scene's name.
#[must_use]
pub fn ending(plan: &GatePlan, place: CasePlace) -> String {
    let id = plan.id(place);
    let formula = match place {
        CasePlace::Case { formula, .. } => plan.member(formula).spec.id.as_str(),
        CasePlace::Scene(_) => "scene",
    };
    id.strip_prefix(formula).and_then(|rest| rest.strip_prefix('/')).unwrap_or(&id).to_owned()
}

/// A hash of what was answered.
pub(super) fn digest(numbers: impl Iterator<Item = u64>) -> u32 {
    let mut hasher = DefaultHasher::new();
    numbers.for_each(|number| number.hash(&mut hasher));
    #[expect(clippy::cast_possible_truncation, reason = "a part of a hash")]
    let digest = hasher.finish() as u32;
    digest
}

/// Cases in a row.
struct Run {
    first: String,
    last: usize,
    end: String,
}

impl Run {
    /// Whether a case is the next of this row: its number is the next one, under the same path.
    fn goes_on(&self, case: usize, id: &str) -> bool {
        case == self.last + 1
            && numbered(&self.end).zip(numbered(id)).is_some_and(|((a, k), (b, n))| a == b && n == k + 1)
    }

    fn text(self) -> String {
        let tail = self.end.rsplit('/').next().unwrap_or_default();
        if self.first == self.end { self.first } else { format!("{}..{tail}", self.first) }
    }
}

/// The path and the number of an id that ends in one.
fn numbered(id: &str) -> Option<(&str, u64)> {
    let (path, number) = id.rsplit_once('/').unwrap_or(("", id));
    number.bytes().all(|byte| byte.is_ascii_digit()).then_some(())?;
    Some((path, number.parse().ok()?))
}

/// The ids that a text such as `random/000003..000017` stands for.
pub fn expanded(text: &str) -> impl Iterator<Item = String> {
    let range = text.split_once("..").and_then(|(first, last)| {
        let (_, from) = numbered(first)?;
        let path = &first[..first.len() - last.len().min(first.len())];
        Some((path.to_owned(), last.len(), from, last.parse::<u64>().ok()?))
    });
    let (one, many) = match range {
        None => (Some(text.to_owned()), None),
        Some((path, width, from, to)) => (None, Some((from..=to).map(move |n| format!("{path}{n:0width$}")))),
    };
    one.into_iter().chain(many.into_iter().flatten())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_document::pack::Choice;

    fn plan() -> GatePlan {
        let filter = ["fog/exp", "blend/add/one/zero", "scene/flat"].map(str::to_owned).to_vec();
        GatePlan::new(Choice { filter, cases: 30, seed: 1, size: Some(32) }).expect("the globs are valid")
    }

    #[test]
    fn an_answer_is_first_the_same_changed_or_given_twice() {
        let plan = plan();
        let mut known = Register::new(&plan);
        let at = |case| CasePlace::Case { formula: 0, case };
        assert_eq!(known.answer(at(0), CaseState::Passed, 7), Turn::First);
        assert_eq!(known.answer(at(0), CaseState::Passed, 7), Turn::Twice);
        known.answer(at(1), CaseState::Failed, 8);
        known.answer(at(2), CaseState::Passed, 9);
        known.answer(CasePlace::Scene(0), CaseState::Passed, 1);
        known.begin_again();
        assert_eq!(known.answer(at(0), CaseState::Passed, 7), Turn::Same);
        assert_eq!(known.answer(at(0), CaseState::Passed, 7), Turn::Twice);
        assert_eq!(known.answer(at(1), CaseState::Failed, 9), Turn::Changed);
        // Answered in this run only.
        assert_eq!(known.answer(at(3), CaseState::Passed, 9), Turn::Changed);
        assert_eq!(known.unanswered_again().collect::<Vec<_>>(), [at(2), CasePlace::Scene(0)]);
    }

    #[test]
    fn cases_in_a_row_are_written_short_and_read_back() {
        let plan = plan();
        let mut known = Register::new(&plan);
        for group in 0..plan.formulas.len() + plan.scenes.len() {
            let count = plan.formulas.get(group).map_or(1, super::super::plan::PlannedFormula::count);
            for case in 0..count {
                let state = match case % 11 {
                    0..3 => CaseState::Passed,
                    3..9 => CaseState::Failed,
                    9 => CaseState::Skipped,
                    _ => continue,
                };
                known.answer(known.place(group, case), state, 1);
            }
            let written = known.not_passed(&plan, group);
            for (name, states) in [
                ("failed", &[CaseState::Failed][..]),
                ("skipped", &[CaseState::Skipped]),
                ("missing", &[CaseState::Open]),
            ] {
                let expected: Vec<String> =
                    known.of(group, |state| states.contains(&state)).map(|place| ending(&plan, place)).collect();
                let texts = written.get(name).cloned().unwrap_or_default();
                let read: Vec<String> = texts.iter().flat_map(|text| expanded(text)).collect();
                assert_eq!(read, expected, "{texts:?}");
                assert!(name != "failed" || texts.len() * 2 < expected.len() || count == 1, "{texts:?}");
            }
        }
    }
}
