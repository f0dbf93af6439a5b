//! The WGSL of a draw, composed from its effects: one file an effect, and nothing of those that are not called for.
//!
//! `scene.wgsl`, `scene_lighting.wgsl` and `scene_uniforms.wgsl` are the skeleton; `effects/<name>.wgsl` holds what an
//! effect puts into it, with bindings and functions of its own. Their formulas come from the families' files. Of all
//! that, a module holds the functions, structs and bindings that its entry points reach. Lines of these forms direct
//! it:
//!
//! | line | meaning |
//! |---|---|
//! | `//@ let name = condition` | a name for a condition |
//! | `//@ when condition` … `//@ end` | these lines where it holds; [`ShaderForm::Full`] counts as having every effect |
//! | `//@ if condition` … `//@ end` | these statements where it holds; in [`ShaderForm::Full`] an `if` on the switches |
//! | `//@ slot name` | the statements that the effects have for it |
//! | `//@ members name` | the same of members of a struct: no switch surrounds them |
//! | `//@ choose name: type from slot else expression` | a value by the one effect's expression, or by this |
//! | `//@ at slot` | what follows, to the next such line, is for the slot |
//!
//! Conditions are of effects' names, `stage_<name>`, `has_normals`, the techniques `fog_at_vertex`, `vectors_interpolated`
//! and `unit_vectors`, `toward_1` to `toward_4` where at least that number of lights' vectors are interpolated, `!`, `&`, `|` and
//! parentheses.

mod condition;
mod forbidden;
mod items;
mod template;

use crate::error::GpuError;
use crate::rung::{Asked, Rung, lower};
use crate::shaders::{Shaders, validate_lowered};
use items::{Item, reached, split};
use lightmeter_scene::effects::{Effect, Effects};
pub use lightmeter_scene::stage::Intermediate;
use naga::valid::ModuleInfo;
use std::collections::{BTreeMap, BTreeSet};
use template::{Template, Wanted};

/// How much a draw's shader holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShaderForm {
    /// The effects that are called for.
    Composed,
    /// Every effect behind a uniform switch: one shader for all draws.
    Full,
}

impl ShaderForm {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Composed, Self::Full];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Composed => "composed",
            Self::Full => "full",
        }
    }
}

/// Where a shader computes what it may compute elsewhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Technique {
    /// As the scene asks for.
    #[default]
    Plain,
    /// The fog's factor at the vertices, interpolated.
    FogAtVertex,
    /// Lit at the fragments, by N, L and V computed at the vertices, interpolated, and normalised again. L and V have their
    /// lengths at the vertices, as in 003's program: they are affine in the position, and their interpolation exact.
    VectorsInterpolated,
    /// The same with L and V normalised at the vertices already, so that what is interpolated turns less than it should.
    UnitVectorsInterpolated,
}

impl Technique {
    /// All.
    pub const ALL: [Self; 4] =
        [Self::Plain, Self::FogAtVertex, Self::VectorsInterpolated, Self::UnitVectorsInterpolated];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::FogAtVertex => "fog-at-vertex",
            Self::VectorsInterpolated => "vectors-interpolated",
            Self::UnitVectorsInterpolated => "unit-vectors-interpolated",
        }
    }

    /// Whether a draw of these effects has use for it.
    #[must_use]
    pub(crate) fn concerns(self, effects: Effects) -> bool {
        match self {
            Self::Plain => true,
            Self::FogAtVertex => effects.has_fog(),
            Self::VectorsInterpolated | Self::UnitVectorsInterpolated => {
                effects.has(Effect::Phong) && effects.has_normals()
            }
        }
    }

    /// Whether vectors are interpolated.
    pub(crate) const fn has_vectors(self) -> bool {
        matches!(self, Self::VectorsInterpolated | Self::UnitVectorsInterpolated)
    }
}

/// Lights whose vectors a draw hands from its vertices to its fragments, at most: what every adapter has varyings for.
pub const MOST_TOWARD: usize = 4;

/// How a frame's shaders are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// How much of the effects a shader holds.
    pub shader: ShaderForm,
    /// The intermediate result that is drawn in place of the colour.
    pub stage: Option<Intermediate>,
    /// The arithmetic.
    pub rung: Rung,
    /// What is computed where.
    pub technique: Technique,
}

