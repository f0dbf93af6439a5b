//! Drawing by a device's blend unit: many states with many pixels each in a submission, one read-back.

use lightmeter_catalogue::cases::blend::{Program, UnitCase};
use lightmeter_engine::piece::{Piece, Pixels};
use lightmeter_gpu::{Batch, BlendUnit, GpuError, UnitDraw};
use lightmeter_judge::blend_unit::pixel::{self, Units};
use lightmeter_scene::target::TargetFormat;
use rayon::prelude::*;
use std::time::Instant;

/// Has a unit draw pieces on a target.
pub(super) fn blend(
    unit: &mut BlendUnit,
    target: TargetFormat,
    pieces: &[&Piece],
    again: bool,
) -> Result<Pixels, GpuError> {
    let clock = Instant::now();
    let share = pieces.len().div_ceil(unit.lanes()).max(1);
    let batches: Vec<Batch> = pieces.par_chunks(share).map(|pieces| batch(target, pieces)).collect();
    let bytes = through(unit, target, &batches)?;
    let seconds = clock.elapsed().as_secs_f64();
    let seconds_warm = again
        .then(|| {
            let clock = Instant::now();
            through(unit, target, &batches).map(|_| clock.elapsed().as_secs_f64())
        })
        .transpose()?;
    let by_lane = pieces.par_chunks(share).zip(bytes);
    let pieces = by_lane.flat_map_iter(|(pieces, bytes)| {
        let mut next = 0;
        let pixels: Vec<Vec<Units>> = pieces
            .iter()
            .map(|piece| {
                let first = next;
                next += piece.count();
                (first..next).map(|number| pixel::read(target, &bytes, number)).collect()
            })
            .collect();
        pixels
    });
    Ok(Pixels { pieces: pieces.collect(), seconds, seconds_warm, ..Pixels::default() })
}

fn through(unit: &mut BlendUnit, target: TargetFormat, batches: &[Batch]) -> Result<Vec<Vec<u8>>, GpuError> {
    let pending = unit.submit(target, batches)?;
    unit.wait(pending)
}

/// A point of a drawing: its case's place, and its layer.
type Point = (usize, usize);

/// Pieces one after the other on a device's target.
fn batch(target: TargetFormat, pieces: &[&Piece]) -> Batch {
    let mut batch = Batch::default();
    let small = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let mut first = 0;
    for piece in pieces {
        let cases: Vec<UnitCase> = (0..piece.count()).map(|k| piece.case(k)).collect();
        for case in &cases {
            pixel::write(target, pixel::stored(target.encoding(), case.dst), &mut batch.destinations);
        }
        let draw = |batch: &mut Batch, layer: usize, constant: [f32; 4], points: &[Point]| {
            let start = small(batch.pixels.len());
            for &(place, layer) in points {
                batch.sources.push(cases[place].sources[layer]);
                batch.pixels.push(small(first + place));
            }
            let (state, mask) = piece.program.layer(layer);
            let points = start..small(batch.pixels.len());
            batch.draws.push(UnitDraw { state, mask, route: piece.route, constant, points });
        };
        match piece.program {
            // One mode: the layers overlap within a draw, in the order of its points.
            Program::Layers([_]) => {
                let points = |(place, case): (usize, &UnitCase)| (0..case.layers).map(move |layer| (place, layer));
                let points: Vec<_> = cases.iter().enumerate().flat_map(points).collect();
                draw(&mut batch, 0, [0.0; 4], &points);
            }
            // Several: they overlap from draw to draw.
            Program::Layers(_) => {
                for layer in 0..cases.iter().map(|case| case.layers).max().unwrap_or(0) {
                    let drawn = cases.iter().enumerate().filter(|(_, case)| case.layers > layer);
                    let points: Vec<_> = drawn.map(|(place, _)| (place, layer)).collect();
                    draw(&mut batch, layer, [0.0; 4], &points);
                }
            }
            _ => {
                for (constant, points) in by_constant(&cases) {
                    draw(&mut batch, 0, constant, &points);
                }
            }
        }
        first += piece.count();
    }
    batch
}

/// The cases of each constant, of which a state has few.
fn by_constant(cases: &[UnitCase]) -> Vec<([f32; 4], Vec<Point>)> {
    let mut groups: Vec<([f32; 4], Vec<Point>)> = vec![];
    for (place, case) in cases.iter().enumerate() {
        let same = |constant: &[f32; 4]| constant.map(f32::to_bits) == case.constant.map(f32::to_bits);
        match groups.iter_mut().find(|(constant, _)| same(constant)) {
            Some((_, points)) => points.push((place, 0)),
            None => groups.push((case.constant, vec![(place, 0)])),
        }
    }
    groups
}
