//! A group of cases on a subject in a stage: its counts, the worst of it, and why it fails.

use super::{Diagnosis, GroupSample, ImageUse, Problem, StoreUse, Tiers};
use crate::by_case::{CaseCounts, SourcePlace};
use crate::count::counters;
use crate::{Number, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// The case's inputs, number by number.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<Number>,
    /// The scalar output's name.
    pub output: String,
    /// What came out.
    pub value: Number,
    /// The f64 reference.
    pub reference: Number,
    /// The least and the greatest legal value.
    pub interval: [Number; 2],
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
    pub fn mistakes(&self) -> Vec<Word> {
        self.diagnosis.as_ref().map_or_else(Vec::new, Diagnosis::mistakes)
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

    /// Whether a renderer does not declare it, so that none of its cases was asked.
    #[must_use]
    pub fn is_not_asked(&self) -> bool {
        self.asked().is_some_and(|counts| counts.totals.not_asked > 0)
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
