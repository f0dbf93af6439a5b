//! Expressions.

use super::{Body, Value, pair};
use crate::rung::dialect::{Dialect, Shape, plain_vector};
use crate::rung::writer::{READS_BITS, integer, literal, operator, shape_of};
use naga::{
    BinaryOperator, Expression, Handle, ImageQuery, RelationalFunction, ScalarKind, SwizzleComponent, Type, TypeInner,
    UnaryOperator,
};

impl Body<'_, '_> {
    pub(super) fn compute(&mut self, value: Value, is_plain: bool) -> Result<String, String> {
        let module = self.writer.module;
        match self.function.expressions[value].clone() {
            Expression::Literal(value) => literal(value, self.dialect(is_plain)),
            Expression::Constant(constant) => {
                self.writer.constant(module.constants[constant].init, self.dialect(is_plain))
            }
            Expression::ZeroValue(ty) => Ok(format!("{}()", self.writer.type_name(ty, is_plain)?)),
            Expression::Compose { ty, components } => self.compose(ty, &components, is_plain),
            Expression::Splat { size, value: one } => self.splat(size as u8, one, is_plain),
            Expression::Swizzle { size, vector, pattern } => self.swizzle(vector, &pattern[..size as usize], is_plain),
            Expression::Access { base, index } => {
                let index = self.value(index)?;
                self.part(base, &index, is_plain)
            }
            Expression::AccessIndex { base, index } => self.part_at(base, index, is_plain),
            Expression::FunctionArgument(k) if is_plain => Ok(format!("_i{k}")),
            Expression::FunctionArgument(k) => Ok(format!("_a{k}")),
            Expression::GlobalVariable(global) => Ok(module.global_variables[global].name.clone().unwrap_or_default()),
            Expression::Load { pointer } => self.load(value, pointer, is_plain),
            Expression::ImageLoad { image, coordinate, array_index: None, sample: None, level } => {
                let (image, coordinate) = (self.value(image)?, self.value(coordinate)?);
                let level = self.level(level)?;
                self.raise(value, &format!("textureLoad({image}, {coordinate}{level})"))
            }
            Expression::ImageQuery { image, query: ImageQuery::Size { level } } => {
                let image = self.value(image)?;
                Ok(format!("textureDimensions({image}{})", self.level(level)?))
            }
            Expression::Unary { op, expr } => self.unary(op, expr, is_plain),
            Expression::Binary { op, left, right } => self.binary(op, left, right, is_plain),
            Expression::Select { condition, accept, reject } => self.select(condition, accept, reject, is_plain),
            Expression::Relational { fun: RelationalFunction::All, argument } => {
                Ok(format!("all({})", self.value(argument)?))
            }
            Expression::Relational { fun: RelationalFunction::Any, argument } => {
                Ok(format!("any({})", self.value(argument)?))
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                let arguments: Vec<Value> = [Some(arg), arg1, arg2, arg3].into_iter().flatten().collect();
                self.math(value, fun, &arguments, is_plain)
            }
            Expression::As { expr, kind, convert } => self.cast(expr, kind, convert.is_some(), is_plain),
            Expression::ArrayLength(pointer) => Ok(format!("arrayLength(&{})", self.place(pointer)?.text)),
            Expression::CallResult(_) => Err("a clip position comes of a call".into()),
            other => Err(format!("an expression that is not lowered: {other:?}")),
        }
    }

    fn compose(&mut self, ty: Handle<Type>, components: &[Value], is_plain: bool) -> Result<String, String> {
        let parts: Vec<String> =
            components.iter().map(|part| self.operand(*part, is_plain)).collect::<Result<_, _>>()?;
        if self.dialect(is_plain) == Dialect::Pair
            && let Some(Shape::Vector(size)) = shape_of(&self.writer.module.types[ty].inner)
        {
            return Ok(pair::vector(size, &parts));
        }
        Ok(format!("{}({})", self.writer.type_name(ty, is_plain)?, parts.join(", ")))
    }

    fn splat(&mut self, size: u8, one: Value, is_plain: bool) -> Result<String, String> {
        let text = self.operand(one, is_plain)?;
        match self.shape(one) {
            Some(_) => Ok(self.dialect(is_plain).splat(size, &text)),
            None => Ok(format!("vec{size}({text})")),
        }
    }

    fn swizzle(&mut self, vector: Value, pattern: &[SwizzleComponent], is_plain: bool) -> Result<String, String> {
        let is_pair = self.dialect(is_plain) == Dialect::Pair && self.shape(vector).is_some();
        let vector = self.operand(vector, is_plain)?;
        let letters: String = pattern.iter().map(|component| char::from(b"xyzw"[*component as usize])).collect();
        Ok(if is_pair {
            format!("DF{}({vector}.hi.{letters}, {vector}.lo.{letters})", pattern.len())
        } else {
            format!("{vector}.{letters}")
        })
    }

    /// A member of a struct, or a part by a number that is known.
    fn part_at(&mut self, base: Value, index: u32, is_plain: bool) -> Result<String, String> {
        match self.inner(base) {
            TypeInner::Struct { members, .. } => {
                let name = members[index as usize].name.clone().unwrap_or_default();
                Ok(format!("{}.{name}", self.operand(base, is_plain)?))
            }
            _ => self.part(base, &index.to_string(), is_plain),
        }
    }

