//! One output of a formula along one of its inputs, over every float of a range: block after block, two of them under way, so
//! that a device and whoever judges its results work at the same time.
//!
//! Floats are numbered in their order by [`key_of`](lightmeter_scene::along::key_of); −0 comes right before 0 and both are there. A device is told where a block
//! begins and how long it is, and makes the inputs itself. Buffers are made once.

use crate::arithmetic::Programmable;
use crate::device::Gpu;
use crate::device::readback::staging;
use crate::error::GpuError;
use crate::kernel::{Kernel, SWEEP_GROUP, SWEEP_WIDTH};
use crate::pipeline::{bind, cleared, compute_pipeline, render_pipeline};
use crate::shaders::Shaders;
use lightmeter_scene::along::Along;
use lightmeter_scene::target::SENTINEL;
use std::sync::mpsc;

const BITS: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// A formula compiled for a stage of a device, to be evaluated along one of its inputs.
#[derive(Debug)]
pub struct Sweep {
    pipeline: Pipeline,
    slots: [Slot; Sweep::UNDER_WAY],
    unwritten: wgpu::Buffer,
    capacity: usize,
    next: usize,
}

#[derive(Debug)]
enum Pipeline {
    Compute(wgpu::ComputePipeline),
    Fragment(wgpu::RenderPipeline),
}

/// What one block under way needs.
#[derive(Debug)]
struct Slot {
    span: wgpu::Buffer,
    results: Results,
    staging: wgpu::Buffer,
    bindings: wgpu::BindGroup,
}

#[derive(Debug)]
enum Results {
    Buffer(wgpu::Buffer),
    Target(wgpu::Texture),
}

/// A block that a device may still be working on.
#[derive(Debug)]
pub struct Block {
    slot: usize,
    count: usize,
    submission: wgpu::SubmissionIndex,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
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
        let lacking = match stage {
            Programmable::Compute => gpu.lacks_compute(),
            Programmable::Fragment => gpu.lacks_storage(false),
        };
        if let Some(reason) = lacking {
            return Ok(Err(reason));
        }
        let capacity = capacity.next_multiple_of(SWEEP_WIDTH as usize);
        let (label, source) = (&kernel.function, kernel.sweep(shaders, along.free, along.output)?);
        let pipeline = match stage {
            Programmable::Compute => Pipeline::Compute(compute_pipeline(gpu, label, source, "lightmeter_sweep")),
            Programmable::Fragment => Pipeline::Fragment(render_pipeline(gpu, label, source, &[BITS])),
        };
        gpu.check_shader(&kernel.file)?;
        let row = gpu.buffer(bytemuck::cast_slice(along.row), wgpu::BufferUsages::STORAGE);
        let unwritten = gpu.buffer(bytemuck::cast_slice(&vec![SENTINEL; capacity]), wgpu::BufferUsages::COPY_SRC);
        let slots = std::array::from_fn(|_| Slot::new(gpu, &pipeline, &row, capacity));
        gpu.check()?;
        Ok(Ok(Self { pipeline, slots, unwritten, capacity, next: 0 }))
    }

    /// Starts on the `count` floats from the one of that key on.
    ///
    /// # Panics
    /// Where the block is longer than it may be. No more than [`Sweep::UNDER_WAY`] blocks may be under way.
    pub fn submit(&mut self, gpu: &Gpu, first: u32, count: usize) -> Block {
        assert!(count <= self.capacity, "{count} inputs in blocks of {}", self.capacity);
        let number = self.next;
        self.next = (self.next + 1) % Self::UNDER_WAY;
        let slot = &self.slots[number];
        let length = u32::try_from(count).unwrap_or(u32::MAX);
        gpu.queue.write_buffer(&slot.span, 0, bytemuck::cast_slice(&[first, length]));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        match (&self.pipeline, &slot.results) {
            (Pipeline::Compute(pipeline), Results::Buffer(results)) => {
                encoder.copy_buffer_to_buffer(&self.unwritten, 0, results, 0, 4 * count as u64);
                {
                    let mut pass = encoder.begin_compute_pass(&Default::default());
                    pass.set_pipeline(pipeline);
                    pass.set_bind_group(0, &slot.bindings, &[]);
                    // At most 65,535 groups lie side by side.
                    let groups = length.div_ceil(SWEEP_GROUP);
                    let wide = groups.min(1 << 12);
                    pass.dispatch_workgroups(wide, groups.div_ceil(wide.max(1)), 1);
                }
                encoder.copy_buffer_to_buffer(results, 0, &slot.staging, 0, 4 * count as u64);
            }
            (Pipeline::Fragment(pipeline), Results::Target(target)) => {
                let view = target.create_view(&Default::default());
                {
                    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                        color_attachments: &[Some(cleared(&view))],
                        ..Default::default()
                    });
                    pass.set_pipeline(pipeline);
                    pass.set_bind_group(0, &slot.bindings, &[]);
                    pass.draw(0..3, 0..1);
                }
                encoder.copy_texture_to_buffer(
                    target.as_image_copy(),
                    wgpu::TexelCopyBufferInfo {
                        buffer: &slot.staging,
                        layout: wgpu::TexelCopyBufferLayout {
                            offset: 0,
                            bytes_per_row: Some(4 * SWEEP_WIDTH),
                            rows_per_image: None,
                        },
                    },
                    target.size(),
                );
            }
            _ => unreachable!("a slot is made for its pipeline"),
        }
        let submission = gpu.queue.submit([encoder.finish()]);
        let (done, mapped) = mpsc::channel();
        slot.staging.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only where nobody waits for the result any more.
            let _ = done.send(result);
        });
        Block { slot: number, count, submission, mapped }
    }

    /// Hands the results of a block on, one word for each input, once they are there.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub fn read<T>(&self, gpu: &Gpu, block: Block, then: impl FnOnce(&[u32]) -> T) -> Result<T, GpuError> {
        gpu.wait_for(block.submission)?;
        match block.mapped.recv() {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(GpuError::Device(error.to_string())),
            Err(error) => return Err(GpuError::Device(error.to_string())),
        }
        let staging = &self.slots[block.slot].staging;
        let result = {
            let view = staging.get_mapped_range(..).map_err(|error| GpuError::Device(error.to_string()))?;
            let words: &[u32] = bytemuck::cast_slice(&view);
            then(&words[..block.count])
        };
        staging.unmap();
        Ok(result)
    }
}

impl Slot {
    fn new(gpu: &Gpu, pipeline: &Pipeline, row: &wgpu::Buffer, capacity: usize) -> Self {
        let span = gpu.buffer(&[0; 8], wgpu::BufferUsages::UNIFORM);
        let (results, bindings) = match pipeline {
            Pipeline::Compute(pipeline) => {
                let results = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("results"),
                    size: 4 * capacity as u64,
                    usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                });
                let bindings = bind(gpu, &pipeline.get_bind_group_layout(0), &[row, &span, &results]);
                (Results::Buffer(results), bindings)
            }
            Pipeline::Fragment(pipeline) => {
                let height = u32::try_from(capacity / SWEEP_WIDTH as usize).unwrap_or(u32::MAX);
                let target = gpu.blend_target(SWEEP_WIDTH, height, BITS);
                (Results::Target(target), bind(gpu, &pipeline.get_bind_group_layout(0), &[row, &span]))
            }
        };
        Self { span, results, staging: staging(gpu, capacity), bindings }
    }
}
