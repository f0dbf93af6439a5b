//! A set of WGSL files: their texts, what each requires, and whether it is valid.

use crate::error::GpuError;
use lightmeter_scene::effects::Effect;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::{BTreeMap, BTreeSet};

/// A set of shader files, each known to be valid with those that it requires.
#[derive(Clone, Debug)]
pub struct Shaders {
    pub(crate) files: BTreeMap<String, String>,
}

impl Shaders {
    /// A function's text with the comment above it; `None` where the file has no such function.
    #[must_use]
    pub fn function(&self, file: &str, name: &str) -> Option<String> {
        let lines: Vec<&str> = self.files.get(file)?.lines().collect();
        let place = lines.iter().position(|line| line.starts_with(&format!("fn {name}(")))?;
        let comment = lines[..place].iter().rev().take_while(|line| line.starts_with("//")).count();
        let end = lines[place..].iter().position(|line| line.starts_with('}'))?;
        Some(lines[place - comment..=place + end].join("\n"))
    }

    /// A function's text as [`Shaders::function`] gives it, and behind it the functions and structures that it names, of the same file or
    /// of others, each once.
    #[must_use]
    pub fn function_with_named(&self, file: &str, name: &str) -> Option<String> {
        let mut texts = vec![self.function(file, name)?];
        let mut told = BTreeSet::from([name.to_owned()]);
        let mut next = 0;
        while let Some(text) = texts.get(next).cloned() {
            let code = text.lines().filter(|line| !line.starts_with("//"));
            let names = code.flat_map(|line| line.split(|c: char| !(c.is_alphanumeric() || c == '_')));
            for name in names.filter(|name| !name.is_empty()) {
                if let Some((of, text)) = self.definition(name)
                    && told.insert(name.to_owned())
                {
                    texts.push(if of == file { text } else { format!("// {of}\n{text}") });
                }
            }
            next += 1;
        }
        Some(texts.join("\n\n"))
    }

    /// The file and the text of a function or a structure.
    fn definition(&self, name: &str) -> Option<(&str, String)> {
        let structure = |text: &str| {
            let lines: Vec<&str> = text.lines().collect();
            let start = lines.iter().position(|line| *line == format!("struct {name} {{"))?;
            let end = lines[start..].iter().position(|line| line.starts_with('}'))?;
            Some(lines[start..=start + end].join("\n"))
        };
        self.files.iter().find_map(|(file, text)| {
            self.function(file, name).or_else(|| structure(text)).map(|text| (file.as_str(), text))
        })
    }

    /// The files that one requires, by its `// requires:` line, and those that they require in turn.
    pub(crate) fn required(&self, file: &str) -> Vec<String> {
        let mut found: Vec<String> = vec![];
        let mut open = vec![file.to_owned()];
        while let Some(name) = open.pop() {
            let names = self
                .text(&name)
                .lines()
                .filter_map(|line| line.strip_prefix("// requires:"))
                .flat_map(str::split_whitespace);
            for stem in names {
                let name = format!("{stem}.wgsl");
                if !found.contains(&name) {
                    found.push(name.clone());
                    open.push(name);
                }
            }
        }
        found
    }

    /// A file's text alone; empty where there is no such file.
    pub(crate) fn text(&self, file: &str) -> &str {
        self.files.get(file).map(String::as_str).unwrap_or_default()
    }

    /// The stable form of a function, which stands in for it at that rung; `None` where it has none of its own.
    #[must_use]
    pub fn stable_form(&self, function: &str) -> Option<String> {
        self.stable_forms().remove(function)
    }

    /// The stable form of each function that has one, as `// stable form of:` lines say, directly above the stable function.
    pub(crate) fn stable_forms(&self) -> BTreeMap<String, String> {
        let mut forms = BTreeMap::new();
        for text in self.files.values() {
            for (mark, function) in text.lines().zip(text.lines().skip(1)) {
                let Some(published) = mark.strip_prefix("// stable form of:") else { continue };
                let name = function.strip_prefix("fn ").and_then(|rest| rest.split('(').next()).unwrap_or_default();
                forms.extend(published.split_whitespace().map(|published| (published.into(), name.into())));
            }
        }
        forms
    }

