//! Errors in words: a number of ULP as long as it says something, and else how far a value is from what it should be.

use crate::number::{Number, thousands};

/// From this many ULP on, an error is greater than the number that it is an error of: binary32 has 24 digits, and smaller formats fewer.
const MOST_ULP: f64 = 16_777_216.0;
/// From this many ULP on, a difference says more than their number.
const MOST_COUNTED: f64 = 1e6;
/// The least power of ten between a value and its reference that is told.
const LEAST_POWER: i32 = 3;

/// An error with its unit, as text for people: `3.25 ULP`. From 2²⁴ ULP on, where no digit of the value is right, the text says so instead of the figure.
#[must_use]
pub fn error_told(Number(error): Number, unit: &str) -> String {
    match error {
        _ if error.is_nan() => "no number".into(),
        _ if error.is_infinite() => "infinite".into(),
        _ if error >= MOST_ULP => format!("more than 2²⁴ {unit}, more than the number itself"),
        _ => format!("{} {unit}", figure(error)),
    }
}

/// The same in the cell of a table, as a bound where the number says nothing.
#[must_use]
pub fn error_figure(Number(error): Number) -> String {
    match error {
        _ if error.is_nan() => "NaN".into(),
        _ if error.is_infinite() => "∞".into(),
        _ if error >= MOST_ULP => "> 2²⁴".into(),
        _ => figure(error),
    }
}

/// How far a value is from its reference: in its unit, or as a difference where no digit is right.
#[must_use]
pub fn distance_told(error: Number, unit: &str, Number(value): Number, Number(reference): Number) -> String {
    if error.0 < MOST_COUNTED {
        return format!("{} from the reference", error_told(error, unit));
    }
    let off = format!("off by {}", Number(value - reference).brief());
    match power_of_ten(value, reference) {
        Some(power) if power > 0 => format!("{off}, about 10{} times the reference", superscript(power)),
        Some(power) if power < 0 => format!("{off}, about 10{} of the reference", superscript(power)),
        _ => off,
    }
}

/// The power of ten that is next to the ratio of two numbers; `None` where there is no such ratio, or a difference says as much.
fn power_of_ten(value: f64, reference: f64) -> Option<i32> {
    let ratio = (value / reference).abs();
    #[expect(clippy::cast_possible_truncation, reason = "a power of ten that f64 has is below 700")]
    let power = (ratio.is_finite() && ratio > 0.0).then(|| ratio.log10().round() as i32);
    power.filter(|power| power.abs() >= LEAST_POWER)
}

/// Two digits behind the point of what is small, and groups of three digits of what is large.
fn figure(error: f64) -> String {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 2²⁴")]
    let whole = |error: f64| thousands(error.round() as u64);
    match error {
        0.0 => "0".into(),
        // What would be shown as 0 is not 0.
        small if small < 0.01 => format!("{small:.1e}"),
        small if small < 999.5 => format!("{small:.2}"),
        large => whole(large),
    }
}

/// An exponent, such as `⁻¹²`.
#[must_use]
pub fn superscript(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).and_then(|digit| DIGITS.get(digit as usize)).copied().unwrap_or('⁻');
    power.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_told_by_what_a_reader_can_grasp() {
        let told = |error| error_told(Number(error), "ULP");
        assert_eq!(
            [0.0, 0.5, 3.25, 998.7, 12_345.6].map(told),
            ["0 ULP", "0.50 ULP", "3.25 ULP", "998.70 ULP", "12,346 ULP"]
        );
        assert_eq!(told(16_777_215.0), "16,777,215 ULP");
        assert_eq!(told(7.134e44), "more than 2²⁴ ULP, more than the number itself");
        assert_eq!([f64::INFINITY, f64::NAN].map(told), ["infinite", "no number"]);
        let cells = [7.134e44, 1_234.0, f64::INFINITY, 1e-4].map(|error| error_figure(Number(error)));
        assert_eq!(cells, ["> 2²⁴", "1,234", "∞", "1.0e-4"]);
    }

    #[test]
    fn a_distance_beyond_all_digits_is_a_difference() {
        let told = |error, value, reference| distance_told(Number(error), "ULP", Number(value), Number(reference));
        assert_eq!(told(3.0, 1.0, 1.0), "3.00 ULP from the reference");
        assert_eq!(told(7.134e44, 1.0, 0.0), "off by 1.000");
        assert_eq!(told(1e30, 2.0, 1e-12), "off by 2.000, about 10¹² times the reference");
        assert_eq!(told(1e8, 3.0, -1.0), "off by 4.000");
        assert_eq!(told(f64::NAN, f64::NAN, 1.0), "off by NaN");
    }
}
