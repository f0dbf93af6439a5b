//! The stable form of a formula, in the language of whoever asks.

use crate::program::validated;
use crate::wrapper::Signature;
use lightmeter_gpu::Shaders;
use lightmeter_shaders::read::Language;
use naga::ShaderStage;
use naga::back::glsl::{Options, PipelineOptions, Version, Writer};
use naga::compact::{KeepUnused, compact};
use naga::proc::BoundsCheckPolicies;

/// The entry point that keeps a function from being left out.
const ENTRY: &str = "lightmeter_entry";

/// A function's stable form with the functions that it calls, as GLSL where that is the language, else as WGSL; `None` where it has none.
#[must_use]
pub fn stable_form(shaders: &Shaders, file: &str, function: &str, language: Language) -> Option<String> {
    in_language(shaders, file, &shaders.stable_form(function)?, language)
}

/// A function with the functions that it calls, as GLSL where that is the language, else as WGSL; `None` where naga cannot write it.
#[must_use]
pub fn in_language(shaders: &Shaders, file: &str, function: &str, language: Language) -> Option<String> {
    match language {
        Language::Glsl(_) => as_glsl(shaders, file, function),
        Language::Wgsl | Language::Spirv => Some(as_wgsl(shaders, file, function)),
    }
}

/// The function's text, and before it the text of each that it calls.
fn as_wgsl(shaders: &Shaders, file: &str, function: &str) -> String {
    let source = shaders.source(file);
    let text_of = |name: &str| shaders.texts().find_map(|(file, _)| shaders.function(file, name));
    let (mut open, mut found): (Vec<String>, Vec<(String, String)>) = (vec![function.into()], vec![]);
    while let Some(name) = open.pop() {
        let Some(text) = text_of(&name) else { continue };
        let is_function = |word: &&str| source.contains(&format!("fn {word}("));
        let called = text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(is_function);
        open.extend(called.filter(|called| *called != name).map(str::to_owned));
        // What is called by several stands before all of them.
        found.retain(|(other, _)| *other != name);
        found.push((name, text));
    }
    found.reverse();
    let functions: Vec<String> = found.into_iter().map(|(_, text)| text + "\n").collect();
    let structures = source.split("\nstruct ").skip(1).filter_map(|rest| {
        let (name, end) = (rest.split(' ').next()?, rest.find("\n}")?);
        let has = |text: &String| text.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name);
        functions.iter().any(has).then(|| format!("struct {}\n}}\n", &rest[..end]))
    });
    structures.chain(functions.iter().cloned()).collect::<Vec<_>>().join("\n")
}

/// The function and what it calls, as naga writes it.
pub(crate) fn as_glsl(shaders: &Shaders, file: &str, function: &str) -> Option<String> {
    // A stable form may stand in a file that this one requires.
    let defines = |text: &str| text.contains(&format!("fn {function}("));
    let own = shaders.texts().find(|(name, text)| *name == file && defines(text));
    let (file, text) = own.or_else(|| shaders.texts().find(|(name, text)| !name.contains('/') && defines(text)))?;
    let zeros: Vec<String> =
        Signature::of(text, function)?.parameters.iter().map(|(_, ty)| format!("{ty}()")).collect();
    let entry = format!(
        "\n@fragment fn {ENTRY}() -> @location(0) vec4f {{ _ = {function}({}); return vec4f(); }}\n",
        zeros.join(", ")
    );
    let mut module = naga::front::wgsl::parse_str(&(shaders.source(file) + &entry)).ok()?;
    compact(&mut module, KeepUnused::No);
    let info = validated(&module).ok()?;
    let options = Options { version: Version::new_gles(310), ..Options::default() };
    let pipeline = PipelineOptions { shader_stage: ShaderStage::Fragment, entry_point: ENTRY.into(), multiview: None };
    let mut out = String::new();
    Writer::new(&mut out, &module, &info, &options, &pipeline, BoundsCheckPolicies::default()).ok()?.write().ok()?;
    let is_code =
        |line: &&str| !line.starts_with("#version") && !line.starts_with("precision") && !line.starts_with("layout");
    let lines: Vec<&str> = out.lines().filter(is_code).take_while(|line| !line.starts_with("void main")).collect();
    Some(lines.join("\n").trim().to_owned() + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stable_form_is_written_in_both_languages() {
        let shaders = Shaders::built_in().expect("the built-in shaders are valid");
        let mut forms = 0;
        for (file, text) in shaders.texts().filter(|(file, _)| !file.contains('/')) {
            for function in text.lines().filter_map(|line| line.strip_prefix("fn ")?.split('(').next()) {
                let Some(stable) = shaders.stable_form(function) else { continue };
                forms += 1;
                let wgsl = stable_form(&shaders, file, function, Language::Wgsl).expect(function);
                assert!(wgsl.contains(&format!("fn {stable}(")), "{wgsl}");
                naga::front::wgsl::parse_str(&wgsl).unwrap_or_else(|error| panic!("{}\n{wgsl}", error.message()));
                let glsl =
                    stable_form(&shaders, file, function, Language::Glsl(ShaderStage::Fragment)).expect(function);
                // naga puts an underscore behind a digit.
                assert!(glsl.contains(&stable) && !glsl.contains("void main"), "{glsl}");
            }
        }
        assert!(forms > 20, "{forms}");
    }
}
