//! A group of formulas in the stages that take rows: chunk after chunk, each handed to every stage of every subject, and judged.

use crate::again::{Digests, UNASKED, digest_of_values, number};
use crate::device::DeviceError;
use crate::diagnosed::{GroupRows, is_shader};
use crate::options::Options;
use crate::rows::Rows;
use crate::subject::{Compiled, Job, Subject};
use lightmeter_catalogue::cases::{Spec, Stage};
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::Number;
use lightmeter_document::event::{Event, Observer};
use lightmeter_document::report::{Diagnosis, Failure, Group, GroupSample, Report, Timing, Totals};
use lightmeter_judge::cases::Unanswered;
use lightmeter_judge::chunk::{self, Chunk};
use lightmeter_judge::diagnose::Told;
use lightmeter_judge::formula::{Judging, RowPlace, RowSample, RowStanding};
use lightmeter_judge::kept::KeptRow;
use lightmeter_judge::packed::packed;
use lightmeter_judge::tally::KEPT_FAILURES;
use std::time::Instant;

/// A group of formulas in the stages that take rows.
pub(crate) struct RowRun<'a> {
    members: &'a [&'a Member],
    /// The stages of each subject.
    compiled: Vec<Compiled>,
    /// What each of them has come to, and in how many seconds.
    standings: Vec<Vec<(RowStanding, f64)>>,
    /// What each stage of each subject answered to each case in turn, where that is wanted.
    digests: Option<Vec<Vec<Digests>>>,
}

/// Which stages of a subject are asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stages {
    /// All that there are.
    All,
    /// All but the fragment stage where the same function is asked for in the compute stage.
    First,
    /// What `First` leaves out.
    Rest,
}

impl Stages {
    /// Whether a stage among all is one of them.
    fn has<T, E>(self, stage: Stage, all: &[(Stage, Result<T, E>)]) -> bool {
        let has_compute = || all.iter().any(|(stage, work)| *stage == Stage::Compute && work.is_ok());
        let is_later = || stage == Stage::Fragment && has_compute();
        match self {
            Self::All => true,
            Self::First => !is_later(),
            Self::Rest => is_later(),
        }
    }
}

/// What a stage was handed.
enum Submitted {
    /// Nothing: it is not asked now.
    Nothing,
    /// It is skipped.
    Skipped,
    /// A job, and how long it took to hand it over.
    Job(Job, f64),
}

/// Cases that the subjects are at work on.
pub(crate) struct Begun<'a> {
    chunk: Chunk<'a>,
    jobs: Vec<Submitted>,
}

