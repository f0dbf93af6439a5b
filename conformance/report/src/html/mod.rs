//! Results as a page that people look at: one file of HTML with everything in it, made from documents alone.
//!
//! Nothing in it is fetched from elsewhere. Its content security policy permits the page's own style and script, by their hashes, and pictures
//! that are embedded; names of others are text wherever they stand.

mod card;
mod compared;
mod equation;
mod failure;
mod markdown;
mod matrix;
mod number;
mod overview;
mod page;
mod plot;
mod scene;
mod shader;
mod verdict;

pub use equation::equation;
pub use markdown::{markdown, own_markdown};
pub use number::written;
pub use page::{PageKind, embedded, page, prose};
pub use plot::course as course_plot;
pub use shader::of_shaders;

use crate::against::{BASELINE, lines};
use crate::bench::{page as bench_page, plot as bench_plot};
use crate::page::selftest::{self, SelftestRun};
use crate::page::sweep::{self, Swept};
use card::{Card, percent};
use compared::compared;
use lightmeter_document::bench::BenchDocument;
use lightmeter_document::report::Report;
use matrix::Column;
use maud::{Markup, html};
use overview::Facts;
use std::fmt;
use verdict::Verdict;

/// The page of a result.
#[must_use]
pub fn of_report(report: &Report) -> String {
    let facts = Facts::of_report(report, Verdict::new(report));
    let columns = matrix::columns(&[("", report)]);
    let passing = failure::passing_cards(report);
    let body = html! {
        (overview::head(&facts))
        (against(report))
        (failures(report))
        @if !passing.is_empty() {
            section #nearest {
                h2 { "What passes, and where it is nearest to failing" }
                p.hint { "Of each formula the case whose answer uses the most of what is legal: its steps, and the output along the input that moves it most, with the band of legal values." }
                @for card in passing { (card) }
            }
        }
        (all(&columns, true))
        (overview::notes(report))
    };
    page(&facts.title, PageKind::Report, &body)
}

/// What fails, worst first; nothing where all passes.
fn failures(report: &Report) -> Markup {
    let (mut cards, left) = failure::cards(report);
    cards.extend(scene::cards(report));
    cards.sort_by(|a, b| b.share.total_cmp(&a.share));
    html! {
        @if !cards.is_empty() {
            section #failures {
                h2 { "What fails" }
                @if cards.len() > 1 { (list(&cards)) }
                p.hint { "Worst first. Keys: " kbd { "j" } " and " kbd { "k" } " go to the next and the previous one, " kbd { "/" } " to the filter." }
                @for card in &cards { (card.body) }
                @if left > 0 { p { (left) " more are in the table below and in the JSON." } }
            }
        }
    }
}

/// One line for each card.
fn list(cards: &[Card]) -> Markup {
    html! {
        div.wide tabindex="0" role="group" aria-label="what fails" { table.fails {
            thead { tr { th scope="col" { "what" } th scope="col" { "where" } th scope="col" { "how much" } th scope="col" { "cause" } } }
            tbody { @for card in cards { tr {
                th scope="row" { a href={ "#" (card.anchor) } { (card.name) } }
                td { (card.place) }
                td { (percent(card.share)) }
                td { @match &card.cause { Some(cause) => (written(cause)), None => span.quiet { "no known mistake explains it" } } }
            } } }
        } }
    }
}

/// The matrix of all formulas, with its filters.
fn all(columns: &[Column<'_>], has_cards: bool) -> Markup {
    html! {
        section #all {
            h2 { "Everything that was judged" }
            (matrix::filters(columns))
            (matrix::table(columns, has_cards))
        }
    }
}

