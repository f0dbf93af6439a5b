//! Numbers in texts as pages write them: a minus sign, and a comma between thousands.

/// A text whose numbers are written so. What stands in an id, a name, a word or behind a point stays as it is.
#[must_use]
pub fn written(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let mut told = String::new();
    let mut at = 0;
    while at < chars.len() {
        let before = at.checked_sub(1).map(|place| chars[place]);
        let is_apart = before.is_none_or(|c| !c.is_alphanumeric() && !"./_#,-:@".contains(c));
        let digits = chars[at..].iter().take_while(|c| c.is_ascii_digit()).count();
        let next_is_digit = chars.get(at + 1).is_some_and(char::is_ascii_digit);
        if chars[at] == '-' && is_apart && next_is_digit {
            told.push('−');
            at += 1;
            let digits = chars[at..].iter().take_while(|c| c.is_ascii_digit()).count();
            told += &integer(&chars, at, digits);
            at += digits;
        } else if digits > 0 {
            let own: String = chars[at..at + digits].iter().collect();
            told += &if is_apart { integer(&chars, at, digits) } else { own };
            at += digits;
        } else {
            told.push(chars[at]);
            at += 1;
        }
    }
    told
}

/// The digits of an integer, or of a number before its point, with commas where that is what they are.
fn integer(chars: &[char], from: usize, digits: usize) -> String {
    let own = &chars[from..from + digits];
    let after = chars.get(from + digits);
    // A path and a version go on behind a slash or a second point, a word behind a letter.
    let is_of_a_name = after.is_some_and(|c| c.is_alphanumeric() || "/_-:".contains(*c));
    if digits < 4 || own[0] == '0' || is_of_a_name {
        return own.iter().collect();
    }
    let mut told = String::new();
    for (place, digit) in own.iter().enumerate() {
        if place > 0 && (digits - place).is_multiple_of(3) {
            told.push(',');
        }
        told.push(*digit);
    }
    told
}

#[cfg(test)]
mod tests {
    use super::written;

    #[test]
    fn numbers_have_commas_and_minus_signs_and_names_stay() {
        for (text, expected) in [
            ("1226 of 1252 failing cases", "1,226 of 1,252 failing cases"),
            ("-2 to 2, (-1, -0.5)", "−2 to 2, (−1, −0.5)"),
            ("20304.5 to 2701.1588", "20,304.5 to 2,701.1588"),
            ("-65504", "−65,504"),
            ("fog/exp/random/000523 and 0x3f800000", "fog/exp/random/000523 and 0x3f800000"),
            ("half-way, 1e-4, 1.5e10, 0.12345, 1,234", "half-way, 1e-4, 1.5e10, 0.12345, 1,234"),
            ("random/1234..1240", "random/1234..1240"),
            ("z-axis-for-zero", "z-axis-for-zero"),
        ] {
            assert_eq!(written(text), expected, "{text}");
        }
    }
}
