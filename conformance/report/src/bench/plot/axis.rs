//! Logarithmic axes, with a band at the end of an axis of errors for what has no logarithm.

/// A logarithmic axis from one pixel to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// Powers of ten at the ends.
    powers: [f64; 2],
    pixels: [f64; 2],
}

/// Digits that a power of ten is multiplied by, from many to one.
const MANTISSAS: [&[f64]; 3] = [&[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0], &[1.0, 2.0, 5.0], &[1.0]];

impl Axis {
    /// Over all values that have a logarithm, with some room beside them; at least `span` powers of ten.
    pub(super) fn over(values: impl Iterator<Item = f64>, span: f64, pixels: [f64; 2]) -> Self {
        let has_logarithm = |value: &f64| value.is_finite() && *value > 0.0;
        let ends = |[low, high]: [f64; 2], power: f64| [low.min(power), high.max(power)];
        let [low, high] = values.filter(has_logarithm).map(f64::log10).fold([f64::INFINITY, f64::NEG_INFINITY], ends);
        let [low, high] = if low > high { [0.0, 0.0] } else { [low, high] };
        let room = (0.07 * (high - low)).max((span - (high - low)) / 2.0);
        Self { powers: [low - room, high + room], pixels }
    }

    /// The pixel of a value: of 0 and less where the axis begins.
    pub(super) fn at(&self, value: f64) -> f64 {
        let ([low, high], [start, end]) = (self.powers, self.pixels);
        let share = if value > 0.0 { ((value.log10() - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
        start + share * (end - start)
    }

    pub(super) const fn pixels(&self) -> [f64; 2] {
        self.pixels
    }

    /// The values at the ends.
    pub(super) fn ends(&self) -> [f64; 2] {
        self.powers.map(|power| 10_f64.powf(power))
    }

    /// Round values on the axis, as many as there are, but `most` at most; of less than a power of ten also 1.5, 3, 4 and 7.
    pub(super) fn ticks(&self, most: usize) -> Vec<f64> {
        let [low, high] = self.powers;
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
pub(super) fn tick(value: f64) -> String {
    if (1e-2..1e4).contains(&value) {
        return value.to_string();
    }
    let written = format!("{value:e}");
    let (mantissa, power) = written.split_once('e').unwrap_or((&written, "0"));
    let power: String = power.chars().map(raised).collect();
    if mantissa == "1" { format!("10{power}") } else { format!("{mantissa}·10{power}") }
}

fn raised(digit: char) -> char {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    digit.to_digit(10).map_or('⁻', |digit| RAISED[digit as usize])
}

/// The axis of errors, upward: a band at the bottom for 0, one at the top for what is infinite or no number.
#[derive(Clone, Copy, Debug)]
pub(super) struct ErrorAxis {
    pub(super) axis: Axis,
    /// The pixels of the middle of each band, where it is needed.
    pub(super) zero: Option<f64>,
    pub(super) infinite: Option<f64>,
    /// The pixels of a band from its middle to its side.
    pub(super) half: f64,
}

impl ErrorAxis {
    pub(super) fn over(errors: impl Iterator<Item = f64> + Clone, [top, bottom]: [f64; 2], half: f64) -> Self {
        let has_zero = errors.clone().any(|error| error <= 0.0);
        let has_infinite = errors.clone().any(|error| !error.is_finite());
        let space = 2.0 * half + 6.0;
        let start = if has_zero { bottom - space } else { bottom };
        let end = if has_infinite { top + space } else { top };
        Self {
            axis: Axis::over(errors, 1.0, [start, end]),
            zero: has_zero.then_some(bottom - half),
            infinite: has_infinite.then_some(top + half),
            half,
        }
    }

    pub(super) fn at(&self, error: f64) -> f64 {
        match (self.zero, self.infinite) {
            (Some(zero), _) if error <= 0.0 => zero,
            (_, Some(infinite)) if !error.is_finite() => infinite,
            _ => self.axis.at(error),
        }
    }

    /// Where one of many points is put: in a band, spread over it.
    pub(super) fn at_place(&self, error: f64, place: usize) -> f64 {
        let has_band = error <= 0.0 || !error.is_finite();
        let steps = f64::from(u8::try_from(place * 5 % 7).unwrap_or_default()) - 3.0;
        self.at(error) + if has_band { steps * self.half * 0.22 } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        let over = |low: f64, high: f64| Axis { powers: [low.log10(), high.log10()], pixels: [0.0, 100.0] };
        let named = |axis: Axis, most| axis.ticks(most).into_iter().map(tick).collect::<Vec<_>>().join(" ");
        assert_eq!(named(over(0.5, 2.1), 8), "0.5 0.7 1 1.5 2");
        assert_eq!(named(over(0.5, 900.0), 5), "1 10 100");
        assert_eq!(named(over(1e-4, 2e5), 10), "10⁻⁴ 10⁻³ 0.01 0.1 1 10 100 1000 10⁴ 10⁵");
        assert_eq!(named(over(1e-3, 5e-3), 8), "10⁻³ 1.5·10⁻³ 2·10⁻³ 3·10⁻³ 4·10⁻³ 5·10⁻³");
        assert_eq!(named(over(0.1, 1e45), 8), "1 10¹⁰ 10²⁰ 10³⁰ 10⁴⁰");
    }

    #[test]
    fn every_value_has_a_place_on_the_axis() {
        let axis = Axis::over([1.0, 100.0].into_iter(), 1.0, [50.0, 150.0]);
        let places =
            [f64::NEG_INFINITY, -3.0, 0.0, 1e-9, 1e9, f64::INFINITY, f64::NAN].map(|value| axis.at(value).to_bits());
        assert_eq!(places, [50.0, 50.0, 50.0, 50.0, 150.0, 150.0, 50.0].map(f64::to_bits));
        assert!((axis.at(10.0) - 100.0).abs() < 1e-9);
    }

    #[test]
    fn what_has_no_logarithm_has_a_band() {
        let errors = [0.0, 1.0, 100.0, f64::INFINITY];
        let all = ErrorAxis::over(errors.into_iter(), [0.0, 200.0], 10.0);
        assert_eq!((all.zero, all.infinite), (Some(190.0), Some(10.0)));
        let places = errors.map(|error| all.at(error));
        let in_the_middle = [places[0], places[3], all.at(f64::NAN)].map(f64::to_bits);
        assert_eq!(in_the_middle, [190.0, 10.0, 10.0].map(f64::to_bits));
        assert!(places.is_sorted_by(|low, high| low > high), "upward: {places:?}");
        assert!(places[1] < 180.0 && places[2] > 20.0, "numbers are in no band: {places:?}");
        let plain = ErrorAxis::over([1.0, 2.0].into_iter(), [0.0, 200.0], 10.0);
        assert_eq!((plain.zero, plain.infinite), (None, None));
        assert!(ErrorAxis::over([0.0].into_iter(), [0.0, 200.0], 10.0).at(0.0) > 180.0);
        let inside = (0..20).all(|place| (180.0..=200.0).contains(&all.at_place(0.0, place)));
        assert!(inside && all.at_place(1.0, 1).to_bits() == all.at(1.0).to_bits());
    }
}
