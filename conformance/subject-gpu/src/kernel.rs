//! The shader function of a formula.

use lightmeter_catalogue::select::Member;
use lightmeter_gpu::{GpuError, Kernel, Shaders};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Shaders as the code under test, with the kernels that were read of them ahead.
pub(crate) struct ShaderCode {
    pub(crate) shaders: Shaders,
    /// By the formula's id. `None` of what has no shader function, or an invalid one.
    kernels: Mutex<HashMap<String, Arc<OnceLock<Option<Kernel>>>>>,
}

impl ShaderCode {
    pub(crate) fn new(shaders: Shaders) -> Self {
        Self { shaders, kernels: Mutex::default() }
    }

    /// Reads a formula's kernel, which [`ShaderCode::kernel`] then need not.
    pub(crate) fn read(&self, member: &Member) {
        let mut kernels = self.kernels.lock().unwrap_or_else(PoisonError::into_inner);
        let place = Arc::clone(kernels.entry(member.spec.id.clone()).or_default());
        drop(kernels);
        place.get_or_init(|| kernel(&self.shaders, member).ok().flatten());
    }

    /// A formula's kernel; where another thread is reading it, as soon as that has.
    pub(crate) fn kernel(&self, member: &Member) -> Result<Option<Kernel>, GpuError> {
        let kernels = self.kernels.lock().unwrap_or_else(PoisonError::into_inner);
        let place = kernels.get(&member.spec.id).cloned();
        drop(kernels);
        let read = place.and_then(|place| place.get_or_init(|| kernel(&self.shaders, member).ok().flatten()).clone());
        // An invalid one is read again for its error.
        read.map_or_else(|| kernel(&self.shaders, member), |kernel| Ok(Some(kernel)))
    }
}

/// The shader function of a formula, held against the formula's description; `None` where no function evaluates it.
///
/// # Errors
/// Where the file lacks the function, or the function has other inputs or outputs than the formula.
pub fn kernel(shaders: &Shaders, member: &Member) -> Result<Option<Kernel>, GpuError> {
    let (spec, function) = (&member.spec, member.spec.function);
    if function.is_empty() {
        return Ok(None);
    }
    let file = spec.file();
    let kernel = Kernel::new(shaders, &file, function)?;
    let (selectors, outputs) = (spec.selectors.len(), spec.output_len());
    let inputs = spec.input_len() + selectors;
    if (kernel.inputs, kernel.outputs, kernel.selectors) != (inputs, outputs, selectors) {
        let found =
            format!("{} numbers to {}, where {} takes {inputs} to {outputs}", kernel.inputs, kernel.outputs, spec.id);
        return Err(GpuError::Signature { file, function: function.into(), found });
    }
    Ok(Some(kernel))
}
