//! A group of blend states judged on every subject and target.

use super::chunk::{self, UnitChunk};
use super::draw::draw;
use super::standing::UnitStanding;
use crate::device::{Code, DeviceError};
use crate::options::Options;
use crate::subject::Subject;
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::{Member, Selected};
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::run::{Interrupted, Report};
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
) -> Result<(), DeviceError> {
    let mut targets = targets_of(members[0], &options.targets);
    let renderer = subjects.iter().find_map(Subject::asked);
    targets.retain(|target| renderer.is_none_or(|renderer| renderer.targets().contains(target)));
    let is_asked = renderer.is_some();
    if targets.is_empty() {
        return Ok(());
    }
    let mut standings: Vec<Vec<UnitStanding>> = subjects
        .iter()
        .map(|subject| {
            targets.iter().map(|&target| UnitStanding::new(target, subject.lacks_blending(target))).collect()
        })
        .collect();
    let mut result = Ok(());
    let mut parts = chunk::parts(members, group, is_asked).peekable();
    'chunks: while parts.peek().is_some() && (is_asked || !options.stop.is_set()) {
        let clock = Instant::now();
        let chunk = UnitChunk::next(&mut parts, options.seed);
        report.timing.generate += clock.elapsed().as_secs_f64();
        for (subject, standings) in subjects.iter_mut().zip(&mut standings) {
            for standing in standings {
                if let Err(error) = standing.judge(subject, &chunk, options, members, report) {
                    report.interrupted = Some(Interrupted {
                        under_way: under_way(&chunk, subject, standing.target, &options.code, &error),
                        message: error.to_string(),
                        signal: None,
                    });
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
        for standing in standings {
            standing.finish(members, subject, options, report);
        }
    }
    result
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
