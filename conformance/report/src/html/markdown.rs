//! Markdown as HTML. Markup in it is text, since names of others stand in pages.

use maud::{Markup, PreEscaped};
use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd, html::push_html};

/// A text of the suite's own as HTML: an empty `<a id="name"></a>` is a place that links lead to. Other markup is text.
#[must_use]
pub fn own_markdown(text: &str, picture: &dyn Fn(&str) -> Option<String>) -> Markup {
    converted(text, picture, true)
}

/// A text as HTML. `picture` gives the address of a picture where it is another than the text's; links keep theirs.
#[must_use]
pub fn markdown(text: &str, picture: &dyn Fn(&str) -> Option<String>) -> Markup {
    converted(text, picture, false)
}

/// The opening tag of a place that links lead to.
fn is_place(tag: &str) -> bool {
    let name = tag.strip_prefix("<a id=\"").and_then(|rest| rest.strip_suffix("\">"));
    name.is_some_and(|name| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-'))
}

fn converted(text: &str, picture: &dyn Fn(&str) -> Option<String>, has_places: bool) -> Markup {
    let parser = Parser::new_ext(text, Options::ENABLE_TABLES | Options::ENABLE_HEADING_ATTRIBUTES);
    let (mut events, mut tables) = (vec![], 0);
    let mut heading: Option<(usize, String)> = None;
    for event in parser {
        let ends_place = has_places
            && matches!(&event, Event::InlineHtml(tag) if &**tag == "</a>")
            && matches!(events.last(), Some(Event::InlineHtml(tag)) if is_place(tag));
        let event = match event {
            Event::InlineHtml(tag) if ends_place || has_places && is_place(&tag) => Event::InlineHtml(tag),
            Event::Html(text) | Event::InlineHtml(text) => Event::Text(text),
            Event::Start(Tag::Image { link_type, dest_url, title, id }) => {
                let dest_url = picture(&dest_url).map_or(dest_url, CowStr::from);
                Event::Start(Tag::Image { link_type, dest_url, title, id })
            }
            // A table that is wider than the page scrolls by itself.
            Event::Start(Tag::Table(_)) => {
                tables += 1;
                let region = format!(r#"<div class="wide" tabindex="0" role="group" aria-label="table {tables}">"#);
                events.push(Event::Html(region.into()));
                event
            }
            Event::End(TagEnd::Table) => {
                events.push(event);
                Event::Html("</div>".into())
            }
            Event::Start(Tag::Heading { .. }) => {
                heading = Some((events.len(), String::new()));
                event
            }
            Event::Text(ref text) | Event::Code(ref text) => {
                if let Some((_, words)) = &mut heading {
                    words.push_str(text);
                }
                event
            }
            Event::End(TagEnd::Heading(_)) => {
                if let Some((place, words)) = heading.take()
                    && let Some(Event::Start(Tag::Heading { id, .. })) = events.get_mut(place)
                {
                    *id = Some(anchor(&words).into());
                }
                event
            }
            other => other,
        };
        events.push(event);
    }
    let mut html = String::new();
    push_html(&mut html, events.into_iter());
    // The page's policy permits no style of an element's own. Quotes of a text are escaped, so that this is never one.
    for side in ["left", "center", "right"] {
        html = html.replace(&format!(r#" style="text-align: {side}""#), &format!(r#" class="{side}""#));
    }
    // A heading without words is a cell.
    for empty in ["<th></th>", r#"<th class="left"></th>"#, r#"<th class="right"></th>"#] {
        html = html.replace(empty, "<td></td>");
    }
    html = html.replace("<pre>", r#"<pre tabindex="0">"#);
    PreEscaped(html)
}

/// The name by which links reach a heading, as code hosts make it.
fn anchor(words: &str) -> String {
    let kept = words.to_lowercase().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect::<String>();
    kept.replace(' ', "-")
}

#[cfg(test)]
mod tests {
    use super::{markdown, own_markdown};

    #[test]
    fn places_that_links_lead_to_are_kept_in_texts_of_our_own() {
        let text = "| a |\n|---|\n| <a id=\"ruling-3\"></a>3: b <a href=\"x\">y</a> |\n";
        let own = own_markdown(text, &|_| None).0;
        assert!(own.contains("<a id=\"ruling-3\"></a>3: b") && !own.contains("<a href"), "{own}");
        let other = markdown(text, &|_| None).0;
        assert!(!other.contains("<a id"), "{other}");
    }

    #[test]
    fn markup_is_text_and_headings_can_be_linked() {
        let html = markdown("# A b\n\n<script>alert(1)</script> <b>x</b>\n\n![p](a.svg)\n", &|name| {
            (name == "a.svg").then(|| "data:x".into())
        });
        assert!(html.0.contains(r#"<h1 id="a-b">"#), "{}", html.0);
        assert!(
            html.0.contains("&lt;script&gt;") && !html.0.contains("<script") && !html.0.contains("<b>"),
            "{}",
            html.0
        );
        assert!(html.0.contains(r#"src="data:x""#), "{}", html.0);
    }
}
