//! The JSON of `selftest`.

use crate::Word;
use crate::report::Interrupted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The schema's name.
pub const SCHEMA: &str = "lightmeter.selftest/1";

/// The JSON of `selftest`: what was not asked for is left out.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct SelftestDocument {
    /// `lightmeter.selftest/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: Word,
    /// The command, but for where its result goes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// The version of lightmeter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<Word>,
    /// When it was made, in UTC, such as `2026-05-01T12:00:00Z`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_at: Option<String>,
    /// The seed of the random cases.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// The faults of the blend unit.
    #[serde(default)]
    pub rows: Vec<UnitRow>,
    /// Every mistake in every formula that it concerns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kills: Option<Vec<Kill>>,
    /// Every formula without a mistake.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clean: Option<Vec<Clean>>,
    /// The mistakes that are known, in the order of reports, where formulas were tried.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mistakes: Vec<Mistake>,
    /// Noise in the place of formulas, where it was tried.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<NoiseRecord>,
    /// What the smallest errors are of, where they were measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub named_from: Option<NamedFrom>,
    /// The smallest errors that are named, of formulas.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Vec<Resolution>>,
    /// The mistakes of whole renderers, in the scenes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scenes: Option<SceneRecord>,
    /// The smallest errors that are told, of scenes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scene_calibration: Vec<SceneResolution>,
    /// What was under way when a signal ended the self-test: not every mistake was tried.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interrupted: Option<Interrupted>,
}

/// What became of a mistake in a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// Caught, and the first diagnosis is it, or one of the same values in every case.
    Named,
    /// Caught, and the first diagnosis is another.
    Caught,
    /// Not caught.
    Survived,
}

/// Noise in the place of formulas: what was answered, and what was explained all the same.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct NoiseRecord {
    /// Formulas with a kind of noise that were tried.
    pub tried: u64,
    /// Those that were explained.
    pub explained: Vec<ExplainedNoise>,
}

impl NoiseRecord {
    /// Whether nothing was explained but what the mistaken formula gives itself.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.explained.iter().all(|one| one.is_made)
    }
}

/// Noise that was explained.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct ExplainedNoise {
    /// The formula, or the scene.
    pub formula: String,
    /// What was answered.
    pub noise: String,
    /// What was said of it.
    pub says: String,
    /// The part of the wrong numbers that whoever makes the mistake gives.
    pub given: f64,
    /// Whether that is nearly all, so that the mistake makes this noise.
    pub is_made: bool,
}

/// A mistake in a formula.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Kill {
    /// The mistake.
    pub fault: String,
    /// The formula.
    pub formula: String,
    /// What became of it.
    pub finding: Finding,
    /// Cases that were tried.
    pub cases: usize,
    /// Those of them that fail.
    pub failing: usize,
    /// How many cases suffice to catch it, in the order of a run.
    pub smallest: Option<usize>,
    /// The case that catches it.
    pub first_case: Option<String>,
    /// How many random cases alone suffice.
    pub smallest_random: Option<usize>,
    /// The first diagnosis.
    pub diagnosis: Vec<String>,
    /// It in words.
    pub sentence: String,
    /// Whether the diagnosis names another mistake of the same values in every case, from which it cannot be told.
    pub alias: bool,
}

/// A formula without a mistake.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Clean {
    /// The formula.
    pub formula: String,
    /// Verdicts on the embedded implementation and on legal evaluations drawn at random.
    pub verdicts: u64,
    /// Those that failed.
    pub failed: u64,
    /// What a group verdict named, of the embedded implementation or of the draws.
    pub systematic: Option<Systematic>,
}

/// A known mistake.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Mistake {
    /// Its name.
    pub name: Word,
    /// What it does, as the end of a sentence: "fog uses radial distance".
    pub says: Word,
    /// A renderer or a habit that has it, where one is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seen_in: Option<Word>,
    /// Whether it follows from the steps and inputs of formulas, and stands in no table of mistakes.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub generated: bool,
}

/// From where on errors are named by a group verdict.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NamedFrom {
    /// Cases of a run.
    pub cases: u64,
    /// Standard errors from 0.
    pub least_z: f64,
    /// The shift of the answers, as a share of the tolerance.
    pub least_share: f64,
}

/// What the self-test of formulas came to.
#[derive(Clone, Debug)]
pub struct Record {
    /// Every mistake in every formula that it concerns.
    pub kills: Vec<Kill>,
    /// Every formula without a mistake.
    pub clean: Vec<Clean>,
    /// Whether every mistake was tried, and none in every formula; a signal can end the self-test earlier.
    pub is_complete: bool,
}

impl Record {
    /// Whether all was tried, every mistake is caught and nothing right is flagged.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.is_complete
            && self.kills.iter().all(|kill| kill.finding != Finding::Survived)
            && self.clean.iter().all(|clean| clean.failed == 0 && clean.systematic.is_none())
    }

    /// The families of its formulas, each once: first in the order of the formulas without a mistake, which is that of the catalogue.
    #[must_use]
    pub fn families(&self) -> Vec<&str> {
        let formulas = self.clean.iter().map(|clean| &clean.formula).chain(self.kills.iter().map(|kill| &kill.formula));
        let mut families: Vec<&str> = vec![];
        for family in formulas.map(|formula| family_of(formula)) {
            if !families.contains(&family) {
                families.push(family);
            }
        }
        families
    }

    /// Mistakes in formulas of a finding.
    #[must_use]
    pub fn count(&self, finding: Finding) -> usize {
        self.kills.iter().filter(|kill| kill.finding == finding).count()
    }
}

