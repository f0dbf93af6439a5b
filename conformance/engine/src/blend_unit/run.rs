//! A group of blend states judged on every subject and target.

use super::chunk::{self, UnitChunk};
use super::draw::draw;
use super::standing::UnitStanding;
use crate::again;
use crate::device::{Code, DeviceError};
use crate::options::Options;
use crate::renderer::AskedPixels;
use crate::subject::Subject;
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::{CaseRef, Member, Selected};
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::report::{Interrupted, Report};
use lightmeter_scene::target::TargetFormat;
use std::time::Instant;

/// Judges a group's states on every subject and target. What was judged before a device failed stays in the report.
pub(crate) fn run_group(
    members: &[&Member],
    group: &[Selected],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<NotedPixels, DeviceError> {
    let is_asked = subjects.iter().any(|subject| subject.asked().is_some());
    let mut standings = standings(members[0], subjects, options);
    let mut noted = NotedPixels::default();
    if standings.iter().all(Vec::is_empty) {
        return Ok(noted);
    }
    let mut result = Ok(());
    let mut parts = chunk::parts(members, group, is_asked).peekable();
    'chunks: while parts.peek().is_some() && (is_asked || !options.stop.is_set()) {
        let clock = Instant::now();
        let chunk = UnitChunk::next(&mut parts, options.seed);
        report.timing.generate += clock.elapsed().as_secs_f64();
        for (subject, standings) in subjects.iter_mut().zip(&mut standings) {
            for standing in standings {
                if let Err(error) = standing.judge(subject, &chunk, options, members, report) {
                    let under_way = under_way(&chunk, subject, standing.target, &options.code, &error);
                    report.interrupted = Some(Interrupted::by_device(&under_way, &error));
                    result = Err(error);
                    break 'chunks;
                }
                observer.see(&Event::Advanced(chunk.cases.iter().map(|cases| cases.len() as u64).sum()));
            }
        }
    }
    for (subject, standings) in subjects.iter_mut().zip(standings) {
        if result.is_ok()
            && let Some(device) = subject.device_mut()
        {
            device.forget_pipelines();
        }
        let mut of_subject = vec![];
        for mut standing in standings {
            of_subject.push(std::mem::take(&mut standing.digests));
            let target = standing.target;
            let failing = std::mem::take(&mut standing.failing).into_iter();
            noted.failing.extend(failing.map(|(member, case, digest)| (target, member, case, digest)));
            standing.finish(members, subject, options, report);
        }
        noted.all.push(of_subject);
    }
    result.map(|()| noted)
}

/// Of each subject, a standing for each target that it is asked to blend on.
fn standings(member: &Member, subjects: &[Subject], options: &Options) -> Vec<Vec<UnitStanding>> {
    let of_subject = |subject: &Subject| {
        let mut targets = targets_of(member, &options.targets);
        targets.retain(|target| subject.asked().is_none_or(|renderer| renderer.targets().contains(target)));
        targets.into_iter().map(|target| UnitStanding::new(target, subject.lacks_blending(target))).collect()
    };
    subjects.iter().map(of_subject).collect()
}

/// What was left on targets.
#[derive(Default)]
pub(crate) struct NotedPixels {
    /// By subject and target, of each case in turn, where all is asked again.
    all: Vec<Vec<Vec<u32>>>,
    /// Of cases that failed: the target, the formula's place among the group's, the case and what was left.
    failing: Vec<(TargetFormat, usize, CaseRef, u32)>,
}

