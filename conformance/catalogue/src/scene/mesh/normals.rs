//! Normals from the faces: one a face, or averaged at the vertices (004).

use super::part::MOST_VERTICES;
use crate::scene::field::{At, SceneError};
use glam::DVec3;
use lightmeter_scene::frame::Mesh;
use std::collections::HashMap;

/// The mesh with its vertices split, so that each face has its own three with its normal.
pub(super) fn of_faces(at: &At<'_>, mesh: &Mesh) -> Result<Mesh, SceneError> {
    let vertices = 3 * mesh.triangles.len() as u64;
    if vertices > MOST_VERTICES {
        return Err(
            at.refuse(format_args!("is `face`, for {vertices} vertices"), format_args!("{MOST_VERTICES} at most"))
        );
    }
    let corners: Vec<usize> = mesh.triangles.iter().flatten().map(|&vertex| vertex as usize).collect();
    let mut normals = Vec::with_capacity(corners.len());
    for place in 0..mesh.triangles.len() {
        let normal = at.numbers(face(at, mesh, place)?.into())?;
        normals.extend([normal; 3]);
    }
    let count = u32::try_from(corners.len()).map_err(|_| at.refuse("is `face`", "fewer triangles"))?;
    Ok(Mesh {
        positions: split(&mesh.positions, &corners),
        normals,
        uvs: split(&mesh.uvs, &corners),
        lightmap_uvs: split(&mesh.lightmap_uvs, &corners),
        colors: split(&mesh.colors, &corners),
        triangles: (0..count / 3).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect(),
    })
}

/// Gives each vertex the mean of the unit normals of the faces around its position.
pub(super) fn average(at: &At<'_>, mesh: &mut Mesh) -> Result<(), SceneError> {
    // Negative zero is zero.
    let key = |position: [f32; 3]| position.map(|x| (x + 0.0).to_bits());
    let mut sums = HashMap::<[u32; 3], DVec3>::new();
    for (place, triangle) in mesh.triangles.iter().enumerate() {
        let normal = face(at, mesh, place)?;
        for &vertex in triangle {
            *sums.entry(key(mesh.positions[vertex as usize])).or_default() += normal;
        }
    }
    mesh.normals = mesh
        .positions
        .iter()
        .map(|&position| {
            // A vertex of no face has any normal.
            let sum = sums.get(&key(position)).copied().unwrap_or(DVec3::Z);
            let Some(normal) = sum.try_normalize() else {
                let holds = format_args!("is `averaged`, but the faces around {position:?} face opposite ways");
                return Err(at.refuse(holds, "`face`, or normals that are given"));
            };
            at.numbers(normal.into())
        })
        .collect::<Result<_, _>>()?;
    Ok(())
}

fn split<const N: usize>(values: &[[f32; N]], corners: &[usize]) -> Vec<[f32; N]> {
    if values.is_empty() { vec![] } else { corners.iter().map(|&corner| values[corner]).collect() }
}

/// The unit normal of a face, on the side from which it is counter-clockwise.
fn face(at: &At<'_>, mesh: &Mesh, place: usize) -> Result<DVec3, SceneError> {
    let [a, b, c] = mesh.triangles[place].map(|vertex| DVec3::from(mesh.positions[vertex as usize].map(f64::from)));
    (b - a).cross(c - a).try_normalize().ok_or_else(|| {
        at.refuse(format_args!("is made from faces, and triangle {place} has no area"), "triangles with an area")
    })
}
