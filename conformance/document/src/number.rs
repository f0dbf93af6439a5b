//! Numbers in JSON.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;

/// A number that may be NaN or infinite, which JSON writes as a string.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Number(pub f64);

impl Number {
    /// The number as f32 has it, with the digits that tell it from its neighbours there, where it is one of f32; else all digits.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, clippy::float_cmp, reason = "whether it is one is what is asked")]
    pub fn narrow(self) -> String {
        let narrow = self.0 as f32;
        match narrow.abs() {
            _ if f64::from(narrow) != self.0 => self.to_string(),
            size if size == 0.0 || (1e-4..1e7).contains(&size) => format!("{narrow}"),
            _ if narrow.is_finite() => format!("{narrow:e}"),
            _ => self.to_string(),
        }
    }

    /// The number in four digits, for people.
    #[must_use]
    pub fn brief(self) -> String {
        let x = self.0;
        match x.abs() {
            size if !size.is_finite() || size == 0.0 => self.to_string(),
            size if !(1e-3..1e6).contains(&size) => format!("{x:.3e}"),
            size => {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most six")]
                let decimals = (3.0 - size.log10().floor()).max(0.0) as usize;
                format!("{x:.decimals$}")
            }
        }
    }
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() { serializer.serialize_f64(self.0) } else { serializer.serialize_str(&self.to_string()) }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Number(f64),
            Name(String),
        }
        match Written::deserialize(deserializer)? {
            Written::Number(number) => Ok(Self(number)),
            Written::Name(name) => match name.as_str() {
                "NaN" => Ok(Self(f64::NAN)),
                "Inf" => Ok(Self(f64::INFINITY)),
                "-Inf" => Ok(Self(f64::NEG_INFINITY)),
                _ => Err(serde::de::Error::custom(format!("expected a number, NaN, Inf or -Inf, not {name:?}"))),
            },
        }
    }
}

impl JsonSchema for Number {
    fn schema_name() -> Cow<'static, str> {
        "Number".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number that may be NaN or infinite, which JSON writes as a string.",
            "anyOf": [{ "type": "number" }, { "enum": ["NaN", "Inf", "-Inf"] }]
        })
    }
}

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            x if x.is_nan() => f.write_str("NaN"),
            x if x == f64::INFINITY => f.write_str("Inf"),
            x if x == f64::NEG_INFINITY => f.write_str("-Inf"),
            x if x == 0.0 || (1e-4..1e7).contains(&x.abs()) => write!(f, "{x}"),
            x => write!(f, "{x:e}"),
        }
    }
}

/// 1234567 as 1,234,567.
#[must_use]
pub fn thousands(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Whether a margin or an error is worse than another: a NaN is worse than every number, so that no maximum loses one.
#[inline]
#[must_use]
pub fn is_worse(a: f64, than: f64) -> bool {
    !than.is_nan() && (a.is_nan() || a > than)
}

/// The worse of two.
#[inline]
#[must_use]
pub fn worse(a: f64, b: f64) -> f64 {
    if is_worse(b, a) { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped() {
        assert_eq!([0, 999, 1000, 1_234_567].map(thousands), ["0", "999", "1,000", "1,234,567"]);
    }

    #[test]
    fn numbers_of_f32_have_the_digits_of_f32() {
        let shown = [0.1, f64::from(0.1_f32), 1e-40, f64::from(1e-40_f32), f64::INFINITY, -0.5, 3e9]
            .map(|x| Number(x).narrow());
        assert_eq!(shown, ["0.1", "0.1", "1e-40", "1e-40", "Inf", "-0.5", "3e9"]);
    }

    #[test]
    fn numbers_for_people_have_four_digits() {
        let shown = [0.0, 12.345_678, 0.012_345_6, 123_456.7, 1e-5, 1.0, f64::NAN].map(|x| Number(x).brief());
        assert_eq!(shown, ["0", "12.35", "0.01235", "123457", "1.000e-5", "1.000", "NaN"]);
    }

    #[test]
    fn no_maximum_loses_a_nan() {
        for values in [[f64::NAN, 1.0, 2.0], [1.0, f64::NAN, 2.0], [1.0, 2.0, f64::NAN]] {
            assert!(values.into_iter().fold(0.0, worse).is_nan(), "{values:?}");
        }
        for (a, b, expected) in [(1.0, 2.0, 2.0_f64), (2.0, 1.0, 2.0), (f64::INFINITY, 1.0, f64::INFINITY)] {
            assert_eq!(worse(a, b).to_bits(), expected.to_bits());
        }
    }
}
