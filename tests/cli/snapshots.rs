//! What people see at 80 columns, as it is: `INSTA_UPDATE=always cargo test` renews the files of `snapshots`, to be read before they are
//! committed. No device has a part in them, and no time.

use super::gate::{answered, edit};
use super::{command, stderr, stdout};

/// What a command prints on both streams, and its exit code. At 80 columns no line may be wider. Where a line has a time, the text is that of a
/// wide terminal, since the digits of the time decide where lines wrap.
fn said(args: &[&str], color: &str) -> String {
    let text = said_in(args, color, "80");
    assert!(color == "always" || is_narrow(&text), "{text}");
    if text.contains("0.0 s") { said_in(args, color, "1000") } else { text }
}

fn said_in(args: &[&str], color: &str, columns: &str) -> String {
    let mut asked = command(&[args, &["--color", color]].concat());
    let output = asked.env("COLUMNS", columns).env_remove("NO_COLOR").output().expect("the binary starts");
    let (told, complaint) = (stdout(&output), stderr(&output));
    let complaint = if complaint.is_empty() { complaint } else { format!("--- standard error\n{complaint}") };
    let text = format!("$ lightmeter {}\n{told}{complaint}--- exit {:?}\n", args.join(" "), output.status.code());
    without_times(&text)
}

/// Without seconds, which differ.
fn without_times(text: &str) -> String {
    let timeless = |line: &str| {
        let end = line.find(" s:").or_else(|| line.strip_suffix(" s").map(str::len));
        let place = end.and_then(|end| Some((line[..end].rfind(' ')? + 1, end)));
        match place.filter(|&(start, end)| line[start..end].parse::<f64>().is_ok()) {
            Some((start, end)) => format!("{}0.0{}\n", &line[..start], &line[end..]),
            None => format!("{line}\n"),
        }
    };
    text.lines().map(timeless).collect()
}

/// Nothing that people read is wider than a terminal, apart from commands to copy.
fn is_narrow(text: &str) -> bool {
    let is_command = |line: &str| line.starts_with("$ ") || line.trim_start().starts_with("lightmeter ");
    text.lines().all(|line| is_command(line) || line.chars().count() <= 80)
}

macro_rules! looks {
    ($($name:ident: $($word:literal)+;)*) => {
        $(#[test]
        fn $name() {
            insta::assert_snapshot!(stringify!($name), said(&[$($word),+], "never"));
        })*
    };
}

looks! {
    help: "--help";
    a_run_that_passes: "run" "fog/exp" "lighting/blinn" "--adapter" "cpu" "--cases" "16";
    the_same_told_in_full: "run" "fog/exp" "lighting/blinn" "--adapter" "cpu" "--cases" "16" "--verbose";
    the_same_told_quietly: "run" "fog/exp" "lighting/blinn" "--adapter" "cpu" "--cases" "16" "--quiet";
    a_formula: "show" "attenuation/spot-cutoff";
    a_case: "show" "fog/exp/hard/far" "--adapter" "cpu";
    a_ruling: "show" "ruling/9";
    a_scene: "show" "scene/spotlight";
    a_mistake: "mistakes" "fog-base-two";
    a_list: "list" "fog/exp";
    a_name_that_is_misspelt: "run" "fog/exq";
    a_mistake_that_is_misspelt: "show" "fog/exp/hard/far" "--mistake" "fog-radail";
}

/// A gate's answers, of which one is wrong or none.
fn gated(test: &str, is_wrong: bool, color: &str) -> String {
    let (pack, answers) = answered(test, &["fog/exp"]);
    let spoil = |k: usize, line: &str| {
        let line = if is_wrong && k == 3 { line.replace("\"value\":[", "\"value\":[7") } else { line.into() };
        line + "\n"
    };
    let given = edit(&answers, spoil);
    let folder = pack.parent().expect("it lies in one").display().to_string();
    said(&["gate", &pack.display().to_string(), &given.display().to_string()], color).replace(&folder, "FOLDER")
}

#[test]
fn a_gate_that_passes() {
    insta::assert_snapshot!("a_gate_that_passes", gated("snapshot-passes", false, "never"));
}

#[test]
fn a_gate_that_fails() {
    insta::assert_snapshot!("a_gate_that_fails", gated("snapshot-fails", true, "never"));
}

#[test]
fn a_gate_that_fails_in_colors() {
    insta::assert_snapshot!(
        "a_gate_that_fails_in_colors",
        gated("snapshot-colors", true, "always").replace('\u{1b}', "␛")
    );
}

#[test]
fn a_run_that_passes_in_colors() {
    let args = ["run", "fog/exp", "--adapter", "cpu", "--cases", "16"];
    insta::assert_snapshot!("a_run_that_passes_in_colors", said(&args, "always").replace('\u{1b}', "␛"));
}
