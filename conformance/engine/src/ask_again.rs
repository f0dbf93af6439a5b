//! All of a run, or what failed of it, asked once more.

use crate::again::{Digests, changed, digest_of, has_changed};
use crate::blend_unit::run::{NotedPixels, run_again};
use crate::device::DeviceError;
use crate::image;
use crate::options::Options;
use crate::row_run::{RowRun, Stages};
use crate::selection::Selection;
use crate::special::asked::{NotedProbe, ask_again as ask_probes};
use crate::subject::Subject;
use crate::supply::RowGroup;
use crate::turn::{Turn, scene_of};
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::{CaseRef, Member, Selected};
use lightmeter_document::event::Observer;
use lightmeter_document::report::Report;

/// What was answered, by subject, and of formulas by stage.
pub(crate) enum Noted {
    Nothing,
    /// To each case of a group.
    Rows(Vec<Vec<Digests>>),
    /// What a blend unit left, or a renderer on targets.
    Pixels(NotedPixels),
    /// The same, and what was answered to each case of the group as arithmetic.
    Both(NotedPixels, Vec<Vec<Digests>>),
    /// To some of the cases that failed, of one formula.
    Failing(Vec<Vec<Vec<(CaseRef, u32)>>>),
    /// What a renderer answered to the probes of a table.
    Probes(Vec<NotedProbe>),
    /// The image of a scene, and whether it failed.
    Images(Vec<(u32, bool)>),
}

/// Asks all cases again, as many times as the options say; if they ask for no repetition, asks renderers that want it only the cases that
/// failed. The report lists each case whose answer differs from the first.
pub(crate) fn ask_again(
    selection: &Selection,
    (noted, groups): (&[(Turn<'_>, Noted)], &[RowGroup<'_>]),
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<(), DeviceError> {
    let is_over = |subjects: &[Subject]| {
        options.stop.is_set() || subjects.iter().any(|subject| subject.asked().is_some_and(|one| one.is_over()))
    };
    let wants_failing = subjects.iter().any(|subject| subject.asked().is_some_and(|one| one.asks_failing_again()));
    let passes = if options.runs > 1 { options.runs - 1 } else { u64::from(wants_failing) };
    for _ in 0..passes {
        if is_over(subjects) {
            break;
        }
        // A renderer process is restarted only if everything is asked again; to repeat only failed cases the running process is used.
        for renderer in subjects.iter_mut().filter(|_| options.runs > 1).filter_map(Subject::asked_mut) {
            renderer.begin_again()?;
        }
        let mut pass = Pass { selection, groups, subjects, options, report, observer };
        for (turn, noted) in noted {
            if pass.options.stop.is_set() {
                break;
            }
            pass.turn(*turn, noted)?;
        }
    }
    Ok(())
}

/// One time that all is asked again.
struct Pass<'a> {
    selection: &'a Selection,
    groups: &'a [RowGroup<'a>],
    subjects: &'a mut [Subject],
    options: &'a Options,
    report: &'a mut Report,
    observer: &'a mut dyn Observer,
}

impl Pass<'_> {
    fn turn(&mut self, turn: Turn<'_>, noted: &Noted) -> Result<(), DeviceError> {
        match (turn, noted) {
            (Turn::Formulas(group), Noted::Rows(digests)) => self.rows(group, digests),
            (Turn::Formulas(group) | Turn::Blended(group), Noted::Pixels(pixels)) => self.pixels(group, pixels),
            (Turn::Formulas(group), Noted::Both(pixels, digests)) => {
                self.pixels(group, pixels)?;
                self.rows(group, digests)
            }
            (Turn::Formulas(group), Noted::Failing(failing)) => {
                let Some(failing) = failing.first().and_then(|stages| stages.first()).filter(|few| !few.is_empty())
                else {
                    return Ok(());
                };
                let (cases, digests): (Vec<_>, Vec<_>) =
                    failing.iter().map(|&(case, digest)| ((0, case), digest)).unzip();
                let members = [&self.selection.catalogue[group[0].member]];
                let run = RowRun::new(&members, self.subjects, self.options)?;
                self.chunk(&run, &members, &cases, &[vec![&digests]])
            }
            (Turn::Table(_), Noted::Probes(noted)) => ask_probes(noted, self.subjects, self.options, self.report),
            (Turn::Scene(chosen), Noted::Images(images)) => {
                let id = turn.id(self.selection);
                for (subject, &(digest, has_failed)) in self.subjects.iter_mut().zip(images) {
                    let is_asked = self.options.runs > 1 || has_failed;
                    let (Some(renderer), true) = (subject.asked_mut(), is_asked) else { continue };
                    let loaded = scene_of(chosen, self.selection);
                    let again = image::asked::ask(renderer, &id, &loaded)?;
                    if has_changed(digest, digest_of(&again)) {
                        changed(self.report, || id.clone());
                    }
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// What is left on targets, of all cases of a group or of those that failed.
    fn pixels(&mut self, group: &[Selected], noted: &NotedPixels) -> Result<(), DeviceError> {
        let catalogue = &self.selection.catalogue;
        let members: Vec<&Member> = group.iter().map(|chosen| &catalogue[chosen.member]).collect();
        if !matches!(members[0].spec.kind, Kind::Blend(_)) {
            return Ok(());
        }
        run_again(&members, group, noted, self.subjects, self.options, self.report)
    }

    /// All cases of a group, in the same order.
    fn rows(&mut self, group: &[Selected], digests: &[Vec<Digests>]) -> Result<(), DeviceError> {
        let first = &self.selection.catalogue[group[0].member].spec.id;
        let Some(group) = self.groups.iter().find(|rows| rows.members()[0].spec.id == *first) else { return Ok(()) };
        let run = RowRun::new(group.members(), self.subjects, self.options)?;
        let mut done = 0;
        for next in std::iter::once(group.scouted().to_vec()).chain(group.chunks()).filter(|next| !next.is_empty()) {
            if self.options.stop.is_set() {
                break;
            }
            let of_chunk = |stage: &'_ Digests| stage.0.get(done..done + next.len()).unwrap_or_default().to_vec();
            let before: Vec<Vec<Vec<u32>>> =
                digests.iter().map(|stages| stages.iter().map(of_chunk).collect()).collect();
            let before: Vec<Vec<&Vec<u32>>> = before.iter().map(|stages| stages.iter().collect()).collect();
            self.chunk(&run, group.members(), &next, &before)?;
            done += next.len();
        }
        Ok(())
    }

    /// Asks cases, and compares what is answered by each stage of each subject with what was answered before.
    fn chunk<'m>(
        &mut self,
        run: &RowRun<'m>,
        members: &'m [&'m Member],
        cases: &[(usize, CaseRef)],
        before: &[Vec<&Vec<u32>>],
    ) -> Result<(), DeviceError> {
        let begun = run.begin(cases, Stages::All, self.subjects, self.options, self.report)?;
        let now = run.answers(begun, self.subjects, self.observer)?;
        for (before, now) in before.iter().zip(&now).flat_map(|(before, now)| before.iter().zip(now)) {
            for ((&(member, case), &before), &now) in cases.iter().zip(*before).zip(&now.0) {
                if has_changed(before, now) {
                    changed(self.report, || members[member].case_id(case));
                }
            }
        }
        Ok(())
    }
}
