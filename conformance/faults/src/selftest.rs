//! Whether the suite catches every mistake of the catalogue and tells it by its name, and flags nothing that is right.
//!
//! Each mistake is made by the embedded implementation and judged like any renderer; its answers are diagnosed. What is right,
//! the embedded implementation and legal evaluations drawn at random, must be flagged by no verdict.

use super::concerned::concerning;
use super::diagnose::diagnose;
use super::explanation::FormulaDiagnosis;
use super::fault::Fault;
use super::group::group_verdict;
use super::variation::Variation;
use lightmeter_arithmetic::{Accept, Profile, RandomLegal, random};
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::filter::Filter;
use lightmeter_catalogue::select::{CaseRef, Member, Shard, catalogue, select};
use lightmeter_document::event::Stop;
use lightmeter_document::selftest::{Clean, Finding, Kill, Record};
use lightmeter_judge::diagnose::Answered;
use lightmeter_judge::{Outcome, judge};
use lightmeter_reference::Real as _;
use rayon::prelude::*;
use std::cell::LazyCell;

/// What is tried.
#[derive(Clone, Debug)]
pub struct SelftestOptions {
    /// Which formulas.
    pub filter: Filter,
    /// Random cases for each formula; a quarter of them for each of the many blend states.
    pub cases: u64,
    /// Their seed.
    pub seed: u64,
    /// Legal evaluations drawn for each case.
    pub draws: u64,
    /// By which rules.
    pub profile: &'static Profile,
    /// Ends it before its time.
    pub stop: Stop,
}

/// Tries every mistake, and none, in every formula that a filter selects. Once it is told to stop, no other mistake is tried, and a
/// formula whose legal evaluations are under way is left out of those without a mistake. `tried` gets the id of each formula once every mistake
/// in it was tried, before its legal evaluations.
#[must_use]
pub fn selftest(options: &SelftestOptions, tried: &(dyn Fn(&str) + Sync)) -> Record {
    let members = catalogue();
    let selected = select(&members, &options.filter, options.cases, Shard::WHOLE);
    let tried: Vec<(Vec<Kill>, Option<Clean>)> =
        selected.par_iter().map(|chosen| try_all(&members[chosen.member], options, tried)).collect();
    let (kills, clean): (Vec<Vec<Kill>>, Vec<Option<Clean>>) = tried.into_iter().unzip();
    let is_complete = clean.iter().all(Option::is_some);
    Record { kills: kills.into_iter().flatten().collect(), clean: clean.into_iter().flatten().collect(), is_complete }
}

/// Random cases of a run, which a mistake must show in at the latest.
const CASES_OF_A_RUN: u64 = 4096;

/// Every mistake in a formula, and none; `None` where that was stopped.
fn try_all(member: &Member, options: &SelftestOptions, tried: &dyn Fn(&str)) -> (Vec<Kill>, Option<Clean>) {
    if options.stop.is_set() {
        return (vec![], None);
    }
    let spec = &member.spec;
    let is_state = matches!(spec.kind, Kind::Blend(_));
    let few = Bench::new(member, options, if is_state { options.cases.div_ceil(4) } else { options.cases });
    let all = LazyCell::new(|| Bench::new(member, options, CASES_OF_A_RUN));
    let mut kills = vec![];
    for fault in concerning(member) {
        if options.stop.is_set() {
            return (kills, None);
        }
        let Some(variation) = Variation::new(member, &[fault]) else { continue };
        let kill = few.kill(fault, &variation);
        // What does not show in a few cases has those of a run.
        kills.push(if kill.finding == Finding::Survived { all.kill(fault, &variation) } else { kill });
    }
    tried(&spec.id);
    // Blend states are products and a sum each; a group verdict on all of them says nothing more than one on the modes.
    let is_grouped = matches!(spec.kind, Kind::Arithmetic) || spec.id.starts_with("blend/mode");
    (kills, if is_grouped { all.clean() } else { few.clean() })
}

/// The cases of one formula, with what is right and what is legal in each.
pub(super) struct Bench<'a> {
    pub(super) member: &'a Member,
    options: &'a SelftestOptions,
    cases: Vec<CaseRef>,
    pub(super) inputs: Vec<Vec<f32>>,
    pub(super) reference: Vec<f64>,
    legal: Vec<Accept>,
}

