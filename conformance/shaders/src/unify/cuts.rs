//! Cuts: sets of values that a value is a function of. As in the mapping of circuits to look-up tables, those of a node are made of those of
//! its operands.

use crate::graph::{Graph, NodeId, Op, Type};
use smallvec::SmallVec;
use std::collections::HashMap;
use std::rc::Rc;

/// Values of a cut.
const MOST_VALUES: usize = 5;
/// Cuts of a node, and of these how many are joined with another operand's.
const MOST_CUTS: (usize, usize) = (100, 60);
/// The same in a graph of more values than [`MANY`].
const MOST_CUTS_OF_MANY: (usize, usize) = (32, 20);
const MANY: usize = 2500;

pub(crate) type Cut = SmallVec<[NodeId; 6]>;

/// The cuts of a graph's nodes, made when they are asked for.
#[derive(Default)]
pub(crate) struct Cuts {
    known: HashMap<NodeId, Rc<Vec<Cut>>>,
}

impl Cuts {
    pub(crate) fn of(&mut self, graph: &Graph, root: NodeId) -> Rc<Vec<Cut>> {
        if let Some(known) = self.known.get(&root) {
            return Rc::clone(known);
        }
        // Operands first, without recursion.
        let mut todo = vec![root];
        while let Some(id) = todo.last().copied() {
            let before = todo.len();
            todo.extend(graph.op(id).operands().into_iter().filter(|own| !self.known.contains_key(own)));
            if todo.len() == before {
                todo.pop();
                if !self.known.contains_key(&id) {
                    let made = self.made(graph, id);
                    self.known.insert(id, Rc::new(made));
                }
            }
        }
        Rc::clone(&self.known[&root])
    }

    fn made(&self, graph: &Graph, id: NodeId) -> Vec<Cut> {
        let own = if may_be_given(graph, id) { vec![Cut::from_slice(&[id])] } else { vec![] };
        match graph.op(id) {
            Op::Leaf(_) => return own,
            Op::Constant(_) => return std::iter::once(Cut::new()).chain(own).collect(),
            _ => {}
        }
        let (most, most_joined) = if graph.len() > MANY { MOST_CUTS_OF_MANY } else { MOST_CUTS };
        let mut joined = vec![Cut::new()];
        for operand in graph.op(id).operands() {
            joined = union(&joined, &self.known[&operand], most, most_joined);
        }
        joined.sort_by_key(Cut::len);
        let mut kept: Vec<Cut> = vec![];
        for cut in joined {
            if !kept.iter().any(|smaller| is_within(graph, smaller, &cut)) {
                kept.push(cut);
            }
            if kept.len() >= most {
                break;
            }
        }
        kept.extend(own);
        kept
    }
}

/// Each of the one with each of the other.
fn union(left: &[Cut], right: &[Cut], most: usize, most_joined: usize) -> Vec<Cut> {
    let mut found: Vec<Cut> = vec![];
    for a in left.iter().take(most_joined) {
        // The last is the operand itself.
        let (last, others) = right.split_last().map_or((None, right), |(last, others)| (Some(last), others));
        for b in last.into_iter().chain(others.iter().take(most_joined)) {
            let more = b.iter().filter(|id| !a.contains(id)).count();
            if a.len() + more <= MOST_VALUES {
                let mut cut = a.clone();
                cut.extend(b.iter().copied().filter(|id| !a.contains(id)));
                cut.sort_unstable();
                found.push(cut);
            }
        }
    }
    // Few values first, and of as many those that are near.
    found.sort_unstable_by(|a, b| a.len().cmp(&b.len()).then_with(|| b.cmp(a)));
    found.dedup();
    found.truncate(3 * most);
    found
}

/// Whether a value may be an input of a step: a sign and a copy belong to what reads it, and 0 and 1 to the form.
fn may_be_given(graph: &Graph, id: NodeId) -> bool {
    let is_number = matches!(graph.ty(id), Type::Float(_) | Type::Matrix(..));
    let belongs = matches!(graph.op(id), Op::Negate(_) | Op::Splat(_));
    let is_part_of_forms = [0.0, 1.0, -1.0].iter().any(|own| graph.is_number(id, *own));
    is_number && !belongs && !is_part_of_forms
}

/// Whether a cut says less than a smaller one: all that it has more are values that are no constants.
fn is_within(graph: &Graph, smaller: &Cut, cut: &Cut) -> bool {
    smaller.len() < cut.len()
        && smaller.iter().all(|id| cut.contains(id))
        && cut.iter().all(|id| smaller.contains(id) || !matches!(graph.op(*id), Op::Constant(_)))
}
