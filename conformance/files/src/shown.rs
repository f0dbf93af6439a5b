//! Text of others, made fit to be shown: a terminal obeys control characters, a reader believes what changes the direction of
//! writing, and a continuous-integration server takes lines that begin in a certain way for commands.

use std::borrow::Cow;
use std::fmt;

/// Whether a character is shown by its number: one that controls a terminal, ends a line, is not to be seen, changes the direction of
/// writing, or stands in no XML.
const fn is_hidden(c: char) -> bool {
    matches!(
        c,
        '\0'..='\x08'
            | '\x0a'..='\x1f'
            | '\x7f'..='\u{9f}'
            | '\u{ad}'
            | '\u{61c}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{2069}'
            | '\u{feff}'
            | '\u{fff9}'..='\u{fffb}'
            | '\u{fffe}'..='\u{ffff}'
            | '\u{e0000}'..='\u{e007f}'
    )
}

fn escape(c: char, out: &mut String) {
    out.extend(c.escape_unicode());
}

/// A text of others within a line: hidden characters by their numbers, `\u{1b}`. One that begins as a command to a
/// continuous-integration server has its first character so, too.
#[must_use]
pub fn shown(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) && !is_command(text) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    push(text, &mut out);
    Cow::Owned(out)
}

fn push(text: &str, out: &mut String) {
    let mut is_first = is_command(text);
    for c in text.chars() {
        let begins = is_first && !c.is_whitespace();
        if begins || is_hidden(c) {
            escape(c, out);
        } else {
            out.push(c);
        }
        is_first &= !begins;
    }
}

/// Whether a line is one that GitHub's or Azure's servers would obey: they look behind blanks.
fn is_command(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with("::") || line.starts_with("##[") || line.starts_with("##vso[")
}

/// A text of several lines, with text of others in it: the same in each of its lines.
#[must_use]
pub fn lines(text: &str) -> Cow<'_, str> {
    let is_hidden = |c: char| c != '\n' && is_hidden(c);
    if !text.contains(is_hidden) && !text.lines().any(is_command) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for (place, line) in text.split('\n').enumerate() {
        if place > 0 {
            out.push('\n');
        }
        push(line, &mut out);
    }
    Cow::Owned(out)
}

/// What is shown so where it is formatted: `format!("renderer {}", Shown(name))`.
#[derive(Clone, Copy, Debug)]
pub struct Shown<T>(pub T);

impl<T: fmt::Display> fmt::Display for Shown<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&shown(&self.0.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_or_a_server_obeys_is_shown_by_its_number() {
        for (text, expected) in [
            ("fog/exp", "fog/exp"),
            ("größer ≥ 1 🙂", "größer ≥ 1 🙂"),
            ("a\x1b[31mb", r"a\u{1b}[31mb"),
            ("a\n::error::b", r"a\u{a}::error::b"),
            ("::add-mask::x", r"\u{3a}:add-mask::x"),
            ("  ::add-mask::x", r"  \u{3a}:add-mask::x"),
            ("##[error]x", r"\u{23}#[error]x"),
            ("a\u{202e}b\u{2066}c\u{fffe}d\u{85}", r"a\u{202e}b\u{2066}c\u{fffe}d\u{85}"),
        ] {
            assert_eq!(shown(text), expected);
            assert_eq!(Shown(text).to_string(), expected);
        }
        assert_eq!(format!("{:>4}", Shown("a")), "   a");
    }

    #[test]
    fn lines_stay_lines() {
        assert_eq!(lines("a\nb"), "a\nb");
        assert_eq!(lines("a\n::error::b\n\tc\r\n"), "a\n\\u{3a}:error::b\n\tc\\u{d}\n");
    }
}
