//! The scouts of a run: a few cases of each formula, so that what is broken is known within seconds. What they judge is told and not
//! counted: the run judges these cases again with all others, by the shaders that were compiled here. Where a run ends among its scouts, there
//! is nothing else, and what they judged is its report.

use crate::device::DeviceError;
use crate::options::Options;
use crate::row_run::{Asked, Begun, CompiledGroups, RowRun};
use crate::selection::Selection;
use crate::subject::Subject;
use crate::under_way::{is_over, tell};
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::{CaseRef, Member, Selected};
use lightmeter_document::event::{Event, Observer, Silent};
use lightmeter_document::report::Report;
use std::collections::VecDeque;

/// Random cases of a group that are scouted, besides its hard cases; of a group of many formulas, one of each at least.
const SCOUTED: usize = 32;
/// Groups that subjects are at work on at once: a driver compiles one while others are judged.
const AT_ONCE: usize = 4;
/// A selection with fewer groups than this has no scouts, since judging all of it takes no longer.
const LEAST_GROUPS: usize = 8;

/// A group whose cases subjects are at work on.
struct UnderWay<'a> {
    members: &'a [&'a Member],
    run: RowRun<'a>,
    begun: Begun<'a>,
}

/// Judges a few cases of each group, of shaders in the compute stage alone. Gives the stages of every group, compiled; `None` where
/// a device failed or the run was stopped.
pub(crate) fn scout(
    selection: &Selection,
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<Option<CompiledGroups>, DeviceError> {
    let catalogue = &selection.catalogue;
    let has_rows = |group: &&[Selected]| !catalogue[group[0].member].spec.row_stages().is_empty();
    let mut groups: Vec<&[Selected]> = selection.groups().filter(has_rows).collect();
    // A renderer is asked each case once.
    if groups.len() < LEAST_GROUPS || subjects.iter().any(|subject| subject.asked().is_some()) {
        return Ok(Some(CompiledGroups::new()));
    }
    // Few formulas, and so simple shaders, first.
    groups.sort_by_key(|group| matches!(catalogue[group[0].member].spec.kind, Kind::Blend(_)));
    let members: Vec<Vec<&Member>> =
        groups.iter().map(|group| group.iter().map(|chosen| &catalogue[chosen.member]).collect()).collect();
    let mut scouts = Scouts { options, compiled: CompiledGroups::new(), report: options.report(subjects) };
    let mut under_way: VecDeque<UnderWay<'_>> = VecDeque::new();
    let mut begun = groups.iter().zip(&members);
    loop {
        let next = if under_way.len() < AT_ONCE { begun.next() } else { None };
        let (id, judged) = match (next, under_way.pop_front()) {
            (Some((group, members)), waiting) => {
                under_way.extend(waiting);
                let begun = scouts.begin(members, group, subjects);
                (members[0].spec.group(), begun.map(|begun| under_way.push_back(begun)))
            }
            (None, Some(first)) => (first.members[0].spec.group(), scouts.end(first, subjects, observer)),
            (None, None) => break,
        };
        if is_over(judged, id, options, report)? {
            // There is nothing else, so these are counted once.
            report.groups = scouts.report.groups;
            report.failures = scouts.report.failures;
            return Ok(None);
        }
    }
    report.timing.add(&scouts.report.timing);
    Ok(Some(scouts.compiled))
}

struct Scouts<'a> {
    options: &'a Options,
    compiled: CompiledGroups,
    /// What is told and not counted.
    report: Report,
}

impl Scouts<'_> {
    fn begin<'a>(
        &mut self,
        members: &'a [&'a Member],
        group: &[Selected],
        subjects: &mut [Subject],
    ) -> Result<UnderWay<'a>, DeviceError> {
        let clock = std::time::Instant::now();
        let compiled = RowRun::compile(members[0], subjects, self.options)?;
        self.report.timing.compile += clock.elapsed().as_secs_f64();
        let run = RowRun::new(members, compiled, Asked::OneOfShaders);
        let begun = run.begin(&cases(members, group), subjects, self.options, &mut self.report)?;
        Ok(UnderWay { members, run, begun })
    }

    /// Judges what the subjects gave, and tells of what fails.
    fn end(
        &mut self,
        under_way: UnderWay<'_>,
        subjects: &mut [Subject],
        observer: &mut dyn Observer,
    ) -> Result<(), DeviceError> {
        let UnderWay { members, mut run, begun } = under_way;
        let id = members[0].spec.group();
        observer.see(&Event::Group(id));
        run.end(begun, subjects, self.options, &mut self.report, &mut Silent)?;
        let (groups, failures) = (self.report.groups.len(), self.report.failures.len());
        self.compiled.insert(id.to_owned(), run.finish(subjects, self.options, &mut self.report));
        for group in &mut self.report.groups[groups..] {
            // With this few cases only a single wrong value tells anything.
            group.problems.clear();
            group.totals.failed_groups = 0;
        }
        for failure in &mut self.report.failures[failures..] {
            failure.rerun = self.options.again(failure, false);
        }
        tell(&self.report.groups[groups..], &self.report.failures[failures..], true, observer);
        Ok(())
    }
}

/// Hard cases, and the first random ones, each with its formula's place among the group's.
fn cases(members: &[&Member], group: &[Selected]) -> Vec<(usize, CaseRef)> {
    let random = (SCOUTED / members.len()).max(1);
    let few = |chosen: &Selected, member: &Member| chosen.rows(member).few(random);
    let formulas = group.iter().zip(members).enumerate();
    formulas
        .flat_map(|(of, (chosen, member))| few(chosen, member).cases().map(|case| (of, case)).collect::<Vec<_>>())
        .collect()
}
