//! A device that wgpu reaches.

use crate::error::GpuError;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How long a submission may take: hundreds of pipelines compiled by a software driver on a slow machine take a minute.
const PATIENCE: Duration = Duration::from_secs(300);

/// A device of wgpu with its queue, and what it reported.
#[derive(Debug)]
pub(super) struct Native {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    failure: Arc<Mutex<Option<String>>>,
    name: String,
    adapter: wgpu::Adapter,
}

impl Native {
    /// Opens a device of an adapter, with those features that the suite has a use for.
    pub(super) fn open(name: &str, adapter: &wgpu::Adapter) -> Result<(Self, wgpu::Features), GpuError> {
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
        Ok((Self { device, queue, failure, name: name.into(), adapter: adapter.clone() }, features))
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    pub(super) const fn adapter(&self) -> &wgpu::Adapter {
        &self.adapter
    }

    /// Pixels of a target's side, at most.
    pub(super) fn most_pixels(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// What destroys the device, as if it were lost.
    pub(super) fn breaker(&self) -> impl Fn() + use<> {
        let device = self.device.clone();
        move || device.destroy()
    }

    /// The first error that the device reported since the last time this was asked.
    pub(super) fn check(&self) -> Result<(), GpuError> {
        let failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner).take();
        failure.map_or(Ok(()), |message| Err(GpuError::Device(message)))
    }

    /// The same after a shader was compiled: what the device says then is of the shader.
    pub(super) fn check_shader(&self, file: &str) -> Result<(), GpuError> {
        self.check().map_err(|error| match error {
            GpuError::Device(message) if !message.contains("lost") => GpuError::Shader { file: file.into(), message },
            other => other,
        })
    }

    /// Waits until everything submitted is done, but not for ever: an edited shader may loop.
    pub(super) fn wait(&self) -> Result<(), GpuError> {
        self.wait_until(None)
    }

    /// The same until a submission is done, whatever came after it.
    pub(super) fn wait_for(&self, submission: wgpu::SubmissionIndex) -> Result<(), GpuError> {
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
}

fn note(failure: &Mutex<Option<String>>, message: String) {
    failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(message);
}
