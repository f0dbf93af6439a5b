//! A kernel evaluated many times over for its time: each invocation has a row of inputs, whose last bits differ from turn to turn, and
//! what comes out is folded into one word, so that nothing can be left out and little is read or written. The same pipeline
//! hands back what it gives for the rows as they are.

use crate::device::Gpu;
use crate::device::readback::{Pending, staging};
use crate::device::{Clock, ClockReading};
use crate::error::GpuError;
use crate::kernel::Kernel;
use crate::pipeline::bind;
use crate::rung::Rung;
use crate::shaders::Shaders;
use lightmeter_scene::target::SENTINEL;

/// Evaluations of one invocation.
pub(crate) const TIMES: u32 = 32;
/// Invocations of a workgroup.
const GROUP: u32 = 64;

/// A kernel compiled to be timed.
#[derive(Debug)]
pub struct RepeatPipeline {
    pipeline: wgpu::ComputePipeline,
    rows: wgpu::Buffer,
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
        Ok(Ok(Self { pipeline, rows, inputs: kernel.inputs, words }))
    }

    /// The words of the outputs of rows of inputs, row after row.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub fn outputs(&self, gpu: &Gpu, rows: &[f32]) -> Result<Vec<u32>, GpuError> {
        let (stride, count) = (self.words + 1, rows.len() / self.inputs);
        let rows = gpu.buffer(bytemuck::cast_slice(rows), wgpu::BufferUsages::STORAGE);
        let (results, bindings) = self.bindings(gpu, &rows, count * stride);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let groups = u32::try_from(count).unwrap_or(u32::MAX).div_ceil(GROUP);
        self.encode(&mut encoder, None, &bindings, groups);
        let staging = staging(gpu, count * stride);
        encoder.copy_buffer_to_buffer(&results, 0, &staging, 0, staging.size());
        Pending::submit(gpu, encoder, staging, (stride, self.words)).wait(gpu)
    }

    /// How long so many workgroups take, of [`Self::EVALUATIONS`] each.
    ///
    /// # Errors
    /// Where the device fails.
    pub fn time(&self, gpu: &Gpu, clock: &Clock, groups: u32) -> Result<ClockReading, GpuError> {
        let (_, bindings) = self.bindings(gpu, &self.rows, self.words + 1);
        clock.time(gpu, |encoder, span| self.encode(encoder, span.compute(), &bindings, groups))
    }

    fn bindings(&self, gpu: &Gpu, rows: &wgpu::Buffer, words: usize) -> (wgpu::Buffer, wgpu::BindGroup) {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let results = gpu.buffer(bytemuck::cast_slice(&vec![SENTINEL; words]), usage);
        let bindings = bind(gpu, &self.pipeline.get_bind_group_layout(0), &[rows, &results]);
        (results, bindings)
    }

    fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::ComputePassTimestampWrites<'_>>,
        bindings: &wgpu::BindGroup,
        groups: u32,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bindings, &[]);
        pass.dispatch_workgroups(groups, 1, 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapters;
    use crate::device::ClockKind;

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
