//! Leaves out of a text what nobody reads: a statement, or a function.

use super::super::glsl::{Token, tokens};
use super::dialect::{Dialect, KEYWORDS, is_type};
use std::ops::Range;

/// What stands for a value that is not read, before its type's name.
pub(super) const UNREAD: &str = "lightmeter_unread_";

/// A text without one of its statements.
pub(super) struct Cut {
    pub(super) text: String,
    /// The type of the value that is taken from outside in its place.
    pub(super) ty: Option<String>,
}

/// A statement, or what stands before braces: the tokens of it, and the place behind the braces.
struct Statement {
    own: Range<usize>,
    end: usize,
    /// The braces that it stands in.
    depth: usize,
    /// Where the function begins that it stands in.
    function: usize,
}

/// The statement of the line, from 1.
fn statement(code: &[(usize, &str)], line: Range<usize>) -> Option<Statement> {
    let wanted = code.iter().position(|(at, _)| line.contains(at))?;
    let (mut start, mut parens, mut depth, mut function) = (0, 0_usize, 0_usize, 0);
    for (k, (_, mark)) in code.iter().enumerate() {
        match *mark {
            "(" | "[" => parens += 1,
            ")" | "]" => parens = parens.saturating_sub(1),
            ";" | "{" | "}" if parens == 0 => {
                if k >= wanted && *mark != "}" {
                    let end = if *mark == "{" { closing(code, k) } else { k + 1 };
                    return Some(Statement { own: start..k, end, depth, function });
                }
                match *mark {
                    "{" => {
                        if depth == 0 {
                            function = start;
                        }
                        depth += 1;
                    }
                    "}" => depth = depth.saturating_sub(1),
                    _ => {}
                }
                if k >= wanted {
                    return None;
                }
                start = k + 1;
            }
            _ => {}
        }
    }
    None
}

/// The place behind the braces that open at a place.
fn closing(code: &[(usize, &str)], open: usize) -> usize {
    let mut depth = 0_usize;
    for (k, (_, mark)) in code.iter().enumerate().skip(open) {
        match *mark {
            "{" => depth += 1,
            "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return k + 1;
        }
    }
    code.len()
}

/// The text with blanks in a place, whose lines stay.
fn replaced(text: &str, place: Range<usize>, by: &str) -> String {
    let lines: String = text[place.clone()].chars().filter(|c| *c == '\n').collect();
    format!("{}{by}{lines}{}", &text[..place.start], &text[place.end..])
}

/// Cuts what stands on a line, from 1. What nobody could do without is not cut.
pub(super) fn cut(text: &str, line: usize, dialect: Dialect) -> Option<Cut> {
    let mut code: Vec<(usize, &str)> = vec![];
    let mut at = 0;
    for token in tokens(text) {
        if !matches!(token, Token::Space(_)) {
            code.push((at, token.text()));
        }
        at += token.text().len();
    }
    let start: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let length = text[start..].split_inclusive('\n').next().map_or(0, str::len);
    let found = statement(&code, start..start + length)?;
    let words: Vec<&str> = code[found.own.clone()].iter().map(|(_, word)| *word).collect();
    let byte = |k: usize| code.get(k).map_or(text.len(), |(at, _)| *at);
    let mark = code.get(found.own.end).map_or(";", |(_, mark)| *mark);
    let own = byte(found.own.start)..byte(found.own.end);
    let whole = byte(found.own.start)..code.get(found.end - 1).map_or(text.len(), |(at, mark)| at + mark.len());
    let value = |ty: &str| format!("{UNREAD}{ty}");
    let cut = |place: Range<usize>, by: &str, ty: Option<&str>| {
        Some(Cut { text: replaced(text, place, by), ty: ty.map(str::to_owned) })
    };
    if mark == "{" {
        let is_main = words.iter().any(|word| word.to_lowercase().contains("main"));
        return match words.first() {
            _ if found.depth == 0 && is_main => None,
            Some(&"if") if found.depth > 0 => cut(own, &format!("if ({})", value("bool")), Some("bool")),
            Some(&"else") => None,
            _ => cut(whole, "", None),
        };
    }
    if found.depth == 0 {
        return cut(own, "", None);
    }
    let first = words.iter().position(|word| *word != "const").unwrap_or(0);
    match words.get(first) {
        Some(&"return") => {
            let ty = (dialect != Dialect::Wgsl).then(|| {
                let head = code[found.function..].iter().map(|(_, word)| *word);
                head.take_while(|word| *word != "(").find(|word| !KEYWORDS.contains(word))
            })?;
            let ty = ty.filter(|ty| *ty != "void" && words.len() > 1)?;
            cut(own, &format!("return {}", value(ty)), Some(ty))
        }
        Some(&"else") => cut(own, "else ", None),
        Some(ty) if is_type(ty) && words.get(first + 2) == Some(&"=") => {
            let from = code[found.own.start + first + 3].0;
            cut(from..own.end, &value(ty), Some(ty))
        }
        Some(_) => cut(own, "", None),
        None => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn without(text: &str, line: usize) -> Option<String> {
        cut(text, line, Dialect::Glsl).map(|own| own.text)
    }

    #[test]
    fn what_stands_on_a_line_is_left_out_and_lines_stay() {
        let text = "uniform vec3 a;\nfloat f(float x) {\n  return odd?(x,\n    1);\n}\nvoid main() {\n  vec3 b = a ?? 1;\n  for (int i = 0; i < 3; i++) {\n    b += §;\n  }\n  if (a #) { b = a; }\n}\n";
        let lines = text.lines().count();
        let own = |line: usize, left_out: &str, there: &str| {
            let cut = without(text, line).unwrap_or_else(|| panic!("line {line}"));
            assert_eq!(cut.lines().count(), lines, "{cut}");
            assert!(!cut.contains(left_out) && cut.contains(there), "{cut}");
        };
        own(1, "uniform", "float f");
        own(4, "odd", "  return lightmeter_unread_float\n;");
        own(2, "float f", "void main");
        own(7, "??", "vec3 b = lightmeter_unread_vec3;");
        own(9, "§", "for (int i = 0; i < 3; i++) {");
        own(8, "for (", "if (a #)");
        own(11, "#", "if (lightmeter_unread_bool){ b = a; }");
        assert_eq!(without(text, 6), None);
        assert_eq!(without(text, 99), None);
    }
}
