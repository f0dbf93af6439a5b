//! What the blend unit draws for a case.

use lightmeter_reference::blend::Mode;
use lightmeter_scene::blend::{Separate, State, WriteMask};

/// The most draws that overlap in a case.
pub const MOST_LAYERS: usize = 16;

/// What the blend unit draws for a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Program {
    /// One draw. Inputs: source, destination, constant.
    Draw(Separate, WriteMask),
    /// One draw of NaN or infinity, which float targets alone can hold. Inputs: source, destination, constant.
    Special(State),
    /// One draw on a back buffer without alpha, which reads as 1: alpha begins as 1 and is not written. Inputs: source,
    /// destination's colour.
    WithoutAlpha(State),
    /// Up to 16 draws that overlap, in order, the modes in turn. Inputs: destination, count, 16 sources.
    Layers(&'static [Mode]),
}

/// A case as the blend unit is given it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitCase {
    /// The source of each draw.
    pub sources: [[f32; 4]; MOST_LAYERS],
    /// How many draws.
    pub layers: usize,
    /// What is there before.
    pub dst: [f32; 4],
    /// The blend constant.
    pub constant: [f32; 4],
}

impl Program {
    /// The state and the write mask of a layer.
    #[must_use]
    pub fn layer(self, number: usize) -> (Separate, WriteMask) {
        match self {
            Self::Draw(state, mask) => (state, mask),
            Self::Special(state) => (state.into(), WriteMask::ALL),
            Self::WithoutAlpha(state) => (state.into(), WriteMask::COLOR),
            Self::Layers(modes) => (modes[number % modes.len()].state().into(), WriteMask::ALL),
        }
    }

    /// Whether only float targets are drawn on.
    #[must_use]
    pub const fn is_special(self) -> bool {
        matches!(self, Self::Special(_))
    }

    /// A row of inputs as the unit is given it.
    ///
    /// # Panics
    /// Where the row has fewer numbers than the program's inputs.
    #[must_use]
    pub fn case(self, row: &[f32]) -> UnitCase {
        let color = |at: usize| [row[at], row[at + 1], row[at + 2], row[at + 3]];
        let mut case = UnitCase { sources: [[0.0; 4]; MOST_LAYERS], layers: 1, dst: [0.0; 4], constant: [0.0; 4] };
        match self {
            Self::Draw(..) | Self::Special(_) => {
                case.sources[0] = color(0);
                case.dst = color(4);
                case.constant = color(8);
            }
            Self::WithoutAlpha(_) => {
                case.sources[0] = color(0);
                case.dst = [row[4], row[5], row[6], 1.0];
            }
            Self::Layers(_) => {
                case.dst = color(0);
                case.layers = (1..=MOST_LAYERS).rev().find(|&n| row[4] >= layer_count(n)).unwrap_or(1);
                for (number, source) in case.sources.iter_mut().enumerate() {
                    *source = color(5 + 4 * number);
                }
            }
        }
        case
    }
}

#[expect(clippy::cast_precision_loss, reason = "at most 16")]
const fn layer_count(n: usize) -> f32 {
    n as f32
}
