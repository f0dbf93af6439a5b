//! A renderer in a process of its own, which speaks JSON lines on its standard input and output.
//!
//! It is started in a process group of its own and with a mark in its environment, so that it ends with its children. What it was asked and has not answered is
//! known at every moment: where it ends, hangs or floods, it is killed and started again, and asked what is open one case at a
//! time until the one that it fails at is found; that case fails, and the rest goes on.

mod running;

use super::answer::{self, Hello, Line, PROTOCOL, Unread, clipped};
use super::error::ProcessError;
use super::known::CaseState;
use super::ledger::Ledger;
use super::pack;
use super::plan::{CasePlace, GatePlan};
use super::problems::note;
use lightmeter_document::event::Stop;
use running::{Event, Running};
use serde_json::json;
use std::collections::{HashMap, VecDeque};
use std::path::Path;
use std::process::ChildStdin;
use std::sync::mpsc::RecvTimeoutError;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Cases that are asked at once, at first and at most: twice as many where they were answered in an eighth of what a case may take.
const BATCH: [usize; 2] = [16, 1024];
/// Lines that wait to be judged, and their bytes, at most.
const WAITING: (usize, usize) = (4096, 8 << 20);
/// Lines beyond one a case, in a batch, that end a process.
const SURPLUS: usize = 10_000;
/// How long a wait lasts before it is asked whether to stop.
const MOMENT: Duration = Duration::from_millis(100);
/// Failed starts in a row after which nothing more is asked.
const MOST_STARTS: usize = 3;
/// Crashes and hangs after which nothing more is asked.
const MOST_CRASHES: u64 = 100;
/// Cases of a formula that it may end or hang at before no more of that formula is asked.
const MOST_OF_FORMULA: usize = 3;

/// How long things may take.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// From the start to the hello.
    pub start: Duration,
    /// A case of a formula.
    pub case: Duration,
    /// A scene.
    pub scene: Duration,
    /// All together; `None` for as long as it takes.
    pub total: Option<Duration>,
}

impl Default for Limits {
    fn default() -> Self {
        let seconds = Duration::from_secs;
        Self { start: seconds(60), case: seconds(10), scene: seconds(60), total: None }
    }
}

/// What became of a process while it was asked.
enum Ended {
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
    const fn message(&self) -> &'static str {
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

/// What a gate over a process came to, besides the ledger.
#[derive(Clone, Debug, Default)]
pub struct Ending {
    /// Who answered.
    pub hello: Hello,
    /// How often it was started.
    pub starts: u64,
    /// What went wrong with the process, in words.
    pub incidents: Vec<String>,
    /// Crashes and hangs that are expected.
    pub expected_incidents: Vec<String>,
    /// Lines that it wrote after its hello.
    pub lines: u64,
    /// The signal that ended the gate before its time.
    pub signal: Option<i32>,
}

/// How a renderer is asked.
#[derive(Clone, Copy, Debug)]
pub struct Asking<'a> {
    /// What starts it, by `sh -c`.
    pub command: &'a str,
    /// Where it writes images.
    pub folder: &'a Path,
    /// How long things may take.
    pub limits: Limits,
    /// How often all is asked. Of one run, what failed is asked once more.
    pub runs: u64,
    /// Whether to stop, which a signal says.
    pub stop: &'a Stop,
}

/// Asks a renderer all that it declares, and again: an answer that changes is no answer.
///
/// # Errors
/// Where it cannot be started, or says nothing of itself.
pub fn ask(
    ledger: &mut Ledger<'_>,
    plan: &GatePlan,
    asking: Asking<'_>,
    progress: &mut impl FnMut(u64),
) -> Result<Ending, ProcessError> {
    let mut session = Session {
        plan,
        asking,
        deadline: asking.limits.total.map(|total| Instant::now() + total),
        running: None,
        outcome: Ending::default(),
        number: 0,
        size: BATCH[0],
        answered: 0,
        culprits: 0,
        culprits_of: HashMap::new(),
    };
    session.start()?;
    let hello = session.outcome.hello.clone();
    let asked = ledger.begin(&hello)?;
    let mut is_whole = session.all(ledger, asked.clone(), progress)?;
    for _ in 1..asking.runs {
        if is_whole {
            // What a process remembers must not matter.
            session.finish();
            session.culprits_of.clear();
            ledger.begin_again();
            is_whole = session.all(ledger, asked.clone(), progress)?;
            if is_whole {
                ledger.end_again(|formula| session.has_given_up(formula));
            }
        }
    }
    if is_whole && asking.runs == 1 {
        let again = ledger.failing();
        session.culprits_of.clear();
        ledger.begin_again();
        session.all(ledger, again, progress)?;
    }
    session.finish();
    session.outcome.signal = asking.stop.signal();
    Ok(session.outcome)
}

