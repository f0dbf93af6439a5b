//! Triangles over a grid of (u, v) of 0 to 1.
//!
//! Points are computed in f64 and rounded once. Triangles without area, as at a sphere's poles, are left out.

use super::part::{MOST_TRIANGLES, MOST_VERTICES};
use crate::scene::field::{At, SceneError};
use glam::DVec3;
use lightmeter_scene::frame::Mesh;

/// A vertex that a grid makes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub(super) position: DVec3,
    pub(super) normal: DVec3,
    pub(super) uv: [f64; 2],
}

/// Adds the vertices over a grid, and two triangles a cell that are counter-clockwise as seen from where u runs right
/// and v down.
pub(super) fn grid(
    at: &At<'_>,
    mesh: &mut Mesh,
    [columns, rows]: [u32; 2],
    vertex: impl Fn([f64; 2]) -> Vertex,
) -> Result<(), SceneError> {
    let (columns, rows) = (u64::from(columns), u64::from(rows));
    let vertices = mesh.positions.len() as u64 + (columns + 1) * (rows + 1);
    let triangles = mesh.triangles.len() as u64 + 2 * columns * rows;
    if vertices > MOST_VERTICES || triangles > MOST_TRIANGLES {
        let holds = format_args!("makes {vertices} vertices and {triangles} triangles");
        return Err(at.refuse(holds, format_args!("{MOST_VERTICES} and {MOST_TRIANGLES} at most")));
    }
    let first = u32::try_from(mesh.positions.len()).map_err(|_| at.refuse("is too large", "fewer parts"))?;
    let (columns, rows) = (u32::try_from(columns).unwrap_or(0), u32::try_from(rows).unwrap_or(0));
    for row in 0..=rows {
        for column in 0..=columns {
            let Vertex { position, normal, uv } =
                vertex([f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows)]);
            mesh.positions.push(at.numbers(position.into())?);
            mesh.normals.push(at.numbers(normal.into())?);
            mesh.uvs.push(at.numbers(uv)?);
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let upper = first + row * (columns + 1) + column;
            let lower = upper + columns + 1;
            for triangle in [[upper, lower, lower + 1], [upper, lower + 1, upper + 1]] {
                let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
                #[expect(clippy::float_cmp, reason = "a grid's points that meet are made equal")]
                let has_area = a != b && b != c && c != a;
                if has_area {
                    mesh.triangles.push(triangle);
                }
            }
        }
    }
    Ok(())
}
