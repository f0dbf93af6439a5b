//! Expressions as nodes.

use super::memory::{Place, Pointer, State, Variable};
use super::{Frame, Lowering, Symbol};
use crate::graph::{Binary, Function as Call, NodeId, Origin, Type};
use naga::{AddressSpace, BinaryOperator, Expression, Handle, Literal, MathFunction, ScalarKind, Span, TypeInner};
use smallvec::smallvec;
use std::rc::Rc;

impl<'a> Lowering<'a> {
    #[expect(clippy::cast_precision_loss, reason = "no shader's constant is so long an integer")]
    fn literal(&mut self, literal: Literal) -> NodeId {
        let (ty, number) = match literal {
            Literal::F64(x) | Literal::AbstractFloat(x) => (Type::Float(1), x),
            Literal::F32(x) => (Type::Float(1), f64::from(x)),
            Literal::F16(x) => (Type::Float(1), f64::from(x.to_f32())),
            Literal::U32(x) => (Type::Int(1), f64::from(x)),
            Literal::I32(x) => (Type::Int(1), f64::from(x)),
            Literal::U16(x) => (Type::Int(1), f64::from(x)),
            Literal::I16(x) => (Type::Int(1), f64::from(x)),
            Literal::U64(x) => (Type::Int(1), x as f64),
            Literal::I64(x) | Literal::AbstractInt(x) => (Type::Int(1), x as f64),
            Literal::Bool(x) => (Type::Bool(1), f64::from(u8::from(x))),
        };
        self.graph.constant(ty, &[number])
    }

    pub(super) fn constant_expression(&mut self, handle: Handle<Expression>) -> Symbol {
        let module = self.module;
        match &module.global_expressions[handle] {
            Expression::Literal(literal) => Symbol::Value(self.literal(*literal)),
            Expression::Constant(constant) => self.constant_expression(module.constants[*constant].init),
            Expression::Override(own) => self.override_of(*own),
            Expression::ZeroValue(ty) => self.zero(*ty),
            Expression::Compose { ty, components } => {
                let parts: Vec<Symbol> = components.iter().map(|own| self.constant_expression(*own)).collect();
                self.composed(*ty, parts)
            }
            Expression::Splat { size, value } => match self.constant_expression(*value) {
                Symbol::Value(id) => Symbol::Value(self.graph.splat(id, *size as u8)),
                other => other,
            },
            _ => Symbol::Nothing,
        }
    }

    fn override_of(&mut self, own: Handle<naga::Override>) -> Symbol {
        let own = &self.module.overrides[own];
        let name = own.name.clone().unwrap_or_default();
        self.fresh(own.ty, &name, Origin::Uniform)
    }

    fn composed(&mut self, ty: Handle<naga::Type>, parts: Vec<Symbol>) -> Symbol {
        let inner = &self.module.types[ty].inner;
        if !matches!(inner, TypeInner::Vector { .. } | TypeInner::Matrix { .. }) {
            return Symbol::Parts(Rc::new(parts));
        }
        let id = |part: &Symbol| if let Symbol::Value(id) = part { Some(*id) } else { None };
        let Some(ids) = parts.iter().map(id).collect::<Option<Vec<NodeId>>>() else { return Symbol::Nothing };
        let TypeInner::Matrix { columns, rows, .. } = inner else { return Symbol::Value(self.graph.vector(&ids)) };
        let columns = if ids.len() == *columns as usize {
            ids.into_iter().collect()
        } else {
            ids.chunks(*rows as usize).map(|column| self.graph.vector(column)).collect()
        };
        Symbol::Value(self.graph.matrix(columns))
    }

    /// Where an expression stands. naga leaves it out of some, whose operands have it.
    fn line_of(&self, frame: &Frame<'a>, handle: Handle<Expression>) -> u32 {
        let line = |span: Span| if span.is_defined() { self.declared.line(span) } else { 0 };
        let expressions = &frame.function.expressions;
        let own = line(expressions.get_span(handle));
        if own > 0 {
            return own;
        }
        let (mut last, mut todo) = (0, operands(&expressions[handle]));
        for _ in 0..40 {
            let Some(next) = todo.pop() else { break };
            let is_name = matches!(
                expressions[next],
                Expression::LocalVariable(_) | Expression::GlobalVariable(_) | Expression::FunctionArgument(_)
            );
            match line(expressions.get_span(next)) {
                _ if is_name => {}
                0 => todo.extend(operands(&expressions[next])),
                own => last = last.max(own),
            }
        }
        last
    }

