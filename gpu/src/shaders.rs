//! The WGSL files: built in, or read from a folder; composed, parsed and validated.

use crate::error::Error;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeMap;
use std::path::Path;

/// The files that are built in: a formula family each, four that drive fixed hardware, and the probes.
pub const FILES: [(&str, &str); 13] = [
    ("attenuation.wgsl", include_str!("shaders/attenuation.wgsl")),
    ("blend.wgsl", include_str!("shaders/blend.wgsl")),
    ("blend_unit.wgsl", include_str!("shaders/blend_unit.wgsl")),
    ("blend_unit_dual.wgsl", include_str!("shaders/blend_unit_dual.wgsl")),
    ("color.wgsl", include_str!("shaders/color.wgsl")),
    ("depth.wgsl", include_str!("shaders/depth.wgsl")),
    ("depth_unit.wgsl", include_str!("shaders/depth_unit.wgsl")),
    ("fog.wgsl", include_str!("shaders/fog.wgsl")),
    ("interpolation.wgsl", include_str!("shaders/interpolation.wgsl")),
    ("lighting.wgsl", include_str!("shaders/lighting.wgsl")),
    ("probe.wgsl", include_str!("shaders/probe.wgsl")),
    ("raster.wgsl", include_str!("shaders/raster.wgsl")),
    ("vector.wgsl", include_str!("shaders/vector.wgsl")),
];

/// A set of shader files, each known to be valid with those that it requires.
#[derive(Clone, Debug)]
pub struct Shaders {
    files: BTreeMap<String, String>,
}

impl Shaders {
    /// The files that are built in.
    ///
    /// # Errors
    /// Where one of them is invalid, which a test rules out.
    pub fn built_in() -> Result<Self, Error> {
        Self::validated(FILES.into_iter().map(|(name, text)| (name.into(), text.into())).collect())
    }

    /// The built-in files, those of the same name in the folder put in their place.
    ///
    /// # Errors
    /// Where the folder cannot be read, holds no WGSL, holds a file of an unknown name, or one that is invalid.
    pub fn from_dir(dir: &Path) -> Result<Self, Error> {
        let unreadable = |path: &Path, message: String| Error::Unreadable { path: path.into(), message };
        let mut files = Self::built_in()?.files;
        let mut replaced = 0;
        let entries = std::fs::read_dir(dir).map_err(|error| unreadable(dir, error.to_string()))?;
        for entry in entries {
            let path = entry.map_err(|error| unreadable(dir, error.to_string()))?.path();
            if path.extension().is_none_or(|extension| extension != "wgsl") {
                continue;
            }
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            let text = std::fs::read_to_string(&path).map_err(|error| unreadable(&path, error.to_string()))?;
            let Some(file) = files.get_mut(&name) else {
                let known: Vec<&str> = FILES.iter().map(|(name, _)| *name).collect();
                return Err(unreadable(&path, format!("no such shader; expected one of {}", known.join(", "))));
            };
            *file = text;
            replaced += 1;
        }
        if replaced == 0 {
            return Err(unreadable(dir, "no .wgsl file there; copy gpu/src/shaders and edit the copy".into()));
        }
        Self::validated(files)
    }

    fn validated(files: BTreeMap<String, String>) -> Result<Self, Error> {
        let shaders = Self { files };
        // A file is reported before those that require it.
        let mut order: Vec<&String> = shaders.files.keys().collect();
        order.sort_by_key(|name| shaders.required(name).len());
        for name in order {
            shaders.parse(name)?;
        }
        Ok(shaders)
    }

    /// The files that one requires, by its `// requires:` line, and those that they require in turn.
    fn required(&self, file: &str) -> Vec<String> {
        let mut found: Vec<String> = vec![];
        let mut open = vec![file.to_owned()];
        while let Some(name) = open.pop() {
            let text = self.files.get(&name).map(String::as_str).unwrap_or_default();
            let names =
                text.lines().filter_map(|line| line.strip_prefix("// requires:")).flat_map(str::split_whitespace);
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

    /// A file followed by those that it requires: its own lines come first, so that messages count from its start.
    #[must_use]
    pub fn source(&self, file: &str) -> String {
        let text = |name: &str| self.files.get(name).map(String::as_str).unwrap_or_default();
        let mut source = text(file).to_owned();
        for name in self.required(file) {
            source.push('\n');
            source.push_str(text(&name));
        }
        source
    }

    /// Parses and validates a file with those that it requires.
    ///
    /// # Errors
    /// naga's message, with the line.
    pub fn parse(&self, file: &str) -> Result<naga::Module, Error> {
        let module = validate(file, &self.source(file))?;
        let entries = ENTRY_POINTS.iter().filter(|(of, _)| *of == file).flat_map(|(_, names)| names.iter());
        for name in entries {
            if !module.entry_points.iter().any(|entry| entry.name == *name) {
                return Err(Error::MissingFunction { file: file.into(), function: (*name).into() });
            }
        }
        Ok(module)
    }
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
pub(crate) fn validate(file: &str, source: &str) -> Result<naga::Module, Error> {
    let invalid = |message: String| Error::Shader { file: file.into(), message };
    let module =
        naga::front::wgsl::parse_str(source).map_err(|error| invalid(error.emit_to_string_with_path(source, file)))?;
    Validator::new(ValidationFlags::all(), Capabilities::default() | Capabilities::DUAL_SOURCE_BLENDING)
        .validate(&module)
        .map_err(|error| invalid(error.emit_to_string_with_path(source, file)))?;
    Ok(module)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn built_in_shaders_are_valid() {
        if let Err(error) = Shaders::built_in() {
            panic!("{error}");
        }
    }

    #[test]
    fn an_error_is_counted_from_the_files_own_start() {
        let mut files: BTreeMap<String, String> = FILES.into_iter().map(|(n, t)| (n.into(), t.into())).collect();
        files.insert("fog.wgsl".into(), "// a\n// b\nfn f() -> f32 {\n    return nothing;\n}\n".into());
        let error = Shaders::validated(files).expect_err("the file is invalid").to_string();
        assert!(error.contains("fog.wgsl:4:12"), "{error}");
    }
}
