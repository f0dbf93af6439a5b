//! WGSL with every f32 written as f64, so that naga keeps its constants to 53 bits: `1.0 / 3.0` is no number of f32.

use std::fmt::Write as _;

/// The text with f64 in place of f32, textures excepted. Comments are left out, lines are kept.
pub(super) fn widen(text: &str) -> String {
    let mut out = String::new();
    for line in text.lines() {
        widen_line(line.split("//").next().unwrap_or_default(), &mut out);
        out.push('\n');
    }
    out
}

fn widen_line(code: &str, out: &mut String) {
    let mut rest = code;
    while let Some(c) = rest.chars().next() {
        let length = |of: &dyn Fn(char) -> bool| rest.find(|c: char| !of(c)).unwrap_or(rest.len());
        let end = if c.is_ascii_alphabetic() || c == '_' {
            let end = length(&|c| c.is_ascii_alphanumeric() || c == '_');
            word(&rest[..end], out);
            end
        } else if c.is_ascii_digit() {
            let end = number_end(rest);
            let number = &rest[..end];
            if let Some(power) = power_of_two(number) {
                let _ = write!(out, "{power:?}lf");
            } else {
                out.push_str(number);
                out.push_str(if is_decimal(number) { "lf" } else { "" });
            }
            end
        } else {
            out.push(c);
            c.len_utf8()
        };
        rest = &rest[end..];
    }
}

fn word(word: &str, out: &mut String) {
    let is_vector = matches!(word, "vec2f" | "vec3f" | "vec4f");
    let is_matrix = word.len() == 7 && word.starts_with("mat") && word.ends_with('f');
    if word == "f32" && !out.ends_with("texture_2d<") {
        out.push_str("f64");
    } else if is_vector || is_matrix {
        out.push_str(&word[..word.len() - 1]);
        out.push_str("<f64>");
    } else {
        out.push_str(word);
    }
}

/// Where a literal ends: a sign belongs to it after an exponent's letter.
fn number_end(text: &str) -> usize {
    let is_hex = text.starts_with("0x");
    let mut before = '0';
    for (place, c) in text.char_indices() {
        let signs = matches!(c, '+' | '-') && matches!((is_hex, before), (true, 'p') | (false, 'e'));
        if !(c.is_ascii_alphanumeric() || c == '.' || signs) {
            return place;
        }
        before = c;
    }
    text.len()
}

/// `0x1p-20` and the like, the only hexadecimal floats that there are.
fn power_of_two(number: &str) -> Option<f64> {
    number.strip_prefix("0x1p")?.parse().ok().map(|exponent: i32| 2.0_f64.powi(exponent))
}

/// A decimal float without a suffix.
fn is_decimal(number: &str) -> bool {
    !number.starts_with("0x")
        && number.contains(['.', 'e'])
        && number.ends_with(|c: char| c.is_ascii_digit() || c == '.')
}

#[cfg(test)]
mod tests {
    use super::widen;

    #[test]
    fn types_and_literals_are_widened_and_nothing_else() {
        let rows = [
            ("fn f(x: f32, v: vec3f) -> mat3x3f { // f32", "fn f(x: f64, v: vec3<f64>) -> mat3x3<f64> { "),
            ("1.0 / 24.0 + x1.y", "1.0lf / 24.0lf + x1.y"),
            ("0x1p-2 + 2u + 0xfffff000u", "0.25lf + 2u + 0xfffff000u"),
            ("1.5e-3-2", "1.5e-3lf-2"),
            ("image: texture_2d<f32>, a: array<f32, 3>", "image: texture_2d<f32>, a: array<f64, 3>"),
        ];
        for (text, wide) in rows {
            assert_eq!(widen(text), format!("{wide}\n"), "{text}");
        }
    }
}
