//! Logarithmic axes, with a band at an end for what has no logarithm.

use lightmeter_document::{superscript, thousands};
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use std::ops::Range;

/// An axis with the values that it is marked at.
#[derive(Clone, Debug)]
pub(super) struct Ticked {
    ends: [f64; 2],
    ticks: Vec<f64>,
}

impl Ranged for Ticked {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let share = (value - self.ends[0]) / (self.ends[1] - self.ends[0]);
        #[expect(clippy::cast_possible_truncation, reason = "a pixel")]
        let pixels = (share * f64::from(to - from)).round() as i32;
        from + pixels
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.ends[0]..self.ends[1]
    }
}

/// An axis of logarithms to base 10.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// The logarithms at the ends, but for the bands.
    low: f64,
    high: f64,
    has_zero: bool,
    has_infinite: bool,
}

/// What has no logarithm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Band {
    /// Where it begins and ends on the axis.
    pub(super) ends: [f64; 2],
    pub(super) name: &'static str,
}

impl Band {
    pub(super) fn holds(&self, at: f64) -> bool {
        (self.ends[0]..=self.ends[1]).contains(&at)
    }
}

/// The shortest axis, in powers of ten.
const LEAST: f64 = 0.7;
/// Free space at either end, and the width of a band, as parts of the axis.
const FREE: f64 = 0.06;
const BAND: f64 = 0.08;
/// Digits that a power of ten is multiplied by, from many to one.
const MANTISSAS: [&[f64]; 3] = [&[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0], &[1.0, 2.0, 5.0], &[1.0]];

impl Axis {
    /// Over all of these values.
    pub(super) fn over(values: impl Iterator<Item = f64>) -> Self {
        let mut axis = Self { low: f64::INFINITY, high: f64::NEG_INFINITY, has_zero: false, has_infinite: false };
        for value in values {
            if !value.is_finite() {
                axis.has_infinite = true;
            } else if value <= 0.0 {
                axis.has_zero = true;
            } else {
                (axis.low, axis.high) = (axis.low.min(value.log10()), axis.high.max(value.log10()));
            }
        }
        if axis.low > axis.high {
            (axis.low, axis.high) = (0.0, 0.0);
        }
        let free = (FREE * (axis.high - axis.low)).max((LEAST - (axis.high - axis.low)) / 2.0);
        Self { low: axis.low - free, high: axis.high + free, ..axis }
    }

    fn band(&self) -> f64 {
        BAND * (self.high - self.low)
    }

    /// The bands, where they are needed.
    pub(super) fn bands(&self) -> Vec<Band> {
        let zero = Band { ends: [self.low - self.band(), self.low], name: "0" };
        let infinite = Band { ends: [self.high, self.high + self.band()], name: "∞" };
        [self.has_zero.then_some(zero), self.has_infinite.then_some(infinite)].into_iter().flatten().collect()
    }

    /// Both ends, the bands included.
    pub(super) fn ends(&self) -> [f64; 2] {
        let band = |is_there: bool| if is_there { self.band() } else { 0.0 };
        [self.low - band(self.has_zero), self.high + band(self.has_infinite)]
    }

    /// Where a value stands.
    pub(super) fn at(&self, value: f64) -> f64 {
        if !value.is_finite() {
            self.high + self.band() / 2.0
        } else if value <= 0.0 {
            self.low - self.band() / 2.0
        } else {
            value.log10().clamp(self.low, self.high)
        }
    }

    /// The axis, marked at round values, at most `most` of them, and in its bands.
    pub(super) fn ticked(&self, most: usize) -> Ticked {
        let [low, high] = self.ends();
        let bands = self.bands().into_iter().map(|band| f64::midpoint(band.ends[0], band.ends[1]));
        let ticks = self.round(most).into_iter().map(f64::log10);
        Ticked { ends: [low, high], ticks: ticks.chain(bands).collect() }
    }

