//! The scenes decide every branch of their shaders both ways, lie on both sides of every boundary, and show each way in which their shaders
//! are composed.

use lightmeter::scene::library::SCENES;
use lightmeter::scene::select::{SIZE_AMONG_ALL, builtin};
use lightmeter::subject_gpu::gpu;
use lightmeter_gpu::Shaders;
use lightmeter_gpu::compose::{Composer, Intermediate, MOST_TOWARD, Recipe, ShaderForm, Technique};
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_scene::effects::{Called, effects};
use lightmeter_scene::frame::{Frame, Place};
use lightmeter_scene::target::TargetFormat;
use lightmeter_tests::branches::{BranchWays, mark};
use lightmeter_tests::device;
use lightmeter_tests::directives::misdirections;
use std::collections::BTreeMap;

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

/// Directing lines that may go wrong with no change to a picture, by how they begin, with the reason.
const UNSEEN: &[(&str, &str)] = &[
    ("scene.wgsl:146: choose f: f32 from fog_factor", "one of the effects of fog gives it"),
    ("scene.wgsl:184: choose texel:", "one of the effects of textures gives it"),
    ("scene.wgsl:189: choose lightmap_texel:", "one of the effects of lightmaps gives it"),
    ("scene_lighting.wgsl:136: choose highlight:", "one of the effects of highlights gives it"),
    ("scene_lighting.wgsl:55: when !lights,", "what is lit by no light is not asked for it"),
    ("scene_lighting.wgsl:120: if spot,", "what is passed over is 0: it saves time"),
    ("effects/phong.wgsl:12: when fog,", "what fog hides is not lit: it saves time"),
    (
        "effects/spot.wgsl:35: when toward_2 & !point,",
        "a technique of `bench`, of two to four spotlights without another light, which no scene has",
    ),
    ("scene_lighting.wgsl:129: if gate | !specular,", "the same"),
];

/// Pixels of the longer side of what is drawn by a wrong composition.
const SIZE: u32 = 96;

#[test]
#[ignore = "long: ./x campaign long"]
fn each_way_of_composing_shows_in_some_picture() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let subject = device();
    let gpu = gpu(&subject).expect("the subject is an adapter");
    let right = Shaders::built_in().expect("the built-in shaders are valid");
    let composer = Composer::new(&right).expect("they go together");
    let plain = Recipe::of(ShaderForm::Composed);
    let techniques = Technique::ALL.map(|technique| Recipe { technique, ..plain });
    let recipes: Vec<Recipe> = techniques.into_iter().chain(Intermediate::ALL.map(Recipe::stage)).collect();
    let frames: Vec<(Frame, Vec<Called>)> = (0..SCENES.len())
        .map(|place| builtin(place, Some(SIZE)).expect("it is built in").frame)
        .map(|frame| (frame.clone(), effects(&frame)))
        .collect();
    let texts = |composer: &Composer, (frame, sets): &(Frame, Vec<Called>), recipe: Recipe| -> Vec<String> {
        let stands = |&&light: &&usize| !matches!(frame.lights[light].place, Place::Directional { .. });
        let compose = |called: &Called| {
            let toward = called.lights.iter().filter(stands).count();
            let toward = if toward > MOST_TOWARD { 0 } else { toward };
            composer.compose(called.effects, recipe, toward).map_or_else(|e| e.to_string(), |made| made.source)
        };
        sets.iter().map(compose).collect()
    };
    let picture = |shaders: &Shaders, (frame, sets): &(Frame, Vec<Called>), recipe: Recipe| {
        let renderer = SceneRenderer::new(gpu, shaders, frame, sets, recipe).map_err(|error| error.to_string())?;
        SceneRenderer::pixels(gpu, renderer.submit(gpu)).map_err(|error| error.to_string())
    };
    let mut composed: BTreeMap<(usize, usize), Vec<String>> = BTreeMap::new();
    let mut pictures: BTreeMap<(usize, usize), Result<Vec<u8>, String>> = BTreeMap::new();
    let (mut unseen, mut shown) = (vec![], 0);
    for wrong in misdirections(right.texts()) {
        // What cannot be composed is refused wherever it is wanted.
        let Ok(shaders) = right.with(&wrong.file, wrong.text.clone()) else {
            shown += 1;
            continue;
        };
        let other = Composer::new(&shaders).expect("it was read once already");
        let is_shown = (0..recipes.len()).any(|k| {
            frames.iter().enumerate().any(|(place, frame)| {
                let key = (k, place);
                let as_it_is = composed.entry(key).or_insert_with(|| texts(&composer, frame, recipes[k]));
                *as_it_is != texts(&other, frame, recipes[k]) && {
                    let drawn = pictures.entry(key).or_insert_with(|| picture(&right, frame, recipes[k]));
                    drawn.is_ok() && *drawn != picture(&shaders, frame, recipes[k])
                }
            })
        });
        if is_shown { shown += 1 } else { unseen.push(wrong.what) }
    }
    assert!(shown > 60, "{shown} ways");
    let unexplained: Vec<&String> =
        unseen.iter().filter(|what| !UNSEEN.iter().any(|(known, _)| what.starts_with(known))).collect();
    assert!(unexplained.is_empty(), "no picture shows it where this is wrong: {unexplained:#?}");
    for (known, reason) in UNSEEN {
        assert!(
            unseen.iter().any(|what| what.starts_with(known)),
            "a picture shows where this is wrong: {known} ({reason})"
        );
    }
}
