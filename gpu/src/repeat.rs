//! A kernel evaluated many times over for its time: each invocation has a row of inputs, whose last bits differ from turn to turn, and
//! what comes out is folded into one word, so that nothing can be left out and little is read or written. The same pipeline
//! hands back what it gives for the rows as they are.

use crate::device::{Clock, ClockReading, Executor, Gpu};
use crate::error::GpuError;
use crate::kernel::Kernel;
use crate::rung::Rung;
use crate::shaders::Shaders;
use crate::work::{BindGroup, Buffer, ComputePass, ComputePipeline, Handle, Read, Resources, Step, Submission};
use wgpu_types::BufferUsages;

/// Evaluations of one invocation.
pub(crate) const TIMES: u32 = 32;
/// Invocations of a workgroup.
const GROUP: u32 = 64;
/// The pipeline of a kernel's [`Resources`].
const PIPELINE: Handle = Handle::Kept(0);
/// The rows of a kernel's [`Resources`].
const ROWS: Handle = Handle::Kept(0);

/// A kernel compiled to be timed.
#[derive(Debug)]
pub struct RepeatPipeline {
    executor: Executor,
    /// Numbers of a row.
    inputs: usize,
    /// Words of a row's outputs: for each, those that its rung hands it back in.
    words: usize,
}

impl RepeatPipeline {
    /// Evaluations of one workgroup.
    pub const EVALUATIONS: u32 = GROUP * TIMES;

    /// Compiles the kernel in a rung's arithmetic, for rows of inputs that its invocations take in turn. `Ok(Err(reason))` where
    /// the adapter has no compute stage or lacks what the rung takes, or the function is unavailable there; whether the
    /// arithmetic does what it should is [`Rung::unavailable`]'s to say.
    ///
    /// # Errors
    /// Where the device refuses the pipeline.
    pub fn new(
        gpu: &Gpu,
        shaders: &Shaders,
        kernel: &Kernel,
        rung: Rung,
        rows: &[f32],
    ) -> Result<Result<Self, String>, GpuError> {
        if let Some(reason) = rung.lacks(gpu) {
            return Ok(Err(reason.into()));
        }
        match kernel.repeat(shaders, rung)? {
            Ok(source) => Self::of(gpu, kernel, source, rows, kernel.outputs * rung.parts()),
            Err(reason) => Ok(Err(reason)),
        }
    }

    /// The same without the function: what reading the inputs and the loop take by themselves.
    ///
    /// # Errors
    /// Where the device refuses the pipeline.
    pub fn idle(gpu: &Gpu, kernel: &Kernel, rows: &[f32]) -> Result<Result<Self, String>, GpuError> {
        Self::of(gpu, kernel, kernel.idle(), rows, 0)
    }

    pub(crate) fn of(
        gpu: &Gpu,
        kernel: &Kernel,
        source: String,
        rows: &[f32],
        words: usize,
    ) -> Result<Result<Self, String>, GpuError> {
        if let Some(reason) = gpu.lacks_compute() {
            return Ok(Err(reason.into()));
        }
        let mut executor = Executor::default();
        executor.make(gpu, &resources(kernel, source, rows), &kernel.file)?;
        Ok(Ok(Self { executor, inputs: kernel.inputs, words }))
    }

    /// The words of the outputs of rows of inputs, row after row.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub fn outputs(&self, gpu: &Gpu, rows: &[f32]) -> Result<Vec<u32>, GpuError> {
        let words = self.executor.submit(gpu, &self.submission(rows)).wait(gpu)?;
        Ok(words.chunks_exact(self.words + 1).flat_map(|row| &row[..self.words]).copied().collect())
    }

    /// How long `groups` workgroups take, of [`Self::EVALUATIONS`] each.
    ///
    /// # Errors
    /// Where the device fails.
    pub fn time(&self, gpu: &Gpu, clock: &Clock, groups: u32) -> Result<ClockReading, GpuError> {
        let mut work = Submission::default();
        self.evaluate(&mut work, ROWS, 1, groups);
        self.executor.time(gpu, clock, &work, 1)
    }

    /// The evaluation of rows of inputs. Each row gives its outputs, and what was folded.
    fn submission(&self, rows: &[f32]) -> Submission {
        let count = rows.len() / self.inputs;
        let mut work = Submission::default();
        let rows = work.buffer(Buffer::of(rows, BufferUsages::STORAGE));
        let groups = u32::try_from(count).unwrap_or(u32::MAX).div_ceil(GROUP);
        let results = self.evaluate(&mut work, rows, count, groups);
        work.reads.push(Read::Buffer { buffer: results, bytes: 4 * count * (self.words + 1) });
        work
    }

    /// Evaluates rows by some workgroups, of which the first invocations write the results of `count` rows.
    fn evaluate(&self, work: &mut Submission, rows: Handle, count: usize, groups: u32) -> Handle {
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let results = work.buffer(Buffer::sentinels(count * (self.words + 1), usage));
        let group = work.group(BindGroup::of_buffers(PIPELINE, &[rows, results]));
        work.steps.push(Step::Compute(ComputePass { pipeline: PIPELINE, group, workgroups: [groups, 1, 1] }));
        results
    }
}

