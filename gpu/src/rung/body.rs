//! A function's statements and expressions in a rung's arithmetic.

use super::dialect::{Dialect, Shape, plain_vector};
use super::writer::{READS_BITS, Writer, integer, is_position, literal, shape_of};
use naga::common::wgsl::TryToWgsl as _;
use naga::front::Typifier;
use naga::proc::{ResolveContext, TypeResolution};
use naga::{
    AddressSpace, BinaryOperator, Block, EntryPoint, Expression, Function, Handle, ImageQuery, LocalVariable,
    MathFunction, RelationalFunction, ScalarKind, Statement, SwitchValue, Type, TypeInner, UnaryOperator,
};
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

type Value = Handle<Expression>;

/// Built-in functions that drivers get right in f64.
const RIGHT_IN_F64: [&str; 14] = [
    "abs",
    "sign",
    "floor",
    "ceil",
    "trunc",
    "round",
    "min",
    "max",
    "clamp",
    "dot",
    "cross",
    "sqrt",
    "inverseSqrt",
    "mix",
];
/// Built-in functions of vectors that are not those of their components.
const OF_VECTORS: [&str; 8] = ["dot", "cross", "length", "distance", "normalize", "reflect", "refract", "faceForward"];

/// Where something is kept.
struct Place {
    text: String,
    /// The component of a vector, where that is a pair of vectors.
    component: Option<String>,
    /// Whether f32 is kept there.
    is_plain: bool,
    /// Whether it is a clip position.
    is_position: bool,
}

pub(super) struct Body<'w, 'a> {
    writer: &'w mut Writer<'a>,
    function: &'w Function,
    entry: Option<&'w EntryPoint>,
    types: Typifier,
    /// Names of what was evaluated.
    bound: HashMap<Value, String>,
    /// The same of what is evaluated in f32.
    bound_plain: HashMap<Value, String>,
    /// What a clip position comes of.
    behind_position: HashSet<Value>,
    /// What is bound as f32, being an entry point's result.
    raw: HashSet<Value>,
    out: String,
    depth: usize,
}

impl<'w, 'a> Body<'w, 'a> {
    pub(super) fn new(
        writer: &'w mut Writer<'a>,
        function: &'w Function,
        entry: Option<&'w EntryPoint>,
    ) -> Result<Self, String> {
        let mut types = Typifier::new();
        let context = ResolveContext::with_locals(writer.module, &function.local_variables, &function.arguments);
        for (handle, _) in function.expressions.iter() {
            types.grow(handle, &function.expressions, &context).map_err(|error| error.to_string())?;
        }
        let mut body = Self {
            writer,
            function,
            entry,
            types,
            bound: HashMap::new(),
            bound_plain: HashMap::new(),
            behind_position: HashSet::new(),
            raw: HashSet::new(),
            out: String::new(),
            depth: 1,
        };
        if body.gives_position() {
            body.find_position(&function.body)?;
        }
        Ok(body)
    }

    pub(super) fn write(mut self) -> Result<String, String> {
        for (handle, local) in self.function.local_variables.iter() {
            let is_plain = self.is_result(handle);
            let ty = self.writer.type_name(local.ty, is_plain)?;
            let init = match local.init {
                None => String::new(),
                Some(init) if is_plain => match self.function.expressions[init] {
                    Expression::ZeroValue(_) => String::new(),
                    _ => return Err("a result begins with a value".into()),
                },
                Some(init) => format!(" = {}", self.value(init)?),
            };
            self.line(&format!("var {}: {ty}{init};", local_name(handle)));
        }
        self.block(&self.function.body)?;
        Ok(self.out)
    }

    fn line(&mut self, text: &str) {
        let _ = writeln!(self.out, "{:width$}{text}", "", width = 4 * self.depth);
    }

    fn block(&mut self, block: &Block) -> Result<(), String> {
        block.iter().try_for_each(|statement| self.statement(statement))
    }

    fn nested(&mut self, head: &str, block: &Block) -> Result<(), String> {
        self.line(&format!("{head} {{"));
        self.depth += 1;
        self.block(block)?;
        self.depth -= 1;
        self.line("}");
        Ok(())
    }

