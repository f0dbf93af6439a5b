//! Pictures of a bench: errors against times, and times against work.

use super::figures::count;
use super::text::{is_stable_form, law};
use crate::plot::{Chart, Quantity, Series, Undrawn, marker, power};
use lightmeter_document::bench::ladder::{BASELINE, RungSummary, front, rungs};
use lightmeter_document::bench::pareto::is_processor;
use lightmeter_document::bench::{BenchDocument, BenchGroup, BenchRow, GroupKind, Measured, Scaling};
use lightmeter_document::thousands;

/// A picture.
#[derive(Clone, Debug)]
pub struct Plot {
    /// The adapter.
    pub adapter: String,
    /// What it shows: a family's id, `scenes`, a technique as `technique-power`, or a kind of work as `lights`.
    pub subject: String,
    /// What it shows, in words.
    pub title: String,
    /// The picture.
    pub svg: String,
}

impl Plot {
    /// The name of its file, without the extension: `lavapipe-fog`.
    #[must_use]
    pub fn stem(&self) -> String {
        format!("{}-{}", self.adapter, self.subject)
    }
}

/// The subject of a group's picture.
pub(super) fn subject(id: &str) -> String {
    id.replace('/', "-")
}

/// All pictures of a document: for each adapter one of each family, of each technique, of the scenes, and of each kind of work, as far as
/// it has something for them to show.
///
/// # Errors
/// Where the library that draws them fails.
pub fn pictures(document: &BenchDocument) -> Result<Vec<Plot>, Undrawn> {
    let mut pictures = vec![];
    for measured in &document.adapters {
        for (subject, chart) in charts(measured) {
            let (adapter, title) = (measured.adapter.clone(), chart.title.clone());
            pictures.push(Plot { adapter, subject, title, svg: chart.svg()? });
        }
    }
    Ok(pictures)
}

/// The charts of an adapter, each with its subject.
fn charts(measured: &Measured) -> Vec<(String, Chart)> {
    let adapter = &measured.adapter;
    let mut charts = vec![];
    // Scenes have a picture of their own.
    for family in measured.families.iter().filter(|family| family.id != "scene") {
        let rungs: Vec<RungSummary> = family.rungs.iter().map(RungSummary::from).collect();
        let title = format!("{} on {adapter}: error against time", family.id);
        let error = "largest absolute error on random inputs";
        charts.extend(cloud(title, &rungs, &family.front, ["formula", error]).map(|chart| (family.id.clone(), chart)));
    }
    let techniques =
        measured.groups.iter().filter(|group| group.kind == GroupKind::Technique && !is_stable_form(group));
    charts.extend(techniques.filter_map(|group| Some((subject(&group.id), technique(group, adapter)?))));
    let scenes = measured.groups.iter().filter(|group| group.kind == GroupKind::Scene);
    let rungs = rungs(scenes, |errors| errors.steps.max.0);
    let title = format!("scenes on {adapter}: error against time");
    let words = ["scene", "largest error of a pixel, in 1/255"];
    charts.extend(cloud(title, &rungs, &front(&rungs), words).map(|chart| ("scenes".into(), chart)));
    charts.extend(measured.scalings.iter().filter_map(|one| Some((subject(&one.id), growth(one, adapter)?))));
    charts
}

/// Rungs over many groups: a large marker each, and a small one for each group.
fn cloud(title: String, rungs: &[RungSummary], on_front: &[String], [of, error]: [&str; 2]) -> Option<Chart> {
    let measured: Vec<&RungSummary> = rungs.iter().filter(|rung| rung.groups > 0).collect();
    let groups = measured.iter().map(|rung| rung.groups + rung.as_f32 + rung.disqualified + rung.unavailable).max()?;
    let series = |(place, rung): (usize, &&RungSummary)| Series {
        large: vec![[rung.ratio, rung.error]],
        // The width of the legal interval has one mark: it is not an error that somebody made.
        small: if rung.name == "cpu-accept" { vec![] } else { rung.points.iter().map(|one| [one.1, one.2]).collect() },
        is_bold: on_front.contains(&rung.name),
        ..Series::new(&rung.name, marker(&rung.name, place))
    };
    let through = on_front.iter().filter_map(|name| measured.iter().find(|rung| rung.name == *name));
    Some(Chart {
        title,
        below: format!("{}; large: mean ratio and median error of all; small: each {of}", count(groups, of)),
        across: Quantity { name: "time over that of f32".into(), ..Quantity::default() },
        upwards: Quantity::new(error),
        series: measured.iter().enumerate().map(series).collect(),
        line: pareto(through.map(|rung| [rung.ratio, rung.error]).collect()),
        notes: vec!["grey: on the processor".into()],
    })
}

