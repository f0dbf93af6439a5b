//! Pictures of a bench, drawn as SVG: errors against times, and times against work.
//!
//! Axes are logarithmic; an error of 0 lies in a band at the bottom, one that is infinite or no number in a band at the top. The
//! line is the Pareto front, whose names are bold; rungs on the processor are grey.

mod axis;
mod cloud;
mod growth;
mod label;
mod mark;
mod panels;
mod svg;

use super::text::is_stable_form;
use lightmeter_document::bench::ladder::{RungSummary, rungs};
use lightmeter_document::bench::{BenchDocument, GroupKind, Measured};

/// A picture.
#[derive(Clone, Debug)]
pub struct Plot {
    /// The adapter.
    pub adapter: String,
    /// What it shows: a family's id, `techniques`, `scenes` or `growth`.
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

/// All pictures of a document: for each adapter one a family, and one of techniques, of scenes and of growth, as far as it has
/// something for them to show.
///
/// # Errors
/// Where the writer fails.
pub fn pictures(document: &BenchDocument) -> Result<Vec<Plot>, std::fmt::Error> {
    let mut pictures = vec![];
    for measured in &document.adapters {
        // Scenes have a picture of their own.
        for family in measured.families.iter().filter(|family| family.id != "scene") {
            let rungs: Vec<RungSummary> = family.rungs.iter().map(RungSummary::from).collect();
            let cloud = cloud::Cloud {
                title: format!("{} on {}: error against time", family.id, measured.adapter),
                rungs: &rungs,
                front: &family.front,
                of: "formula",
                error: "largest absolute error on random inputs",
            };
            push(measured, &family.id, &cloud.title, cloud.svg()?, &mut pictures);
        }
        let techniques = measured.groups.iter().filter(|group| group.kind == GroupKind::Technique);
        let title = format!("Techniques on {}: error against time", measured.adapter);
        let groups: Vec<_> = techniques.filter(|group| !is_stable_form(group)).collect();
        push(measured, "techniques", &title, panels::svg(&groups, &measured.rungs, &title)?, &mut pictures);
        let scenes = measured.groups.iter().filter(|group| group.kind == GroupKind::Scene);
        let rungs = rungs(scenes, |errors| errors.steps.max.0);
        let front = lightmeter_document::bench::ladder::front(&rungs);
        let title = format!("Scenes on {}: error against time", measured.adapter);
        let error = "largest error of a pixel, 1/255";
        let cloud = cloud::Cloud { title, rungs: &rungs, front: &front, of: "scene", error };
        push(measured, "scenes", &cloud.title, cloud.svg()?, &mut pictures);
        let title = format!("Growth of time with work on {}", measured.adapter);
        push(measured, "growth", &title, growth::svg(&measured.scalings, &title)?, &mut pictures);
    }
    Ok(pictures)
}

/// Keeps a picture, where there is one.
fn push(measured: &Measured, subject: &str, title: &str, svg: Option<String>, pictures: &mut Vec<Plot>) {
    if let Some(svg) = svg {
        let (adapter, subject, title) = (measured.adapter.clone(), subject.to_owned(), title.to_owned());
        pictures.push(Plot { adapter, subject, title, svg });
    }
}

#[cfg(test)]
mod tests;
