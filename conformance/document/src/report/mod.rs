//! What was judged and what came of it: the JSON of `run`, `gate` and `merge`.

mod blend;
mod diagnosis;
mod failure;
mod group;
mod image;
mod problem;
mod review;
mod sample;
mod shader;
mod stability;

pub use blend::{BlendPromise, BlendState, SpecialUse, StoreUse, Tiers};
pub use diagnosis::{
    Counted, Diagnosis, Explanation, FailingOutput, OtherFormulas, PartDiagnosis, Standing, Telling, ToldApart,
    WrongParameter,
};
pub use failure::Failure;
pub use group::{Group, Totals, WorstAnswer};
pub use image::{BiasUnit, Departure, EffectsCost, ImageBias, ImageUse, PixelUse};
pub use problem::{Problem, ProblemKind, Sentence};
pub use review::{
    FailingStep, JudgedStep, RefusedName, ShaderReview, ShaderStep, ShaderSum, StepFunction, StepParameter, StepVerdict,
};
pub use sample::{GroupSample, SampledRows, SampledStores, StoresOfState};
pub use shader::{BoundVariable, FoundBy, HeldInput, JudgedAs, MistakePlace, ShaderUse};
pub use stability::{Cost, Examined, StableForm};

use crate::by_case::{CaseTotals, ComparedBy, Coverage, KnownFailure, RendererIdentity, RendererUse, is_zero};
use crate::explained::Explained;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
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
    /// The shaders whose steps were looked at.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shaders: Vec<ShaderReview>,
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
            shaders: vec![],
        }
    }

    /// Expected failures none of whose cases failed. In a shard, whose cases are a part of theirs, nobody can tell.
    pub fn passing_unexpectedly(&self) -> impl Iterator<Item = &KnownFailure> {
        let is_shard = self.compared_by.as_ref().is_some_and(|by| by.shard.is_some());
        // What was judged of an interrupted run are the first cases alone.
        let is_whole = !is_shard && self.interrupted.is_none();
        self.expectations.iter().filter(move |expected| is_whole && expected.passes_unexpectedly())
    }

    /// Counts verdicts that a named deviation of an adapter excused.
    pub fn excuse(&mut self, deviation: &str, adapter: &str, verdicts: u64) {
        let is_it = |known: &&mut DeviationUse| known.name == deviation && known.adapter == adapter;
        if let Some(known) = self.deviations.iter_mut().find(is_it) {
            known.excused += verdicts;
        }
    }

    /// The same without what differs whenever it is made: when that was, how it was asked for, and what it took.
    #[must_use]
    pub fn without_times(&self) -> Self {
        let mut same = Self {
            command: None,
            made_at: None,
            seconds: 0.0,
            timing: Timing::default(),
            stable_costs: vec![],
            ..self.clone()
        };
        for group in &mut same.groups {
            (group.seconds, group.seconds_warm) = (0.0, None);
            if let Some(image) = &mut group.image {
                image.cost = None;
            }
        }
        same
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

    /// How many of the cases that were chosen were judged. What a renderer does not declare is chosen only where the filter has its name.
    #[must_use]
    pub fn coverage(&self) -> Coverage {
        if self.renderer.is_none() {
            let Totals { cases, skipped, .. } = self.totals;
            return Coverage { chosen: cases, judged: cases.saturating_sub(skipped), excluded: skipped };
        }
        let CaseTotals { asked, skipped, missing, .. } = self.cases();
        let named = self.groups_not_asked().filter(|group| self.is_named(group));
        let not_asked =
            named.filter_map(Group::asked).fold(0, |sum: u64, one| sum.saturating_add(one.totals.not_asked));
        Coverage {
            chosen: asked.saturating_add(not_asked),
            judged: asked.saturating_sub(skipped).saturating_sub(missing),
            excluded: not_asked.saturating_add(skipped),
        }
    }

    /// How many of the formulas and scenes that the filter selects the renderer declares, and how many there are; `None` where it declares
    /// all of them.
    #[must_use]
    pub fn declared(&self) -> Option<[usize; 2]> {
        let lacking: BTreeSet<&str> = self.groups_not_asked().map(|group| group.id.as_str()).collect();
        let is_asked = |group: &&Group| group.asked().is_some_and(|counts| counts.totals.asked > 0);
        let asked: BTreeSet<&str> = self.groups.iter().filter(is_asked).map(|group| group.id.as_str()).collect();
        (!lacking.is_empty()).then(|| [asked.len(), asked.union(&lacking).count()])
    }

    /// The groups that a renderer does not declare.
    fn groups_not_asked(&self) -> impl Iterator<Item = &Group> {
        self.groups.iter().filter(|group| group.is_not_asked())
    }

    /// Whether the filter has the name of a formula or a scene, or of a case of it.
    #[must_use]
    pub fn is_named(&self, group: &Group) -> bool {
        let globs = self.compared_by.iter().flat_map(|by| &by.choice.filter);
        let below =
            |glob: &str| glob.strip_prefix(&group.id).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        globs.into_iter().any(|glob| below(glob))
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
