//! What is legal, from integers and from the grid of a format alone.

use crate::format::Format;
use crate::{Accept, F16, F32, Hardware};
use std::sync::OnceLock;

/// The least and the greatest legal value; `None` where anything is legal.
pub(super) type Ends = Option<(f64, f64)>;

/// The values of a format, found without the bit operations of [`Format`].
pub(super) trait Grid: Format {
    /// The greatest value ≤ x, for x within the format's range.
    fn below(x: f64) -> f64;

    /// The least value ≥ x, for x within the format's range.
    fn above(x: f64) -> f64 {
        -Self::below(-x)
    }
}

impl Grid for F32 {
    fn below(x: f64) -> f64 {
        #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is a start")]
        let nearest = x as f32;
        f64::from(if f64::from(nearest) > x { nearest.next_down() } else { nearest })
    }
}

impl Grid for F16 {
    fn below(x: f64) -> f64 {
        static VALUES: OnceLock<Vec<f64>> = OnceLock::new();
        let values = VALUES.get_or_init(|| {
            // 1,024 subnormals and zero, then 30 binades of 1,024 numbers.
            let positive = (0..31).flat_map(|binade| (0..1024).map(move |k| (binade, k)));
            let positive = positive.map(|(binade, k)| match binade {
                0 => f64::from(k) * power_of_two(-24),
                _ => f64::from(1024 + k) * power_of_two(binade - 25),
            });
            let mut values: Vec<f64> = positive.flat_map(|x| [-x, x]).collect();
            values.sort_by(f64::total_cmp);
            values
        });
        let after = values.partition_point(|value| *value <= x);
        after.checked_sub(1).map_or(f64::NEG_INFINITY, |at| values[at])
    }
}

impl<F: Grid> Grid for Hardware<F> {
    fn below(x: f64) -> f64 {
        F::below(x)
    }
}

/// 2ᵉ for a normal f64.
pub(super) fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(u64::try_from(1023 + exponent).expect("a normal number") << 52)
}

/// Muller's ULP: the distance of the two values that bracket x most narrowly.
pub(super) fn ulp<F: Grid>(x: f64) -> f64 {
    let x = x.abs();
    let (below, above) = (F::below(x), F::above(x));
    if below < above { above - below } else { (x - F::below(x.next_down())).min(F::above(x.next_up()) - x) }
}

/// The ends with 0 where one of the values is subnormal, so that it may be flushed.
pub(super) fn flushed<F: Format>((low, high): (f64, f64)) -> (f64, f64) {
    let is_subnormal = |x: f64| x != 0.0 && x.abs() < F::MIN_NORMAL;
    if is_subnormal(low) || is_subnormal(high) { (low.min(0.0), high.max(0.0)) } else { (low, high) }
}

/// The ends of what an exact result may be rounded to, up or down.
pub(super) fn rounded<F: Grid>(exact: f64) -> Ends {
    (exact.abs() <= F::MAX).then(|| flushed::<F>((F::below(exact), F::above(exact))))
}

/// The ends of the format's values that lie within an absolute error of an exact result.
pub(super) fn within<F: Grid>(low: f64, high: f64) -> Ends {
    let beyond = F::MAX + ulp::<F>(F::MAX);
    (low > -beyond && high < beyond).then(|| {
        let (low, high) = (F::above(low.max(-F::MAX)), F::below(high.min(F::MAX)));
        // A range without a number of the format lies between two subnormals: either may be returned.
        flushed::<F>((low.min(high), high.max(low)))
    })
}

/// An f32 as an integer times a power of two.
fn decompose(x: f32) -> (i128, i32) {
    let bits = x.to_bits();
    let (exponent, fraction) = (i32::try_from(bits >> 23 & 0xff).expect("8 bits"), i128::from(bits & 0x7f_ffff));
    let magnitude = if exponent == 0 { fraction } else { fraction + (1 << 23) };
    (if x.is_sign_negative() { -magnitude } else { magnitude }, exponent.max(1) - 150)
}

