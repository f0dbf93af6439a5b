//! What all pixels of an image of 8 bits say together, where each alone is legal.
//!
//! A step of 8 bits hides what is wrong by less. Where a shader is off by a third of a step, a third of the pixels are a step off, all to
//! one side; each is legal wherever arithmetic leaves it to the shader which of two steps is next. So the steps by which pixels differ from the
//! reference, rounded, are added up: of a right image they are few, and as often up as down. Where a shader compiler may be off to one side all over an
//! image, it may be: what fails an image is what is left beyond that.

use super::file::StoredImage;
use super::pixel::LegalPixel;
use std::collections::BTreeMap;

/// Standard errors that a bias is more than.
const ERRORS: f64 = 8.0;
/// Steps that it is more than: an eighth of what a target of 8 bits tells apart.
const STEPS: f64 = 0.125;
/// Values of the reference that have to be there, in steps, each of which counts once however many pixels have it.
const LEAST_VALUES: usize = 24;

/// An image to one side of its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bias {
    /// What the values are as if multiplied by; `None` where they are as if something were added.
    pub factor: Option<f64>,
    /// How far it moves values, in steps, negative where it is downwards: the root of the mean square.
    pub steps: f64,
    /// Its standard error, in steps.
    pub error: f64,
}

impl Bias {
    /// To which side of its reference an image of 8 bits lies; `None` where it lies to none. Marked pixels say nothing, and neither do
    /// those at the ends of the range, where values are clamped.
    #[must_use]
    pub fn of(image: &StoredImage, reference: &StoredImage, expected: &[LegalPixel], pixels: &[usize]) -> Option<Self> {
        let unmarked = pixels.iter().copied().filter(|&pixel| !expected[pixel].is_marked);
        Self::fitted(&means(reference, unmarked, |pixel, component, nearest| image.pixels[pixel][component] - nearest))
    }

    /// What is left of it where every value that a pixel may have before it is stored is rounded to the nearest step, at a tie to either: of
    /// an image that the accuracy rules explain nothing is left.
    #[must_use]
    pub fn beyond(
        image: &StoredImage,
        reference: &StoredImage,
        on_floats: &[LegalPixel],
        pixels: &[usize],
    ) -> Option<Self> {
        let unmarked = pixels.iter().copied().filter(|&pixel| !on_floats[pixel].is_marked);
        let off = |pixel: usize, component: usize, _: f64| {
            let legal = &on_floats[pixel];
            let least = (255.0 * legal.low[component] - 0.5).ceil();
            let greatest = (255.0 * legal.high[component] + 0.5).floor();
            let value = image.pixels[pixel][component];
            value - value.max(least).min(greatest)
        };
        Self::fitted(&means(reference, unmarked, off))
    }

    fn fitted(points: &[[f64; 2]]) -> Option<Self> {
        if points.len() < LEAST_VALUES {
            return None;
        }
        let added = fit(points, |_| 1.0);
        let multiplied = fit(points, |x| x);
        let is_multiplied = multiplied.rest < added.rest;
        let better = if is_multiplied { multiplied } else { added };
        let found = Self {
            factor: is_multiplied.then_some(1.0 + better.slope),
            steps: better.slope * better.size,
            error: better.error * better.size,
        };
        // The error is not negative, and may be 0.
        (found.steps.abs() >= STEPS && found.steps.abs() >= ERRORS * found.error).then_some(found)
    }
}

/// For each component and each value of the reference in whole steps, that value and the mean of something over the pixels that have it.
fn means(
    reference: &StoredImage,
    pixels: impl Iterator<Item = usize>,
    of: impl Fn(usize, usize, f64) -> f64,
) -> Vec<[f64; 2]> {
    let mut values: BTreeMap<(usize, u64), (f64, f64)> = BTreeMap::new();
    for pixel in pixels {
        for component in 0..3 {
            let exact = reference.pixels[pixel][component];
            if (1.0..=254.0).contains(&exact) {
                let nearest = exact.round_ties_even();
                let (sum, count) = values.entry((component, nearest.to_bits())).or_default();
                *sum += of(pixel, component, nearest);
                *count += 1.0;
            }
        }
    }
    values.into_iter().map(|((_, nearest), (sum, count))| [f64::from_bits(nearest), sum / count]).collect()
}

/// A line through the origin.
#[derive(Clone, Copy)]
struct Line {
    slope: f64,
    /// The slope's standard error.
    error: f64,
    /// The root of the mean square of what the slope is multiplied by.
    size: f64,
    /// The sum of the squares that it leaves.
    rest: f64,
}

