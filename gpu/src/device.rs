//! One open device, the executor that runs work on it, and what tells how long that takes. Nobody outside reaches the device
//! itself.

mod clock;
mod encode;
mod executor;
mod objects;
mod readback;
#[cfg(test)]
mod tests;

pub use clock::{Clock, ClockKind, ClockReading};
pub(crate) use executor::Executor;
pub use readback::Pending;

use crate::error::GpuError;
use lightmeter_scene::target::TargetFormat;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How long a submission may take: hundreds of pipelines compiled by a software driver on a slow machine take a minute.
const PATIENCE: Duration = Duration::from_secs(300);

/// An open device.
#[derive(Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pub(crate) is_gl: bool,
    features: wgpu::Features,
    downlevel: wgpu::DownlevelFlags,
    failure: Arc<Mutex<Option<String>>>,
    name: String,
    adapter: wgpu::Adapter,
}

impl Gpu {
    pub(crate) fn open(name: &str, adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let wanted = wgpu::Features::FLOAT32_BLENDABLE
            | wgpu::Features::DUAL_SOURCE_BLENDING
            | wgpu::Features::TIMESTAMP_QUERY
            | wgpu::Features::SHADER_F16
            | wgpu::Features::SHADER_F64;
        let features = adapter.features() & wanted;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("lightmeter"),
            required_features: features,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| GpuError::Open { adapter: name.into(), message: error.to_string() })?;
        let failure = Arc::new(Mutex::new(None));
        let (on_error, on_lost) = (failure.clone(), failure.clone());
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| note(&on_error, error.to_string())));
        device.set_device_lost_callback(move |reason, message| {
            if reason != wgpu::DeviceLostReason::Destroyed {
                note(&on_lost, format!("device lost: {message}"));
            }
        });
        Ok(Self {
            device,
            queue,
            is_gl: adapter.get_info().backend == wgpu::Backend::Gl,
            features,
            downlevel: adapter.get_downlevel_capabilities().flags,
            failure,
            name: name.into(),
            adapter: adapter.clone(),
        })
    }

    /// Whether the driver computes on the processor.
    #[must_use]
    pub fn is_cpu(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// Pixels of a target's side, at most.
    #[must_use]
    pub fn most_pixels(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// Another device on the same adapter, with a queue of its own.
    ///
    /// # Errors
    /// Where the driver gives none.
    pub fn sibling(&self) -> Result<Self, GpuError> {
        Self::open(&self.name, &self.adapter)
    }

    /// What destroys the device, as if it were lost.
    pub(crate) fn breaker(&self) -> impl Fn() + use<> {
        let device = self.device.clone();
        move || device.destroy()
    }

    /// How many devices compile pipelines side by side: a software Vulkan driver compiles at the first draw, on the one
    /// thread of its queue.
    pub(crate) fn lanes(&self) -> usize {
        let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        if self.is_cpu() && !self.is_gl { cores.min(4) } else { 1 }
    }

    /// The first error that the device reported since the last time this was asked.
    fn check(&self) -> Result<(), GpuError> {
        let failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner).take();
        failure.map_or(Ok(()), |message| Err(GpuError::Device(message)))
    }

    /// The same after a shader was compiled: what the device says then is of the shader.
    fn check_shader(&self, file: &str) -> Result<(), GpuError> {
        self.check().map_err(|error| match error {
            GpuError::Device(message) if !message.contains("lost") => GpuError::Shader { file: file.into(), message },
            other => other,
        })
    }

    /// Waits until everything submitted is done, but not for ever: an edited shader may loop.
    fn wait(&self) -> Result<(), GpuError> {
        self.wait_until(None)
    }

    /// The same until a submission is done, whatever came after it.
    fn wait_for(&self, submission: wgpu::SubmissionIndex) -> Result<(), GpuError> {
        self.wait_until(Some(submission))
    }

    fn wait_until(&self, submission_index: Option<wgpu::SubmissionIndex>) -> Result<(), GpuError> {
        let wait = wgpu::PollType::Wait { submission_index, timeout: Some(PATIENCE) };
        match self.device.poll(wait) {
            Ok(_) => self.check(),
            Err(wgpu::PollError::Timeout) => Err(GpuError::Timeout(PATIENCE.as_secs())),
            // What the device said before is why nothing can be waited for.
            Err(error) => Err(self.check().err().unwrap_or_else(|| GpuError::Device(error.to_string()))),
        }
    }

    /// Why a target cannot be blended on here; `None` where it can.
    #[must_use]
    pub fn lacks_blending(&self, target: TargetFormat) -> Option<&'static str> {
        let on_adapter = self.adapter.get_texture_format_features(format(target));
        if target == TargetFormat::Rgba32Float && !self.features.contains(wgpu::Features::FLOAT32_BLENDABLE) {
            Some("the adapter lacks the feature FLOAT32_BLENDABLE")
        } else if !on_adapter.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
            Some("the adapter cannot draw to the format: it lacks RENDER_ATTACHMENT there")
        } else if !on_adapter.flags.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE) {
            Some("the adapter cannot blend on the format: it lacks BLENDABLE there")
        } else {
            None
        }
    }

    /// Why a format cannot be drawn to here; `None` where it can.
    #[must_use]
    pub fn lacks_target(&self, target: TargetFormat) -> Option<&'static str> {
        let on_adapter = self.adapter.get_texture_format_features(format(target));
        (!on_adapter.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT))
            .then_some("the adapter cannot draw to the format: it lacks RENDER_ATTACHMENT there")
    }

    /// Whether the device has a feature.
    pub(crate) fn has(&self, feature: wgpu::Features) -> bool {
        self.features.contains(feature)
    }

    /// Whether passes can be told to write timestamps.
    pub(crate) fn has_timestamps(&self) -> bool {
        self.has(wgpu::Features::TIMESTAMP_QUERY)
    }

    /// Whether a fragment may have two source colours.
    pub(crate) fn has_dual_source(&self) -> bool {
        self.has(wgpu::Features::DUAL_SOURCE_BLENDING)
    }

    /// Why a stage that reads storage buffers cannot run here; `None` where it can.
    pub(crate) fn lacks_storage(&self, vertex: bool) -> Option<&'static str> {
        let (flag, reason) = if vertex {
            (wgpu::DownlevelFlags::VERTEX_STORAGE, "the adapter has no storage buffers in the vertex stage")
        } else {
            (wgpu::DownlevelFlags::FRAGMENT_STORAGE, "the adapter has no storage buffers in the fragment stage")
        };
        (!self.downlevel.contains(flag)).then_some(reason)
    }

    pub(crate) fn lacks_compute(&self) -> Option<&'static str> {
        (!self.downlevel.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS)).then_some("the adapter has no compute stage")
    }
}

/// A target's format in wgpu's terms.
pub(crate) const fn format(target: TargetFormat) -> wgpu::TextureFormat {
    match target {
        TargetFormat::Rgba32Float => wgpu::TextureFormat::Rgba32Float,
        TargetFormat::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        TargetFormat::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
        TargetFormat::Rgba8UnormSrgb => wgpu::TextureFormat::Rgba8UnormSrgb,
        TargetFormat::Bgra8Unorm => wgpu::TextureFormat::Bgra8Unorm,
    }
}

/// The middle of a pixel of a packed target in clip coordinates: exact where width and height are powers of two.
pub(crate) fn middle(pixel: u32, width: u32, height: u32) -> [f32; 2] {
    let middle = |pixel: u32, size: u32| f64::from(2 * pixel + 1) / f64::from(size);
    #[expect(clippy::cast_possible_truncation, reason = "exact: sizes are powers of two")]
    let middle = [(middle(pixel % width, width) - 1.0) as f32, (1.0 - middle(pixel / width, height)) as f32];
    middle
}

fn note(failure: &Mutex<Option<String>>, message: String) {
    failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(message);
}
