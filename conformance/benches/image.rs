//! The reference renderer and the legal values of every pixel, in lit fragments a second: a sphere under one light, lit at
//! every fragment, on 512 × 512 pixels.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::image::expect;
use lightmeter::scene::{Loaded, load};
use lightmeter_reference::render::render;
use lightmeter_scene::effects::effects;

/// The light is put in.
const SCENE: &str = r#"{
  "title": "One light", "shows": "A sphere that fills the image.",
  "camera": { "eye": [0, 0, 3], "projection": { "orthographic": { "height": 1.4, "near": 0.5, "far": 5 } } },
  "lights": [LIGHT],
  "materials": { "plain": { "ka": 0.1, "kd": 0.6, "ks": 0.4, "shininess": 32 } },
  "meshes": { "ball": { "shape": { "sphere": { "radius": 1, "rings": 24, "segments": 36 } } } },
  "objects": [{ "mesh": "ball", "material": "plain", "cull": "back" }]
}"#;

const DIRECTIONAL: &str = r#"{ "kind": "directional", "color": [1, 0.9, 0.8], "toward": [2, 3, 4] }"#;
const POINT: &str = r#"{ "kind": "point", "color": [1, 0.9, 0.8], "position": [2, 3, 4], "falloff": [1, 0.1, 0.01] }"#;

fn main() {
    divan::main();
}

fn scene(light: &str) -> Loaded {
    let none = |name: &str| Err(std::io::Error::other(name.to_owned()));
    load::text("light", &SCENE.replace("LIGHT", light), &none).expect("the scene is valid")
}

#[divan::bench(args = [DIRECTIONAL, POINT], sample_count = 20)]
fn reference_f64(bencher: Bencher<'_, '_>, light: &str) {
    let loaded = scene(light);
    let (frame, called) = (&loaded.frame, effects(&loaded.frame));
    let lit = render::<f64>(frame, None, None).fragments;
    bencher.counter(ItemsCount::new(lit)).bench_local(|| render::<f64>(black_box(frame), Some(&called), None));
}

#[divan::bench(args = [DIRECTIONAL, POINT], sample_count = 20)]
fn legal_values(bencher: Bencher<'_, '_>, light: &str) {
    let loaded = scene(light);
    let (frame, called) = (&loaded.frame, effects(&loaded.frame));
    let lit = render::<f64>(frame, None, None).fragments;
    bencher.counter(ItemsCount::new(lit)).bench_local(|| expect(black_box(frame), Some(&called), None, &WGSL));
}
