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
use super::dialect::{Dialect, Prelude, Shape};
use super::widen::widen;
use naga::common::wgsl::{ToWgsl as _, TryToWgsl as _};
use naga::{
    AddressSpace, ArraySize, Binding, BuiltIn, EntryPoint, Expression, Function, Handle, ImageClass, Interpolation,
    Literal, Module, Sampling, ScalarKind, ShaderStage, Type, TypeInner,
};
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
/// Why a function has no meaning in other arithmetics.
pub(super) const READS_BITS: &str = "it reads the bits of a number of binary32";

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
    let mut writer = Writer {
        module: &module,
        rung,
        dialect,
        prelude,
        forms: if rung == Rung::Stable { forms } else { &none },
        is_replaced: false,
        bindings: matches!(wanted, Asked::Module),
        pending: vec![],
        conversions: vec![],
        plain_structs: vec![],
        rung_structs: vec![],
    };
    let (mut body, mut root) = (String::new(), String::new());
    match wanted {
        Asked::Function(name) => root = writer.target(name, ""),
        Asked::Module => {
            writer.globals(&mut body)?;
            for entry in &module.entry_points {
                writer.entry(entry, &mut body)?;
            }
        }
    }
    let mut next = 0;
    while let Some(&handle) = writer.pending.get(next) {
        writer.function(&module.functions[handle], &mut body)?;
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

/// What is said of a text, beyond its functions' bodies.
pub(super) struct Writer<'a> {
    pub(super) module: &'a Module,
    pub(super) rung: Rung,
    pub(super) dialect: Dialect,
    pub(super) prelude: Prelude,
    forms: &'a BTreeMap<String, String>,
    is_replaced: bool,
    /// Whether bindings are written.
    pub(super) bindings: bool,
    pending: Vec<Handle<Function>>,
    /// Structs that are converted: to the rung, or from it.
    conversions: Vec<(Handle<Type>, bool)>,
    plain_structs: Vec<Handle<Type>>,
    rung_structs: Vec<Handle<Type>>,
}

fn insert<T: PartialEq>(into: &mut Vec<T>, item: T) {
    if !into.contains(&item) {
        into.push(item);
    }
}

/// The floats of a type; `None` where it is no number, vector or matrix of them.
pub(super) fn shape_of(inner: &TypeInner) -> Option<Shape> {
    let is_float = |kind| matches!(kind, ScalarKind::Float | ScalarKind::AbstractFloat);
    match *inner {
        TypeInner::Scalar(scalar) if is_float(scalar.kind) => Some(Shape::Scalar),
        TypeInner::Vector { size, scalar } if is_float(scalar.kind) => Some(Shape::Vector(size as u8)),
        TypeInner::Matrix { columns, rows, .. } => Some(Shape::Matrix(columns as u8, rows as u8)),
        _ => None,
    }
}

/// What a struct is called in the rung.
pub(crate) fn rung_struct(rung: Rung, name: &str) -> String {
    if Dialect::of(rung) == Dialect::Single { name.into() } else { format!("Rung{name}") }
}

