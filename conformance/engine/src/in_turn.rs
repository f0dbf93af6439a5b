//! The turns of a run, judged one after the other, while devices are at work on those that come next.
//!
//! A software driver draws on one thread. So while what is legal of one turn is worked out and judged, its device is handed the first
//! rows, or the images, of the next ones. A renderer is asked turn by turn.

use crate::ask_again::Noted;
use crate::blend_unit;
use crate::blend_unit::run::NotedPixels;
use crate::device::DeviceError;
use crate::expected::expect_problems;
use crate::image;
use crate::image::run::BegunScene;
use crate::options::Options;
use crate::renderer::AskedRenderer;
use crate::row_run::{Begun, RowRun, Stages};
use crate::scout::{Scouted, ScoutedGroups, few};
use crate::selection::Selection;
use crate::special;
use crate::special::verdict::Table;
use crate::stability;
use crate::subject::Subject;
use crate::supply::{RowGroup, Supply};
use crate::turn::{Turn, not_asked, scene_of};
use crate::under_way::{is_over, tell};
use lightmeter_catalogue::cases::{Kind, Stage};
use lightmeter_catalogue::scene::select::Chosen;
use lightmeter_catalogue::select::{CaseRef, Member, Selected};
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::report::{Failure, Group, Report};
use lightmeter_judge::chunk::Chunk;
use std::collections::VecDeque;
use std::time::Instant;

/// Failing cases of each formula that are asked once more.
const MOST_AGAIN: usize = 1024;
/// Parts that have begun at once, at most.
const AT_ONCE: usize = 6;
/// Pixels of scenes that have begun, from which on no further part begins.
const PIXELS: usize = 1 << 19;

/// What is judged in one step: a chunk of a formula group's rows, or all else of a turn.
struct Part<'a> {
    place: usize,
    turn: Turn<'a>,
    rows: Option<Rows<'a>>,
}

/// A chunk of a group's rows; an empty one where the group has none.
struct Rows<'a> {
    group: &'a RowGroup<'a>,
    cases: Vec<(usize, CaseRef)>,
    is_first: bool,
    is_last: bool,
}

/// A part that subjects are at work on, or why it could not begin.
struct Step<'a> {
    part: Part<'a>,
    begun: Result<Work<'a>, DeviceError>,
}

/// What subjects were handed of a part.
enum Work<'a> {
    /// Nothing yet: what is asked for in one go, rows that nobody answers any more, a group without rows.
    Nothing,
    Rows(Vec<Begun<'a>>),
    Scene(Box<BegunScene>),
}

impl Step<'_> {
    /// Whether another part may begin while this one waits to be judged. Behind one that failed nothing does, nor behind a table of special
    /// values, which is judged before anything is drawn.
    const fn lets_begin(&self) -> bool {
        self.begun.is_ok() && !matches!(self.part.turn, Turn::Table(_))
    }

    /// Pixels of its images.
    fn pixels(&self) -> usize {
        if let Ok(Work::Scene(scene)) = &self.begun { scene.pixels() } else { 0 }
    }

    /// Whether subjects are at work on it.
    const fn is_begun(&self) -> bool {
        matches!(self.begun, Ok(Work::Scene(_) | Work::Rows(_)))
    }
}

/// What came of a part.
#[derive(Clone, Copy, PartialEq, Eq)]
enum After {
    /// More of its turn follows.
    More,
    /// Its turn is over.
    Turn,
    /// Nothing more is to be judged.
    All,
}

/// A group of formulas, some of whose rows subjects are at work on.
struct GroupRun<'a> {
    place: usize,
    run: RowRun<'a>,
    /// What a blend unit left.
    pixels: Option<NotedPixels>,
}

