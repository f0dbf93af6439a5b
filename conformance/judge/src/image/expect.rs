//! The legal values of every pixel of a frame.

use super::bound::{Bound, VertexErrors};
use super::pixel::{Candidate, Painter};
use crate::blend_unit::pixel::Units;
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_reference::interpolation::{self, Viewport};
use lightmeter_reference::render::{Geometry, Scratch, Shader};
use lightmeter_reference::{Vec4, Vector};
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::{Draw, Frame};
use lightmeter_scene::raster::Provoking;
use lightmeter_scene::stage::Intermediate;
use lightmeter_scene::target::TargetFormat;
use rayon::prelude::*;
use std::collections::HashMap;

/// Pixels of a tile's side.
const TILE: usize = 16;

/// What a pixel may hold, in the units of its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// The least legal value of each component.
    pub low: Units,
    /// The greatest.
    pub high: Units,
    /// Whether its coverage, its depth's winner or another condition is open, and the outcomes differ by more than twice the
    /// widest of them.
    pub is_marked: bool,
}

/// A frame prepared for the legal values of its pixels.
pub struct Expectation<'a> {
    frame: &'a Frame,
    stage: Option<Intermediate>,
    profile: Profile,
    draws: Vec<Prepared<'a>>,
    bins: Vec<Vec<(u32, u32)>>,
    columns: usize,
}

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

impl<'a> Expectation<'a> {
    /// Prepares a frame to be judged by a profile: everything that it names, or what is called for
    /// only; its colours, or an intermediate result.
    #[must_use]
    pub fn new(frame: &'a Frame, only: Option<&'a [Called]>, stage: Option<Intermediate>, profile: &Profile) -> Self {
        profile.scope(|| Self::prepared(frame, only, stage, profile))
    }

