//! A conversation with a process: its start, batches of questions, its answers as they come, its end.

use super::super::answer::{self, Line, Unread};
use super::super::error::ProcessError;
use super::super::given::{Asks, Given, Skips, given};
use super::super::hello::{self, Hello};
use super::super::pack::described;
use super::super::problems::note;
use super::super::words::clipped;
use super::Asking;
use super::clock::Clock;
use super::running::{Event, Running};
use lightmeter_catalogue::cases::Spec;
use lightmeter_document::by_case::RendererUse;
use lightmeter_document::protocol::{BatchEnd, FormulaDescription, Greeting, PROTOCOL};
use lightmeter_judge::cases::ExpectedFailure;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

/// Cases that are asked at once, at first and at most: twice as many where they were answered in an eighth of what a case may take.
pub(super) const BATCH: [usize; 2] = [16, 1024];
/// Cases of a batch in columns, at first and at most: twice as many where they were answered in an eighth of what a batch may take.
pub(super) const ROWS: [usize; 2] = [256, 1 << 14];
/// Lines that wait to be read as answers, and their bytes, at most.
const WAITING: (usize, usize) = (4096, 8 << 20);
/// Lines beyond one a case, in a batch, that end a process.
pub(super) const SURPLUS: usize = 10_000;
/// How long a wait lasts before it is asked whether to stop.
const MOMENT: Duration = Duration::from_millis(100);

/// What became of a process while it was asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ended {
    /// All is answered.
    Answered,
    /// It ended, or its output did.
    Crashed,
    /// It took too long.
    Hung,
    /// It wrote what was not asked for, without end.
    Flooded,
    /// It answered, and did not read what it was asked.
    Deaf,
    /// Time for all is over.
    OutOfTime,
    /// The gate was told to stop.
    Stopped,
}

impl Ended {
    /// It in words.
    pub(super) const fn message(self) -> &'static str {
        match self {
            Self::Answered => "it answered",
            Self::Crashed => "it ended",
            Self::Hung => "it took longer than a case may",
            Self::Flooded => "it wrote many lines that answer nothing",
            Self::Deaf => "it answered, and did not read what it was asked",
            Self::OutOfTime => "time for all is over",
            Self::Stopped => "it was stopped",
        }
    }
}

/// A question.
pub(super) struct Question<'a> {
    pub(super) id: String,
    /// The line that asks it.
    pub(super) request: String,
    pub(super) asks: Asks<'a>,
}

/// Questions, and what was given to them so far.
pub(super) struct Questions<'a> {
    pub(super) all: &'a [Question<'a>],
    /// The place of each by its id.
    places: HashMap<&'a str, usize>,
    pub(super) given: Vec<Option<Given>>,
}

impl<'a> Questions<'a> {
    pub(super) fn new(all: &'a [Question<'a>]) -> Self {
        let places = all.iter().enumerate().map(|(place, question)| (question.id.as_str(), place)).collect();
        Self { all, places, given: vec![None; all.len()] }
    }
}

/// A batch that is asked.
struct Waiting {
    /// What is not answered, by its id.
    open: HashMap<String, usize>,
    /// How long an answer may take.
    limit: Duration,
    /// Until when the next must come: answers must come all the time, and nothing else counts.
    until: Duration,
    /// Lines that wait to be read as answers, each with its number, and their bytes.
    lines: Vec<(u64, Vec<u8>)>,
    bytes: usize,
    /// Lines that answer nothing.
    surplus: usize,
}

impl Waiting {
    /// Takes a line that came `now`, and counts it where it is not blank.
    fn hear(&mut self, line: Vec<u8>, now: Duration, count: &mut u64) {
        if line.iter().all(u8::is_ascii_whitespace) {
            self.surplus += 1;
            return;
        }
        if answer::id(&line).is_some_and(|id| self.open.remove(id.as_ref()).is_some()) {
            self.until = now + self.limit;
        } else {
            self.surplus += 1;
        }
        self.bytes += line.len();
        *count += 1;
        self.lines.push((*count, line));
    }
}