/// What the turns are made of, in the order in which they are judged.
fn parts<'a>(turns: &'a [(usize, Turn<'a>)], rows: &'a [RowGroup<'a>]) -> impl Iterator<Item = Part<'a>> {
    turns.iter().flat_map(move |&(place, turn)| -> Box<dyn Iterator<Item = Part<'a>> + 'a> {
        let Some(group) = rows.iter().find(|group| group.turn() == place) else {
            return Box::new(std::iter::once(Part { place, turn, rows: None }));
        };
        let (mut chunks, mut next) = (group.chunks().peekable(), Some(true));
        Box::new(std::iter::from_fn(move || {
            let is_first = next?;
            let cases = chunks.next().unwrap_or_default();
            let is_last = chunks.peek().is_none();
            next = (!is_last).then_some(false);
            Some(Part { place, turn, rows: Some(Rows { group, cases, is_first, is_last }) })
        }))
    })
}

/// The turns of a run, and how far they are.
pub(crate) struct InTurn<'a, 'r> {
    selection: &'a Selection,
    supply: Supply<'a>,
    subjects: &'r mut [Subject],
    options: &'r Options,
    /// Groups whose scouts are judged.
    scouted: ScoutedGroups<'a>,
    report: &'r mut Report,
    observer: &'r mut dyn Observer,
    /// The groups that are under way, the first that is judged in front.
    groups: VecDeque<GroupRun<'a>>,
}

/// What came of turns, each by its place in the order of reports.
#[derive(Default)]
pub(crate) struct Outcome<'a> {
    pub(crate) judged: Vec<(usize, Vec<Group>, Vec<Failure>)>,
    /// What was answered, to be compared with what is answered later.
    pub(crate) noted: Vec<(Turn<'a>, Noted)>,
}

impl<'a, 'r> InTurn<'a, 'r> {
    pub(crate) fn new(
        selection: &'a Selection,
        supply: Supply<'a>,
        subjects: &'r mut [Subject],
        (options, scouted): (&'r Options, ScoutedGroups<'a>),
        report: &'r mut Report,
        observer: &'r mut dyn Observer,
    ) -> Self {
        Self { selection, supply, subjects, options, scouted, report, observer, groups: VecDeque::new() }
    }

    /// Judges one after the other, until a device fails or the run is stopped.
    pub(crate) fn judge_all(
        mut self,
        turns: &'a [(usize, Turn<'a>)],
        rows: &'a [RowGroup<'a>],
    ) -> Result<Outcome<'a>, DeviceError> {
        let at_once = if self.is_asked() { 1 } else { AT_ONCE };
        let mut outcome = Outcome::default();
        let (mut parts, mut under_way) = (parts(turns, rows).peekable(), VecDeque::<Step<'a>>::new());
        loop {
            while under_way.len() < at_once
                && under_way.back().is_none_or(Step::lets_begin)
                && under_way.iter().map(Step::pixels).sum::<usize>() < PIXELS
                && let Some(part) = parts.next_if(|part| under_way.is_empty() || self.is_ready(part))
            {
                under_way.push_back(self.begin(part));
            }
            let Some(step) = under_way.pop_front() else { return Ok(self.ended(outcome)) };
            let place = step.part.place;
            match self.judge(step, &under_way, &mut outcome)? {
                After::More => {}
                // A renderer that failed within a turn is asked no more of it.
                After::Turn => while parts.next_if(|part| part.place == place).is_some() {},
                After::All => return Ok(self.ended(outcome)),
            }
        }
    }

    /// What came of all, with the scouts of the groups that the run did not come to.
    fn ended(mut self, mut outcome: Outcome<'a>) -> Outcome<'a> {
        let begun = std::mem::take(&mut self.groups).into_iter().map(|group| (group.place, group.run));
        let scouted = std::mem::take(&mut self.scouted).into_iter().map(|(place, scouted)| (place, scouted.run));
        for (place, run) in begun.chain(scouted) {
            let (groups, failures) = few(&run, self.subjects, self.options, self.report);
            outcome.judged.push((place, groups, failures));
        }
        outcome
    }

    /// Whether a renderer is asked, case by case.
    fn is_asked(&self) -> bool {
        self.subjects.iter().any(|subject| subject.asked().is_some())
    }

    /// Whether a part can begin without a wait for its rows.
    fn is_ready(&self, part: &Part<'_>) -> bool {
        part.rows.as_ref().is_none_or(|rows| rows.cases.is_empty() || self.supply.has_ready())
    }

    /// Hands a part to the subjects, as far as they can be at work on it while others are judged.
    fn begin(&mut self, part: Part<'a>) -> Step<'a> {
        let begun = match (&part.rows, part.turn) {
            (Some(rows), _) => self.begin_rows(rows),
            (None, Turn::Scene(chosen)) if !self.is_asked() => {
                let loaded = scene_of(chosen, self.selection);
                image::run::begin(loaded, self.subjects, self.options, self.report)
                    .map(|begun| Work::Scene(Box::new(begun)))
            }
            _ => Ok(Work::Nothing),
        };
        Step { part, begun }
    }

    fn begin_rows(&mut self, rows: &Rows<'a>) -> Result<Work<'a>, DeviceError> {
        let place = rows.group.turn();
        let mut begun = vec![];
        if rows.is_first {
            let clock = Instant::now();
            let (run, scouted) = match self.scouted.remove(&place) {
                Some(Scouted { run, chunk }) => (run, Some(chunk)),
                None => (RowRun::new(rows.group.members(), self.subjects, self.options)?, None),
            };
            self.report.timing.compile += clock.elapsed().as_secs_f64();
            self.groups.push_back(GroupRun { place, run, pixels: None });
            if let Some(chunk) = scouted {
                begun.push(self.start(chunk, Stages::Rest)?);
            }
        }
        let has_ended =
            self.is_asked() && self.subjects.iter().all(|one| one.asked().is_some_and(AskedRenderer::is_over));
        if !rows.cases.is_empty() && !has_ended {
            let ready = self.supply.next(place);
            self.report.timing.generate += ready.drawing;
            self.report.timing.reference += ready.evaluating;
            begun.push(self.start(ready.chunk, Stages::All)?);
        }
        Ok(if begun.is_empty() { Work::Nothing } else { Work::Rows(begun) })
    }

    /// Hands cases of the group that began last to stages of every subject.
    fn start(&mut self, chunk: Chunk<'a>, stages: Stages) -> Result<Begun<'a>, DeviceError> {
        let group = self.groups.back().expect("a group is under way once its first rows have begun");
        group.run.start(chunk, stages, self.subjects, self.report)
    }

    /// Judges a part and, where it is the last of its turn, takes what came of the turn. Some parts have begun after it.
    fn judge(
        &mut self,
        step: Step<'a>,
        others: &VecDeque<Step<'a>>,
        outcome: &mut Outcome<'a>,
    ) -> Result<After, DeviceError> {
        let Part { place, turn, rows } = step.part;
        let id = turn.id(self.selection);
        if rows.as_ref().is_none_or(|rows| rows.is_first) {
            self.observer.see(&Event::Group(&id));
        }
        let noted = match (turn, step.begun, &rows) {
            (Turn::Formulas(chosen), begun, Some(rows)) => self.rows(chosen, begun, rows),
            (_, Err(error), _) => Err(error),
            (Turn::Table(table), ..) => self.table(table).map(Some),
            (Turn::Scene(chosen), Ok(begun), _) => self.scene(chosen, begun).map(Some),
            (Turn::Formulas(group), ..) => self.without_rows(group).map(Some),
            (Turn::Blended(group), ..) => self.blended(group).map(|pixels| Some(Noted::Pixels(pixels))),
        };
        let result = match noted {
            // More of the turn follows.
            Ok(None) => return Ok(After::More),
            Ok(Some(noted)) => {
                outcome.noted.push((turn, noted));
                Ok(())
            }
            Err(error) => Err(error),
        };
        let report = &mut *self.report;
        let (mut groups, mut failures) = (std::mem::take(&mut report.groups), std::mem::take(&mut report.failures));
        let is_asked = self.subjects.iter().any(|subject| subject.asked().is_some());
        failures.iter_mut().for_each(|failure| failure.rerun = self.options.again(failure, is_asked));
        expect_problems(&mut groups, &mut report.expectations);
        find_sources(&mut groups, self.subjects);
        tell(&groups, &failures, false, self.observer);
        outcome.judged.push((place, groups, failures));
        let mut under_way = id;
        if result.is_err() {
            // A driver may have failed at any of those.
            let mut others: Vec<&Part<'_>> =
                others.iter().filter(|step| step.is_begun()).map(|step| &step.part).collect();
            others.retain(|other| other.place != place);
            others.dedup_by_key(|other| other.place);
            let ids: Vec<String> = others.iter().map(|other| other.turn.id(self.selection)).collect();
            if !ids.is_empty() {
                under_way += &format!(" (or {}, begun after it)", ids.join(", "));
            }
        }
        let is_over = is_over(result, &under_way, self.options, report)?;
        // Of a renderer everything is reported: what it was not asked is missing.
        Ok(if is_over && !self.is_asked() { After::All } else { After::Turn })
    }

    /// Judges a table of special values.
    fn table(&mut self, table: &Table) -> Result<Noted, DeviceError> {
        let (options, report) = (self.options, &mut *self.report);
        if let [subject] = &mut *self.subjects
            && subject.asked().is_some()
        {
            return special::asked::run_table(table, subject, options, report, self.observer).map(Noted::Probes);
        }
        special::verdict::run_table(table, self.subjects, options, report, self.observer).map(|()| Noted::Nothing)
    }

    /// Judges a scene, whose images a device has begun to draw.
    fn scene(&mut self, chosen: &Chosen, begun: Work<'a>) -> Result<Noted, DeviceError> {
        let (options, report) = (self.options, &mut *self.report);
        match (begun, &mut *self.subjects) {
            (Work::Scene(begun), subjects) => {
                image::run::judge(*begun, chosen, subjects, options, report, self.observer)?;
                Ok(Noted::Nothing)
            }
            (_, [subject]) => {
                let loaded = scene_of(chosen, self.selection);
                image::asked::run_scene(&loaded, chosen, subject, options, report, self.observer)
                    .map(|image| Noted::Images(vec![image]))
            }
            _ => unreachable!("a renderer that is asked is the only subject"),
        }
    }

    /// Judges a chunk of a group's rows and, behind the last one, the group; `None` where more of it follow.
    fn rows(
        &mut self,
        chosen: &[Selected],
        begun: Result<Work<'a>, DeviceError>,
        rows: &Rows<'a>,
    ) -> Result<Option<Noted>, DeviceError> {
        let (is_asked, options) = (self.is_asked(), self.options);
        let is_stopped = || !is_asked && options.stop.is_set();
        let begun = match begun {
            Ok(begun) => begun,
            Err(error) => return Err(self.broken(error)),
        };
        if rows.is_first && !is_asked && is_blended(rows.group.members()[0]) {
            let drawn = self.blended(chosen);
            let group = self.groups.front_mut().expect("it has begun");
            match drawn {
                Ok(pixels) if !is_stopped() => group.pixels = Some(pixels),
                other => {
                    self.cut_short();
                    return other.map(|pixels| Some(Noted::Pixels(pixels)));
                }
            }
        }
        if is_stopped() {
            let pixels = self.cut_short();
            return Ok(Some(Noted::Pixels(pixels.unwrap_or_default())));
        }
        if let Err(error) = self.chunk(begun, rows, is_asked) {
            return Err(self.broken(error));
        }
        if !rows.is_last {
            return Ok(None);
        }
        self.finish(chosen, rows.group.members(), is_asked).map(Some)
    }

    /// Reports what was judged of the group under way, whose other cases nobody judges any more; what a blend unit left of it.
    fn cut_short(&mut self) -> Option<NotedPixels> {
        let group = self.groups.pop_front()?;
        let (groups, failures) = few(&group.run, self.subjects, self.options, self.report);
        self.report.groups.extend(groups);
        self.report.failures.extend(failures);
        group.pixels
    }

    /// Reports what was judged of a group, if any of it had begun, before it came to an error.
    fn broken(&mut self, error: DeviceError) -> DeviceError {
        if let Some(group) = self.groups.pop_front() {
            group.run.finish(self.subjects, self.options, self.report);
        }
        error
    }

    /// Judges a chunk of a group's rows.
    fn chunk(&mut self, begun: Work<'a>, rows: &Rows<'a>, is_asked: bool) -> Result<(), DeviceError> {
        let run = &mut self.groups.front_mut().expect("it has begun").run;
        match begun {
            Work::Rows(begun) => {
                for cases in begun {
                    run.judge(cases, self.subjects, self.options, self.report, self.observer)?;
                }
            }
            _ => run.leave_out(&rows.cases),
        }
        if !is_asked {
            self.observer.see(&Event::Advanced(rows.cases.len() as u64));
        }
        Ok(())
    }

    /// Reports the group that is judged, and examines its stable forms.
    fn finish(&mut self, chosen: &[Selected], members: &[&Member], is_asked: bool) -> Result<Noted, DeviceError> {
        let GroupRun { mut run, pixels, .. } = self.groups.pop_front().expect("it has begun");
        let (options, report) = (self.options, &mut *self.report);
        let first = report.groups.len();
        let digests = run.noted();
        let failing = if is_asked && digests.is_none() { run.failing(MOST_AGAIN) } else { vec![] };
        run.finish(self.subjects, options, report);
        if is_asked {
            return Ok(digests.map_or(Noted::Failing(failing), Noted::Rows));
        }
        for (member, chosen) in members.iter().zip(chosen) {
            stability::examine(member, &chosen.hard, self.subjects, options, report)?;
        }
        for group in &mut report.groups[first..] {
            if let Some(unstable) = stability::problem(&report.stability, &group.id, &group.adapter, &group.stage) {
                group.problems.push(unstable);
                group.totals.failed_groups = 1;
            }
        }
        let pixels = pixels.unwrap_or_default();
        Ok(match digests {
            Some(rows) => Noted::Both(pixels, rows),
            None => Noted::Pixels(pixels),
        })
    }

    /// A group without stages that take rows, or one that a renderer lacks.
    fn without_rows(&mut self, chosen: &[Selected]) -> Result<Noted, DeviceError> {
        let member = &self.selection.catalogue[chosen[0].member];
        if let [subject] = &*self.subjects
            && let Some(reason) = subject.asked().and_then(|renderer| renderer.lacks(&member.spec.id))
        {
            let (id, stage) = (member.spec.id.clone(), Stage::Answer.name());
            self.report.groups.push(not_asked(id, stage, chosen[0].count(), reason, subject));
            return Ok(Noted::Nothing);
        }
        let pixels = if is_blended(member) { self.blended(chosen)? } else { NotedPixels::default() };
        Ok(Noted::Pixels(pixels))
    }

    /// Judges what blend units leave.
    fn blended(&mut self, chosen: &[Selected]) -> Result<NotedPixels, DeviceError> {
        let catalogue = &self.selection.catalogue;
        let members: Vec<&Member> = chosen.iter().map(|chosen| &catalogue[chosen.member]).collect();
        blend_unit::run::run_group(&members, chosen, self.subjects, self.options, self.report, self.observer)
    }
}

const fn is_blended(member: &Member) -> bool {
    matches!(member.spec.kind, Kind::Blend(_))
}

/// Notes where a renderer's code of each group stands, as far as it says so.
fn find_sources(groups: &mut [Group], subjects: &[Subject]) {
    let Some(renderer) = subjects.iter().find_map(Subject::asked) else { return };
    groups.iter_mut().for_each(|group| group.source = renderer.source(&group.id));
}
