//! Mistakes tried as explanations of the pixels that fail. Only pixels that are looked at are drawn anew: a part of those that fail
//! and of those that pass. What explains them is then held against the whole image.

mod chance;
mod common;
mod parameter;

use super::{SCENE_FAULTS, SceneFault, colors, draw, draw_at, places, with};
use crate::evidence::LEAST_EVIDENCE;
use lightmeter_arithmetic::Profile;
use lightmeter_document::report::{Counted, Diagnosis, Explanation, PartDiagnosis, Standing, Telling, ToldApart};
use lightmeter_document::{Number, Word};
use lightmeter_judge::blend_unit::pixel;
use lightmeter_judge::image::LegalPixel;
use lightmeter_judge::image::expect::Expectation;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::{Encoding, TargetFormat};
use parameter::{FACTORS, PARAMETERS, STEPS, Scaled};
use rayon::prelude::*;
use std::borrow::Cow;
use std::cmp::Reverse;
use std::ops::Range;

/// Pixels that are looked at, of those that fail and of those that do not.
const LOOKED_AT: usize = 512;
/// The number of mistakes, the nearest ones, that pairs are made of.
const PAIRED: usize = 3;
/// The number of other mistakes that each of them is paired with.
const OTHERS: usize = 24;
/// The part of the failing components that an explanation explains at least.
const WHOLE: f64 = 0.9;
/// The same of two mistakes at once, which fit more by themselves.
const WHOLE_OF_TWO: f64 = 0.98;
/// The passing components that may contradict an explanation, as a part of the failing ones.
const MOST_CONTRADICTED: f64 = 0.02;
/// The tolerance within which a value counts as a whole step of the target.
const STEP_ERROR: f64 = 1e-6;
/// Explanations that are tried with all that is legal.
const MOST_TRIED: usize = 5;

/// What may have been drawn in a frame's place.
#[derive(Clone, Debug)]
pub struct SceneExplanation {
    /// The mistakes.
    pub faults: Vec<&'static SceneFault>,
    /// A parameter that is wrong.
    scaled: Option<Scaled>,
    /// How unlikely it is that chance explains as much, in bits.
    evidence: f64,
    /// Failing components that are legal of it, of those that were looked at.
    pub explained: usize,
    /// Passing components that are not, in the whole image: counted where few are, else estimated.
    pub contradicted: f64,
    /// How far the failing ones are from what these mistakes draw in f64, together, in units.
    pub distance: f64,
    /// The pixels that were looked at, as these mistakes draw them in f64.
    drawn: Vec<[f64; 4]>,
}

/// What a renderer did wrong in a scene.
#[derive(Clone, Debug)]
pub struct SceneDiagnosis {
    /// Components that fail.
    pub failing: usize,
    /// The best first.
    pub explanations: Vec<SceneExplanation>,
    /// Where nothing explains whole pixels: what explains colour and alpha, each by itself.
    pub parts: Vec<(PixelPart, Vec<SceneExplanation>)>,
    /// What a report says of it.
    pub diagnosis: Diagnosis,
}

/// Components of pixels that are diagnosed together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelPart {
    /// All four.
    Whole,
    /// Red, green and blue.
    Color,
    /// Alpha.
    Alpha,
}

impl PixelPart {
    const fn components(self) -> Range<usize> {
        match self {
            Self::Whole => 0..4,
            Self::Color => 0..3,
            Self::Alpha => 3..4,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Whole => "pixels",
            Self::Color => "color",
            Self::Alpha => "color.a",
        }
    }
}

/// An image and all that is known of it.
pub struct Trial<'a> {
    frame: &'a Frame,
    image: &'a StoredImage,
    expected: &'a [LegalPixel],
    profile: &'a Profile,
    /// The components that it is of: others count neither as failing nor as passing.
    part: PixelPart,
    /// Components that fail, and those that pass and are not of marked pixels.
    failing: Vec<usize>,
    passing: usize,
    /// The pixels that are looked at, in their order.
    looked_at: Vec<usize>,
    /// Their components that fail, and those that pass: the place among those that are looked at, and the component.
    failing_there: Vec<(usize, usize)>,
    passing_there: Vec<(usize, usize)>,
    /// The linear colours of the right image there.
    right: Vec<[f64; 4]>,
}

/// How close the image that these mistakes draw in f64 comes to the given image: a cheap test before legal bounds are computed.
struct Near {
    misses: usize,
    distance: f64,
    made: Made,
    drawn: Vec<[f64; 4]>,
}

