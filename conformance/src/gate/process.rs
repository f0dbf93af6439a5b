//! A renderer in a process of its own, which speaks JSON lines on its standard input and output.
//!
//! It is started in a process group of its own, so that it ends with its children. What it was asked and has not answered is
//! known at every moment: where it ends, hangs or floods, it is killed and started again, and asked what is open one case at a
//! time until the one that it fails at is found; that case fails, and the rest goes on.

use super::answer::{self, Hello, Line, PROTOCOL, Unread};
use super::ledger::Ledger;
use super::pack;
use super::plan::{Place, Plan};
use rustix::process::{Pid, Signal, kill_process_group};
use serde_json::json;
use std::collections::{HashMap, VecDeque};
use std::io::{BufReader, Read as _, Write as _};
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Cases that are asked at once, at first and at most: twice as many where they were answered in an eighth of what a case may take.
const BATCH: [usize; 2] = [16, 1024];
/// Lines that wait to be judged, and their bytes, at most.
const WAITING: (usize, usize) = (4096, 8 << 20);
/// Lines of a process that wait to be read.
const UNREAD: usize = 64;
/// Lines beyond one a case, in a batch, that end a process.
const SURPLUS: usize = 10_000;
/// Bytes of standard error that are kept.
const KEPT: usize = 4096;
/// Failed starts in a row after which nothing more is asked.
const MOST_STARTS: usize = 3;
/// Crashes and hangs after which nothing more is asked.
const MOST_CRASHES: u64 = 100;

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

