//! A mesh, or the part of one that has a material of its own, and how large it may be.

use crate::scene::field::{At, SceneError};
use crate::scene::material::Surface;
use lightmeter_scene::frame::Mesh;

/// Vertices of a mesh, at most.
pub(super) const MOST_VERTICES: u64 = 1_000_000;
/// Triangles of a mesh, at most.
pub(super) const MOST_TRIANGLES: u64 = 1_000_000;

/// A mesh, or the part of one that has a material of its own.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Added to the draw's name.
    pub(crate) name: String,
    pub(crate) mesh: Mesh,
    /// From the file that the mesh is from.
    pub(crate) surface: Option<Surface>,
}

impl Part {
    /// A mesh that is one part, without a material of its own.
    pub(super) const fn whole(mesh: Mesh) -> Self {
        Self { name: String::new(), mesh, surface: None }
    }
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
