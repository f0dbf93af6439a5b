//! The mistakes of the catalogue, as those who judge ask for them.

use crate::diagnose::diagnose;
use crate::group::group_verdict;
use crate::scene::Trial;
use lightmeter_arithmetic::Profile;
use lightmeter_catalogue::select::Member;
use lightmeter_judge::diagnose::{Answered, Cause, Diagnose};
use lightmeter_judge::image::LegalPixel;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_scene::frame::Frame;

/// All mistakes of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Mistakes;

impl Diagnose for Mistakes {
    fn formula(&self, member: &Member, answered: &[Answered<'_>], failing: u64, profile: &Profile) -> Cause {
        let found = diagnose(member, answered, profile);
        let says = found.sentence_of(usize::try_from(failing).unwrap_or(usize::MAX));
        let names = found.explanations.first().map(|first| first.faults.iter().map(ToString::to_string).collect());
        Cause { says, cause: found.cause(), mistakes: names.unwrap_or_default() }
    }

    fn systematic(&self, member: &Member, answered: &[Answered<'_>], profile: &Profile) -> Option<String> {
        group_verdict(member, answered, profile).map(|systematic| systematic.says)
    }

    fn image(&self, frame: &Frame, image: &StoredImage, expected: &[LegalPixel], profile: &Profile) -> Cause {
        let found = Trial::new(frame, image, expected, profile).diagnose();
        let names =
            found.explanations.first().map(|first| first.faults.iter().map(|fault| fault.name.into()).collect());
        Cause { cause: found.cause(), says: found.sentence, mistakes: names.unwrap_or_default() }
    }
}
