//! Both shaders draw the same frame on whatever adapters are there, and structs lie where the uniforms' words do.

use super::uniforms::Told;
use super::*;
use crate::adapters;
use crate::device::ClockKind;
use crate::rung::Rung;
use crate::work::tests::words_by_json;
use lightmeter_scene::blend::{Equation, Factor, State};
use lightmeter_scene::depth::{Compare, DepthTest};
use lightmeter_scene::effects::{effects, named};
use lightmeter_scene::frame::{
    Blend, Cull, Draw, Fog, FogForm, Light, Material, Matrix, Mesh, Place, Sampled, Shading, Target, Texture,
    TextureFilter, Textured, Wrap,
};
use lightmeter_scene::raster::Provoking;
use lightmeter_scene::shading::{Ambient, Distance, Frequency, LightAmbient, Normals, Specular, SpecularGate, Viewer};
use std::sync::{Mutex, MutexGuard, PoisonError};

const IDENTITY: Matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
const SIZE: usize = 33;

/// Two triangles that face the eye, two units away, under every kind of light, in fog, textured, with holes.
fn frame() -> Frame {
    let mut projection = IDENTITY;
    projection[2] = [0.0, 0.0, -1.1, -1.0];
    projection[3] = [0.0, 0.0, -1.1, 0.0];
    Frame {
        target: Target {
            width: u32::try_from(SIZE).expect("it is small"),
            height: u32::try_from(SIZE).expect("it is small"),
            format: TargetFormat::Rgba32Float,
        },
        background: [0.1, 0.2, 0.3, 0.4],
        clear_depth: 1.0,
        projection,
        ambient: [0.2, 0.3, 0.4],
        ambient_form: Ambient::Product,
        departures: lightmeter_scene::frame::Departures::default(),
        light_ambient: LightAmbient::OpenGl,
        lights: lights(),
        fog: Some(Fog {
            color: [0.5, 0.5, 0.6],
            form: FogForm::Linear { dmin: 1.5, dmax: 2.3 },
            distance: Distance::Radial,
        }),
        meshes: vec![mesh()],
        textures: vec![texture(0), texture(1)],
        draws: vec![square()],
    }
}

