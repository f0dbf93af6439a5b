//! A formula's WGSL function, replaced by one that calls a shader.

use crate::AdaptError;
use crate::bind::ShaderBinding;
use crate::program::ShaderProgram;
use lightmeter_catalogue::cases::Spec;
use lightmeter_gpu::Shaders;
use std::fmt::Write as _;

/// The value of a case that has none, NaN in each of its `numbers` components. It is read from a variable, since browsers refuse a constant NaN.
fn nothing_of(numbers: usize) -> String {
    const NAN: &str = "bitcast<f32>(user_nothing)";
    if numbers == 1 { NAN.into() } else { format!("vec{numbers}f({NAN})") }
}

/// The text of the file of a family of formulas, in which each bound formula's function calls the shader.
///
/// # Errors
/// Where a formula has no function of its own, or a bound expression is not WGSL over its inputs.
pub fn replaced(
    shaders: &Shaders,
    program: &ShaderProgram,
    bound: &[(&Spec, ShaderBinding)],
) -> Result<Vec<(String, String)>, AdaptError> {
    let mut files: Vec<(String, String)> = vec![];
    for (spec, binding) in bound {
        let file = spec.file();
        let place = files.iter().position(|(name, _)| *name == file).unwrap_or_else(|| {
            let text = shaders.texts().find(|(name, _)| *name == file).map_or("", |(_, text)| text);
            files.push((file.clone(), text.to_owned()));
            files.len() - 1
        });
        let text = &mut files[place].1;
        let Some(signature) = Signature::of(text, spec.function) else {
            return Err(AdaptError::Bind(format!(
                "{} is evaluated by fixed hardware, which no shader can stand in for",
                spec.id
            )));
        };
        let wrapper = wrapper(&signature, program, spec, binding);
        *text = text.replacen(&format!("fn {}(", spec.function), &format!("fn user_own_{}(", spec.function), 1);
        text.push_str(&wrapper);
    }
    for (k, (_, text)) in files.iter_mut().enumerate() {
        // What a file requires is said in its first lines.
        let _ = write!(text, "\n{}", program.wgsl);
        // One file may require another one, so that each has names of its own.
        if k > 0 {
            *text = text.replace("user_", &format!("user{k}_"));
        }
    }
    Ok(files)
}

/// The head of a function of ours.
pub(crate) struct Signature {
    pub(crate) parameters: Vec<(String, String)>,
    result: String,
    /// The members of the parameters that are structures, in order.
    inputs: Vec<String>,
    /// The members of a result that is a structure.
    members: Vec<String>,
}

impl Signature {
    pub(crate) fn of(text: &str, function: &str) -> Option<Self> {
        let start = text.find(&format!("fn {function}("))? + function.len() + 4;
        let (head, _) = text[start..].split_once('{')?;
        let (parameters, result) = head.rsplit_once(')')?;
        let pair = |text: &str| text.split_once(':').map(|(name, ty)| (name.trim().to_owned(), ty.trim().to_owned()));
        let parameters: Vec<(String, String)> = parameters.split(',').filter_map(pair).collect();
        let result = result.trim().trim_start_matches("->").trim().to_owned();
        let members = |ty: &str| -> Option<Vec<String>> {
            let body = text.split_once(&format!("struct {ty} {{"))?.1.split_once('}')?.0;
            Some(body.split(',').filter_map(pair).map(|(name, _)| name).collect())
        };
        let mut inputs = vec![];
        for (k, (_, ty)) in parameters.iter().enumerate().filter(|(_, (_, ty))| ty != "u32") {
            match members(ty) {
                Some(names) => inputs.extend(names.into_iter().map(|name| format!("user_in{k}x.{name}"))),
                None => inputs.push(format!("user_in{k}x")),
            }
        }
        Some(Self { inputs, members: members(&result).unwrap_or_default(), parameters, result })
    }
}

fn wrapper(signature: &Signature, program: &ShaderProgram, spec: &Spec, binding: &ShaderBinding) -> String {
    let function = spec.function;
    let parameters: Vec<String> =
        signature.parameters.iter().enumerate().map(|(k, (_, ty))| format!("user_in{k}x: {ty}")).collect();
    let mut text = format!("\nfn {function}({}) -> {} {{\n", parameters.join(", "), signature.result);
    for (input, value) in spec.inputs.iter().zip(&signature.inputs) {
        let _ = writeln!(text, "    let {} = {value};", input.name);
    }
    for line in program.unanswered.reset.iter().chain(&program.declared) {
        let _ = writeln!(text, "    {line}");
    }
    for bound in &binding.bound {
        let _ = writeln!(text, "    {} = {};", bound.place, bound.expression);
    }
    let _ = writeln!(text, "    {}", program.call);
    let names: Vec<String> = (0..signature.parameters.len()).map(|k| format!("user_in{k}x")).collect();
    let _ = writeln!(text, "    let user_own = user_own_{function}({});", names.join(", "));
    if program.unanswered.flag.is_some() {
        text += "    var user_nothing = 0x7fc00000u;\n";
    }
    let given = |value: &str, numbers: usize| match &program.unanswered.flag {
        None => value.to_owned(),
        Some(flag) => format!("select({value}, {}, {flag})", nothing_of(numbers)),
    };
    let numbers: Vec<usize> = spec.outputs.iter().map(|output| output.shape.components()).collect();
    let result = match (binding.outputs.as_slice(), signature.members.as_slice()) {
        ([(_, value)], []) => value.as_deref().map_or_else(|| "user_own".into(), |value| given(value, numbers[0])),
        (values, members) => {
            let part = |(k, ((_, value), member)): (usize, (&(&str, Option<String>), &String))| {
                value.as_deref().map_or_else(|| format!("user_own.{member}"), |value| given(value, numbers[k]))
            };
            let parts: Vec<String> = values.iter().zip(members).enumerate().map(part).collect();
            format!("{}({})", signature.result, parts.join(", "))
        }
    };
    let _ = writeln!(text, "    return {result};\n}}");
    text
}