impl Writer<'_> {
    /// What a function is called where it is called within another, which is written later if need be.
    pub(super) fn target(&mut self, name: &str, within: &str) -> String {
        let find = |name: &str| self.module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name));
        let form = self.forms.get(name).filter(|form| *form != within && find(form).is_some());
        let name = form.map_or(name, String::as_str);
        if !self.prelude.has(name)
            && let Some((handle, _)) = find(name)
        {
            insert(&mut self.pending, handle);
        }
        self.is_replaced |= form.is_some();
        name.into()
    }

    /// Whether there are floats in a type.
    pub(super) fn has_floats(&self, ty: Handle<Type>) -> bool {
        let inner = &self.module.types[ty].inner;
        match inner {
            TypeInner::Struct { members, .. } => members.iter().any(|member| self.has_floats(member.ty)),
            TypeInner::Array { base, .. } => self.has_floats(*base),
            _ => shape_of(inner).is_some(),
        }
    }

    /// A type's name: of f32, or in the rung.
    pub(super) fn type_name(&mut self, ty: Handle<Type>, is_plain: bool) -> Result<String, String> {
        let found = &self.module.types[ty];
        let name = found.name.clone().unwrap_or_default();
        if let Some(shape) = shape_of(&found.inner) {
            return Ok(if is_plain { Dialect::Single } else { self.dialect }.type_of(shape));
        }
        match &found.inner {
            TypeInner::Scalar(scalar) => Ok(integer(scalar.kind).into()),
            TypeInner::Vector { size, scalar } => Ok(format!("vec{}<{}>", *size as u8, integer(scalar.kind))),
            TypeInner::Struct { .. } => {
                if is_plain || self.dialect == Dialect::Single || !self.has_floats(ty) {
                    insert(&mut self.plain_structs, ty);
                    Ok(name)
                } else {
                    insert(&mut self.rung_structs, ty);
                    Ok(rung_struct(self.rung, &name))
                }
            }
            TypeInner::Array { base, size, .. } => {
                let base = self.type_name(*base, is_plain)?;
                match size {
                    ArraySize::Constant(size) => Ok(format!("array<{base}, {size}>")),
                    ArraySize::Dynamic => Ok(format!("array<{base}>")),
                    ArraySize::Pending(_) => Err("an array's size is not known".into()),
                }
            }
            TypeInner::Pointer { base, space: AddressSpace::Function } => {
                Ok(format!("ptr<function, {}>", self.type_name(*base, is_plain)?))
            }
            TypeInner::Image { dim, arrayed: false, class: ImageClass::Sampled { kind, multi: false } } => {
                let kind = if *kind == ScalarKind::Float { "f32" } else { integer(*kind) };
                Ok(format!("texture_{}<{kind}>", dim.to_wgsl()))
            }
            other => Err(format!("it has a type that is not lowered: {other:?}")),
        }
    }

    /// A value of f32 taken into the rung, or one of the rung rounded.
    pub(super) fn convert(&mut self, ty: Handle<Type>, value: &str, is_up: bool) -> Result<String, String> {
        if self.dialect == Dialect::Single || !self.has_floats(ty) {
            return Ok(value.into());
        }
        let inner = &self.module.types[ty].inner;
        if let Some(shape) = shape_of(inner) {
            return Ok(if is_up { self.dialect.up(shape, value) } else { self.dialect.down(shape, value) });
        }
        match inner {
            TypeInner::Struct { .. } => {
                insert(&mut self.conversions, (ty, is_up));
                Ok(format!("{}({value})", self.converter(ty, is_up)))
            }
            other => Err(format!("a value of a type that is not converted is passed whole: {other:?}")),
        }
    }

    fn converter(&self, ty: Handle<Type>, is_up: bool) -> String {
        let name = self.module.types[ty].name.as_deref().unwrap_or_default();
        format!("rung_{}_{name}", if is_up { "up" } else { "down" })
    }

    fn converters(&mut self, out: &mut String) -> Result<(), String> {
        let mut next = 0;
        while let Some(&(ty, is_up)) = self.conversions.get(next) {
            next += 1;
            let TypeInner::Struct { members, .. } = &self.module.types[ty].inner else { continue };
            let parts: Vec<String> = members
                .iter()
                .map(|member| {
                    let value = format!("x.{}", member.name.as_deref().unwrap_or_default());
                    self.convert(member.ty, &value, is_up)
                })
                .collect::<Result<_, String>>()?;
            let (from, to) = (self.type_name(ty, is_up)?, self.type_name(ty, !is_up)?);
            let name = self.converter(ty, is_up);
            let _ = writeln!(out, "fn {name}(x: {from}) -> {to} {{\n    return {to}({});\n}}", parts.join(", "));
        }
        Ok(())
    }

    fn structs(&mut self, out: &mut String) -> Result<(), String> {
        for is_plain in [true, false] {
            let mut next = 0;
            while let Some(&ty) = if is_plain { &self.plain_structs } else { &self.rung_structs }.get(next) {
                next += 1;
                let name = self.type_name(ty, is_plain)?;
                let TypeInner::Struct { members, .. } = &self.module.types[ty].inner else { continue };
                let _ = writeln!(out, "struct {name} {{");
                for member in members {
                    let binding = member.binding.as_ref().filter(|_| is_plain);
                    let binding = binding.map_or(Ok(String::new()), attributes)?;
                    let ty = self.type_name(member.ty, is_plain)?;
                    let _ = writeln!(out, "    {binding}{}: {ty},", member.name.as_deref().unwrap_or_default());
                }
                out.push_str("}\n");
            }
        }
        Ok(())
    }

    fn globals(&mut self, out: &mut String) -> Result<(), String> {
        for (_, global) in self.module.global_variables.iter() {
            let name = global.name.as_deref().unwrap_or_default();
            let space = match global.space {
                AddressSpace::Uniform => "<uniform>",
                AddressSpace::Storage { access } if access.contains(naga::StorageAccess::STORE) => {
                    "<storage, read_write>"
                }
                AddressSpace::Storage { .. } => "<storage, read>",
                AddressSpace::Handle => "",
                other => return Err(format!("`{name}` is in an address space that is not lowered: {other:?}")),
            };
            let place = global
                .binding
                .map_or(String::new(), |place| format!("@group({}) @binding({}) ", place.group, place.binding));
            let ty = self.type_name(global.ty, true)?;
            let _ = writeln!(out, "{place}var{space} {name}: {ty};");
        }
        Ok(())
    }

    fn function(&mut self, function: &Function, out: &mut String) -> Result<(), String> {
        let name = function.name.clone().unwrap_or_default();
        let arguments: Vec<String> = function
            .arguments
            .iter()
            .enumerate()
            .map(|(k, argument)| Ok(format!("_a{k}: {}", self.type_name(argument.ty, false)?)))
            .collect::<Result<_, String>>()?;
        let result = match &function.result {
            Some(result) => format!(" -> {}", self.type_name(result.ty, false)?),
            None => String::new(),
        };
        let text = Body::new(self, function, None)?.write()?;
        let _ = writeln!(out, "fn {name}({}){result} {{\n{text}}}", arguments.join(", "));
        Ok(())
    }

    fn entry(&mut self, entry: &EntryPoint, out: &mut String) -> Result<(), String> {
        let function = &entry.function;
        let stage = match entry.stage {
            ShaderStage::Vertex => "@vertex".to_owned(),
            ShaderStage::Fragment => "@fragment".to_owned(),
            ShaderStage::Compute => {
                format!("@compute @workgroup_size({:?})", entry.workgroup_size).replace(['[', ']'], "")
            }
            other => return Err(format!("a stage that is not lowered: {other:?}")),
        };
        let (mut arguments, mut received) = (vec![], String::new());
        for (k, argument) in function.arguments.iter().enumerate() {
            let binding = argument.binding.as_ref().map_or(Ok(String::new()), attributes)?;
            arguments.push(format!("{binding}_i{k}: {}", self.type_name(argument.ty, true)?));
            let _ = writeln!(received, "    let _a{k} = {};", self.convert(argument.ty, &format!("_i{k}"), true)?);
        }
        if self.dialect == Dialect::Pair {
            received.push_str(&self.unknown_zero(entry, &mut arguments)?);
        }
        let result = match &function.result {
            Some(result) => {
                let binding = result.binding.as_ref().map_or(Ok(String::new()), attributes)?;
                format!(" -> {binding}{}", self.type_name(result.ty, true)?)
            }
            None => String::new(),
        };
        let text = Body::new(self, function, Some(entry))?.write()?;
        let (name, arguments) = (&entry.name, arguments.join(", "));
        let _ = writeln!(out, "{stage}\nfn {name}({arguments}){result} {{\n{received}{text}}}");
        Ok(())
    }

    /// A statement that fills `rung_zero` with a zero that no compiler knows: the index of the only instance, or what
    /// a fragment's place in pixels has beyond 2^20.
    fn unknown_zero(&self, entry: &EntryPoint, arguments: &mut Vec<String>) -> Result<String, String> {
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
                    let TypeInner::Struct { members, .. } = &self.module.types[argument.ty].inner else { return None };
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

    /// A constant expression of the module's.
    pub(super) fn constant(&mut self, init: Handle<Expression>, dialect: Dialect) -> Result<String, String> {
        match &self.module.global_expressions[init] {
            Expression::Literal(value) => literal(*value, dialect),
            Expression::Constant(constant) => self.constant(self.module.constants[*constant].init, dialect),
            Expression::ZeroValue(ty) => Ok(format!("{}()", self.type_name(*ty, dialect == Dialect::Single)?)),
            other => Err(format!("a constant that is not lowered: {other:?}")),
        }
    }
}