/// The state of a conversation, over all starts of the process.
pub(super) struct Session {
    pub(super) asking: Asking,
    pub(super) expected: Vec<ExpectedFailure>,
    pub(super) clock: Clock,
    deadline: Option<Duration>,
    pub(super) running: Option<Running>,
    /// What it said first.
    hello: Hello,
    /// What it may skip.
    pub(super) skips: Skips,
    pub(super) used: RendererUse,
    /// Lines that it wrote after its hello.
    pub(super) lines: u64,
    /// The number of the last batch.
    pub(super) number: u64,
    /// Cases that are asked at once.
    pub(super) size: usize,
    /// Cases that are asked at once in columns.
    pub(super) rows: usize,
    /// How often it failed in columns at each formula.
    pub(super) failed_in_columns: HashMap<String, usize>,
    /// Whether it wrote fewer bytes of an array than it announced, and hung so: it is asked in columns no more.
    pub(super) hangs_in_arrays: bool,
    /// Cases that the process has answered since it was started.
    pub(super) answered: usize,
    /// Cases that it failed at.
    pub(super) culprits: u64,
    /// How many of each formula, but for those that are expected.
    pub(super) culprits_of: HashMap<String, usize>,
    /// The ids that were asked, hashed.
    asked: HashSet<u64>,
    /// The formulas that the process was told of since it was started.
    described: HashSet<String>,
    /// Whether nothing more is asked.
    pub(super) has_broken_off: bool,
}

impl Drop for Session {
    /// Whatever ends the session, the process does not outlive it.
    fn drop(&mut self) {
        if let Some(running) = self.running.take() {
            running.kill();
        }
    }
}

impl Session {
    pub(super) fn new(asking: Asking) -> Self {
        Self {
            clock: Clock::new(asking.is_time_told),
            deadline: asking.limits.total,
            asking,
            expected: vec![],
            running: None,
            hello: Hello::default(),
            skips: Skips::default(),
            used: RendererUse::default(),
            lines: 0,
            number: 0,
            size: BATCH[0],
            rows: ROWS[0],
            failed_in_columns: HashMap::new(),
            hangs_in_arrays: false,
            answered: 0,
            culprits: 0,
            culprits_of: HashMap::new(),
            asked: HashSet::new(),
            described: HashSet::new(),
            has_broken_off: false,
        }
    }

    /// What it said of itself.
    pub(super) const fn hello(&self) -> &Hello {
        &self.hello
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.asking.stop.is_set()
    }

    /// Whether nothing more is asked.
    pub(super) fn is_over(&self) -> bool {
        self.has_broken_off || self.is_stopped()
    }

    /// Ends the process once it has nothing more to do; where it ends otherwise than well, that is told.
    fn finish(&mut self) {
        if let Some(running) = self.running.take() {
            let stop = &self.asking.stop;
            let end = running.finish(self.asking.limits.case, &self.clock, || stop.is_set());
            self.used.incidents.extend(end.wrong);
            // Behind an array it may be what a wrong number of bytes left over.
            if end.unread > 0 && self.hello.columns {
                note(&mut self.used.problems, "malformed", || {
                    format!(
                        "{} bytes behind the last answer, which nothing asked for; expected as many bytes of arrays as their lines announce",
                        end.unread
                    )
                });
            }
        }
    }

    /// All of it is asked once more, of a process that is started anew: what it remembers must not matter.
    pub(super) fn begin_again(&mut self) {
        self.finish();
        self.culprits_of.clear();
        self.failed_in_columns.clear();
        self.asked.clear();
    }

    /// Ends it, and tells who it was and what went wrong.
    pub(super) fn end_well(&mut self) -> RendererUse {
        self.finish();
        let (identity, declares) = (self.hello.identity(), self.hello.declares());
        RendererUse { identity, declares, ..self.used.clone() }
    }

    /// Ends it at once; what it ended by, and what it complained of.
    pub(super) fn kill(&mut self, ended: Ended) -> String {
        let Some(mut running) = self.running.take() else { return ended.message().to_owned() };
        if ended == Ended::Crashed {
            running.has_ended();
        }
        running.kill()
    }

