//! From JSON to a frame.

use super::field::{At, SceneError};
use super::files::{Files, read};
use super::objects::{self, KnownObjects, Parts};
use super::{camera, library, lights, mesh, texture};
use crate::nearest::did_you_mean;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::model::Scene;
use std::io;
use std::path::Path;

/// Texels of all textures.
const MOST_TEXELS: usize = 1 << 24;
/// Triangles of all meshes, and of all that is drawn.
const MOST_IN_ALL: usize = 4_000_000;
const IN_ALL: &str = "4000000 triangles at most in all";

/// A scene that can be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The name of its file, without the ending.
    pub name: String,
    /// Its title.
    pub title: String,
    /// What is to be seen.
    pub shows: String,
    /// What is drawn.
    pub frame: Frame,
}

/// Loads the scene of that path, or the built-in one of that name.
///
/// # Errors
///
/// Where there is neither, or the scene is refused.
pub fn scene(path_or_name: impl AsRef<Path>) -> Result<Loaded, SceneError> {
    let path = path_or_name.as_ref();
    let Some(given) = path.to_str() else { return file(path) };
    let name = given.strip_prefix("scene/").unwrap_or(given);
    if library::SCENES.iter().any(|(own, _)| *own == name) && !path.is_file() {
        return builtin(name);
    }
    if given.contains(['/', '.', '\\']) || path.exists() {
        return file(path);
    }
    Err(unknown(name))
}

/// Loads a scene from a file.
///
/// # Errors
///
/// Where the file cannot be read, or the scene is refused.
pub fn file(path: &Path) -> Result<Loaded, SceneError> {
    let unreadable = |error| SceneError::File { file: path.display().to_string(), error };
    let json = read(path).map_err(unreadable)?;
    let json = String::from_utf8(json).map_err(|error| unreadable(io::Error::other(error)))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    text(&name, &json, &|file| read(&folder.join(file)))
}

/// Loads a built-in scene.
///
/// # Errors
///
/// Where there is none of that name.
pub fn builtin(name: &str) -> Result<Loaded, SceneError> {
    let (name, json) = library::SCENES.iter().find(|(own, _)| *own == name).ok_or_else(|| unknown(name))?;
    text(name, json, &library::asset)
}

fn unknown(name: &str) -> SceneError {
    let typed = name.strip_prefix("scene/").unwrap_or(name);
    SceneError::Unknown { name: name.to_owned(), meant: did_you_mean(typed, library::SCENES.map(|(own, _)| own)) }
}

/// Loads a scene from JSON. `files` gives the bytes of the files that it names.
///
/// # Errors
///
/// Where the text is not JSON, not of the schema, or holds what is not allowed.
pub fn text(name: &str, json: &str, files: &Files<'_>) -> Result<Loaded, SceneError> {
    let scene = parse(json)?;
    let frame = frame(&scene, files)?;
    Ok(Loaded { name: name.to_owned(), title: scene.title, shows: scene.shows, frame })
}

/// Reads what is authored.
///
/// # Errors
///
/// Where the text is not JSON, or not of the schema.
pub fn parse(json: &str) -> Result<Scene, SceneError> {
    let mut deserializer = serde_json::Deserializer::from_str(json);
    let scene = serde_path_to_error::deserialize(&mut deserializer)
        .map_err(|error| SceneError::Json { path: error.path().to_string(), says: error.inner().to_string() })?;
    deserializer.end().map_err(|error| SceneError::Json { path: ".".into(), says: error.to_string() })?;
    Ok(scene)
}

