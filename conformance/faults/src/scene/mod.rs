//! Which mistake a renderer made, from an image: a frame that is drawn as if it were another, and colours that are written
//! elsewhere or otherwise than they should be.

pub mod calibrate;
mod diagnose;
mod look;
pub mod noise;
pub mod selftest;
mod table;

pub use diagnose::{PixelPart, SceneDiagnosis, SceneExplanation, Trial};
use lightmeter_judge::image::LegalPixel;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_judge::image::judge;
use lightmeter_reference::Real;
use lightmeter_reference::render::{Image, render, render_at};
use lightmeter_scene::frame::Frame;
pub use look::looks;
use table::Change;
pub use table::{SCENE_FAULTS, SceneFault};

impl SceneFault {
    /// The frame with the mistake; as it is, of one that changes the image alone.
    #[must_use]
    pub fn frame(&self, mut frame: Frame) -> Frame {
        if let Change::Frame(change) = self.change {
            change(&mut frame);
        }
        frame
    }

    /// The colour that is written for a linear one.
    fn color(&self, pixel: [f64; 4]) -> [f64; 4] {
        if let Change::Color(change) = self.change { change(pixel) } else { pixel }
    }

    /// The pixel that a pixel takes its colour from. `size` is the number of columns and rows.
    fn place(&self, pixel: [usize; 2], size: [usize; 2]) -> [usize; 2] {
        if let Change::Place(change) = self.change { change(pixel, size) } else { pixel }
    }

    const fn is_of_frame(&self) -> bool {
        matches!(self.change, Change::Frame(_))
    }

    const fn is_of_color(&self) -> bool {
        matches!(self.change, Change::Color(_))
    }
}