fn mesh() -> Mesh {
    Mesh {
        positions: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.2], [1.0, 1.0, 0.0], [-1.0, 1.0, -0.3]],
        normals: vec![[-0.2, 0.0, 1.0], [0.3, 0.1, 2.0], [0.0, 0.4, 1.0], [0.1, -0.2, 0.7]],
        uvs: vec![[-0.3, 1.4], [1.2, 1.1], [1.3, -0.2], [0.0, 0.0]],
        lightmap_uvs: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        colors: vec![[1.0, 0.5, 0.5, 1.0], [0.5, 1.0, 0.5, 0.9], [0.5, 0.5, 1.0, 0.8], [1.0; 4]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

fn texture(seed: usize) -> Texture {
    let texels =
        (0..12).map(|k| std::array::from_fn(|c| [0.2, 0.9, 0.5, 0.7, 1.0][(k * (3 + seed) + c * 2) % 5])).collect();
    Texture { width: 4, height: 3, texels }
}

fn square() -> Draw {
    let shading = Shading {
        frequency: Frequency::Phong,
        provoking: Provoking::First,
        specular: Specular::Blinn,
        gate: SpecularGate::OpenGl,
        viewer: Viewer::Local,
        normals: Normals::InverseTranspose,
    };
    let mut modelview = IDENTITY;
    modelview[0][0] = 1.2;
    modelview[1][0] = 0.1;
    modelview[3] = [0.0, 0.1, -2.0, 1.0];
    Draw {
        name: "square".into(),
        mesh: 0,
        modelview,
        material: Material {
            emissive: [0.02, 0.0, 0.01],
            ambient: [0.3, 0.2, 0.1],
            diffuse: [0.8, 0.6, 0.7],
            specular: [0.5, 0.6, 0.4],
            shininess: 12.0,
        },
        shading: Some(shading),
        alpha: 0.9,
        vertex_colors: true,
        texture: Some(Textured {
            sampled: Sampled { texture: 0, filter: TextureFilter::Bilinear, wrap: Wrap::Repeat },
            replaces: false,
        }),
        lightmap: Some(Sampled { texture: 1, filter: TextureFilter::Nearest, wrap: Wrap::Clamp }),
        cutout: Some(0.08),
        blend: None,
        depth: Some(DepthTest { compare: Compare::Less, write: true }),
        cull: Cull::Back,
    }
}

/// Lights of each kind.
fn lights() -> Vec<Light> {
    let light = |place| Light {
        name: "light".into(),
        ambient: [0.05, 0.04, 0.03],
        diffuse: [0.6, 0.5, 0.4],
        specular: [0.3, 0.4, 0.5],
        place,
    };
    let falloff = [1.0, 0.1, 0.05];
    vec![
        light(Place::Directional { toward: [0.5, 0.5, 2.0], unit: false }),
        light(Place::Directional { toward: [0.0, 0.6, 0.8], unit: true }),
        light(Place::Point { position: [0.5, 1.0, -0.5], falloff }),
        light(Place::Spot {
            position: [-0.5, 0.5, 0.0],
            falloff,
            axis: [0.4, -0.2, -2.0],
            cutoff_cosine: 0.95,
            exponent: 4.0,
        }),
    ]
}

fn drawn(gpu: &Gpu, frame: &Frame, sets: &[Called], shader: ShaderForm, stage: Option<Intermediate>) -> Vec<u8> {
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    let renderer = SceneRenderer::new(gpu, &shaders, frame, sets, Recipe { stage, ..Recipe::of(shader) })
        .unwrap_or_else(|error| panic!("{error}"));
    let pixels = SceneRenderer::pixels(gpu, renderer.submit(gpu)).unwrap_or_else(|error| panic!("{error}"));
    assert!(renderer.time(gpu, &Clock::wall(None), 2).expect("the device answers").seconds().is_some_and(|s| s > 0.0));
    pixels
}

/// Mesa's OpenGL does not survive devices that come and go on several threads.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The adapters' devices, with a format that they draw to.
fn devices() -> impl Iterator<Item = (String, Gpu, TargetFormat)> {
    let adapters = adapters();
    assert!(!adapters.is_empty(), "no adapter");
    adapters.into_iter().map(|adapter| {
        let gpu = adapter.open().unwrap_or_else(|error| panic!("{error}"));
        let formats = [TargetFormat::Rgba32Float, TargetFormat::Rgba8Unorm];
        let format = formats.into_iter().find(|format| gpu.lacks_blending(*format).is_none());
        (adapter.name, gpu, format.expect("8 bits are drawn to everywhere"))
    })
}

/// Components, of 8 bits or of 32.
fn floats(pixels: &[u8]) -> Vec<f32> {
    if pixels.len() == 4 * SIZE * SIZE {
        return pixels.iter().map(|byte| f32::from(*byte) / 255.0).collect();
    }
    bytemuck::pod_collect_to_vec(pixels)
}

/// The pixel in the middle.
fn middle(pixels: &[u8]) -> [f32; 4] {
    let first = 4 * (SIZE * (SIZE / 2) + SIZE / 2);
    floats(pixels)[first..first + 4].try_into().expect("a pixel has four components")
}

fn assert_alike(a: &[u8], b: &[u8], what: &str) {
    // Compilers contract the products of the two differently; a value between two bytes may so be rounded to either.
    let allowed = if a.len() == 4 * SIZE * SIZE { 1.01 / 255.0 } else { 1e-5 };
    let (a, b) = (floats(a), floats(b));
    assert_eq!(a.len(), 4 * SIZE * SIZE, "{what}");
    for (place, (a, b)) in a.iter().zip(&b).enumerate() {
        assert!((a - b).abs() <= allowed, "{what}: {a} and {b} at {place}");
    }
}

/// Frames that meet every effect.
fn frames() -> Vec<(String, Frame)> {
    let mut frames = vec![];
    for (number, (frequency, specular)) in [
        (Frequency::Flat, Specular::Phong),
        (Frequency::Gouraud, Specular::Blinn),
        (Frequency::Phong, Specular::BlinnUnnormalised),
        (Frequency::Phong, Specular::Phong),
        (Frequency::Phong, Specular::Blinn),
    ]
    .into_iter()
    .enumerate()
    {
        let mut frame = frame();
        let shading = frame.draws[0].shading.as_mut().expect("it is lit");
        (shading.frequency, shading.specular) = (frequency, specular);
        if number == 1 {
            (shading.viewer, shading.gate, shading.normals) =
                (Viewer::NonLocal, SpecularGate::Documents, Normals::Modelview);
            frame.fog.as_mut().expect("there is fog").form = FogForm::Exp { density: 0.4 };
            frame.draws[0].texture.as_mut().expect("it is textured").sampled.filter = TextureFilter::Nearest;
            frame.ambient_form = Ambient::Constant;
        }
        if number == 2 {
            frame.fog.as_mut().expect("there is fog").form = FogForm::Exp2Document { density: 0.3 };
            frame.draws[0].lightmap.as_mut().expect("it has a lightmap").filter = TextureFilter::Bilinear;
            frame.light_ambient = LightAmbient::Documents;
        }
        if number == 3 {
            let fog = frame.fog.as_mut().expect("there is fog");
            (fog.form, fog.distance) = (FogForm::Exp2OpenGl { density: 0.4 }, Distance::Planar);
            frame.draws[0].texture.as_mut().expect("it is textured").replaces = true;
            frame.draws[0].blend = Some(Blend {
                state: State { equation: Equation::Add, src: Factor::SrcAlpha, dst: Factor::OneMinusSrcAlpha }.into(),
                constant: [0.0; 4],
            });
        }
        frames.push((format!("{frequency:?} {specular:?}"), frame));
    }
    frames
}

#[test]
#[ignore = "long: ./x campaign long"]
fn composed_and_full_shaders_draw_alike_on_every_adapter() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    for (name, gpu, format) in devices() {
        for (what, mut frame) in frames() {
            frame.target.format = format;
            let what = format!("{what} on {name}");
            assert_eq!(SceneRenderer::lacks(&gpu, &frame), None, "{what}");
            let composed = drawn(&gpu, &frame, &effects(&frame), ShaderForm::Composed, None);
            assert_alike(&composed, &drawn(&gpu, &frame, &effects(&frame), ShaderForm::Full, None), &what);
            assert_alike(&composed, &drawn(&gpu, &frame, &named(&frame), ShaderForm::Composed, None), &what);
            let values = floats(&composed);
            let corner = &values[..4];
            let inside = values.chunks_exact(4).filter(|pixel| *pixel != corner).count();
            assert!((200..SIZE * SIZE / 2).contains(&inside), "{what}: {inside} pixels were drawn");
        }
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn composed_and_full_shaders_draw_alike_for_sets_of_all_sorts() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    let (name, gpu, _) = devices().next().expect("there is one");
    let (_, frame) = frames().pop().expect("there are some");
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    for set in crate::compose::tests::sets().into_iter().step_by(431) {
        let mut called = named(&frame);
        called[0].effects = set;
        let [composed, full] = ShaderForm::ALL.map(|shader| {
            let renderer = SceneRenderer::new(&gpu, &shaders, &frame, &called, Recipe::of(shader));
            let renderer = renderer.unwrap_or_else(|error| panic!("{set}: {error}"));
            SceneRenderer::pixels(&gpu, renderer.submit(&gpu)).unwrap_or_else(|error| panic!("{set}: {error}"))
        });
        assert_alike(&composed, &full, &format!("{set} on {name}"));
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn stages_are_steps_towards_the_colour() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    let (_, gpu, _) = devices().next().expect("there is one");
    for (what, mut frame) in frames() {
        (frame.draws[0].blend, frame.draws[0].cutout) = (None, None);
        // Intermediate results are 0 where nothing is drawn.
        frame.background = [0.0; 4];
        let called = named(&frame);
        let of = |stage| drawn(&gpu, &frame, &called, ShaderForm::Composed, Some(stage));
        let color = drawn(&gpu, &frame, &called, ShaderForm::Composed, None);
        assert_alike(&of(Intermediate::Fog), &color, &what);
        let [_, _, z, w] = middle(&of(Intermediate::Position));
        assert!((-2.4..-1.8).contains(&z) && (w - 1.0).abs() < 1e-6, "{what}: p.z is {z}");
        let [depth, ..] = middle(&of(Intermediate::Depth));
        assert!((depth - (1.1 * -z - 1.1) / -z).abs() < 1e-5, "{what}: {depth} at {z}");
        let [x, y, z, _] = middle(&of(Intermediate::Normal));
        let length = (x * x + y * y + z * z).sqrt();
        let phong = frame.draws[0].shading.is_some_and(|shading| shading.frequency == Frequency::Phong);
        assert!(if phong { (length - 1.0).abs() < 1e-6 } else { (0.8..1.0).contains(&length) }, "{what}: {length}");
        let mut bare = frame.clone();
        let draw = &mut bare.draws[0];
        (draw.vertex_colors, draw.texture, draw.lightmap, draw.cutout, bare.fog) = (false, None, None, None, None);
        let lit = middle(&drawn(&gpu, &bare, &effects(&bare), ShaderForm::Composed, None));
        let (diffuse, specular) = (middle(&of(Intermediate::Diffuse)), middle(&of(Intermediate::Specular)));
        for k in 0..3 {
            assert!((diffuse[k] + specular[k] - lit[k]).abs() < 1e-5, "{what}: {diffuse:?} {specular:?} {lit:?}");
            assert!(specular[k] > 0.0, "{what}: {specular:?}");
        }
        assert_ne!(of(Intermediate::Surface), color, "{what}: fog is seen");
    }
}

/// PreparedDraw by a technique.
fn by(gpu: &Gpu, frame: &Frame, technique: Technique) -> Result<Vec<u8>, GpuError> {
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    let recipe = Recipe { technique, ..Recipe::of(ShaderForm::Composed) };
    let renderer = SceneRenderer::new(gpu, &shaders, frame, &effects(frame), recipe)?;
    SceneRenderer::pixels(gpu, renderer.submit(gpu))
}

/// The greatest difference of a component.
fn apart(a: &[u8], b: &[u8]) -> f32 {
    floats(a).iter().zip(&floats(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
#[ignore = "long: ./x campaign long"]
fn fog_at_the_vertices_is_fog_where_its_factor_is_constant_and_not_elsewhere() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    for (name, gpu, format) in devices() {
        for frequency in [Frequency::Gouraud, Frequency::Phong] {
            let mut frame = frame();
            frame.target.format = format;
            let draw = &mut frame.draws[0];
            draw.shading.as_mut().expect("it is lit").frequency = frequency;
            let fog = frame.fog.as_mut().expect("there is fog");
            (fog.form, fog.distance) = (FogForm::Exp { density: 1.0 }, Distance::Planar);
            let mut both = |z: [f32; 4]| {
                frame.meshes[0].positions.iter_mut().zip(z).for_each(|(position, z)| position[2] = z);
                let drawn = |technique| by(&gpu, &frame, technique).unwrap_or_else(|error| panic!("{error}"));
                (drawn(Technique::Plain), drawn(Technique::FogAtVertex))
            };
            let what = format!("{frequency:?} on {name}");
            let (plain, vertex) = both([0.0; 4]);
            assert_alike(&plain, &vertex, &what);
            let (plain, vertex) = both([0.9, -3.0, -4.0, 0.5]);
            assert!(apart(&plain, &vertex) > 0.02, "{what}: {}", apart(&plain, &vertex));
        }
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn interpolated_vectors_are_the_vectors_unless_they_are_normalised_first() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    for (name, gpu, format) in devices() {
        let mut frame = frame();
        (frame.target.format, frame.fog) = (format, None);
        frame.lights.push(Light { diffuse: [0.1, 0.7, 0.2], ..frame.lights[2].clone() });
        frame.lights.push(Light { diffuse: [0.7, 0.1, 0.1], ..frame.lights[3].clone() });
        let Place::Point { position, .. } = &mut frame.lights[4].place else { panic!("it is a point light") };
        *position = [-0.6, -0.4, -1.3];
        let Place::Spot { position, .. } = &mut frame.lights[5].place else { panic!("it is a spotlight") };
        *position = [-0.9, 0.2, -0.1];
        let drawn = |frame: &Frame, technique| by(&gpu, frame, technique).unwrap_or_else(|error| panic!("{error}"));
        let plain = drawn(&frame, Technique::Plain);
        // Affine in the position, so that their interpolation is exact but for rounding: each light by its own vector.
        let vectors = drawn(&frame, Technique::VectorsInterpolated);
        assert!(apart(&plain, &vectors) <= 1.01 / 255.0, "{name}: {}", apart(&plain, &vectors));
        let unit = drawn(&frame, Technique::UnitVectorsInterpolated);
        assert!(apart(&plain, &unit) > 0.02, "{name}: {}", apart(&plain, &unit));
        // A vector that is everywhere the same.
        frame.lights.truncate(2);
        frame.draws[0].shading.as_mut().expect("it is lit").viewer = Viewer::NonLocal;
        let plain = drawn(&frame, Technique::Plain);
        for technique in [Technique::VectorsInterpolated, Technique::UnitVectorsInterpolated] {
            assert_alike(&plain, &drawn(&frame, technique), &format!("{} on {name}", technique.name()));
        }
    }
}

#[test]
fn a_frame_that_has_no_use_for_a_technique_is_refused() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    let (_, gpu, _) = devices().next().expect("there is one");
    let refused = |frame: &Frame, technique: Technique| match by(&gpu, frame, technique) {
        Err(GpuError::Technique { technique: named, reason }) => {
            assert_eq!(named, technique.name());
            reason
        }
        other => panic!("{}: {other:?}", technique.name()),
    };
    let mut clear = frame();
    clear.fog = None;
    assert!(refused(&clear, Technique::FogAtVertex).contains("fog"));
    let mut gouraud = frame();
    gouraud.draws[0].shading.as_mut().expect("it is lit").frequency = Frequency::Gouraud;
    assert!(refused(&gouraud, Technique::VectorsInterpolated).contains("fragments"));
    let mut bright = frame();
    bright.lights.extend([2, 2, 2].map(|light: usize| bright.lights[light].clone()));
    assert!(refused(&bright, Technique::UnitVectorsInterpolated).contains("5 lights"));
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    let recipe = Recipe { technique: Technique::FogAtVertex, ..Recipe::of(ShaderForm::Full) };
    let full = SceneRenderer::new(&gpu, &shaders, &frame(), &effects(&frame()), recipe);
    assert!(matches!(full, Err(GpuError::Technique { .. })));
}

/// Timestamps that a driver takes before it has rasterised would tell less than goes by on the wall.
#[test]
#[ignore = "long: ./x campaign long"]
fn timestamps_tell_the_time_that_a_frame_takes() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    for (name, gpu, format) in devices() {
        let clock = Clock::new(&gpu).unwrap_or_else(|error| panic!("{error}"));
        if clock.kind() != ClockKind::Timestamps || !gpu.is_cpu() {
            continue;
        }
        let mut frame = frame();
        frame.target = Target { width: 512, height: 512, format };
        let renderer = SceneRenderer::new(&gpu, &shaders, &frame, &effects(&frame), Recipe::of(ShaderForm::Composed));
        let renderer = renderer.unwrap_or_else(|error| panic!("{error}"));
        let time = |clock: &Clock| renderer.time(&gpu, clock, 4).unwrap_or_else(|error| panic!("{error}"));
        time(&clock);
        let mut ratios: Vec<f64> = (0..9)
            .map(|_| {
                let (stamps, wall) = (time(&clock).seconds(), time(&Clock::wall(None)).seconds());
                stamps.unwrap_or(0.0) / wall.expect("the clock on the wall goes forward")
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        // What else the machine does falls upon either, so that half and double say enough.
        assert!((0.5..2.0).contains(&ratios[4]), "{name}: {ratios:?}");
    }
}

#[test]
fn a_flat_face_has_the_colour_of_its_provoking_vertex() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    for (name, gpu, format) in devices() {
        for (provoking, vertex) in [(Provoking::First, 0), (Provoking::Last, 2)] {
            let mut frame = frame();
            frame.target.format = format;
            let draw = &mut frame.draws[0];
            (draw.vertex_colors, draw.texture, draw.lightmap, draw.cutout, frame.fog) = (false, None, None, None, None);
            draw.depth = None;
            let shading = draw.shading.as_mut().expect("it is lit");
            (shading.frequency, shading.provoking) = (Frequency::Flat, provoking);
            frame.meshes[0].triangles.truncate(1);
            frame.meshes[0].normals = vec![[0.0, 0.0, -1.0]; 4];
            frame.draws[0].material.emissive = [0.0; 3];
            let dark = drawn(&gpu, &frame, &effects(&frame), ShaderForm::Composed, None);
            frame.meshes[0].normals[vertex] = [0.0, 0.0, 1.0];
            let bright = drawn(&gpu, &frame, &effects(&frame), ShaderForm::Composed, None);
            assert!(middle(&bright)[0] > middle(&dark)[0] + 0.1, "{provoking:?} on {name}");
        }
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn what_the_unit_cannot_blend_and_sets_of_another_frame_are_errors() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    let (_, gpu, _) = devices().next().expect("there is one");
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    let mut frame = frame();
    let says = |frame: &Frame, sets: &[Called]| {
        let made = SceneRenderer::new(&gpu, &shaders, frame, sets, Recipe::of(ShaderForm::Composed));
        made.expect_err("it cannot be drawn").to_string()
    };
    assert!(says(&frame, &[]).contains("1 draws"), "{}", says(&frame, &[]));
    let state = State { equation: Equation::Add, src: Factor::ConstantColor, dst: Factor::ConstantAlpha };
    frame.draws[0].blend = Some(Blend { state: state.into(), constant: [0.1, 0.2, 0.3, 0.4] });
    assert!(says(&frame, &effects(&frame)).contains("constant"), "{}", says(&frame, &effects(&frame)));
}

#[test]
fn a_frame_is_drawn_alike_by_way_of_json() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    let (_, gpu, format) = devices().next().expect("there is one");
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    let mut frame = frame();
    frame.target.format = format;
    let state = State { equation: Equation::Add, src: Factor::ConstantColor, dst: Factor::OneMinusSrcAlpha };
    frame.draws[0].blend = Some(Blend { state: state.into(), constant: [0.9, 0.8, 0.7, 0.6] });
    let sets = effects(&frame);
    let recipe = Recipe::of(ShaderForm::Composed);
    let made = describe(&shaders, &frame, &sets, recipe, gpu.is_gl);
    let (resources, work) = made.unwrap_or_else(|error| panic!("{error}"));
    let words = words_by_json(&gpu, &resources, &work);
    let pixels = drawn(&gpu, &frame, &sets, ShaderForm::Composed, None);
    assert_eq!(bytemuck::cast_slice::<u32, u8>(&words), pixels);
}

/// The first word of a binding's member by naga's layout: names of members and numbers of elements lead there.
fn word(module: &naga::Module, binding: &str, path: &[&str]) -> usize {
    let global = module.global_variables.iter().find(|(_, global)| global.name.as_deref() == Some(binding));
    let mut ty = global.unwrap_or_else(|| panic!("there is no {binding}")).1.ty;
    let mut offset = 0;
    for step in path {
        match &module.types[ty].inner {
            naga::TypeInner::Struct { members, .. } => {
                let member = members.iter().find(|member| member.name.as_deref() == Some(step));
                let member = member.unwrap_or_else(|| panic!("{binding} has no {step}"));
                (offset, ty) = (offset + member.offset, member.ty);
            }
            naga::TypeInner::Array { base, stride, .. } => {
                (offset, ty) = (offset + stride * step.parse::<u32>().expect("a number of an element"), *base);
            }
            other => panic!("{binding} {path:?}: {other:?}"),
        }
    }
    offset as usize / 4
}

#[test]
fn numbers_lie_where_naga_reads_them() {
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    let composer = Composer::new(&shaders).expect("the files can be read");
    let full = composer.compose(Effects::NONE, Recipe::of(ShaderForm::Full), 0).expect("it can be composed");
    let (module, _) = full.validate().unwrap_or_else(|error| panic!("{error}"));
    let mut frame = frame();
    frame.lights.push(frame.lights[2].clone());
    frame.lights.push(frame.lights[3].clone());
    frame.lights[4].specular = [7.0, 8.0, 9.0];
    let Place::Spot { position, .. } = &mut frame.lights[5].place else { panic!("it is a spotlight") };
    *position = [11.0, 12.0, 13.0];
    let mut unlit = frame.clone();
    unlit.draws[0].shading = None;
    let mut dense = frame.clone();
    dense.fog = Some(Fog { color: [0.0; 3], form: FogForm::Exp { density: 5.0 }, distance: Distance::Planar });
    let draw = &frame.draws[0];
    let material = draw.material;
    let rows: [(&Frame, &str, &[&str], &[f32]); 30] = [
        (&frame, "scene_draw", &["projection"], frame.projection.as_flattened()),
        (&frame, "scene_draw", &["modelview"], draw.modelview.as_flattened()),
        (&frame, "scene_draw", &["base"], &[0.0; 3]),
        (&unlit, "scene_draw", &["base"], &material.diffuse),
        (&frame, "scene_draw", &["alpha"], &[draw.alpha]),
        (&frame, "scene_material", &["emissive"], &material.emissive),
        (&frame, "scene_material", &["ambient"], &material.ambient),
        (&frame, "scene_material", &["diffuse"], &material.diffuse),
        (&frame, "scene_material", &["specular"], &material.specular),
        (&frame, "scene_material", &["shininess"], &[material.shininess]),
        (&frame, "scene_ambient", &["color"], &frame.ambient),
        (&frame, "scene_fog", &["color"], &[0.5, 0.5, 0.6]),
        (&frame, "scene_fog", &["dmin"], &[1.5]),
        (&frame, "scene_fog", &["dmax"], &[2.3]),
        (&dense, "scene_fog", &["density"], &[5.0]),
        (&frame, "scene_cutout", &["threshold"], &[0.08]),
        (&frame, "scene_texture_reading", &["clamps"], &[f32::from_bits(0)]),
        (&frame, "scene_lightmap_reading", &["clamps"], &[f32::from_bits(1)]),
        (&frame, "scene_directional", &["count"], &[f32::from_bits(1)]),
        (&frame, "scene_directional", &["lights", "0", "toward"], &[0.5, 0.5, 2.0]),
        (&frame, "scene_directional_unit", &["lights", "0", "toward"], &[0.0, 0.6, 0.8]),
        (&frame, "scene_point", &["count"], &[f32::from_bits(2)]),
        (&frame, "scene_point", &["lights", "1", "colors", "ambient"], &[0.05, 0.04, 0.03]),
        (&frame, "scene_point", &["lights", "1", "colors", "specular"], &[7.0, 8.0, 9.0]),
        (&frame, "scene_point", &["lights", "1", "falloff"], &[1.0, 0.1, 0.05]),
        (&frame, "scene_spot", &["lights", "1", "position"], &[11.0, 12.0, 13.0]),
        (&frame, "scene_spot", &["lights", "1", "falloff"], &[1.0, 0.1, 0.05]),
        (&frame, "scene_spot", &["lights", "1", "exponent"], &[4.0]),
        (&frame, "scene_spot", &["lights", "1", "axis"], &[0.4, -0.2, -2.0]),
        (&frame, "scene_spot", &["lights", "1", "cutoff_cosine"], &[0.95]),
    ];
    for (frame, binding, path, values) in rows {
        let called = &named(frame)[0];
        let told = Told { frame, draw: &frame.draws[0], called, effects: called.effects, stage: None };
        let words = uniforms::words(&told, binding).expect("it is known").expect("it is a uniform");
        let first = word(&module, binding, path);
        let lies: Vec<u32> = words[first..first + values.len()].to_vec();
        assert_eq!(lies, values.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), "{binding} {path:?}");
    }
}

#[test]
fn every_uniform_is_as_long_as_its_struct() {
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    let composer = Composer::new(&shaders).expect("the files can be read");
    let full = composer.compose(Effects::NONE, Recipe::of(ShaderForm::Full), 0).expect("it can be composed");
    let (module, _) = full.validate().unwrap_or_else(|error| panic!("{error}"));
    let frame = frame();
    let called = &named(&frame)[0];
    let told = Told { frame: &frame, draw: &frame.draws[0], called, effects: called.effects, stage: None };
    for (_, global) in module.global_variables.iter() {
        let name = global.name.as_deref().expect("bindings have names");
        let size = module.types[global.ty].inner.size(module.to_ctx()) as usize;
        match uniforms::words(&told, name).unwrap_or_else(|error| panic!("{error}")) {
            Some(words) => assert_eq!(4 * words.len(), size.next_multiple_of(16), "{name}"),
            None => assert!(name == "scene_texture" || name == "scene_lightmap", "{name}"),
        }
    }
}

/// The frame's pixels at a rung; `None` where the device lacks it, or no step of the shader has a form of that rung.
fn at_rung(gpu: &Gpu, frame: &Frame, recipe: Recipe) -> Option<Vec<f32>> {
    if recipe.rung.unavailable(gpu).unwrap_or_else(|error| panic!("{error}")).is_some() {
        return None;
    }
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    let renderer = match SceneRenderer::new(gpu, &shaders, frame, &effects(frame), recipe) {
        Err(GpuError::Unavailable { .. }) if matches!(recipe.rung, Rung::Cheap | Rung::Stable) => return None,
        made => made.unwrap_or_else(|error| panic!("{}: {error}", recipe.rung.name())),
    };
    let pixels = SceneRenderer::pixels(gpu, renderer.submit(gpu)).unwrap_or_else(|error| panic!("{error}"));
    Some(floats(&pixels))
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_frame_is_drawn_at_every_rung() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    let mut frame = frame();
    // A hole's edge moves with the alpha.
    frame.draws[0].cutout = None;
    // Below 64 a power's stable form is the published one.
    frame.draws[0].material.shininess = 100.0;
    for (name, gpu, format) in devices().filter(|(_, _, format)| *format == TargetFormat::Rgba32Float) {
        frame.target.format = format;
        let recipe = |rung| Recipe { rung, ..Recipe::of(ShaderForm::Composed) };
        // With few digits another texel is the nearest, and a cone's edge is elsewhere.
        let mut smooth = frame.clone();
        smooth.lights.truncate(3);
        (smooth.draws[0].texture, smooth.draws[0].lightmap) = (None, None);
        let single = at_rung(&gpu, &frame, recipe(Rung::F32)).expect("f32 is everywhere");
        let single_smooth = at_rung(&gpu, &smooth, recipe(Rung::F32)).expect("f32 is everywhere");
        let mut drawn = vec![];
        for (rung, most) in
            [(Rung::F16, 0.05), (Rung::Cheap, 0.2), (Rung::Stable, 1e-5), (Rung::DoubleFloat, 1e-5), (Rung::F64, 1e-5)]
        {
            let (frame, single) = if most > 1e-3 { (&smooth, &single_smooth) } else { (&frame, &single) };
            let Some(pixels) = at_rung(&gpu, frame, recipe(rung)) else { continue };
            let off = pixels.iter().zip(single).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(off > 0.0 && off <= most, "{name}, {}: {off:e}", rung.name());
            // The same pixels are covered, whatever the lighting is computed in.
            let covered = |pixels: &[f32]| pixels.chunks_exact(4).map(|p| p[3] > 0.5).collect::<Vec<_>>();
            assert_eq!(covered(&pixels), covered(single), "{name}, {}", rung.name());
            drawn.push((rung, pixels));
        }
        let of = |wanted: Rung| drawn.iter().find(|(rung, _)| *rung == wanted).map(|(_, pixels)| pixels);
        if let (Some(pair), Some(double)) = (of(Rung::DoubleFloat), of(Rung::F64)) {
            let same = |a: &[f32]| a.iter().zip(double).filter(|(a, b)| a.to_bits() == b.to_bits()).count();
            let all = double.len();
            assert!(same(pair) * 1000 >= all * 998, "{name}: {} of {all} are those of f64", same(pair));
            assert!(same(&single) * 10 < all * 9, "{name}: {} of {all} in f32", same(&single));
        }
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn the_clip_position_is_of_f32_at_every_rung() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    let frame = frame();
    for (name, gpu, _) in devices().filter(|(_, gpu, _)| gpu.lacks_target(TargetFormat::Rgba32Float).is_none()) {
        let depth = |rung| at_rung(&gpu, &frame, Recipe { rung, ..Recipe::stage(Intermediate::Depth) });
        let single = depth(Rung::F32).expect("f32 is everywhere");
        for rung in [Rung::Cheap, Rung::DoubleFloat, Rung::F64] {
            assert!(depth(rung).is_none_or(|pixels| pixels == single), "{name}, {}", rung.name());
        }
    }
}

/// Exponentials of what uniforms go into, before loops on uniforms: a branch in them brings Mesa 22.3's lavapipe down.
#[test]
#[ignore = "long: ./x campaign long"]
fn exponential_fog_and_all_effects_are_drawn_at_every_rung() {
    if crate::lacks_driver() {
        return;
    }
    let _alone = alone();
    let mut frame = frame();
    frame.draws[0].cutout = None;
    frame.fog = frame.fog.map(|fog| Fog { form: FogForm::Exp { density: 0.3 }, ..fog });
    for (name, gpu, format) in devices().filter(|(_, _, format)| *format == TargetFormat::Rgba32Float) {
        frame.target.format = format;
        // All effects in double-floats take half a minute to compile.
        for rung in [Rung::F16, Rung::Cheap, Rung::Stable, Rung::F64] {
            let drawn = |shader| at_rung(&gpu, &frame, Recipe { rung, ..Recipe::of(shader) });
            let (Some(composed), Some(full)) = (drawn(ShaderForm::Composed), drawn(ShaderForm::Full)) else { continue };
            let off = composed.iter().zip(&full).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            let most = if rung == Rung::F16 { 0.01 } else { 1e-5 };
            assert!(off <= most, "{name}, {}: {off:e}", rung.name());
        }
    }
}
