//! What clip positions are computed from, which is computed in f32 besides.

use super::{Body, Value};
use crate::rung::writer::is_position;
use naga::{Block, Expression, Handle, Statement, Type, TypeInner};

impl Body<'_, '_> {
    /// Whether it is an entry point with a clip position among its results.
    pub(super) fn gives_position(&self) -> bool {
        let Some(result) = self.entry.and(self.function.result.as_ref()) else { return false };
        match &self.writer.module.types[result.ty].inner {
            TypeInner::Struct { members, .. } => {
                members.iter().any(|member| member.binding.as_ref().is_some_and(is_position))
            }
            _ => result.binding.as_ref().is_some_and(is_position),
        }
    }

    /// Notes what clip positions come of.
    pub(super) fn find_position(&mut self, block: &Block) -> Result<(), String> {
        for statement in block {
            match statement {
                Statement::Block(block) => self.find_position(block)?,
                Statement::If { accept, reject, .. } => {
                    self.find_position(accept)?;
                    self.find_position(reject)?;
                }
                Statement::Switch { cases, .. } => {
                    cases.iter().try_for_each(|case| self.find_position(&case.body))?;
                }
                Statement::Loop { body, continuing, .. } => {
                    self.find_position(body)?;
                    self.find_position(continuing)?;
                }
                Statement::Store { pointer, value } if self.stores_position(*pointer) => self.note_position(*value),
                Statement::Return { value: Some(value) } => match &self.function.expressions[*value] {
                    Expression::Compose { ty, components } if self.is_struct(*ty) => {
                        for component in self.positions(*ty, components) {
                            self.note_position(component);
                        }
                    }
                    Expression::Load { .. } => {}
                    _ => self.note_position(*value),
                },
                _ => {}
            }
        }
        Ok(())
    }

    fn stores_position(&self, pointer: Value) -> bool {
        match self.function.expressions[pointer] {
            Expression::AccessIndex { base, index } => match self.pointed(base) {
                Some(TypeInner::Struct { members, .. }) => {
                    members[index as usize].binding.as_ref().is_some_and(is_position)
                }
                _ => self.stores_position(base),
            },
            Expression::Access { base, .. } => self.stores_position(base),
            _ => false,
        }
    }

    fn is_struct(&self, ty: Handle<Type>) -> bool {
        matches!(self.writer.module.types[ty].inner, TypeInner::Struct { .. })
    }

    /// The clip positions of a struct that is put together.
    fn positions(&self, ty: Handle<Type>, components: &[Value]) -> Vec<Value> {
        let TypeInner::Struct { members, .. } = &self.writer.module.types[ty].inner else { return vec![] };
        let of = members.iter().zip(components).filter(|(member, _)| member.binding.as_ref().is_some_and(is_position));
        of.map(|(_, &component)| component).collect()
    }

    fn note_position(&mut self, value: Value) {
        let operands: Vec<Value> = match &self.function.expressions[value] {
            Expression::Compose { components, .. } => components.clone(),
            Expression::Access { base, index } => vec![*base, *index],
            Expression::AccessIndex { base, .. } => vec![*base],
            Expression::Splat { value, .. } => vec![*value],
            Expression::Swizzle { vector, .. } => vec![*vector],
            Expression::Unary { expr, .. } | Expression::As { expr, .. } => vec![*expr],
            Expression::Binary { left, right, .. } => vec![*left, *right],
            Expression::Select { condition, accept, reject } => vec![*condition, *accept, *reject],
            Expression::Math { arg, arg1, arg2, arg3, .. } => {
                [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().collect()
            }
            _ => vec![],
        };
        if self.behind_position.insert(value) {
            for operand in operands {
                self.note_position(operand);
            }
        }
    }
}
