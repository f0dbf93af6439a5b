//! The group verdict: each answer may be legal and all of them together still wrong. Residuals are regressed on the formula's
//! derivatives, so that a parameter that is a little off is told from rounding, and named.

use super::factor::digits;
use lightmeter_catalogue::cases::{Kind, Spec};
use lightmeter_catalogue::select::Member;
use lightmeter_document::selftest::{OffBy, Systematic};
use lightmeter_judge::diagnose::Answered;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::hash::Hash;
use std::ops::Range;

/// A number of a formula's that may be off: an input as a whole, one number of an input, or an output.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) is_output: bool,
    pub(super) range: Range<usize>,
    pub(super) error: OffBy,
}

impl Parameter {
    /// Numbers first, then vectors, then numbers of vectors, then outputs.
    fn rank(&self) -> u8 {
        match (self.is_output, self.name.contains('.'), self.range.len()) {
            (true, _, _) => 3,
            (false, true, _) => 2,
            (false, false, 1) => 0,
            (false, false, _) => 1,
        }
    }
}

/// Values that a group verdict takes at least.
pub const LEAST_VALUES: usize = 4096;
/// Standard errors from which a systematic error is named.
///
/// Some 3,000 parameters of all formulas are tried in a run. Were residuals normal and independent, one of them would reach 8
/// by chance in 10¹¹ runs; in random legal evaluations none exceeds 7. Those of one implementation are not independent, so
/// the shift that is named must besides be at least [`LEAST_SHARE`].
pub const LEAST_Z: f64 = 8.0;
/// The share of the tolerance that the shift comes to at least.
///
/// Constants that are rounded to f32, and rounding where few inputs differ (256 bytes), shift the answers of one
/// implementation all alike, and are legal: by 0.112 of the tolerance at most in the embedded one.
pub const LEAST_SHARE: f64 = 0.125;
/// The error of a parameter from which it is named, relative to the parameter: two roundings to binary32.
///
/// A constant is rounded, and a division by one may be a multiplication by its reciprocal, which is rounded too: `SwiftShader` computes byte/255 so. All
/// answers are then off alike, by as much as if a parameter were, and all of it is legal.
pub const LEAST_ERROR: f64 = 1.0 / 8_388_608.0;
/// Residuals are cut to this number of tolerances, so that one case far off does not decide.
const FARTHEST: f64 = 4.0;
/// Cases that a task of the pool takes at once.
const TASK: usize = 256;
/// The number of iterations of the regression; each one is done on the residuals that the previous one left.
const ROUNDS: usize = 4;

/// The parameters of a formula: each input as a whole and each of its numbers, each output as a whole, scaled and moved.
pub(super) fn parameters(spec: &Spec) -> Vec<Parameter> {
    let mut found = vec![];
    let mut push = |name: &str, is_output: bool, range: Range<usize>, error: OffBy| {
        found.push(Parameter { name: name.into(), is_output, range, error });
    };
    let mut start = 0;
    for input in spec.inputs {
        let range = start..start + input.shape.components();
        start = range.end;
        push(input.name, false, range.clone(), OffBy::Scale);
        if range.len() == 1 {
            push(input.name, false, range, OffBy::Offset);
        } else {
            for number in range {
                push(&spec.input_name(number), false, number..number + 1, OffBy::Scale);
                push(&spec.input_name(number), false, number..number + 1, OffBy::Offset);
            }
        }
    }
    let mut start = 0;
    for output in spec.outputs {
        let range = start..start + output.shape.components();
        start = range.end;
        push(output.name, true, range.clone(), OffBy::Scale);
        push(output.name, true, range, OffBy::Offset);
    }
    found
}

/// Cases with their references, tolerances and derivatives, against which any answers can be held.
pub(super) struct Design {
    outputs: usize,
    reference: Vec<f64>,
    /// 1 over the tolerance; 0 where an output counts for nothing.
    weight: Vec<f64>,
    pub(super) parameters: Vec<Parameter>,
    /// For each parameter the derivative of each output of each case, in tolerances.
    derivatives: Vec<Vec<f32>>,
    /// For each parameter what its error is measured by: 1 for a scale, its root mean square for an offset.
    sizes: Vec<f64>,
    /// Values that are no independent samples, by each reason for it.
    clusters: Vec<Clusters>,
}

