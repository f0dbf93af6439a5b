//! The frame of a page: its policy, style and script.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest as _, Sha256};

const STYLE: &str = include_str!("style.css");
const REPORT_SCRIPT: &str = include_str!("report.js");
const SEARCH_SCRIPT: &str = include_str!("search.js");

/// What a page is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PageKind {
    /// A report, which can be filtered.
    Report,
    /// A page of the book, which runs nothing.
    Book,
    /// The book's page that finds others.
    Search,
}

/// Words as they stand in documents: what stands between backticks is code.
#[must_use]
pub fn prose(words: &str) -> Markup {
    html! {
        @for (k, part) in words.split('`').enumerate() { @if k % 2 == 1 { code { (part) } } @else { (part) } }
    }
}

/// A picture as an address of its own.
#[must_use]
pub fn embedded(mime: &str, bytes: &[u8]) -> String {
    format!("data:{mime};base64,{}", STANDARD.encode(bytes))
}

/// A whole page, which needs nothing else.
#[must_use]
pub fn page(title: &str, kind: PageKind, body: &Markup) -> String {
    let hash = |text: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)));
    let script = match kind {
        PageKind::Report => Some(REPORT_SCRIPT),
        PageKind::Search => Some(SEARCH_SCRIPT),
        PageKind::Book => None,
    };
    let scripts = script.map_or_else(|| "'none'".into(), hash);
    let images = if kind == PageKind::Report { "data:" } else { "'self' data:" };
    let policy = format!(
        "default-src 'none'; img-src {images}; style-src {}; script-src {scripts}; base-uri 'none'; form-action 'none'",
        hash(STYLE)
    );
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                @if kind == PageKind::Report { main { (body) } } @else { (body) }
                @if let Some(script) = script { script { (PreEscaped(script)) } }
            }
        }
    };
    page.into_string()
}
