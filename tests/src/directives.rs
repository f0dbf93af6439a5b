//! Wrong texts for the lines by which scenes' shaders are composed: each way of a `choose`, what stands under a `when` or an `if`, and what
//! an effect puts into a slot. A condition that is met where it need not be only composes what no pixel depends on.

use std::collections::BTreeMap;

/// A file of shaders with one directing line, or what it leads to, wrong.
#[derive(Clone, Debug)]
pub struct Misdirection {
    /// Which way of which line is wrong.
    pub what: String,
    /// The file's name.
    pub file: String,
    /// Its wrong text.
    pub text: String,
}

/// Every misdirection of these files.
#[must_use]
pub fn misdirections<'a>(files: impl Iterator<Item = (&'a str, &'a str)>) -> Vec<Misdirection> {
    let files: Vec<(&str, Vec<&str>)> = files.map(|(name, text)| (name, text.lines().collect())).collect();
    // The type of what is chosen from a slot.
    let chosen: BTreeMap<&str, &str> =
        files.iter().flat_map(|(_, lines)| lines).filter_map(|line| Choice::of(line)).map(|c| (c.slot, c.ty)).collect();
    let mut all = vec![];
    for (file, lines) in &files {
        for (place, line) in lines.iter().enumerate() {
            let mut wrong = |what: String, changed: &dyn Fn(usize, &str) -> String| {
                let text = lines.iter().enumerate().map(|(k, line)| changed(k, line) + "\n").collect();
                all.push(Misdirection { what: format!("{file}:{}: {what}", place + 1), file: (*file).into(), text });
            };
            let instead =
                |other: String| move |k: usize, line: &str| if k == place { other.clone() } else { line.into() };
            let directive = line.trim_start().strip_prefix("//@ ").unwrap_or_default();
            if let Some(choice) = Choice::of(line) {
                let head = &line[..line.len() - choice.otherwise.len()];
                let other = format!("{head}{}", other_value(choice.ty, choice.otherwise));
                wrong(format!("{directive}, the last"), &instead(other));
            }
            for word in ["when", "if"] {
                if let Some(condition) = directive.strip_prefix(word).and_then(|rest| rest.strip_prefix(' ')) {
                    wrong(
                        format!("{directive}, left out"),
                        &instead(format!("//@ {word} ({condition}) & !({condition})")),
                    );
                }
            }
            if let Some(slot) = directive.strip_prefix("at ") {
                let part = lines[place + 1..].iter().take_while(|line| !line.starts_with("//@ at "));
                let of = place + 1..place + 1 + part.count();
                let is_text = |line: &str| !line.trim().is_empty() && !line.trim_start().starts_with("//");
                match chosen.get(slot) {
                    Some(ty) => wrong(format!("{directive}, chosen"), &|k, line| {
                        let is_value = of.contains(&k) && is_text(line);
                        if is_value { other_value(ty, line) } else { line.into() }
                    }),
                    None => wrong(format!("{directive}, left out"), &|k, line| {
                        let is_put = of.contains(&k) && is_text(line);
                        if is_put { String::new() } else { line.into() }
                    }),
                }
            }
        }
    }
    all
}

/// `//@ choose name: type from slot else expression`.
struct Choice<'a> {
    ty: &'a str,
    slot: &'a str,
    otherwise: &'a str,
}

impl<'a> Choice<'a> {
    fn of(line: &'a str) -> Option<Self> {
        let (_, rest) = line.trim_start().strip_prefix("//@ choose ")?.split_once(": ")?;
        let (ty, rest) = rest.split_once(" from ")?;
        let (slot, otherwise) = rest.split_once(" else ")?;
        Some(Self { ty, slot, otherwise })
    }
}

/// Another value of the same type, whatever the right one is.
fn other_value(ty: &str, expression: &str) -> String {
    let more = if ty == "f32" {
        "0.37".to_owned()
    } else {
        format!("{ty}(0.37, 0.21, 0.45{})", if ty == "vec4f" { ", 0.28" } else { "" })
    };
    format!("({more} + 0.5 * ({}))", expression.trim())
}
