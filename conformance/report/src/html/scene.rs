//! The card of a scene whose image is wrong: reference and result behind a slider, the error map, and the pixels' values.

use super::card::{Card, failing_share, source_of};
use super::failure::command;
use super::matrix::{card_id, is_failing};
use super::page::embedded;
use lightmeter_document::report::{Departure, Failure, Group, ImageUse, PixelUse, Report};
use lightmeter_document::{Number, thousands};
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

/// The largest picture that is embedded, in bytes.
const MOST_BYTES: u64 = 4 << 20;
/// Scenes whose cards are open at first.
const OPEN: usize = 2;
/// Pixels that the card lists.
const LISTED: usize = 8;
/// How far two of them are apart, at least in one direction.
const APART: usize = 3;

/// Reference, result and error map of a wrong image.
const PICTURES: [&str; 3] = ["reference", "result", "error"];

/// What was found where a picture is to be.
#[derive(PartialEq, Eq)]
enum Picture {
    /// The file that the result's run wrote.
    Own(Vec<u8>),
    /// A picture that another run wrote under this name.
    OfAnother(String),
    /// Nothing, or what is no picture.
    Missing(String),
}

impl Picture {
    /// The address of the picture itself.
    fn embedded(&self) -> Option<String> {
        match self {
            Self::Own(png) => Some(embedded("image/png", png)),
            Self::OfAnother(_) | Self::Missing(_) => None,
        }
    }
}

/// A wrong image, and the stages that drew it in the same way.
struct Wrong<'a> {
    group: &'a Group,
    image: &'a ImageUse,
    pictures: [Picture; 3],
    /// Other stages, whose pictures are the same to the last bit.
    alike: Vec<&'a Group>,
    /// Whether it is the scene's worst card of its adapter, to which links lead.
    is_first: bool,
}

impl Wrong<'_> {
    fn anchor(&self) -> String {
        card_id(&self.group.id, &self.group.adapter) + if self.is_first { "" } else { "-other" }
    }

    /// The stages that drew it in this way.
    fn places(&self) -> String {
        let stages: Vec<&str> =
            self.alike.iter().map(|group| &*group.stage).chain([&*self.group.stage]).rev().collect();
        let target = self.group.target.as_ref().map_or_else(String::new, |target| format!(" on {target}"));
        stages.join(" and ") + &target + if stages.len() > 1 { " alike" } else { "" }
    }
}

/// The images of all scenes that are wrong, worst first. What several stages draw alike stands there once.
fn wrong(report: &Report) -> Vec<Wrong<'_>> {
    let mut all: Vec<Wrong<'_>> = vec![];
    for group in report.groups.iter().filter(|group| is_failing(group)) {
        let Some(image) = group.image.as_ref().filter(|image| !image.files.is_empty()) else { continue };
        let pictures = PICTURES.map(|what| picture(image, what));
        let is_its = |other: &&mut Wrong<'_>| other.group.id == group.id && other.group.adapter == group.adapter;
        let is_same = |other: &&mut Wrong<'_>| {
            is_its(other) && matches!(pictures[1], Picture::Own(_)) && other.pictures == pictures
        };
        match all.iter_mut().find(is_same) {
            Some(other) => other.alike.push(group),
            None => all.push(Wrong { group, image, pictures, alike: vec![], is_first: false }),
        }
    }
    all.sort_by(|a, b| failing_share(&[b.group]).total_cmp(&failing_share(&[a.group])));
    for place in 0..all.len() {
        let (before, from_here) = all.split_at_mut(place);
        let own = &mut from_here[0];
        let is_its = |other: &Wrong<'_>| other.group.id == own.group.id && other.group.adapter == own.group.adapter;
        own.is_first = !before.iter().any(is_its);
    }
    all
}

/// The cards of all scenes whose images are wrong, worst first.
pub(super) fn cards(report: &Report) -> Vec<Card> {
    let told = |(place, wrong): (usize, &Wrong<'_>)| Card {
        anchor: wrong.anchor(),
        name: wrong.group.id.clone(),
        place: format!("{}, {}{}", wrong.group.adapter, wrong.places(), source_of(wrong.group)),
        share: failing_share(&[wrong.group]),
        cause: wrong.group.cause(),
        body: card(report, wrong, place < OPEN),
    };
    wrong(report).iter().enumerate().map(told).collect()
}

