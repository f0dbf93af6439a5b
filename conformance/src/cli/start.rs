//! `lightmeter start-renderer`: what `gate` starts a renderer by, so that nothing of it outlives the gate.

use super::Status;
use super::environment;
use super::signals::ENDING;
use anyhow::Context as _;
use clap::Args;
use rustix::io::Errno;
use rustix::process::{
    Pid, Resource, Rlimit, Signal, WaitOptions, WaitStatus, getpid, getppid, kill_process, setrlimit, wait,
};
use signal_hook::low_level::emulate_default_handler;
use std::collections::BTreeMap;
use std::fs::OpenOptions;
use std::process::Command;
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
        for &signal in ENDING {
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
        setrlimit(Resource::Core, Rlimit { current: Some(0), maximum: Some(0) })?;
        // The shell limits itself, and so what it starts: this process needs more than a renderer may.
        let limit = self.memory.map(|memory| format!("ulimit -v {} || exit 2\n", memory << 10)).unwrap_or_default();
        let mut shell = Command::new("sh");
        let shell = environment::spare(shell.args(["-c", &(limit + &self.command)]));
        let child = shell.spawn().context("cannot start a shell")?;
        // Its pipes are its own: whoever reads or writes them sees when it closes them.
        let nothing = OpenOptions::new().read(true).write(true).open("/dev/null")?;
        rustix::stdio::dup2_stdin(&nothing)?;
        rustix::stdio::dup2_stdout(&nothing)?;
        rustix::stdio::dup2_stderr(&nothing)?;
        let status = ended(child.id())?;
        end_descendants();
        end_like(status)
    }
}

/// Waits for a child, and for all that lost its parent and ends before it; how the child ended.
fn ended(child: u32) -> anyhow::Result<WaitStatus> {
    loop {
        match wait(WaitOptions::empty()) {
            Ok(Some((pid, status))) if u32::try_from(pid.as_raw_nonzero().get()) == Ok(child) => return Ok(status),
            Ok(_) | Err(Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
    }
}

/// Ends as a process has ended: by the same signal, whatever handles it here.
fn end_like(status: WaitStatus) -> ! {
    if let Some(signal) = status.terminating_signal() {
        let _ = emulate_default_handler(signal);
        // A signal of real time has no default that can be had here.
        std::process::exit(128 + signal);
    }
    std::process::exit(status.exit_status().unwrap_or_default())
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
