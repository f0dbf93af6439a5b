//! The shader function of a formula.

use lightmeter_catalogue::select::Member;
use lightmeter_gpu::{GpuError, Kernel, Shaders};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A kernel, once somebody has read it; `None` of an invalid one.
type Read = OnceLock<Option<Kernel>>;

/// Shaders as the code under test, with the kernels that are read of them, each once for all devices.
pub(crate) struct ShaderCode {
    pub(crate) shaders: Shaders,
    /// By file and function.
    kernels: Mutex<HashMap<(String, &'static str), Arc<Read>>>,
}

impl ShaderCode {
    pub(crate) fn new(shaders: Shaders) -> Self {
        Self { shaders, kernels: Mutex::default() }
    }

    /// The shader function of a formula, held against the formula's description as [`kernel`] does. Where another thread is reading it, as soon as
    /// that has.
    pub(crate) fn kernel(&self, member: &Member) -> Result<Option<Kernel>, GpuError> {
        let (file, function) = (member.spec.file(), member.spec.function);
        if function.is_empty() {
            return Ok(None);
        }
        let mut kernels = self.kernels.lock().unwrap_or_else(PoisonError::into_inner);
        let place = Arc::clone(kernels.entry((file.clone(), function)).or_default());
        drop(kernels);
        match place.get_or_init(|| Kernel::new(&self.shaders, &file, function).ok()) {
            Some(kernel) => held_against(kernel.clone(), member).map(Some),
            // An invalid one is read again for its error.
            None => kernel(&self.shaders, member),
        }
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
    held_against(Kernel::new(shaders, &spec.file(), function)?, member).map(Some)
}

fn held_against(kernel: Kernel, member: &Member) -> Result<Kernel, GpuError> {
    let spec = &member.spec;
    let (selectors, outputs) = (spec.selectors.len(), spec.output_len());
    let inputs = spec.input_len() + selectors;
    if (kernel.inputs, kernel.outputs, kernel.selectors) != (inputs, outputs, selectors) {
        let found =
            format!("{} numbers to {}, where {} takes {inputs} to {outputs}", kernel.inputs, kernel.outputs, spec.id);
        return Err(GpuError::Signature { file: spec.file(), function: spec.function.into(), found });
    }
    Ok(kernel)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::select::catalogue;

    #[test]
    fn a_kernel_that_was_read_before_is_the_same_and_belongs_to_its_function() {
        let code = ShaderCode::new(Shaders::built_in().expect("the built-in shaders are valid"));
        let catalogue = catalogue();
        for id in ["fog/exp", "fog/linear", "lighting/blinn"] {
            let member = catalogue.iter().find(|member| member.spec.id == id).expect("it is there");
            let read = || format!("{:?}", code.kernel(member).expect("it is valid"));
            let first = read();
            assert!(first.contains(member.spec.function), "{id}");
            assert_eq!(first, format!("{:?}", kernel(&code.shaders, member).expect("it is valid")));
            assert_eq!(first, read());
        }
        assert_eq!(code.kernels.lock().expect("nothing panicked").len(), 3);
    }
}