    /// Round values, as many as there are, but `most` at most; of less than a power of ten also 1.5, 3, 4 and 7.
    fn round(&self, most: usize) -> Vec<f64> {
        let Self { low, high, .. } = *self;
        #[expect(clippy::cast_possible_truncation, reason = "powers of ten of an f64")]
        let (first, last) = (low.floor() as i32, high.ceil() as i32);
        let within = |value: &f64| (low..=high).contains(&value.log10());
        let by = |mantissas: &[f64], step: i32| -> Vec<f64> {
            let powers = (first..=last).filter(|power| power.rem_euclid(step) == 0);
            let of = |power: i32| mantissas.iter().map(move |mantissa| decimal(*mantissa, power)).collect::<Vec<_>>();
            powers.flat_map(of).filter(within).collect()
        };
        let enough = usize::from(high - low >= 1.0);
        let fine = MANTISSAS[enough..].iter().map(|mantissas| by(mantissas, 1));
        let coarse = [2, 3, 5, 10, 20, 50, 100].into_iter().map(|step| by(&[1.0], step));
        fine.chain(coarse).find(|ticks| ticks.len() <= most).unwrap_or_default()
    }
}

/// The f64 that is nearest to it as it is written: 3e-1 and not 3 · 0.1.
fn decimal(mantissa: f64, power: i32) -> f64 {
    format!("{mantissa}e{power}").parse().unwrap_or(f64::NAN)
}

/// `0.5`, `1`, `100`, `10⁴`, `2·10⁻³`.
pub(crate) fn power(value: f64) -> String {
    let value: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    if (1e-2..1e4).contains(&value) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 10⁴")]
        return if value < 1e3 { value.to_string() } else { thousands(value.round() as u64) };
    }
    let written = format!("{value:e}");
    let (mantissa, power) = written.split_once('e').unwrap_or((&written, "0"));
    let power = superscript(power.parse().unwrap_or_default());
    if mantissa == "1" { format!("10{power}") } else { format!("{mantissa}·10{power}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        let over =
            |low: f64, high: f64| Axis { low: low.log10(), high: high.log10(), has_zero: false, has_infinite: false };
        let named = |axis: Axis, most| axis.round(most).into_iter().map(power).collect::<Vec<_>>().join(" ");
        assert_eq!(named(over(0.5, 2.1), 8), "0.5 0.7 1 1.5 2");
        assert_eq!(named(over(0.5, 900.0), 5), "1 10 100");
        assert_eq!(named(over(1e-4, 2e5), 10), "10⁻⁴ 10⁻³ 0.01 0.1 1 10 100 1,000 10⁴ 10⁵");
        assert_eq!(named(over(1e-3, 5e-3), 8), "10⁻³ 1.5·10⁻³ 2·10⁻³ 3·10⁻³ 4·10⁻³ 5·10⁻³");
        assert_eq!(named(over(0.1, 1e45), 8), "1 10¹⁰ 10²⁰ 10³⁰ 10⁴⁰");
    }

    #[test]
    fn every_value_has_a_place_and_what_has_no_logarithm_a_band() {
        let axis = Axis::over([0.0, 1.0, 100.0, f64::NAN].into_iter());
        let places = [0.0, 1.0, 10.0, 100.0, f64::INFINITY].map(|value| axis.at(value));
        assert!(places.is_sorted_by(|low, high| low < high), "{places:?}");
        let [zero, infinite] = axis.bands()[..] else { panic!("two bands") };
        assert!(
            places[4] > axis.high
                && zero.holds(places[0])
                && infinite.holds(places[4])
                && infinite.holds(axis.at(f64::NAN))
        );
        assert!(!zero.holds(places[1]) && !infinite.holds(places[3]), "numbers are in no band");
        let [low, high] = axis.ends();
        assert!(places.iter().all(|place| (low..=high).contains(place)));
        assert!(Axis::over([2.0].into_iter()).bands().is_empty());
    }
}
