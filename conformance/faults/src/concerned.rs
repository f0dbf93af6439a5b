//! Which mistakes concern a formula.

use super::catalogue::{faults, generated};
use super::fault::{Concerned, Fault, is_computed, is_in_a_step};
use super::steps::steps_of;
use super::variation::Variation;
use lightmeter_arithmetic::Accept;
use lightmeter_arithmetic::profile::WGSL;
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::{CaseRef, Member};
use std::cell::LazyCell;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Those that concern a formula.
#[must_use]
pub fn concerning(member: &Member) -> Vec<&'static Fault> {
    concerned(member).iter().map(|concerned| concerned.fault).collect()
}

/// Those of the tables that concern a formula, without those that follow from its steps.
#[must_use]
pub fn listed(member: &Member) -> Vec<&'static Fault> {
    concerning(member).into_iter().filter(|fault| !fault.is_generated).collect()
}

impl<'a> Variation<'a> {
    /// The formula with these mistakes; `None` where one does not concern it, or they cannot be made together.
    #[must_use]
    pub fn new(member: &'a Member, faults: &[&'static Fault]) -> Option<Self> {
        let known = concerned(member);
        let find =
            |fault: &&'static Fault| known.iter().find(|concerned| std::ptr::eq(concerned.fault, *fault)).copied();
        Self::of(member, &faults.iter().map(find).collect::<Option<Vec<Concerned>>>()?)
    }
}

/// The mistakes that concern a formula: those that a way fits of, and that show. Found once for each formula.
pub(super) fn concerned(member: &Member) -> Arc<[Concerned]> {
    static KNOWN: LazyLock<Mutex<HashMap<String, Arc<[Concerned]>>>> = LazyLock::new(Mutex::default);
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(found) = known().get(&member.spec.id) {
        return Arc::clone(found);
    }
    let (spec, steps) = (&member.spec, steps_of(member));
    let sample = LazyCell::new(|| Sample::new(member));
    let of_fault = |fault: &&'static Fault| {
        let concerned = Concerned { fault, way: fault.way(spec, &steps)? };
        // What a blend state computes is compared as a function, and what a rasteriser covers is not for a sample to tell.
        let is_sampled = matches!(spec.kind, Kind::Arithmetic | Kind::Depth(_)) || is_in_a_step(concerned.way);
        (!is_sampled || sample.shows(&concerned)).then_some(concerned)
    };
    let mut found: Vec<Concerned> = faults().iter().filter_map(of_fault).collect();
    if is_computed(spec) {
        let mut made: Vec<Vec<f64>> = found.iter().filter_map(|concerned| sample.answers(concerned)).collect();
        for concerned in generated().iter().filter_map(of_fault) {
            let Some(answers) = sample.answers(&concerned) else { continue };
            // What another mistake computes as well is that one.
            if !made.iter().any(|other| is_same(other, &answers)) {
                made.push(answers);
                found.push(concerned);
            }
        }
    }
    let found: Arc<[Concerned]> = found.into();
    known().insert(spec.id.clone(), Arc::clone(&found));
    found
}

/// Whether two mistakes compute the same but for the rounding of f64.
fn is_same(some: &[f64], others: &[f64]) -> bool {
    let is_near = |(a, b): (&f64, &f64)| {
        a.to_bits() == b.to_bits() || (a - b).abs() <= 1e-10 * a.abs().max(b.abs()) || a.is_nan() && b.is_nan()
    };
    some.iter().zip(others).all(is_near)
}

/// Cases of a formula with what is legal in each, on which a mistake must show.
struct Sample<'a> {
    member: &'a Member,
    inputs: Vec<Vec<f32>>,
    legal: Vec<Vec<Accept>>,
}

impl<'a> Sample<'a> {
    /// Random cases, besides the hard ones and those near them.
    const RANDOM: u64 = 1024;
    /// Of the random ones a mistake shows in one of this number, unless in another kind of case.
    const SHARE: usize = 40;

    fn new(member: &'a Member) -> Self {
        let draws = member.draws(0);
        let inputs: Vec<Vec<f32>> = member
            .fixed()
            .chain((0..Self::RANDOM).map(CaseRef::Random))
            .map(|case| {
                let mut row = vec![];
                draws.inputs(case, &mut row);
                row
            })
            .collect();
        let legal = inputs.iter().map(|row| {
            let mut legal = vec![Accept::ANY; member.spec.output_len()];
            member.formula.promised_interval(member.spec.kind, row, &WGSL, &mut legal);
            legal
        });
        let legal = legal.collect();
        Self { member, inputs, legal }
    }

