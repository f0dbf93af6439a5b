//! A shader's items, functions, structs, bindings and constants, and which of them its entry points reach.

use super::template::Line;
use std::collections::HashMap;

/// An item with the comment above it.
#[derive(Clone, Debug)]
pub(super) struct Item {
    name: String,
    is_entry: bool,
    /// The names in it that may be of other items.
    names: Vec<String>,
    pub(super) lines: Vec<Line>,
}

/// The items of a file, whatever stands between them left out.
pub(super) fn split(lines: Vec<Line>) -> Vec<Item> {
    let (mut items, mut open): (Vec<Item>, Vec<Line>) = (vec![], vec![]);
    let mut depth = 0_usize;
    for line in lines {
        let code = code(&line.text);
        let is_blank = line.text.trim().is_empty();
        if is_blank && depth == 0 {
            open.clear();
            continue;
        }
        depth += code.matches(['{', '(']).count();
        depth = depth.saturating_sub(code.matches(['}', ')']).count());
        let ends = depth == 0 && code.trim_end().ends_with(['}', ';']);
        open.push(line);
        if ends {
            items.push(Item::new(std::mem::take(&mut open)));
        }
    }
    items
}

/// The line without its comment.
fn code(line: &str) -> &str {
    line.split("//").next().unwrap_or_default()
}

impl Item {
    fn new(lines: Vec<Line>) -> Self {
        let (mut names, mut is_entry) = (vec![], false);
        for line in &lines {
            let code = code(&line.text);
            is_entry |= code.starts_with("@vertex") || code.starts_with("@fragment");
            identifiers(code, &mut names);
        }
        // What it is called follows `fn`, `struct` or `const`, or ends the declaration of a binding.
        let keyword = names.iter().position(|name| matches!(name.as_str(), "fn" | "struct" | "const" | "var"));
        let after = keyword.map_or(0, |place| {
            let spaced = names[place + 1..]
                .iter()
                .position(|name| !matches!(name.as_str(), "uniform" | "private" | "storage" | "read"));
            place + 1 + spaced.unwrap_or(0)
        });
        let name = names.get(after).cloned().unwrap_or_default();
        names.sort_unstable();
        names.dedup();
        Self { name, is_entry, names, lines }
    }
}

impl Item {
    /// Whether a text has an item of the name.
    pub(super) fn is_in(&self, source: &str) -> bool {
        let (function, structure) = (format!("fn {}(", self.name), format!("struct {} ", self.name));
        source.lines().any(|line| line.starts_with(&function) || line.starts_with(&structure))
    }
}

/// The identifiers of a line that may be of items: not what follows a dot, nor what a type follows.
fn identifiers(code: &str, names: &mut Vec<String>) {
    let mut before = ' ';
    let mut rest = code;
    while let Some(c) = rest.chars().next() {
        if c.is_ascii_alphabetic() || c == '_' {
            let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
            let is_item = code.contains("var<") || code.contains(" var ") || code.starts_with("const ");
            let is_declared = rest[end..].starts_with(':') && !is_item;
            if before != '.' && !is_declared {
                names.push(rest[..end].to_owned());
            }
            rest = &rest[end..];
            before = 'a';
        } else if c.is_ascii_digit() {
            let end = rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
            rest = &rest[end..];
            before = '0';
        } else {
            before = c;
            rest = &rest[c.len_utf8()..];
        }
    }
}

/// The items that the entry points reach, in their order. An own item comes before a family's of the same name.
pub(super) fn reached<'a>(own: &'a [Item], families: &'a [Item]) -> Vec<&'a Item> {
    let all: Vec<&Item> = own.iter().chain(families).collect();
    let mut places: HashMap<&str, usize> = HashMap::new();
    for (place, item) in all.iter().enumerate() {
        places.entry(&item.name).or_insert(place);
    }
    let mut wanted = vec![false; all.len()];
    let mut open: Vec<usize> = (0..all.len()).filter(|&place| all[place].is_entry).collect();
    while let Some(place) = open.pop() {
        if !std::mem::replace(&mut wanted[place], true) {
            open.extend(all[place].names.iter().filter_map(|name| places.get(name.as_str())));
        }
    }
    all.into_iter().zip(wanted).filter(|(_, wanted)| *wanted).map(|(item, _)| item).collect()
}

#[cfg(test)]
mod tests {
    use super::super::template::lines;
    use super::*;

    #[test]
    fn only_what_is_reached_stays() {
        let own = "// The entry.\n@fragment\nfn main(\n    a: f32,\n) -> A {\n    return f(b.g, 1e5);\n}\n
@group(0) @binding(0) var<uniform> b: A;\nstruct A {\n    g: f32,\n}\n// h\nconst c = 1.0;\n";
        let family = "fn f(x: f32, y: f32) -> A {\n    return A(x); // g\n}\n\nfn g() -> f32 {\n    return c;\n}\n";
        let (own, family) = (split(lines("own", own)), split(lines("family", family)));
        let names: Vec<&str> = reached(&own, &family).iter().map(|item| item.name.as_str()).collect();
        assert_eq!(names, ["main", "b", "A", "f"]);
        assert_eq!(own.iter().map(|item| item.name.as_str()).collect::<Vec<_>>(), ["main", "b", "A", "c"]);
        assert_eq!(own[0].lines[0].text, "// The entry.");
        // A constant with its type, as naga writes it.
        let own = split(lines("own", "const one: f32 = 1f;\n\n@fragment\nfn main() {\n    let a = one;\n}\n"));
        assert_eq!(reached(&own, &[]).iter().map(|item| item.name.as_str()).collect::<Vec<_>>(), ["one", "main"]);
    }
}
