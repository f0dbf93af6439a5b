//! What a mistake is, which formulas it concerns, and the catalogue of formulas that it is looked up in.

use super::blend;
use super::body::{self, Body};
use super::change::{After, Before};
use super::fog;
use super::lighting;
use super::table;
use lightmeter_catalogue::cases::blend::Samples;
use lightmeter_catalogue::cases::{Kind, Spec};
use lightmeter_catalogue::select::{Member, catalogue_of};
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
    /// A step of lighting is wrong.
    Lighting(lighting::Twist),
    /// A step of fog.
    Fog(fog::Twist),
    /// The blend state or its operands.
    Blend(blend::Twist),
    /// Another body.
    Body(Body),
    /// Another formula of the catalogue, by pairs of ids; those that begin with `*` are ends of ids.
    Instead(&'static [(&'static str, &'static str)]),
    /// The form that the formula is the stable one of.
    Naive,
    /// The outputs change.
    After(After),
}

impl Step {
    /// The formula that stands in one's place, which takes and gives the same.
    pub(super) fn instead(self, spec: &Spec) -> Option<&'static Member> {
        let id = match self {
            Self::Instead(pairs) => {
                pairs.iter().find_map(|(from, to)| match (from.strip_prefix('*'), to.strip_prefix('*')) {
                    (Some(from), Some(to)) => spec.id.strip_suffix(from).map(|stem| format!("{stem}{to}")),
                    _ => (spec.id == *from).then(|| (*to).to_owned()),
                })?
            }
            Self::Naive => spec.hard.iter().find_map(|hard| hard.naive)?.formula.to_owned(),
            _ => return None,
        };
        let fits = |member: &&Member| {
            member.spec.id == id
                && member.spec.input_len() == spec.input_len()
                && member.spec.output_len() == spec.output_len()
        };
        formulas().iter().find(fits)
    }

    fn fits(self, spec: &Spec) -> bool {
        let is_raster = matches!(spec.kind, Kind::Raster(_));
        match self {
            Self::Before(before) => before.fits(spec),
            Self::After(after) => after.fits(spec),
            Self::Instead(_) | Self::Naive => self.instead(spec).is_some(),
            // A rasteriser's answers follow from changed inputs alone.
            _ if is_raster => false,
            Self::Lighting(twist) => lighting::concerns(spec, &[twist]),
            Self::Fog(twist) => fog::concerns(spec, &[twist]),
            Self::Blend(twist) => blend::concerns(spec, &[twist]),
            Self::Body(body) => body::concerns(spec, body),
        }
    }
}

impl Fault {
    /// Whether it concerns a formula.
    #[must_use]
    pub fn concerns(&self, spec: &Spec) -> bool {
        self.steps(spec).is_some()
    }

    /// How it is made in a formula.
    pub(super) fn steps(&self, spec: &Spec) -> Option<&'static [Step]> {
        // NaN and infinity in blending: of what comes out nothing is promised.
        let is_special = matches!(spec.kind, Kind::Blend(program) if program.is_special());
        if is_special || !(self.only)(spec) {
            return None;
        }
        let way = self.ways.iter().copied().find(|way| way.iter().all(|step| step.fits(spec)))?;
        let is_blending = matches!(spec.kind, Kind::Blend(_));
        (!is_blending || shows_in_blending(spec, way)).then_some(way)
    }

    /// The mistake of that name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Self> {
        faults().iter().copied().find(|fault| fault.name == name)
    }
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

/// Every mistake, in the order of tables.
#[must_use]
pub fn faults() -> &'static [&'static Fault] {
    static ALL: LazyLock<Vec<&'static Fault>> = LazyLock::new(|| table::all().collect());
    &ALL
}

/// Those that concern a formula.
pub fn concerning(spec: &Spec) -> impl Iterator<Item = &'static Fault> {
    faults().iter().copied().filter(|fault| fault.concerns(spec))
}

/// The formulas that one is taken for another of.
pub(super) fn formulas() -> &'static [Member] {
    static ALL: LazyLock<Vec<Member>> = LazyLock::new(|| catalogue_of(&Samples { count: 0, ..Samples::default() }));
    &ALL
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::cases::FAMILIES;
    use std::collections::BTreeSet;

    #[test]
    fn names_are_unique_and_each_fault_concerns_a_formula() {
        assert!(faults().len() >= 60, "{}", faults().len());
        let names: BTreeSet<&str> = faults().iter().map(|fault| fault.name).collect();
        let sentences: BTreeSet<&str> = faults().iter().map(|fault| fault.says).collect();
        assert_eq!((names.len(), sentences.len()), (faults().len(), faults().len()));
        for fault in faults() {
            assert!(formulas().iter().any(|member| fault.concerns(&member.spec)), "{} concerns nothing", fault.name);
            // A way that never comes first is a way that is never taken.
            for way in fault.ways {
                let taken = |member: &Member| fault.steps(&member.spec).is_some_and(|steps| std::ptr::eq(steps, *way));
                assert!(formulas().iter().any(taken), "{}: {way:?} fits nothing", fault.name);
            }
        }
    }

    #[test]
    fn no_family_is_without_faults() {
        for family in FAMILIES {
            let count = faults().iter().filter(|fault| {
                formulas().iter().any(|member| member.spec.family() == family && fault.concerns(&member.spec))
            });
            assert!(count.count() >= 5, "{family}");
        }
    }
}
