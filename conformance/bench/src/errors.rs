//! Errors of many values against their exact ones.

use lightmeter_arithmetic::F32;
use lightmeter_arithmetic::format::Format as _;
use lightmeter_document::Number;
use lightmeter_document::bench::{Errors, Spread};

/// Gathers errors.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    absolute: Vec<f64>,
    ulp: Vec<f64>,
    lost: u64,
    nothing_promised: u64,
}

impl Gathered {
    /// A value beside the exact one. What is too great for binary32 is lost, and where the exact value is no number, or is too
    /// great itself, nothing is promised.
    pub fn add(&mut self, value: f64, exact: f64) {
        if !exact.is_finite() || exact.abs() > f64::from(f32::MAX) {
            self.nothing_promised += 1;
        } else if !value.is_finite() {
            self.lost += 1;
        } else {
            let error = (value - exact).abs();
            self.absolute.push(error);
            self.ulp.push(error / F32::ulp(exact));
        }
    }

    /// A value that nothing is promised of.
    pub const fn skip(&mut self) {
        self.nothing_promised += 1;
    }

    /// The statistics; `None` where no value was compared.
    #[must_use]
    pub fn errors(mut self) -> Option<Errors> {
        let values = self.absolute.len() as u64 + self.lost;
        if values == 0 {
            return None;
        }
        let absolute = spread(&mut self.absolute, self.lost);
        Some(Errors {
            values,
            lost: self.lost,
            nothing_promised: self.nothing_promised,
            ulp: spread(&mut self.ulp, self.lost),
            steps: Spread {
                max: Number(absolute.max.0 * 255.0),
                p99: Number(absolute.p99.0 * 255.0),
                mean: Number(absolute.mean.0 * 255.0),
            },
            absolute,
        })
    }
}

/// Of errors, and of a number of infinite ones.
fn spread(errors: &mut [f64], lost: u64) -> Spread {
    errors.sort_by(f64::total_cmp);
    let lost = usize::try_from(lost).unwrap_or(usize::MAX);
    let all = errors.len() + lost;
    // The least error that 99 of 100 do not exceed.
    let place = (all * 99).div_ceil(100).saturating_sub(1);
    let at = |place: usize| errors.get(place).copied().unwrap_or(f64::INFINITY);
    #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53 values")]
    let mean = if errors.is_empty() { f64::INFINITY } else { errors.iter().sum::<f64>() / errors.len() as f64 };
    Spread { max: Number(at(all - 1)), p99: Number(at(place)), mean: Number(mean) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_are_of_all_values() {
        let mut gathered = Gathered::default();
        for k in 1..=100 {
            gathered.add(1.0 + f64::from(k) * 1e-3, 1.0);
        }
        let errors = gathered.errors().expect("values were given");
        let near = |number: Number, expected: f64| assert!((number.0 / expected - 1.0).abs() < 1e-9, "{number}");
        near(errors.absolute.max, 0.1);
        near(errors.absolute.p99, 0.099);
        near(errors.absolute.mean, 0.0505);
        near(errors.steps.max, 25.5);
        // 1 is a power of two: the bracket below is half as wide, 2^-24.
        near(errors.ulp.max, 0.1 * 16_777_216.0);
    }

    #[test]
    fn what_is_lost_is_the_largest_error_and_in_no_mean() {
        let mut gathered = Gathered::default();
        gathered.add(1.0, 1.0);
        gathered.add(f64::NAN, 1.0);
        gathered.add(1.0, f64::NAN);
        gathered.add(1.0, 1e39);
        let errors = gathered.errors().expect("values were given");
        assert_eq!((errors.values, errors.lost, errors.nothing_promised), (2, 1, 2));
        assert!(errors.ulp.max.0 == f64::INFINITY && errors.absolute.mean.0 == 0.0);
    }

    #[test]
    fn nothing_compared_is_no_error_of_zero() {
        let mut gathered = Gathered::default();
        gathered.skip();
        assert!(gathered.errors().is_none());
    }
}