impl<'a> Bench<'a> {
    pub(super) fn new(member: &'a Member, options: &'a SelftestOptions, random: u64) -> Self {
        let spec = &member.spec;
        let cases: Vec<CaseRef> = member.fixed().chain((0..random).map(CaseRef::Random)).collect();
        let inputs: Vec<Vec<f32>> = cases
            .iter()
            .map(|&case| {
                let mut row = vec![];
                member.inputs(case, options.seed, &mut row);
                row
            })
            .collect();
        let outputs = spec.output_len();
        let mut reference = vec![0.0; cases.len() * outputs];
        let mut legal = vec![Accept::ANY; cases.len() * outputs];
        let rows = reference.chunks_exact_mut(outputs).zip(legal.chunks_exact_mut(outputs));
        for (inputs, (reference, legal)) in inputs.iter().zip(rows) {
            member.formula.reference(inputs, reference);
            member.formula.promised_interval(spec.kind, inputs, options.profile, legal);
        }
        Self { member, options, cases, inputs, reference, legal }
    }

    pub(super) fn outputs(&self) -> usize {
        self.member.spec.output_len()
    }

    /// Whether a case's answer fails a verdict.
    fn is_wrong(&self, case: usize, values: &[f32]) -> bool {
        let at = case * self.outputs();
        values.iter().enumerate().any(|(k, value)| {
            let verdict = judge(value.to_bits(), self.reference[at + k], &self.legal[at + k]);
            verdict.outcome == Outcome::Fail
        })
    }

    fn answers(&self, implementation: impl Fn(&[f32], &mut [f32])) -> Vec<Vec<f32>> {
        let answer = |inputs: &Vec<f32>| {
            let mut out = vec![0.0; self.outputs()];
            implementation(inputs, &mut out);
            out
        };
        self.inputs.iter().map(answer).collect()
    }

    pub(super) fn answered<'b>(&'b self, values: &'b [Vec<f32>]) -> Vec<Answered<'b>> {
        let rows = self.inputs.iter().zip(values).enumerate();
        rows.map(|(place, (inputs, values))| {
            let case = self.cases[place];
            let of = place * self.outputs()..(place + 1) * self.outputs();
            let (reference, legal) = (&self.reference[of.clone()], &self.legal[of]);
            Answered { case, inputs, values, reference, legal, is_wrong: self.is_wrong(place, values) }
        })
        .collect()
    }

    fn kill(&self, fault: &'static Fault, variation: &Variation<'_>) -> Kill {
        let values = self.answers(|inputs, out| variation.evaluate::<f32>(inputs, out));
        let rows = self.answered(&values);
        let smallest = rows.iter().position(|row| row.is_wrong);
        let mut random = rows.iter().zip(&self.cases).filter(|(_, case)| matches!(case, CaseRef::Random(_)));
        let diagnosis = diagnose(self.member, &rows, self.options.profile);
        let named = diagnosis.explanations.first().map(|first| first.faults.clone()).unwrap_or_default();
        let is_named = named == [fault.name];
        let alias = !is_named && self.is_alias(variation, &diagnosis);
        Kill {
            fault: fault.name.into(),
            formula: self.member.spec.id.clone(),
            finding: match smallest {
                None => Finding::Survived,
                Some(_) if is_named || alias => Finding::Named,
                Some(_) => Finding::Caught,
            },
            cases: rows.len(),
            failing: diagnosis.failing,
            smallest: smallest.map(|place| place + 1),
            first_case: smallest.map(|place| self.member.case_id(self.cases[place])),
            smallest_random: random.position(|(row, _)| row.is_wrong).map(|place| place + 1),
            diagnosis: named.into_iter().map(String::from).collect(),
            sentence: diagnosis.diagnosis.to_string(),
            alias,
        }
    }