    /// Starts the process and hears its hello.
    pub(super) fn start(&mut self) -> Result<(), ProcessError> {
        let failed = |message: String| ProcessError::Start { command: self.asking.command.clone(), message };
        let mut running =
            Running::start(&self.asking.command, self.asking.starter.as_ref(), &self.clock).map_err(&failed)?;
        self.used.starts += 1;
        let greeting = Greeting {
            hello: PROTOCOL.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            folder: self.asking.folder.to_string_lossy().into_owned(),
        };
        running.send(format!("{greeting}\n").into_bytes());
        let begun = self.clock.now();
        let until = self.over(begun + self.asking.limits.start);
        loop {
            let event = self.hear(&running, until);
            if matches!(event, Err(RecvTimeoutError::Timeout)) && self.clock.now() < until && !self.is_stopped() {
                continue;
            }
            let message = match event {
                Ok(Event::Line(line)) if line.iter().all(u8::is_ascii_whitespace) => continue,
                Ok(Event::Line(line)) => match answer::read(&line) {
                    Ok(Line::Hello(hello)) if self.used.starts > 1 && *hello != self.hello => {
                        let which = self.hello.difference(&hello).unwrap_or_default();
                        format!("says another hello than when it was started first: {which}")
                    }
                    Ok(Line::Hello(hello)) => {
                        self.answered = 0;
                        self.described.clear();
                        self.hello = *hello;
                        running.framing.has_columns(self.hello.columns);
                        // It may have said its hello before it read ours.
                        if self.has_read(&mut running, until) {
                            self.running = Some(running);
                            return Ok(());
                        }
                        "did not read the greeting".to_owned()
                    }
                    Err(message) if hello::is_one(&line) => message,
                    _ => {
                        let line = clipped(&String::from_utf8_lossy(&line));
                        format!(
                            "said `{line}` first; expected a hello such as {{\"hello\": \"{PROTOCOL}\", \"renderer\": …}}"
                        )
                    }
                },
                Ok(Event::Columns(..) | Event::TooLong) => "said a line without end first; expected its hello".into(),
                Ok(Event::End) | Err(RecvTimeoutError::Disconnected) => {
                    running.has_ended();
                    let how = running.kill();
                    return Err(failed(format!("ended before its hello: {how}")));
                }
                Err(RecvTimeoutError::Timeout) if self.is_stopped() => "was stopped before its hello".into(),
                Ok(Event::Passed(_)) | Err(RecvTimeoutError::Timeout) => {
                    running.said_no_line_for(until.saturating_sub(begun).as_secs_f64())
                }
            };
            running.kill();
            return Err(failed(format!("{message} (it was then ended)")));
        }
    }

    /// Asks questions at once, by their places; how that ended, and which are left unanswered.
    pub(super) fn batch(&mut self, questions: &mut Questions<'_>, batch: &[usize]) -> (Ended, Vec<usize>) {
        let text = self.requests(questions, batch);
        let Some(mut running) = self.running.take() else { return (Ended::Crashed, batch.to_vec()) };
        running.send(text.into_bytes());
        let limits = self.asking.limits;
        let limit = if matches!(questions.all[batch[0]].asks, Asks::Image) { limits.scene } else { limits.case };
        let start = self.clock.now();
        let mut waiting = Waiting {
            open: batch.iter().map(|&place| (questions.all[place].id.clone(), place)).collect(),
            limit,
            until: start + limit,
            lines: vec![],
            bytes: 0,
            surplus: 0,
        };
        let mut ended = self.listen(questions, &running, &mut waiting);
        self.read(questions, &waiting.lines);
        if ended == Ended::Answered {
            if !self.has_read(&mut running, waiting.until) {
                ended = Ended::Deaf;
            }
            if (self.clock.now() - start) * 8 < limit {
                self.size = (2 * self.size).min(BATCH[1]);
            }
        }
        self.running = Some(running);
        let is_open = |place: &usize| waiting.open.values().any(|open| open == place);
        (ended, batch.iter().copied().filter(is_open).collect())
    }

    /// What a batch is asked by, a line each, with its number behind them.
    fn requests(&mut self, questions: &Questions<'_>, batch: &[usize]) -> String {
        let mut text = String::new();
        for &place in batch {
            let Question { id, request, asks } = &questions.all[place];
            self.asked.insert(hash(id));
            if let Asks::Outputs(spec) | Asks::Pixel(spec) = asks {
                text += &self.description(spec);
            }
            text += request;
            text.push('\n');
        }
        self.number += 1;
        text + &format!("{}\n", BatchEnd { batch: self.number })
    }

