//! The JSON of `special`.

pub mod record;

use crate::Word;
use crate::report::{Identity, Interrupted};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// The schema of [`SpecialReport`].
pub const SCHEMA: &str = "lightmeter.special/1";

/// What became of a probe on an adapter in a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProbeVerdict {
    /// As promised.
    Kept,
    /// Not as promised.
    Broken,
    /// Nothing is promised.
    Indeterminate,
    /// Not what is on record for this very driver.
    Changed,
    /// Not as promised, as a named deviation says.
    Deviates,
}

impl ProbeVerdict {
    /// The name in JSON and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::Broken => "broken",
            Self::Indeterminate => "indeterminate",
            Self::Changed => "changed",
            Self::Deviates => "deviates",
        }
    }

    /// Whether it fails.
    #[must_use]
    pub const fn is_failure(self) -> bool {
        matches!(self, Self::Broken | Self::Changed)
    }
}

/// A result of a probe.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ProbeResult {
    /// The probe's name.
    pub probe: Word,
    /// The adapter's short name.
    pub adapter: String,
    /// The stage's name.
    pub stage: Word,
    /// What came out.
    #[serde(with = "hex")]
    #[schemars(with = "String")]
    pub bits: u32,
    /// The same in few letters.
    pub value: String,
    /// What became of it.
    pub verdict: ProbeVerdict,
    /// What is on record for the driver.
    #[serde(default, with = "maybe_hex", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub recorded: Option<u32>,
    /// What is on record, in few letters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recorded_value: Option<String>,
}

/// A stage that an adapter lacks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Skipped {
    /// The adapter's short name.
    pub adapter: String,
    /// The stage's name.
    pub stage: Word,
    /// Why.
    pub reason: Word,
}

/// What is on record for an adapter.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct RecordUse {
    /// The adapter's short name.
    pub adapter: String,
    /// Whose record it is.
    pub of: String,
    /// Whether another result fails.
    pub binds: bool,
}

/// A probe as JSON has it.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ProbeRow {
    /// Its name.
    pub name: Word,
    /// What it is about.
    pub class: Word,
    /// What is computed, for people.
    pub what: Word,
    /// The operands' bits.
    pub inputs: Vec<String>,
    /// What is promised, in words.
    pub promise: String,
    /// Whether anything is.
    pub definite: bool,
    /// The section that says so.
    pub source: Word,
}

/// What probes are about, as reports group them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ProbeClass {
    /// The name that probes have as their `class`.
    pub name: Word,
    /// The heading in reports.
    pub title: Word,
}

/// A rule of the language that promises something of special values, or refuses to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ProbeSource {
    /// The section that states it. A section may state several rules.
    pub section: Word,
    /// What it says.
    pub says: Word,
}

/// A promise that an interface is known to break.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SpecialDeviation {
    /// The name in reports.
    pub name: Word,
    /// The interface: `vulkan` or `gl`.
    pub backend: Word,
    /// The probes whose promise it breaks.
    pub probes: Cow<'static, [Word]>,
    /// Why.
    pub reason: Word,
}

/// The JSON of `special`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct SpecialReport {
    /// `lightmeter.special/1`.
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
    /// What was probed.
    pub adapters: Vec<Identity>,
    /// What is on record for them.
    #[serde(default)]
    pub records: Vec<RecordUse>,
    /// The probes.
    #[serde(default)]
    pub probes: Vec<ProbeRow>,
    /// What the probes are about, in the order of reports.
    #[serde(default)]
    pub classes: Vec<ProbeClass>,
    /// The rules that the promises are from, in the order of reports.
    #[serde(default)]
    pub sources: Vec<ProbeSource>,
    /// Promises that are known to be broken, on whichever interface.
    #[serde(default)]
    pub deviations: Vec<SpecialDeviation>,
    /// Stages that an adapter lacks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub skipped: Vec<Skipped>,
    /// Every result.
    pub outcomes: Vec<ProbeResult>,
    /// The adapter that was under way when a signal ended the probes: none after it was probed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interrupted: Option<Interrupted>,
}

impl SpecialReport {
    /// Whether every adapter was probed, every promise was kept, and every result is as on record where a record binds.
    #[must_use]
    pub fn is_success(&self) -> bool {
        self.interrupted.is_none() && !self.outcomes.iter().any(|outcome| outcome.verdict.is_failure())
    }

    /// The probe of that name.
    #[must_use]
    pub fn probe(&self, name: &str) -> Option<&ProbeRow> {
        self.probes.iter().find(|probe| probe.name == name)
    }

    /// The probes of a class.
    pub fn of_class<'a>(&'a self, class: &'a ProbeClass) -> impl Iterator<Item = &'a ProbeRow> {
        self.probes.iter().filter(|probe| probe.class == class.name)
    }

    /// A probe's results on an adapter, stage by stage.
    pub fn of<'a>(&'a self, probe: &'a str, adapter: &'a str) -> impl Iterator<Item = &'a ProbeResult> {
        self.outcomes.iter().filter(move |outcome| outcome.probe == probe && outcome.adapter == adapter)
    }
}

/// Bits as `0x7fc00000`.
mod hex {
    use serde::{Deserialize, Deserializer, Serializer};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands a reference")]
    pub(super) fn serialize<S: Serializer>(bits: &u32, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&format!("0x{bits:08x}"))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
        let text = String::deserialize(deserializer)?;
        let bits = text.strip_prefix("0x").and_then(|digits| u32::from_str_radix(digits, 16).ok());
        bits.ok_or_else(|| serde::de::Error::custom(format!("expected bits such as 0x7fc00000, not {text:?}")))
    }
}

/// The same, where there are any.
mod maybe_hex {
    use serde::{Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(bits: &Option<u32>, serializer: S) -> Result<S::Ok, S::Error> {
        super::hex::serialize(&bits.unwrap_or_default(), serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u32>, D::Error> {
        super::hex::deserialize(deserializer).map(Some)
    }
}
