//! Laws of the effects, as pairs of frames whose images are the same bit for bit.
//!
//! Each row has a control: a change that is nearly that of its law, after which some image must differ.

use super::laws::opaque;
use super::{cases, difference};
use lightmeter_reference::render::{Image, render};
use lightmeter_scene::frame::{
    Cull, Draw, Fog, FogForm, Frame, Mesh, Place, Sampled, Texture, TextureFilter, Textured, Wrap,
};
use lightmeter_scene::raster::Provoking;
use lightmeter_scene::shading::{Distance, Frequency, LightAmbient};
use lightmeter_scene::stage::Intermediate;
use lightmeter_scene::target::TargetFormat;
use lightmeter_tests::frames::frame;
use proptest::prelude::*;

/// A change of a frame.
type Change = fn(&mut Frame);

/// Two changes that give the same image, and a third that must not.
struct Law {
    what: &'static str,
    /// What is done to the frame before.
    given: Change,
    one: Change,
    other: Change,
    wrong: Change,
}

const LAWS: &[Law] = &[
    Law {
        what: "exponential fog of density 0 is none",
        given: |_| (),
        one: |frame| fog(frame, FogForm::Exp { density: 0.0 }),
        other: |frame| frame.fog = None,
        wrong: |frame| fog(frame, FogForm::Exp { density: 1e-6 }),
    },
    Law {
        what: "exponential-squared fog of document 000, of density 0, is none",
        given: |_| (),
        one: |frame| fog(frame, FogForm::Exp2Document { density: 0.0 }),
        other: |frame| frame.fog = None,
        wrong: |frame| fog(frame, FogForm::Exp2Document { density: 1e-6 }),
    },
    Law {
        what: "exponential-squared fog of OpenGL, of density 0, is none",
        given: |_| (),
        one: |frame| fog(frame, FogForm::Exp2OpenGl { density: 0.0 }),
        other: |frame| frame.fog = None,
        wrong: |frame| fog(frame, FogForm::Exp2OpenGl { density: 1e-3 }),
    },
    Law {
        what: "linear fog that begins behind everything is none",
        given: |_| (),
        one: |frame| fog(frame, FogForm::Linear { dmin: 50.0, dmax: 60.0 }),
        other: |frame| frame.fog = None,
        wrong: |frame| fog(frame, FogForm::Linear { dmin: 0.0, dmax: 60.0 }),
    },
    Law {
        // Everything lies behind the near plane, at 0.5.
        what: "where f = 0 the fog's colour is seen",
        given: |frame| {
            bare(frame);
            fog(frame, FogForm::Linear { dmin: 0.25, dmax: 0.5 });
        },
        one: |_| (),
        other: |frame| {
            let color = frame.fog.take().expect("just given").color;
            unlit(frame, color);
        },
        wrong: |frame| fog(frame, FogForm::Linear { dmin: 0.25, dmax: 9.0 }),
    },
    Law {
        what: "a white texture, read at the nearest texel, changes nothing",
        given: |_| (),
        one: |frame| texture(frame, 1.0, false),
        other: |frame| frame.draws.iter_mut().for_each(|draw| draw.texture = None),
        wrong: |frame| texture(frame, 0.999, false),
    },
    Law {
        what: "a texture in place of the colour is the colour",
        given: |_| (),
        one: |frame| texture(frame, 1.0, true),
        other: |frame| {
            unlit(frame, [1.0; 3]);
            for draw in &mut frame.draws {
                (draw.texture, draw.vertex_colors, draw.alpha) = (None, false, 1.0);
            }
        },
        wrong: |frame| texture(frame, 0.999, true),
    },
    Law {
        what: "a threshold of 0 cuts nothing out",
        given: |_| (),
        one: |frame| frame.draws.iter_mut().for_each(|draw| draw.cutout = Some(0.0)),
        other: |frame| frame.draws.iter_mut().for_each(|draw| draw.cutout = None),
        wrong: |frame| frame.draws.iter_mut().for_each(|draw| draw.cutout = Some(0.3)),
    },
    Law {
        what: "a threshold above 1 leaves nothing",
        given: |_| (),
        one: |frame| frame.draws.iter_mut().for_each(|draw| draw.cutout = Some(1.001)),
        other: |frame| frame.draws.clear(),
        wrong: |frame| frame.draws.iter_mut().for_each(|draw| draw.cutout = Some(1.0)),
    },
    Law {
        // Nothing is seen beside or behind a light that far before the near plane, and nothing of the meshes is.
        what: "a spotlight, evenly bright, is a point light within its cone",
        given: |_| (),
        one: |frame| positional(frame, Some([0.0, 0.0])),
        other: |frame| positional(frame, None),
        wrong: |frame| positional(frame, Some([0.98, 0.0])),
    },
    Law {
        what: "an exponent of 0 leaves the cone evenly bright, any other does not",
        given: |_| (),
        one: |frame| positional(frame, Some([0.0, 0.0])),
        other: |frame| positional(frame, None),
        wrong: |frame| positional(frame, Some([0.0, 0.01])),
    },
    Law {
        what: "an axis is a unit vector already",
        given: |_| (),
        one: |frame| directional(frame, [0.0, 0.0, 1.0], true),
        other: |frame| directional(frame, [0.0, 0.0, 1.0], false),
        wrong: |frame| directional(frame, [0.0, 0.0, 0.999], true),
    },
    Law {
        what: "a light's vector is normalised, whatever its length",
        given: |_| (),
        one: |frame| directional(frame, [0.0, -4.0, 0.0], false),
        other: |frame| directional(frame, [0.0, -1.0, 0.0], true),
        wrong: |frame| directional(frame, [0.0, -4.0, 0.0], true),
    },
    Law {
        what: "all faces are the back faces and the front faces",
        given: |frame| {
            opaque(frame);
            frame.draws.iter_mut().for_each(|draw| draw.cull = Cull::None);
        },
        one: |_| (),
        other: |frame| both_faces(frame, [Cull::Front, Cull::Back]),
        wrong: |frame| both_faces(frame, [Cull::Front, Cull::Front]),
    },
    Law {
        what: "the last vertex is the first of the triangle turned on",
        given: |frame| {
            opaque(frame);
            bare(frame);
            frame.fog = None;
        },
        one: |frame| flat(frame, Provoking::Last),
        other: |frame| {
            flat(frame, Provoking::First);
            frame.meshes.iter_mut().for_each(turn);
        },
        wrong: |frame| flat(frame, Provoking::First),
    },
    Law {
        what: "a black light is none",
        given: |_| (),
        one: |frame| shine(frame, 0.0),
        other: |frame| frame.lights.clear(),
        wrong: |frame| shine(frame, 1e-3),
    },
];

