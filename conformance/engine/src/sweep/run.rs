//! The way of a sweep's data: block after block, with the next ones under way on the device while one is judged.

use super::blend::BytesWork;
use super::description::span;
use super::file::{self, DocumentError};
use super::judge::Judge;
use super::plan::{Over, SweepPlan};
use super::span::input;
use super::work::Work;
use crate::device::{Blocks, Code, DeviceError};
use crate::subject::Subject;
use lightmeter_arithmetic::Profile;
use lightmeter_document::sweep::{Statistics, SweepDocument};
use lightmeter_scene::along::{Along, key_of};
use rayon::prelude::*;
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::time::Instant;

/// Inputs that a task of the pool takes at once, of the embedded implementation.
const TASK: usize = 1 << 12;

/// Why a sweep ends early.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A shader or a device.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The checkpoint.
    #[error(transparent)]
    Document(#[from] DocumentError),
    /// The adapter lacks what it takes.
    #[error("{adapter} cannot do this sweep: {reason}")]
    Lacks {
        /// Its short name.
        adapter: String,
        /// What.
        reason: &'static str,
    },
}

/// Continues a sweep from where the document stands, by at most `part` blocks of its shard. After each block `tell` is handed the
/// document, and may end the sweep.
///
/// # Errors
/// Where the shader is invalid, the device refuses it or fails, or the document's receiver fails. What is done stands in the
/// document.
pub fn sweep(
    plan: &SweepPlan<'_>,
    subject: &mut Subject,
    code: &Code,
    profile: &'static Profile,
    document: &mut SweepDocument,
    part: Option<u64>,
    tell: &mut dyn FnMut(&SweepDocument) -> Result<ControlFlow<()>, DocumentError>,
) -> Result<(), SweepError> {
    let last = document.blocks.min(document.done.saturating_add(part.unwrap_or(u64::MAX)));
    if document.done == last {
        return Ok(());
    }
    let adapter = subject.identity.name.clone();
    let lacks = |reason| SweepError::Lacks { adapter: adapter.clone(), reason };
    match &plan.over {
        Over::Bytes => {
            let mut work = BytesWork::new(plan, subject, code, profile).map_err(&lacks)?;
            drive(&mut work, document, last, tell)
        }
        Over::Number { free, row, from, output, .. } => {
            let along = Along { row, free: *free, output: *output };
            let known = subject.known.clone();
            let whole = (key_of(input(*from, 0)), document.sweep.inputs);
            let judge = Judge { formula: &*plan.member.formula, along, profile, deviations: &known.deviations, whole };
            let Some(device) = subject.device() else {
                return drive(&mut Embedded { judge, from: *from }, document, last, tell);
            };
            let capacity = usize::try_from(plan.span().block).unwrap_or(usize::MAX);
            let blocks = device.sweep(code, plan.member, plan.stage, along, capacity)?.map_err(&lacks)?;
            drive(&mut OnDevice { blocks, judge, from: *from }, document, last, tell)
        }
    }
}

/// Blocks that are under way at once.
pub const UNDER_WAY: usize = 2;

fn drive<W: Work>(
    work: &mut W,
    document: &mut SweepDocument,
    last: u64,
    tell: &mut dyn FnMut(&SweepDocument) -> Result<ControlFlow<()>, DocumentError>,
) -> Result<(), SweepError> {
    let (before, clock) = (document.seconds, Instant::now());
    let (span, shard) = (span(&document.sweep), file::shard(document));
    let mut under_way = VecDeque::new();
    let mut next = document.done;
    while document.done < last {
        while next < last && under_way.len() < UNDER_WAY {
            let (first, count) = span.block_of(shard, next);
            under_way.push_back(work.start(first, count));
            next += 1;
        }
        let Some(job) = under_way.pop_front() else { break };
        document.statistics.add(work.finish(job)?);
        document.done += 1;
        document.seconds = before + clock.elapsed().as_secs_f64();
        if tell(document)?.is_break() {
            break;
        }
    }
    Ok(())
}

/// A shader.
struct OnDevice<'a> {
    blocks: Box<dyn Blocks + 'a>,
    judge: Judge<'a>,
    from: f32,
}

impl Work for OnDevice<'_> {
    type Job = (u32, usize);

    fn start(&mut self, first: u64, count: u64) -> Self::Job {
        let key = key_of(input(self.from, first));
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        self.blocks.start(key, count);
        (key, count)
    }

    fn finish(&mut self, (key, count): Self::Job) -> Result<Statistics, DeviceError> {
        let mut judged = None;
        self.blocks.finish(&mut |words| {
            assert!(
                judged.is_none() && words.len() == count,
                "a device gives the words of a block once, and all of them"
            );
            judged = Some(self.judge.block(key, words));
        })?;
        Ok(judged.expect("a device gives the words of a block that it has finished"))
    }
}

/// The formula in f32 on this processor.
struct Embedded<'a> {
    judge: Judge<'a>,
    from: f32,
}

impl Work for Embedded<'_> {
    type Job = (u64, u64);

    fn start(&mut self, first: u64, count: u64) -> Self::Job {
        (first, count)
    }

    fn finish(&mut self, (first, count): Self::Job) -> Result<Statistics, DeviceError> {
        let mut words = vec![0; usize::try_from(count).unwrap_or(usize::MAX)];
        words.par_chunks_mut(TASK).enumerate().for_each(|(task, words)| {
            let first = first + (task * TASK) as u64;
            let inputs: Vec<f32> = (first..).take(words.len()).map(|number| input(self.from, number)).collect();
            let mut out = vec![0.0; words.len()];
            self.judge.formula.embedded_along(&self.judge.along, &inputs, &mut out);
            for (word, value) in words.iter_mut().zip(out) {
                *word = value.to_bits();
            }
        });
        Ok(self.judge.block(key_of(input(self.from, first)), &words))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::{Asked, describe};
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::select::{Shard, catalogue};

    /// A device that is lost in its fourth block.
    struct Lost(u64);

    impl Work for Lost {
        type Job = u64;

        fn start(&mut self, _first: u64, count: u64) -> u64 {
            count
        }

        fn finish(&mut self, count: u64) -> Result<Statistics, DeviceError> {
            self.0 += 1;
            if self.0 == 4 {
                return Err(DeviceError::Failed("lost".into()));
            }
            let mut part = Statistics { inputs: count, passed: count, ..Statistics::default() };
            part.histogram.count_near([count, 0, 0]);
            Ok(part)
        }
    }

    #[test]
    fn what_was_judged_before_a_device_was_lost_is_kept() {
        let catalogue = catalogue();
        let asked = Asked { from: Some(1.0), to: Some(1.125), ..Asked::default() };
        let plan = SweepPlan::new(&catalogue, "fog/exp", &asked).expect("a plan");
        let sweep = describe(&plan, &Subject::embedded(), &WGSL, &Code::default());
        let mut document = file::begun(sweep, Shard::WHOLE);
        let last = document.blocks;
        let mut told = 0;
        let lost = drive(&mut Lost(0), &mut document, last, &mut |_| {
            told += 1;
            Ok(ControlFlow::Continue(()))
        });
        assert!(matches!(lost, Err(SweepError::Device(DeviceError::Failed(_)))), "{lost:?}");
        assert_eq!((document.done, told), (3, 3));
        let text = lightmeter_document::Document::to_json(&document).expect("JSON");
        assert_eq!(file::parse(&text).expect("it adds up").done, 3);
    }
}