/// Why a renderer could not be asked at all.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The command cannot be started, or says nothing that can be read.
    #[error("`{command}` {message}")]
    Start {
        /// The command.
        command: String,
        /// What it does in the place of its hello.
        message: String,
    },
    /// What it declares cannot be read.
    #[error("the renderer's hello: {0}")]
    Hello(#[from] crate::filter::FilterError),
    /// It asks for accuracy rules that are unknown.
    #[error("the renderer's hello: no profile `{0}`; expected {profiles}", profiles = crate::arithmetic::profile::PROFILES.map(|profile| profile.name).join(", "))]
    Profile(String),
    /// A scene is refused, which a test rules out.
    #[error("{0}")]
    Scene(#[from] crate::scene::Error),
    /// A pack's or a scene's file cannot be written.
    #[error("{0}")]
    Pack(#[from] pack::Error),
    /// A folder for images cannot be made.
    #[error("cannot write {}: {message}", .path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why.
        message: String,
    },
}

/// What comes from a process.
enum Event {
    Line(Vec<u8>),
    TooLong,
    End,
}

/// A running renderer.
struct Running {
    child: Child,
    group: Option<Pid>,
    input: Option<ChildStdin>,
    events: Receiver<Event>,
    complaint: Arc<Mutex<Vec<u8>>>,
    /// Reads what it complains of, until its end.
    listening: Option<std::thread::JoinHandle<()>>,
}

impl Running {
    fn start(command: &str) -> Result<Self, String> {
        let mut child = Command::new("sh")
            .args(["-c", command])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .process_group(0)
            .spawn()
            .map_err(|error| format!("cannot be started: {error}"))?;
        let group = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
        let (input, output, errors) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        // What is not taken waits in the pipe, so that memory stays flat.
        let (send, events) = sync_channel(UNREAD);
        if let Some(output) = output {
            std::thread::spawn(move || listen(output, &send));
        }
        let complaint = Arc::new(Mutex::new(vec![]));
        let listening = errors.map(|mut errors| {
            let kept = complaint.clone();
            std::thread::spawn(move || {
                let mut part = [0; 1024];
                while let Ok(count @ 1..) = errors.read(&mut part) {
                    if let Ok(mut kept) = kept.lock() {
                        kept.extend_from_slice(&part[..count]);
                        let excess = kept.len().saturating_sub(KEPT);
                        kept.drain(..excess);
                    }
                }
            })
        });
        Ok(Self { child, group, input, events, complaint, listening })
    }

    /// Writes lines in a thread of its own, since a renderer may answer before it has read all.
    fn send(&mut self, text: String) -> Option<std::thread::JoinHandle<Option<ChildStdin>>> {
        let mut input = self.input.take()?;
        Some(std::thread::spawn(move || {
            let written = input.write_all(text.as_bytes()).and_then(|()| input.flush());
            written.is_ok().then_some(input)
        }))
    }

    /// Ends it with its children; how it ended, in words.
    fn kill(mut self) -> String {
        drop(self.input.take());
        if let Some(group) = self.group {
            let _ = kill_process_group(group, Signal::KILL);
        }
        let _ = self.child.kill();
        let status = self.child.wait();
        // A child that left the group may hold the pipe open: it is not waited for.
        let until = Instant::now() + Duration::from_millis(200);
        while self.listening.as_ref().is_some_and(|thread| !thread.is_finished()) && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(2));
        }
        let said =
            self.complaint.lock().map(|said| String::from_utf8_lossy(&said).trim().to_owned()).unwrap_or_default();
        let status = status.map_or_else(|error| error.to_string(), |status| status.to_string());
        let last: Vec<&str> = said.lines().rev().take(4).collect();
        let last: Vec<&str> = last.into_iter().rev().collect();
        if last.is_empty() { status } else { format!("{status}; it said: {}", last.join(" / ")) }
    }

    /// How it ended by itself, where it has.
    fn has_ended(&mut self) -> bool {
        // Its output may close a little before it ends.
        for _ in 0..50 {
            if matches!(self.child.try_wait(), Ok(Some(_))) {
                return true;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        false
    }
}

fn listen(output: impl std::io::Read, send: &SyncSender<Event>) {
    let mut stream = BufReader::with_capacity(1 << 16, output);
    let mut line = vec![];
    loop {
        let event = match answer::next(&mut stream, &mut line) {
            Ok(true) => Event::Line(std::mem::take(&mut line)),
            Err(Unread::TooLong) => Event::TooLong,
            Ok(false) | Err(Unread::Io(_)) => {
                let _ = send.send(Event::End);
                return;
            }
        };
        if send.send(event).is_err() {
            return;
        }
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
}

/// What a gate over a process came to, besides the ledger.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Who answered.
    pub hello: Hello,
    /// How often it was started.
    pub starts: u64,
    /// What went wrong with the process, in words.
    pub incidents: Vec<String>,
    /// Cases that were never asked, since it was given up.
    pub given_up: u64,
    /// Lines that it wrote after its hello.
    pub lines: u64,
}

/// Asks a renderer all that it declares, and what failed once more at the end.
///
/// # Errors
/// Where it cannot be started, or says nothing of itself.
pub fn ask(
    ledger: &mut Ledger<'_>,
    plan: &Plan,
    command: &str,
    folder: &Path,
    limits: Limits,
    progress: &mut impl FnMut(u64),
) -> Result<Outcome, Error> {
    let mut session = Session {
        plan,
        command,
        folder,
        limits,
        deadline: limits.total.map(|total| Instant::now() + total),
        running: None,
        outcome: Outcome::default(),
        number: 0,
        size: BATCH[0],
    };
    session.start()?;
    let hello = session.outcome.hello.clone();
    let asked = ledger.begin(&hello)?;
    let out_of_time = session.all(ledger, asked, false, progress)?;
    // What failed must fail again: an answer that changes is no answer.
    if !out_of_time {
        let again = ledger.failing();
        session.all(ledger, again, true, progress)?;
    }
    if let Some(mut running) = session.running.take() {
        drop(running.input.take());
        running.has_ended();
        running.kill();
    }
    Ok(session.outcome)
}

struct Session<'a> {
    plan: &'a Plan,
    command: &'a str,
    folder: &'a Path,
    limits: Limits,
    deadline: Option<Instant>,
    running: Option<Running>,
    outcome: Outcome,
    number: u64,
    /// Cases that are asked at once.
    size: usize,
}

