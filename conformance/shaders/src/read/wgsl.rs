//! WGSL as the part of it that naga reads: directives of hosts, and what earlier drafts of the language wrote.

use super::lines::Lines;
use super::macros::words;

/// Brings a text into today's language. Its lines stay.
pub(super) fn plain(own: &Lines) -> Lines {
    let mut found = Lines::default();
    // Whether each of the conditions is on that the line stands in.
    let mut conditions: Vec<bool> = vec![];
    let (mut depth, mut is_struct) = (0_usize, false);
    for (line, number) in own.iter() {
        let word = line.trim_start();
        if let Some(directive) = word.strip_prefix('#').filter(|rest| !rest.starts_with('{')) {
            match words(directive).next().unwrap_or_default() {
                "ifdef" | "if" | "ifndef" => conditions.push(!directive.trim_start().starts_with("ifndef")),
                "else" | "elif" => {
                    if let Some(own) = conditions.last_mut() {
                        *own = !*own;
                    }
                }
                "endif" => drop(conditions.pop()),
                _ => {}
            }
            found.push("", number);
            continue;
        }
        if conditions.contains(&false) {
            found.push("", number);
            continue;
        }
        let mut kept = today(line);
        if words(&kept).next() == Some("struct") {
            (is_struct, depth) = (true, 0);
        }
        if is_struct {
            let code = kept.split("//").next().unwrap_or_default();
            let (opened, closed) = (code.matches('{').count(), code.matches('}').count());
            let ends = (depth + opened).saturating_sub(closed) == 0 && closed > 0;
            let at = if ends { code.rfind('}').unwrap_or(code.len()) } else { code.len() };
            kept = format!("{}{}", kept[..at].replace(';', ","), &kept[at..]);
            depth = (depth + opened).saturating_sub(closed);
            is_struct = !ends;
        }
        found.push(&kept, number);
    }
    found
}

/// A line without what hosts and earlier drafts wrote.
fn today(line: &str) -> String {
    let line = line
        .replace("::", "_")
        .replace("@stage(fragment)", "@fragment")
        .replace("@stage(vertex)", "@vertex")
        .replace("<push_constant>", "<immediate>");
    let mut line = super::hosts::without_places(&line);
    while let Some((start, end)) = line.find("#{").and_then(|at| Some((at, line[at..].find('}')? + at + 1))) {
        line.replace_range(start..end, "0");
    }
    while let Some((start, end)) = line.find("[[").and_then(|at| Some((at, line[at..].find("]]")? + at + 2))) {
        let own: Vec<String> = line[start + 2..end - 2].split(',').map(|own| attribute(own.trim())).collect();
        line.replace_range(start..end, &own.join(" "));
    }
    line
}

/// `stage(fragment)`, `location(0)`, `block` of earlier drafts.
fn attribute(own: &str) -> String {
    match own.strip_prefix("stage(").and_then(|rest| rest.strip_suffix(')')) {
        Some(stage) => format!("@{stage}"),
        None if own == "block" => String::new(),
        None => format!("@{own}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directives_and_earlier_drafts_become_todays_language() {
        let text = "#import bevy::view\n[[block]] struct A {\n  a: f32; // one;\n  b: vec2<f32>;\n};\n#ifdef X\n[[group(0), binding(1)]] var<uniform> a: A;\n#else\n@group(#{G}) var<uniform> a: A;\n#endif\n[[stage(fragment)]] fn f() { let x = view::of(1); }\n";
        let found = plain(&Lines::of_file(text));
        let lines: Vec<&str> = found.text.lines().map(str::trim).collect();
        assert_eq!(
            lines,
            [
                "",
                "struct A {",
                "a: f32, // one;",
                "b: vec2<f32>,",
                "};",
                "",
                "@group(0) @binding(1) var<uniform> a: A;",
                "",
                "",
                "",
                "@fragment fn f() { let x = view_of(1); }",
            ]
        );
    }
}
