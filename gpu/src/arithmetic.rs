//! Formulas as arithmetic, in the compute and in the fragment stage: the same WGSL, which drivers compile differently.

use crate::device::{Executor, Gpu, Pending};
use crate::error::GpuError;
use crate::kernel::{FRAGMENT_WIDTH, Kernel};
use crate::work::{
    BindGroup, Buffer, ComputePass, ComputePipeline, Handle, Read, RenderPass, RenderPipeline, Resources, Step,
    Submission, TextureResource,
};
use wgpu_types::{BufferUsages, TextureFormat, TextureUsages};

const BITS: TextureFormat = TextureFormat::Rgba32Uint;
/// The pipeline of a kernel's [`Resources`].
const PIPELINE: Handle = Handle::Kept(0);

/// A programmable stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Programmable {
    /// A compute shader that writes a storage buffer.
    Compute,
    /// A fragment shader that writes colour targets, bit for bit.
    Fragment,
}

impl Programmable {
    /// Why the stage cannot evaluate rows here; `None` where it can.
    pub(crate) fn lacks(self, gpu: &Gpu) -> Option<&'static str> {
        match self {
            Self::Compute => gpu.lacks_compute(),
            Self::Fragment => gpu.lacks_storage(false),
        }
    }
}

/// A kernel compiled for a stage of a device.
#[derive(Debug)]
pub struct ArithmeticPipeline {
    executor: Executor,
    stage: Programmable,
    inputs: usize,
    outputs: usize,
    targets: usize,
}

impl ArithmeticPipeline {
    /// Compiles the kernel for the stage. `Ok(Err(reason))` where the adapter lacks what it takes.
    ///
    /// # Errors
    /// Where the device refuses the pipeline.
    pub fn new(gpu: &Gpu, kernel: &Kernel, stage: Programmable) -> Result<Result<Self, &'static str>, GpuError> {
        if let Some(reason) = stage.lacks(gpu) {
            return Ok(Err(reason));
        }
        let mut executor = Executor::default();
        executor.make(gpu, &Self::resources(kernel, stage), &kernel.file)?;
        let Kernel { inputs, outputs, .. } = *kernel;
        Ok(Ok(Self { executor, stage, inputs, outputs, targets: kernel.targets() }))
    }

    /// Evaluates every row of `rows`, of as many numbers as the kernel takes, selectors as their bits.
    ///
    /// # Panics
    /// Where `rows` is not a whole number of rows.
    #[must_use]
    pub fn submit(&self, gpu: &Gpu, rows: &[f32]) -> Pending {
        self.executor.submit(gpu, &self.submission(rows))
    }

    /// What a kernel needs from one submission to the next: its pipeline.
    fn resources(kernel: &Kernel, stage: Programmable) -> Resources {
        let mut resources = Resources::default();
        match stage {
            Programmable::Compute => {
                let shader = resources.shader(&kernel.function, kernel.compute.clone());
                resources.pipeline(ComputePipeline::new(&kernel.function, shader, "lightmeter_compute"));
            }
            Programmable::Fragment => {
                let shader = resources.shader(&kernel.function, kernel.fragment.clone());
                let targets = (0..kernel.targets()).map(|_| BITS.into());
                resources.pipeline(RenderPipeline::of_kernel(&kernel.function, shader, targets));
            }
        }
        resources
    }

    /// The evaluation of rows.
    fn submission(&self, rows: &[f32]) -> Submission {
        assert!(rows.len().is_multiple_of(self.inputs), "rows are not of {} numbers each", self.inputs);
        let count = rows.len() / self.inputs;
        let mut work = Submission::default();
        let rows = work.buffer(Buffer::of(rows, BufferUsages::STORAGE));
        match self.stage {
            Programmable::Compute => self.compute(&mut work, rows, count),
            Programmable::Fragment => self.draw(&mut work, rows, count),
        }
        work
    }

    fn compute(&self, work: &mut Submission, rows: Handle, count: usize) {
        let words = count * self.outputs;
        let results = work.buffer(Buffer::sentinels(words, BufferUsages::STORAGE | BufferUsages::COPY_SRC));
        let group = work.group(BindGroup::of_buffers(PIPELINE, &[rows, results]));
        let workgroups = [u32::try_from(count.div_ceil(64)).unwrap_or(u32::MAX), 1, 1];
        work.steps.push(Step::Compute(ComputePass { pipeline: PIPELINE, group, workgroups }));
        work.reads.push(Read::Buffer { buffer: results, bytes: 4 * words });
    }

    fn draw(&self, work: &mut Submission, rows: Handle, count: usize) {
        let height = u32::try_from(count.div_ceil(FRAGMENT_WIDTH as usize)).unwrap_or(u32::MAX);
        let target = TextureResource::target([FRAGMENT_WIDTH, height], BITS, TextureUsages::COPY_SRC);
        let targets: Vec<Handle> = (0..self.targets).map(|_| work.texture(target.clone())).collect();
        let group = work.group(BindGroup::of_buffers(PIPELINE, &[rows]));
        work.steps.push(Step::Render(RenderPass::screen(PIPELINE, group, &targets)));
        // One after the other; `outputs` puts the words of a case together.
        work.reads.extend(targets.into_iter().map(Read::Texture));
    }

    /// The outputs of each case in order, from the words of a [`Pending`] of this pipeline.
    #[must_use]
    pub fn outputs(&self, words: Vec<u32>, count: usize) -> Vec<u32> {
        if self.stage == Programmable::Compute {
            return words;
        }
        let plane = words.len() / self.targets;
        let mut outputs = Vec::with_capacity(count * self.outputs);
        for case in 0..count {
            outputs.extend((0..self.outputs).map(|k| words[(k / 4) * plane + 4 * case + k % 4]));
        }
        outputs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::Shaders;
    use crate::work::tests::{device, words_by_json};

    #[test]
    fn rows_are_evaluated_alike_by_way_of_json() {
        if crate::lacks_driver() {
            return;
        }
        let gpu = device();
        let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
        for (file, function) in [("fog.wgsl", "fog_exp"), ("lighting.wgsl", "lighting_frame")] {
            let kernel = Kernel::new(&shaders, file, function).unwrap_or_else(|error| panic!("{error}"));
            let rows: Vec<f32> =
                (0..300 * kernel.inputs).map(|k| [0.25, 0.5, 0.75, 1.0, 1.5][k * k % 13 % 5]).collect();
            for stage in [Programmable::Compute, Programmable::Fragment] {
                let made = ArithmeticPipeline::new(&gpu, &kernel, stage).unwrap_or_else(|error| panic!("{error}"));
                let pipeline = made.unwrap_or_else(|reason| panic!("{reason}"));
                let resources = ArithmeticPipeline::resources(&kernel, stage);
                let words = words_by_json(&gpu, &resources, &pipeline.submission(&rows));
                assert_eq!(pipeline.outputs(words, 300).len(), 300 * kernel.outputs);
            }
        }
    }
}
