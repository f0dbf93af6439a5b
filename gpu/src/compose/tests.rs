//! What composed shaders hold, over the effects' subsets by sections.
//!
//! There are 9,107 subsets of the kinds of light and 540 surfaces in fogs, the product of which would take hours.
//! Light, surface and fog share nothing but the fog's factor, below which Phong shading is passed over. So every subset
//! of the kinds of light is taken once, the exclusive variants turned by a counter, with a surface and a fog that
//! another counter turns through all of theirs; and every surface and fog with a few lights. Each pair of effects that
//! may stand together is met.

use super::*;
use naga::{Expression, Function, Module, Statement, TypeInner};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use Effect as E;

const SPECULAR: [E; 3] = [E::SpecularPhong, E::SpecularBlinn, E::SpecularUnnormalised];
const FOG: [E; 4] = [E::FogLinear, E::FogExp, E::FogExp2Document, E::FogExp2OpenGl];

/// Effects of which a set has one at most.
const EXCLUSIVE: [&[E]; 6] = [
    &[E::Flat, E::Gouraud, E::Phong],
    &SPECULAR,
    &[E::AmbientProduct, E::AmbientConstant],
    &[E::TextureNearest, E::TextureBilinear],
    &[E::LightmapNearest, E::LightmapBilinear],
    &FOG,
];

fn composer() -> Composer {
    let shaders = Shaders::built_in().unwrap_or_else(|error| panic!("{error}"));
    Composer::new(&shaders).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn what_pictures_do_not_show_is_told_by_file_and_line() {
    let lines = composer().lines_beside_pictures().unwrap_or_else(|error| panic!("{error}"));
    let has = |text: &str| lines.iter().any(|line| line.file == "scene.wgsl" && line.text == text);
    for beside in ["out.fog_factor = scene_fog_factor(eye.xyz);", "out.viewer = -eye.xyz;", "return vec4f(in.p, 1.0);"]
    {
        assert!(has(beside), "{beside}");
    }
    for shown in ["out.clip = scene_draw.projection * eye;", "let f = scene_fog_factor(in.p);", "return color;"] {
        assert!(!has(shown), "{shown}");
    }
}

/// Every subset of the parts that may stand beside each other.
fn subsets(parts: &[Effect]) -> Vec<Effects> {
    (0..1_u32 << parts.len())
        .map(|bits| (0..).zip(parts).filter(|(k, _)| bits >> k & 1 == 1).map(|(_, effect)| *effect).collect())
        .collect()
}

fn union(a: Effects, b: Effects) -> Effects {
    a.iter().chain(b.iter()).collect()
}

/// Every consistent subset of the kinds of light, the exclusive variants turned by a counter.
fn lights() -> Vec<Effects> {
    let kinds = [
        E::Emissive,
        E::AmbientProduct,
        E::LightAmbient,
        E::AttenuatedAmbient,
        E::Diffuse,
        E::SpecularPhong,
        E::LocalViewer,
        E::Gate,
        E::InverseTranspose,
        E::Directional,
        E::DirectionalUnit,
        E::Point,
        E::Spot,
        E::SpotExponent,
        E::Attenuation,
        E::Phong,
    ];
    let consistent = subsets(&kinds).into_iter().map(|set| {
        // Without lights there is nothing to light at a fragment, but something to interpolate.
        if set.has_lights() || !set.has(E::Phong) { set } else { set.without(E::Phong).with(E::Gouraud) }
    });
    let frequencies = [E::Flat, E::Gouraud, E::Phong];
    consistent
        .filter(|set| set.contradiction().is_none())
        .enumerate()
        .map(|(turn, mut set)| {
            if set.has(E::SpecularPhong) {
                set = set.without(E::SpecularPhong).with(SPECULAR[turn % 3]);
            }
            if set.has(E::AmbientProduct) && turn / 3 % 2 == 0 {
                set = set.without(E::AmbientProduct).with(E::AmbientConstant);
            }
            if set.has(E::Phong) {
                set = set.without(E::Phong).with(frequencies[turn / 6 % 3]);
            }
            set
        })
        .collect()
}

/// Every surface in every fog: each subset of the kinds, with each variant.
fn surfaces() -> Vec<Effects> {
    let kinds = [
        E::VertexColor,
        E::TextureNearest,
        E::TextureBilinear,
        E::TextureReplace,
        E::LightmapNearest,
        E::LightmapBilinear,
        E::Cutout,
    ];
    let surfaces: Vec<Effects> = subsets(&kinds).into_iter().filter(|set| set.contradiction().is_none()).collect();
    let fog = subsets(&[&FOG[..], &[E::FogRadial]].concat());
    let fog: Vec<Effects> = fog.into_iter().filter(|set| set.contradiction().is_none()).collect();
    fog.iter().flat_map(|fog| surfaces.iter().map(|surface| union(*fog, *surface))).collect()
}

/// The sets that are looked at.
pub(crate) fn sets() -> Vec<Effects> {
    let (lights, surfaces) = (lights(), surfaces());
    let few = lights.iter().step_by(lights.len() / 7).flat_map(|light| surfaces.iter().map(|s| union(*s, *light)));
    // A step that shares no factor with the surfaces' number meets all of them.
    let all = lights.iter().enumerate().map(|(turn, light)| union(*light, surfaces[turn * 101 % surfaces.len()]));
    let sets: BTreeSet<Effects> = few.chain(all).collect();
    sets.into_iter().collect()
}

/// On every core.
fn each<T: Sync>(items: &[T], check: impl Fn(&T) + Sync) {
    let next = AtomicUsize::new(0);
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    std::thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(|| {
                while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
                    check(item);
                }
            });
        }
    });
}

