//! A shader's file, read by naga.

use super::ShaderError;
use super::glsl::{self, PRELUDE_LINES, Role};
use lightmeter_files::read;
use naga::front::{glsl as glsl_in, spv, wgsl};
use naga::{Module, ShaderStage};
use std::path::Path;

/// Bytes that a shader's file may have.
pub(super) const MOST_BYTES: u64 = 4 << 20;

/// What a file's ending says of its language.
const ENDINGS: [(&str, Language); 19] = [
    ("wgsl", Language::Wgsl),
    ("spv", Language::Spirv),
    ("frag", Language::Glsl(ShaderStage::Fragment)),
    ("glsl", Language::Glsl(ShaderStage::Fragment)),
    ("fs", Language::Glsl(ShaderStage::Fragment)),
    ("fsh", Language::Glsl(ShaderStage::Fragment)),
    ("fp", Language::Glsl(ShaderStage::Fragment)),
    ("psh", Language::Glsl(ShaderStage::Fragment)),
    ("fshader", Language::Glsl(ShaderStage::Fragment)),
    ("fragment", Language::Glsl(ShaderStage::Fragment)),
    ("vshader", Language::Glsl(ShaderStage::Vertex)),
    ("vertex", Language::Glsl(ShaderStage::Vertex)),
    ("fragmentshader", Language::Glsl(ShaderStage::Fragment)),
    ("vertexshader", Language::Glsl(ShaderStage::Vertex)),
    ("vert", Language::Glsl(ShaderStage::Vertex)),
    ("vs", Language::Glsl(ShaderStage::Vertex)),
    ("vsh", Language::Glsl(ShaderStage::Vertex)),
    ("vp", Language::Glsl(ShaderStage::Vertex)),
    ("comp", Language::Glsl(ShaderStage::Compute)),
];

/// The language that a shader is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// WGSL.
    Wgsl,
    /// GLSL of any version, of a stage.
    Glsl(ShaderStage),
    /// SPIR-V, to which compilers of HLSL, Slang and GLSL translate.
    Spirv,
}

/// A shader as naga has it.
#[derive(Debug)]
pub struct ShaderSource {
    /// What it says.
    pub module: Module,
    /// Of GLSL each global variable's name and what it was declared as.
    pub roles: Vec<(String, Role)>,
    /// Its text; empty of SPIR-V.
    pub text: String,
    /// Its language.
    pub language: Language,
    /// The text that naga read, and how many lines of it stand before the file's own.
    pub read: (String, usize),
    /// Whether it is only functions.
    pub is_library: bool,
}

impl ShaderSource {
    /// Reads a file.
    ///
    /// # Errors
    /// Where it cannot be read, or naga does not take it: with the line, and what would do.
    pub fn read(path: &Path) -> Result<Self, ShaderError> {
        let language = language(path)?;
        let unreadable = |error: std::io::Error| ShaderError::File { path: path.into(), message: error.to_string() };
        if language == Language::Spirv {
            let bytes = read::bytes(path, MOST_BYTES).map_err(unreadable)?;
            return of_spirv(path, &bytes);
        }
        let text = read::text(path, MOST_BYTES).map_err(unreadable)?;
        Self::of_text(path, &text, language)
    }

    /// Reads a text, as the file of that name.
    ///
    /// # Errors
    /// Where naga does not take it: with the line, and what would do.
    pub fn of_text(path: &Path, text: &str, language: Language) -> Result<Self, ShaderError> {
        // Some editors begin a file with a mark of its byte order, and some end lines with CR alone.
        let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n").replace('\r', "\n");
        if let Language::Glsl(stage) = language {
            return of_glsl(path, text, stage);
        }
        let module = of_wgsl(path, &text)?;
        Ok(Self { module, roles: vec![], read: (text.clone(), 0), text, language, is_library: false })
    }

    /// The line of the file in which something stands that is not read.
    #[must_use]
    pub fn line_of(&self, words: &[&str]) -> Option<usize> {
        let has = |line: &str| words.iter().any(|word| line.contains(word));
        self.text.lines().position(has).map(|place| place + 1)
    }
}

impl Language {
    /// What a file's ending says.
    ///
    /// # Errors
    /// Where it names no language that is read: says what would do.
    pub fn of(path: &Path) -> Result<Self, ShaderError> {
        language(path)
    }
}

/// Whether a file's ending is that of a shader.
#[must_use]
pub fn is_shader(path: &Path) -> bool {
    let ending = path.extension().map(|own| own.to_string_lossy().to_lowercase()).unwrap_or_default();
    ENDINGS.iter().any(|(own, _)| *own == ending) || HLSL.contains(&&*ending)
}

/// Endings of HLSL.
pub(super) const HLSL: [&str; 4] = ["hlsl", "hlsli", "fx", "fxh"];

