//! The verdict on an image of a scene: every pixel of it against what is legal, and where it is wrong, how.

use super::diagnose;
use crate::device::{DeviceError, Picture};
use crate::options::Options;
use crate::subject::Subject;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::scene::Loaded;
use lightmeter_catalogue::scene::select::{Chosen, pixel_id, scene_id, size};
use lightmeter_document::adapters::Deviation;
use lightmeter_document::by_case::{CaseCounts, CaseTotals};
use lightmeter_document::report::{
    BiasUnit, Departure, Diagnosis, Failure, Group, ImageBias, ImageUse, PixelUse, Problem, ProblemKind, Report, Totals,
};
use lightmeter_document::{Number, hash};
use lightmeter_judge::cases::ending;
use lightmeter_judge::devices::grant;
use lightmeter_judge::image::LegalPixel;
use lightmeter_judge::image::bias::Bias;
use lightmeter_judge::image::expect::{Expectation, expect};
use lightmeter_judge::image::file::{ImageFileError, StoredImage};
use lightmeter_judge::image::judge::{Judged, Miss, error, judge};
use lightmeter_judge::image::map::{error_map, with_legend};
use lightmeter_judge::is_worse;
use lightmeter_judge::tally::KEPT_FAILURES;
use lightmeter_reference::render::render;
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::{Encoding, TargetFormat};
use serde_json::json;
use std::collections::BTreeMap;
use std::time::Instant;

/// The most pixels of each kind that are told of a wrong image.
const MOST_PIXELS: usize = 256;

/// Takes the misses out that a named deviation makes legal; how many there are.
pub fn excuse(
    judged: &mut Judged,
    image: &StoredImage,
    frame: &Frame,
    deviation: &'static Deviation,
    profile: &Profile,
) -> u64 {
    let granted = grant(deviation, *profile);
    let expectation = Expectation::new(frame, None, None, &granted);
    judged.excuse(&deviation.name, |miss| {
        let (x, y) = (miss.pixel % image.width, miss.pixel / image.width);
        let legal = expectation.pixel(x, y);
        let value = image.pixels[miss.pixel][miss.component];
        legal.low[miss.component] <= value && value <= legal.high[miss.component]
    })
}

/// Everything about a scene that does not depend on a subject.
pub(super) struct JudgedScene<'a> {
    id: String,
    frame: &'a Frame,
    pixels: Vec<usize>,
    reference: StoredImage,
    /// The legal values by subpixel bits.
    expected: Vec<(u32, Vec<LegalPixel>)>,
}

/// An image of a scene, who drew it, and by what it is judged.
pub(super) struct Drawn<'a> {
    pub(super) image: &'a StoredImage,
    pub(super) subject: &'a Subject,
    pub(super) picture: Picture,
    pub(super) options: &'a Options,
    /// The accuracy rules for the subject.
    pub(super) profile: Profile,
}

impl<'a> JudgedScene<'a> {
    pub(super) fn new(loaded: &'a Loaded, chosen: &Chosen) -> Self {
        let frame = &loaded.frame;
        let reference = StoredImage::unrounded(&render::<f64>(frame, None, None), frame.target.format);
        let pixels = chosen.pixels.clone().unwrap_or_else(|| (0..reference.pixels.len()).collect());
        Self { id: scene_id(chosen.place), frame, pixels, reference, expected: vec![] }
    }

    /// How many pixels are judged.
    pub(super) const fn pixels(&self) -> usize {
        self.pixels.len()
    }

    /// Works out what is legal by a profile.
    pub(super) fn expect(&mut self, profile: &Profile) {
        if !self.expected.iter().any(|(bits, _)| *bits == profile.subpixel_bits) {
            let expected = expect(self.frame, None, None, profile);
            self.expected.push((profile.subpixel_bits, expected));
        }
    }

    /// What a profile makes legal, which was worked out.
    pub(super) fn expected(&self, profile: &Profile) -> &[LegalPixel] {
        let found = self.expected.iter().find(|(bits, _)| *bits == profile.subpixel_bits);
        &found.expect("what is legal was worked out for every subject").1
    }

    /// The group of an image that a subject cannot draw.
    pub(super) fn skipped(&self, subject: &Subject, picture: Picture, reason: &'static str) -> Group {
        let cases = self.pixels.len() as u64;
        Group {
            skip_reason: Some(reason.into()),
            ..self.group(subject, picture, Totals { cases, skipped: cases, ..Totals::default() })
        }
    }