    fn prepared(frame: &'a Frame, only: Option<&'a [Called]>, stage: Option<Intermediate>, profile: &Profile) -> Self {
        let steps = f64::from(2.0_f32).powi(-i32::try_from(profile.subpixel_bits).unwrap_or(0));
        let mut draws: Vec<Prepared<'a>> = vec![];
        for number in 0..frame.draws.len() {
            let called = only.map(|called| &called[number]);
            let mut prepared = Prepared::new(frame, number, called, stage.is_some(), steps, profile);
            let same = |other: &&Prepared<'_>| {
                other.draw.mesh == prepared.draw.mesh && other.draw.modelview == prepared.draw.modelview
            };
            prepared.place = draws.iter().find(same).map_or(number, |other| other.place);
            draws.push(prepared);
        }
        let (columns, bins) = bins(&draws, [frame.target.width, frame.target.height]);
        Self { frame, stage, profile: *profile, draws, bins, columns }
    }

    /// The format of the image.
    #[must_use]
    pub const fn format(&self) -> TargetFormat {
        if self.stage.is_some() { TargetFormat::Rgba32Float } else { self.frame.target.format }
    }

    /// Every pixel, row after row.
    #[must_use]
    pub fn pixels(&self) -> Vec<Expected> {
        let (width, height) = (self.frame.target.width as usize, self.frame.target.height as usize);
        let tiles: Vec<Vec<Expected>> =
            (0..self.bins.len()).into_par_iter().map(|tile| self.profile.scope(|| self.tile(tile))).collect();
        let blank = Expected { low: [0.0; 4], high: [0.0; 4], is_marked: false };
        let mut pixels = vec![blank; width * height];
        for (number, tile) in tiles.iter().enumerate() {
            let [left, top] = self.origin(number);
            let span = TILE.min(width - left);
            for (row, expected) in tile.chunks(span).enumerate() {
                let start = (top + row) * width + left;
                pixels[start..start + span].copy_from_slice(expected);
            }
        }
        pixels
    }

    /// One pixel.
    #[must_use]
    pub fn pixel(&self, x: usize, y: usize) -> Expected {
        self.profile.scope(|| {
            let bin = &self.bins[y / TILE * self.columns + x / TILE];
            let mut candidates = vec![];
            for &of in bin {
                candidates.extend(self.candidate(of, x, y));
            }
            Painter::new(self.frame, &self.draws, self.stage).pixel(&candidates)
        })
    }

    const fn origin(&self, tile: usize) -> [usize; 2] {
        [tile % self.columns * TILE, tile / self.columns * TILE]
    }

    fn tile(&self, number: usize) -> Vec<Expected> {
        let [left, top] = self.origin(number);
        let right = (left + TILE).min(self.frame.target.width as usize);
        let bottom = (top + TILE).min(self.frame.target.height as usize);
        let mut candidates: Vec<Vec<Candidate>> = vec![vec![]; (right - left) * (bottom - top)];
        for &(draw, triangle) in &self.bins[number] {
            let [columns, rows] = self.reach((draw, triangle));
            for y in rows[0].max(top)..(rows[1] + 1).min(bottom) {
                for x in columns[0].max(left)..(columns[1] + 1).min(right) {
                    let pixel = (y - top) * (right - left) + x - left;
                    candidates[pixel].extend(self.candidate((draw, triangle), x, y));
                }
            }
        }
        let mut painter = Painter::new(self.frame, &self.draws, self.stage);
        candidates.iter().map(|candidates| painter.pixel(candidates)).collect()
    }

    /// The pixels that a triangle may cover.
    fn reach(&self, (draw, triangle): (u32, u32)) -> [[usize; 2]; 2] {
        let draw = &self.draws[draw as usize];
        let [dx, dy] = draw.bounds[triangle as usize].reach;
        let size = [self.frame.target.width, self.frame.target.height];
        draw.geometry.triangles[triangle as usize].pixels(dx.max(dy), size)
    }

    fn candidate(&self, (draw, number): (u32, u32), x: usize, y: usize) -> Option<Candidate> {
        let prepared = &self.draws[draw as usize];
        let (triangle, bound) = (&prepared.geometry.triangles[number as usize], &prepared.bounds[number as usize]);
        let edges = triangle.edges([middle(x), middle(y)]);
        let is_open = |k: usize| edges[k].abs() <= bound.margins[k];
        if (0..3).any(|k| edges[k] < -bound.margins[k]) {
            return None;
        }
        let open = [is_open(0), is_open(1), is_open(2)];
        Some(Candidate { draw, triangle: number, edges, open, covers: triangle.covers(edges) })
    }
}

/// The legal values of every pixel of a frame, by a profile.
#[must_use]
pub fn expect(frame: &Frame, only: Option<&[Called]>, stage: Option<Intermediate>, profile: &Profile) -> Vec<Expected> {
    Expectation::new(frame, only, stage, profile).pixels()
}

fn middle(pixel: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "within a target's size")]
    let pixel = pixel as f64;
    pixel + 0.5
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
    fn new(
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

/// The triangles that each tile may hold a part of, in the order of drawing.
fn bins(draws: &[Prepared<'_>], size: [u32; 2]) -> (usize, Vec<Vec<(u32, u32)>>) {
    let [columns, rows] = size.map(|pixels| (pixels as usize).div_ceil(TILE));
    let mut bins = vec![vec![]; columns * rows];
    let number = |place: usize| u32::try_from(place).expect("a loader refuses meshes of more triangles");
    for (draw, prepared) in draws.iter().enumerate() {
        for (place, triangle) in prepared.geometry.triangles.iter().enumerate() {
            let [dx, dy] = prepared.bounds[place].reach;
            let [[left, right], [top, bottom]] = triangle.pixels(dx.max(dy), size);
            if right < left || bottom < top {
                continue;
            }
            for row in top / TILE..=bottom / TILE {
                for column in left / TILE..=right / TILE {
                    bins[row * columns + column].push((number(draw), number(place)));
                }
            }
        }
    }
    (columns, bins)
}
