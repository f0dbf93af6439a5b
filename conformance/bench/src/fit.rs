//! The law that times grow by: `ns = fixed + factor · work^exponent`.
//!
//! Least squares of ln(measured / fitted). For each fixed part the other two follow by Gauss and Newton's steps; the fixed
//! part itself, from 0 to below the least time, is searched for. Where the exponent is free, a fixed part is told from a lower
//! exponent only by points from both sides of where the one takes over.

use lightmeter_document::bench::{Fit, ScalingPoint};

/// Fixed parts that are tried, as equal shares of the least time.
const SHARES: u32 = 200;
/// The number of Gauss–Newton steps. Convergence is quadratic: each step roughly squares the remaining relative error.
const STEPS: usize = 12;
/// Times that the interval around the best share is cut by a third.
const THIRDS: usize = 50;

/// The law that fits the points best; `None` below three different amounts of work, or where a figure is not positive.
#[must_use]
pub fn fit(points: &[ScalingPoint]) -> Option<Fit> {
    #[expect(clippy::cast_precision_loss, reason = "far less than 2^53 of anything")]
    let points: Vec<(f64, f64)> = points.iter().map(|point| (point.work as f64, point.ns)).collect();
    let mut amounts: Vec<f64> = points.iter().map(|(work, _)| *work).collect();
    amounts.sort_by(f64::total_cmp);
    amounts.dedup();
    if amounts.len() < 3 || points.iter().any(|&(work, ns)| !(work >= 1.0 && ns > 0.0 && ns.is_finite())) {
        return None;
    }
    let least = points.iter().map(|(_, ns)| *ns).fold(f64::INFINITY, f64::min);
    let at = |share: f64| Law::with_fixed(share * least, &points);
    let step = 1.0 / f64::from(SHARES);
    let shares = (0..SHARES).map(|k| f64::from(k) * step);
    let best = shares.min_by(|a, b| at(*a).squares(&points).total_cmp(&at(*b).squares(&points)))?;
    // The whole of the least time would leave nothing to take a logarithm of.
    let (mut low, mut high) = ((best - step).max(0.0), (best + step).min(1.0 - 1e-9));
    for _ in 0..THIRDS {
        let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if at(a).squares(&points) <= at(b).squares(&points) { high = b } else { low = a }
    }
    let laws = [at(0.0), at(best), at(0.5 * (low + high))];
    let law = laws.into_iter().min_by(|a, b| a.squares(&points).total_cmp(&b.squares(&points)))?;
    Some(Fit {
        fixed_ns: law.fixed,
        factor_ns: law.ln_factor.exp(),
        exponent: law.exponent,
        residual: points.iter().map(|&point| law.residual(point).abs()).fold(0.0, f64::max),
    })
}

#[derive(Clone, Copy, Debug)]
struct Law {
    fixed: f64,
    ln_factor: f64,
    exponent: f64,
}

impl Law {
    /// The best with that fixed part.
    fn with_fixed(fixed: f64, points: &[(f64, f64)]) -> Self {
        // Without the fixed part the logarithms lie on a line, from which the steps begin; what is mostly fixed says little.
        let start = line(points.iter().map(|&(work, ns)| {
            let share = (ns - fixed) / ns;
            (share, share * work.ln(), share * (ns - fixed).ln())
        }));
        let mut law = Self { fixed, ln_factor: start.0, exponent: start.1 };
        let mut best = law;
        for _ in 0..STEPS {
            let rows = points.iter().map(|&(work, ns)| {
                let varying = law.varying(work);
                let share = varying / (fixed + varying);
                (share, share * work.ln(), law.residual((work, ns)))
            });
            let (more, steeper) = line(rows);
            law = Self { fixed, ln_factor: law.ln_factor + more, exponent: law.exponent + steeper };
            if law.squares(points) < best.squares(points) {
                best = law;
            }
        }
        best
    }

    fn varying(&self, work: f64) -> f64 {
        (self.ln_factor + self.exponent * work.ln()).exp()
    }

