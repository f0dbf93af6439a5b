//! The Pareto front: what nothing else is both faster and closer than.
//!
//! A point is on it where no other of it is at most as slow *and* at most as far off, and one of these strictly. What has no time or no finite error is never on it; nor is a row that is unavailable or wrong in value, nor
//! a rung on the processor, which no shader can take.

use super::{BenchGroup, BenchRow};

/// A row, or a rung over many.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its name.
    pub name: String,
    /// Its time, from the least to the greatest that it may be.
    pub time: [f64; 2],
    /// What it is told as, between these.
    pub ratio: f64,
    /// Its error.
    pub error: f64,
    /// Whether it is what the others are measured against.
    pub is_baseline: bool,
}

impl Point {
    /// Whether its time is that of another, as far as is known.
    fn ties(&self, other: &Self) -> bool {
        self.time[0] <= other.time[1] && other.time[0] <= self.time[1]
    }
}

/// The names of the points on the front, the fastest first. Times whose spreads overlap are equal, so that a second run finds the
/// same front; of points that are equal in both the baseline is on it, or the fastest. That equality is not transitive: the front
/// is built from its closest point on, and a point is left out only for one that stays.
#[must_use]
pub fn front(mut points: Vec<Point>) -> Vec<String> {
    let is_known = |point: &Point| point.time.iter().all(|time| time.is_finite()) && point.error.is_finite();
    points.retain(is_known);
    // A sum with 0 is never −0, which the total order has before 0.
    points
        .sort_by(|a, b| (a.error + 0.0).total_cmp(&(b.error + 0.0)).then((a.ratio + 0.0).total_cmp(&(b.ratio + 0.0))));
    let mut kept: Vec<Point> = vec![];
    for point in points {
        let same = |other: &&mut Point| other.error.total_cmp(&point.error).is_eq() && other.ties(&point);
        if let Some(same) = kept.iter_mut().find(same) {
            if point.is_baseline {
                *same = point;
            }
        } else if !kept.iter().any(|closer| closer.time[0] <= point.time[1]) {
            kept.push(point);
        }
    }
    kept.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    kept.into_iter().map(|point| point.name).collect()
}

/// The front of a group's rows: by their time and their largest absolute error on random inputs.
#[must_use]
pub fn front_of(group: &BenchGroup) -> Vec<String> {
    let point = |row: &BenchRow| {
        let (error, time) = (row.random.as_ref()?.absolute.max.0, row.time.as_ref()?);
        let (name, is_baseline) = (row.name.clone(), row.name == group.baseline);
        let point = Point { name, time: time.spread, ratio: time.ratio, error, is_baseline };
        refusal(row).is_none().then_some(point)
    };
    front(group.rows.iter().filter_map(point).collect())
}

/// Whether a rung is one on the processor: `cpu-f64` and its like, which no shader can take.
#[must_use]
pub fn is_processor(name: &str) -> bool {
    name.rsplit(' ').next().is_some_and(|rung| rung.starts_with("cpu-"))
}

/// Why a row is on no front and never recommended, if so.
#[must_use]
pub fn refusal(row: &BenchRow) -> Option<&str> {
    let processor = is_processor(&row.name).then_some("on the processor");
    row.unavailable.as_deref().or(row.disqualified.as_deref()).or(processor)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(name: &str, time: [f64; 2], error: f64) -> Point {
        Point { name: name.into(), time, ratio: 0.5 * (time[0] + time[1]), error, is_baseline: name == "base" }
    }

    /// By the definition, pair by pair, where no time has a spread.
    fn by_definition(points: &[Point]) -> Vec<String> {
        let known = || points.iter().filter(|point| point.time[0].is_finite() && point.error.is_finite());
        let mut kept: Vec<&Point> = vec![];
        for (place, own) in known().enumerate() {
            let is_beaten = known().any(|other| {
                let (time, error) = ((other.ratio, own.ratio), (other.error, own.error));
                time.0 <= time.1 && error.0 <= error.1 && (time.0 < time.1 || error.0 < error.1)
            });
            let is_repeated = known().take(place).any(|other| (other.ratio, other.error) == (own.ratio, own.error));
            if !is_beaten && !is_repeated {
                kept.push(own);
            }
        }
        kept.sort_by(|a, b| a.ratio.partial_cmp(&b.ratio).expect("times are finite"));
        kept.into_iter().map(|point| point.name.clone()).collect()
    }

    #[test]
    fn the_front_is_what_the_definition_says() {
        const NAMES: [&str; 12] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l"];
        // A linear congruential generator, of which the high bits are taken.
        let mut state = 7_u64;
        let mut below = |end: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % end
        };
        let mut sizes = [0_usize; 13];
        for _ in 0..4000 {
            // Few values, so that many are equal.
            let mut value = || match below(9) {
                0 => f64::NAN,
                1 => f64::INFINITY,
                k => f64::from(u8::try_from(k).expect("it is below 9")) - 2.0,
            };
            let values: Vec<[f64; 2]> = NAMES.iter().map(|_| [value(), value()]).collect();
            let count = usize::try_from(below(13)).expect("it is below 13");
            let points: Vec<_> = (NAMES[..count].iter().zip(values))
                .map(|(name, [time, error])| point(name, [time; 2], error))
                .collect();
            let found = front(points.clone());
            assert_eq!(found, by_definition(&points), "{points:?}");
            sizes[found.len()] += 1;
        }
        assert!(sizes[..4].iter().all(|&count| count > 50), "fronts of all sizes: {sizes:?}");
    }

    /// What a row pins, points, and their front.
    type Figures<'a> = (&'a str, &'a [(&'a str, [f64; 2], f64)], &'a [&'a str]);

    #[test]
    fn figures_of_a_front() {
        let rows: [Figures; 8] = [
            ("a trade", &[("slow", [2.0; 2], 1.0), ("fast", [1.0; 2], 2.0)], &["fast", "slow"]),
            ("dominated", &[("worse", [2.0; 2], 2.0), ("better", [1.0; 2], 1.0)], &["better"]),
            ("equal: the baseline", &[("a", [1.0; 2], 1.0), ("base", [1.0; 2], 1.0)], &["base"]),
            ("a tie, farther off", &[("a", [0.8, 1.1], 2.0), ("b", [1.0, 1.2], 1.0)], &["b"]),
            ("as close, slower", &[("a", [2.0; 2], 0.0), ("b", [1.0; 2], -0.0)], &["b"]),
            ("no number", &[("a", [0.5; 2], f64::INFINITY), ("b", [0.5; 2], f64::NAN), ("c", [f64::NAN; 2], 0.0)], &[]),
            // Each ties with the next, and the first and the last differ.
            (
                "what is left out leaves nothing out",
                &[("a", [0.3, 0.7], 9.0), ("b", [0.6, 1.4], 3.0), ("c", [1.3, 1.8], 1.0)],
                &["a", "c"],
            ),
            ("a baseline that is slower", &[("base", [1.0; 2], 1.0), ("b", [0.5, 0.9], 1.0)], &["b"]),
        ];
        for (pins, points, expected) in rows {
            let points = points.iter().map(|&(name, time, error)| point(name, time, error)).collect();
            assert_eq!(front(points), expected, "{pins}");
        }
    }
}
