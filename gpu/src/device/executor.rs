//! Runs descriptions of work on a device by wgpu: the one place that makes objects, encodes commands and submits them.

use super::clock::Span;
use super::encode::encode;
use super::objects::Objects;
use super::readback::{Layout, Pending};
use super::{Clock, ClockReading, Gpu};
use crate::error::GpuError;
use crate::work::{Resources, Submission};

/// Runs submissions on a device, and keeps what outlives them.
#[derive(Debug, Default)]
pub(crate) struct Executor {
    kept: Objects,
}

impl Executor {
    /// Makes the resources that are described and not made yet. The description is that of the calls before, perhaps with
    /// more at the lists' ends.
    ///
    /// # Errors
    /// Where the device refuses a shader or a pipeline, which is said of `file`, or fails at something else. What was
    /// refused has its place all the same.
    pub(crate) fn make(&mut self, gpu: &Gpu, resources: &Resources, file: &str) -> Result<(), GpuError> {
        self.kept.compile(gpu, resources, None);
        gpu.check_shader(file)?;
        self.kept.fill(gpu, resources, None);
        gpu.check()
    }

    /// Drops all pipelines.
    pub(crate) fn forget_pipelines(&mut self) {
        self.kept.forget_pipelines();
    }

    /// Submits the work and asks for what comes back.
    pub(crate) fn submit(&self, gpu: &Gpu, work: &Submission) -> Pending {
        let own = self.prepare(gpu, work);
        let scope = own.scope(Some(&self.kept));
        let layout = Layout::new(scope, &work.reads);
        let through = match work.through {
            Some(buffer) => scope.buffer(buffer).clone(),
            None => layout.buffer(gpu),
        };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encode(&mut encoder, scope, &work.steps, Span::NONE);
        layout.encode(&mut encoder, scope, &work.reads, &through);
        Pending::new(gpu.queue.submit([encoder.finish()]), through, layout)
    }

    /// How long the steps of the work take, repeated `repeats` times. Nothing comes back.
    ///
    /// # Errors
    /// Where the device fails.
    pub(crate) fn time(
        &self,
        gpu: &Gpu,
        clock: &Clock,
        work: &Submission,
        repeats: u32,
    ) -> Result<ClockReading, GpuError> {
        let own = self.prepare(gpu, work);
        let scope = own.scope(Some(&self.kept));
        clock.time(gpu, |encoder, span| {
            for k in 0..repeats {
                encode(encoder, scope, &work.steps, span.part(k == 0, k + 1 == repeats));
            }
        })
    }

    /// Makes what ends with the submission, and writes what is to be written before it.
    fn prepare(&self, gpu: &Gpu, work: &Submission) -> Objects {
        let mut own = Objects::default();
        own.compile(gpu, &work.own, Some(&self.kept));
        own.fill(gpu, &work.own, Some(&self.kept));
        for write in &work.writes {
            gpu.queue.write_buffer(own.scope(Some(&self.kept)).buffer(write.buffer), 0, &write.contents.0);
        }
        own
    }
}