/// Values that are no independent samples: their roundings are the same.
pub(super) struct Clusters {
    /// The cluster of each output of each case.
    of_value: Vec<usize>,
    count: usize,
}

impl Clusters {
    /// An input counts as shared by many cases if, on average, at least this many cases have each of its values.
    const MANY: usize = 8;
    /// The fewest clusters that can reach [`LEAST_Z`]: if n clusters all show the same error, it differs from 0 by √n standard errors.
    const LEAST: usize = 64;

    /// Those that have a key in common.
    fn by<K: Eq + Hash>(keys: impl Iterator<Item = K>) -> Self {
        let mut known = HashMap::new();
        let of_value = keys.map(|key| {
            let next = known.len();
            *known.entry(key).or_insert(next)
        });
        Self { of_value: of_value.collect(), count: known.len() }
    }

    /// Cases with the same result, as the corners of blend states have, which come again and again.
    fn by_reference(design: &Design) -> Self {
        Self::by(design.reference.iter().map(|reference| reference.to_bits()))
    }

    /// Clusters of cases that have the same value of an input with few different values, such as a blend state's constant, which has two.
    /// Whatever is computed from that input alone is rounded identically in all of them. `None` if the outputs depend on no such input.
    fn by_input(rows: &[&[f32]], design: &Design) -> Option<Self> {
        let is_used = |number: usize| {
            let is_of = |parameter: &Parameter| !parameter.is_output && parameter.range.contains(&number);
            let parameters = design.parameters.iter().zip(&design.derivatives);
            let mut derivatives = parameters.filter(|(parameter, _)| is_of(parameter));
            derivatives.any(|(_, derivatives)| derivatives.iter().any(|&d| d != 0.0))
        };
        let is_shared = |&number: &usize| {
            let values: HashSet<u32> = rows.iter().map(|row| row[number].to_bits()).collect();
            values.len() * Self::MANY <= rows.len() && is_used(number)
        };
        let shared: Vec<usize> = (0..rows.first()?.len()).filter(is_shared).collect();
        let key = |row: &&[f32]| shared.iter().map(|&number| row[number].to_bits()).collect::<Vec<u32>>();
        let keys = rows.iter().flat_map(|row| std::iter::repeat_n(key(row), design.outputs));
        (!shared.is_empty()).then(|| Self::by(keys))
    }

    /// By how many standard errors the moments of all cases differ from 0, were each cluster one sample.
    fn z(&self, moments: impl Iterator<Item = f64>) -> f64 {
        let mut sums = vec![0.0; self.count];
        for (place, moment) in moments.enumerate() {
            sums[self.of_value[place]] += moment;
        }
        let variance: f64 = sums.iter().map(|sum| sum * sum).sum();
        if variance > 0.0 { sums.iter().sum::<f64>() / variance.sqrt() } else { 0.0 }
    }
}

