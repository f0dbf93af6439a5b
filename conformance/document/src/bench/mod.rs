//! What a bench found, as it is written: `lightmeter.bench/1`.
//!
//! Times are nanoseconds, errors are against the f64 reference of what a group's `ideal` says. A *row* is a technique or a
//! rung of the ladder; rows of a *group* compute the same, and are measured in turns beside the group's baseline.

pub mod ladder;
pub mod pareto;
pub mod recommendation;

use crate::Number;
use crate::report::Interrupted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The schema's name.
pub const SCHEMA: &str = "lightmeter.bench/1";

/// Everything that was found.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct BenchDocument {
    /// `lightmeter.bench/1`.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: String,
    /// The command that made it.
    pub command: String,
    /// The suite's version.
    pub version: String,
    /// When it was made, in UTC, such as `2026-05-01T12:00:00Z`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_at: Option<String>,
    /// Whether it was a quick one: fewer formulas, fewer turns.
    pub quick: bool,
    /// What inputs are drawn from.
    pub seed: u64,
    /// How long it took.
    pub seconds: f64,
    /// Cores of the processor.
    pub cores: usize,
    /// What was measured, adapter by adapter.
    pub adapters: Vec<Measured>,
    /// What was under way when a signal ended the bench: it lacks groups, or sittings of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interrupted: Option<Interrupted>,
}

/// What was measured on an adapter.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Measured {
    /// The adapter's short name.
    pub adapter: String,
    /// The device as the driver names it.
    pub device: String,
    /// `vulkan`, `gl` or `embedded`.
    pub backend: String,
    /// The driver and its version.
    pub driver: String,
    /// Whether the driver computes on the processor: its times are the processor's.
    pub is_cpu: bool,
    /// How GPU times were told.
    pub clock: ClockUse,
    /// The rungs of the ladder and whether the adapter has them.
    pub rungs: Vec<RungUse>,
    /// The groups.
    pub groups: Vec<BenchGroup>,
    /// Formula families as a whole.
    pub families: Vec<Family>,
    /// How time grows with work.
    pub scalings: Vec<Scaling>,
    /// What the documents claim.
    pub claims: Vec<Claim>,
}

/// How GPU times were told.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ClockUse {
    /// `timestamps` or `wall`.
    pub kind: String,
    /// Why it is the clock on the wall, or what went wrong with timestamps.
    pub note: Option<String>,
    /// Readings that were taken.
    pub readings: u64,
    /// Of them, those that could not be true: in no figure.
    pub rejected: u64,
    /// The steps in which a browser's clock tells time, in nanoseconds, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grain_ns: Option<u64>,
}

impl ClockUse {
    /// Whether readings were taken and every one was rejected.
    #[must_use]
    pub const fn tells_nothing(&self) -> bool {
        self.readings > 0 && self.rejected == self.readings
    }
}

/// A rung of the ladder on an adapter.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct RungUse {
    /// `f16`, `f32-cheap`, `f32`, `f32-stable`, `double-float`, `f64`, `cpu-f32`, `cpu-f64`, `cpu-accept`.
    pub name: String,
    /// What it is, in a line.
    pub what: String,
    /// Why the adapter has it not.
    pub unavailable: Option<String>,
}

/// What the rows of a group are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GroupKind {
    /// A formula at the rungs of the ladder.
    Formula,
    /// Techniques against each other.
    Technique,
    /// A scene at the rungs of the ladder.
    Scene,
}

/// Rows that compute the same.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct BenchGroup {
    /// `fog/exp`, `technique/viewer`, `scene/teapot`.
    pub id: String,
    /// What its rows are.
    pub kind: GroupKind,
    /// A formula's family; `technique`; `scene`.
    pub family: String,
    /// What is compared, in a line.
    pub title: String,
    /// What errors are against, in a line.
    pub ideal: String,
    /// The row that ratios are over.
    pub baseline: String,
    /// What a time is of: `evaluation` or `frame`.
    pub unit: String,
    /// What errors and times are over, in a line: how many cases, what is drawn.
    pub work: String,
    /// The rows.
    pub rows: Vec<BenchRow>,
    /// Rows than which none is both as fast, within the spreads, and closer, the fastest first; errors are the largest on random
    /// inputs.
    pub front: Vec<String>,
}

/// A technique or a rung.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct BenchRow {
    /// Its name, one of its own in its group.
    pub name: String,
    /// What it is, in a line.
    pub what: String,
    /// Whether it claims the formula itself: its values must lie in the acceptance intervals.
    pub claims_exact: bool,
    /// Why it was not measured.
    pub unavailable: Option<String>,
    /// Whether it is not there because no step of it has a form of its own at the rung: f32's figures count for it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub as_f32: bool,
    /// What is wrong in value with it: such a row is on no front and never recommended.
    pub disqualified: Option<String>,
    /// On random inputs; of a scene, its pixels.
    pub random: Option<Errors>,
    /// On the group's hard cases, and those within a few ULP of them.
    pub hard: Option<Errors>,
    /// What of the error on random inputs is rounding: against the f64 reference of its own formula, where that is another one
    /// than the ideal.
    pub rounding: Option<Errors>,
    /// How long it takes.
    pub time: Option<Time>,
    /// Milliseconds from the shader's text to the first result, compilation within: in no time.
    pub compile_ms: Option<f64>,
}

