//! Whether a vector is of length 1, as far as the shader says it.

use super::class::{Class, Random};
use super::{Finder, MOST_OPERATIONS};
use crate::graph::{Evaluation, Function, NodeId, Op, Type};

/// What is known of a vector's length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Length {
    One,
    /// It comes from outside.
    Open,
    /// It is computed, and is not 1.
    NotOne,
}

impl Finder<'_> {
    pub(crate) fn length(&mut self, id: NodeId) -> Length {
        if let Some(known) = self.lengths.get(&id) {
            return *known;
        }
        let found = self.measured(id);
        self.lengths.insert(id, found);
        found
    }

    fn measured(&mut self, id: NodeId) -> Length {
        let graph = self.graph;
        match graph.op(id) {
            Op::Negate(inner) => self.length(*inner),
            Op::Call(Function::Normalize, _) => Length::One,
            Op::Leaf(_) => Length::Open,
            Op::Swizzle(of, _) if matches!(graph.op(*of), Op::Leaf(_)) => Length::Open,
            Op::Constant(_) => {
                let value = graph.constant_of(id).map_or(0.0, |value| value.dot(&value));
                if (value - 1.0).abs() < 1e-5 { Length::One } else { Length::NotOne }
            }
            Op::Select(_, a, b) => match (graph.is_number(*a, 0.0), graph.is_number(*b, 0.0)) {
                (true, _) => self.length(*b),
                (_, true) => self.length(*a),
                _ => match (self.length(*a), self.length(*b)) {
                    (Length::One, Length::One) => Length::One,
                    (Length::NotOne, _) | (_, Length::NotOne) => Length::NotOne,
                    _ => Length::Open,
                },
            },
            Op::Call(Function::Reflect, of) => match (self.length(of[0]), self.length(of[1])) {
                (Length::One, Length::One) => Length::One,
                (Length::NotOne, _) | (_, Length::NotOne) => Length::NotOne,
                _ => Length::Open,
            },
            Op::Call(Function::FaceForward, of) => self.length(of[0]),
            _ if self.is_one_by_trial(id) => Length::One,
            _ => Length::NotOne,
        }
    }

    fn is_one_by_trial(&mut self, id: NodeId) -> bool {
        let graph = self.graph;
        let leaves = graph.leaves_of(id);
        let Some(evaluation) = Evaluation::new(graph, id, &leaves, 4 * MOST_OPERATIONS) else { return false };
        let mut random = Random::new(12345);
        (0..6).all(|_| {
            let class = |ty: Type| if ty.is_scalar() { Class::Positive } else { Class::Vector };
            let given: Vec<_> =
                leaves.iter().map(|leaf| class(graph.ty(*leaf)).sample(graph.ty(*leaf), &mut random)).collect();
            let value = evaluation.value(&given, &mut self.buffer);
            (value.dot(&value) - 1.0).abs() < 1e-6
        })
    }
}