impl Design {
    /// Works out what does not depend on the answers, on all cores.
    pub(super) fn new(member: &Member, answered: &[Answered<'_>]) -> Self {
        let parts: Vec<Self> = answered.par_chunks(TASK).map(|rows| Self::part(member, rows)).collect();
        let rows: Vec<&[f32]> = answered.iter().map(|row| row.inputs).collect();
        let mut design = Self::part(member, &[]);
        for part in parts {
            design.reference.extend(part.reference);
            design.weight.extend(part.weight);
            for (derivatives, of_part) in design.derivatives.iter_mut().zip(part.derivatives) {
                derivatives.extend(of_part);
            }
        }
        design.sizes = design.parameters.iter().map(|parameter| design.size(parameter, &rows)).collect();
        design.clusters.push(Clusters::by_reference(&design));
        design.clusters.extend(Clusters::by_input(&rows, &design));
        design
    }

    /// The same of some rows.
    fn part(member: &Member, rows: &[Answered<'_>]) -> Self {
        let spec = &member.spec;
        let outputs = spec.output_len();
        let parameters = parameters(spec);
        let mut design = Self {
            outputs,
            reference: vec![],
            weight: vec![],
            derivatives: vec![vec![]; parameters.len()],
            parameters,
            sizes: vec![],
            clusters: vec![],
        };
        for &Answered { inputs: row, reference, legal, .. } in rows {
            let slopes = member.formula.derivatives(row);
            let start = design.reference.len();
            for (&reference, legal) in reference.iter().zip(legal) {
                let half = legal.width() * 0.5;
                let counts = !legal.is_any() && half > 0.0 && half.is_finite() && reference.is_finite();
                design.reference.push(reference);
                design.weight.push(if counts { 1.0 / half } else { 0.0 });
            }
            for (parameter, derivatives) in design.parameters.iter().zip(&mut design.derivatives) {
                for output in 0..outputs {
                    let weight = design.weight[start + output];
                    let slope = if parameter.is_output {
                        match (parameter.range.contains(&output), parameter.error) {
                            (false, _) => 0.0,
                            (true, OffBy::Scale) => reference[output],
                            (true, OffBy::Offset) => 1.0,
                        }
                    } else {
                        parameter
                            .range
                            .clone()
                            .map(|number| {
                                let by = if parameter.error == OffBy::Scale { f64::from(row[number]) } else { 1.0 };
                                if by == 0.0 { 0.0 } else { slopes[number][output].slope * by }
                            })
                            .sum()
                    };
                    #[expect(clippy::cast_possible_truncation, reason = "a weight needs no more digits")]
                    let derivative = (slope * weight) as f32;
                    derivatives.push(if derivative.is_finite() { derivative } else { 0.0 });
                }
            }
        }
        design
    }

    /// What a parameter's error is measured by.
    fn size(&self, parameter: &Parameter, rows: &[&[f32]]) -> f64 {
        if parameter.error == OffBy::Scale {
            return 1.0;
        }
        let root_mean_square = |values: &mut dyn Iterator<Item = f64>| {
            let (sum, count) =
                values.filter(|x| x.is_finite()).fold((0.0, 0.0), |(sum, n), x| (x.mul_add(x, sum), n + 1.0));
            if count > 0.0 { f64::sqrt(sum / count) } else { 0.0 }
        };
        if parameter.is_output {
            let outputs = |k: usize| parameter.range.contains(&(k % self.outputs));
            let values = self.reference.iter().enumerate().filter(|(k, _)| outputs(*k));
            root_mean_square(&mut values.map(|(_, &reference)| reference))
        } else {
            root_mean_square(
                &mut rows.iter().flat_map(|row| row[parameter.range.clone()].iter().map(|&x| f64::from(x))),
            )
        }
    }

    /// The residuals of answers, in tolerances; `None` where too few values count.
    fn residuals(&self, values: &[f32]) -> Option<Vec<f64>> {
        let mut counted = 0;
        let residuals = values.iter().zip(&self.reference).zip(&self.weight).map(|((&value, reference), weight)| {
            let residual = (f64::from(value) - reference) * weight;
            let counts = *weight > 0.0 && residual.is_finite();
            counted += usize::from(counts);
            if counts { residual } else { 0.0 }
        });
        let residuals: Vec<f64> = residuals.collect();
        (counted >= LEAST_VALUES.min(1024 * self.outputs)).then_some(residuals)
    }

    /// The verdict on the answers, of all cases in order.
    pub(super) fn verdict(&self, values: &[f32]) -> Option<Systematic> {
        let residuals = self.residuals(values)?;
        let regressed: Vec<Regressed> =
            (0..self.parameters.len()).into_par_iter().map(|place| self.regressed(&residuals, place)).collect();
        let strongest = regressed.iter().filter(|r| r.is_named()).map(|r| r.z.abs()).fold(0.0, f64::max);
        // Among parameters that explain the residuals about equally well, prefer an input that is a single number, then an input that is a
        // vector.
        let best = (0..regressed.len())
            .filter(|&place| regressed[place].is_named() && regressed[place].z.abs() >= 0.99 * strongest)
            .min_by(|&a, &b| {
                let rank = |place: usize| self.parameters[place].rank();
                rank(a).cmp(&rank(b)).then(regressed[b].z.abs().total_cmp(&regressed[a].z.abs()))
            })?;
        let Regressed { amount, z, share, .. } = regressed[best];
        let parameter = &self.parameters[best];
        let as_well = |place: &usize| *place != best && regressed[*place].z.abs() >= 0.99 * z.abs();
        let or = (0..regressed.len()).filter(as_well).map(|place| self.parameters[place].name.clone());
        let mut or: Vec<String> = or.filter(|name| *name != parameter.name).collect();
        or.dedup();
        Some(Systematic {
            parameter: parameter.name.clone(),
            is_output: parameter.is_output,
            error: parameter.error,
            amount,
            z: z.abs(),
            share,
            or,
            says: says(parameter, amount),
        })
    }

    /// For each output of each case the derivative by a parameter, in tolerances.
    pub(super) fn derivatives(&self, place: usize) -> &[f32] {
        &self.derivatives[place]
    }

    /// Whether the answers show that the parameter is off, even if another parameter would be reported instead of it.
    pub(super) fn names(&self, place: usize, values: &[f32]) -> bool {
        self.residuals(values).is_some_and(|residuals| self.regressed(&residuals, place).is_named())
    }

    /// A parameter's error, as certain as the number of independent samples makes it.
    fn regressed(&self, residuals: &[f64], place: usize) -> Regressed {
        let derivatives = &self.derivatives[place];
        let regressed = Regressed::new(residuals, derivatives);
        let Some(limit) = limit(derivatives) else { return regressed };
        let moment = |(r, &d): (&f64, &f32)| f64::from(d).clamp(-limit, limit) * r.clamp(-FARTHEST, FARTHEST);
        let z_of = |clusters: &Clusters| clusters.z(residuals.iter().zip(derivatives).map(moment)).abs();
        let most = self.clusters.iter().map(z_of).fold(f64::INFINITY, f64::min);
        let is_rounding = regressed.amount.abs() < LEAST_ERROR * self.sizes[place];
        Regressed { certain: if is_rounding { 0.0 } else { regressed.certain.min(most) }, ..regressed }
    }

    /// The smallest error of a parameter that would still be named, given the residuals of correct answers and supposing that the answers
    /// are linear in the parameter.
    pub(super) fn least_amount(&self, place: usize, right: &[f32]) -> Option<f64> {
        let derivatives = &self.derivatives[place];
        let (residuals, limit) = (self.residuals(right)?, limit(derivatives)?);
        if self.clusters.iter().any(|clusters| clusters.count < Clusters::LEAST) {
            return None;
        }
        let (mut shift, mut count, mut variance, mut slopes) = (0.0, 0.0, 0.0, 0.0);
        for (r, &d) in residuals.iter().zip(derivatives).filter(|(_, d)| **d != 0.0) {
            let (d, psi) = (f64::from(d), f64::from(d).clamp(-limit, limit));
            shift += psi * psi;
            count += 1.0;
            variance += (psi * r.clamp(-FARTHEST, FARTHEST)).powi(2);
            slopes += psi * d;
        }
        let by_share: f64 = LEAST_SHARE / (shift / count).sqrt();
        Some(by_share.max(LEAST_Z * variance.sqrt() / slopes).max(LEAST_ERROR * self.sizes[place]))
    }
}

/// A parameter's error by the residuals.
#[derive(Clone, Copy, Debug)]
pub(super) struct Regressed {
    pub(super) amount: f64,
    pub(super) z: f64,
    pub(super) share: f64,
    /// By how many standard errors it differs from 0 where values that are no independent samples count as one; 0 where a rounded constant explains it.
    certain: f64,
}

impl Regressed {
    fn is_named(&self) -> bool {
        self.z.abs() >= LEAST_Z && self.certain >= LEAST_Z && self.share >= LEAST_SHARE
    }

    /// Solves Σ ψ(d)·χ(r − δd) = 0, with χ limiting a residual, ψ limiting how much a case can weigh, and White's standard error, which holds though
    /// rounding is greater in some cases than in others.
    fn new(residuals: &[f64], derivatives: &[f32]) -> Self {
        let none = Self { amount: 0.0, z: 0.0, share: 0.0, certain: 0.0 };
        let Some(limit) = limit(derivatives) else { return none };
        let psi = |d: f64| d.clamp(-limit, limit);
        let slopes: f64 = derivatives.iter().map(|&d| psi(d.into()) * f64::from(d)).sum();
        let mut amount = 0.0;
        for _ in 0..ROUNDS {
            let rest = |r: &f64, d: f32| (r - amount * f64::from(d)).clamp(-FARTHEST, FARTHEST);
            let moments: f64 = residuals.iter().zip(derivatives).map(|(r, &d)| psi(d.into()) * rest(r, d)).sum();
            amount += moments / slopes;
        }
        let (mut variance, mut shift, mut count) = (0.0, 0.0, 0.0);
        for (r, &d) in residuals.iter().zip(derivatives) {
            let d = f64::from(d);
            if d != 0.0 {
                let rest = (r - amount * d).clamp(-FARTHEST, FARTHEST);
                variance += (psi(d) * rest).powi(2);
                shift += (amount * psi(d)).powi(2);
                count += 1.0;
            }
        }
        let z = if variance > 0.0 { amount * slopes / variance.sqrt() } else { f64::INFINITY.copysign(amount) };
        if amount == 0.0 || !amount.is_finite() {
            none
        } else {
            Self { amount, z, share: (shift / count).sqrt(), certain: z.abs() }
        }
    }
}

/// Four times the median derivative: what a case weighs at most. `None` where too few cases have one.
fn limit(derivatives: &[f32]) -> Option<f64> {
    const LEAST_CASES: usize = 64;
    let mut sizes: Vec<f32> = derivatives.iter().map(|d| d.abs()).filter(|&d| d > 0.0).collect();
    if sizes.len() < LEAST_CASES {
        return None;
    }
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f32::total_cmp);
    Some(f64::from(*median) * 4.0)
}

fn says(parameter: &Parameter, amount: f64) -> String {
    let name = &parameter.name;
    match parameter.error {
        OffBy::Scale => {
            let way = if amount < 0.0 { "smaller" } else { "larger" };
            format!("as if {name} were {} % {way}", digits(100.0 * amount.abs(), 2))
        }
        OffBy::Offset => {
            let way = if amount < 0.0 { "less" } else { "more" };
            format!("as if {name} were {} {way}", digits(amount.abs(), 2))
        }
    }
}

/// What a renderer's answers to one formula show together; `None` where nothing, and of fewer than [`LEAST_VALUES`] values or
/// of a rasteriser.
#[must_use]
pub fn group_verdict(member: &Member, rows: &[Answered<'_>]) -> Option<Systematic> {
    let spec = &member.spec;
    if matches!(spec.kind, Kind::Raster(_)) {
        return None;
    }
    let fits = |row: &&Answered<'_>| row.inputs.len() == spec.input_len() && row.values.len() == spec.output_len();
    let rows: Vec<Answered<'_>> = rows.iter().filter(fits).copied().collect();
    if rows.len() * spec.output_len() < LEAST_VALUES {
        return None;
    }
    let design = Design::new(member, &rows);
    let values: Vec<f32> = rows.iter().flat_map(|row| row.values.iter().copied()).collect();
    design.verdict(&values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::formulas;
    use lightmeter_arithmetic::RandomLegal;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_arithmetic::random::seed;
    use lightmeter_catalogue::cases::Stage;
    use lightmeter_catalogue::select::CaseRef;
    use lightmeter_judge::devices::Known;
    use lightmeter_judge::formula::evaluated;
    use lightmeter_judge::kept::KeptRow;
    use lightmeter_reference::Real as _;

    fn rows_of(member: &Member, cases: u64) -> Vec<Vec<f32>> {
        let row = |k| {
            let mut row = vec![];
            member.inputs(CaseRef::Random(k), 1, &mut row);
            row
        };
        (0..cases).map(row).collect()
    }

    /// What answers to random cases show together.
    fn verdict(member: &Member, rows: &[Vec<f32>], values: &[Vec<f32>]) -> Option<Systematic> {
        let by = (Stage::Compute, &Known::default(), &WGSL);
        let kept = rows.iter().zip(values).map(|(row, values)| evaluated(member, row.clone(), values.clone(), by));
        let kept: Vec<KeptRow> = kept.collect();
        let rows: Vec<Answered<'_>> = kept.iter().map(|row| row.answers(CaseRef::Random(0), false)).collect();
        group_verdict(member, &rows)
    }

    #[test]
    fn a_parameter_that_is_slightly_off_is_named() {
        let member = formulas().iter().find(|member| member.spec.id == "fog/exp").expect("fog/exp");
        let rows = rows_of(member, 2048);
        let answers = |change: &dyn Fn(&mut [f32])| {
            let answer = |row: &Vec<f32>| {
                let (mut row, mut out) = (row.clone(), vec![0.0; 4]);
                change(&mut row);
                member.formula.embedded(&row, &mut out);
                out
            };
            rows.iter().map(answer).collect::<Vec<_>>()
        };
        let verdict = |values: &[Vec<f32>]| verdict(member, &rows, values);
        assert_eq!(verdict(&answers(&|_| {})), None);
        let named = verdict(&answers(&|row| row[3] *= 1.000_003)).expect("a systematic error");
        assert_eq!((named.parameter.as_str(), named.error), ("density", OffBy::Scale), "{named:?}");
        assert!((named.amount - 3e-6).abs() < 3e-7 && named.says.contains("density"), "{named:?}");
        let named = verdict(&answers(&|row| row[4] += 4e-7)).expect("a systematic error");
        assert_eq!(named.parameter, "fog.r", "{named:?}");
    }

    /// A division by 255 as a multiplication by what 1/255 is rounded to.
    #[test]
    fn a_rounded_constant_is_no_parameter_that_is_off() {
        let member = formulas().iter().find(|member| member.spec.id == "color/from-unorm8").expect("it is a formula");
        let rows = rows_of(member, 65_536);
        let values: Vec<Vec<f32>> = rows.iter().map(|row| vec![row[0] * (1.0 / 255.0)]).collect();
        assert_eq!(verdict(member, &rows, &values), None);
    }

    /// Both constants of a state are rounded in a way of their own, and ten thousand cases have one of them.
    #[test]
    fn few_constants_are_few_samples() {
        for factor in ["one-minus-constant-color", "one-minus-constant-alpha"] {
            for source in ["zero", "one", "src-color", "dst-alpha", "one-minus-dst-alpha"] {
                let id = format!("blend/add/{source}/{factor}");
                let member = formulas().iter().find(|member| member.spec.id == id).expect("it is a state");
                let rows = rows_of(member, 10_000);
                let answer = |row: &Vec<f32>| {
                    let mut out = vec![0.0; 4];
                    member.formula.embedded(row, &mut out);
                    out
                };
                let values: Vec<Vec<f32>> = rows.iter().map(answer).collect();
                assert_eq!(verdict(member, &rows, &values), None, "{id}");
            }
        }
    }

    #[test]
    #[ignore = "long: ./x campaign long"]
    fn legal_evaluations_are_not_named() {
        seed(2026);
        for member in formulas().iter().filter(|member| ["fog", "attenuation"].contains(&member.spec.family())) {
            let rows = rows_of(member, 4096);
            let answer = |row: &Vec<f32>| {
                let inputs: Vec<RandomLegal> = row.iter().map(|&x| RandomLegal::input(x)).collect();
                let mut out = vec![RandomLegal::of(0.0); member.spec.output_len()];
                WGSL.scope(|| member.formula.on_draw(&inputs, &mut out));
                #[expect(clippy::cast_possible_truncation, reason = "a draw is an f32")]
                out.iter().map(|x| x.value as f32).collect::<Vec<f32>>()
            };
            let values: Vec<Vec<f32>> = rows.iter().map(answer).collect();
            assert_eq!(verdict(member, &rows, &values), None, "{}", member.spec.id);
        }
    }
}
