//! Where the primitives of raster cases lie: raw numbers drawn between 0 and 1, or on a grid, become vertices about the
//! case's pixel.

use crate::cases::Spec;
use crate::cases::draw::narrow;
use lightmeter_scene::raster::TARGET_SIZE;

/// From raw numbers between 0 and 1 to a vertex in clip coordinates at that angle about the pixel.
fn place(raw: &mut [f32], pixel: [f64; 2], angle: f64) {
    let [_, radius, z, w] = [raw[0], raw[1], raw[2], raw[3]].map(f64::from);
    let radius = 8.0 * core_math::exp2(radius * core_math::log2(60.0 / 8.0));
    let (x, y) = (pixel[0] + radius * core_math::cos(angle), pixel[1] + radius * core_math::sin(angle));
    let half = f64::from(TARGET_SIZE) / 2.0;
    let w = 0.5 * core_math::exp2(4.0 * w);
    for (raw, value) in raw.iter_mut().zip([(x / half - 1.0) * w, (1.0 - y / half) * w, z * w, w]) {
        *raw = narrow(value);
    }
}

fn center(row: &[f32]) -> [f64; 2] {
    [f64::from(row[row.len() - 2]) + 0.5, f64::from(row[row.len() - 1]) + 0.5]
}

pub(in crate::cases) fn triangle_around_the_pixel(_: &Spec, row: &mut [f32]) {
    for k in 0..3 {
        row[4 * k + 2] = 0.05 + 0.9 * row[4 * k + 2];
    }
    triangle_around(row);
}

pub(super) fn triangle_across_the_volume(_: &Spec, row: &mut [f32]) {
    let behind = row[12].to_bits() & 3 == 0;
    for k in 0..3 {
        row[4 * k + 2] = 2.0 * row[4 * k + 2] - 0.5;
    }
    triangle_around(row);
    if behind {
        // A vertex behind the eye: the triangle opens away from it.
        row[..4].iter_mut().for_each(|x| *x = -*x);
    }
}

fn triangle_around(row: &mut [f32]) {
    let (pixel, base) = (center(row), std::f64::consts::TAU * f64::from(row[0]));
    let clockwise = row[1].to_bits() & 1 == 0;
    for (k, turn) in (0..3).zip([0.0, 1.0, 2.0]) {
        let jitter = if k == 0 { 0.0 } else { 0.7 * (f64::from(row[4 * k]) - 0.5) };
        let angle = std::f64::consts::TAU / 3.0 * turn + jitter;
        place(&mut row[4 * k..4 * k + 4], pixel, base + if clockwise { angle } else { -angle });
    }
}

pub(super) fn line_through_the_pixel(_: &Spec, row: &mut [f32]) {
    let (pixel, angle) = (center(row), std::f64::consts::TAU * f64::from(row[0]));
    for (k, turn) in [(0, 0.0), (1, std::f64::consts::PI)] {
        row[4 * k + 2] = 0.05 + 0.9 * row[4 * k + 2];
        place(&mut row[4 * k..4 * k + 4], pixel, angle + turn);
    }
}

/// Four corners in order about the middle of the grid, moved so that they surround the pixel.
pub(super) fn quad_on_the_grid(_: &Spec, row: &mut [f32]) {
    let [px, py] = [row[8], row[9]];
    for (k, (right, down)) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].into_iter().enumerate() {
        // Corners 0 to 8 pixels from the pixel, so that edges often pass through its centre.
        let reach = |raw: f32| (raw / 8.0 * 2.0).round() * 0.5;
        row[2 * k] = px + 0.5 + (2.0 * right - 1.0) * reach(row[2 * k]);
        row[2 * k + 1] = py + 0.5 + (2.0 * down - 1.0) * reach(row[2 * k + 1]);
    }
}

/// Four corners about the pixel, two of them nearly opposite, so that the shared edge passes close by.
pub(super) fn quad_around_the_pixel(_: &Spec, row: &mut [f32]) {
    let pixel = center(row);
    let base = std::f64::consts::TAU * f64::from(row[0]) / 256.0;
    for (k, turn) in (0..4).zip([0.0, 0.25, 0.5, 0.75]) {
        let [angle, radius] = [row[2 * k], row[2 * k + 1]].map(|raw| f64::from(raw) / 256.0);
        let jitter = if k == 2 { 0.02 * (angle - 0.5) } else { 0.0 };
        let (angle, radius) = (base + std::f64::consts::TAU * (turn + jitter), 16.0 + 44.0 * radius);
        row[2 * k] = narrow(pixel[0] + radius * core_math::cos(angle));
        row[2 * k + 1] = narrow(pixel[1] + radius * core_math::sin(angle));
    }
}
