//! What a text uses: names with the fields that are asked of them, types, calls.

use super::super::glsl::{Token, tokens};
use super::dialect::{Dialect, KEYWORDS, is_type};
use std::collections::{BTreeSet, HashMap, HashSet};

/// The words and marks of a text, without comments and directives.
pub(super) fn code(text: &str) -> Vec<&str> {
    let solid = |token: &Token<'_>| !matches!(token, Token::Space(_));
    tokens(text).into_iter().filter(solid).map(Token::text).collect()
}

pub(super) fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_') && !KEYWORDS.contains(&word)
}

/// A name, and what is asked of it.
#[derive(Debug)]
pub(super) struct Use<'a> {
    pub(super) name: &'a str,
    /// Whether an element is asked of it.
    pub(super) is_indexed: bool,
    /// The fields within each other, each with whether an element is asked of it.
    pub(super) fields: Vec<(&'a str, bool)>,
    /// What stands before it, the nearest last.
    pub(super) before: [&'a str; 3],
    /// What stands behind it.
    pub(super) after: &'a str,
    /// The type of the variable that it is the whole value of.
    pub(super) declares: Option<&'a str>,
    /// Whether it multiplies as a matrix does: `mul(…, name)`, `name * vec4(…)`.
    pub(super) is_matrix: bool,
}

/// The place behind what a bracket at a place opens.
fn behind(code: &[&str], open: usize) -> usize {
    let mut depth = 0_usize;
    for (k, mark) in code.iter().enumerate().skip(open) {
        match *mark {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return k + 1;
        }
    }
    code.len()
}

/// The place of the second argument of the brackets that open at a place.
fn second(code: &[&str], open: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (k, mark) in code.iter().enumerate().skip(open) {
        match *mark {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            "," if depth == 1 => return Some(k + 1),
            _ => {}
        }
        if depth == 0 {
            return None;
        }
    }
    None
}

/// All names that are used as values.
pub(super) fn uses<'a>(code: &[&'a str]) -> Vec<Use<'a>> {
    let at = |k: usize| code.get(k).copied().unwrap_or("");
    let back = |k: usize, by: usize| k.checked_sub(by).map_or("", &at);
    let declared: HashMap<&str, &str> =
        code.windows(3).filter(|own| own[2] == ";" && is_name(own[0])).map(|own| (own[1], own[0])).collect();
    let seconds: HashSet<usize> =
        (0..code.len()).filter(|&k| code[k] == "mul" && at(k + 1) == "(").filter_map(|k| second(code, k + 1)).collect();
    let mut found: Vec<Use<'a>> = vec![];
    for k in (0..code.len()).filter(|&k| is_name(code[k]) && back(k, 1) != "." && !is_type(code[k])) {
        let mut own = Use {
            name: code[k],
            is_indexed: false,
            fields: vec![],
            before: [back(k, 3), back(k, 2), back(k, 1)],
            after: "",
            declares: None,
            is_matrix: seconds.contains(&k),
        };
        let mut next = k + 1;
        loop {
            match at(next) {
                "[" => {
                    match own.fields.last_mut() {
                        Some(last) => last.1 = true,
                        None => own.is_indexed = true,
                    }
                    next = behind(code, next);
                }
                "." if at(next + 1).starts_with(|c: char| c.is_alphabetic() || c == '_') => {
                    own.fields.push((at(next + 1), false));
                    next += 2;
                }
                _ => break,
            }
        }
        own.after = at(next);
        own.is_matrix |= own.after == "*" && at(next + 1) == "vec4";
        if own.before[2] == "=" && own.after == ";" && is_name(own.before[1]) {
            // `T x = name;`, and `x = name;` of a `T x;`.
            own.declares = Some(own.before[0])
                .filter(|ty| is_name(ty) || is_type(ty))
                .or_else(|| declared.get(own.before[1]).copied());
        }
        found.push(own);
    }
    found
}

