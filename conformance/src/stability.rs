//! Hard cases on both sides: the stable form of a formula must keep its claim there, and the naive form is seen to fail.
//!
//! Errors are told in *roundings*: |value − exact| over 2⁻²⁴ of the result's size, the outputs of a case taken together as one
//! vector. `exact` is the stable formula's f64 reference, which the certificate holds against many digits. What no method can
//! do better than is the *condition*: so many roundings of the result come of one rounding of each input.

use crate::arithmetic::Accept;
use crate::cases::{AnyFormula, Naive, Size, Spec, Stable};
use crate::evaluate::{Evaluator, kernel};
use crate::report::{Number, Report};
use crate::run::Options;
use crate::select::{CaseRef, Member, catalogue};
use crate::subject::Subject;
use lightmeter_gpu::{Error, RepeatPipeline};
use serde::Serialize;
use std::collections::BTreeMap;

/// A rounding to nearest of a number near 1, at most.
pub const ROUNDING: f64 = 1.0 / 16_777_216.0;

/// A hard case by its stable and its naive form, on an adapter in a stage. Errors are in roundings, the greatest at the case
/// and within a few ULP of it; infinite where a value is NaN or infinite.
#[derive(Clone, Debug, Serialize)]
pub struct Examined {
    /// The case, of the stable formula.
    pub id: String,
    /// The adapter's short name.
    pub adapter: String,
    /// The stage's name.
    pub stage: &'static str,
    /// How much the result amplifies the inputs' errors at the case itself.
    pub condition: Number,
    /// What the stable form claims.
    pub bound: f64,
    /// The stable form's error.
    pub stable: Number,
    /// The case near by where that is.
    pub stable_at: String,
    /// The naive formula.
    pub naive_formula: &'static str,
    /// What goes wrong with it.
    pub fails: &'static str,
    /// By how much at least.
    pub naive_at_least: Number,
    /// The naive form's error.
    pub naive: Number,
}

impl Examined {
    /// Whether the stable form keeps its claim.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.stable.0 <= self.bound
    }

    /// Whether the naive form fails as it is said to.
    #[must_use]
    pub fn naive_fails(&self) -> bool {
        self.naive.0 >= self.naive_at_least.0
    }
}

/// The error of a result in roundings.
#[must_use]
pub fn roundings(values: &[f64], exact: &[f64], size: Size) -> f64 {
    let off = norm(values.iter().zip(exact).map(|(value, exact)| value - exact));
    if off.is_nan() {
        return f64::INFINITY;
    }
    if off == 0.0 { 0.0 } else { off / (ROUNDING * size_of(exact, size)) }
}

/// What a formula's errors are relative to: as it claims, or, where it claims nothing, 1 for a colour, a share of what is seen.
#[must_use]
pub fn size(spec: &Spec) -> Size {
    let is_color = spec.outputs.iter().all(|output| output.unit == "color");
    spec.stable.map_or(if is_color { Size::Unit } else { Size::Own }, |stable| stable.size)
}

fn size_of(exact: &[f64], size: Size) -> f64 {
    let own = norm(exact.iter().copied());
    match size {
        Size::Own => own,
        Size::Unit => own.max(1.0),
    }
}

/// √Σx², without overflow or underflow for what an f32 can hold.
fn norm(of: impl Iterator<Item = f64>) -> f64 {
    of.map(|x| x * x).sum::<f64>().sqrt()
}

/// How many roundings of a result come of one rounding of each input: Σᵢ |xᵢ|·|∂y/∂xᵢ| over the result's size.
#[must_use]
pub fn condition(formula: &dyn AnyFormula, inputs: &[f32], size: Size) -> f64 {
    let by_input = formula.derivatives(inputs);
    let moved: f64 = inputs
        .iter()
        .zip(&by_input)
        .filter(|(x, _)| **x != 0.0)
        .map(|(&x, outputs)| f64::from(x).abs() * norm(outputs.iter().map(|output| output.slope)))
        .sum();
    let values: Vec<f64> =
        by_input.first().map(|outputs| outputs.iter().map(|y| y.value).collect()).unwrap_or_default();
    if moved == 0.0 { 0.0 } else { moved / size_of(&values, size) }
}

/// The rows of a hard case: itself, and those near it.
struct Rows {
    cases: Vec<CaseRef>,
    inputs: Vec<f32>,
}

