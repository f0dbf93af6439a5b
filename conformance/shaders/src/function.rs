//! A function in WGSL, computed here: for judging a step where there is no adapter, or none is asked.

use crate::graph::{Evaluation, Graph, NodeId, Value};
use crate::lower::Lowering;
use crate::unify::Plain;
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Operations that a function has at most.
const MOST_OPERATIONS: usize = 4096;

/// A function that is computed in f32, operation by operation, each rounded to the nearest value.
#[derive(Debug)]
pub struct EvaluatedFunction {
    graph: Graph,
    outputs: Vec<NodeId>,
    /// Each parameter's leaves, in the order of its numbers.
    cut: Vec<NodeId>,
}

impl EvaluatedFunction {
    /// A function of a text.
    ///
    /// # Errors
    /// Where the text is no WGSL, or there is no such function, or it uses what the graph has not.
    pub fn new(wgsl: &str, name: &str) -> Result<Self, String> {
        let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| error.emit_to_string(wgsl))?;
        // What no driver would take is no function either.
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
        validator.validate(&module).map_err(|error| error.emit_to_string(wgsl))?;
        let found = module.functions.iter().find(|(_, own)| own.name.as_deref() == Some(name));
        let (_, function) = found.ok_or_else(|| format!("there is no function `{name}`"))?;
        let mut lowering = Lowering::new(&module, &Plain);
        let root = lowering.root(function, name, false);
        let graph = lowering.graph;
        let named = |own: &str| graph.ids().find(|id| graph.leaf_of(*id).is_some_and(|leaf| leaf.name == own));
        let cut: Vec<NodeId> = function
            .arguments
            .iter()
            .map(|own| own.name.as_deref().and_then(named))
            .collect::<Option<_>>()
            .ok_or("a parameter is not used")?;
        let outputs: Vec<NodeId> = root.outputs.iter().map(|own| own.value).collect();
        let own = Self { graph, outputs, cut };
        if own.evaluations().is_none() {
            return Err(format!("`{name}` needs more than its parameters"));
        }
        Ok(own)
    }

    fn evaluations(&self) -> Option<Vec<Evaluation<'_>>> {
        self.outputs
            .iter()
            .map(|root| Evaluation::new(&self.graph, *root, &self.cut, MOST_OPERATIONS).map(Evaluation::of_numbers))
            .collect()
    }

    /// Its value's numbers for each row of its parameters' numbers, one row after the other.
    pub fn rows<'a>(&self, rows: impl Iterator<Item = &'a [f32]>) -> Vec<Vec<f32>> {
        let Some(evaluations) = self.evaluations() else { return vec![] };
        let mut buffer = vec![];
        let mut value = |row: &[f32]| {
            let mut rest = row.iter().copied();
            let given: Vec<Value<f32>> =
                self.cut.iter().map(|id| rest.by_ref().take(self.graph.ty(*id).length()).collect()).collect();
            evaluations.iter().flat_map(|own| own.value(&given, &mut buffer).components().to_vec()).collect()
        };
        rows.map(&mut value).collect()
    }
}
