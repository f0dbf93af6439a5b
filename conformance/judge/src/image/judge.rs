//! An image against what its pixels may hold.

use super::file::StoredImage;
use super::pixel::LegalPixel;
use crate::tally::Tally;
use crate::{Outcome, margin};
use lightmeter_arithmetic::format::error_ulp;
use lightmeter_arithmetic::{F16, F32};
use lightmeter_scene::target::{Encoding, TargetFormat};
use rayon::prelude::*;

/// A component of a pixel that is outside what is legal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miss {
    /// The pixel's number, row after row.
    pub pixel: usize,
    /// The component.
    pub component: usize,
    /// By how many times its tolerance it is off.
    pub margin: f64,
}

/// How an image compares.
#[derive(Clone, Debug, Default)]
pub struct Judged {
    /// Verdicts on components, by pixel and component. The greatest error leaves marked pixels out, and is in ULP on float
    /// targets and in steps on those of 8 bits; the greatest margin leaves them out unless it is a miss.
    pub verdicts: Tally<(usize, usize)>,
    /// Components outside their intervals.
    pub misses: Vec<Miss>,
}

impl Judged {
    /// The pixels that fail, each once, in order.
    #[must_use]
    pub fn pixels(&self) -> Vec<usize> {
        let mut pixels: Vec<usize> = self.misses.iter().map(|miss| miss.pixel).collect();
        pixels.dedup();
        pixels
    }

    /// The component of the greatest margin.
    #[must_use]
    pub fn worst(&self) -> Option<Miss> {
        self.verdicts.worst.map(|(margin, (pixel, component))| Miss { pixel, component, margin })
    }

    /// Takes the misses out that a named deviation makes legal; how many there are.
    pub fn excuse(&mut self, deviation: &'static str, is_legal: impl Fn(&Miss) -> bool) -> u64 {
        let before = self.misses.len();
        self.misses.retain(|miss| !is_legal(miss));
        let excused = (before - self.misses.len()) as u64;
        if excused > 0 {
            self.verdicts.totals.failed -= excused;
            self.verdicts.totals.expected_failures += excused;
            *self.verdicts.excused.entry(deviation).or_default() += excused;
        }
        excused
    }
}

/// Judges every component of the pixels given, by their numbers.
///
/// The margin is the distance from the reference, not rounded to the target, over the distance to the interval's end.
#[must_use]
pub fn judge(image: &StoredImage, reference: &StoredImage, expected: &[LegalPixel], pixels: &[usize]) -> Judged {
    let chunks = pixels.par_chunks(4096).map(|pixels| {
        let mut judged = Judged::default();
        let mut indeterminate = 0;
        for &pixel in pixels {
            for component in 0..4 {
                let outcome = one(image, reference, expected, (pixel, component), &mut judged);
                indeterminate += u64::from(outcome == Outcome::Indeterminate);
            }
        }
        let (cases, failed) = (pixels.len() as u64, judged.misses.len() as u64);
        judged.verdicts.totals.cases = cases;
        judged.verdicts.count_many(Outcome::Pass, 4 * cases - failed - indeterminate, true);
        judged.verdicts.count_many(Outcome::Fail, failed, true);
        judged.verdicts.count_many(Outcome::Indeterminate, indeterminate, true);
        judged
    });
    let mut all = Judged::default();
    for part in chunks.collect::<Vec<Judged>>() {
        all.verdicts.add(part.verdicts);
        all.misses.extend(part.misses);
    }
    all
}

/// The outcome of a component; what else it says is noted.
fn one(
    image: &StoredImage,
    reference: &StoredImage,
    expected: &[LegalPixel],
    (pixel, component): (usize, usize),
    judged: &mut Judged,
) -> Outcome {
    let (value, exact) = (image.pixels[pixel][component], reference.pixels[pixel][component]);
    let (low, high) = (expected[pixel].low[component], expected[pixel].high[component]);
    let outcome = if low == f64::NEG_INFINITY && high == f64::INFINITY {
        Outcome::Indeterminate
    } else if low <= value && value <= high && !exact.is_nan() {
        Outcome::Pass
    } else {
        Outcome::Fail
    };
    if outcome == Outcome::Indeterminate {
        return outcome;
    }
    // Where outcomes differ by themselves, the distance from one of them says nothing.
    if !expected[pixel].is_marked {
        judged.verdicts.see_error(error(image.format, value, exact));
    }
    let miss = Miss { pixel, component, margin: margin(value, exact, low, high) };
    if outcome == Outcome::Fail {
        judged.misses.push(miss);
    }
    if miss.margin > 1.0 || !expected[pixel].is_marked {
        judged.verdicts.see_margin(miss.margin, (pixel, component));
    }
    outcome
}