/// The ends of a + b, in integers.
pub(super) fn sum(a: f32, b: f32) -> Ends {
    let (a, b) = if a.abs() < b.abs() { (b, a) } else { (a, b) };
    let ((m, e), (n, f)) = (decompose(a), decompose(b));
    // A term far below the other's last bit only has a sign.
    let (total, exponent) = if e - f > 60 { ((m << 60) + n.signum(), e - 60) } else { ((m << (e - f)) + n, f) };
    let bits = i32::try_from(128 - total.unsigned_abs().leading_zeros()).expect("at most 128");
    let drop = (bits - 24).max(-149 - exponent).max(0);
    #[expect(clippy::cast_precision_loss, reason = "at most 25 bits")]
    let value = |significand: i128| significand as f64 * power_of_two(exponent + drop);
    let (low, high) = (value(total >> drop), value(-(-total >> drop)));
    (low >= -F32::MAX && high <= F32::MAX).then(|| flushed::<F32>((low, high)))
}

/// The ends of a·b, whose exact value is an f64.
pub(super) fn product(a: f32, b: f32) -> Ends {
    rounded::<F32>(f64::from(a) * f64::from(b))
}

/// The smallest ends that hold all of these.
pub(super) fn hull(all: impl IntoIterator<Item = Ends>) -> Ends {
    all.into_iter().reduce(|a, b| a.zip(b).map(|((a, b), (c, d))| (a.min(c), b.max(d)))).flatten()
}

/// The ends over all pairs of two lists.
pub(super) fn over_pairs(a: &[f32], b: &[f32], f: impl Fn(f32, f32) -> Ends) -> Ends {
    hull(a.iter().flat_map(|&a| b.iter().map(move |&b| (a, b))).map(|(a, b)| f(a, b)))
}

/// The ends of an interval.
pub(super) fn ends<F: Format>(interval: Accept<F>) -> Ends {
    (!interval.is_any()).then(|| (interval.low(), interval.high()))
}

/// An interval has exactly these ends.
pub(super) fn assert_is<F: Format>(name: &str, inputs: &dyn std::fmt::Debug, got: Accept<F>, expected: Ends) {
    assert_eq!(ends(got), expected, "{name} of {inputs:?}");
}

/// An interval holds what is legal, and no more than what the rule permits with the slack of f64.
pub(super) fn assert_between<F: Format>(
    name: &str,
    inputs: &dyn std::fmt::Debug,
    got: Accept<F>,
    [required, permitted]: [Ends; 2],
) {
    let is_inside = |inner: Ends, outer: Ends| match (inner, outer) {
        (_, None) => true,
        (None, Some(_)) => false,
        (Some((a, b)), Some((low, high))) => low <= a && b <= high,
    };
    assert!(is_inside(required, ends(got)), "{name} of {inputs:?}: {got:?} lacks a part of {required:?}");
    assert!(is_inside(ends(got), permitted), "{name} of {inputs:?}: {got:?} exceeds {permitted:?}");
}

/// Numbers at the boundaries of binary32, each of both signs.
pub(super) fn boundaries() -> Vec<f32> {
    let positive = [
        0.0,
        f32::from_bits(1),
        1e-40,
        f32::MIN_POSITIVE.next_down(),
        f32::MIN_POSITIVE,
        f32::MIN_POSITIVE.next_up(),
        1e-30,
        2.0_f32.powi(-63),
        2.0_f32.powi(-24),
        0.1,
        1.0 / 3.0,
        0.5_f32.next_down(),
        0.5,
        0.75,
        1.0_f32.next_down(),
        1.0,
        1.0_f32.next_up(),
        1.5,
        2.0,
        2.0_f32.next_up(),
        3.0,
        88.0,
        16_777_215.0,
        1e18,
        2.0_f32.powi(126),
        2.0_f32.powi(126).next_up(),
        f32::MAX.next_down(),
        f32::MAX,
    ];
    positive.into_iter().flat_map(|x| [x, -x]).collect()
}

/// A generator with a fixed seed: the linear congruential one of Knuth's MMIX.
pub(super) struct Draws(pub u64);

impl Draws {
    /// 32 bits.
    pub(super) fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from(self.0 >> 32).expect("32 bits")
    }

    /// An f32 of either sign whose exponent lies between two.
    pub(super) fn number(&mut self, least: i32, most: i32) -> f32 {
        let span = u32::try_from(most - least + 1).expect("an exponent range");
        let exponent = u32::try_from(127 + least).expect("a normal number") + self.bits() % span;
        let sign_and_fraction = self.bits() & 0x807f_ffff;
        f32::from_bits(sign_and_fraction | exponent << 23)
    }

    /// Two numbers in order.
    pub(super) fn range(&mut self, least: i32, most: i32) -> [f32; 2] {
        let (a, b) = (self.number(least, most), self.number(least, most));
        [a.min(b), a.max(b)]
    }
}
