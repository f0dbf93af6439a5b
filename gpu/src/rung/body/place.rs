//! Where pointers point.

use super::{Body, Value};
use crate::rung::dialect::{Dialect, Shape};
use crate::rung::writer::{is_position, shape_of};
use naga::{AddressSpace, Expression, Handle, LocalVariable, Type, TypeInner};
use std::fmt::Write as _;

/// Where something is kept.
pub(super) struct Place {
    pub(super) text: String,
    /// The component of a vector, where that is a pair of vectors.
    pub(super) component: Option<String>,
    /// Whether f32 is kept there.
    pub(super) is_plain: bool,
    /// Whether it is a clip position.
    pub(super) is_position: bool,
}

impl Body<'_, '_> {
    pub(super) fn place(&mut self, pointer: Value) -> Result<Place, String> {
        let module = self.writer.module;
        let kept = |text: String, is_plain| Place { text, component: None, is_plain, is_position: false };
        match self.function.expressions[pointer] {
            Expression::GlobalVariable(global) => {
                let global = &module.global_variables[global];
                let name = global.name.clone().unwrap_or_default();
                match global.space {
                    AddressSpace::Uniform | AddressSpace::Storage { .. } if self.writer.bindings => {
                        Ok(kept(name, true))
                    }
                    _ => Err(format!("it reads `{name}`, which is not handed to it")),
                }
            }
            Expression::LocalVariable(local) => Ok(kept(local_name(local), self.is_result(local))),
            Expression::FunctionArgument(k) => Ok(kept(format!("(*_a{k})"), false)),
            Expression::AccessIndex { base, index } => {
                let member = match self.pointed(base) {
                    Some(TypeInner::Struct { members, .. }) => Some(members[index as usize].clone()),
                    _ => None,
                };
                let Some(member) = member else { return self.place_part(base, &index.to_string()) };
                let mut place = self.place(base)?;
                let _ = write!(place.text, ".{}", member.name.as_deref().unwrap_or_default());
                place.is_position = place.is_plain && member.binding.as_ref().is_some_and(is_position);
                Ok(place)
            }
            Expression::Access { base, index } => {
                let index = self.value(index)?;
                self.place_part(base, &index)
            }
            ref other => Err(format!("a pointer that is not lowered: {other:?}")),
        }
    }

    fn place_part(&mut self, base: Value, index: &str) -> Result<Place, String> {
        let is_vector = self.pointed(base).is_some_and(|inner| matches!(shape_of(inner), Some(Shape::Vector(_))));
        let mut place = self.place(base)?;
        if is_vector && !place.is_plain && self.writer.dialect == Dialect::Pair {
            place.component = Some(index.into());
        } else {
            let _ = write!(place.text, "[{index}]");
        }
        Ok(place)
    }

    pub(super) fn pointed(&self, pointer: Value) -> Option<&TypeInner> {
        match *self.inner(pointer) {
            TypeInner::Pointer { base, .. } => Some(&self.writer.module.types[base].inner),
            _ => None,
        }
    }

    pub(super) fn is_pointer(&self, value: Value) -> bool {
        matches!(self.inner(value), TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. })
    }

    /// Whether an entry point's result is kept in a variable.
    pub(super) fn is_result(&self, local: Handle<LocalVariable>) -> bool {
        self.gives_position() && self.is_result_type(self.function.local_variables[local].ty)
    }

    pub(super) fn is_result_type(&self, ty: Handle<Type>) -> bool {
        self.function.result.as_ref().is_some_and(|result| result.ty == ty)
    }

    pub(super) fn is_whole_result(&self, pointer: Value) -> bool {
        matches!(self.function.expressions[pointer], Expression::LocalVariable(local) if self.is_result(local))
    }
}

/// What a variable is called.
pub(super) fn local_name(local: Handle<LocalVariable>) -> String {
    format!("_v{}", local.index())
}