impl Rows {
    fn of(member: &Member, places: &[usize], seed: u64) -> Self {
        let near = |&place: &usize| (0..member.near()).map(move |k| CaseRef::Near(place, k));
        let cases: Vec<CaseRef> =
            places.iter().flat_map(|place| std::iter::once(CaseRef::Hard(*place)).chain(near(place))).collect();
        let mut inputs = vec![];
        for &case in &cases {
            member.inputs(case, seed, &mut inputs);
        }
        Self { cases, inputs }
    }

    fn place(case: CaseRef) -> usize {
        match case {
            CaseRef::Hard(place) | CaseRef::Near(place, _) => place,
            CaseRef::Random(_) => unreachable!("only hard cases and those near them are rows here"),
        }
    }
}

/// The greatest error at each hard case, and at which row.
type Worst = BTreeMap<usize, (f64, CaseRef)>;

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
) -> Result<(), Error> {
    let Some(stable) = member.spec.stable else { return Ok(()) };
    let naive = |place: usize| member.spec.hard[place].naive;
    let places: Vec<usize> = hard.iter().copied().filter(|&place| naive(place).is_some()).collect();
    if places.is_empty() {
        return Ok(());
    }
    let rows = Rows::of(member, &places, options.seed);
    let conditions: BTreeMap<usize, f64> = rows
        .cases
        .iter()
        .zip(rows.inputs.chunks_exact(member.spec.input_len()))
        .filter(|(case, _)| matches!(case, CaseRef::Hard(_)))
        .map(|(&case, inputs)| (Rows::place(case), condition(member.formula.as_ref(), inputs, stable.size)))
        .collect();
    let exact = references(member, &rows);
    let rivals = rivals(places.iter().filter_map(|&place| naive(place)));
    for subject in subjects {
        let own = errors(member, stable, &rows, &exact, subject, options)?;
        let mut others = BTreeMap::new();
        for (id, rival) in &rivals {
            others.insert(*id, errors(rival, stable, &rows, &exact, subject, options)?);
        }
        if options.again {
            report.stable_costs.extend(cost(member, &rivals, subject, options)?);
        }
        for (stage, worst) in own {
            for (&place, &(error, at)) in &worst {
                let Some(naive) = naive(place) else { continue };
                let of_naive = others[naive.formula].iter().find(|(other, _)| *other == stage);
                let Some((naive_error, _)) = of_naive.and_then(|(_, worst)| worst.get(&place)) else { continue };
                report.stability.push(Examined {
                    id: member.case_id(CaseRef::Hard(place)),
                    adapter: subject.identity.name.clone(),
                    stage,
                    condition: Number(conditions[&place]),
                    bound: stable.bound,
                    stable: Number(error),
                    stable_at: member.case_id(at),
                    naive_formula: naive.formula,
                    fails: naive.fails,
                    naive_at_least: Number(naive.at_least),
                    naive: Number(*naive_error),
                });
            }
        }
    }
    Ok(())
}

/// What a stable form takes beside a naive one, in the compute stage: nanoseconds of wall time for an evaluation, medians of
/// turns in which each is measured, less what reading the inputs takes.
#[derive(Clone, Debug, Serialize)]
pub struct Cost {
    /// The stable formula.
    pub formula: String,
    /// The naive one.
    pub naive: &'static str,
    /// The adapter's short name.
    pub adapter: String,
    /// Of the stable form.
    pub stable_ns: f64,
    /// Of the naive form.
    pub naive_ns: f64,
    /// Of reading the inputs, which is in neither.
    pub idle_ns: f64,
    /// Median of the stable form's time over the naive one's, turn by turn, reading included in both.
    pub ratio: f64,
    /// Its lower and upper quartile.
    pub quartiles: [f64; 2],
}

/// Turns that a cost is the median of.
const TURNS: usize = 15;
/// Random cases that are evaluated in turn.
const COST_ROWS: u64 = 1024;

