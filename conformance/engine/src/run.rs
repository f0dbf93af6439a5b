//! The runner: draws cases, has every subject evaluate them, computes what is legal meanwhile, and judges.
//!
//! Work goes group by group and chunk by chunk, so that memory stays flat however many cases there are. A chunk's inputs
//! are handed to every stage of every subject before the reference is computed on all cores; then the results are read.

use crate::blend_unit;
use crate::device::DeviceError;
use crate::image;
use crate::options::{Options, Progress};
use crate::rows::Rows;
use crate::selection::Selection;
use crate::special::verdict::Table;
use crate::subject::{Compiled, Job, Subject};
use crate::witness;
use crate::{special, stability};
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::cases::blend;
use lightmeter_catalogue::scene::select::Chosen;
use lightmeter_catalogue::select::{CaseRef, Member, Selected};
use lightmeter_document::Number;
use lightmeter_document::run::{BlendPromise, Group, Interrupted, Report, Totals};
use lightmeter_judge::blend_unit::policy::{PROMISES, Promise};
use lightmeter_judge::chunk::{self, Chunk};
use lightmeter_judge::formula::{RowPlace, RowTally, judge_chunk};
use lightmeter_judge::stability::UNSTABLE;
use lightmeter_scene::blend::Equation;
use std::time::Instant;

/// Cases of a chunk.
const CHUNK: usize = 1 << 16;
/// Runs what the options select on every subject. Where a device fails, what was judged until then is the report, which says
/// what was under way.
///
/// # Errors
/// Where a shader is invalid, or a device fails before anything ran.
pub fn run(subjects: &mut [Subject], options: &Options, progress: &mut impl Progress) -> Result<Report, DeviceError> {
    run_selection(&Selection::of(options), subjects, options, progress)
}

/// Runs a selection, or a part of one, on every subject. Where a device fails, what was judged until then is the report, which
/// says what was under way.
///
/// # Errors
/// Where a shader is invalid, or a device fails before anything ran.
pub fn run_selection(
    selection: &Selection,
    subjects: &mut [Subject],
    options: &Options,
    progress: &mut impl Progress,
) -> Result<Report, DeviceError> {
    let started = Instant::now();
    progress.start(work(selection, subjects, options));
    let mut report = options.report(subjects);
    for &deviation in &selection.deviations {
        witness::ask(deviation, &selection.catalogue, subjects, options, &mut report)?;
    }
    judge_in_turn(selection, subjects, options, &mut report, progress)?;
    for group in &report.groups {
        report.totals.add(&group.totals);
    }
    report.totals.unexpected_passes +=
        report.deviations.iter().filter(|deviation| !deviation.still_needed).count() as u64;
    report.aliases = blend::aliases()
        .filter(|(alias, canonical)| options.filter.selects(alias) || options.filter.selects(canonical))
        .count() as u64;
    report.routes = routes(&report);
    if !report.special.is_empty() {
        let told = |promise: &Promise| BlendPromise { interface: promise.interface.into(), says: promise.says.into() };
        report.blend_promises = PROMISES.iter().map(told).collect();
    }
    report.unstable_beyond = (!report.stability.is_empty()).then_some(UNSTABLE);
    report.seconds = started.elapsed().as_secs_f64();
    Ok(report)
}

/// Tables of special values, formulas and scenes, one after the other, until a device fails.
fn judge_in_turn(
    selection: &Selection,
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    progress: &mut impl Progress,
) -> Result<(), DeviceError> {
    // First: Mesa 22.3's lavapipe no longer flushes subnormals in fragments once it has drawn certain scenes.
    for table in &selection.tables {
        let id = table.id();
        progress.group(&id);
        let judged = special::verdict::run_table(table, subjects, options, report, progress);
        if is_interrupted(judged, &id, report)? {
            return Ok(());
        }
    }
    let catalogue = &selection.catalogue;
    for group in
        selection.formulas.chunk_by(|a, b| catalogue[a.member].spec.group() == catalogue[b.member].spec.group())
    {
        let members: Vec<&Member> = group.iter().map(|chosen| &catalogue[chosen.member]).collect();
        let id = members[0].spec.group();
        progress.group(id);
        let judged = judge_group(&members, group, subjects, options, report, progress);
        if is_interrupted(judged, id, report)? {
            return Ok(());
        }
    }
    let size = lightmeter_catalogue::scene::select::size(&options.filter, options.size);
    for chosen in &selection.scenes {
        let id = lightmeter_catalogue::scene::select::scene_id(chosen.place);
        progress.group(&id);
        let loaded = lightmeter_catalogue::scene::select::builtin(chosen.place, size)
            .expect("a test loads every scene that is built in");
        let judged = image::run::run_scene(&loaded, chosen, subjects, options, report, progress);
        if is_interrupted(judged, &id, report)? {
            return Ok(());
        }
    }
    Ok(())
}

