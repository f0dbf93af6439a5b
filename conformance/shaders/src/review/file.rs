//! A file's steps, over all that it may be read as.

use super::Review;
use crate::graph::{Graph, NodeId};
use crate::lower::{Lowering, Output, Root};
use crate::read::{ReadOptions, ShaderError, ShaderReading, readings};
use crate::unify::Library;
use lightmeter_document::report::{ShaderReview, ShaderStep, ShaderSum, StepVerdict};
use naga::{Block, Function, Handle, Statement};
use std::collections::HashSet;
use std::path::Path;

/// Reviews files.
#[derive(Debug)]
pub struct Reviewer {
    library: Library,
}

/// Functions of the reader's own.
fn is_ours(name: &str) -> bool {
    name.starts_with("lightmeter_") || name == "main" || name == "ftransform"
}

impl Reviewer {
    /// Makes the forms ready that steps are compared with.
    ///
    /// # Errors
    /// Which form is not as it should be: none that is built in.
    pub fn new() -> Result<Self, String> {
        Ok(Self { library: Library::new()? })
    }

    /// Reads a file, and finds its steps.
    ///
    /// # Errors
    /// Where nobody reads it.
    pub fn review(&self, path: &Path, options: &ReadOptions) -> Result<ShaderReview, ShaderError> {
        let readings = readings(path, options)?;
        let mut found = ShaderReview {
            file: path.to_string_lossy().into_owned(),
            unread: None,
            language: readings.first().map(|own| own.language.clone()).unwrap_or_default(),
            reader: readings.first().map(|own| own.reader.clone()).unwrap_or_default(),
            notes: vec![],
            refused: vec![],
            steps: vec![],
            sums: vec![],
        };
        for reading in &readings {
            let (steps, sums, notes) = self.reviewed(reading);
            found.notes.extend(reading.notes.iter().cloned().chain(notes));
            for step in steps {
                let is_known =
                    |own: &ShaderStep| own.line == step.line && own.kind == step.kind && own.name == step.name;
                if !found.steps.iter().any(is_known) {
                    found.steps.push(step);
                }
            }
            found.sums.extend(sums.into_iter().filter(|sum| !found.sums.contains(sum)).collect::<Vec<_>>());
        }
        let mut seen = HashSet::new();
        found.notes.retain(|note| seen.insert(note.clone()));
        found.steps.sort_by_key(|step| step.line);
        Ok(found)
    }

    fn reviewed(&self, reading: &ShaderReading) -> (Vec<ShaderStep>, Vec<ShaderSum>, Vec<String>) {
        let module = &reading.module;
        let called = called(reading);
        let mut lowering = Lowering::new(module, reading);
        let mut roots = vec![];
        if reading.has_entry {
            roots.extend(module.entry_points.iter().map(|own| lowering.root(&own.function, &own.name, true)));
        }
        let alone = |handle: &Handle<Function>| !called.contains(handle);
        for (handle, function) in module.functions.iter() {
            let name = function.name.clone().unwrap_or_default();
            if alone(&handle) && !is_ours(&name) {
                roots.push(lowering.root(function, &name, false));
            }
        }
        let mut notes = std::mem::take(&mut lowering.notes);
        if lowering.has_loops {
            notes.push("a loop is shown by its first turn".into());
        }
        let graph = lowering.graph;
        let (mut steps, sums) = self.steps_of(&graph, &roots, reading);
        steps.extend(self.steps_unused(&graph, &roots, reading, &steps));
        // What is called, but not on a way that outputs take: each by itself.
        let covered = covered(&graph, &roots);
        let mut more = Lowering::new(module, reading);
        let mut others = vec![];
        for (handle, function) in module.functions.iter() {
            let name = function.name.clone().unwrap_or_default();
            if called.contains(&handle) && !is_ours(&name) {
                others.push(more.root(function, &name, false));
            }
        }
        let (others, _) = self.steps_of(&more.graph, &others, reading);
        let lines = |step: &ShaderStep| std::iter::once(step.line).chain(step.also.iter().copied()).collect::<Vec<_>>();
        let known: Vec<u32> = steps.iter().flat_map(lines).collect();
        steps.extend(others.into_iter().filter(|step| {
            let is_seen = lines(step).iter().any(|line| covered.contains(line) || known.contains(line));
            // What a function computes of what it is given may be hidden by what it is given.
            let is_plain = ["schlick", "gamma", "srgb", "tone", "fog", "blend"].contains(&&*step.kind)
                && step.verdict != StepVerdict::Mistake
                && !lines(step).iter().any(|line| known.contains(line));
            is_plain || !is_seen && !matches!(&*step.kind, "terms" | "value")
        }));
        (steps, sums, notes)
    }