fn fog(frame: &mut Frame, form: FogForm) {
    frame.fog = Some(Fog { color: [0.25, 0.5, 0.75], form, distance: Distance::Planar });
}

/// Without textures and vertex colours, nothing cut out.
fn bare(frame: &mut Frame) {
    for draw in &mut frame.draws {
        (draw.texture, draw.lightmap, draw.vertex_colors, draw.cutout) = (None, None, false, None);
    }
}

fn unlit(frame: &mut Frame, color: [f32; 3]) {
    for draw in &mut frame.draws {
        draw.shading = None;
        draw.material.diffuse = color;
    }
}

/// A texture of one grey on everything.
fn texture(frame: &mut Frame, grey: f32, replaces: bool) {
    frame.textures.push(Texture { width: 2, height: 1, texels: vec![[grey, grey, grey, 1.0]; 2] });
    let sampled = Sampled { texture: frame.textures.len() - 1, filter: TextureFilter::Nearest, wrap: Wrap::Repeat };
    frame.draws.iter_mut().for_each(|draw| draw.texture = Some(Textured { sampled, replaces }));
}

/// Each light far behind the eye, as a spotlight of a cutoff's cosine and an exponent, or as a point light.
fn positional(frame: &mut Frame, cone: Option<[f32; 2]>) {
    for (place, light) in (0_u8..).zip(&mut frame.lights) {
        let (position, falloff) = ([f32::from(place), 0.5, 9.0], [1.0, 0.1, 0.01]);
        light.place = match cone {
            Some([cutoff_cosine, exponent]) => {
                Place::Spot { position, falloff, axis: [0.0, 0.0, -2.0], cutoff_cosine, exponent }
            }
            None => Place::Point { position, falloff },
        };
    }
}

fn directional(frame: &mut Frame, toward: [f32; 3], unit: bool) {
    frame.lights.iter_mut().for_each(|light| light.place = Place::Directional { toward, unit });
}

/// Each draw twice, with the faces that it leaves out.
fn both_faces(frame: &mut Frame, culls: [Cull; 2]) {
    let draws = std::mem::take(&mut frame.draws);
    for draw in draws {
        frame.draws.extend(culls.map(|cull| Draw { cull, ..draw.clone() }));
    }
}

