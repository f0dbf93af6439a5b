//! `lightmeter serve`.

use super::playground::play;
use super::run::{Prepared, Run};
use super::visit::{awaited, tell_of};
use super::{NothingToRun, Status, environment, say};
use clap::Args;
use lightmeter::browser::{Server, Session};
use lightmeter::subject_gpu::browser::of_session;
use std::net::{SocketAddr, ToSocketAddrs as _};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::thread::JoinHandle;

/// Options that a playground has no use for: it judges what is typed.
const PLAYGROUND_LACKS: [&str; 30] = [
    "filter",
    "blend",
    "target",
    "size",
    "seed",
    "shaders",
    "shader",
    "function",
    "bind",
    "constant",
    "cases",
    "shard",
    "suggest",
    "groups",
    "timing",
    "separate",
    "images",
    "runs",
    "fail_fast",
    "no_samples",
    "expect",
    "baseline",
    "across",
    "growth",
    "update_baseline",
    "require",
    "format",
    "out",
    "json",
    "keep",
];

/// Judge the GPU of a browser: a page that it opens computes what `run` asks, and what comes back is judged here.
#[derive(Debug, Args)]
pub(crate) struct Serve {
    #[command(flatten)]
    run: Run,
    /// Where the page is served: an address of this machine, and a port; 0 is any that is free. Other machines reach it by https alone
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:0", value_parser = address)]
    listen: SocketAddr,
    /// Open the page in the default browser
    #[arg(long)]
    open: bool,
    /// Stay when a browser was judged, for others, one after the other or at once; Ctrl-C ends it
    #[arg(long)]
    keep: bool,
    /// Judge shaders that are typed into the page, as they are typed, and nothing else; Ctrl-C ends it
    #[arg(long, conflicts_with_all = PLAYGROUND_LACKS)]
    playground: bool,
}

impl Serve {
    pub(crate) fn run(mut self) -> anyhow::Result<Status> {
        if let Some(name) = self.run.adapters().first() {
            anyhow::bail!(
                "serve judges the browser that opens its page: leave --adapter out, or use `run --adapter {name}`"
            );
        }
        let asked = self.run.clone();
        let prepared = self.run.prepared()?;
        let server = Server::start(self.listen)?;
        tell_of(&server);
        if let (true, Err(error)) = (self.open, open(&server.access().url())) {
            say(&format!("note: {error}"));
        }
        let stop = prepared.stop().clone();
        let next = || awaited(&server, &stop);
        if self.playground {
            return play(next, &stop, self.run.profile());
        }
        if self.keep {
            return judge_all(&asked, next);
        }
        let session = next().ok_or_else(|| NothingToRun("ended before a browser opened the page".into()))?;
        judge(&self.run, prepared, &session, &mut vec![])
    }
}

/// Judges all browsers that come, each as soon as it does, until a signal ends it.
fn judge_all(asked: &Run, next: impl Fn() -> Option<Arc<Session>>) -> anyhow::Result<Status> {
    let (mut names, mut runs): (Vec<String>, Vec<JoinHandle<anyhow::Result<Status>>>) = (vec![], vec![]);
    while let Some(session) = next() {
        let mut run = asked.clone().numbered(names.len() + 1);
        let prepared = run.prepared()?;
        let name = named(&session, &mut names);
        runs.push(std::thread::spawn(move || judge_named(&run, prepared, &session, name)));
    }
    if runs.is_empty() {
        return Err(NothingToRun("ended before a browser opened the page".into()).into());
    }
    let mut worst = Status::Success;
    for run in runs {
        let status = run.join().map_err(|_| anyhow::anyhow!("a run ended by a panic, which stands above"))??;
        if (worst as u8) < status as u8 {
            worst = status;
        }
    }
    Ok(worst)
}

fn judge(run: &Run, prepared: Prepared, session: &Arc<Session>, names: &mut Vec<String>) -> anyhow::Result<Status> {
    let name = named(session, names);
    judge_named(run, prepared, session, name)
}

fn judge_named(run: &Run, prepared: Prepared, session: &Arc<Session>, name: String) -> anyhow::Result<Status> {
    let judged = run.judged(prepared, vec![of_session(name, session.clone())], Some(session.clone()));
    if let Err(error) = &judged {
        session.tell_the_end(format!("The run ended before its time: {error}"), None);
    }
    judged
}

/// The browser's name as an adapter, which no other one of this run has: `chrome`, `firefox-2`.
fn named(session: &Session, names: &mut Vec<String>) -> String {
    let words = session.hello().browser.to_lowercase();
    let words: Vec<&str> = words.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let name = if words.is_empty() { "browser".into() } else { words.join("-") };
    names.push(name.clone());
    match names.iter().filter(|other| **other == name).count() {
        1 => name,
        count => format!("{name}-{count}"),
    }
}

/// An address of this machine with a port. Of the addresses that a name stands for, that of version 4 is taken, as most browsers do.
fn address(text: &str) -> Result<SocketAddr, String> {
    let expected = "expected ADDRESS:PORT, as 127.0.0.1:8080, [::1]:8080 or localhost:8080";
    let found = text.to_socket_addrs().map_err(|error| format!("{error}; {expected}"))?;
    let mut found: Vec<SocketAddr> = found.collect();
    found.sort_by_key(SocketAddr::is_ipv6);
    found.first().copied().ok_or_else(|| expected.to_owned())
}

/// Opens a page in the default browser.
fn open(url: &str) -> anyhow::Result<()> {
    let (program, arguments): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let mut command = Command::new(program);
    let command = environment::spare(command.args(arguments).arg(url).stdout(Stdio::null()).stderr(Stdio::null()));
    command
        .spawn()
        .map(drop)
        .map_err(|error| anyhow::anyhow!("--open: {program} does not start: {error}; open the page by hand"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_playground_has_a_use_for_an_option_or_refuses_it() {
        const USED: [&str; 5] = ["adapter", "profile", "listen", "open", "playground"];
        let command = Serve::augment_args(clap::Command::new("serve"));
        for id in command.get_arguments().map(|arg| arg.get_id().as_str()) {
            assert!(PLAYGROUND_LACKS.contains(&id) != USED.contains(&id), "{id}");
        }
    }
}
