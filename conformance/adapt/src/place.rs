//! Where in a shader's text a step of a formula is likely to stand.

use lightmeter_shaders::read::ShaderSource;
use naga::{Block, Function, Handle, Module, Span, Statement};

/// What a line that computes a step has: any of these, each of whose words it has all of, and none of those behind a `!`.
type Signs = &'static [&'static [&'static str]];

/// The steps of formulas, with what a line has that computes one.
const STEPS: &[(&[&str], Signs)] = &[
    (&["h", "n·h"], &[&["half"], &["Half"], &["normalize(", "+"], &[" h ="], &[" H ="]]),
    (&["r", "r·v", "i·n"], &[&["reflect("]]),
    (&["n"], &[&["normalize(", "ormal"], &[" n ="], &[" N ="], &["norm ="]]),
    (&["l"], &[&["normalize(", "ight"], &[" l ="], &[" L ="]]),
    (&["v"], &[&["normalize(", "iew"], &["normalize(", "ye"], &["normalize(", "osition"], &[" v ="], &[" V ="]]),
    (&["FS", "CS"], &[&["pow("]]),
    (
        &["FI", "l·n", "CD"],
        &[
            &["iff", "dot(", "!pow("],
            &["max(", "dot(", "!pow(", "!pec", "!eflect", "!alf"],
            &["abs(", "dot(", "!pow(", "!pec", "!eflect", "!alf"],
            &["dot(", "!pow(", "!pec", "!eflect", "!alf"],
        ],
    ),
    (&["CA"], &[&["mbient"]]),
    (&["atten", "kc + kl·d + kq·d²", "d"], &[&["ttenuation"], &["atten"], &["/", "uadratic"], &["falloff"]]),
    (&["spot", "cone", "−l·axis"], &[&["utoff"], &["utOff"], &["spot"], &["cone"]]),
    (&["exp", "−density·distance"], &[&["exp("], &["exp2("]]),
    (&["f"], &[&["exp("], &["exp2("], &["smoothstep("], &["clamp("], &["factor"], &["Factor"]]),
    (&["clamp"], &[&["clamp("]]),
    (&["distance"], &[&["length("], &["distance("], &["abs("], &[".z"], &["dist"]]),
    (&["color"], &[&["mix("]]),
];

/// The line of a text that computes a step, from 1, with its words; `None` where none or several do.
#[must_use]
pub fn line_of_step<'a>(text: &'a str, step: &str) -> Option<(usize, &'a str)> {
    let (_, signs) = STEPS.iter().find(|(names, _)| names.contains(&step))?;
    // A weaker sign says nothing where several lines have a stronger one.
    let fits = |line: &str, word: &str| match word.strip_prefix('!') {
        Some(none) => !line.contains(none),
        None => line.contains(word),
    };
    let mut found = signs.iter().map(|words| lines(text, |line| words.iter().all(|word| fits(line, word))));
    one(&found.find(|found| !found.is_empty())?)
}

/// The line of a text that has one of these variables.
#[must_use]
pub fn line_of_variable<'a>(text: &'a str, names: &[&str]) -> Option<(usize, &'a str)> {
    let last =
        |name: &&str| name.rsplit('.').next().unwrap_or_default().split('[').next().unwrap_or_default().to_owned();
    let names: Vec<String> = names.iter().map(last).collect();
    let has = |line: &str| {
        line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| names.iter().any(|name| name == word))
    };
    one(&lines(text, has))
}

/// A shader's text without the lines of functions that what is judged does not call; lines keep their numbers.
pub(crate) fn judged_text(module: &Module, entry: Handle<Function>, source: &ShaderSource) -> String {
    let (read, before) = &source.read;
    let line = |span: Span| (span.location(read).line_number as usize).saturating_sub(*before);
    let lines_of = |handle: Handle<Function>| {
        let function = &module.functions[handle];
        let of_body = function.body.span_iter().map(|(_, span)| *span);
        let spans = of_body.chain(function.expressions.iter().map(|(one, _)| function.expressions.get_span(one)));
        let lines = spans.filter(|span| !read.is_empty() && *span != Span::UNDEFINED).flat_map(|span| {
            let end = span.to_range().map_or(0, |range| range.end.saturating_sub(1));
            [
                line(span),
                line(Span::new(u32::try_from(end).unwrap_or_default(), u32::try_from(end).unwrap_or_default())),
            ]
        });
        lines.fold(None, |all: Option<(usize, usize)>, line| {
            Some(all.map_or((line, line), |(first, last)| (first.min(line), last.max(line))))
        })
    };
    let called = called_from(module, entry);
    let other: Vec<(usize, usize)> = module
        .functions
        .iter()
        .filter(|(handle, _)| !called.contains(handle))
        .filter_map(|(one, _)| lines_of(one))
        .collect();
    let is_other = |line: usize| other.iter().any(|(first, last)| (*first..=*last).contains(&line));
    let kept = source.text.lines().enumerate().map(|(k, text)| if is_other(k + 1) { "" } else { text });
    kept.collect::<Vec<_>>().join("\n")
}

