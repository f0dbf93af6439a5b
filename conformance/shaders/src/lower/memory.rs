//! Variables, and what they hold.

use super::{Lowering, MOST_ELEMENTS, Symbol};
use crate::graph::{NodeId, Origin, Type};
use naga::{AddressSpace, ArraySize, Function, GlobalVariable, Handle, LocalVariable, TypeInner};
use std::collections::HashMap;
use std::rc::Rc;

/// A variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Variable {
    /// Of a frame.
    Local(u32, Handle<LocalVariable>),
    Global(Handle<GlobalVariable>),
    /// What a function that stands alone is given to write to.
    Out(usize),
}

/// A part of a variable.
#[derive(Clone, Debug)]
pub(super) struct Pointer {
    pub(super) variable: Variable,
    pub(super) path: Vec<Place>,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    At(u32),
    Computed(NodeId),
}

/// What variables hold.
pub(super) type State = HashMap<Variable, Symbol>;

fn elements(size: ArraySize) -> u32 {
    if let ArraySize::Constant(n) = size { n.get().min(MOST_ELEMENTS) } else { 1 }
}

impl<'a> Lowering<'a> {
    /// A value of which each part is a leaf.
    pub(super) fn fresh(&mut self, ty: Handle<naga::Type>, name: &str, origin: Origin) -> Symbol {
        let module = self.module;
        match &module.types[ty].inner {
            TypeInner::Struct { members, .. } => {
                let member = |(k, member): (usize, &naga::StructMember)| {
                    let name = joined(name, member.name.as_deref(), k);
                    self.fresh(member.ty, &name, origin)
                };
                Symbol::Parts(Rc::new(members.iter().enumerate().map(member).collect()))
            }
            TypeInner::Array { base, size, .. } => {
                let own = (0..elements(*size)).map(|k| self.fresh(*base, &format!("{name}[{k}]"), origin));
                Symbol::Parts(Rc::new(own.collect()))
            }
            TypeInner::Image { .. } | TypeInner::Sampler { .. } | TypeInner::BindingArray { .. } => {
                Symbol::Resource(name.into())
            }
            inner => match Self::plain(inner) {
                Some(ty) => Symbol::Value(self.graph.leaf(name, ty, origin)),
                None => Symbol::Nothing,
            },
        }
    }

    pub(super) fn zero(&mut self, ty: Handle<naga::Type>) -> Symbol {
        let module = self.module;
        match &module.types[ty].inner {
            TypeInner::Struct { members, .. } => {
                Symbol::Parts(Rc::new(members.iter().map(|member| self.zero(member.ty)).collect()))
            }
            TypeInner::Array { base, size, .. } => {
                Symbol::Parts(Rc::new((0..elements(*size)).map(|_| self.zero(*base)).collect()))
            }
            inner => match Self::plain(inner) {
                Some(ty) => Symbol::Value(self.graph.constant(ty, &vec![0.0; ty.length()])),
                None => Symbol::Nothing,
            },
        }
    }

    pub(super) fn global_name(&self, global: Handle<GlobalVariable>) -> String {
        let own = &self.module.global_variables[global];
        own.name.clone().or_else(|| self.module.types[own.ty].name.clone()).unwrap_or_default()
    }

    /// What a part of a variable holds before anything was stored, and how much of the path that took.
    fn initial(&mut self, pointer: &Pointer, function: Option<&'a Function>) -> (Symbol, usize) {
        match pointer.variable {
            Variable::Out(_) => (Symbol::Nothing, 0),
            Variable::Local(_, local) => {
                let Some(own) = function.map(|function| &function.local_variables[local]) else {
                    return (Symbol::Nothing, 0);
                };
                if self.declared.zeroes_locals() {
                    return (self.zero(own.ty), 0);
                }
                let name = own.name.clone().unwrap_or_else(|| "a variable".into());
                let is_set = self.set_in_loops.contains(&pointer.variable);
                let origin = if is_set { Origin::EarlierTurn } else { Origin::NoValue };
                (self.fresh(own.ty, &name, origin), 0)
            }
            Variable::Global(global) => self.initial_global(global, &pointer.path),
        }
    }

