//! Hard cases on both sides: the stable form of a formula must keep its claim there, and the naive form is seen to fail.
//!
//! Errors are told in *roundings*: |value − exact| over 2⁻²⁴ of the result's size, the outputs of a case taken together as one
//! vector. `exact` is the stable formula's f64 reference, which the certificate holds against many digits. What no method can
//! do better than is the *condition*: how many roundings of the result one rounding of each input causes.

use lightmeter_judge::stability::{condition, roundings};

use crate::device::DeviceError;
use crate::evaluate::Evaluator;
use crate::options::Options;
use crate::subject::Subject;
use lightmeter_catalogue::cases::{Naive, Stable};
use lightmeter_catalogue::select::{CaseRef, Member, catalogue};
use lightmeter_document::report::{Cost, Examined, Problem, ProblemKind, Report, StableForm};
use lightmeter_document::{Number, error_told};
use std::collections::BTreeMap;

/// The rows of a hard case: itself, and those near it.
struct HardRows {
    cases: Vec<CaseRef>,
    inputs: Vec<f32>,
}

impl HardRows {
    fn of(member: &Member, places: &[usize], seed: u64) -> Self {
        let near = |&place: &usize| (0..member.near()).map(move |k| CaseRef::Near(place, k));
        let cases: Vec<CaseRef> =
            places.iter().flat_map(|place| std::iter::once(CaseRef::Hard(*place)).chain(near(place))).collect();
        let (draws, mut inputs) = (member.draws(seed), vec![]);
        for &case in &cases {
            draws.inputs(case, &mut inputs);
        }
        Self { cases, inputs }
    }

    fn place(case: CaseRef) -> usize {
        match case {
            CaseRef::Hard(place) | CaseRef::Near(place, _) => place,
            CaseRef::Boundary(_) | CaseRef::Random(_) => {
                unreachable!("only hard cases and those near them are rows here")
            }
        }
    }
}

/// The greatest error at each hard case, and at which row.
type Worst = BTreeMap<usize, (f64, CaseRef)>;

/// The same by the stage's name.
type InStages = Vec<(&'static str, Worst)>;

/// Examines hard cases, by their places, of a formula that has a stable form: each is evaluated with those near it, by its own
/// shader function and by those of its naive forms, on every subject that has shaders.
///
/// # Errors
/// Where a shader is invalid or a device fails.
pub fn examine(
    member: &Member,
    hard: &[usize],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
) -> Result<(), DeviceError> {
    let Some(stable) = member.spec.stable else { return Ok(()) };
    let places: Vec<usize> = hard.iter().copied().filter(|&place| member.spec.hard[place].naive.is_some()).collect();
    if places.is_empty() {
        return Ok(());
    }
    let examination = Examination::new(member, stable, &places, options.seed);
    for subject in subjects {
        let examined = examination.examined(subject, options)?;
        if options.again {
            report.stable_costs.extend(costs(member, &examination.rivals, subject, options)?);
        }
        report.stability.extend(examined);
    }
    Ok(())
}

/// What the stable forms of a catalogue claim.
#[must_use]
pub fn stable_forms(catalogue: &[Member]) -> Vec<StableForm> {
    let form = |member: &Member| {
        let Stable { bound, because, .. } = member.spec.stable?;
        Some(StableForm { formula: member.spec.id.clone(), bound, because: because.into() })
    };
    catalogue.iter().filter_map(form).collect()
}

/// A formula's stable form, its naive ones, and the rows that all of them are tried on.
struct Examination<'a> {
    member: &'a Member,
    stable: Stable,
    rows: HardRows,
    /// The condition of each hard case.
    conditions: BTreeMap<usize, f64>,
    /// The stable form's f64 reference at each row.
    exact: Vec<f64>,
    /// The naive formulas.
    rivals: BTreeMap<&'static str, Member>,
}

impl<'a> Examination<'a> {
    fn new(member: &'a Member, stable: Stable, places: &[usize], seed: u64) -> Self {
        let rows = HardRows::of(member, places, seed);
        let conditions = rows
            .cases
            .iter()
            .zip(rows.inputs.chunks_exact(member.spec.input_len()))
            .filter(|(case, _)| matches!(case, CaseRef::Hard(_)))
            .map(|(&case, inputs)| (HardRows::place(case), condition(member.formula.as_ref(), inputs, stable.size)))
            .collect();
        let exact = references(member, &rows);
        let rivals = rivals(places.iter().filter_map(|&place| member.spec.hard[place].naive));
        Self { member, stable, rows, conditions, exact, rivals }
    }