/// What may have been done wrong.
#[derive(Clone, Debug)]
struct Made {
    faults: Vec<&'static SceneFault>,
    scaled: Option<Scaled>,
}

impl Made {
    /// The frame with the wrong parameter, without the mistakes.
    fn base<'f>(&self, frame: &'f Frame) -> Cow<'f, Frame> {
        self.scaled.map_or(Cow::Borrowed(frame), |scaled| Cow::Owned(scaled.frame(frame)))
    }
}

impl<'a> Trial<'a> {
    /// An image with what is legal of it.
    #[must_use]
    pub fn new(frame: &'a Frame, image: &'a StoredImage, expected: &'a [LegalPixel], profile: &'a Profile) -> Self {
        Self::of(PixelPart::Whole, frame, image, expected, profile)
    }

    fn of(
        part: PixelPart,
        frame: &'a Frame,
        image: &'a StoredImage,
        expected: &'a [LegalPixel],
        profile: &'a Profile,
    ) -> Self {
        let components = part.components();
        let (mut failing, mut passing) = (vec![], 0);
        let (mut wrong, mut right) = (vec![], vec![]);
        for (number, (value, legal)) in image.pixels.iter().zip(expected).enumerate() {
            let before = failing.len();
            failing.extend(components.clone().filter(|&k| !is_within(value, legal, k)).map(|k| 4 * number + k));
            let found = failing.len() - before;
            passing += if legal.is_marked { 0 } else { components.len() - found };
            if found > 0 {
                wrong.push(number);
            } else {
                right.push(number);
            }
        }
        let mut looked_at: Vec<usize> = spread(&wrong, LOOKED_AT).chain(spread(&right, LOOKED_AT)).collect();
        looked_at.sort_unstable();
        let (mut failing_there, mut passing_there) = (vec![], vec![]);
        for (place, &number) in looked_at.iter().enumerate() {
            let (value, legal) = (&image.pixels[number], &expected[number]);
            for k in components.clone() {
                if !is_within(value, legal, k) {
                    failing_there.push((place, k));
                } else if !legal.is_marked {
                    passing_there.push((place, k));
                }
            }
        }
        let right = lightmeter_reference::render::render_at::<f64>(frame, &looked_at);
        Self { frame, image, expected, profile, part, failing, passing, looked_at, failing_there, passing_there, right }
    }

    /// Tries what the catalogue knows: of whole pixels, and where nothing explains them, of colour and alpha apart.
    #[must_use]
    pub fn diagnose(&self) -> SceneDiagnosis {
        let mut found = self.diagnosed();
        if found.failing > 0 && found.explanations.is_empty() {
            let parts: Vec<(PixelPart, SceneDiagnosis)> = [PixelPart::Color, PixelPart::Alpha]
                .map(|part| (part, Self::of(part, self.frame, self.image, self.expected, self.profile).diagnosed()))
                .into_iter()
                .filter(|(_, found)| found.failing > 0)
                .collect();
            if parts.len() > 1 && parts.iter().any(|(_, found)| !found.explanations.is_empty()) {
                for (part, SceneDiagnosis { explanations, diagnosis, .. }) in parts {
                    let failing = diagnosis.looked_at;
                    let told = PartDiagnosis::new(part.name().to_owned(), Diagnosis { failing, ..diagnosis });
                    found.parts.push((part, explanations));
                    found.diagnosis.parts.push(told);
                }
            }
        }
        found
    }

    /// What explains the components of this part.
    fn diagnosed(&self) -> SceneDiagnosis {
        let failing = self.failing.len();
        if failing == 0 {
            let diagnosis = Diagnosis { counts: Counted::Components, ..Diagnosis::default() };
            return SceneDiagnosis { failing, explanations: vec![], parts: vec![], diagnosis };
        }
        if self.flat().is_some() {
            return self.told(vec![]);
        }
        let singles = self.near(SCENE_FAULTS.iter().map(|fault| vec![fault]).collect());
        let pairs = pairs(&singles);
        let (mut found, mut candidates) = (self.tried(singles), SCENE_FAULTS.len());
        if found.is_empty() {
            candidates += PARAMETERS.len() * FACTORS.len() * STEPS;
            found = self.tried(self.scaled());
        }
        if found.is_empty() {
            candidates = SCENE_FAULTS.len() + pairs.len();
            found = self.tried(self.near(pairs));
        }
        // An explanation that is no better than chance is dropped, and no more complicated explanation is tried in its place.
        found.retain(|one| one.evidence >= real(candidates).log2() + LEAST_EVIDENCE);
        self.told(found)
    }