    /// What a mistake computes in f64 of the first cases, and of as many random ones.
    fn answers(&self, concerned: &Concerned) -> Option<Vec<f64>> {
        const CASES: usize = 64;
        let variation = Variation::of(self.member, &[*concerned])?;
        let outputs = self.member.spec.output_len();
        let random = self.inputs.iter().rev().take(CASES);
        let mut answers = vec![];
        for inputs in self.inputs.iter().take(CASES).chain(random) {
            let start = answers.len();
            answers.resize(start + outputs, 0.0);
            variation.evaluate(inputs, &mut answers[start..]);
        }
        Some(answers)
    }

    fn shows(&self, concerned: &Concerned) -> bool {
        let Some(variation) = Variation::of(self.member, &[*concerned]) else { return false };
        let mut out = vec![0.0_f32; self.member.spec.output_len()];
        let random = usize::try_from(Self::RANDOM).unwrap_or(usize::MAX);
        let hard = self.inputs.len() - random;
        let mut is_wrong = |place: &usize| {
            variation.evaluate(&self.inputs[*place], &mut out);
            out.iter().zip(&self.legal[*place]).any(|(&x, legal)| !legal.contains(x.into()))
        };
        let enough = random.div_ceil(Self::SHARE);
        (0..hard).any(|place| is_wrong(&place))
            || (hard..self.inputs.len()).filter(is_wrong).take(enough).count() == enough
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::{Step, formulas};
    use lightmeter_catalogue::cases::{FAMILIES, Kind};
    use std::collections::BTreeSet;

    #[test]
    fn names_are_unique_and_each_fault_concerns_a_formula() {
        assert!(faults().len() >= 60, "{}", faults().len());
        let names: BTreeSet<&str> = faults().iter().map(|fault| fault.name).collect();
        let sentences: BTreeSet<&str> = faults().iter().map(|fault| fault.says).collect();
        assert_eq!((names.len(), sentences.len()), (faults().len(), faults().len()));
        let all: Vec<_> = formulas().iter().flat_map(|member| concerned(member).to_vec()).collect();
        let idle: Vec<&str> = faults()
            .iter()
            .filter(|fault| !all.iter().any(|found| std::ptr::eq(found.fault, **fault)))
            .map(|fault| fault.name)
            .collect();
        assert!(idle.is_empty(), "these concern nothing: {idle:?}");
        // A way that never comes first is a way that is never taken.
        let is_taken = |way: &&'static [Step]| all.iter().any(|found| std::ptr::eq(found.way, *way));
        let idle: Vec<String> = faults()
            .iter()
            .flat_map(|fault| {
                fault.ways.iter().filter(|way| !is_taken(way)).map(|way| format!("{}: {way:?}", fault.name))
            })
            .collect();
        assert!(idle.is_empty(), "these ways fit nothing: {idle:#?}");
    }

    #[test]
    fn every_formula_has_mistakes() {
        let is_special = |member: &&Member| matches!(member.spec.kind, Kind::Blend(program) if program.is_special());
        // Where both triangles of an edge are drawn by one rasteriser, and where a point has one vertex: nothing to exchange.
        let is_without = |member: &&Member| {
            let id = member.spec.id.as_str();
            id == "interpolation/raster-shared-edge" || id.starts_with("interpolation/raster-flat-points")
        };
        let is_asked = |member: &&Member| !is_special(member) && !is_without(member);
        let few = formulas().iter().filter(|member| is_asked(member) && concerned(member).is_empty());
        let few: Vec<&str> = few.map(|member| member.spec.id.as_str()).collect();
        assert!(few.is_empty(), "{few:?}");
    }

    #[test]
    fn what_has_no_highlight_has_no_mistake_in_it() {
        let without = formulas().iter().filter(|member| {
            let spec = &member.spec;
            matches!(spec.family(), "attenuation" | "fog" | "color" | "depth")
        });
        for member in without {
            for fault in concerning(member) {
                let is_of_one = ["highlight", "shininess", "half vector"].iter().any(|word| fault.says.contains(word));
                assert!(!is_of_one, "{} in {}", fault.name, member.spec.id);
            }
        }
    }

    #[test]
    fn no_family_is_without_faults() {
        for family in FAMILIES {
            let count = faults().iter().filter(|fault| {
                let concerns = |member: &&Member| concerning(member).iter().any(|of| std::ptr::eq(*of, **fault));
                formulas().iter().filter(|member| member.spec.family() == family).any(|member| concerns(&member))
            });
            assert!(count.count() >= 5, "{family}");
        }
    }
}
