//! What is legal, and what an answer is worth. Here a single verdict: a value against the reference and the interval of legal values.
//! `formula` has the verdicts on the cases of formulas, `blend_unit` and `image` those on pixels, `tally` and `cases` what they come to, `sample` which
//! rows are kept for a diagnosis, which is asked through `diagnose`, `devices` what is known of drivers.

pub mod blend_unit;
pub mod cases;
pub mod chunk;
pub mod devices;
pub mod diagnose;
pub mod formula;
pub mod image;
pub mod kept;
pub mod packed;
pub mod sample;
pub mod special;
pub mod stability;
pub mod tally;

pub use lightmeter_document::{is_worse, worse};

use lightmeter_arithmetic::format::error_ulp;
use lightmeter_arithmetic::{Accept, F32};
use lightmeter_scene::target::SENTINEL;

/// What became of one scalar output of one case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Inside the interval.
    Pass,
    /// Outside.
    Fail,
    /// The rules permit anything here: not a pass.
    Indeterminate,
}

impl Outcome {
    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Indeterminate => "indeterminate",
        }
    }
}

/// A verdict.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Inside or outside.
    pub outcome: Outcome,
    /// The error against the reference in ULP of the output's format, or in its steps where that is of 8 bits.
    pub error: f64,
    /// The distance from the reference over the distance to the interval's end on the value's side: above 1 outside.
    pub margin: f64,
}

/// Judges a value by its bits. An output that was never written fails, even where anything is legal.
#[must_use]
pub fn judge(bits: u32, reference: f64, interval: &Accept) -> Verdict {
    let value = f32::from_bits(bits);
    let error = error_ulp::<F32>(value, reference);
    if bits == SENTINEL {
        return Verdict { outcome: Outcome::Fail, error: f64::INFINITY, margin: f64::INFINITY };
    }
    if interval.is_any() {
        return Verdict { outcome: Outcome::Indeterminate, error, margin: 0.0 };
    }
    let value = f64::from(value);
    // Beside a reference that is no number nothing passes, whatever is legal.
    let outcome = if interval.contains(value) && !reference.is_nan() { Outcome::Pass } else { Outcome::Fail };
    Verdict { outcome, error, margin: margin(value, reference, interval.low(), interval.high()) }
}

/// The distance from the reference over the distance to the end of the interval on the value's side. It is never NaN: beside
/// a NaN it is infinite, and 1 where the interval's end is infinite and the value is that.
#[inline]
pub fn margin(value: f64, reference: f64, low: f64, high: f64) -> f64 {
    let distance = (value - reference).abs();
    // 0/0 is 0: exactly right where nothing else is legal.
    if distance == 0.0 {
        return 0.0;
    }
    if distance < f64::INFINITY {
        return distance / room(value, reference, low, high);
    }
    margin_beyond(value, reference, low, high)
}

/// The distance from the reference to the end of the interval on the value's side.
#[inline]
fn room(value: f64, reference: f64, low: f64, high: f64) -> f64 {
    (if value >= reference { high - reference } else { reference - low }).max(0.0)
}

/// The margin where the value and the reference are infinitely far from each other, the same infinity, or a NaN is one of them.
fn margin_beyond(value: f64, reference: f64, low: f64, high: f64) -> f64 {
    if value.is_nan() || reference.is_nan() {
        return f64::INFINITY;
    }
    if value.is_infinite() {
        let within = (low..=high).contains(&value);
        return if value.to_bits() == reference.to_bits() {
            0.0
        } else if within {
            1.0
        } else {
            f64::INFINITY
        };
    }
    let margin = (value - reference).abs() / room(value, reference, low, high);
    // From an infinite reference all that is finite is as far away as the end of the interval.
    if margin.is_nan() { 1.0 } else { margin }
}

/// How much inputs take to write down: the fewer, the simpler a case.
#[must_use]
pub fn simplicity(inputs: &[f32]) -> u32 {
    let digits = |x: f32| match x.abs() {
        0.0 => 0,
        1.0 => 1,
        x if x.is_finite() => 26 - x.to_bits().trailing_zeros().min(23),
        _ => 64,
    };
    inputs.iter().map(|&x| digits(x)).sum()
}