    /// What a report says of what was found.
    fn told(&self, explanations: Vec<SceneExplanation>) -> SceneDiagnosis {
        let all = self.failing.len() as u64;
        let mut diagnosis = Diagnosis { counts: Counted::Components, failing: all, ..Diagnosis::default() };
        match explanations.first() {
            None => (diagnosis.looked_at, diagnosis.in_common) = (all, self.in_common()),
            Some(best) => {
                diagnosis.looked_at = self.failing_there.len() as u64;
                let is_equal =
                    |other: &SceneExplanation| other.explained == best.explained && other.drawn == best.drawn;
                let standing = |place: usize, one: &SceneExplanation| match place {
                    0 => Standing::Best,
                    _ if is_equal(one) => Standing::Equal,
                    _ => Standing::Next,
                };
                let told = |(place, one): (usize, &SceneExplanation)| one.told(standing(place, one));
                diagnosis.explanations = explanations.iter().enumerate().take(MOST_TRIED).map(told).collect();
                let next = diagnosis.explanations.iter().position(|one| one.standing == Standing::Next);
                if let Some(next) = next {
                    match self.telling(best, &explanations[next]) {
                        Some(Telltale::Near) => diagnosis.explanations[next].standing = Standing::Near,
                        Some(Telltale::At(telling)) => diagnosis.telling = Some(Telling { next, ..telling }),
                        None => {}
                    }
                }
            }
        }
        let failing = self.failing.len();
        SceneDiagnosis { failing, explanations, parts: vec![], diagnosis }
    }

    /// The mistakes that change something, the nearest first.
    fn near(&self, candidates: Vec<Vec<&'static SceneFault>>) -> Vec<Near> {
        let made = |faults| Made { faults, scaled: None };
        nearest_first(candidates.into_par_iter().filter_map(|faults| self.probe(made(faults))).collect())
    }

    /// How near these mistakes come; `None` where they change nothing.
    fn probe(&self, made: Made) -> Option<Near> {
        let format = self.image.format;
        let faults = &made.faults;
        let drawn = if made.scaled.is_none() && faults.iter().all(|fault| fault.is_of_color()) {
            let mut pixels = self.right.clone();
            colors(&mut pixels, faults);
            pixels.into_iter().map(|color| stored(format, color)).collect()
        } else if faults.iter().any(|fault| fault.is_of_frame()) && with(self.frame, faults) == *self.frame {
            return None;
        } else {
            draw_at(&made.base(self.frame), faults, &self.looked_at)
        };
        let value = |&(place, k): &(usize, usize)| (self.image.pixels[self.looked_at[place]][k], drawn[place][k]);
        let is_far = |of: &&(usize, usize)| {
            let (value, drawn) = value(of);
            let near = 2.0 * self.room(self.looked_at[of.0], of.1) + slack(format, drawn) * 4.0;
            let distance = (value - drawn).abs();
            // What is no number is far from everything.
            distance.is_nan() || distance > near
        };
        let misses =
            self.failing_there.iter().filter(is_far).count() + self.passing_there.iter().filter(is_far).count();
        let distance = self.failing_there.iter().map(value).map(|(value, drawn)| (value - drawn).abs()).sum();
        Some(Near { misses, distance, made, drawn })
    }

    /// How far a value may be from the middle of what is legal, in units.
    fn room(&self, number: usize, k: usize) -> f64 {
        let legal = &self.expected[number];
        (legal.high[k] - legal.low[k]).min(f64::MAX)
    }

    /// The nearest, each held against all that is legal of it: those that explain what fails, the best first.
    fn tried(&self, mut near: Vec<Near>) -> Vec<SceneExplanation> {
        near.retain(|near| 2 * near.misses <= self.failing_there.len());
        near.truncate(MOST_TRIED);
        let mut found: Vec<SceneExplanation> = near.into_iter().filter_map(|near| self.explanation(near)).collect();
        let key = |one: &SceneExplanation| (Reverse(one.explained), one.faults.len());
        found.sort_by(|a, b| {
            let by_contradiction = a.contradicted.total_cmp(&b.contradicted);
            key(a).cmp(&key(b)).then(by_contradiction).then(a.distance.total_cmp(&b.distance))
        });
        found
    }

