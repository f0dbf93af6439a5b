//! What a bench found, from its document alone: text, pages, pictures and recommendations.

pub(crate) mod figures;
pub mod page;
pub mod plot;
pub mod recommend;
#[cfg(test)]
mod synthetic;
pub mod text;

#[cfg(test)]
mod tests {
    use super::synthetic::{document, errors, group, row};
    use lightmeter_document::bench::ladder::{self, RungSummary, front};
    use lightmeter_document::bench::pareto::{front_of, is_processor, refusal};
    use lightmeter_document::bench::{BenchGroup, BenchRow};

    #[test]
    fn a_family_is_of_what_was_measured_and_is_right() {
        let mut groups: Vec<BenchGroup> = [2.0, 8.0, 3.0, 5.0]
            .map(|ns| group("fog/made-up", vec![row("f32", 1.0, 1.0, 4.0), row("f16", ns, ns, 100.0 * ns)]))
            .into();
        groups[2].rows[1].disqualified = Some("wrong".into());
        groups[3].rows[1].unavailable = Some("no such feature".into());
        groups[0].rows[0].random = Some(errors(f64::INFINITY));
        let family = ladder::family("fog", groups.iter());
        let [f32, f16] = family.rungs.as_slice() else { panic!("two rungs: {family:?}") };
        assert_eq!((f16.formulas, f16.disqualified, f16.unavailable, f16.points.len()), (2, 1, 1, 2));
        assert!((f16.ratio - 4.0).abs() < 1e-12 && (f16.ns - 4.0).abs() < 1e-12, "{f16:?}");
        let absolute = |ulp: f64| errors(ulp).absolute.max;
        assert_eq!((f16.error_max, f32.error_max), (absolute(500.0), absolute(4.0)));
        assert_eq!((f32.formulas, family.front.as_slice()), (4, ["f32".to_owned()].as_slice()));
        // Where no step has such a form, the rung is f32: means are of the same formulas.
        let reason = "no step of it has a cheap approximation";
        groups.iter_mut().for_each(|group| group.rows.truncate(1));
        for (place, group) in groups.iter_mut().enumerate() {
            let mut cheap = row("f32-cheap", 1.0, 0.5, 100.0);
            if place > 0 {
                cheap = BenchRow { unavailable: Some(reason.into()), as_f32: true, time: None, random: None, ..cheap };
            }
            group.rows.push(cheap);
        }
        let own = ladder::family("fog", groups.iter());
        let cheap = &own.rungs[1];
        assert_eq!((cheap.formulas, cheap.as_f32, cheap.unavailable, cheap.points.len()), (1, 3, 0, 1));
        assert!((cheap.ratio - 0.5_f64.powf(0.25)).abs() < 1e-12 && cheap.error_max == absolute(4.0), "{cheap:?}");
        let again: Vec<RungSummary> = family.rungs.iter().map(RungSummary::from).collect();
        assert_eq!(front(&again), family.front);
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