/// In which order failing cases explain most, the least first: ordinary inputs before hard ones, and then the simplest.
#[must_use]
pub fn telling(inputs: &[f32], is_random: bool) -> u32 {
    simplicity(inputs) | u32::from(!is_random) << 31
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(value: f32, interval: Accept) -> Outcome {
        judge(value.to_bits(), 1.0, &interval).outcome
    }

    #[test]
    fn values_are_told_inside_from_outside() {
        let interval = Accept::from_bounds(0.5, 2.0);
        assert_eq!(outcome(1.0, interval), Outcome::Pass);
        assert_eq!(outcome(2.0, interval), Outcome::Pass);
        assert_eq!(outcome(2.0_f32.next_up(), interval), Outcome::Fail);
        assert_eq!(outcome(f32::NAN, interval), Outcome::Fail);
        assert_eq!(outcome(f32::INFINITY, interval), Outcome::Fail);
        assert_eq!(outcome(f32::NAN, Accept::ANY), Outcome::Indeterminate);
    }

    #[test]
    fn outcomes_have_the_names_of_reports() {
        let names = [Outcome::Pass, Outcome::Fail, Outcome::Indeterminate].map(Outcome::name);
        assert_eq!(names, ["pass", "fail", "indeterminate"]);
    }

    /// The digits of a number in binary, with 0 and ±1 the simplest and what is no number the least simple.
    #[test]
    fn the_fewer_digits_the_simpler() {
        for (input, digits) in
            [(0.0, 0), (-0.0, 0), (1.0, 1), (-1.0, 1), (2.0, 3), (0.5, 3), (1.5, 4), (1.25, 5), (0.1, 26)]
        {
            assert_eq!(simplicity(&[input]), digits, "{input}");
        }
        for input in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(simplicity(&[input]), 64, "{input}");
        }
        assert_eq!(simplicity(&[1.0, 1.5, 0.0]), 5);
    }

    #[test]
    fn ordinary_inputs_tell_more_than_hard_ones() {
        assert_eq!(telling(&[1.5], true), 4);
        assert_eq!(telling(&[1.5], false), 4 + (1 << 31));
        assert!(telling(&[f32::NAN; 9], true) < telling(&[0.0], false));
    }

    #[test]
    fn what_was_never_written_fails() {
        for interval in [Accept::ANY, Accept::from_bounds(0.0, 1.0)] {
            assert_eq!(judge(SENTINEL, 0.0, &interval).outcome, Outcome::Fail);
        }
    }

    #[test]
    fn no_nan_is_legal_whatever_its_bits() {
        for bits in [0x7fc0_0000, 0xffc0_0000, 0x7fa0_0001, 0xffff_ffff, 0x7fc1_2345] {
            for interval in [Accept::from_bounds(0.5, 2.0), Accept::from_bounds(0.0, 0.0)] {
                let verdict = judge(bits, 1.0, &interval);
                assert_eq!(verdict.outcome, Outcome::Fail, "{bits:08x}");
                assert!(verdict.margin == f64::INFINITY && verdict.error == f64::INFINITY, "{bits:08x}");
            }
            assert_eq!(judge(bits, 1.0, &Accept::ANY).outcome, Outcome::Indeterminate, "{bits:08x}");
            assert_eq!(judge(bits, f64::NAN, &Accept::from_bounds(0.5, 2.0)).outcome, Outcome::Fail, "{bits:08x}");
        }
    }

    #[test]
    fn a_reference_that_is_no_number_passes_nothing() {
        let verdict = judge(1.0_f32.to_bits(), f64::NAN, &Accept::from_bounds(0.5, 2.0));
        assert_eq!(verdict.outcome, Outcome::Fail);
        assert!(verdict.margin == f64::INFINITY && verdict.error == f64::INFINITY);
    }

    #[test]
    fn a_margin_is_never_nan() {
        let (inf, nan, most) = (f64::INFINITY, f64::NAN, 65_504.0);
        let rows = [
            // What is too great for a format is infinite or its greatest number.
            (inf, 120_000.0, most, inf, 1.0),
            (-inf, -120_000.0, -inf, -most, 1.0),
            (inf, inf, most, inf, 0.0),
            (most, inf, most, inf, 1.0),
            (inf, 1.0, 0.0, 2.0, inf),
            (-inf, 120_000.0, most, inf, inf),
            (nan, 120_000.0, most, inf, inf),
            (1.0, nan, 0.0, 2.0, inf),
            (nan, nan, 0.0, 2.0, inf),
        ];
        for (value, reference, low, high, expected) in rows {
            let found = margin(value, reference, low, high);
            assert!(found.to_bits() == expected.to_bits(), "{value} beside {reference}: {found}");
        }
    }

    #[test]
    fn the_margin_is_taken_on_the_values_side() {
        let interval = Accept::from_bounds(0.0, 5.0);
        let margin = |value: f32| judge(value.to_bits(), 1.0, &interval).margin;
        assert!((margin(3.0) - 0.5).abs() < 1e-12);
        assert!((margin(0.5) - 0.5).abs() < 1e-12);
        assert!(margin(1.0) == 0.0 && margin(6.0) > 1.0 && margin(f32::NAN) == f64::INFINITY);
    }
}
