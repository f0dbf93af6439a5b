//! What was judged and what came of it: the JSON of `run`, `gate` and `merge`.

mod blend;
mod diagnosis;
mod problem;
mod sample;
mod shader;
mod stability;

pub use blend::{BlendPromise, BlendState, SpecialUse, StoreUse, Tiers};
pub use diagnosis::{
    Counted, Diagnosis, Explanation, FailingOutput, OtherFormulas, Standing, Telling, ToldApart, WrongParameter,
};
pub use problem::{Problem, ProblemKind, Sentence};
pub use sample::{GroupSample, SampledRows, SampledStores, StoresOfState};
pub use shader::{BoundVariable, FoundBy, HeldInput, JudgedAs, MistakePlace, ShaderUse};
pub use stability::{Cost, Examined, StableForm};

use crate::by_case::{
    CaseCounts, CaseTotals, ComparedBy, Coverage, FailedAnswer, KnownFailure, RendererIdentity, RendererUse,
    SourcePlace, is_zero,
};
use crate::count::counters;
use crate::explained::Explained;
use crate::hash::hash;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

/// The schema of [`Report`].
pub const SCHEMA: &str = "lightmeter.report/2";

/// How a subject is named in reports.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Identity {
    /// The short name.
    pub name: String,
    /// The device as the driver names it.
    pub device: String,
    /// `vulkan`, `gl` or `embedded`.
    pub backend: Word,
    /// The driver and its version.
    pub driver: String,
}

impl From<&RendererIdentity> for Identity {
    /// A renderer, as of an adapter.
    fn from(renderer: &RendererIdentity) -> Self {
        Self {
            name: renderer.name.clone(),
            device: renderer.device.clone().unwrap_or_else(|| renderer.name.clone()),
            backend: "renderer".into(),
            driver: renderer.driver.clone().unwrap_or_else(|| renderer.version.clone()),
        }
    }
}

counters! {
    /// Counts of verdicts.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
    pub struct Totals {
        /// Cases, each counted once for an adapter and stage.
        pub cases: u64,
        /// Scalar outputs judged.
        pub verdicts: u64,
        /// Inside the interval.
        pub passed: u64,
        /// Outside.
        pub failed: u64,
        /// Outside, as a named deviation says.
        pub expected_failures: u64,
        /// Inside at the witness of a named deviation, which is no longer needed.
        pub unexpected_passes: u64,
        /// Cases that the adapter cannot evaluate.
        pub skipped: u64,
        /// Where the rules permit anything.
        pub indeterminate: u64,
        /// Groups that fail as a whole, although each verdict is legal.
        pub failed_groups: u64,
    }
}

/// A group on an adapter in a stage.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Group {
    /// `family/formula`.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The stage's name.
    pub stage: Word,
    /// The format that the blend unit worked on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<Word>,
    /// Values by how near they come, on a target of 8 bits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tiers: Option<Tiers>,
    /// How values are stored, on a target of 8 bits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub store: Option<StoreUse>,
    /// The counts.
    #[serde(flatten)]
    pub totals: Totals,
    /// The greatest error of a verdict that is not indeterminate, in ULP of the output's format or in its steps.
    pub error_ulp_max: Number,
    /// The greatest margin.
    pub margin_max: Number,
    /// Time spent on the group on this adapter in this stage.
    pub seconds: f64,
    /// Time that drawing it takes once every pipeline is compiled, where that was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds_warm: Option<f64>,
    /// The case of the greatest margin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst: Option<String>,
    /// What was answered to it, at the output that the margin is of; missing where no row of inputs was answered, as by a blend unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst_answer: Option<WorstAnswer>,
    /// Why the group is skipped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skip_reason: Option<Word>,
    /// What explains what failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diagnosis: Option<Diagnosis>,
    /// Why the group fails as a whole.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub problems: Vec<Problem>,
    /// Why it fails as a whole, as a known failure says that it does.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub expected_problems: Vec<Problem>,
    /// Of a scene's image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<ImageUse>,
    /// The same counted by cases, where that was asked for: of renderers always.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_case: Option<CaseCounts>,
    /// Where the renderer's code of it stands, where its hello says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<SourcePlace>,
    /// What a shard keeps for the diagnosis of the whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<GroupSample>,
}

