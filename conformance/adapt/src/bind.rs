//! Binds the variables of a shader to expressions over the inputs of a formula.

use crate::AdaptError;
use crate::meaning::{Context, Meaning, Term};
use crate::name::keys;
use crate::program::{From, Leaf, ShaderOutput, ShaderProgram, Variable};
use crate::synonyms::SYNONYMS;
use lightmeter_catalogue::cases::{Input, Spec, ValueShape};
use lightmeter_document::report::FoundBy;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{BuiltIn, ScalarKind};
use std::collections::{BTreeSet, HashSet};

/// A binding that was asked for: `NAME=EXPRESSION`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AskedBinding {
    /// The variable, as it stands in the shader, or the last part of its name.
    pub name: String,
    /// WGSL over the formula's inputs.
    pub expression: String,
}

/// What is said of a module of SPIR-V that was compiled without names.
const NAMELESS: &str = "the module has no names of its variables, by which they are bound: compile it with names, such as by `naga -g`, \
                        `glslangValidator -g` or `dxc -Zi`";

/// A variable and what it is set to.
#[derive(Clone, Debug)]
pub struct Bound {
    /// The variable as it stands in the shader.
    pub name: String,
    /// The expression over the formula's inputs.
    pub expression: String,
    /// How it was found.
    pub found: FoundBy,
    /// What it would be if it pointed the other way, where its name does not tell.
    pub turned: Option<String>,
    /// Whether it is of an element of an array other than the first.
    pub is_further: bool,
    pub(crate) place: String,
}

/// All variables of a shader, bound.
#[derive(Clone, Debug)]
pub struct ShaderBinding {
    /// Each variable.
    pub bound: Vec<Bound>,
    /// For each output of the formula the shader's value, or `None` where the shader gives none.
    pub outputs: Vec<(&'static str, Option<String>)>,
    /// Inputs of the formula that no variable has.
    pub unused: Vec<&'static str>,
    /// Whether it discards fragments, which then give no value.
    pub discards: bool,
    /// Whether it has loops, which are left after [`MOST_TURNS`](crate::MOST_TURNS) and then give no value.
    pub loops: bool,
}

/// Binds a shader to a formula.
///
/// # Errors
/// Where a variable has no meaning that the formula knows, a name that was asked for is none of the shader's or is given twice, or no output
/// fits: with both lists.
pub fn bind(program: &ShaderProgram, spec: &Spec, asked: &[AskedBinding]) -> Result<ShaderBinding, AdaptError> {
    known(program, asked)?;
    for AskedBinding { name, expression } in asked {
        for slot in program.slots.iter().filter(|slot| is_named(slot, name)).take(1) {
            checked(slot, &of_an_input(slot, expression, spec), spec)?;
        }
    }
    let is_point = |slot: &&Variable| meanings(slot).next() == Some(Meaning::Point);
    let points = program.slots.iter().filter(is_point).count();
    let context = Context { spec, meanings: all_meanings(program, spec, asked), points };
    let (mut bound, mut missing) = (vec![], vec![]);
    for slot in &program.slots {
        match expression(slot, &context, asked) {
            Some((expression, found)) => {
                let turned = if found == FoundBy::Asked { None } else { turned(slot, &context) };
                let is_further = slot.is_further;
                bound.push(Bound {
                    name: slot.name.clone(),
                    expression,
                    found,
                    turned,
                    is_further,
                    place: slot.place.clone(),
                });
            }
            None if slot.name.is_empty() => return Err(AdaptError::Bind(NAMELESS.into())),
            None => {
                let is_known = meanings(slot).any(|meaning| context.expression(meaning, slot.from).is_some());
                let why =
                    if is_known { " (its name is known, and no input that it may mean fits its type)" } else { "" };
                missing.push(format!("{}: {}{why}", slot.name, slot.leaf));
            }
        }
    }
    if !missing.is_empty() {
        let inputs =
            spec.inputs.iter().map(|input| format!("{}: {}", input.name, input.shape.name())).collect::<Vec<_>>();
        let message = format!(
            "nothing of {} is known to be meant by\n  {}\nThe formula has the inputs\n  {}\nSay what is meant by `--bind \
             'NAME=EXPRESSION'`, in WGSL over these inputs.",
            spec.id,
            missing.join("\n  "),
            inputs.join("\n  ")
        );
        return Err(AdaptError::Unknown { variables: missing.len(), message });
    }
    let outputs = outputs(program, spec)?;
    let unused = unused(spec, &bound, &outputs);
    Ok(ShaderBinding { bound, outputs, unused, discards: program.unanswered.discards, loops: program.unanswered.loops })
}

/// What the variables are taken to be, so far as it follows from each alone, and which colours the bindings that are asked for have.
fn all_meanings(program: &ShaderProgram, spec: &Spec, asked: &[AskedBinding]) -> BTreeSet<Meaning> {
    let alone = Context { spec, meanings: BTreeSet::new(), points: 0 };
    let is_asked = |slot: &Variable| asked.iter().any(|asked| is_named(slot, &asked.name));
    let of_slot = |slot: &Variable| {
        meanings(slot).find(|&meaning| {
            let expression = alone.expression(meaning, slot.from);
            expression.is_some_and(|expression| {
                fitted(&expression, shape_of(meaning, &expression, spec), slot.leaf, Some(meaning)).is_some()
            })
        })
    };
    let mut all: BTreeSet<Meaning> =
        program.slots.iter().filter(|slot| slot.is_used && !is_asked(slot)).filter_map(of_slot).collect();
    for AskedBinding { expression, .. } in asked {
        for term in [Term::Ambient, Term::Diffuse, Term::Specular] {
            let [light, material] = Context::colors(term).map(|name| has_word(expression, name));
            match (light, material) {
                (true, false) => drop(all.insert(Meaning::OfLight(term))),
                (false, true) => drop(all.insert(Meaning::OfMaterial(term))),
                _ => {}
            }
        }
    }
    all
}

/// Of a vector whose name does not say whether it points towards the light or away from it, the other way.
fn turned(slot: &Variable, context: &Context<'_>) -> Option<String> {
    let is_of_light = context.has("direction") && !context.has("axis");
    let meaning = meanings(slot).find(|&meaning| context.expression(meaning, slot.from).is_some())?;
    match meaning {
        Meaning::Travel if is_of_light => Some("-direction".into()),
        Meaning::ToLight if is_of_light && slot.from == From::Uniform => Some("direction".into()),
        _ => None,
    }
}

fn has_word(expression: &str, name: &str) -> bool {
    expression.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name)
}

