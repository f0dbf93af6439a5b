//! Shapes that the project generates, each from grids over (u, v) of 0 to 1, with normals and texture coordinates.

use super::grid::{Vertex, grid};
use super::teapot;
use crate::scene::field::{At, SceneError};
use glam::DVec3;
use lightmeter_scene::frame::Mesh;
use lightmeter_scene::model::Shape;
use std::f64::consts::TAU;

/// The mesh of a generated shape.
pub(super) fn shape(at: &At<'_>, shape: &Shape) -> Result<Mesh, SceneError> {
    let mut mesh = Mesh::default();
    match *shape {
        Shape::Triangles { .. } | Shape::Obj(_) => {}
        Shape::Quad { size, steps, repeat } => {
            let at = at.field("quad");
            rectangle(&at, &mut mesh, size, steps, repeat, |[x, y]| (DVec3::new(x, y, 0.0), DVec3::Z))?;
        }
        Shape::Plane { size, steps, repeat } => {
            let at = at.field("plane");
            rectangle(&at, &mut mesh, size, steps, repeat, |[x, y]| (DVec3::new(x, 0.0, -y), DVec3::Y))?;
        }
        Shape::Cube { size, steps } => cube(&at.field("cube"), &mut mesh, size, steps)?,
        Shape::Sphere { radius, rings, segments } => sphere(&at.field("sphere"), &mut mesh, radius, rings, segments)?,
        Shape::Disc { radius, segments } => {
            let at = at.field("disc");
            at.field("radius").positive(radius)?;
            parts(&at, "segments", segments, 3)?;
            disc(&at, &mut mesh, segments, |x, y| (DVec3::new(x * radius, y * radius, 0.0), DVec3::Z))?;
        }
        Shape::Cylinder { radius, height, segments } => {
            cylinder(&at.field("cylinder"), &mut mesh, radius, height, segments)?;
        }
        Shape::Torus { radius, tube, rings, segments } => {
            torus(&at.field("torus"), &mut mesh, [radius, tube], rings, segments)?;
        }
        Shape::Teapot { steps } => {
            let at = at.field("teapot");
            parts(&at, "steps", steps, 1)?;
            for patch in teapot::patches() {
                grid(&at, &mut mesh, [steps; 2], |[u, v]| patch.vertex(u, v))?;
            }
        }
    }
    Ok(mesh)
}

/// A point of the unit circle about the y axis, counter-clockwise as seen from above; exact at its quarters.
fn ring(u: f64) -> DVec3 {
    let (sin, cos) = turn(u);
    DVec3::new(cos, 0.0, -sin)
}

/// Sine and cosine of a share of a turn; exact at its quarters, so that seams close.
fn turn(u: f64) -> (f64, f64) {
    let quarters = 4.0 * u;
    for (quarter, exact) in
        [(0.0, (0.0, 1.0)), (1.0, (1.0, 0.0)), (2.0, (0.0, -1.0)), (3.0, (-1.0, 0.0)), (4.0, (0.0, 1.0))]
    {
        if f64::total_cmp(&quarters, &quarter).is_eq() {
            return exact;
        }
    }
    (TAU * u).sin_cos()
}

fn parts(at: &At<'_>, name: &str, count: u32, least: u32) -> Result<(), SceneError> {
    at.field(name).require((least..=1024).contains(&count), count, &format!("{least} to 1024 parts"))
}

/// A rectangle about the origin; `place` puts a point of the plane, y up, into space.
fn rectangle(
    at: &At<'_>,
    mesh: &mut Mesh,
    size: [f64; 2],
    steps: [u32; 2],
    repeat: [f64; 2],
    place: impl Fn([f64; 2]) -> (DVec3, DVec3),
) -> Result<(), SceneError> {
    for k in 0..2 {
        at.field("size").item(k).positive(size[k])?;
        at.field("steps").item(k).require((1..=1024).contains(&steps[k]), steps[k], "1 to 1024 parts")?;
        at.field("repeat").item(k).number(repeat[k])?;
    }
    let vertex = |[u, v]: [f64; 2], uv| {
        let (position, normal) = place([size[0] * (u - 0.5), size[1] * (0.5 - v)]);
        Vertex { position, normal, uv }
    };
    grid(at, mesh, steps, |[u, v]| vertex([u, v], [u * repeat[0], v * repeat[1]]))?;
    // A lightmap lies on the whole once.
    let mut once = Mesh::default();
    grid(at, &mut once, steps, |uv| vertex(uv, uv))?;
    mesh.lightmap_uvs = once.uvs;
    Ok(())
}

fn cube(at: &At<'_>, mesh: &mut Mesh, size: f64, steps: u32) -> Result<(), SceneError> {
    at.field("size").positive(size)?;
    parts(at, "steps", steps, 1)?;
    for [right, up] in [
        [DVec3::X, DVec3::Y],
        [DVec3::NEG_X, DVec3::Y],
        [DVec3::NEG_Z, DVec3::Y],
        [DVec3::Z, DVec3::Y],
        [DVec3::X, DVec3::NEG_Z],
        [DVec3::X, DVec3::Z],
    ] {
        let normal = right.cross(up);
        grid(at, mesh, [steps; 2], |[u, v]| {
            let position = (normal + right * (2.0 * u - 1.0) + up * (1.0 - 2.0 * v)) * (size / 2.0);
            Vertex { position, normal, uv: [u, v] }
        })?;
    }
    let channel = |x: f32| at.number(f64::from(x) / size + 0.5);
    for &[x, y, z] in &mesh.positions {
        mesh.colors.push([channel(x)?, channel(y)?, channel(z)?, 1.0]);
    }
    Ok(())
}

