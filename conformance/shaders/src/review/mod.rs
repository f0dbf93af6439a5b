//! From matches to steps: what each vector is for, which matches are steps, what is wrong with them, and what multiplies what.

mod accept;
mod claim;
mod direction;
mod file;
mod role;
mod site;
mod sum;

pub use file::Reviewer;

use crate::graph::{Graph, NodeId};
use crate::lower::Root;
use crate::templates::Worth;
use crate::unify::{Finder, Library};
use lightmeter_document::report::{ShaderStep, ShaderSum, StepVerdict};
use site::{Mates, Site};
use std::collections::{BTreeMap, HashMap, HashSet};

impl From<Worth> for StepVerdict {
    fn from(worth: Worth) -> Self {
        match worth {
            Worth::Right => Self::Right,
            Worth::Dialect => Self::Dialect,
            Worth::Mistake => Self::Mistake,
        }
    }
}

/// Looks at roots of a graph.
struct Review<'a> {
    graph: &'a Graph,
    finder: Finder<'a>,
    /// What is made of each value.
    users: HashMap<NodeId, Vec<NodeId>>,
    sites: BTreeMap<NodeId, Site>,
    /// The normals of highlights, and their lights and eyes.
    normals: HashSet<NodeId>,
    mates: Vec<Mates>,
    /// Conditions, which are looked at last.
    waiting: Vec<NodeId>,
    is_vertex: bool,
    /// What functions give that stand alone, with their names.
    given: HashMap<NodeId, String>,
    steps: Vec<ShaderStep>,
    sums: Vec<ShaderSum>,
}

impl<'a> Review<'a> {
    fn new(graph: &'a Graph, library: &'a Library, is_vertex: bool) -> Self {
        let mut users: HashMap<NodeId, Vec<NodeId>> = HashMap::new();
        for id in graph.ids() {
            for operand in graph.op(id).operands() {
                users.entry(operand).or_default().push(id);
            }
        }
        Self {
            graph,
            finder: Finder::new(graph, library),
            users,
            sites: BTreeMap::new(),
            normals: HashSet::new(),
            mates: vec![],
            waiting: vec![],
            is_vertex,
            given: HashMap::new(),
            steps: vec![],
            sums: vec![],
        }
    }

    fn users(&self, id: NodeId) -> &[NodeId] {
        self.users.get(&id).map_or(&[], |own| own)
    }

    fn say(&mut self, step: ShaderStep) {
        let is_term = step.kind == "terms";
        let is_known = self.steps.iter().any(|own| {
            (own.line == step.line || is_term)
                && own.kind == step.kind
                && own.name == step.name
                && own.verdict == step.verdict
        });
        if !is_known {
            self.steps.push(step);
        }
    }

    /// The steps of roots, and their sums.
    fn roots(&mut self, roots: &[Root]) {
        for root in roots {
            self.given.extend(root.outputs.iter().map(|own| (own.value, root.name.to_lowercase())));
        }
        // Twice: what highlights say of normals and lights helps with the rest.
        for is_last in [false, true] {
            self.visit_all(roots);
            if !is_last {
                self.learn();
            }
        }
        self.claim_all();
        for root in roots {
            for output in &root.outputs {
                self.combination(&output.name, output.value);
            }
        }
        self.values_without(roots);
        self.steps.sort_by_key(|step| step.line);
    }
}
