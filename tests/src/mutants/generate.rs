//! The mutants of a text, by one rule for all files.

use super::tokens::{Token, TokenKind, tokens};
use std::ops::Range;

/// A text with one change.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mutant {
    /// The file that it is in.
    pub file: String,
    /// The function that it is in; empty outside of functions.
    pub function: String,
    /// The number of the first token that changes, counted from the function's name, or from the start of the file.
    pub place: usize,
    /// What stood there.
    pub before: String,
    /// What stands there instead.
    pub after: String,
    range: Range<usize>,
}

impl Mutant {
    /// Its name, which no change elsewhere in the file alters.
    #[must_use]
    pub fn name(&self) -> String {
        let Self { file, function, place, before, after, .. } = self;
        let of = if function.is_empty() { String::new() } else { format!(" {function}") };
        // What stands on several lines is named on one.
        let line = |text: &str| text.split_whitespace().collect::<Vec<&str>>().join(" ");
        format!("{file}{of} {place}: {} -> {}", line(before), line(after)).trim_end().to_owned()
    }

    /// The text with the change.
    #[must_use]
    pub fn apply(&self, text: &str) -> String {
        format!("{}{}{}", &text[..self.range.start], self.after, &text[self.range.end..])
    }
}

/// All mutants of a file.
#[must_use]
pub fn mutants(file: &str, text: &str) -> Vec<Mutant> {
    let tokens = tokens(text);
    let mut source = Source { file, text, tokens: &tokens, function: String::new(), start: 0, found: vec![] };
    let mut depth = 0;
    let mut at = 0;
    while at < tokens.len() {
        match source.word(at) {
            "struct" if depth == 0 => at = source.end_of_block(at),
            // Declarations of bindings and types say nothing that computes.
            "@" | "var" | "alias" | "enable" | "diagnostic" if depth == 0 && source.function.is_empty() => {
                at = source.end_of_declaration(at);
            }
            "fn" => {
                (source.function, source.start) = (source.word(at + 1).to_owned(), at + 1);
                at = source.start_of_body(at);
                continue;
            }
            "{" => depth += 1,
            "}" => {
                depth -= 1;
                if depth == 0 {
                    (source.function, source.start) = (String::new(), 0);
                }
            }
            _ => source.change(at),
        }
        at += 1;
    }
    source.found
}

/// Functions of one argument that are taken away, or that another one replaces.
const REPLACED: [(&str, &[&str]); 16] = [
    ("min", &["max"]),
    ("max", &["min"]),
    ("exp", &["exp2"]),
    ("exp2", &["exp"]),
    ("log", &["log2"]),
    ("log2", &["log"]),
    ("floor", &["ceil", "trunc"]),
    ("ceil", &["floor"]),
    ("round", &["floor"]),
    ("trunc", &["floor"]),
    ("sqrt", &["inverseSqrt"]),
    ("inverseSqrt", &["sqrt"]),
    ("any", &["all"]),
    ("all", &["any"]),
    ("true", &["false"]),
    ("false", &["true"]),
];

/// Operators and what is put in their places.
const OPERATORS: [(&str, &[&str]); 18] = [
    ("+", &["-"]),
    ("-", &["+"]),
    ("*", &["/"]),
    ("/", &["*"]),
    ("+=", &["-="]),
    ("-=", &["+="]),
    ("*=", &["/="]),
    ("/=", &["*="]),
    ("<", &["<=", ">"]),
    ("<=", &["<", ">="]),
    (">", &[">=", "<"]),
    (">=", &[">", "<="]),
    ("==", &["!="]),
    ("!=", &["=="]),
    ("&&", &["||"]),
    ("||", &["&&"]),
    ("<<", &[">>"]),
    (">>", &["<<"]),
];

/// A file under change.
struct Source<'a> {
    file: &'a str,
    text: &'a str,
    tokens: &'a [Token],
    /// The function that is gone through, and its first token.
    function: String,
    start: usize,
    found: Vec<Mutant>,
}

