//! Drawing by a blend unit: many states with many pixels each in a submission, one read-back.

use crate::device::{Code, DeviceError};
use crate::piece::{Piece, Pixels};
use crate::subject::Subject;
use lightmeter_judge::blend_unit::embedded;
use lightmeter_scene::target::TargetFormat;
use rayon::prelude::*;
use std::time::Instant;

/// Has a subject draw pieces on a target.
///
/// # Errors
/// Where a shader is invalid, or the device refuses a pipeline, fails or is lost.
pub fn draw(
    subject: &mut Subject,
    code: &Code,
    target: TargetFormat,
    pieces: &[&Piece],
    again: bool,
) -> Result<Pixels, DeviceError> {
    let rules = *subject.rules();
    if let Some(device) = subject.device_mut() {
        return device.blend(code, target, pieces, again);
    }
    let clock = Instant::now();
    let blend = |piece: &&Piece| {
        (0..piece.count()).map(|k| embedded::blend(piece.program, target, &piece.case(k), &rules)).collect()
    };
    let pieces = pieces.par_iter().map(blend).collect();
    Ok(Pixels { pieces, seconds: clock.elapsed().as_secs_f64(), ..Pixels::default() })
}
