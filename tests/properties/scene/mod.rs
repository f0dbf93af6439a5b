//! Laws of whole images, over random frames.

mod builtin;
mod effects;
mod laws;
mod mistakes;
mod split;

use lightmeter::arithmetic::profile::WGSL;
use lightmeter::device::Picture;
use lightmeter::image::drawn::{drawn, intermediate};
use lightmeter::image::{LegalPixel, expect};
use lightmeter::subject_gpu::{code_of, open_device};
use lightmeter_reference::render::{Image, render};
use lightmeter_scene::effects::{effects, named};
use lightmeter_scene::frame::Frame;
use lightmeter_scene::stage::Intermediate;
use lightmeter_scene::target::TargetFormat;
use lightmeter_tests::frames::frame;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// How a law is tried: on `cases` random frames, the same ones at each run.
fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() }
}

/// The first pixel that two images do not have in common, bit for bit.
fn difference(a: &Image, b: &Image) -> Option<String> {
    let pairs = a.pixels.iter().zip(&b.pixels).enumerate();
    let mut differing = pairs.filter(|(_, (a, b))| a.map(f64::to_bits) != b.map(f64::to_bits));
    let (number, (of_a, of_b)) = differing.next()?;
    Some(format!("pixel {} {}: {of_a:?} and {of_b:?}", number % a.width, number / a.width))
}

proptest! {
    #![proptest_config(cases(400))]

    /// The effects that a frame does not call for change no bit of its image.
    #[test]
    fn what_is_not_called_for_changes_nothing(seed: u64) {
        let frame = frame(seed);
        let called = effects(&frame);
        for of in called.iter().chain(&named(&frame)) {
            prop_assert_eq!(of.effects.contradiction(), None, "{}", of.effects);
        }
        let full = render::<f64>(&frame, None, None);
        prop_assert_eq!(difference(&render::<f64>(&frame, Some(&called), None), &full), None);
        prop_assert_eq!(difference(&render::<f64>(&frame, Some(&named(&frame)), None), &full), None);
    }
}

/// The pixels of random frames that are outside what is legal, and how many are marked of how many.
fn departures(
    of: impl Fn(&Frame, Option<Intermediate>) -> Image,
    stage: Option<Intermediate>,
) -> (Vec<String>, usize, usize) {
    let (mut outside, mut marked, mut all) = (vec![], 0, 0);
    for seed in 0..120 {
        let frame = frame(seed);
        let expected = expect(&frame, None, stage, &WGSL);
        let image = of(&frame, stage);
        all += expected.len();
        marked += expected.iter().filter(|expected| expected.is_marked).count();
        outside.extend(illegal(&frame, stage, &expected, &image).map(|told| format!("seed {seed}, {told}")));
    }
    (outside, marked, all)
}

/// The pixels of a frame's image that are not legal.
fn illegal(
    frame: &Frame,
    stage: Option<Intermediate>,
    expected: &[LegalPixel],
    image: &Image,
) -> impl Iterator<Item = String> {
    let pairs = image.pixels.iter().zip(expected).enumerate();
    pairs.filter(move |(_, (pixel, expected))| !contains(frame, stage, expected, **pixel)).map(
        |(number, (pixel, expected))| {
            let (x, y) = (number % image.width, number / image.width);
            format!("pixel {x} {y}: {pixel:?} is not in {expected:?}")
        },
    )
}

fn contains(frame: &Frame, stage: Option<Intermediate>, expected: &LegalPixel, pixel: [f64; 4]) -> bool {
    let units = if stage.is_none() && frame.target.format.is_unorm() { 255.0 } else { 1.0 };
    (0..4).all(|k| {
        let value = pixel[k] * units;
        // A plain image is not rounded to its format: binary16 has 11 bits.
        let is_half = stage.is_none() && frame.target.format == TargetFormat::Rgba16Float;
        let rounding = 1e-12 + if is_half { value.abs() / 2048.0 } else { 0.0 };
        expected.low[k] - rounding <= value && value <= expected.high[k] + rounding
    })
}