/// Measures a stable form against its naive ones, in turns.
fn cost(
    member: &Member,
    rivals: &BTreeMap<&'static str, Member>,
    subject: &Subject,
    options: &Options,
) -> Result<Vec<Cost>, Error> {
    let Some(gpu) = subject.gpu() else { return Ok(vec![]) };
    let mut rows = vec![];
    for k in 0..COST_ROWS {
        member.inputs(CaseRef::Random(k), options.seed, &mut rows);
    }
    let kernel_of = |member: &Member| Ok(kernel(&options.shaders, member)?.expect("arithmetic has a shader function"));
    let own = kernel_of(member)?;
    let Ok(idle) = RepeatPipeline::idle(gpu, &own, &rows)? else { return Ok(vec![]) };
    let Ok(stable) = RepeatPipeline::new(gpu, &options.shaders, &own, &rows)? else { return Ok(vec![]) };
    let mut costs = vec![];
    for (id, rival) in rivals {
        let Ok(naive) = RepeatPipeline::new(gpu, &options.shaders, &kernel_of(rival)?, &rows)? else { continue };
        for warm in [&idle, &stable, &naive] {
            warm.time(gpu)?;
        }
        let turns: Vec<[f64; 3]> = (0..TURNS)
            .map(|_| Ok([idle.time(gpu)?, stable.time(gpu)?, naive.time(gpu)?]))
            .collect::<Result<_, Error>>()?;
        let sorted = |of: &dyn Fn(&[f64; 3]) -> f64| {
            let mut all: Vec<f64> = turns.iter().map(of).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let median_ns = |of: &dyn Fn(&[f64; 3]) -> f64| sorted(of)[TURNS / 2] * 1e9;
        let ratios = sorted(&|[_, stable, naive]| stable / naive);
        costs.push(Cost {
            formula: member.spec.id.clone(),
            naive: id,
            adapter: subject.identity.name.clone(),
            stable_ns: median_ns(&|[idle, stable, _]| stable - idle),
            naive_ns: median_ns(&|[idle, _, naive]| naive - idle),
            idle_ns: median_ns(&|[idle, ..]| *idle),
            ratio: ratios[TURNS / 2],
            quartiles: [ratios[TURNS / 4], ratios[TURNS - 1 - TURNS / 4]],
        });
    }
    Ok(costs)
}

/// The naive formulas that some cases name.
fn rivals(named: impl Iterator<Item = Naive>) -> BTreeMap<&'static str, Member> {
    let wanted: Vec<&'static str> = named.map(|naive| naive.formula).collect();
    let member = |member: Member| wanted.iter().find(|id| **id == member.spec.id).map(|id| (*id, member));
    catalogue().into_iter().filter_map(member).collect()
}

fn references(member: &Member, rows: &Rows) -> Vec<f64> {
    let (inputs, outputs) = (member.spec.input_len(), member.spec.output_len());
    let mut exact = vec![0.0; rows.cases.len() * outputs];
    for (inputs, exact) in rows.inputs.chunks_exact(inputs).zip(exact.chunks_exact_mut(outputs)) {
        member.formula.reference(inputs, exact);
    }
    exact
}

/// The greatest error of a form at each hard case, in each stage that takes rows.
fn errors(
    form: &Member,
    stable: Stable,
    rows: &Rows,
    exact: &[f64],
    subject: &mut Subject,
    options: &Options,
) -> Result<Vec<(&'static str, Worst)>, Error> {
    let (members, outputs) = ([form], form.spec.output_len());
    let evaluator = Evaluator::new(subject, &members, &options.shaders)?;
    let mut found = vec![];
    for (stage, words) in evaluator.run(subject, &vec![0; rows.cases.len()], &rows.inputs)? {
        let Ok(words) = words else { continue };
        let mut worst = Worst::new();
        let of_rows = words.chunks_exact(outputs).zip(exact.chunks_exact(outputs)).zip(&rows.cases);
        for ((words, exact), &case) in of_rows {
            let values: Vec<f64> = words.iter().map(|&bits| f64::from(f32::from_bits(bits))).collect();
            let error = roundings(&values, exact, stable.size);
            let entry = worst.entry(Rows::place(case)).or_insert((error, case));
            if error > entry.0 {
                *entry = (error, case);
            }
        }
        found.push((stage.name(), worst));
    }
    Ok(found)
}

