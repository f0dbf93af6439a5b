//! Formulas as arithmetic, in the compute and in the fragment stage: the same WGSL, which drivers compile differently.

use crate::device::Gpu;
use crate::device::readback::{Pending, staging};
use crate::error::GpuError;
use crate::kernel::{FRAGMENT_WIDTH, Kernel};
use crate::pipeline::{bind, cleared, compute_pipeline, render_pipeline};
use lightmeter_scene::target::SENTINEL;

const BITS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;

/// A programmable stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Programmable {
    /// A compute shader that writes a storage buffer.
    Compute,
    /// A fragment shader that writes colour targets, bit for bit.
    Fragment,
}

#[derive(Debug)]
enum Pipeline {
    Compute(wgpu::ComputePipeline),
    Fragment(wgpu::RenderPipeline),
}

/// A kernel compiled for a stage of a device.
#[derive(Debug)]
pub struct ArithmeticPipeline {
    pipeline: Pipeline,
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
        let pipeline = match stage {
            Programmable::Compute => {
                if let Some(reason) = gpu.lacks_compute() {
                    return Ok(Err(reason));
                }
                Pipeline::Compute(compute_pipeline(gpu, &kernel.function, kernel.compute.clone(), "lightmeter_compute"))
            }
            Programmable::Fragment => {
                if let Some(reason) = gpu.lacks_storage(false) {
                    return Ok(Err(reason));
                }
                let targets = vec![BITS; kernel.targets()];
                Pipeline::Fragment(render_pipeline(gpu, &kernel.function, kernel.fragment.clone(), &targets))
            }
        };
        gpu.check_shader(&kernel.file)?;
        Ok(Ok(Self { pipeline, inputs: kernel.inputs, outputs: kernel.outputs, targets: kernel.targets() }))
    }

    /// Evaluates every row of `rows`, of as many numbers as the kernel takes, selectors as their bits.
    ///
    /// # Panics
    /// Where `rows` is not a whole number of rows.
    #[must_use]
    pub fn submit(&self, gpu: &Gpu, rows: &[f32]) -> Pending {
        assert!(rows.len().is_multiple_of(self.inputs), "rows are not of {} numbers each", self.inputs);
        let count = rows.len() / self.inputs;
        let buffer = gpu.buffer(bytemuck::cast_slice(rows), wgpu::BufferUsages::STORAGE);
        match &self.pipeline {
            Pipeline::Compute(pipeline) => self.submit_compute(gpu, pipeline, &buffer, count),
            Pipeline::Fragment(pipeline) => self.submit_fragment(gpu, pipeline, &buffer, count),
        }
    }

    fn submit_compute(
        &self,
        gpu: &Gpu,
        pipeline: &wgpu::ComputePipeline,
        rows: &wgpu::Buffer,
        count: usize,
    ) -> Pending {
        let words = count * self.outputs;
        let unwritten = vec![SENTINEL; words];
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let results = gpu.buffer(bytemuck::cast_slice(&unwritten), usage);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &bind(gpu, &pipeline.get_bind_group_layout(0), &[rows, &results]), &[]);
            pass.dispatch_workgroups(u32::try_from(count.div_ceil(64)).unwrap_or(u32::MAX), 1, 1);
        }
        let staging = staging(gpu, words);
        encoder.copy_buffer_to_buffer(&results, 0, &staging, 0, 4 * words as u64);
        Pending::submit(gpu, encoder, staging, (self.outputs, self.outputs))
    }

    fn submit_fragment(
        &self,
        gpu: &Gpu,
        pipeline: &wgpu::RenderPipeline,
        rows: &wgpu::Buffer,
        count: usize,
    ) -> Pending {
        let height = u32::try_from(count.div_ceil(FRAGMENT_WIDTH as usize)).unwrap_or(u32::MAX);
        let targets: Vec<wgpu::Texture> = (0..self.targets).map(|_| gpu.target(FRAGMENT_WIDTH, height, BITS)).collect();
        let views: Vec<wgpu::TextureView> = targets.iter().map(|t| t.create_view(&Default::default())).collect();
        let attachments: Vec<_> = views.iter().map(|view| Some(cleared(view))).collect();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &attachments,
                ..Default::default()
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &bind(gpu, &pipeline.get_bind_group_layout(0), &[rows]), &[]);
            pass.draw(0..3, 0..1);
        }
        // All targets into one buffer, one after the other; `interleave` puts the words of a case together.
        let plane = 16 * u64::from(FRAGMENT_WIDTH) * u64::from(height);
        let staging = staging(gpu, usize::try_from(plane / 4).unwrap_or(usize::MAX) * self.targets);
        for (k, target) in targets.iter().enumerate() {
            encoder.copy_texture_to_buffer(
                target.as_image_copy(),
                wgpu::TexelCopyBufferInfo {
                    buffer: &staging,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: k as u64 * plane,
                        bytes_per_row: Some(16 * FRAGMENT_WIDTH),
                        rows_per_image: None,
                    },
                },
                target.size(),
            );
        }
        Pending::submit(gpu, encoder, staging, (4, 4))
    }

    /// The outputs of each case in order, from the words of a [`Pending`] of this pipeline.
    #[must_use]
    pub fn outputs(&self, words: Vec<u32>, count: usize) -> Vec<u32> {
        if matches!(self.pipeline, Pipeline::Compute(_)) {
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