impl<'a> RowRun<'a> {
    /// Of a group, with its stages of every subject compiled. It notes what is answered where all is asked again.
    pub(crate) fn new(
        members: &'a [&'a Member],
        subjects: &mut [Subject],
        options: &Options,
    ) -> Result<Self, DeviceError> {
        let compile = |subject: &mut Subject| subject.compile(&options.code, members[0]);
        let compiled: Vec<Compiled> = subjects.iter_mut().map(compile).collect::<Result<_, DeviceError>>()?;
        let outputs = members[0].spec.output_len();
        let blank = |compiled: &Compiled| compiled.stages.iter().map(|_| (RowStanding::new(outputs), 0.0)).collect();
        let undigested = |compiled: &Compiled| compiled.stages.iter().map(|_| Digests::default()).collect();
        let digests = (options.runs > 1).then(|| compiled.iter().map(undigested).collect());
        Ok(Self { members, standings: compiled.iter().map(blank).collect(), compiled, digests })
    }

    /// The group's id.
    pub(crate) fn id(&self) -> &'a str {
        self.members[0].spec.group()
    }

    /// Whether a verdict fails.
    pub(crate) fn fails(&self) -> bool {
        self.standings.iter().flatten().any(|(standing, _)| standing.tally.totals.failed > 0)
    }

    /// What was answered to each case by each stage of each subject, where it was noted.
    pub(crate) fn noted(&mut self) -> Option<Vec<Vec<Digests>>> {
        self.digests.take()
    }

    /// Draws cases, each with its formula's place among the group's, and hands them to stages of every subject.
    pub(crate) fn begin(
        &self,
        cases: &[(usize, CaseRef)],
        stages: Stages,
        subjects: &mut [Subject],
        options: &Options,
        report: &mut Report,
    ) -> Result<Begun<'a>, DeviceError> {
        let clock = Instant::now();
        let chunk = chunk::draw(self.members, cases, options.seed);
        report.timing.generate += clock.elapsed().as_secs_f64();
        self.start(chunk, stages, subjects, report)
    }

    /// Hands cases that are drawn already to stages of every subject.
    pub(crate) fn start(
        &self,
        chunk: Chunk<'a>,
        stages: Stages,
        subjects: &mut [Subject],
        report: &mut Report,
    ) -> Result<Begun<'a>, DeviceError> {
        let clock = Instant::now();
        let jobs = self.submit(stages, subjects, &chunk)?;
        report.timing.devices += clock.elapsed().as_secs_f64();
        Ok(Begun { chunk, jobs })
    }

    /// Works out what is legal while the subjects work, and judges what they give; the cases with what is legal.
    pub(crate) fn end(
        &mut self,
        mut begun: Begun<'a>,
        subjects: &mut [Subject],
        options: &Options,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) -> Result<Chunk<'a>, DeviceError> {
        let clock = Instant::now();
        chunk::refer(&mut begun.chunk, options.profile);
        report.timing.reference += clock.elapsed().as_secs_f64();
        self.judge(begun, subjects, options, report, observer)
    }

    /// What the subjects answer to cases that were judged before.
    pub(crate) fn answers(
        &self,
        begun: Begun<'a>,
        subjects: &mut [Subject],
        observer: &mut dyn Observer,
    ) -> Result<Vec<Vec<Digests>>, DeviceError> {
        let mut jobs = begun.jobs.into_iter();
        let mut all = vec![];
        for (subject, compiled) in subjects.iter_mut().zip(&self.compiled) {
            let mut stages = vec![];
            for (_, work) in &compiled.stages {
                let mut digests = Digests::default();
                if let (Some(Submitted::Job(job, _)), Ok(work)) = (jobs.next(), work) {
                    let mut advanced = |count| observer.see(&Event::Advanced(count));
                    let answers = subject.finish(work, job, &rows(&begun.chunk), &mut advanced)?;
                    digests.note(&answers, self.members[0].spec.output_len(), begun.chunk.cases.len());
                }
                stages.push(digests);
            }
            all.push(stages);
        }
        Ok(all)
    }

    /// A sample of at most `most` failing cases for each stage of each subject, each with a hash of its answer.
    pub(crate) fn failing(&self, most: usize) -> Vec<Vec<Vec<(CaseRef, u32)>>> {
        let of_stage = |(standing, _): &(RowStanding, f64)| {
            let values = |row: &KeptRow| digest_of_values(row.values.iter().map(|&value| value.into()));
            let rows = standing.wrong.rows().into_iter().map(|((_, case), row)| (case, values(row)));
            let refused = standing.cases.refused.iter().filter(|(_, why)| matches!(why, Unanswered::Unjudged(_)));
            let mut all: Vec<(CaseRef, u32)> =
                rows.chain(refused.map(|(&(_, case), why)| (case, number(why)))).collect();
            all.sort_unstable();
            let stride = all.len().div_ceil(most).max(1);
            all.into_iter().step_by(stride).collect()
        };
        self.standings.iter().map(|stages| stages.iter().map(of_stage).collect()).collect()
    }

    /// Counts cases as not asked because the subject no longer answers.
    pub(crate) fn leave_out(&mut self, cases: &[(usize, CaseRef)]) {
        for (standing, _) in self.standings.iter_mut().flatten() {
            for &case in cases {
                standing.tally.totals.cases += 1;
                standing.cases.unanswered(case, &Unanswered::Unasked);
            }
        }
        let digests = self.digests.iter_mut().flatten().flatten();
        digests.for_each(|digests| digests.0.extend(cases.iter().map(|_| UNASKED)));
    }

    /// Hands a chunk to stages of every subject, in the order in which the jobs are finished.
    fn submit(
        &self,
        stages: Stages,
        subjects: &mut [Subject],
        chunk: &Chunk<'_>,
    ) -> Result<Vec<Submitted>, DeviceError> {
        let mut jobs = vec![];
        for (subject, compiled) in subjects.iter_mut().zip(&self.compiled) {
            for (stage, work) in &compiled.stages {
                let clock = Instant::now();
                jobs.push(match work {
                    _ if !stages.has(*stage, &compiled.stages) => Submitted::Nothing,
                    Err(_) => Submitted::Skipped,
                    Ok(work) => Submitted::Job(subject.submit(work, &rows(chunk))?, clock.elapsed().as_secs_f64()),
                });
            }
        }
        Ok(jobs)
    }

    /// Waits for the stages of every subject, and judges what they gave; the cases.
    pub(crate) fn judge(
        &mut self,
        Begun { chunk, jobs }: Begun<'a>,
        subjects: &mut [Subject],
        options: &Options,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) -> Result<Chunk<'a>, DeviceError> {
        let (mut jobs, cases) = (jobs.into_iter(), chunk.cases.len() as u64);
        let outputs = self.members[0].spec.output_len();
        for (place, (subject, compiled)) in subjects.iter_mut().zip(&self.compiled).enumerate() {
            let stages = compiled.stages.iter().zip(&mut self.standings[place]).enumerate();
            for (number, ((stage, work), (standing, seconds))) in stages {
                let (job, submitting, work) = match (jobs.next(), work) {
                    (Some(Submitted::Job(job, submitting)), Ok(work)) => (job, submitting, work),
                    (Some(Submitted::Skipped), _) => {
                        standing.tally.totals.cases += cases;
                        standing.tally.totals.skipped += cases;
                        continue;
                    }
                    _ => continue,
                };
                let clock = Instant::now();
                let answers =
                    subject.finish(work, job, &rows(&chunk), &mut |count| observer.see(&Event::Advanced(count)))?;
                let waiting = clock.elapsed().as_secs_f64();
                report.timing.devices += waiting;
                let clock = Instant::now();
                standing.judge(&chunk, &answers, *stage, &options.judging(subject));
                if let Some(digests) = &mut self.digests {
                    digests[place][number].note(&answers, outputs, chunk.cases.len());
                }
                report.timing.judge += clock.elapsed().as_secs_f64();
                *seconds += submitting + waiting + clock.elapsed().as_secs_f64();
            }
        }
        Ok(chunk)
    }

    /// Adds a group for each stage of each subject to the report.
    pub(crate) fn finish(self, subjects: &[Subject], options: &Options, report: &mut Report) {
        let (groups, failures) = self.groups(subjects, options, &mut report.timing);
        report.groups.extend(groups);
        report.failures.extend(failures);
        self.note(subjects, report);
    }

    /// Notes in a report what deviations and known failures excused.
    pub(crate) fn note(&self, subjects: &[Subject], report: &mut Report) {
        for (subject, standings) in subjects.iter().zip(&self.standings) {
            for (standing, _) in standings {
                for (name, excused) in &standing.tally.excused {
                    report.excuse(name, &subject.identity.name, *excused);
                }
                standing.cases.note(&mut report.expectations);
            }
        }
    }

    /// A group for each stage of each subject, and the failures that are reported.
    pub(crate) fn groups(
        &self,
        subjects: &[Subject],
        options: &Options,
        timing: &mut Timing,
    ) -> (Vec<Group>, Vec<Failure>) {
        let (mut groups, mut failures) = (vec![], vec![]);
        for ((subject, compiled), standings) in subjects.iter().zip(&self.compiled).zip(&self.standings) {
            let by = options.judging(subject);
            let mut before: Option<(&RowStanding, Told)> = None;
            for ((stage, work), (standing, seconds)) in compiled.stages.iter().zip(standings) {
                let clock = Instant::now();
                // Where the fragment stage gave the same bits as the compute stage, the diagnosis is the same: it is not made twice.
                let told = match before.take() {
                    Some((other, told)) if is_shader(*stage) && is_like(other, standing) => told,
                    _ => self.told(standing, *stage, subject, options),
                };
                timing.diagnose += clock.elapsed().as_secs_f64();
                groups.push(Group {
                    seconds: *seconds,
                    sample: options.keeps_samples().then(|| sampled(self.members, standing)),
                    skip_reason: work.as_ref().err().map(|reason| (*reason).into()),
                    ..self.group(standing, *stage, told.clone(), &by)
                });
                failures.extend(standing.failures(self.members, *stage, &by).into_iter().take(KEPT_FAILURES));
                before = is_shader(*stage).then_some((standing, told));
            }
        }
        (groups, failures)
    }

    fn told(&self, standing: &RowStanding, stage: Stage, subject: &Subject, options: &Options) -> Told {
        let RowStanding { failing, wrong, right, .. } = standing;
        let rows = GroupRows { members: self.members, stage, failing, wrong, right };
        rows.told(options.diagnose, &subject.known.granted(options.profile))
    }

    /// The group of a stage's verdicts.
    fn group(&self, standing: &RowStanding, stage: Stage, told: Told, by: &Judging<'_>) -> Group {
        let tally = &standing.tally;
        let problem = tally.problem().or(told.systematic);
        let name_of = |place: &RowPlace| self.members[place.member].case_id(place.case);
        let id = group_id(&self.members[0].spec, stage);
        let counts = by.counts_cases.then(|| standing.cases.told(self.members, id));
        let unjudged = counts.as_ref().map_or(0, |counts| counts.totals.unjudged);
        let diagnosis = told.diagnosis.map(|found| Diagnosis { unjudged, ..found });
        Group {
            totals: Totals { failed_groups: u64::from(problem.is_some()), ..tally.totals },
            error_ulp_max: Number(tally.error_max),
            margin_max: Number(tally.worst.as_ref().map_or(0.0, |(margin, _)| *margin)),
            worst: tally.worst.as_ref().map(|(_, place)| name_of(place)),
            worst_answer: standing.worst_answer(self.members),
            diagnosis,
            problems: problem.into_iter().collect(),
            by_case: counts,
            ..Group::new(id.into(), by.adapter.to_owned(), stage.name())
        }
    }
}