/// Whether directives of a text define a word.
fn is_defined(text: &str, word: &str) -> bool {
    let name = |line: &str| {
        let rest = line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("define")?;
        super::super::macros::words(rest).next().map(|own| own == word)
    };
    text.lines().any(|line| name(line) == Some(true))
}

/// Whether a text declares a word itself: as a structure, a block, a macro, a function or a variable.
pub(super) fn is_declared(text: &str, code: &[&str], word: &str) -> bool {
    let declares = |pair: &[&str]| {
        pair[1] == word
            && (is_type(pair[0]) || matches!(pair[0], "struct" | "typedef" | "alias" | "type" | "fn" | "let"))
    };
    code.windows(2).any(declares) || is_defined(text, word)
}

/// Types that a text uses and nobody declares, each with the variables of it.
pub(super) fn unknown_types<'a>(text: &str, code: &[&'a str], dialect: Dialect) -> Vec<(&'a str, BTreeSet<&'a str>)> {
    let mut found: Vec<(&'a str, BTreeSet<&'a str>)> = vec![];
    let mut depth = 0_usize;
    let at = |k: usize| code.get(k).copied().unwrap_or("");
    for k in 0..code.len() {
        match code[k] {
            "{" => depth += 1,
            "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        const BUFFERS: [&str; 3] = ["ConstantBuffer", "StructuredBuffer", "RWStructuredBuffer"];
        let is_of_buffer = k > 1 && at(k - 1) == "<" && BUFFERS.contains(&at(k - 2)) && at(k + 1) == ">";
        let (ty, name) = if is_of_buffer {
            (code[k], at(k + 2))
        } else if dialect == Dialect::Wgsl {
            let is_field = |word: &str| word.starts_with(|c: char| c.is_alphabetic() || c == '_');
            let is_typed =
                k > 1 && at(k - 1) == ":" && is_field(at(k - 2)) || k > 1 && at(k - 2) == "-" && at(k - 1) == ">";
            let is_element = k > 1 && at(k - 1) == "<" && at(k - 2) == "array";
            let (start, name) = if is_element { (0, "") } else { (k.saturating_sub(2), at(k.saturating_sub(2))) };
            // `case X: Y` is no declaration.
            if !(is_typed || is_element)
                || start > 0 && at(start - 1) == "case"
                || !matches!(at(k + 1), "," | ")" | "{" | ";" | "=" | "}" | ">")
            {
                continue;
            }
            (code[k], name)
        } else {
            let is_variable =
                matches!(at(k + 2), ";" | "=" | "," | ")" | "[") || at(k + 2) == ":" && dialect == Dialect::Hlsl;
            let is_function = at(k + 2) == "(" && depth == 0;
            if !is_name(at(k + 1)) || is_type(at(k + 1)) || !(is_variable || is_function) || k > 0 && code[k - 1] == "."
            {
                continue;
            }
            (code[k], if is_variable { at(k + 1) } else { "" })
        };
        if !is_name(ty)
            || is_type(ty)
            || WGSL_TYPES.contains(&ty) && dialect == Dialect::Wgsl
            || is_declared(text, code, ty)
        {
            continue;
        }
        let place = found.iter().position(|(own, _)| *own == ty).unwrap_or_else(|| {
            found.push((ty, BTreeSet::new()));
            found.len() - 1
        });
        if is_name(name) {
            found[place].1.insert(name);
        }
    }
    found
}

/// Names that a text uses as values and declares nowhere.
pub(super) fn undeclared<'a>(text: &str, code: &[&'a str], uses: &[Use<'a>]) -> Vec<&'a str> {
    let mut declared: HashSet<&str> = HashSet::new();
    let is_word = |word: &str| word.starts_with(|c: char| c.is_alphabetic() || c == '_');
    let ends = |mark: &str| matches!(mark, ">" | "]");
    for pair in code.windows(2) {
        let declares = is_word(pair[0]) && !matches!(pair[0], "return" | "else" | "case" | "in") || ends(pair[0]);
        if declares && is_word(pair[1]) {
            declared.insert(pair[1]);
        }
    }
    // `float a = f(1, 2), b;`
    for statement in code.split(|mark| matches!(*mark, ";" | "{" | "}")) {
        let is_list =
            statement.iter().take(4).collect::<Vec<_>>().windows(2).any(|pair| is_word(pair[0]) && is_name(pair[1]));
        let mut depth = 0_usize;
        for pair in statement.windows(2).filter(|_| is_list) {
            match pair[0] {
                "(" | "[" => depth += 1,
                ")" | "]" => depth = depth.saturating_sub(1),
                "," if depth == 0 => drop(declared.insert(pair[1])),
                _ => {}
            }
        }
    }
    let mut found: Vec<&str> = vec![];
    for own in uses {
        let is_called = own.after == "(" && own.fields.is_empty() || is_word(own.after);
        let is_attribute = own.before[2] == "[" && matches!(own.before[1], ";" | "{" | "}" | ")" | "");
        let is_place = own.before[2] == "(" && matches!(own.before[1], "register" | "packoffset");
        let is_semantic = own.before[2] == ":" && !is_ternary(code, own);
        let is_known = is_called || is_attribute || is_place || is_semantic || declared.contains(own.name);
        if !is_known && !found.contains(&own.name) && !is_defined(text, own.name) {
            found.push(own.name);
        }
    }
    found
}

/// Whether the colon before a name is that of a choice.
fn is_ternary(code: &[&str], own: &Use<'_>) -> bool {
    let Some(at) = code.windows(2).position(|pair| pair[0] == ":" && pair[1] == own.name) else { return false };
    code[..at].iter().rev().take_while(|mark| !matches!(**mark, ";" | "{" | "}")).any(|mark| *mark == "?")
}

/// What WGSL itself calls types, but for those of [`is_type`].
const WGSL_TYPES: [&str; 12] =
    ["f32", "i32", "u32", "f16", "array", "ptr", "atomic", "vec2f", "vec3f", "vec4f", "mat4x4f", "mat3x3f"];

/// Words before a type that are nobody's: qualifiers that a host defines.
pub(super) fn unknown_qualifiers<'a>(text: &str, code: &[&'a str]) -> BTreeSet<&'a str> {
    let is_word =
        |word: &str| is_type(word) || matches!(word, "uniform" | "in" | "out" | "const" | "highp" | "mediump" | "lowp");
    let starts = |k: usize| k == 0 || matches!(code[k - 1], ";" | "}" | "{" | "(" | "," | ")") || is_word(code[k - 1]);
    (0..code.len().saturating_sub(2))
        .filter(|&k| is_name(code[k]) && !is_type(code[k]) && is_word(code[k + 1]) && code[k + 2] != "(" && starts(k))
        .map(|k| code[k])
        .filter(|word| !is_declared(text, code, word))
        .collect()
}

