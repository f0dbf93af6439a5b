//! One open device, the executor that runs work on it, and what tells how long that takes. Nobody outside reaches the device
//! itself. A device is wgpu's, or one elsewhere, which a [`Host`] hands the work to.

mod clock;
mod encode;
mod executor;
mod hosted;
mod native;
mod objects;
mod readback;
#[cfg(test)]
mod tests;

pub use clock::{Clock, ClockKind, ClockReading};
pub(crate) use executor::Executor;
pub use hosted::{Abilities, Host, HostError, Ticket, WorkPiece};
pub use readback::Pending;

use crate::error::GpuError;
use lightmeter_scene::target::TargetFormat;
use native::Native;
use std::sync::Arc;

/// An open device.
#[derive(Debug)]
pub struct Gpu {
    place: Place,
    pub(crate) is_gl: bool,
    is_cpu: bool,
    most_pixels: u32,
    features: wgpu::Features,
    downlevel: wgpu::DownlevelFlags,
}

/// Where a device is.
#[derive(Debug)]
enum Place {
    /// Here, reached by wgpu.
    Here(Native),
    /// Elsewhere.
    Hosted(Arc<dyn Host>),
}

impl Gpu {
    pub(crate) fn open(name: &str, adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let (native, features) = Native::open(name, adapter)?;
        let info = adapter.get_info();
        Ok(Self {
            is_gl: info.backend == wgpu::Backend::Gl,
            is_cpu: info.device_type == wgpu::DeviceType::Cpu,
            most_pixels: native.most_pixels(),
            features,
            downlevel: adapter.get_downlevel_capabilities().flags,
            place: Place::Here(native),
        })
    }

    /// A device elsewhere, which can do all that WebGPU guarantees, and what its abilities say besides.
    #[must_use]
    pub fn hosted(host: Arc<dyn Host>) -> Self {
        let abilities = host.abilities();
        Self {
            is_gl: false,
            is_cpu: abilities.is_cpu,
            most_pixels: abilities.most_pixels,
            features: abilities.features(),
            downlevel: wgpu::DownlevelFlags::all(),
            place: Place::Hosted(host),
        }
    }

    /// Whether the driver computes on the processor.
    #[must_use]
    pub const fn is_cpu(&self) -> bool {
        self.is_cpu
    }

    /// Pixels of a target's side, at most.
    #[must_use]
    pub const fn most_pixels(&self) -> u32 {
        self.most_pixels
    }

    /// Another device on the same adapter, with a queue of its own; elsewhere the same one.
    ///
    /// # Errors
    /// Where the driver gives none.
    pub fn sibling(&self) -> Result<Self, GpuError> {
        match &self.place {
            Place::Here(native) => Self::open(native.name(), native.adapter()),
            Place::Hosted(host) => Ok(Self::hosted(host.clone())),
        }
    }

    /// What destroys the device, as if it were lost.
    pub(crate) fn breaker(&self) -> Box<dyn Fn()> {
        match &self.place {
            Place::Here(native) => Box::new(native.breaker()),
            Place::Hosted(host) => {
                let host = host.clone();
                Box::new(move || {
                    let ticket = host.send(&WorkPiece::Destroy);
                    host.forget(ticket);
                })
            }
        }
    }

    /// How many devices compile pipelines side by side: a software Vulkan driver compiles at the first draw, on the one
    /// thread of its queue.
    pub(crate) fn lanes(&self) -> usize {
        let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let is_here = matches!(self.place, Place::Here(_));
        if is_here && self.is_cpu && !self.is_gl { cores.min(4) } else { 1 }
    }

    fn format_features(&self, target: TargetFormat) -> wgpu::TextureFormatFeatures {
        match &self.place {
            Place::Here(native) => native.adapter().get_texture_format_features(format(target)),
            Place::Hosted(_) => format(target).guaranteed_format_features(self.features),
        }
    }

    /// Why a target cannot be blended on here; `None` where it can.
    #[must_use]
    pub fn lacks_blending(&self, target: TargetFormat) -> Option<&'static str> {
        let on_adapter = self.format_features(target);
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
        (!self.format_features(target).allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT))
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