    /// A file followed by those that it requires: its own lines come first, so that messages count from its start.
    #[must_use]
    pub fn source(&self, file: &str) -> String {
        let mut source = self.text(file).to_owned();
        for name in self.required(file) {
            source.push('\n');
            source.push_str(self.text(&name));
        }
        source
    }

    /// Parses and validates a file with those that it requires.
    ///
    /// # Errors
    /// naga's message, with the line.
    pub fn parse(&self, file: &str) -> Result<naga::Module, GpuError> {
        let module = validate(file, &self.source(file))?;
        let entries = ENTRY_POINTS.iter().filter(|(of, _)| *of == file).flat_map(|(_, names)| names.iter());
        for name in entries {
            if !module.entry_points.iter().any(|entry| entry.name == *name) {
                return Err(GpuError::MissingFunction { file: file.into(), function: (*name).into() });
            }
        }
        Ok(module)
    }
}

/// The file with an effect's part of the scenes' shader.
pub(crate) fn effect_file(effect: Effect) -> String {
    format!("effects/{}.wgsl", effect.name())
}

/// The entry points that fixed hardware is driven by.
const ENTRY_POINTS: [(&str, &[&str]); 4] = [
    ("blend_unit.wgsl", &["unit_source", "unit_folded_source", "unit_color"]),
    ("depth_unit.wgsl", &["unit_old", "unit_new", "unit_first", "unit_second", "unit_screen", "unit_left"]),
    ("blend_unit_dual.wgsl", &["unit_dual_source", "unit_color"]),
    (
        "raster.wgsl",
        &[
            "raster_triangle_vertex",
            "raster_line_vertex",
            "raster_quad_vertex",
            "raster_depth_vertex",
            "raster_flat_first_vertex",
            "raster_flat_last_vertex",
            "raster_attributes",
            "raster_position",
            "raster_facing",
            "raster_covered",
            "raster_covered_again",
            "raster_count",
            "raster_own_depth",
            "raster_flat_fragment",
            "raster_screen",
            "raster_result",
        ],
    ),
];

/// Parses and validates WGSL that begins with a file's own text.
pub(crate) fn validate(file: &str, source: &str) -> Result<naga::Module, GpuError> {
    let invalid = |message: String| GpuError::Shader { file: file.into(), message };
    let module =
        naga::front::wgsl::parse_str(source).map_err(|error| invalid(error.emit_to_string_with_path(source, file)))?;
    validator().validate(&module).map_err(|error| invalid(error.emit_to_string_with_path(source, file)))?;
    Ok(module)
}

/// The same of a text in another arithmetic.
pub(crate) fn validate_lowered(file: &str, source: &str) -> Result<naga::Module, GpuError> {
    let invalid = |message: String| GpuError::Shader { file: file.into(), message };
    let module =
        naga::front::wgsl::parse_str(source).map_err(|error| invalid(error.emit_to_string_with_path(source, file)))?;
    let capabilities = Capabilities::FLOAT64 | Capabilities::SHADER_FLOAT16 | Capabilities::SHADER_FLOAT16_IN_FLOAT32;
    Validator::new(ValidationFlags::all(), Capabilities::default() | capabilities)
        .validate(&module)
        .map_err(|error| invalid(error.emit_to_string_with_path(source, file)))?;
    Ok(module)
}

pub(crate) fn validator() -> Validator {
    let capabilities = Capabilities::DUAL_SOURCE_BLENDING | Capabilities::SHADER_FLOAT16_IN_FLOAT32;
    Validator::new(ValidationFlags::all(), Capabilities::default() | capabilities)
}