/// A PNG that the report names. A later run of the same scene may have written another one under its name.
fn picture(image: &ImageUse, what: &str) -> Picture {
    let named = |file: &String| file.ends_with(&format!("-{what}.png"));
    let Some(place) = image.files.iter().position(named) else { return Picture::Missing(format!("-{what}.png")) };
    let path = &image.files[place];
    let is_small = std::fs::metadata(path).is_ok_and(|found| found.is_file() && found.len() <= MOST_BYTES);
    let bytes = is_small.then(|| std::fs::read(path).ok()).flatten();
    match bytes.filter(|bytes| bytes.starts_with(b"\x89PNG\r\n\x1a\n")) {
        None => Picture::Missing(path.clone()),
        Some(png) if image.is_its_file(place, &png).unwrap_or_else(|| is_of(image, what, &png)) => Picture::Own(png),
        Some(_) => Picture::OfAnother(path.clone()),
    }
}

/// Whether a picture has the size of the image that was judged; the map has a legend below it. It is all that tells pictures of a document
/// without hashes.
fn is_of(image: &ImageUse, what: &str, png: &[u8]) -> bool {
    let number = |at: usize| Some(u32::from_be_bytes(png.get(at..at + 4)?.try_into().ok()?) as usize);
    let (width, height) = (number(16), number(20));
    width == Some(image.width)
        && if what == "error" { height > Some(image.height) } else { height == Some(image.height) }
}

/// The map without the legend that stands below it in its file, and a legend beside it.
fn map(wrong: &Wrong<'_>, error: &str) -> Markup {
    let (width, height) = (wrong.image.width, wrong.image.height);
    html! {
        figure {
            svg.map viewBox={ "0 0 " (width) " " (height) } role="img" aria-label={ "where " (wrong.group.id) " is wrong, and by how much" } {
                image href=(error) x="0" y="0" {}
            }
            div.legend aria-hidden="true" { @for power in ["0.01", "0.1", "1", "10", "100", "1000"] { span { (power) } } }
            figcaption { "Error over tolerance. From 1 on a pixel is wrong: yellow, red, violet. Grey pixels lie at an edge, where more is legal." }
        }
    }
}

fn card(report: &Report, wrong: &Wrong<'_>, is_open: bool) -> Markup {
    let Wrong { group, image, .. } = *wrong;
    let [reference, result, error] = wrong.pictures.each_ref().map(Picture::embedded);
    let failure = report.failures.iter().find(|failure| {
        failure.adapter == group.adapter && failure.stage == group.stage && group.has_case(&failure.id)
    });
    html! {
        details.card.scene id=(wrong.anchor()) open[is_open] {
            summary {
                span.fail { "✗" } " " b { (group.id) } " on " (group.adapter) ", " (wrong.places()) ": "
                span.quiet {
                    (thousands(group.totals.failed)) " of " (thousands(group.totals.verdicts)) " values fail"
                    @if group.totals.expected_failures > 0 { ", besides " (thousands(group.totals.expected_failures)) " that are known deviations" }
                    "."
                }
            }
            @for what in group.reasons() { p.cause { (what) } }
            @if let Some(Departure { stage, pixels, of }) = &image.departs_in {
                p { "The first intermediate result that departs: " b { (stage) } " (" (pixels) " of " (of) " pixels looked at)." }
            }
            @if let (Some(reference), Some(result)) = (&reference, &result) {
                div.pictures {
                    figure {
                        div.slider data-width=(image.width) data-height=(image.height) {
                            img.result src=(result) alt={ "what was drawn of " (group.id) };
                            img.reference src=(reference) alt={ "the reference of " (group.id) };
                            canvas.marks aria-hidden="true" {}
                            div.cut {}
                        }
                        label { "reference " input type="range" min="0" max="100" value="50" aria-label="how much of the reference is shown"; " result" }
                        label { input.marked type="checkbox"; " show the pixels that are listed" }
                        figcaption { "Reference on the left of the line, result on the right." }
                    }
                    @if let Some(error) = &error { (map(wrong, error)) }
                }
                output.pixel role="status" { "Point at a pixel, or choose one below, to see its values." }
            }
            (lacking(&wrong.pictures))
            (pixels(image))
            @if let Some(Failure { rerun, .. }) = failure { @if !rerun.is_empty() { (command(rerun)) } }
        }
    }
}

/// Which pictures are not shown, and why.
fn lacking(pictures: &[Picture]) -> Markup {
    let files = |is: fn(&Picture) -> Option<&str>| pictures.iter().filter_map(is).collect::<Vec<_>>().join(", ");
    let missing = files(|picture| if let Picture::Missing(file) = picture { Some(file) } else { None });
    let others = files(|picture| if let Picture::OfAnother(file) = picture { Some(file) } else { None });
    html! {
        @if !missing.is_empty() { p.hint { "These pictures of this scene were not found when the page was made: " (missing) } }
        @if !others.is_empty() {
            p.cause { "These pictures are not shown, because another run wrote them under the same name after this one: " (others) }
        }
    }
}