pub(super) fn is_position(binding: &Binding) -> bool {
    matches!(binding, Binding::BuiltIn(BuiltIn::Position { .. }))
}

pub(super) const fn integer(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Sint | ScalarKind::AbstractInt => "i32",
        ScalarKind::Uint => "u32",
        ScalarKind::Bool => "bool",
        ScalarKind::Float | ScalarKind::AbstractFloat => "f32",
    }
}

pub(super) fn literal(value: Literal, dialect: Dialect) -> Result<String, String> {
    Ok(match value {
        Literal::F64(x) | Literal::AbstractFloat(x) => dialect.literal(x),
        Literal::F32(x) => dialect.literal(f64::from(x)),
        Literal::U32(x) => format!("{x}u"),
        Literal::I32(x) => format!("i32({x})"),
        Literal::AbstractInt(x) => format!("{x}"),
        Literal::Bool(x) => format!("{x}"),
        other => return Err(format!("a literal that is not lowered: {other:?}")),
    })
}

/// A binding's attributes, each followed by a space.
fn attributes(binding: &Binding) -> Result<String, String> {
    match binding {
        Binding::BuiltIn(builtin) => {
            let invariant = if *builtin == (BuiltIn::Position { invariant: true }) { "@invariant " } else { "" };
            let name = builtin.try_to_wgsl().ok_or_else(|| format!("a built-in value without a name: {builtin:?}"))?;
            Ok(format!("{invariant}@builtin({name}) "))
        }
        Binding::Location { location, interpolation, sampling, blend_src, .. } => {
            let mut text = format!("@location({location}) ");
            if let Some(source) = blend_src {
                let _ = write!(text, "@blend_src({source}) ");
            }
            let is_usual = matches!(interpolation, None | Some(Interpolation::Perspective))
                && matches!(sampling, None | Some(Sampling::Center));
            if let Some(interpolation) = interpolation.filter(|_| !is_usual) {
                let sampling = sampling.map_or(String::new(), |sampling| format!(", {}", sampling.to_wgsl()));
                let _ = write!(text, "@interpolate({}{sampling}) ", interpolation.to_wgsl());
            }
            Ok(text)
        }
    }
}