impl Source<'_> {
    /// The text of a token; empty beyond the last.
    fn word(&self, at: usize) -> &str {
        self.tokens.get(at).map(|token| &self.text[token.range.clone()]).unwrap_or_default()
    }

    /// The last token of the block that begins after a token.
    fn end_of_block(&self, at: usize) -> usize {
        let open = (at..self.tokens.len()).find(|&k| self.word(k) == "{").unwrap_or(at);
        self.closing(open)
    }

    /// The last token of a declaration: a semicolon, or the one before `fn`.
    fn end_of_declaration(&self, at: usize) -> usize {
        let is_end = |&k: &usize| self.word(k) == ";" || self.word(k + 1) == "fn" || self.word(k + 1).is_empty();
        (at..self.tokens.len()).find(is_end).unwrap_or(at)
    }

    /// The brace that opens a function's body.
    fn start_of_body(&self, at: usize) -> usize {
        (at..self.tokens.len()).find(|&k| self.word(k) == "{").unwrap_or(self.tokens.len())
    }

    /// The bracket that closes the one at a token.
    fn closing(&self, open: usize) -> usize {
        let mut depth = 0_usize;
        for at in open..self.tokens.len() {
            match self.word(at) {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                return at;
            }
        }
        self.tokens.len() - 1
    }

    fn put(&mut self, at: usize, range: Range<usize>, after: String) {
        let before = self.text[range.clone()].to_owned();
        // Directives of the composer stand in comments, and are no part of an expression.
        if before == after || before.contains("//") {
            return;
        }
        let (file, function) = (self.file.to_owned(), self.function.clone());
        self.found.push(Mutant { file, function, place: at - self.start, before, after, range });
    }

    /// Every change of what begins at a token.
    fn change(&mut self, at: usize) {
        let Token { kind, range } = self.tokens[at].clone();
        let text = self.text[range.clone()].to_owned();
        match kind {
            TokenKind::Float => self.change_float(at, range, &text),
            TokenKind::Whole if !text.starts_with("0x") => {
                let digits = text.trim_end_matches(|c: char| !c.is_ascii_digit());
                if let Ok(x) = digits.parse::<u64>() {
                    self.put(at, range, format!("{}{}", x + 1, &text[digits.len()..]));
                }
            }
            TokenKind::Whole => {}
            TokenKind::Word => self.change_word(at, range, &text),
            TokenKind::Sign => {
                if text == "-" && self.is_prefix(at) {
                    self.put(at, range, String::new());
                    return;
                }
                if let Some((_, others)) = OPERATORS.iter().find(|(sign, _)| *sign == text) {
                    others.iter().for_each(|other| self.put(at, range.clone(), (*other).to_owned()));
                }
            }
        }
    }

    /// Whether a minus stands before its only operand.
    fn is_prefix(&self, at: usize) -> bool {
        let before = at.checked_sub(1).map_or("", |k| self.word(k));
        let ends_operand = self
            .tokens
            .get(at.wrapping_sub(1))
            .is_some_and(|token| token.kind != TokenKind::Sign && before != "return");
        !ends_operand && !matches!(before, ")" | "]")
    }

    /// A float a thousandth greater, and one greater.
    fn change_float(&mut self, at: usize, range: Range<usize>, text: &str) {
        let Ok(x) = text.trim_end_matches('f').parse::<f64>() else { return };
        let slightly = if x == 0.0 { 1e-3 } else { x * 1.001 };
        for other in [slightly, x + 1.0] {
            self.put(at, range.clone(), format!("{other:?}"));
        }
    }

    fn change_word(&mut self, at: usize, range: Range<usize>, text: &str) {
        if at > 0 && self.word(at - 1) == "." {
            let letters = if text.chars().all(|c| "xyzw".contains(c)) { "xyzw" } else { "rgba" };
            // A component of a vector; members of structures have whole words for names.
            if let (1, Some(place)) = (text.len(), letters.find(text)) {
                let other = letters.chars().nth((place + 1) % 3).unwrap_or('x');
                self.put(at, range, other.to_string());
            }
            return;
        }
        if let Some((_, others)) = REPLACED.iter().find(|(name, _)| *name == text) {
            others.iter().for_each(|other| self.put(at, range.clone(), (*other).to_owned()));
        }
        if text == "if" {
            // A condition ends where the block begins.
            let end = self.start_of_body(at);
            let condition = self.tokens[at + 1].range.start..self.tokens[end - 1].range.end;
            for other in ["true", "false"] {
                self.put(at, condition.clone(), other.to_owned());
            }
            return;
        }
        if self.word(at + 1) == "(" {
            self.change_call(at);
        }
    }

    /// A call without its function, and with each two neighbouring arguments exchanged.
    fn change_call(&mut self, at: usize) {
        let (open, close) = (at + 1, self.closing(at + 1));
        let mut arguments = vec![];
        let (mut depth, mut first) = (0_usize, open + 1);
        for k in open + 1..=close {
            match self.word(k) {
                "," if depth == 0 => {
                    arguments.push(first..k);
                    first = k + 1;
                }
                _ if k == close => arguments.extend((first < k).then_some(first..k)),
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
        }
        let span = |tokens: &Range<usize>| self.tokens[tokens.start].range.start..self.tokens[tokens.end - 1].range.end;
        let spans: Vec<Range<usize>> = arguments.iter().map(span).collect();
        let call = self.tokens[at].range.start..self.tokens[close].range.end;
        if let Some(first) = spans.first() {
            let alone = format!("({})", &self.text[first.clone()]);
            self.put(at, call, alone);
        }
        for pair in spans.windows(2) {
            let (a, b) = (&self.text[pair[0].clone()], &self.text[pair[1].clone()]);
            let between = &self.text[pair[0].end..pair[1].start];
            let exchanged = format!("{b}{between}{a}");
            self.put(at, pair[0].start..pair[1].end, exchanged);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(body: &str) -> Vec<String> {
        let text = format!("struct S {{ a: vec3<f32>, }}\nconst K: f32 = 2.0;\nfn f(a: f32) -> f32 {{\n{body}\n}}\n");
        mutants("f.wgsl", &text)
            .iter()
            .filter(|m| m.function == "f")
            .map(|m| m.apply(&text))
            .map(|changed| {
                let (start, end) = (changed.find("{\n").unwrap_or(0) + 2, changed.rfind("\n}").unwrap_or(0));
                changed[start..end].to_owned()
            })
            .collect()
    }

    #[test]
    fn constants_operators_and_arguments_change_one_at_a_time() {
        assert_eq!(of("return -a;"), ["return a;"]);
        assert_eq!(of("return a - 1.0;"), ["return a + 1.0;", "return a - 1.001;", "return a - 2.0;"]);
        assert_eq!(
            of("return max(a, b.x);"),
            ["return min(a, b.x);", "return (a);", "return max(b.x, a);", "return max(a, b.y);",]
        );
        assert_eq!(
            of("if a < b { return 2u; }"),
            [
                "if true { return 2u; }",
                "if false { return 2u; }",
                "if a <= b { return 2u; }",
                "if a > b { return 2u; }",
                "if a < b { return 3u; }",
            ]
        );
    }

    #[test]
    fn constants_of_a_file_change_and_its_declarations_do_not() {
        let text = "@group(0) @binding(1) var<storage, read> rows: array<u32, 4>;\nconst K: f32 = 2.0;\n@fragment\nfn f() {}\n";
        let names: Vec<String> = mutants("f.wgsl", text).iter().map(Mutant::name).collect();
        assert_eq!(names.len(), 2, "{names:?}");
        assert!(names[0].ends_with("2.0 -> 2.002"), "{names:?}");
    }

    #[test]
    fn names_are_unique_in_every_file() {
        let shaders = lightmeter_gpu::Shaders::built_in().expect("the built-in shaders are valid");
        let names: Vec<String> =
            shaders.texts().flat_map(|(file, text)| mutants(file, text)).map(|mutant| mutant.name()).collect();
        let unique: std::collections::BTreeSet<&String> = names.iter().collect();
        assert!(names.len() > 1500, "{}", names.len());
        assert_eq!(unique.len(), names.len());
    }
}
