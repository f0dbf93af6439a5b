//! The JSON of `mistakes`: what the suite knows renderers to do wrong, and how it shows.

use crate::Word;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The schema of [`MistakesDocument`].
pub const SCHEMA: &str = "lightmeter.mistakes/1";

/// The JSON of `mistakes`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MistakesDocument {
    /// `lightmeter.mistakes/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The mistakes, in the order in which equally good explanations are told.
    pub mistakes: Vec<KnownMistake>,
}

/// Where a mistake is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MistakeOf {
    /// In formulas.
    Formulas,
    /// In whole scenes.
    Scenes,
}

/// A mistake of the catalogue.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct KnownMistake {
    /// Its name.
    pub name: Word,
    /// What it does, as the end of a sentence: "fog uses radial distance".
    pub says: Word,
    /// Where it is made.
    pub of: MistakeOf,
    /// A renderer or a habit that has it, where one is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seen_in: Option<Word>,
    /// The formulas that it concerns; of a mistake in scenes the scenes in which it shows, where some were asked for by name.
    pub formulas: Vec<String>,
    /// How it looks in some of them: in all but the many blend states.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub looks: Vec<MistakeLook>,
}

/// How a mistake looks: in a formula over its hard cases and 256 random ones, in a scene over the pixels of a small image.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MistakeLook {
    /// The formula, or the scene.
    pub formula: String,
    /// How many cases were tried, or pixels.
    pub cases: usize,
    /// How many of them fail.
    pub failing: usize,
    /// How many wrong numbers they have that are too great, and how many that are too small.
    pub too_great: usize,
    /// See `too_great`.
    pub too_small: usize,
    /// The outputs that are wrong in some case.
    pub outputs: Vec<Word>,
}
