//! Entry points and functions that stand alone, with the values that they give.

use super::memory::{Pointer, State, Variable};
use super::{Lowering, Symbol};
use crate::graph::{NodeId, Origin};
use naga::{Binding, BuiltIn, Function, Handle, TypeInner};

/// A value that is given.
#[derive(Debug)]
pub(crate) struct Output {
    pub(crate) name: String,
    pub(crate) value: NodeId,
    /// Whether it is a place, and no colour or what becomes one.
    pub(crate) is_position: bool,
}

/// An entry point, or a function that nothing calls.
#[derive(Debug)]
pub(crate) struct Root {
    pub(crate) name: String,
    pub(crate) outputs: Vec<Output>,
}

/// Parts of a value that are outputs of their own.
const MOST_PARTS: usize = 12;

impl<'a> Lowering<'a> {
    /// Reads an entry point, or a function by itself.
    pub(crate) fn root(&mut self, function: &'a Function, name: &str, is_entry: bool) -> Root {
        self.statements = 0;
        let mut state = State::new();
        let mut written = vec![];
        let mut arguments = vec![];
        for (k, argument) in function.arguments.iter().enumerate() {
            let own = argument.name.clone().unwrap_or_else(|| format!("argument {k}"));
            let inner = &self.module.types[argument.ty].inner;
            if let TypeInner::Pointer { base, .. } = inner {
                let variable = Variable::Out(k);
                let before = self.fresh(*base, &own, Origin::Parameter);
                state.insert(variable, before.clone());
                written.push((own, variable, before));
                arguments.push(Symbol::Pointer(Pointer { variable, path: vec![] }));
                continue;
            }
            let origin = match &argument.binding {
                Some(Binding::BuiltIn(_)) => Origin::BuiltIn,
                Some(_) => Origin::Input,
                None if is_entry => Origin::Input,
                None => Origin::Parameter,
            };
            let is_block = is_entry && matches!(inner, TypeInner::Struct { .. });
            arguments.push(self.fresh(argument.ty, if is_block { "" } else { &own }, origin));
        }
        let (value, state) = self.run(function, arguments, state);
        let mut outputs = vec![];
        let ty = function.result.as_ref().map(|result| result.ty);
        self.spread(if is_entry { "" } else { "result" }, &value, ty, &mut outputs);
        for (name, variable, before) in written {
            if let Some(after) = state.get(&variable).filter(|after| !same(after, &before)) {
                self.spread(&name, &after.clone(), None, &mut outputs);
            }
        }
        let mut variables: Vec<Variable> = state.keys().copied().collect();
        variables.sort_unstable();
        for variable in variables {
            let Variable::Global(global) = variable else { continue };
            let name = self.global_name(global);
            if self.declared.is_output(&name) {
                let ty = self.module.global_variables[global].ty;
                self.spread(&name, &state[&variable], Some(ty), &mut outputs);
            }
        }
        Root { name: name.into(), outputs }
    }

    fn spread(&self, name: &str, value: &Symbol, ty: Option<Handle<naga::Type>>, outputs: &mut Vec<Output>) {
        match value {
            Symbol::Value(id) => {
                let is_position = name.rsplit('.').next() == Some("gl_Position");
                outputs.push(Output { name: name.into(), value: *id, is_position });
            }
            Symbol::Parts(parts) => {
                let members = ty.and_then(|ty| match &self.module.types[ty].inner {
                    TypeInner::Struct { members, .. } => Some(members),
                    _ => None,
                });
                for (k, part) in parts.iter().enumerate().take(MOST_PARTS) {
                    let member = members.and_then(|members| members.get(k));
                    let own = member.and_then(|member| member.name.clone()).unwrap_or_else(|| k.to_string());
                    let name = if name.is_empty() { own } else { format!("{name}.{own}") };
                    let before = outputs.len();
                    self.spread(&name, part, member.map(|member| member.ty), outputs);
                    let is_position = member
                        .is_some_and(|own| matches!(own.binding, Some(Binding::BuiltIn(BuiltIn::Position { .. }))));
                    outputs[before..].iter_mut().for_each(|own| own.is_position |= is_position);
                }
            }
            _ => {}
        }
    }
}

fn same(a: &Symbol, b: &Symbol) -> bool {
    match (a, b) {
        (Symbol::Value(a), Symbol::Value(b)) => a == b,
        (Symbol::Parts(a), Symbol::Parts(b)) => a.iter().zip(b.iter()).all(|(a, b)| same(a, b)),
        _ => false,
    }
}
