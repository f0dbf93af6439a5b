//! A kernel evaluated many times over for its time: each invocation has a row of inputs, whose last bits differ from turn to turn, and
//! what comes out is folded into one word, so that nothing can be left out and little is read or written.

use crate::arithmetic::bind;
use crate::device::Gpu;
use crate::error::Error;
use crate::kernel::Kernel;
use crate::readback::{Pending, staging};
use crate::shaders::Shaders;
use std::time::Instant;

/// Evaluations of one invocation.
const TIMES: u32 = 64;
/// Invocations.
const INVOCATIONS: u32 = 1 << 16;

/// A kernel compiled to be timed.
#[derive(Debug)]
pub struct RepeatPipeline {
    pipeline: wgpu::ComputePipeline,
    rows: wgpu::Buffer,
}

impl RepeatPipeline {
    /// Compiles the kernel for rows of inputs that its invocations take in turn. `Ok(Err(reason))` where the adapter has no
    /// compute stage.
    ///
    /// # Errors
    /// Where the device refuses the pipeline.
    pub fn new(
        gpu: &Gpu,
        shaders: &Shaders,
        kernel: &Kernel,
        rows: &[f32],
    ) -> Result<Result<Self, &'static str>, Error> {
        Self::of(gpu, kernel, kernel.repeat(shaders)?, rows)
    }

    /// The same without the function: what reading the inputs and the loop take by themselves.
    ///
    /// # Errors
    /// Where the device refuses the pipeline.
    pub fn idle(gpu: &Gpu, kernel: &Kernel, rows: &[f32]) -> Result<Result<Self, &'static str>, Error> {
        Self::of(gpu, kernel, kernel.idle(), rows)
    }

    fn of(gpu: &Gpu, kernel: &Kernel, source: String, rows: &[f32]) -> Result<Result<Self, &'static str>, Error> {
        if let Some(reason) = gpu.lacks_compute() {
            return Ok(Err(reason));
        }
        let module = gpu.module(&kernel.function, source);
        let constants = [("lightmeter_times", f64::from(TIMES))];
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&kernel.function),
            layout: None,
            module: &module,
            entry_point: Some("lightmeter_repeat"),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            cache: None,
        });
        gpu.check_shader(&kernel.file)?;
        let rows = gpu.buffer(bytemuck::cast_slice(rows), wgpu::BufferUsages::STORAGE);
        Ok(Ok(Self { pipeline, rows }))
    }

    /// Seconds of wall time for one evaluation, of some four million in one submission.
    ///
    /// # Errors
    /// Where the device fails.
    pub fn time(&self, gpu: &Gpu) -> Result<f64, Error> {
        let results = vec![0_u32; INVOCATIONS as usize];
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let results = gpu.buffer(bytemuck::cast_slice(&results), usage);
        let bindings = bind(gpu, &self.pipeline.get_bind_group_layout(0), &[&self.rows, &results]);
        let staging = staging(gpu, 1);
        let clock = Instant::now();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &bindings, &[]);
            pass.dispatch_workgroups(INVOCATIONS / 64, 1, 1);
        }
        encoder.copy_buffer_to_buffer(&results, 0, &staging, 0, 4);
        Pending::submit(gpu, encoder, staging, (1, 1)).wait(gpu)?;
        Ok(clock.elapsed().as_secs_f64() / f64::from(INVOCATIONS * TIMES))
    }
}
