//! A command that holds at one of its events, so that a test knows where it is when a signal reaches it.

use crate::command;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// After which a test fails that waits for an event in vain.
const LIMIT: Duration = Duration::from_secs(1200);

/// A command under way.
pub(crate) struct Held {
    child: Child,
    events: Receiver<Value>,
    /// What it says on standard error besides its events.
    complaint: JoinHandle<String>,
    output: JoinHandle<Vec<u8>>,
}

/// Starts a command that holds at an event of this name and number, such as `advanced:1`.
pub(crate) fn held(args: &[&str], event: &str) -> Held {
    Held::start(&mut command(args), event)
}

impl Held {
    /// Starts a command, and waits until it holds.
    pub(crate) fn start(command: &mut Command, event: &str) -> Self {
        let (name, number) = event.split_once(':').expect("an event has a number");
        let held = Self::unawaited(command, event);
        (0..number.parse().expect("a number")).for_each(|_| held.wait_for(name));
        held
    }

    /// Starts a command that will hold at an event.
    pub(crate) fn unawaited(command: &mut Command, event: &str) -> Self {
        Self::watch(command.env("LIGHTMETER_HOLD", format!("{event}@0")).stdin(Stdio::piped()))
    }

    /// Starts a command whose events can be waited for.
    pub(crate) fn watch(command: &mut Command) -> Self {
        command.env("LIGHTMETER_EVENTS", "2").stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the binary starts");
        let (mut out, err) = (child.stdout.take().expect("a pipe"), child.stderr.take().expect("a pipe"));
        let (send, events) = channel();
        let complaint = std::thread::spawn(move || {
            let mut said = String::new();
            for line in BufReader::new(err).lines() {
                let line = line.expect("messages are UTF-8");
                match serde_json::from_str(&line) {
                    Ok(event) if line.starts_with("{\"event\":") => drop(send.send(event)),
                    _ => said += &(line + "\n"),
                }
            }
            said
        });
        let output = std::thread::spawn(move || {
            let mut bytes = vec![];
            out.read_to_end(&mut bytes).expect("a pipe can be read");
            bytes
        });
        Self { child, events, complaint, output }
    }

    /// Waits for an event.
    pub(crate) fn wait_for(&self, name: &str) {
        while self.events.recv_timeout(LIMIT).unwrap_or_else(|error| panic!("no `{name}`: {error}"))["event"] != name {}
    }

    /// Sends a signal, and waits until it was heard.
    pub(crate) fn signal(&self, signal: Signal) {
        self.send(signal);
        self.wait_for("signal");
    }

    /// Sends a signal.
    pub(crate) fn send(&self, signal: Signal) {
        let pid = i32::try_from(self.child.id()).ok().and_then(Pid::from_raw).expect("a number");
        kill_process(pid, signal).expect("it runs");
    }

    /// Ends it at once.
    pub(crate) fn kill(mut self) {
        self.child.kill().expect("it can be killed");
        self.child.wait().expect("it was killed");
    }

    /// Lets it go on where it holds, and waits for its end.
    pub(crate) fn go_on(self) -> Output {
        self.ended().0
    }

    /// The same, with the names of the events that nobody waited for.
    pub(crate) fn ended(mut self) -> (Output, Vec<String>) {
        if let Some(mut bytes) = self.child.stdin.take() {
            // One that has ended does not hold any more.
            let _ = bytes.write_all(b"\n");
        }
        let status = self.child.wait().expect("it ends");
        let stdout = self.output.join().expect("it was read");
        let stderr = self.complaint.join().expect("it was read").into_bytes();
        let names = self.events.iter().filter_map(|event| event["event"].as_str().map(str::to_owned)).collect();
        (Output { status, stdout, stderr }, names)
    }
}

/// What a command leaves that gets a signal at an event.
pub(crate) fn stopped_at(event: &str, args: &[&str], signal: Signal) -> Output {
    let held = held(args, event);
    held.signal(signal);
    held.go_on()
}

/// A document without times and the command, which differ.
fn lasting(value: Value) -> Value {
    match value {
        Value::Object(fields) => {
            let is_lasting = |name: &str| {
                !name.contains("seconds") && !matches!(name, "made_at" | "command" | "timing" | "checksum")
            };
            let kept = fields.into_iter().filter(|(name, _)| is_lasting(name));
            Value::Object(kept.map(|(name, value)| (name, lasting(value))).collect())
        }
        Value::Array(values) => Value::Array(values.into_iter().map(lasting).collect()),
        other => other,
    }
}

#[test]
fn what_tests_wait_for_changes_no_result() {
    let exec = crate::gate::process::command_of("wrong-at=fog/exp/random/000003");
    let rows: [(&[&str], &str); 4] = [
        (&["run", "fog/exp", "--adapter", "cpu", "--cases", "64"], "advanced:1"),
        (&["gate", "fog/exp", "--exec", &exec, "--cases", "64"], "judged:1"),
        (&["sweep", "fog/exp", "--adapter", "cpu", "--from", "1", "--to", "1.5"], "block:2"),
        (&["selftest", "fog/exp", "--only", "formulas"], "tried:1"),
    ];
    for (args, event) in rows {
        let args = [args, &["--format", "json"]].concat();
        let read = |output: &Output| lasting(serde_json::from_slice(&output.stdout).expect("JSON and nothing else"));
        let mut plain = command(&args);
        let plain = plain.env_remove("LIGHTMETER_CLOCK").output().expect("the binary starts");
        let held = held(&args, event).go_on();
        assert_eq!((plain.status.code(), read(&plain)), (held.status.code(), read(&held)), "{args:?}");
        assert_eq!(crate::stderr(&plain), crate::stderr(&held), "{args:?}");
    }
    for name in ["--help", "-h"] {
        assert!(!crate::stdout(&crate::lightmeter(&["gate", name])).contains("LIGHTMETER_"));
    }
}
