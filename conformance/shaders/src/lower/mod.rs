//! naga's intermediate language as a graph: calls are inlined, a loop is taken once, a branch is a choice.
//!
//! A loop over lights shows its first light: its first turn is taken, as if it always ran. What its turns hand to each other is given by
//! leaves of [`Origin::EarlierTurn`].

mod expression;
mod flow;
mod memory;
mod root;

pub(crate) use root::{Output, Root};

use crate::graph::{Graph, NodeId, Origin, Type};
use memory::Pointer;
use naga::{Expression, Function, Handle, Module, Span, TypeInner};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// Statements that are taken of one entry point.
const MOST_STATEMENTS: usize = 20_000;
/// Values that a graph may have.
const MOST_NODES: usize = 20_000;
/// Calls within calls.
const MOST_CALLS: usize = 16;
/// Elements that are told apart of an array.
const MOST_ELEMENTS: u32 = 16;

/// What an expression gives.
#[derive(Clone, Debug)]
enum Symbol {
    Value(NodeId),
    /// A structure's or an array's parts.
    Parts(Rc<Vec<Symbol>>),
    Pointer(Pointer),
    /// A texture or a sampler, by its name.
    Resource(String),
    Nothing,
}

/// What a module does not say of itself.
pub(crate) trait Declared {
    /// The line of a span in the file as it stands; 0 if there is none.
    fn line(&self, span: Span) -> u32;
    /// Where a global variable's value comes from, if its declaration said it.
    fn origin(&self, name: &str) -> Option<Origin>;
    /// Whether a global variable is an output.
    fn is_output(&self, name: &str) -> bool;
    /// Whether variables without a value are 0.
    fn zeroes_locals(&self) -> bool;
}

/// A function that is being read.
struct Frame<'a> {
    function: &'a Function,
    number: u32,
    arguments: Vec<Symbol>,
    values: HashMap<Handle<Expression>, Symbol>,
}

/// Reads functions of a module into a graph.
pub(crate) struct Lowering<'a> {
    module: &'a Module,
    declared: &'a dyn Declared,
    pub(crate) graph: Graph,
    /// What was left out, in words.
    pub(crate) notes: Vec<String>,
    frames: u32,
    calls: usize,
    loops: usize,
    statements: usize,
    /// Whether a loop's first turn stands for all.
    pub(crate) has_loops: bool,
    /// Variables parts of which a loop has set.
    set_in_loops: HashSet<memory::Variable>,
}

impl<'a> Lowering<'a> {
    pub(crate) fn new(module: &'a Module, declared: &'a dyn Declared) -> Self {
        Self {
            module,
            declared,
            graph: Graph::default(),
            notes: vec![],
            frames: 0,
            calls: 0,
            loops: 0,
            statements: 0,
            has_loops: false,
            set_in_loops: HashSet::new(),
        }
    }

    fn note(&mut self, text: &str) {
        if !self.notes.iter().any(|own| own == text) {
            self.notes.push(text.to_owned());
        }
    }

    /// Whether no more is read.
    fn is_full(&mut self) -> bool {
        let is_full = self.statements > MOST_STATEMENTS || self.graph.len() > MOST_NODES;
        if is_full {
            self.note("it computes more than is looked at: the rest is left out");
        }
        is_full
    }

    /// The graph's type of a scalar, a vector or a matrix.
    fn plain(inner: &TypeInner) -> Option<Type> {
        let of = |scalar: &naga::Scalar, n: u8| match scalar.kind {
            naga::ScalarKind::Float | naga::ScalarKind::AbstractFloat => Type::Float(n),
            naga::ScalarKind::Bool => Type::Bool(n),
            _ => Type::Int(n),
        };
        match inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Some(of(scalar, 1)),
            TypeInner::Vector { size, scalar } => Some(of(scalar, *size as u8)),
            TypeInner::Matrix { columns, rows, .. } => Some(Type::Matrix(*columns as u8, *rows as u8)),
            _ => None,
        }
    }
}
