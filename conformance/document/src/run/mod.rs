//! The JSON of `run`.

mod blend;
mod shader;
mod stability;

pub use blend::{BlendPromise, BlendState, SpecialUse, StoreUse, StoresOfShard, Tiers};
pub use shader::{BoundVariable, FoundBy, JudgedAs, MistakePlace, ShaderUse};
pub use stability::{Cost, Examined, StableForm};

use crate::by_case::{CaseCounts, ComparedBy, Coverage, FailedAnswer, KnownFailure, RendererUse, SourcePlace};
use crate::explained::Explained;
use crate::hash::hash;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

/// The schema of [`Report`].
pub const SCHEMA: &str = "lightmeter.run/1";

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

impl Totals {
    /// The sum.
    pub fn add(&mut self, other: &Self) {
        self.cases = self.cases.saturating_add(other.cases);
        self.verdicts = self.verdicts.saturating_add(other.verdicts);
        self.passed = self.passed.saturating_add(other.passed);
        self.failed = self.failed.saturating_add(other.failed);
        self.expected_failures = self.expected_failures.saturating_add(other.expected_failures);
        self.unexpected_passes = self.unexpected_passes.saturating_add(other.unexpected_passes);
        self.skipped = self.skipped.saturating_add(other.skipped);
        self.indeterminate = self.indeterminate.saturating_add(other.indeterminate);
        self.failed_groups = self.failed_groups.saturating_add(other.failed_groups);
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
    /// What a shard's values say of how they are stored, for the whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stores: Option<StoresOfShard>,
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
    /// The mistake that explains what failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explanation: Option<String>,
    /// What the renderer did wrong, in words, without how many failures it explains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cause: Option<String>,
    /// The names of the mistakes that explain what failed together.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mistakes: Vec<String>,
    /// Why the group fails as a whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
    /// Why it fails as a whole, as a known failure says that it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected_problem: Option<String>,
    /// Of a scene's image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<ImageUse>,
    /// The same counted by cases, where that was asked for: of renderers always.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_case: Option<CaseCounts>,
    /// Where the renderer's code of it stands, where its hello says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<SourcePlace>,
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
    /// The first intermediate result in which a wrong image departs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub departs_in: Option<Word>,
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
            stores: None,
            totals: Totals::default(),
            error_ulp_max: Number(0.0),
            margin_max: Number(0.0),
            seconds: 0.0,
            seconds_warm: None,
            worst: None,
            worst_answer: None,
            skip_reason: None,
            explanation: None,
            cause: None,
            mistakes: vec![],
            problem: None,
            expected_problem: None,
            image: None,
            by_case: None,
            source: None,
        }
    }

    /// The stage, and for a blend unit the target.
    #[must_use]
    pub fn place(&self) -> String {
        self.target.as_ref().map_or(self.stage.to_string(), |target| format!("{} on {target}", self.stage))
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

/// The JSON of `run`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Report {
    /// `lightmeter.run/1`.
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

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
const fn is_zero(count: &u64) -> bool {
    *count == 0
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

    /// How many of the cases that were chosen were judged.
    #[must_use]
    pub const fn coverage(&self) -> Coverage {
        let Totals { cases, skipped, .. } = self.totals;
        Coverage { chosen: cases, judged: cases.saturating_sub(skipped), excluded: skipped }
    }

    /// Whether all went as expected.
    #[must_use]
    pub fn is_success(&self) -> bool {
        let is_failed = |group: &Group| group.by_case.as_ref().is_some_and(CaseCounts::is_failed);
        self.interrupted.is_none()
            && self.totals.failed == 0
            && self.totals.unexpected_passes == 0
            && self.totals.failed_groups == 0
            && self.unstable == 0
            && self.regressions.is_empty()
            && self.passing_unexpectedly().next().is_none()
            && !self.groups.iter().any(is_failed)
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
