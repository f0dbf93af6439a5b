//! The WGSL files that are built in, and those of a folder in their place: each is valid by itself, and composed with the others.

use crate::compose::Composer;
use crate::error::GpuError;
use crate::shaders::{Shaders, effect_file};
use lightmeter_files::read;
use lightmeter_scene::effects::Effect;
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

impl Shaders {
    /// The files that are built in.
    ///
    /// # Errors
    /// Where one of them is invalid, which a test rules out.
    pub fn built_in() -> Result<Self, GpuError> {
        Self::validated(every_file().map(|(name, text)| (name.into(), text.into())).collect(), &|_| ())
    }

    /// The built-in files, those of the same name in the folder, and in its folder `effects`, put in their place.
    ///
    /// # Errors
    /// Where the folder cannot be read, holds no WGSL, holds a file of an unknown name, or one that is invalid.
    pub fn from_dir(dir: &Path) -> Result<Self, GpuError> {
        Self::from_dir_telling(dir, &|_| ())
    }

    /// The same, which tells each file before it is parsed.
    ///
    /// # Errors
    /// As [`Shaders::from_dir`].
    pub fn from_dir_telling(dir: &Path, under_way: &dyn Fn(&str)) -> Result<Self, GpuError> {
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
        Self::validated(files, under_way)
    }

    /// The names of the files with their texts.
    pub fn texts(&self) -> impl Iterator<Item = (&str, &str)> {
        self.files.iter().map(|(name, text)| (name.as_str(), text.as_str()))
    }

    /// The same files, of which one has another text.
    ///
    /// # Errors
    /// Where there is no file of that name, or one of the files is no longer valid.
    pub fn with(&self, name: &str, text: String) -> Result<Self, GpuError> {
        let mut files = self.files.clone();
        let Some(file) = files.get_mut(name) else {
            let message = "no such shader file".into();
            return Err(GpuError::Unreadable { path: name.into(), message });
        };
        *file = text;
        let shaders = Self { files };
        // What does not have the file in it is as valid as it was.
        let dependent = |other: &str| other == name || shaders.required(other).iter().any(|required| required == name);
        shaders.parse_all(&dependent, &|_| ())?;
        let composer = Composer::new(&shaders)?;
        match Effect::ALL.into_iter().find(|effect| effect_file(*effect) == name) {
            Some(effect) => composer.check_with(effect)?,
            None => composer.check()?,
        }
        Ok(shaders)
    }

    fn validated(files: BTreeMap<String, String>, under_way: &dyn Fn(&str)) -> Result<Self, GpuError> {
        let shaders = Self { files };
        shaders.parse_all(&|_| true, under_way)?;
        under_way("a composed shader of scenes");
        Composer::new(&shaders)?.check()?;
        Ok(shaders)
    }

    /// Validates those of the files that are chosen, each after those that it requires.
    fn parse_all(&self, chosen: &dyn Fn(&str) -> bool, under_way: &dyn Fn(&str)) -> Result<(), GpuError> {
        let mut order: Vec<&str> = FILES.into_iter().map(|(name, _)| name).filter(|name| chosen(name)).collect();
        order.sort_by_key(|name| self.required(name).len());
        for name in order {
            under_way(name);
            self.parse(name)?;
        }
        Ok(())
    }
}

fn every_file() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILES.into_iter().chain(SCENE_FILES).chain(EFFECT_FILES)
}

/// Bytes that a shader's file may have.
const MOST_SHADER: u64 = 4 << 20;

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
        let text = read::text(&path, MOST_SHADER).map_err(|error| unreadable(&path, error.to_string()))?;
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
        let error = Shaders::validated(files, &|_| ()).expect_err("the file is invalid").to_string();
        assert!(error.contains("fog.wgsl:4:12"), "{error}");
    }
}