struct Session<'a> {
    plan: &'a GatePlan,
    asking: Asking<'a>,
    deadline: Option<Instant>,
    running: Option<Running>,
    outcome: Ending,
    number: u64,
    /// Cases that are asked at once.
    size: usize,
    /// Cases that the process has answered since it was started.
    answered: usize,
    /// Cases that it failed at.
    culprits: u64,
    /// How many of each formula, but for those that are expected.
    culprits_of: HashMap<usize, usize>,
}

/// What is still to be asked of a process.
struct Queue {
    open: VecDeque<CasePlace>,
    /// Cases that are asked alone, to find the one that it fails at.
    alone: usize,
    /// What was told of them, by its places among the incidents, as long as the culprit is not found.
    untold: Vec<usize>,
    /// Since when they are asked so, where it was said to take too long.
    since: Option<Instant>,
}

impl Queue {
    /// The cases that are asked next, `size` at once at most.
    fn next(&self, size: usize) -> Vec<CasePlace> {
        let is_case = |place: &&CasePlace| matches!(place, CasePlace::Case { .. });
        let is_one = self.alone > 0 || size == 1 || !self.open.front().is_some_and(|place| is_case(&place));
        let count = if is_one { 1 } else { self.open.iter().take(size).take_while(is_case).count() };
        self.open.iter().take(count).copied().collect()
    }
}

/// A batch that is asked.
struct Waiting {
    /// What is not answered, by its id.
    open: HashMap<String, CasePlace>,
    /// How long an answer may take.
    limit: Duration,
    /// Until when the next must come: answers must come all the time, and nothing else counts.
    until: Instant,
    /// Lines that wait to be judged, and their bytes.
    lines: Vec<(u64, Vec<u8>)>,
    bytes: usize,
    /// Lines that answer nothing.
    surplus: usize,
}

impl Waiting {
    /// Takes a line, and counts it where it is not blank.
    fn hear(&mut self, line: Vec<u8>, count: &mut u64) {
        if line.iter().all(u8::is_ascii_whitespace) {
            self.surplus += 1;
            return;
        }
        if answer::id(&line).is_some_and(|id| self.open.remove(id.as_ref()).is_some()) {
            self.until = Instant::now() + self.limit;
        } else {
            self.surplus += 1;
        }
        self.bytes += line.len();
        *count += 1;
        self.lines.push((*count, line));
    }
}

