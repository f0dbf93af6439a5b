//! Files, lines and streams that nobody means well with: each is told with what is wrong with it, and no verdict is lost.

use super::gate::process::PASSES;
use super::gate::{answered, edit, folder};
use super::held::held;
use super::{code, command, eval, lightmeter, stderr, stdout};
use serde_json::Value;
use std::cell::RefCell;
use std::fs::File;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

/// What runs a command line of a shell, in which `$L` is the binary.
fn shell(line: &str) -> std::process::Output {
    let mut shell = Command::new("sh");
    shell.args(["-c", line]).env("L", env!("CARGO_BIN_EXE_lightmeter"));
    shell.output().expect("there is a shell")
}

/// Answers of which one is wrong.
fn wrong(test: &str) -> (String, String) {
    let (pack, answers) = answered(test, &["fog/exp"]);
    let spoil =
        |k: usize, line: &str| if k == 3 { line.replace("\"value\":[", "\"value\":[7") } else { line.into() } + "\n";
    let wrong = edit(&answers, spoil);
    (pack.display().to_string(), wrong.display().to_string())
}

#[test]
fn whoever_closes_an_output_changes_no_exit_code() {
    let (pack, answers) = wrong("closed");
    let given = format!("'{pack}' '{answers}'");
    for streams in ["| true", ">&-", ">/dev/full 2>&-", "2>/dev/full", ">/dev/full 2>/dev/full"] {
        let line = match streams {
            "| true" => format!("{{ $L gate {given}; echo $? >&2; }} 2>&1 >/dev/null {streams}"),
            _ => format!("$L gate {given} {streams}; echo $?"),
        };
        let output = match streams {
            // The exit code of what stands before a pipe.
            "| true" => Command::new("bash")
                .args(["-c", &format!("$L gate {given} | true; echo ${{PIPESTATUS[0]}}")])
                .env("L", env!("CARGO_BIN_EXE_lightmeter"))
                .output()
                .expect("there is a shell"),
            _ => shell(&line),
        };
        let said = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        // What could not be written is an error of its own.
        let expected: &[&str] = if streams.contains(">/dev/full 2") { &["2"] } else { &["1"] };
        let code = said.lines().last().unwrap_or_default();
        assert!(expected.contains(&code), "{streams}: {said}");
    }
    let output = shell("$L run frog 2>/dev/full; echo $?");
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "2");
}

#[test]
fn what_stood_in_a_file_stays_until_a_result_is_whole() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let folder = folder("whole");
    let file = folder.join("out.json");
    std::fs::write(&file, "before").expect("it can be written");
    let out = file.display().to_string();
    for args in [
        &["run", "frog", "--out", &out][..],
        &["gate", "/nowhere", "/nowhere/answers", "--out", &out],
        &["merge", "/dev/null", "--out", &out],
        &["page", "selftest", "/nowhere", "--out", &out],
    ] {
        assert_ne!(code(&lightmeter(args)), 0, "{args:?}");
        assert_eq!(std::fs::read_to_string(&file).expect("it is there"), "before", "{args:?}");
    }
    // What takes long says so before it begins.
    for command in [&["selftest"][..], &["sweep", "fog/exp"], &["special"], &["bench", "fog/exp"], &["run", "fog/exp"]]
    {
        refused(&[command, &["--out", "/nowhere/out.json"]].concat(), "cannot write /nowhere/out.json");
    }
    let fresh = folder.join("fresh.json");
    assert_ne!(code(&lightmeter(&["run", "frog", "--out", fresh.to_str().expect("UTF-8")])), 0);
    assert!(!fresh.exists(), "nothing was written");
    assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 1, "nothing is left beside it");
}

/// Ends with 2 and says something of the file, without waiting for it.
fn refused(args: &[&str], says: &str) {
    // The limit ends a test that fails.
    let args = [&["300", env!("CARGO_BIN_EXE_lightmeter")], args].concat();
    let output = Command::new("timeout").args(&args).stdin(Stdio::null()).output().expect("there is timeout");
    let said = stderr(&output);
    assert!(code(&output) == 2 && said.contains(says), "{args:?}: {said}");
}

