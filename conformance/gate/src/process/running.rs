//! A running renderer: its pipes, and its end with all that it started.

use super::super::answer::{self, Unread};
use super::super::words::clipped;
use super::clock::{Clock, Unmarked};
use super::framing::{Framing, columns_of};
use super::{Starter, family};
use lightmeter_document::protocol::ColumnsAnswer;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::ffi::OsStr;
use std::io::{BufReader, Read as _, Write as _};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Lines of a process that wait to be read.
const UNREAD: usize = 64;
/// The most events that are taken ahead of those who wait for them.
const MOST_AHEAD: usize = 1 << 14;
/// Bytes of standard error that are kept.
const KEPT: usize = 4096;
/// How long a starter may take to end all that it started.
const MOST_OF_END: Duration = Duration::from_secs(2);

/// What comes from a process.
pub(super) enum Event {
    Line(Vec<u8>),
    /// An answer in columns, and the bytes behind its line.
    Columns(ColumnsAnswer, Vec<u8>),
    TooLong,
    /// So much time has passed, as a renderer of a test says.
    Passed(Duration),
    End,
}

/// How a renderer ended that had nothing more to do.
pub(super) struct End {
    /// What is wrong with it, in words.
    pub(super) wrong: Option<String>,
    /// Bytes that it wrote behind its last answer.
    pub(super) unread: usize,
}

/// A running renderer.
pub(super) struct Running {
    child: Child,
    /// Whether the child ends all that descends from it when it is told to end.
    ends_all: bool,
    /// Its standard input, but while something is written to it.
    input: Option<ChildStdin>,
    /// Who writes to its input, which is not closed before it is killed or finished: one that reads the end of it may end, and what it did not
    /// write whole could no longer be told from what it wrote.
    writing: Option<JoinHandle<Option<ChildStdin>>>,
    /// Which arrays may stand behind a line that it writes, and how much of one has come.
    pub(super) framing: Arc<Framing>,
    /// What it writes.
    events: Receiver<Event>,
    /// What was taken from `events` and comes before them.
    ahead: RefCell<VecDeque<Event>>,
    /// A word in its environment, which its descendants inherit.
    mark: String,
    complaint: Arc<Mutex<Vec<u8>>>,
    /// Reads what it complains of, until its end.
    listening: Option<JoinHandle<()>>,
}

impl Running {
    pub(super) fn start(command: &str, starter: Option<&Starter>, clock: &Clock) -> Result<Self, String> {
        static STARTED: AtomicU64 = AtomicU64::new(0);
        let mark = format!("{}-{}", std::process::id(), STARTED.fetch_add(1, Ordering::Relaxed));
        let (program, arguments) = match starter {
            Some(starter) => (starter.program.as_os_str(), starter.arguments(command)),
            None => {
                let (shell, arguments) = family::shell(command);
                (OsStr::new(shell), arguments)
            }
        };
        let mut child = family::lead(&mut Command::new(program), &mark)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| format!("cannot be started: {error}"))?;
        let (input, output, errors) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        // What is not taken waits in the pipe, so that memory stays flat.
        let (send, events) = sync_channel(UNREAD);
        let framing = Arc::new(Framing::default());
        if let Some(output) = output {
            let (framing, is_told) = (Arc::clone(&framing), clock.is_told());
            std::thread::spawn(move || {
                if is_told {
                    // Where nobody hears it any more, the lines behind it end the thread.
                    let passes = |time| drop(send.send(Event::Passed(time)));
                    listen(Unmarked::new(output, passes), &send, &framing);
                } else {
                    listen(output, &send, &framing);
                }
            });
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
        let ends_all = starter.is_some();
        let ahead = RefCell::default();
        Ok(Self { child, ends_all, input, writing: None, framing, events, ahead, mark, complaint, listening })
    }

    /// What it writes next, waited for so long.
    pub(super) fn next(&self, wait: Duration) -> Result<Event, RecvTimeoutError> {
        match self.ahead.borrow_mut().pop_front() {
            Some(event) => Ok(event),
            None => self.events.recv_timeout(wait),
        }
    }

    /// Takes what it writes next ahead of those who wait for it, to hear the time that it tells.
    pub(super) fn hear_ahead(&self, clock: &Clock, wait: Duration) {
        let mut ahead = self.ahead.borrow_mut();
        if !clock.is_told() || ahead.len() >= MOST_AHEAD {
            std::thread::sleep(wait);
            return;
        }
        match self.events.recv_timeout(wait) {
            Ok(Event::Passed(time)) => clock.pass(time),
            Ok(event) => ahead.push_back(event),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => std::thread::sleep(wait),
        }
    }

    /// That no whole line came for some seconds, in words.
    pub(super) fn said_no_line_for(&self, seconds: f64) -> String {
        self.framing.open_line().map_or_else(
            || format!("said nothing for {seconds:.1} s"),
            |line| format!("said no whole line for {seconds:.1} s: {line}"),
        )
    }

