//! What a shader computes, as a graph: typed, each value once, in one canonical form.
//!
//! A value that is computed twice is one node. So that it is, constructors bring what they are given into one form: `-x` is drawn outwards,
//! `v·v` is `|v|²`, `v/|v|` is `normalize(v)`, a difference of vectors has one direction, a swizzle is pushed to what it reads. Where a value is
//! computed, and under which conditions, stands beside its node (`Occurrence`), since two branches may compute the same.

mod build;
mod demand;
mod evaluate;
#[cfg(test)]
mod tests;
mod text;
mod value;
mod vector;
mod wgsl;

pub use evaluate::Evaluation;
pub use value::Value;

use smallvec::{SmallVec, smallvec};
use std::collections::HashMap;

/// A node of a graph. Operands have smaller numbers than what is made of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    pub(crate) const fn index(self) -> usize {
        self.0 as usize
    }
}

/// The type of a value: what its components are, and how many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Type {
    /// A number, or a vector of 2 to 4.
    Float(u8),
    /// An integer, or a vector of them.
    Int(u8),
    /// A truth value, or a vector of them.
    Bool(u8),
    /// A matrix of so many columns and rows.
    Matrix(u8, u8),
}

impl Type {
    /// How many components it has.
    #[must_use]
    pub const fn length(self) -> usize {
        match self {
            Self::Float(n) | Self::Int(n) | Self::Bool(n) => n as usize,
            Self::Matrix(columns, rows) => columns as usize * rows as usize,
        }
    }

    /// The vector of so many components of the same kind.
    #[must_use]
    pub const fn of_length(self, n: u8) -> Self {
        match self {
            Self::Float(_) | Self::Matrix(..) => Self::Float(n),
            Self::Int(_) => Self::Int(n),
            Self::Bool(_) => Self::Bool(n),
        }
    }

    pub(crate) const fn is_scalar(self) -> bool {
        self.length() == 1
    }

    pub(crate) const fn is_float(self) -> bool {
        matches!(self, Self::Float(_))
    }

    /// The number of components of a vector.
    pub(crate) const fn width(self) -> u8 {
        match self {
            Self::Float(n) | Self::Int(n) | Self::Bool(n) => n,
            Self::Matrix(_, rows) => rows,
        }
    }
}

/// An operation of two operands, component by component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names are the operations'")]
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    And,
    Or,
}

impl Binary {
    pub(crate) const fn compares(self) -> bool {
        matches!(self, Self::Equal | Self::NotEqual | Self::Less | Self::LessEqual | Self::Greater | Self::GreaterEqual)
    }
}

/// A built-in function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names are the functions' in GLSL")]
pub enum Function {
    Abs,
    Min,
    Max,
    Sqrt,
    Exp,
    Exp2,
    Log,
    Log2,
    Pow,
    Sin,
    Cos,
    Tan,
    Acos,
    Asin,
    Atan,
    Floor,
    Ceil,
    Round,
    Trunc,
    Fract,
    Sign,
    Mix,
    Step,
    Smoothstep,
    ToInt,
    Dot,
    Cross,
    Length,
    Normalize,
    Reflect,
    FaceForward,
    Transpose,
    Determinant,
    Inverse,
    All,
    Any,
}

impl Function {
    /// Whether each component of its value is made of the same component of each argument.
    #[must_use]
    pub const fn is_by_component(self) -> bool {
        use Function as F;
        !matches!(
            self,
            F::Dot
                | F::Cross
                | F::Length
                | F::Normalize
                | F::Reflect
                | F::FaceForward
                | F::Transpose
                | F::Determinant
                | F::Inverse
                | F::All
                | F::Any
        )
    }
}

/// Components of a vector, in order.
pub(crate) type Pattern = SmallVec<[u8; 4]>;
/// Operands.
pub(crate) type Operands = SmallVec<[NodeId; 4]>;

/// What a node is.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Op {
    Leaf(u32),
    /// The bits of each component in f64.
    Constant(SmallVec<[u64; 4]>),
    Negate(NodeId),
    Not(NodeId),
    Binary(Binary, NodeId, NodeId),
    MatrixVector(NodeId, NodeId),
    VectorMatrix(NodeId, NodeId),
    MatrixMatrix(NodeId, NodeId),
    Call(Function, Operands),
    Select(NodeId, NodeId, NodeId),
    Swizzle(NodeId, Pattern),
    /// A vector of scalars and vectors one after the other.
    Vector(Operands),
    /// A scalar in each component.
    Splat(NodeId),
    Matrix(Operands),
    Column(NodeId, u8),
}

impl Op {
    pub(crate) fn operands(&self) -> Operands {
        match self {
            Self::Leaf(_) | Self::Constant(_) => smallvec![],
            Self::Negate(a) | Self::Not(a) | Self::Swizzle(a, _) | Self::Splat(a) | Self::Column(a, _) => smallvec![*a],
            Self::Binary(_, a, b) | Self::MatrixVector(a, b) | Self::VectorMatrix(a, b) | Self::MatrixMatrix(a, b) => {
                smallvec![*a, *b]
            }
            Self::Call(_, all) | Self::Vector(all) | Self::Matrix(all) => all.clone(),
            Self::Select(a, b, c) => smallvec![*a, *b, *c],
        }
    }
}

/// Where a value that is not computed comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Origin {
    /// From the host: the same for all invocations.
    Uniform,
    /// From the stage before.
    Input,
    /// From whoever calls the function.
    Parameter,
    /// From a texture.
    Texture,
    /// From the language: a fragment's place, a derivative.
    BuiltIn,
    /// From nowhere: it was not given a value.
    NoValue,
    /// From a loop's turn before the one that is shown.
    EarlierTurn,
}