/// What a kernel needs from one submission to the next: its pipeline, and the rows that are timed.
fn resources(kernel: &Kernel, source: String, rows: &[f32]) -> Resources {
    let mut resources = Resources::default();
    let shader = resources.shader(&kernel.function, source);
    let mut pipeline = ComputePipeline::new(&kernel.function, shader, "lightmeter_repeat");
    pipeline.constants.insert("lightmeter_times".into(), TIMES.into());
    resources.pipeline(pipeline);
    resources.buffer(Buffer::of(rows, BufferUsages::STORAGE));
    resources
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapters;
    use crate::device::ClockKind;
    use crate::work::tests::{device, words_by_json};

    #[test]
    fn rows_are_evaluated_over_and_over_alike_by_way_of_json() {
        if crate::lacks_driver() {
            return;
        }
        let gpu = device();
        let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
        let kernel = Kernel::new(&shaders, "fog.wgsl", "fog_exp").unwrap_or_else(|error| panic!("{error}"));
        let rows: Vec<f32> = (0..100 * kernel.inputs).map(|k| [0.25, 0.5, 0.75, 1.0, 1.5][k * k % 13 % 5]).collect();
        let source = kernel.repeat(&shaders, Rung::F32).unwrap_or_else(|error| panic!("{error}"));
        let source = source.unwrap_or_else(|reason| panic!("{reason}"));
        let made = RepeatPipeline::new(&gpu, &shaders, &kernel, Rung::F32, &rows);
        let pipeline = made.unwrap_or_else(|error| panic!("{error}")).unwrap_or_else(|reason| panic!("{reason}"));
        let words = words_by_json(&gpu, &resources(&kernel, source, &rows), &pipeline.submission(&rows));
        assert_eq!(words.len(), 100 * (kernel.outputs + 1));
    }

    /// Timestamps that a driver takes before it has computed would tell less than goes by on the wall.
    #[test]
    fn timestamps_tell_the_time_that_a_dispatch_takes() {
        let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
        let kernel = Kernel::new(&shaders, "fog.wgsl", "fog_exp").unwrap_or_else(|error| panic!("{error}"));
        let rows = vec![0.5; 16 * kernel.inputs];
        for adapter in adapters() {
            let gpu = adapter.open().unwrap_or_else(|error| panic!("{error}"));
            let clock = Clock::new(&gpu).unwrap_or_else(|error| panic!("{error}"));
            if clock.kind() != ClockKind::Timestamps || !gpu.is_cpu() {
                continue;
            }
            let made = RepeatPipeline::new(&gpu, &shaders, &kernel, Rung::F32, &rows);
            let Ok(pipeline) = made.unwrap_or_else(|error| panic!("{error}")) else { continue };
            let time = |clock: &Clock| {
                let reading = pipeline.time(&gpu, clock, 4096).unwrap_or_else(|error| panic!("{error}"));
                reading.seconds().unwrap_or(0.0)
            };
            time(&clock);
            let mut ratios: Vec<f64> = (0..9).map(|_| time(&clock) / time(&Clock::wall(None))).collect();
            ratios.sort_by(f64::total_cmp);
            // What else the machine does falls upon either, so that half and double say enough.
            assert!((0.5..2.0).contains(&ratios[4]), "{}: {ratios:?}", adapter.name);
        }
    }
}
