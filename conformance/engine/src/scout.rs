//! The scouts of a run: of each formula a few cases that are judged before all others, so that what is broken is known within seconds. They are
//! asked in one stage of those that shaders are evaluated in; the other has them with the first chunk of the group. Where a run ends before
//! it comes to a group, its scouts are what is reported of it.

use crate::device::DeviceError;
use crate::options::Options;
use crate::row_run::{Begun, RowRun, Stages};
use crate::subject::Subject;
use crate::supply::RowGroup;
use crate::under_way::{is_over, tell};
use lightmeter_catalogue::cases::Kind;
use lightmeter_document::event::{Event, Observer, Silent};
use lightmeter_document::report::{Failure, Group, Report, Timing};
use lightmeter_judge::chunk::Chunk;
use std::collections::{BTreeMap, VecDeque};
use std::time::Instant;

/// Random cases of a group that are scouted, besides its hard cases; of a group of many formulas, one of each at least.
const SCOUTED: usize = 32;
/// Groups that subjects are at work on at once: a driver compiles one while others are judged.
const AT_ONCE: usize = 4;
/// A selection with fewer groups than this has no scouts, since judging all of it takes no longer.
const LEAST_GROUPS: usize = 8;

/// A group whose scouts are judged: what it has come to, and the cases that a stage has yet to answer.
pub(crate) struct Scouted<'a> {
    pub(crate) run: RowRun<'a>,
    pub(crate) chunk: Chunk<'a>,
}

/// Groups whose scouts are judged, by their turns.
pub(crate) type ScoutedGroups<'a> = BTreeMap<usize, Scouted<'a>>;

/// Chooses the scouts of each group, unless there are too few groups, or a renderer is asked: that has no time to lose.
pub(crate) fn choose(groups: &mut [RowGroup<'_>], subjects: &[Subject]) {
    if groups.len() >= LEAST_GROUPS && subjects.iter().all(|subject| subject.asked().is_none()) {
        groups.iter_mut().for_each(|group| group.scout(SCOUTED));
    }
}

/// Judges the scouts of each group. Where a device fails or the run is stopped, the report says so.
pub(crate) fn scout<'a>(
    groups: &'a [RowGroup<'a>],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<ScoutedGroups<'a>, DeviceError> {
    let mut groups: Vec<&RowGroup<'_>> = groups.iter().filter(|group| !group.scouted().is_empty()).collect();
    // In the order of reports; few formulas, and so simple shaders, first.
    groups.sort_by_key(|group| (matches!(group.members()[0].spec.kind, Kind::Blend(_)), group.turn()));
    let mut scouted = ScoutedGroups::new();
    let mut under_way: VecDeque<(&RowGroup<'_>, RowRun<'_>, Begun<'_>)> = VecDeque::new();
    let mut groups = groups.into_iter();
    loop {
        let next = if under_way.len() < AT_ONCE { groups.next() } else { None };
        let (group, judged) = match (next, under_way.pop_front()) {
            (Some(group), waiting) => {
                under_way.extend(waiting);
                let begun = begin(group, subjects, options, report);
                (group, begun.map(|(run, begun)| under_way.push_back((group, run, begun))))
            }
            (None, Some((group, run, begun))) => {
                let ended = end(run, begun, subjects, options, report, observer);
                (group, ended.map(|ended| drop(scouted.insert(group.turn(), ended))))
            }
            (None, None) => return Ok(scouted),
        };
        if is_over(judged, group.members()[0].spec.group(), options, report)? {
            return Ok(scouted);
        }
    }
}

fn begin<'a>(
    group: &'a RowGroup<'a>,
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
) -> Result<(RowRun<'a>, Begun<'a>), DeviceError> {
    let clock = Instant::now();
    let run = RowRun::new(group.members(), subjects, options)?;
    report.timing.compile += clock.elapsed().as_secs_f64();
    let begun = run.begin(group.scouted(), Stages::First, subjects, options, report)?;
    Ok((run, begun))
}

/// Judges what the subjects gave, and tells of what fails.
fn end<'a>(
    mut run: RowRun<'a>,
    begun: Begun<'a>,
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<Scouted<'a>, DeviceError> {
    observer.see(&Event::Group(run.id()));
    let chunk = match run.end(begun, subjects, options, report, &mut Silent) {
        Ok(chunk) => chunk,
        Err(error) => {
            // What the subjects before the one that failed gave is judged.
            let (groups, failures) = few(&run, subjects, options, report);
            report.groups.extend(groups);
            report.failures.extend(failures);
            return Err(error);
        }
    };
    observer.see(&Event::Advanced(chunk.cases.len() as u64));
    if run.fails() {
        let (groups, failures) = told(&run, subjects, options, &mut report.timing);
        tell(&groups, &failures, true, observer);
    }
    Ok(Scouted { run, chunk })
}

/// What some of a group's cases have come to, where nobody judges the others: it is reported, and what is excused is noted.
pub(crate) fn few(
    run: &RowRun<'_>,
    subjects: &[Subject],
    options: &Options,
    report: &mut Report,
) -> (Vec<Group>, Vec<Failure>) {
    run.note(subjects, report);
    told(run, subjects, options, &mut report.timing)
}

/// What some of a group's cases have come to. With this few only a single wrong value tells anything.
fn told(run: &RowRun<'_>, subjects: &[Subject], options: &Options, timing: &mut Timing) -> (Vec<Group>, Vec<Failure>) {
    let (mut groups, mut failures) = run.groups(subjects, options, timing);
    groups.retain(|group| group.totals.cases > 0);
    for group in &mut groups {
        group.problems.clear();
        group.totals.failed_groups = 0;
    }
    failures.iter_mut().for_each(|failure| failure.rerun = options.again(failure, false));
    (groups, failures)
}
