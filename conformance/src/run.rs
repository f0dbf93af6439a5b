//! The runner: draws cases, has every subject evaluate them, computes what is legal meanwhile, and judges.
//!
//! Work goes group by group and chunk by chunk, so that memory stays flat however many cases there are. A chunk's inputs
//! are handed to every stage of every subject before the reference is computed on all cores; then the results are read.

use crate::arithmetic::{Accept, Profile};
use crate::blend_unit;
use crate::cases::Kind;
use crate::cases::blend::{self, Samples};
use crate::evaluate::kernel;
use crate::filter::Filter;
use crate::image;
use crate::judge::{Outcome, judge};
use crate::report::{DeviationUse, Group, Interrupted, Number, Report, Timing, Totals};
use crate::select::{CaseRef, Member, Selected, Shard, catalogue_of, select};
use crate::stability;
use crate::subject::{Compiled, Rows, Subject};
use crate::tally::{Tally, judge_chunk};
use lightmeter_gpu::{Error, Shaders};
use lightmeter_scene::blend::Equation;
use lightmeter_scene::target::TargetFormat;
use rayon::prelude::*;
use std::path::PathBuf;
use std::time::Instant;

/// Cases of a chunk.
const CHUNK: usize = 1 << 16;
/// Cases that a task of the pool takes at once.
pub(crate) const TASK: usize = 512;
/// The share of indeterminate verdicts, hard cases apart, above which a group fails.
const MOST_INDETERMINATE: f64 = 0.01;

/// What to run.
pub struct Options {
    /// Which cases.
    pub filter: Filter,
    /// Random cases for each formula.
    pub cases: u64,
    /// The seed.
    pub seed: u64,
    /// Which part.
    pub shard: Shard,
    /// The formats that are blended on.
    pub targets: Vec<TargetFormat>,
    /// Which states with another one for alpha are judged.
    pub samples: Samples,
    /// Pixels of the longer side of every scene; `None` for the scenes' own, or for a quarter of the pixels in a run of all.
    pub size: Option<u32>,
    /// Where the images of scenes that fail are written; `None` for nowhere.
    pub images: Option<PathBuf>,
    /// Whether what takes time is measured apart: the blend unit draws everything once more with its pipelines compiled, and
    /// stable forms are timed beside naive ones.
    pub again: bool,
    /// The accuracy rules.
    pub profile: &'static Profile,
    /// The shaders.
    pub shaders: Shaders,
    /// What to add to a command that runs one case again.
    pub rerun: String,
}

/// Is told how far a run has come.
pub trait Progress {
    /// So many cases in all are about to be run.
    fn start(&mut self, cases: u64);
    /// A group begins.
    fn group(&mut self, id: &str);
    /// So many more cases are done.
    fn advance(&mut self, cases: u64);
}

/// Nobody looks.
pub struct Silent;

impl Progress for Silent {
    fn start(&mut self, _cases: u64) {}
    fn group(&mut self, _id: &str) {}
    fn advance(&mut self, _cases: u64) {}
}

/// Runs what the options select on every subject. Where a device fails, what was judged until then is the report, which says
/// what was under way.
///
/// # Errors
/// Where a shader is invalid, or a device fails before anything ran.
///
/// # Panics
/// Where a built-in scene is refused, which a test rules out.
pub fn run(subjects: &mut [Subject], options: &Options, progress: &mut impl Progress) -> Result<Report, Error> {
    let started = Instant::now();
    let catalogue = catalogue_of(&options.samples);
    let selected = select(&catalogue, &options.filter, options.cases, options.shard);
    let size = image::select::size(&options.filter, options.size);
    let scenes = image::select::select(&options.filter, options.shard, size);
    let rows: u64 = selected.iter().map(|chosen| work(&catalogue[chosen.member], chosen, subjects, options)).sum();
    progress.start(rows + scenes.iter().map(|chosen| chosen.work() * subjects.len() as u64).sum::<u64>());
    let mut report = empty(subjects, options);
    if !selected.is_empty() || !scenes.is_empty() {
        probe_deviations(subjects, options, &mut report)?;
    }
    for group in selected.chunk_by(|a, b| catalogue[a.member].spec.group() == catalogue[b.member].spec.group()) {
        let members: Vec<&Member> = group.iter().map(|chosen| &catalogue[chosen.member]).collect();
        progress.group(members[0].spec.group());
        let judged = judge_group(&members, group, subjects, options, &mut report, progress);
        match judged {
            Err(error @ (Error::Device(_) | Error::Timeout(_))) => {
                let under_way = members[0].spec.group().into();
                report.interrupted.get_or_insert(Interrupted { under_way, message: error.to_string() });
                break;
            }
            judged => judged?,
        }
    }
    for chosen in scenes {
        if report.interrupted.is_some() {
            break;
        }
        let id = image::select::scene_id(chosen.place);
        progress.group(&id);
        let loaded = image::select::builtin(chosen.place, size).expect("a test loads every scene that is built in");
        match image::run::run_scene(&loaded, &chosen, subjects, options, &mut report, progress) {
            Err(error @ (Error::Device(_) | Error::Timeout(_))) => {
                report.interrupted = Some(Interrupted { under_way: id, message: error.to_string() });
            }
            judged => judged?,
        }
    }
    for group in &report.groups {
        report.totals.add(&group.totals);
    }
    report.totals.unexpected_passes +=
        report.deviations.iter().filter(|deviation| !deviation.still_needed).count() as u64;
    report.aliases = blend::aliases()
        .filter(|(alias, canonical)| options.filter.selects(alias) || options.filter.selects(canonical))
        .count() as u64;
    report.routes = routes(&report);
    report.seconds = started.elapsed().as_secs_f64();
    Ok(report)
}

