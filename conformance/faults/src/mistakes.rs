//! The mistakes of the catalogue, as those who judge ask for them.

use crate::diagnose::diagnose;
use crate::group::group_verdict;
use crate::scene::Trial;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::select::Member;
use lightmeter_document::report::{Diagnosis, Problem, ProblemKind};
use lightmeter_judge::diagnose::{Answered, Diagnose};
use lightmeter_judge::image::LegalPixel;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_scene::frame::Frame;

/// All mistakes of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Mistakes;

impl Diagnose for Mistakes {
    fn formula(&self, member: &Member, answered: &[Answered<'_>], failing: u64, profile: &Profile) -> Diagnosis {
        let found = diagnose(member, answered, profile);
        Diagnosis { failing, ..found.diagnosis }
    }

    fn systematic(&self, member: &Member, answered: &[Answered<'_>]) -> Option<Problem> {
        let found = group_verdict(member, answered)?;
        Some(Problem::new(ProblemKind::Systematic, found.says))
    }

    fn image(&self, frame: &Frame, image: &StoredImage, expected: &[LegalPixel], profile: &Profile) -> Diagnosis {
        Trial::new(frame, image, expected, profile).diagnose().diagnosis
    }
}
