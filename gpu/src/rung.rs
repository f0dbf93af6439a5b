//! The ladder: the arithmetics that the same WGSL is evaluated in on a device.

mod body;
mod dialect;
mod lower;
mod probe;
mod widen;
mod writer;

use crate::device::Gpu;
use crate::error::GpuError;
pub(crate) use dialect::{Dialect, Shape, rung_struct};
pub(crate) use lower::{Asked, Lowered, lower};

/// A rung of the ladder: what a shader's f32 becomes, and by what its functions are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Rung {
    /// binary16.
    F16,
    /// f32, with approximations that cost little: Schlick's power, exponentials and logarithms by the bits.
    Cheap,
    /// f32, as published.
    F32,
    /// f32, with the stable form of each step that has one.
    Stable,
    /// Sums of two f32, by error-free transforms.
    DoubleFloat,
    /// binary64, with exponentials and powers of our own.
    F64,
}

impl Rung {
    /// All, the coarsest first.
    pub const ALL: [Self; 6] = [Self::F16, Self::Cheap, Self::F32, Self::Stable, Self::DoubleFloat, Self::F64];

    /// Whether that is the reason of what is no program of its own at a rung, but that of f32.
    #[must_use]
    pub fn is_as_f32(reason: &str) -> bool {
        [lower::NOTHING_CHEAP, lower::NOTHING_STABLE].contains(&reason)
    }

    /// Whether it computes what f32 does, only closer or by another form: not coarser, and not by approximations.
    #[must_use]
    pub const fn is_exact(self) -> bool {
        matches!(self, Self::F32 | Self::Stable | Self::DoubleFloat | Self::F64)
    }

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::F16 => "f16",
            Self::Cheap => "f32-cheap",
            Self::F32 => "f32",
            Self::Stable => "f32-stable",
            Self::DoubleFloat => "double-float",
            Self::F64 => "f64",
        }
    }

    /// Words of binary32 that a number of it is handed back in, the greatest part first.
    #[must_use]
    pub const fn parts(self) -> usize {
        match self {
            Self::F16 | Self::Cheap | Self::F32 | Self::Stable => 1,
            Self::DoubleFloat => 2,
            Self::F64 => 3,
        }
    }

    /// The feature that a device lacks for it; `None` where it has what it takes.
    #[must_use]
    pub fn lacks(self, gpu: &Gpu) -> Option<&'static str> {
        let (feature, reason) = match self {
            Self::Cheap | Self::F32 | Self::Stable | Self::DoubleFloat => return None,
            Self::F16 => (wgpu_types::Features::SHADER_F16, "the adapter lacks the feature SHADER_F16"),
            Self::F64 => (wgpu_types::Features::SHADER_F64, "the adapter lacks the feature SHADER_F64"),
        };
        (!gpu.has(feature)).then_some(reason)
    }

    /// Why it is unavailable on a device: by what the device lacks, else by a probe of its arithmetic. `None` where it is
    /// available.
    ///
    /// # Errors
    /// Where the device fails.
    pub fn unavailable(self, gpu: &Gpu) -> Result<Option<String>, GpuError> {
        match self.lacks(gpu) {
            Some(reason) => Ok(Some(reason.into())),
            None => probe::probe(self, gpu),
        }
    }
}

#[cfg(test)]
mod tests;
