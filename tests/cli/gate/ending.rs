//! How gates and renderers end: by a signal, by time, and that nothing outlives them.

use super::process::{gate, process, renderer};
use super::{count, folder, report, text};
use crate::{code, command, lightmeter, stderr};
use rustix::process::{Pid, Signal, kill_process, test_kill_process};
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// Whether a process whose number a file has runs, once it has had time to end.
fn runs(file: &Path) -> bool {
    let read = || std::fs::read_to_string(file).ok()?.trim().parse::<i32>().ok();
    let until = Instant::now() + Duration::from_secs(5);
    let number = loop {
        match read() {
            Some(number) => break number,
            None => assert!(Instant::now() < until, "the process wrote no number"),
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let pid = Pid::from_raw(number).expect("a number above 0");
    let state = || std::fs::read_to_string(format!("/proc/{number}/stat")).unwrap_or_default();
    let until = Instant::now() + Duration::from_secs(5);
    // One that has ended and whose parent does not ask is a zombie.
    while test_kill_process(pid).is_ok() && !state().contains(") Z") {
        if Instant::now() > until {
            return true;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    false
}

#[test]
fn a_gate_that_is_told_to_stop_before_the_hello_ends_by_the_signal() {
    let gate = command(&["gate", "fog/exp", "--exec", "sleep 600"]).stderr(Stdio::piped()).spawn().expect("it starts");
    std::thread::sleep(Duration::from_secs(3));
    let pid = i32::try_from(gate.id()).ok().and_then(Pid::from_raw).expect("a number");
    kill_process(pid, Signal::INT).expect("it runs");
    assert_eq!(code(&gate.wait_with_output().expect("it ends")), 130);
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
        let output = gate(&["fog/exp"], &exec, &["--case-timeout", "1"]);
        assert_eq!(code(&output), if fault.is_empty() { 0 } else { 4 }, "{}", stderr(&output));
        assert!(!runs(&file), "{fault}: what it started runs on");
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
    let until = Instant::now() + Duration::from_secs(20);
    while std::fs::read_to_string(&file).unwrap_or_default().trim().is_empty() {
        assert!(Instant::now() < until, "the renderer was not started");
        std::thread::sleep(Duration::from_millis(5));
    }
    gate.kill().expect("it can be killed");
    gate.wait().expect("it has ended");
    assert!(!runs(&file), "the renderer runs on");
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
    assert!(!runs(&number), "it goes on");
}

#[test]
fn a_gate_that_is_told_to_stop_reports_and_leaves_nothing() {
    let folder = folder("stopped");
    let file = folder.join("pid");
    let temporary = folder.join("tmp");
    std::fs::create_dir_all(&temporary).expect("a folder can be made");
    let exec = format!("echo $$ > '{}'; exec {} hang-at=fog/exp/random/000050", text(&file), renderer());
    let gate =
        command(&["gate", "fog/exp", "scene/flat", "--exec", &exec, "--format", "json", "--case-timeout", "600"])
            .env("TMPDIR", &temporary)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the binary starts");
    let until = Instant::now() + Duration::from_secs(60);
    while !file.exists() && Instant::now() < until {
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_secs(6));
    let pid = i32::try_from(gate.id()).ok().and_then(Pid::from_raw).expect("a number");
    // As `timeout` does: to its child, and to the group that the child is in.
    for _ in 0..2 {
        kill_process(pid, Signal::TERM).expect("it runs");
        std::thread::sleep(Duration::from_millis(1));
    }
    let (status, found) = report(&gate.wait_with_output().expect("it ends"));
    assert!(status == 143 && found["signal"] == 15, "{found}");
    assert!(found["incidents"].to_string().contains("it was stopped"), "{found}");
    assert!(count(&found, "passed") > 0, "what was answered is judged: {found}");
    assert!(!runs(&file), "the renderer runs on");
    assert_eq!(std::fs::read_dir(&temporary).expect("it is there").count(), 0, "its folder for images is left");
}

#[test]
fn a_renderer_that_writes_on_after_its_last_answer_is_ended() {
    for pause in ["sleep 0.02", ":"] {
        let exec = format!("{}; while :; do echo; {pause}; done", renderer());
        let (status, found) = report(&gate(&["fog/exp"], &exec, &["--case-timeout", "1"]));
        assert!(status == 4 && found["incidents"].to_string().contains("did not end"), "{pause}: {found}");
    }
}

#[test]
fn how_a_renderer_ends_is_told_though_it_answered_all() {
    for (fault, said) in [("exit=3", "exit status: 3"), ("lingers=all", "did not end")] {
        let (status, found) = report(&process(&["fog/exp"], fault, &["--case-timeout", "1"]));
        assert!(status == 4 && found["incidents"].to_string().contains(said), "{fault}: {found}");
        assert_eq!(count(&found, "passed"), count(&found, "asked"), "{found}");
    }
}

#[test]
fn time_for_all_ends_a_renderer_that_never_says_hello() {
    let output = lightmeter(&["gate", "fog", "--exec", "sleep 600", "--timeout", "0.5"]);
    assert!(code(&output) == 4 && stderr(&output).contains("said nothing for 0.5 s"), "{}", stderr(&output));
    let output = lightmeter(&["gate", "fog", "--exec", "printf '{}'; sleep 600", "--timeout", "0.5"]);
    let said = "said no whole line for 0.5 s: 2 bytes without a newline behind them came, `{}`";
    assert!(code(&output) == 4 && stderr(&output).contains(said), "{}", stderr(&output));
}
