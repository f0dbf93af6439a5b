//! Scenes judged on every subject: each drawn by the shaders composed from the effects that it calls for, and by the one
//! with all effects behind switches; every pixel of both must be legal by the full reference. A run of everything, which is
//! to end within a minute, draws them smaller and by the composed shaders alone.

use super::diagnose::{self, Departure};
use crate::device::{DeviceError, Own, Picture};
use crate::options::{Options, Progress};
use crate::subject::Subject;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::scene::Loaded;
use lightmeter_catalogue::scene::select::{Chosen, pixel_id, scene_id, size};
use lightmeter_document::Number;
use lightmeter_document::run::{Failure, Group, ImageUse, Report, Totals};
use lightmeter_judge::devices::Deviation;
use lightmeter_judge::image::Expected;
use lightmeter_judge::image::expect::{Expectation, expect};
use lightmeter_judge::image::file::{self, Stored};
use lightmeter_judge::image::judge::{Judged, Miss, error, error_map, judge};
use lightmeter_judge::is_worse;
use lightmeter_judge::tally::KEPT_FAILURES;
use lightmeter_judge::tally::problem;
use lightmeter_reference::render::render;
use lightmeter_scene::effects::{Called, effects, named};
use lightmeter_scene::frame::Frame;
use serde_json::json;
use std::time::Instant;

/// Which shader drew an image, as reports name it.
const fn stage(picture: Picture) -> &'static str {
    match picture {
        Picture::Composed => "image",
        Picture::Full => "image-full",
        Picture::Intermediate(stage) => stage.name(),
    }
}

/// Everything about a scene that does not depend on a subject.
struct Scene<'a> {
    id: String,
    frame: &'a Frame,
    named: Vec<Called>,
    pixels: Vec<usize>,
    reference: Stored,
    /// The legal values by subpixel bits.
    expected: Vec<(u32, Vec<Expected>)>,
}

/// Judges a scene on every subject.
///
/// # Errors
/// Where a shader is invalid or a device fails.
pub(crate) fn run_scene(
    loaded: &Loaded,
    chosen: &Chosen,
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    progress: &mut impl Progress,
) -> Result<(), DeviceError> {
    let frame = &loaded.frame;
    let (called, named) = (effects(frame), named(frame));
    let mut work = vec![];
    for (number, subject) in subjects.iter().enumerate() {
        // The shader with all effects takes a compiler as long as everything else of a scene.
        let pictures =
            if options.filter.is_empty() { &[Picture::Composed][..] } else { &[Picture::Composed, Picture::Full] };
        for &picture in pictures {
            let clock = Instant::now();
            let drawing =
                start(subject, options, frame, if picture == Picture::Full { &named } else { &called }, picture)?;
            let seconds = clock.elapsed().as_secs_f64();
            report.timing.devices += seconds;
            work.push((number, picture, drawing, seconds));
        }
    }
    let clock = Instant::now();
    let mut scene = Scene::new(loaded, chosen, named);
    for subject in subjects.iter() {
        scene.expect(&profile_of(subject, options.profile));
    }
    report.timing.reference += clock.elapsed().as_secs_f64();
    let mut composed: Vec<Option<Stored>> = vec![None; subjects.len()];
    for (number, picture, drawing, seconds) in work {
        let subject = &subjects[number];
        let clock = Instant::now();
        let image = match drawing {
            Drawing::Skipped(reason) => {
                report.groups.push(scene.skipped(subject, picture, reason));
                continue;
            }
            Drawing::Embedded => embedded(frame, picture),
            Drawing::Pending(pending) => {
                let bytes = subject.device().expect("only a device has pending work").pixels(pending)?;
                Some(Stored::read(frame.target.width as usize, frame.target.format, &bytes))
            }
        };
        let Some(image) = image else { continue };
        report.timing.devices += clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        let mut measuring = 0.0;
        let mut group = scene.judge(&image, subject, picture, options, report)?;
        match picture {
            Picture::Composed | Picture::Intermediate(_) => composed[number] = Some(image),
            Picture::Full => {
                let same = composed[number].as_ref().map(|composed| differing(composed, &image));
                if let Some(used) = &mut group.image {
                    used.differs_from_composed = same;
                    if options.again
                        && let Some(device) = subject.device()
                    {
                        let clock = Instant::now();
                        used.cost = Some(device.effects_cost(&options.code, frame, &called)?);
                        measuring = clock.elapsed().as_secs_f64();
                    }
                }
            }
        }
        let judging = clock.elapsed().as_secs_f64() - measuring;
        report.timing.judge += judging;
        report.timing.devices += measuring;
        group.seconds = seconds + judging;
        report.groups.push(group);
    }
    progress.advance((scene.pixels.len() * subjects.len()) as u64);
    Ok(())
}

