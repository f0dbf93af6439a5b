//! A frame drawn in a plain arithmetic: tiles side by side, within each what is drawn in its order.

use super::attributes::MOST;
use super::raster::{Geometry, Triangle, plain};
use super::shader::{Scratch, Shader};
use crate::algebra::{Rgba, Vector};
use crate::blend::{Operands, Saturate, blend_separate};
use crate::depth::passes;
use crate::interpolation;
use crate::real::Real;
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::{Draw, Frame};
use lightmeter_scene::raster::Provoking;
use lightmeter_scene::stage::Intermediate;
use rayon::prelude::*;
use std::collections::HashMap;

/// Pixels of a tile's side.
const TILE: usize = 32;

/// An image: linear colours, top row first. Nothing is rounded to the target's format yet.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels.
    pub width: usize,
    /// Pixels.
    pub height: usize,
    /// Row after row.
    pub pixels: Vec<[f64; 4]>,
    /// Fragments that were lit or otherwise coloured.
    pub fragments: u64,
}

/// Draws a frame: everything that it names, or what is called for only; its colours, or an intermediate result of the
/// fragment that is seen.
#[must_use]
pub fn render<R>(frame: &Frame, only: Option<&[Called]>, stage: Option<Intermediate>) -> Image
where
    R: Real + Into<f64> + Send + Sync,
{
    let (width, height) = (frame.target.width as usize, frame.target.height as usize);
    let tiles = drawn::<R, _>(frame, only, stage, None, |tile| (tile.within, tile.colors, tile.fragments));
    let mut pixels = vec![[0.0; 4]; width * height];
    for ([[left, right], [top, _]], colors, _) in &tiles {
        let span = right - left + 1;
        for (row, colors) in colors.chunks(span).enumerate() {
            let start = (top + row) * width + left;
            pixels[start..start + span].copy_from_slice(colors);
        }
    }
    Image { width, height, pixels, fragments: tiles.iter().map(|(_, _, fragments)| fragments).sum() }
}

/// The linear colours of some pixels of a frame, by their numbers row after row; no other fragment is shaded.
///
/// # Panics
/// Where the frame has no pixel of that number.
#[must_use]
pub fn render_at<R>(frame: &Frame, pixels: &[usize]) -> Vec<[f64; 4]>
where
    R: Real + Into<f64> + Send + Sync,
{
    let width = frame.target.width as usize;
    let mut wanted = vec![false; width * frame.target.height as usize];
    pixels.iter().for_each(|&pixel| wanted[pixel] = true);
    let tiles = drawn::<R, _>(frame, None, None, Some(&wanted), |tile| {
        let [[left, right], [top, _]] = tile.within;
        let number = |place: usize| (top + place / (right - left + 1)) * width + left + place % (right - left + 1);
        let colors = tile.colors.iter().enumerate().map(|(place, &color)| (number(place), color));
        colors.filter(|&(number, _)| wanted[number]).collect::<Vec<_>>()
    });
    let colors: HashMap<usize, [f64; 4]> = tiles.into_iter().flatten().collect();
    pixels.iter().map(|pixel| colors[pixel]).collect()
}

/// The tiles of a frame, or of their pixels those alone that are wanted: what is made of each.
fn drawn<R, T>(
    frame: &Frame,
    only: Option<&[Called]>,
    stage: Option<Intermediate>,
    wanted: Option<&[bool]>,
    of_tile: impl Fn(Tile<'_, R>) -> T + Sync,
) -> Vec<T>
where
    R: Real + Into<f64> + Send + Sync,
    T: Send,
{
    let draws: Vec<Prepared<'_, R>> = (0..frame.draws.len())
        .map(|draw| Prepared::new(frame, draw, only.map(|called| &called[draw]), stage.is_some()))
        .collect();
    let size = [frame.target.width as usize, frame.target.height as usize];
    let columns = size[0].div_ceil(TILE);
    bins(&draws, size)
        .par_iter()
        .enumerate()
        .map(|(tile, bin)| {
            let origin = [tile % columns * TILE, tile / columns * TILE];
            let mut tile = Tile::new(frame, (stage, wanted), origin, size);
            for &(draw, triangle) in bin {
                tile.draw(&draws[draw], &draws[draw].geometry.triangles[triangle]);
            }
            of_tile(tile)
        })
        .collect()
}

/// A draw with its triangles in the window.
struct Prepared<'a, R> {
    draw: &'a Draw,
    shader: Shader<'a, R>,
    geometry: Geometry,
}

impl<'a, R: Real + Into<f64> + Send + Sync> Prepared<'a, R> {
    fn new(frame: &'a Frame, number: usize, only: Option<&'a Called>, stages: bool) -> Self {
        let draw = &frame.draws[number];
        let (mesh, shader) = (&frame.meshes[draw.mesh], Shader::<R>::new(frame, number, only, stages));
        let vertices: Vec<([f64; 4], Vec<R>)> = (0..mesh.positions.len())
            .into_par_iter()
            .map_init(Scratch::default, |scratch, vertex| {
                let mut attributes = vec![];
                let clip = shader.vertex(vertex, scratch, &mut attributes);
                (plain(clip), attributes)
            })
            .collect();
        let mut geometry = Geometry { stride: shader.attributes.count, ..Geometry::default() };
        for (number, (clip, attributes)) in vertices.into_iter().enumerate() {
            geometry.clip.push(clip);
            geometry.numbers.extend(attributes.into_iter().map(Into::<f64>::into));
            geometry.identities.push(number as u64);
        }
        let provoking = draw.shading.map_or(Provoking::First, |shading| shading.provoking);
        let size = [frame.target.width, frame.target.height];
        geometry.assemble(&mesh.triangles, |of| interpolation::flat(of, provoking), size, draw.cull);
        Self { draw, shader, geometry }
    }
}

