//! An image of a scene, as a report has it.

use crate::by_case::is_zero;
use crate::hash::hash;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::{self, Display, Formatter};

/// An image of a scene.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ImageUse {
    /// Pixels.
    pub width: usize,
    /// Pixels.
    pub height: usize,
    /// Judged pixels of which several outcomes are legal that differ by more than twice the widest of them.
    pub marked: u64,
    /// Of the shader with all effects: pixels that are not, bit for bit, those of the composed shaders.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub differs_from_composed: Option<u64>,
    /// Of the shader with all effects: what they cost, where that was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost: Option<EffectsCost>,
    /// To which side of the reference all pixels lie together, where each alone is legal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bias: Option<ImageBias>,
    /// Pixels that are wrong.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub wrong: u64,
    /// The first intermediate result in which a wrong image departs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub departs_in: Option<Departure>,
    /// The command that shows the worst pixel of a wrong image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub show: Option<String>,
    /// Reference, result and error map of a wrong image.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<String>,
    /// The hash of each of these files in turn, by which they are told from those of a later run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hashes: Vec<String>,
    /// Of a wrong image: the pixels that are farthest off, worst first, and then marked ones.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pixels: Vec<PixelUse>,
}

impl ImageUse {
    /// Whether bytes are those of the file at a place of `files`. Of a document without hashes, as older versions wrote them, nobody can tell.
    #[must_use]
    pub fn is_its_file(&self, place: usize, bytes: &[u8]) -> Option<bool> {
        self.hashes.get(place).map(|own| *own == hash(bytes))
    }
}

/// The first intermediate result that is not legal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Departure {
    /// Its name, `cutout` where only the fragments that are left out differ, or `blend` or `store` where all of them are legal.
    pub stage: Word,
    /// Pixels that depart there.
    pub pixels: u64,
    /// Of how many that were looked at.
    pub of: u64,
}

impl Display for Departure {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "first departs in: {} ({} of {} pixels looked at)", self.stage, self.pixels, self.of)
    }
}

/// A pixel of a wrong image, in the target's values, or in steps where it has 8 bits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PixelUse {
    /// From the left.
    pub x: usize,
    /// From the top.
    pub y: usize,
    /// Which sample of the pixel, from 0, where pixels have more than one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<u32>,
    /// The f64 reference: red, green, blue, alpha.
    pub reference: [Number; 4],
    /// The least legal values.
    pub low: [Number; 4],
    /// The greatest legal values.
    pub high: [Number; 4],
    /// What was drawn.
    pub value: [Number; 4],
    /// Whether several outcomes are legal that differ.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub marked: bool,
}

/// In what a bias is counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum BiasUnit {
    /// Steps of 8 bits.
    #[default]
    Step,
    /// Tolerances of pixels, on a target of floats.
    Tolerance,
}

/// An image that is to one side of its reference, by less than one pixel shows.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ImageBias {
    /// What the values are as if multiplied by; where it is missing, as if something were added.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
    /// How far it moves values, in units, negative where it is downwards.
    pub steps: f64,
    /// Its standard error, in units.
    pub error: f64,
    /// What the units are; steps of 8 bits where it is missing.
    #[serde(default, skip_serializing_if = "is_step")]
    pub unit: BiasUnit,
    /// What of these the accuracy rules do not explain, which fails the image; missing where they explain it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beyond: Option<f64>,
}

fn is_step(unit: &BiasUnit) -> bool {
    *unit == BiasUnit::Step
}

impl ImageBias {
    /// What it is as if: something multiplied, or added to all values.
    #[must_use]
    pub fn as_if(&self) -> String {
        match self.factor {
            Some(factor) if self.unit == BiasUnit::Step => {
                format!("as if every value were {factor:.4} times what it is to be")
            }
            Some(factor) => format!("as if every value were {factor:.6} times what it is to be"),
            None if self.unit == BiasUnit::Step => format!("as if {:+.2} were added to every value", self.steps),
            None => "as if the same were added to every value".into(),
        }
    }

    /// How far it moves values, as the root of the mean square, with the unit.
    #[must_use]
    pub fn on_average(&self) -> String {
        match self.unit {
            BiasUnit::Step => format!("{:+.2} steps of 8 bits", self.steps),
            BiasUnit::Tolerance => format!("{:+.2} of what is permitted", self.steps),
        }
    }
}

/// What drawing a scene takes by composed shaders, and by the one with all effects, in turns.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
pub struct EffectsCost {
    /// Median of one drawing by composed shaders.
    pub composed_ms: f64,
    /// The same by the shader with all effects.
    pub full_ms: f64,
    /// Median of the second over the first, turn by turn.
    pub ratio: f64,
    /// Its lower and upper quartile.
    pub quartiles: [f64; 2],
}