/// Whether a device failed while something was judged, which is noted then.
fn is_interrupted(judged: Result<(), DeviceError>, under_way: &str, report: &mut Report) -> Result<bool, DeviceError> {
    match judged {
        Err(error) if error.is_of_device() => {
            let (under_way, message) = (under_way.to_owned(), error.to_string());
            report.interrupted.get_or_insert(Interrupted { under_way, message });
            Ok(true)
        }
        judged => judged.map(|()| false),
    }
}

/// Cases that are to be judged, for the progress: those of a formula once for its stages that take rows, and once for each
/// target of each blend unit; results of tables and pixels of scenes on each subject.
fn work(selection: &Selection, subjects: &[Subject], options: &Options) -> u64 {
    let of_formula = |chosen: &Selected| {
        let member = &selection.catalogue[chosen.member];
        let unit = match member.spec.kind {
            Kind::Blend(_) => blend_unit::run::targets_of(member, &options.targets).len() * subjects.len(),
            _ => 0,
        };
        let rows = if member.spec.row_stages().is_empty() { 0 } else { chosen.rows(member).count() };
        chosen.count() * unit as u64 + rows
    };
    let formulas: u64 = selection.formulas.iter().map(of_formula).sum();
    let others: u64 = selection.tables.iter().map(Table::work).chain(selection.scenes.iter().map(Chosen::work)).sum();
    formulas + others * subjects.len() as u64
}

/// Judges a group in the blend unit, if that draws it, and in the stages that take rows.
fn judge_group(
    members: &[&Member],
    group: &[Selected],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    progress: &mut impl Progress,
) -> Result<(), DeviceError> {
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
        if let Some(unstable) = stability::problem(&report.stability, &group.id, &group.adapter, &group.stage) {
            group.problem =
                Some(group.problem.take().map_or(unstable.clone(), |problem| format!("{problem}; {unstable}")));
            group.totals.failed_groups = 1;
        }
    }
    Ok(())
}

/// How the distinct states of the 15 × 15 × 5 reached a blend unit: states by route, on any adapter and target.
fn routes(report: &Report) -> serde_json::Map<String, serde_json::Value> {
    let mut routes = std::collections::BTreeMap::<&str, std::collections::BTreeSet<&str>>::new();
    let is_state = |id: &str| id.split('/').nth(1).is_some_and(|name| Equation::ALL.iter().any(|e| e.name() == name));
    let on_device =
        |name: &str| report.adapters.iter().any(|adapter| adapter.name == name && adapter.backend != "embedded");
    for state in report.blend_states.iter().filter(|state| state.is_drawn() && on_device(&state.adapter)) {
        if is_state(&state.id) {
            routes.entry(&state.route).or_default().insert(&state.id);
        }
    }
    routes.into_iter().map(|(route, states)| (route.into(), states.len().into())).collect()
}

/// A group of formulas in the stages that take rows.
struct RowRun {
    /// The stages of each subject.
    compiled: Vec<Compiled>,
    /// What each of them has come to, and in how many seconds.
    tallies: Vec<Vec<(RowTally, f64)>>,
}

/// A job of a stage, and how long it took to hand it over; `None` where the stage is skipped.
type Submitted = (Option<Job>, f64);

fn run_rows(
    members: &[&Member],
    group: &[Selected],
    subjects: &mut [Subject],
    options: &Options,
    report: &mut Report,
    progress: &mut impl Progress,
) -> Result<(), DeviceError> {
    let group: Vec<Selected> = group.iter().zip(members).map(|(chosen, member)| chosen.rows(member)).collect();
    let clock = Instant::now();
    let mut run = RowRun::new(members[0], subjects, options)?;
    report.timing.compile += clock.elapsed().as_secs_f64();

    let mut all = group.iter().enumerate().flat_map(|(of, chosen)| chosen.cases().map(move |case| (of, case)));
    let mut next: Vec<(usize, CaseRef)> = vec![];
    loop {
        next.clear();
        next.extend(all.by_ref().take(CHUNK));
        if next.is_empty() {
            break;
        }
        let clock = Instant::now();
        let mut chunk = chunk::draw(members, &next, options.seed);
        report.timing.generate += clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        let jobs = run.submit(subjects, &chunk)?;
        report.timing.devices += clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        chunk::refer(&mut chunk, options.profile);
        report.timing.reference += clock.elapsed().as_secs_f64();

        run.judge(subjects, &chunk, jobs, options, report)?;
        progress.advance(next.len() as u64);
    }
    run.finish(members, subjects, report);
    Ok(())
}