/// A function and all that it calls.
fn called_from(module: &Module, entry: Handle<Function>) -> Vec<Handle<Function>> {
    fn calls(block: &Block, into: &mut Vec<Handle<Function>>) {
        for statement in block {
            match statement {
                Statement::Call { function, .. } => into.push(*function),
                Statement::Block(block) => calls(block, into),
                Statement::If { accept, reject, .. } => {
                    [accept, reject].map(|block| calls(block, into)).into_iter().collect()
                }
                Statement::Switch { cases, .. } => cases.iter().for_each(|case| calls(&case.body, into)),
                Statement::Loop { body, continuing, .. } => {
                    [body, continuing].map(|block| calls(block, into)).into_iter().collect()
                }
                _ => {}
            }
        }
    }
    let (mut found, mut next) = (vec![], vec![entry]);
    while let Some(function) = next.pop() {
        if !found.contains(&function) {
            found.push(function);
            calls(&module.functions[function].body, &mut next);
        }
    }
    found
}

/// The one of several; `None` of none and of more.
fn one<T: Copy>(found: &[T]) -> Option<T> {
    match found {
        [one] => Some(*one),
        _ => None,
    }
}

/// The lines that are code and are chosen.
fn lines(text: &str, is_chosen: impl Fn(&str) -> bool) -> Vec<(usize, &str)> {
    let is_code = |line: &str| line.contains('=') || line.contains("return ");
    let code = |line: &'_ str| line.split("//").next().unwrap_or_default().trim_end().len();
    let found = text.lines().enumerate().filter_map(|(k, line)| {
        let line = line[..code(line)].trim();
        (is_code(line) && is_chosen(line)).then_some((k + 1, line))
    });
    found.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_of_a_step_is_found_where_there_is_one() {
        let text = "uniform vec3 fogColor; // exp(\nvoid main() {\n    vec3 h = (l + v) * 0.5;\n    float f = exp(-d);\n    c = mix(fogColor, x, f);\n    a = dot(n, l) + dot(n, h);\n    b = dot(n, l);\n}\n";
        assert_eq!(line_of_step(text, "h"), Some((3, "vec3 h = (l + v) * 0.5;")));
        assert_eq!(line_of_step(text, "exp").map(|(line, _)| line), Some(4));
        assert_eq!(line_of_step(text, "l·n"), None);
        assert_eq!(line_of_variable(text, &["fogColor"]).map(|(line, _)| line), Some(5));
        // A highlight's cosine is none of the diffuse term, whichever is limited.
        let text = "float share = dot(norm, toLight);\nfloat glint = max(dot(view, reflected), 0.0);\n";
        assert_eq!(line_of_step(text, "FI").map(|(line, _)| line), Some(1));
        // Two lines reflect, so that neither is it, whatever else they have.
        let text = "a = reflect(i, n);\nb = reflect(j, n);\nvec3 h = x;\n";
        assert_eq!(line_of_step(text, "r"), None);
        // A half vector by name is a stronger sign than a letter, and two of them decide nothing.
        let text = "vec3 halfway = a;\nvec3 half2 = b;\nvec3 h = c;\n";
        assert_eq!(line_of_step(text, "h"), None);
    }

    #[test]
    fn lines_of_what_is_not_called_are_left_out() {
        let path = std::env::temp_dir().join(format!("lightmeter-judged-{}.wgsl", std::process::id()));
        let text = "fn other(l: vec3f, v: vec3f) -> vec3f {\n    return normalize(l + v);\n}\nfn own(l: vec3f, v: vec3f) -> vec3f {\n    let h = (l + v) * 0.5;\n    return h;\n}\nfn shade(l: vec3f, v: vec3f) -> vec3f {\n    return own(l, v);\n}\n";
        std::fs::write(&path, text).expect("it can be written");
        let source = ShaderSource::read(&path).unwrap_or_else(|error| panic!("{error}"));
        std::fs::remove_file(&path).expect("it is there");
        let entry = source.module.functions.iter().find(|(_, one)| one.name.as_deref() == Some("shade"));
        let judged = judged_text(&source.module, entry.expect("it is there").0, &source);
        assert!(!judged.contains("normalize") && judged.contains("* 0.5") && judged.contains("own(l, v)"), "{judged}");
        // In the whole text another function's line is taken for it.
        assert_eq!(line_of_step(text, "h").map(|(line, _)| line), Some(2));
        assert_eq!(line_of_step(&judged, "h"), Some((5, "let h = (l + v) * 0.5;")));
    }
}
