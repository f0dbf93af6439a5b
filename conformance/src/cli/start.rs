//! `lightmeter start-renderer`: what `gate` starts a renderer by, so that nothing of it outlives the gate.

use super::Status;
use anyhow::Context as _;
use clap::Args;
use rustix::process::{Pid, Resource, Rlimit, Signal, getpid, getppid, kill_process, setrlimit};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use std::collections::BTreeMap;
use std::fs::OpenOptions;
use std::os::unix::process::ExitStatusExt as _;
use std::process::{Command, ExitStatus};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How often it looks whether the gate is still there.
const LOOKS: Duration = Duration::from_millis(10);
/// How often what was started is ended anew, until nothing is left.
const MOST_ROUNDS: usize = 50;

/// Start a renderer within limits, and end all that it started when it ends, or when the gate does
#[derive(Debug, Args)]
pub(crate) struct Start {
    /// The process that it is started for
    #[arg(long, value_name = "PID")]
    parent: i32,
    /// Address space that each of its processes may have
    #[arg(long, value_name = "MIB")]
    memory: Option<u64>,
    /// What is started, by `sh -c`
    command: String,
}

impl Start {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let parent = Pid::from_raw(self.parent);
        let stop = Arc::new(AtomicBool::new(false));
        for signal in [SIGTERM, SIGINT, SIGHUP] {
            signal_hook::flag::register(signal, stop.clone())?;
        }
        // What loses its parent becomes a child of this process, and is found so.
        #[cfg(target_os = "linux")]
        rustix::process::set_child_subreaper(Some(getpid()))?;
        // A thread is the parent that Linux tells the death of, and threads of the gate come and go: so the parent is looked at.
        std::thread::spawn(move || {
            while !stop.load(Ordering::Relaxed) && getppid() == parent {
                std::thread::sleep(LOOKS);
            }
            end_descendants();
            let _ = kill_process(getpid(), Signal::KILL);
        });
        let limit = |bytes: u64| Rlimit { current: Some(bytes), maximum: Some(bytes) };
        setrlimit(Resource::Core, limit(0))?;
        if let Some(memory) = self.memory {
            setrlimit(Resource::As, limit(memory << 20)).context("cannot limit the memory")?;
        }
        let mut child = Command::new("sh").args(["-c", &self.command]).spawn().context("cannot start a shell")?;
        // Its pipes are its own: whoever reads or writes them sees when it closes them.
        let nothing = OpenOptions::new().read(true).write(true).open("/dev/null")?;
        rustix::stdio::dup2_stdin(&nothing)?;
        rustix::stdio::dup2_stdout(&nothing)?;
        rustix::stdio::dup2_stderr(&nothing)?;
        let status = child.wait()?;
        end_descendants();
        end_like(status)
    }
}

/// Ends as a process has ended.
fn end_like(status: ExitStatus) -> ! {
    if let Some(signal) = status.signal().and_then(Signal::from_named_raw) {
        let _ = kill_process(getpid(), signal);
    }
    // Some signals are handled here.
    std::process::exit(status.code().unwrap_or_else(|| 128 + status.signal().unwrap_or_default()))
}

/// Kills all that descends from this process, until nothing of it runs. Where there is no /proc, nothing is found.
fn end_descendants() {
    for _ in 0..MOST_ROUNDS {
        let running = descendants();
        if running.is_empty() {
            return;
        }
        for pid in running {
            let _ = kill_process(pid, Signal::KILL);
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// What descends from this process and runs.
fn descendants() -> Vec<Pid> {
    let mut children: BTreeMap<i32, Vec<(i32, bool)>> = BTreeMap::new();
    for entry in std::fs::read_dir("/proc").into_iter().flatten().flatten() {
        let number = entry.file_name().to_str().and_then(|name| name.parse::<i32>().ok());
        let stat = number.and_then(|_| std::fs::read_to_string(entry.path().join("stat")).ok());
        // Behind the name, which may hold anything: the state, and the parent.
        let fields = stat.as_deref().and_then(|stat| stat.rsplit_once(") ")).map(|(_, fields)| fields);
        let mut fields = fields.unwrap_or_default().split(' ');
        let (state, parent) = (fields.next(), fields.next().and_then(|parent| parent.parse().ok()));
        if let (Some(number), Some(state), Some(parent)) = (number, state, parent) {
            children.entry(parent).or_default().push((number, !matches!(state, "Z" | "X")));
        }
    }
    let (mut found, mut open) = (vec![], vec![getpid().as_raw_nonzero().get()]);
    while let Some(parent) = open.pop() {
        for &(number, runs) in children.get(&parent).into_iter().flatten() {
            open.push(number);
            found.extend(Pid::from_raw(number).filter(|_| runs));
        }
    }
    found
}
