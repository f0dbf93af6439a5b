//! What all pixels of an image of 8 bits say together, where each alone is legal.
//!
//! A step of 8 bits hides what is wrong by less. Where a shader is off by a third of a step, a third of the pixels are a step off, all to
//! one side; each is legal wherever arithmetic leaves it to the shader which of two steps is next. So the steps by which pixels differ from the
//! reference, rounded, are added up: of a right image they are few, and as often up as down. Where a shader compiler may be off to one side all over an
//! image, it may be: what fails an image is what is left beyond that.
//!
//! On a float target each pixel tells what it hides, but for what lies within its tolerance. There a bias is counted in tolerances. It is
//! told, and fails nothing, since each pixel may be where it is.

use super::file::StoredImage;
use super::pixel::LegalPixel;
use std::collections::BTreeMap;

/// Standard errors that a bias is more than.
const ERRORS: f64 = 8.0;
/// Steps that it is more than: an eighth of what a target of 8 bits tells apart. On floats, tolerances.
const STEPS: f64 = 0.125;
/// Values of the reference that have to be there, in steps of 8 bits, each of which counts once however many pixels have it.
const LEAST_VALUES: usize = 24;

/// An image to one side of its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bias {
    /// What the values are as if multiplied by; `None` where they are as if something were added.
    pub factor: Option<f64>,
    /// How far it moves values, in steps of 8 bits or in tolerances on floats, negative where it is downwards: the root of the mean square.
    pub steps: f64,
    /// Its standard error, in the same.
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

    /// To which side of its reference an image of floats lies, in tolerances; `None` where it lies to none. Marked pixels say nothing, and neither
    /// do those of which any value or a single one is legal.
    #[must_use]
    pub fn of_floats(
        image: &StoredImage,
        reference: &StoredImage,
        expected: &[LegalPixel],
        pixels: &[usize],
    ) -> Option<Self> {
        let mut values: Means<3> = BTreeMap::new();
        for &pixel in pixels.iter().filter(|&&pixel| !expected[pixel].is_marked) {
            for component in 0..3 {
                let exact = reference.pixels[pixel][component];
                let tolerance = 0.5 * (expected[pixel].high[component] - expected[pixel].low[component]);
                if exact != 0.0 && tolerance > 0.0 && tolerance.is_finite() {
                    let step = (255.0 * exact).round_ties_even();
                    let off = image.pixels[pixel][component] - exact;
                    add(&mut values, component, step, [exact, 1.0, off].map(|x| x / tolerance));
                }
            }
        }
        let points: Vec<Point> =
            values.into_values().map(|sums| mean(&sums)).map(|[x, one, y]| Point { x, one, y }).collect();
        Self::fitted(&points)
    }

    fn fitted(points: &[Point]) -> Option<Self> {
        if points.len() < LEAST_VALUES {
            return None;
        }
        let added = fit(points, |point| point.one);
        let multiplied = fit(points, |point| point.x);
        let is_multiplied = multiplied.rest < added.rest;
        let better = if is_multiplied { multiplied } else { added };
        if better.points < LEAST_POINTS {
            return None;
        }
        let found = Self {
            factor: is_multiplied.then_some(1.0 + better.slope),
            steps: better.slope * better.size,
            error: better.error * better.size,
        };
        // The error is not negative, and may be 0.
        (found.steps.abs() >= STEPS && found.steps.abs() >= ERRORS * found.error).then_some(found)
    }
}

/// Points that a fit has to rest on: of n points of the same weight n, and of others fewer, since one point says by itself what a line is
/// on which it weighs more than all others.
const LEAST_POINTS: f64 = 12.0;

/// What the pixels of a value say together, in steps or in tolerances.
#[derive(Clone, Copy)]
struct Point {
    /// The value, as what a factor multiplies.
    x: f64,
    /// What 1 comes to that is added to it.
    one: f64,
    /// How far the pixels are from it.
    y: f64,
}

/// Sums of numbers, and how many there are of each, by component and value of the reference in whole steps.
type Means<const N: usize> = BTreeMap<(usize, u64), ([f64; N], f64)>;

fn add<const N: usize>(values: &mut Means<N>, component: usize, step: f64, of: [f64; N]) {
    let (sums, count) = values.entry((component, step.to_bits())).or_insert(([0.0; N], 0.0));
    sums.iter_mut().zip(of).for_each(|(sum, x)| *sum += x);
    *count += 1.0;
}

fn mean<const N: usize>((sums, count): &([f64; N], f64)) -> [f64; N] {
    sums.map(|sum| sum / count)
}