fn flat(frame: &mut Frame, provoking: Provoking) {
    for shading in frame.draws.iter_mut().filter_map(|draw| draw.shading.as_mut()) {
        (shading.frequency, shading.provoking) = (Frequency::Flat, provoking);
    }
}

fn turn(mesh: &mut Mesh) {
    mesh.triangles.iter_mut().for_each(|triangle| triangle.rotate_right(1));
}

/// All lights by so much brighter.
fn shine(frame: &mut Frame, by: f32) {
    for light in &mut frame.lights {
        for color in [&mut light.ambient, &mut light.diffuse, &mut light.specular] {
            *color = color.map(|c| c * by);
        }
    }
}

fn image(frame: &Frame, change: Change) -> Image {
    let mut frame = frame.clone();
    change(&mut frame);
    render::<f64>(&frame, None, None)
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn each_law_of_an_effect_holds(seed: u64) {
        for law in LAWS {
            let mut frame = frame(seed);
            (law.given)(&mut frame);
            let told = difference(&image(&frame, law.one), &image(&frame, law.other));
            prop_assert_eq!(told, None, "{}", law.what);
        }
    }

    /// A lightmap of one colour multiplies by it.
    #[test]
    fn a_lightmap_of_a_constant_scales(seed: u64, c in 0.0_f32..1.0) {
        let mut frame = frame(seed);
        opaque(&mut frame);
        frame.target.format = TargetFormat::Rgba32Float;
        (frame.fog, frame.background) = (None, [0.0; 4]);
        frame.draws.iter_mut().for_each(|draw| (draw.texture, draw.lightmap) = (None, None));
        let mut scaled = render::<f64>(&frame, None, None);
        scaled.pixels.iter_mut().flatten().for_each(|x| *x *= f64::from(c));
        frame.textures[0] = Texture { width: 1, height: 1, texels: vec![[c; 4]] };
        let sampled = Sampled { texture: 0, filter: TextureFilter::Nearest, wrap: Wrap::Clamp };
        frame.draws.iter_mut().for_each(|draw| draw.lightmap = Some(sampled));
        let image = render::<f64>(&frame, None, None);
        prop_assert_eq!(difference(&image, &scaled), None);
    }

    /// Twice the light gives twice the diffuse colour and the highlight: a power of two rounds nothing.
    #[test]
    fn twice_the_light_is_twice_as_bright(seed: u64) {
        let mut frame = frame(seed);
        opaque(&mut frame);
        frame.ambient = [0.0; 3];
        frame.draws.retain(|draw| draw.shading.is_some());
        frame.draws.iter_mut().for_each(|draw| draw.material.emissive = [0.0; 3]);
        for stage in [Intermediate::Diffuse, Intermediate::Specular] {
            let mut once = render::<f64>(&frame, None, Some(stage));
            once.pixels.iter_mut().flat_map(|pixel| &mut pixel[..3]).for_each(|x| *x *= 2.0);
            let mut frame = frame.clone();
            shine(&mut frame, 2.0);
            let twice = render::<f64>(&frame, None, Some(stage));
            prop_assert_eq!(difference(&twice, &once), None, "{:?}", stage);
        }
    }

    /// Lit at the fragments, what an evenly bright cone shows is the point light within it and no light outside.
    #[test]
    fn a_cone_is_all_or_nothing(seed: u64) {
        let mut given = frame(seed);
        opaque(&mut given);
        given.lights.truncate(1);
        given.light_ambient = LightAmbient::OpenGl;
        for shading in given.draws.iter_mut().filter_map(|draw| draw.shading.as_mut()) {
            shading.frequency = Frequency::Phong;
        }
        let cone = image(&given, |frame| positional(frame, Some([0.98, 0.0])));
        let choices = [image(&given, |frame| positional(frame, None)), image(&given, |frame| frame.lights.clear())];
        for (number, pixel) in cone.pixels.iter().enumerate() {
            prop_assert!(choices.iter().any(|image| image.pixels[number] == *pixel), "{} {:?}", number, pixel);
        }
    }
}

#[test]
fn each_control_breaks_its_law() {
    for law in LAWS {
        let breaks = (0..100).any(|seed| {
            let mut frame = frame(seed);
            (law.given)(&mut frame);
            difference(&image(&frame, law.wrong), &image(&frame, law.other)).is_some()
        });
        assert!(breaks, "{}", law.what);
    }
}