/// Cases of a formula, counted once for its stages that take rows, and once for each target of each blend unit.
fn work(member: &Member, chosen: &Selected, subjects: &[Subject], options: &Options) -> u64 {
    let unit = match member.spec.kind {
        Kind::Blend(_) => blend_unit::run::targets_of(member, &options.targets).len() * subjects.len(),
        _ => 0,
    };
    let rows = if member.spec.row_stages().is_empty() { 0 } else { chosen.rows(member).count() };
    chosen.count() * unit as u64 + rows
}

/// Judges a group in the blend unit, if that draws it, and in the stages that take rows.
fn judge_group(
    members: &[&Member],
    group: &[Selected],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    progress: &mut impl Progress,
) -> Result<(), Error> {
    if matches!(members[0].spec.kind, Kind::Blend(_)) {
        blend_unit::run::run_group(members, group, subjects, options, report, progress)?;
    }
    if members[0].spec.row_stages().is_empty() {
        return Ok(());
    }
    let first = report.groups.len();
    run_rows(members, group, subjects, options, report, progress)?;
    for (member, chosen) in members.iter().zip(group) {
        stability::examine(member, &chosen.hard, subjects, options, report)?;
    }
    for group in &mut report.groups[first..] {
        if let Some(unstable) = stability::problem(&report.stability, &group.id, &group.adapter, group.stage) {
            group.problem =
                Some(group.problem.take().map_or(unstable.clone(), |problem| format!("{problem}; {unstable}")));
            group.totals.failed_groups = 1;
        }
    }
    Ok(())
}

/// A report of nothing yet.
#[must_use]
pub fn empty(subjects: &[Subject], options: &Options) -> Report {
    Report {
        schema: "lightmeter.run/1",
        seed: options.seed,
        seconds: 0.0,
        profile: options.profile.name,
        filter: options.filter.globs().map(str::to_owned).collect(),
        adapters: subjects.iter().map(|subject| subject.identity.clone()).collect(),
        totals: Totals::default(),
        aliases: 0,
        routes: serde_json::Map::new(),
        timing: Timing::default(),
        deviations: vec![],
        groups: vec![],
        blend_states: vec![],
        special: vec![],
        stability: vec![],
        stable_costs: vec![],
        interrupted: None,
        failures: vec![],
    }
}

/// How the distinct states of the 15 × 15 × 5 reached a blend unit: states by route, on any adapter and target.
fn routes(report: &Report) -> serde_json::Map<String, serde_json::Value> {
    let mut routes = std::collections::BTreeMap::<&str, std::collections::BTreeSet<&str>>::new();
    let is_state = |id: &str| id.split('/').nth(1).is_some_and(|name| Equation::ALL.iter().any(|e| e.name() == name));
    let on_device =
        |name: &str| report.adapters.iter().any(|adapter| adapter.name == name && adapter.backend != "embedded");
    for state in report.blend_states.iter().filter(|state| state.is_drawn() && on_device(&state.adapter)) {
        if is_state(&state.id) {
            routes.entry(state.route).or_default().insert(&state.id);
        }
    }
    routes.into_iter().map(|(route, states)| (route.into(), states.len().into())).collect()
}

