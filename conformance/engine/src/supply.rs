//! The chunks of a run's formulas, drawn and evaluated ahead of the subjects.
//!
//! A thread of its own draws cases and works out what is legal of them, in the order in which the run judges them, on whatever cores are free
//! while subjects compile, draw, and are judged. So that memory stays flat it waits where enough is ready.

use crate::options::Options;
use crate::turn::{CHUNK, Turn, cases_of};
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::select::{CaseRef, Member, Selected};
use lightmeter_judge::chunk::{self, Chunk};
use std::collections::{HashSet, VecDeque};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::Scope;
use std::time::Instant;

/// Cases that may be ready, or more if they are of one chunk.
const READY: usize = 2 * CHUNK;

/// The formulas of a turn that are evaluated in stages which take rows.
pub(crate) struct RowGroup<'a> {
    /// The place of the turn among all.
    turn: usize,
    members: Vec<&'a Member>,
    rows: Vec<Selected>,
    /// The cases that are judged before all others.
    scouted: Vec<(usize, CaseRef)>,
}

impl<'a> RowGroup<'a> {
    /// Of a turn; `None` where it has no such stage, or `lacks` says that nobody is asked.
    pub(crate) fn of(
        (place, turn): &(usize, Turn<'_>),
        catalogue: &'a [Member],
        is_asked: bool,
        lacks: impl Fn(&str) -> bool,
    ) -> Option<Self> {
        let Turn::Formulas(group) = turn else { return None };
        let members: Vec<&Member> = group.iter().map(|chosen| &catalogue[chosen.member]).collect();
        if lacks(&members[0].spec.id) || (!is_asked && members[0].spec.row_stages().is_empty()) {
            return None;
        }
        // A renderer is asked for all cases of a state, once.
        let rows =
            |(chosen, member): (&Selected, &&Member)| if is_asked { chosen.clone() } else { chosen.rows(member) };
        let rows = group.iter().zip(&members).map(rows).collect();
        Some(Self { turn: *place, members, rows, scouted: vec![] })
    }

    /// Has a few cases judged before all others: each formula's hard cases, and its first random ones, of which the group has about `random`.
    pub(crate) fn scout(&mut self, random: usize) {
        let few = |rows: &Selected| rows.few((random / self.members.len()).max(1));
        self.scouted = cases_of(&self.rows.iter().map(few).collect::<Vec<_>>()).collect();
    }

    /// The cases that are judged before all others, each with its formula's place among the members.
    pub(crate) fn scouted(&self) -> &[(usize, CaseRef)] {
        &self.scouted
    }

    /// The other cases of its chunks in turn, each with its formula's place among the members.
    pub(crate) fn chunks(&self) -> impl Iterator<Item = Vec<(usize, CaseRef)>> + '_ {
        let mut scouted: HashSet<(usize, CaseRef)> = self.scouted.iter().copied().collect();
        let mut cases = cases_of(&self.rows).filter(move |case| scouted.is_empty() || !scouted.remove(case));
        std::iter::from_fn(move || Some(cases.by_ref().take(CHUNK).collect()).filter(|next: &Vec<_>| !next.is_empty()))
    }

    pub(crate) const fn turn(&self) -> usize {
        self.turn
    }

    pub(crate) fn members(&self) -> &[&'a Member] {
        &self.members
    }
}

/// A chunk that is drawn and evaluated, and the seconds that each took.
pub(crate) struct Ready<'a> {
    turn: usize,
    pub(crate) chunk: Chunk<'a>,
    pub(crate) drawing: f64,
    pub(crate) evaluating: f64,
}

#[derive(Default)]
struct State<'a> {
    ready: VecDeque<Ready<'a>>,
    cases: usize,
    /// Nothing more is wanted.
    is_over: bool,
    /// Nothing more comes.
    is_done: bool,
}

#[derive(Default)]
struct Shared<'a> {
    state: Mutex<State<'a>>,
    changed: Condvar,
}

impl<'a> Shared<'a> {
    fn state(&self) -> MutexGuard<'_, State<'a>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait_while(&self, condition: impl FnMut(&mut State<'a>) -> bool) -> MutexGuard<'_, State<'a>> {
        self.changed.wait_while(self.state(), condition).unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether more is wanted, as soon as there is room for it.
    fn has_room(&self) -> bool {
        !self.wait_while(|state| !state.is_over && state.cases >= READY).is_over
    }

    fn put(&self, ready: Ready<'a>) {
        let mut state = self.state();
        state.cases += ready.chunk.cases.len();
        state.ready.push_back(ready);
        self.changed.notify_all();
    }
}

/// Chunks in the order of the run. Where it is dropped, its thread ends with the chunk that is under way.
pub(crate) struct Supply<'a>(Arc<Shared<'a>>);

/// Says that nothing more comes, however the thread ends.
struct Done<'a>(Arc<Shared<'a>>);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        self.0.state().is_done = true;
        self.0.changed.notify_all();
    }
}