/// The worst pixels, and the values of all that are told for the script.
fn pixels(image: &ImageUse) -> Markup {
    let row = |pixel: &PixelUse| -> Value {
        let four = |numbers: &[Number; 4]| json!(numbers);
        json!([
            pixel.x,
            pixel.y,
            four(&pixel.reference),
            four(&pixel.low),
            four(&pixel.high),
            four(&pixel.value),
            u8::from(pixel.marked)
        ])
    };
    // A script's data ends at the first `</`, whatever it stands in.
    let data = Value::from(image.pixels.iter().map(row).collect::<Vec<_>>()).to_string().replace('<', "\\u003c");
    html! {
        script.pixels type="application/json" { (PreEscaped(data)) }
        @if !image.pixels.is_empty() {
            div.wide tabindex="0" role="group" aria-label="worst pixels" { table.worst {
                thead { tr { th scope="col" { "pixel" } th scope="col" { "reference" } th scope="col" { "legal" } th scope="col" { "drawn" } } }
                @for pixel in listed(image) {
                    tr {
                        th scope="row" { button type="button" data-x=(pixel.x) data-y=(pixel.y) { (pixel.x) ", " (pixel.y) } }
                        td.number { (four(pixel, &pixel.reference)) }
                        td.number { (four(pixel, &pixel.low)) br; (four(pixel, &pixel.high)) }
                        td.number { (four(pixel, &pixel.value)) @if pixel.marked { " (several outcomes are legal)" } }
                    }
                }
            } }
        }
    }
}

/// The worst pixels, but for those beside one that is listed, which are wrong in the same way.
fn listed(image: &ImageUse) -> Vec<&PixelUse> {
    let mut listed: Vec<&PixelUse> = vec![];
    for pixel in &image.pixels {
        let is_beside = |other: &PixelUse| pixel.x.abs_diff(other.x) <= APART && pixel.y.abs_diff(other.y) <= APART;
        if listed.len() < LISTED && !listed.iter().any(|other| is_beside(other)) {
            listed.push(pixel);
        }
    }
    listed
}

/// A pixel's numbers, with as many decimals as tell the ends of what is legal from each other and from what was drawn.
fn four(pixel: &PixelUse, numbers: &[Number; 4]) -> String {
    let least = (0..4)
        .flat_map(|k| {
            let [low, high, value] = [pixel.low[k].0, pixel.high[k].0, pixel.value[k].0];
            [high - low, value - low, value - high]
        })
        .map(f64::abs)
        .filter(|apart| apart.is_finite() && *apart > 0.0)
        .fold(1.0, f64::min);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few decimals")]
    let decimals = (1.0 - least.log10()).ceil().clamp(0.0, 8.0) as usize;
    numbers.map(|x| if x.0.is_finite() { format!("{:.decimals$}", x.0) } else { x.to_string() }).join("  ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_document::hash;

    #[test]
    fn pictures_of_another_size_than_the_image_are_of_another_run() {
        let image: ImageUse =
            serde_json::from_value(json!({ "width": 256, "height": 128, "marked": 0 })).expect("it is an image");
        let png = |width: u32, height: u32| {
            [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"[..], &width.to_be_bytes(), &height.to_be_bytes()].concat()
        };
        for (what, size, is_its) in [
            ("result", (256, 128), true),
            ("result", (512, 128), false),
            ("reference", (256, 512), false),
            ("error", (256, 140), true),
            ("error", (512, 300), false),
        ] {
            assert_eq!(is_of(&image, what, &png(size.0, size.1)), is_its, "{what} {size:?}");
        }
        assert!(!is_of(&image, "result", b"\x89PNG"));
    }

    #[test]
    fn a_picture_of_a_later_run_is_not_shown_and_is_told() {
        let folder = std::env::temp_dir().join(format!("lightmeter-pictures-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder can be made");
        let path = folder.join("scene-result.png");
        let png = |last: u8| [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x08\0\0\0\x08"[..], &[last]].concat();
        let file = path.display().to_string();
        let mut image: ImageUse = serde_json::from_value(
            json!({ "width": 8, "height": 8, "marked": 0, "files": [file], "hashes": [hash(&png(1))] }),
        )
        .expect("it is an image");
        std::fs::write(&path, png(1)).expect("it can be written");
        assert!(picture(&image, "result") == Picture::Own(png(1)));
        std::fs::write(&path, png(2)).expect("it can be written");
        let later = picture(&image, "result");
        assert!(later == Picture::OfAnother(path.display().to_string()));
        assert!(lacking(&[later]).0.contains("another run wrote them"));
        // An older document has no hashes: the size is all that tells.
        image.hashes.clear();
        assert!(picture(&image, "result") == Picture::Own(png(2)));
        std::fs::remove_dir_all(&folder).expect("it is there");
        assert!(matches!(picture(&image, "result"), Picture::Missing(_)));
    }
}