fn composed(composer: &Composer, effects: Effects, stage: Option<Intermediate>) -> Composition {
    let composition = composer.compose(effects, Recipe { stage, ..Recipe::of(ShaderForm::Composed) }, 0);
    composition.unwrap_or_else(|error| panic!("{error}"))
}

fn functions(module: &Module) -> impl Iterator<Item = &Function> {
    module.functions.iter().map(|(_, f)| f).chain(module.entry_points.iter().map(|entry| &entry.function))
}

/// How much there is of each sort.
fn counts(module: &Module) -> [usize; 6] {
    let expressions = functions(module).map(|f| f.expressions.len()).sum();
    let locals = functions(module).map(|f| f.local_variables.len()).sum();
    [
        module.types.len(),
        module.constants.len(),
        module.global_variables.len(),
        module.functions.len(),
        expressions,
        locals,
    ]
}

/// Nothing in the module is unused: values with a name count as used only where something uses them.
fn assert_compact(module: &Module, what: &str) {
    let mut named = module.clone();
    for (_, function) in named.functions.iter_mut() {
        function.named_expressions.clear();
    }
    for entry in &mut named.entry_points {
        entry.function.named_expressions.clear();
    }
    let before = counts(&named);
    naga::compact::compact(&mut named, naga::compact::KeepUnused::No);
    assert_eq!(before, counts(&named), "{what}: types, constants, bindings, functions, expressions, variables");
}

/// What a module does and reads, by name.
fn marks(module: &Module) -> BTreeSet<String> {
    let mut marks: BTreeSet<String> = module.global_variables.iter().filter_map(|(_, g)| g.name.clone()).collect();
    marks.extend(module.functions.iter().filter_map(|(_, f)| f.name.clone()));
    for function in functions(module) {
        for (_, expression) in function.expressions.iter() {
            match expression {
                Expression::Math { fun, .. } => marks.extend([format!("{fun:?}")]),
                Expression::ImageLoad { .. } => marks.extend(["ImageLoad".to_owned()]),
                _ => {}
            }
        }
        if kills(&function.body) {
            marks.insert("Kill".into());
        }
    }
    for (_, ty) in module.types.iter().filter(|(_, ty)| matches!(&ty.name, Some(name) if is_interface(name))) {
        if let (Some(name), TypeInner::Struct { members, .. }) = (&ty.name, &ty.inner) {
            marks.extend(members.iter().filter_map(|member| Some(format!("{name}.{}", member.name.as_ref()?))));
        }
    }
    marks
}

