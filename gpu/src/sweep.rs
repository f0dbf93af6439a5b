//! One output of a formula along one of its inputs, over every float of a range: block after block, two of them under way, so
//! that a device and whoever judges its results work at the same time.
//!
//! Floats are numbered in their order by [`key_of`](lightmeter_scene::along::key_of); −0 comes right before 0 and both are there. A device is told where a block
//! begins and how long it is, and makes the inputs itself. Buffers are made once.

use crate::arithmetic::Programmable;
use crate::device::{Executor, Gpu, Pending};
use crate::error::GpuError;
use crate::kernel::{Kernel, SWEEP_GROUP, SWEEP_WIDTH};
use crate::shaders::Shaders;
use crate::work::{
    BindGroup, Buffer, ComputePass, ComputePipeline, Handle, Read, RenderPass, RenderPipeline, Resources, Step,
    Submission, TextureResource, Write,
};
use lightmeter_scene::along::Along;
use wgpu_types::{BufferUsages, TextureFormat, TextureUsages};

const BITS: TextureFormat = TextureFormat::R32Uint;

/// A formula compiled for a stage of a device, to be evaluated along one of its inputs.
#[derive(Debug)]
pub struct Sweep {
    executor: Executor,
    plan: SweepPlan,
    next: usize,
}

/// What a sweep has on a device.
#[derive(Debug)]
struct SweepPlan {
    pipeline: Handle,
    slots: [Slot; Sweep::UNDER_WAY],
    /// As many sentinels as a block is long, where results go to a buffer; else they go to a target.
    unwritten: Option<Handle>,
    capacity: usize,
}

/// What one block under way needs.
#[derive(Clone, Copy, Debug)]
struct Slot {
    span: Handle,
    /// A buffer or a texture.
    results: Handle,
    staging: Handle,
    group: Handle,
}

/// A block that a device may still be working on.
#[derive(Debug)]
pub struct Block {
    count: usize,
    pending: Pending,
}

impl Sweep {
    /// How many blocks may be under way.
    pub const UNDER_WAY: usize = 2;

    /// Compiles the kernel for blocks of at most `capacity` inputs. `Ok(Err(reason))` where the adapter lacks what it takes.
    ///
    /// # Errors
    /// Where the shader is invalid or the device refuses the pipeline.
    ///
    /// # Panics
    /// Where the row is not of the kernel's length, or the free number or the output lies beyond it.
    pub fn new(
        gpu: &Gpu,
        shaders: &Shaders,
        kernel: &Kernel,
        stage: Programmable,
        along: Along<'_>,
        capacity: usize,
    ) -> Result<Result<Self, &'static str>, GpuError> {
        assert_eq!(along.row.len(), kernel.inputs, "the row is not of {} numbers", kernel.inputs);
        assert!((kernel.selectors..kernel.inputs).contains(&along.free), "number {} is no input", along.free);
        assert!(along.output < kernel.outputs, "number {} is no output", along.output);
        if let Some(reason) = stage.lacks(gpu) {
            return Ok(Err(reason));
        }
        let source = kernel.sweep(shaders, along.free, along.output)?;
        let (resources, plan) = SweepPlan::new(&kernel.function, source, stage, along.row, capacity);
        let mut executor = Executor::default();
        executor.make(gpu, &resources, &kernel.file)?;
        Ok(Ok(Self { executor, plan, next: 0 }))
    }

    /// Starts on the `count` floats from the one of that key on.
    ///
    /// # Panics
    /// Where the block is longer than it may be. No more than [`Sweep::UNDER_WAY`] blocks may be under way.
    pub fn submit(&mut self, gpu: &Gpu, first: u32, count: usize) -> Block {
        assert!(count <= self.plan.capacity, "{count} inputs in blocks of {}", self.plan.capacity);
        let slot = self.plan.slots[self.next];
        self.next = (self.next + 1) % Self::UNDER_WAY;
        let pending = self.executor.submit(gpu, &self.plan.submission(slot, first, count));
        Block { count, pending }
    }

    /// Hands the results of a block on, one word for each input, once they are there.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub fn read<T>(&self, gpu: &Gpu, block: Block, then: impl FnOnce(&[u32]) -> T) -> Result<T, GpuError> {
        block.pending.map(gpu, |words| then(&words[..block.count]))
    }
}

