//! A group of formulas in the stages that take rows: chunk after chunk, each handed to every stage of every subject before the
//! reference is computed on all cores.

use crate::device::DeviceError;
use crate::options::Options;
use crate::rows::Rows;
use crate::subject::{Compiled, Job, Subject};
use lightmeter_catalogue::cases::Stage;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::Number;
use lightmeter_document::run::{Group, Report, Totals};
use lightmeter_judge::chunk::{self, Chunk};
use lightmeter_judge::diagnose::{Row, Told};
use lightmeter_judge::formula::{RowPlace, RowSample, RowStanding};
use std::cmp::Reverse;
use std::collections::HashMap;
use std::time::Instant;

/// The stages of every subject that are compiled already, by group.
pub(crate) type CompiledGroups = HashMap<String, Vec<Compiled>>;

/// A group of formulas in the stages that take rows.
pub(crate) struct RowRun<'a> {
    members: &'a [&'a Member],
    /// The stages of each subject.
    compiled: Vec<Compiled>,
    /// What each of them has come to, and in how many seconds.
    standings: Vec<Vec<(RowStanding, f64)>>,
    /// Which stages are asked.
    asked: Asked,
}

/// Which stages of a subject are asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    /// All that there are.
    All,
    /// All but the fragment stage where the same function is asked for in the compute stage.
    OneOfShaders,
}

impl Asked {
    /// The stages that are asked.
    fn of<T, E>(self, stages: &[(Stage, Result<T, E>)]) -> impl Iterator<Item = &(Stage, Result<T, E>)> {
        let has_compute = stages.iter().any(|(stage, work)| *stage == Stage::Compute && work.is_ok());
        let skipped = (self == Self::OneOfShaders && has_compute).then_some(Stage::Fragment);
        stages.iter().filter(move |(stage, _)| Some(*stage) != skipped)
    }
}

/// A job of a stage, and how long it took to hand it over; `None` where the stage is skipped.
type Submitted = (Option<Job>, f64);

/// Cases that the subjects are at work on.
pub(crate) struct Begun<'a> {
    chunk: Chunk<'a>,
    jobs: Vec<Submitted>,
}

impl<'a> RowRun<'a> {
    /// The stages of every subject, compiled.
    pub(crate) fn compile(
        member: &Member,
        subjects: &mut [Subject],
        options: &Options,
    ) -> Result<Vec<Compiled>, DeviceError> {
        subjects.iter_mut().map(|subject| subject.compile(&options.code, member)).collect()
    }

