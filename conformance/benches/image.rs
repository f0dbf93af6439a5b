//! The reference renderer and the legal values of every pixel, in lit fragments a second: a sphere under one light, lit at
//! every fragment, on 512 × 512 pixels.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::image::expect;
use lightmeter::scene::load;
use lightmeter_reference::render::render;
use lightmeter_scene::effects::effects;
use std::hint::black_box;

/// The light is put in.
const SCENE: &str = r#"{
  "title": "One light", "shows": "A sphere that fills the image.",
  "camera": { "eye": [0, 0, 3], "projection": { "orthographic": { "height": 1.4, "near": 0.5, "far": 5 } } },
  "lights": [LIGHT],
  "materials": { "plain": { "ka": 0.1, "kd": 0.6, "ks": 0.4, "shininess": 32 } },
  "meshes": { "ball": { "shape": { "sphere": { "radius": 1, "rings": 24, "segments": 36 } } } },
  "objects": [{ "mesh": "ball", "material": "plain", "cull": "back" }]
}"#;

const LIGHTS: [(&str, &str); 2] = [
    ("directional", r#"{ "kind": "directional", "color": [1, 0.9, 0.8], "toward": [2, 3, 4] }"#),
    ("point", r#"{ "kind": "point", "color": [1, 0.9, 0.8], "position": [2, 3, 4], "falloff": [1, 0.1, 0.01] }"#),
];

fn images(c: &mut Criterion) {
    let none = |name: &str| Err(std::io::Error::other(name.to_owned()));
    for (name, light) in LIGHTS {
        let loaded = load::text(name, &SCENE.replace("LIGHT", light), &none).expect("the scene is valid");
        let frame = &loaded.frame;
        let called = effects(frame);
        let mut group = c.benchmark_group(format!("one {name} light"));
        group.sample_size(20);
        group.throughput(Throughput::Elements(render::<f64>(frame, None, None).fragments));
        group.bench_function("reference f64", |b| b.iter(|| render::<f64>(black_box(frame), Some(&called), None)));
        group.bench_function("legal values", |b| b.iter(|| expect(black_box(frame), Some(&called), None, &WGSL)));
        group.finish();
    }
}

criterion_group!(benches, images);
criterion_main!(benches);
