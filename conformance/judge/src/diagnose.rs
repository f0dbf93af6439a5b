//! What is asked of whoever knows mistakes: which one explains wrong answers.

use crate::image::LegalPixel;
use crate::image::file::StoredImage;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::report::{Diagnosis, Problem};
use lightmeter_scene::frame::Frame;

/// An answer to one case.
#[derive(Clone, Copy, Debug)]
pub struct Answered<'a> {
    /// Which case of the formula it is.
    pub case: CaseRef,
    /// The case's inputs.
    pub inputs: &'a [f32],
    /// What was answered.
    pub values: &'a [f32],
    /// Whether a verdict on it failed.
    pub is_wrong: bool,
}

impl Answered<'_> {
    /// Whether its inputs were drawn, and are none that a formula is hard for.
    #[must_use]
    pub const fn is_random(&self) -> bool {
        matches!(self.case, CaseRef::Random(_))
    }
}

/// Knows mistakes, and tells which one explains answers. `lightmeter_faults` has the one that commands use.
pub trait Diagnose: Sync {
    /// What explains the wrong ones of the answers to a formula. They are a sample of `failing` ones that are wrong.
    fn formula(&self, member: &Member, answered: &[Answered<'_>], failing: u64, profile: &Profile) -> Diagnosis;

    /// What is wrong with answers of which each is legal: a parameter that is a little off. `None` where nothing is found.
    fn systematic(&self, member: &Member, answered: &[Answered<'_>], profile: &Profile) -> Option<Problem>;

    /// What explains a wrong image of a frame.
    fn image(&self, frame: &Frame, image: &StoredImage, expected: &[LegalPixel], profile: &Profile) -> Diagnosis;
}

/// A row that was answered: its inputs, the values, and which case it is.
pub type Row<'a> = (Vec<f32>, &'a [f32], CaseRef);

/// What the diagnosis of all answers to a formula says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Told {
    /// What explains those that are wrong.
    pub diagnosis: Option<Diagnosis>,
    /// What is wrong with all of them together, where none is wrong by itself.
    pub systematic: Option<Problem>,
}

impl Told {
    /// What somebody who knows mistakes tells of answers: of some of the `failing` ones that are wrong, and of some others.
    #[must_use]
    pub fn of(
        diagnose: &dyn Diagnose,
        member: &Member,
        [wrong, right]: [&[Row<'_>]; 2],
        failing: u64,
        profile: &Profile,
    ) -> Self {
        if failing == 0 {
            // Hard cases are where formulas are steep, and say nothing of a parameter.
            let random: Vec<Answered<'_>> = right
                .iter()
                .filter(|(.., case)| matches!(case, CaseRef::Random(_)))
                .map(|(inputs, values, case)| Answered { case: *case, inputs, values, is_wrong: false })
                .collect();
            return Self { systematic: diagnose.systematic(member, &random, profile), ..Self::default() };
        }
        let all = wrong.iter().map(|row| (row, true)).chain(right.iter().map(|row| (row, false)));
        let answered: Vec<Answered<'_>> =
            all.map(|((inputs, values, case), is_wrong)| Answered { case: *case, inputs, values, is_wrong }).collect();
        Self { diagnosis: Some(diagnose.formula(member, &answered, failing, profile)), ..Self::default() }
    }
}
