//! The suite's resolution: for each parameter of each formula the smallest error that a run of 4,096 cases names, by a single
//! verdict and by the group verdict.

use super::group::{Design, Parameter};
use super::selftest::SelftestOptions;
use lightmeter_arithmetic::{Accept, Profile};
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::cases::blend::Program;
use lightmeter_catalogue::select::{CaseRef, Member, Shard, catalogue, select};
use lightmeter_document::event::Stop;
use lightmeter_document::selftest::{OffBy, Resolution};
use lightmeter_judge::diagnose::Answered;
use lightmeter_judge::{Outcome, judge};
use rayon::prelude::*;

/// Cases of a run.
pub const CASES: u64 = 4096;
/// Cases that are tried of those that a parameter shows most in.
const MOST_TRIED: usize = 16;
/// Halvings of an interval of errors: the smallest is known to 1 %.
const HALVINGS: u32 = 12;
/// The widest error that is tried; beyond, a parameter does not count.
const WIDEST: f64 = 16.0;

/// What an error grows by while the group verdict does not name it, and how often.
const STEP: f64 = 1.25;
const MOST_STEPS: u32 = 16;

/// Measures every parameter of every formula that a filter selects. Of the many blend states, which have their operands in
/// common, the named modes stand for all. Once it is told to stop, no other parameter is measured.
#[must_use]
pub fn calibrate(options: &SelftestOptions) -> Vec<Resolution> {
    let members = catalogue();
    let selected = select(&members, &options.filter, 1, Shard::WHOLE);
    let is_measured = |member: &&Member| match member.spec.kind {
        Kind::Raster(_) | Kind::Depth(_) => false,
        Kind::Blend(program) => matches!(program, Program::WithoutAlpha(_)) && member.spec.id.starts_with("blend/mode"),
        Kind::Arithmetic => true,
    };
    let members: Vec<&Member> = selected.iter().map(|chosen| &members[chosen.member]).filter(is_measured).collect();
    let measure = |member| {
        if options.stop.is_set() { vec![] } else { Scale::new(member, options).measure(&options.stop) }
    };
    members.into_par_iter().flat_map_iter(measure).collect()
}

/// 4,096 cases of a formula.
struct Scale<'a> {
    member: &'a Member,
    inputs: Vec<Vec<f32>>,
    reference: Vec<f64>,
    legal: Vec<Accept>,
    /// The embedded implementation's answers.
    right: Vec<f32>,
    design: Design,
}

impl<'a> Scale<'a> {
    fn new(member: &'a Member, options: &'a SelftestOptions) -> Self {
        let spec = &member.spec;
        let profile: &Profile = options.profile;
        let inputs = (0..CASES).map(|k| {
            let mut row = vec![];
            member.inputs(CaseRef::Random(k), options.seed, &mut row);
            row
        });
        let inputs: Vec<Vec<f32>> = inputs.collect();
        let outputs = spec.output_len();
        let mut reference = vec![0.0; inputs.len() * outputs];
        let mut legal = vec![Accept::ANY; inputs.len() * outputs];
        let rows = reference.chunks_exact_mut(outputs).zip(legal.chunks_exact_mut(outputs));
        for (inputs, (reference, legal)) in inputs.iter().zip(rows) {
            member.formula.reference(inputs, reference);
            member.formula.promised_interval(spec.kind, inputs, profile, legal);
        }
        let mut right = vec![0.0; inputs.len() * outputs];
        for (inputs, out) in inputs.iter().zip(right.chunks_exact_mut(outputs)) {
            member.formula.embedded(inputs, out);
        }
        let rows = inputs.iter().zip(reference.chunks_exact(outputs)).zip(legal.chunks_exact(outputs));
        let answered = rows.map(|((inputs, reference), legal)| Answered {
            case: CaseRef::Random(0),
            inputs,
            values: &[],
            reference,
            legal,
            is_wrong: false,
        });
        let answered: Vec<Answered<'_>> = answered.collect();
        let design = Design::new(member, &answered);
        Self { member, inputs, reference, legal, right, design }
    }

    fn measure(&self, stop: &Stop) -> Vec<Resolution> {
        let of = |(place, parameter): (usize, &Parameter)| Resolution {
            formula: self.member.spec.id.clone(),
            parameter: parameter.name.clone(),
            is_output: parameter.is_output,
            error: parameter.error,
            single: self.single(place, parameter),
            group: self.group(place, parameter),
        };
        self.design.parameters.iter().enumerate().take_while(|_| !stop.is_set()).map(of).collect()
    }

    /// The embedded implementation with the parameter off by so much.
    fn answer(&self, case: usize, parameter: &Parameter, amount: f64, out: &mut [f32]) {
        #[expect(clippy::cast_possible_truncation, reason = "a renderer's own parameters are f32")]
        let wrong = |x: &mut f32| {
            *x = match parameter.error {
                OffBy::Scale => (f64::from(*x) * (1.0 + amount)) as f32,
                OffBy::Offset => (f64::from(*x) + amount) as f32,
            };
        };
        let mut inputs = self.inputs[case].clone();
        if !parameter.is_output {
            inputs[parameter.range.clone()].iter_mut().for_each(wrong);
        }
        self.member.formula.embedded(&inputs, out);
        if parameter.is_output {
            out[parameter.range.clone()].iter_mut().for_each(wrong);
        }
    }

    fn fails(&self, case: usize, parameter: &Parameter, amount: f64) -> bool {
        let outputs = self.member.spec.output_len();
        let mut out = vec![0.0; outputs];
        self.answer(case, parameter, amount, &mut out);
        let at = case * outputs;
        out.iter().enumerate().any(|(k, value)| {
            let verdict = judge(value.to_bits(), self.reference[at + k], &self.legal[at + k]);
            verdict.outcome == Outcome::Fail
        })
    }

    /// By bisection, of the cases in which the parameter shows most by its derivative.
    fn single(&self, place: usize, parameter: &Parameter) -> Option<f64> {
        let outputs = self.member.spec.output_len();
        let mut cases: Vec<(f32, usize)> = self
            .design
            .derivatives(place)
            .chunks_exact(outputs)
            .enumerate()
            .map(|(case, slopes)| (slopes.iter().fold(0.0, |most, slope| slope.abs().max(most)), case))
            .filter(|(slope, _)| *slope > 0.0)
            .collect();
        cases.sort_by(|a, b| b.0.total_cmp(&a.0));
        cases.truncate(MOST_TRIED);
        let (steepest, _) = cases.first()?;
        let fails = |amount: f64| cases.iter().any(|&(_, case)| self.fails(case, parameter, amount));
        let mut high = 1.0 / f64::from(*steepest);
        // Below the least f32 nothing changes.
        high = high.max(f64::from(f32::MIN_POSITIVE));
        while !fails(high) {
            high *= 2.0;
            if high > WIDEST {
                return None;
            }
        }
        let mut low = 0.0;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if fails(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(high)
    }

    /// From what the regression's own errors say, upward until the verdict is there.
    fn group(&self, place: usize, parameter: &Parameter) -> Option<f64> {
        let outputs = self.member.spec.output_len();
        let mut values = vec![0.0; self.inputs.len() * outputs];
        let mut named = |amount: f64| {
            for (case, out) in values.chunks_exact_mut(outputs).enumerate() {
                self.answer(case, parameter, amount, out);
            }
            self.design.names(place, &values)
        };
        let mut amount = self.design.least_amount(place, &self.right)?;
        for _ in 0..MOST_STEPS {
            if amount > WIDEST {
                return None;
            }
            if named(amount) {
                return Some(amount);
            }
            amount *= STEP;
        }
        None
    }
}
