//! Triangles that a scene writes out.

use super::part::{indices, size};
use crate::scene::field::{At, SceneError};
use lightmeter_scene::frame::Mesh;
use lightmeter_scene::model::Shape;

/// Triangles as they are written.
pub(super) fn triangles(at: &At<'_>, shape: &Shape) -> Result<Mesh, SceneError> {
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

fn attribute<const N: usize>(at: &At<'_>, values: &[[f64; N]], vertices: usize) -> Result<Vec<[f32; N]>, SceneError> {
    if !values.is_empty() && values.len() != vertices {
        let holds = format_args!("has {} entries", values.len());
        return Err(at.refuse(holds, format_args!("none, or one for each of {vertices} positions")));
    }
    values.iter().enumerate().map(|(place, value)| at.item(place).numbers(*value)).collect()
}
