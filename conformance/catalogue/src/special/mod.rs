//! NaN, infinity, subnormals and signed zero in shader arithmetic: what the language promises, and what each driver does.
//!
//! A *probe* is one operation on stated operands, evaluated in the compute and in the fragment stage, or carried through the
//! rasteriser. Where the language promises something definite, another result is a broken promise. Where it promises nothing
//! the result is indeterminate. Either way it is compared with what is on record for that driver: a renderer that depends
//! on it should know when it changes. Blending has a policy of its own, in `blend_unit/policy.rs`.

mod table;

pub use table::PROBES;

use lightmeter_document::Number;
use lightmeter_scene::target::SENTINEL;

/// The first segment of the ids.
pub const FAMILY: &str = "special";

/// What a probe is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// NaN given, or what has no value.
    Nan,
    /// Infinity given, or overflow.
    Infinity,
    /// Subnormals given, or underflow.
    Subnormal,
    /// The sign of zero.
    SignedZero,
    /// Which neighbour a rounded result is.
    Rounding,
}

impl Class {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 5] = [Self::Nan, Self::Infinity, Self::Subnormal, Self::SignedZero, Self::Rounding];

    /// The name in ids: `special/nan/nan-plus-one`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nan => "nan",
            Self::Infinity => "infinity",
            Self::Subnormal => "subnormal",
            Self::SignedZero => "signed-zero",
            Self::Rounding => "rounding",
        }
    }

    /// The heading in reports.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Nan => "NaN",
            Self::Infinity => "Infinity and overflow",
            Self::Subnormal => "Subnormals and underflow",
            Self::SignedZero => "The sign of zero",
            Self::Rounding => "Rounding",
        }
    }
}

/// Where a promise, or the lack of one, is stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// There may be assumed to be neither overflow, infinity nor NaN.
    FiniteMath,
    /// Inputs and outputs of operations may be flushed to zero, and what passes through a bitcast.
    Flush,
    /// The sign of a zero may be ignored.
    ZeroSign,
    /// The table of accuracies: outside a domain named there nothing is promised.
    Accuracy,
    /// Fusion, where it is at least as accurate.
    Fusion,
    /// Conversions.
    Conversion,
    /// The reinterpretation of bits.
    Bitcast,
    /// Packing and unpacking.
    Packing,
    /// A choice between values, which computes nothing.
    Selection,
}

impl Source {
    /// The section.
    #[must_use]
    pub const fn section(self) -> &'static str {
        match self {
            Self::FiniteMath | Self::Flush | Self::ZeroSign => "WGSL §15.7.2",
            Self::Accuracy => "WGSL §15.7.4",
            Self::Fusion => "WGSL §15.7.5",
            Self::Conversion => "WGSL §15.7.6",
            Self::Bitcast => "WGSL §17.2.1",
            Self::Packing => "WGSL §17.9",
            Self::Selection => "WGSL §17.3",
        }
    }

    /// What it says.
    #[must_use]
    pub const fn says(self) -> &'static str {
        match self {
            Self::FiniteMath => {
                "overflow, infinity and NaN may be assumed absent: where one is present the result is an indeterminate value"
            }
            Self::Flush => {
                "subnormals may be flushed to zero as inputs and outputs of an operation, and on their way through a bitcast"
            }
            Self::ZeroSign => "the sign of a zero may be ignored",
            Self::Accuracy => {
                "accuracy is promised on a domain; a function that inherits it from an expression inherits the expression's domain"
            }
            Self::Fusion => "operations may be fused where that is at least as accurate; fma need not be",
            Self::Conversion => {
                "a float is clamped to the range of an integer; an integer between two floats may become either"
            }
            Self::Bitcast => "bits of a NaN or an infinity become an indeterminate value of a float type",
            Self::Packing => {
                "a component that binary16 cannot hold is an indeterminate value; a subnormal may be flushed"
            }
            Self::Selection => "one of two values is taken as it is",
        }
    }

    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::FiniteMath,
        Self::Flush,
        Self::ZeroSign,
        Self::Accuracy,
        Self::Fusion,
        Self::Conversion,
        Self::Bitcast,
        Self::Packing,
        Self::Selection,
    ];
}

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

const SIGN: u32 = 1 << 31;

/// How a probe is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// A function of `special.wgsl`, in the compute and in the fragment stage.
    Function(&'static str),
    /// A value that every vertex of a primitive has, read from its fragment.
    Varying {
        /// Flat, or else interpolated.
        flat: bool,
    },
}

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

/// A promise that is known to be broken.
#[derive(Clone, Copy, Debug)]
pub struct Deviation {
    /// Its name in reports.
    pub name: &'static str,
    /// Of which interface.
    pub backend: &'static str,
    /// Of which probes.
    pub probes: &'static [&'static str],
    /// Why.
    pub reason: &'static str,
}

