//! A renderer in a process of its own: how it fails, and what is left of it.

use super::{count, folder, report, text};
use crate::{code, command, lightmeter, stderr, stdout};
use serde_json::{Value, json};
use std::path::Path;
use std::process::Output;

/// The command of the example renderer.
pub(super) fn renderer() -> String {
    let binary = Path::new(env!("CARGO_BIN_EXE_lightmeter"));
    let renderer = binary.parent().expect("it lies in a folder").join("examples/renderer");
    assert!(
        renderer.exists(),
        "it is built by `cargo test` of the whole workspace, and by `cargo build --example renderer`"
    );
    format!("'{}'", text(&renderer))
}

/// The command of the example renderer, with something that goes wrong in it.
pub(crate) fn command_of(fault: &str) -> String {
    format!("{} {fault}", renderer())
}

/// A gate over the example renderer, with something that goes wrong in it.
pub(crate) fn process(filter: &[&str], fault: &str, more: &[&str]) -> Output {
    gate(filter, &command_of(fault), more)
}

pub(super) fn gate(filter: &[&str], exec: &str, more: &[&str]) -> Output {
    lightmeter(&[&["gate", "--exec", exec, "--format", "json", "--cases", "64"], filter, more].concat())
}

/// What tells a shell to say that ten minutes have passed.
pub(crate) const PASSES: &str = r"printf '\377passes:00600000'";

#[test]
fn formulas_are_described_before_they_are_asked_for() {
    // It ends where it is asked for a formula that was not described.
    for more in ["", " columns=f4", " targets=all", " crash-at=fog/exp/random/000017"] {
        let output = process(&["fog/{exp,linear}", "blend/mode-add"], &format!("describe=all{more}"), &[]);
        let (status, report) = report(&output);
        let expected = if more.contains("crash") { (4, 1) } else { (0, 0) };
        assert_eq!((status, count(&report, "failed")), expected, "{more}: {report}");
    }
}

