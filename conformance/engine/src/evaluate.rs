//! Formulas evaluated by a subject on rows of inputs from anywhere, apart from a run.

use crate::device::{Code, DeviceError};
use crate::rows::Rows;
use crate::subject::{Compiled, Subject};
use lightmeter_catalogue::cases::Stage;
use lightmeter_catalogue::select::Member;

/// A group of formulas compiled for one subject, for rows of inputs from anywhere.
pub struct Evaluator<'a> {
    members: &'a [&'a Member],
    compiled: Compiled,
}

/// The outputs' bits of each row in a stage, or why the stage is skipped.
pub type StageOutputs = (Stage, Result<Vec<u32>, &'static str>);

impl<'a> Evaluator<'a> {
    /// Compiles the formulas, which must be of one group.
    ///
    /// # Errors
    /// Where a shader is invalid or the device refuses it.
    pub fn new(subject: &mut Subject, members: &'a [&'a Member], code: &Code) -> Result<Self, DeviceError> {
        let compiled = subject.compile(code, members[0])?;
        Ok(Self { members, compiled })
    }

    /// Evaluates rows in every stage: `of` names the formula of each row by its place among the members.
    ///
    /// # Errors
    /// Where the device fails.
    pub fn run(&self, subject: &mut Subject, of: &[usize], inputs: &[f32]) -> Result<Vec<StageOutputs>, DeviceError> {
        let (stride, mut selected) = (self.members[0].spec.input_len(), vec![]);
        for (&of, row) in of.iter().zip(inputs.chunks_exact(stride)) {
            selected.extend(self.members[of].spec.selectors.iter().map(|&code| f32::from_bits(code)));
            selected.extend_from_slice(row);
        }
        let outputs = self.members[0].spec.output_len();
        let rows = Rows { members: self.members, of, cases: &[], inputs, selected: &selected, outputs };
        let stages = self.compiled.stages.iter().map(|(stage, work)| match work {
            Err(reason) => Ok((*stage, Err(*reason))),
            Ok(work) => {
                let job = subject.submit(work, &rows)?;
                Ok((*stage, Ok(subject.finish(work, job, &rows, &mut |_| {})?.words)))
            }
        });
        stages.collect()
    }
}
