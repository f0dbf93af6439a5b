//! The result of a run as data: what the JSON of `run` holds.

pub mod junit;
pub mod text;

use crate::subject::Identity;
use serde::{Serialize, Serializer};

/// A number that may be NaN or infinite, which JSON writes as a string.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number(pub f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() { serializer.serialize_f64(self.0) } else { serializer.serialize_str(&self.to_string()) }
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
    /// The counts.
    #[serde(flatten)]
    pub totals: Totals,
    /// The greatest error of a verdict that is not indeterminate, in ULP of the output's format.
    pub error_ulp_max: Number,
    /// The greatest margin.
    pub margin_max: Number,
    /// Time spent on the group on this adapter in this stage.
    pub seconds: f64,
    /// The case of the greatest margin.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst: Option<String>,
    /// Why the group is skipped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skip_reason: Option<&'static str>,
    /// Why the group fails as a whole.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
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
    /// What came out.
    pub value: Number,
    /// Its bits.
    pub value_hex: String,
    /// Whether it was never written.
    pub unwritten: bool,
    /// The error in ULP of binary32.
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
    /// Failures, the first of each group.
    pub failures: Vec<Failure>,
}

impl Report {
    /// Whether all went as expected.
    #[must_use]
    pub fn is_success(&self) -> bool {
        self.totals.failed == 0 && self.totals.unexpected_passes == 0 && self.totals.failed_groups == 0
    }
}
