//! A picture of where an image is wrong, and by how much.

use super::LegalPixel;
use super::file::StoredImage;
use crate::{margin, worse};
use font8x8::legacy::BASIC_LEGACY;
use lightmeter_scene::target::TargetFormat;

/// A colour with the power of ten at which it stands, of an error over the tolerance; between two of them colours are mixed. What is legal
/// is blue, and what is not is yellow to violet.
const LEGAL: [(f64, [f64; 3]); 2] = [(-2.0, [0.0, 0.0, 0.0]), (0.0, [45.0, 65.0, 140.0])];
const WRONG: [(f64, [f64; 3]); 4] =
    [(0.0, [255.0, 235.0, 60.0]), (1.0, [255.0, 140.0, 0.0]), (2.0, [225.0, 0.0, 0.0]), (3.0, [190.0, 0.0, 190.0])];
/// Legal pixels of which more values are legal than of others.
const MARKED: [f64; 3] = [90.0, 90.0, 90.0];

/// The colour of a logarithm.
fn mixed(scale: &[(f64, [f64; 3])], power: f64) -> [f64; 3] {
    let (first, last) = (scale[0], scale[scale.len() - 1]);
    let power = power.clamp(first.0, last.0);
    let pair = scale.windows(2).find(|pair| power <= pair[1].0).unwrap_or(&scale[scale.len() - 2..]);
    let share = (power - pair[0].0) / (pair[1].0 - pair[0].0);
    std::array::from_fn(|k| (pair[0].1[k] + share * (pair[1].1[k] - pair[0].1[k])).round())
}

/// An image of each pixel's distance from the reference over its tolerance, on a scale of logarithms: from black, for a hundredth and less,
/// to blue where it is legal, and from yellow to violet, for a thousand times and more, where it is not. Marked pixels, of which more values
/// are legal since a sample lies near an edge, are grey where they are legal.
#[must_use]
pub fn error_map(image: &StoredImage, reference: &StoredImage, expected: &[LegalPixel]) -> StoredImage {
    let pixels = (0..image.pixels.len()).map(|pixel| {
        let of = |k: usize| {
            let (value, exact) = (image.pixels[pixel][k], reference.pixels[pixel][k]);
            margin(value, exact, expected[pixel].low[k], expected[pixel].high[k])
        };
        let outside = (0..4).any(|k| {
            let value = image.pixels[pixel][k];
            !(expected[pixel].low[k] <= value && value <= expected[pixel].high[k])
        });
        let most = (0..4).map(of).fold(0.0, worse);
        let power = if most.is_nan() { f64::INFINITY } else { most.log10() };
        let [red, green, blue] = match outside {
            false if expected[pixel].is_marked => MARKED,
            false => mixed(&LEGAL, power),
            true => mixed(&WRONG, power),
        };
        [red, green, blue, 255.0]
    });
    StoredImage { width: image.width, format: TargetFormat::Rgba8Unorm, pixels: pixels.collect() }
}

/// Pixels of a power of ten on the legend, of the strip of colours, and of a line of letters.
const DECADE: usize = 40;
const STRIP: usize = 10;
const LINE: usize = 12;
/// Pixels beside the legend, and what it says below the strip.
const MARGIN: usize = 24;
const SAYS: &str = "error/tolerance; grey: edges";

/// The map with a legend below it.
#[must_use]
pub fn with_legend(map: &StoredImage) -> StoredImage {
    let powers = -2..=3;
    let strip = DECADE * (powers.clone().count() - 1);
    let width = map.width.max(strip + 2 * MARGIN);
    let (height, below) = (map.pixels.len() / map.width, STRIP + 2 * LINE + 8);
    let mut pixels = vec![[255.0; 4]; width * (height + below)];
    for (place, pixel) in map.pixels.iter().enumerate() {
        pixels[place / map.width * width + place % map.width] = *pixel;
    }
    let mut put = |x: usize, y: usize, [red, green, blue]: [f64; 3]| {
        if let Some(pixel) = pixels.get_mut((height + y) * width + x).filter(|_| x < width) {
            *pixel = [red, green, blue, 255.0];
        }
    };
    for x in 0..strip {
        #[expect(clippy::cast_precision_loss, reason = "a few pixels")]
        let power = x as f64 / DECADE as f64 - 2.0;
        let color = if power < 0.0 { mixed(&LEGAL, power) } else { mixed(&WRONG, power) };
        (4..4 + STRIP).for_each(|y| put(MARGIN + x, y, color));
    }
    let mut written = |words: &str, left: usize, top: usize| {
        for (place, letter) in words.chars().enumerate() {
            let rows = BASIC_LEGACY.get(letter as usize).copied().unwrap_or_default();
            for (y, row) in rows.into_iter().enumerate() {
                (0..8).filter(|x| row >> x & 1 == 1).for_each(|x| put(left + 8 * place + x, top + y, [0.0; 3]));
            }
        }
    };
    for (place, words) in ["0.01", "0.1", "1", "10", "100", "1000"].into_iter().enumerate() {
        let middle = MARGIN + place * DECADE;
        written(words, middle.saturating_sub(4 * words.len()), 6 + STRIP);
    }
    written(SAYS, 4, 6 + STRIP + LINE);
    StoredImage { width, format: map.format, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_tell_what_is_legal_from_what_is_not_and_how_far_it_is() {
        let expected = LegalPixel { low: [90.0; 4], high: [110.0; 4], is_marked: false };
        let image = |values: [f64; 5]| StoredImage {
            width: 5,
            format: TargetFormat::Rgba8Unorm,
            pixels: values.map(|value| [value; 4]).to_vec(),
        };
        let mut legal = vec![expected; 5];
        legal[4].is_marked = true;
        let map = error_map(&image([100.0, 109.0, 115.0, 200.0, 105.0]), &image([100.0; 5]), &legal);
        let [right, near, wrong, far, marked] = map.pixels[..] else { panic!("five pixels") };
        assert_eq!(right.map(f64::to_bits), [0.0, 0.0, 0.0, 255.0].map(f64::to_bits));
        assert!(near[2] > 100.0 && near[0] < 80.0, "{near:?}");
        assert!(wrong[0] > 200.0 && wrong[1] > 200.0, "{wrong:?}");
        assert!(far[0] > 200.0 && far[1] < 150.0, "{far:?}");
        assert_eq!(marked[..3], MARKED);
    }

    #[test]
    fn a_legend_stands_below_the_map_and_changes_none_of_it() {
        let map = StoredImage {
            width: 3,
            format: TargetFormat::Rgba8Unorm,
            pixels: (0..6_u8).map(|k| [k.into(), 2.0, 3.0, 255.0]).collect(),
        };
        let shown = with_legend(&map);
        assert!(shown.width >= 5 * DECADE && shown.pixels.len().is_multiple_of(shown.width));
        for (place, pixel) in map.pixels.iter().enumerate() {
            let there = shown.pixels[place / 3 * shown.width + place % 3];
            assert_eq!(there.map(f64::to_bits), pixel.map(f64::to_bits));
        }
        let has = |color: [f64; 3]| shown.pixels.iter().any(|pixel| pixel[..3] == color);
        assert!(has([0.0; 3]) && has(mixed(&WRONG, 0.0)) && has(mixed(&WRONG, 2.0)));
    }
}