impl Drop for Supply<'_> {
    fn drop(&mut self) {
        self.0.state().is_over = true;
        self.0.changed.notify_all();
    }
}

impl<'a> Supply<'a> {
    /// Begins to draw the chunks of groups.
    pub(crate) fn start<'scope>(scope: &'scope Scope<'scope, '_>, groups: &'a [RowGroup<'a>], options: &Options) -> Self
    where
        'a: 'scope,
    {
        let (shared, seed, profile) = (Arc::new(Shared::default()), options.seed, options.profile);
        let done = Done(Arc::clone(&shared));
        scope.spawn(move || make(groups, &done.0, seed, profile));
        Self(shared)
    }

    /// Whether a chunk is there already.
    pub(crate) fn has_ready(&self) -> bool {
        !self.0.state().ready.is_empty()
    }

    /// The next chunk of a turn; those of turns before it that nobody took are left.
    pub(crate) fn next(&self, turn: usize) -> Ready<'a> {
        loop {
            let mut state = self.0.wait_while(|state| state.ready.is_empty() && !state.is_done);
            let ready = state.ready.pop_front().expect("each chunk of a turn is taken once");
            state.cases -= ready.chunk.cases.len();
            self.0.changed.notify_all();
            if ready.turn == turn {
                return ready;
            }
        }
    }
}

fn make<'a>(groups: &'a [RowGroup<'a>], shared: &Shared<'a>, seed: u64, profile: &Profile) {
    for group in groups {
        for cases in group.chunks() {
            if !shared.has_room() {
                return;
            }
            let clock = Instant::now();
            let mut chunk = chunk::draw(&group.members, &cases, seed);
            let drawing = clock.elapsed().as_secs_f64();
            let clock = Instant::now();
            chunk::refer(&mut chunk, profile);
            shared.put(Ready { turn: group.turn, chunk, drawing, evaluating: clock.elapsed().as_secs_f64() });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::select::{Random, catalogue};

    #[test]
    fn what_is_scouted_is_in_no_chunk_and_all_else_is_in_one() {
        let catalogue = catalogue();
        let place = |id: &str| catalogue.iter().position(|member| member.spec.id == id).expect("it is there");
        let members = ["fog/exp", "fog/linear"].map(place);
        let rows: Vec<Selected> = (members.iter())
            .map(|&member| {
                let mut rows = Selected::whole(member, Random::First(CHUNK as u64));
                rows.hard = vec![0, 2];
                rows
            })
            .collect();
        let whole: Vec<(usize, CaseRef)> = cases_of(&rows).collect();
        let members = members.iter().map(|&member| &catalogue[member]).collect();
        let mut group = RowGroup { turn: 0, members, rows, scouted: vec![] };
        group.scout(32);
        assert_eq!(group.scouted().len(), 2 * (2 + 16));
        let mut all: Vec<(usize, CaseRef)> = group.scouted().iter().copied().chain(group.chunks().flatten()).collect();
        all.sort_unstable();
        let mut expected = whole;
        expected.sort_unstable();
        assert_eq!(all, expected);
    }

    #[test]
    fn chunks_come_in_turn_with_what_is_legal_and_those_that_nobody_took_are_left() {
        let catalogue = catalogue();
        let place = |id: &str| catalogue.iter().position(|member| member.spec.id == id).expect("it is there");
        let group = |(turn, id): (usize, &str)| {
            let rows = vec![Selected::whole(place(id), Random::First(CHUNK as u64 + 1))];
            RowGroup { turn, members: vec![&catalogue[place(id)]], rows, scouted: vec![] }
        };
        let groups: Vec<RowGroup<'_>> = [(3, "color/to-unorm8"), (1, "color/from-unorm8")].map(group).into();
        let options = Options::new(crate::device::Code::default());
        std::thread::scope(|scope| {
            let supply = Supply::start(scope, &groups, &options);
            let first = supply.next(3).chunk;
            assert_eq!((first.cases.len(), first.intervals.len(), first.references.len()), (CHUNK, CHUNK, CHUNK));
            // The second chunk of the turn before it, of one case, is left.
            let other = supply.next(1).chunk;
            assert_eq!((other.members[0].spec.id.as_str(), other.cases.len()), ("color/from-unorm8", CHUNK));
            let drawn = chunk::draw(&groups[1].members, &groups[1].chunks().next().expect("a chunk"), options.seed);
            assert_eq!(other.inputs, drawn.inputs);
            // The last chunk is taken by nobody, and the thread ends all the same.
        });
    }
}
