//! Which adapters there are, and the short names that they go by.

use crate::device::Gpu;
use crate::error::GpuError;

/// An adapter that can be run on.
#[derive(Debug)]
pub struct Adapter {
    /// The short name for the command line: `lavapipe`, `swiftshader`, `llvmpipe-gl`, or one made of the device's name.
    pub name: String,
    /// The device, as the driver names it.
    pub device: String,
    /// `vulkan`, `dx12`, `metal` or `gl`.
    pub backend: &'static str,
    /// The driver and its version, as the driver says it.
    pub driver: String,
    /// Whether the device is the CPU.
    pub is_cpu: bool,
    adapter: wgpu::Adapter,
}

/// What drivers are reached by, but for OpenGL; what a system lacks is not looked for.
const NATIVE: wgpu::Backends = wgpu::Backends::VULKAN.union(wgpu::Backends::DX12).union(wgpu::Backends::METAL);

/// Every adapter of Vulkan, on Windows of Direct3D 12 and on macOS of Metal: lavapipe first, hardware next, then the other software drivers.
#[must_use]
pub fn native_adapters() -> Vec<Adapter> {
    enumerate(NATIVE)
}

/// Every adapter of every backend, in the same order, OpenGL's last of their kind.
#[must_use]
pub fn adapters() -> Vec<Adapter> {
    enumerate(NATIVE | wgpu::Backends::GL)
}

fn enumerate(backends: wgpu::Backends) -> Vec<Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let found = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let mut adapters: Vec<Adapter> = found.into_iter().map(Adapter::new).collect();
    adapters.sort_by_key(|a| (a.name != "lavapipe", a.is_cpu, a.backend == "gl", a.name.clone()));
    for place in 1..adapters.len() {
        let same = adapters[..place].iter().filter(|a| a.name == adapters[place].name).count();
        if same > 0 {
            let numbered = format!("{}-{}", adapters[place].name, same + 1);
            adapters[place].name = numbered;
        }
    }
    adapters
}

impl Adapter {
    fn new(adapter: wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        let backend = match info.backend {
            wgpu::Backend::Gl => "gl",
            wgpu::Backend::Dx12 => "dx12",
            wgpu::Backend::Metal => "metal",
            _ => "vulkan",
        };
        let driver = [info.driver.as_str(), info.driver_info.as_str()]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join(", ");
        Self {
            name: short_name(&info.name, backend),
            device: info.name,
            backend,
            driver,
            is_cpu: info.device_type == wgpu::DeviceType::Cpu,
            adapter,
        }
    }

    /// Opens a device on it.
    ///
    /// # Errors
    /// Where the driver gives no device.
    pub fn open(&self) -> Result<Gpu, GpuError> {
        Gpu::open(&self.name, &self.adapter)
    }
}

fn short_name(device: &str, backend: &str) -> String {
    let lower = device.to_lowercase();
    if lower.contains("swiftshader") {
        return "swiftshader".into();
    }
    if lower.contains("llvmpipe") {
        return if backend == "gl" { "llvmpipe-gl" } else { "lavapipe" }.into();
    }
    let words: Vec<&str> = lower.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let name = words.join("-");
    if ["gl", "dx12"].contains(&backend) { format!("{name}-{backend}") } else { name }
}

#[cfg(test)]
mod tests {
    use super::short_name;

    #[test]
    fn names_are_short_and_tell_the_backend() {
        assert_eq!(short_name("llvmpipe (LLVM 15.0.6, 256 bits)", "vulkan"), "lavapipe");
        assert_eq!(short_name("llvmpipe (LLVM 15.0.6, 256 bits)", "gl"), "llvmpipe-gl");
        assert_eq!(short_name("SwiftShader Device (Subzero)", "vulkan"), "swiftshader");
        assert_eq!(short_name("NVIDIA H200", "vulkan"), "nvidia-h200");
    }
}