#[test]
fn the_reference_and_its_form_in_f32_are_legal() {
    for stage in std::iter::once(None).chain(Intermediate::ALL.map(Some)) {
        for of in [|f: &Frame, s| render::<f64>(f, None, s), |f: &Frame, s| render::<f32>(f, None, s)] {
            let (outside, marked, all) = departures(of, stage);
            assert!(outside.is_empty(), "{stage:?}: {} pixels are not legal, as {}", outside.len(), outside[0]);
            // A third of the frames' triangles are seen on a few pixels only: the share is far above that of a real scene.
            assert!(marked * 50 < all, "{stage:?}: {marked} of {all} pixels are marked");
        }
    }
}

/// Frames that a device draws: its compiler takes most of the time.
const FRAMES: u64 = 24;

/// Random frames on a device: the composed shaders and the one with all effects, each pixel legal by the full
/// reference.
#[test]
#[ignore = "long: ./x campaign long"]
fn devices_draw_random_frames_within_what_is_legal() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let adapters = lightmeter_gpu::native_adapters();
    let adapter = adapters.first().expect("no Vulkan driver is here: `./x test` installs lavapipe");
    let subject = open_device(adapter).expect("the adapter gives a device");
    let code = code_of(None).expect("the built-in shaders are valid");
    let profile = subject.known.profile(&WGSL);
    let mut judged = 0;
    for seed in 0..FRAMES {
        let frame = frame(seed);
        let expected = expect(&frame, None, None, &profile);
        for (picture, sets) in [(Picture::Composed, effects(&frame)), (Picture::Full, named(&frame))] {
            let image = drawn(&subject, &code, &frame, &sets, picture).expect("it draws").expect("it can be drawn");
            for (number, (pixel, legal)) in image.pixels.iter().zip(&expected).enumerate() {
                let outside = (0..4).find(|&k| !(legal.low[k] <= pixel[k] && pixel[k] <= legal.high[k]));
                let place = [number % 48, number / 48];
                assert_eq!(outside, None, "seed {seed}, {picture:?}, pixel {place:?}: {pixel:?} is not in {legal:?}");
                judged += 1;
            }
        }
    }
    assert_eq!(judged, 2 * 48 * 40 * usize::try_from(FRAMES).expect("few"));
}

/// The intermediate results of random frames on a device, where something is drawn for certain.
#[test]
#[ignore = "long: ./x campaign long"]
fn devices_draw_intermediate_results_within_what_is_legal() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let adapters = lightmeter_gpu::native_adapters();
    let adapter = adapters.first().expect("no Vulkan driver is here: `./x test` installs lavapipe");
    let subject = open_device(adapter).expect("the adapter gives a device");
    let code = code_of(None).expect("the built-in shaders are valid");
    let profile = subject.known.profile(&WGSL);
    let mut judged = 0;
    for seed in 0..FRAMES / 2 {
        let frame = frame(seed);
        let sets = named(&frame);
        let depths = expect(&frame, None, Some(Intermediate::Depth), &profile);
        for stage in Intermediate::ALL {
            let expected = expect(&frame, None, Some(stage), &profile);
            let image =
                intermediate(&subject, &code, &frame, &sets, stage).expect("it draws").expect("it can be drawn");
            for pixel in (0..expected.len()).filter(|&pixel| depths[pixel].low[3] > 0.0) {
                let (legal, value) = (&expected[pixel], image.pixels[pixel]);
                let outside = (0..4).find(|&k| !(legal.low[k] <= value[k] && value[k] <= legal.high[k]));
                assert_eq!(outside, None, "seed {seed}, {stage:?}, pixel {pixel}: {value:?} is not in {legal:?}");
                judged += 1;
            }
        }
    }
    assert!(judged > 10_000, "{judged}");
}
