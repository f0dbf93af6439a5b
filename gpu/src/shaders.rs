//! The WGSL files: built in, or read from a folder; composed, parsed and validated.

use crate::compose::Composer;
use crate::error::GpuError;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeMap;
use std::path::Path;

/// The built-in files that stand by themselves: a formula family each, the elementary functions that WGSL lacks, four
/// that drive fixed hardware, two of probes, and the techniques that are measured against each other.
pub const FILES: [(&str, &str); 17] = [
    ("attenuation.wgsl", include_str!("shaders/attenuation.wgsl")),
    ("blend.wgsl", include_str!("shaders/blend.wgsl")),
    ("blend_unit.wgsl", include_str!("shaders/blend_unit.wgsl")),
    ("blend_unit_dual.wgsl", include_str!("shaders/blend_unit_dual.wgsl")),
    ("color.wgsl", include_str!("shaders/color.wgsl")),
    ("depth.wgsl", include_str!("shaders/depth.wgsl")),
    ("depth_unit.wgsl", include_str!("shaders/depth_unit.wgsl")),
    ("elementary.wgsl", include_str!("shaders/elementary.wgsl")),
    ("fog.wgsl", include_str!("shaders/fog.wgsl")),
    ("interpolation.wgsl", include_str!("shaders/interpolation.wgsl")),
    ("lighting.wgsl", include_str!("shaders/lighting.wgsl")),
    ("probe.wgsl", include_str!("shaders/probe.wgsl")),
    ("raster.wgsl", include_str!("shaders/raster.wgsl")),
    ("special.wgsl", include_str!("shaders/special.wgsl")),
    ("technique.wgsl", include_str!("shaders/technique.wgsl")),
    ("texture.wgsl", include_str!("shaders/texture.wgsl")),
    ("vector.wgsl", include_str!("shaders/vector.wgsl")),
];

/// The built-in files that shaders of scenes are composed of: the skeleton.
pub const SCENE_FILES: [(&str, &str); 3] = [
    ("scene.wgsl", include_str!("shaders/scene.wgsl")),
    ("scene_lighting.wgsl", include_str!("shaders/scene_lighting.wgsl")),
    ("scene_uniforms.wgsl", include_str!("shaders/scene_uniforms.wgsl")),
];

macro_rules! effect_files {
    ($($name:literal)*) => {
        /// The built-in files of the effects, one each.
        pub const EFFECT_FILES: [(&str, &str); [$($name),*].len()] =
            [$((concat!("effects/", $name, ".wgsl"), include_str!(concat!("shaders/effects/", $name, ".wgsl")))),*];
    };
}

effect_files! {
    "flat" "gouraud" "phong" "inverse_transpose" "emissive" "ambient_product" "ambient_constant" "light_ambient"
    "attenuated_ambient" "diffuse" "specular_phong" "specular_blinn" "specular_unnormalised" "local_viewer" "gate"
    "directional" "directional_unit" "point" "spot" "spot_exponent" "attenuation" "vertex_color" "texture_nearest"
    "texture_bilinear" "texture_replace" "lightmap_nearest" "lightmap_bilinear" "cutout" "fog_linear" "fog_exp"
    "fog_exp2_document" "fog_exp2_opengl" "fog_radial"
}

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
    pub fn built_in() -> Result<Self, GpuError> {
        Self::validated(every_file().map(|(name, text)| (name.into(), text.into())).collect())
    }

    /// The built-in files, those of the same name in the folder, and in its folder `effects`, put in their place.
    ///
    /// # Errors
    /// Where the folder cannot be read, holds no WGSL, holds a file of an unknown name, or one that is invalid.
    pub fn from_dir(dir: &Path) -> Result<Self, GpuError> {
        let mut files = Self::built_in()?.files;
        let effects = dir.join("effects");
        let mut replaced = replace(&mut files, dir, "")?;
        if effects.is_dir() {
            replaced += replace(&mut files, &effects, "effects/")?;
        }
        if replaced == 0 {
            let message = "no .wgsl file there; copy gpu/src/shaders and edit the copy";
            return Err(GpuError::Unreadable { path: dir.into(), message: message.into() });
        }
        Self::validated(files)
    }

    fn validated(files: BTreeMap<String, String>) -> Result<Self, GpuError> {
        let shaders = Self { files };
        // A file is reported before those that require it.
        let mut order: Vec<&str> = FILES.into_iter().map(|(name, _)| name).collect();
        order.sort_by_key(|name| shaders.required(name).len());
        for name in order {
            shaders.parse(name)?;
        }
        Composer::new(&shaders)?.check()?;
        Ok(shaders)
    }

    /// The files that one requires, by its `// requires:` line, and those that they require in turn.
    fn required(&self, file: &str) -> Vec<String> {
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

fn every_file() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILES.into_iter().chain(SCENE_FILES).chain(EFFECT_FILES)
}

/// Puts a folder's files in the place of those of the same name, and says how many.
fn replace(files: &mut BTreeMap<String, String>, dir: &Path, prefix: &str) -> Result<usize, GpuError> {
    let unreadable = |path: &Path, message: String| GpuError::Unreadable { path: path.into(), message };
    let mut replaced = 0;
    let entries = std::fs::read_dir(dir).map_err(|error| unreadable(dir, error.to_string()))?;
    for entry in entries {
        let path = entry.map_err(|error| unreadable(dir, error.to_string()))?.path();
        if path.extension().is_none_or(|extension| extension != "wgsl") {
            continue;
        }
        let name = path.file_name().map(|name| format!("{prefix}{}", name.to_string_lossy())).unwrap_or_default();
        let text = std::fs::read_to_string(&path).map_err(|error| unreadable(&path, error.to_string()))?;
        let Some(file) = files.get_mut(&name) else {
            let known: Vec<&str> = every_file().map(|(name, _)| name).collect();
            return Err(unreadable(&path, format!("no such shader; expected one of {}", known.join(", "))));
        };
        *file = text;
        replaced += 1;
    }
    Ok(replaced)
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
        let mut files: BTreeMap<String, String> = every_file().map(|(n, t)| (n.into(), t.into())).collect();
        files.insert("fog.wgsl".into(), "// a\n// b\nfn f() -> f32 {\n    return nothing;\n}\n".into());
        let error = Shaders::validated(files).expect_err("the file is invalid").to_string();
        assert!(error.contains("fog.wgsl:4:12"), "{error}");
    }
}