/// What was answered to the case of the greatest margin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WorstAnswer {
    /// The scalar output's name.
    pub output: String,
    /// What came out.
    pub value: Number,
    /// The f64 reference.
    pub reference: Number,
    /// The least and the greatest legal value.
    pub interval: [Number; 2],
}

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

impl Group {
    /// Whether the case of an id is one of the group's, which its name alone does not tell: `fog/exp` has none of `fog/exp-radial`.
    #[must_use]
    pub fn has_case(&self, id: &str) -> bool {
        id.strip_prefix(&self.id).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
    }

    /// What the first explanation of its failures says, with its mistakes' names.
    #[must_use]
    pub fn cause(&self) -> Option<String> {
        self.diagnosis.as_ref().and_then(Diagnosis::cause)
    }

    /// The mistakes that explain its failures together.
    #[must_use]
    pub fn mistakes(&self) -> &[Word] {
        self.diagnosis.as_ref().map_or(&[], Diagnosis::mistakes)
    }

    /// What is known of why it fails, each in a sentence: what explains its failures, and what is wrong with the whole.
    pub fn reasons(&self) -> impl Iterator<Item = String> + '_ {
        self.diagnosis.iter().map(ToString::to_string).chain(self.problem())
    }

    /// What is wrong with the whole as a known failure says, in a sentence.
    #[must_use]
    pub fn expected_problem(&self) -> Option<String> {
        told_together(&self.expected_problems)
    }

    /// What is wrong with the whole, in a sentence.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        told_together(&self.problems)
    }

    /// Whether something fails that is not expected to, or was not answered.
    #[must_use]
    pub fn is_failed(&self) -> bool {
        self.totals.failed > 0 || !self.problems.is_empty() || self.by_case.as_ref().is_some_and(CaseCounts::is_failed)
    }

    /// The format that was blended on; of a scene, which is drawn on one as well, none.
    #[must_use]
    pub fn blended_on(&self) -> Option<&Word> {
        self.target.as_ref().filter(|_| !self.id.starts_with("scene/"))
    }

    /// The cases of a renderer's group: how many of which fate. `None` of a group whose verdicts are counted.
    #[must_use]
    pub fn asked(&self) -> Option<&CaseCounts> {
        self.by_case.as_ref().filter(|_| self.stage == "answer")
    }

    /// Its name: of a renderer's, the id and the format that was blended on.
    #[must_use]
    pub fn name(&self) -> String {
        match (self.asked(), self.blended_on()) {
            (None, _) => format!("{} on {}, {}", self.id, self.adapter, self.place()),
            (Some(_), Some(target)) => format!("{} on {target}", self.id),
            (Some(_), None) => self.id.clone(),
        }
    }

    /// A group of nothing yet.
    #[must_use]
    pub fn new(id: String, adapter: String, stage: impl Into<Word>) -> Self {
        Self {
            id,
            adapter,
            stage: stage.into(),
            target: None,
            tiers: None,
            store: None,
            totals: Totals::default(),
            error_ulp_max: Number(0.0),
            margin_max: Number(0.0),
            seconds: 0.0,
            seconds_warm: None,
            worst: None,
            worst_answer: None,
            skip_reason: None,
            diagnosis: None,
            problems: vec![],
            expected_problems: vec![],
            image: None,
            by_case: None,
            source: None,
            sample: None,
        }
    }

    /// The stage, and for a blend unit the target.
    #[must_use]
    pub fn place(&self) -> String {
        self.target.as_ref().map_or(self.stage.to_string(), |target| format!("{} on {target}", self.stage))
    }
}