/// Every promise that is known to be broken. Where a record binds, it also says by which value.
pub const DEVIATIONS: &[Deviation] = &[Deviation {
    name: "gl-unclamped-conversions",
    backend: "gl",
    probes: &["negative-to-u32", "too-large-to-u32", "too-large-to-i32", "too-small-to-i32"],
    reason: "naga 30 clamps a float before it becomes an integer in SPIR-V, not in GLSL, where a value out of range is undefined",
}];

impl Deviation {
    /// What is known of a probe on an interface.
    #[must_use]
    pub fn of(probe: &Probe, backend: &str) -> Option<&'static Self> {
        DEVIATIONS.iter().find(|deviation| deviation.backend == backend && deviation.probes.contains(&probe.name))
    }
}

/// One operation on stated operands.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    /// Its name.
    pub name: &'static str,
    /// What it is about.
    pub class: Class,
    /// What is computed, for people.
    pub what: &'static str,
    /// How.
    pub way: Way,
    /// The operands' bits.
    pub inputs: &'static [u32],
    /// The result's type.
    pub gives: Gives,
    /// What is promised.
    pub promise: Promise,
    /// By which rule.
    pub source: Source,
}

impl Probe {
    /// Its id: `special/nan/nan-plus-one`.
    #[must_use]
    pub fn id(&self) -> String {
        format!("{FAMILY}/{}/{}", self.class.name(), self.name)
    }

    /// The probe of that id.
    #[must_use]
    pub fn by_id(id: &str) -> Option<&'static Self> {
        PROBES.iter().find(|probe| probe.id() == id)
    }

    /// The probe of that name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Self> {
        PROBES.iter().find(|probe| probe.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::Accept;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_reference::Real;

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

    /// Where the acceptance intervals know an operation, table and intervals say the same.
    #[test]
    fn promises_agree_with_the_intervals() {
        let mut compared = 0;
        for probe in PROBES {
            let Way::Function(function) = probe.way else { continue };
            if probe.inputs.iter().any(|bits| !f32::from_bits(*bits).is_finite()) {
                continue;
            }
            let x: Vec<Accept> = probe.inputs.iter().map(|bits| Accept::input(f32::from_bits(*bits))).collect();
            let interval = WGSL.scope(|| {
                Some(match function {
                    "special_add" => x[0] + x[1],
                    "special_subtract" => x[0] - x[1],
                    "special_multiply" => x[0] * x[1],
                    "special_divide" => x[0] / x[1],
                    "special_multiply_add" => x[0] * x[1] + x[2],
                    "special_sqrt" => x[0].sqrt(),
                    "special_inverse_sqrt" => x[0].inverse_sqrt(),
                    "special_exp" => x[0].exp(),
                    "special_exp2" => x[0].exp2(),
                    "special_pow" => x[0].pow(x[1]),
                    "special_mix" => Accept::mix(x[0], x[1], x[2]),
                    _ => return None,
                })
            });
            let Some(interval): Option<Accept> = interval else { continue };
            compared += 1;
            let name = probe.name;
            assert_eq!(interval.is_any(), !probe.promise.is_definite(), "{name}: {interval:?}");
            let legal = |bits: u32| interval.contains(f32::from_bits(bits).into());
            match probe.promise {
                Promise::Exactly(bits) => assert!(legal(bits), "{name}"),
                Promise::OneOf(all) => assert!(all.iter().all(|bits| legal(*bits)), "{name}: {interval:?}"),
                Promise::KeptOrFlushed(bits) => assert!(legal(bits) && legal(0), "{name}: {interval:?}"),
                Promise::NearOrFlushed(low, high) => {
                    assert!(legal(low.to_bits()) && legal(high.to_bits()) && legal(0), "{name}: {interval:?}");
                }
                Promise::EitherZero => assert!(legal(0), "{name}: {interval:?}"),
                Promise::Indeterminate => {}
            }
        }
        assert!(compared >= 30, "{compared} probes were compared");
    }

    #[test]
    fn deviations_name_probes_that_are_promised_something() {
        for name in DEVIATIONS.iter().flat_map(|deviation| deviation.probes) {
            let probe = Probe::by_name(name).unwrap_or_else(|| panic!("no probe {name}"));
            assert!(probe.promise.is_definite(), "{name}");
            assert!(Deviation::of(probe, "gl").is_some() && Deviation::of(probe, "vulkan").is_none(), "{name}");
        }
    }

    #[test]
    fn results_are_written_in_few_letters() {
        let rows = [
            (Gives::Float, 0x7fc0_0001, "NaN 0x7fc00001"),
            (Gives::Float, 0xff80_0000, "-Inf"),
            (Gives::Float, SIGN, "-0"),
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
