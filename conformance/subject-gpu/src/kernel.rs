//! The shader function of a formula.

use lightmeter_catalogue::select::Member;
use lightmeter_gpu::{GpuError, Kernel, Shaders};

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