    /// The value of an expression, as the numbers that it has.
    fn value(&mut self, frame: &mut Frame<'a>, state: &State, handle: Handle<Expression>) -> NodeId {
        if let Symbol::Value(id) = self.expression(frame, state, handle) {
            return id;
        }
        self.note("a value of a kind that is not looked at");
        self.graph.leaf("?", Type::Float(1), Origin::BuiltIn)
    }

    pub(super) fn expression(&mut self, frame: &mut Frame<'a>, state: &State, handle: Handle<Expression>) -> Symbol {
        if let Some(known) = frame.values.get(&handle) {
            return known.clone();
        }
        let found = self.made(frame, state, handle);
        frame.values.insert(handle, found.clone());
        found
    }

    #[expect(clippy::too_many_lines, reason = "one arm for each kind of expression")]
    fn made(&mut self, frame: &mut Frame<'a>, state: &State, handle: Handle<Expression>) -> Symbol {
        let function = frame.function;
        let line = self.line_of(frame, handle);
        match &function.expressions[handle] {
            Expression::Literal(literal) => Symbol::Value(self.literal(*literal)),
            Expression::Constant(constant) => self.constant_expression(self.module.constants[*constant].init),
            Expression::Override(own) => self.override_of(*own),
            Expression::ZeroValue(ty) => self.zero(*ty),
            Expression::Compose { ty, components } => {
                let parts: Vec<Symbol> = components.iter().map(|own| self.expression(frame, state, *own)).collect();
                self.graph.line = line;
                self.composed(*ty, parts)
            }
            Expression::Access { base, index } => {
                let index = self.value(frame, state, *index);
                self.accessed(frame, state, *base, Place::Computed(index))
            }
            Expression::AccessIndex { base, index } => self.accessed(frame, state, *base, Place::At(*index)),
            Expression::Splat { size, value } => {
                let value = self.value(frame, state, *value);
                Symbol::Value(self.graph.splat(value, *size as u8))
            }
            Expression::Swizzle { size, vector, pattern } => {
                let vector = self.value(frame, state, *vector);
                let pattern: Vec<u8> = pattern[..*size as usize].iter().map(|own| *own as u8).collect();
                // naga's reader of GLSL lets this pass where a name hides another.
                let length = self.graph.ty(vector).length();
                if pattern.iter().any(|own| usize::from(*own) >= length) {
                    return Symbol::Value(self.opaque("components", vector));
                }
                self.graph.line = line;
                Symbol::Value(self.graph.swizzle(vector, &pattern))
            }
            Expression::FunctionArgument(k) => frame.arguments.get(*k as usize).cloned().unwrap_or(Symbol::Nothing),
            Expression::GlobalVariable(global) => {
                if self.module.global_variables[*global].space == AddressSpace::Handle {
                    return Symbol::Resource(self.global_name(*global));
                }
                Symbol::Pointer(Pointer { variable: Variable::Global(*global), path: vec![] })
            }
            Expression::LocalVariable(local) => {
                Symbol::Pointer(Pointer { variable: Variable::Local(frame.number, *local), path: vec![] })
            }
            Expression::Load { pointer } => match self.expression(frame, state, *pointer) {
                Symbol::Pointer(pointer) => self.load(state, &pointer, Some(function)),
                other => other,
            },
            Expression::ImageSample { image, coordinate, depth_ref, .. } => {
                let at = self.value(frame, state, *coordinate);
                let at = self.graph.text(at, 2);
                self.of_texture(
                    frame,
                    state,
                    *image,
                    &format!(", {at}"),
                    Type::Float(if depth_ref.is_some() { 1 } else { 4 }),
                )
            }
            Expression::ImageLoad { image, .. } => self.of_texture(frame, state, *image, "", Type::Float(4)),
            Expression::ImageQuery { image, query } => {
                let n = if matches!(query, naga::ImageQuery::Size { .. }) { 2 } else { 1 };
                self.of_texture(frame, state, *image, ", size", Type::Int(n))
            }
            Expression::Unary { op, expr } => {
                let x = self.value(frame, state, *expr);
                self.graph.line = line;
                Symbol::Value(match op {
                    naga::UnaryOperator::Negate => self.graph.negate(x),
                    naga::UnaryOperator::LogicalNot => self.graph.not(x),
                    naga::UnaryOperator::BitwiseNot => self.opaque("not", x),
                })
            }
            Expression::Binary { op, left, right } => {
                let (a, b) = (self.value(frame, state, *left), self.value(frame, state, *right));
                self.graph.line = line;
                Symbol::Value(self.operation(*op, a, b))
            }
            Expression::Select { condition, accept, reject } => {
                let condition = self.value(frame, state, *condition);
                let (yes, no) = (self.value(frame, state, *accept), self.value(frame, state, *reject));
                self.graph.line = line;
                Symbol::Value(self.graph.select(condition, yes, no))
            }
            Expression::Derivative { expr, .. } => {
                let x = self.value(frame, state, *expr);
                Symbol::Value(self.opaque("derivative", x))
            }
            Expression::Relational { fun, argument } => {
                let x = self.value(frame, state, *argument);
                Symbol::Value(match fun {
                    naga::RelationalFunction::All => self.graph.call(Call::All, smallvec![x]),
                    naga::RelationalFunction::Any => self.graph.call(Call::Any, smallvec![x]),
                    _ => {
                        let ty = Type::Bool(self.graph.ty(x).width());
                        self.graph.constant(ty, &vec![0.0; ty.length()])
                    }
                })
            }
            Expression::Math { fun, arg, arg1, arg2, .. } => {
                let arguments = [Some(*arg), *arg1, *arg2];
                let x: Vec<NodeId> = arguments.into_iter().flatten().map(|own| self.value(frame, state, own)).collect();
                self.graph.line = line;
                Symbol::Value(self.built_in(*fun, &x))
            }
            Expression::As { expr, kind, convert } => {
                let x = self.value(frame, state, *expr);
                Symbol::Value(if convert.is_some() { self.converted(x, *kind) } else { self.opaque("bits", x) })
            }
            Expression::ArrayLength(_) => Symbol::Value(self.graph.leaf("length", Type::Int(1), Origin::Uniform)),
            _ => Symbol::Nothing,
        }
    }