/// Refuses names that the shader has not, that several have, or that are bound twice.
fn known(program: &ShaderProgram, asked: &[AskedBinding]) -> Result<(), AdaptError> {
    let mut seen = HashSet::new();
    for AskedBinding { name, .. } in asked {
        if !seen.insert(name) {
            return Err(AdaptError::Bind(format!("`{name}` is bound twice")));
        }
        let whole = |slot: &Variable| match (slot.name.split_once('['), slot.name.rsplit_once(']')) {
            (Some((before, _)), Some((_, after))) => format!("{before}{after}"),
            _ => slot.name.clone(),
        };
        let found: BTreeSet<String> = program.slots.iter().filter(|slot| is_named(slot, name)).map(whole).collect();
        if found.len() > 1 && !program.slots.iter().any(|slot| slot.name == *name) {
            let found: Vec<String> = found.into_iter().collect();
            return Err(AdaptError::Bind(format!("`{name}` may be {}; write the whole name", found.join(" or "))));
        }
        if found.is_empty() {
            let names: Vec<&str> = program.slots.iter().map(|slot| slot.name.as_str()).collect();
            let meant = lightmeter_catalogue::nearest::did_you_mean(name, names.iter().copied());
            return Err(AdaptError::Bind(format!(
                "the shader has no `{name}` to bind{meant} It has {}",
                names.join(", ")
            )));
        }
    }
    Ok(())
}