/// Problems in a sentence.
fn told_together(problems: &[Problem]) -> Option<String> {
    let says: Vec<String> = problems.iter().map(ToString::to_string).collect();
    (!says.is_empty()).then(|| says.join("; "))
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

/// A value outside its interval.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Failure {
    /// The case.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The stage's name.
    pub stage: Word,
    /// The format that the blend unit worked on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<Word>,
    /// How the state reached the blend unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub route: Option<Word>,
    /// The scalar output's name.
    pub output: String,
    /// The inputs by name.
    pub inputs: serde_json::Map<String, serde_json::Value>,
    /// The units of those that have one.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub units: BTreeMap<String, Word>,
    /// Their bits.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub inputs_hex: serde_json::Map<String, serde_json::Value>,
    /// The f64 reference.
    pub reference: Number,
    /// The least and the greatest legal value.
    pub interval: [Number; 2],
    /// What is legal in words, where an interval does not say it: of a special value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub promise: Option<String>,
    /// What came out.
    pub value: Number,
    /// Its bits.
    pub value_hex: String,
    /// Whether it was never written.
    pub unwritten: bool,
    /// The error in ULP of the output's format, or in its steps.
    pub error_ulp: Number,
    /// The command that runs the case alone.
    pub rerun: String,
    /// All that was answered to the case, where it was answered as a whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub answer: Option<FailedAnswer>,
}

impl Failure {
    /// The format that was blended on; of a scene, which is drawn on one as well, none.
    #[must_use]
    pub fn blended_on(&self) -> Option<&Word> {
        self.target.as_ref().filter(|_| !self.id.starts_with("scene/"))
    }

    /// A failure without inputs and numbers.
    #[must_use]
    pub fn new(id: String, adapter: String, stage: impl Into<Word>) -> Self {
        let none = Number(f64::NAN);
        Self {
            id,
            adapter,
            stage: stage.into(),
            target: None,
            route: None,
            output: String::new(),
            inputs: serde_json::Map::new(),
            units: BTreeMap::new(),
            inputs_hex: serde_json::Map::new(),
            reference: none,
            interval: [none; 2],
            promise: None,
            value: none,
            value_hex: String::new(),
            unwritten: false,
            error_ulp: none,
            rerun: String::new(),
            answer: None,
        }
    }
}

/// A named deviation that was granted or asked for.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct DeviationUse {
    /// The deviation's name.
    pub name: Word,
    /// The adapter's short name.
    pub adapter: String,
    /// Why it is granted.
    pub reason: Word,
    /// Whether its witness still shows it; where not, the deviation is no longer needed.
    pub still_needed: bool,
    /// Verdicts that it excused, the witness apart.
    pub excused: u64,
}

/// Where the time of a run went, in seconds of this process.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct Timing {
    /// Drawing inputs, for the most part on a thread of its own, beside the rest.
    pub generate: f64,
    /// Shaders parsed and pipelines made.
    pub compile: f64,
    /// Reference values and intervals, of formulas likewise.
    pub reference: f64,
    /// Handing work to devices, and waiting for it: drivers compile at the first use of a pipeline.
    pub devices: f64,
    /// Verdicts.
    pub judge: f64,
    /// What explains wrong values, and what is wrong with all values of a formula together.
    #[serde(default)]
    pub diagnose: f64,
}

impl Timing {
    /// The sum.
    pub fn add(&mut self, other: &Self) {
        self.generate += other.generate;
        self.compile += other.compile;
        self.reference += other.reference;
        self.devices += other.devices;
        self.judge += other.judge;
        self.diagnose += other.diagnose;
    }
}

/// A run, a bench, a self-test or probes that ended before their time.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Interrupted {
    /// What was under way.
    pub under_way: String,
    /// What the device said, or who stopped the run.
    pub message: String,
    /// The number of the signal that stopped it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub signal: Option<i32>,
    /// Whether the first failure ended it, as was asked.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub at_first_failure: bool,
}

impl Interrupted {
    /// A device failed.
    #[must_use]
    pub fn by_device(under_way: &str, error: &impl Display) -> Self {
        Self { under_way: under_way.into(), message: error.to_string(), signal: None, at_first_failure: false }
    }
}

impl Display for Interrupted {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} was under way: {}", self.under_way, self.message)
    }
}

/// What a project's `lightmeter.toml` said, in the place of options that were not given.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ConfigUse {
    /// The file, as it is called from the folder of the command.
    pub file: String,
    /// The options with their values.
    pub settings: serde_json::Map<String, serde_json::Value>,
}