/// A value that is not computed.
#[derive(Clone, Debug)]
pub struct GraphLeaf {
    /// Its name in the shader.
    pub name: String,
    /// Where it comes from.
    pub origin: Origin,
}

/// A place that computes a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Occurrence {
    pub(crate) line: u32,
    /// Under which conditions, and whether each holds.
    pub(crate) conditions: SmallVec<[(NodeId, bool); 2]>,
}

#[derive(Debug)]
struct Node {
    op: Op,
    ty: Type,
    occurrences: Vec<Occurrence>,
}

/// A graph of values.
#[derive(Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    known: HashMap<(Op, Type), NodeId>,
    leaves: Vec<GraphLeaf>,
    named: HashMap<(String, Type, Origin), NodeId>,
    /// The place that is being read.
    pub(crate) line: u32,
    /// The conditions of the branch that is being read.
    pub(crate) conditions: SmallVec<[(NodeId, bool); 2]>,
}

/// Places that are kept of one value.
const MOST_OCCURRENCES: usize = 16;

impl Graph {
    /// How many values it has.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether it has none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The type of a value.
    #[must_use]
    pub fn ty(&self, id: NodeId) -> Type {
        self.nodes[id.index()].ty
    }

    pub(crate) fn op(&self, id: NodeId) -> &Op {
        &self.nodes[id.index()].op
    }

    pub(crate) fn ids(&self) -> impl Iterator<Item = NodeId> + use<> {
        (0..u32::try_from(self.nodes.len()).unwrap_or(u32::MAX)).map(NodeId)
    }

    /// Where a value is computed.
    pub(crate) fn occurrences(&self, id: NodeId) -> &[Occurrence] {
        &self.nodes[id.index()].occurrences
    }

    /// The first line that computes a value; 0 where none is known.
    #[must_use]
    pub fn line(&self, id: NodeId) -> u32 {
        self.occurrences(id).iter().map(|place| place.line).find(|line| *line > 0).unwrap_or(0)
    }

    /// What a leaf is.
    #[must_use]
    pub fn leaf_of(&self, id: NodeId) -> Option<&GraphLeaf> {
        if let Op::Leaf(k) = self.op(id) { self.leaves.get(*k as usize) } else { None }
    }

    /// The components of a constant.
    #[must_use]
    pub fn constant_of(&self, id: NodeId) -> Option<Value<f64>> {
        let Op::Constant(bits) = self.op(id) else { return None };
        Some(bits.iter().map(|bits| f64::from_bits(*bits)).collect())
    }

    /// The number that all components of a constant are.
    #[must_use]
    pub fn number_of(&self, id: NodeId) -> Option<f64> {
        let Op::Constant(bits) = self.op(id) else { return None };
        bits.iter().all(|own| *own == bits[0]).then(|| f64::from_bits(bits[0]))
    }

    pub(crate) fn is_number(&self, id: NodeId, number: f64) -> bool {
        self.number_of(id) == Some(number)
    }

    /// What stands behind a sign, and whether there is one.
    pub(crate) fn without_sign(&self, id: NodeId) -> (NodeId, bool) {
        if let Op::Negate(inner) = self.op(id) { (*inner, true) } else { (id, false) }
    }

    /// What is computed between a value and a cut, operands first; none if that is more than `most`.
    pub(crate) fn cone(&self, root: NodeId, cut: &[NodeId], most: usize) -> Option<Vec<NodeId>> {
        let (mut found, mut todo): (Vec<NodeId>, Vec<NodeId>) = (vec![], vec![root]);
        if most > 100 {
            // A few are found by looking, many by a table.
            let mut seen = vec![false; root.index() + 1];
            while let Some(id) = todo.pop() {
                if !seen[id.index()] && !cut.contains(&id) {
                    seen[id.index()] = true;
                    found.push(id);
                    todo.extend(self.op(id).operands());
                }
            }
            found.sort_unstable();
            return (found.len() <= most).then_some(found);
        }
        while let Some(id) = todo.pop() {
            if cut.contains(&id) || found.contains(&id) {
                continue;
            }
            found.push(id);
            if found.len() > most {
                return None;
            }
            todo.extend(self.op(id).operands());
        }
        found.sort_unstable();
        Some(found)
    }

    /// All that a value is made of, itself included, operands first.
    pub(crate) fn all_of(&self, root: NodeId) -> Vec<NodeId> {
        self.cone(root, &[], usize::MAX).unwrap_or_default()
    }

    /// The leaves that a value is made of.
    #[must_use]
    pub fn leaves_of(&self, root: NodeId) -> Vec<NodeId> {
        self.all_of(root).into_iter().filter(|id| matches!(self.op(*id), Op::Leaf(_))).collect()
    }

    /// The names of the leaves that a value is made of.
    pub(crate) fn names_of(&self, root: NodeId) -> Vec<&str> {
        self.leaves_of(root).into_iter().filter_map(|id| self.leaf_of(id)).map(|leaf| &*leaf.name).collect()
    }

    /// Keeps that the place that is being read computes a value.
    fn occurs(&mut self, id: NodeId) {
        if self.line == 0 {
            return;
        }
        let place = Occurrence { line: self.line, conditions: self.conditions.clone() };
        let own = &mut self.nodes[id.index()].occurrences;
        if own.len() < MOST_OCCURRENCES && !own.contains(&place) {
            own.push(place);
        }
    }
}