    /// Writes lines in a thread of its own, since a renderer may answer before it has read all.
    pub(super) fn send(&mut self, text: Vec<u8>) {
        let Some(mut input) = self.input.take() else { return };
        self.writing = Some(std::thread::spawn(move || {
            let written = input.write_all(&text).and_then(|()| input.flush());
            written.is_ok().then_some(input)
        }));
    }

    /// Whether it has read all that was sent, so that more can be.
    pub(super) fn has_read(&mut self) -> bool {
        let is_written = self.writing.as_ref().is_none_or(JoinHandle::is_finished);
        if is_written && let Some(writing) = self.writing.take() {
            self.input = writing.join().ok().flatten();
        }
        is_written
    }

    fn close_input(&mut self) {
        drop((self.input.take(), self.writing.take()));
    }

    /// Ends it with its children; how it ended, in words.
    pub(super) fn kill(mut self) -> String {
        self.close_input();
        if self.ends_all {
            family::terminate(&self.child);
            self.ends_within(MOST_OF_END);
        }
        let status = family::kill(&mut self.child, &self.mark);
        // What left the group and cleared its environment may hold the pipe open: it is not waited for.
        let until = Instant::now() + Duration::from_millis(200);
        while self.listening.as_ref().is_some_and(|thread| !thread.is_finished()) && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(2));
        }
        let said =
            self.complaint.lock().map(|said| String::from_utf8_lossy(&said).trim().to_owned()).unwrap_or_default();
        let status = status.map_or_else(|error| error.to_string(), |status| status.to_string());
        let last: Vec<&str> = said.lines().rev().take(4).collect();
        let last: Vec<&str> = last.into_iter().rev().collect();
        if last.is_empty() { status } else { format!("{status}; it said: {}", clipped(&last.join(" / "))) }
    }

    /// Closes its input and waits until it ends.
    pub(super) fn finish(mut self, limit: Duration, clock: &Clock, is_stopped: impl Fn() -> bool) -> End {
        self.close_input();
        let (until, mut unread) = (clock.now() + limit, 0);
        let status = loop {
            match self.child.try_wait() {
                Ok(Some(status)) => break Some(status),
                Ok(None) if clock.now() < until && !is_stopped() => {}
                _ => break None,
            }
            unread += self.unread(clock, Instant::now() + Duration::from_millis(2));
        };
        if status.is_some() {
            unread += self.unread(clock, Instant::now() + Duration::from_millis(50));
        }
        let how = self.kill();
        let wrong = match status {
            None if is_stopped() => None,
            None => Some(format!("it did not end within {} s of its input's end", limit.as_secs_f64())),
            Some(status) if status.success() => None,
            Some(_) => Some(format!("all was answered, and it ended with {how}")),
        };
        End { wrong, unread }
    }

    /// Bytes of what it writes until then and nobody waits for, but for blank lines.
    fn unread(&self, clock: &Clock, until: Instant) -> usize {
        let mut bytes = 0;
        // One that writes without end is heard no longer.
        while let Some(left) = until.checked_duration_since(Instant::now()) {
            let event = match self.next(left) {
                Ok(event) => event,
                Err(RecvTimeoutError::Timeout) => return bytes,
                // Its output is closed, and it may still run.
                Err(RecvTimeoutError::Disconnected) => {
                    std::thread::sleep(left);
                    return bytes;
                }
            };
            bytes += match event {
                Event::Line(line) if line.iter().all(u8::is_ascii_whitespace) => 0,
                Event::Line(line) => line.len(),
                Event::Columns(_, array) => array.len(),
                Event::TooLong => answer::MOST_BYTES,
                Event::Passed(time) => {
                    clock.pass(time);
                    return bytes;
                }
                Event::End => return bytes,
            };
        }
        bytes
    }

    /// Whether it has ended by itself.
    pub(super) fn has_ended(&mut self) -> bool {
        // Its output may close a little before it ends.
        self.ends_within(Duration::from_millis(250))
    }

    fn ends_within(&mut self, limit: Duration) -> bool {
        let until = Instant::now() + limit;
        while Instant::now() < until {
            if matches!(self.child.try_wait(), Ok(Some(_))) {
                return true;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        false
    }
}

/// Hears what it writes, a line at a time, and the array behind one that has some.
fn listen(output: impl std::io::Read, send: &SyncSender<Event>, framing: &Framing) {
    let mut stream = BufReader::with_capacity(1 << 16, output);
    let mut line = vec![];
    loop {
        let read = answer::next_told(&mut stream, &mut line, |so_far, bytes| framing.has_come(so_far, bytes));
        framing.has_come(&[], 0);
        let event = match read {
            Ok(true) => match columns_of(&line).and_then(|answer| Some((framing.length(&answer)?, answer))) {
                Some((count, answer)) => {
                    framing.array(&mut stream, count).map_or(Event::End, |bytes| Event::Columns(answer, bytes))
                }
                None => Event::Line(std::mem::take(&mut line)),
            },
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