impl std::fmt::Display for ConfigUse {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let settings: Vec<String> = self
            .settings
            .iter()
            .map(|(name, value)| format!("{name} {}", value.as_str().unwrap_or_default()))
            .collect();
        write!(f, "{}: {}", self.file, settings.join(", "))
    }
}

/// What was judged and what came of it, whoever answered.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Report {
    /// `lightmeter.report/2`.
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
    /// The seed of random cases.
    pub seed: u64,
    /// Wall time.
    pub seconds: f64,
    /// The accuracy profile.
    pub profile: Word,
    /// The globs that cases were chosen by; none for all.
    pub filter: Vec<String>,
    /// What was judged.
    pub adapters: Vec<Identity>,
    /// The part of the chosen cases that had to be judged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub required: Option<Number>,
    /// The sum over the groups.
    pub totals: Totals,
    /// The same of cases, where they are counted: of a renderer always.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_case: Option<CaseTotals>,
    /// States judged under another's name: how many of the selected.
    pub aliases: u64,
    /// How blend states reached the blend unit: states by route.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub routes: serde_json::Map<String, serde_json::Value>,
    /// Where the time went.
    pub timing: Timing,
    /// Named deviations in force.
    pub deviations: Vec<DeviationUse>,
    /// The groups.
    pub groups: Vec<Group>,
    /// Each blend state on each target.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blend_states: Vec<BlendState>,
    /// What blend units left of NaN and infinity, of which nothing is promised.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub special: Vec<SpecialUse>,
    /// What interfaces say of NaN and infinity in blending, where any was judged.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blend_promises: Vec<BlendPromise>,
    /// How many times more than its condition explains a form may err before it is called unstable, where any was examined.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unstable_beyond: Option<f64>,
    /// Every stable form of the suite, in the order of reports, where any hard case was examined.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stable_forms: Vec<StableForm>,
    /// Hard cases by their stable and their naive form.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stability: Vec<Examined>,
    /// What stable forms take beside naive ones, where that was measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stable_costs: Vec<Cost>,
    /// What was under way when a device failed, which ended the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interrupted: Option<Interrupted>,
    /// What there is to know of the result besides.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<Sentence>,
    /// Failures, the first of each group.
    pub failures: Vec<Failure>,
    /// Who answered, where that is another renderer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub renderer: Option<RendererUse>,
    /// Cases whose answer changed when they were asked once more: how many there are.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub unstable: u64,
    /// The first 1,000 of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unstable_cases: Vec<String>,
    /// Known failures, and what became of their cases.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub expectations: Vec<KnownFailure>,
    /// What is worse than in the baseline.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub regressions: Vec<String>,
    /// What is better than in the baseline.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mended: Vec<String>,
    /// What the baseline has not.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub added: Vec<String>,
    /// What explains the first failing case of each formula and, where few were judged, the worst case of those that pass.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub explained: Vec<Explained>,
    /// What chose the cases, and the version of what draws them, where a later run may be compared with this one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compared_by: Option<ComparedBy>,
    /// What a project's `lightmeter.toml` said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub config: Option<ConfigUse>,
    /// The shader that was judged in the place of the suite's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shader: Option<ShaderUse>,
    /// The hash of the text of all shader files, where some were judged that are not the suite's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shaders_hash: Option<String>,
}

impl Report {
    /// A report of nothing yet.
    #[must_use]
    pub fn empty(seed: u64, profile: Word, filter: Vec<String>, adapters: Vec<Identity>) -> Self {
        Self {
            schema: SCHEMA.into(),
            command: None,
            version: Some(env!("CARGO_PKG_VERSION").into()),
            made_at: None,
            seed,
            seconds: 0.0,
            profile,
            filter,
            adapters,
            required: None,
            totals: Totals::default(),
            by_case: None,
            aliases: 0,
            routes: serde_json::Map::new(),
            timing: Timing::default(),
            deviations: vec![],
            groups: vec![],
            blend_states: vec![],
            special: vec![],
            blend_promises: vec![],
            unstable_beyond: None,
            stable_forms: vec![],
            stability: vec![],
            stable_costs: vec![],
            interrupted: None,
            notes: vec![],
            failures: vec![],
            renderer: None,
            unstable: 0,
            unstable_cases: vec![],
            expectations: vec![],
            regressions: vec![],
            mended: vec![],
            added: vec![],
            explained: vec![],
            compared_by: None,
            config: None,
            shader: None,
            shaders_hash: None,
        }
    }