fn language(path: &Path) -> Result<Language, ShaderError> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    if let Some((_, language)) = ENDINGS.iter().find(|(own, _)| *own == ending) {
        return Ok(*language);
    }
    let by_spirv = |compiler: &str| format!("{ending} is read as SPIR-V: compile it by `{compiler}`");
    let message = match ending.as_str() {
        "hlsl" | "fx" => by_spirv("dxc -spirv -T ps_6_0 -E main -Fo shader.spv"),
        "slang" => by_spirv("slangc -target spirv -o shader.spv"),
        _ => "its ending names no language; expected .wgsl, .frag, .vert or .glsl, or .spv".to_owned(),
    };
    Err(ShaderError::Language { path: path.into(), message })
}

fn of_spirv(path: &Path, bytes: &[u8]) -> Result<ShaderSource, ShaderError> {
    let options =
        spv::Options { adjust_coordinate_space: false, strict_capabilities: false, ..spv::Options::default() };
    let module = spv::parse_u8_slice(bytes, &options).map_err(|error| ShaderError::Invalid {
        path: path.into(),
        line: None,
        message: format!("it is no SPIR-V that naga reads: {error}"),
    })?;
    let (text, read) = (String::new(), (String::new(), 0));
    Ok(ShaderSource { module, roles: vec![], text, language: Language::Spirv, read, is_library: false })
}

fn of_wgsl(path: &Path, text: &str) -> Result<Module, ShaderError> {
    wgsl::parse_str(text).map_err(|error| ShaderError::Invalid {
        path: path.into(),
        line: error.location(text).map(|place| place.line_number as usize),
        message: error.message().to_owned(),
    })
}

fn of_glsl(path: &Path, own: String, stage: ShaderStage) -> Result<ShaderSource, ShaderError> {
    // Messages have the names that people wrote.
    let invalid =
        |line, message: String| ShaderError::Invalid { path: path.into(), line, message: glsl::shown(&message) };
    if let Some((line, word)) = unread(&own) {
        return Err(invalid(Some(line), word));
    }
    let glsl::Normalised { text, mut roles, has_main } = glsl::normalised(&own);
    if stage == ShaderStage::Vertex {
        // What varies is what a vertex shader gives.
        roles.iter_mut().filter(|(_, role)| *role == Role::Varying).for_each(|(_, role)| *role = Role::Output);
    }
    let module = glsl_in::Frontend::default().parse(&glsl_in::Options::from(stage), &text).map_err(|errors| {
        let Some(error) = errors.errors.first() else { return invalid(None, errors.to_string()) };
        let line = error.meta.location(&text).line_number as usize;
        invalid(Some(line.saturating_sub(PRELUDE_LINES).max(1)), plain(&error.kind.to_string()))
    })?;
    let language = Language::Glsl(stage);
    Ok(ShaderSource { module, roles, text: own, language, read: (text, PRELUDE_LINES), is_library: !has_main })
}

/// A message without what naga's own types look like.
fn plain(message: &str) -> String {
    message.split_once("TypeName(").map_or_else(|| message.to_owned(), |(before, _)| format!("{before}a type"))
}

/// The versions of GLSL and of GLSL ES.
const VERSIONS: [&str; 17] = [
    "100", "110", "120", "130", "140", "150", "300", "310", "320", "330", "400", "410", "420", "430", "440", "450",
    "460",
];
/// Extensions whose words are read without them.
const EXTENSIONS: [&str; 8] = [
    "GL_ARB_explicit_attrib_location",
    "GL_ARB_explicit_uniform_location",
    "GL_ARB_separate_shader_objects",
    "GL_ARB_shading_language_420pack",
    "GL_ARB_uniform_buffer_object",
    "GL_EXT_shader_io_blocks",
    "GL_KHR_vulkan_glsl",
    "GL_OES_standard_derivatives",
];

/// What no preprocessor here reads: the line, and what would do.
fn unread(text: &str) -> Option<(usize, String)> {
    let line = |(k, line): (usize, &str)| {
        let words = line.trim_start().strip_prefix('#')?.trim_start();
        let words = words.split("//").next().unwrap_or_default();
        let says = if let Some(file) = words.strip_prefix("include") {
            let file = file.trim();
            format!("`#include {file}` is not followed; put the text there, or compile it to SPIR-V")
        } else if let Some(version) = words.strip_prefix("version") {
            let version = version.trim();
            if version.split_whitespace().next().is_some_and(|number| VERSIONS.contains(&number)) {
                return None;
            }
            format!(
                "`#version {version}` is no version of GLSL; expected such as `#version 330 core` or `#version 300 es`"
            )
        } else {
            let (name, behaviour) = words.strip_prefix("extension")?.split_once(':')?;
            let name = name.trim();
            if behaviour.trim() != "require" || EXTENSIONS.contains(&name) {
                return None;
            }
            format!(
                "the extension {name} is required, and is not read; compile the shader to SPIR-V, or write it without"
            )
        };
        Some((k + 1, says))
    };
    text.lines().enumerate().find_map(line)
}
