//! A group of blend states judged on every subject and target.

use super::draw::{Piece, draw};
use super::standing::UnitStanding;
use crate::device::{Code, DeviceError};
use crate::options::{Options, Progress};
use crate::subject::Subject;
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::{CaseRef, Member, Selected};
use lightmeter_document::run::{Interrupted, Report};
use lightmeter_scene::blend::{Route, routes};
use lightmeter_scene::target::TargetFormat;
use rayon::prelude::*;
use std::time::Instant;

/// Pixels of a submission.
const PIXELS: usize = 1 << 19;
/// Cases of a state that are taken at once.
const BLOCK: usize = 1 << 15;

/// Pieces of a chunk, and whose they are.
pub(super) struct UnitChunk<'a> {
    pub(super) members: Vec<&'a Member>,
    pub(super) cases: Vec<Vec<CaseRef>>,
    pub(super) pieces: Vec<Piece>,
}

/// Judges a group's states on every subject and target. What was judged before a device failed stays in the report.
pub(crate) fn run_group(
    members: &[&Member],
    group: &[Selected],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    progress: &mut impl Progress,
) -> Result<(), DeviceError> {
    let targets = targets_of(members[0], &options.targets);
    let mut standings: Vec<Vec<UnitStanding>> = subjects
        .iter()
        .map(|subject| {
            targets.iter().map(|&target| UnitStanding::new(target, subject.lacks_blending(target))).collect()
        })
        .collect();
    let mut result = Ok(());
    let mut pieces = pieces(members, group).peekable();
    'chunks: while pieces.peek().is_some() {
        let clock = Instant::now();
        let chunk = UnitChunk::next(&mut pieces, options.seed);
        report.timing.generate += clock.elapsed().as_secs_f64();
        for (subject, standings) in subjects.iter_mut().zip(&mut standings) {
            for standing in standings {
                if let Err(error) = standing.judge(subject, &chunk, options, report) {
                    report.interrupted = Some(Interrupted {
                        under_way: chunk.under_way(subject, standing, &options.code, &error),
                        message: error.to_string(),
                    });
                    result = Err(error);
                    break 'chunks;
                }
                progress.advance(chunk.cases.iter().map(|cases| cases.len() as u64).sum());
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
            standing.finish(members[0], subject, report);
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

/// A state by a route with some of its cases.
type Part<'a> = (&'a Member, Route, Vec<CaseRef>);

fn pieces<'a>(members: &'a [&'a Member], group: &'a [Selected]) -> impl Iterator<Item = Part<'a>> {
    members.iter().zip(group).flat_map(|(member, chosen)| {
        let Kind::Blend(program) = member.spec.kind else { unreachable!("only blend states are drawn by the unit") };
        let mut cases = chosen.cases();
        let blocks = std::iter::from_fn(move || {
            let block: Vec<CaseRef> = cases.by_ref().take(BLOCK).collect();
            (!block.is_empty()).then_some(block)
        });
        blocks
            .flat_map(move |block| routes(program.layer(0).0).iter().map(move |route| (*member, *route, block.clone())))
    })
}

impl<'a> UnitChunk<'a> {
    fn next(parts: &mut impl Iterator<Item = Part<'a>>, seed: u64) -> Self {
        let (mut taken, mut pixels) = (vec![], 0);
        while pixels < PIXELS {
            let Some(part) = parts.next() else { break };
            pixels += part.2.len();
            taken.push(part);
        }
        let pieces = taken.par_iter().map(|(member, route, cases)| {
            let mut inputs = vec![];
            for &case in cases {
                member.inputs(case, seed, &mut inputs);
            }
            let Kind::Blend(program) = member.spec.kind else { unreachable!("checked where the parts are made") };
            Piece { program, route: *route, inputs, stride: member.spec.input_len() }
        });
        let pieces = pieces.collect();
        let (members, cases) = taken.into_iter().map(|(member, _, cases)| (member, cases)).unzip();
        Self { members, cases, pieces }
    }

    /// What was under way when a device failed: the state that fails again alone on fresh devices, or all that were drawn
    /// together.
    fn under_way(&self, subject: &mut Subject, standing: &UnitStanding, code: &Code, error: &DeviceError) -> String {
        let target = standing.target;
        let place = format!("on {} of {}", target.name(), subject.identity.name);
        // What hangs would hang again for minutes.
        let hangs = matches!(error, DeviceError::Hangs(_));
        for (member, piece) in self.members.iter().zip(&self.pieces).filter(|_| !hangs) {
            if let Some(device) = subject.device_mut() {
                device.renew_blend_unit();
            }
            let is_drawn = matches!(subject.lacks_route(code, piece.route), Ok(None));
            if is_drawn && draw(subject, code, target, &[piece], false).is_err() {
                return format!("{} by {} {place}, which fails alone too,", member.spec.id, piece.route.name());
            }
        }
        let (first, last) = (&self.members[0].spec.id, &self.members[self.members.len() - 1].spec.id);
        if first == last {
            return format!("{first} {place}");
        }
        let alone = if hangs { "" } else { " of which none fails alone" };
        format!("a submission of {} states from {first} to {last} {place},{alone}", self.members.len())
    }
}
