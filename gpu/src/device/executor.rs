//! Runs descriptions of work on a device: by wgpu, for which this is the one place that makes objects, encodes commands and submits them, or by
//! handing them to where the device is.

use super::clock::Span;
use super::encode::encode;
use super::hosted::Kept;
use super::native::Native;
use super::objects::Objects;
use super::readback::{Layout, Pending};
use super::{Clock, ClockReading, Gpu, Place};
use crate::error::GpuError;
use crate::work::{Resources, Submission};

/// Runs submissions on a device, and keeps what outlives them.
#[derive(Debug, Default)]
pub(crate) struct Executor {
    kept: Objects,
    /// What is kept elsewhere, where the device is there.
    elsewhere: Option<Kept>,
}

impl Executor {
    /// Makes the resources that are described and not made yet. The description is that of the calls before, perhaps with
    /// more at the lists' ends.
    ///
    /// # Errors
    /// Where the device refuses a shader or a pipeline, which is said of `file`, or fails at something else. What was
    /// refused has its place all the same. A device elsewhere makes it while this goes on: its errors are those of the next result.
    pub(crate) fn make(&mut self, gpu: &Gpu, resources: &Resources, file: &str) -> Result<(), GpuError> {
        match &gpu.place {
            Place::Here(native) => {
                self.kept.compile(native, resources, None);
                native.check_shader(file)?;
                self.kept.fill(native, resources, None);
                native.check()
            }
            Place::Hosted(host) => {
                self.elsewhere.get_or_insert_with(|| Kept::new(host)).make(resources, file);
                Ok(())
            }
        }
    }

    /// Drops all pipelines.
    pub(crate) fn forget_pipelines(&mut self) {
        self.kept.forget_pipelines();
        if let Some(elsewhere) = &mut self.elsewhere {
            elsewhere.forget_pipelines();
        }
    }

    /// Submits the work and asks for what comes back.
    pub(crate) fn submit(&self, gpu: &Gpu, work: &Submission) -> Pending {
        let native = match &gpu.place {
            Place::Here(native) => native,
            Place::Hosted(_) => return Pending::elsewhere(self.elsewhere().submit(work)),
        };
        let own = self.prepare(native, work);
        let scope = own.scope(Some(&self.kept));
        let layout = Layout::new(scope, &work.reads);
        let through = match work.through {
            Some(buffer) => scope.buffer(buffer).clone(),
            None => layout.buffer(native),
        };
        let mut encoder = native.device.create_command_encoder(&Default::default());
        encode(&mut encoder, scope, &work.steps, Span::NONE);
        layout.encode(&mut encoder, scope, &work.reads, &through);
        Pending::new(native.queue.submit([encoder.finish()]), through, layout)
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
        let native = match &gpu.place {
            Place::Here(native) => native,
            Place::Hosted(_) => return self.elsewhere().time(clock, work, repeats),
        };
        let own = self.prepare(native, work);
        let scope = own.scope(Some(&self.kept));
        clock.time(native, |encoder, span| {
            for k in 0..repeats {
                encode(encoder, scope, &work.steps, span.part(k == 0, k + 1 == repeats));
            }
        })
    }

    fn elsewhere(&self) -> &Kept {
        self.elsewhere.as_ref().expect("what a submission names is made before, if only nothing")
    }

    /// Makes what ends with the submission, and writes what is to be written before it.
    fn prepare(&self, native: &Native, work: &Submission) -> Objects {
        let mut own = Objects::default();
        own.compile(native, &work.own, Some(&self.kept));
        own.fill(native, &work.own, Some(&self.kept));
        for write in &work.writes {
            native.queue.write_buffer(own.scope(Some(&self.kept)).buffer(write.buffer), 0, &write.contents.0);
        }
        own
    }
}