    /// ln(measured / fitted)
    fn residual(&self, (work, ns): (f64, f64)) -> f64 {
        (ns / (self.fixed + self.varying(work))).ln()
    }

    fn squares(&self, points: &[(f64, f64)]) -> f64 {
        let squares: f64 = points.iter().map(|&point| self.residual(point).powi(2)).sum();
        if squares.is_nan() { f64::INFINITY } else { squares }
    }
}

/// (a, b) of the least squares of y − a·u − b·v over rows (u, v, y).
fn line(rows: impl Iterator<Item = (f64, f64, f64)>) -> (f64, f64) {
    let [mut uu, mut uv, mut vv, mut uy, mut vy] = [0.0; 5];
    for (u, v, y) in rows {
        uu += u * u;
        uv += u * v;
        vv += v * v;
        uy += u * y;
        vy += v * y;
    }
    let determinant = uu * vv - uv * uv;
    ((uy * vv - vy * uv) / determinant, (vy * uu - uy * uv) / determinant)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(works: &[u64], ns: impl Fn(f64) -> f64) -> Vec<ScalingPoint> {
        works
            .iter()
            .map(|&work| {
                #[expect(clippy::cast_precision_loss, reason = "small")]
                let ns = ns(work as f64);
                ScalingPoint { work, ns, quartiles_ns: [ns; 2] }
            })
            .collect()
    }

    /// So that 2¹⁴ units take a hundred times as long as the fixed part of the tests.
    fn factor(exponent: f64) -> f64 {
        300_000.0 / 16_384.0_f64.powf(exponent)
    }

    fn powers(least: u32, most: u32) -> Vec<u64> {
        (least..=most).map(|k| 1 << k).collect()
    }

    #[test]
    fn laws_are_recovered() {
        for exponent in [0.5, 1.0, 2.0] {
            for fixed in [0.0, 3_000.0] {
                let factor = factor(exponent);
                let made = points(&powers(0, 14), |work| fixed + factor * work.powf(exponent));
                let law = fit(&made).expect("15 points");
                let what = format!("{fixed} + {factor}·w^{exponent}: {law:?}");
                assert!((law.exponent - exponent).abs() < 1e-3, "{what}");
                assert!((law.factor_ns / factor - 1.0).abs() < 1e-2, "{what}");
                assert!((law.fixed_ns - fixed).abs() < 1.0 + 1e-3 * fixed, "{what}");
                assert!(law.residual < 1e-4, "{what}");
            }
        }
    }

    #[test]
    fn noise_moves_the_exponent_by_no_more_than_itself() {
        // ±5 %, in an order that has nothing to do with the work's.
        let noise = |work: f64| 1.0 + 0.05 * (work.ln() * 12.9898).sin();
        for exponent in [0.5, 1.0, 2.0] {
            for fixed in [0.0, 3_000.0] {
                let factor = factor(exponent);
                let made = points(&powers(0, 14), |work| (fixed + factor * work.powf(exponent)) * noise(work));
                let law = fit(&made).expect("15 points");
                assert!((law.exponent - exponent).abs() < 0.1, "{fixed} + {factor}·w^{exponent}: {law:?}");
                assert!((1e-3..0.12).contains(&law.residual), "{law:?}");
            }
        }
    }

    #[test]
    fn what_grows_by_no_such_law_has_a_residual_that_says_so() {
        let stairs = points(&powers(0, 10), |work| if work < 32.0 { 1_000.0 } else { 64_000.0 });
        assert!(fit(&stairs).expect("11 points").residual > 0.3);
    }

    #[test]
    fn two_points_are_no_law() {
        assert!(fit(&points(&[1, 2], |work| work)).is_none());
        assert!(fit(&points(&[2, 2, 2, 4], |work| work)).is_none());
        assert!(fit(&points(&[1, 2, 4], |work| work - 1.0)).is_none());
        assert!(fit(&points(&[1, 2, 4], |_| f64::NAN)).is_none());
    }
}