#[test]
fn what_is_no_file_is_not_waited_for() {
    let folder = folder("no-file");
    let pipe = folder.join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("there is mkfifo").success());
    let (pack, answers) = answered("no-file-asked", &["fog/exp"]);
    let (pack, answers) = (pack.display().to_string(), answers.display().to_string());
    for given in ["/dev/zero", &pipe.display().to_string()] {
        let says = "it is a pipe or a device; expected a file";
        refused(&["gate", &pack, &answers, "--baseline", given], says);
        refused(&["gate", &pack, &answers, "--expect", given], says);
        refused(&["gate", &pack, given], says);
        refused(&["run", "fog/exp", "--adapter", "cpu", "--baseline", given], says);
        refused(&["merge", given], says);
        refused(&["page", "selftest", given], says);
        refused(&["effects", given], "cannot read");
        let shaders = folder.join("shaders");
        std::fs::create_dir_all(&shaders).expect("a folder can be made");
        let shader = shaders.join("fog.wgsl");
        let _ = std::fs::remove_file(&shader);
        std::os::unix::fs::symlink(given, &shader).expect("a link can be made");
        refused(&["run", "fog/exp", "--shaders", &shaders.display().to_string()], says);
    }
}

#[test]
fn what_is_too_long_is_not_read() {
    let folder = folder("long");
    let long = folder.join("long");
    // A file that has no blocks takes no room.
    File::create(&long).and_then(|file| file.set_len(1 << 34)).expect("it can be made");
    let shader = folder.join("fog.wgsl");
    File::create(&shader).and_then(|file| file.set_len(1 << 30)).expect("it can be made");
    let long = long.display().to_string();
    refused(&["merge", &long], "17179869184 bytes; expected at most 67108864");
    refused(&["run", "fog/exp", "--adapter", "cpu", "--baseline", &long], "17179869184 bytes; expected at most");
    refused(&["run", "fog/exp", "--adapter", "cpu", "--expect", &long], "17179869184 bytes; expected at most");
    let shaders = folder.display().to_string();
    refused(&["run", "fog/exp", "--shaders", &shaders], "1073741824 bytes; expected at most 4194304");
    refused(&["gate", "--exec", "cat", "fog/exp", "--cases", "1000000000"], "is not in 1..=10000000");
}

#[test]
fn a_baseline_that_says_what_cannot_be_is_refused() {
    let (pack, answers) = answered("baseline", &["fog/exp"]);
    let (pack, answers) = (pack.display().to_string(), answers.display().to_string());
    let output = lightmeter(&["gate", &pack, &answers, "--format", "json"]);
    let whole: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let file = folder("baseline-file").join("baseline.json");
    let with = |edit: &dyn Fn(&mut Value)| {
        let mut edited = whole.clone();
        edit(&mut edited);
        std::fs::write(&file, edited.to_string()).expect("it can be written");
        file.display().to_string()
    };
    for (edit, says) in [
        (
            &(|report: &mut Value| {
                report["groups"][0]["by_case"]["not_passed"]["failed"] = vec!["random/0..18446744073709551615"].into();
            }) as &dyn Fn(&mut Value),
            "cases did not pass of",
        ),
        (&|report: &mut Value| report["groups"] = Value::Array(vec![]), "it contains no results to compare with"),
        (&|report: &mut Value| report["groups"][0]["by_case"]["asked"] = 1.into(), "its totals count"),
        (
            &|report: &mut Value| {
                let again = report["groups"][0].clone();
                for sums in ["totals", "by_case"] {
                    for (_, count) in report[sums].as_object_mut().expect("counts") {
                        *count = (2 * count.as_u64().expect("a count")).into();
                    }
                }
                report["groups"].as_array_mut().expect("a list").push(again);
            },
            "fog/exp stands there twice",
        ),
    ] {
        let baseline = with(edit);
        refused(&["gate", &pack, &answers, "--baseline", &baseline], says);
    }
    let twice = whole.to_string().replacen("\"groups\":", "\"groups\":[],\"groups\":", 1);
    std::fs::write(&file, twice).expect("it can be written");
    let baseline = file.display().to_string();
    refused(&["gate", &pack, &answers, "--baseline", &baseline], "field `groups` stands there twice");
    // Words that are not ASCII, and controls, are words like others.
    let baseline = with(&|report| {
        report["groups"][0]["by_case"]["not_passed"]["failed"] = vec!["größer\u{1b}[2J..é\u{202e}"].into();
        report["groups"][0]["id"] = "\n::error::é".into();
    });
    let output = lightmeter(&["gate", &pack, &answers, "--baseline", &baseline]);
    let said = stdout(&output) + &stderr(&output);
    assert_ne!(code(&output), 0, "{said}");
    harmless(&said);
}

