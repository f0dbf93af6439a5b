//! What a mistake is, and which formulas it concerns.

use super::alteration::At;
use super::blend;
use super::change::{After, Before};
use super::steps::{Seen, steps_of};
use lightmeter_catalogue::cases::blend::Samples;
use lightmeter_catalogue::cases::{Kind, Spec};
use lightmeter_catalogue::select::{Member, catalogue_of};
use lightmeter_scene::depth::DepthTest;
use std::sync::LazyLock;

/// A named mistake that renderers make.
#[derive(Debug)]
pub struct Fault {
    /// Its name in tables and JSON.
    pub name: &'static str,
    /// What it does, as the end of a sentence: "fog uses radial distance".
    pub says: &'static str,
    /// A renderer or a habit that has it, where one is known.
    pub seen_in: Option<&'static str>,
    /// Whether it computes the same but for its rounding, which leaves too much open to be told beside another mistake.
    pub(super) is_rounding: bool,
    /// Whether it was made from the steps and inputs of formulas, and stands in no table.
    pub is_generated: bool,
    /// How it is made, the first way that fits a formula.
    pub(super) ways: &'static [&'static [Step]],
    /// Which of the formulas that a way fits it shows in.
    pub(super) only: fn(&Spec) -> bool,
}

/// A part of a mistake.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// The inputs change.
    Before(Before),
    /// A named step goes wrong.
    At(At),
    /// The blend state or its operands.
    Blend(blend::Twist),
    /// Another depth test.
    Test(fn(DepthTest) -> DepthTest),
    /// Another formula of the catalogue, by pairs of ids; those that begin with `*` are ends of ids.
    Instead(&'static [(&'static str, &'static str)]),
    /// The form that the formula is the stable one of.
    Naive,
    /// The outputs change.
    After(After),
    /// Alpha is the sum of all terms as the colours are, of lights and materials whose own is 1.
    AlphaSummed,
}

impl Step {
    /// The formula that stands in one's place, which takes and gives the same.
    pub(super) fn instead(&self, spec: &Spec) -> Option<&'static Member> {
        let id = match self {
            Self::Instead(pairs) => {
                pairs.iter().find_map(|(from, to)| match (from.strip_prefix('*'), to.strip_prefix('*')) {
                    (Some(from), Some(to)) => spec.id.strip_suffix(from).map(|stem| format!("{stem}{to}")),
                    _ => (spec.id == *from).then(|| (*to).to_owned()),
                })?
            }
            Self::Naive => spec.hard.iter().find_map(|hard| hard.naive)?.formula.to_owned(),
            Self::Test(other) => {
                let Kind::Depth(test) = spec.kind else { return None };
                let other = other(test);
                let is_other = |member: &&Member| matches!(member.spec.kind, Kind::Depth(by) if by == other);
                return formulas().iter().find(is_other).filter(|_| other != test);
            }
            _ => return None,
        };
        let fits = |member: &&Member| {
            member.spec.id == id
                && member.spec.input_len() == spec.input_len()
                && member.spec.output_len() == spec.output_len()
        };
        formulas().iter().find(fits)
    }

    fn fits(&self, spec: &Spec, steps: &[Seen]) -> bool {
        let is_raster = matches!(spec.kind, Kind::Raster(_));
        match self {
            Self::Before(before) => before.fits(spec),
            Self::AlphaSummed => {
                spec.family() == "lighting" && matches!(spec.outputs, [color] if color.shape.components() == 4)
            }
            Self::After(after) => after.fits(spec),
            Self::Instead(_) | Self::Test(_) | Self::Naive => self.instead(spec).is_some(),
            // A rasteriser's answers follow from changed inputs alone.
            Self::At(_) | Self::Blend(_) if is_raster => false,
            Self::At(at) => steps.iter().any(|seen| at.fits(seen.step, seen.sizes, seen.out)),
            Self::Blend(twist) => blend::concerns(spec, &[*twist]),
        }
    }
}

impl Fault {
    /// One that follows from the steps and inputs of formulas.
    pub(super) const fn generated(name: &'static str, says: &'static str, ways: &'static [&'static [Step]]) -> Self {
        Self { name, says, seen_in: None, is_rounding: false, is_generated: true, ways, only: is_computed }
    }

    /// How it is made in a formula whose steps are these: the first way that fits.
    pub(super) fn way(&self, spec: &Spec, steps: &[Seen]) -> Option<&'static [Step]> {
        // NaN and infinity in blending: of what comes out nothing is promised.
        let is_special = matches!(spec.kind, Kind::Blend(program) if program.is_special());
        if is_special || !(self.only)(spec) {
            return None;
        }
        let fits = |way: &&'static [Step]| {
            let other = way.iter().find_map(|step| step.instead(spec)).map(steps_of);
            way.iter().all(|step| step.fits(spec, other.as_deref().unwrap_or(steps)))
        };
        let way = self.ways.iter().copied().find(fits)?;
        let is_state = matches!(spec.kind, Kind::Blend(_)) && !is_in_a_step(way);
        (!is_state || shows_in_blending(spec, way)).then_some(way)
    }
}

/// Whether a formula is computed step by step, and neither a rasteriser's nor a blend unit's.
pub(super) fn is_computed(spec: &Spec) -> bool {
    matches!(spec.kind, Kind::Arithmetic | Kind::Depth(_))
}

/// A mistake that concerns a formula, and how it is made there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Concerned {
    pub(super) fault: &'static Fault,
    pub(super) way: &'static [Step],
}

/// Whether a mistake is made in a named step, which what a blend state computes does not tell.
pub(super) fn is_in_a_step(way: &[Step]) -> bool {
    way.iter().any(|step| matches!(step, Step::At(_)))
}

/// Of some of the many states a mistake makes the same function.
fn shows_in_blending(spec: &Spec, way: &[Step]) -> bool {
    let (mut before, mut twists, mut after) = (vec![], vec![], vec![]);
    for step in way {
        match *step {
            Step::Before(step) => before.push(step),
            Step::Blend(step) => twists.push(step),
            Step::After(step) => after.push(step),
            _ => {}
        }
    }
    blend::differs(spec, &before, &twists, &after)
}

/// The formulas that one is taken for another of.
pub(super) fn formulas() -> &'static [Member] {
    static ALL: LazyLock<Vec<Member>> = LazyLock::new(|| catalogue_of(&Samples { count: 0, ..Samples::default() }));
    &ALL
}
