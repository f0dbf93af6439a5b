//! Chapters and pages that are written as Markdown: read from the folder of documentation, their links turned to the book's own.

use crate::BookError;
use crate::contents::Place;
use crate::figure::{FIGURE, with_figures};
use lightmeter_files::read;
use lightmeter_report::html::own_markdown;
use maud::{Markup, PreEscaped};
use std::collections::BTreeSet;
use std::path::Path;

/// Pages of the documentation that the book takes in, and where they stand in it.
pub(crate) const PAGES: &[(&str, &str)] = &[
    ("guide.md", "reference/guide.html"),
    ("../examples/engine/README.md", "rust-engine.html"),
    ("gate.md", "reference/gate.html"),
    ("protocol.md", "reference/protocol.html"),
    ("shaders.md", "reference/shaders.html"),
    ("design.md", "reference/design.html"),
    ("renderers.md", "renderers.html"),
    ("rulings.md", "rulings.html"),
    ("stability.md", "reference/stability.html"),
    ("sweep.md", "reference/sweep.html"),
    ("bench.md", "appendix/bench.html"),
    ("scenes.md", "appendix/scenes.html"),
    ("blend.md", "appendix/blend.html"),
    ("special-values.md", "appendix/special-values.html"),
    ("selftest.md", "appendix/selftest.html"),
    ("certificate.md", "appendix/certificate.html"),
];

/// A text of the documentation.
pub(crate) struct Text {
    /// Its first heading.
    pub(crate) title: String,
    text: String,
    /// The folder that pictures are in, within the documentation.
    folder: &'static str,
}

impl Text {
    /// Reads a text of the documentation.
    pub(crate) fn read(docs: &Path, name: &str) -> Result<Self, BookError> {
        let path = docs.join(name);
        let failed = |message: String| BookError::Read { path: path.clone(), message };
        let text = read::text(&path, read::MOST_TEXT).map_err(|error| failed(error.to_string()))?;
        let heading = text.lines().find_map(|line| line.strip_prefix("# "));
        let title = heading
            .ok_or_else(|| failed("it has no heading; expected a line such as `# Title`".into()))?
            .replace('`', "");
        Ok(Self { title, text, folder: if name.contains('/') { "book" } else { "" } })
    }

    /// The text at its place in the book. `pictures` collects the files of the documentation that it shows.
    pub(crate) fn body(&self, place: &Place<'_>, pictures: &mut BTreeSet<String>) -> Markup {
        let mut shown = BTreeSet::new();
        let is_own = |name: &str| name.contains("://") || name.starts_with(FIGURE);
        let picture = |name: &str| (!is_own(name)).then(|| place.to(&format!("pictures/{}", flat(name))));
        for name in images(&self.text) {
            shown.insert(if self.folder.is_empty() { name } else { format!("{}/{name}", self.folder) });
        }
        pictures.extend(shown);
        let html = own_markdown(&self.text, &picture);
        PreEscaped(folded(&links(&with_figures(&html.0), place)))
    }
}

/// From this many characters on, the sections of a text are folded: nobody scrolls through more.
const LONG: usize = 150_000;

/// A long text with the sections below its headings of the third order folded, each under its heading.
fn folded(html: &str) -> String {
    if html.len() < LONG {
        return html.to_owned();
    }
    let (mut out, mut rest) = (String::new(), html);
    while let Some(at) = rest.find("<h3 ") {
        let (before, section) = rest.split_at(at);
        let Some(heading) = section.find("</h3>").map(|end| end + "</h3>".len()) else { break };
        let ends = ["<h2 ", "<h3 "].into_iter().filter_map(|next| section[heading..].find(next)).min();
        let end = ends.map_or(section.len(), |next| heading + next);
        out += before;
        out += &format!(
            "<details class=\"section\"><summary>{}</summary>{}</details>",
            &section[..heading],
            &section[heading..end]
        );
        rest = &section[end..];
    }
    out + rest
}

/// The name of a picture in the book's one folder of pictures.
pub(crate) fn flat(name: &str) -> String {
    name.trim_start_matches("../").replace('/', "-")
}

/// The pictures that a text shows, by their addresses.
fn images(text: &str) -> impl Iterator<Item = String> {
    text.split("![").skip(1).filter_map(|rest| {
        let address = rest.split_once("](")?.1.split_once(')')?.0;
        (!address.contains("://") && !address.starts_with(FIGURE)).then(|| address.to_owned())
    })
}