/// Evaluates the witness of each deviation in force: where the driver is inside the promised bound there, the deviation is
/// no longer needed, which fails the run.
fn probe_deviations(subjects: &[Subject], options: &Options, report: &mut Report) -> Result<(), Error> {
    // The driver is asked, not the shaders under test.
    let shaders = Shaders::built_in()?;
    for subject in subjects {
        for deviation in &subject.known.deviations {
            let Some(bits) = subject.probe(&shaders, deviation.builtin.probe(), deviation.witness)? else {
                continue;
            };
            let interval = options.profile.scope(|| deviation.builtin.interval(deviation.witness));
            let granted = deviation.grant(*options.profile).scope(|| deviation.builtin.interval(deviation.witness));
            let exact = deviation.builtin.exact(deviation.witness);
            let outcome = |legal| judge(bits, exact, legal).outcome;
            // Wronger than what is granted is another mistake, which the cases will show.
            let still_needed = outcome(&interval) == Outcome::Fail && outcome(&granted) == Outcome::Pass;
            report.deviations.push(DeviationUse {
                name: deviation.name,
                adapter: subject.identity.name.clone(),
                reason: deviation.reason,
                still_needed,
                excused: 0,
            });
        }
    }
    Ok(())
}

/// A chunk of a group's cases, with everything about them that does not depend on a subject.
pub(crate) struct Chunk<'a> {
    pub(crate) members: &'a [&'a Member],
    pub(crate) cases: Vec<CaseRef>,
    pub(crate) of: Vec<usize>,
    pub(crate) inputs: Vec<f32>,
    pub(crate) selected: Vec<f32>,
    pub(crate) references: Vec<f64>,
    pub(crate) intervals: Vec<Accept>,
}

impl Chunk<'_> {
    fn rows(&self) -> Rows<'_> {
        Rows {
            members: self.members,
            of: &self.of,
            inputs: &self.inputs,
            selected: &self.selected,
            outputs: self.members[0].spec.output_len(),
        }
    }

    pub(crate) fn inputs_of(&self, case: usize) -> &[f32] {
        let stride = self.members[0].spec.input_len();
        &self.inputs[case * stride..(case + 1) * stride]
    }
}

fn run_rows(
    members: &[&Member],
    group: &[Selected],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    progress: &mut impl Progress,
) -> Result<(), Error> {
    let group: Vec<Selected> = group.iter().zip(members).map(|(chosen, member)| chosen.rows(member)).collect();
    let spec = &members[0].spec;
    let clock = Instant::now();
    let kernel = kernel(&options.shaders, members[0])?;
    let compiled: Vec<Compiled> = subjects
        .iter_mut()
        .map(|subject| subject.compile(&options.shaders, spec, kernel.as_ref()))
        .collect::<Result<_, Error>>()?;
    let compiling = clock.elapsed().as_secs_f64();
    report.timing.compile += compiling;

    let mut tallies: Vec<Vec<Tally>> =
        compiled.iter().map(|compiled| compiled.stages.iter().map(|_| Tally::default()).collect()).collect();
    let cases: Vec<(usize, CaseRef)> = vec![];
    let mut all = group.iter().enumerate().flat_map(|(of, chosen)| chosen.cases().map(move |case| (of, case)));
    let mut next = cases;
    loop {
        next.clear();
        next.extend(all.by_ref().take(CHUNK));
        if next.is_empty() {
            break;
        }
        let clock = Instant::now();
        let mut chunk = draw(members, &next, options.seed);
        report.timing.generate += clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        let mut jobs = vec![];
        for (subject, compiled) in subjects.iter_mut().zip(&compiled) {
            for (_, work) in &compiled.stages {
                let clock = Instant::now();
                let job = work.as_ref().ok().map(|work| subject.submit(work, &chunk.rows())).transpose()?;
                jobs.push((job, clock.elapsed().as_secs_f64()));
            }
        }
        report.timing.devices += clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        refer(&mut chunk, options.profile);
        report.timing.reference += clock.elapsed().as_secs_f64();

        let mut jobs = jobs.into_iter();
        for ((subject, compiled), tallies) in subjects.iter().zip(&compiled).zip(&mut tallies) {
            for ((stage, work), tally) in compiled.stages.iter().zip(tallies) {
                let (Some((Some(job), submitting)), Ok(work)) = (jobs.next(), work) else {
                    tally.totals.cases += next.len() as u64;
                    tally.totals.skipped += next.len() as u64;
                    continue;
                };
                let clock = Instant::now();
                let words = subject.finish(work, job, &chunk.rows())?;
                let waiting = clock.elapsed().as_secs_f64();
                report.timing.devices += waiting;
                let clock = Instant::now();
                tally.merge(judge_chunk(&chunk, &words, *stage, subject, options));
                report.timing.judge += clock.elapsed().as_secs_f64();
                tally.seconds += submitting + waiting + clock.elapsed().as_secs_f64();
            }
        }
        progress.advance(next.len() as u64);
    }

    for ((subject, compiled), tallies) in subjects.iter().zip(compiled).zip(tallies) {
        for ((stage, work), tally) in compiled.stages.into_iter().zip(tallies) {
            for (name, excused) in &tally.excused {
                let uses = report.deviations.iter_mut().find(|d| d.name == *name && d.adapter == subject.identity.name);
                if let Some(uses) = uses {
                    uses.excused += excused;
                }
            }
            report.failures.extend(tally.failures);
            let problem = problem(tally.random, tally.totals.verdicts, tally.totals.indeterminate);
            report.groups.push(Group {
                id: spec.group().into(),
                adapter: subject.identity.name.clone(),
                stage: stage.name(),
                target: None,
                tiers: None,
                store: None,
                totals: Totals { failed_groups: u64::from(problem.is_some()), ..tally.totals },
                error_ulp_max: Number(tally.error_ulp_max),
                margin_max: Number(tally.worst.as_ref().map_or(0.0, |(margin, _)| *margin)),
                seconds: tally.seconds,
                seconds_warm: None,
                explanation: None,
                image: None,
                worst: tally.worst.map(|(_, id)| id),
                skip_reason: work.err(),
                problem,
            });
        }
    }
    Ok(())
}