    /// An explanation, where it explains nearly all that fails and what passes does not contradict it.
    fn explanation(&self, Near { distance, made, drawn, .. }: Near) -> Option<SceneExplanation> {
        let legal = self.legal(&made, &self.looked_at);
        let is_legal = |&&(place, k): &&(usize, usize)| {
            let ([low, high], value) = (legal[place][k], self.image.pixels[self.looked_at[place]][k]);
            low <= value && value <= high
        };
        let explained = self.failing_there.iter().filter(is_legal).count();
        let whole = if made.faults.len() > 1 { WHOLE_OF_TWO } else { WHOLE };
        if real(explained) < whole * real(self.failing_there.len()) {
            return None;
        }
        let passing = self.passing_there.len();
        let contradicted = passing - self.passing_there.iter().filter(is_legal).count();
        let estimated = real(contradicted) * real(self.passing) / real(passing.max(1));
        let contradicted = estimated.max(self.contradicted(&made));
        if contradicted >= MOST_CONTRADICTED * real(self.failing.len()) {
            return None;
        }
        let evidence = self.bits(&legal, &drawn);
        let Made { faults, scaled } = made;
        Some(SceneExplanation { faults, scaled, evidence, explained, contradicted, distance, drawn })
    }

    /// The legal values of some pixels where these mistakes are made: the least and the greatest of each component.
    fn legal(&self, made: &Made, pixels: &[usize]) -> Vec<[[f64; 2]; 4]> {
        let faults = &made.faults;
        let (frame, format) = (with(&made.base(self.frame), faults), self.image.format);
        let legal = Expectation::new(&frame, None, None, self.profile).at(&places(&frame, pixels, faults));
        let changes_color = faults.iter().any(|fault| fault.is_of_color());
        let ends = |legal: &LegalPixel| {
            if !changes_color {
                return std::array::from_fn(|k| [legal.low[k], legal.high[k]]);
            }
            // The bounds of a frame already include the rounding of the store. A mistake that changes colours acts before the store, so the
            // changed bounds have to be rounded once more: on an 8-bit target, outward to the neighbouring steps.
            let [low, high] = [legal.low, legal.high].map(|units| {
                let mut pixels = [std::array::from_fn(|k| pixel::linear(format.encoding(), k, units[k]))];
                colors(&mut pixels, faults);
                unrounded(format, pixels[0])
            });
            std::array::from_fn(|k| match format.encoding() {
                Encoding::Unorm8 | Encoding::Srgb8 => [(low[k] + STEP_ERROR).floor(), (high[k] - STEP_ERROR).ceil()],
                Encoding::Float16 | Encoding::Float32 => {
                    [low[k] - slack(format, low[k]), high[k] + slack(format, high[k])]
                }
            })
        };
        legal.iter().map(ends).collect()
    }

    /// The passing components of the whole image that are far from what these mistakes draw, and that are not legal of them; where
    /// they are many, a part of them is tried.
    fn contradicted(&self, made: &Made) -> f64 {
        let drawn = draw::<f64>(&made.base(self.frame), &made.faults);
        let far: Vec<(usize, usize)> = (0..drawn.pixels.len())
            .filter(|&number| !self.expected[number].is_marked)
            .flat_map(|number| self.part.components().map(move |k| (number, k)))
            .filter(|&(number, k)| {
                let (value, there) = (self.image.pixels[number][k], drawn.pixels[number][k]);
                let is_far = (value - there).abs() > slack(self.image.format, value);
                is_far && is_within(&self.image.pixels[number], &self.expected[number], k)
            })
            .collect();
        let tried: Vec<(usize, usize)> = spread(&far, LOOKED_AT).collect();
        let pixels: Vec<usize> = tried.iter().map(|&(number, _)| number).collect();
        let legal = self.legal(made, &pixels);
        let is_legal = |((number, k), legal): (&(usize, usize), &[[f64; 2]; 4])| {
            let ([low, high], value) = (legal[*k], self.image.pixels[*number][*k]);
            low <= value && value <= high
        };
        let contradicted = tried.iter().zip(&legal).filter(|&of| !is_legal(of)).count();
        real(contradicted) * real(far.len()) / real(tried.len().max(1))
    }

    /// The failing pixel at which two explanations draw what is least alike.
    fn telling(&self, best: &SceneExplanation, next: &SceneExplanation) -> Option<Telltale> {
        let apart = |&(place, k): &(usize, usize)| (best.drawn[place][k] - next.drawn[place][k]).abs();
        let is_best = |&&(place, k): &&(usize, usize)| {
            let value = self.image.pixels[self.looked_at[place]][k];
            (value - best.drawn[place][k]).abs() < (value - next.drawn[place][k]).abs()
        };
        let at = self.failing_there.iter().filter(is_best).max_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        let (number, width) = (self.looked_at[at.0], self.image.width);
        let shown = |value: f64| if value.fract() == 0.0 { format!("{value}") } else { format!("{value:.4}") };
        let [here, there] = [best.drawn[at.0][at.1], next.drawn[at.0][at.1]].map(shown);
        if here == there {
            return Some(Telltale::Near);
        }
        let [value, first, next] =
            [self.image.pixels[number][at.1], best.drawn[at.0][at.1], next.drawn[at.0][at.1]].map(Number);
        let shown = ToldApart { component: NAMES[at.1].into(), value, first, next };
        Some(Telltale::At(Telling {
            case: format!("{},{}", number % width, number / width),
            next: 0,
            shown: Some(shown),
        }))
    }
}