/// Refuses an expression that is not WGSL over the formula's inputs, or of another type than the variable.
fn checked(slot: &Variable, expression: &str, spec: &Spec) -> Result<(), AdaptError> {
    let inputs: Vec<String> =
        spec.inputs.iter().map(|input| format!("{}: {}", input.name, type_of(input.shape))).collect();
    let head = format!("fn bound({}) -> {} {{ return ", inputs.join(", "), slot.leaf);
    let refused = |message: &str| {
        AdaptError::Expression(format!(
            "`--bind '{}={expression}'`: {message}; expected WGSL of the type {} over {}",
            slot.name,
            slot.leaf,
            inputs.join(", ")
        ))
    };
    let parsed = |written: &str| {
        naga::front::wgsl::parse_str(&format!("{head}{written}; }}")).map_err(|error| refused(error.message()))
    };
    // It stands in brackets later: what is an expression only there, or only without them, is none.
    parsed(expression)?;
    let module = parsed(&format!("({expression})"))?;
    Validator::new(ValidationFlags::all(), Capabilities::default())
        .validate(&module)
        .map_err(|_| refused("it has another type"))?;
    Ok(())
}

pub(crate) const fn type_of(shape: ValueShape) -> &'static str {
    match shape {
        ValueShape::Scalar => "f32",
        ValueShape::Vec2 => "vec2f",
        ValueShape::Vec3 => "vec3f",
        ValueShape::Vec4 => "vec4f",
        ValueShape::Mat3 => "mat3x3f",
        ValueShape::Mat4 => "mat4x4f",
    }
}

/// Whether a variable has that name: the whole of it, or its last part.
fn is_named(slot: &Variable, name: &str) -> bool {
    slot.name == name || slot.name.rsplit('.').next() == Some(name)
}

/// What a variable may mean by its name, the most telling key first.
fn meanings(slot: &Variable) -> impl Iterator<Item = Meaning> + '_ {
    // three.js hands over the vector to the eye by this name. Who turns it round has the surface's position.
    let given = (slot.name == "vViewPosition" && !slot.is_negated).then_some(Meaning::ToEyeWithLength);
    let of_key = |key: String| {
        SYNONYMS
            .iter()
            .filter(move |(_, names)| names.contains(&key.as_str()))
            .map(|(meaning, _)| *meaning)
            .collect::<Vec<_>>()
    };
    given.into_iter().chain(keys(&slot.name).into_iter().flat_map(of_key)).map(|meaning| match meaning {
        // A point in the eye's space goes by the name of the eye's own position.
        Meaning::Eye if slot.from == From::Input => Meaning::Point,
        other => other,
    })
}

fn expression(slot: &Variable, context: &Context<'_>, asked: &[AskedBinding]) -> Option<(String, FoundBy)> {
    let whole = asked.iter().find(|asked| asked.name == slot.name);
    if let Some(asked) = whole.or_else(|| asked.iter().find(|asked| is_named(slot, &asked.name))) {
        return Some((of_an_input(slot, &asked.expression, context.spec), FoundBy::Asked));
    }
    if let From::BuiltIn(built_in) = slot.from {
        return Some((built_in_value(built_in, slot.leaf, context), FoundBy::Fixed));
    }
    if !slot.is_used {
        return Some((zero(slot.leaf), FoundBy::Fixed));
    }
    // naga puts an underscore behind a name that ends in a digit.
    let name = slot.name.trim_end_matches('_');
    // A normal that is a parameter is a unit vector, whatever the formula's is.
    let is_unit = slot.from == From::Parameter && name == "normal";
    // Of a matrix the capitals are the writer's taste. Of others they are not: a shader's `Position` is not the light's.
    let is_matrix = matches!(slot.leaf, Leaf::Matrix(..));
    let is_same = |input: &&Input| input.name == name || (is_matrix && input.name.eq_ignore_ascii_case(name));
    let same = context.spec.inputs.iter().find(|input| is_same(input) && !is_unit && !is_of_surface(slot, context));
    if let Some(input) = same
        && let Some(fitted) = fitted(input.name, input.shape, slot.leaf, None)
    {
        return Some((fitted, FoundBy::SameName));
    }
    if is_of_light(slot, context) {
        return fitted("position", ValueShape::Vec3, slot.leaf, Some(Meaning::LightPosition))
            .map(|is| (is, FoundBy::Synonym));
    }
    let understood = meanings(slot).find_map(|meaning| {
        // Further lights of an array give nothing.
        if slot.is_further && is_light_color(meaning) {
            return Some((zero(slot.leaf), FoundBy::Synonym));
        }
        let expression = context.expression(meaning, slot.from)?;
        let fitted = fitted(&expression, shape_of(meaning, &expression, context.spec), slot.leaf, Some(meaning))?;
        Some((fitted, FoundBy::Synonym))
    });
    understood.or_else(|| Some((numbered(slot, context).or_else(|| unnamed(slot, context))?, FoundBy::Synonym)))
}