    fn statement(&mut self, statement: &Statement) -> Result<(), String> {
        match statement {
            Statement::Emit(range) => range.clone().try_for_each(|value| self.evaluate(value))?,
            Statement::Block(block) => self.nested("", block)?,
            Statement::If { condition, accept, reject } => {
                let condition = self.value(*condition)?;
                self.nested(&format!("if {condition}"), accept)?;
                if !reject.is_empty() {
                    self.nested("else", reject)?;
                }
            }
            Statement::Switch { selector, cases } => {
                let selector = self.value(*selector)?;
                self.line(&format!("switch {selector} {{"));
                self.depth += 1;
                let mut labels = vec![];
                for case in cases {
                    labels.push(match case.value {
                        SwitchValue::I32(value) => format!("{value}i"),
                        SwitchValue::U32(value) => format!("{value}u"),
                        SwitchValue::Default => "default".into(),
                    });
                    if case.fall_through && case.body.is_empty() {
                        continue;
                    }
                    if case.fall_through {
                        return Err("a case falls through".into());
                    }
                    self.nested(&format!("case {}:", std::mem::take(&mut labels).join(", ")), &case.body)?;
                }
                self.depth -= 1;
                self.line("}");
            }
            Statement::Loop { body, continuing, break_if } => {
                self.line("loop {");
                self.depth += 1;
                self.block(body)?;
                if !continuing.is_empty() || break_if.is_some() {
                    self.line("continuing {");
                    self.depth += 1;
                    self.block(continuing)?;
                    if let Some(condition) = break_if {
                        let condition = self.value(*condition)?;
                        self.line(&format!("break if {condition};"));
                    }
                    self.depth -= 1;
                    self.line("}");
                }
                self.depth -= 1;
                self.line("}");
            }
            Statement::Break => self.line("break;"),
            Statement::Continue => self.line("continue;"),
            Statement::Kill => self.line("discard;"),
            Statement::Return { value } => {
                let value = value.map_or(Ok(String::new()), |value| self.returned(value))?;
                self.line(&format!("return {value};"));
            }
            Statement::Store { pointer, value } => self.store(*pointer, *value)?,
            Statement::Call { function, arguments, result } => self.call(*function, arguments, *result)?,
            other => return Err(format!("a statement that is not lowered: {other:?}")),
        }
        Ok(())
    }

    fn call(&mut self, function: Handle<Function>, arguments: &[Value], result: Option<Value>) -> Result<(), String> {
        let own = self.function.name.clone().unwrap_or_default();
        let called = self.writer.module.functions[function].name.clone().unwrap_or_default();
        let target = self.writer.target(&called, &own);
        let mut texts = vec![];
        for &argument in arguments {
            texts.push(if self.is_pointer(argument) {
                let place = self.place(argument)?;
                if place.is_plain || place.component.is_some() {
                    return Err("a pointer to what is kept in f32 is passed".into());
                }
                format!("&{}", place.text)
            } else {
                self.value(argument)?
            });
        }
        let call = format!("{target}({})", texts.join(", "));
        match result {
            Some(result) => self.bind(result, &call),
            None => self.line(&format!("{call};")),
        }
        Ok(())
    }

    fn store(&mut self, pointer: Value, value: Value) -> Result<(), String> {
        let place = self.place(pointer)?;
        let text = if place.is_position { self.plain(value)? } else { self.value(value)? };
        if let Some(index) = place.component {
            for part in ["hi", "lo"] {
                self.line(&format!("{}.{part}[{index}] = {text}.{part};", place.text));
            }
            return Ok(());
        }
        let text = if place.is_plain && !place.is_position {
            match (self.shape(value), self.handle(value)) {
                (Some(shape), _) => self.writer.dialect.down(shape, &text),
                (None, Some(ty)) => self.writer.convert(ty, &text, false)?,
                (None, None) => text,
            }
        } else {
            text
        };
        self.line(&format!("{} = {text};", place.text));
        Ok(())
    }

