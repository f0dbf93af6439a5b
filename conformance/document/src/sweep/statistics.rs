//! What a sweep has come to. Statistics of parts add up to those of the whole, whatever the parts and their order: counts,
//! greatest values with the first input that has them, and the first inputs that fail.

use super::histogram::Histogram;
use crate::Number;
use crate::report::Tiers;
use crate::stores::StoreCounts;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Failing inputs that are kept.
const KEPT: usize = 5;

/// An f32 as it is read by people and as its bits, which are what counts.
#[derive(Clone, Copy, Debug, JsonSchema)]
pub struct ExactFloat(#[schemars(with = "ExactParts")] pub f32);

impl PartialEq for ExactFloat {
    fn eq(&self, other: &Self) -> bool {
        self.0.to_bits() == other.0.to_bits()
    }
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ExactParts {
    #[schemars(with = "Number")]
    value: serde_json::Value,
    bits: String,
}

impl Serialize for ExactFloat {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let value = serde_json::to_value(Number(self.0.into())).unwrap_or_default();
        ExactParts { value, bits: format!("0x{:08x}", self.0.to_bits()) }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for ExactFloat {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let parts = ExactParts::deserialize(deserializer)?;
        let bits = parts.bits.strip_prefix("0x").and_then(|hex| u32::from_str_radix(hex, 16).ok());
        let expected = || serde::de::Error::custom(format!("`{}` is no f32's bits, as 0x3f800000", parts.bits));
        let x = f32::from_bits(bits.ok_or_else(expected)?);
        if serde_json::to_value(Number(x.into())).ok().as_ref() != Some(&parts.value) {
            return Err(serde::de::Error::custom(format!("{} is not the value of {}", parts.value, parts.bits)));
        }
        Ok(Self(x))
    }
}

/// One input of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SweepInput {
    /// A float.
    Float(ExactFloat),
    /// Of a blend state: a component of the source and of the destination, and the source's alpha, in 255ths.
    Bytes {
        /// The source's.
        source: u8,
        /// The destination's.
        destination: u8,
        /// The source's alpha.
        alpha: u8,
    },
}

impl SweepInput {
    /// How it stands to another in the order of inputs: that of floats, −0 before 0; of bytes by alpha, source and destination.
    #[must_use]
    pub fn order(self, other: Self) -> Ordering {
        match (self, other) {
            (Self::Float(ExactFloat(a)), Self::Float(ExactFloat(b))) => a.total_cmp(&b),
            (a, b) => a.bytes().cmp(&b.bytes()),
        }
    }

    /// Alpha, source and destination; of a float nothing.
    const fn bytes(self) -> Option<[u8; 3]> {
        match self {
            Self::Float(_) => None,
            Self::Bytes { source, destination, alpha } => Some([alpha, source, destination]),
        }
    }
}

/// A verdict with all that it rests on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SweepVerdict {
    /// The input.
    pub input: SweepInput,
    /// What came out.
    pub value: ExactFloat,
    /// What the formula gives.
    pub reference: Number,
    /// The least legal value.
    pub low: Number,
    /// The greatest.
    pub high: Number,
    /// The distance from the reference in the sweep's unit.
    pub error: Number,
    /// The distance from the reference over the distance to the end of what is legal.
    pub margin: Number,
}

/// What the stores of a blend unit came to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StoreStatistics {
    /// By how near values come.
    pub tiers: Tiers,
    /// What the values say of how they are stored, red, green and blue together.
    pub counts: StoreCounts,
    /// Values that the device's declared model predicts.
    pub predicted: u64,
    /// Those that are another.
    pub departing: u64,
}

/// What a sweep, or a part of one, has come to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Statistics {
    /// Inputs.
    pub inputs: u64,
    /// Legal results.
    pub passed: u64,
    /// Others.
    pub failed: u64,
    /// Not legal, as a named deviation says.
    pub expected_failures: u64,
    /// Where the rules permit anything; in no bin of the histogram.
    pub indeterminate: u64,
    /// Which deviations were needed, and how often.
    pub excused: BTreeMap<String, u64>,
    /// The errors.
    pub histogram: Histogram,
    /// The greatest error.
    pub worst: Option<SweepVerdict>,
    /// The greatest margin of the values that are not next to the reference, where either float is legal: its margin is at most 1.
    pub nearest_to_limit: Option<SweepVerdict>,
    /// The first results that are not legal.
    pub failures: Vec<SweepVerdict>,
    /// The same along the input: the sweep in 256 parts of as many floats each, of which those are here that were done.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub along: Vec<SweepPart>,
    /// Of a blend unit.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub stored: Option<StoreStatistics>,
}

/// A 256th of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SweepPart {
    /// Which one, from 0.
    pub part: usize,
    /// The greatest error.
    pub error_max: Number,
    /// Results that are not legal.
    pub failed: u64,
    /// The greatest margin, of results that are not next to the reference; 0 in files of earlier versions.
    #[serde(default)]
    pub margin_max: Number,
}

impl Statistics {
    /// Adds another part's.
    pub fn add(&mut self, other: Self) {
        self.inputs += other.inputs;
        self.passed += other.passed;
        self.failed += other.failed;
        self.expected_failures += other.expected_failures;
        self.indeterminate += other.indeterminate;
        for (name, count) in other.excused {
            *self.excused.entry(name).or_default() += count;
        }
        self.histogram.add(&other.histogram);
        if let Some(seen) = other.worst {
            self.see_error(seen);
        }
        if let Some(seen) = other.nearest_to_limit {
            self.see_margin(seen);
        }
        self.failures.extend(other.failures);
        self.failures.sort_by(|a, b| a.input.order(b.input));
        self.failures.truncate(KEPT);
        for part in other.along {
            self.see_part(part);
        }
        if let Some(other) = other.stored {
            let stored = self.stored.get_or_insert_default();
            stored.tiers.add(&other.tiers);
            stored.counts.add(&other.counts);
            stored.predicted += other.predicted;
            stored.departing += other.departing;
        }
    }