/// Pixels that two images do not have in common, bit for bit.
fn differing(a: &Stored, b: &Stored) -> u64 {
    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| a.map(f64::to_bits) != b.map(f64::to_bits)).count() as u64
}

enum Drawing {
    Skipped(&'static str),
    Embedded,
    Pending(Own),
}

fn start(
    subject: &Subject,
    options: &Options,
    frame: &Frame,
    sets: &[Called],
    picture: Picture,
) -> Result<Drawing, DeviceError> {
    let Some(device) = subject.device() else { return Ok(Drawing::Embedded) };
    if let Some(reason) = device.lacks_frame(frame) {
        return Ok(Drawing::Skipped(reason));
    }
    device.draw(&options.code, frame, sets, picture).map(Drawing::Pending)
}

/// The formulas in f32, which have no shader with switches.
fn embedded(frame: &Frame, picture: Picture) -> Option<Stored> {
    (picture == Picture::Composed).then(|| Stored::of(&render::<f32>(frame, None, None), frame.target.format))
}

/// Takes the misses out that a named deviation makes legal; how many there are.
pub fn excuse(judged: &mut Judged, image: &Stored, frame: &Frame, deviation: &Deviation, profile: &Profile) -> u64 {
    let granted = deviation.grant(*profile);
    let expectation = Expectation::new(frame, None, None, &granted);
    let before = judged.misses.len();
    judged.misses.retain(|miss| {
        let (x, y) = (miss.pixel % image.width, miss.pixel / image.width);
        let legal = expectation.pixel(x, y);
        let value = image.pixels[miss.pixel][miss.component];
        !(legal.low[miss.component] <= value && value <= legal.high[miss.component])
    });
    (before - judged.misses.len()) as u64
}

/// The accuracy rules for a subject: the profile's, with the subpixel bits that its rasteriser is known to have.
#[must_use]
pub fn profile_of(subject: &Subject, profile: &Profile) -> Profile {
    subject.known.profile(profile)
}

impl<'a> Scene<'a> {
    fn new(loaded: &'a Loaded, chosen: &Chosen, named: Vec<Called>) -> Self {
        let frame = &loaded.frame;
        let reference = Stored::unrounded(&render::<f64>(frame, None, None), frame.target.format);
        let pixels = chosen.pixels.clone().unwrap_or_else(|| (0..reference.pixels.len()).collect());
        Self { id: scene_id(chosen.place), frame, named, pixels, reference, expected: vec![] }
    }

    fn expect(&mut self, profile: &Profile) {
        if !self.expected.iter().any(|(bits, _)| *bits == profile.subpixel_bits) {
            let expected = expect(self.frame, None, None, profile);
            self.expected.push((profile.subpixel_bits, expected));
        }
    }

    fn expected(&self, profile: &Profile) -> &[Expected] {
        let found = self.expected.iter().find(|(bits, _)| *bits == profile.subpixel_bits);
        &found.expect("what is legal was worked out for every subject").1
    }