/// For each component and each value of the reference in whole steps, that value and the mean of something over the pixels that have it.
fn means(
    reference: &StoredImage,
    pixels: impl Iterator<Item = usize>,
    of: impl Fn(usize, usize, f64) -> f64,
) -> Vec<Point> {
    let mut values: Means<1> = BTreeMap::new();
    for pixel in pixels {
        for component in 0..3 {
            let exact = reference.pixels[pixel][component];
            if (1.0..=254.0).contains(&exact) {
                let nearest = exact.round_ties_even();
                add(&mut values, component, nearest, [of(pixel, component, nearest)]);
            }
        }
    }
    let points = values.into_iter().map(|((_, nearest), sums)| (f64::from_bits(nearest), mean(&sums)));
    points.map(|(x, [y])| Point { x, one: 1.0, y }).collect()
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
    /// How many points of the same weight say as much: (Σw)²/Σw² of the weights w, the squares of what the slope is multiplied by.
    points: f64,
}

/// The line `y = slope·of(point)` of the least squares.
fn fit(points: &[Point], of: impl Fn(&Point) -> f64) -> Line {
    let squares: f64 = points.iter().map(|point| of(point) * of(point)).sum();
    let slope = points.iter().map(|point| of(point) * point.y).sum::<f64>() / squares;
    let left = |point: &Point| point.y - slope * of(point);
    let rest: f64 = points.iter().map(|point| left(point) * left(point)).sum();
    let fourth_powers: f64 = points.iter().map(|point| of(point).powi(4)).sum();
    #[expect(clippy::cast_precision_loss, reason = "no more points than pixels")]
    let count = points.len() as f64;
    Line {
        slope,
        error: (rest / (count - 1.0) / squares).sqrt(),
        size: (squares / count).sqrt(),
        rest,
        points: squares * squares / fourth_powers,
    }
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
    fn on_floats_a_bias_is_counted_in_tolerances() {
        // Rounded at random to within a tenth of a tolerance of 1e-4.
        let exact: Vec<[f64; 4]> = (0..5_000).map(|k| [0.05 + f64::from(k) * 1e-4; 4]).collect();
        let reference = StoredImage { width: 100, format: TargetFormat::Rgba32Float, pixels: exact.clone() };
        let legal = |pixel: &[f64; 4]| LegalPixel {
            low: pixel.map(|c| c * (1.0 - 1e-4)),
            high: pixel.map(|c| c * (1.0 + 1e-4)),
            is_marked: false,
        };
        let expected: Vec<LegalPixel> = exact.iter().map(legal).collect();
        let all: Vec<usize> = (0..exact.len()).collect();
        let found = |factor: f64, added: f64| {
            let noise = |c: f64| 1e-5 * c * (c * 7919.0).sin();
            let drawn = |pixel: &[f64; 4]| pixel.map(|c| c * factor + added + noise(c));
            let image = StoredImage { pixels: exact.iter().map(drawn).collect(), ..reference.clone() };
            Bias::of_floats(&image, &reference, &expected, &all)
        };
        assert_eq!(found(1.0, 0.0), None);
        assert_eq!(found(1.000_01, 0.0), None, "a tenth of the tolerance is too little");
        let bright = found(1.000_03, 0.0).expect("it is to one side");
        assert!(bright.factor.is_some_and(|factor| (factor - 1.000_03).abs() < 1e-6), "{bright:?}");
        assert!((bright.steps - 0.3).abs() < 0.02, "{bright:?}");
        let above = found(1.0, 1e-5).expect("it is to one side");
        assert!(above.factor.is_none() && above.steps > 0.125, "{above:?}");
    }

    #[test]
    fn on_floats_one_value_of_a_small_tolerance_says_nothing() {
        let exact: Vec<[f64; 4]> = (0..40).map(|k| [f64::from(k + 1) * 0.01; 4]).collect();
        let reference = StoredImage { width: 40, format: TargetFormat::Rgba32Float, pixels: exact.clone() };
        let tolerance = |place: usize, c: f64| if place == 30 { 1e-7 * c } else { 1e-4 * c };
        let legal = |(place, pixel): (usize, &[f64; 4])| LegalPixel {
            low: pixel.map(|c| c - tolerance(place, c)),
            high: pixel.map(|c| c + tolerance(place, c)),
            is_marked: false,
        };
        let expected: Vec<LegalPixel> = exact.iter().enumerate().map(legal).collect();
        let mut image = reference.clone();
        image.pixels[30] = image.pixels[30].map(|c| c + 0.9 * tolerance(30, c));
        let all: Vec<usize> = (0..exact.len()).collect();
        assert_eq!(Bias::of_floats(&image, &reference, &expected, &all), None);
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