    /// Whether what is diagnosed has the same values in every case, as nearly as can be told.
    fn is_alias(&self, variation: &Variation<'_>, diagnosis: &FormulaDiagnosis) -> bool {
        let Some(first) = diagnosis.explanations.first() else { return false };
        let faults: Vec<&'static Fault> = first.faults.iter().filter_map(|name| Fault::by_name(name)).collect();
        let Some(other) = Variation::new(self.member, &faults).filter(|_| !faults.is_empty()) else { return false };
        let within = |value: &Variation<'_>, interval: &Variation<'_>| {
            let mut legal = vec![Accept::ANY; self.outputs()];
            let mut values = vec![0.0_f32; self.outputs()];
            self.inputs.iter().all(|inputs| {
                interval.interval(inputs, self.options.profile, &mut legal);
                value.evaluate::<f32>(inputs, &mut values);
                values.iter().zip(&legal).all(|(&value, legal)| legal.contains(value.into()))
            })
        };
        let same = || {
            let (mut a, mut b) = (vec![0.0_f64; self.outputs()], vec![0.0_f64; self.outputs()]);
            self.inputs.iter().all(|inputs| {
                variation.evaluate(inputs, &mut a);
                other.evaluate(inputs, &mut b);
                // Rounding of f64 apart.
                a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-9 * a.abs().max(1.0) || (a.is_nan() && b.is_nan()))
            })
        };
        same() || (within(variation, &other) && within(&other, variation))
    }

    /// Verdicts on what is right; `None` where they were stopped.
    fn clean(&self) -> Option<Clean> {
        let spec = &self.member.spec;
        let mut clean = Clean { formula: spec.id.clone(), verdicts: 0, failed: 0, systematic: None };
        let mut take = |values: Vec<Vec<f32>>, grouped: bool| {
            let rows = self.answered(&values);
            clean.verdicts += (rows.len() * self.outputs()) as u64;
            clean.failed += rows.iter().filter(|row| row.is_wrong).count() as u64;
            if grouped && clean.systematic.is_none() {
                // Hard cases are no sample of anything.
                let random = rows.iter().zip(&self.cases).filter(|(_, case)| matches!(case, CaseRef::Random(_)));
                let random: Vec<Answered<'_>> = random.map(|(row, _)| *row).collect();
                clean.systematic = group_verdict(self.member, &random);
            }
        };
        take(self.answers(|inputs, out| self.member.formula.embedded(inputs, out)), true);
        // A rasteriser chooses where it snaps, not how it rounds.
        if !matches!(spec.kind, Kind::Raster(_)) {
            for draw in 0..self.options.draws {
                if self.options.stop.is_set() {
                    return None;
                }
                random::seed(self.options.seed.wrapping_add(draw));
                take(self.answers(|inputs, out| self.draw(inputs, out)), draw == 0);
            }
        }
        Some(clean)
    }

    /// One legal evaluation.
    fn draw(&self, inputs: &[f32], out: &mut [f32]) {
        self.options.profile.scope(|| {
            let inputs: Vec<RandomLegal> = inputs.iter().map(|&x| RandomLegal::input(x)).collect();
            let mut drawn = vec![RandomLegal::of(0.0); out.len()];
            self.member.formula.on_draw(&inputs, &mut drawn);
            for (out, drawn) in out.iter_mut().zip(drawn) {
                *out = drawn.narrow();
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_arithmetic::profile::PROFILES;

    /// The cases of each formula that a gate asks without any option.
    const CASES_OF_A_GATE: u64 = 256;
    /// Every family. The many blend states differ in their factors alone, and `selftest` tries all of them.
    const FORMULAS: [&str; 8] =
        ["interpolation", "color", "vector", "lighting", "attenuation", "fog", "depth", "blend/mode-*"];

    #[test]
    #[ignore = "long: ./x campaign long"]
    fn every_mistake_shows_in_the_default_cases_of_a_gate() {
        for seed in 1..=5 {
            let options = SelftestOptions {
                filter: Filter::new(&FORMULAS.map(String::from)).expect("the globs are valid"),
                cases: CASES_OF_A_GATE,
                seed,
                draws: 0,
                profile: PROFILES[0],
                stop: Stop::default(),
            };
            let members = catalogue();
            let selected = select(&members, &options.filter, options.cases, Shard::WHOLE);
            let tried: Vec<(String, bool)> = selected
                .par_iter()
                .flat_map_iter(|chosen| {
                    let member = &members[chosen.member];
                    let bench = Bench::new(member, &options, options.cases);
                    let variations = concerning(member)
                        .into_iter()
                        .filter_map(|fault| Some((fault, Variation::new(member, &[fault])?)))
                        .map(|(fault, variation)| {
                            let values = bench.answers(|inputs, out| variation.evaluate::<f32>(inputs, out));
                            let is_caught = bench.answered(&values).iter().any(|row| row.is_wrong);
                            (format!("{} in {}", fault.name, member.spec.id), is_caught)
                        });
                    variations.collect::<Vec<_>>()
                })
                .collect();
            assert!(tried.len() > 1000, "{}", tried.len());
            let missed: Vec<&str> = tried.iter().filter(|(_, is_caught)| !is_caught).map(|(name, _)| &**name).collect();
            assert!(missed.is_empty(), "seed {seed}: {}", missed.join(", "));
        }
    }
}
