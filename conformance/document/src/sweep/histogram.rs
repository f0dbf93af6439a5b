//! How often errors of each size were seen: exact, at most ½, at most 1, 2, 4, 8, … units, more, infinite, NaN.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The bin of at most 1 unit; the ones after it double.
const ONE: usize = 2;
/// Doublings that have a bin.
const DOUBLINGS: usize = 32;
/// Finite, but greater than the last power of two.
const MORE: usize = ONE + DOUBLINGS + 1;
const INFINITE: usize = MORE + 1;
const NAN: usize = MORE + 2;
const BINS: usize = MORE + 3;

/// Errors counted by size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Histogram {
    counts: [u64; BINS],
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: [0; BINS] }
    }
}

impl Histogram {
    /// Counts an error of a value that is not NaN.
    pub fn count(&mut self, error: f64) {
        self.counts[bin(error)] += 1;
    }

    /// Counts a value that is NaN where the reference is a number.
    pub fn count_nan(&mut self) {
        self.counts[NAN] += 1;
    }

    /// Counts errors that are 0, in (0, ½] and in (½, 1].
    pub fn count_near(&mut self, counts: [u64; ONE + 1]) {
        for (sum, count) in self.counts.iter_mut().zip(counts) {
            *sum += count;
        }
    }

    /// Adds another's counts.
    pub fn add(&mut self, other: &Self) {
        for (sum, count) in self.counts.iter_mut().zip(other.counts) {
            *sum += count;
        }
    }

    /// All that was counted; `None` where that is no number, as in a damaged file.
    #[must_use]
    pub fn total(&self) -> Option<u64> {
        self.counts.iter().try_fold(0_u64, |sum, &count| sum.checked_add(count))
    }

    /// NaN results.
    #[must_use]
    pub const fn nan(&self) -> u64 {
        self.counts[NAN]
    }

    /// The bins from the first to the last that holds something, each with its name.
    #[must_use]
    pub fn bins(&self) -> Vec<(String, u64)> {
        let finite = self.counts[..=MORE].iter().rposition(|&count| count > 0).map_or(0, |last| last + 1);
        let special = (INFINITE..BINS).filter(|&bin| self.counts[bin] > 0);
        (0..finite).chain(special).map(|bin| (name(bin), self.counts[bin])).collect()
    }
}

fn bin(error: f64) -> usize {
    if error == f64::INFINITY {
        return INFINITE;
    }
    let within = |k: usize| error <= at_most(k);
    (0..MORE).find(|&k| within(k)).unwrap_or(MORE)
}

/// The greatest error of a bin before [`MORE`].
fn at_most(bin: usize) -> f64 {
    match bin {
        0 => 0.0,
        1 => 0.5,
        _ => f64::from(1_u32 << (bin - ONE).min(31)) * if bin - ONE == DOUBLINGS { 2.0 } else { 1.0 },
    }
}

fn name(bin: usize) -> String {
    match bin {
        0 => "exact".into(),
        MORE => "more".into(),
        INFINITE => "infinite".into(),
        NAN => "NaN".into(),
        _ => at_most(bin).to_string(),
    }
}

impl Serialize for Histogram {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map((0..BINS).filter(|&bin| self.counts[bin] > 0).map(|bin| (name(bin), self.counts[bin])))
    }
}

impl JsonSchema for Histogram {
    fn schema_name() -> Cow<'static, str> {
        "Histogram".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        BTreeMap::<String, u64>::json_schema(generator)
    }
}

impl<'de> Deserialize<'de> for Histogram {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut histogram = Self::default();
        for (label, count) in BTreeMap::<String, u64>::deserialize(deserializer)? {
            let bin = (0..BINS).find(|&bin| name(bin) == label);
            let bin = bin.ok_or_else(|| D::Error::custom(format!("the histogram has no bin `{label}`")))?;
            histogram.counts[bin] = count;
        }
        Ok(histogram)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_fall_in_the_bin_that_they_just_reach() {
        let named = |error: f64| name(bin(error));
        let pins = [
            (0.0, "exact"),
            (1e-300, "0.5"),
            (0.5, "0.5"),
            (0.5_f64.next_up(), "1"),
            (1.0, "1"),
            (1.0_f64.next_up(), "2"),
            (2.0, "2"),
            (3.0, "4"),
            (4_294_967_296.0, "4294967296"),
            (4_294_967_297.0, "more"),
            (f64::INFINITY, "infinite"),
        ];
        for (error, bin) in pins {
            assert_eq!(named(error), bin, "{error}");
        }
    }

    #[test]
    fn a_histogram_is_read_back_as_it_was_written() {
        let mut histogram = Histogram::default();
        histogram.count_near([3, 2, 1]);
        [7.0, 1e30, f64::INFINITY].into_iter().for_each(|error| histogram.count(error));
        histogram.count_nan();
        let json = serde_json::to_string(&histogram).expect("a histogram is JSON");
        assert_eq!(json, r#"{"exact":3,"0.5":2,"1":1,"8":1,"more":1,"infinite":1,"NaN":1}"#);
        assert_eq!(serde_json::from_str::<Histogram>(&json).expect("it is one"), histogram);
        assert!(serde_json::from_str::<Histogram>(r#"{"3": 1}"#).is_err());
        assert_eq!((histogram.total(), histogram.nan()), (Some(10), 1));
    }
}
