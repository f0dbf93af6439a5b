//! The Pareto front: what nothing else is both faster and closer than.
//!
//! A point is on it where no other is at most as slow *and* at most as far off, and one of these strictly. Of points that are
//! equal the first is. What has no time or no finite error is never on it; nor is a row that is unavailable or wrong in value, nor
//! a rung on the processor, which no shader can take.

use super::document::{Errors, Group, GroupKind, Row};
use std::cmp::Ordering;

/// The names of the points `(name, time, error)` on the front, the fastest first.
#[must_use]
pub fn front<'a>(points: &[(&'a str, Option<f64>, f64)]) -> Vec<&'a str> {
    let finite = |&(name, time, error): &(&'a str, Option<f64>, f64)| {
        let time = time.filter(|time| time.is_finite())?;
        // A sum with 0 is never −0, which the total order has before 0.
        error.is_finite().then_some((name, time + 0.0, error + 0.0))
    };
    let mut points: Vec<_> = points.iter().filter_map(finite).collect();
    points.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    let mut least = f64::INFINITY;
    points.retain(|&(_, _, error)| {
        let is_closer = error < least;
        least = least.min(error);
        is_closer
    });
    points.into_iter().map(|(name, ..)| name).collect()
}

/// The front of a group's rows: by their time and their largest error on random inputs, which is in ULP of a formula and absolute
/// of techniques and scenes. Times whose ratios' spreads overlap are equal, so that a second run finds the same front; of rows
/// that are equal in both the baseline is on it, or the first.
#[must_use]
pub fn front_of(group: &Group) -> Vec<String> {
    let point = |(place, row): (usize, &'_ Row)| {
        let error = largest(group.kind, row.random.as_ref()?);
        let (time, is_other) = (row.time.clone()?, row.name != group.baseline);
        (refusal(row).is_none() && error.is_finite()).then_some((row.name.clone(), time, error, (is_other, place)))
    };
    let mut points: Vec<_> = group.rows.iter().enumerate().filter_map(point).collect();
    let all = points.clone();
    points.retain(|(_, time, error, order)| {
        !all.iter().any(|(_, other, closer, before)| {
            let (is_slower, is_faster) = (other.spread[0] > time.spread[1], other.spread[1] < time.spread[0]);
            let wins = match closer.total_cmp(error) {
                Ordering::Less => true,
                Ordering::Equal => is_faster || before < order,
                Ordering::Greater => false,
            };
            !is_slower && wins
        })
    });
    points.sort_by(|a, b| a.1.ratio.total_cmp(&b.1.ratio));
    points.into_iter().map(|(name, ..)| name).collect()
}

/// The largest error in the unit that a group of that kind is told by.
#[must_use]
pub const fn largest(kind: GroupKind, errors: &Errors) -> f64 {
    match kind {
        GroupKind::Formula => errors.ulp.max.0,
        GroupKind::Technique | GroupKind::Scene => errors.absolute.max.0,
    }
}

/// Whether a rung is one on the processor: `cpu-f64` and its like, which no shader can take.
#[must_use]
pub fn is_processor(name: &str) -> bool {
    name.starts_with("cpu-")
}

/// Why a row is on no front and never recommended, if so.
#[must_use]
pub fn refusal(row: &Row) -> Option<&str> {
    let processor = is_processor(&row.name).then_some("on the processor");
    row.unavailable.as_deref().or(row.disqualified.as_deref()).or(processor)
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::{Draw, document};
    use super::*;

    /// By the definition, pair by pair.
    fn by_definition<'a>(points: &[(&'a str, Option<f64>, f64)]) -> Vec<&'a str> {
        let known: Vec<_> = (points.iter())
            .filter_map(|&(name, time, error)| Some((name, time?, error)))
            .filter(|(_, time, error)| time.is_finite() && error.is_finite())
            .collect();
        let mut kept: Vec<_> = vec![];
        for (place, &(name, time, error)) in known.iter().enumerate() {
            let is_beaten = known.iter().any(|&(_, t, e)| t <= time && e <= error && (t < time || e < error));
            let is_repeated = known[..place].iter().any(|&(_, t, e)| (t + 0.0, e + 0.0) == (time + 0.0, error + 0.0));
            if !is_beaten && !is_repeated {
                kept.push((name, time));
            }
        }
        kept.sort_by(|a, b| a.1.partial_cmp(&b.1).expect("times are finite"));
        kept.into_iter().map(|(name, _)| name).collect()
    }

    #[test]
    fn the_front_is_what_the_definition_says() {
        const NAMES: [&str; 12] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l"];
        let mut draw = Draw::new(7);
        let mut sizes = [0_usize; 13];
        for _ in 0..4000 {
            // Few values, so that many are equal.
            let value = |draw: &mut Draw| match draw.below(9) {
                0 => f64::NAN,
                1 => f64::INFINITY,
                2 => -0.0,
                k => f64::from(k - 3),
            };
            let count = draw.below(13) as usize;
            let points: Vec<_> = (0..count)
                .map(|place| {
                    let time = if draw.below(8) == 0 { None } else { Some(value(&mut draw)) };
                    (NAMES[place], time, value(&mut draw))
                })
                .collect();
            let found = front(&points);
            assert_eq!(found, by_definition(&points), "{points:?}");
            sizes[found.len()] += 1;
        }
        assert!(sizes[..4].iter().all(|&count| count > 50), "fronts of all sizes: {sizes:?}");
    }

    /// What a row pins, points, and their front.
    type Figures<'a> = (&'a str, &'a [(&'a str, Option<f64>, f64)], &'a [&'a str]);

    #[test]
    fn figures_of_a_front() {
        let rows: [Figures; 8] = [
            ("a trade", &[("slow", Some(2.0), 1.0), ("fast", Some(1.0), 2.0)], &["fast", "slow"]),
            ("dominated", &[("worse", Some(2.0), 2.0), ("better", Some(1.0), 1.0)], &["better"]),
            ("equal: the first", &[("a", Some(1.0), 1.0), ("b", Some(1.0), 1.0)], &["a"]),
            ("as fast, farther off", &[("a", Some(1.0), 2.0), ("b", Some(1.0), 1.0)], &["b"]),
            ("as close, slower", &[("a", Some(2.0), 0.0), ("b", Some(1.0), 0.0)], &["b"]),
            ("either zero", &[("a", Some(0.0), 0.0), ("b", Some(-0.0), -0.0)], &["a"]),
            ("no number", &[("a", Some(0.5), f64::INFINITY), ("b", Some(0.5), f64::NAN), ("c", None, 0.0)], &[]),
            ("a time below zero is a time", &[("a", Some(-0.1), 3.0), ("b", Some(1.0), 2.0)], &["a", "b"]),
        ];
        for (pins, points, expected) in rows {
            assert_eq!(front(points), expected, "{pins}");
        }
    }

    #[test]
    fn no_front_has_a_row_that_cannot_be_taken() {
        let document = document();
        let mut refused = 0;
        for group in document.adapters.iter().flat_map(|measured| &measured.groups) {
            let front = front_of(group);
            for row in group.rows.iter().filter(|row| refusal(row).is_some()) {
                assert!(!front.contains(&row.name), "{} of {}", row.name, group.id);
                refused += 1;
            }
        }
        assert!(refused > 100, "{refused} rows are refused");
        for family in document.adapters.iter().flat_map(|measured| &measured.families) {
            assert!(!family.front.is_empty() && !family.front.iter().any(|name| is_processor(name)), "{}", family.id);
        }
    }
}
