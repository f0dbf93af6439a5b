//! The scenes decide every branch of their shaders both ways, and lie on both sides of every boundary.

use lightmeter::scene::library::SCENES;
use lightmeter::scene::select::{SIZE_AMONG_ALL, builtin};
use lightmeter::subject_gpu::gpu;
use lightmeter_gpu::Shaders;
use lightmeter_gpu::compose::{Recipe, ShaderForm};
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_scene::effects::effects;
use lightmeter_scene::target::TargetFormat;
use lightmeter_tests::branches::{BranchWays, mark};
use lightmeter_tests::device;

/// What no scene decides, by how it begins, with the reason. The scenes' own files and the effects' have no such branch.
const NEVER: &[(&str, &str)] = &[
    (
        "elementary_binary_scale: ",
        "normals are transformed at the vertices, which leave no marks; `vector/*` has hard cases",
    ),
    ("vector_largest: ", "the same"),
    ("vector_normal_by_cofactors: ", "the same"),
    ("vector_normalize_scaled: ", "the same"),
    (
        "vector_normalize: if dot(v, v) <= 0.0, true",
        "no scene has a vector without length; `vector/normalize` has hard cases",
    ),
    ("fog_exp_factor: clamp(", "the exponential of a number that is not positive lies within [0, 1]"),
    ("fog_exp2_document_factor: clamp(", "the same"),
    ("fog_exp2_opengl_factor: clamp(", "the same"),
    (
        "fog_linear_factor: if dmin == dmax, true",
        "a step's pixels lie on either side of it; `fog/linear/hard/dmin-equals-dmax`",
    ),
    ("fog_linear_factor: select(", "the same"),
    ("lighting_gate: select(highlight, 0.0, dot(l, n) <= 0.0), true", "a light behind the face is passed over before"),
];

#[test]
#[ignore = "long: ./x campaign long"]
fn every_branch_is_decided_both_ways_by_some_scene() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let subject = device();
    let gpu = gpu(&subject).expect("the subject is an adapter");
    let shaders = Shaders::built_in().expect("the built-in shaders are valid");
    let mut taken = BranchWays::default();
    for place in 0..SCENES.len() {
        let mut frame = builtin(place, Some(SIZE_AMONG_ALL)).expect("it is built in").frame;
        // Each pixel has the marks of one fragment, and not a mixture of several.
        frame.target.format = TargetFormat::Rgba32Float;
        frame.background = [0.0; 4];
        frame.draws.iter_mut().for_each(|draw| draw.blend = None);
        let sets = effects(&frame);
        let recipe = Recipe::of(ShaderForm::Composed);
        let (mut resources, work) =
            SceneRenderer::describe(gpu, &shaders, &frame, &sets, recipe).unwrap_or_else(|error| panic!("{error}"));
        let marks = mark(&mut resources);
        let renderer = SceneRenderer::of(gpu, &resources, work).unwrap_or_else(|error| panic!("{error}"));
        let bytes = SceneRenderer::pixels(gpu, renderer.submit(gpu)).unwrap_or_else(|error| panic!("{error}"));
        let component = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().expect("four bytes"));
        let numbers: Vec<f32> = bytes.chunks_exact(4).map(component).collect();
        let pixels: Vec<[f32; 4]> = numbers.chunks_exact(4).map(|four| [four[0], four[1], four[2], four[3]]).collect();
        taken.see(&marks, &pixels);
    }
    assert!(taken.0.len() > 20, "{} sites", taken.0.len());
    let missing = taken.missing();
    let unexplained: Vec<&String> =
        missing.iter().filter(|way| !NEVER.iter().any(|(never, _)| way.starts_with(never))).collect();
    assert!(unexplained.is_empty(), "no scene decides: {unexplained:#?}");
    for (never, reason) in NEVER {
        assert!(missing.iter().any(|way| way.starts_with(never)), "a scene decides this both ways: {never} ({reason})");
    }
}
