//! What a blend unit draws at once, and the pixels that come of it.

use lightmeter_catalogue::cases::blend::{Program, UnitCase};
use lightmeter_judge::blend_unit::pixel::Units;
use lightmeter_judge::cases::Unanswered;
use lightmeter_scene::blend::Route;
use std::collections::BTreeMap;

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
#[derive(Default)]
pub struct Pixels {
    /// Pixels by piece and case.
    pub pieces: Vec<Vec<Units>>,
    /// Cases without a pixel, by piece and case.
    pub unanswered: BTreeMap<(usize, usize), Unanswered>,
    /// Seconds of the first drawing.
    pub seconds: f64,
    /// Seconds of a second one, where it was asked for.
    pub seconds_warm: Option<f64>,
}