/// An expression that is asked for. An input by its name alone is brought to the variable's type, as it is where no binding is asked for.
fn of_an_input(slot: &Variable, expression: &str, spec: &Spec) -> String {
    let input = spec.inputs.iter().find(|input| input.name == expression);
    let fitted = input.and_then(|input| {
        fitted(input.name, input.shape, slot.leaf, meanings(slot).find(|&meaning| meaning != Meaning::Identity))
    });
    fitted.unwrap_or_else(|| expression.to_owned())
}

/// The input whose name a variable has but for a number at its end, by which tools tell names apart.
fn numbered(slot: &Variable, context: &Context<'_>) -> Option<String> {
    let name = slot.name.trim_end_matches(|c: char| c == '_' || c.is_ascii_digit());
    let input = context.spec.inputs.iter().find(|input| input.name == name)?;
    fitted(input.name, input.shape, slot.leaf, None)
}

/// Whether a bare position is the light's: beside another one of the surface, where nothing else is the light's.
fn is_of_light(slot: &Variable, context: &Context<'_>) -> bool {
    let is_bare = slot.name.trim_end_matches(|c: char| c == '_' || c.is_ascii_digit()) == "position";
    let has_light = context.meanings.contains(&Meaning::LightPosition);
    is_bare && slot.from == From::Parameter && context.has("position") && context.points > 1 && !has_light
}

/// What a variable is whose name is not understood: a matrix is a transform, and a texture has the surface's colour.
fn unnamed(slot: &Variable, context: &Context<'_>) -> Option<String> {
    let meaning = match (slot.leaf, slot.from) {
        (Leaf::Matrix(..), _) => Meaning::Identity,
        (_, From::Texture) => Meaning::SurfaceColor,
        _ => return None,
    };
    let expression = context.expression(meaning, slot.from)?;
    fitted(&expression, shape_of(meaning, &expression, context.spec), slot.leaf, Some(meaning))
}

/// Whether it is the surface's position where the formula's input of that name is the light's: what comes from the stage before, and what
/// stands beside a light's position.
fn is_of_surface(slot: &Variable, context: &Context<'_>) -> bool {
    let has_light = context.meanings.contains(&Meaning::LightPosition);
    slot.name == "position" && context.has("p") && (slot.from == From::Input || has_light)
}

const fn is_light_color(meaning: Meaning) -> bool {
    matches!(meaning, Meaning::OfLight(_) | Meaning::LightColor | Meaning::OfMaterial(_))
}

/// What the pipeline gives to a single case.
fn built_in_value(built_in: BuiltIn, leaf: Leaf, context: &Context<'_>) -> String {
    match built_in {
        BuiltIn::Position { .. } => {
            // The depth over the reciprocal of w is the distance from the eye's plane, however a formula measures its own.
            let planar = context.spec.place("p").filter(|place| place.len() == 3).map(|_| "abs(p.z)".to_owned());
            let distance = planar.or_else(|| context.expression(Meaning::Distance, From::Input));
            let distance = distance.unwrap_or_else(|| "1.0".into());
            format!("vec4f(0.5, 0.5, 1.0, 1.0 / ({distance}))")
        }
        BuiltIn::FrontFacing => "true".into(),
        _ => zero(leaf),
    }
}

fn zero(leaf: Leaf) -> String {
    format!("{leaf}()")
}

fn shape_of(meaning: Meaning, expression: &str, spec: &Spec) -> ValueShape {
    if let Some(input) = spec.inputs.iter().find(|input| input.name == expression) {
        return input.shape;
    }
    use Meaning as M;
    match meaning {
        M::Weight(_) if spec.place("ka").is_none() && expression != "1.0" => ValueShape::Vec3,
        M::Shininess
        | M::Weight(_)
        | M::Alpha
        | M::Constant
        | M::Linear
        | M::Quadratic
        | M::Attenuation
        | M::Distance
        | M::CutoffCosine
        | M::SpotExponent
        | M::FogDensity
        | M::FogStart
        | M::FogEnd
        | M::FogFactor
        | M::Incidence
        | M::HalfCosine
        | M::ReflectedCosine
        | M::Identity
        | M::Count
        | M::TexturePlace => ValueShape::Scalar,
        _ => ValueShape::Vec3,
    }
}