#[test]
fn what_is_described_says_what_computes_a_formula_and_how() {
    let output = lightmeter(&["list", "--formulas", "--format", "json", "vector/normal-modelview", "fog/exp"]);
    let listed: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let made_by = |id: &str| {
        let formulas = listed["formulas"].as_array().expect("an array");
        formulas
            .iter()
            .find(|formula| formula["id"] == id)
            .map(|formula| formula["made_by"].clone())
            .expect("it is there")
    };
    let matrix = made_by("vector/normal-modelview");
    assert_eq!(matrix, json!({"file": "vector.wgsl", "function": "vector_normal_modelview", "matrices": "columns"}));
    assert_eq!(made_by("fog/exp"), json!({"file": "fog.wgsl", "function": "fog_exp"}));
    let output = lightmeter(&["list", "--formulas", "--format", "json", "depth/test/less/keep", "blend/min"]);
    let listed: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    for formula in listed["formulas"].as_array().expect("an array") {
        let made_by = &formula["made_by"];
        let is_depth = formula["id"] == "depth/test/less/keep";
        assert!(!is_depth || made_by["depth"] == json!({"compare": "less", "write": false}), "{formula}");
        assert!(is_depth || made_by["blend"][0]["color"]["equation"] == "min", "{formula}");
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_process_that_fails_in_any_way_costs_that_case_alone() {
    let case = "fog/exp/random/000017";
    // The fault; the exit code; cases that fail, and that are never answered; what is said.
    let rows: [(&str, i32, u64, &str); 9] = [
        ("", 0, 0, ""),
        ("crash-at", 4, 1, "it ended"),
        ("hang-at", 4, 1, "longer"),
        ("nan-at", 1, 1, ""),
        ("truncated-at", 4, 0, "malformed"),
        ("long-at", 4, 0, "oversized"),
        ("unknown-at", 4, 0, "fog/none"),
        ("twice-at", 4, 0, "more than once"),
        ("short-at", 1, 1, "expected 4"),
    ];
    for (fault, status, failed, said) in rows {
        let fault = format!("{fault}={case}");
        let output = process(&["fog/exp", "vector"], &fault, &[]);
        let (found, report) = report(&output);
        assert_eq!((found, count(&report, "failed")), (status, failed), "{fault}: {report}");
        assert_eq!(count(&report, "passed"), count(&report, "asked") - failed, "{fault}: {report}");
        assert!(report.to_string().contains(said), "{fault}: {report}");
    }
    let (status, found) = report(&process(&["fog/exp"], "unstable-at=fog/exp/random/000003", &[]));
    assert_eq!((status, count(&found, "unstable")), (1, 1), "{found}");
    // The last answer of a batch, so that nothing else is in its line.
    let last = "unended-at=fog/exp/random/000015";
    let (status, found) = report(&process(&["fog/exp/random/0000{0,1}*"], last, &[]));
    let incidents = found["renderer"]["incidents"].to_string();
    assert!(
        status == 4 && incidents.contains("took longer than a case may: ") && count(&found, "failed") == 1,
        "{found}"
    );
    assert!(
        incidents.contains(" bytes without a newline behind them came, `{\\\"id\\\":\\\"fog/exp/random/000015"),
        "{found}"
    );
    let dropped = process(&["fog/exp"], &format!("drop-at={case}"), &[]);
    let (status, found) = report(&dropped);
    assert_eq!((status, count(&found, "failed")), (4, 1), "{found}");
}

#[test]
fn a_formula_that_a_renderer_keeps_ending_at_is_given_up() {
    let (status, found) = report(&process(&["fog/exp", "vector"], "crash-at=fog/exp", &[]));
    assert_eq!(status, 4, "{found}");
    let groups = found["groups"].as_array().expect("an array");
    for group in groups.iter().filter(|group| group["by_case"]["asked"] != 0) {
        let is_it = group["id"] == "fog/exp";
        let (failed, missing) = if is_it { (3, group["by_case"]["asked"].as_u64().unwrap_or(0) - 3) } else { (0, 0) };
        assert_eq!(
            (&group["by_case"]["failed"], &group["by_case"]["broken"]),
            (&failed.into(), &failed.into()),
            "{group}"
        );
        assert_eq!(group["by_case"]["missing"], missing, "{group}");
    }
    assert!(groups.len() > 10, "{found}");
    let incidents = found["renderer"]["incidents"].as_array().expect("an array");
    assert_eq!(incidents.len(), 4, "three cases, and that no more is asked: {incidents:?}");
    assert!(incidents[3].to_string().contains("fog/exp: no more of it is asked"), "{incidents:?}");
    assert!(found["renderer"]["starts"].as_u64().is_some_and(|starts| starts <= 8), "{found}");
}

#[test]
fn a_crash_in_every_run_is_no_changed_answer() {
    let (status, found) = report(&process(&["fog/exp"], "crash-at=fog/exp/random/000017", &["--runs", "3"]));
    assert_eq!((status, count(&found, "unstable"), count(&found, "broken")), (4, 0, 1), "{found}");
    let (status, found) = report(&process(&["fog/exp", "fog/linear"], "crash-at=fog/exp", &["--runs", "2"]));
    assert_eq!((status, count(&found, "unstable"), count(&found, "broken")), (4, 0, 3), "{found}");
}

#[test]
fn a_failure_names_inputs_outputs_and_units() {
    let output = process(&["fog/linear"], "nan-at=fog/linear/random/000017", &[]);
    let (_, found) = report(&output);
    let failure = &found["failures"][0];
    assert!(failure["inputs"]["dmin"].is_number() && failure["inputs"]["p"].is_array(), "{failure}");
    assert_eq!(
        (&failure["answer"]["outputs"][0], &failure["units"]["dmax"]),
        (&"f".into(), &"unit".into()),
        "{failure}"
    );
    let exec = format!("{} nan-at=fog/linear/random/000017", renderer());
    let told = crate::stdout(&lightmeter(&["gate", "--exec", &exec, "--cases", "64", "fog/linear"]));
    assert!(told.contains("dmin ") && told.contains("✗  f  ") && told.contains("legal from"), "{told}");
    assert!(told.contains("again      lightmeter gate --exec '"), "{told}");
}

#[test]
fn scenes_are_drawn_and_judged() {
    let output = process(&["scene/phong-blinn", "scene/flat"], "", &[]);
    let (status, found) = report(&output);
    assert_eq!((status, count(&found, "passed")), (0, 2), "{found}");
    for (fault, said) in [("half-at", "the scene is"), ("elsewhere-at", "leaves the folder")] {
        let (status, found) = report(&process(&["scene/flat"], &format!("{fault}=scene/flat"), &[]));
        assert_eq!((status, count(&found, "failed")), (1, 1), "{found}");
        assert!(found.to_string().contains(said), "{found}");
        let exec = format!("{} {fault}=scene/flat", renderer());
        let told = crate::stdout(&lightmeter(&["gate", "--exec", &exec, "scene/flat"]));
        assert!(told.contains(said), "people are told, too: {told}");
    }
}

#[test]
fn a_renderer_that_never_starts_is_told() {
    for (exec, said) in [
        ("exit 3", "ended before its hello"),
        ("echo what", "first; expected a hello"),
        ("/no/such/renderer", "not found"),
    ] {
        let output = lightmeter(&["gate", "fog", "--exec", exec]);
        assert_eq!(code(&output), 4, "{exec}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{exec}: {}", stderr(&output));
    }
}

#[test]
fn what_is_written_without_end_or_use_ends_the_process_and_not_the_gate() {
    let case = "fog/exp/random/000017";
    for (fault, said) in [("flood-at", "many lines that answer nothing"), ("trickle-at", "longer than a case may")] {
        let output = process(&["fog/exp"], &format!("{fault}={case}"), &[]);
        let (status, found) = report(&output);
        assert!(status == 4 && found["renderer"]["incidents"].to_string().contains(said), "{fault}: {found}");
        assert_eq!(count(&found, "passed"), count(&found, "asked") - 1, "{fault}: {found}");
    }
    let (status, found) = report(&process(&["fog/exp"], &format!("hello-at={case}"), &[]));
    assert!(status == 4 && found.to_string().contains("said once and first"), "{found}");
}

#[test]
fn a_renderer_that_answers_without_reading_is_told() {
    let folder = folder("deaf");
    let hello = "{\"hello\":\"lightmeter.protocol/1\",\"renderer\":\"deaf\",\"formulas\":[\"fog/exp\"]}\n";
    let answers = (0..4000).map(|k| format!("{{\"id\":\"fog/exp/random/{k:06}\",\"value\":[0,0,0,0]}}\n"));
    let file = folder.join("answers.jsonl");
    std::fs::write(&file, hello.to_owned() + &answers.collect::<String>()).expect("it can be written");
    // Time goes on passing: the first of it may be heard before the pipe is full.
    let exec = format!("cat '{}'; while {PASSES}; do sleep 0.1; done", text(&file));
    let args = ["gate", "--exec", &exec, "--format", "json", "--cases", "4000", "fog/exp/random"];
    let (status, found) = report(&lightmeter(&args));
    assert!(
        status == 4 && found["renderer"]["incidents"].to_string().contains("did not read what it was asked"),
        "{found}"
    );
}

#[test]
fn what_the_gate_sets_for_itself_is_not_in_the_environment_of_a_renderer() {
    let file = folder("environment").join("tunables");
    let exec = format!("echo \"[$GLIBC_TUNABLES]\" > '{}'", text(&file));
    for own in ["", "glibc.malloc.perturb=0"] {
        let mut gate = command(&["gate", "fog/exp", "--exec", &exec]);
        if own.is_empty() {
            gate.env_remove("GLIBC_TUNABLES")
        } else {
            gate.env("GLIBC_TUNABLES", own)
        };
        gate.output().expect("the binary starts");
        assert_eq!(std::fs::read_to_string(&file).expect("it ran").trim(), format!("[{own}]"));
    }
}

#[test]
fn a_renderer_has_the_memory_that_it_is_given() {
    let exec = format!("test \"$(ulimit -v)\" = 8388608 && exec {}", renderer());
    let output = gate(&["fog/exp"], &exec, &["--memory", "8192"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let output = gate(&["fog/exp"], &exec, &["--memory", "8191"]);
    assert!(code(&output) == 4 && stderr(&output).contains("ended before its hello"), "{}", stderr(&output));
}

#[test]
fn an_image_of_an_earlier_run_is_no_answer() {
    let images = folder("stale");
    let more = ["--images", text(&images)];
    let (status, found) = report(&process(&["scene/flat"], "", &more));
    assert_eq!((status, count(&found, "passed")), (0, 1), "{found}");
    // A file has its time from a clock that may stand still for some milliseconds.
    let image = std::fs::metadata(images.join("scene-flat.exr")).and_then(|file| file.modified()).expect("a time");
    let probe = images.join("probe");
    let is_later = || {
        std::fs::write(&probe, "").expect("it can be written");
        std::fs::metadata(&probe).and_then(|file| file.modified()).expect("a time") > image
    };
    while !is_later() {}
    let (status, found) = report(&process(&["scene/flat"], "stale-at=scene/flat", &more));
    assert!(status == 1 && found.to_string().contains("was there before the scene was asked for"), "{found}");
    let (status, found) = report(&process(&["scene/flat"], "", &more));
    assert_eq!((status, count(&found, "passed")), (0, 1), "{found}");
}

#[test]
fn an_image_that_is_no_file_is_not_waited_for() {
    let folder = folder("fifo");
    let hello = "{\"hello\":\"lightmeter.protocol/1\",\"renderer\":\"fifo\",\"scenes\":[\"scene/flat\"]}";
    let answer = "{\"id\":\"scene/flat\",\"image\":\"pipe.png\"}";
    let exec = format!(
        "mkfifo '{}/pipe.png'; echo '{hello}'; while read -r line; do case $line in *batch*) echo '{answer}';; esac; done",
        text(&folder)
    );
    let (status, found) = report(&gate(&["scene/flat"], &exec, &["--images", text(&folder), "--size", "16"]));
    assert!(status == 1 && found.to_string().contains("is no file"), "{found}");
}

#[test]
fn a_crash_that_is_expected_breaks_nothing() {
    let folder = folder("expected-crash");
    let file = folder.join("expected.toml");
    let case = "fog/exp/random/000017";
    let write = |more: &str| {
        let text = format!("[[expected]]\nid = \"{case}\"\nreason = \"it divides by 0\"\n{more}");
        std::fs::write(&file, text).expect("it can be written");
    };
    let gate = || report(&process(&["fog/exp"], &format!("crash-at={case}"), &["--expect", text(&file)]));
    write("");
    let (status, found) = gate();
    assert!(status == 4 && count(&found, "expected_failures") == 1, "{found}");
    write("crash = true\n");
    let (status, found) = gate();
    assert_eq!((status, count(&found, "failed")), (0, 1), "{found}");
    assert_eq!(found["renderer"]["expected_incidents"].as_array().map(Vec::len), Some(1), "told once: {found}");
    // Another crash is not excused.
    let both = format!("crash-at={case}");
    let elsewhere =
        report(&process(&["fog/exp", "fog/linear"], &both.replace("exp/", "linear/"), &["--expect", text(&file)]));
    assert_eq!(elsewhere.0, 4, "{}", elsewhere.1);
}

/// A renderer in shell, of `fog/exp`: `answered` is run for each case, with its id in `$id`; it answers at once.
fn in_shell(folder: &Path, before: &str, answered: &str) -> String {
    let script = folder.join("renderer.sh");
    let text_of = format!(
        "{before}\necho '{{\"hello\":\"lightmeter.protocol/1\",\"renderer\":\"shell\",\"formulas\":[\"fog/exp\"],\"scenes\":[]}}'\n\
         while read -r line; do case $line in *'\"inputs\"'*) id=${{line#*'\"id\":\"'}}; id=${{id%%'\"'*}};\n{answered}\n;; esac; done\n"
    );
    std::fs::write(&script, text_of).expect("it can be written");
    format!("sh '{}'", text(&script))
}

const ZEROS: &str = "echo \"{\\\"id\\\":\\\"$id\\\",\\\"value\\\":[0,0,0,0]}\"";

#[test]
fn a_process_that_ends_after_an_answer_spoils_no_other_case() {
    let folder = folder("after");
    // It ends of the case that it has just answered, each time.
    let answered = format!("{ZEROS}; case $id in */000017) exit 9;; esac");
    let exec = in_shell(&folder, "", &answered);
    let (status, found) = report(&gate(&["fog/exp"], &exec, &["--seed", "3"]));
    assert_eq!(status, 4, "{found}");
    let problems: Vec<&str> = found["failures"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|failure| failure["answer"]["problem"].as_str())
        .collect();
    assert!(problems.is_empty() && count(&found, "missing") == 0, "every answer is judged: {problems:?}");
}

#[test]
fn what_takes_long_together_is_no_hang() {
    // It answers at the end of a batch, as buffered output does: 10 ms a case, and 256 of them take longer than one may.
    let exec = format!("{} slow-at=fog/exp2-opengl", renderer());
    let args = ["fog/exp", "fog/linear", "fog/exp2-opengl", "--case-timeout", "1", "--seed", "2"];
    let (status, found) =
        report(&lightmeter(&[&["gate", "--exec", &exec, "--format", "json", "--cases", "400"], &args[..]].concat()));
    assert_eq!(status, 0, "{found}");
}

#[test]
fn another_crash_is_not_excused_by_one_that_is_expected() {
    let folder = folder("flaky");
    let (flag, file) = (folder.join("flag"), folder.join("expected.toml"));
    std::fs::write(&file, "[[expected]]\nid = \"scene/flat\"\nreason = \"known\"\ncrash = true\n").expect("written");
    // The first process ends of a case that later ones answer.
    let exec = format!(
        "if [ -e '{0}' ]; then exec {1} crash-at=scene/flat; else touch '{0}'; exec {1} crash-at=fog/exp/random/000003; fi",
        text(&flag),
        renderer()
    );
    let (status, found) = report(&gate(&["fog/exp", "scene/flat"], &exec, &["--expect", text(&file)]));
    assert!(status == 4 && found["renderer"]["incidents"].as_array().map(Vec::len) == Some(1), "{found}");
}

#[test]
fn a_process_that_says_another_hello_is_given_up() {
    let folder = folder("another-hello");
    let flag = folder.join("flag");
    let before = format!("name=first; [ -e '{0}' ] && name=second; touch '{0}'", text(&flag));
    let exec = in_shell(&folder, &before, ZEROS);
    let script = folder.join("renderer.sh");
    let named = std::fs::read_to_string(&script).expect("it is there").replace("\"shell\"", "\"'$name'\"");
    std::fs::write(&script, named).expect("it can be written");
    let (status, found) = report(&gate(&["fog/exp"], &exec, &["--runs", "2"]));
    assert!(status == 4 && found["renderer"]["incidents"].to_string().contains("says another hello"), "{found}");
    let incidents = found["renderer"]["incidents"].to_string();
    assert!(incidents.contains("started first: `renderer` was \\\"first\\\", and is \\\"second\\\""), "{incidents}");
    for (hello, status, said) in [
        ("{\"hello\":\"lightmeter.protocol/2\",\"renderer\":\"r\"}", 4, "expected `lightmeter.protocol/1`"),
        (
            "{\"hello\":\"lightmeter.protocol/1\",\"renderer\":\"r\",\"formulas\":[\"fog/exp\", \"lighting/phnog\"]}",
            2,
            "`lighting/phnog` matches no formula; did you mean `lighting/phong`,",
        ),
        (
            "{\"hello\":\"lightmeter.protocol/1\",\"renderer\":\"r\",\"scenes\":[\"scene/teapto\"]}",
            2,
            "`scene/teapto` matches no scene; did you mean `scene/teapot`",
        ),
        ("{\"hello\":\"lightmeter.protocol/1\",\"renderer\":\"r\",\"formulas\":\"fog\"}", 4, "`formulas` is no list"),
    ] {
        let output = lightmeter(&["gate", "fog", "--exec", &format!("echo '{hello}'; sleep 600")]);
        assert_eq!(code(&output), status, "{}", stderr(&output));
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
    }
}

#[test]
fn all_is_asked_as_often_as_is_said() {
    let fault = "unstable-at=fog/exp/random/000003";
    let (status, found) = report(&process(&["fog/exp"], "", &["--runs", "3"]));
    assert_eq!((status, found["renderer"]["starts"].as_u64()), (0, Some(3)), "{found}");
    // An answer that is another each time, legal or not, is found by runs; a process of the same history gives the same.
    let flag = folder("runs").join("flag");
    let exec = format!(
        "if [ -e '{0}' ]; then exec {1} wrong-at=fog/exp/random/000009; else touch '{0}'; exec {1}; fi",
        text(&flag),
        renderer()
    );
    let (status, found) = report(&gate(&["fog/exp"], &exec, &["--runs", "2"]));
    assert!(status == 1 && found["unstable_cases"] == serde_json::json!(["fog/exp/random/000009"]), "{found}");
    let (status, found) = report(&process(&["fog/exp"], fault, &[]));
    assert_eq!((status, count(&found, "unstable")), (1, 1), "{found}");
}

#[test]
#[ignore = "long: ./x campaign long"]
fn blending_is_asked_on_every_target_that_is_declared() {
    let of = |fault: &str, more: &[&str]| {
        report(&process(&["blend/{add,min}/src-alpha", "blend/write-mask", "blend/layers"], fault, more))
    };
    let named = |found: &serde_json::Value, target: &str, words: &str| {
        let groups = found["groups"].as_array().expect("an array");
        let is_so = |group: &&serde_json::Value| group["target"] == target && group.to_string().contains(words);
        groups.iter().filter(is_so).count()
    };
    let (status, found) = of("targets=all", &[]);
    assert_eq!((status, count(&found, "failed"), count(&found, "missing")), (0, 0, 0), "{}", found["totals"]);
    for target in ["rgba32float", "rgba16float", "rgba8unorm", "rgba8unorm-srgb", "bgra8unorm"] {
        assert_eq!(named(&found, target, "\"asked\""), 4, "{target}");
    }
    // Each alias of MIN has cases of its own, and so has the state that all of them come to.
    let min = found["groups"]
        .as_array()
        .expect("an array")
        .iter()
        .find(|group| group["id"] == "blend/min" && group["target"] == "rgba8unorm");
    assert_eq!(min.and_then(|group| group["by_case"]["asked"].as_u64()), Some(16 * 64), "{min:?}");
    let (status, found) = of("targets=all blends-by=truncate", &[]);
    assert!(status == 1 && named(&found, "rgba8unorm", "stored truncated") >= 2, "{}", found["totals"]);
    let (status, found) = of("targets=all blends-by=times-256", &["--target", "rgba8unorm"]);
    assert!(status == 1 && named(&found, "rgba8unorm", "×256 for ×255") >= 2, "{}", found["totals"]);
    assert_eq!(named(&found, "bgra8unorm", ""), 0, "one target was asked for");
    let (status, found) = of("targets=all blends-by=factors-in-min", &[]);
    assert!(status == 1 && named(&found, "rgba16float", "multiplied by their factors") == 1, "{}", found["totals"]);
    let (status, found) = of("", &[]);
    assert!(status == 0 && named(&found, "rgba8unorm", "") == 0, "nothing was declared: {}", found["totals"]);
}

#[test]
fn a_process_that_fails_at_a_pixel_costs_that_pixel_alone() {
    let id = "blend/add/src-alpha/one/0003@rgba8unorm";
    for (fault, failed) in [("crash-at", 4), ("short-at", 1), ("nan-at", 1)] {
        let (status, found) = report(&process(&["blend/add/src-alpha/one"], &format!("targets=all {fault}={id}"), &[]));
        assert_eq!(
            (status, count(&found, "failed"), count(&found, "missing")),
            (failed, 1, 0),
            "{fault}: {}",
            found["totals"]
        );
        let failure = &found["failures"][0];
        assert_eq!(
            (&failure["id"], &failure["target"]),
            (&id.split('@').next().into(), &"rgba8unorm".into()),
            "{failure}"
        );
    }
}

#[test]
fn a_pixel_that_changes_is_unstable() {
    let id = "blend/add/src-alpha/one/0003@rgba8unorm";
    let state = ["blend/add/src-alpha/one"];
    // At each answer another value, and so at the end, when what failed is asked once more; and from the second start on.
    let flag = folder("unstable-pixel").join("flag");
    let (flag, renderer) = (text(&flag), renderer());
    let later = format!(
        "if [ -e '{flag}' ]; then exec {renderer} targets=all nan-at={id}; fi; touch '{flag}'; exec {renderer} targets=all"
    );
    for (exec, more) in [(command_of(&format!("targets=all unstable-at={id}")), &[][..]), (later, &["--runs", "2"])] {
        let (status, found) = report(&gate(&state, &exec, &[&["--target", "rgba8unorm"], more].concat()));
        assert_eq!((status, count(&found, "unstable")), (1, 1), "{more:?}: {}", found["totals"]);
        assert_eq!(found["unstable_cases"][0], "blend/add/src-alpha/one/0003 on rgba8unorm", "{found}");
    }
    let (status, found) = report(&process(&state, "targets=all", &["--runs", "2"]));
    assert_eq!((status, count(&found, "unstable")), (0, 0), "{}", found["totals"]);
}

#[test]
#[ignore = "long: ./x campaign long"]
fn declaring_fewer_targets_is_a_regression_in_any_part() {
    let baseline = folder("fewer-targets").join("baseline.json");
    let state = ["blend/add/src-alpha"];
    let of = |fault: &str, filter: &[&str], more: &[&str]| {
        report(&process(filter, fault, &[&["--baseline", text(&baseline)], more].concat())).0
    };
    assert_eq!(of("targets=all", &state, &["--update-baseline"]), 0);
    for (filter, more) in [(&state[..], &[][..]), (&state, &["--shard", "1/2"]), (&["blend/add/src-alpha/one"], &[])] {
        assert_eq!(of("targets=all", filter, more), 0, "{more:?}");
        assert_eq!(of("", filter, more), 1, "{more:?}");
    }
    assert_eq!(of("targets=all", &state, &["--target", "rgba8unorm"]), 0, "what is not asked for is not compared");
    // Another shard has other cases.
    assert_eq!(of("targets=all", &state, &["--shard", "1/2", "--update-baseline"]), 0);
    assert_eq!(of("targets=all", &state, &["--shard", "1/2"]), 0);
    assert_eq!(of("targets=all", &state, &["--shard", "2/2"]), 2);
    assert_eq!(of("targets=all", &state, &[]), 2);
}

#[test]
#[ignore = "long: ./x campaign long"]
fn crashes_that_are_expected_do_not_add_up() {
    let expected = folder("many-crashes").join("expected.toml");
    std::fs::write(&expected, "[[expected]]\nid = \"fog/exp\"\nreason = \"a trap\"\ncrash = true\n")
        .expect("it can be written");
    let (status, found) =
        report(&process(&["fog/exp", "fog/linear"], "crash-at=fog/exp", &["--expect", text(&expected)]));
    assert_eq!((status, count(&found, "missing")), (0, 0), "{}", found["totals"]);
    assert!(count(&found, "broken") > 100, "{}", found["totals"]);
}

#[test]
fn shards_of_a_gate_are_its_cases() {
    let whole = report(&process(&["fog"], "wrong-at=fog/exp/random/000017", &[])).1;
    let (mut asked, mut failed) = (0, 0);
    for shard in ["1/3", "2/3", "3/3"] {
        let (_, part) = report(&process(&["fog"], "wrong-at=fog/exp/random/000017", &["--shard", shard]));
        asked += count(&part, "asked");
        failed += count(&part, "failed");
    }
    assert_eq!((asked, failed), (count(&whole, "asked"), 1));
}