    fn initial_global(&mut self, global: Handle<GlobalVariable>, path: &[Place]) -> (Symbol, usize) {
        let module = self.module;
        let own = &module.global_variables[global];
        let mut name = self.global_name(global);
        let declared = self.declared.origin(&name);
        if let (Some(init), None) = (own.init, declared) {
            return (self.constant_expression(init), 0);
        }
        let origin = declared.unwrap_or(match own.space {
            AddressSpace::Uniform | AddressSpace::Storage { .. } | AddressSpace::Immediate => Origin::Uniform,
            AddressSpace::Handle => Origin::Texture,
            _ => Origin::NoValue,
        });
        // Compilers put loose uniforms into a block of no name of its own.
        if name.starts_with("gl_DefaultUniformBlock") || name == "$Global" {
            name.clear();
        }
        // By type along the path, so that only what is asked for becomes leaves.
        let (mut ty, mut used) = (own.ty, 0);
        for place in path {
            match (&module.types[ty].inner, place) {
                (TypeInner::Struct { members, .. }, Place::At(k)) => {
                    let Some(member) = members.get(*k as usize) else { break };
                    name = joined(&name, member.name.as_deref(), *k as usize);
                    ty = member.ty;
                }
                (TypeInner::Array { base, .. }, place) => {
                    let index = match place {
                        Place::At(k) => k.to_string(),
                        Place::Computed(id) => self.graph.text(*id, 3),
                    };
                    name = format!("{name}[{index}]");
                    ty = *base;
                }
                _ => break,
            }
            used += 1;
        }
        (self.fresh(ty, &name, origin), used)
    }

    fn number_of(&self, place: Place) -> Option<usize> {
        match place {
            Place::At(k) => Some(k as usize),
            Place::Computed(id) => self.graph.number_of(id).map(index),
        }
    }

    /// A part of a value. A computed place that is not known is the first.
    pub(super) fn part(&mut self, of: &Symbol, place: Place) -> Symbol {
        let k = self.number_of(place);
        match of {
            Symbol::Parts(parts) => {
                k.and_then(|k| parts.get(k)).or_else(|| parts.first()).cloned().unwrap_or(Symbol::Nothing)
            }
            Symbol::Value(id) => {
                let k =
                    u8::try_from(k.unwrap_or(0).min(usize::from(self.graph.ty(*id).width().saturating_sub(1)).max(3)));
                let k = k.unwrap_or(0);
                Symbol::Value(match self.graph.ty(*id) {
                    Type::Matrix(columns, _) => self.graph.column(*id, k.min(columns - 1)),
                    ty => self.graph.swizzle(*id, &[k.min(ty.width() - 1)]),
                })
            }
            other => other.clone(),
        }
    }

    pub(super) fn load(&mut self, state: &State, pointer: &Pointer, function: Option<&'a Function>) -> Symbol {
        let (mut value, used) = match state.get(&pointer.variable) {
            Some(value) => (value.clone(), 0),
            None => self.initial(pointer, function),
        };
        for place in &pointer.path[used..] {
            value = self.part(&value, *place);
        }
        value
    }

    pub(super) fn store(
        &mut self,
        state: &mut State,
        pointer: &Pointer,
        value: Symbol,
        function: Option<&'a Function>,
    ) {
        if pointer.path.is_empty() {
            state.insert(pointer.variable, value);
            return;
        }
        if self.loops > 0 && self.is_element(pointer, function) {
            self.set_in_loops.insert(pointer.variable);
        }
        let whole = Pointer { variable: pointer.variable, path: vec![] };
        let before = match state.get(&pointer.variable) {
            Some(value) => value.clone(),
            None => self.initial(&whole, function).0,
        };
        let after = self.with_part(before, &pointer.path, value);
        state.insert(pointer.variable, after);
    }

