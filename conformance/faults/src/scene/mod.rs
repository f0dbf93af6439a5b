//! Which mistake a renderer made, from an image: a frame that is drawn as if it were another, an image that is written as if it
//! were, and pairs of these, tried as explanations of the pixels that fail.

pub mod calibrate;
pub mod selftest;
mod table;

use lightmeter_arithmetic::Profile;
use lightmeter_judge::blend_unit::pixel;
use lightmeter_judge::image::LegalPixel;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_judge::image::{expect, judge};
use lightmeter_reference::Real;
use lightmeter_reference::render::render;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::{Encoding, TargetFormat};
use std::cmp::Reverse;
use table::Change;
pub use table::{SCENE_FAULTS, SceneFault};

/// Pixels that a mistake is tried on first, of those that fail and of those that do not.
const PROBES: usize = 2048;
/// Mistakes that are tried in pairs.
const PAIRED: usize = 3;
/// With so many others.
const OTHERS: usize = 24;
/// The part of the failing components that an explanation explains at least.
const WHOLE: f64 = 0.9;
/// The same of two mistakes at once, which fit more by themselves.
const WHOLE_OF_TWO: f64 = 0.98;
/// The passing components that may contradict an explanation, as a part of the failing ones.
const MOST_CONTRADICTED: f64 = 0.02;
/// How far from a whole step a value may be that is one.
const STEP_ERROR: f64 = 1e-6;
/// Explanations that are tried with all that is legal.
const MOST_TRIED: usize = 5;

/// What may have been drawn in a frame's place.
#[derive(Clone, Debug)]
pub struct SceneExplanation {
    /// The mistakes.
    pub faults: Vec<&'static SceneFault>,
    /// Failing components that are legal of it.
    pub explained: usize,
    /// Passing components that are, too.
    pub consistent: usize,
    /// How far some of the failing ones are from what these mistakes draw in f64, together, in units.
    pub distance: f64,
}

/// What a renderer did wrong in a scene.
#[derive(Clone, Debug)]
pub struct SceneDiagnosis {
    /// Components that fail.
    pub failing: usize,
    /// The best first.
    pub explanations: Vec<SceneExplanation>,
    /// The outcome as a sentence.
    pub sentence: String,
}

impl SceneFault {
    /// The frame with the mistake; as it is, of one that changes the image alone.
    #[must_use]
    pub fn frame(&self, mut frame: Frame) -> Frame {
        if let Change::Frame(change) = self.change {
            change(&mut frame);
        }
        frame
    }

    /// Linear values with the mistake.
    fn image(&self, pixels: &mut Vec<[f64; 4]>, width: usize) {
        if let Change::Image(change) = self.change {
            change(pixels, width);
        }
    }

    const fn is_of_frame(&self) -> bool {
        matches!(self.change, Change::Frame(_))
    }
}