/// The triangles that each tile may hold a part of, in the order of drawing.
fn bins<R>(draws: &[Prepared<'_, R>], size: [usize; 2]) -> Vec<Vec<(usize, usize)>> {
    let [columns, rows] = size.map(|pixels| pixels.div_ceil(TILE));
    let mut bins = vec![vec![]; columns * rows];
    #[expect(clippy::cast_possible_truncation, reason = "a target's size")]
    let size = size.map(|pixels| pixels as u32);
    for (number, draw) in draws.iter().enumerate() {
        for (place, triangle) in draw.geometry.triangles.iter().enumerate() {
            let [[left, right], [top, bottom]] = triangle.pixels(0.0, size);
            if right < left || bottom < top {
                continue;
            }
            for row in top / TILE..=bottom / TILE {
                for column in left / TILE..=right / TILE {
                    bins[row * columns + column].push((number, place));
                }
            }
        }
    }
    bins
}

/// A part of the image.
struct Tile<'a, R> {
    frame: &'a Frame,
    stage: Option<Intermediate>,
    wanted: Option<&'a [bool]>,
    /// First and last pixel of each axis.
    within: [[usize; 2]; 2],
    colors: Vec<[f64; 4]>,
    depths: Vec<f64>,
    fragments: u64,
    scratch: Scratch<R>,
    attributes: [R; MOST],
}

impl<'a, R: Real + Into<f64>> Tile<'a, R> {
    fn new(
        frame: &'a Frame,
        (stage, wanted): (Option<Intermediate>, Option<&'a [bool]>),
        origin: [usize; 2],
        size: [usize; 2],
    ) -> Self {
        let within = std::array::from_fn(|axis| [origin[axis], (origin[axis] + TILE).min(size[axis]) - 1]);
        let [[left, right], [top, bottom]] = within;
        let count = (right - left + 1) * (bottom - top + 1);
        let background = frame.background.map(f64::from);
        Self {
            frame,
            stage,
            wanted,
            within,
            colors: vec![if stage.is_some() { [0.0; 4] } else { background }; count],
            depths: vec![frame.clear_depth.into(); count],
            fragments: 0,
            scratch: Scratch::default(),
            attributes: [R::literal(0.0); MOST],
        }
    }

    fn draw(&mut self, prepared: &Prepared<'_, R>, triangle: &Triangle) {
        let size = [self.frame.target.width, self.frame.target.height];
        let [columns, rows] = triangle.pixels(0.0, size);
        let [[left, right], [top, bottom]] = self.within;
        for y in rows[0].max(top)..=rows[1].min(bottom) {
            let row = triangle.row(middle(y));
            for x in columns[0].max(left)..=columns[1].min(right) {
                if self.wanted.is_some_and(|wanted| !wanted[y * size[0] as usize + x]) {
                    continue;
                }
                let edges = triangle.edges_in(row, middle(x));
                if triangle.covers(edges) {
                    self.fragment(prepared, triangle, edges, (y - top) * (right - left + 1) + x - left);
                }
            }
        }
    }

    fn fragment(&mut self, prepared: &Prepared<'_, R>, triangle: &Triangle, edges: [f64; 3], pixel: usize) {
        let (draw, shader) = (prepared.draw, &prepared.shader);
        let depth = triangle.depth_at(edges);
        let is_seen = draw.depth.is_none_or(|test| passes(test.compare, depth, self.depths[pixel]) > 0.5);
        if !is_seen {
            return;
        }
        self.fragments += 1;
        interpolate(&prepared.geometry, triangle, edges, shader, &mut self.attributes);
        let fragment = shader.fragment(&self.attributes[..shader.attributes.count], &mut self.scratch);
        if fragment.kept.into() < 0.5 {
            return;
        }
        if draw.depth.is_some_and(|test| test.write) {
            self.depths[pixel] = depth;
        }
        let below = self.colors[pixel];
        self.colors[pixel] = match self.stage {
            Some(stage) => fragment.at(stage, R::literal(depth)).0.map(Into::into),
            None => stored(self.frame, draw, fragment.color, below),
        };
    }
}

/// The middle of a pixel.
fn middle(pixel: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "within a target's size")]
    let pixel = pixel as f64;
    pixel + 0.5
}

fn interpolate<R: Real>(
    geometry: &Geometry,
    triangle: &Triangle,
    edges: [f64; 3],
    shader: &Shader<'_, R>,
    attributes: &mut [R; MOST],
) {
    let weights = triangle.weights(edges);
    let [a, b, c] = triangle.vertices.map(|vertex| geometry.attributes(vertex));
    let at = a.iter().zip(b).zip(c);
    for (attribute, ((&a, &b), &c)) in attributes.iter_mut().zip(at) {
        *attribute = R::literal(interpolation::triangle(weights, [a, b, c]));
    }
    let flat = geometry.attributes(triangle.provoking);
    for number in shader.attributes.flat.clone() {
        attributes[number] = R::literal(flat[number]);
    }
}

/// What a pixel holds when a colour is drawn over another: blended, clamped where the format is.
fn stored<R: Real + Into<f64>>(frame: &Frame, draw: &Draw, color: Rgba<R>, below: [f64; 4]) -> [f64; 4] {
    let is_unorm = frame.target.format.is_unorm();
    let clamped = |c: [f64; 4]| if is_unorm { c.map(|x| x.clamp(0.0, 1.0)) } else { c };
    let src = clamped(color.0.map(Into::into));
    let Some(blend) = draw.blend else { return src };
    let constant = clamped(blend.constant.map(f64::from));
    let of = Operands { src: Vector(src), dst: Vector(below), constant: Vector(constant) };
    clamped(blend_separate(blend.state, &of, Saturate::SourceAndDestination).0)
}
