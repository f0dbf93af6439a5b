//! A function's body in a rung's arithmetic: what is bound to which name, and of what types. Statements, expressions, built-in
//! functions, places and clip positions are written by files of their own.

mod expression;
mod math;
mod pair;
mod place;
mod position;
mod statement;

use super::dialect::{Dialect, Shape};
use super::writer::{Writer, is_position, shape_of};
use naga::front::Typifier;
use naga::proc::{ResolveContext, TypeResolution};
use naga::{EntryPoint, Expression, Function, Handle, Type, TypeInner};
use place::local_name;
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

type Value = Handle<Expression>;

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

    /// How a value is written: in f32, or in the rung.
    fn dialect(&self, is_plain: bool) -> Dialect {
        if is_plain { Dialect::Single } else { self.writer.dialect }
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
}