/// Draws a group's states once more, or of a renderer the cases that failed, and notes each whose pixel is another one.
pub(crate) fn run_again(
    members: &[&Member],
    group: &[Selected],
    noted: &NotedPixels,
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
) -> Result<(), DeviceError> {
    if options.runs == 1 {
        return ask_failing(members, &noted.failing, subjects, options, report);
    }
    let is_asked = subjects.iter().any(|subject| subject.asked().is_some());
    let mut standings = standings(members[0], subjects, options);
    let mut before: Vec<Vec<std::slice::Iter<'_, u32>>> =
        noted.all.iter().map(|targets| targets.iter().map(|digests| digests.iter()).collect()).collect();
    let mut parts = chunk::parts(members, group, is_asked).peekable();
    while parts.peek().is_some() && !options.stop.is_set() {
        let chunk = UnitChunk::next(&mut parts, options.seed);
        for ((subject, standings), before) in subjects.iter_mut().zip(&mut standings).zip(&mut before) {
            for (standing, before) in standings.iter_mut().zip(before) {
                for (member, case, now) in standing.draw_again(subject, &chunk, options, report)? {
                    if before.next().is_some_and(|&before| again::has_changed(before, now)) {
                        again::changed(report, || format!("{} on {}", member.case_id(case), standing.target.name()));
                    }
                }
            }
        }
    }
    for device in subjects.iter_mut().filter_map(Subject::device_mut) {
        device.forget_pipelines();
    }
    Ok(())
}

/// Asks a renderer once more for pixels that failed.
fn ask_failing(
    members: &[&Member],
    failing: &[(TargetFormat, usize, CaseRef, u32)],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
) -> Result<(), DeviceError> {
    let Some(renderer) = subjects.iter_mut().find_map(Subject::asked_mut) else { return Ok(()) };
    for of_state in failing.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (target, member) = (of_state[0].0, members[of_state[0].1]);
        let Kind::Blend(program) = member.spec.kind else { unreachable!("only blend states are drawn by the unit") };
        let cases: Vec<CaseRef> = of_state.iter().map(|(.., case, _)| *case).collect();
        let mut inputs = vec![];
        cases.iter().for_each(|&case| member.inputs(case, options.seed, &mut inputs));
        let answers = renderer.pixels(&AskedPixels { member, program, target, cases: &cases, inputs: &inputs })?;
        for (&(.., case, before), now) in of_state.iter().zip(answers) {
            let now = match now {
                Ok(pixel) => again::digest_of_values(pixel.iter().copied()),
                Err(why) => again::number(&why),
            };
            if again::has_changed(before, now) {
                again::changed(report, || format!("{} on {}", member.case_id(case), target.name()));
            }
        }
    }
    Ok(())
}

/// NaN and infinity are for float targets alone.
#[must_use]
pub fn targets_of(member: &Member, targets: &[TargetFormat]) -> Vec<TargetFormat> {
    let is_special = matches!(member.spec.kind, Kind::Blend(program) if program.is_special());
    targets.iter().copied().filter(|target| !(is_special && target.is_unorm())).collect()
}

/// What was under way when a device failed: the state that fails again alone on fresh devices, or all that were drawn
/// together.
fn under_way(
    chunk: &UnitChunk<'_>,
    subject: &mut Subject,
    target: TargetFormat,
    code: &Code,
    error: &DeviceError,
) -> String {
    let place = format!("on {} of {}", target.name(), subject.identity.name);
    // What hangs would hang again for minutes.
    let hangs = matches!(error, DeviceError::Hangs(_));
    for (member, piece) in chunk.members.iter().zip(&chunk.pieces).filter(|_| !hangs) {
        if let Some(device) = subject.device_mut() {
            device.renew_blend_unit();
        }
        let is_drawn = matches!(subject.lacks_route(code, piece.route), Ok(None));
        if is_drawn && draw(subject, code, target, &[piece], false).is_err() {
            return format!("{} by {} {place}, which fails alone too,", member.spec.id, piece.route.name());
        }
    }
    let (first, last) = (&chunk.members[0].spec.id, &chunk.members[chunk.members.len() - 1].spec.id);
    if first == last {
        return format!("{first} {place}");
    }
    let alone = if hangs { "" } else { " of which none fails alone" };
    format!("a submission of {} states from {first} to {last} {place},{alone}", chunk.members.len())
}