    /// An element of an array, a column or a component.
    fn part(&mut self, base: Value, index: &str, is_plain: bool) -> Result<String, String> {
        let dialect = self.dialect(is_plain);
        let text = self.operand(base, is_plain)?;
        Ok(match self.shape(base) {
            Some(Shape::Vector(_)) => dialect.component(&text, index),
            _ => format!("{text}[{index}]"),
        })
    }

    fn load(&mut self, value: Value, pointer: Value, is_plain: bool) -> Result<String, String> {
        let place = self.place(pointer)?;
        if is_plain && !place.is_plain {
            return Err("a clip position comes of a variable".into());
        }
        let text = match &place.component {
            Some(index) => Dialect::Pair.component(&place.text, index),
            None => place.text,
        };
        if is_plain || !place.is_plain { Ok(text) } else { self.raise(value, &text) }
    }

    /// A texture's level as a further argument.
    fn level(&mut self, level: Option<Value>) -> Result<String, String> {
        level.map_or(Ok(String::new()), |level| Ok(format!(", {}", self.value(level)?)))
    }

    fn unary(&mut self, op: UnaryOperator, of: Value, is_plain: bool) -> Result<String, String> {
        let text = self.operand(of, is_plain)?;
        match (op, self.shape(of)) {
            (UnaryOperator::Negate, Some(shape)) if self.dialect(is_plain) == Dialect::Pair => {
                Ok(format!("DF{}(-{text}.hi, -{text}.lo)", shape.width()))
            }
            (UnaryOperator::Negate, _) => Ok(format!("(-{text})")),
            (UnaryOperator::LogicalNot, _) => Ok(format!("(!{text})")),
            (UnaryOperator::BitwiseNot, _) => Ok(format!("(~{text})")),
        }
    }

    fn binary(&mut self, op: BinaryOperator, left: Value, right: Value, is_plain: bool) -> Result<String, String> {
        let (a, b) = (self.operand(left, is_plain)?, self.operand(right, is_plain)?);
        match (self.shape(left), self.shape(right)) {
            (Some(left), Some(right)) if self.dialect(is_plain) == Dialect::Pair => {
                pair::operation(op, (left, &a), (right, &b))
            }
            _ => Ok(format!("({a} {} {b})", operator(op))),
        }
    }

    fn select(&mut self, condition: Value, accept: Value, reject: Value, is_plain: bool) -> Result<String, String> {
        let condition = self.operand(condition, is_plain)?;
        let (a, r) = (self.operand(accept, is_plain)?, self.operand(reject, is_plain)?);
        match self.shape(accept) {
            Some(shape) if self.dialect(is_plain) == Dialect::Pair => Ok(format!(
                "DF{}(select({r}.hi, {a}.hi, {condition}), select({r}.lo, {a}.lo, {condition}))",
                shape.width()
            )),
            _ => Ok(format!("select({r}, {a}, {condition})")),
        }
    }

    /// A value of f32 taken into the rung.
    pub(super) fn raise(&mut self, value: Value, text: &str) -> Result<String, String> {
        match (self.shape(value), self.handle(value)) {
            (Some(shape), _) => Ok(self.writer.dialect.up(shape, text)),
            (None, Some(ty)) => self.writer.convert(ty, text, true),
            (None, None) => Ok(text.into()),
        }
    }

    fn cast(&mut self, from: Value, kind: ScalarKind, converts: bool, is_plain: bool) -> Result<String, String> {
        let dialect = self.dialect(is_plain);
        let text = self.operand(from, is_plain)?;
        let (from_kind, size) = match *self.inner(from) {
            TypeInner::Scalar(scalar) => (scalar.kind, None),
            TypeInner::Vector { size, scalar } => (scalar.kind, Some(size as u8)),
            _ => return Err("a matrix is converted".into()),
        };
        let width = size.unwrap_or(1);
        let of = |name: &str| size.map_or_else(|| name.to_owned(), |size| format!("vec{size}<{name}>"));
        let (was_float, is_float) = (from_kind == ScalarKind::Float, kind == ScalarKind::Float);
        if !converts {
            if (was_float || is_float) && dialect != Dialect::Single {
                return Err(READS_BITS.into());
            }
            return Ok(format!("bitcast<{}>({text})", of(integer(kind))));
        }
        match (was_float, is_float) {
            (true, true) => Ok(text),
            (false, false) => Ok(format!("{}({text})", of(integer(kind)))),
            (false, true) if dialect == Dialect::Pair && from_kind != ScalarKind::Bool => {
                Ok(format!("rung_from_{}_{width}({text})", integer(from_kind)))
            }
            (false, true) if dialect == Dialect::Pair => {
                Ok(format!("DF{width}({0}({text}), {0}())", plain_vector(width)))
            }
            (false, true) => Ok(format!("{}({text})", dialect.type_of(size.map_or(Shape::Scalar, Shape::Vector)))),
            (true, false) if dialect == Dialect::Pair && kind != ScalarKind::Bool => {
                Ok(format!("rung_to_{}_{width}({text})", integer(kind)))
            }
            (true, false) if dialect == Dialect::Pair => Err("a number is taken for a condition".into()),
            (true, false) => Ok(format!("{}({text})", of(integer(kind)))),
        }
    }
}