/// A frame with mistakes.
fn with(frame: &Frame, faults: &[&'static SceneFault]) -> Frame {
    faults.iter().fold(frame.clone(), |frame, fault| fault.frame(frame))
}

/// What a renderer with these mistakes draws in an arithmetic, in the target's units, rounded to it.
#[must_use]
pub fn draw<R: Real + Into<f64> + Send + Sync>(frame: &Frame, faults: &[&'static SceneFault]) -> StoredImage {
    let format = frame.target.format;
    let mut image = render::<R>(&with(frame, faults), None, None);
    faults.iter().for_each(|fault| fault.image(&mut image.pixels, image.width));
    StoredImage::of(&image, format)
}

/// An image and all that is known of it.
pub struct Trial<'a> {
    frame: &'a Frame,
    image: &'a StoredImage,
    profile: &'a Profile,
    /// The numbers of components that fail, and of some that do not.
    failing: Vec<usize>,
    passing: Vec<usize>,
    /// How far a value may be from the middle of what is legal, in units.
    room: Vec<f64>,
}

impl<'a> Trial<'a> {
    /// An image with what is legal of it.
    #[must_use]
    pub fn new(frame: &'a Frame, image: &'a StoredImage, expected: &[LegalPixel], profile: &'a Profile) -> Self {
        let (mut failing, mut passing, mut room) = (vec![], vec![], vec![]);
        for (pixel, (value, legal)) in image.pixels.iter().zip(expected).enumerate() {
            for (k, value) in value.iter().enumerate() {
                let (low, high) = (legal.low[k], legal.high[k]);
                room.push((high - low).min(f64::MAX));
                let inside = (low..=high).contains(value);
                if !inside {
                    failing.push(4 * pixel + k);
                } else if !legal.is_marked {
                    passing.push(4 * pixel + k);
                }
            }
        }
        Self { frame, image, profile, failing, passing, room }
    }

    /// Tries what the catalogue knows.
    #[must_use]
    pub fn diagnose(&self) -> SceneDiagnosis {
        if self.flat().is_some() {
            return SceneDiagnosis { failing: self.failing.len(), explanations: vec![], sentence: self.sentence(None) };
        }
        let mut found = self.ranked(SCENE_FAULTS.iter().map(|fault| vec![fault]).collect());
        if self.failing.is_empty() {
            return SceneDiagnosis { failing: 0, explanations: vec![], sentence: "nothing fails".into() };
        }
        let best = |found: &[SceneExplanation]| found.first().map_or(0, |best| best.explained);
        #[expect(clippy::cast_precision_loss, reason = "counts of components")]
        let enough = |count: usize| count as f64 >= WHOLE * self.failing.len() as f64;
        if !enough(best(&found)) {
            found.extend(self.ranked(self.pairs()));
        }
        let key = |one: &SceneExplanation| (Reverse(one.explained), Reverse(one.consistent), one.faults.len());
        found.sort_by(|a, b| key(a).cmp(&key(b)).then(a.distance.total_cmp(&b.distance)));
        #[expect(clippy::cast_precision_loss, reason = "counts of components")]
        let has = |count: usize, share: f64, all: usize| count as f64 >= share * all as f64;
        // What pixels that pass contradict is not what was done.
        found.retain(|one| {
            let whole = if one.faults.len() > 1 { WHOLE_OF_TWO } else { WHOLE };
            let contradicted = self.passing.len() - one.consistent;
            has(one.explained, whole, self.failing.len())
                && !has(contradicted, MOST_CONTRADICTED, self.failing.len().max(1))
        });
        let sentence = self.sentence(found.first());
        SceneDiagnosis { failing: self.failing.len(), explanations: found, sentence }
    }

    /// The colour of an image that has no other, in units: it says nothing of how it came about.
    fn flat(&self) -> Option<[f64; 4]> {
        let (first, rest) = self.image.pixels.split_first()?;
        let is_same = |pixel: &[f64; 4]| pixel.iter().zip(first).all(|(a, b)| a.to_bits() == b.to_bits());
        (!rest.is_empty() && rest.iter().all(is_same)).then_some(*first)
    }

    fn sentence(&self, best: Option<&SceneExplanation>) -> String {
        let all = self.failing.len();
        let Some(best) = best else {
            let told = format!("nothing in the catalogue explains the {all} failing components of pixels");
            let flat = self.flat().map(|[r, g, b, a]| format!(": the whole image is {r} {g} {b} {a}"));
            return told + &flat.unwrap_or_default();
        };
        let says: Vec<&str> = best.faults.iter().map(|fault| fault.says).collect();
        format!("{} of {all} failing components of pixels are explained by: {}", best.explained, says.join(", and "))
    }

    /// The mistakes that come nearest by the middle of what is legal, each tried with all that is legal of it.
    fn ranked(&self, candidates: Vec<Vec<&'static SceneFault>>) -> Vec<SceneExplanation> {
        let mut near: Vec<((usize, f64), Vec<&'static SceneFault>)> =
            candidates.into_iter().filter_map(|faults| Some((self.probe(&faults)?, faults))).collect();
        near.sort_by(|(a, _), (b, _)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let probes = self.failing.len().min(PROBES);
        near.retain(|((misses, _), _)| 2 * misses <= probes);
        near.truncate(MOST_TRIED);
        near.into_iter().map(|((_, distance), faults)| self.tried(faults, distance)).collect()
    }

    /// The failing components, of some, that are not near what these mistakes draw in f64, and the passing ones, and how far the
    /// failing ones are from that; `None` where they change nothing.
    fn probe(&self, faults: &[&'static SceneFault]) -> Option<(usize, f64)> {
        let frame = with(self.frame, faults);
        let changes_frame = faults.iter().any(|fault| fault.is_of_frame());
        if changes_frame && frame == *self.frame {
            return None;
        }
        let drawn = draw::<f64>(self.frame, faults);
        let is_far = |number: usize| {
            let (pixel, k) = (number / 4, number % 4);
            let near = 2.0 * self.room[number] + slack(self.image.format, drawn.pixels[pixel][k]) * 4.0;
            let distance = (self.image.pixels[pixel][k] - drawn.pixels[pixel][k]).abs();
            // What is no number is far from everything.
            distance.is_nan() || distance > near
        };
        let far = |of: &[usize]| spread(of, PROBES).filter(|&number| is_far(number)).count();
        let distance = spread(&self.failing, PROBES)
            .map(|number| (self.image.pixels[number / 4][number % 4] - drawn.pixels[number / 4][number % 4]).abs())
            .sum();
        Some((far(&self.failing) + far(&self.passing), distance))
    }

    fn tried(&self, faults: Vec<&'static SceneFault>, distance: f64) -> SceneExplanation {
        let frame = with(self.frame, &faults);
        let legal = expect(&frame, None, None, self.profile);
        let format = self.image.format;
        let ends = |end: fn(&LegalPixel) -> [f64; 4]| -> Vec<[f64; 4]> {
            let linear = |legal: &LegalPixel| -> [f64; 4] {
                let units = end(legal);
                std::array::from_fn(|k| pixel::linear(format, k, units[k]))
            };
            let mut pixels: Vec<[f64; 4]> = legal.iter().map(linear).collect();
            faults.iter().for_each(|fault| fault.image(&mut pixels, self.image.width));
            let units = |pixel: [f64; 4]| std::array::from_fn(|k| pixel::units(format, k, pixel[k]));
            pixels.into_iter().map(units).collect()
        };
        let (low, high) = (ends(|legal| legal.low), ends(|legal| legal.high));
        let changes_image = faults.iter().any(|fault| !fault.is_of_frame());
        let is_legal = |number: &usize| {
            let (pixel, k) = (number / 4, number % 4);
            let (low, high, value) = (low[pixel][k], high[pixel][k], self.image.pixels[pixel][k]);
            // The legal values of a frame are all that may be stored; those of a changed image were changed after that, and are
            // stored now: on steps, at either neighbour.
            let [low, high] = match format.encoding() {
                _ if !changes_image => [low, high],
                Encoding::Unorm8 | Encoding::Srgb8 => [(low + STEP_ERROR).floor(), (high - STEP_ERROR).ceil()],
                Encoding::Float16 | Encoding::Float32 => [low - slack(format, value), high + slack(format, value)],
            };
            low <= value && value <= high
        };
        let count = |of: &[usize]| of.iter().filter(|number| is_legal(number)).count();
        SceneExplanation { explained: count(&self.failing), consistent: count(&self.passing), faults, distance }
    }

    /// Pairs of those that explain the most, with each of all.
    fn pairs(&self) -> Vec<Vec<&'static SceneFault>> {
        let mut singles: Vec<((usize, f64), &'static SceneFault)> =
            SCENE_FAULTS.iter().filter_map(|fault| Some((self.probe(&[fault])?, fault))).collect();
        singles.sort_by(|(a, _), (b, _)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let first: Vec<&'static SceneFault> = singles.iter().take(PAIRED).map(|(_, fault)| *fault).collect();
        let mut pairs = vec![];
        for (place, &one) in first.iter().enumerate() {
            for &(_, other) in singles.iter().take(OTHERS) {
                let is_known = first[..=place].iter().any(|known| std::ptr::eq(*known, other));
                if !is_known {
                    pairs.push(vec![one, other]);
                }
            }
        }
        pairs
    }
}

/// So many of them, evenly.
fn spread(of: &[usize], most: usize) -> impl Iterator<Item = usize> {
    of.iter().copied().step_by(of.len().div_ceil(most).max(1))
}

/// What the store of a changed image may add, in units.
fn slack(format: TargetFormat, value: f64) -> f64 {
    match format.encoding() {
        Encoding::Unorm8 | Encoding::Srgb8 => 1.0,
        Encoding::Float16 => (value.abs() / 1024.0).max(1e-7),
        Encoding::Float32 => (value.abs() * 1e-6).max(1e-9),
    }
}

/// The failing components and the passing ones of an image, by a judgement that is at hand.
#[must_use]
pub fn fails(image: &StoredImage, reference: &StoredImage, expected: &[LegalPixel]) -> bool {
    let all: Vec<usize> = (0..image.pixels.len()).collect();
    !judge::judge(image, reference, expected, &all).misses.is_empty()
}
