//! The legal values of every pixel of a frame.

use super::pixel::{Candidate, LegalPixel, Painter};
use super::prepared::Prepared;
use lightmeter_arithmetic::Profile;
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::stage::Intermediate;
use lightmeter_scene::target::TargetFormat;
use rayon::prelude::*;

/// Pixels of a tile's side.
const TILE: usize = 16;

/// A frame prepared for the legal values of its pixels.
pub struct Expectation<'a> {
    frame: &'a Frame,
    stage: Option<Intermediate>,
    profile: Profile,
    draws: Vec<Prepared<'a>>,
    bins: Vec<Vec<(u32, u32)>>,
    columns: usize,
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
    pub fn pixels(&self) -> Vec<LegalPixel> {
        let (width, height) = (self.frame.target.width as usize, self.frame.target.height as usize);
        let tiles: Vec<Vec<LegalPixel>> =
            (0..self.bins.len()).into_par_iter().map(|tile| self.profile.scope(|| self.tile(tile))).collect();
        let blank = LegalPixel { low: [0.0; 4], high: [0.0; 4], is_marked: false };
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

    /// Some pixels, by their numbers row after row.
    #[must_use]
    pub fn at(&self, pixels: &[usize]) -> Vec<LegalPixel> {
        let width = self.frame.target.width as usize;
        pixels.par_iter().map(|&pixel| self.pixel(pixel % width, pixel / width)).collect()
    }

    /// One pixel.
    #[must_use]
    pub fn pixel(&self, x: usize, y: usize) -> LegalPixel {
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

    fn tile(&self, number: usize) -> Vec<LegalPixel> {
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
        let [dx, dy] = draw.outlines[triangle as usize].reach;
        let size = [self.frame.target.width, self.frame.target.height];
        draw.geometry.triangles[triangle as usize].pixels(dx.max(dy), size)
    }

    fn candidate(&self, (draw, number): (u32, u32), x: usize, y: usize) -> Option<Candidate> {
        let prepared = &self.draws[draw as usize];
        let (triangle, outline) = (&prepared.geometry.triangles[number as usize], &prepared.outlines[number as usize]);
        let edges = triangle.edges([middle(x), middle(y)]);
        let is_open = |k: usize| edges[k].abs() <= outline.margins[k];
        if (0..3).any(|k| edges[k] < -outline.margins[k]) {
            return None;
        }
        let open = [is_open(0), is_open(1), is_open(2)];
        Some(Candidate { draw, triangle: number, edges, open, covers: triangle.covers(edges) })
    }
}

/// The legal values of every pixel of a frame, by a profile.
#[must_use]
pub fn expect(
    frame: &Frame,
    only: Option<&[Called]>,
    stage: Option<Intermediate>,
    profile: &Profile,
) -> Vec<LegalPixel> {
    Expectation::new(frame, only, stage, profile).pixels()
}

fn middle(pixel: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "within a target's size")]
    let pixel = pixel as f64;
    pixel + 0.5
}

/// The triangles that each tile may hold a part of, in the order of drawing.
fn bins(draws: &[Prepared<'_>], size: [u32; 2]) -> (usize, Vec<Vec<(u32, u32)>>) {
    let [columns, rows] = size.map(|pixels| (pixels as usize).div_ceil(TILE));
    let mut bins = vec![vec![]; columns * rows];
    let number = |place: usize| u32::try_from(place).expect("a loader refuses meshes of more triangles");
    for (draw, prepared) in draws.iter().enumerate() {
        for (place, triangle) in prepared.geometry.triangles.iter().enumerate() {
            let [dx, dy] = prepared.outlines[place].reach;
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