impl Session<'_> {
    /// Starts the process and hears its hello.
    fn start(&mut self) -> Result<(), Error> {
        let failed = |message: String| Error::Start { command: self.command.to_owned(), message };
        let mut running = Running::start(self.command).map_err(&failed)?;
        self.outcome.starts += 1;
        let greeting = json!({ "hello": PROTOCOL, "version": env!("CARGO_PKG_VERSION"), "folder": self.folder });
        let written = running.send(format!("{greeting}\n"));
        let until = Instant::now() + self.limits.start;
        let until = self.deadline.map_or(until, |deadline| until.min(deadline));
        loop {
            let event = running.events.recv_timeout(until.saturating_duration_since(Instant::now()));
            let message = match event {
                Ok(Event::Line(line)) if line.iter().all(u8::is_ascii_whitespace) => continue,
                Ok(Event::Line(line)) => match answer::read(&line) {
                    Ok(Line::Hello(hello)) => {
                        self.outcome.hello = *hello;
                        running.input = written.and_then(|thread| thread.join().ok().flatten());
                        self.running = Some(running);
                        return Ok(());
                    }
                    _ => {
                        let line = String::from_utf8_lossy(&line).chars().take(120).collect::<String>();
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
                Err(RecvTimeoutError::Timeout) => format!("said nothing for {} s", self.limits.start.as_secs()),
            };
            let how = running.kill();
            return Err(failed(format!("{message} (killed: {how})")));
        }
    }

    /// Asks cases until each is answered or has failed; whether time ran out.
    fn all(
        &mut self,
        ledger: &mut Ledger<'_>,
        asked: Vec<Place>,
        again: bool,
        progress: &mut impl FnMut(u64),
    ) -> Result<bool, Error> {
        let mut open: VecDeque<Place> = asked.into();
        // Cases that are asked alone, to find the one that it fails at.
        let mut alone = 0;
        while !open.is_empty() {
            if self.running.is_none() {
                let mut started = self.start();
                for _ in 1..MOST_STARTS {
                    if started.is_err() {
                        started = self.start();
                    }
                }
                if let Err(error) = started {
                    // It was there once, and is no more.
                    self.outcome.incidents.push(error.to_string());
                    self.outcome.given_up += open.len() as u64;
                    return Ok(true);
                }
            }
            let count = if alone > 0 || matches!(open[0], Place::Scene(_)) { 1 } else { self.size };
            let is_case = |place: &&Place| matches!(place, Place::Case { .. });
            let count = if count == 1 { 1 } else { open.iter().take(count).take_while(is_case).count() };
            let batch: Vec<Place> = open.iter().take(count).copied().collect();
            let (ended, rest) = self.batch(ledger, &batch, again)?;
            let done = batch.len() - rest.len();
            progress(done as u64);
            open.drain(..batch.len());
            alone = if alone > 0 { alone - done.min(alone) } else { 0 };
            let message = match ended {
                Ended::Answered => continue,
                Ended::OutOfTime => {
                    self.end("time for all is over");
                    self.outcome.given_up += (open.len() + rest.len()) as u64;
                    self.outcome.incidents.push("time for all is over".into());
                    return Ok(true);
                }
                Ended::Crashed => "it ended",
                Ended::Hung => "it took longer than a case may",
                Ended::Flooded => "it wrote many lines that answer nothing",
                Ended::Deaf => "it answered, and did not read what it was asked",
            };
            let how = self.end(message);
            if let [culprit] = rest[..] {
                let id = self.plan.id(culprit);
                self.outcome.incidents.push(format!("{id}: {message}: {how}"));
                if again {
                    ledger.unstable.push(id);
                } else {
                    ledger.fail(culprit, format!("{message}: {how}"));
                }
                progress(1);
                if self.outcome.incidents.len() as u64 >= MOST_CRASHES {
                    self.outcome.incidents.push(format!("{MOST_CRASHES} crashes and hangs: nothing more is asked"));
                    self.outcome.given_up += open.len() as u64;
                    return Ok(true);
                }
            } else {
                // Nothing is retried into green: that it ended is told, whatever it answers afterwards.
                let count = rest.len();
                self.outcome
                    .incidents
                    .push(format!("with {count} cases open {message}: {how}; they are asked one by one"));
                self.size = BATCH[0];
                alone = count;
                rest.into_iter().rev().for_each(|place| open.push_front(place));
            }
        }
        Ok(false)
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
    fn batch(&mut self, ledger: &mut Ledger<'_>, batch: &[Place], again: bool) -> Result<(Ended, Vec<Place>), Error> {
        let mut text = String::new();
        for &place in batch {
            text += &self.request(place)?;
            text.push('\n');
        }
        self.number += 1;
        text += &format!("{{\"batch\": {}}}\n", self.number);
        let Some(running) = &mut self.running else { return Ok((Ended::Crashed, batch.to_vec())) };
        let mut writing = running.send(text);
        let limit = if matches!(batch[0], Place::Scene(_)) { self.limits.scene } else { self.limits.case };
        let mut open: HashMap<String, Place> = batch.iter().map(|&place| (self.plan.id(place), place)).collect();
        let (mut lines, mut bytes, mut surplus) = (vec![], 0, 0);
        let start = Instant::now();
        // Answers must come all the time, and nothing else counts.
        let mut until = start + limit;
        let ended = loop {
            if open.is_empty() {
                break Ended::Answered;
            }
            if surplus > SURPLUS {
                break Ended::Flooded;
            }
            if lines.len() >= WAITING.0 || bytes >= WAITING.1 {
                ledger.lines(&lines, self.folder, again);
                lines.clear();
                bytes = 0;
            }
            let over = self.deadline.map_or(until, |deadline| until.min(deadline));
            let wait = over.saturating_duration_since(Instant::now());
            if wait.is_zero() {
                let is_over = self.deadline.is_some_and(|deadline| Instant::now() >= deadline);
                break if is_over { Ended::OutOfTime } else { Ended::Hung };
            }
            match running.events.recv_timeout(wait) {
                Ok(Event::Line(line)) => {
                    if line.iter().all(u8::is_ascii_whitespace) {
                        surplus += 1;
                        continue;
                    }
                    if answer::id(&line).is_some_and(|id| open.remove(id.as_ref()).is_some()) {
                        until = Instant::now() + limit;
                    } else {
                        surplus += 1;
                    }
                    bytes += line.len();
                    self.outcome.lines += 1;
                    lines.push((self.outcome.lines, line));
                }
                Ok(Event::TooLong) => {
                    surplus += 1;
                    self.outcome.lines += 1;
                    let number = self.outcome.lines;
                    ledger.problems.add("oversized", || format!("line {number}: {}", Unread::TooLong));
                }
                Ok(Event::End) | Err(RecvTimeoutError::Disconnected) => break Ended::Crashed,
                // The next turn tells which time is over.
                Err(RecvTimeoutError::Timeout) => {}
            }
        };
        ledger.lines(&lines, self.folder, again);
        let mut ended = ended;
        if matches!(ended, Ended::Answered) {
            let is_written =
                |thread: &Option<std::thread::JoinHandle<_>>| thread.as_ref().is_none_or(|one| one.is_finished());
            let over = self.deadline.map_or(until, |deadline| until.min(deadline));
            while !is_written(&writing) && Instant::now() < over {
                std::thread::sleep(Duration::from_millis(1));
            }
            if is_written(&writing) {
                running.input = writing.take().and_then(|thread| thread.join().ok().flatten());
            } else {
                ended = Ended::Deaf;
            }
            if start.elapsed() * 8 < limit {
                self.size = (2 * self.size).min(BATCH[1]);
            }
        }
        let left = batch.iter().copied().filter(|place| open.values().any(|open| open == place)).collect();
        Ok((ended, left))
    }

    fn request(&self, place: Place) -> Result<String, Error> {
        Ok(match place {
            Place::Case { formula, case } => pack::case(self.plan, formula, case).to_string(),
            Place::Scene(scene) => {
                let (title, frame) = self.plan.frame(scene)?;
                let id = self.plan.id(place);
                let path = self.folder.join(format!("{}.json", id.replace('/', "-")));
                let text = super::frame::to_json(&id, &title, &frame).to_string();
                std::fs::write(&path, text)
                    .map_err(|error| Error::Folder { path: path.clone(), message: error.to_string() })?;
                let (width, height) = (frame.target.width, frame.target.height);
                let format = frame.target.format.name();
                json!({ "id": id, "scene": path, "width": width, "height": height, "format": format }).to_string()
            }
        })
    }
}