/// A frame with mistakes.
fn with(frame: &Frame, faults: &[&'static SceneFault]) -> Frame {
    faults.iter().fold(frame.clone(), |frame, fault| fault.frame(frame))
}

/// The linear colours that are written for those that a frame has.
fn colors(pixels: &mut [[f64; 4]], faults: &[&'static SceneFault]) {
    for pixel in pixels {
        *pixel = faults.iter().fold(*pixel, |color, fault| fault.color(color));
    }
}

/// The pixels whose colours some pixels get, by their numbers row after row.
fn places(frame: &Frame, pixels: &[usize], faults: &[&'static SceneFault]) -> Vec<usize> {
    let size = [frame.target.width as usize, frame.target.height as usize];
    let source = |&pixel: &usize| {
        let [x, y] = faults.iter().fold([pixel % size[0], pixel / size[0]], |pixel, fault| fault.place(pixel, size));
        y * size[0] + x
    };
    pixels.iter().map(source).collect()
}

/// What a renderer with these mistakes draws in an arithmetic, in the target's units, rounded to it.
#[must_use]
pub fn draw<R: Real + Into<f64> + Send + Sync>(frame: &Frame, faults: &[&'static SceneFault]) -> StoredImage {
    let image = render::<R>(&with(frame, faults), None, None);
    let all: Vec<usize> = (0..image.pixels.len()).collect();
    let mut pixels: Vec<[f64; 4]> =
        places(frame, &all, faults).into_iter().map(|source| image.pixels[source]).collect();
    colors(&mut pixels, faults);
    StoredImage::of(&Image { pixels, ..image }, frame.target.format)
}

/// The same at some pixels, by their numbers row after row, in f64: the rest is not drawn.
fn draw_at(frame: &Frame, faults: &[&'static SceneFault], pixels: &[usize]) -> Vec<[f64; 4]> {
    let mut drawn = render_at::<f64>(&with(frame, faults), &places(frame, pixels, faults));
    colors(&mut drawn, faults);
    let (width, format) = (drawn.len(), frame.target.format);
    StoredImage::of(&Image { width, height: 1, pixels: drawn, fragments: 0 }, format).pixels
}

/// Whether a judgement of all pixels has something against an image.
#[must_use]
pub fn fails(image: &StoredImage, reference: &StoredImage, expected: &[LegalPixel]) -> bool {
    let all: Vec<usize> = (0..image.pixels.len()).collect();
    !judge::judge(image, reference, expected, &all).misses.is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::scene::library::SCENES;
    use lightmeter_catalogue::scene::select::builtin;
    use lightmeter_judge::image::expect;
    use lightmeter_scene::frame::{Fog, FogForm};

    fn frame(scene: &str) -> Frame {
        let place = SCENES.iter().position(|(name, _)| *name == scene).expect("it is built in");
        builtin(place, Some(128)).expect("it can be read").frame
    }

    fn mistake(name: &str) -> &'static SceneFault {
        SCENE_FAULTS.iter().find(|fault| fault.name == name).expect("it is known")
    }

    /// The diagnosis of a scene of which a part is drawn with a mistake: the pixels that are chosen by their column.
    fn diagnosis(scene: &str, name: &str, is_wrong: impl Fn(usize) -> bool) -> SceneDiagnosis {
        let frame = frame(scene);
        let (mut image, wrong) = (draw::<f32>(&frame, &[]), draw::<f32>(&frame, &[mistake(name)]));
        for (place, pixel) in image.pixels.iter_mut().enumerate() {
            if is_wrong(place % image.width) {
                *pixel = wrong.pixels[place];
            }
        }
        Trial::new(&frame, &image, &expect(&frame, None, None, &WGSL), &WGSL).diagnose()
    }

    #[test]
    #[ignore = "long: ./x campaign long"]
    fn what_is_wrong_in_a_part_of_an_image_alone_has_no_name() {
        for (scene, name) in
            [("phong", "diffuse-left-out"), ("teapot", "specular-left-out"), ("spotlight", "spot-as-point")]
        {
            let whole = diagnosis(scene, name, |_| true);
            let named = whole.explanations.first().map(|explanation| explanation.faults[0].name);
            assert_eq!(named, Some(name), "{scene}: {}", whole.diagnosis);
            let part = diagnosis(scene, name, |column| column % 2 == 0);
            assert!(part.failing > 0 && part.explanations.is_empty(), "{scene}, {name}: {}", part.diagnosis);
        }
    }

    /// The diagnosis of a scene that is drawn otherwise.
    fn of_changed(scene: &str, change: impl Fn(&mut Frame)) -> SceneDiagnosis {
        let frame = frame(scene);
        let mut changed = frame.clone();
        change(&mut changed);
        let image = draw::<f32>(&changed, &[]);
        Trial::new(&frame, &image, &expect(&frame, None, None, &WGSL), &WGSL).diagnose()
    }

    #[test]
    fn a_wrong_alpha_hides_no_cause_of_a_wrong_color() {
        let frame = frame("phong");
        let mut image = draw::<f32>(&frame, &[mistake("diffuse-left-out")]);
        // Of alpha, what nothing in the catalogue does.
        for (place, pixel) in image.pixels.iter_mut().enumerate() {
            pixel[3] = f64::from(u32::try_from(place * 37 % 200).expect("it is small"));
        }
        let found = Trial::new(&frame, &image, &expect(&frame, None, None, &WGSL), &WGSL).diagnose();
        assert!(found.explanations.is_empty() && found.parts.len() == 2, "{}", found.diagnosis);
        let named = |part: usize| found.parts[part].1.first().map(|best| best.faults[0].name);
        assert_eq!((found.parts[0].0, named(0)), (PixelPart::Color, Some("diffuse-left-out")), "{}", found.diagnosis);
        assert_eq!((found.parts[1].0, named(1)), (PixelPart::Alpha, None), "{}", found.diagnosis);
        let told = found.diagnosis.to_string();
        assert!(told.contains("wrong values of color are explained by: the diffuse term is left out"), "{told}");
    }

    #[test]
    #[ignore = "long: ./x campaign long"]
    fn a_wrong_parameter_is_named_with_its_factor() {
        let shininess = |factor: f32| {
            move |frame: &mut Frame| frame.draws.iter_mut().for_each(|draw| draw.material.shininess *= factor)
        };
        let told = of_changed("phong", shininess(2.0)).diagnosis.to_string();
        assert!(told.contains("explained by: the shininess is 2 times what was asked"), "{told}");
        let told = of_changed("teapot", shininess(1.7)).diagnosis.to_string();
        let factor = told.split("the shininess is ").nth(1).and_then(|rest| rest.split(' ').next());
        let factor: f64 = factor.and_then(|factor| factor.parse().ok()).expect("a factor is told");
        assert!((factor - 1.7).abs() < 0.02, "{told}");
        let told = of_changed("fog-exp", |frame| {
            if let Some(Fog { form: FogForm::Exp { density }, .. }) = &mut frame.fog {
                *density *= 1.5;
            }
        });
        assert!(told.diagnosis.to_string().contains("the fog's density is 1.5 times"), "{}", told.diagnosis);
    }

    #[test]
    #[ignore = "long: ./x campaign long"]
    fn a_pixel_that_is_as_bright_as_can_be_says_nothing() {
        let frame = frame("phong");
        let mut image = draw::<f32>(&frame, &[]);
        let expected = expect(&frame, None, None, &WGSL);
        // A component that a mistake would saturate, and that is far from it where the scene is drawn rightly.
        let saturated = |fault: &'static SceneFault| {
            let wrong = draw::<f32>(&frame, &[fault]);
            (0..image.pixels.len()).find(|&place| wrong.pixels[place][0] >= 255.0 && image.pixels[place][0] < 200.0)
        };
        let place = SCENE_FAULTS.iter().find_map(saturated).expect("a mistake saturates a pixel");
        image.pixels[place][0] = 255.0;
        let found = Trial::new(&frame, &image, &expected, &WGSL).diagnose();
        assert!(found.failing > 0 && found.explanations.is_empty(), "{}", found.diagnosis);
    }

    #[test]
    fn some_pixels_are_drawn_as_they_are_in_the_whole_image() {
        for (scene, names) in [
            ("teapot", &["upside-down", "gamma-encoded"][..]),
            ("translucent-square", &["mirrored", "premultiplied"]),
            ("gouraud", &["half-lambert"]),
            ("fog-exp", &[]),
        ] {
            let (frame, faults) = (frame(scene), names.iter().map(|name| mistake(name)).collect::<Vec<_>>());
            let (image, some) = (draw::<f64>(&frame, &faults), (0..128 * 64).step_by(37).collect::<Vec<_>>());
            let drawn = draw_at(&frame, &faults, &some);
            for (&pixel, color) in some.iter().zip(&drawn) {
                assert_eq!(image.pixels[pixel].map(f64::to_bits), color.map(f64::to_bits), "{scene} {names:?} {pixel}");
            }
        }
    }

    #[test]
    fn the_sentence_of_what_has_no_name_tells_what_its_failures_have_in_common() {
        let frame = frame("phong");
        let mut image = draw::<f32>(&frame, &[]);
        // The red of a rectangle is brighter by a pattern that no mistake of the catalogue makes.
        for (x, y) in (40..80).flat_map(|x| (30..60).map(move |y| (x, y))) {
            image.pixels[y * 128 + x][0] += f64::from(u32::try_from(20 + (x * 7 + y * 13) % 11).expect("it is small"));
        }
        let found = Trial::new(&frame, &image, &expect(&frame, None, None, &WGSL), &WGSL).diagnose();
        let failing = found.failing;
        assert!((1100..=1200).contains(&failing), "{failing}");
        let told = format!(
            "nothing in the catalogue explains the {} failing components of pixels: all are red, all are too great, \
             all are in columns 40 to 79 and rows 30 to 59",
            lightmeter_document::thousands(failing as u64)
        );
        assert_eq!(found.diagnosis.to_string(), told);
    }
}
