//! The resolution of scenes: for each parameter of each built-in scene the smallest error that an image tells.

use super::{draw, fails};
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::scene::SceneError;
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::select::{builtin, scene_id};
use lightmeter_document::event::Stop;
use lightmeter_document::selftest::SceneResolution;
use lightmeter_judge::image::bias::Bias;
use lightmeter_judge::image::expect;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_reference::render::render;
use lightmeter_scene::frame::{Fog, FogForm, Frame, Material, Place};
use lightmeter_scene::target::{Encoding, TargetFormat};
use rayon::prelude::*;

/// The greatest relative error that is tried; beyond, a parameter does not count.
const GREATEST: f32 = 0.25;
/// The least.
const LEAST: f32 = 1.0 / 1_048_576.0;
/// Halvings between the last error that is told and the first that is not: the smallest is known to 7 %.
const HALVINGS: u32 = 3;

/// A number of a scene, and how it is multiplied.
type Scaled = (&'static str, fn(&mut Frame, f32));

/// What is measured.
const PARAMETERS: &[Scaled] = &[
    ("all light", |frame, k| {
        scale(&mut frame.ambient, k);
        frame.lights.iter_mut().for_each(|light| {
            [&mut light.ambient, &mut light.diffuse, &mut light.specular].into_iter().for_each(|color| scale(color, k));
        });
        each_material(frame, |material| scale(&mut material.emissive, k));
    }),
    ("ambient light", |frame, k| {
        scale(&mut frame.ambient, k);
        frame.lights.iter_mut().for_each(|light| scale(&mut light.ambient, k));
    }),
    ("emission", |frame, k| each_material(frame, |material| scale(&mut material.emissive, k))),
    ("diffuse material", |frame, k| each_material(frame, |material| scale(&mut material.diffuse, k))),
    ("specular material", |frame, k| each_material(frame, |material| scale(&mut material.specular, k))),
    ("shininess", |frame, k| each_material(frame, |material| material.shininess *= k)),
    ("attenuation", |frame, k| {
        for light in &mut frame.lights {
            if let Place::Point { falloff, .. } | Place::Spot { falloff, .. } = &mut light.place {
                scale(falloff, k);
            }
        }
    }),
    ("cone's exponent", |frame, k| {
        for light in &mut frame.lights {
            if let Place::Spot { exponent, .. } = &mut light.place {
                *exponent *= k;
            }
        }
    }),
    ("fog's density or end", |frame, k| match &mut frame.fog {
        Some(Fog { form: FogForm::Linear { dmax, .. }, .. }) => *dmax *= k,
        Some(Fog {
            form: FogForm::Exp { density } | FogForm::Exp2Document { density } | FogForm::Exp2OpenGl { density },
            ..
        }) => *density *= k,
        None => {}
    }),
    ("fog's colour", |frame, k| frame.fog.iter_mut().for_each(|fog| scale(&mut fog.color, k))),
];

fn scale(numbers: &mut [f32; 3], k: f32) {
    numbers.iter_mut().for_each(|x| *x *= k);
}

fn each_material(frame: &mut Frame, mut f: impl FnMut(&mut Material)) {
    frame.draws.iter_mut().for_each(|draw| f(&mut draw.material));
}

/// Measures every parameter of every built-in scene. `size` is the count of pixels on a scene's longer side. When `stop` is set, the
/// scene that is being measured is finished, and no other is begun.
///
/// # Errors
/// Where a scene is refused, which a test rules out.
pub fn calibrate(
    size: u32,
    profile: &Profile,
    stop: &Stop,
    progress: &mut impl FnMut(&str),
) -> Result<Vec<SceneResolution>, SceneError> {
    let mut found = vec![];
    for place in 0..SCENES.len() {
        if stop.is_set() {
            break;
        }
        let id = scene_id(place);
        progress(&id);
        let measured = Measured::new(builtin(place, Some(size))?.frame, profile);
        let rows: Vec<Option<SceneResolution>> =
            PARAMETERS.par_iter().map(|parameter| measured.resolution(&id, *parameter)).collect();
        found.extend(rows.into_iter().flatten());
    }
    Ok(found)
}

/// A scene with what is legal of it.
struct Measured {
    frame: Frame,
    expected: Vec<lightmeter_judge::image::LegalPixel>,
    /// The same before it is stored, where all pixels of 8 bits tell together what each hides.
    on_floats: Option<Vec<lightmeter_judge::image::LegalPixel>>,
    reference: StoredImage,
    /// The numbers of all pixels.
    all: Vec<usize>,
}

impl Measured {
    fn new(frame: Frame, profile: &Profile) -> Self {
        let expected = expect(&frame, None, None, profile);
        let reference = StoredImage::unrounded(&render::<f64>(&frame, None, None), frame.target.format);
        let is_biased =
            frame.target.format.encoding() == Encoding::Unorm8 && frame.draws.iter().all(|draw| draw.blend.is_none());
        let on_floats = is_biased.then(|| {
            let mut on_floats = frame.clone();
            on_floats.target.format = TargetFormat::Rgba32Float;
            expect(&on_floats, None, None, profile)
        });
        let all = (0..expected.len()).collect();
        Self { frame, expected, on_floats, reference, all }
    }

    fn resolution(&self, id: &str, (parameter, scale): Scaled) -> Option<SceneResolution> {
        let drawn = |error: f32| {
            let mut frame = self.frame.clone();
            scale(&mut frame, 1.0 + error);
            draw::<f32>(&frame, &[])
        };
        // What the scene does not show is not measured.
        if drawn(GREATEST).pixels == draw::<f32>(&self.frame, &[]).pixels {
            return None;
        }
        let by_pixel = |error: f32| fails(&drawn(error), &self.reference, &self.expected);
        let together = |error: f32| {
            let image = drawn(error);
            fails(&image, &self.reference, &self.expected) || self.is_biased(&image)
        };
        Some(SceneResolution {
            scene: id.into(),
            target: self.frame.target.format.name().into(),
            parameter: parameter.into(),
            pixel: smallest(by_pixel),
            image: smallest(together),
        })
    }

    fn is_biased(&self, image: &StoredImage) -> bool {
        let is_float = self.frame.target.format.encoding() == Encoding::Float32;
        if is_float && self.frame.draws.iter().all(|draw| draw.blend.is_none()) {
            return Bias::of_floats(image, &self.reference, &self.expected, &self.all).is_some();
        }
        let Some(on_floats) = &self.on_floats else { return false };
        Bias::of(image, &self.reference, &self.expected, &self.all).is_some()
            && Bias::beyond(image, &self.reference, on_floats, &self.all).is_some()
    }
}

/// The smallest error that is told; `None` where the greatest is not.
fn smallest(is_told: impl Fn(f32) -> bool) -> Option<f64> {
    let mut told = GREATEST;
    if !is_told(told) {
        return None;
    }
    while told > LEAST && is_told(told * 0.5) {
        told *= 0.5;
    }
    let mut untold = told * 0.5;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (told + untold);
        if is_told(middle) {
            told = middle;
        } else {
            untold = middle;
        }
    }
    Some(told.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;

    #[test]
    fn the_smallest_error_is_found() {
        let found = smallest(|error| error > 0.01).expect("it is told");
        assert!((0.01..0.011).contains(&found), "{found}");
        assert_eq!(smallest(|_| false), None);
    }

    #[test]
    fn the_pixels_of_an_image_tell_together_what_none_tells_alone() {
        let place = SCENES.iter().position(|(name, _)| *name == "flat").expect("it is built in");
        let frame = builtin(place, Some(64)).expect("it can be read").frame;
        let row = Measured::new(frame, &WGSL).resolution("scene/flat", PARAMETERS[0]).expect("it has light");
        let (pixel, image) = (row.pixel.expect("a pixel tells it"), row.image.expect("the image tells it"));
        assert!(image < pixel && pixel < 0.05, "{row:?}");
    }
}
