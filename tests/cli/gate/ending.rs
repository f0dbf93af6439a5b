//! How gates and renderers end: by a signal, by time, and that nothing outlives them.

use super::process::{PASSES, gate, process, renderer};
use super::{count, folder, report, text};
use crate::held::Held;
use crate::{code, command, lightmeter, stderr};
use rustix::process::{Pid, Signal, test_kill_process};
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// Waits until a process whose number a file has does not run any more.
fn ends(file: &Path) {
    let read = || std::fs::read_to_string(file).ok()?.trim().parse::<i32>().ok();
    let number = waited_for("its number", read);
    let pid = Pid::from_raw(number).expect("a number above 0");
    let state = || std::fs::read_to_string(format!("/proc/{number}/stat")).unwrap_or_default();
    // One that has ended and whose parent does not ask is a zombie.
    waited_for("its end", || (test_kill_process(pid).is_err() || state().contains(") Z")).then_some(()));
}

/// After which a test fails that waits for something in vain.
const LIMIT: Duration = Duration::from_secs(300);

/// Waits for something that happens in another process.
fn waited_for<T>(what: &str, happens: impl Fn() -> Option<T>) -> T {
    let until = Instant::now() + LIMIT;
    loop {
        match happens() {
            Some(it) => return it,
            None => assert!(Instant::now() < until, "waited for {what} in vain"),
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_gate_that_is_told_to_stop_before_the_hello_ends_by_the_signal() {
    let gate = Held::watch(&mut command(&["gate", "fog/exp", "--exec", "sleep 600"]));
    gate.wait_for("ready");
    gate.signal(Signal::INT);
    assert_eq!(code(&gate.go_on()), 130);
}

#[test]
fn nothing_that_a_renderer_started_outlives_it() {
    let folder = folder("orphans");
    let file = folder.join("pid");
    // In a session, and so a process group, of its own, with an environment of its own, and started by a shell that has ended.
    let orphan = format!("(env -i setsid /bin/sh -c 'echo $$ > \"{}\"; exec sleep 600' &)", text(&file));
    for fault in ["", "crash-at=fog/exp/random/000017", "hang-at=fog/exp/random/000017"] {
        // At each start not before it has written its number.
        let (gone, waits) =
            (format!("rm -f '{0}'", text(&file)), format!("while [ ! -s '{0}' ]; do sleep 0.01; done", text(&file)));
        let exec = format!("{gone}; {orphan}; {waits}; {} {fault}", renderer());
        let output = gate(&["fog/exp"], &exec, &[]);
        assert_eq!(code(&output), if fault.is_empty() { 0 } else { 4 }, "{}", stderr(&output));
        ends(&file);
    }
}

#[test]
fn a_renderer_does_not_outlive_a_gate_that_is_killed() {
    let file = folder("killed").join("pid");
    let exec = format!("echo $$ > '{}'; exec sleep 600", text(&file));
    let mut gate = command(&["gate", "fog/exp", "--exec", &exec])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the binary starts");
    waited_for("the renderer", || std::fs::read_to_string(&file).ok().filter(|number| number.ends_with('\n')));
    gate.kill().expect("it can be killed");
    gate.wait().expect("it has ended");
    ends(&file);
}

#[test]
fn a_renderer_whose_hello_is_refused_is_ended() {
    let number = folder("refused").join("number");
    let hello = r#"{"hello": "lightmeter.protocol/1", "renderer": "r", "formulas": ["fog"], "targets": ["rgb565"]}"#;
    let exec = format!("echo $$ > '{}'; echo '{hello}'; exec sleep 600", text(&number));
    let output = gate(&["fog/exp"], &exec, &[]);
    assert!(
        code(&output) == 2 && stderr(&output).contains("no target `rgb565`; expected rgba32float"),
        "{}",
        stderr(&output)
    );
    ends(&number);
}

#[test]
fn a_gate_that_is_told_to_stop_reports_and_leaves_nothing() {
    let folder = folder("stopped");
    let file = folder.join("pid");
    let temporary = folder.join("tmp");
    std::fs::create_dir_all(&temporary).expect("a folder can be made");
    let hangs = folder.join("hangs");
    let fault = format!("hang-at=fog/exp/random/000050 tells='{}'", text(&hangs));
    let exec = format!("echo $$ > '{}'; exec {} {fault}", text(&file), renderer());
    // What hears the first signal holds, so that the second one comes as early as `timeout` sends it.
    let gate = Held::unawaited(
        command(&["gate", "fog/exp", "scene/flat", "--exec", &exec, "--format", "json", "--case-timeout", "1e6"])
            .env("TMPDIR", &temporary),
        "signal:1",
    );
    waited_for("the case that it hangs at", || hangs.exists().then_some(()));
    // As `timeout` does: to its child, and to the group that the child is in.
    gate.signal(Signal::TERM);
    gate.send(Signal::TERM);
    let (status, found) = report(&gate.go_on());
    assert!(status == 143 && found["interrupted"]["signal"] == 15, "{found}");
    assert!(found["renderer"]["incidents"].to_string().contains("it was stopped"), "{found}");
    assert!(count(&found, "passed") > 0, "what was answered is judged: {found}");
    ends(&file);
    assert_eq!(std::fs::read_dir(&temporary).expect("it is there").count(), 0, "its folder for images is left");
}

#[test]
fn a_renderer_that_writes_on_after_its_last_answer_is_ended() {
    for pause in [PASSES, ":"] {
        let exec = format!("{}; {PASSES}; while :; do echo; {pause}; done", renderer());
        let (status, found) = report(&gate(&["fog/exp"], &exec, &[]));
        assert!(status == 4 && found["renderer"]["incidents"].to_string().contains("did not end"), "{pause}: {found}");
    }
}

#[test]
fn how_a_renderer_ends_is_told_though_it_answered_all() {
    for (fault, said) in [("exit=3", "exit status: 3"), ("lingers=all", "did not end")] {
        let (status, found) = report(&process(&["fog/exp"], fault, &[]));
        assert!(status == 4 && found["renderer"]["incidents"].to_string().contains(said), "{fault}: {found}");
        assert_eq!(count(&found, "passed"), count(&found, "asked"), "{found}");
    }
}

#[test]
fn time_for_all_ends_a_renderer_that_never_says_hello() {
    // By the machine's clock: it says nothing however long that is.
    let mut gate = command(&["gate", "fog", "--exec", "sleep 600", "--timeout", "0.5"]);
    let output = gate.env_remove("LIGHTMETER_CLOCK").output().expect("the binary starts");
    assert!(code(&output) == 4 && stderr(&output).contains("said nothing for 0.5 s"), "{}", stderr(&output));
    let exec = format!("printf '{{}}'; {PASSES}; sleep 600");
    let output = lightmeter(&["gate", "fog", "--exec", &exec, "--timeout", "0.5"]);
    let said = "said no whole line for 0.5 s: 2 bytes without a newline behind them came, `{}`";
    assert!(code(&output) == 4 && stderr(&output).contains(said), "{}", stderr(&output));
}
