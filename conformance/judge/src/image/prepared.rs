//! A draw with its triangles, and what rasterisers may make of each.

use super::bound::{Outline, Surface, VertexErrors, off};
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_reference::interpolation::{self, Viewport};
use lightmeter_reference::render::{Geometry, Scratch, Shader};
use lightmeter_reference::{Vec4, Vector};
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::{Draw, Frame};
use lightmeter_scene::raster::Provoking;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::OnceLock;

/// A draw with its triangles and what may become of each.
pub(super) struct Prepared<'a> {
    pub(super) draw: &'a Draw,
    pub(super) shader: Shader<'a, Accept>,
    pub(super) geometry: Geometry,
    pub(super) outlines: Vec<Outline>,
    /// Of those triangles alone that a pixel has asked for.
    surfaces: Vec<OnceLock<Surface>>,
    errors: VertexErrors,
    /// Draws of one number have the same depths, triangle by triangle.
    pub(super) place: usize,
}

/// A vertex: clip coordinates and attributes, legal places in eye space, and what its clip coordinates and its place in the window
/// may be off by.
struct Shaded {
    clip: [f64; 4],
    attributes: Vec<f64>,
    eye: Vec4<Accept>,
    off_clip: [f64; 4],
    off_place: [f64; 4],
}

impl<'a> Prepared<'a> {
    /// Prepares the draw of that number.
    pub(super) fn new(
        frame: &'a Frame,
        number: usize,
        only: Option<&'a Called>,
        stages: bool,
        step: f64,
        profile: &Profile,
    ) -> Self {
        let draw = &frame.draws[number];
        let mesh = &frame.meshes[draw.mesh];
        let exact = Shader::<f64>::new(frame, number, only, stages);
        let shader = Shader::<Accept>::new(frame, number, only, stages);
        let size = [frame.target.width, frame.target.height].map(f64::from);
        let vertices: Vec<Shaded> = (0..mesh.positions.len())
            .into_par_iter()
            .map(|vertex| profile.scope(|| shaded(&exact, &shader, vertex, size)))
            .collect();
        let mut geometry = Geometry { stride: shader.attributes.count, ..Geometry::default() };
        let mut errors = VertexErrors::default();
        let mut identities = HashMap::new();
        for (vertex, position) in vertices.into_iter().zip(&mesh.positions) {
            geometry.clip.push(vertex.clip);
            geometry.numbers.extend(vertex.attributes);
            let next = identities.len() as u64;
            geometry.identities.push(*identities.entry(position.map(f32::to_bits)).or_insert(next));
            errors.eyes.push(vertex.eye);
            errors.clips.push(vertex.off_clip);
            errors.places.push(vertex.off_place);
        }
        let provoking = draw.shading.map_or(Provoking::First, |shading| shading.provoking);
        let pixels = [frame.target.width, frame.target.height];
        geometry.assemble(&mesh.triangles, |of| interpolation::flat(of, provoking), pixels, draw.cull);
        errors.extend(&geometry, size);
        let outlines =
            geometry.triangles.iter().map(|triangle| Outline::new(triangle, &geometry, &errors, step)).collect();
        let surfaces = geometry.triangles.iter().map(|_| OnceLock::new()).collect();
        Self { draw, shader, geometry, outlines, surfaces, errors, place: number }
    }

    /// What the triangle of that number may show, by the profile in force, which must be that of [`Prepared::new`]. Not to be called first where
    /// [`paths`](lightmeter_arithmetic::paths) are followed: its own would be among them.
    pub(super) fn surface(&self, number: usize) -> &Surface {
        self.surfaces[number].get_or_init(|| {
            let of = (&self.geometry.triangles[number], &self.outlines[number]);
            Surface::new(of, &self.geometry, &self.errors, &self.shader)
        })
    }
}

fn shaded(exact: &Shader<'_, f64>, legal: &Shader<'_, Accept>, vertex: usize, size: [f64; 2]) -> Shaded {
    let mut attributes = Vec::with_capacity(exact.attributes.count);
    let clip = exact.vertex(vertex, &mut Scratch::default(), &mut attributes);
    let eye = legal.eye(vertex);
    let legal_clip = legal.clip(eye);
    let off_clip = std::array::from_fn(|k| off(clip[k], &legal_clip[k]));
    Shaded { clip: clip.0, attributes, eye, off_clip, off_place: place(clip, legal_clip, size) }
}

/// What a vertex's place in the window may be off by: x, y, depth, and 1/w relatively.
fn place(exact: Vec4<f64>, legal: Vec4<Accept>, [width, height]: [f64; 2]) -> [f64; 4] {
    let to = Viewport { origin: Vector([0.0; 2]), size: Vector([width, height]), depth: Vector([0.0, 1.0]) };
    let number = Accept::exactly;
    let legal_to =
        Viewport { origin: to.origin.map_to(number), size: to.size.map_to(number), depth: to.depth.map_to(number) };
    if exact.w() <= 0.0 {
        // Behind the eye there is no place; what clipping makes of it errs by its own rounding.
        return [0.0; 4];
    }
    let (window, legal_window) = (interpolation::viewport(exact, &to), interpolation::viewport(legal, &legal_to));
    let off = |k: usize| off(window[k], &legal_window[k]);
    let w = legal.w();
    let inverse_w = (w.high() / exact.w() - 1.0).max(1.0 - w.low() / exact.w());
    [off(0), off(1), off(2), inverse_w]
}