/// A call in a text: where its name begins and where its brackets end, and how many arguments it has.
pub(super) struct Call {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) arguments: usize,
    /// Whether it stands as a statement of its own.
    pub(super) is_statement: bool,
}

/// The first call of a function at or behind a place.
pub(super) fn call(text: &str, name: &str, from: usize) -> Option<Call> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut at = from;
    loop {
        let start = at + text.get(at..)?.find(name)?;
        at = start + name.len();
        let rest = &text[at..];
        let open = at + (rest.len() - rest.trim_start().len());
        if text[..start].ends_with(is_word) || !text[open..].starts_with('(') {
            continue;
        }
        let (mut depth, mut arguments, mut is_empty) = (0_usize, 1, true);
        for (k, c) in text[open..].char_indices() {
            match c {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth = depth.saturating_sub(1),
                ',' if depth == 1 => arguments += 1,
                _ => {}
            }
            is_empty &= k == 0 || c.is_whitespace() || depth == 0;
            if depth == 0 {
                let end = open + k + 1;
                let before = text[..start].trim_end();
                let is_statement = before.ends_with([';', '{', '}']) && text[end..].trim_start().starts_with(';');
                return Some(Call { start, end, arguments: if is_empty { 0 } else { arguments }, is_statement });
            }
        }
        return None;
    }
}