    /// What is returned: an entry point's result is f32.
    fn returned(&mut self, value: Value) -> Result<String, String> {
        let Some(result) = self.entry.and_then(|entry| entry.function.result.as_ref()) else {
            return self.value(value);
        };
        if self.raw.contains(&value) {
            return Ok(self.bound[&value].clone());
        }
        if result.binding.as_ref().is_some_and(is_position) {
            return self.plain(value);
        }
        let text = self.value(value)?;
        self.writer.convert(result.ty, &text, false)
    }

    /// Binds an expression to a name where naga evaluates it.
    fn evaluate(&mut self, value: Value) -> Result<(), String> {
        if self.is_pointer(value) {
            return Ok(());
        }
        if self.behind_position.contains(&value) {
            let text = self.compute(value, true)?;
            let name = format!("_p{}", value.index());
            self.line(&format!("let {name} = {text};"));
            self.bound_plain.insert(value, name);
        }
        let text = match &self.function.expressions[value] {
            Expression::Load { pointer } if self.is_whole_result(*pointer) => {
                self.raw.insert(value);
                self.place(*pointer)?.text
            }
            Expression::Compose { ty, components } if self.gives_position() && self.is_result_type(*ty) => {
                self.raw.insert(value);
                self.compose_result(*ty, components)?
            }
            _ => self.compute(value, false)?,
        };
        self.bind(value, &text);
        Ok(())
    }

    fn bind(&mut self, value: Value, text: &str) {
        let name = format!("_e{}", value.index());
        self.line(&format!("let {name} = {text};"));
        self.bound.insert(value, name);
    }

    fn compose_result(&mut self, ty: Handle<Type>, components: &[Value]) -> Result<String, String> {
        let mut parts = vec![];
        let TypeInner::Struct { members, .. } = &self.writer.module.types[ty].inner else {
            return Err("a result that is no struct".into());
        };
        for (member, &component) in members.iter().zip(components) {
            parts.push(if member.binding.as_ref().is_some_and(is_position) {
                self.plain(component)?
            } else {
                let text = self.value(component)?;
                self.writer.convert(member.ty, &text, false)?
            });
        }
        Ok(format!("{}({})", self.writer.type_name(ty, true)?, parts.join(", ")))
    }

    /// A value in the rung.
    fn value(&mut self, value: Value) -> Result<String, String> {
        match self.bound.get(&value).cloned() {
            Some(name) if self.raw.contains(&value) => {
                self.handle(value).map_or(Ok(name.clone()), |ty| self.writer.convert(ty, &name, true))
            }
            Some(name) => Ok(name),
            None => self.compute(value, false),
        }
    }

    /// A value in f32, of what a clip position comes of.
    fn plain(&mut self, value: Value) -> Result<String, String> {
        match self.bound_plain.get(&value) {
            Some(name) => Ok(name.clone()),
            None => self.compute(value, true),
        }
    }

    fn operand(&mut self, value: Value, is_plain: bool) -> Result<String, String> {
        if is_plain { self.plain(value) } else { self.value(value) }
    }

