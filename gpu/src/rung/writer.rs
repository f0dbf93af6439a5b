//! What a lowered text needs beyond its functions' bodies: types, structs and what converts them, bindings, constants.

use super::Rung;
use super::dialect::{Dialect, Prelude, Shape, rung_struct};
use naga::common::wgsl::{ToWgsl as _, TryToWgsl as _};
use naga::{
    AddressSpace, ArraySize, BinaryOperator, Binding, BuiltIn, Expression, Function, Handle, ImageClass, Interpolation,
    Literal, Module, Sampling, ScalarKind, Type, TypeInner,
};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Why a function has no meaning in other arithmetics.
pub(super) const READS_BITS: &str = "it reads the bits of a number of binary32";

/// What is said of a text, beyond its functions' bodies.
pub(super) struct Writer<'a> {
    pub(super) module: &'a Module,
    pub(super) rung: Rung,
    pub(super) dialect: Dialect,
    pub(super) prelude: Prelude,
    /// The functions that stand in for others, by those.
    forms: &'a BTreeMap<String, String>,
    /// Whether one does.
    pub(super) is_replaced: bool,
    /// Whether bindings are written.
    pub(super) bindings: bool,
    /// Functions that are called.
    pub(super) pending: Vec<Handle<Function>>,
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

impl<'a> Writer<'a> {
    /// Nothing said yet of a module; `forms` has the functions that stand in for others.
    pub(super) fn new(
        module: &'a Module,
        rung: Rung,
        prelude: Prelude,
        forms: &'a BTreeMap<String, String>,
        bindings: bool,
    ) -> Self {
        Self {
            module,
            rung,
            dialect: Dialect::of(rung),
            prelude,
            forms,
            is_replaced: false,
            bindings,
            pending: vec![],
            conversions: vec![],
            plain_structs: vec![],
            rung_structs: vec![],
        }
    }

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

    pub(super) fn converters(&mut self, out: &mut String) -> Result<(), String> {
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

    pub(super) fn structs(&mut self, out: &mut String) -> Result<(), String> {
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

    pub(super) fn globals(&mut self, out: &mut String) -> Result<(), String> {
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

/// A binary operator's sign.
pub(super) const fn operator(op: BinaryOperator) -> &'static str {
    use BinaryOperator as B;
    match op {
        B::Add => "+",
        B::Subtract => "-",
        B::Multiply => "*",
        B::Divide => "/",
        B::Modulo => "%",
        B::Equal => "==",
        B::NotEqual => "!=",
        B::Less => "<",
        B::LessEqual => "<=",
        B::Greater => ">",
        B::GreaterEqual => ">=",
        B::And => "&",
        B::ExclusiveOr => "^",
        B::InclusiveOr => "|",
        B::LogicalAnd => "&&",
        B::LogicalOr => "||",
        B::ShiftLeft => "<<",
        B::ShiftRight => ">>",
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
pub(super) fn attributes(binding: &Binding) -> Result<String, String> {
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