    /// Whether a pointer is to an element of a local array: another turn of a loop sets another.
    fn is_element(&self, pointer: &Pointer, function: Option<&'a Function>) -> bool {
        let (Variable::Local(_, local), Some(function)) = (pointer.variable, function) else { return false };
        let Some((_, own)) = function.local_variables.iter().find(|(handle, _)| *handle == local) else { return false };
        let mut ty = own.ty;
        for place in &pointer.path {
            match (&self.module.types[ty].inner, place) {
                (TypeInner::Array { .. }, _) => return true,
                (TypeInner::Struct { members, .. }, Place::At(k)) if (*k as usize) < members.len() => {
                    ty = members[*k as usize].ty;
                }
                _ => return false,
            }
        }
        false
    }

    fn with_part(&mut self, of: Symbol, path: &[Place], value: Symbol) -> Symbol {
        let Some((first, rest)) = path.split_first() else { return value };
        let k = self.number_of(*first).unwrap_or(0);
        match of {
            Symbol::Parts(mut parts) => {
                if let Some(own) = Rc::make_mut(&mut parts).get_mut(k) {
                    let before = std::mem::replace(own, Symbol::Nothing);
                    *own = self.with_part(before, rest, value);
                }
                Symbol::Parts(parts)
            }
            Symbol::Value(id) => Symbol::Value(self.with_component(id, k, rest, value)),
            other => other,
        }
    }

    fn with_component(&mut self, of: NodeId, k: usize, rest: &[Place], value: Symbol) -> NodeId {
        let ty = self.graph.ty(of);
        if let Type::Matrix(columns, _) = ty {
            let column = |own: u8, lowering: &mut Self| {
                let before = lowering.graph.column(of, own);
                if usize::from(own) != k {
                    return before;
                }
                match lowering.with_part(Symbol::Value(before), rest, value.clone()) {
                    Symbol::Value(id) => id,
                    _ => before,
                }
            };
            let columns = (0..columns).map(|own| column(own, self)).collect();
            return self.graph.matrix(columns);
        }
        let Symbol::Value(value) = value else { return of };
        let component = |own: u8| if usize::from(own) == k { value } else { self.graph.swizzle(of, &[own]) };
        let components: Vec<NodeId> = (0..ty.width()).map(component).collect();
        self.graph.vector(&components)
    }

    /// What variables hold after a branch.
    pub(super) fn merged(
        &mut self,
        condition: NodeId,
        yes: State,
        no: State,
        function: &'a Function,
        frame: u32,
    ) -> State {
        let mut variables: Vec<Variable> = yes.keys().chain(no.keys()).copied().collect();
        variables.sort_unstable();
        variables.dedup();
        let mut found = State::new();
        for variable in variables {
            let before = |lowering: &mut Self| {
                let is_known = !matches!(variable, Variable::Local(number, _) if number != frame);
                let pointer = Pointer { variable, path: vec![] };
                is_known.then(|| lowering.initial(&pointer, Some(function)).0)
            };
            let value = match (yes.get(&variable), no.get(&variable)) {
                (Some(a), Some(b)) => self.chosen(condition, a, b),
                (Some(a), None) => before(self).map_or_else(|| a.clone(), |b| self.chosen(condition, a, &b)),
                (None, Some(b)) => before(self).map_or_else(|| b.clone(), |a| self.chosen(condition, &a, b)),
                (None, None) => continue,
            };
            found.insert(variable, value);
        }
        found
    }

    pub(super) fn chosen(&mut self, condition: NodeId, yes: &Symbol, no: &Symbol) -> Symbol {
        match (yes, no) {
            (Symbol::Value(a), Symbol::Value(b)) if self.graph.ty(*a) == self.graph.ty(*b) => {
                Symbol::Value(self.graph.select(condition, *a, *b))
            }
            (Symbol::Parts(a), Symbol::Parts(b)) if !Rc::ptr_eq(a, b) => {
                Symbol::Parts(Rc::new(a.iter().zip(b.iter()).map(|(a, b)| self.chosen(condition, a, b)).collect()))
            }
            _ => yes.clone(),
        }
    }
}

/// A member's name within its structure's.
fn joined(of: &str, own: Option<&str>, k: usize) -> String {
    let own = own.map_or_else(|| format!("member {k}"), str::to_owned);
    if of.is_empty() { own } else { format!("{of}.{own}") }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "held within what an array may have")]
fn index(number: f64) -> usize {
    number.clamp(0.0, 65_536.0) as usize
}