    /// A line that describes a formula, where it was asked for and not written yet.
    pub(super) fn description(&mut self, spec: &Spec) -> String {
        if self.hello.describe && self.described.insert(spec.id.clone()) {
            format!("{}\n", FormulaDescription { describe: described(spec) })
        } else {
            String::new()
        }
    }

    /// Takes lines for answers to questions. What answers none of them is a problem.
    fn read(&mut self, questions: &mut Questions<'_>, lines: &[(u64, Vec<u8>)]) {
        let read: Vec<(u64, Result<Line<'_>, String>)> =
            lines.par_iter().map(|(number, line)| (*number, answer::read(line))).collect();
        for (number, line) in read {
            let line = match line {
                Ok(line) => line,
                Err(message) => {
                    note(&mut self.used.problems, "malformed", || format!("line {number}: {message}"));
                    continue;
                }
            };
            let Some(id) = line.id() else {
                note(&mut self.used.problems, "malformed", || {
                    format!("line {number}: a hello, which is said once and first")
                });
                continue;
            };
            match questions.places.get(id) {
                Some(&place) if questions.given[place].is_none() => {
                    let id = &questions.all[place].id;
                    questions.given[place] = Some(self.skips.settled(id, given(line, questions.all[place].asks)));
                }
                None if !self.asked.contains(&hash(id)) => note(&mut self.used.problems, "unknown", || {
                    format!("line {number}: no case `{}` was asked for", clipped(id))
                }),
                _ => note(&mut self.used.problems, "duplicate", || {
                    format!("line {number}: {id} is answered more than once")
                }),
            }
        }
    }

    /// Takes answers until all that is open is answered, or the process fails.
    fn listen(&mut self, questions: &mut Questions<'_>, running: &Running, waiting: &mut Waiting) -> Ended {
        loop {
            if waiting.open.is_empty() {
                return Ended::Answered;
            }
            if waiting.surplus > SURPLUS {
                return Ended::Flooded;
            }
            if waiting.lines.len() >= WAITING.0 || waiting.bytes >= WAITING.1 {
                self.read(questions, &waiting.lines);
                waiting.lines.clear();
                waiting.bytes = 0;
            }
            if self.is_stopped() {
                return Ended::Stopped;
            }
            let until = self.over(waiting.until);
            if self.clock.now() >= until {
                return if self.is_out_of_time() { Ended::OutOfTime } else { Ended::Hung };
            }
            match self.hear(running, until) {
                Ok(Event::Line(line)) => waiting.hear(line, self.clock.now(), &mut self.lines),
                Ok(Event::TooLong) => {
                    waiting.surplus += 1;
                    self.lines += 1;
                    let number = self.lines;
                    note(&mut self.used.problems, "oversized", || format!("line {number}: {}", Unread::TooLong));
                }
                Ok(Event::Columns(answer, _)) => {
                    waiting.surplus += 1;
                    self.is_not_asked(&answer);
                }
                Ok(Event::End) | Err(RecvTimeoutError::Disconnected) => return Ended::Crashed,
                // The next turn tells which time is over.
                Ok(Event::Passed(_)) | Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    /// What the process writes next, within a moment and before `until`. Time that it tells is noted here.
    pub(super) fn hear(&self, running: &Running, until: Duration) -> Result<Event, RecvTimeoutError> {
        let event = running.next(until.saturating_sub(self.clock.now()).min(MOMENT));
        if let Ok(Event::Passed(time)) = event {
            self.clock.pass(time);
        }
        event
    }

    /// Whether time for all is over.
    pub(super) fn is_out_of_time(&self) -> bool {
        self.deadline.is_some_and(|deadline| self.clock.now() >= deadline)
    }

    /// A moment, or that at which time for all is over.
    pub(super) fn over(&self, until: Duration) -> Duration {
        self.deadline.map_or(until, |deadline| until.min(deadline))
    }

    /// Whether the process reads all that it was asked, as one that answers does.
    pub(super) fn has_read(&self, running: &mut Running, until: Duration) -> bool {
        let over = self.over(until);
        while !running.has_read() {
            if self.clock.now() >= over || self.is_stopped() {
                return false;
            }
            running.hear_ahead(&self.clock, Duration::from_millis(1));
        }
        true
    }
}

fn hash(id: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    id.hash(&mut hasher);
    hasher.finish()
}
