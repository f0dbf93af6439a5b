//! A draw with its triangles, and what rasterisers may make of each.

use super::bound::{Bound, VertexErrors};
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_reference::interpolation::{self, Viewport};
use lightmeter_reference::render::{Geometry, Scratch, Shader};
use lightmeter_reference::{Vec4, Vector};
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::{Draw, Frame};
use lightmeter_scene::raster::Provoking;
use rayon::prelude::*;
use std::collections::HashMap;

/// A draw with its triangles and what may become of each.
pub(super) struct Prepared<'a> {
    pub(super) draw: &'a Draw,
    pub(super) shader: Shader<'a, Accept>,
    pub(super) geometry: Geometry,
    pub(super) bounds: Vec<Bound>,
    pub(super) slacks: Vec<f64>,
    /// Draws of one number have the same depths, triangle by triangle.
    pub(super) place: usize,
}

/// A vertex: clip coordinates and attributes, and what they and its place in the window may be off by.
struct Shaded {
    clip: [f64; 4],
    off_clip: [f64; 4],
    place: [f64; 4],
    attributes: Vec<f64>,
    off: Vec<f64>,
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
        let stride = shader.attributes.count;
        let mut geometry = Geometry { stride, ..Geometry::default() };
        let mut errors = VertexErrors { stride, ..VertexErrors::default() };
        let mut identities = HashMap::new();
        for (vertex, position) in vertices.into_iter().zip(&mesh.positions) {
            geometry.clip.push(vertex.clip);
            errors.clips.push(vertex.off_clip);
            geometry.numbers.extend(vertex.attributes);
            let next = identities.len() as u64;
            geometry.identities.push(*identities.entry(position.map(f32::to_bits)).or_insert(next));
            errors.places.push(vertex.place);
            errors.attributes.extend(vertex.off);
        }
        let provoking = draw.shading.map_or(Provoking::First, |shading| shading.provoking);
        let size = [frame.target.width, frame.target.height];
        geometry.assemble(&mesh.triangles, |of| interpolation::flat(of, provoking), size, draw.cull);
        errors.extend(&geometry, size.map(f64::from));
        let mut slacks = vec![];
        let bounds = geometry
            .triangles
            .iter()
            .map(|triangle| Bound::new(triangle, &geometry, &errors, &shader.attributes, step, &mut slacks))
            .collect();
        Self { draw, shader, geometry, bounds, slacks, place: number }
    }
}

fn shaded(exact: &Shader<'_, f64>, legal: &Shader<'_, Accept>, vertex: usize, size: [f64; 2]) -> Shaded {
    let (mut attributes, mut intervals) = (vec![], vec![]);
    let clip = exact.vertex(vertex, &mut Scratch::default(), &mut attributes);
    let legal_clip = legal.vertex(vertex, &mut Scratch::default(), &mut intervals);
    let off = |value: f64, legal: &Accept| (legal.high() - value).max(value - legal.low());
    let slack = attributes.iter().zip(&intervals).map(|(&value, legal)| off(value, legal)).collect();
    let off_clip = std::array::from_fn(|k| off(clip[k], &legal_clip[k]));
    Shaded { clip: clip.0, off_clip, place: place(clip, legal_clip, size), attributes, off: slack }
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
    let off = |k: usize| (legal_window[k].high() - window[k]).max(window[k] - legal_window[k].low());
    let w = legal.w();
    let inverse_w = (w.high() / exact.w() - 1.0).max(1.0 - w.low() / exact.w());
    [off(0), off(1), off(2), inverse_w]
}
