//! A chunk of a group's cases: inputs, references and intervals, on all cores.

use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_catalogue::select::{CaseRef, Member};
use rayon::prelude::*;

/// Cases that a task of the pool takes at once.
pub const TASK: usize = 512;
/// A chunk of a group's cases, with everything about them that does not depend on a subject.
pub struct Chunk<'a> {
    /// The formulas of the group.
    pub members: &'a [&'a Member],
    /// The cases, one after the other.
    pub cases: Vec<CaseRef>,
    /// For each case, its formula's place among the members.
    pub of: Vec<usize>,
    /// The inputs, row after row.
    pub inputs: Vec<f32>,
    /// The same inputs as the shaders take them: each row is preceded by the selector words that say which formula of the group is to be
    /// evaluated.
    pub selected: Vec<f32>,
    /// The f64 reference of each output.
    pub references: Vec<f64>,
    /// What is legal of each output in the programmable stages.
    pub intervals: Vec<Accept>,
}

impl Chunk<'_> {
    /// The inputs of a case.
    #[must_use]
    pub fn inputs_of(&self, case: usize) -> &[f32] {
        let stride = self.members[0].spec.input_len();
        &self.inputs[case * stride..(case + 1) * stride]
    }
}

/// Draws the inputs of cases, each with its formula's place among the members, on all cores.
#[must_use]
pub fn draw<'a>(members: &'a [&'a Member], cases: &[(usize, CaseRef)], seed: u64) -> Chunk<'a> {
    let parts: Vec<(Vec<f32>, Vec<f32>)> = cases
        .par_chunks(TASK)
        .map(|cases| {
            let (mut inputs, mut selected) = (Vec::with_capacity(cases.len() * members[0].spec.input_len()), vec![]);
            for of_member in cases.chunk_by(|a, b| a.0 == b.0) {
                let member = members[of_member[0].0];
                let draws = member.draws(seed);
                for &(_, case) in of_member {
                    let start = inputs.len();
                    draws.inputs(case, &mut inputs);
                    if !member.spec.selectors.is_empty() {
                        selected.extend(member.spec.selectors.iter().map(|&code| f32::from_bits(code)));
                        selected.extend_from_slice(&inputs[start..]);
                    }
                }
            }
            (inputs, selected)
        })
        .collect();
    let (inputs, selected): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
    let (inputs, selected) = (inputs.concat(), selected.concat());
    Chunk {
        members,
        cases: cases.iter().map(|(_, case)| *case).collect(),
        of: cases.iter().map(|(of, _)| *of).collect(),
        selected,
        inputs,
        references: vec![],
        intervals: vec![],
    }
}

/// Reference values and intervals, on all cores.
pub fn refer(chunk: &mut Chunk<'_>, profile: &Profile) {
    let spec = &chunk.members[0].spec;
    let (stride, outputs) = (spec.input_len(), spec.output_len());
    let mut references = vec![0.0; chunk.cases.len() * outputs];
    let mut intervals = vec![Accept::ANY; chunk.cases.len() * outputs];
    references.par_chunks_mut(TASK * outputs).zip(intervals.par_chunks_mut(TASK * outputs)).enumerate().for_each(
        |(task, (references, intervals))| {
            let first = task * TASK;
            let mut done = 0;
            for of in chunk.of[first..first + references.len() / outputs].chunk_by(|a, b| a == b) {
                let formula = &chunk.members[of[0]].formula;
                let cases = done..done + of.len();
                let rows = &chunk.inputs[(first + cases.start) * stride..(first + cases.end) * stride];
                let out = cases.start * outputs..cases.end * outputs;
                formula.references(rows, stride, &mut references[out.clone()]);
                formula.intervals(rows, stride, profile, &mut intervals[out]);
                done = cases.end;
            }
        },
    );
    chunk.references = references;
    chunk.intervals = intervals;
}