/// The line `y = slope·of(x)` of the least squares.
fn fit(points: &[[f64; 2]], of: impl Fn(f64) -> f64) -> Line {
    let squares: f64 = points.iter().map(|&[x, _]| of(x) * of(x)).sum();
    let slope = points.iter().map(|&[x, y]| of(x) * y).sum::<f64>() / squares;
    let rest: f64 = points.iter().map(|&[x, y]| (y - slope * of(x)) * (y - slope * of(x))).sum();
    #[expect(clippy::cast_precision_loss, reason = "at most some hundred points")]
    let count = points.len() as f64;
    Line { slope, error: (rest / (count - 1.0) / squares).sqrt(), size: (squares / count).sqrt(), rest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_scene::target::TargetFormat;

    /// An image of all brightnesses, changed before it is rounded, and what is legal of it.
    fn found(change: impl Fn(f64) -> f64) -> Option<Bias> {
        let exact: Vec<[f64; 4]> = (0..20_000)
            .map(|k| [0.3, 0.5, 0.7].map(|share| 10.0 + f64::from(k) * 0.01 * share))
            .map(|[r, g, b]| [r, g, b, 255.0])
            .collect();
        let stored = |c: f64| change(c).round_ties_even().clamp(0.0, 255.0);
        let image = StoredImage {
            width: 100,
            format: TargetFormat::Rgba8Unorm,
            pixels: exact.iter().map(|&[r, g, b, a]| [stored(r), stored(g), stored(b), a]).collect(),
        };
        let legal = |pixel: &[f64; 4]| LegalPixel {
            low: pixel.map(|c| c - 1.0),
            high: pixel.map(|c| c + 1.0),
            is_marked: false,
        };
        let expected: Vec<LegalPixel> = exact.iter().map(legal).collect();
        let reference = StoredImage { width: 100, format: TargetFormat::Rgba8Unorm, pixels: exact };
        let all: Vec<usize> = (0..reference.pixels.len()).collect();
        Bias::of(&image, &reference, &expected, &all)
    }

    #[test]
    fn a_factor_and_an_offset_are_told_and_rounding_is_none() {
        assert_eq!(found(|c| c), None);
        // As often up as down.
        assert_eq!(found(|c| c + 0.4 * (c * 7919.0).sin()), None);
        assert_eq!(found(|c| c * 1.0005), None);
        for factor in [1.002, 0.998, 1.003] {
            let bias = found(|c| c * factor).expect("it is to one side");
            assert!(bias.factor.is_some_and(|found| (found - factor).abs() < 0.0003), "{factor}: {bias:?}");
        }
        for offset in [0.5, -0.25] {
            let bias = found(|c| c + offset).expect("it is to one side");
            assert!(bias.factor.is_none() && (bias.steps - offset).abs() < 0.05, "{offset}: {bias:?}");
        }
    }

    #[test]
    fn what_the_rules_explain_is_not_beyond_them() {
        // A ramp, which is 60 % of what is legal too bright, and one on the ties between steps that is rounded down.
        let exact: Vec<[f64; 4]> = (0..20_000).map(|k| [10.0 + f64::from(k) * 0.01; 4]).collect();
        let reference = StoredImage { width: 100, format: TargetFormat::Rgba8Unorm, pixels: exact.clone() };
        let on_floats = |half: f64| -> Vec<LegalPixel> {
            let legal = |pixel: &[f64; 4]| LegalPixel {
                low: pixel.map(|c| c * (1.0 - half) / 255.0),
                high: pixel.map(|c| c * (1.0 + half) / 255.0),
                is_marked: false,
            };
            exact.iter().map(legal).collect()
        };
        let drawn = |change: &dyn Fn(f64) -> f64| StoredImage {
            pixels: exact.iter().map(|pixel| pixel.map(change)).collect(),
            ..reference.clone()
        };
        let all: Vec<usize> = (0..exact.len()).collect();
        let bright = drawn(&|c| (c * 1.003).round_ties_even());
        assert!(Bias::of(&bright, &reference, &on_floats(0.005), &all).is_some());
        assert_eq!(Bias::beyond(&bright, &reference, &on_floats(0.005), &all), None);
        assert_eq!(Bias::beyond(&bright, &reference, &on_floats(0.003_001), &all), None);
        assert!(Bias::beyond(&bright, &reference, &on_floats(0.000_01), &all).is_some());
        let ties =
            StoredImage { pixels: (0..20_000).map(|k| [f64::from(k / 100) + 10.5; 4]).collect(), ..reference.clone() };
        let down =
            StoredImage { pixels: ties.pixels.iter().map(|pixel| pixel.map(f64::floor)).collect(), ..ties.clone() };
        let legal: Vec<LegalPixel> = ties
            .pixels
            .iter()
            .map(|pixel| LegalPixel { low: pixel.map(|c| c / 255.0), high: pixel.map(|c| c / 255.0), is_marked: false })
            .collect();
        assert_eq!(Bias::beyond(&down, &ties, &legal, &all), None);
    }

    #[test]
    fn a_few_colors_say_nothing() {
        let flat = StoredImage {
            width: 100,
            format: TargetFormat::Rgba8Unorm,
            pixels: vec![[78.4, 20.0, 30.0, 255.0]; 10_000],
        };
        let above = StoredImage { pixels: vec![[79.0, 21.0, 31.0, 255.0]; 10_000], ..flat.clone() };
        let expected = vec![LegalPixel { low: [0.0; 4], high: [255.0; 4], is_marked: false }; 10_000];
        let all: Vec<usize> = (0..10_000).collect();
        assert_eq!(Bias::of(&above, &flat, &expected, &all), None);
    }
}
