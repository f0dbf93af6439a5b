//! Dialects and mistakes that are accepted by name: in a comment of the shader, or by whoever asks for the review.
//!
//! `// lightmeter: accept NAME` stands behind a step, or alone on the line above it; a comment above the first line of code holds for the whole
//! file. Several names are separated by commas; a reason may follow after a colon.

use crate::templates::{self, Worth};
use lightmeter_document::report::{RefusedName, ShaderReview, StepVerdict};

/// What a comment begins with.
const WORDS: &str = "lightmeter: accept ";

/// Names that the review gives to what no form alone shows.
const OF_REVIEW: [&str; 26] = [
    "ambient-attenuated",
    "ambient-in-the-cone",
    "ambient-multiplies-diffuse",
    "attenuated-twice",
    "axis-not-normalised",
    "by-a-branch",
    "diffuse-not-attenuated",
    "diffuse-without-light-color",
    "eye-not-normalised",
    "fog-after-gamma",
    "fog-mixed-the-wrong-way",
    "half-vector-not-normalised",
    "highlight-times-lambert",
    "highlight-without-light-color",
    "light-not-normalised",
    "light-reversed",
    "multiplied-for-divided",
    "normal-not-normalised",
    "not-clamped",
    "not-initialised",
    "ramp",
    "specular-not-attenuated",
    "spot-backwards",
    "view-reversed",
    "viewer-at-infinity",
    "window-depth",
];

/// The names of all dialects and mistakes that a step may have, in alphabetical order.
#[must_use]
pub fn names() -> Vec<String> {
    let heads = templates::all().map(|(_, heads)| heads).unwrap_or_default();
    let of_forms = heads.into_iter().filter(|(_, head)| head.worth != Worth::Right && !head.name.is_empty());
    let mut names: Vec<String> = of_forms.map(|(_, head)| head.name).chain(OF_REVIEW.map(String::from)).collect();
    names.sort();
    names.dedup();
    names
}

/// A comment that accepts a name.
#[derive(Debug, PartialEq, Eq)]
struct Comment<'a> {
    name: &'a str,
    /// Where it stands, from 1.
    line: u32,
    /// The line that it is for; none where it is for the whole file.
    at: Option<u32>,
}

/// The comments of a text, whose lines end as they may.
fn comments(text: &str) -> Vec<Comment<'_>> {
    let lines: Vec<&str> = text.split('\n').flat_map(|line| line.trim_end_matches('\r').split('\r')).collect();
    let mut in_comment = false;
    let is_code: Vec<bool> = lines.iter().map(|line| has_code(line, &mut in_comment)).collect();
    let first = is_code.iter().position(|is_code| *is_code).unwrap_or(lines.len());
    let mut found = vec![];
    for (k, line) in lines.iter().enumerate() {
        let (Some(start), true) = (line.find(WORDS), line.contains("//") || line.contains("/*")) else { continue };
        let rest = &line[start + WORDS.len()..];
        let end = rest.find([':', '*']).unwrap_or(rest.len());
        let for_line = if is_code[k] { Some(k) } else { (k..lines.len()).find(|own| is_code[*own]) };
        let at = for_line.filter(|_| k >= first).and_then(|own| u32::try_from(own + 1).ok());
        let line = u32::try_from(k + 1).unwrap_or(u32::MAX);
        let names = rest[..end].split(',').map(str::trim).filter(|name| !name.is_empty());
        found.extend(names.map(|name| Comment { name, line, at }));
    }
    found
}

/// Whether a line has more than comments and the version.
fn has_code(line: &str, in_comment: &mut bool) -> bool {
    let mut rest = line.trim();
    loop {
        if *in_comment {
            let Some((_, after)) = rest.split_once("*/") else { return false };
            (*in_comment, rest) = (false, after.trim_start());
        } else if let Some(after) = rest.strip_prefix("/*") {
            (*in_comment, rest) = (true, after);
        } else {
            return !(rest.is_empty() || rest.starts_with("//") || rest.starts_with("#version"));
        }
    }
}

/// Marks the steps of a file that its comments or the given names accept, and notes the comments that accept nothing.
/// For a name that does not exist, `near` says which one may be meant.
pub fn accept(review: &mut ShaderReview, text: &str, given: &[String], near: &dyn Fn(&str) -> String) {
    let known = names();
    for step in review.steps.iter_mut().filter(|step| step.verdict != StepVerdict::Right) {
        step.accepted = given.contains(&step.name);
    }
    for comment in comments(text) {
        let Comment { name, line, at } = comment;
        if !known.iter().any(|own| own == name) {
            let says = format!("no dialect and no mistake is called `{name}`{}", near(name));
            review.refused.push(RefusedName { line, says });
            continue;
        }
        let is_meant = |own: u32| at.is_none_or(|at| at == own);
        let mut is_found = false;
        for step in review.steps.iter_mut().filter(|step| step.verdict != StepVerdict::Right && step.name == name) {
            if is_meant(step.line) || step.also.iter().any(|own| is_meant(*own)) {
                (step.accepted, is_found) = (true, true);
            }
        }
        if !is_found {
            review.notes.push(format!(
                "line {line}: this comment accepts `{name}`, which is not found here: take the comment out"
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_is_for_its_line_the_next_line_of_code_or_the_file() {
        let text = "#version 330\n/* Ours.\n lightmeter: no. */\n// lightmeter: accept ramp\nuniform vec3 n;\r\nvoid main() {\n  // lightmeter: accept not-clamped, by-a-branch: as the paper has it\n\n  float x = 1.0; // lightmeter: accept window-depth\n}\n";
        let found: Vec<_> = comments(text).iter().map(|own| (own.name, own.line, own.at)).collect();
        let wanted =
            [("ramp", 4, None), ("not-clamped", 7, Some(9)), ("by-a-branch", 7, Some(9)), ("window-depth", 9, Some(9))];
        assert_eq!(found, wanted);
        assert_eq!(comments("a\rb // lightmeter: accept ramp\rc")[0].at, Some(2));
    }

    /// A name that the review says and that is not in the list could not be accepted.
    #[test]
    fn the_names_of_the_review_are_those_in_its_code() {
        const CODE: [&str; 2] = [include_str!("review/claim.rs"), include_str!("review/sum.rs")];
        const KINDS: [&str; 4] = ["decode-normal", "fog-distance", "fog-mix", "normal-transform"];
        let is_name = |own: &&str| own.contains('-') && own.chars().all(|c| c.is_ascii_lowercase() || c == '-');
        let said: Vec<&str> = CODE.iter().flat_map(|code| code.split('"').filter(is_name)).collect();
        let names = names();
        for name in &said {
            assert!(KINDS.contains(name) || names.iter().any(|own| own == name), "`{name}` cannot be accepted");
        }
        for name in OF_REVIEW {
            assert!(CODE.iter().any(|code| code.contains(&format!("\"{name}\""))), "nothing says `{name}`");
        }
    }

    #[test]
    fn names_are_in_order_and_each_once() {
        let names = names();
        assert!(names.is_sorted() && names.len() > OF_REVIEW.len());
        assert!(OF_REVIEW.is_sorted());
    }
}
