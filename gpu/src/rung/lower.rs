//! WGSL written again in a rung's arithmetic, from what naga reads of it.
//!
//! A value of f32 becomes one of the rung's; a struct `S` becomes `RungS`. What naga evaluates at one place is bound to a name
//! there. A built-in function `name` of n components is the prelude's `rung_name_n` where there is one, else that of its
//! components, else the language's own; a function of ours that the prelude has by the same name is the prelude's.
//!
//! *Interfaces* (bindings, textures, vertex inputs, varyings, targets) stay f32: values are converted as they are loaded or
//! received, and rounded as they leave. What a clip position is computed from, back to the uniforms and the vertex inputs,
//! is computed in f32 besides, at every rung: the same triangles cover the same pixels at the same depths.

use super::Rung;
use super::body::Body;
use super::dialect::{Dialect, Prelude};
use super::widen::widen;
use super::writer::{Writer, attributes, is_position};
use naga::{EntryPoint, Function, ShaderStage, TypeInner};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Asked<'a> {
    /// A function, with all that it reaches.
    Function(&'a str),
    /// Entry points and bindings, with all that they reach.
    Module,
}

/// A lowered text.
#[derive(Debug)]
pub(crate) struct Lowered {
    /// The WGSL.
    pub(crate) source: String,
    /// What the function that was wanted is called there.
    pub(crate) root: String,
}

/// Why a rung of f32's own types has nothing to say of a function.
pub(super) const NOTHING_STABLE: &str = "no step of it has a stable form of its own";
/// The same of approximations.
pub(super) const NOTHING_CHEAP: &str = "no step of it has a cheap approximation";

/// Writes a valid text of f32 in the rung's arithmetic; `Err` says why it is unavailable there. `forms` has the stable form
/// of each function that has one.
pub(crate) fn lower(
    text: &str,
    rung: Rung,
    forms: &BTreeMap<String, String>,
    wanted: Asked<'_>,
) -> Result<Lowered, String> {
    lower_with(text, rung, Prelude::of(rung), forms, wanted)
}

pub(super) fn lower_with(
    text: &str,
    rung: Rung,
    prelude: Prelude,
    forms: &BTreeMap<String, String>,
    wanted: Asked<'_>,
) -> Result<Lowered, String> {
    let dialect = Dialect::of(rung);
    let source = if dialect == Dialect::Single { text.to_owned() } else { widen(text) };
    let module = naga::front::wgsl::parse_str(&source).map_err(|error| error.emit_to_string(&source))?;
    let none = BTreeMap::new();
    let forms = if rung == Rung::Stable { forms } else { &none };
    let mut writer = Writer::new(&module, rung, prelude, forms, matches!(wanted, Asked::Module));
    let (mut body, mut root) = (String::new(), String::new());
    match wanted {
        Asked::Function(name) => root = writer.target(name, ""),
        Asked::Module => {
            writer.globals(&mut body)?;
            for point in &module.entry_points {
                entry(&mut writer, point, &mut body)?;
            }
        }
    }
    let mut next = 0;
    while let Some(&handle) = writer.pending.get(next) {
        function(&mut writer, &module.functions[handle], &mut body)?;
        next += 1;
    }
    writer.converters(&mut body)?;
    writer.structs(&mut body)?;
    if rung == Rung::Stable && !writer.is_replaced {
        return Err(NOTHING_STABLE.into());
    }
    if rung == Rung::Cheap && !body.contains("rung_") {
        return Err(NOTHING_CHEAP.into());
    }
    let enable = if rung == Rung::F16 { "enable f16;\n" } else { "" };
    Ok(Lowered { source: format!("{enable}{body}\n{}", writer.prelude.text), root })
}

fn function(writer: &mut Writer<'_>, function: &Function, out: &mut String) -> Result<(), String> {
    let name = function.name.clone().unwrap_or_default();
    let arguments: Vec<String> = function
        .arguments
        .iter()
        .enumerate()
        .map(|(k, argument)| Ok(format!("_a{k}: {}", writer.type_name(argument.ty, false)?)))
        .collect::<Result<_, String>>()?;
    let result = match &function.result {
        Some(result) => format!(" -> {}", writer.type_name(result.ty, false)?),
        None => String::new(),
    };
    let text = Body::new(writer, function, None)?.write()?;
    let _ = writeln!(out, "fn {name}({}){result} {{\n{text}}}", arguments.join(", "));
    Ok(())
}

fn entry(writer: &mut Writer<'_>, entry: &EntryPoint, out: &mut String) -> Result<(), String> {
    let function = &entry.function;
    let stage = match entry.stage {
        ShaderStage::Vertex => "@vertex".to_owned(),
        ShaderStage::Fragment => "@fragment".to_owned(),
        ShaderStage::Compute => format!("@compute @workgroup_size({:?})", entry.workgroup_size).replace(['[', ']'], ""),
        other => return Err(format!("a stage that is not lowered: {other:?}")),
    };
    let (mut arguments, mut received) = (vec![], String::new());
    for (k, argument) in function.arguments.iter().enumerate() {
        let binding = argument.binding.as_ref().map_or(Ok(String::new()), attributes)?;
        arguments.push(format!("{binding}_i{k}: {}", writer.type_name(argument.ty, true)?));
        let _ = writeln!(received, "    let _a{k} = {};", writer.convert(argument.ty, &format!("_i{k}"), true)?);
    }
    if writer.dialect == Dialect::Pair {
        received.push_str(&unknown_zero(writer, entry, &mut arguments)?);
    }
    let result = match &function.result {
        Some(result) => {
            let binding = result.binding.as_ref().map_or(Ok(String::new()), attributes)?;
            format!(" -> {binding}{}", writer.type_name(result.ty, true)?)
        }
        None => String::new(),
    };
    let text = Body::new(writer, function, Some(entry))?.write()?;
    let (name, arguments) = (&entry.name, arguments.join(", "));
    let _ = writeln!(out, "{stage}\nfn {name}({arguments}){result} {{\n{received}{text}}}");
    Ok(())
}

/// A statement that fills `rung_zero` with a zero that no compiler knows: the index of the only instance, or what
/// a fragment's place in pixels has beyond 2^20.
fn unknown_zero(writer: &Writer<'_>, entry: &EntryPoint, arguments: &mut Vec<String>) -> Result<String, String> {
    let value = match entry.stage {
        ShaderStage::Vertex => {
            arguments.push("@builtin(instance_index) _zero: u32".into());
            "_zero".into()
        }
        ShaderStage::Fragment => {
            let place = entry.function.arguments.iter().enumerate().find_map(|(k, argument)| {
                if argument.binding.as_ref().is_some_and(is_position) {
                    return Some(format!("_i{k}"));
                }
                let TypeInner::Struct { members, .. } = &writer.module.types[argument.ty].inner else { return None };
                let member = members.iter().find(|member| member.binding.as_ref().is_some_and(is_position))?;
                Some(format!("_i{k}.{}", member.name.as_deref().unwrap_or_default()))
            });
            let place = place.unwrap_or_else(|| {
                arguments.push("@builtin(position) _place: vec4f".into());
                "_place".into()
            });
            format!("u32({place}.x) >> 20u")
        }
        other => return Err(format!("a stage without a zero that no compiler knows: {other:?}")),
    };
    Ok(format!("    rung_zero = {value};\n"))
}
