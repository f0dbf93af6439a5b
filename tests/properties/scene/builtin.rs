//! The built-in scenes: what they call for, how much of them is open, and what is legal near the plane that clips.

use super::contains;
use lightmeter::arithmetic::Profile;
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::image::expect;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::{Loaded, load};
use lightmeter_reference::render::render;
use lightmeter_scene::effects::{Effect, Effects, effects};

fn scenes() -> impl Iterator<Item = Loaded> {
    SCENES.iter().map(|(name, _)| load::builtin(name).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn every_effect_is_called_for_by_some_scene() {
    let called: Effects = scenes()
        .flat_map(|loaded| effects(&loaded.frame))
        .flat_map(|called| called.effects.iter().collect::<Vec<Effect>>())
        .collect();
    let missing: Vec<&str> = Effect::ALL.into_iter().filter(|&e| !called.has(e)).map(Effect::name).collect();
    assert_eq!(missing, Vec::<&str>::new());
}

/// Marked pixels stay below 1 % of an image with 8 subpixel bits and below 4 % with 4.
#[test]
#[ignore = "long: ./x campaign long"]
fn few_pixels_of_a_scene_are_open() {
    for (subpixel_bits, most) in [(8, 1), (4, 4)] {
        let profile = Profile { subpixel_bits, ..WGSL };
        for loaded in scenes() {
            let expected = expect(&loaded.frame, None, None, &profile);
            let marked = expected.iter().filter(|pixel| pixel.is_marked).count();
            let (name, of) = (&loaded.name, expected.len());
            assert!(100 * marked < most * of, "{name}: {marked} of {of} with {subpixel_bits} bits");
        }
    }
}

/// A triangle nearly parallel to the near plane: where it meets it is hardly known, and so is what is seen of it.
#[test]
fn grazing_the_near_plane_stays_legal() {
    const SCENE: &str = r#"{
        "title": "t", "shows": "s", "target": { "width": 64, "height": 64, "format": "rgba32float" },
        "camera": {
            "eye": [0, 0, 0], "center": [0, 0, -1],
            "projection": { "perspective": { "fov_y_deg": 90, "near": 1, "far": 10 } }
        },
        "materials": { "m": {} },
        "meshes": { "t": { "shape": { "triangles": {
            "positions": [[-3, -3, Z0], [3, -3, Z1], [0, 3, Z2]],
            "colors": [[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1]], "triangles": [[0, 1, 2]]
        } } } },
        "objects": [{ "mesh": "t", "material": "m", "shading": { "frequency": "unlit" }, "vertex_colors": true }]
    }"#;
    let none = |name: &str| Err(std::io::Error::other(name.to_owned()));
    for off in [1e-2, 1e-3, 1e-5, 1e-6, 3e-7, 1e-7] {
        let [z0, z1, z2] = [-1.0 + off, -1.0 - off, -1.0 - off / 3.0].map(|z: f64| z.to_string());
        let json = SCENE.replace("Z0", &z0).replace("Z1", &z1).replace("Z2", &z2);
        let frame = load::text("graze", &json, &none).unwrap_or_else(|error| panic!("{error}")).frame;
        for subpixel_bits in [4, 8] {
            let expected = expect(&frame, None, None, &Profile { subpixel_bits, ..WGSL });
            for image in [render::<f64>(&frame, None, None), render::<f32>(&frame, None, None)] {
                let outside =
                    image.pixels.iter().zip(&expected).filter(|(p, e)| !contains(&frame, None, e, **p)).count();
                assert_eq!(outside, 0, "off by {off} with {subpixel_bits} bits");
            }
        }
    }
}