impl Recipe {
    /// In f32, as the scene asks for.
    #[must_use]
    pub const fn of(shader: ShaderForm) -> Self {
        Self { shader, stage: None, rung: Rung::F32, technique: Technique::Plain }
    }

    /// An intermediate result.
    #[must_use]
    pub const fn stage(stage: Intermediate) -> Self {
        Self { stage: Some(stage), ..Self::of(ShaderForm::Composed) }
    }
}

/// Whether no surface colour is known yet.
const fn is_before_surface(stage: Intermediate) -> bool {
    !matches!(stage, Intermediate::Surface | Intermediate::Fog)
}

/// The effects that a draw's result depends on: a texture in place of the colour leaves no use for light, and a stage
/// none for what comes later, the alpha that a cutout reads excepted.
#[must_use]
pub fn live(effects: Effects, stage: Option<Intermediate>) -> Effects {
    use Effect as E;
    let ambient = [E::Emissive, E::AmbientProduct, E::AmbientConstant, E::LightAmbient, E::AttenuatedAmbient];
    let specular = [E::SpecularPhong, E::SpecularBlinn, E::SpecularUnnormalised];
    let surface = [
        E::VertexColor,
        E::TextureNearest,
        E::TextureBilinear,
        E::TextureReplace,
        E::LightmapNearest,
        E::LightmapBilinear,
    ];
    let fog = [E::FogLinear, E::FogExp, E::FogExp2Document, E::FogExp2OpenGl, E::FogRadial];
    let lit = [E::Flat, E::Gouraud, E::Phong];
    let without = |from: Effects, gone: &[Effect]| gone.iter().fold(from, |from, &effect| from.without(effect));

    let mut live = effects;
    if stage.is_some_and(|stage| stage != Intermediate::Fog) {
        live = without(live, &fog);
    }
    if stage.is_some_and(is_before_surface) && !live.has(E::Cutout) {
        live = without(live, &surface);
    }
    let replaced = live.has(E::TextureReplace);
    if replaced {
        live = live.without(E::VertexColor);
    }
    let (diffuse, highlights) = match stage {
        Some(Intermediate::Position | Intermediate::Depth | Intermediate::Normal) => (false, false),
        // Which lights are passed over depends on both, so that both are kept.
        Some(Intermediate::Diffuse) => (true, effects.has_lights()),
        Some(Intermediate::Specular) => (effects.has_lights(), true),
        Some(Intermediate::Surface | Intermediate::Fog) | None => (!replaced, !replaced),
    };
    if !diffuse {
        live = without(without(live, &ambient), &[E::Diffuse]);
    }
    if !highlights {
        live = without(live, &specular);
    }
    if !live.has_specular() {
        live = without(live, &[E::LocalViewer, E::Gate]);
    }
    let keeps_normals = stage == Some(Intermediate::Normal) && effects.has_normals();
    if !live.has_normals() && !keeps_normals {
        live = live.without(E::InverseTranspose);
    }
    if !live.has_normals() && !live.has(E::AttenuatedAmbient) {
        live = without(live, &[E::Attenuation, E::SpotExponent]);
    }
    if !live.has_normals() && !live.has(E::LightAmbient) {
        live = without(live, &[E::Directional, E::DirectionalUnit, E::Point, E::Spot]);
        let constant = live.has_any(&[E::Emissive, E::AmbientProduct, E::AmbientConstant]);
        let interpolated = constant && live.has(E::Gouraud);
        if !interpolated && !keeps_normals {
            live = without(live, &lit);
        }
    }
    live
}

/// A shader with where each of its lines is from.
#[derive(Clone, Debug)]
pub struct Composition {
    /// The WGSL.
    pub source: String,
    /// The effects that it computes: see [`live`]; with [`ShaderForm::Full`] those that are switched on.
    pub effects: Effects,
    /// The file and the line in it of each line.
    origins: Vec<(String, usize)>,
}

impl Composition {
    /// The vertex shader's entry point.
    pub const VERTEX: &str = "scene_vertex";
    /// The fragment shader's entry point.
    pub const FRAGMENT: &str = "scene_fragment";