impl Trial<'_> {
    /// The part of the failing components that a renderer which makes these mistakes gives itself.
    pub(super) fn given(&self, one: &SceneExplanation, part: PixelPart) -> f64 {
        let made = Made { faults: one.faults.clone(), scaled: one.scaled };
        let drawn = draw::<f32>(&made.base(self.frame), &made.faults);
        let failing: Vec<usize> =
            self.failing.iter().copied().filter(|number| part.components().contains(&(number % 4))).collect();
        let is_given = |&&number: &&usize| {
            let (value, drawn) = (self.image.pixels[number / 4][number % 4], drawn.pixels[number / 4][number % 4]);
            value.to_bits() == drawn.to_bits() || (value - drawn).abs() <= slack(self.image.format, value)
        };
        real(failing.iter().filter(is_given).count()) / real(failing.len().max(1))
    }
}

/// What tells two explanations apart.
enum Telltale {
    /// Nothing that is seen in the digits of a value that are shown.
    Near,
    /// A pixel.
    At(Telling),
}

/// The components of a pixel.
pub(super) const NAMES: [&str; 4] = ["red", "green", "blue", "alpha"];

/// Pairs of those that come nearest, with each of others.
fn pairs(near: &[Near]) -> Vec<Vec<&'static SceneFault>> {
    let singles: Vec<&'static SceneFault> = near.iter().map(|near| near.made.faults[0]).take(OTHERS).collect();
    let first = &singles[..singles.len().min(PAIRED)];
    let with_others = |(place, &one): (usize, &&'static SceneFault)| {
        singles[place + 1..].iter().map(move |&other| vec![one, other]).collect::<Vec<_>>()
    };
    first.iter().enumerate().flat_map(with_others).collect()
}

impl SceneExplanation {
    /// In words, as the end of a sentence.
    #[must_use]
    pub fn says(&self) -> String {
        let scaled = self.scaled.map(Scaled::says);
        let faults = self.faults.iter().map(|fault| fault.says.to_owned());
        scaled.into_iter().chain(faults).collect::<Vec<_>>().join(", and ")
    }

    /// As a report has it.
    fn told(&self, standing: Standing) -> Explanation {
        Explanation {
            says: self.says(),
            mistakes: self.faults.iter().map(|fault| Word::from(fault.name)).collect(),
            parameter: self.scaled.map(Scaled::told),
            explained: self.explained as u64,
            open: 0,
            standing,
        }
    }
}

/// The nearest first.
fn nearest_first(mut near: Vec<Near>) -> Vec<Near> {
    near.sort_by(|a, b| a.misses.cmp(&b.misses).then(a.distance.total_cmp(&b.distance)));
    near
}

fn is_within(value: &[f64; 4], legal: &LegalPixel, k: usize) -> bool {
    (legal.low[k]..=legal.high[k]).contains(&value[k])
}

/// So many of them, evenly.
fn spread<T: Copy>(of: &[T], most: usize) -> impl Iterator<Item = T> {
    of.iter().copied().step_by(of.len().div_ceil(most).max(1))
}

/// A linear colour in the target's units.
fn unrounded(format: TargetFormat, color: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|k| pixel::units(format.encoding(), k, color[k]))
}

/// The same, rounded to it.
fn stored(format: TargetFormat, color: [f64; 4]) -> [f64; 4] {
    let units = unrounded(format, color);
    if format.is_unorm() { units.map(f64::round_ties_even) } else { units }
}

/// What the store of a changed image may add, in units.
fn slack(format: TargetFormat, value: f64) -> f64 {
    match format.encoding() {
        Encoding::Unorm8 | Encoding::Srgb8 => 1.0,
        Encoding::Float16 => (value.abs() / 1024.0).max(1e-7),
        Encoding::Float32 => (value.abs() * 1e-6).max(1e-9),
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts of components")]
const fn real(count: usize) -> f64 {
    count as f64
}
