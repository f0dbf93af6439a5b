//! Scenes judged on every subject: each drawn by the shaders composed from the effects that it calls for, and by the one
//! with all effects behind switches; every pixel of both must be legal by the full reference. A run of everything, which is
//! to end within a minute, draws them smaller and by the composed shaders alone.

use super::verdict::{Drawn, JudgedScene};
use crate::device::{DeviceError, Own, Picture};
use crate::options::Options;
use crate::subject::Subject;
use lightmeter_catalogue::scene::Loaded;
use lightmeter_catalogue::scene::select::Chosen;
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::report::Report;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_reference::render::render;
use lightmeter_scene::effects::{Called, effects, named};
use lightmeter_scene::frame::Frame;
use std::time::Instant;

/// A frame, and the effects that it is drawn with.
struct Asked<'a> {
    frame: &'a Frame,
    /// What it calls for.
    called: Vec<Called>,
    /// All that it names.
    named: Vec<Called>,
}

/// An image that a subject, by its place, has begun to draw.
struct Started {
    subject: usize,
    picture: Picture,
    drawing: Drawing,
    seconds: f64,
}

enum Drawing {
    Skipped(&'static str),
    Embedded,
    Pending(Own),
}

/// A scene whose images subjects have begun to draw.
pub(crate) struct BegunScene {
    loaded: Loaded,
    images: Vec<Started>,
}

impl BegunScene {
    /// Pixels of all its images.
    pub(crate) fn pixels(&self) -> usize {
        let target = &self.loaded.frame.target;
        self.images.len() * target.width as usize * target.height as usize
    }
}

/// Has every subject begin with a scene's images.
///
/// # Errors
/// Where a shader is invalid or a device fails.
pub(crate) fn begin(
    loaded: Loaded,
    subjects: &[Subject],
    options: &Options,
    report: &mut Report,
) -> Result<BegunScene, DeviceError> {
    let images = Asked::of(&loaded.frame).start_all(subjects, options, report)?;
    Ok(BegunScene { loaded, images })
}

/// Works out what is legal of a scene, and judges every subject's images.
///
/// # Errors
/// Where a device fails.
pub(crate) fn judge(
    BegunScene { loaded, images }: BegunScene,
    chosen: &Chosen,
    subjects: &[Subject],
    options: &Options,
    report: &mut Report,
    observer: &mut dyn Observer,
) -> Result<(), DeviceError> {
    let asked = Asked::of(&loaded.frame);
    let clock = Instant::now();
    let mut scene = JudgedScene::new(&loaded, chosen);
    for subject in subjects {
        scene.expect(&subject.known.profile(options.profile));
    }
    report.timing.reference += clock.elapsed().as_secs_f64();
    let mut composed: Vec<Option<StoredImage>> = vec![None; subjects.len()];
    for started in images {
        let place = started.subject;
        asked.finish(started, &scene, &subjects[place], &mut composed[place], options, report)?;
    }
    observer.see(&Event::Advanced((scene.pixels() * subjects.len()) as u64));
    Ok(())
}

impl<'a> Asked<'a> {
    fn of(frame: &'a Frame) -> Self {
        Self { frame, called: effects(frame), named: named(frame) }
    }

    /// Has every subject begin with its images.
    fn start_all(
        &self,
        subjects: &[Subject],
        options: &Options,
        report: &mut Report,
    ) -> Result<Vec<Started>, DeviceError> {
        // The shader with all effects takes a compiler as long as everything else of a scene.
        let pictures =
            if options.filter.is_empty() { &[Picture::Composed][..] } else { &[Picture::Composed, Picture::Full] };
        let mut started = vec![];
        for (place, subject) in subjects.iter().enumerate() {
            for &picture in pictures {
                let clock = Instant::now();
                let drawing = self.start(subject, options, picture)?;
                let seconds = clock.elapsed().as_secs_f64();
                report.timing.devices += seconds;
                started.push(Started { subject: place, picture, drawing, seconds });
            }
        }
        Ok(started)
    }

    fn start(&self, subject: &Subject, options: &Options, picture: Picture) -> Result<Drawing, DeviceError> {
        let Some(device) = subject.device() else { return Ok(Drawing::Embedded) };
        if let Some(reason) = device.lacks_frame(self.frame) {
            return Ok(Drawing::Skipped(reason));
        }
        let sets = if picture == Picture::Full { &self.named } else { &self.called };
        device.draw(&options.code, self.frame, sets, picture).map(Drawing::Pending)
    }

    /// Waits for an image, and adds the group of its verdicts to the report. The image by the composed shaders is left for the
    /// one by the shader with switches.
    fn finish(
        &self,
        started: Started,
        scene: &JudgedScene<'_>,
        subject: &Subject,
        composed: &mut Option<StoredImage>,
        options: &Options,
        report: &mut Report,
    ) -> Result<(), DeviceError> {
        let Started { picture, drawing, seconds, .. } = started;
        let clock = Instant::now();
        let image = match drawing {
            Drawing::Skipped(reason) => {
                report.groups.push(scene.skipped(subject, picture, reason));
                return Ok(());
            }
            Drawing::Embedded => embedded(self.frame, picture),
            Drawing::Pending(pending) => {
                let bytes = subject.device().expect("only a device has pending work").pixels(pending)?;
                Some(StoredImage::read(self.frame.target.width as usize, self.frame.target.format, &bytes))
            }
        };
        let Some(image) = image else { return Ok(()) };
        report.timing.devices += clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        let profile = subject.known.profile(options.profile);
        let mut group =
            scene.judge(&Drawn { image: &image, subject, picture, options, profile }, &self.named, report)?;
        if picture == Picture::Full
            && let Some(used) = &mut group.image
        {
            used.differs_from_composed = composed.as_ref().map(|composed| differing(composed, &image));
        }
        let judging = clock.elapsed().as_secs_f64();
        report.timing.judge += judging;

        if picture == Picture::Full
            && options.again
            && let (Some(used), Some(device)) = (&mut group.image, subject.device())
        {
            let clock = Instant::now();
            used.cost = Some(device.effects_cost(&options.code, self.frame, &self.called)?);
            report.timing.devices += clock.elapsed().as_secs_f64();
        }
        if picture != Picture::Full {
            *composed = Some(image);
        }
        group.seconds = seconds + judging;
        report.groups.push(group);
        Ok(())
    }
}

/// Pixels that two images do not have in common, bit for bit.
fn differing(a: &StoredImage, b: &StoredImage) -> u64 {
    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| a.map(f64::to_bits) != b.map(f64::to_bits)).count() as u64
}

/// The formulas in f32, which have no shader with switches.
fn embedded(frame: &Frame, picture: Picture) -> Option<StoredImage> {
    (picture == Picture::Composed).then(|| StoredImage::of(&render::<f32>(frame, None, None), frame.target.format))
}
