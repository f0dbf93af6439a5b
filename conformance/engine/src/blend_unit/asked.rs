//! Blend states on the targets of a renderer that is asked case by case.

use super::chunk::UnitChunk;
use crate::device::DeviceError;
use crate::piece::Pixels;
use crate::renderer::{AskedPixels, AskedRenderer};
use lightmeter_scene::target::TargetFormat;
use std::time::Instant;

/// The pixels that a renderer leaves of all pieces of a chunk.
pub(super) fn asked(
    renderer: &mut dyn AskedRenderer,
    target: TargetFormat,
    chunk: &UnitChunk<'_>,
) -> Result<Pixels, DeviceError> {
    let clock = Instant::now();
    let mut drawn = Pixels::default();
    for (number, ((&member, piece), cases)) in chunk.members.iter().zip(&chunk.pieces).zip(&chunk.cases).enumerate() {
        let asked = AskedPixels { member, program: piece.program, target, cases, inputs: &piece.inputs };
        let mut pixels = vec![[0.0; 4]; cases.len()];
        for (place, answer) in renderer.pixels(&asked)?.into_iter().enumerate() {
            match answer {
                Ok(pixel) => pixels[place] = pixel,
                Err(why) => drop(drawn.unanswered.insert((number, place), why)),
            }
        }
        drawn.pieces.push(pixels);
    }
    drawn.seconds = clock.elapsed().as_secs_f64();
    Ok(drawn)
}