fn is_interface(name: &str) -> bool {
    name == "SceneVertex" || name == "SceneVaryings"
}

fn kills(block: &naga::Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Kill => true,
        Statement::Block(inner) => kills(inner),
        Statement::If { accept, reject, .. } => kills(accept) || kills(reject),
        Statement::Loop { body, continuing, .. } => kills(body) || kills(continuing),
        _ => false,
    })
}

/// A mark, and the sets that call for it.
type Mark = (&'static str, fn(Effects) -> bool);

fn lit_at_fragments(s: Effects) -> bool {
    s.has(E::Phong)
}

fn weighs(s: Effects) -> bool {
    s.has_normals() || s.has(E::AttenuatedAmbient)
}

/// Whether the lights need the point.
fn needs_point(s: Effects) -> bool {
    s.has(E::LocalViewer)
        || weighs(s) && s.has(E::Spot)
        || s.has(E::Point) && (s.has_normals() || s.has(E::Attenuation))
}

const MARKS: [Mark; 57] = [
    ("Pow", |s| s.has_specular() || s.has(E::SpotExponent)),
    ("Exp", |s| s.has_any(&FOG[1..])),
    ("Kill", |s| s.has(E::Cutout)),
    ("ImageLoad", |s| s.has_texture() || s.has_lightmap()),
    ("Floor", |s| s.has_texture() || s.has_lightmap()),
    ("Distance", |s| s.has(E::Attenuation)),
    ("Length", |s| s.has(E::FogRadial)),
    ("Cross", |s| s.has(E::InverseTranspose)),
    ("Mix", |s| s.has_fog() || s.has_any(&[E::TextureBilinear, E::LightmapBilinear])),
    ("Normalize", |s| s.has_normals() || needs_point(s) && (s.has(E::LocalViewer) || s.has(E::Spot))),
    ("vector_normalize", |s| s.has_normals() || needs_point(s) && (s.has(E::LocalViewer) || s.has(E::Spot))),
    ("vector_normal_by_cofactors", |s| s.has(E::InverseTranspose)),
    ("vector_normal_modelview", |s| s.has_normals() && !s.has(E::InverseTranspose)),
    ("vector_reflect", |s| s.has(E::SpecularPhong)),
    ("vector_halfway", |s| s.has(E::SpecularBlinn)),
    ("vector_halfway_unnormalised", |s| s.has(E::SpecularUnnormalised)),
    ("vector_lobe", |s| s.has_specular() || s.has(E::SpotExponent)),
    ("lighting_highlight_phong", |s| s.has(E::SpecularPhong)),
    ("lighting_highlight_blinn", |s| s.has(E::SpecularBlinn)),
    ("lighting_highlight_unnormalised", |s| s.has(E::SpecularUnnormalised)),
    ("lighting_gate", |s| s.has(E::Gate)),
    ("lighting_incidence", |s| s.has_any(&[E::Diffuse, E::Gate])),
    ("lighting_ambient", |s| s.has_any(&[E::AmbientProduct, E::LightAmbient])),
    ("attenuation_point", |s| s.has(E::Attenuation)),
    ("attenuation_spot_exponent", |s| s.has(E::SpotExponent)),
    ("attenuation_spot_cutoff", |s| s.has(E::Spot) && weighs(s) && !s.has(E::SpotExponent)),
    ("scene_cone_weight", |s| s.has(E::Attenuation) && s.has(E::Spot)),
    ("scene_lit_at_fragment", lit_at_fragments),
    ("scene_shine", Effects::has_lights),
    ("fog_mix", Effects::has_fog),
    ("fog_linear_factor", |s| s.has(E::FogLinear)),
    ("fog_exp_factor", |s| s.has(E::FogExp)),
    ("fog_exp2_document_factor", |s| s.has(E::FogExp2Document)),
    ("fog_exp2_opengl_factor", |s| s.has(E::FogExp2OpenGl)),
    ("fog_planar_distance", |s| s.has_fog() && !s.has(E::FogRadial)),
    ("fog_radial_distance", |s| s.has(E::FogRadial)),
    ("texture_nearest", |s| s.has_any(&[E::TextureNearest, E::LightmapNearest])),
    ("texture_bilinear", |s| s.has_any(&[E::TextureBilinear, E::LightmapBilinear])),
    ("color_modulate", |s| s.has(E::VertexColor) || s.has_lightmap() || s.has_texture() && !s.has(E::TextureReplace)),
    ("scene_material", |s| s.has_normals() || s.has_any(&[E::Emissive, E::AmbientProduct, E::LightAmbient])),
    ("scene_ambient", |s| s.has_any(&[E::AmbientProduct, E::AmbientConstant])),
    ("scene_directional", |s| s.has(E::Directional)),
    ("scene_directional_unit", |s| s.has(E::DirectionalUnit)),
    ("scene_point", |s| s.has(E::Point)),
    ("scene_spot", |s| s.has(E::Spot)),
    ("scene_fog", Effects::has_fog),
    ("scene_texture", Effects::has_texture),
    ("scene_texture_reading", Effects::has_texture),
    ("scene_lightmap", Effects::has_lightmap),
    ("scene_lightmap_reading", Effects::has_lightmap),
    ("scene_cutout", |s| s.has(E::Cutout)),
    ("scene_switches", |_| false),
    ("SceneVertex.normal", Effects::has_normals),
    ("SceneVertex.color", |s| s.has(E::VertexColor)),
    ("SceneVaryings.p", |s| s.has_fog() || s.has(E::Phong) && needs_point(s)),
    ("SceneVaryings.normal", |s| s.has(E::Phong) && s.has_normals()),
    ("SceneVaryings.flat_lit", |s| s.has(E::Flat)),
];

#[test]
#[ignore = "long: ./x campaign long"]
fn a_shader_holds_what_its_effects_call_for_and_nothing_else() {
    let (composer, sets) = (composer(), sets());
    assert!(sets.len() > 10_000, "{} sets", sets.len());
    for (a, b) in Effect::ALL.into_iter().flat_map(|a| Effect::ALL.map(|b| (a, b))) {
        let exclusive = a != b && EXCLUSIVE.iter().any(|group| group.contains(&a) && group.contains(&b));
        let met = sets.iter().any(|set| set.has(a) && set.has(b));
        assert_eq!(met, !exclusive, "{} with {}", a.name(), b.name());
    }
    each(&sets, |set| {
        let composition = composed(&composer, *set, None);
        let (module, _) = composition.validate().unwrap_or_else(|error| panic!("{error}"));
        assert_compact(&module, &set.to_string());
        let marks = marks(&module);
        for (mark, wants) in MARKS {
            assert_eq!(marks.contains(mark), wants(composition.effects), "`{mark}` in the shader of: {set}");
        }
    });
}

#[test]
fn stages_hold_what_they_need() {
    let composer = composer();
    let sets: Vec<Effects> = sets().into_iter().step_by(23).collect();
    each(&sets, |set| {
        for stage in Intermediate::ALL {
            let composition = composed(&composer, *set, Some(stage));
            let what = format!("{} of {set}", stage.name());
            let (module, _) = composition.validate().unwrap_or_else(|error| panic!("{what}: {error}"));
            assert_compact(&module, &what);
            let marks = marks(&module);
            let has = |mark: &str| marks.contains(mark);
            assert_eq!(has("Kill"), set.has(E::Cutout), "{what}");
            assert!(!has("fog_mix") || stage == Intermediate::Fog, "{what}");
            let early = matches!(stage, Intermediate::Position | Intermediate::Depth | Intermediate::Normal);
            assert!(!early || !has("scene_material") && !has("scene_shine"), "{what}");
            assert!(stage != Intermediate::Specular || set.has_lights() || !has("lighting_ambient"), "{what}");
            let surface =
                !early && !matches!(stage, Intermediate::Diffuse | Intermediate::Specular) || set.has(E::Cutout);
            assert_eq!(has("scene_texture"), set.has_texture() && surface, "{what}");
        }
    });
}

/// Names of what techniques add.
const OF_TECHNIQUES: [&str; 4] = ["fog_factor: f32", "viewer: vec3f", "toward_1", "scene_toward"];

#[test]
#[ignore = "long: ./x campaign long"]
fn a_technique_is_in_no_shader_that_it_is_not_asked_of() {
    let composer = composer();
    let sets: Vec<Effects> = sets().into_iter().step_by(7).collect();
    each(&sets, |set| {
        let plain = composed(&composer, *set, None);
        for name in OF_TECHNIQUES {
            assert!(!plain.source.contains(name), "`{name}` in the plain shader of: {set}");
        }
        for technique in Technique::ALL {
            let what = format!("{} of {set}", technique.name());
            let recipe = Recipe { technique, ..Recipe::of(ShaderForm::Composed) };
            let one = composer.compose(*set, recipe, toward(plain.effects)).unwrap_or_else(|e| panic!("{what}: {e}"));
            let (module, _) = one.validate().unwrap_or_else(|error| panic!("{error}"));
            assert_compact(&module, &what);
            let (marks, effects) = (marks(&module), one.effects);
            let concerned = technique.concerns(effects);
            let varying = effects.has_any(&[E::Point, E::Spot, E::LocalViewer]);
            let vectors = concerned && technique.has_vectors() && varying;
            let fog = concerned && technique == Technique::FogAtVertex;
            let has = |member: &str| marks.contains(&format!("SceneVaryings.{member}"));
            assert_eq!(has("fog_factor"), fog, "{what}");
            assert_eq!(has("viewer"), vectors && effects.has(E::LocalViewer), "{what}");
            assert_eq!(has("toward_1"), vectors && effects.has_any(&[E::Point, E::Spot]), "{what}");
            assert_eq!(has("toward_2"), vectors && effects.has(E::Point) && effects.has(E::Spot), "{what}");
            let at_fragments = effects.has(E::Phong) && needs_point(effects);
            let place = if vectors { effects.has(E::Attenuation) } else { at_fragments };
            assert_eq!(has("p"), effects.has_fog() && !fog || place, "{what}");
            assert_eq!(one.source == plain.source, technique == Technique::Plain || !fog && !vectors, "{what}");
        }
    });
}

#[test]
fn every_number_of_vectors_up_to_the_most_is_valid() {
    let composer = composer();
    for kinds in [&[E::Point][..], &[E::Spot], &[E::Point, E::Spot]] {
        let set: Effects = [E::Phong, E::Diffuse, E::SpecularBlinn].into_iter().chain(kinds.iter().copied()).collect();
        for number in kinds.len()..=MOST_TOWARD {
            let recipe = Recipe { technique: Technique::VectorsInterpolated, ..Recipe::of(ShaderForm::Composed) };
            let one = composer.compose(set, recipe, number).unwrap_or_else(|error| panic!("{error}"));
            let (module, _) = one.validate().unwrap_or_else(|error| panic!("{error}"));
            assert_compact(&module, &format!("{number} vectors of {set}"));
            assert!(marks(&module).contains(&format!("SceneVaryings.toward_{number}")), "{number} of {set}");
        }
    }
}

/// Instructions of a module in SPIR-V.
fn instructions(composer: &Composer, effects: Effects) -> usize {
    let (module, info) =
        composed(composer, effects, None).validate().unwrap_or_else(|error| panic!("{effects}: {error}"));
    let mut options = naga::back::spv::Options::default();
    options.flags.remove(naga::back::spv::WriterFlags::DEBUG);
    let words = naga::back::spv::write_vec(&module, &info, &options, None).expect("a valid module can be written");
    let (mut place, mut count) = (5, 0);
    while let Some(word) = words.get(place) {
        place += (word >> 16) as usize;
        count += 1;
    }
    count
}

/// Effects that another form of the same stands in for, and how many instructions that form may have more.
const FORMS: [(Effect, usize, &str); 2] = [
    (E::FogRadial, 1, "|z| takes a component and an absolute value, the length of p one instruction"),
    (E::TextureReplace, usize::MAX, "what the texture stands in place of is lit again"),
];

#[test]
#[ignore = "long: ./x campaign long"]
fn a_shader_never_grows_when_an_effect_leaves() {
    let composer = composer();
    let (lights, surfaces) = (lights(), surfaces());
    let with_few = surfaces.iter().flat_map(|s| lights.iter().step_by(lights.len() / 3).map(|l| union(*s, *l)));
    let sets: BTreeSet<Effects> = lights.iter().copied().step_by(7).chain(with_few.step_by(3)).collect();
    let smaller =
        |set: Effects| set.iter().map(move |e| (e, set.without(e))).filter(|(_, s)| s.contradiction().is_none());
    let all: BTreeSet<Effects> = sets.iter().flat_map(|set| smaller(*set).map(|(_, s)| s).chain([*set])).collect();
    let all: Vec<Effects> = all.into_iter().collect();
    let found = std::sync::Mutex::new(HashMap::new());
    each(&all, |set| {
        let count = instructions(&composer, *set);
        found.lock().expect("no check failed").insert(*set, count);
    });
    let found = found.into_inner().expect("no check failed");
    let mut needed = BTreeSet::new();
    for set in &sets {
        for (effect, without) in smaller(*set) {
            let (more, less) = (found[set], found[&without]);
            let form = FORMS.iter().find(|(of, ..)| *of == effect);
            if less > more {
                needed.insert(effect);
            }
            let allowed = form.map_or(0, |(_, allowed, _)| *allowed);
            assert!(less <= more.saturating_add(allowed), "{more} with {}, {less} without: {set}", effect.name());
        }
    }
    for (effect, _, reason) in FORMS {
        assert!(needed.contains(&effect), "{} is no exception any more: {reason}", effect.name());
    }
}

#[test]
fn the_full_shader_is_one_and_holds_everything() {
    let composer = composer();
    let full = |set| composer.compose(set, Recipe::of(ShaderForm::Full), 0).unwrap_or_else(|error| panic!("{error}"));
    let (one, other) = (full(Effects::NONE), full(sets()[4321]));
    assert_eq!(one.source, other.source);
    let (module, _) = one.validate().unwrap_or_else(|error| panic!("{error}"));
    let marks = marks(&module);
    for (mark, _) in MARKS {
        assert!(marks.contains(mark), "{mark}");
    }
}

#[test]
fn every_effect_has_its_file_and_every_file_its_effect() {
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/shaders/effects");
    let entries = std::fs::read_dir(dir).expect("the folder can be read");
    let files: BTreeSet<String> =
        entries.map(|entry| entry.expect("it can be read").file_name().to_string_lossy().into_owned()).collect();
    assert_eq!(files, Effect::ALL.into_iter().map(|effect| format!("{}.wgsl", effect.name())).collect());
    let built_in: Vec<&str> = crate::library::EFFECT_FILES.into_iter().map(|(name, _)| name).collect();
    let wanted: Vec<String> = Effect::ALL.into_iter().map(crate::shaders::effect_file).collect();
    assert_eq!(built_in, wanted);
    assert_eq!(covering().count(), Effect::ALL.len(), "each is met when files are read");
}
