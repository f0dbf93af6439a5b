//! The result of a run as data: what the JSON of `run` holds.

pub mod junit;
pub mod page;
pub mod selftest;
pub mod special;
pub mod text;

use crate::options::Options;
use crate::stability::{Cost, Examined};
use crate::subject::{Identity, Subject};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number that may be NaN or infinite, which JSON writes as a string.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number(pub f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() { serializer.serialize_f64(self.0) } else { serializer.serialize_str(&self.to_string()) }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Number(f64),
            Name(String),
        }
        match Written::deserialize(deserializer)? {
            Written::Number(number) => Ok(Self(number)),
            Written::Name(name) => match name.as_str() {
                "NaN" => Ok(Self(f64::NAN)),
                "Inf" => Ok(Self(f64::INFINITY)),
                "-Inf" => Ok(Self(f64::NEG_INFINITY)),
                _ => Err(serde::de::Error::custom(format!("expected a number, NaN, Inf or -Inf, not {name:?}"))),
            },
        }
    }
}

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            x if x.is_nan() => f.write_str("NaN"),
            x if x == f64::INFINITY => f.write_str("Inf"),
            x if x == f64::NEG_INFINITY => f.write_str("-Inf"),
            x if x == 0.0 || (1e-4..1e7).contains(&x.abs()) => write!(f, "{x}"),
            x => write!(f, "{x:e}"),
        }
    }
}

/// Counts of verdicts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
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
        self.cases += other.cases;
        self.verdicts += other.verdicts;
        self.passed += other.passed;
        self.failed += other.failed;
        self.expected_failures += other.expected_failures;
        self.unexpected_passes += other.unexpected_passes;
        self.skipped += other.skipped;
        self.indeterminate += other.indeterminate;
        self.failed_groups += other.failed_groups;
    }
}

/// Values on a target of 8 bits by how near they come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tiers {
    /// The formula gives a whole step, and it came out.
    pub exact: u64,
    /// The nearest step.
    pub nearest: u64,
    /// The other neighbour.
    pub neighbour: u64,
    /// Farther, but within the format's bound.
    pub bound: u64,
    /// Outside.
    pub outside: u64,
}

impl Tiers {
    /// The sum.
    pub fn add(&mut self, other: &Self) {
        self.exact += other.exact;
        self.nearest += other.nearest;
        self.neighbour += other.neighbour;
        self.bound += other.bound;
        self.outside += other.outside;
    }

    /// Each with its name.
    #[must_use]
    pub const fn named(&self) -> [(&'static str, u64); 5] {
        [
            ("exact", self.exact),
            ("nearest", self.nearest),
            ("neighbour", self.neighbour),
            ("bound", self.bound),
            ("outside", self.outside),
        ]
    }
}

/// How a target's values are stored, told from many of them together.
#[derive(Clone, Debug, Serialize)]
pub struct StoreUse {
    /// The store that most values speak for, or the model that all of them follow.
    pub identified: &'static str,
    /// The share of the values that are as it would have them.
    pub share: f64,
    /// Values that tell stores apart.
    pub of: u64,
    /// Their mean error with its sign, in steps.
    pub bias: f64,
}

/// A blend state by one route on a target.
#[derive(Clone, Debug, Serialize)]
pub struct BlendState {
    /// The state's id.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The target's format.
    pub target: &'static str,
    /// How the state reached the unit.
    pub route: &'static str,
    /// Pixels.
    pub cases: u64,
    /// Components outside what is legal.
    pub failed: u64,
    /// The greatest error: ULP on float targets, steps on those of 8 bits.
    pub error_max: Number,
    /// On targets of 8 bits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tiers: Option<Tiers>,
    /// Why it was not drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skip_reason: Option<&'static str>,
}

/// NaN or infinity in a blend unit.
#[derive(Clone, Debug, Serialize)]
pub struct SpecialUse {
    /// The case.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The target's format.
    pub target: &'static str,
    /// What was left of the colour.
    pub seen: String,
    /// What is on record for the driver.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recorded: Option<&'static str>,
}

impl SpecialUse {
    /// Whether it is what is on record, if anything is.
    #[must_use]
    pub fn is_as_recorded(&self) -> bool {
        self.recorded.is_none_or(|recorded| recorded == self.seen)
    }
}

/// A group on an adapter in a stage.
#[derive(Clone, Debug, Serialize)]
pub struct Group {
    /// `family/formula`.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The stage's name.
    pub stage: &'static str,
    /// The format that the blend unit worked on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<&'static str>,
    /// Values by how near they come, on a target of 8 bits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tiers: Option<Tiers>,
    /// How values are stored, on a target of 8 bits.
    #[serde(skip_serializing_if = "Option::is_none")]
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
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds_warm: Option<f64>,
    /// The case of the greatest margin.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst: Option<String>,
    /// Why the group is skipped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skip_reason: Option<&'static str>,
    /// The mistake that explains what failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub explanation: Option<String>,
    /// Why the group fails as a whole.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
    /// Of a scene's image.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub image: Option<ImageUse>,
}

/// An image of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct ImageUse {
    /// Pixels.
    pub width: usize,
    /// Pixels.
    pub height: usize,
    /// Judged pixels of which several outcomes are legal that differ by more than twice the widest of them.
    pub marked: u64,
    /// Of the shader with all effects: pixels that are not, bit for bit, those of the composed shaders.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub differs_from_composed: Option<u64>,
    /// Of the shader with all effects: what they cost, where that was measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cost: Option<EffectsCost>,
    /// The first intermediate result in which a wrong image departs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub departs_in: Option<&'static str>,
    /// Reference, result and error map of a wrong image.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<String>,
}