/// As many words as have room below a title, and a mark where some have not.
fn shortened(words: &str) -> String {
    const MOST: usize = 120;
    if words.chars().count() <= MOST {
        return words.to_owned();
    }
    let cut: String = words.chars().take(MOST).collect();
    cut.rsplit_once(' ').map_or("", |(kept, _)| kept).trim_end_matches([',', ';', ':']).to_owned() + " …"
}

fn pareto(points: Vec<[f64; 2]>) -> Option<(String, Vec<[f64; 2]>)> {
    (points.len() > 1).then(|| ("none faster and closer".into(), points))
}

/// The rows of a technique, but for those of the processor, which are told in tables.
fn technique(group: &BenchGroup, adapter: &str) -> Option<Chart> {
    let point = |row: &BenchRow| Some([row.time.as_ref()?.ns, row.random.as_ref()?.absolute.max.0]);
    let rows: Vec<(&BenchRow, [f64; 2])> =
        (group.rows.iter()).filter(|row| !is_processor(&row.name)).filter_map(|row| Some((row, point(row)?))).collect();
    // A technique has its colour at all rungs, and a rung its shape: `chord double-float`.
    let parts = |name: &'_ str| -> (String, String) {
        name.rsplit_once(' ')
            .map_or((name.to_owned(), BASELINE.to_owned()), |(of, rung)| (of.to_owned(), rung.to_owned()))
    };
    let mut techniques: Vec<String> = vec![];
    for (row, _) in &rows {
        let (of, _) = parts(&row.name);
        if !techniques.contains(&of) {
            techniques.push(of);
        }
    }
    let series = |(row, [ns, error]): &(&BenchRow, [f64; 2])| {
        let (of, rung) = parts(&row.name);
        let place = techniques.iter().position(|one| *one == of).unwrap_or_default();
        let quartiles = row.time.as_ref().map(|time| time.quartiles_ns.map(|ns| [ns, *error]));
        Series {
            large: vec![[*ns, *error]],
            ranges: quartiles.into_iter().collect(),
            is_bold: group.front.contains(&row.name),
            is_hollow: row.disqualified.is_some(),
            ..Series::new(&row.name, marker(&rung, 0).colored_as(marker("", place)))
        }
    };
    let lacking = group.rows.iter().filter(|row| row.unavailable.is_some() && !is_processor(&row.name));
    let on_front = group.front.iter().filter_map(|name| rows.iter().find(|(row, _)| row.name == *name));
    (!rows.is_empty()).then(|| Chart {
        title: format!("{} on {adapter}", group.id),
        below: shortened(&group.title),
        across: Quantity { name: format!("time for one {}", group.unit), written: duration },
        upwards: Quantity::new("largest absolute error on random inputs"),
        series: rows.iter().map(series).collect(),
        line: pareto(on_front.map(|(_, point)| *point).collect()),
        notes: lacking
            .map(|row| format!("not measured: {}", row.name))
            .chain(["lines: the middle half".into(), "hollow: wrong in value".into()])
            .collect(),
    })
}

/// Nanoseconds as they are written beside an axis.
fn duration(ns: f64) -> String {
    let (scale, unit) = match ns {
        x if x >= 0.999e9 => (1e9, "s"),
        x if x >= 0.999e6 => (1e6, "ms"),
        x if x >= 0.999e3 => (1e3, "µs"),
        x if x >= 0.0999 => (1.0, "ns"),
        _ => (1e-3, "ps"),
    };
    format!("{} {unit}", power(ns / scale))
}