    /// Of a group, whose stages are compiled.
    pub(crate) fn new(members: &'a [&'a Member], compiled: Vec<Compiled>, asked: Asked) -> Self {
        let outputs = members[0].spec.output_len();
        let blank =
            |compiled: &Compiled| asked.of(&compiled.stages).map(|_| (RowStanding::new(outputs), 0.0)).collect();
        Self { members, standings: compiled.iter().map(blank).collect(), compiled, asked }
    }

    /// Draws cases, each with its formula's place among the group's, and hands them to every stage of every subject.
    pub(crate) fn begin(
        &self,
        cases: &[(usize, CaseRef)],
        subjects: &mut [Subject],
        options: &Options,
        report: &mut Report,
    ) -> Result<Begun<'a>, DeviceError> {
        let clock = Instant::now();
        let chunk = chunk::draw(self.members, cases, options.seed);
        report.timing.generate += clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        let jobs = self.submit(subjects, &chunk)?;
        report.timing.devices += clock.elapsed().as_secs_f64();
        Ok(Begun { chunk, jobs })
    }

    /// Works out what is legal while the subjects work, and judges what they give.
    pub(crate) fn end(
        &mut self,
        mut begun: Begun<'a>,
        subjects: &[Subject],
        options: &Options,
        report: &mut Report,
    ) -> Result<(), DeviceError> {
        let clock = Instant::now();
        chunk::refer(&mut begun.chunk, options.profile);
        report.timing.reference += clock.elapsed().as_secs_f64();
        self.judge(subjects, &begun.chunk, begun.jobs, options, report)
    }

    /// Hands a chunk to every stage of every subject, in the order in which the jobs are finished.
    fn submit(&self, subjects: &mut [Subject], chunk: &Chunk<'_>) -> Result<Vec<Submitted>, DeviceError> {
        let mut jobs = vec![];
        for (subject, compiled) in subjects.iter_mut().zip(&self.compiled) {
            for (_, work) in self.asked.of(&compiled.stages) {
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
        for ((subject, compiled), standings) in subjects.iter().zip(&self.compiled).zip(&mut self.standings) {
            for ((stage, work), (standing, seconds)) in self.asked.of(&compiled.stages).zip(standings) {
                let (Some((Some(job), submitting)), Ok(work)) = (jobs.next(), work) else {
                    standing.tally.totals.cases += cases;
                    standing.tally.totals.skipped += cases;
                    continue;
                };
                let clock = Instant::now();
                let words = subject.finish(work, job, &rows(chunk))?;
                let waiting = clock.elapsed().as_secs_f64();
                report.timing.devices += waiting;
                let clock = Instant::now();
                standing.judge(chunk, &words, *stage, &options.judging(subject));
                report.timing.judge += clock.elapsed().as_secs_f64();
                *seconds += submitting + waiting + clock.elapsed().as_secs_f64();
            }
        }
        Ok(())
    }

    /// Adds a group for each stage of each subject to the report, and hands back what was compiled.
    pub(crate) fn finish(self, subjects: &[Subject], options: &Options, report: &mut Report) -> Vec<Compiled> {
        for ((subject, compiled), standings) in subjects.iter().zip(&self.compiled).zip(self.standings) {
            let mut before: Option<(RowSample, RowSample, Told)> = None;
            for ((stage, work), (standing, seconds)) in self.asked.of(&compiled.stages).zip(standings) {
                for (name, excused) in &standing.tally.excused {
                    report.excuse(name, &subject.identity.name, *excused);
                }
                let clock = Instant::now();
                // Where the fragment stage gave the same bits as the compute stage, the diagnosis is the same: it is not made twice.
                let told = match before.take() {
                    Some((wrong, right, told))
                        if is_shader(*stage) && wrong == standing.wrong && right == standing.right =>
                    {
                        told
                    }
                    _ => told(self.members, &standing, *stage, subject, options),
                };
                report.timing.diagnose += clock.elapsed().as_secs_f64();
                let RowStanding { tally, wrong, right, .. } = standing;
                before = is_shader(*stage).then(|| (wrong, right, told.clone()));
                let problem = tally.problem().or(told.systematic);
                let name_of = |place: RowPlace| self.members[place.member].case_id(place.case);
                report.groups.push(Group {
                    totals: Totals { failed_groups: u64::from(problem.is_some()), ..tally.totals },
                    error_ulp_max: Number(tally.error_max),
                    margin_max: Number(tally.worst.as_ref().map_or(0.0, |(margin, _)| *margin)),
                    seconds,
                    worst: tally.worst.map(|(_, place)| name_of(place)),
                    skip_reason: work.as_ref().err().map(|reason| (*reason).into()),
                    explanation: told.explanation,
                    problem,
                    ..Group::new(self.members[0].spec.group().into(), subject.identity.name.clone(), stage.name())
                });
                report.failures.extend(tally.reported());
            }
        }
        self.compiled
    }
}

/// What explains the rows of a stage that fail; where none does, what is wrong with all of them together. Of several formulas it is
/// told of the one that fails most often.
fn told(members: &[&Member], standing: &RowStanding, stage: Stage, subject: &Subject, options: &Options) -> Told {
    let (wrong, right) = (standing.wrong.rows(), standing.right.rows());
    let Some(diagnose) = options.diagnose else { return Told::default() };
    // What a rasteriser or a depth test does is no arithmetic with a parameter that may be off.
    if wrong.is_empty() && (members.len() > 1 || !is_shader(stage)) {
        return Told::default();
    }
    let most = standing.failing.iter().max_by_key(|(member, count)| (**count, Reverse(**member)));
    let (most, failing) = most.map_or((0, 0), |(member, count)| (*member, *count));
    let member = members[most];
    let profile = subject.known.profile(options.profile);
    let rows = [wrong, right].map(|rows| of_member(member, most, rows, options.seed));
    let mut told = Told::of(diagnose, member, [&rows[0], &rows[1]], failing, &profile);
    if members.len() > 1 {
        told.explanation = told.explanation.map(|says| format!("{}: {says}", member.spec.id));
    }
    told
}

const fn is_shader(stage: Stage) -> bool {
    matches!(stage, Stage::Compute | Stage::Fragment)
}

/// The rows of one formula, by its place among the group's, with their inputs.
fn of_member<'a>(member: &Member, place: usize, rows: Vec<((usize, CaseRef), &'a [f32])>, seed: u64) -> Vec<Row<'a>> {
    let row = |((_, case), values)| {
        let mut inputs = Vec::with_capacity(member.spec.input_len());
        member.inputs(case, seed, &mut inputs);
        (inputs, values, matches!(case, CaseRef::Random(_)))
    };
    // A hard case is one of its own formula alone.
    rows.into_iter().filter(|((of, _), _)| *of == place).map(row).collect()
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
