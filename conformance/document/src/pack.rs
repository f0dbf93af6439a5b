//! The manifest of a pack of cases: `lightmeter.pack/1`.

use crate::Word;
use crate::list::ListedFormula;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The schema's name.
pub const SCHEMA: &str = "lightmeter.pack/1";

/// What chooses the cases. Two gates with equal choices judge the same cases.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Choice {
    /// Globs that match an id or an ancestor of it; all where there are none.
    pub filter: Vec<String>,
    /// Random cases for each formula.
    pub cases: u64,
    /// What they are drawn from.
    pub seed: u64,
    /// Pixels of the longer side of every scene; `None` for the scenes' own.
    pub size: Option<u32>,
    /// Of a pack, the formats of targets that its blend states are asked for on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub targets: Vec<String>,
    /// Inputs that are constants of the shader under test, or in common with another one, as `shininess=32`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub held: Vec<String>,
    /// Whether a pack has special values.
    #[serde(default, skip_serializing_if = "is_false")]
    pub special: bool,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
const fn is_false(is_so: &bool) -> bool {
    !*is_so
}

fn is_empty(word: &Word) -> bool {
    word.is_empty()
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
const fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// What a pack holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Manifest {
    /// `lightmeter.pack/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The version of what draws the cases: with another one they are others.
    pub generator: u64,
    /// The version of lightmeter that wrote it.
    pub version: Word,
    /// What chose the cases.
    #[serde(flatten)]
    pub choice: Choice,
    /// What tells this pack's cases from those of others, which answers in columns name.
    #[serde(default, skip_serializing_if = "is_empty")]
    pub pack: Word,
    /// Whether the cases of formulas are columns, `columns/FORMULA/INPUT.npy`, and not lines of `cases.jsonl`.
    #[serde(default, skip_serializing_if = "is_false")]
    pub columns: bool,
    /// The formulas, with their inputs and outputs.
    pub formulas: Vec<ListedFormula>,
    /// How many cases of blend states there are on each target.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub on_targets: BTreeMap<String, u64>,
    /// How many special values there are.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub probes: usize,
    /// The scenes.
    pub scenes: Vec<PackedScene>,
    /// Each file's bytes and checksum.
    pub files: Vec<Listed>,
}

/// A scene of a pack.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PackedScene {
    /// Its id.
    pub id: String,
    /// What it shows.
    pub title: String,
    /// Its file within the pack.
    pub file: String,
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// The format of the target that it is drawn on.
    pub format: Word,
}

/// A file of a pack.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Listed {
    /// Its name within the pack.
    pub name: String,
    /// Its length.
    pub bytes: u64,
    /// Its CRC-32, as 8 digits of base 16.
    pub crc32: String,
}