    fn accessed(&mut self, frame: &mut Frame<'a>, state: &State, base: Handle<Expression>, place: Place) -> Symbol {
        match self.expression(frame, state, base) {
            Symbol::Pointer(mut pointer) => {
                pointer.path.push(match place {
                    Place::Computed(id) => self.graph.number_of(id).map_or(place, |number| Place::At(whole(number))),
                    at @ Place::At(_) => at,
                });
                Symbol::Pointer(pointer)
            }
            value => self.part(&value, place),
        }
    }

    fn of_texture(
        &mut self,
        frame: &mut Frame<'a>,
        state: &State,
        image: Handle<Expression>,
        at: &str,
        ty: Type,
    ) -> Symbol {
        let Symbol::Resource(name) = self.expression(frame, state, image) else { return Symbol::Nothing };
        Symbol::Value(self.graph.leaf(&format!("texture({name}{at})"), ty, Origin::Texture))
    }

    /// A value of which only is known what it is made of.
    fn opaque(&mut self, what: &str, x: NodeId) -> NodeId {
        let (ty, text) = (self.graph.ty(x), self.graph.text(x, 2));
        self.graph.leaf(&format!("{what}({text})"), ty, Origin::BuiltIn)
    }

    fn operation(&mut self, op: BinaryOperator, a: NodeId, b: NodeId) -> NodeId {
        use BinaryOperator as O;
        let op = match op {
            O::Add => Binary::Add,
            O::Subtract => Binary::Subtract,
            O::Multiply => Binary::Multiply,
            O::Divide => Binary::Divide,
            O::Modulo => Binary::Remainder,
            O::Equal => Binary::Equal,
            O::NotEqual => Binary::NotEqual,
            O::Less => Binary::Less,
            O::LessEqual => Binary::LessEqual,
            O::Greater => Binary::Greater,
            O::GreaterEqual => Binary::GreaterEqual,
            O::LogicalAnd => Binary::And,
            O::LogicalOr => Binary::Or,
            O::And | O::InclusiveOr | O::ExclusiveOr if matches!(self.graph.ty(a), Type::Bool(_)) => match op {
                O::And => Binary::And,
                O::InclusiveOr => Binary::Or,
                _ => Binary::NotEqual,
            },
            // Bits of integers are no part of a step.
            O::And | O::InclusiveOr | O::ExclusiveOr | O::ShiftLeft | O::ShiftRight => return self.opaque("bits", a),
        };
        self.graph.binary(op, a, b)
    }