/// An expression of a shape as the value of a variable; `None` where the two do not fit.
fn fitted(expression: &str, shape: ValueShape, leaf: Leaf, meaning: Option<Meaning>) -> Option<String> {
    let w = match meaning {
        Some(Meaning::Point | Meaning::Eye | Meaning::LightPosition) => "1.0",
        Some(meaning) if is_direction(meaning) => "0.0",
        _ => "1.0",
    };
    match (shape, leaf) {
        (_, Leaf::Matrix(columns, rows)) if meaning == Some(Meaning::Identity) => Some(identity(columns, rows)),
        (ValueShape::Mat3, Leaf::Matrix(3, 3)) | (ValueShape::Mat4, Leaf::Matrix(4, 4)) => Some(expression.into()),
        // A modelview matrix of which a normal's formula has the upper left.
        (ValueShape::Mat3, Leaf::Matrix(4, 4)) => {
            let column = |k: u8| format!("vec4f(({expression})[{k}], 0.0)");
            Some(format!("mat4x4f({}, {}, {}, vec4f(0.0, 0.0, 0.0, 1.0))", column(0), column(1), column(2)))
        }
        (ValueShape::Mat4, Leaf::Matrix(3, 3)) => {
            let column = |k: u8| format!("({expression})[{k}].xyz");
            Some(format!("mat3x3f({}, {}, {})", column(0), column(1), column(2)))
        }
        (_, Leaf::Vector(size, ScalarKind::Float)) if meaning == Some(Meaning::TexturePlace) => {
            Some(format!("vec{size}f({expression})"))
        }
        (ValueShape::Scalar, Leaf::Scalar(ScalarKind::Float)) if meaning != Some(Meaning::Identity) => {
            Some(expression.into())
        }
        (ValueShape::Scalar, Leaf::Scalar(kind @ (ScalarKind::Sint | ScalarKind::Uint))) => {
            Some(if kind == ScalarKind::Sint { format!("i32({expression})") } else { format!("u32({expression})") })
        }
        // A single weight applies to red, green and blue alike.
        (ValueShape::Scalar, Leaf::Vector(size, ScalarKind::Float)) if matches!(meaning, Some(Meaning::Weight(_))) => {
            Some(format!("vec{size}f({expression})"))
        }
        (ValueShape::Vec2, Leaf::Vector(2, ScalarKind::Float))
        | (ValueShape::Vec3, Leaf::Vector(3, ScalarKind::Float))
        | (ValueShape::Vec4, Leaf::Vector(4, ScalarKind::Float)) => Some(expression.into()),
        (ValueShape::Vec3, Leaf::Vector(4, ScalarKind::Float)) => Some(format!("vec4f({expression}, {w})")),
        (ValueShape::Vec4, Leaf::Vector(3, ScalarKind::Float)) => Some(format!("({expression}).xyz")),
        _ => None,
    }
}

const fn is_direction(meaning: Meaning) -> bool {
    use Meaning as M;
    matches!(
        meaning,
        M::Normal | M::ToEye | M::ToEyeWithLength | M::ToLight | M::Travel | M::Half | M::Reflected | M::Axis
    )
}

fn identity(columns: u8, rows: u8) -> String {
    let number = |column: u8, row: u8| if column == row { "1.0" } else { "0.0" };
    let numbers: Vec<&str> = (0..columns).flat_map(|column| (0..rows).map(move |row| number(column, row))).collect();
    format!("mat{columns}x{rows}f({})", numbers.join(", "))
}

/// The numbers of a shape.
fn leaf_of(shape: ValueShape) -> Option<u8> {
    match shape {
        ValueShape::Scalar => Some(1),
        ValueShape::Vec2 => Some(2),
        ValueShape::Vec3 => Some(3),
        ValueShape::Vec4 => Some(4),
        ValueShape::Mat3 | ValueShape::Mat4 => None,
    }
}

const fn size(leaf: Leaf) -> Option<u8> {
    match leaf {
        Leaf::Scalar(ScalarKind::Float) => Some(1),
        Leaf::Vector(size, ScalarKind::Float) => Some(size),
        _ => None,
    }
}

