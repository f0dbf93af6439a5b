//! Drawing by a blend unit: many states with many pixels each in a submission, one read-back.

use super::embedded;
use super::pixel::Units;
use crate::device::{Code, DeviceError};
use crate::subject::Subject;
use lightmeter_catalogue::cases::blend::{Program, UnitCase};
use lightmeter_scene::blend::Route;
use lightmeter_scene::target::TargetFormat;
use rayon::prelude::*;
use std::time::Instant;

/// A state by one route, with rows of inputs.
#[derive(Clone, Debug)]
pub struct Piece {
    /// What is drawn.
    pub program: Program,
    /// How it reaches the unit.
    pub route: Route,
    /// The inputs, row after row.
    pub inputs: Vec<f32>,
    /// Numbers of a row.
    pub stride: usize,
}

impl Piece {
    /// How many cases there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.inputs.len() / self.stride
    }

    /// A case.
    #[must_use]
    pub fn case(&self, place: usize) -> UnitCase {
        self.program.case(&self.inputs[place * self.stride..(place + 1) * self.stride])
    }
}

/// The pixels of each piece, and how long they took: at first, and again with every pipeline compiled.
pub struct Pixels {
    /// Pixels by piece and case.
    pub pieces: Vec<Vec<Units>>,
    /// Seconds of the first drawing.
    pub seconds: f64,
    /// Seconds of a second one, where it was asked for.
    pub seconds_warm: Option<f64>,
}

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
    Ok(Pixels { pieces, seconds: clock.elapsed().as_secs_f64(), seconds_warm: None })
}