    /// Parses and validates it.
    ///
    /// # Errors
    /// naga's message, with the file and the line that the mistake is in.
    pub fn validate(&self) -> Result<(naga::Module, ModuleInfo), GpuError> {
        let invalid = |line: Option<u32>, message: String| {
            let origin = line.and_then(|line| self.origins.get((line as usize).checked_sub(1)?));
            let (file, line) = origin.cloned().unwrap_or_else(|| ("scene.wgsl".into(), 1));
            let message = format!("{file}:{line}, in the shader of: {}\n{message}", self.effects);
            GpuError::Shader { file, message }
        };
        let module = naga::front::wgsl::parse_str(&self.source).map_err(|error| {
            let line = error.location(&self.source).map(|at| at.line_number);
            invalid(line, error.emit_to_string_with_path(&self.source, "composed"))
        })?;
        let info = crate::shaders::validator().validate(&module).map_err(|error| {
            // What a stage forbids, naga tells without a place.
            let location = error.location(&self.source);
            let location = location.or_else(|| Some(forbidden::in_vertices(&module)?.location(&self.source)));
            let line = location.map(|at| at.line_number);
            invalid(line, error.emit_to_string_with_path(&self.source, "composed"))
        })?;
        Ok((module, info))
    }
}

/// The skeleton and the effects, read.
#[derive(Debug)]
pub struct Composer {
    template: Template,
    families: Vec<Item>,
    /// The stable form of each function that has one.
    forms: BTreeMap<String, String>,
}

/// The files that composed shaders take formulas from.
const FAMILIES: [&str; 7] =
    ["attenuation.wgsl", "color.wgsl", "elementary.wgsl", "fog.wgsl", "lighting.wgsl", "texture.wgsl", "vector.wgsl"];

impl Composer {
    /// Reads the files.
    ///
    /// # Errors
    /// Where a directing line cannot be read, with the file and the line.
    pub fn new(shaders: &Shaders) -> Result<Self, GpuError> {
        let mut families = vec![];
        for file in FAMILIES {
            families.extend(split(template::lines(file, shaders.text(file))));
        }
        Ok(Self { template: Template::new(shaders)?, families, forms: shaders.stable_forms() })
    }

    /// The shader of a draw of these effects. A stage goes with [`ShaderForm::Composed`], and so does a technique, which changes
    /// nothing where the effects have no use for it. `toward` lights stand at a point or in a cone: as many vectors are
    /// interpolated where the technique says so.
    ///
    /// # Errors
    /// Where the effects' files do not go together, with the file and the line.
    ///
    /// # Panics
    /// Where a stage or a technique is asked of [`ShaderForm::Full`], or more vectors than [`MOST_TOWARD`] are interpolated.
    pub fn compose(&self, effects: Effects, recipe: Recipe, toward: usize) -> Result<Composition, GpuError> {
        let Recipe { shader, stage, technique, .. } = recipe;
        assert!(shader == ShaderForm::Composed || stage.is_none(), "the full shader has no stages");
        assert!(shader == ShaderForm::Composed || technique == Technique::Plain, "the full shader has no techniques");
        let live = live(effects, stage);
        let technique = if technique.concerns(live) { technique } else { Technique::Plain };
        let toward = if technique.has_vectors() { toward } else { 0 };
        assert!(toward <= MOST_TOWARD, "{toward} lights' vectors are interpolated, and {MOST_TOWARD} can be");
        let has_normals = effects.has_normals();
        let wanted = Wanted { effects: live, stage, has_normals, full: shader == ShaderForm::Full, technique, toward };
        let own = split(self.template.expand(&wanted)?);
        let items = reached(&own, &self.families);
        let (mut source, mut origins) = (String::new(), vec![]);
        for (k, item) in items.into_iter().enumerate() {
            if k > 0 {
                source.push('\n');
                origins.push((String::new(), 0));
            }
            for line in &item.lines {
                source.push_str(&line.text);
                source.push('\n');
                origins.push((line.file.to_string(), line.number));
            }
        }
        Ok(Composition { source, effects: live, origins })
    }

    /// A shader in a rung's arithmetic: see [`crate::Rung`].
    ///
    /// # Errors
    /// [`GpuError::Unavailable`] where there is no such, with the reason.
    pub(crate) fn lower(&self, composition: &Composition, rung: Rung) -> Result<String, GpuError> {
        if rung == Rung::F32 {
            return Ok(composition.source.clone());
        }
        let mut source = composition.source.clone();
        if rung == Rung::Stable {
            // What published functions are replaced by is reached by none of them.
            for item in self.families.iter().filter(|item| !item.is_in(&composition.source)) {
                source.push('\n');
                source.extend(item.lines.iter().flat_map(|line| [line.text.as_str(), "\n"]));
            }
        }
        let unavailable =
            |reason| GpuError::Unavailable { what: format!("a scene's shader in {}", rung.name()), reason };
        let lowered = lower(&source, rung, &self.forms, Asked::Module).map_err(unavailable)?;
        validate_lowered("scene.wgsl", &lowered.source)?;
        Ok(lowered.source)
    }