/// Errors over many values. `lost` values are in none of the statistics, whose maxima are infinite where there are any.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Errors {
    /// Values that were compared.
    pub values: u64,
    /// Of them, NaN or infinite where the reference is a number.
    pub lost: u64,
    /// Values that nothing is promised of, and that were not compared.
    pub nothing_promised: u64,
    /// In ULP of binary32.
    pub ulp: Spread,
    /// In 1/255 of full scale.
    pub steps: Spread,
    /// As they are.
    pub absolute: Spread,
}

/// Statistics of errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Spread {
    /// The largest.
    pub max: Number,
    /// 99 of 100 are no greater.
    pub p99: Number,
    /// The mean.
    pub mean: Number,
}

/// How long a row takes, for one of the group's `unit`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Time {
    /// `timestamps`, `wall`, or `processor` of the rungs on one core of the processor.
    pub clock: String,
    /// Nanoseconds, the median of the turns, and of these of the sittings; what reading the inputs takes is taken off where the
    /// group's `work` says so.
    pub ns: f64,
    /// The lower and the upper end of the middle half of the turns.
    pub quartiles_ns: [f64; 2],
    /// The median, turn by turn, over the baseline's time in the same turn; of the processor's rungs over `cpu-f32`.
    pub ratio: f64,
    /// From where to where that goes in the turns.
    pub spread: [f64; 2],
    /// What the ratio says.
    pub verdict: Rank,
    /// Turns that are in the figures.
    pub turns: usize,
    /// Readings that could not be true: in no figure.
    pub rejected: usize,
    /// What else is to be said of the figure.
    pub note: Option<String>,
}

/// What a ratio says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Rank {
    /// It is the baseline itself.
    Baseline,
    /// Below 1, and the spread with it.
    Faster,
    /// Above 1, and the spread with it.
    Slower,
    /// 1 lies within the spread.
    Tie,
}

/// The formulas of a family at the rungs of the ladder, as a whole.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Family {
    /// The family.
    pub id: String,
    /// The rungs that were measured of it.
    pub rungs: Vec<FamilyRung>,
    /// Rungs than which none is both faster and closer, the fastest first.
    pub front: Vec<String>,
}

/// A rung over a family's formulas.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct FamilyRung {
    /// The rung's name.
    pub name: String,
    /// Formulas of the family that were measured at it and are right in value.
    pub formulas: usize,
    /// Formulas no step of which has such a form, so that f32's figures count.
    pub as_f32: usize,
    /// Formulas that it is disqualified at.
    pub disqualified: usize,
    /// Formulas that have it not.
    pub unavailable: usize,
    /// The geometric mean of its ratios to f32.
    pub ratio: f64,
    /// The same of the ends of their spreads.
    pub spread: [f64; 2],
    /// The geometric mean of its times in nanoseconds.
    pub ns: f64,
    /// The median of its formulas' largest errors on random inputs, absolute.
    pub error_max: Number,
    /// Each formula's ratio and largest error.
    pub points: Vec<(String, f64, Number)>,
}

/// How time grows with work.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Scaling {
    /// `lights`, `vertices`, `pixels`, `cases`.
    pub id: String,
    /// What is drawn or evaluated, in a line.
    pub what: String,
    /// What the work is counted in.
    pub unit: String,
    /// The clock, as in [`Time`].
    pub clock: String,
    /// The steps, least work first.
    pub points: Vec<ScalingPoint>,
    /// Steps that the adapter does not reach, with the reason.
    pub unavailable: Vec<(u64, String)>,
    /// `time = fixed + factor · work^exponent`, by least squares of the logarithm.
    pub fit: Option<Fit>,
}

/// A step.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ScalingPoint {
    /// How much work.
    pub work: u64,
    /// Nanoseconds, the median.
    pub ns: f64,
    /// The middle half.
    pub quartiles_ns: [f64; 2],
}

/// A fitted law of growth.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Fit {
    /// Nanoseconds whatever the work.
    pub fixed_ns: f64,
    /// Nanoseconds of one unit, where the exponent is 1.
    pub factor_ns: f64,
    /// The exponent.
    pub exponent: f64,
    /// The largest |ln(measured / fitted)| of a step.
    pub residual: f64,
}

/// A sentence of the documents about cost or quality, and what was measured.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Claim {
    /// A name of its own.
    pub id: String,
    /// Where it is from: `000 §6.4`.
    pub source: String,
    /// What is claimed, in our words.
    pub claim: String,
    /// The group that it is measured in.
    pub group: String,
    /// The row that the claim is about, and the one that it is held against.
    pub rows: [String; 2],
    /// Time of the first over that of the second.
    pub ratio: f64,
    /// Its spread.
    pub spread: [f64; 2],
    /// What the error figure is, in words.
    pub error_is: String,
    /// The error figure, as the sentence has it.
    pub error: Number,
    /// Whether the claim holds here; `None` where a tie leaves it open.
    pub holds: Option<bool>,
    /// The sentence, with both figures.
    pub sentence: String,
}
