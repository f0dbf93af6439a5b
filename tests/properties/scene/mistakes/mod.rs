//! Mistakes in the shaders of scenes: each is seen by the judge, and said to be where it was made.
//!
//! The built-in scenes are drawn at 128 × 128 pixels on the first adapter. A mistake is one edit of one shader file.

mod table;

use lightmeter::arithmetic::Profile;
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::device::{Code, Picture};
use lightmeter::document::report::Departure;
use lightmeter::image::diagnose::departure;
use lightmeter::image::drawn::drawn;
use lightmeter::image::file::StoredImage;
use lightmeter::image::judge::{Judged, judge};
use lightmeter::image::{LegalPixel, expect};
use lightmeter::scene::load;
use lightmeter::subject::Subject;
use lightmeter::subject_gpu::{code_of, open_device};
use lightmeter_reference::render::render;
use lightmeter_scene::effects::{Called, effects};
use lightmeter_scene::frame::Frame;
use lightmeter_scene::stage::Intermediate;
use lightmeter_tests::place::folder;
use std::collections::BTreeMap;
use table::{MISTAKES, Mistake, RIGHT, UNSEEN};

/// A scene, and what is known of it whatever draws it.
struct Prepared {
    frame: Frame,
    sets: Vec<Called>,
    reference: StoredImage,
    expected: Vec<LegalPixel>,
}

impl Prepared {
    fn new(scene: &str, profile: &Profile) -> Self {
        let mut frame = load::builtin(scene).expect("a built-in scene").frame;
        (frame.target.width, frame.target.height) = (128, 128);
        let reference = StoredImage::unrounded(&render::<f64>(&frame, None, None), frame.target.format);
        let expected = expect(&frame, None, None, profile);
        Self { sets: effects(&frame), frame, reference, expected }
    }

    /// Pixels where something is drawn for certain, of every four.
    fn covered(&self, profile: &Profile) -> Vec<usize> {
        let expected = expect(&self.frame, None, Some(Intermediate::Depth), profile);
        (0..expected.len()).step_by(4).filter(|&pixel| expected[pixel].low[3] > 0.0).collect()
    }

    /// Where it departs, of those pixels.
    fn departure(&self, subject: &Subject, code: &Code, profile: &Profile, pixels: &[usize]) -> Departure {
        let departure = departure(subject, code, &self.frame, &self.sets, profile, pixels);
        departure.expect("intermediate results are drawn").expect("the adapter draws on rgba32float")
    }

    /// The scene as a device draws it by composed shaders, judged.
    fn judged(&self, subject: &Subject, code: &Code) -> Judged {
        let image = drawn(subject, code, &self.frame, &self.sets, Picture::Composed).expect("the mistakes compile");
        let image = image.expect("it can be drawn");
        judge(&image, &self.reference, &self.expected, &(0..image.pixels.len()).collect::<Vec<_>>())
    }
}

/// The first adapter's device.
fn subject() -> Subject {
    let adapters = lightmeter_gpu::native_adapters();
    let adapter = adapters.first().expect("no Vulkan driver is here: `./x test` installs lavapipe");
    open_device(adapter).expect("the adapter gives a device")
}

/// The built-in shaders, one of them edited, in a folder of its own.
fn edited(place: usize, file: &str, edit: impl Fn(&str) -> String) -> Code {
    let dir = folder(&format!("scene-mistake-{place}"));
    std::fs::create_dir_all(dir.join("effects")).expect("a folder for shaders can be made");
    let mut files =
        lightmeter_gpu::FILES.into_iter().chain(lightmeter_gpu::SCENE_FILES).chain(lightmeter_gpu::EFFECT_FILES);
    let (_, text) = files.find(|(name, _)| *name == file).expect("the shader is built in");
    std::fs::write(dir.join(file), edit(text)).expect("a shader can be written");
    code_of(Some(&dir)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// A scene with one of the shaders edited.
fn with(place: usize, (mistake, file, what, by, ..): Mistake) -> Code {
    edited(place, file, |text| {
        assert!(text.contains(what), "{mistake}: `{what}` no longer stands in {file}");
        text.replace(what, by)
    })
}

#[test]
#[ignore = "long: ./x campaign long"]
fn each_mistake_is_seen_and_said_to_be_where_it_was_made() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let subject = subject();
    let profile = subject.known.profile(&WGSL);
    let right = code_of(None).expect("the built-in shaders are valid");
    let mut scenes: BTreeMap<&str, Prepared> = BTreeMap::new();
    let mut wrong = vec![];
    for (place, row) in MISTAKES.iter().enumerate() {
        let &(mistake, .., scene, stage) = row;
        let prepared = scenes.entry(scene).or_insert_with(|| {
            let prepared = Prepared::new(scene, &profile);
            assert_eq!(prepared.judged(&subject, &right).misses, [], "{scene} with the built-in shaders");
            prepared
        });
        let code = with(place, *row);
        let pixels = prepared.judged(&subject, &code).pixels();
        if pixels.is_empty() {
            wrong.push(format!("{mistake}: not seen in {scene}"));
            continue;
        }
        let departure = prepared.departure(&subject, &code, &profile, &pixels);
        if departure.stage != stage {
            wrong.push(format!("{mistake}: {} pixels of {scene}, {departure}; expected {stage}", pixels.len()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn intermediate_results_show_what_pixels_do_not() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let subject = subject();
    let profile = subject.known.profile(&WGSL);
    for (place, row) in UNSEEN.iter().enumerate() {
        let &(mistake, .., scene, stage) = row;
        let prepared = Prepared::new(scene, &profile);
        let code = with(MISTAKES.len() + place, *row);
        assert_eq!(prepared.judged(&subject, &code).misses, [], "{mistake}: seen in {scene}");
        let departure = prepared.departure(&subject, &code, &profile, &prepared.covered(&profile));
        assert_eq!(departure.stage, stage, "{mistake}: {scene} {departure}");
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn right_shaders_depart_nowhere() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let subject = subject();
    let profile = subject.known.profile(&WGSL);
    let code = code_of(None).expect("the built-in shaders are valid");
    for (scene, stage) in RIGHT {
        let prepared = Prepared::new(scene, &profile);
        let departure = prepared.departure(&subject, &code, &profile, &prepared.covered(&profile));
        assert_eq!(departure.stage, *stage, "{scene} {departure}");
    }
}