impl SweepPlan {
    fn new(label: &str, source: String, stage: Programmable, row: &[f32], capacity: usize) -> (Resources, Self) {
        let capacity = capacity.next_multiple_of(SWEEP_WIDTH as usize);
        let mut resources = Resources::default();
        let shader = resources.shader(label, source);
        let pipeline = match stage {
            Programmable::Compute => resources.pipeline(ComputePipeline::new(label, shader, "lightmeter_sweep")),
            Programmable::Fragment => resources.pipeline(RenderPipeline::of_kernel(label, shader, [BITS.into()])),
        };
        let row = resources.buffer(Buffer::of(row, BufferUsages::STORAGE));
        let slots = std::array::from_fn(|_| Slot::new(&mut resources, (stage, pipeline), row, capacity));
        let unwritten = (stage == Programmable::Compute)
            .then(|| resources.buffer(Buffer::sentinels(capacity, BufferUsages::COPY_SRC)));
        (resources, Self { pipeline, slots, unwritten, capacity })
    }

    /// The evaluation of the `count` floats from the one of that key on.
    fn submission(&self, slot: Slot, first: u32, count: usize) -> Submission {
        let length = u32::try_from(count).unwrap_or(u32::MAX);
        let contents = bytemuck::cast_slice(&[first, length]).into();
        let writes = vec![Write { buffer: slot.span, contents }];
        let Slot { results, group, staging, .. } = slot;
        let (bytes, pipeline) = (4 * count, self.pipeline);
        let (steps, read) = match self.unwritten {
            Some(unwritten) => {
                // At most 65,535 groups lie side by side.
                let groups = length.div_ceil(SWEEP_GROUP);
                let wide = groups.min(1 << 12);
                let workgroups = [wide, groups.div_ceil(wide.max(1)), 1];
                let pass = Step::Compute(ComputePass { pipeline, group, workgroups });
                let steps = vec![Step::Copy { from: unwritten, to: results, bytes }, pass];
                (steps, Read::Buffer { buffer: results, bytes })
            }
            None => (vec![Step::Render(RenderPass::screen(pipeline, group, &[results]))], Read::Texture(results)),
        };
        Submission { own: Resources::default(), writes, steps, reads: vec![read], through: Some(staging) }
    }
}

impl Slot {
    fn new(resources: &mut Resources, (stage, pipeline): (Programmable, Handle), row: Handle, capacity: usize) -> Self {
        let span = resources.buffer(Buffer::of(&[0_u32; 2], BufferUsages::UNIFORM | BufferUsages::COPY_DST));
        let copied = TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
        let (results, bound) = match stage {
            Programmable::Compute => {
                let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
                let results = resources.buffer(Buffer::unwritten(4 * capacity, usage));
                (results, vec![row, span, results])
            }
            Programmable::Fragment => {
                let height = u32::try_from(capacity / SWEEP_WIDTH as usize).unwrap_or(u32::MAX);
                (resources.texture(TextureResource::target([SWEEP_WIDTH, height], BITS, copied)), vec![row, span])
            }
        };
        let group = resources.group(BindGroup::of_buffers(pipeline, &bound));
        let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
        let staging = resources.buffer(Buffer::unwritten(4 * capacity, usage));
        Self { span, results, staging, group }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::tests::{device, words_by_json};

    #[test]
    fn blocks_are_evaluated_alike_by_way_of_json() {
        if crate::lacks_driver() {
            return;
        }
        let gpu = device();
        let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
        let made = Kernel::new(&shaders, "fog.wgsl", "fog_exp_factor");
        let kernel = made.unwrap_or_else(|error| panic!("{error}"));
        let source = kernel.sweep(&shaders, 0, 0).unwrap_or_else(|error| panic!("{error}"));
        for stage in [Programmable::Compute, Programmable::Fragment] {
            let (resources, plan) = SweepPlan::new("fog_exp_factor", source.clone(), stage, &[0.0, 0.5], 5000);
            let first = lightmeter_scene::along::key_of(0.5);
            let words = words_by_json(&gpu, &resources, &plan.submission(plan.slots[1], first, 4321));
            let along = Along { row: &[0.0, 0.5], free: 0, output: 0 };
            let made =
                Sweep::new(&gpu, &shaders, &kernel, stage, along, 5000).unwrap_or_else(|error| panic!("{error}"));
            let mut sweep = made.unwrap_or_else(|reason| panic!("{reason}"));
            for _ in 0..3 {
                let block = sweep.submit(&gpu, first, 4321);
                sweep
                    .read(&gpu, block, |read| assert_eq!(read, &words[..4321]))
                    .unwrap_or_else(|error| panic!("{error}"));
            }
        }
    }
}