/// Time against work, with the law that was fitted.
#[expect(clippy::cast_precision_loss, reason = "work is far below 2⁵³, and this is a picture")]
fn growth(scaling: &Scaling, adapter: &str) -> Option<Chart> {
    let (first, last) = (scaling.points.first()?.work as f64, scaling.points.last()?.work as f64);
    let at = |work: u64, ns: f64| [work as f64, ns];
    let measured = Series {
        large: scaling.points.iter().map(|point| at(point.work, point.ns)).collect(),
        ranges: scaling.points.iter().map(|point| point.quartiles_ns.map(|ns| at(point.work, ns))).collect(),
        ..Series::new("measured", marker("f32", 0))
    };
    let law_of = scaling.fit.as_ref().map(|fit| {
        let curve = (0..=48).map(|step| {
            let work = first.max(1.0) * (last / first.max(1.0)).powf(f64::from(step) / 48.0);
            [work, fit.fixed_ns + fit.factor_ns * work.powf(fit.exponent)]
        });
        ("the fitted law".to_owned(), curve.collect())
    });
    let lacking = scaling.unavailable.iter().map(|(work, _)| format!("not reached: {}", thousands(*work)));
    Some(Chart {
        title: format!("{} on {adapter}: {}", scaling.id, scaling.what),
        below: format!("{}; lines: the middle half of the turns", law(scaling)),
        across: Quantity::new(&scaling.unit),
        upwards: Quantity { name: format!("time, by {}", scaling.clock), written: duration },
        series: vec![measured],
        line: law_of,
        notes: lacking.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::document;
    use super::*;

    #[test]
    fn every_adapter_has_a_picture_of_everything() {
        let document = document();
        let pictures = pictures(&document).expect("a string takes all");
        let stems: Vec<String> = pictures.iter().map(Plot::stem).collect();
        for measured in &document.adapters {
            let groups =
                measured.groups.iter().filter(|group| group.kind == GroupKind::Technique && !is_stable_form(group));
            let families = measured.families.iter().map(|family| family.id.clone());
            let scalings = measured.scalings.iter().filter(|one| !one.points.is_empty()).map(|one| subject(&one.id));
            for of in families.chain(groups.map(|group| subject(&group.id))).chain(scalings).chain(["scenes".into()]) {
                assert!(stems.contains(&format!("{}-{of}", measured.adapter)), "{of} of {}", measured.adapter);
            }
        }
        for Plot { title, svg, adapter, .. } in &pictures {
            assert!(title.contains(adapter.as_str()), "{title}");
            assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"), "{title}");
            assert!(title.chars().count() <= 90, "{title} is cut off");
            // Between quotes are the places and paths.
            let is_number = |value: &str| !value.contains("NaN") && !value.contains("inf");
            assert!(svg.split('"').skip(1).step_by(2).all(is_number), "{title} has a place that is no number");
        }
    }

    #[test]
    fn every_row_that_was_measured_is_named_and_those_on_the_front_are_bold() {
        let document = document();
        for measured in &document.adapters {
            let charts = charts(measured);
            let chart = |subject: &str| &charts.iter().find(|(of, _)| of == subject).expect("there is one").1;
            for family in &measured.families {
                for rung in &family.rungs {
                    let found = chart(&family.id).series.iter().find(|one| one.name == rung.name);
                    assert_eq!(found.is_some(), rung.formulas > 0, "{} of {}", rung.name, family.id);
                    let is_bold = found.is_some_and(|one| one.is_bold);
                    assert_eq!(is_bold, family.front.contains(&rung.name), "{} of {}", rung.name, family.id);
                }
            }
            let techniques =
                measured.groups.iter().filter(|group| group.kind == GroupKind::Technique && !is_stable_form(group));
            for group in techniques {
                let svg = chart(&subject(&group.id)).svg().expect("a string takes all");
                for row in group.rows.iter().filter(|row| row.unavailable.is_none() && !is_processor(&row.name)) {
                    assert!(svg.contains(&format!("\n{}\n</text>", row.name)), "{} of {}", row.name, group.id);
                }
            }
        }
    }

    #[test]
    fn a_document_of_nothing_has_no_picture() {
        let mut document = document();
        for measured in &mut document.adapters {
            (measured.families, measured.groups, measured.scalings) = (vec![], vec![], vec![]);
        }
        assert!(pictures(&document).expect("a string takes all").is_empty());
    }

    /// The texts of a picture: their left ends, middles and sizes.
    fn texts(svg: &str) -> Vec<(String, f64, f64)> {
        let text = |part: &str| {
            let number = |name: &str| part.split(&format!(" {name}=\"")).nth(1)?.split('"').next()?.parse::<f64>().ok();
            let words = part.split('>').nth(1)?.trim().trim_end_matches("</text").to_owned();
            Some((words, number("x")?, number("y")?))
        };
        svg.split("<text").skip(1).filter_map(text).collect()
    }

    #[test]
    fn names_in_the_legend_do_not_collide_and_are_not_cut_off() {
        for picture in pictures(&document()).expect("a string takes all") {
            let legend: Vec<_> = texts(&picture.svg).into_iter().filter(|(_, x, y)| *x > 695.0 && *y > 60.0).collect();
            assert!(!legend.is_empty(), "{}", picture.title);
            for pair in legend.windows(2) {
                assert!((pair[0].2 - pair[1].2).abs() >= 14.0, "{pair:?} in {}", picture.title);
            }
            let width = |words: &str| words.chars().map(|_| 8.0).sum::<f64>();
            let widest = legend.iter().map(|(words, x, _)| x + width(words)).fold(0.0, f64::max);
            assert!(widest <= 940.0, "a name ends at {widest} in {}", picture.title);
        }
    }
}