    /// Expected failures none of whose cases failed. In a shard, whose cases are a part of theirs, nobody can tell.
    pub fn passing_unexpectedly(&self) -> impl Iterator<Item = &KnownFailure> {
        let is_shard = self.compared_by.as_ref().is_some_and(|by| by.shard.is_some());
        self.expectations.iter().filter(move |expected| !is_shard && expected.passes_unexpectedly())
    }

    /// Counts verdicts that a named deviation of an adapter excused.
    pub fn excuse(&mut self, deviation: &str, adapter: &str, verdicts: u64) {
        let is_it = |known: &&mut DeviationUse| known.name == deviation && known.adapter == adapter;
        if let Some(known) = self.deviations.iter_mut().find(is_it) {
            known.excused += verdicts;
        }
    }

    /// Sums the groups up.
    pub fn sum_up(&mut self) {
        self.totals = Totals::default();
        self.groups.iter().for_each(|group| self.totals.add(&group.totals));
        self.by_case = self.groups.iter().any(|group| group.by_case.is_some()).then(|| self.cases());
    }

    /// The cases of all groups, where they are counted: how many of which fate.
    #[must_use]
    pub fn cases(&self) -> CaseTotals {
        let mut all = CaseTotals::default();
        self.groups.iter().filter_map(|group| group.by_case.as_ref()).for_each(|counts| all.add(&counts.totals));
        all
    }

    /// How many of the cases that were chosen were judged.
    #[must_use]
    pub fn coverage(&self) -> Coverage {
        if self.renderer.is_none() {
            let Totals { cases, skipped, .. } = self.totals;
            return Coverage { chosen: cases, judged: cases.saturating_sub(skipped), excluded: skipped };
        }
        let CaseTotals { asked, not_asked, skipped, missing, .. } = self.cases();
        Coverage {
            chosen: asked.saturating_add(not_asked),
            judged: asked.saturating_sub(skipped).saturating_sub(missing),
            excluded: not_asked.saturating_add(skipped),
        }
    }

    /// Whether a renderer that was asked broke off, or wrote what is no answer.
    #[must_use]
    pub fn is_broken(&self) -> bool {
        self.renderer.as_ref().is_some_and(RendererUse::is_broken)
    }

    /// Whether anything was judged: a verdict that is decided, or, where nothing else was asked for, a witness of a named deviation.
    #[must_use]
    pub fn has_judged(&self) -> bool {
        let Totals { cases, verdicts, indeterminate, .. } = self.totals;
        verdicts > indeterminate || (cases == 0 && !self.deviations.is_empty())
    }

    /// Whether anything fails that is not expected to, or passes that is.
    #[must_use]
    pub fn is_failed(&self) -> bool {
        self.totals.failed > 0
            || self.totals.unexpected_passes > 0
            || self.totals.failed_groups > 0
            || self.unstable > 0
            || !self.regressions.is_empty()
            || self.passing_unexpectedly().next().is_some()
            || self.groups.iter().any(Group::is_failed)
    }

    /// Whether all went as expected.
    #[must_use]
    pub fn is_success(&self) -> bool {
        self.interrupted.is_none() && !self.is_failed() && !self.is_broken()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_has_its_own_cases_and_none_of_a_longer_name() {
        let group = Group::new("fog/exp".into(), "adapter".into(), "compute");
        for id in ["fog/exp", "fog/exp/random/000001", "fog/exp/hard/far"] {
            assert!(group.has_case(id), "{id}");
        }
        for id in ["fog/exp-radial/random/000001", "fog/exp2-opengl", "fog", "fog/ex"] {
            assert!(!group.has_case(id), "{id}");
        }
    }
}