/// ULP of a float format, or steps.
#[must_use]
pub fn error(format: TargetFormat, value: f64, exact: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "a value that was read from a target fits binary32")]
    let narrow = value as f32;
    match format.encoding() {
        Encoding::Float32 => error_ulp::<F32>(narrow, exact),
        Encoding::Float16 => error_ulp::<F16>(narrow, exact),
        Encoding::Unorm8 | Encoding::Srgb8 => (value - exact).abs(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::map::error_map;
    use super::*;

    /// More than two of the pool's tasks.
    const PIXELS: usize = 10_000;

    /// An image that is right, and what is legal of it.
    fn image(format: TargetFormat) -> (StoredImage, Vec<LegalPixel>) {
        let expected = LegalPixel { low: [0.25; 4], high: [0.75; 4], is_marked: false };
        (StoredImage { width: 100, format, pixels: vec![[0.5; 4]; PIXELS] }, vec![expected; PIXELS])
    }

    fn nans() -> [f64; 4] {
        [0x7fc0_0000, 0xffc0_0000, 0x7fa0_0001, 0x7fc1_2345].map(|bits| f32::from_bits(bits).into())
    }

    fn everywhere() -> impl Iterator<Item = (usize, usize, f64)> {
        let places = [0, PIXELS / 2, PIXELS - 1].into_iter().flat_map(|pixel| [0, 2, 3].map(|k| (pixel, k)));
        places.flat_map(|(pixel, k)| nans().map(|nan| (pixel, k, nan)))
    }

    #[test]
    fn a_nan_fails_wherever_it_stands() {
        for format in [TargetFormat::Rgba32Float, TargetFormat::Rgba16Float] {
            let (reference, mut expected) = image(format);
            let all: Vec<usize> = (0..PIXELS).collect();
            for (pixel, component, nan) in everywhere() {
                for is_marked in [false, true] {
                    let mut wrong = reference.clone();
                    wrong.pixels[pixel][component] = nan;
                    expected[pixel].is_marked = is_marked;
                    let judged = judge(&wrong, &reference, &expected, &all);
                    let miss = Miss { pixel, component, margin: f64::INFINITY };
                    assert_eq!((judged.misses.as_slice(), judged.worst()), (&[miss][..], Some(miss)));
                    assert_eq!(judged.verdicts.totals.passed, 4 * PIXELS as u64 - 1);
                    assert!(is_marked || judged.verdicts.error_max == f64::INFINITY);
                    let map = error_map(&wrong, &reference, &expected);
                    let violet = [190.0_f64, 0.0, 190.0, 255.0].map(f64::to_bits);
                    assert_eq!(map.pixels[pixel].map(f64::to_bits), violet, "a NaN is as far off as can be");
                }
                expected[pixel].is_marked = false;
            }
        }
    }

    #[test]
    fn a_nan_is_indeterminate_where_anything_is_legal_and_never_a_pass() {
        let (reference, expected) = image(TargetFormat::Rgba32Float);
        let all: Vec<usize> = (0..PIXELS).collect();
        for (pixel, component, nan) in everywhere() {
            let (mut wrong, mut expected) = (reference.clone(), expected.clone());
            wrong.pixels[pixel][component] = nan;
            (expected[pixel].low[component], expected[pixel].high[component]) = (f64::NEG_INFINITY, f64::INFINITY);
            let judged = judge(&wrong, &reference, &expected, &all);
            let totals = judged.verdicts.totals;
            assert_eq!((totals.indeterminate, totals.failed, judged.misses.len()), (1, 0, 0));
            assert_eq!(totals.passed, 4 * PIXELS as u64 - 1);
        }
    }

    #[test]
    fn a_reference_that_is_no_number_passes_nothing() {
        let (right, expected) = image(TargetFormat::Rgba32Float);
        for (pixel, component, nan) in everywhere() {
            let mut reference = right.clone();
            reference.pixels[pixel][component] = nan;
            let judged = judge(&right, &reference, &expected, &[pixel]);
            assert_eq!((judged.verdicts.totals.passed, judged.misses.len()), (3, 1));
            assert!(judged.worst().is_some_and(|worst| worst.component == component && worst.margin == f64::INFINITY));
        }
    }
}