/// What a comparison with a baseline says, what was expected to fail, and what went wrong with a renderer.
fn against(report: &Report) -> Markup {
    let lines = lines(report);
    let incidents: Vec<&String> =
        report.renderer.iter().flat_map(|renderer| renderer.incidents.iter().chain(&renderer.problems.first)).collect();
    let has_baseline = !(report.regressions.is_empty() && report.mended.is_empty() && report.added.is_empty());
    html! {
        @if !incidents.is_empty() {
            section { h2 { "What went wrong with the renderer" } ul.bad { @for incident in incidents { li { (incident) } } } }
        }
        @if !lines.is_empty() || has_baseline {
            section #compared {
                h2 { "Compared with what is known" }
                @if !report.regressions.is_empty() {
                    h3 { "Worse than in the baseline" }
                    ul.bad { @for line in compared(report, &report.regressions) { li { (line) } } }
                }
                @if lines.iter().any(|(title, _)| title != BASELINE) {
                    h3 { "Not as expected" }
                    ul.bad { @for (title, what) in lines.iter().filter(|(title, _)| title != BASELINE) { li { b { (title) } ": " (what) } } }
                }
                @if !report.mended.is_empty() {
                    h3 { "Better than the baseline" }
                    ul.good { @for line in compared(report, &report.mended) { li { (line) } } }
                }
                @if !report.added.is_empty() {
                    h3 { "Not in the baseline" }
                    ul { @for line in compared(report, &report.added) { li { (line) } } }
                }
            }
        }
    }
}

/// A page with a matrix of formulas by the subjects of several results, each with the name that tells it from the others.
#[must_use]
pub fn of_matrix(reports: &[(&str, &Report)]) -> String {
    let columns = matrix::columns(reports);
    let facts = Facts::of_matrix(reports);
    let body = html! { (overview::head(&facts)) (all(&columns, false)) };
    page(&facts.title, PageKind::Report, &body)
}

/// Why a result does not pass, as its exit code has it, in sentences; `None` where it passes.
pub(crate) fn why_not(report: &Report) -> Option<String> {
    let verdict = Verdict::new(report);
    (!verdict.is_success).then(|| verdict.sentences.join(" "))
}

/// The same matrix in Markdown: a row for each formula that does not simply pass everywhere, and the counts of the others.
///
/// # Errors
/// Where the writer fails.
pub fn matrix_markdown(reports: &[(&str, &Report)], out: &mut impl fmt::Write) -> fmt::Result {
    matrix::write_markdown(&matrix::columns(reports), out)
}

/// The page of sweeps.
///
/// # Errors
/// Where a part of it cannot be written.
pub fn of_sweeps(sweeps: &[Swept]) -> Result<String, fmt::Error> {
    let mut text = String::new();
    sweep::body(sweeps, &mut text)?;
    let is_success = sweeps.iter().all(|swept| swept.document.statistics.failed == 0 && swept.document.is_finished());
    let facts = Facts::of_sweeps(sweeps, is_success);
    let body = html! {
        (overview::head(&facts))
        @for swept in sweeps { (plot::errors(&swept.document)) }
        section { (markdown(&text, &|_| None)) }
    };
    Ok(page(&facts.title, PageKind::Report, &body))
}

/// The page of a bench, with its pictures.
///
/// # Errors
/// Where a part of it cannot be drawn or written.
pub fn of_bench(document: &BenchDocument) -> Result<String, Box<dyn std::error::Error + Send + Sync>> {
    let pictures = bench_plot::pictures(document)?;
    let mut text = String::new();
    bench_page::body(document, &pictures, "", &mut text)?;
    let picture = |name: &str| {
        let found = pictures.iter().find(|picture| name.strip_suffix(".svg") == Some(&picture.stem()))?;
        Some(embedded("image/svg+xml", found.svg.as_bytes()))
    };
    let facts = Facts::of_bench(document);
    let body = html! { (overview::head(&facts)) section { (markdown(&text, &picture)) } };
    Ok(page(&facts.title, PageKind::Report, &body))
}

/// The page of a self-test.
///
/// # Errors
/// Where it cannot be written.
pub fn of_selftest(run: &SelftestRun) -> Result<String, fmt::Error> {
    let mut text = String::new();
    selftest::body(run, &mut text)?;
    let facts = Facts::of_selftest(run);
    let body = html! { (overview::head(&facts)) section { (markdown(&text, &|_| None)) } };
    Ok(page(&facts.title, PageKind::Report, &body))
}
