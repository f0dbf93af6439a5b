//! Shaders of others are read in a process of their own: what reads them may overflow its stack, or take any time and memory.
//!
//! The process is given the files one after the other, and answers each with a line of JSON. Where it ends or takes too long, that file is told so,
//! and another process goes on with the next.

use super::super::observed::is_time_told;
use super::super::progress::Bar;
use super::super::{Status, foreign::limit_time};
use super::Read;
use super::judged::Judge;
use anyhow::Context as _;
use clap::Args;
use lightmeter::document::report::ShaderReview;
use lightmeter::nearest::did_you_mean;
use lightmeter_shaders::read::{ReadOptions, ShaderError};
use lightmeter_shaders::{Reviewer, accepted};
#[cfg(unix)]
use rustix::process::{Resource, Rlimit, setrlimit};
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// How long a file may take.
const MOST_TIME: Duration = Duration::from_secs(20);
/// Bytes of memory that reading may take.
const MOST_MEMORY: u64 = 2 << 30;
/// Bytes of the stack that reading may take.
const MOST_STACK: usize = 64 << 20;

/// Review the shaders that standard input names
#[derive(Debug, Args)]
pub(crate) struct Worker {
    #[command(flatten)]
    read: Read,
}

impl Worker {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        limit_time();
        #[cfg(unix)]
        let _ = setrlimit(Resource::As, Rlimit { current: Some(MOST_MEMORY), maximum: Some(MOST_MEMORY) });
        // What a panic says is no part of the answer.
        std::panic::set_hook(Box::new(|_| {}));
        let options = ReadOptions { include: self.read.include, defines: self.read.define };
        let accept = self.read.accept;
        let answer = move || -> anyhow::Result<()> {
            let reviewer = Reviewer::new().map_err(anyhow::Error::msg)?;
            for line in std::io::stdin().lock().lines() {
                let file: PathBuf = serde_json::from_str(&line?)?;
                let review = reviewed(&reviewer, &file, &options, &accept);
                writeln!(std::io::stdout(), "{}", serde_json::to_string(&review)?)?;
            }
            Ok(())
        };
        let thread = std::thread::Builder::new().stack_size(MOST_STACK).spawn(answer)?;
        thread.join().map_err(|_| anyhow::anyhow!("it panicked"))??;
        Ok(Status::Success)
    }
}

fn reviewed(reviewer: &Reviewer, file: &Path, options: &ReadOptions, accept: &[String]) -> ShaderReview {
    let known = accepted::names();
    let near = |name: &str| did_you_mean(name, known.iter().map(String::as_str));
    let review = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        let mut review = reviewer.review(file, options)?;
        let text = std::fs::read(file).unwrap_or_default();
        accepted::accept(&mut review, &String::from_utf8_lossy(&text), accept, &near);
        Ok::<_, ShaderError>(review)
    }));
    match review {
        Ok(Ok(review)) => review,
        Ok(Err(error)) => unread(file, &error.to_string()),
        Err(_) => unread(file, "what reads it ended: this is a mistake of lightmeter's"),
    }
}

fn unread(file: &Path, why: &str) -> ShaderReview {
    let name = file.to_string_lossy();
    // The file is named before it.
    let why = why.strip_prefix(&*name).map_or(why, |rest| rest.trim_start_matches([':', ' ']));
    ShaderReview { file: name.into_owned(), unread: Some(why.to_owned()), ..ShaderReview::default() }
}

/// A process that reviews.
struct Process {
    child: Child,
    stdin: ChildStdin,
    answers: Receiver<String>,
}

impl Process {
    fn start(read: &Read) -> anyhow::Result<Self> {
        let program = std::env::current_exe().context("cannot find the own binary")?;
        let mut command = Command::new(program);
        command.arg("review-shaders");
        read.include.iter().for_each(|folder| {
            command.arg("-I").arg(folder);
        });
        read.define.iter().for_each(|(name, value)| {
            command.arg("-D").arg(format!("{name}={value}"));
        });
        read.accept.iter().for_each(|name| {
            command.arg("--accept").arg(name);
        });
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("cannot start a process to read the shaders in")?;
        let stdin = child.stdin.take().context("it has no standard input")?;
        let stdout = child.stdout.take().context("it has no standard output")?;
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        Ok(Self { child, stdin, answers })
    }

    fn review(&mut self, file: &Path) -> Result<ShaderReview, String> {
        let name = serde_json::to_string(file).map_err(|_| "its name is no Unicode".to_owned())?;
        let asked = writeln!(self.stdin, "{name}").and_then(|()| self.stdin.flush());
        asked.map_err(|error| error.to_string())?;
        let most = if is_time_told() { Duration::MAX } else { MOST_TIME };
        match self.answers.recv_timeout(most) {
            Ok(line) => serde_json::from_str(&line).map_err(|error| error.to_string()),
            Err(RecvTimeoutError::Timeout) => Err(format!("it takes more than {} s to be read", MOST_TIME.as_secs())),
            Err(RecvTimeoutError::Disconnected) => Err(format!(
                "it takes more than {} GiB, or a stack of more than {} MiB, to be read: it nests too deep, or its macros grow too much",
                MOST_MEMORY >> 30,
                MOST_STACK >> 20
            )),
        }
    }

    fn end(mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The reviews of files that are read with the same, in their order, their steps judged.
pub(super) fn reviews(
    files: &[PathBuf],
    read: &Read,
    judge: &mut Judge,
    bar: &mut Bar,
) -> anyhow::Result<Vec<ShaderReview>> {
    let mut process = Process::start(read)?;
    let mut found = vec![];
    for file in files {
        let mut review = match process.review(file) {
            Ok(review) => review,
            Err(why) => {
                process.end();
                process = Process::start(read)?;
                unread(file, &why)
            }
        };
        judge.judge(&mut review)?;
        found.push(review);
        bar.bar.inc(1);
    }
    process.end();
    Ok(found)
}
