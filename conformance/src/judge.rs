//! One verdict: a value against the reference and the interval of legal values.

use crate::arithmetic::format::error_ulp;
use crate::arithmetic::{Accept, F32};
use lightmeter_gpu::SENTINEL;

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

/// A verdict.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Inside or outside.
    pub outcome: Outcome,
    /// The error against the reference in ULP of the output's format.
    pub error_ulp: f64,
    /// The distance from the reference over the distance to the interval's end on the value's side: above 1 outside.
    pub margin: f64,
}

/// Judges a value by its bits. An output that was never written fails, even where anything is legal.
#[must_use]
pub fn judge(bits: u32, reference: f64, interval: &Accept) -> Verdict {
    let value = f32::from_bits(bits);
    let error_ulp = error_ulp::<F32>(value, reference);
    if bits == SENTINEL {
        return Verdict { outcome: Outcome::Fail, error_ulp: f64::INFINITY, margin: f64::INFINITY };
    }
    if interval.is_any() {
        return Verdict { outcome: Outcome::Indeterminate, error_ulp, margin: 0.0 };
    }
    let value = f64::from(value);
    let outcome = if interval.contains(value) { Outcome::Pass } else { Outcome::Fail };
    Verdict { outcome, error_ulp, margin: margin(value, reference, interval.low(), interval.high()) }
}

/// The distance from the reference over the distance to the end of the interval on the value's side.
pub(crate) fn margin(value: f64, reference: f64, low: f64, high: f64) -> f64 {
    if value.is_nan() {
        return f64::INFINITY;
    }
    let distance = (value - reference).abs();
    let room = if value >= reference { high - reference } else { reference - low };
    // 0/0 is 0: exactly right where nothing else is legal.
    if distance == 0.0 { 0.0 } else { distance / room.max(0.0) }
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
    fn what_was_never_written_fails() {
        for interval in [Accept::ANY, Accept::from_bounds(0.0, 1.0)] {
            assert_eq!(judge(SENTINEL, 0.0, &interval).outcome, Outcome::Fail);
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