fn sphere(at: &At<'_>, mesh: &mut Mesh, radius: f64, rings: u32, segments: u32) -> Result<(), SceneError> {
    at.field("radius").positive(radius)?;
    parts(at, "rings", rings, 2)?;
    parts(at, "segments", segments, 3)?;
    grid(at, mesh, [segments, rings], |[u, v]| {
        let (sin, cos) = turn(v / 2.0);
        let normal = ring(u) * sin + DVec3::Y * cos;
        Vertex { position: normal * radius, normal, uv: [u, v] }
    })
}

/// A cylinder about the y axis: its side and its two ends.
fn cylinder(at: &At<'_>, mesh: &mut Mesh, radius: f64, height: f64, segments: u32) -> Result<(), SceneError> {
    at.field("radius").positive(radius)?;
    at.field("height").positive(height)?;
    parts(at, "segments", segments, 3)?;
    grid(at, mesh, [segments, 1], |[u, v]| {
        let position = ring(u) * radius + DVec3::Y * height * (0.5 - v);
        Vertex { position, normal: ring(u), uv: [u, v] }
    })?;
    for y in [DVec3::Y, DVec3::NEG_Y] {
        let end = |x: f64, z: f64| (DVec3::new(x * radius, 0.0, -z * radius * y.y) + y * height / 2.0, y);
        disc(at, mesh, segments, end)?;
    }
    Ok(())
}

/// A torus about the y axis, of the radius of the tube's middle and of the tube.
fn torus(at: &At<'_>, mesh: &mut Mesh, [radius, tube]: [f64; 2], rings: u32, segments: u32) -> Result<(), SceneError> {
    at.field("radius").positive(radius)?;
    at.field("tube").positive(tube)?;
    parts(at, "rings", rings, 3)?;
    parts(at, "segments", segments, 3)?;
    grid(at, mesh, [segments, rings], |[u, v]| {
        let (sin, cos) = turn(v);
        let normal = ring(u) * cos - DVec3::Y * sin;
        Vertex { position: ring(u) * radius + normal * tube, normal, uv: [u, v] }
    })
}

/// A disc of a fan of triangles; `place` puts a point of the unit disc, y up, into space.
fn disc(
    at: &At<'_>,
    mesh: &mut Mesh,
    segments: u32,
    place: impl Fn(f64, f64) -> (DVec3, DVec3),
) -> Result<(), SceneError> {
    grid(at, mesh, [segments, 1], |[u, v]| {
        let (sin, cos) = turn(u);
        let (position, normal) = place(cos * v, sin * v);
        Vertex { position, normal, uv: [0.5 + cos * v / 2.0, 0.5 - sin * v / 2.0] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    fn all() -> Vec<(&'static str, Mesh)> {
        [
            ("quad", "{}"),
            ("plane", r#"{"steps": [3, 2], "repeat": [4, 4]}"#),
            ("cube", r#"{"steps": 3}"#),
            ("sphere", r#"{"rings": 7, "segments": 9}"#),
            ("disc", r#"{"segments": 7}"#),
            ("cylinder", r#"{"segments": 9}"#),
            ("torus", r#"{"rings": 7, "segments": 9}"#),
            ("teapot", r#"{"steps": 5}"#),
        ]
        .map(|(name, fields)| {
            let written = format!("{{\"{name}\": {fields}}}");
            let written: Shape = serde_json::from_str(&written).expect("a shape");
            (name, shape(&At::Scene, &written).expect("a mesh"))
        })
        .into()
    }

    #[test]
    fn fronts_are_where_normals_point() {
        for (name, mesh) in all() {
            let point = |vertex: u32| DVec3::from(mesh.positions[vertex as usize].map(f64::from));
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(point);
                let face = (b - a).cross(c - a).normalize();
                let mean: DVec3 = triangle.iter().map(|&v| DVec3::from(mesh.normals[v as usize].map(f64::from))).sum();
                assert!(face.dot(mean) > 0.0, "{name}: {triangle:?} at {a}");
            }
            assert!(
                mesh.normals.iter().all(|&n| (DVec3::from(n.map(f64::from)).length() - 1.0).abs() < 1e-6),
                "{name}"
            );
            assert_eq!((mesh.normals.len(), mesh.uvs.len()), (mesh.positions.len(), mesh.positions.len()), "{name}");
        }
    }

    #[test]
    fn closed_shapes_have_each_edge_once_each_way() {
        for (name, mesh) in all() {
            if !["cube", "sphere", "cylinder", "torus"].contains(&name) {
                continue;
            }
            let point = |vertex: u32| mesh.positions[vertex as usize].map(|x| (x + 0.0).to_bits());
            let mut edges = HashMap::new();
            for &[a, b, c] in &mesh.triangles {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *edges.entry((point(from), point(to))).or_insert(0) += 1;
                }
            }
            for ((from, to), count) in &edges {
                assert_eq!((*count, edges.get(&(*to, *from))), (1, Some(&1)), "{name}");
            }
        }
    }
}
