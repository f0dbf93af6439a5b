//! Evaluates the part of a graph between a value and a cut, many times.

use super::value::apply;
use super::{Function, Graph, NodeId, Op, Type, Value};
use num_traits::Float;
use smallvec::{SmallVec, smallvec};

/// What is computed between a value and a cut, made ready to be evaluated for values of the cut.
#[derive(Debug)]
pub struct Evaluation<'a> {
    graph: &'a Graph,
    /// Each node with the places of its operands and its own.
    steps: Vec<(NodeId, SmallVec<[usize; 4]>, usize)>,
    constants: Vec<(usize, Value<f64>)>,
    places: usize,
    root: usize,
    /// Whether the least and the greatest of a number and of what is none are the number, as processors have it.
    is_of_numbers: bool,
}

impl<'a> Evaluation<'a> {
    /// Of a value as a function of a cut; none where it needs a leaf that is not of the cut, or more than `most` operations.
    #[must_use]
    pub fn new(graph: &'a Graph, root: NodeId, cut: &[NodeId], most: usize) -> Option<Self> {
        let cone = graph.cone(root, cut, most)?;
        let place = |id: NodeId| {
            cut.iter().position(|own| *own == id).or_else(|| cone.binary_search(&id).ok().map(|k| k + cut.len()))
        };
        let mut own = Self {
            graph,
            steps: vec![],
            constants: vec![],
            places: cut.len() + cone.len(),
            root: place(root)?,
            is_of_numbers: false,
        };
        for (k, id) in cone.iter().enumerate() {
            let here = cut.len() + k;
            match graph.op(*id) {
                Op::Leaf(_) => return None,
                Op::Constant(_) => own.constants.push((here, graph.constant_of(*id)?)),
                op => {
                    let operands = op.operands().into_iter().map(place).collect::<Option<_>>()?;
                    own.steps.push((*id, operands, here));
                }
            }
        }
        Some(own)
    }

    /// The same, where the least and the greatest of a number and of what is none are the number. Shading languages leave that open.
    #[must_use]
    pub const fn of_numbers(mut self) -> Self {
        self.is_of_numbers = true;
        self
    }

    /// The value, given those of the cut.
    pub fn value<N: Float>(&self, given: &[Value<N>], buffer: &mut Vec<Value<N>>) -> Value<N> {
        buffer.clear();
        buffer.extend_from_slice(given);
        buffer.resize(self.places, Value::zero(0));
        for (place, constant) in &self.constants {
            let number = |own: &f64| N::from(*own).unwrap_or_else(N::nan);
            buffer[*place] = constant.components().iter().map(number).collect();
        }
        for (id, operands, place) in &self.steps {
            let mut values: SmallVec<[Value<N>; 4]> = operands.iter().map(|operand| buffer[*operand]).collect();
            let own = self.graph.op(*id);
            if self.is_of_numbers && matches!(own, Op::Call(Function::Min | Function::Max, _)) {
                values = smallvec![values[0].or(&values[1]), values[1].or(&values[0])];
            }
            let types: SmallVec<[Type; 4]> = own.operands().iter().map(|operand| self.graph.ty(*operand)).collect();
            buffer[*place] = apply(own, self.graph.ty(*id), &values, &types);
        }
        buffer[self.root]
    }
}
