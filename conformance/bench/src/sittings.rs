//! Combines repeated sittings of the same benchmark. A measured ratio differs more from one sitting to the next than between the turns of
//! one sitting, because machine code and memory end up at different addresses; so every sitting creates its own devices and pipelines.

use super::Sitting;
use super::fit::fit;
use super::turns::{median, standing};
use lightmeter_document::bench::{Rank, ScalingPoint, Time};

/// Returns the first sitting, which alone holds the errors, with times combined from all sittings. A sitting that was stopped early lacks
/// the last groups; the times of those groups come from the other sittings.
///
/// # Panics
/// Where there is none.
pub(super) fn together(mut all: Vec<Sitting>) -> Sitting {
    let later = all.split_off(1);
    let mut first = all.pop().expect("there is a sitting");
    for (place, group) in first.groups.iter_mut().enumerate() {
        for (k, row) in group.rows.iter_mut().enumerate() {
            let of = |sitting: &Sitting| Some(sitting.groups.get(place)?.rows[k].time.clone());
            let times: Option<Vec<Time>> =
                std::iter::once(row.time.take()).chain(later.iter().filter_map(of)).collect();
            match times {
                Some(times) => row.time = Some(time(&times)),
                None if row.unavailable.is_none() => {
                    row.unavailable = Some("every reading of a sitting was rejected".into());
                }
                None => {}
            }
        }
    }
    for (place, scaling) in first.scalings.iter_mut().enumerate() {
        for point in &mut scaling.points {
            let of = |sitting: &Sitting| {
                let points = &sitting.scalings.get(place)?.points;
                points.iter().find(|other| other.work == point.work).cloned()
            };
            let all: Vec<ScalingPoint> = std::iter::once(point.clone()).chain(later.iter().filter_map(of)).collect();
            point.ns = middle(all.iter().map(|point| point.ns));
            point.quartiles_ns = range(all.iter().map(|point| point.quartiles_ns));
        }
        scaling.fit = fit(&scaling.points);
    }
    for sitting in &later {
        first.clock.readings += sitting.clock.readings;
        first.clock.rejected += sitting.clock.rejected;
    }
    first
}

/// The median of the sittings' medians, from the least of all turns to the greatest.
fn time(of: &[Time]) -> Time {
    let spread = range(of.iter().map(|time| time.spread));
    let is_baseline = of[0].verdict == Rank::Baseline;
    Time {
        ns: middle(of.iter().map(|time| time.ns)),
        quartiles_ns: range(of.iter().map(|time| time.quartiles_ns)),
        ratio: middle(of.iter().map(|time| time.ratio)),
        spread,
        verdict: if is_baseline { Rank::Baseline } else { standing(spread) },
        turns: of.iter().map(|time| time.turns).sum(),
        rejected: of.iter().map(|time| time.rejected).sum(),
        ..of[0].clone()
    }
}

fn middle(of: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = of.collect();
    sorted.sort_by(f64::total_cmp);
    median(&sorted)
}

fn range(of: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    of.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or([f64::NAN; 2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_document::Number;
    use lightmeter_document::bench::{BenchGroup, BenchRow, ClockUse, Errors, GroupKind, Spread, Time};

    /// A row that was measured.
    fn row(name: &str, ns: f64, ratio: f64) -> BenchRow {
        let spread = Spread { max: Number(1.0), p99: Number(1.0), mean: Number(1.0) };
        let errors = Errors { values: 1, lost: 0, nothing_promised: 0, ulp: spread, steps: spread, absolute: spread };
        let time = Time {
            clock: "timestamps".into(),
            ns,
            quartiles_ns: [ns * 0.98, ns * 1.02],
            ratio,
            spread: [ratio * 0.97, ratio * 1.03],
            verdict: Rank::Tie,
            turns: 15,
            rejected: 0,
            note: None,
        };
        BenchRow {
            name: name.into(),
            what: name.into(),
            claims_exact: true,
            unavailable: None,
            as_f32: false,
            disqualified: None,
            random: Some(errors),
            hard: None,
            rounding: None,
            time: Some(time),
            compile_ms: None,
        }
    }

    /// A group whose first row is the baseline.
    fn group(mut rows: Vec<BenchRow>) -> BenchGroup {
        if let Some(time) = rows[0].time.as_mut() {
            time.verdict = Rank::Baseline;
        }
        BenchGroup {
            id: "g".into(),
            kind: GroupKind::Formula,
            family: "g".into(),
            title: "g".into(),
            ideal: "g".into(),
            baseline: rows[0].name.clone(),
            unit: "evaluation".into(),
            work: "g".into(),
            rows,
            front: vec![],
        }
    }

    fn sitting(ns: f64, ratio: f64) -> Sitting {
        let clock = ClockUse { kind: "timestamps".into(), note: None, readings: 10, rejected: 1, grain_ns: None };
        Sitting { groups: vec![group(vec![row("f32", ns, 1.0), row("x", ns, ratio)])], scalings: vec![], clock }
    }

    #[test]
    fn a_ratio_is_the_median_of_sittings_and_its_spread_covers_all() {
        let mut last = sitting(9.0, 1.3);
        last.groups[0].rows[1].random = None;
        let all = together(vec![sitting(2.0, 1.2), sitting(3.0, 0.8), last]);
        let row = &all.groups[0].rows[1];
        let time = row.time.as_ref().expect("it is timed");
        assert!((time.ratio - 1.2).abs() < 1e-12 && (time.ns - 3.0).abs() < 1e-12);
        assert!((time.spread[0] - 0.8 * 0.97).abs() < 1e-12 && (time.spread[1] - 1.3 * 1.03).abs() < 1e-12);
        assert_eq!((time.verdict, time.turns), (Rank::Tie, 45));
        assert!(row.random.is_some(), "errors are those of the first");
        assert_eq!((all.clock.readings, all.clock.rejected), (30, 3));
    }

    #[test]
    fn a_group_that_a_stopped_sitting_lacks_has_the_times_of_the_others() {
        let mut second = sitting(3.0, 1.4);
        second.groups.clear();
        let all = together(vec![sitting(2.0, 1.2), sitting(3.0, 1.0), second]);
        let time = all.groups[0].rows[1].time.as_ref().expect("two sittings have timed it");
        assert!((time.ratio - 1.1).abs() < 1e-12 && time.turns == 30, "{time:?}");
    }

    #[test]
    fn a_row_without_a_time_in_a_sitting_has_none() {
        let mut second = sitting(3.0, 1.0);
        second.groups[0].rows[1].time = None;
        let all = together(vec![sitting(2.0, 1.2), second]);
        let row = &all.groups[0].rows[1];
        assert!(row.time.is_none() && row.unavailable.as_deref().is_some_and(|reason| reason.contains("rejected")));
    }
}