    fn skipped(&self, subject: &Subject, picture: Picture, reason: &'static str) -> Group {
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

    fn judge(
        &self,
        image: &Stored,
        subject: &Subject,
        picture: Picture,
        options: &Options,
        report: &mut Report,
    ) -> Result<Group, DeviceError> {
        let profile = profile_of(subject, options.profile);
        let expected = self.expected(&profile);
        let mut judged = judge(image, &self.reference, expected, &self.pixels);
        let excused = self.excuse(&mut judged, image, subject, &profile, report);
        let verdicts = 4 * self.pixels.len() as u64;
        let mut totals = Totals {
            cases: self.pixels.len() as u64,
            verdicts,
            passed: judged.passed,
            failed: judged.misses.len() as u64,
            expected_failures: excused,
            indeterminate: judged.indeterminate,
            ..Totals::default()
        };
        let problem = problem((verdicts, judged.indeterminate), verdicts, judged.indeterminate);
        totals.failed_groups = u64::from(problem.is_some());
        let width = image.width;
        let mut used = ImageUse {
            width,
            height: image.pixels.len() / width,
            marked: self.pixels.iter().filter(|&&pixel| expected[pixel].is_marked).count() as u64,
            differs_from_composed: None,
            cost: None,
            departs_in: None,
            files: vec![],
        };
        let mut explanation = None;
        if let Some(worst) =
            judged.misses.iter().copied().reduce(|a, b| if is_worse(b.margin, a.margin) { b } else { a })
        {
            let departure = self.departure(subject, options, &profile, &judged)?;
            used.departs_in = Some(departure.stage.into());
            used.files = self.write(image, expected, subject, picture, options);
            let pixels = judged.pixels().len();
            let command = self.rerun("show", subject, options, worst.pixel);
            explanation =
                Some(format!("{pixels} pixels; {departure}; the worst: {command}{}", files_told(&used.files)));
            let kept = judged.misses.iter().filter(|miss| miss.component == 0 || **miss != worst).take(KEPT_FAILURES);
            let failures: Vec<Miss> = std::iter::once(worst).chain(kept.copied()).take(KEPT_FAILURES).collect();
            for miss in failures {
                report.failures.push(self.failure(miss, image, expected, subject, picture, options));
            }
        }
        Ok(Group {
            error_ulp_max: Number(judged.error_max),
            margin_max: Number(judged.worst.map_or(0.0, |worst| worst.margin)),
            worst: judged.worst.map(|worst| pixel_id(&self.id, width, worst.pixel)),
            explanation,
            problem,
            image: Some(used),
            ..self.group(subject, picture, totals)
        })
    }

    /// Takes the misses out that a named deviation of the subject makes legal; how many there are.
    fn excuse(
        &self,
        judged: &mut Judged,
        image: &Stored,
        subject: &Subject,
        profile: &Profile,
        report: &mut Report,
    ) -> u64 {
        let mut excused = 0;
        for deviation in &subject.known.deviations {
            if judged.misses.is_empty() {
                break;
            }
            let count = excuse(judged, image, self.frame, deviation, profile);
            excused += count;
            report.excuse(deviation.name, &subject.identity.name, count);
        }
        excused
    }

    fn departure(
        &self,
        subject: &Subject,
        options: &Options,
        profile: &Profile,
        judged: &Judged,
    ) -> Result<Departure, DeviceError> {
        // What a texture replaces is an intermediate result all the same.
        diagnose::departure(subject, &options.code, self.frame, &self.named, profile, &judged.pixels())
    }

    /// Reference, result and error map; nothing where files are not asked for or cannot be written.
    fn write(
        &self,
        image: &Stored,
        expected: &[Expected],
        subject: &Subject,
        picture: Picture,
        options: &Options,
    ) -> Vec<String> {
        let Some(folder) = &options.images else { return vec![] };
        let rounded = Stored::of(&render::<f64>(self.frame, None, None), self.frame.target.format);
        let map = error_map(image, &self.reference, expected);
        let name = self.id.replace('/', "-");
        let place = format!("{name}-{}-{}", subject.identity.name, stage(picture));
        let _ = std::fs::create_dir_all(folder);
        let mut files = vec![];
        for (what, image) in [("reference", &rounded), ("result", image), ("error", &map)] {
            let path = folder.join(format!("{place}-{what}.png"));
            match image.write(&path) {
                Ok(()) => files.push(path.display().to_string()),
                Err(error) => {
                    let _: file::ImageFileError = error;
                }
            }
        }
        files
    }

    fn rerun(&self, command: &str, subject: &Subject, options: &Options, pixel: usize) -> String {
        let id = pixel_id(&self.id, self.reference.width, pixel);
        let size = size(&options.filter, options.size).map(|size| format!(" --size {size}")).unwrap_or_default();
        format!("lightmeter {command} '{id}' --adapter {}{size}{}", subject.identity.name, options.rerun)
    }

    fn failure(
        &self,
        miss: Miss,
        image: &Stored,
        expected: &[Expected],
        subject: &Subject,
        picture: Picture,
        options: &Options,
    ) -> Failure {
        let (pixel, k) = (miss.pixel, miss.component);
        let (value, exact) = (image.pixels[pixel][k], self.reference.pixels[pixel][k]);
        let place = json!({ "x": pixel % image.width, "y": pixel / image.width });
        let inputs = place.as_object().cloned().unwrap_or_default();
        #[expect(clippy::cast_possible_truncation, reason = "a value that was read from a target fits binary32")]
        let bits = (value as f32).to_bits();
        Failure {
            rerun: self.rerun("run", subject, options, pixel),
            id: pixel_id(&self.id, image.width, pixel),
            adapter: subject.identity.name.clone(),
            stage: stage(picture).into(),
            target: Some(self.frame.target.format.name().into()),
            route: None,
            output: ["r", "g", "b", "a"][k].into(),
            inputs,
            inputs_hex: serde_json::Map::new(),
            reference: Number(exact),
            interval: [Number(expected[pixel].low[k]), Number(expected[pixel].high[k])],
            promise: None,
            value: Number(value),
            value_hex: format!("0x{bits:08x}"),
            unwritten: false,
            error_ulp: Number(error(image.format, value, exact)),
        }
    }
}

fn files_told(files: &[String]) -> String {
    if files.is_empty() { String::new() } else { format!("; see {}", files.join(", ")) }
}
