//! The catalogue of mistakes as text.

use lightmeter_document::mistakes::{KnownMistake, MistakeLook, MistakeOf, MistakesDocument};
use std::fmt::Write as _;

/// Formulas that are named in a list.
const MOST_NAMED: usize = 4;

/// Every mistake with what it does, where it was seen and what it concerns; in detail also how it looks in each formula.
#[must_use]
pub fn text(document: &MistakesDocument, in_detail: bool) -> String {
    let mut text = String::new();
    for mistake in &document.mistakes {
        push(&mut text, &format!("{}\n  {}", mistake.name, mistake.says));
        if let Some(seen_in) = &mistake.seen_in {
            push(&mut text, &format!("  seen in: {seen_in}"));
        }
        push(&mut text, &format!("  {}", concerned(mistake)));
        if in_detail {
            mistake.looks.iter().for_each(|look| push(&mut text, &looks(look)));
            push(&mut text, "");
        }
    }
    let scenes = document.mistakes.iter().filter(|mistake| mistake.of == MistakeOf::Scenes).count();
    let formulas = document.mistakes.len() - scenes;
    let noun = if formulas == 1 { "mistake" } else { "mistakes" };
    push(&mut text, &format!("{formulas} {noun} in formulas, {scenes} in scenes"));
    text
}

fn push(text: &mut String, line: &str) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "{line}");
}

fn concerned(mistake: &KnownMistake) -> String {
    let all = &mistake.formulas;
    let of = match mistake.of {
        MistakeOf::Scenes if all.is_empty() => return "concerns: scenes".into(),
        MistakeOf::Scenes => "shows in",
        MistakeOf::Formulas => "concerns",
    };
    let named = all.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
    match all.len().saturating_sub(MOST_NAMED) {
        0 => format!("{of}: {named}"),
        more => format!("{of}: {named} and {more} more"),
    }
}

/// In how many cases it shows, and on which side.
fn looks(look: &MistakeLook) -> String {
    let MistakeLook { formula, cases, failing, too_great, too_small, outputs } = look;
    let side = match (too_great, too_small) {
        (0, 0) => "no wrong number is finite".to_owned(),
        (_, 0) => "each wrong number is too great".to_owned(),
        (0, _) => "each wrong number is too small".to_owned(),
        (great, small) => format!("of the wrong numbers {great} are too great and {small} too small"),
    };
    let outputs: Vec<&str> = outputs.iter().map(AsRef::as_ref).collect();
    let what = if formula.starts_with("scene/") { "pixels" } else { "cases" };
    format!("  {formula}: {failing} of {cases} {what} fail, in {}; {side}", outputs.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mistake_is_told_with_what_it_concerns() {
        let mistake = KnownMistake {
            name: "fog-radial".into(),
            says: "fog uses radial distance".into(),
            of: MistakeOf::Formulas,
            seen_in: Some("Unity".into()),
            formulas: (1..7).map(|k| format!("fog/{k}")).collect(),
            looks: vec![MistakeLook {
                formula: "fog/1".into(),
                cases: 256,
                failing: 200,
                too_great: 0,
                too_small: 600,
                outputs: vec!["f".into(), "color".into()],
            }],
        };
        let document = MistakesDocument { schema: "lightmeter.mistakes/1".into(), mistakes: vec![mistake] };
        assert_eq!(
            text(&document, true),
            "fog-radial\n  fog uses radial distance\n  seen in: Unity\n  concerns: fog/1, fog/2, fog/3, fog/4 and 2 more\n  \
             fog/1: 200 of 256 cases fail, in f, color; each wrong number is too small\n\n1 mistake in formulas, 0 in scenes\n"
        );
    }
}
