//! What the language promises of a result, and whether bits are as promised.

use super::gives::Gives;
use lightmeter_scene::target::SENTINEL;

const SIGN: u32 = 1 << 31;

/// What the language promises of a result, by its bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Promise {
    /// This, to the last bit.
    Exactly(u32),
    /// One of these.
    OneOf(&'static [u32]),
    /// This, or a zero of either sign.
    KeptOrFlushed(u32),
    /// A number from the first to the second, or a zero of either sign: an inexact result below the normal numbers.
    NearOrFlushed(f32, f32),
    /// A zero of either sign.
    EitherZero,
    /// Nothing.
    Indeterminate,
}

impl Promise {
    /// Whether it says anything.
    #[must_use]
    pub const fn is_definite(self) -> bool {
        !matches!(self, Self::Indeterminate)
    }

    /// Whether a result is as promised. What was never written is not, whatever is promised.
    #[must_use]
    pub fn allows(self, bits: u32) -> bool {
        let is_zero = bits & !SIGN == 0;
        bits != SENTINEL
            && match self {
                Self::Exactly(promised) => bits == promised,
                Self::OneOf(promised) => promised.contains(&bits),
                Self::KeptOrFlushed(kept) => bits == kept || is_zero,
                Self::NearOrFlushed(low, high) => is_zero || (low..=high).contains(&f32::from_bits(bits)),
                Self::EitherZero => is_zero,
                Self::Indeterminate => true,
            }
    }

    /// The value that a result is compared with, and the least and the greatest that is promised: numbers of a float, words of
    /// another type. Where nothing is promised there is no such value, and anything lies between.
    #[must_use]
    pub fn bounds(self, gives: Gives) -> (f64, [f64; 2]) {
        let number = |bits: u32| gives.number(bits);
        match self {
            Self::Exactly(bits) => (number(bits), [number(bits); 2]),
            Self::OneOf(all) => {
                let ends = all
                    .iter()
                    .map(|&bits| number(bits))
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
                (all.first().map_or(f64::NAN, |&bits| number(bits)), ends)
            }
            Self::KeptOrFlushed(bits) => (number(bits), [number(bits).min(0.0), number(bits).max(0.0)]),
            Self::NearOrFlushed(low, high) => {
                let [low, high] = [f64::from(low), f64::from(high)];
                (f64::midpoint(low, high), [low.min(0.0), high.max(0.0)])
            }
            Self::EitherZero => (0.0, [0.0; 2]),
            Self::Indeterminate => (f64::NAN, [f64::NEG_INFINITY, f64::INFINITY]),
        }
    }

    /// In words, for a result of the type given.
    #[must_use]
    pub fn words(self, gives: Gives) -> String {
        let word = |bits: u32| gives.word(bits);
        match self {
            Self::Exactly(bits) => word(bits),
            Self::OneOf(all) => all.iter().map(|bits| word(*bits)).collect::<Vec<_>>().join(" or "),
            Self::KeptOrFlushed(bits) => format!("{} or flushed", word(bits)),
            Self::NearOrFlushed(low, high) => {
                format!("{} to {}, or flushed", word(low.to_bits()), word(high.to_bits()))
            }
            Self::EitherZero => "0 or -0".into(),
            Self::Indeterminate => "nothing".into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NANS: [u32; 5] = [0x7fc0_0000, 0xffc0_0000, 0x7fa0_0000, 0xffff_ffff, 0x7fc1_2345];

    #[test]
    fn a_nan_keeps_no_promise_of_a_number() {
        let promises = [
            Promise::Exactly(0),
            Promise::OneOf(&[0, 0x3f80_0000]),
            Promise::KeptOrFlushed(1),
            Promise::NearOrFlushed(0.0, f32::INFINITY),
            Promise::EitherZero,
        ];
        for promise in promises {
            for nan in NANS {
                assert!(!promise.allows(nan), "{promise:?} {nan:08x}");
            }
        }
        assert!(NANS.into_iter().all(|nan| Promise::Indeterminate.allows(nan)));
    }

    #[test]
    fn what_was_never_written_keeps_none() {
        for promise in [Promise::Indeterminate, Promise::Exactly(SENTINEL), Promise::OneOf(&[SENTINEL])] {
            assert!(!promise.allows(SENTINEL), "{promise:?}");
        }
    }

    #[test]
    fn each_promise_tells_its_own_from_the_next() {
        const ONE: u32 = 1.0_f32.to_bits();
        let rows: [(Promise, &[u32], &[u32]); 5] = [
            (Promise::Exactly(ONE), &[ONE], &[ONE + 1, 0]),
            (Promise::OneOf(&[ONE, 7]), &[ONE, 7], &[ONE - 1, 8, 0]),
            (Promise::KeptOrFlushed(5), &[5, 0, SIGN], &[4, 6, SIGN | 5]),
            (Promise::NearOrFlushed(f32::from_bits(4), f32::from_bits(9)), &[0, SIGN, 4, 9], &[3, 10, SIGN | 5]),
            (Promise::EitherZero, &[0, SIGN], &[1, ONE]),
        ];
        for (promise, kept, broken) in rows {
            assert!(kept.iter().all(|bits| promise.allows(*bits)), "{promise:?}");
            assert!(broken.iter().all(|bits| !promise.allows(*bits)), "{promise:?}");
        }
    }
}
