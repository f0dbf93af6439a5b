//! A process with all that it starts: how a shell is called, and how all of them are ended.

use std::process::{Child, Command};

/// The variable that marks a renderer and its descendants.
const MARK: &str = "LIGHTMETER_GATE";

/// A command as the system's shell takes it.
pub(super) fn shell(command: &str) -> (&'static str, Vec<String>) {
    let (shell, option) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    (shell, vec![option.to_owned(), command.to_owned()])
}

/// Makes a command lead a family of processes, marked by a word in their environment.
pub(super) fn lead<'a>(command: &'a mut Command, mark: &str) -> &'a mut Command {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    command.env(MARK, mark)
}

#[cfg(unix)]
mod system {
    use super::MARK;
    use rustix::process::{Pid, Signal, kill_process, kill_process_group};
    use std::process::Child;

    fn pid(child: &Child) -> Option<Pid> {
        i32::try_from(child.id()).ok().and_then(Pid::from_raw)
    }

    /// Asks a process to end.
    pub(in super::super) fn terminate(child: &Child) {
        if let Some(pid) = pid(child) {
            let _ = kill_process(pid, Signal::TERM);
        }
    }

    pub(super) fn kill_group(child: &Child) {
        if let Some(group) = pid(child) {
            let _ = kill_process_group(group, Signal::KILL);
        }
    }

    /// Kills what has the mark in its environment: descendants that left the process group. Where there is no /proc, none is found.
    pub(super) fn kill_marked(mark: &str) {
        let wanted = format!("{MARK}={mark}");
        let is_marked = |environment: &[u8]| environment.split(|&byte| byte == 0).any(|one| one == wanted.as_bytes());
        // One that is being forked as the list is read is found the next time.
        for _ in 0..3 {
            let Ok(entries) = std::fs::read_dir("/proc") else { return };
            let mut found = false;
            for entry in entries.flatten() {
                let Some(pid) = entry.file_name().to_str().and_then(|name| name.parse().ok()).and_then(Pid::from_raw)
                else {
                    continue;
                };
                if std::fs::read(entry.path().join("environ")).is_ok_and(|environment| is_marked(&environment)) {
                    found |= kill_process(pid, Signal::KILL).is_ok();
                }
            }
            if !found {
                return;
            }
        }
    }
}

#[cfg(not(unix))]
mod system {
    use std::process::{Child, Command, Stdio};

    /// Windows has no request to end: it is killed with its descendants.
    pub(in super::super) fn terminate(child: &Child) {
        kill_group(child);
    }

    /// Windows's own command ends a process with all that descends from it, as long as it runs.
    pub(super) fn kill_group(child: &Child) {
        let mut command = Command::new("taskkill");
        command.args(["/T", "/F", "/PID", &child.id().to_string()]);
        let _ = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    }

    /// The environment of another process cannot be read.
    pub(super) fn kill_marked(_mark: &str) {}
}

pub(super) use system::terminate;

/// Kills a process with all that it started; how it ended.
pub(super) fn kill(child: &mut Child, mark: &str) -> std::io::Result<std::process::ExitStatus> {
    system::kill_group(child);
    let _ = child.kill();
    let status = child.wait();
    system::kill_marked(mark);
    status
}
