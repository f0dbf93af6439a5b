//! The order of the book: its parts and pages, the list of them beside each page, and the frame of a page.

use lightmeter_report::html::{PageKind, page};
use maud::{Markup, html};

/// The page that finds others by their words, which has no place in the order.
pub(crate) const SEARCH: &str = "search.html";

/// A page of the book.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// Its file within the book, with `/` between folders.
    pub(crate) path: String,
    /// Its title.
    pub(crate) title: String,
    /// What pages of the same kind are listed under, where the list has too many of them to show all: the family of a formula.
    pub(crate) family: Option<String>,
}

/// A part of the book.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Its title.
    pub(crate) title: &'static str,
    /// Its pages.
    pub(crate) entries: Vec<Entry>,
}

/// The book's order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contents {
    /// Its parts.
    pub(crate) parts: Vec<Part>,
}

/// Where a page is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<'a> {
    path: &'a str,
}

impl<'a> Place<'a> {
    /// The place of a file within the book.
    pub(crate) const fn new(path: &'a str) -> Self {
        Self { path }
    }

    /// A link to another file of the book.
    pub(crate) fn to(&self, path: &str) -> String {
        "../".repeat(self.path.matches('/').count()) + path
    }
}

impl Contents {
    /// Adds a part.
    pub(crate) fn part(&mut self, title: &'static str, entries: Vec<Entry>) {
        self.parts.push(Part { title, entries });
    }

    fn entries(&self) -> impl Iterator<Item = &Entry> {
        self.parts.iter().flat_map(|part| &part.entries)
    }

    /// The title of a page.
    pub(crate) fn title(&self, path: &str) -> &str {
        if path == SEARCH {
            return "Search";
        }
        self.entries().find(|entry| entry.path == path).map_or("lightmeter", |entry| &entry.title)
    }

    /// A whole page: the list of the book's pages, what the page says, and the ways to the pages beside it.
    pub(crate) fn framed(&self, path: &str, body: &Markup) -> String {
        let entries: Vec<&Entry> = self.entries().collect();
        let at = entries.iter().position(|entry| entry.path == path);
        let title = self.title(path);
        let family = at.and_then(|at| entries[at].family.as_deref());
        let place = Place::new(path);
        let before = at.and_then(|at| at.checked_sub(1)).map(|at| entries[at]);
        let after = at.and_then(|at| entries.get(at + 1)).copied();
        let body = html! {
            div.book {
                nav #contents aria-label="contents" {
                    p { a href=(place.to("index.html")) { b { "lightmeter" } } " · " a href=(place.to(SEARCH)) { "Search" } }
                    details open { summary { "Contents" }
                        @for part in &self.parts {
                            p.part { (part.title) }
                            ul { @for entry in &part.entries { @if entry.family.is_none() || entry.family.as_deref() == family {
                                li class=[entry.family.as_ref().map(|_| "below")] { a href=(place.to(&entry.path)) aria-current=[(entry.path == path).then_some("page")] { (entry.title) } }
                            } } }
                        }
                    }
                }
                main {
                    p.to-contents { a href="#contents" { "Contents" } " · " a href=(place.to(SEARCH)) { "Search" } }
                    (body)
                    div.turn {
                        @match before { Some(entry) => a href=(place.to(&entry.path)) rel="prev" { "← " (entry.title) }, None => span {} }
                        @if let Some(entry) = after { a href=(place.to(&entry.path)) rel="next" { (entry.title) " →" } }
                    }
                }
            }
        };
        let kind = if path == SEARCH { PageKind::Search } else { PageKind::Book };
        page(&format!("{title} · lightmeter"), kind, &body)
    }
}