impl RowRun {
    fn new(member: &Member, subjects: &mut [Subject], options: &Options) -> Result<Self, DeviceError> {
        let compile = |subject: &mut Subject| subject.compile(&options.code, member);
        let compiled: Vec<Compiled> = subjects.iter_mut().map(compile).collect::<Result<_, _>>()?;
        let blank = |compiled: &Compiled| vec![(RowTally::default(), 0.0); compiled.stages.len()];
        Ok(Self { tallies: compiled.iter().map(blank).collect(), compiled })
    }

    /// Hands a chunk to every stage of every subject, in the order in which the jobs are finished.
    fn submit(&self, subjects: &mut [Subject], chunk: &Chunk<'_>) -> Result<Vec<Submitted>, DeviceError> {
        let mut jobs = vec![];
        for (subject, compiled) in subjects.iter_mut().zip(&self.compiled) {
            for (_, work) in &compiled.stages {
                let clock = Instant::now();
                let job = work.as_ref().ok().map(|work| subject.submit(work, &rows(chunk))).transpose()?;
                jobs.push((job, clock.elapsed().as_secs_f64()));
            }
        }
        Ok(jobs)
    }

    /// Waits for every stage of every subject, and judges what it gave.
    fn judge(
        &mut self,
        subjects: &[Subject],
        chunk: &Chunk<'_>,
        jobs: Vec<Submitted>,
        options: &Options,
        report: &mut Report,
    ) -> Result<(), DeviceError> {
        let (mut jobs, cases) = (jobs.into_iter(), chunk.cases.len() as u64);
        for ((subject, compiled), tallies) in subjects.iter().zip(&self.compiled).zip(&mut self.tallies) {
            for ((stage, work), (tally, seconds)) in compiled.stages.iter().zip(tallies) {
                let (Some((Some(job), submitting)), Ok(work)) = (jobs.next(), work) else {
                    tally.totals.cases += cases;
                    tally.totals.skipped += cases;
                    continue;
                };
                let clock = Instant::now();
                let words = subject.finish(work, job, &rows(chunk))?;
                let waiting = clock.elapsed().as_secs_f64();
                report.timing.devices += waiting;
                let clock = Instant::now();
                tally.add(judge_chunk(chunk, &words, *stage, &options.judging(subject)));
                report.timing.judge += clock.elapsed().as_secs_f64();
                *seconds += submitting + waiting + clock.elapsed().as_secs_f64();
            }
        }
        Ok(())
    }

    /// Adds a group for each stage of each subject to the report.
    fn finish(self, members: &[&Member], subjects: &[Subject], report: &mut Report) {
        for ((subject, compiled), tallies) in subjects.iter().zip(self.compiled).zip(self.tallies) {
            for ((stage, work), (tally, seconds)) in compiled.stages.into_iter().zip(tallies) {
                for (name, excused) in &tally.excused {
                    report.excuse(name, &subject.identity.name, *excused);
                }
                let problem = tally.problem();
                let name_of = |place: RowPlace| members[place.member].case_id(place.case);
                report.groups.push(Group {
                    totals: Totals { failed_groups: u64::from(problem.is_some()), ..tally.totals },
                    error_ulp_max: Number(tally.error_max),
                    margin_max: Number(tally.worst.as_ref().map_or(0.0, |(margin, _)| *margin)),
                    seconds,
                    worst: tally.worst.map(|(_, place)| name_of(place)),
                    skip_reason: work.err().map(Into::into),
                    problem,
                    ..Group::new(members[0].spec.group().into(), subject.identity.name.clone(), stage.name())
                });
                report.failures.extend(tally.reported());
            }
        }
    }
}

/// The rows of a chunk, as a stage takes them.
fn rows<'a>(chunk: &'a Chunk<'_>) -> Rows<'a> {
    Rows {
        members: chunk.members,
        of: &chunk.of,
        inputs: &chunk.inputs,
        selected: &chunk.selected,
        outputs: chunk.members[0].spec.output_len(),
    }
}
