//! Wavefront OBJ and MTL. Texture coordinates point up there and down here.
//!
//! Of an MTL, Ka Kd Ks Ke Ns d and map_Kd are the material; what it leaves out is as in a material of a scene. The
//! files that an OBJ names lie in its own folder.

use super::part::{Part, indices, size};
use crate::scene::field::{At, SceneError};
use crate::scene::files::Files;
use crate::scene::material::{Surface, of_file};
use crate::scene::texture;
use lightmeter_scene::frame::{Mesh, Texture};
use std::collections::HashMap;
use std::io::BufReader;
use std::path::Path;

/// Triangles of the file, by its groups and materials.
pub(super) fn parts(
    at: &At<'_>,
    path: &str,
    files: &Files<'_>,
    textures: &mut Vec<Texture>,
) -> Result<Vec<Part>, SceneError> {
    let unreadable = |path: &str, error: &dyn std::fmt::Display| {
        at.refuse(format_args!("is `{path}`, which cannot be read: {error}"), "an OBJ with its MTL")
    };
    let bytes = files(path).map_err(|error| unreadable(path, &error))?;
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..tobj::LoadOptions::default() };
    let missing = std::cell::RefCell::new(None);
    let library = |name: &Path| {
        let path = beside(path, &name.to_string_lossy());
        let bytes = files(&path).map_err(|error| {
            *missing.borrow_mut() = Some(unreadable(&path, &error));
            tobj::LoadError::OpenFileFailed
        })?;
        if let Some(problem) = broken_color(&bytes) {
            *missing.borrow_mut() = Some(unreadable(&path, &problem));
            return Err(tobj::LoadError::MaterialParseError);
        }
        tobj::load_mtl_buf(&mut BufReader::new(bytes.as_slice()))
    };
    let (models, materials) = tobj::load_obj_buf(&mut BufReader::new(bytes.as_slice()), &options, library)
        .map_err(|error| unreadable(path, &error))?;
    if let Some(error) = missing.into_inner() {
        return Err(error);
    }
    let materials = materials.map_err(|error| unreadable(path, &error))?;
    let vertices = models.iter().map(|model| model.mesh.positions.len() / 3).sum();
    size(at, vertices, models.iter().map(|model| model.mesh.indices.len() / 3).sum())?;

    let mut images = HashMap::new();
    let mut surfaces = vec![];
    for material in &materials {
        surfaces.push(surface(at, path, material, files, textures, &mut images)?);
    }
    let parts = models.into_iter().filter(|model| !model.mesh.indices.is_empty());
    parts
        .map(|model| {
            let surface = model.mesh.material_id.and_then(|place| surfaces.get(place)).copied();
            Ok(Part { name: model.name, mesh: mesh(at, &model.mesh)?, surface })
        })
        .collect()
}

/// What is wrong with the first colour of an MTL that has too few numbers, at which the library that reads it panics.
fn broken_color(mtl: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(mtl);
    let broken = |(number, line): (usize, &str)| {
        let mut words = line.split_whitespace();
        let keyword = words.next().filter(|word| ["Ka", "Kd", "Ks", "Ke"].contains(word))?;
        let numbers = words.count();
        (numbers < 3).then(|| format!("line {} has {numbers} numbers after {keyword}; expected 3", number + 1))
    };
    text.lines().enumerate().find_map(broken)
}

fn mesh(at: &At<'_>, from: &tobj::Mesh) -> Result<Mesh, SceneError> {
    let uvs: Vec<[f32; 2]> = attribute(at, &from.texcoords)?;
    let colors: Vec<[f32; 3]> = attribute(at, &from.vertex_color)?;
    let mesh = Mesh {
        positions: attribute(at, &from.positions)?,
        normals: attribute(at, &from.normals)?,
        uvs: uvs.into_iter().map(|[u, v]| [u, 1.0 - v]).collect(),
        lightmap_uvs: vec![],
        colors: colors.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect(),
        triangles: from.indices.as_chunks().0.to_vec(),
    };
    let vertices = mesh.positions.len();
    for (what, count) in
        [("normals", mesh.normals.len()), ("texture coordinates", mesh.uvs.len()), ("colours", mesh.colors.len())]
    {
        if count != 0 && count != vertices {
            let holds = format_args!("has {count} {what} at {vertices} vertices");
            return Err(at.refuse(holds, "faces all of which have them, or none"));
        }
    }
    if mesh.normals.contains(&[0.0; 3]) {
        return Err(at.refuse("has a normal that is 0", "normals of any other length"));
    }
    indices(at, &mesh)?;
    Ok(mesh)
}

fn attribute<const N: usize>(at: &At<'_>, values: &[f32]) -> Result<Vec<[f32; N]>, SceneError> {
    match values.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(at.refuse(format_args!("holds {x}"), "finite numbers")),
        None => Ok(values.as_chunks().0.to_vec()),
    }
}

fn surface(
    at: &At<'_>,
    path: &str,
    from: &tobj::Material,
    files: &Files<'_>,
    textures: &mut Vec<Texture>,
    images: &mut HashMap<String, usize>,
) -> Result<Surface, SceneError> {
    let mut surface = Surface::WHITE;
    let number = |name: &str, x: f32, allowed: &str, right: bool| {
        let holds = format_args!("has a material `{}` with {name} {x}", from.name);
        if right && x.is_finite() { Ok(x) } else { Err(at.refuse(holds, allowed)) }
    };
    let material = &mut surface.material;
    for (name, to, given) in [
        ("Ka", &mut material.ambient, from.ambient),
        ("Kd", &mut material.diffuse, from.diffuse),
        ("Ks", &mut material.specular, from.specular),
        ("Ke", &mut material.emissive, from.emissive),
    ] {
        for (to, x) in to.iter_mut().zip(given.into_iter().flatten()) {
            *to = number(name, x, "finite numbers", true)?;
        }
    }
    if let Some(ns) = from.shininess {
        material.shininess = number("Ns", ns, "a number that is 0 or above", ns >= 0.0)?;
    }
    if let Some(d) = from.dissolve {
        surface.opacity = number("d", d, "a number from 0 to 1", (0.0..=1.0).contains(&d))?;
    }
    if let Some(image) = &from.diffuse_texture {
        let image = beside(path, image);
        let place = match images.get(&image) {
            Some(&place) => place,
            None => {
                textures.push(texture::from_file(at, &image, files)?);
                images.insert(image, textures.len() - 1);
                textures.len() - 1
            }
        };
        surface.texture = Some(of_file(place));
    }
    Ok(surface)
}

/// A file in the folder of another.
fn beside(path: &str, name: &str) -> String {
    match path.rsplit_once('/') {
        Some((folder, _)) => format!("{folder}/{name}"),
        None => name.to_owned(),
    }
}
