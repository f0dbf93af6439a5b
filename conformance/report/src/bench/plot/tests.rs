use super::*;
use crate::bench::synthetic::document;

#[test]
fn every_adapter_has_a_picture_of_everything() {
    let document = document();
    let pictures = pictures(&document).expect("a string takes all");
    let stems: Vec<String> = pictures.iter().map(Plot::stem).collect();
    assert_eq!(stems.len(), 22, "{stems:?}");
    for measured in &document.adapters {
        for subject in
            measured.families.iter().map(|family| family.id.as_str()).chain(["techniques", "scenes", "growth"])
        {
            assert!(stems.contains(&format!("{}-{subject}", measured.adapter)), "{subject}");
        }
    }
    for Plot { title, svg, adapter, .. } in &pictures {
        assert!(title.contains(adapter.as_str()) && svg.contains(title.as_str()), "{title}");
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"), "{title}");
        // Between quotes are the places and paths.
        let is_number = |value: &str| !value.contains("NaN") && !value.contains("inf");
        assert!(svg.split('"').skip(1).step_by(2).all(is_number), "{title} has a place that is no number");
    }
}

#[test]
fn every_row_that_was_measured_is_named() {
    let document = document();
    let pictures = pictures(&document).expect("a string takes all");
    for measured in &document.adapters {
        let svg = |subject: &str| {
            let found = pictures.iter().find(|one| one.adapter == measured.adapter && one.subject == subject);
            &found.expect("there is one").svg
        };
        for family in &measured.families {
            for rung in &family.rungs {
                let names = svg(&family.id).matches(&format!(">{}</text>", rung.name)).count();
                assert_eq!(names, usize::from(rung.formulas > 0), "{} of {}", rung.name, family.id);
                // The halo comes right before the name, and the weight before the halo.
                let bold = r##" font-weight="bold" stroke="#ffffff" stroke-width="3" stroke-opacity="0.85" paint-order="stroke">"##;
                let is_bold = svg(&family.id).contains(&format!("{bold}{}</text>", rung.name));
                assert_eq!(is_bold, family.front.contains(&rung.name), "{} of {}", rung.name, family.id);
            }
        }
        let rows = measured.groups.iter().filter(|group| group.family == "technique").flat_map(|group| &group.rows);
        for row in rows.filter(|row| row.unavailable.is_none()) {
            assert!(svg("techniques").contains(&format!(">{}</text>", row.name)), "{}", row.name);
        }
        for scaling in &measured.scalings {
            assert!(svg("growth").contains(&format!(">{}</text>", scaling.id)));
            assert!(scaling.fit.is_none() || svg("growth").contains(&format!("{}^", scaling.unit)));
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

#[test]
fn text_is_large_enough_to_be_read() {
    for picture in pictures(&document()).expect("a string takes all") {
        for size in picture.svg.split(r#"font-size=""#).skip(1) {
            let size: f64 = size.split('"').next().and_then(|size| size.parse().ok()).expect("a number");
            assert!(size >= 11.0, "{size} in {}", picture.title);
        }
    }
}

/// The names beside markers: left end, top and width, which text as wide as it may be takes.
fn names(svg: &str) -> Vec<(String, [f64; 3])> {
    let name = |text: &str| {
        let number = |from: &str| text.split(from).nth(1)?.split('"').next()?.parse::<f64>().ok();
        let name = text.split('>').nth(1)?.to_owned();
        let width = svg::text_width(&name, svg::SIZE);
        text.contains("paint-order").then_some((name, [number("x=\"")? - width / 2.0, number("y=\"")?, width]))
    };
    svg.split("<text ").filter_map(|text| name(text.split("</text>").next()?)).collect()
}

/// The same document with all rows of a group in one place, or nearly.
fn crowded() -> BenchDocument {
    let mut document = document();
    for measured in &mut document.adapters {
        for rung in measured.families.iter_mut().flat_map(|family| &mut family.rungs) {
            rung.ratio = 1.0 + (rung.ratio - 1.0) * 1e-4;
            rung.error_max.0 = rung.error_max.0.clamp(0.5, 0.51);
            rung.points.iter_mut().for_each(|point| (point.1, point.2.0) = (1.0, 0.5));
        }
        let rows = measured.groups.iter_mut().flat_map(|group| &mut group.rows);
        rows.filter_map(|row| row.time.as_mut()).for_each(|time| (time.ns, time.quartiles_ns) = (2.0, [1.9, 2.1]));
    }
    document
}

#[test]
fn names_do_not_overlap() {
    for document in [document(), crowded()] {
        for picture in pictures(&document).expect("a string takes all") {
            let names = names(&picture.svg);
            assert!(names.len() > 3 || picture.subject == "growth", "{}", picture.title);
            for (place, (name, [left, top, width])) in names.iter().enumerate() {
                assert!(*left >= 0.0 && left + width <= svg::WIDTH, "{name} in {}", picture.title);
                for (other, [x, y, wide]) in &names[..place] {
                    let is_clear = left + width <= *x || x + wide <= *left || (top - y).abs() >= svg::SIZE - 0.1;
                    assert!(is_clear, "{name} and {other} in {}", picture.title);
                }
            }
        }
    }
}