    /// What a subject makes of each hard case by each form, in each stage that takes rows.
    fn examined(&self, subject: &mut Subject, options: &Options) -> Result<Vec<Examined>, DeviceError> {
        let own = self.errors(self.member, &self.exact, subject, options)?;
        let mut others = BTreeMap::new();
        for (id, rival) in &self.rivals {
            let errors = self.errors(rival, &self.exact, subject, options)?;
            let roundings = self.errors(rival, &references(rival, &self.rows), subject, options)?;
            others.insert(*id, (errors, roundings));
        }
        let mut examined = vec![];
        for (stage, worst) in own {
            for (place, (error, at)) in worst {
                let Some(naive) = self.member.spec.hard[place].naive else { continue };
                let (errors, roundings) = &others[naive.formula];
                let (Some(error_of_naive), Some(rounding)) =
                    (error_in(errors, stage, place), error_in(roundings, stage, place))
                else {
                    continue;
                };
                examined.push(Examined {
                    id: self.member.case_id(CaseRef::Hard(place)),
                    adapter: subject.identity.name.clone(),
                    stage: stage.into(),
                    condition: Number(self.conditions[&place]),
                    bound: self.stable.bound,
                    stable: Number(error),
                    stable_at: self.member.case_id(at),
                    naive_formula: naive.formula.into(),
                    fails: naive.fails.into(),
                    naive_at_least: Number(naive.at_least),
                    naive: Number(error_of_naive),
                    naive_rounding: Number(rounding),
                });
            }
        }
        Ok(examined)
    }

    /// The greatest error of a form, against values that are exact, at each hard case in each stage that takes rows.
    fn errors(
        &self,
        form: &Member,
        exact: &[f64],
        subject: &mut Subject,
        options: &Options,
    ) -> Result<InStages, DeviceError> {
        let (members, outputs) = ([form], form.spec.output_len());
        let evaluator = Evaluator::new(subject, &members, &options.code)?;
        let mut found = vec![];
        for (stage, words) in evaluator.run(subject, &vec![0; self.rows.cases.len()], &self.rows.inputs)? {
            let Ok(words) = words else { continue };
            let mut worst = Worst::new();
            let of_rows = words.chunks_exact(outputs).zip(exact.chunks_exact(outputs)).zip(&self.rows.cases);
            for ((words, exact), &case) in of_rows {
                let values: Vec<f64> = words.iter().map(|&bits| f64::from(f32::from_bits(bits))).collect();
                let error = roundings(&values, exact, self.stable.size);
                let entry = worst.entry(HardRows::place(case)).or_insert((error, case));
                if error > entry.0 {
                    *entry = (error, case);
                }
            }
            found.push((stage.name(), worst));
        }
        Ok(found)
    }
}

/// The error at a hard case in a stage.
fn error_in(stages: &InStages, stage: &str, place: usize) -> Option<f64> {
    let (_, worst) = stages.iter().find(|(other, _)| *other == stage)?;
    worst.get(&place).map(|(error, _)| *error)
}

/// What the form costs beside naive ones on a subject's device.
fn costs(
    member: &Member,
    rivals: &BTreeMap<&'static str, Member>,
    subject: &Subject,
    options: &Options,
) -> Result<Vec<Cost>, DeviceError> {
    let Some(device) = subject.device() else { return Ok(vec![]) };
    device.stable_costs(&options.code, member, rivals, options.seed)
}

/// The naive formulas that some cases name.
fn rivals(named: impl Iterator<Item = Naive>) -> BTreeMap<&'static str, Member> {
    let wanted: Vec<&'static str> = named.map(|naive| naive.formula).collect();
    let member = |member: Member| wanted.iter().find(|id| **id == member.spec.id).map(|id| (*id, member));
    catalogue().into_iter().filter_map(member).collect()
}

fn references(member: &Member, rows: &HardRows) -> Vec<f64> {
    let (inputs, outputs) = (member.spec.input_len(), member.spec.output_len());
    let mut exact = vec![0.0; rows.cases.len() * outputs];
    for (inputs, exact) in rows.inputs.chunks_exact(inputs).zip(exact.chunks_exact_mut(outputs)) {
        member.formula.reference(inputs, exact);
    }
    exact
}

/// The group verdict: what a stable form that breaks its claim is told by.
#[must_use]
pub fn problem(examined: &[Examined], group: &str, adapter: &str, stage: &str) -> Option<Problem> {
    let of_group =
        |one: &&Examined| one.adapter == adapter && one.stage == stage && one.id.starts_with(&format!("{group}/"));
    let broken: Vec<&Examined> = examined.iter().filter(of_group).filter(|one| !one.is_stable()).collect();
    let worst = broken.iter().max_by(|a, b| (a.stable.0 / a.bound).total_cmp(&(b.stable.0 / b.bound)))?;
    let says = format!(
        "unstable at {} hard case{}: at {} it errs by {}, where the form claims {}; {} is the form that makes no such claim",
        broken.len(),
        if broken.len() == 1 { "" } else { "s" },
        worst.stable_at,
        error_told(Number(worst.stable.0.round()), "roundings"),
        worst.bound,
        worst.naive_formula
    );
    Some(Problem::new(ProblemKind::Stability, says))
}
