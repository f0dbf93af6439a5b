//! Figures and words as reports show them.

use lightmeter_document::bench::ladder::median;
use lightmeter_document::bench::{Measured, Rank, Time};
use lightmeter_document::{superscript, thousands};

/// How long compilation took, rung by rung.
pub(super) fn compilation(measured: &Measured) -> Option<String> {
    let rows = || measured.groups.iter().flat_map(|group| &group.rows);
    let of = |rung: &str| {
        let is_of = |name: &str| name == rung || name.ends_with(&format!(" {rung}"));
        let taken: Vec<f64> = rows().filter(|row| is_of(&row.name)).filter_map(|row| row.compile_ms).collect();
        (!taken.is_empty()).then(|| format!("{rung} {}", time(1e6 * median(taken.into_iter()))))
    };
    let medians: Vec<String> = measured.rungs.iter().filter_map(|rung| of(&rung.name)).collect();
    let all: Vec<f64> = rows().filter_map(|row| row.compile_ms).collect();
    let total = time(1e6 * all.iter().sum::<f64>());
    let shaders = count(all.len(), "shader");
    (!medians.is_empty()).then(|| {
        format!("{total} for {shaders} in the first sitting, each to its first result; medians: {}", medians.join(", "))
    })
}

/// Nanoseconds, in the unit that reads best.
pub(super) fn time(ns: f64) -> String {
    let (scale, unit) = match ns.abs() {
        x if x >= 1e9 => (1e9, "s"),
        x if x >= 1e6 => (1e6, "ms"),
        x if x >= 1e3 => (1e3, "µs"),
        x if x >= 0.1 || x == 0.0 => (1.0, "ns"),
        _ => (1e-3, "ps"),
    };
    format!("{} {unit}", digits(ns / scale))
}

/// Three digits, a power of ten for what is great or small.
pub(super) fn digits(x: f64) -> String {
    match x.abs() {
        y if !y.is_finite() => error(x),
        0.0 => "0".into(),
        y if !(1e-3..99_999.5).contains(&y) => scientific(x),
        y if y >= 999.5 => grouped(x),
        y if y >= 99.95 => format!("{x:.0}"),
        y if y >= 9.995 => format!("{x:.1}"),
        y if y >= 0.9995 => format!("{x:.2}"),
        y if y >= 0.09995 => format!("{x:.3}"),
        y if y >= 0.009995 => format!("{x:.4}"),
        _ => format!("{x:.5}"),
    }
}

/// Two digits of an error.
pub(super) fn error(x: f64) -> String {
    match x {
        x if x.is_nan() => "NaN".into(),
        f64::INFINITY => "∞".into(),
        f64::NEG_INFINITY => "−∞".into(),
        0.0 => "0".into(),
        x if !(1e-2..99_999.5).contains(&x.abs()) => scientific(x),
        x if x.abs() >= 999.5 => grouped(x),
        x if x.abs() >= 9.95 => format!("{x:.0}"),
        x if x.abs() >= 0.995 => format!("{x:.1}"),
        x if x.abs() >= 0.0995 => format!("{x:.2}"),
        x => format!("{x:.3}"),
    }
}

/// A whole number in groups of three digits.
pub(crate) fn grouped(x: f64) -> String {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 10⁵")]
    let whole = thousands(x.abs().round() as u64);
    if x < 0.0 { format!("−{whole}") } else { whole }
}

/// Two digits and a power of ten.
pub(crate) fn scientific(x: f64) -> String {
    let written = format!("{x:.1e}");
    let (digits, power) = written.split_once('e').unwrap_or((&written, "0"));
    format!("{digits}·10{}", superscript(power.parse().unwrap_or_default()))
}

/// From where to where a ratio goes.
pub(super) fn spread([from, to]: [f64; 2]) -> String {
    format!("{}–{}", digits(from), digits(to))
}

/// What a ratio says, in a word.
pub(super) const fn standing(time: &Time) -> &'static str {
    match time.verdict {
        Rank::Baseline => "baseline",
        Rank::Faster => "faster",
        Rank::Slower => "slower",
        Rank::Tie => "tie",
    }
}

/// Whether a claim holds, in a word or a few.
pub(super) const fn holding(holds: Option<bool>) -> &'static str {
    match holds {
        Some(true) => "holds",
        Some(false) => "does not hold",
        None => "left open by a tie",
    }
}

/// `1 formula`, `2 formulas`.
pub(super) fn count(n: usize, what: &str) -> String {
    if n == 1 { format!("{n} {what}") } else { format!("{n} {what}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_a_few_digits_and_a_unit() {
        let times = [0.0, 0.0123, 0.41234, 9.996, 99.97, 1234.5, 3.21e6, 4e9, -0.5, f64::INFINITY].map(time);
        let expected =
            ["0 ns", "12.3 ps", "0.412 ns", "10.0 ns", "100 ns", "1.23 µs", "3.21 ms", "4.00 s", "-0.500 ns", "∞ s"];
        assert_eq!(times, expected);
        let errors = [0.0, 0.5, 0.031, 0.999, 3.21, 9.96, 1234.0, 1.7e7, 1e-3, f64::INFINITY, f64::NAN].map(error);
        assert_eq!(errors, ["0", "0.50", "0.031", "1.0", "3.2", "10", "1,234", "1.7·10⁷", "1.0·10⁻³", "∞", "NaN"]);
        assert_eq!(spread([0.98, 1.021]), "0.980–1.02");
    }
}