    fn converted(&mut self, x: NodeId, kind: ScalarKind) -> NodeId {
        let ty = self.graph.ty(x);
        let n = ty.width();
        let is_float = matches!(kind, ScalarKind::Float | ScalarKind::AbstractFloat);
        match (ty, kind) {
            (Type::Matrix(..), _) | (Type::Bool(_), ScalarKind::Bool) => x,
            (Type::Float(_), _) if is_float => x,
            (Type::Float(_) | Type::Int(_), ScalarKind::Bool) => {
                let zero = self.graph.constant(ty.of_length(1), &[0.0]);
                self.graph.binary(Binary::NotEqual, x, zero)
            }
            (Type::Float(_), _) => self.graph.call(Call::ToInt, smallvec![x]),
            (Type::Bool(_), _) => {
                let ty = if is_float { Type::Float(n) } else { Type::Int(n) };
                let (one, zero) = (vec![1.0; ty.length()], vec![0.0; ty.length()]);
                let (one, zero) = (self.graph.constant(ty, &one), self.graph.constant(ty, &zero));
                self.graph.select(x, one, zero)
            }
            (Type::Int(_), _) if is_float => match self.graph.constant_of(x) {
                Some(value) => self.graph.constant(Type::Float(n), value.components()),
                None => {
                    let text = self.graph.text(x, 3);
                    self.graph.leaf(&format!("float({text})"), Type::Float(n), Origin::Uniform)
                }
            },
            (Type::Int(_), _) => x,
        }
    }

    #[expect(clippy::too_many_lines, reason = "one arm for each built-in function")]
    fn built_in(&mut self, function: MathFunction, x: &[NodeId]) -> NodeId {
        use MathFunction as M;
        let graph = &mut self.graph;
        let plain = match function {
            M::Abs => Call::Abs,
            M::Min => Call::Min,
            M::Max => Call::Max,
            M::Cos => Call::Cos,
            M::Sin => Call::Sin,
            M::Tan => Call::Tan,
            M::Acos => Call::Acos,
            M::Asin => Call::Asin,
            M::Atan | M::Atan2 => Call::Atan,
            M::Ceil => Call::Ceil,
            M::Floor => Call::Floor,
            M::Round => Call::Round,
            M::Fract => Call::Fract,
            M::Trunc => Call::Trunc,
            M::Exp => Call::Exp,
            M::Exp2 => Call::Exp2,
            M::Log => Call::Log,
            M::Log2 => Call::Log2,
            M::Pow => Call::Pow,
            M::Dot => Call::Dot,
            M::Cross => Call::Cross,
            M::Length => Call::Length,
            M::Normalize => Call::Normalize,
            M::Reflect => Call::Reflect,
            M::FaceForward => Call::FaceForward,
            M::Sign => Call::Sign,
            M::Mix => Call::Mix,
            M::Step => Call::Step,
            M::SmoothStep => Call::Smoothstep,
            M::Sqrt => Call::Sqrt,
            M::Transpose => Call::Transpose,
            M::Determinant => Call::Determinant,
            M::Inverse => Call::Inverse,
            M::Clamp => return graph.clamp(x[0], x[1], x[2]),
            M::Saturate => {
                let (zero, one) = (graph.number(0.0), graph.number(1.0));
                return graph.clamp(x[0], zero, one);
            }
            M::InverseSqrt => {
                let root = graph.call(Call::Sqrt, smallvec![x[0]]);
                let one = graph.number(1.0);
                return graph.binary(Binary::Divide, one, root);
            }
            M::Distance => {
                let difference = graph.binary(Binary::Subtract, x[0], x[1]);
                return graph.call(Call::Length, smallvec![difference]);
            }
            M::Fma => {
                let product = graph.binary(Binary::Multiply, x[0], x[1]);
                return graph.binary(Binary::Add, product, x[2]);
            }
            M::Radians => {
                let factor = graph.number(std::f64::consts::PI / 180.0);
                return graph.binary(Binary::Multiply, x[0], factor);
            }
            M::Degrees => {
                let factor = graph.number(180.0 / std::f64::consts::PI);
                return graph.binary(Binary::Multiply, x[0], factor);
            }
            other => return self.opaque(&format!("{other:?}").to_lowercase(), x[0]),
        };
        graph.call(plain, x.iter().copied().collect())
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "held within what an array may have")]
fn whole(number: f64) -> u32 {
    number.clamp(0.0, 65_536.0) as u32
}

fn operands(expression: &Expression) -> Vec<Handle<Expression>> {
    match expression {
        Expression::Compose { components, .. } => components.clone(),
        Expression::Access { base, index } => vec![*base, *index],
        Expression::AccessIndex { base, .. } => vec![*base],
        Expression::Splat { value, .. } => vec![*value],
        Expression::Swizzle { vector, .. } => vec![*vector],
        Expression::Load { pointer } => vec![*pointer],
        Expression::Unary { expr, .. } | Expression::As { expr, .. } | Expression::Derivative { expr, .. } => {
            vec![*expr]
        }
        Expression::Binary { left, right, .. } => vec![*left, *right],
        Expression::Select { condition, accept, reject } => vec![*condition, *accept, *reject],
        Expression::Relational { argument, .. } => vec![*argument],
        Expression::Math { arg, arg1, arg2, arg3, .. } => {
            [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().collect()
        }
        _ => vec![],
    }
}