/// Which value of the shader each output of the formula is.
fn outputs(program: &ShaderProgram, spec: &Spec) -> Result<Vec<(&'static str, Option<String>)>, AdaptError> {
    let fits = |output: &ShaderOutput, wanted: u8| {
        size(output.leaf).and_then(|given| match (given, wanted) {
            (given, wanted) if given == wanted => Some(output.value.clone()),
            (4, 3) => Some(format!("({}).xyz", output.value)),
            // A shader without an alpha is judged by its colours: the formula's own alpha stands beside them.
            (3, 4) => Some(format!("vec4f({}, user_own.w)", output.value)),
            _ => None,
        })
    };
    let given = |name: &str, shape: ValueShape| {
        let wanted = leaf_of(shape)?;
        let named = program.outputs.iter().find(|output| output.name == name && size(output.leaf).is_some());
        // Of several the one at location 0.
        let only = || {
            let fitting: Vec<&ShaderOutput> =
                program.outputs.iter().filter(|output| fits(output, wanted).is_some()).collect();
            let first: Vec<&ShaderOutput> = fitting.iter().copied().filter(|output| !output.is_further).collect();
            match (fitting.as_slice(), first.as_slice()) {
                ([one], _) | (_, [one]) => Some(*one),
                _ => None,
            }
        };
        named.and_then(|output| fits(output, wanted)).or_else(|| fits(only()?, wanted))
    };
    let found: Vec<(&'static str, Option<String>)> =
        spec.outputs.iter().map(|output| (output.name, given(output.name, output.shape))).collect();
    if found.iter().all(|(_, value)| value.is_none()) {
        let own: Vec<String> = program
            .outputs
            .iter()
            .map(|output| match output.name.as_str() {
                "" => format!("a {}", output.leaf),
                name => format!("{name}: {}", output.leaf),
            })
            .collect();
        let own = if own.is_empty() { "nothing".into() } else { own.join(", ") };
        let wanted: Vec<String> =
            spec.outputs.iter().map(|output| format!("{}: {}", output.name, output.shape.name())).collect();
        return Err(AdaptError::Bind(format!("the shader gives {own}, and {} gives {}", spec.id, wanted.join(", "))));
    }
    Ok(found)
}

/// Inputs that no variable has, of a shader that gives all outputs.
fn unused(spec: &Spec, bound: &[Bound], outputs: &[(&'static str, Option<String>)]) -> Vec<&'static str> {
    if outputs.iter().any(|(_, value)| value.is_none()) {
        return vec![];
    }
    spec.inputs
        .iter()
        .map(|input| input.name)
        .filter(|name| !bound.iter().any(|bound| has_word(&bound.expression, name)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::suggest::as_glsl;
    use crate::{Part, replaced};
    use lightmeter_catalogue::cases::Kind;
    use lightmeter_catalogue::select::catalogue;
    use lightmeter_gpu::Shaders;
    use lightmeter_shaders::read::{Language, ShaderSource};
    use std::path::{Path, PathBuf};

    fn read(path: &Path, text: &str) -> Result<ShaderSource, AdaptError> {
        Ok(ShaderSource::of_text(path, text, Language::of(path)?)?)
    }

    /// Each formula of lighting, fog and attenuation is bound by the names that our own functions have, in WGSL and as naga writes it in GLSL.
    #[test]
    fn every_formula_of_ours_is_bound_by_its_own_names() {
        let shaders = Shaders::built_in().expect("the built-in shaders are valid");
        let mut bound = 0;
        for member in catalogue() {
            let spec = &member.spec;
            let is_meant =
                ["lighting", "fog", "attenuation"].contains(&spec.family()) && matches!(spec.kind, Kind::Arithmetic);
            if !is_meant || spec.function.is_empty() {
                continue;
            }
            let file = spec.file();
            let glsl = as_glsl(&shaders, &file, spec.function).expect(spec.function);
            for (ending, text) in [("wgsl", shaders.source(&file)), ("glsl", glsl)] {
                let path = PathBuf::from(format!("{}.{ending}", spec.function));
                let source = read(&path, &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
                // naga puts an underscore behind a digit.
                let names = [spec.function.to_owned(), format!("{}_", spec.function)];
                let name = names.iter().find(|name| text.contains(&format!("{name}("))).expect(spec.function);
                let program = ShaderProgram::new(&path, &source, &Part::Function(name.clone()));
                let program = program.unwrap_or_else(|error| panic!("{error}\n{text}"));
                let binding = bind(&program, spec, &[]).unwrap_or_else(|error| panic!("{}: {error}\n{text}", spec.id));
                assert!(binding.unused.is_empty(), "{}: nothing stands for {:?}", spec.id, binding.unused);
                replaced(&shaders, &program, &[(spec, binding)]).unwrap_or_else(|error| panic!("{error}"));
                bound += 1;
            }
        }
        assert!(bound > 100, "{bound}");
    }

    /// What the variables of a fragment shader in GLSL, or of a function of it, are bound to.
    fn binding(id: &str, text: &str, part: &Part) -> Result<Vec<(String, String)>, String> {
        let path = Path::new("shader.frag");
        let source = read(path, text).map_err(|error| error.to_string())?;
        let program = ShaderProgram::new(path, &source, part).map_err(|error| error.to_string())?;
        let catalogue = catalogue();
        let member = catalogue.iter().find(|member| member.spec.id == id).expect(id);
        let found = bind(&program, &member.spec, &[]).map_err(|error| error.to_string())?;
        Ok(found.bound.into_iter().map(|one| (one.name, one.expression)).collect())
    }

    #[test]
    fn names_are_understood_by_how_they_are_used_and_by_what_stands_beside_them() {
        let lit = |declared: &str, color: &str| {
            format!("#version 330\n{declared}\nout vec4 o;\nvoid main() {{ o = vec4({color}, 1.0); }}\n")
        };
        let eye = "in vec3 vNormal; in vec3 vViewPosition; uniform vec3 uSpecular;";
        let of_eye = |v: &str| lit(eye, &format!("uSpecular * dot(normalize(vNormal), normalize({v}))"));
        let weighted = lit(
            "uniform float Ka; uniform vec3 ambientColor; uniform float kLinear;",
            "Ka * ambientColor / (1.0 + kLinear)",
        );
        let placed = lit(
            "in vec3 Position; in vec3 Normal; uniform vec3 lightPosition;",
            "Normal * dot(lightPosition - Position, Normal)",
        );
        let layers = lit("uniform vec4 fg; uniform vec3 bg;", "fg.rgb * fg.a + bg * (1.0 - fg.a)");
        for (id, text, name, is) in [
            ("lighting/blinn", of_eye("vViewPosition"), "vViewPosition", "-p"),
            ("lighting/blinn", of_eye("-vViewPosition"), "vViewPosition", "p"),
            ("lighting/point-phong", weighted.clone(), "Ka", "1.0"),
            ("lighting/point-phong", weighted.clone(), "ambientColor", "la * ma"),
            ("lighting/point-phong", weighted.clone(), "kLinear", "kl"),
            ("lighting/point-phong", placed.clone(), "Position", "p"),
            ("lighting/point-phong", placed, "lightPosition", "position"),
            ("blend/over", layers.clone(), "fg", "src"),
            ("blend/over", layers, "bg", "dst"),
            ("lighting/point-phong", format!("\u{feff}{weighted}"), "kLinear", "kl"),
        ] {
            let found = binding(id, &text, &Part::Shader).unwrap_or_else(|error| panic!("{error}\n{text}"));
            let of_name = found.iter().find(|(own, _)| own == name).map(|(_, is)| is.as_str());
            assert_eq!(of_name, Some(is), "{name} in {id}: {found:?}");
        }
        let function = "#version 330\nvec3 lit(vec3 normal, vec3 ls) { return ls * normal.z; }\nvoid main() {}\n";
        let found = binding("lighting/blinn", function, &Part::Function("lit".into())).expect("it is understood");
        assert!(found.contains(&("normal".into(), "normalize(normal)".into())), "{found:?}");
        let unknown = binding("lighting/blinn", &lit("in vec3 _vs2fs_location0;", "_vs2fs_location0"), &Part::Shader);
        assert!(unknown.as_ref().is_err_and(|error| error.contains("_vs2fs_location0: vec3")), "{unknown:?}");
        let other_type = binding("lighting/blinn", &lit("uniform vec3 uShininess;", "uShininess"), &Part::Shader);
        assert!(other_type.as_ref().is_err_and(|error| error.contains("its name is known")), "{other_type:?}");
    }
}