    fn group(&self, subject: &Subject, picture: Picture, totals: Totals) -> Group {
        Group {
            target: Some(self.frame.target.format.name().into()),
            totals,
            ..Group::new(self.id.clone(), subject.identity.name.clone(), stage(picture))
        }
    }

    /// The verdicts on an image by what a profile makes legal.
    pub(super) fn judged(&self, image: &StoredImage, profile: &Profile) -> Judged {
        judge(image, &self.reference, self.expected(profile), &self.pixels)
    }

    /// What all pixels of a right image say together; of blended ones nothing, since each layer was rounded, of sRGB nothing,
    /// whose steps are uneven, and nothing of half precision, to which some devices truncate: that is legal, and lies to one side.
    pub(super) fn bias(&self, image: &StoredImage, profile: &Profile) -> Option<ImageBias> {
        let frame = self.frame;
        if frame.draws.iter().any(|draw| draw.blend.is_some()) {
            return None;
        }
        let told = |found: Bias, unit, beyond| ImageBias {
            factor: found.factor,
            steps: found.steps,
            error: found.error,
            unit,
            beyond,
        };
        match frame.target.format.encoding() {
            Encoding::Unorm8 => {}
            Encoding::Srgb8 | Encoding::Float16 => return None,
            Encoding::Float32 => {
                let found = Bias::of_floats(image, &self.reference, self.expected(profile), &self.pixels)?;
                return Some(told(found, BiasUnit::Tolerance, None));
            }
        }
        let found = Bias::of(image, &self.reference, self.expected(profile), &self.pixels)?;
        let mut on_floats = frame.clone();
        on_floats.target.format = TargetFormat::Rgba32Float;
        let on_floats = expect(&on_floats, None, None, profile);
        let beyond = Bias::beyond(image, &self.reference, &on_floats, &self.pixels).map(|beyond| beyond.steps);
        Some(told(found, BiasUnit::Step, beyond))
    }

    /// What the reference has at a pixel.
    pub(super) fn reference(&self, pixel: usize) -> [f64; 4] {
        self.reference.pixels[pixel]
    }

    /// The group of an image. Where that is wrong, its failures go to the report, and its intermediate results, which everything
    /// that the frame names takes part in, are drawn.
    pub(super) fn judge(&self, drawn: &Drawn<'_>, named: &[Called], report: &mut Report) -> Result<Group, DeviceError> {
        let expected = self.expected(&drawn.profile);
        let mut judged = self.judged(drawn.image, &drawn.profile);
        self.excuse(&mut judged, drawn, report);
        let bias = if judged.misses.is_empty() { self.bias(drawn.image, &drawn.profile) } else { None };
        let problem = judged.verdicts.problem().or(bias.and_then(|bias| told(&bias)));
        let mut totals = Totals { failed_groups: u64::from(problem.is_some()), ..judged.verdicts.totals };
        let mut used = ImageUse { bias, ..self.image_use(drawn.image, expected) };
        let diagnosis = match worst(&judged) {
            Some(worst) => self.explain(drawn, named, (&judged, worst), &mut used, report)?,
            None => None,
        };
        let has_failed = totals.failed > 0;
        let on = [stage(drawn.picture), self.frame.target.format.name()];
        if crate::expected::expect(report, drawn.options, &self.id, &on, has_failed, diagnosis.as_ref()) {
            totals.expected_failures += std::mem::take(&mut totals.failed);
        }
        let by_case = drawn.options.counts_cases.then(|| self.counts(has_failed, totals.failed == 0));
        Ok(Group {
            error_ulp_max: Number(judged.verdicts.error_max),
            margin_max: Number(judged.worst().map_or(0.0, |worst| worst.margin)),
            worst: judged.worst().map(|worst| pixel_id(&self.id, drawn.image.width, worst.pixel)),
            diagnosis,
            problems: problem.into_iter().collect(),
            image: Some(used),
            by_case,
            ..self.group(drawn.subject, drawn.picture, totals)
        })
    }

    /// The image as the one case that it is.
    pub(super) fn counts(&self, has_failed: bool, is_expected: bool) -> CaseCounts {
        let failed = u64::from(has_failed);
        let not_passed = BTreeMap::from([("failed".to_owned(), vec![ending("scene", &self.id)])]);
        let expected_failures = u64::from(has_failed && is_expected);
        CaseCounts {
            totals: CaseTotals { asked: 1, passed: 1 - failed, failed, expected_failures, ..CaseTotals::default() },
            not_passed: if has_failed { not_passed } else { BTreeMap::new() },
            ..CaseCounts::default()
        }
    }