/// Resolves what is authored.
///
/// # Errors
///
/// Where a field holds what it may not.
pub fn frame(scene: &Scene, files: &Files<'_>) -> Result<Frame, SceneError> {
    let target = camera::target(scene.target)?;
    let view = camera::view(&scene.camera)?;
    let projection = camera::projection(&scene.camera, target)?;
    objects::names(scene)?;

    let at = At::Scene.field("textures");
    let mut textures = vec![];
    let mut texels = 0;
    for (name, image) in scene.textures.iter() {
        textures.push(texture::texture(&at.field(name), image, files)?);
        texels += textures[textures.len() - 1].texels.len();
        at.require(
            texels <= MOST_TEXELS,
            format_args!("a list of {texels} texels or more"),
            "16777216 at most in all",
        )?;
    }
    let surfaces = objects::surfaces(scene)?;

    let at = At::Scene.field("meshes");
    let (mut meshes, mut parts, mut triangles) = (vec![], vec![], 0);
    for (name, mesh) in scene.meshes.iter() {
        let mut of_mesh = Parts::new();
        for part in mesh::parts(&at.field(name), mesh, files, &mut textures)? {
            of_mesh.push((meshes.len(), part.name, part.surface));
            triangles += part.mesh.triangles.len();
            at.require(triangles <= MOST_IN_ALL, format_args!("a list of {triangles} triangles or more"), IN_ALL)?;
            meshes.push(part.mesh);
        }
        parts.push(of_mesh);
    }

    let lights = lights::lights(&scene.lights, &|at, attached| objects::space(at, scene, view, attached))?;
    let known = KnownObjects { scene, view, surfaces: &surfaces, parts: &parts };
    let draws = objects::draws(&known, &mut meshes)?;
    let drawn: usize = draws.iter().map(|draw| meshes[draw.mesh].triangles.len()).sum();
    let at = At::Scene.field("objects");
    at.require(drawn <= MOST_IN_ALL, format_args!("a list that draws {drawn} triangles, with instances"), IN_ALL)?;
    Ok(Frame {
        target,
        background: At::Scene.field("background").numbers(scene.background)?,
        clear_depth: if scene.camera.reversed_depth { 0.0 } else { 1.0 },
        projection,
        ambient: At::Scene.field("ambient").field("color").numbers(scene.ambient.color)?,
        ambient_form: scene.ambient.form,
        departures: lightmeter_scene::frame::Departures::default(),
        light_ambient: scene.light_ambient,
        lights,
        fog: scene.fog.as_ref().map(lights::fog).transpose()?,
        meshes,
        textures,
        draws,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_scene::frame::{Light, Place};

    fn loaded(name: &str) -> Frame {
        builtin(name).expect("the scene is built in").frame
    }

    fn position(light: &Light) -> [f32; 3] {
        match light.place {
            Place::Point { position, .. } | Place::Spot { position, .. } => position,
            Place::Directional { toward, .. } => toward,
        }
    }

    fn close(a: [f32; 3], b: [f32; 3]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5)
    }

    #[test]
    fn lights_stand_in_eye_space() {
        // 003 takes its light's position in eye space; the camera of `missed-highlight` looks along −z from z = 6.
        assert!(close(position(&loaded("phong").lights[0]), [0.0, 3.0, -3.0]));
        assert!(close(position(&loaded("missed-highlight").lights[0]), [-0.9, 0.0, 0.44]));
        assert!(close(position(&loaded("shininess").lights[0]), [4.0, 6.0, -1.0]));
        // By the model: scaled, turned and moved with it, then seen by a camera that looks down at it.
        let json = r#"{
            "title": "", "shows": "",
            "camera": { "eye": [0, 0, 5], "projection": { "perspective": { "fov_y_deg": 45, "near": 1, "far": 10 } } },
            "lights": [{ "kind": "point", "position": [1, 0, 0], "attached": "m" }],
            "meshes": { "m": { "shape": { "quad": {} } } },
            "objects": [{ "mesh": "m", "transform": [
                { "scale": [2, 2, 2] }, { "rotate": { "deg": 90, "axis": [0, 0, 3] } }, { "translate": [0, 0, 1] }
            ] }]
        }"#;
        let frame = text("m", json, &|_| Err(io::ErrorKind::NotFound.into())).expect("a scene").frame;
        assert!(close(position(&frame.lights[0]), [0.0, 2.0, -4.0]), "{:?}", frame.lights);
    }

    #[test]
    fn objects_are_sorted() {
        let names: Vec<String> = loaded("sorted").draws.into_iter().map(|draw| draw.name).collect();
        assert_eq!(names, ["ball", "floor", "leaf[0]", "leaf[1]", "far pane", "middle pane", "near pane"]);
        let written: Vec<String> = loaded("depth-on-off").draws.into_iter().map(|draw| draw.name).collect();
        assert_eq!(written[..2], ["tested ball", "tested block"]);
    }

    #[test]
    fn near_and_far_have_their_depths() {
        for (name, near, far, at_near) in [("phong", 0.1, 100.0, 0.0), ("reversed-depth", 1.0, 20.0, 1.0)] {
            let frame = loaded(name);
            let depth = |z: f32| {
                let row = |r: usize| frame.projection[2][r] * z + frame.projection[3][r];
                row(2) / row(3)
            };
            assert!((depth(-near) - at_near).abs() < 1e-4, "{name}: {}", depth(-near));
            assert!((depth(-far) - (1.0 - at_near)).abs() < 1e-4, "{name}: {}", depth(-far));
            assert!((frame.clear_depth - (1.0 - at_near)).abs() < 1e-6, "{name}");
        }
    }

    #[test]
    #[cfg_attr(not(feature = "scenes"), ignore = "scenes read files of images and meshes")]
    fn an_obj_brings_its_materials() {
        let frame = loaded("obj");
        let draw = |name: &str| frame.draws.iter().find(|draw| draw.name == format!("house/{name}")).expect(name);
        let (walls, windows) = (draw("walls"), draw("windows"));
        assert!(walls.texture.is_some() && draw("roof").texture.is_none());
        assert!(close(windows.material.emissive, [0.7, 0.6, 0.3]));
        assert!((windows.material.shininess - 60.0).abs() < 1e-6);
        // OBJ's v points up: the corner with vt 0 0 is at v = 1.
        assert!(
            frame.meshes[walls.mesh].uvs.contains(&[0.0, 1.0]) && frame.meshes[walls.mesh].uvs.contains(&[3.0, -1.0])
        );
    }

    #[test]
    #[cfg_attr(not(feature = "scenes"), ignore = "scenes read files of images and meshes")]
    fn scenes_have_moderate_meshes() {
        for (name, _) in library::SCENES {
            let frame = loaded(name);
            let triangles: usize = frame.draws.iter().map(|draw| frame.meshes[draw.mesh].triangles.len()).sum();
            assert!((1..=8000).contains(&triangles), "{name} draws {triangles} triangles");
        }
    }
}
