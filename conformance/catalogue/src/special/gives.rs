//! The type of a probe's result: its bits as a number, and in words.

use lightmeter_document::Number;
use lightmeter_scene::target::SENTINEL;

/// What type a result has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gives {
    /// f32.
    Float,
    /// u32, or the bits of an i32.
    Word,
    /// Whether a comparison holds: 1 or 0.
    Truth,
}

impl Gives {
    /// A result as a number: of a float its value, of another type the word.
    #[must_use]
    pub fn number(self, bits: u32) -> f64 {
        if self == Self::Float { f32::from_bits(bits).into() } else { bits.into() }
    }

    /// A result in few letters.
    #[must_use]
    pub fn word(self, bits: u32) -> String {
        match self {
            _ if bits == SENTINEL => "never written".into(),
            Self::Truth if bits < 2 => ["false", "true"][bits as usize].into(),
            Self::Word | Self::Truth => format!("0x{bits:x}"),
            Self::Float => match f32::from_bits(bits) {
                x if x.is_nan() => format!("NaN 0x{bits:08x}"),
                x if x == 0.0 || x.is_infinite() => {
                    // `Number` drops the sign of a NaN alone.
                    Number(x.into()).to_string()
                }
                x if x.abs() >= f32::MAX => if x > 0.0 { "greatest" } else { "-greatest" }.into(),
                x if (1e-4..1e7).contains(&x.abs()) => x.to_string(),
                x => format!("{x:e}"),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_written_in_few_letters() {
        let rows = [
            (Gives::Float, 0x7fc0_0001, "NaN 0x7fc00001"),
            (Gives::Float, 0xff80_0000, "-Inf"),
            (Gives::Float, (-0.0_f32).to_bits(), "-0"),
            (Gives::Float, 1, "1e-45"),
            (Gives::Float, f32::MAX.to_bits(), "greatest"),
            (Gives::Truth, 1, "true"),
            (Gives::Truth, 2, "0x2"),
            (Gives::Word, u32::MAX, "0xffffffff"),
            (Gives::Word, SENTINEL, "never written"),
        ];
        for (gives, bits, word) in rows {
            assert_eq!(gives.word(bits), word);
        }
    }
}