    /// Takes the misses out that a named deviation of the subject makes legal.
    fn excuse(&self, judged: &mut Judged, drawn: &Drawn<'_>, report: &mut Report) {
        for deviation in &drawn.subject.known.deviations {
            if judged.misses.is_empty() {
                break;
            }
            let count = excuse(judged, drawn.image, self.frame, deviation, &drawn.profile);
            report.excuse(&deviation.name, &drawn.subject.identity.name, count);
        }
    }

    /// What a report says of an image by itself; what is wrong with it comes later.
    fn image_use(&self, image: &StoredImage, expected: &[LegalPixel]) -> ImageUse {
        ImageUse {
            width: image.width,
            height: image.pixels.len() / image.width,
            marked: self.pixels.iter().filter(|&&pixel| expected[pixel].is_marked).count() as u64,
            differs_from_composed: None,
            cost: None,
            bias: None,
            wrong: 0,
            departs_in: None,
            show: None,
            files: vec![],
            hashes: vec![],
            pixels: vec![],
        }
    }

    /// Where a wrong image departs, its files, the command that shows its worst pixel, and in the report its failures.
    fn explain(
        &self,
        drawn: &Drawn<'_>,
        named: &[Called],
        (judged, worst): (&Judged, Miss),
        used: &mut ImageUse,
        report: &mut Report,
    ) -> Result<Option<Diagnosis>, DeviceError> {
        used.wrong = judged.pixels().len() as u64;
        used.departs_in = self.departure(drawn, named, judged)?;
        used.show = Some(self.show(drawn, worst.pixel));
        (used.files, used.hashes) = self.write(drawn);
        used.pixels = self.told_pixels(drawn.image, judged, &drawn.profile);
        let kept = judged.misses.iter().filter(|miss| miss.component == 0 || **miss != worst).take(KEPT_FAILURES);
        for miss in std::iter::once(worst).chain(kept.copied()).take(KEPT_FAILURES) {
            report.failures.push(self.failure(drawn, miss));
        }
        let clock = Instant::now();
        let expected = self.expected(&drawn.profile);
        let granted = drawn.subject.known.granted(drawn.options.profile);
        let found = drawn.options.diagnose.map(|diagnose| diagnose.image(self.frame, drawn.image, expected, &granted));
        report.timing.diagnose += clock.elapsed().as_secs_f64();
        Ok(found)
    }

    fn departure(
        &self,
        drawn: &Drawn<'_>,
        named: &[Called],
        judged: &Judged,
    ) -> Result<Option<Departure>, DeviceError> {
        // What a texture replaces is an intermediate result all the same.
        let code = &drawn.options.code;
        diagnose::departure(drawn.subject, code, self.frame, named, &drawn.profile, &judged.pixels())
    }

    /// The pixels that are farthest off, worst first, and then marked ones, from the top.
    pub(super) fn told_pixels(&self, image: &StoredImage, judged: &Judged, profile: &Profile) -> Vec<PixelUse> {
        let expected = self.expected(profile);
        let mut worst: Vec<(f64, usize)> = vec![];
        for miss in &judged.misses {
            match worst.last_mut().filter(|(_, pixel)| *pixel == miss.pixel) {
                Some((margin, _)) => *margin = if is_worse(miss.margin, *margin) { miss.margin } else { *margin },
                None => worst.push((miss.margin, miss.pixel)),
            }
        }
        worst.sort_by(|(a, _), (b, _)| b.partial_cmp(a).unwrap_or_else(|| b.is_nan().cmp(&a.is_nan())));
        worst.truncate(MOST_PIXELS);
        let is_told = |pixel: &usize| worst.iter().any(|(_, told)| told == pixel);
        let marked = self.pixels.iter().copied().filter(|&pixel| expected[pixel].is_marked);
        let marked = marked.filter(|pixel| !is_told(pixel)).take(MOST_PIXELS);
        let told = worst.iter().map(|(_, pixel)| *pixel).chain(marked);
        told.map(|pixel| PixelUse {
            x: pixel % image.width,
            y: pixel / image.width,
            sample: None,
            reference: self.reference.pixels[pixel].map(short),
            low: expected[pixel].low.map(short),
            high: expected[pixel].high.map(short),
            value: image.pixels[pixel].map(short),
            marked: expected[pixel].is_marked,
        })
        .collect()
    }

    /// Reference, result and error map; nothing where files are not asked for or cannot be written.
    fn write(&self, drawn: &Drawn<'_>) -> (Vec<String>, Vec<String>) {
        let (image, options) = (drawn.image, drawn.options);
        self.write_files(options, &drawn.subject.identity.name, stage(drawn.picture), image, &drawn.profile)
    }