/// The family of a formula, the first part of its id.
#[must_use]
pub fn family_of(formula: &str) -> &str {
    formula.split('/').next().unwrap_or_default()
}

/// How a number is off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OffBy {
    /// A relative error: x(1 + δ).
    Scale,
    /// An absolute one: x + δ.
    Offset,
}

impl OffBy {
    /// The name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Scale => "scale",
            Self::Offset => "offset",
        }
    }
}

/// A systematic error that the answers show together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Systematic {
    /// What is off: an input, one number of it, or an output.
    pub parameter: String,
    /// Whether it is an output.
    pub is_output: bool,
    /// Relatively or absolutely.
    pub error: OffBy,
    /// By how much.
    pub amount: f64,
    /// How many standard errors that is.
    pub z: f64,
    /// The shift that it makes, as a share of the tolerance: the root of the mean square over the cases.
    pub share: f64,
    /// Other parameters that would explain it as well: their z is above 0.99 of this one.
    pub or: Vec<String>,
    /// In words: "as if shininess were 0.40 % larger".
    pub says: String,
}

/// The smallest errors of a parameter that are named.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Resolution {
    /// The formula.
    pub formula: String,
    /// An input, one number of it, or an output.
    pub parameter: String,
    /// Whether it is an output.
    pub is_output: bool,
    /// Relative or absolute.
    pub error: OffBy,
    /// By a single verdict: some case leaves its interval.
    pub single: Option<f64>,
    /// By the group verdict.
    pub group: Option<f64>,
}

impl Resolution {
    /// The parameter's name, an output's said to be one.
    #[must_use]
    pub fn name(&self) -> String {
        if self.is_output { format!("{} (output)", self.parameter) } else { self.parameter.clone() }
    }
}

/// The smallest errors of a parameter that a scene's image tells, as shares of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SceneResolution {
    /// The scene.
    pub scene: String,
    /// The format of its target.
    pub target: Word,
    /// The parameter, of all that the scene draws.
    pub parameter: Word,
    /// By a single pixel.
    pub pixel: Option<f64>,
    /// By a pixel, or by all pixels of an image of 8 bits together.
    pub image: Option<f64>,
}

/// What became of a mistake in the scenes.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct SceneRow {
    /// The mistake.
    pub fault: String,
    /// In words.
    pub says: String,
    /// Scenes that it fails in.
    pub caught: Vec<String>,
    /// Of them, those whose diagnosis names it first, or names one that draws the same there.
    pub named: Vec<String>,
    /// What the others' diagnoses say.
    pub others: Vec<String>,
}

/// What the scenes catch.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct SceneRecord {
    /// Each mistake.
    pub rows: Vec<SceneRow>,
    /// Scenes in which nothing is wrong and something fails all the same.
    pub alarms: Vec<String>,
    /// How many scenes were judged before a signal ended the self-test; absent where all were.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub judged: Option<usize>,
}

impl SceneRecord {
    /// Whether every scene was judged, every mistake is caught, and nothing that is right is flagged.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.judged.is_none() && self.alarms.is_empty() && self.rows.iter().all(SceneRow::is_caught)
    }

    /// How often a mistake was caught, and how often it was told by its name.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        let count = |of: fn(&SceneRow) -> &Vec<String>| self.rows.iter().map(|row| of(row).len()).sum();
        [count(|row| &row.caught), count(|row| &row.named)]
    }
}

impl SceneRow {
    /// Whether some scene catches it.
    #[must_use]
    pub fn is_caught(&self) -> bool {
        !self.caught.is_empty()
    }
}

/// What became of a fault of the blend unit on a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum UnitFinding {
    /// Found, and told by its name.
    Named,
    /// Found, and told by another name or none.
    Caught,
    /// Not found.
    Survived,
    /// It cannot be made on the target.
    NotApplicable,
    /// Nothing was found where nothing was wrong.
    Clean,
    /// Something was found where nothing was wrong.
    FalseAlarm,
}

/// A fault of the blend unit on a target.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct UnitRow {
    /// The fault's name, or `none`.
    pub fault: Word,
    /// The target's format.
    pub target: Word,
    /// What became of it.
    pub finding: UnitFinding,
    /// Verdicts.
    pub verdicts: u64,
    /// Those that failed by themselves.
    pub failed: u64,
    /// What was said of it.
    pub said: Vec<String>,
}

impl UnitFinding {
    /// The name in JSON and on pages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Named => "named",
            Self::Caught => "caught",
            Self::Survived => "survived",
            Self::NotApplicable => "not-applicable",
            Self::Clean => "clean",
            Self::FalseAlarm => "false-alarm",
        }
    }

    /// Whether it is as it should be.
    #[must_use]
    pub const fn is_good(self) -> bool {
        matches!(self, Self::Named | Self::NotApplicable | Self::Clean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_come_in_the_order_of_the_formulas() {
        let clean = |formula: &str| Clean { formula: formula.into(), verdicts: 1, failed: 0, systematic: None };
        let clean = ["vector/reflect", "fog/exp", "fog/linear", "blend/add"].map(clean).to_vec();
        let record = Record { kills: vec![], clean, is_complete: true };
        assert_eq!(record.families(), ["vector", "fog", "blend"]);
    }
}
