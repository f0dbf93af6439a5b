//! Meshes: what is written is checked, what is generated is made, and normals are made anew where that is asked for.

use super::field::{At, SceneError};
use super::load::Files;
use super::material::Surface;
use super::{normals, obj, shapes};
use lightmeter_scene::frame::{Mesh, Texture};
use lightmeter_scene::model::{self, NormalsFrom, Shape};

/// Vertices of a mesh, at most.
pub(super) const MOST_VERTICES: u64 = 1_000_000;
/// Triangles of a mesh, at most.
pub(super) const MOST_TRIANGLES: u64 = 1_000_000;

/// A mesh, or the part of one that has a material of its own.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Added to the draw's name.
    pub(super) name: String,
    pub(super) mesh: Mesh,
    /// From the file that the mesh is from.
    pub(super) surface: Option<Surface>,
}

/// The parts of a mesh. A file may add to the textures.
pub(super) fn parts(
    at: &At<'_>,
    mesh: &model::Mesh,
    files: &Files<'_>,
    textures: &mut Vec<Texture>,
) -> Result<Vec<Part>, SceneError> {
    let shape = at.field("shape");
    let mut parts = match &mesh.shape {
        Shape::Obj(path) => obj::parts(&shape.field("obj"), path, files, textures)?,
        written @ Shape::Triangles { .. } => {
            vec![Part { name: String::new(), mesh: triangles(&shape.field("triangles"), written)?, surface: None }]
        }
        generated => vec![Part { name: String::new(), mesh: shapes::shape(&shape, generated)?, surface: None }],
    };
    for part in &mut parts {
        match mesh.normals {
            NormalsFrom::Given => {}
            NormalsFrom::Face => part.mesh = normals::of_faces(&at.field("normals"), &part.mesh)?,
            NormalsFrom::Averaged => normals::average(&at.field("normals"), &mut part.mesh)?,
        }
    }
    Ok(parts)
}

/// Triangles as they are written.
fn triangles(at: &At<'_>, shape: &Shape) -> Result<Mesh, SceneError> {
    let Shape::Triangles { positions, normals, uvs, lightmap_uvs, colors, triangles } = shape else {
        return Ok(Mesh::default());
    };
    size(at, positions.len(), triangles.len())?;
    let mesh = Mesh {
        positions: attribute(&at.field("positions"), positions, positions.len())?,
        normals: attribute(&at.field("normals"), normals, positions.len())?,
        uvs: attribute(&at.field("uvs"), uvs, positions.len())?,
        lightmap_uvs: attribute(&at.field("lightmap_uvs"), lightmap_uvs, positions.len())?,
        colors: attribute(&at.field("colors"), colors, positions.len())?,
        triangles: triangles.clone(),
    };
    for (place, normal) in normals.iter().enumerate() {
        at.field("normals").item(place).direction(*normal)?;
    }
    indices(&at.field("triangles"), &mesh)?;
    Ok(mesh)
}

/// Refuses a mesh without triangles, or with too many.
pub(super) fn size(at: &At<'_>, vertices: usize, triangles: usize) -> Result<(), SceneError> {
    let right = (1..=MOST_TRIANGLES).contains(&(triangles as u64)) && vertices as u64 <= MOST_VERTICES;
    let holds = format_args!("has {vertices} vertices and {triangles} triangles");
    let allowed = format_args!("1 to {MOST_TRIANGLES} triangles of up to {MOST_VERTICES} vertices");
    if right { Ok(()) } else { Err(at.refuse(holds, allowed)) }
}

/// Refuses a triangle of a vertex that there is not.
pub(super) fn indices(at: &At<'_>, mesh: &Mesh) -> Result<(), SceneError> {
    let vertices = mesh.positions.len();
    for (place, triangle) in mesh.triangles.iter().enumerate() {
        for (corner, &vertex) in triangle.iter().enumerate() {
            if vertex as usize >= vertices {
                return Err(at.item(place).item(corner).refuse(
                    format_args!("is {vertex}"),
                    format_args!("the place of one of {vertices} vertices, from 0"),
                ));
            }
        }
    }
    Ok(())
}

fn attribute<const N: usize>(at: &At<'_>, values: &[[f64; N]], vertices: usize) -> Result<Vec<[f32; N]>, SceneError> {
    if !values.is_empty() && values.len() != vertices {
        let holds = format_args!("has {} entries", values.len());
        return Err(at.refuse(holds, format_args!("none, or one for each of {vertices} positions")));
    }
    values.iter().enumerate().map(|(place, value)| at.item(place).numbers(*value)).collect()
}