/// Whether two stages gave the same.
fn is_like(one: &RowStanding, other: &RowStanding) -> bool {
    let is_same = |one: &RowSample, other: &RowSample| one.is_like(other, KeptRow::has_values_of);
    is_same(&one.wrong, &other.wrong) && is_same(&one.right, &other.right)
}

/// What a shard keeps of a group's rows.
fn sampled(members: &[&Member], standing: &RowStanding) -> GroupSample {
    GroupSample {
        formulas: members.iter().map(|member| member.spec.id.clone()).collect(),
        failing: (0..members.len()).map(|place| standing.failing.get(&place).copied().unwrap_or_default()).collect(),
        random: standing.tally.random.into(),
        wrong: packed(&standing.wrong, |row| row.values.clone()),
        right: packed(&standing.right, |row| row.values.clone()),
        stores: None,
    }
}

/// The id of the group that a formula is judged in: of a renderer, each formula is a group.
pub(crate) fn group_id(spec: &Spec, stage: Stage) -> &str {
    if stage == Stage::Answer { &spec.id } else { spec.group() }
}

/// The rows of a chunk, as a stage takes them.
fn rows<'a>(chunk: &'a Chunk<'_>) -> Rows<'a> {
    Rows {
        members: chunk.members,
        of: &chunk.of,
        cases: &chunk.cases,
        inputs: &chunk.inputs,
        selected: if chunk.selected.is_empty() { &chunk.inputs } else { &chunk.selected },
        outputs: chunk.members[0].spec.output_len(),
    }
}