    fn compute(&mut self, value: Value, is_plain: bool) -> Result<String, String> {
        let dialect = if is_plain { Dialect::Single } else { self.writer.dialect };
        let is_pair = dialect == Dialect::Pair;
        let module = self.writer.module;
        match self.function.expressions[value].clone() {
            Expression::Literal(value) => literal(value, dialect),
            Expression::Constant(constant) => self.writer.constant(module.constants[constant].init, dialect),
            Expression::ZeroValue(ty) => Ok(format!("{}()", self.writer.type_name(ty, is_plain)?)),
            Expression::Compose { ty, components } => {
                let parts: Vec<String> =
                    components.iter().map(|part| self.operand(*part, is_plain)).collect::<Result<_, _>>()?;
                if is_pair && let Some(Shape::Vector(size)) = shape_of(&module.types[ty].inner) {
                    return Ok(self.pair_of(size, &parts));
                }
                Ok(format!("{}({})", self.writer.type_name(ty, is_plain)?, parts.join(", ")))
            }
            Expression::Splat { size, value: one } => {
                let text = self.operand(one, is_plain)?;
                match self.shape(one) {
                    Some(_) => Ok(splat(dialect, size as u8, &text)),
                    None => Ok(format!("vec{}({text})", size as u8)),
                }
            }
            Expression::Swizzle { size, vector, pattern } => {
                let is_float = self.shape(vector).is_some();
                let vector = self.operand(vector, is_plain)?;
                let letters: String =
                    pattern[..size as usize].iter().map(|c| char::from(b"xyzw"[*c as usize])).collect();
                if is_pair && is_float {
                    return Ok(format!("DF{}({vector}.hi.{letters}, {vector}.lo.{letters})", size as u8));
                }
                Ok(format!("{vector}.{letters}"))
            }
            Expression::Access { base, index } => {
                let index = self.value(index)?;
                self.part(base, &index, is_plain)
            }
            Expression::AccessIndex { base, index } => match self.inner(base) {
                TypeInner::Struct { members, .. } => {
                    let name = members[index as usize].name.clone().unwrap_or_default();
                    Ok(format!("{}.{name}", self.operand(base, is_plain)?))
                }
                _ => self.part(base, &index.to_string(), is_plain),
            },
            Expression::FunctionArgument(k) if is_plain => Ok(format!("_i{k}")),
            Expression::FunctionArgument(k) => Ok(format!("_a{k}")),
            Expression::GlobalVariable(global) => Ok(module.global_variables[global].name.clone().unwrap_or_default()),
            Expression::Load { pointer } => {
                let place = self.place(pointer)?;
                if is_plain && !place.is_plain {
                    return Err("a clip position comes of a variable".into());
                }
                let text = place
                    .component
                    .as_ref()
                    .map_or_else(|| place.text.clone(), |index| Dialect::Pair.component(&place.text, index));
                if is_plain || !place.is_plain { Ok(text) } else { self.raise(value, &text) }
            }
            Expression::ImageLoad { image, coordinate, array_index: None, sample: None, level } => {
                let (image, coordinate) = (self.value(image)?, self.value(coordinate)?);
                let level =
                    level.map_or(Ok(String::new()), |level| Ok::<_, String>(format!(", {}", self.value(level)?)))?;
                self.raise(value, &format!("textureLoad({image}, {coordinate}{level})"))
            }
            Expression::ImageQuery { image, query: ImageQuery::Size { level } } => {
                let image = self.value(image)?;
                let level =
                    level.map_or(Ok(String::new()), |level| Ok::<_, String>(format!(", {}", self.value(level)?)))?;
                Ok(format!("textureDimensions({image}{level})"))
            }
            Expression::Unary { op, expr } => {
                let text = self.operand(expr, is_plain)?;
                match (op, self.shape(expr)) {
                    (UnaryOperator::Negate, Some(shape)) if is_pair => {
                        Ok(format!("DF{}(-{text}.hi, -{text}.lo)", shape.width()))
                    }
                    (UnaryOperator::Negate, _) => Ok(format!("(-{text})")),
                    (UnaryOperator::LogicalNot, _) => Ok(format!("(!{text})")),
                    (UnaryOperator::BitwiseNot, _) => Ok(format!("(~{text})")),
                }
            }
            Expression::Binary { op, left, right } => {
                let (a, b) = (self.operand(left, is_plain)?, self.operand(right, is_plain)?);
                match (self.shape(left), self.shape(right)) {
                    (Some(left), Some(right)) if is_pair => self.pair_operation(op, (left, &a), (right, &b)),
                    _ => Ok(format!("({a} {} {b})", operator(op))),
                }
            }
            Expression::Select { condition, accept, reject } => {
                let condition = self.operand(condition, is_plain)?;
                let (a, r) = (self.operand(accept, is_plain)?, self.operand(reject, is_plain)?);
                match self.shape(accept) {
                    Some(shape) if is_pair => Ok(format!(
                        "DF{}(select({r}.hi, {a}.hi, {condition}), select({r}.lo, {a}.lo, {condition}))",
                        shape.width()
                    )),
                    _ => Ok(format!("select({r}, {a}, {condition})")),
                }
            }
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

    /// A value of f32 taken into the rung.
    fn raise(&mut self, value: Value, text: &str) -> Result<String, String> {
        match (self.shape(value), self.handle(value)) {
            (Some(shape), _) => Ok(self.writer.dialect.up(shape, text)),
            (None, Some(ty)) => self.writer.convert(ty, text, true),
            (None, None) => Ok(text.into()),
        }
    }

    /// An element of an array, a column or a component.
    fn part(&mut self, base: Value, index: &str, is_plain: bool) -> Result<String, String> {
        let dialect = if is_plain { Dialect::Single } else { self.writer.dialect };
        let text = self.operand(base, is_plain)?;
        Ok(match self.shape(base) {
            Some(Shape::Vector(_)) => dialect.component(&text, index),
            _ => format!("{text}[{index}]"),
        })
    }

    fn pair_of(&self, size: u8, parts: &[String]) -> String {
        let vector = plain_vector(size);
        let half = |part: &str| parts.iter().map(|text| format!("{text}.{part}")).collect::<Vec<_>>().join(", ");
        format!("DF{size}({vector}({}), {vector}({}))", half("hi"), half("lo"))
    }

    fn pair_operation(&self, op: BinaryOperator, left: (Shape, &str), right: (Shape, &str)) -> Result<String, String> {
        use BinaryOperator as B;
        let name = match op {
            B::Add => "add",
            B::Subtract => "sub",
            B::Multiply => "mul",
            B::Divide => "div",
            B::Equal => "eq",
            B::NotEqual => "ne",
            B::Less => "lt",
            B::LessEqual => "le",
            B::Greater => "gt",
            B::GreaterEqual => "ge",
            other => return Err(format!("`{}` has no double-float form", operator(other))),
        };
        let ((a, x), (b, y)) = (left, right);
        match (a, b) {
            (Shape::Matrix(columns, rows), Shape::Vector(_)) if op == B::Multiply => {
                Ok(columns_by(x, columns, rows, y))
            }
            (Shape::Matrix(columns, rows), Shape::Matrix(others, _)) if op == B::Multiply => {
                let products: Vec<String> =
                    (0..others).map(|k| columns_by(x, columns, rows, &format!("{y}[{k}]"))).collect();
                Ok(format!("array<DF{rows}, {others}>({})", products.join(", ")))
            }
            (Shape::Matrix(..), _) | (_, Shape::Matrix(..)) => {
                Err("an operation on matrices has no double-float form".into())
            }
            _ => {
                let width = a.width().max(b.width());
                let widened = |shape: Shape, text: &str| {
                    if shape.width() < width { splat(Dialect::Pair, width, text) } else { text.to_owned() }
                };
                Ok(format!("rung_{name}_{width}({}, {})", widened(a, x), widened(b, y)))
            }
        }
    }

    fn math(&mut self, value: Value, fun: MathFunction, arguments: &[Value], is_plain: bool) -> Result<String, String> {
        let name = fun.try_to_wgsl().ok_or_else(|| format!("a function without a name: {fun:?}"))?;
        let dialect = if is_plain { Dialect::Single } else { self.writer.dialect };
        let texts: Vec<String> =
            arguments.iter().map(|argument| self.operand(*argument, is_plain)).collect::<Result<_, _>>()?;
        let native = format!("{name}({})", texts.join(", "));
        let Some(shape) = self.shape(arguments[0]) else {
            return if self.shape(value).is_some() { self.raise(value, &native) } else { Ok(native) };
        };
        if is_plain {
            return Ok(native);
        }
        if name.starts_with("pack") || name == "quantizeToF16" {
            return if dialect == Dialect::Single { Ok(native) } else { Err(READS_BITS.into()) };
        }
        let width = shape.width();
        let own = |width: u8| format!("rung_{name}_{width}");
        let widened: Vec<String> = texts
            .iter()
            .zip(arguments)
            .map(|(text, argument)| match self.shape(*argument) {
                Some(Shape::Scalar) if width > 1 => splat(dialect, width, text),
                _ => text.clone(),
            })
            .collect();
        if self.writer.prelude.has(&own(width)) {
            return Ok(format!("{}({})", own(width), widened.join(", ")));
        }
        if width > 1 && self.writer.prelude.has(&own(1)) && !OF_VECTORS.contains(&name) {
            let parts: Vec<String> = (0..width)
                .map(|k| {
                    let index = k.to_string();
                    let of: Vec<String> = widened.iter().map(|text| dialect.component(text, &index)).collect();
                    format!("{}({})", own(1), of.join(", "))
                })
                .collect();
            return Ok(match dialect {
                Dialect::Pair => self.pair_of(width, &parts),
                _ => format!("{}({})", dialect.type_of(shape), parts.join(", ")),
            });
        }
        match dialect {
            Dialect::Single | Dialect::Half => Ok(native),
            Dialect::Double if RIGHT_IN_F64.contains(&name) => Ok(native),
            Dialect::Double | Dialect::Pair => Err(format!("`{name}` has no form there")),
        }
    }

    fn cast(&mut self, from: Value, kind: ScalarKind, converts: bool, is_plain: bool) -> Result<String, String> {
        let dialect = if is_plain { Dialect::Single } else { self.writer.dialect };
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

    fn place(&mut self, pointer: Value) -> Result<Place, String> {
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

    fn pointed(&self, pointer: Value) -> Option<&TypeInner> {
        match *self.inner(pointer) {
            TypeInner::Pointer { base, .. } => Some(&self.writer.module.types[base].inner),
            _ => None,
        }
    }

    fn inner(&self, value: Value) -> &TypeInner {
        self.types.get(value, &self.writer.module.types)
    }

    fn shape(&self, value: Value) -> Option<Shape> {
        shape_of(self.inner(value))
    }

    fn handle(&self, value: Value) -> Option<Handle<Type>> {
        match self.types[value] {
            TypeResolution::Handle(handle) => Some(handle),
            TypeResolution::Value(_) => None,
        }
    }

    fn is_pointer(&self, value: Value) -> bool {
        matches!(self.inner(value), TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. })
    }

    /// Whether an entry point's result is kept in a variable.
    fn is_result(&self, local: Handle<LocalVariable>) -> bool {
        self.gives_position() && self.is_result_type(self.function.local_variables[local].ty)
    }

    fn is_result_type(&self, ty: Handle<Type>) -> bool {
        self.function.result.as_ref().is_some_and(|result| result.ty == ty)
    }

    fn is_whole_result(&self, pointer: Value) -> bool {
        matches!(self.function.expressions[pointer], Expression::LocalVariable(local) if self.is_result(local))
    }

    /// Whether it is an entry point with a clip position among its results.
    fn gives_position(&self) -> bool {
        let Some(result) = self.entry.and(self.function.result.as_ref()) else { return false };
        match &self.writer.module.types[result.ty].inner {
            TypeInner::Struct { members, .. } => {
                members.iter().any(|member| member.binding.as_ref().is_some_and(is_position))
            }
            _ => result.binding.as_ref().is_some_and(is_position),
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

    /// Notes what clip positions come of.
    fn find_position(&mut self, block: &Block) -> Result<(), String> {
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

fn local_name(local: Handle<LocalVariable>) -> String {
    format!("_v{}", local.index())
}

fn splat(dialect: Dialect, size: u8, one: &str) -> String {
    match dialect {
        Dialect::Pair => format!("DF{size}(vec{size}f({one}.hi), vec{size}f({one}.lo))"),
        _ => format!("{}({one})", dialect.type_of(Shape::Vector(size))),
    }
}

/// A matrix of double-floats times a vector, column by column.
fn columns_by(matrix: &str, columns: u8, rows: u8, vector: &str) -> String {
    let product = |k: u8| {
        let one = Dialect::Pair.component(vector, &k.to_string());
        format!("rung_mul_{rows}({matrix}[{k}], {})", splat(Dialect::Pair, rows, &one))
    };
    (1..columns).fold(product(0), |sum, k| format!("rung_add_{rows}({sum}, {})", product(k)))
}

const fn operator(op: BinaryOperator) -> &'static str {
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