    /// Composes and validates shaders that hold every effect once at least.
    ///
    /// # Errors
    /// The first mistake.
    pub fn check(&self) -> Result<(), GpuError> {
        self.check_those(|_| true)
    }

    /// The same of the shaders alone that hold an effect.
    pub(crate) fn check_with(&self, effect: Effect) -> Result<(), GpuError> {
        self.check_those(|effects| effects.has(effect))
    }

    /// The lines that only techniques and intermediate results compose, one shader after the other: no picture of a scene shows what they do.
    ///
    /// # Errors
    /// Where the effects' files do not go together, with the file and the line.
    pub fn lines_beside_pictures(&self) -> Result<Vec<LineBeside>, GpuError> {
        let plain = Recipe::of(ShaderForm::Composed);
        let techniques = Technique::ALL.map(|technique| Recipe { technique, ..plain });
        let stages = Intermediate::ALL.map(Recipe::stage);
        let places =
            |composition: &Composition| composition.origins.iter().cloned().collect::<BTreeSet<(String, usize)>>();
        let mut shown = places(&self.compose(Effects::NONE, Recipe::of(ShaderForm::Full), 0)?);
        for effects in covering() {
            shown.extend(places(&self.compose(effects, plain, 0)?));
        }
        let mut beside = vec![];
        for (number, effects) in covering().enumerate() {
            let toward = if effects.has_any(&[Effect::Point, Effect::Spot]) { MOST_TOWARD } else { 0 };
            for (recipe, place) in techniques.iter().chain(&stages).zip(0..) {
                let composition = self.compose(effects, *recipe, toward)?;
                let lines = composition.origins.iter().zip(composition.source.lines());
                beside.extend(lines.filter(|(origin, _)| !shown.contains(*origin)).map(|((file, line), text)| {
                    LineBeside {
                        shader: (number, place),
                        file: file.clone(),
                        line: *line,
                        text: text.trim().to_owned(),
                    }
                }));
            }
        }
        Ok(beside)
    }

    fn check_those(&self, chosen: impl Fn(Effects) -> bool) -> Result<(), GpuError> {
        for effects in covering().filter(|effects| chosen(*effects)) {
            for technique in Technique::ALL.into_iter().filter(|technique| technique.concerns(live(effects, None))) {
                let recipe = Recipe { technique, ..Recipe::of(ShaderForm::Composed) };
                self.compose(effects, recipe, toward(effects))?.validate()?;
            }
        }
        self.compose(Effects::NONE, Recipe::of(ShaderForm::Full), 0)?.validate()?;
        Ok(())
    }
}

/// A line that is in a technique's or an intermediate result's shader, and in none of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineBeside {
    /// Which shader: the number of its set of effects, and that of its recipe. They do not depend on the files, so that two folders can be compared.
    pub shader: (usize, usize),
    /// The file that the line is from.
    pub file: String,
    /// Its number there.
    pub line: usize,
    /// What it says.
    pub text: String,
}

/// A light of each kind that stands somewhere.
fn toward(effects: Effects) -> usize {
    usize::from(effects.has(Effect::Point)) + usize::from(effects.has(Effect::Spot))
}

/// A small set with each effect.
fn covering() -> impl Iterator<Item = Effects> {
    use Effect as E;
    let bases: [&[Effect]; 8] = [
        &[],
        &[E::Diffuse, E::Point],
        &[E::Phong, E::Diffuse],
        &[E::Phong, E::Diffuse, E::Point],
        &[E::Phong, E::Directional],
        &[E::Phong, E::SpecularBlinn, E::LightAmbient, E::Spot],
        &[E::TextureNearest],
        &[E::FogExp],
    ];
    Effect::ALL.into_iter().filter_map(move |effect| {
        let sets = bases.iter().map(|base| base.iter().copied().collect::<Effects>().with(effect));
        sets.into_iter().find(|set| set.contradiction().is_none() && live(*set, None).has(effect))
    })
}

#[cfg(test)]
pub(crate) mod tests;
