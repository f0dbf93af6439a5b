//! Meshes: what is written is checked, what is generated is made, and normals are made anew where that is asked for.

mod grid;
mod normals;
#[cfg_attr(not(feature = "scenes"), path = "no_obj.rs")]
mod obj;
mod part;
mod shapes;
mod teapot;
mod written;

use self::part::Part;
use super::field::{At, SceneError};
use super::files::Files;
use lightmeter_scene::frame::Texture;
use lightmeter_scene::model::{self, NormalsFrom, Shape};

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
        given @ Shape::Triangles { .. } => vec![Part::whole(written::triangles(&shape.field("triangles"), given)?)],
        generated => vec![Part::whole(shapes::shape(&shape, generated)?)],
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