impl Group {
    /// A group of nothing yet.
    #[must_use]
    pub fn new(id: String, adapter: String, stage: &'static str) -> Self {
        Self {
            id,
            adapter,
            stage,
            target: None,
            tiers: None,
            store: None,
            totals: Totals::default(),
            error_ulp_max: Number(0.0),
            margin_max: Number(0.0),
            seconds: 0.0,
            seconds_warm: None,
            worst: None,
            skip_reason: None,
            explanation: None,
            problem: None,
            image: None,
        }
    }

    /// The stage, and for a blend unit the target.
    #[must_use]
    pub fn place(&self) -> String {
        self.target.map_or(self.stage.into(), |target| format!("{} on {target}", self.stage))
    }
}

/// What drawing a scene takes by composed shaders, and by the one with all effects, in turns.
#[derive(Clone, Copy, Debug, Serialize)]
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
#[derive(Clone, Debug, Serialize)]
pub struct Failure {
    /// The case.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The stage's name.
    pub stage: &'static str,
    /// The format that the blend unit worked on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<&'static str>,
    /// How the state reached the blend unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub route: Option<&'static str>,
    /// The scalar output's name.
    pub output: String,
    /// The inputs by name.
    pub inputs: serde_json::Map<String, serde_json::Value>,
    /// Their bits.
    pub inputs_hex: serde_json::Map<String, serde_json::Value>,
    /// The f64 reference.
    pub reference: Number,
    /// The least and the greatest legal value.
    pub interval: [Number; 2],
    /// What is legal in words, where an interval does not say it: of a special value.
    #[serde(skip_serializing_if = "Option::is_none")]
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
}

/// A named deviation that was granted or asked for.
#[derive(Clone, Debug, Serialize)]
pub struct DeviationUse {
    /// The deviation's name.
    pub name: &'static str,
    /// The adapter's short name.
    pub adapter: String,
    /// Why it is granted.
    pub reason: &'static str,
    /// Whether its witness still shows it; where not, the deviation is no longer needed.
    pub still_needed: bool,
    /// Verdicts that it excused, the witness apart.
    pub excused: u64,
}

/// Where the time of a run went, in seconds of this process.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Timing {
    /// Drawing inputs.
    pub generate: f64,
    /// Shaders parsed and pipelines made.
    pub compile: f64,
    /// Reference values and intervals.
    pub reference: f64,
    /// Handing work to devices, and waiting for it: drivers compile at the first use of a pipeline.
    pub devices: f64,
    /// Verdicts.
    pub judge: f64,
}

/// A run that ended before its time.
#[derive(Clone, Debug, Serialize)]
pub struct Interrupted {
    /// What was under way.
    pub under_way: String,
    /// What the device said.
    pub message: String,
}

/// The JSON of `run`.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// `lightmeter.run/1`.
    pub schema: &'static str,
    /// The seed of random cases.
    pub seed: u64,
    /// Wall time.
    pub seconds: f64,
    /// The accuracy profile.
    pub profile: &'static str,
    /// The globs that cases were chosen by; none for all.
    pub filter: Vec<String>,
    /// What was judged.
    pub adapters: Vec<Identity>,
    /// The sum over the groups.
    pub totals: Totals,
    /// States judged under another's name: how many of the selected.
    pub aliases: u64,
    /// How blend states reached the blend unit: states by route.
    #[serde(skip_serializing_if = "serde_json::Map::is_empty")]
    pub routes: serde_json::Map<String, serde_json::Value>,
    /// Where the time went.
    pub timing: Timing,
    /// Named deviations in force.
    pub deviations: Vec<DeviationUse>,
    /// The groups.
    pub groups: Vec<Group>,
    /// Each blend state on each target.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub blend_states: Vec<BlendState>,
    /// What blend units left of NaN and infinity, of which nothing is promised.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub special: Vec<SpecialUse>,
    /// Hard cases by their stable and their naive form.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stability: Vec<Examined>,
    /// What stable forms take beside naive ones, where that was measured.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stable_costs: Vec<Cost>,
    /// What was under way when a device failed, which ended the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interrupted: Option<Interrupted>,
    /// Failures, the first of each group.
    pub failures: Vec<Failure>,
}

impl Report {
    /// A report of nothing yet.
    #[must_use]
    pub fn empty(subjects: &[Subject], options: &Options) -> Self {
        Self {
            schema: "lightmeter.run/1",
            seed: options.seed,
            seconds: 0.0,
            profile: options.profile.name,
            filter: options.filter.globs().map(str::to_owned).collect(),
            adapters: subjects.iter().map(|subject| subject.identity.clone()).collect(),
            totals: Totals::default(),
            aliases: 0,
            routes: serde_json::Map::new(),
            timing: Timing::default(),
            deviations: vec![],
            groups: vec![],
            blend_states: vec![],
            special: vec![],
            stability: vec![],
            stable_costs: vec![],
            interrupted: None,
            failures: vec![],
        }
    }

    /// Counts verdicts that a named deviation of an adapter excused.
    pub(crate) fn excuse(&mut self, deviation: &str, adapter: &str, verdicts: u64) {
        let is_it = |known: &&mut DeviationUse| known.name == deviation && known.adapter == adapter;
        if let Some(known) = self.deviations.iter_mut().find(is_it) {
            known.excused += verdicts;
        }
    }

    /// Whether all went as expected.
    #[must_use]
    pub fn is_success(&self) -> bool {
        self.interrupted.is_none()
            && self.totals.failed == 0
            && self.totals.unexpected_passes == 0
            && self.totals.failed_groups == 0
    }
}
