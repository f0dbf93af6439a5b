//! WGSL as tokens: enough of its grammar to change a constant, an operator or an argument.

use std::ops::Range;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// A name or a keyword.
    Word,
    /// A literal with a decimal point, an exponent or the suffix `f`.
    Float,
    /// Any other literal of a number.
    Whole,
    /// An operator or a bracket.
    Sign,
}

/// A token of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    pub(crate) kind: TokenKind,
    /// Its bytes in the file.
    pub(crate) range: Range<usize>,
}

/// Signs of more than one character; longer ones come first.
const SIGNS: [&str; 19] = [
    "<<=", ">>=", "->", "<=", ">=", "==", "!=", "&&", "||", "<<", ">>", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=",
];

/// The tokens of a text. Comments are left out.
pub(crate) fn tokens(text: &str) -> Vec<Token> {
    let mut found = vec![];
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let (kind, length) = if first.is_whitespace() {
            (None, first.len_utf8())
        } else if rest.starts_with("//") {
            (None, rest.find('\n').unwrap_or(rest.len()))
        } else if first.is_ascii_digit() || (first == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit())) {
            let length = number(rest);
            let is_float = !rest.starts_with("0x") && rest[..length].contains(['.', 'e', 'f']);
            (Some(if is_float { TokenKind::Float } else { TokenKind::Whole }), length)
        } else if first.is_alphabetic() || first == '_' {
            (Some(TokenKind::Word), rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len()))
        } else {
            let length = SIGNS.iter().find(|sign| rest.starts_with(**sign)).map_or(first.len_utf8(), |sign| sign.len());
            (Some(TokenKind::Sign), length)
        };
        found.extend(kind.map(|kind| Token { kind, range: at..at + length }));
        at += length;
    }
    found
}

/// The length of the literal of a number that a text begins with.
fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut length = 0;
    while let Some(&byte) = bytes.get(length) {
        let is_signed_exponent = matches!(byte, b'+' | b'-') && !text.starts_with("0x") && bytes[length - 1] == b'e';
        if !(byte.is_ascii_alphanumeric() || byte == b'.' || is_signed_exponent) {
            break;
        }
        length += 1;
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_statement_falls_into_its_tokens() {
        let text = "x += -1.5e-3 * max(a.x, 0x1Fu) <= b; // 2.0\n";
        let found: Vec<&str> = tokens(text).into_iter().map(|token| &text[token.range]).collect();
        assert_eq!(
            found,
            ["x", "+=", "-", "1.5e-3", "*", "max", "(", "a", ".", "x", ",", "0x1Fu", ")", "<=", "b", ";"]
        );
        let kinds: Vec<TokenKind> = tokens("1.0 1u 0xfu 2f").into_iter().map(|token| token.kind).collect();
        assert_eq!(kinds, [TokenKind::Float, TokenKind::Whole, TokenKind::Whole, TokenKind::Float]);
    }
}