/// Links of a text as the book has them: `.md` pages are its own, and what the book does not have is no link.
fn links(html: &str, place: &Place<'_>) -> String {
    let mut text = String::new();
    let mut rest = html;
    while let Some((before, after)) = rest.split_once("<a href=\"") {
        text += before;
        let Some((address, after)) = after.split_once('"') else { break };
        match of_book(address) {
            Some(address) if address.starts_with('#') || address.contains("://") => {
                text += &format!("<a href=\"{address}\"")
            }
            Some(address) => text += &format!("<a href=\"{}\"", place.to(&address)),
            None => text += "<a",
        }
        rest = after;
    }
    text + rest
}

/// An address as the book has it; `None` where it leads out of the book.
fn of_book(address: &str) -> Option<String> {
    if address.starts_with('#') || address.contains("://") {
        return Some(address.to_owned());
    }
    let (path, fragment) =
        address.split_once('#').map_or((address, String::new()), |(path, at)| (path, format!("#{at}")));
    let name = path.trim_start_matches("../").trim_start_matches("docs/").trim_start_matches("book/");
    if let Some((_, page)) = PAGES.iter().find(|(own, _)| own.trim_start_matches("../") == name) {
        return Some(format!("{page}{fragment}"));
    }
    if let Some(schema) = name.strip_prefix("schemas/").and_then(|name| name.strip_suffix(".json")) {
        return Some(format!("reference/schema/{schema}.html"));
    }
    let chapter = name.strip_suffix(".md")?;
    let page = match chapter {
        // The first chapter is the way in.
        "what-it-tells-you" => "index".to_owned(),
        "README" | "CONTRIBUTING" | "ARCHITECTURE" | "CHANGELOG" => return None,
        other => other.to_owned(),
    };
    Some(format!("{page}.html{fragment}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contents::Place;

    #[test]
    fn links_lead_within_the_book_or_are_none() {
        assert_eq!(of_book("gate.md#files").as_deref(), Some("reference/gate.html#files"));
        assert_eq!(of_book("formula/fog/exp.md").as_deref(), Some("formula/fog/exp.html"));
        assert_eq!(of_book("schemas/frame.json").as_deref(), Some("reference/schema/frame.html"));
        assert_eq!(of_book("../README.md"), None);
        assert_eq!(of_book("../../docs/book/in-ci.md#x").as_deref(), Some("in-ci.html#x"));
        assert_eq!(of_book("../../examples/engine/README.md").as_deref(), Some("rust-engine.html"));
        let html = links(
            r##"<p><a href="gate.md">g</a> <a href="../README.md">r</a> <a href="#x">x</a></p>"##,
            &Place::new("formula/a.html"),
        );
        assert_eq!(html, r##"<p><a href="../reference/gate.html">g</a> <a>r</a> <a href="#x">x</a></p>"##);
    }

    #[test]
    fn pictures_are_found() {
        assert_eq!(images("a ![x](bench/a.svg) b ![y](https://z)").collect::<Vec<_>>(), ["bench/a.svg"]);
        assert_eq!(flat("bench/a.svg"), "bench-a.svg");
    }

    #[test]
    fn the_sections_of_a_long_text_are_folded_and_nothing_is_lost() {
        let rows = "<p>a row</p>".repeat(LONG / 20);
        let text = format!(
            "<h2 id=\"a\">A</h2><p>before</p><h3 id=\"b\">B</h3>{rows}<h3 id=\"c\">C</h3>{rows}<h2 id=\"d\">D</h2>after"
        );
        let html = folded(&text);
        assert_eq!(html.matches("<details").count(), 2, "{html:.300}");
        assert!(
            html.contains("<summary><h3 id=\"b\">B</h3></summary><p>a row")
                && html.ends_with("</details><h2 id=\"d\">D</h2>after")
        );
        let bare = ["<details class=\"section\">", "</details>", "<summary>", "</summary>"]
            .iter()
            .fold(html, |html, tag| html.replace(tag, ""));
        assert_eq!(bare, text);
        assert_eq!(folded("<h3 id=\"b\">B</h3>short"), "<h3 id=\"b\">B</h3>short");
    }
}