    /// Steps that a shader computes and does not use: what they are, and no mistake.
    fn steps_unused(
        &self,
        graph: &Graph,
        roots: &[Root],
        reading: &ShaderReading,
        known: &[ShaderStep],
    ) -> Vec<ShaderStep> {
        let used: HashSet<_> =
            roots.iter().flat_map(|root| &root.outputs).flat_map(|own| graph.all_of(own.value)).collect();
        let operands: HashSet<_> = graph.ids().flat_map(|id| graph.op(id).operands()).collect();
        let is_unused = |id: &NodeId| !used.contains(id) && !operands.contains(id) && graph.ty(*id).is_float();
        let outputs = graph
            .ids()
            .filter(is_unused)
            .map(|value| Output { name: String::new(), value, is_position: false })
            .collect();
        let (steps, _) = self.steps_of(graph, &[Root { name: String::new(), outputs }], reading);
        let is_new = |step: &ShaderStep| {
            // A function that is not there may take it.
            let is_length = step.kind == "length" && reading.lacks_functions;
            let is_step = !matches!(&*step.kind, "terms" | "value" | "length") && step.verdict != StepVerdict::Mistake;
            // v · 1/|v| is another form of what is used.
            let is_inverse = step.kind == "attenuation" && step.name == "inverse";
            (is_step && !is_inverse || is_length)
                && known.iter().all(|own| own.line != step.line || own.kind != step.kind)
        };
        let told = |mut step: ShaderStep| {
            let taken = if reading.lacks_functions {
                "; it goes into a function that is not there, or nowhere"
            } else {
                "; it does not enter an output's arithmetic"
            };
            step.sentence += taken;
            step
        };
        steps.into_iter().filter(is_new).map(told).collect()
    }

    fn steps_of(&self, graph: &Graph, roots: &[Root], reading: &ShaderReading) -> (Vec<ShaderStep>, Vec<ShaderSum>) {
        let mut review = Review::new(graph, &self.library, reading.is_vertex());
        review.roots(roots);
        // What is left out might be what is missing, and a function that is not there may set what it is given.
        if reading.is_partial || reading.lacks_functions {
            let is_open = |step: &&mut ShaderStep| step.kind == "value" || step.kind == "terms" && reading.is_partial;
            let of_sums = review.steps.iter_mut().filter(is_open);
            of_sums
                .filter(|step| step.verdict == StepVerdict::Mistake)
                .for_each(|step| step.verdict = StepVerdict::Perhaps);
        }
        (review.steps, review.sums)
    }
}

/// The lines of all that outputs are made of.
fn covered(graph: &Graph, roots: &[Root]) -> HashSet<u32> {
    let outputs = roots.iter().flat_map(|root| &root.outputs);
    let values = outputs.flat_map(|output| graph.all_of(output.value));
    values.flat_map(|own| graph.occurrences(own).iter().map(|place| place.line).collect::<Vec<_>>()).collect()
}

/// Functions that an entry point calls, or another function.
fn called(reading: &ShaderReading) -> HashSet<Handle<Function>> {
    let module = &reading.module;
    let (mut found, mut todo) = (HashSet::new(), vec![]);
    for own in module.entry_points.iter().filter(|_| reading.has_entry) {
        callees(&own.function.body, &mut todo);
    }
    for (_, function) in module.functions.iter() {
        callees(&function.body, &mut todo);
    }
    while let Some(handle) = todo.pop() {
        if found.insert(handle) {
            callees(&module.functions[handle].body, &mut todo);
        }
    }
    found
}

fn callees(block: &Block, found: &mut Vec<Handle<Function>>) {
    for statement in block.iter() {
        match statement {
            Statement::Call { function, .. } => found.push(*function),
            Statement::Block(inner) => callees(inner, found),
            Statement::If { accept, reject, .. } => {
                callees(accept, found);
                callees(reject, found);
            }
            Statement::Loop { body, continuing, .. } => {
                callees(body, found);
                callees(continuing, found);
            }
            Statement::Switch { cases, .. } => cases.iter().for_each(|case| callees(&case.body, found)),
            _ => {}
        }
    }
}