impl Session<'_> {
    fn is_stopped(&self) -> bool {
        self.asking.stop.is_set()
    }

    /// Ends the process once it has nothing more to do; where it ends otherwise than well, that is told.
    fn finish(&mut self) {
        if let Some(running) = self.running.take() {
            let stop = self.asking.stop;
            let wrong = running.finish(self.asking.limits.case, || stop.is_set());
            self.outcome.incidents.extend(wrong);
        }
    }

    /// Starts the process and hears its hello.
    fn start(&mut self) -> Result<(), ProcessError> {
        let failed = |message: String| ProcessError::Start { command: self.asking.command.to_owned(), message };
        let mut running = Running::start(self.asking.command).map_err(&failed)?;
        self.outcome.starts += 1;
        let greeting = json!({ "hello": PROTOCOL, "version": env!("CARGO_PKG_VERSION"), "folder": self.asking.folder });
        let written = running.send(format!("{greeting}\n"));
        let begun = Instant::now();
        let until = begun + self.asking.limits.start;
        let until = self.deadline.map_or(until, |deadline| until.min(deadline));
        loop {
            let left = until.saturating_duration_since(Instant::now());
            let event = running.events.recv_timeout(left.min(MOMENT));
            if matches!(event, Err(RecvTimeoutError::Timeout)) && left > MOMENT && !self.is_stopped() {
                continue;
            }
            let message = match event {
                Ok(Event::Line(line)) if line.iter().all(u8::is_ascii_whitespace) => continue,
                Ok(Event::Line(line)) => match answer::read(&line) {
                    Ok(Line::Hello(hello)) if self.outcome.starts > 1 && *hello != self.outcome.hello => {
                        "says another hello than when it was started first".into()
                    }
                    Ok(Line::Hello(hello)) => {
                        self.answered = 0;
                        self.outcome.hello = *hello;
                        running.input = written.and_then(|thread| thread.join().ok().flatten());
                        self.running = Some(running);
                        return Ok(());
                    }
                    Err(message) if answer::is_hello(&line) => message,
                    _ => {
                        let line = clipped(&String::from_utf8_lossy(&line));
                        format!(
                            "said `{line}` first; expected a hello such as {{\"hello\": \"{PROTOCOL}\", \"renderer\": …}}"
                        )
                    }
                },
                Ok(Event::TooLong) => "said a line without end first; expected its hello".into(),
                Ok(Event::End) | Err(RecvTimeoutError::Disconnected) => {
                    running.has_ended();
                    let how = running.kill();
                    return Err(failed(format!("ended before its hello: {how}")));
                }
                Err(RecvTimeoutError::Timeout) if self.is_stopped() => "was stopped before its hello".into(),
                Err(RecvTimeoutError::Timeout) => {
                    format!("said nothing for {:.1} s", until.saturating_duration_since(begun).as_secs_f64())
                }
            };
            let how = running.kill();
            return Err(failed(format!("{message} (killed: {how})")));
        }
    }

    /// Asks cases until each is answered or has failed; whether it came to the end.
    fn all(
        &mut self,
        ledger: &mut Ledger<'_>,
        asked: Vec<CasePlace>,
        progress: &mut impl FnMut(u64),
    ) -> Result<bool, ProcessError> {
        let mut queue = Queue { open: asked.into(), alone: 0, untold: vec![], since: None };
        while !queue.open.is_empty() {
            if self.running.is_none() && !self.starts_again(queue.open.len()) {
                return Ok(false);
            }
            let batch = queue.next(self.size);
            let (ended, rest) = self.batch(ledger, &batch)?;
            let done = batch.len() - rest.len();
            self.answered += done;
            progress(done as u64);
            queue.open.drain(..batch.len());
            queue.alone = queue.alone.saturating_sub(done);
            let left = queue.open.len() + rest.len();
            let goes_on = match ended {
                Ended::Answered => {
                    self.forgets_culprit(&mut queue);
                    true
                }
                Ended::OutOfTime | Ended::Stopped => self.breaks_off(ended.message(), left),
                Ended::Crashed | Ended::Hung | Ended::Flooded | Ended::Deaf => {
                    self.failed(ledger, &mut queue, &ended, rest, progress)
                }
            };
            if !goes_on {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Where all cases that were asked alone are answered, there is no culprit. Together they may take longer than one of them
    /// may: that is no hang.
    fn forgets_culprit(&mut self, queue: &mut Queue) {
        if queue.alone > 0 {
            return;
        }
        let limit = self.asking.limits.case;
        if queue.since.take().is_some_and(|since| since.elapsed() * 2 >= limit) {
            queue.untold.drain(..).rev().for_each(|place| drop(self.outcome.incidents.remove(place)));
        }
        queue.untold.clear();
    }

    /// Ends the process before all was asked, and tells what is left; nothing more is asked.
    fn breaks_off(&mut self, what: &str, left: usize) -> bool {
        self.end(what);
        self.outcome.incidents.push(format!("{what}: {left} cases were not asked or not answered"));
        false
    }

    /// Ends a process that failed with cases open, and finds out which of them it failed at; whether more is to be asked.
    fn failed(
        &mut self,
        ledger: &mut Ledger<'_>,
        queue: &mut Queue,
        ended: &Ended,
        rest: Vec<CasePlace>,
        progress: &mut impl FnMut(u64),
    ) -> bool {
        let message = ended.message();
        let how = self.end(message);
        let [culprit] = rest[..] else {
            // A retry hides nothing: that the process ended is reported, whatever it answers afterwards.
            let count = rest.len();
            queue.untold = vec![self.outcome.incidents.len()];
            queue.since = matches!(ended, Ended::Hung).then(Instant::now);
            let incident = format!("with {count} cases open {message}: {how}; they are asked one by one");
            self.outcome.incidents.push(incident);
            self.size = BATCH[0];
            queue.alone = count;
            rest.into_iter().rev().for_each(|place| queue.open.push_front(place));
            return true;
        };
        if matches!(ended, Ended::Crashed) && self.answered > 0 {
            // It may be an earlier case that it ended of: one that it is asked first is the culprit.
            queue.untold.push(self.outcome.incidents.len());
            let id = self.plan.id(culprit);
            self.outcome.incidents.push(format!("before it answered {id} {message}: {how}; it is asked again"));
            queue.alone = queue.alone.max(1);
            queue.open.push_front(culprit);
            return true;
        }
        // The case that ended the process is found: what was kept for its batch is reported of it alone.
        queue.alone = queue.alone.saturating_sub(1);
        queue.since = None;
        self.failed_at(ledger, culprit, &format!("{message}: {how}"), std::mem::take(&mut queue.untold));
        self.culprits += 1;
        progress(1);
        progress(self.gives_up(ledger, queue, culprit));
        if self.culprits < MOST_CRASHES {
            return true;
        }
        let left = queue.open.len();
        let what = format!("{MOST_CRASHES} crashes and hangs: nothing more is asked, {left} cases are left");
        self.outcome.incidents.push(what);
        false
    }

    /// After a few cases of a formula that it ended or hung at, asks no more of that formula; how many cases that leaves out.
    fn gives_up(&mut self, ledger: &Ledger<'_>, queue: &mut Queue, culprit: CasePlace) -> u64 {
        let CasePlace::Case { formula, .. } = culprit else { return 0 };
        if ledger.expects_crash(culprit) {
            return 0;
        }
        let culprits = self.culprits_of.entry(formula).or_default();
        *culprits += 1;
        if *culprits < MOST_OF_FORMULA {
            return 0;
        }
        let is_of = |place: &CasePlace| matches!(place, CasePlace::Case { formula: of, .. } if *of == formula);
        let before = queue.open.len();
        queue.alone -= queue.open.iter().take(queue.alone).filter(|place| is_of(place)).count();
        queue.open.retain(|place| !is_of(place));
        let left = (before - queue.open.len()) as u64;
        let id = &self.plan.member(formula).spec.id;
        let what = format!("{id}: no more of it is asked after {MOST_OF_FORMULA} such cases; {left} are left");
        self.outcome.incidents.push(what);
        left
    }

    /// Whether no more of a formula is asked in this run.
    fn has_given_up(&self, formula: usize) -> bool {
        self.culprits_of.get(&formula).is_some_and(|culprits| *culprits >= MOST_OF_FORMULA)
    }

    /// Starts the process once more, or tells that it will not.
    fn starts_again(&mut self, left: usize) -> bool {
        let mut started = self.start();
        for _ in 1..MOST_STARTS {
            if started.is_err() && !self.is_stopped() {
                started = self.start();
            }
        }
        let Err(error) = started else { return true };
        // It was there once, and is no more.
        self.outcome.incidents.push(format!("{error}; {left} cases are left"));
        false
    }

    /// Notes the case that the process failed at. What was told of its batch before, by places among the incidents, is of the same
    /// failure, and is not told besides.
    fn failed_at(&mut self, ledger: &mut Ledger<'_>, culprit: CasePlace, message: &str, before: Vec<usize>) {
        before.into_iter().rev().for_each(|place| drop(self.outcome.incidents.remove(place)));
        let told = format!("{}: {message}", self.plan.id(culprit));
        let incidents = if ledger.expects_crash(culprit) {
            &mut self.outcome.expected_incidents
        } else {
            &mut self.outcome.incidents
        };
        incidents.push(told);
        ledger.fail(culprit, CaseState::Broken, message);
    }

    fn end(&mut self, message: &str) -> String {
        self.running.take().map_or_else(
            || message.to_owned(),
            |mut running| {
                if message == "it ended" {
                    running.has_ended();
                }
                running.kill()
            },
        )
    }

    /// Asks cases at once; how that ended, and what is left unanswered.
    fn batch(&mut self, ledger: &mut Ledger<'_>, batch: &[CasePlace]) -> Result<(Ended, Vec<CasePlace>), ProcessError> {
        let text = self.requests(ledger, batch)?;
        let Some(mut running) = self.running.take() else { return Ok((Ended::Crashed, batch.to_vec())) };
        let writing = running.send(text);
        let limits = self.asking.limits;
        let limit = if matches!(batch[0], CasePlace::Scene(_)) { limits.scene } else { limits.case };
        let start = Instant::now();
        let mut waiting = Waiting {
            open: batch.iter().map(|&place| (self.plan.id(place), place)).collect(),
            limit,
            until: start + limit,
            lines: vec![],
            bytes: 0,
            surplus: 0,
        };
        let mut ended = self.listen(ledger, &running, &mut waiting);
        ledger.lines(&waiting.lines, self.asking.folder);
        if matches!(ended, Ended::Answered) {
            if !self.has_read(&mut running, writing, waiting.until) {
                ended = Ended::Deaf;
            }
            if start.elapsed() * 8 < limit {
                self.size = (2 * self.size).min(BATCH[1]);
            }
        }
        self.running = Some(running);
        let is_open = |place: &CasePlace| waiting.open.values().any(|open| open == place);
        Ok((ended, batch.iter().copied().filter(is_open).collect()))
    }

    /// What a batch is asked by, a line each, with its number behind them.
    fn requests(&mut self, ledger: &mut Ledger<'_>, batch: &[CasePlace]) -> Result<String, ProcessError> {
        let mut text = String::new();
        for &place in batch {
            text += &self.request(ledger, place)?;
            text.push('\n');
        }
        self.number += 1;
        Ok(text + &format!("{{\"batch\": {}}}\n", self.number))
    }

    /// Takes answers until all that is open is answered, or the process fails.
    fn listen(&mut self, ledger: &mut Ledger<'_>, running: &Running, waiting: &mut Waiting) -> Ended {
        loop {
            if waiting.open.is_empty() {
                return Ended::Answered;
            }
            if waiting.surplus > SURPLUS {
                return Ended::Flooded;
            }
            if waiting.lines.len() >= WAITING.0 || waiting.bytes >= WAITING.1 {
                ledger.lines(&waiting.lines, self.asking.folder);
                waiting.lines.clear();
                waiting.bytes = 0;
            }
            if self.is_stopped() {
                return Ended::Stopped;
            }
            let wait = self.over(waiting.until).saturating_duration_since(Instant::now());
            if wait.is_zero() {
                let is_over = self.deadline.is_some_and(|deadline| Instant::now() >= deadline);
                return if is_over { Ended::OutOfTime } else { Ended::Hung };
            }
            match running.events.recv_timeout(wait.min(MOMENT)) {
                Ok(Event::Line(line)) => waiting.hear(line, &mut self.outcome.lines),
                Ok(Event::TooLong) => {
                    waiting.surplus += 1;
                    self.outcome.lines += 1;
                    let number = self.outcome.lines;
                    note(&mut ledger.problems, "oversized", || format!("line {number}: {}", Unread::TooLong));
                }
                Ok(Event::End) | Err(RecvTimeoutError::Disconnected) => return Ended::Crashed,
                // The next turn tells which time is over.
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    /// A moment, or that at which time for all is over.
    fn over(&self, until: Instant) -> Instant {
        self.deadline.map_or(until, |deadline| until.min(deadline))
    }

    /// Whether the process reads all that it was asked, as one that answers does.
    fn has_read(
        &self,
        running: &mut Running,
        mut writing: Option<JoinHandle<Option<ChildStdin>>>,
        until: Instant,
    ) -> bool {
        let is_written =
            |thread: &Option<JoinHandle<Option<ChildStdin>>>| thread.as_ref().is_none_or(JoinHandle::is_finished);
        let over = self.over(until);
        while !is_written(&writing) && Instant::now() < over && !self.is_stopped() {
            std::thread::sleep(Duration::from_millis(1));
        }
        let has_read = is_written(&writing);
        if has_read {
            running.input = writing.take().and_then(|thread| thread.join().ok().flatten());
        }
        has_read
    }

    fn request(&self, ledger: &mut Ledger<'_>, place: CasePlace) -> Result<String, ProcessError> {
        Ok(match place {
            CasePlace::Case { formula, case } => pack::case(self.plan, formula, case).to_string(),
            CasePlace::Scene(scene) => {
                let (title, frame) = self.plan.frame(scene)?;
                let id = self.plan.id(place);
                let path = self.asking.folder.join(format!("{}.json", id.replace('/', "-")));
                let text = super::frame::to_json(&id, &title, &frame).to_string();
                let failed =
                    |error: std::io::Error| ProcessError::Folder { path: path.clone(), message: error.to_string() };
                std::fs::write(&path, text).map_err(failed)?;
                // By the same clock that an image gets its time from.
                let asked = path.metadata().and_then(|metadata| metadata.modified()).map_err(failed)?;
                ledger.asked.insert(scene, asked);
                let (width, height) = (frame.target.width, frame.target.height);
                let format = frame.target.format.name();
                json!({ "id": id, "scene": path, "width": width, "height": height, "format": format }).to_string()
            }
        })
    }
}
