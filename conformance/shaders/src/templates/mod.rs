//! The forms of each step: right ones, dialects and mistakes, as WGSL functions.
//!
//! A form's head is `//@ kind worth [name] [weak] [transparent] [falling] [<types>] [(source)]: sentence`. A parameter's name says what it
//! is, and so how it is drawn (`unify::class`). Where types stand, the function is one for each, with `T` for the type.

mod highlight;

use lightmeter_document::report::{StepFunction, StepParameter};

/// What a form is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Worth {
    Right,
    Dialect,
    Mistake,
}

/// What is to be said of a form.
#[derive(Clone, Debug)]
pub(crate) struct Head {
    /// The step that it is a form of.
    pub(crate) kind: String,
    pub(crate) worth: Worth,
    /// The dialect's or the mistake's name; empty if it has none.
    pub(crate) name: String,
    /// Whether it is a claim only with other evidence.
    pub(crate) is_weak: bool,
    /// Whether what it multiplies is looked into.
    pub(crate) is_transparent: bool,
    /// Whether a ramp falls with its variable.
    pub(crate) falls: bool,
    /// Who has it so.
    pub(crate) source: String,
    pub(crate) sentence: String,
}

const FILES: [&str; 5] = [
    include_str!("light.wgsl"),
    include_str!("attenuation.wgsl"),
    include_str!("spot.wgsl"),
    include_str!("fog.wgsl"),
    include_str!("color.wgsl"),
];

/// A head, and the types that its function is for.
fn head(line: &str) -> Result<(Head, Vec<String>), String> {
    let (before, sentence) = line.split_once(": ").ok_or(line)?;
    let taken = |text: &str, open: char, close: char| {
        let inner = text.split_once(open).and_then(|(_, rest)| rest.split_once(close)).map(|(inner, _)| inner);
        let whole = inner.map(|inner| text.replace(&format!("{open}{inner}{close}"), ""));
        (whole.unwrap_or_else(|| text.to_owned()), inner.unwrap_or_default().to_owned())
    };
    let (before, source) = taken(before, '(', ')');
    let (before, types) = taken(&before, '<', '>');
    let mut words = before.split_whitespace();
    let kind = words.next().ok_or(line)?.to_owned();
    let worth = match words.next() {
        Some("right") => Worth::Right,
        Some("dialect") => Worth::Dialect,
        Some("mistake") => Worth::Mistake,
        _ => return Err(line.to_owned()),
    };
    let words: Vec<&str> = words.collect();
    let is = |word: &str| words.contains(&word);
    let name = words.iter().find(|word| !matches!(**word, "weak" | "transparent" | "falling")).copied();
    let own = Head {
        kind,
        worth,
        name: name.unwrap_or_default().to_owned(),
        is_weak: is("weak"),
        is_transparent: is("transparent"),
        falls: is("falling"),
        source,
        sentence: sentence.to_owned(),
    };
    Ok((own, types.split_whitespace().map(str::to_owned).collect()))
}

/// The text of all functions, and each one's name and head, in order.
///
/// # Errors
/// The line that is not as it should be.
pub(crate) fn all() -> Result<(String, Vec<(String, Head)>), String> {
    let mut heads: Vec<(String, Head)> = vec![];
    let mut text = String::new();
    let generated = highlight::all();
    for file in FILES.into_iter().chain([&*generated]) {
        let mut waiting: Option<(Head, Vec<String>)> = None;
        for line in file.lines() {
            if let Some(own) = line.strip_prefix("//@ ") {
                waiting = Some(head(own)?);
            } else if let Some(signature) = line.strip_prefix("fn ") {
                let (head, types) = waiting.take().ok_or(line)?;
                let name = signature.split('(').next().ok_or(line)?;
                let types = if types.is_empty() { vec![String::new()] } else { types };
                for ty in types {
                    let own = if ty.is_empty() { name.to_owned() } else { format!("{name}_{ty}") };
                    let line = line.replacen(name, &own, 1);
                    text += &line
                        .replace("T(", &format!("{ty}("))
                        .replace(": T", &format!(": {ty}"))
                        .replace("-> T", &format!("-> {ty}"));
                    text.push('\n');
                    heads.push((own, head.clone()));
                }
            }
        }
    }
    Ok((text, heads))
}

/// Each form as a function, with what it is worth.
///
/// # Errors
/// The line that is not as it should be.
pub(crate) fn functions() -> Result<Vec<(Worth, StepFunction)>, String> {
    let (text, heads) = all()?;
    let mut found = vec![];
    for (line, (form, head)) in text.lines().filter(|line| line.starts_with("fn ")).zip(heads) {
        let (signature, _) = line.split_once('(').and_then(|(_, rest)| rest.split_once(')')).ok_or(line)?;
        let parameter = |own: &str| {
            let name = own.split(':').next().unwrap_or_default().trim().to_owned();
            StepParameter { name, is_negated: false, bits: vec![] }
        };
        let parameters = signature.split(", ").map(parameter).collect();
        let wgsl = line.replacen(&form, "shader_step", 1);
        found.push((head.worth, StepFunction { form, wgsl, parameters }));
    }
    Ok(found)
}
