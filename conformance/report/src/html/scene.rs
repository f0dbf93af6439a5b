//! The card of a scene whose image is wrong: reference and result behind a slider, the error map, and the pixels' values.

use super::failure::command;
use super::matrix::{card_id, is_failing};
use super::page::embedded;
use lightmeter_document::run::{Failure, Group, ImageUse, PixelUse, Report};
use lightmeter_document::{Number, thousands};
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

/// The largest picture that is embedded, in bytes.
const MOST_BYTES: u64 = 4 << 20;
/// Scenes whose cards are open at first.
const OPEN: usize = 2;
/// Pixels that the card lists.
const LISTED: usize = 12;
/// How far two of them are apart, at least in one direction.
const APART: usize = 3;

/// The cards of all scenes whose images are wrong, worst first.
pub(super) fn cards(report: &Report) -> Vec<Markup> {
    let mut scenes: Vec<(&Group, &ImageUse)> = report
        .groups
        .iter()
        .filter(|group| is_failing(group))
        .filter_map(|group| Some((group, group.image.as_ref().filter(|image| !image.files.is_empty())?)))
        .collect();
    scenes.sort_by_key(|(group, _)| std::cmp::Reverse(group.totals.failed));
    let mut named = vec![];
    let mut cards = vec![];
    for (place, (group, image)) in scenes.into_iter().enumerate() {
        let first = !named.contains(&(&group.id, &group.adapter));
        named.push((&group.id, &group.adapter));
        cards.push(card(report, (group, image), first, place < OPEN));
    }
    cards
}

/// A PNG that the report names, as an address; nothing where it is none.
fn picture(image: &ImageUse, what: &str) -> Option<String> {
    let path = image.files.iter().find(|file| file.ends_with(&format!("-{what}.png")))?;
    let is_small = std::fs::metadata(path).is_ok_and(|found| found.is_file() && found.len() <= MOST_BYTES);
    let bytes = is_small.then(|| std::fs::read(path).ok()).flatten()?;
    bytes.starts_with(b"\x89PNG\r\n\x1a\n").then(|| embedded("image/png", &bytes))
}

fn card(report: &Report, (group, image): (&Group, &ImageUse), is_first: bool, is_open: bool) -> Markup {
    let [reference, result, error] = ["reference", "result", "error"].map(|what| picture(image, what));
    let failure = report.failures.iter().find(|failure| {
        failure.adapter == group.adapter
            && failure.stage == group.stage
            && failure.id.starts_with(&format!("{}/", group.id))
    });
    let id = card_id(&group.id, &group.adapter) + if is_first { "" } else { "-full" };
    html! {
        details.card.scene id=(id) open[is_open] {
            summary {
                span.fail { "✗" } " " b { (group.id) } " on " (group.adapter) ", " (group.place()) " "
                span.quiet { (thousands(group.totals.failed)) " of " (thousands(group.totals.verdicts)) " values fail." }
            }
            @for what in group.explanation.iter().chain(&group.problem) {
                p.cause { (what.split("; the worst: ").next().unwrap_or_default()) }
            }
            @if let Some(stage) = &image.departs_in { p { "The first intermediate result that departs: " b { (stage) } "." } }
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
                    @if let Some(error) = &error {
                        figure { img.map src=(error) alt={ "where " (group.id) " is wrong, and by how much" };
                            figcaption { "Error over tolerance, on a scale of logarithms." } }
                    }
                }
                output.pixel role="status" { "Point at a pixel, or choose one below, to see its values." }
            } @else {
                p.hint { "The pictures of this scene were not found when the page was made: " (image.files.join(", ")) }
            }
            (pixels(image))
            @if let Some(Failure { rerun, .. }) = failure { @if !rerun.is_empty() { (command(rerun)) } }
        }
    }
}

/// The worst pixels, and the values of all that are told for the script.
fn pixels(image: &ImageUse) -> Markup {
    let row = |pixel: &PixelUse| -> Value {
        let four = |numbers: &[Number; 4]| json!(numbers.map(|x| x.to_string()));
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
