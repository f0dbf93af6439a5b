//! Rungs over many groups: the geometric mean of times, the median of largest errors.

use super::document::{Errors, Family, FamilyRung, Group, Row};
use super::pareto::{self, is_processor};
use crate::report::Number;

/// A rung over many groups.
#[derive(Clone, Debug)]
pub struct Rung {
    /// Its name.
    pub name: String,
    /// Groups that it was measured in and is right in value.
    pub groups: usize,
    /// Groups that it is disqualified in.
    pub disqualified: usize,
    /// Groups that have it not.
    pub unavailable: usize,
    /// The geometric mean of its ratios to the baseline.
    pub ratio: f64,
    /// The geometric mean of its times in nanoseconds.
    pub ns: f64,
    /// The median of its largest errors on random inputs.
    pub error: f64,
    /// Each group's id, ratio and largest error.
    pub points: Vec<(String, f64, f64)>,
}

/// The rungs over groups, in the order in which they first appear. `error` takes the largest error in the unit wanted.
#[must_use]
pub fn rungs<'a>(groups: impl Iterator<Item = &'a Group> + Clone, error: impl Fn(&Errors) -> f64) -> Vec<Rung> {
    let mut names: Vec<&str> = vec![];
    for row in groups.clone().flat_map(|group| &group.rows) {
        if !names.contains(&row.name.as_str()) {
            names.push(&row.name);
        }
    }
    let rows = |name: &'a str| {
        let of = move |group: &'a Group| group.rows.iter().find(|row| row.name == name).map(|row| (group, row));
        groups.clone().filter_map(of)
    };
    names.into_iter().map(|name| rung(name, rows(name), &error)).collect()
}

fn rung<'a>(name: &str, rows: impl Iterator<Item = (&'a Group, &'a Row)>, error: &impl Fn(&Errors) -> f64) -> Rung {
    let (mut disqualified, mut unavailable) = (0, 0);
    let (mut points, mut ns) = (vec![], vec![]);
    for (group, row) in rows {
        match row {
            Row { unavailable: Some(_), .. } => unavailable += 1,
            Row { disqualified: Some(_), .. } => disqualified += 1,
            Row { time: Some(time), random: Some(errors), .. } => {
                points.push((group.id.clone(), time.ratio, error(errors)));
                ns.push(time.ns);
            }
            _ => {}
        }
    }
    Rung {
        name: name.to_owned(),
        groups: points.len(),
        disqualified,
        unavailable,
        ratio: geometric_mean(points.iter().map(|point| point.1)),
        ns: geometric_mean(ns.into_iter()),
        error: median(points.iter().map(|point| point.2)),
        points,
    }
}

/// The rungs than which none is both faster and closer, the fastest first.
#[must_use]
pub fn front(rungs: &[Rung]) -> Vec<String> {
    let taken = rungs.iter().filter(|rung| rung.groups > 0 && !is_processor(&rung.name));
    let points: Vec<_> = taken.map(|rung| (rung.name.as_str(), Some(rung.ratio), rung.error)).collect();
    pareto::front(&points).into_iter().map(str::to_owned).collect()
}

/// A family of formulas as the document has it.
#[must_use]
pub fn family<'a>(id: &str, groups: impl Iterator<Item = &'a Group> + Clone) -> Family {
    let of = |rung: Rung| FamilyRung {
        name: rung.name,
        formulas: rung.groups,
        disqualified: rung.disqualified,
        unavailable: rung.unavailable,
        ratio: rung.ratio,
        ns: rung.ns,
        ulp_max: Number(rung.error),
        points: rung.points.into_iter().map(|(id, ratio, error)| (id, ratio, Number(error))).collect(),
    };
    let rungs = rungs(groups, |errors| errors.ulp.max.0);
    let front = front(&rungs);
    Family { id: id.to_owned(), rungs: rungs.into_iter().map(of).collect(), front }
}

impl From<&FamilyRung> for Rung {
    fn from(rung: &FamilyRung) -> Self {
        Self {
            name: rung.name.clone(),
            groups: rung.formulas,
            disqualified: rung.disqualified,
            unavailable: rung.unavailable,
            ratio: rung.ratio,
            ns: rung.ns,
            error: rung.ulp_max.0,
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
    use super::super::synthetic::{errors, group, row};
    use super::*;

    #[test]
    fn a_family_is_of_what_was_measured_and_is_right() {
        let mut groups: Vec<Group> = [2.0, 8.0, 3.0, 5.0]
            .map(|ns| group("fog/made-up", vec![row("f32", 1.0, 1.0, 4.0), row("f16", ns, ns, 100.0 * ns)]))
            .into();
        groups[2].rows[1].disqualified = Some("wrong".into());
        groups[3].rows[1].unavailable = Some("no such feature".into());
        groups[0].rows[0].random = Some(errors(f64::INFINITY));
        let family = family("fog", groups.iter());
        let [f32, f16] = family.rungs.as_slice() else { panic!("two rungs: {family:?}") };
        assert_eq!((f16.formulas, f16.disqualified, f16.unavailable, f16.points.len()), (2, 1, 1, 2));
        assert!((f16.ratio - 4.0).abs() < 1e-12 && (f16.ns - 4.0).abs() < 1e-12, "{f16:?}");
        assert_eq!((f16.ulp_max, f32.ulp_max), (Number(500.0), Number(4.0)));
        assert_eq!((f32.formulas, family.front.as_slice()), (4, ["f32".to_owned()].as_slice()));
        let again: Vec<Rung> = family.rungs.iter().map(Rung::from).collect();
        assert_eq!(front(&again), family.front);
    }

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
