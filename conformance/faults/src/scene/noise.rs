//! Noise in the place of scenes: images that come of no mistake. None of them may be explained, unless a renderer that makes the mistake
//! draws it.

use super::{PixelPart, SceneExplanation, Trial};
use crate::noise::{LEAST_GIVEN, random};
use crate::selftest::SelftestOptions;
use lightmeter_catalogue::scene::SceneError;
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::select::{builtin, scene_id};
use lightmeter_document::selftest::{ExplainedNoise, NoiseRecord};
use lightmeter_judge::image::expect;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_reference::render::{Image, render};
use rayon::prelude::*;
use std::fmt;

/// What is drawn in a scene's place, in linear colours.
enum Noise<'a> {
    /// One colour.
    Constant([f64; 4]),
    /// Numbers from 0 to 1 that depend on nothing.
    Unit,
    /// Numbers between the least and the greatest right one of the component.
    InRange,
    /// The column and the row, as parts of the width and the height.
    Place,
    /// Right colours, each at another place.
    Shuffled,
    /// Another scene.
    Other(&'a str, &'a Image),
}

impl fmt::Display for Noise<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(color) => write!(f, "{color:?} everywhere"),
            Self::Unit => f.write_str("random colours"),
            Self::InRange => f.write_str("random colours within the range of the right ones"),
            Self::Place => f.write_str("the pixel's column and row"),
            Self::Shuffled => f.write_str("the right colours in another order"),
            Self::Other(id, _) => write!(f, "the image of {id}"),
        }
    }
}

/// Scenes that stand in another's place.
const OTHERS: usize = 6;

/// Draws every kind of noise, with and without the right alpha, in the place of each built-in scene that a filter selects, `size` pixels on its
/// longer side. Gives what was explained although it should not be. When it is told to stop, it begins no further scene.
///
/// # Errors
/// Where a scene is refused, which a test rules out.
pub fn noise(size: u32, options: &SelftestOptions, progress: &mut impl FnMut(&str)) -> Result<NoiseRecord, SceneError> {
    let images = (0..SCENES.len())
        .map(|place| Ok(render::<f64>(&builtin(place, Some(size))?.frame, None, None)))
        .collect::<Result<Vec<Image>, SceneError>>()?;
    let ids: Vec<String> = (0..SCENES.len()).map(scene_id).collect();
    let mut record = NoiseRecord::default();
    let SelftestOptions { filter, profile, stop, .. } = options;
    for (place, right) in images.iter().enumerate() {
        if stop.is_set() {
            break;
        }
        if !filter.is_empty() && !filter.selects(&ids[place]) {
            continue;
        }
        progress(&ids[place]);
        let frame = builtin(place, Some(size))?.frame;
        let expected = expect(&frame, None, None, profile);
        let constants = [[0.0; 4], [1.0; 4], [0.5; 4], [0.9, 0.8, 0.7, 1.0], [0.1, 0.7, 0.3, 0.0]];
        let others = (1..=OTHERS).map(|k| (place + 7 * k) % SCENES.len()).filter(|other| *other != place);
        let others = others.map(|other| Noise::Other(&ids[other], &images[other]));
        let all = constants.map(Noise::Constant).into_iter();
        let all: Vec<Noise<'_>> =
            all.chain([Noise::Unit, Noise::InRange, Noise::Place, Noise::Shuffled]).chain(others).collect();
        let tried: Vec<(&Noise<'_>, bool)> = all.iter().flat_map(|noise| [(noise, false), (noise, true)]).collect();
        record.tried += tried.len() as u64;
        let explained = tried.into_par_iter().flat_map_iter(|(noise, keeps_alpha)| {
            let image = StoredImage::of(&drawn(right, noise, keeps_alpha), frame.target.format);
            let trial = Trial::new(&frame, &image, &expected, profile);
            let found = trial.diagnose();
            let whole = found.explanations.first().map(|best| (PixelPart::Whole, best));
            let parts = found.parts.iter().filter_map(|(part, all)| Some((*part, all.first()?)));
            let one = |(part, best): (PixelPart, &SceneExplanation)| {
                let given = trial.given(best, part);
                ExplainedNoise {
                    formula: ids[place].clone(),
                    noise: if keeps_alpha { format!("{noise}, with the right alpha") } else { noise.to_string() },
                    says: best.says(),
                    given,
                    is_made: given >= LEAST_GIVEN,
                }
            };
            whole.into_iter().chain(parts).map(one).collect::<Vec<_>>()
        });
        record.explained.extend(explained.collect::<Vec<_>>());
    }
    Ok(record)
}

/// The image of a kind of noise, of the size of the right one.
fn drawn(right: &Image, noise: &Noise<'_>, keeps_alpha: bool) -> Image {
    let (width, height) = (right.width, right.height);
    let range = |k: usize| {
        let all = right.pixels.iter().map(|pixel| pixel[k]);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    };
    let ranges: [[f64; 2]; 4] = std::array::from_fn(range);
    let color = |number: usize| {
        let unit: [f64; 4] = std::array::from_fn(|k| random(number, k));
        let mut color = match noise {
            Noise::Constant(color) => *color,
            Noise::Unit => unit,
            Noise::InRange => std::array::from_fn(|k| ranges[k][0] + unit[k] * (ranges[k][1] - ranges[k][0])),
            Noise::Place => {
                let [x, y] = [part(number % width, width), part(number / width, height)];
                [x, y, 0.5, 1.0]
            }
            // Prime to the number of pixels of any image whose sides are powers of two, and to most others.
            Noise::Shuffled => right.pixels[(7919 * number + 13) % right.pixels.len()],
            Noise::Other(_, image) => image.pixels[number % image.pixels.len()],
        };
        if keeps_alpha {
            color[3] = right.pixels[number][3];
        }
        color
    };
    Image { width, height, pixels: (0..right.pixels.len()).map(color).collect(), fragments: 0 }
}

#[expect(clippy::cast_precision_loss, reason = "sides of images")]
fn part(of: usize, all: usize) -> f64 {
    of as f64 / all.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::filter::Filter;
    use lightmeter_document::event::Stop;

    #[test]
    #[ignore = "long: ./x campaign long"]
    fn no_noise_in_the_place_of_a_scene_is_explained() {
        let filter = Filter::new::<&str>(&[]).expect("it selects all");
        let options = SelftestOptions { filter, cases: 0, seed: 1, draws: 0, profile: &WGSL, stop: Stop::default() };
        let record = noise(40, &options, &mut |_| {}).expect("the scenes load");
        let false_ones: Vec<_> = record.explained.iter().filter(|one| !one.is_made).collect();
        assert!(record.tried > 500 && false_ones.is_empty(), "{false_ones:#?}");
    }
}