/// The group verdict: what a stable form that breaks its claim is told by.
#[must_use]
pub fn problem(examined: &[Examined], group: &str, adapter: &str, stage: &str) -> Option<String> {
    let of_group =
        |one: &&Examined| one.adapter == adapter && one.stage == stage && one.id.starts_with(&format!("{group}/"));
    let broken: Vec<&Examined> = examined.iter().filter(of_group).filter(|one| !one.is_stable()).collect();
    let worst = broken.iter().max_by(|a, b| (a.stable.0 / a.bound).total_cmp(&(b.stable.0 / b.bound)))?;
    Some(format!(
        "unstable at {} hard case{}: at {} it errs by {} roundings, where the form claims {}",
        broken.len(),
        if broken.len() == 1 { "" } else { "s" },
        worst.stable_at,
        Number(worst.stable.0.round()),
        worst.bound
    ))
}

/// What a form's legal values say of it at a case, apart from any renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Standing {
    /// The result moves by no more than a few roundings, and so do the legal values.
    Stable,
    /// The inputs' own roundings move the result by more than [`ILL_CONDITIONED`] of its roundings: with inputs that were
    /// rounded before no method can do better.
    IllConditioned,
    /// The legal values reach farther than [`UNSTABLE`] times what the condition explains: the fault of the form.
    Unstable,
    /// The rules permit anything, though the result is a number: the fault of the form.
    NothingPromised,
    /// There is no value, or the least change of an input makes another of it.
    Singular,
}

/// Ten bits are lost by the inputs' own rounding.
pub const ILL_CONDITIONED: f64 = 1024.0;

/// How far the legal values of a form reach, in roundings, over what its condition explains: beyond this the form is to blame.
/// Of random cases of published formulas less than 1 in 500 are called unstable (a test holds that), most of them forward
/// differences, which are.
pub const UNSTABLE: f64 = 256.0;

/// How well a case can be computed, and how well a form promises to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Conditioning {
    /// How many roundings of the result come of one rounding of each input.
    pub condition: Number,
    /// How many roundings the legal values reach from the reference; infinite where anything is legal.
    pub reach: Number,
    /// What follows.
    pub standing: Standing,
}

impl Conditioning {
    /// Of a formula at a case, by its legal values in force.
    #[must_use]
    pub fn of(member: &Member, inputs: &[f32], legal: &[Accept]) -> Self {
        let size = size(&member.spec);
        let mut exact = vec![0.0; member.spec.output_len()];
        member.formula.reference(inputs, &mut exact);
        let condition = condition(member.formula.as_ref(), inputs, size);
        let farthest = exact
            .iter()
            .zip(legal)
            .map(|(x, legal)| if legal.is_any() { f64::INFINITY } else { (x - legal.low()).max(legal.high() - x) });
        let farthest = norm(farthest);
        let reach = if farthest == 0.0 { 0.0 } else { farthest / (ROUNDING * size_of(&exact, size)) };
        let is_number = exact.iter().all(|x| x.is_finite());
        let standing = if !is_number || !condition.is_finite() {
            Standing::Singular
        } else if reach.is_nan() || reach.is_infinite() {
            Standing::NothingPromised
        } else if reach > UNSTABLE * (1.0 + condition) {
            Standing::Unstable
        } else if condition > ILL_CONDITIONED {
            Standing::IllConditioned
        } else {
            Standing::Stable
        };
        Self { condition: Number(condition), reach: Number(reach), standing }
    }

    /// In a line.
    #[must_use]
    pub fn text(&self) -> String {
        let rounded = |x: Number| {
            if x.0 >= 1e5 {
                format!("{:.1e}", x.0)
            } else if x.0 < 10.0 {
                format!("{:.2}", x.0)
            } else {
                format!("{:.0}", x.0)
            }
        };
        let (condition, reach) = (rounded(self.condition), rounded(self.reach));
        let times = rounded(Number(self.reach.0 / (1.0 + self.condition.0)));
        let moves = format!("a rounding of each input moves the result by {condition} of its own");
        match self.standing {
            Standing::Stable => format!("{moves}; legal values reach {reach}: stable"),
            Standing::IllConditioned => {
                format!(
                    "{moves}; legal values reach {reach}: ill-conditioned: with inputs that were rounded no method can do better"
                )
            }
            Standing::Unstable => {
                format!(
                    "{moves}; legal values reach {reach}, {times} times what that explains: unstable, the fault of the form"
                )
            }
            Standing::NothingPromised => format!("{moves}; yet anything is legal: the fault of the form"),
            Standing::Singular => "there is no value here, or the least change of an input makes another of it".into(),
        }
    }
}
