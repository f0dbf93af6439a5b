//! Why a measurement has no result.

use lightmeter_document::event::Stop;
use lightmeter_gpu::GpuError;

/// Why a measurement has no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BenchError {
    /// A shader is invalid, or a device failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Somebody stopped the bench.
    #[error("the bench was stopped")]
    Stopped,
}

/// Goes on unless somebody stops the bench. What compiles, draws or times asks this before each step, so that a bench ends soon.
pub(super) fn unless_stopped(stop: &Stop) -> Result<(), BenchError> {
    if stop.is_set() { Err(BenchError::Stopped) } else { Ok(()) }
}
