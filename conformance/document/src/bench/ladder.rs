//! Rungs over many groups: the geometric mean of times, the median of largest errors.

use super::pareto::{self, Point, is_processor};
use super::{BenchGroup, BenchRow, Errors, Family, FamilyRung};
use crate::Number;

/// The rung that the others are measured against.
pub const BASELINE: &str = "f32";

/// A rung over many groups.
#[derive(Clone, Debug)]
pub struct RungSummary {
    /// Its name.
    pub name: String,
    /// Groups that it was measured in and is right in value.
    pub groups: usize,
    /// Groups in which it is f32's own program, no step of which has such a form: f32's figures count there.
    pub as_f32: usize,
    /// Groups that it is disqualified in.
    pub disqualified: usize,
    /// Groups that have it not.
    pub unavailable: usize,
    /// The geometric mean of its ratios to the baseline.
    pub ratio: f64,
    /// From where to where: the same of the ends of their spreads.
    pub spread: [f64; 2],
    /// The geometric mean of its times in nanoseconds.
    pub ns: f64,
    /// The median of its largest errors on random inputs.
    pub error: f64,
    /// Each group's id, ratio and largest error.
    pub points: Vec<(String, f64, f64)>,
}

/// The rungs over groups, in the order in which they first appear. `error` takes the largest error in the unit wanted.
#[must_use]
pub fn rungs<'a>(
    groups: impl Iterator<Item = &'a BenchGroup> + Clone,
    error: impl Fn(&Errors) -> f64,
) -> Vec<RungSummary> {
    let mut names: Vec<&str> = vec![];
    for row in groups.clone().flat_map(|group| &group.rows) {
        if !names.contains(&row.name.as_str()) {
            names.push(&row.name);
        }
    }
    let rows = |name: &'a str| {
        let of = move |group: &'a BenchGroup| group.rows.iter().find(|row| row.name == name).map(|row| (group, row));
        groups.clone().filter_map(of)
    };
    names.into_iter().map(|name| rung(name, rows(name), &error)).collect()
}

fn rung<'a>(
    name: &str,
    rows: impl Iterator<Item = (&'a BenchGroup, &'a BenchRow)>,
    error: &impl Fn(&Errors) -> f64,
) -> RungSummary {
    let (mut disqualified, mut unavailable, mut as_f32) = (0, 0, 0);
    let (mut points, mut figures) = (vec![], vec![]);
    for (group, row) in rows {
        let mut own = row;
        if row.as_f32 {
            // Means are of the same groups whatever the rung.
            let Some(base) = group.rows.iter().find(|base| base.name == group.baseline) else { continue };
            own = base;
        }
        match own {
            BenchRow { unavailable: Some(_), .. } => unavailable += 1,
            BenchRow { disqualified: Some(_), .. } => disqualified += 1,
            BenchRow { time: Some(time), random: Some(errors), .. } => {
                if row.name == own.name {
                    points.push((group.id.clone(), time.ratio, error(errors)));
                } else {
                    as_f32 += 1;
                }
                figures.push((time.ratio, time.spread, time.ns, error(errors)));
            }
            _ => {}
        }
    }
    let end = |k: usize| geometric_mean(figures.iter().map(|figure| figure.1[k]));
    RungSummary {
        name: name.to_owned(),
        groups: points.len(),
        as_f32,
        disqualified,
        unavailable,
        ratio: geometric_mean(figures.iter().map(|figure| figure.0)),
        spread: [end(0), end(1)],
        ns: geometric_mean(figures.iter().map(|figure| figure.2)),
        error: median(figures.iter().map(|figure| figure.3)),
        points,
    }
}

/// The rungs than which none is both as fast and closer: see [`pareto::front`].
#[must_use]
pub fn front(rungs: &[RungSummary]) -> Vec<String> {
    let taken = rungs.iter().filter(|rung| rung.groups > 0 && !is_processor(&rung.name));
    let points = taken.map(|rung| Point {
        name: rung.name.clone(),
        time: rung.spread,
        ratio: rung.ratio,
        error: rung.error,
        is_baseline: rung.name == BASELINE,
    });
    pareto::front(points.collect())
}

/// A family of formulas as the document has it.
#[must_use]
pub fn family<'a>(id: &str, groups: impl Iterator<Item = &'a BenchGroup> + Clone) -> Family {
    let of = |rung: RungSummary| FamilyRung {
        name: rung.name,
        formulas: rung.groups,
        as_f32: rung.as_f32,
        disqualified: rung.disqualified,
        unavailable: rung.unavailable,
        ratio: rung.ratio,
        spread: rung.spread,
        ns: rung.ns,
        error_max: Number(rung.error),
        points: rung.points.into_iter().map(|(id, ratio, error)| (id, ratio, Number(error))).collect(),
    };
    let rungs = rungs(groups, |errors| errors.absolute.max.0);
    let front = front(&rungs);
    Family { id: id.to_owned(), rungs: rungs.into_iter().map(of).collect(), front }
}

impl From<&FamilyRung> for RungSummary {
    fn from(rung: &FamilyRung) -> Self {
        Self {
            name: rung.name.clone(),
            groups: rung.formulas,
            as_f32: rung.as_f32,
            disqualified: rung.disqualified,
            unavailable: rung.unavailable,
            ratio: rung.ratio,
            spread: rung.spread,
            ns: rung.ns,
            error: rung.error_max.0,
            points: rung.points.iter().map(|(id, ratio, error)| (id.clone(), *ratio, error.0)).collect(),
        }
    }
}

/// Of those that are positive and finite; 0 of none, which no document is written with NaN for.
#[must_use]
pub fn geometric_mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values.filter(|value| value.is_finite() && *value > 0.0) {
        sum += value.ln();
        count += 1.0;
    }
    if count > 0.0 { f64::exp(sum / count) } else { 0.0 }
}

/// Of an even number of values the mean of the two in the middle; what is no number is infinite; NaN of none.
#[must_use]
pub fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.map(|value| if value.is_nan() { f64::INFINITY } else { value }).collect();
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[middle],
        _ => f64::midpoint(values[middle - 1], values[middle]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_medians() {
        let mean = |values: &[f64]| geometric_mean(values.iter().copied());
        assert!((mean(&[1.0, 4.0, 16.0]) - 4.0).abs() < 1e-12);
        assert!((mean(&[2.0, 0.0, -1.0, f64::INFINITY, f64::NAN]) - 2.0).abs() < 1e-12, "others count for nothing");
        assert_eq!(mean(&[]).to_bits(), 0);
        let median = |values: &[f64]| super::median(values.iter().copied()).to_bits();
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2_f64.to_bits());
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5_f64.to_bits());
        assert_eq!(median(&[1.0, f64::NAN, f64::INFINITY]), f64::INFINITY.to_bits());
    }
}