/// Nothing that a terminal or a server would obey.
fn harmless(said: &str) {
    assert!(!said.contains(['\u{1b}', '\u{202e}']), "{said}");
    let is_command = |line: &str| ["::", "##["].iter().any(|start| line.trim_start().starts_with(start));
    assert!(!said.lines().any(is_command), "{said}");
}

#[test]
fn words_of_others_command_no_terminal_and_no_server() {
    let hello = |fields: &str| {
        let hello = format!(r#"{{"hello": "lightmeter/1", {fields}}}"#);
        format!("printf '%s\\n' '{hello}'; while read -r line; do {PASSES}; done")
    };
    for fields in [
        r#""renderer": "::add-mask::x", "formulas": ["fog/exp"]"#,
        r###""renderer": "##[error]x", "version": "\u001b[31m1\u202e", "formulas": ["fog/exp"]"###,
        r#""renderer": "a", "formulas": ["fog/exp"], "profile": "x\n::error::y\u001b[2J""#,
        r#""renderer": "a", "formulas": ["fog/[\n::error::y"]"#,
        r#""renderer": "a", "formulas": ["fog/exp"], "effects": ["x\n::error::y"]"#,
        r#""renderer": "a\n::error::y", "formulas": ["\n::error::y"]"#,
    ] {
        let output = lightmeter(&["gate", "--exec", &hello(fields), "fog/exp", "--cases", "4", "--timeout", "2"]);
        let said = stdout(&output) + &stderr(&output);
        assert_ne!(code(&output), 0, "{fields}: {said}");
        harmless(&said);
    }
    let folder = folder("words");
    let scene = folder.join("scene.json");
    std::fs::write(&scene, "{\"title\": \"\\u001b[31m\\n::error::x\", \"\\n::error::y\": 1}")
        .expect("it can be written");
    for command in [&["effects"][..], &["render", "--out", "x.png"]] {
        let path = scene.display().to_string();
        let output = lightmeter(&[&command[..1], &[path.as_str()], &command[1..]].concat());
        let said = stdout(&output) + &stderr(&output);
        assert_eq!(code(&output), 2, "{said}");
        harmless(&said);
    }
}

#[test]
fn junit_of_hostile_words_is_xml() {
    let (pack, _) = answered("junit", &["fog/exp"]);
    let answers = folder("junit-answers").join("answers.jsonl");
    let text = "{\"renderer\": \"a\\ufffe\\uffff\\u0001\"}\n{\"id\": \"x\\ufffe\\u0007\", \"value\": [1]}\n";
    std::fs::write(&answers, text).expect("it can be written");
    let given = answers.display().to_string();
    let output = lightmeter(&["gate", &pack.display().to_string(), &given, "--format", "junit"]);
    let xml = stdout(&output);
    let is_of_xml = |c: char| matches!(c, '\t' | '\n' | '\r' | ' '..='\u{fffd}' | '\u{10000}'..);
    assert!(xml.starts_with("<?xml") && xml.chars().all(is_of_xml), "{xml}");
    assert!(!xml.contains("&#1;") && !xml.contains("&#xFFFE;"), "{xml}");
}

#[test]
fn a_line_that_cannot_be_answered_ends_nothing() {
    let line = |id: &str, inputs: &str| format!(r#"{{"id":{id},"formula":"fog/linear","inputs":{inputs}}}"#);
    let inputs = r#"{"p":[0,0,-5],"dmin":0,"dmax":10,"fog":[0,0,0],"shaded":[1,1,1]}"#;
    let twice = inputs.replace("\"dmin\":0", "\"dmin\":0,\"dmin\":1");
    let long = format!("\"{}\"", "x".repeat(2 << 20));
    let lines = [line("1", inputs), line("\"b\"", &twice), line(&long, inputs), line("4", "{}"), line("5", inputs)];
    let output = eval(&(lines.join("\n") + "\n"));
    assert_eq!(code(&output), 2);
    let answers: Vec<Value> = stdout(&output).lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let error = |k: usize| answers[k]["error"].as_str().unwrap_or_default().to_owned();
    assert_eq!(answers.len(), 5);
    assert!(answers[0]["value"].is_array() && answers[4]["value"].is_array());
    assert!(error(1).contains("line 2: not JSON: field `dmin` stands there twice"), "{}", error(1));
    assert!(error(2).contains("line 3: it has more than 1048576 bytes"), "{}", error(2));
    assert!(error(3).contains("line 4: field `inputs.p` is missing") && answers[3]["id"] == 4, "{}", error(3));
}

#[test]
#[cfg(unix)]
fn lines_are_refused_though_nobody_reads_that_and_a_line_without_end_ends() {
    let binary = env!("CARGO_BIN_EXE_lightmeter");
    let in_shell = |script: &str| {
        let output = std::process::Command::new("sh").args(["-c", script]).output().expect("a shell");
        stderr(&output)
    };
    // The output is closed before the first answer.
    let mut child = command(&["eval"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the binary starts");
    drop(child.stdout.take());
    let _ = child.stdin.take().expect("a pipe").write_all(b"bad\nbad\n");
    assert_eq!(child.wait().expect("it ends").code(), Some(2));
    // The limits end a test that fails.
    let told = in_shell(&format!("timeout 300 '{binary}' eval < /dev/zero; echo \"ends with $?\" >&2"));
    assert!(told.contains("a line of more than 67108864 bytes") && told.contains("ends with 2"), "{told}");
    // So does a renderer's first line.
    let told =
        in_shell(&format!("timeout 300 '{binary}' gate --exec 'cat /dev/zero' fog/exp; echo \"ends with $?\" >&2"));
    assert!(told.contains("a line without end") && told.contains("ends with 4"), "{told}");
}

#[test]
fn a_pack_that_was_killed_leaves_nothing_in_the_next_one() {
    let pack = folder("killed").join("pack");
    let path = pack.display().to_string();
    // Before the cases, before the first scene, among the scenes and after them.
    for file in [1, 2, 3, 20] {
        held(&["pack", &path, "scene/*", "fog/*", "--size", "64"], &format!("file:{file}")).kill();
        let output = lightmeter(&["pack", &path, "fog/exp", "--cases", "4"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let entries = std::fs::read_dir(&pack).expect("a folder").map(|entry| entry.expect("an entry"));
        // A file that was under way goes a minute later.
        let is_listed = |entry: &std::fs::DirEntry| !entry.file_name().to_string_lossy().starts_with(".lightmeter-");
        let is_file = |entry: &std::fs::DirEntry| entry.file_type().is_ok_and(|kind| kind.is_file());
        let mut names: Vec<_> = entries.filter(is_listed).filter(is_file).map(|entry| entry.file_name()).collect();
        names.sort();
        assert_eq!(names, ["cases.jsonl", "manifest.json"]);
        let in_folders = |folder: &Path| -> usize {
            let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"));
            entries.filter(|entry| !entry.file_name().to_string_lossy().starts_with(".lightmeter-")).count()
        };
        let folders = std::fs::read_dir(pack.join("scene")).into_iter().flatten().flatten();
        assert_eq!(folders.map(|scene| in_folders(&scene.path())).sum::<usize>(), 0, "files of scenes are left");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_path_need_not_be_utf_8() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = folder("path");
    let out = folder.join(std::ffi::OsStr::from_bytes(b"out-\xff.json"));
    let (pack, answers) = answered("path-asked", &["fog/exp"]);
    let [strange_pack, strange_answers, scene] = [&b"pack-\xff"[..], b"answers-\xff.jsonl", b"scene-\xff.json"]
        .map(|name| folder.join(std::ffi::OsStr::from_bytes(name)));
    std::fs::rename(&pack, &strange_pack).expect("it can be renamed");
    std::fs::rename(&answers, &strange_answers).expect("it can be renamed");
    let output = command(&["gate"]).args([&strange_pack, &strange_answers]).output().expect("the binary starts");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    std::fs::rename(&strange_pack, &pack).expect("it can be renamed");
    std::fs::rename(&strange_answers, &answers).expect("it can be renamed");
    let fog = Path::new(env!("CARGO_MANIFEST_DIR")).join("catalogue/scenes/fog-exp.json");
    std::fs::copy(fog, &scene).expect("it can be copied");
    let output = command(&["effects"]).arg(&scene).output().expect("the binary starts");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    for flag in ["--out", "--baseline"] {
        let mut gate = command(&["gate", &pack.display().to_string(), &answers.display().to_string()]);
        let output = gate.args(["--format", "json", flag]).arg(&out).output().expect("the binary starts");
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }
    assert!(Path::new(&out).metadata().expect("it is there").len() > 100);
}

#[test]
fn what_is_skipped_is_declared_or_fails() {
    let (pack, answers) = answered("skips", &["fog/exp", "vector/reflect"]);
    let skip = |line: &str| -> String {
        let found: Value = serde_json::from_str(line).expect("JSON");
        let id = found["id"].as_str().unwrap_or_default();
        if id.starts_with("fog/") {
            format!("{{\"id\": \"{id}\", \"skip\": \"no fog\"}}\n")
        } else {
            format!("{line}\n")
        }
    };
    let skipping = edit(&answers, |_, line| skip(line));
    let folder = folder("skips-expected");
    let file = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).expect("it can be written");
        path.display().to_string()
    };
    let declared = file("declared.toml", "[[skipped]]\nid = \"fog/exp\"\nreason = \"no fog\"\n");
    let others = file("others.toml", "[[skipped]]\nid = \"fog/linear\"\nreason = \"no fog\"\n");
    let everything = file("everything.toml", "[[skipped]]\nid = \"**\"\nreason = \"no time\"\n");
    let may_pass = file("may-pass.toml", "[[expected]]\nid = \"**\"\nreason = \"no time\"\nmay_pass = true\n");
    let (pack, skipping) = (pack.display().to_string(), skipping.display().to_string());
    for (options, status, said) in [
        (&[][..], 1, "skipped without having been declared: no fog"),
        (&["--expect", &others], 1, "skipped without having been declared"),
        (&["--expect", &declared, "--require", "0.1"], 0, " excluded"),
        (&["--expect", &declared, "--require", "0.99"], 1, "less than the part of 0.99 that is required"),
        (&["--expect", &everything], 2, "skipped[0] `**` matches everything"),
        (&["--expect", &may_pass], 2, "expected[0] `**` matches everything"),
        (&["--require", "1.5"], 2, "expected a part of 1"),
    ] {
        let output = lightmeter(&[&["gate", &pack, &skipping], options].concat());
        let told = stdout(&output) + &stderr(&output);
        assert_eq!(code(&output), status, "{options:?}: {told}");
        assert!(told.contains(said), "{options:?}: {told}");
    }
    // A hello that declares little leaves little to be judged.
    let hello = edit(&answers, |k, line| match k {
        0 => format!("{{\"renderer\": \"r\", \"formulas\": [\"fog/none\"]}}\n{line}\n"),
        _ => format!("{line}\n"),
    });
    let output = lightmeter(&["gate", &pack, &hello.display().to_string()]);
    assert_ne!(code(&output), 0, "{}", stdout(&output));
}

#[test]
fn a_skip_that_nothing_can_be_made_of_is_told() {
    let (pack, answers) = answered("skips-wrong", &["fog/exp", "vector/reflect"]);
    let (pack, all) = (pack.display().to_string(), answers.display().to_string());
    for (skip, said) in [
        (r#"{"id": "fog/exq", "reason": "typed wrongly"}"#, "skips `fog/exq`: it matches no case"),
        (r#"{"id": "fog/exp"}"#, "missing field `reason`"),
        ("3", "expected a skip such as"),
    ] {
        let hello = edit(&answers, |k, line| match k {
            0 => format!("{{\"renderer\": \"r\", \"formulas\": [\"**\"], \"skips\": [{skip}]}}\n{line}\n"),
            _ => format!("{line}\n"),
        });
        let output = lightmeter(&["gate", &pack, &hello.display().to_string()]);
        assert_ne!(code(&output), 0, "{skip}");
        assert!(stderr(&output).contains(said), "{skip}: {}", stderr(&output));
    }
    // A filter beside a pack, and a pack beside a command, are told as what they are.
    for (args, said) in [
        (&["gate", &pack, "fog/exp"][..], "`fog/exp` is a filter, and no file of answers"),
        (&["gate", &pack, &all, "--exec", "true"], "with --exec, all other arguments must be globs"),
    ] {
        let output = lightmeter(args);
        assert_eq!(code(&output), 2, "{args:?}");
        assert!(stderr(&output).contains(said), "{args:?}: {}", stderr(&output));
    }
}

#[test]
fn what_would_be_ignored_is_refused() {
    let (pack, answers) = answered("ignored", &["fog/exp"]);
    let (pack, answers) = (pack.display().to_string(), answers.display().to_string());
    for option in ["--seed", "--cases", "--size"] {
        refused(&["gate", &pack, &answers, option, "7"], &format!("`{option}` has no effect here"));
    }
    let folder = folder("another-renderer");
    let baseline = folder.join("baseline.json").display().to_string();
    let made = lightmeter(&["gate", &pack, &answers, "--baseline", &baseline, "--update-baseline"]);
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    let text = std::fs::read_to_string(&baseline).expect("it is there");
    let mut changed: Value = serde_json::from_str(&text).expect("JSON");
    changed["renderer"]["name"] = "another".into();
    std::fs::write(&baseline, changed.to_string()).expect("it can be written");
    refused(&["gate", &pack, &answers, "--baseline", &baseline], "is a result of another, and this is one of ");
}

#[test]
fn an_unfinished_sweep_is_no_success() {
    let checkpoint = folder("unfinished").join("sweep.json").display().to_string();
    let sweep = [
        "sweep",
        "fog/exp",
        "--over",
        "p.z",
        "--from",
        "-2",
        "--to",
        "-1",
        "--adapter",
        "cpu",
        "--checkpoint",
        &checkpoint,
    ];
    let output = lightmeter(&[&sweep[..], &["--blocks", "2"]].concat());
    let told = stdout(&output);
    assert!(!told.contains('✓') && told.contains("so far: 2 of "), "{told}");
}

#[test]
fn shaders_that_end_whoever_reads_them_are_refused() {
    let folder = folder("deep");
    let right = include_str!("../../gpu/src/shaders/fog.wgsl");
    let first = "fn fog_exp_factor(";
    assert!(right.contains(first), "the formula is where it was");
    let chain: String = (0..20_000).map(|k| format!("else if (x == {k}.0) {{ y = {k}.0; }}\n")).collect();
    let terms = vec!["x"; 100_000].join(" + ");
    let rows = [
        (
            "chain",
            format!("fn deep(x: f32) -> f32 {{ var y = 0.0; if (x < 0.0) {{ y = 1.0; }}\n{chain} return y; }}\n"),
        ),
        ("terms", format!("fn deep(x: f32) -> f32 {{ return {terms}; }}\n")),
        ("braces", format!("fn deep(x: f32) -> f32 {{ {} {} return x; }}\n", "{".repeat(50_000), "}".repeat(50_000))),
    ];
    for (name, function) in rows {
        let shaders = folder.join(name);
        std::fs::create_dir_all(&shaders).expect("a folder can be made");
        std::fs::write(shaders.join("fog.wgsl"), right.replace(first, &format!("{function}\n{first}")))
            .expect("it can be written");
        for command in ["run", "sweep", "show"] {
            let args = [command, if command == "show" { "fog/exp/random/000001" } else { "fog/exp" }, "--shaders"];
            let output = lightmeter(&[&args[..], &[&shaders.display().to_string()]].concat());
            let said = stderr(&output);
            assert_eq!(code(&output), 2, "{name}: {said}");
            assert!(said.contains("fog.wgsl"), "{name}: {said}");
            assert!(said.lines().all(|line| line.chars().count() < 700), "{name}: {} bytes are said", said.len());
        }
    }
}

/// Numbers that look random, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).expect("31 bits") % bound
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn any_wrong_number_of_an_answer_fails() {
    let (pack, answers) = answered("any-number", &["fog/linear", "fog/exp", "vector/reflect", "color/modulate"]);
    let pack = pack.display().to_string();
    let count = std::fs::read_to_string(&answers).expect("there are answers").lines().count();
    let mut numbers = Numbers(7);
    for _ in 0..60 {
        let (chosen, place) = (numbers.below(count), numbers.below(64));
        let changed = RefCell::new(String::new());
        let wrong = edit(&answers, |k, line| {
            let mut answer: Value = serde_json::from_str(line).expect("JSON");
            if k == chosen
                && let Some(values) = answer["value"].as_array_mut()
            {
                let place = place % values.len();
                let before = values[place].as_f64().unwrap_or_default();
                values[place] = (before + before.abs().max(1.0)).into();
                changed.replace(answer.to_string());
            }
            format!("{answer}\n")
        });
        let output = lightmeter(&["gate", &pack, &wrong.display().to_string()]);
        // Of some hard cases nothing is promised: any number is legal there.
        let changed = changed.into_inner();
        let permits_anything = changed.contains("/hard/");
        assert!(code(&output) == 1 || permits_anything && code(&output) == 0, "{changed}: {}", stdout(&output));
    }
}

#[test]
fn any_cut_of_a_file_is_told() {
    let (pack, answers) = answered("cut", &["fog/exp"]);
    let folder = folder("cut-files");
    let place = |name: &str| folder.join(name).display().to_string();
    let (pack, answers) = (pack.display().to_string(), answers.display().to_string());
    let (baseline, checkpoint, scene) = (place("baseline.json"), place("sweep.json"), place("scene.json"));
    let shards = ["1/2", "2/2"].map(|shard| {
        let out = place(&format!("{}.json", &shard[..1]));
        let args = ["run", "fog/exp", "--adapter", "cpu", "--cases", "64", "--format", "json", "--shard", shard];
        assert_eq!(code(&lightmeter(&[&args[..], &["--out", &out]].concat())), 0);
        out
    });
    assert_eq!(code(&lightmeter(&["gate", &pack, &answers, "--baseline", &baseline, "--update-baseline"])), 0);
    let sweep = ["sweep", "fog/exp", "--over", "p.z", "--from", "-2", "--to", "-1", "--adapter", "cpu", "--checkpoint"];
    assert_eq!(code(&lightmeter(&[&sweep[..], &[&checkpoint, "--blocks", "2"]].concat())), 1);
    let written =
        lightmeter::scene::library::SCENES.iter().find(|(name, _)| *name == "fixed-color").expect("it is built in");
    std::fs::write(&scene, written.1).expect("it can be written");
    let manifest = Path::new(&pack).join("manifest.json").display().to_string();
    let cases = Path::new(&pack).join("cases.jsonl").display().to_string();
    let gate = vec!["gate", &pack, &answers];
    for (file, command) in [
        (&manifest, gate.clone()),
        (&cases, gate.clone()),
        (&answers, gate.clone()),
        (&baseline, [&gate[..], &["--baseline", &baseline]].concat()),
        (&shards[0], vec!["merge", &shards[0], &shards[1]]),
        (&checkpoint, [&sweep[..], &[&checkpoint, "--blocks", "1"]].concat()),
        (&scene, vec!["effects", &scene]),
    ] {
        let whole = std::fs::read(file).expect("it is there");
        let output = lightmeter(&command);
        // A sweep that is not finished ends with 1, and one whose file is cut with another code.
        let as_it_was = i32::from(command[0] == "sweep");
        assert_eq!(code(&output), as_it_was, "{command:?}: {}", stderr(&output));
        // The last byte is the end of a line.
        for part in 1..=12 {
            let end = (whole.len() - 2) * part / 12;
            std::fs::write(file, &whole[..end]).expect("it can be written");
            let output = lightmeter(&command);
            assert!(code(&output) > as_it_was, "{command:?} with {end} of {} bytes of {file}", whole.len());
            let said = stdout(&output) + &stderr(&output);
            assert!(!said.contains("panicked") && !said.trim().is_empty(), "{command:?}: {said}");
        }
        std::fs::write(file, &whole).expect("it can be written");
    }
}