    /// Keeps it where its error is the greatest.
    pub fn see_error(&mut self, seen: SweepVerdict) {
        if is_beyond(&seen, self.worst.as_ref(), |seen| seen.error.0) {
            self.worst = Some(seen);
        }
    }

    /// Adds a part along the input.
    pub fn see_part(&mut self, seen: SweepPart) {
        match self.along.binary_search_by_key(&seen.part, |own| own.part) {
            Ok(place) => {
                let own = &mut self.along[place];
                own.failed += seen.failed;
                let greater = |a: Number, b: Number| if a.0.total_cmp(&b.0).is_gt() { a } else { b };
                own.error_max = greater(seen.error_max, own.error_max);
                own.margin_max = greater(seen.margin_max, own.margin_max);
            }
            Err(place) => self.along.insert(place, seen),
        }
    }

    /// Keeps it where its margin is the greatest.
    pub fn see_margin(&mut self, seen: SweepVerdict) {
        if is_beyond(&seen, self.nearest_to_limit.as_ref(), |seen| seen.margin.0) {
            self.nearest_to_limit = Some(seen);
        }
    }

    /// Keeps it where few have failed before; inputs come in order.
    pub fn see_failure(&mut self, seen: SweepVerdict) {
        if self.failures.len() < KEPT {
            self.failures.push(seen);
        }
    }

    /// What does not add up; `None` where all does.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        let judged = [self.passed, self.failed, self.expected_failures, self.indeterminate];
        let sum = judged.into_iter().try_fold(0_u64, u64::checked_add);
        if sum != Some(self.inputs) {
            return Some(format!("its verdicts do not come to its {} inputs", self.inputs));
        }
        if self.histogram.total() != Some(self.inputs - self.indeterminate) {
            return Some("its histogram does not come to its count of inputs".into());
        }
        let excused = self.excused.values().try_fold(0_u64, |sum, &count| sum.checked_add(count));
        if excused != Some(self.expected_failures) {
            return Some("its deviations do not come to its expected failures".into());
        }
        let along = self.along.iter().try_fold(0_u64, |sum, part| sum.checked_add(part.failed));
        if !self.along.is_empty() && along != Some(self.failed) {
            return Some("its parts along the input do not come to its failures".into());
        }
        if self.failures.len() as u64 > self.failed || (self.failed > 0 && self.failures.is_empty()) {
            return Some(format!("it keeps {} failures of {}", self.failures.len(), self.failed));
        }
        None
    }
}

/// Whether it is greater, or as great at an earlier input.
fn is_beyond(seen: &SweepVerdict, most: Option<&SweepVerdict>, of: impl Fn(&SweepVerdict) -> f64) -> bool {
    most.is_none_or(|most| match of(seen).total_cmp(&of(most)) {
        Ordering::Equal => seen.input.order(most.input).is_lt(),
        order => order.is_gt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(x: f32, error: f64) -> SweepVerdict {
        SweepVerdict {
            input: SweepInput::Float(ExactFloat(x)),
            value: ExactFloat(1.0),
            reference: Number(1.0),
            low: Number(0.5),
            high: Number(2.0),
            error: Number(error),
            margin: Number(error / 8.0),
        }
    }

    fn part(x: f32, error: f64) -> Statistics {
        let mut part = Statistics { inputs: 1, failed: 1, ..Statistics::default() };
        part.histogram.count(error);
        part.see_error(seen(x, error));
        part.see_margin(seen(x, error));
        part.see_failure(seen(x, error));
        part
    }

    #[test]
    fn parts_add_up_in_any_order() {
        let parts: Vec<Statistics> = [3.0, 9.0, 9.0, 1.0, 2.0, 5.0, 4.0]
            .iter()
            .zip([1_u8, 2, 3, 4, 5, 6, 7])
            .map(|(e, x)| part(x.into(), *e))
            .collect();
        let mut forwards = Statistics::default();
        parts.iter().for_each(|part| forwards.add(part.clone()));
        let mut backwards = Statistics::default();
        parts.iter().rev().for_each(|part| backwards.add(part.clone()));
        assert_eq!(forwards, backwards);
        assert_eq!(
            forwards.worst.map(|seen| seen.input),
            Some(SweepInput::Float(ExactFloat(2.0))),
            "the first of equals"
        );
        assert_eq!(forwards.failures.len(), KEPT);
        assert_eq!(forwards.problem(), None);
    }

    #[test]
    fn counts_that_do_not_add_up_are_told() {
        let mut good = part(1.0, 3.0);
        good.passed += 1;
        assert!(good.problem().is_some_and(|problem| problem.contains("verdicts")));
        let mut good = part(1.0, 3.0);
        good.histogram.count(1.0);
        assert!(good.problem().is_some_and(|problem| problem.contains("histogram")));
        let mut good = part(1.0, 3.0);
        good.failures.clear();
        assert!(good.problem().is_some_and(|problem| problem.contains("failures")));
        assert!(Statistics { inputs: 1, passed: u64::MAX, failed: 2, ..Statistics::default() }.problem().is_some());
    }
}
