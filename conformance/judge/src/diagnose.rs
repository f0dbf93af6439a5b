//! What is asked of whoever knows mistakes: which one explains wrong answers.

use crate::image::LegalPixel;
use crate::image::file::StoredImage;
pub use crate::kept::Answered;
use crate::kept::KeptRow;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::report::{Diagnosis, Problem};
use lightmeter_scene::frame::Frame;
use std::fmt::Debug;

/// Knows mistakes, and tells which one explains answers. `lightmeter_faults` has the one that commands use.
pub trait Diagnose: Sync {
    /// What explains the wrong ones of the answers to a formula. They are a sample of `failing` ones that are wrong.
    fn formula(&self, member: &Member, answered: &[Answered<'_>], failing: u64, profile: &Profile) -> Diagnosis;

    /// What is wrong with answers of which each is legal: a parameter that is a little off. `None` where nothing is found.
    fn systematic(&self, member: &Member, answered: &[Answered<'_>]) -> Option<Problem>;

    /// What explains a wrong image of a frame.
    fn image(&self, frame: &Frame, image: &StoredImage, expected: &[LegalPixel], profile: &Profile) -> Diagnosis;
}

/// Mistakes that a renderer is known to make.
pub trait Made: Debug + Send + Sync {
    /// Whether a wrong answer to a formula is what one of them gives, or all of them together.
    fn explains(&self, member: &Member, answered: &Answered<'_>, profile: &Profile) -> bool;
}

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
        [wrong, right]: [&[(CaseRef, &KeptRow)]; 2],
        failing: u64,
        profile: &Profile,
    ) -> Self {
        let mut right = answered(right, false);
        if failing == 0 {
            // Hard cases are where formulas are steep, and say nothing of a parameter.
            right.retain(Answered::is_random);
            return Self { systematic: diagnose.systematic(member, &right), ..Self::default() };
        }
        let all = [answered(wrong, true), right].concat();
        Self { diagnosis: Some(diagnose.formula(member, &all, failing, profile)), ..Self::default() }
    }
}

fn answered<'a>(rows: &[(CaseRef, &'a KeptRow)], is_wrong: bool) -> Vec<Answered<'a>> {
    rows.iter().map(|(case, row)| row.answers(*case, is_wrong)).collect()
}