    /// The same of an image of whoever drew it: the files, and the hash of each.
    pub(super) fn write_files(
        &self,
        options: &Options,
        adapter: &str,
        stage: &str,
        image: &StoredImage,
        profile: &Profile,
    ) -> (Vec<String>, Vec<String>) {
        let Some(folder) = &options.images else { return (vec![], vec![]) };
        let rounded = StoredImage::of(&render::<f64>(self.frame, None, None), self.frame.target.format);
        let map = with_legend(&error_map(image, &self.reference, self.expected(profile)));
        // A renderer may have any name.
        let is_plain = |c: char| c.is_alphanumeric() || "-_.".contains(c);
        let adapter: String = adapter.chars().map(|c| if is_plain(c) { c } else { '-' }).collect();
        let place = format!("{}-{adapter}-{stage}", self.id.replace('/', "-"));
        let _ = std::fs::create_dir_all(folder);
        let (mut files, mut hashes) = (vec![], vec![]);
        for (what, image) in [("reference", &rounded), ("result", image), ("error", &map)] {
            let path = folder.join(format!("{place}-{what}.png"));
            match image.write(&path) {
                Ok(()) => {
                    // What cannot be read again has the hash of nothing, so that no later picture is taken for it.
                    hashes.push(hash(&std::fs::read(&path).unwrap_or_default()));
                    files.push(path.display().to_string());
                }
                Err(error) => {
                    let _: ImageFileError = error;
                }
            }
        }
        (files, hashes)
    }

    /// The command that shows a pixel.
    fn show(&self, drawn: &Drawn<'_>, pixel: usize) -> String {
        let (id, options) = (pixel_id(&self.id, self.reference.width, pixel), drawn.options);
        let size = size(&options.filter, options.size).map(|size| format!(" --size {size}")).unwrap_or_default();
        format!("lightmeter show '{id}' --adapter {}{size}{}", drawn.subject.identity.name, options.rerun)
    }

    fn failure(&self, drawn: &Drawn<'_>, miss: Miss) -> Failure {
        let (image, pixel, k) = (drawn.image, miss.pixel, miss.component);
        let (value, exact) = (image.pixels[pixel][k], self.reference.pixels[pixel][k]);
        let expected = &self.expected(&drawn.profile)[pixel];
        let place = json!({ "x": pixel % image.width, "y": pixel / image.width });
        let inputs = place.as_object().cloned().unwrap_or_default();
        #[expect(clippy::cast_possible_truncation, reason = "a value that was read from a target fits binary32")]
        let bits = (value as f32).to_bits();
        Failure {
            rerun: String::new(),
            id: pixel_id(&self.id, image.width, pixel),
            adapter: drawn.subject.identity.name.clone(),
            stage: stage(drawn.picture).into(),
            target: Some(self.frame.target.format.name().into()),
            route: None,
            sample: None,
            output: ["r", "g", "b", "a"][k].into(),
            inputs,
            units: BTreeMap::new(),
            inputs_hex: serde_json::Map::new(),
            reference: Number(exact),
            interval: [Number(expected.low[k]), Number(expected.high[k])],
            promise: None,
            value: Number(value),
            value_hex: format!("0x{bits:08x}"),
            unwritten: false,
            error_ulp: Number(error(image.format, value, exact)),
            answer: None,
        }
    }
}

/// A number of a pixel in the report, with the digits of binary32.
fn short(x: f64) -> Number {
    #[expect(clippy::cast_possible_truncation, reason = "people read it")]
    let narrow = x as f32;
    Number(narrow.to_string().parse().unwrap_or(x))
}

/// What a bias says that the accuracy rules do not explain.
pub(super) fn told(bias: &ImageBias) -> Option<Problem> {
    let ImageBias { steps, beyond, .. } = *bias;
    let is = bias.as_if();
    let says = format!(
        "each pixel is legal, but together they lie to one side: {is}, {steps:+.2} steps on average, of which the accuracy rules do not \
         explain {:+.2}",
        beyond?
    );
    Some(Problem::new(ProblemKind::Bias, says))
}

/// Which shader drew an image, as reports name it.
const fn stage(picture: Picture) -> &'static str {
    match picture {
        Picture::Composed => "image",
        Picture::Full => "image-full",
        Picture::Intermediate(stage) => stage.name(),
    }
}

/// The miss of the greatest margin.
pub(super) fn worst(judged: &Judged) -> Option<Miss> {
    judged.misses.iter().copied().reduce(|a, b| if is_worse(b.margin, a.margin) { b } else { a })
}