/// The group verdict on indeterminate values: more than 1 % of them, hard cases apart, make a run of little.
pub(crate) fn problem(random: (u64, u64), verdicts: u64, indeterminate: u64) -> Option<String> {
    #[expect(clippy::cast_precision_loss, reason = "a share")]
    let share = random.1 as f64 / random.0.max(1) as f64;
    if share > MOST_INDETERMINATE {
        return Some(format!(
            "{:.1} % of the verdicts are indeterminate, hard cases apart; at most 1 % may be",
            100.0 * share
        ));
    }
    (random.0 > 0 && indeterminate == verdicts).then(|| "nothing but indeterminate verdicts".into())
}

pub(crate) fn draw<'a>(members: &'a [&'a Member], cases: &[(usize, CaseRef)], seed: u64) -> Chunk<'a> {
    let parts: Vec<(Vec<f32>, Vec<f32>)> = cases
        .par_chunks(TASK)
        .map(|cases| {
            let (mut inputs, mut selected) = (vec![], vec![]);
            for &(of, case) in cases {
                let start = inputs.len();
                members[of].inputs(case, seed, &mut inputs);
                if !members[of].spec.selectors.is_empty() {
                    selected.extend(members[of].spec.selectors.iter().map(|&code| f32::from_bits(code)));
                    selected.extend_from_slice(&inputs[start..]);
                }
            }
            (inputs, selected)
        })
        .collect();
    let inputs = parts.iter().flat_map(|(inputs, _)| inputs).copied().collect::<Vec<f32>>();
    let selected = parts.iter().flat_map(|(_, selected)| selected).copied().collect::<Vec<f32>>();
    Chunk {
        members,
        cases: cases.iter().map(|(_, case)| *case).collect(),
        of: cases.iter().map(|(of, _)| *of).collect(),
        selected: if selected.is_empty() { inputs.clone() } else { selected },
        inputs,
        references: vec![],
        intervals: vec![],
    }
}

/// Reference values and intervals, on all cores.
pub(crate) fn refer(chunk: &mut Chunk<'_>, profile: &Profile) {
    let outputs = chunk.members[0].spec.output_len();
    let mut references = vec![0.0; chunk.cases.len() * outputs];
    let mut intervals = vec![Accept::ANY; chunk.cases.len() * outputs];
    references.par_chunks_mut(TASK * outputs).zip(intervals.par_chunks_mut(TASK * outputs)).enumerate().for_each(
        |(task, (references, intervals))| {
            profile.scope(|| {
                let rows = references.chunks_exact_mut(outputs).zip(intervals.chunks_exact_mut(outputs));
                for (case, (reference, interval)) in (task * TASK..).zip(rows) {
                    let formula = &chunk.members[chunk.of[case]].formula;
                    formula.reference(chunk.inputs_of(case), reference);
                    formula.interval(chunk.inputs_of(case), interval);
                }
            });
        },
    );
    chunk.references = references;
    chunk.intervals = intervals;
}
