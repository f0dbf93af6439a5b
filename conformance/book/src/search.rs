//! The page that finds others by their words. It holds all that it looks in, so that it works from a folder without a server.

use maud::{Markup, PreEscaped, html};
use serde_json::json;
use std::collections::BTreeSet;

/// The characters of a word; what is longer is an address.
const LENGTHS: std::ops::RangeInclusive<usize> = 2..=32;

/// What is known of a page.
pub(crate) struct Found {
    pub(crate) path: String,
    pub(crate) title: String,
    /// Those that can be linked: their names, and what they say.
    headings: Vec<(String, String)>,
    words: BTreeSet<String>,
}

impl Found {
    /// What there is to find on a page.
    pub(crate) fn new(path: &str, title: &str, html: &str) -> Self {
        let mut headings = vec![];
        for part in html.split("<h").skip(1) {
            let Some(rest) = ["2 id=\"", "3 id=\""].iter().find_map(|begin| part.strip_prefix(begin)) else { continue };
            if let Some((id, rest)) = rest.split_once("\">") {
                // Code in a heading has tags of its own, none of which is a heading's.
                let text = rest.split("</h").next().unwrap_or_default();
                headings.push((id.to_owned(), plain(text).split_whitespace().collect::<Vec<_>>().join(" ")));
            }
        }
        let words = plain(html).to_lowercase();
        let words = words.split(|c: char| !(c.is_alphanumeric() || c == '-' || c == '_'));
        // A name is found by its parts, too.
        let words = words.flat_map(|word| word.split(['-', '_']).chain([word]));
        let words =
            words.filter(|word| LENGTHS.contains(&word.chars().count()) && word.chars().any(char::is_alphabetic));
        Self { path: path.to_owned(), title: title.to_owned(), headings, words: words.map(str::to_owned).collect() }
    }
}

/// The text of some HTML.
fn plain(html: &str) -> String {
    let mut text = String::new();
    let mut is_tag = false;
    for c in html.chars() {
        match c {
            '<' => is_tag = true,
            '>' if is_tag => {
                is_tag = false;
                text.push(' ');
            }
            c if !is_tag => text.push(c),
            _ => {}
        }
    }
    [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&amp;", "&")]
        .iter()
        .fold(text, |text, (entity, c)| text.replace(entity, c))
}

/// The page.
pub(crate) fn page(found: &[Found]) -> Markup {
    let pages: Vec<_> = found
        .iter()
        .map(|one| {
            let words: Vec<&str> = one.words.iter().map(String::as_str).collect();
            json!([one.path, one.title, one.headings, words.join(" ")])
        })
        .collect();
    // A script's data ends at the first `</`, whatever it stands in.
    let data = json!(pages).to_string().replace('<', "\\u003c");
    html! {
        h1 { "Search" }
        p { label for="q" { "Words, or the beginnings of words, that a page is to have:" } }
        p { input #q type="search" name="q" autocomplete="off" placeholder="exp2 fog …"; " " output #count role="status" {} }
        ul #found {}
        noscript { p { "The search needs scripts. " a href="formula/index.html" { "All formulas" } ", " a href="mistakes.html" { "mistakes by name" } " and the contents list everything." } }
        script #pages type="application/json" { (PreEscaped(data)) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Found, page, plain};

    #[test]
    fn a_page_is_found_by_its_words_and_its_headings() {
        let found =
            Found::new("a.html", "A", "<h1>A</h1><h2 id=\"why\">Why <code>exp</code></h2><p>Fog &amp; mist</p>");
        assert_eq!(found.headings, [("why".to_owned(), "Why exp".to_owned())]);
        assert!(["fog", "mist", "exp", "why"].iter().all(|word| found.words.contains(*word)), "{:?}", found.words);
        assert_eq!(plain("a &lt;b&gt;<i>c</i>"), "a <b> c ");
        let other = Found::new("b.html", "B", "</script><p>fog");
        let html = page(&[found, other]).0;
        // A word is found wherever it stands, and no page ends the script.
        assert!(html.matches("fog").count() == 3 && html.matches("</script>").count() == 1, "{html}");
    }
}
