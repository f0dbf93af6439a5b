//! What a renderer declares in its hello, and what follows from it.

use super::{answered, count, edit, folder, judged, text};
use crate::{code, command, lightmeter, stderr, stdout};
use std::io::Write as _;
use std::process::Stdio;

#[test]
fn what_the_first_line_does_not_declare_is_unknown() {
    let (pack, answers) = answered("undeclared", &["fog/exp", "fog/linear"]);
    let hello = "{\"renderer\": \"half\", \"formulas\": [\"fog/exp\"]}\n";
    let half = edit(&answers, |k, line| if k == 0 { hello } else { "" }.to_owned() + line + "\n");
    let (status, report) = judged(&pack, &half, &[]);
    assert!(status == 4 && report["renderer"]["problems"]["counts"]["unknown"].as_u64() > Some(60), "{report}");
    assert_eq!(count(&report, "passed"), count(&report, "asked"), "{report}");
    // A hello that is not the first line is told.
    let late = edit(&answers, |k, line| if k == 5 { hello } else { "" }.to_owned() + line + "\n");
    let (status, report) = judged(&pack, &late, &[]);
    assert!(status == 4 && report.to_string().contains("a hello, which is said once and first"), "{report}");
}

#[test]
fn a_hello_says_what_it_computes_on_and_what_it_leaves_out() {
    let (pack, answers) = answered("says-all", &["fog/exp", "fog/linear"]);
    let saying = |hello: &str| edit(&answers, |k, line| if k == 0 { hello } else { "" }.to_owned() + line + "\n");
    let hello = "{\"renderer\": \"r\", \"version\": \"2\", \"device\": \"GPU\", \"driver\": \"D 3\", \"formulas\": [\"fog\"], \
                 \"excludes\": [\"fog/{linear,exp2-*}\"]}\n";
    let file = saying(hello);
    let (_, report) = judged(&pack, &file, &[]);
    let renderer = &report["renderer"];
    assert!(renderer["device"] == "GPU" && renderer["driver"] == "D 3", "{renderer}");
    let groups = report["groups"].as_array().expect("an array");
    let ids: Vec<_> =
        groups.iter().filter(|group| group["by_case"]["asked"].as_u64() > Some(0)).map(|one| &one["id"]).collect();
    assert_eq!(ids, ["fog/exp"]);
    assert!(report.to_string().contains("it excludes it"), "{report}");
    let output = lightmeter(&["gate", text(&pack), text(&file)]);
    assert!(stdout(&output).starts_with("r 2 on GPU, D 3 · profile wgsl\n"), "{}", stdout(&output));
    for (entry, asked) in [
        ("function:fog_linear", vec!["fog/exp"]),
        ("file:fog.wgsl", vec![]),
        ("shape:mat4", vec!["fog/exp", "fog/linear"]),
        ("matrices:columns", vec!["fog/exp", "fog/linear"]),
        ("blend:min", vec!["fog/exp", "fog/linear"]),
        ("depth:less", vec!["fog/exp", "fog/linear"]),
        ("effect:fog_exp", vec!["fog/exp", "fog/linear"]),
    ] {
        let file = saying(&format!("{{\"renderer\": \"r\", \"formulas\": [\"fog\"], \"excludes\": [\"{entry}\"]}}\n"));
        let (_, report) = judged(&pack, &file, &[]);
        let groups = report["groups"].as_array().expect("an array");
        let has_cases = |group: &&serde_json::Value| group["by_case"]["asked"].as_u64() > Some(0);
        let mut ids: Vec<_> = groups.iter().filter(has_cases).filter_map(|one| one["id"].as_str()).collect();
        ids.sort_unstable();
        assert_eq!(ids, asked, "{entry}");
    }
    for (entry, said) in [
        ("shape:mat5", "names no shape; expected one of mat3, mat4, scalar, vec2, vec3, vec4"),
        ("function:fog_lin", "names no function; did you mean `fog_linear`"),
        (
            "of:fog",
            "names no kind of thing; expected one of function, file, shape, matrices, blend, depth, effect, format",
        ),
        ("format:rgb8", "names no format; expected one of bgra8unorm"),
    ] {
        let file = saying(&format!("{{\"renderer\": \"r\", \"formulas\": [\"fog\"], \"excludes\": [\"{entry}\"]}}\n"));
        let output = lightmeter(&["gate", text(&pack), text(&file)]);
        assert!(code(&output) == 2 && stderr(&output).contains(said), "{}", stderr(&output));
    }
    let misspelt = saying("{\"renderer\": \"r\", \"formulas\": [\"fog\"], \"excludes\": [\"fog/linaer\"]}\n");
    let output = lightmeter(&["gate", text(&pack), text(&misspelt)]);
    assert!(code(&output) == 2 && stderr(&output).contains("`fog/linear`"), "{}", stderr(&output));
}

#[test]
fn nothing_declared_is_nothing_judged() {
    let folder = folder("nothing");
    let (pack, _) = answered("nothing-pack", &["fog/exp"]);
    let answers = folder.join("answers.jsonl");
    std::fs::write(&answers, "{\"renderer\": \"none\", \"formulas\": []}\n").expect("it can be written");
    let output = lightmeter(&["gate", text(&pack), text(&answers)]);
    assert_eq!(code(&output), 3, "{}", stdout(&output));
    let mut child = command(&["gate", text(&pack), "/dev/stdin"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    child.stdin.take().expect("a pipe").write_all(b"").expect("it is read");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(code(&output), 1, "every case is missing: {}", stdout(&output));
}

#[test]
fn a_field_that_a_hello_does_not_have_is_refused_with_the_one_that_is_meant() {
    let (pack, answers) = answered("misspelt-field", &["fog/exp"]);
    for (hello, said) in [
        ("{\"renderer\": \"r\", \"exclude\": [\"fog/linear\"]}\n", "unknown field `exclude`; did you mean `excludes`?"),
        ("{\"renderer\": \"r\", \"formulae\": [\"fog\"]}\n", "unknown field `formulae`; did you mean `formulas`?"),
        ("{\"renderer\": \"r\", \"xyzzy\": 1}\n", "unknown field `xyzzy`; expected one of hello, renderer, version"),
    ] {
        let file = edit(&answers, |k, line| if k == 0 { hello } else { "" }.to_owned() + line + "\n");
        let output = lightmeter(&["gate", text(&pack), text(&file)]);
        assert!(code(&output) == 2 && stderr(&output).contains(said), "{}", stderr(&output));
    }
}

#[test]
fn annotations_and_the_report_name_the_file_and_line_that_a_hello_names() {
    let (pack, answers) = answered("sources", &["fog/exp", "fog/linear"]);
    let saying = |sources: &str| {
        let hello = format!("{{\"renderer\": \"r\", \"formulas\": [\"fog\"], \"sources\": {sources}}}\n");
        edit(&answers, |k, line| {
            let wrong = line.replacen("\"value\":[", "\"value\":[9", 1) + "\n";
            if k == 0 { hello.clone() + &wrong } else { wrong }
        })
    };
    let sources = "[{\"id\": \"fog/exp\", \"file\": \"src/a, b.glsl\", \"line\": 12}, {\"id\": \"fog\", \"file\": \"src/fog.glsl\"}]";
    let file = saying(sources);
    let (_, report) = judged(&pack, &file, &[]);
    let groups = report["groups"].as_array().expect("an array");
    let exp = groups.iter().find(|group| group["id"] == "fog/exp").expect("it was judged");
    assert_eq!(exp["source"].to_string(), "{\"file\":\"src/a, b.glsl\",\"line\":12}", "{report}");
    let output = stdout(&lightmeter(&["gate", text(&pack), text(&file), "--format", "github"]));
    assert!(output.contains("::error file=src/a%2C b.glsl,line=12,title=fog/exp::"), "{output}");
    assert!(output.contains("::error file=src/fog.glsl,title=fog/linear::"), "{output}");
    let output = stdout(&lightmeter(&["gate", text(&pack), text(&file), "--format", "junit"]));
    assert!(output.contains("file=\"src/a, b.glsl\"") && output.contains("line=\"12\""), "{output}");
    let output = stdout(&lightmeter(&["gate", text(&pack), text(&file), "--format", "html"]));
    assert!(output.contains(", src/a, b.glsl:12"), "{output}");
    let output = stdout(&lightmeter(&["gate", text(&pack), text(&file)]));
    assert!(output.contains("  source src/a, b.glsl:12\n") && output.contains("  source src/fog.glsl\n"), "{output}");
    for (sources, said) in [
        ("[{\"id\": \"fog/exq\", \"file\": \"a.c\"}]", "`fog/exq` matches no formula or scene; did you mean `fog/exp`"),
        ("[{\"id\": \"fog/exp\", \"file\": \"a.c\", \"line\": 0}]", "`line` is 0; expected 1 or more"),
        ("[{\"id\": \"fog/exp\", \"file\": \"\"}]", "`file` is empty; expected such as"),
    ] {
        let output = lightmeter(&["gate", text(&pack), text(&saying(sources))]);
        assert!(code(&output) == 2 && stderr(&output).contains(said), "{}", stderr(&output));
    }
}

#[test]
fn answers_that_do_not_say_which_pack_they_answer_are_warned_of() {
    let (pack, answers) = answered("of-which-pack", &["fog/exp"]);
    let manifest = std::fs::read_to_string(pack.join("manifest.json")).expect("there is a manifest");
    let manifest: serde_json::Value = serde_json::from_str(&manifest).expect("it is JSON");
    let own = manifest["pack"].as_str().expect("it has a name");
    let warned = |file: &std::path::Path| {
        let (status, report) = judged(&pack, file, &[]);
        let output = lightmeter(&["gate", text(&pack), text(file)]);
        assert_eq!((status, code(&output)), (0, 0), "{report}");
        let warnings = report["renderer"]["warnings"].as_array().cloned().unwrap_or_default();
        for (format, says) in [("text", "warning: "), ("junit", "which pack"), ("html", "which pack")] {
            let output = stdout(&lightmeter(&["gate", text(&pack), text(file), "--format", format]));
            assert_eq!(output.contains(says), !warnings.is_empty(), "{format}: {output}");
        }
        warnings
    };
    let warnings = warned(&answers);
    let said = warnings[0].as_str().unwrap_or_default();
    assert!(warnings.len() == 1 && said.contains("do not say which pack") && said.contains(own), "{warnings:?}");
    let hello = format!("{{\"renderer\": \"r\", \"formulas\": [\"fog\"], \"pack\": \"{own}\"}}\n");
    let file = edit(&answers, |k, line| if k == 0 { hello.clone() } else { String::new() } + line + "\n");
    assert_eq!(warned(&file), [serde_json::Value::Null; 0]);
    let other = edit(&file, |_, line| line.replace(own, "00000000") + "\n");
    let output = lightmeter(&["gate", text(&pack), text(&other)]);
    assert!(code(&output) == 2 && stderr(&output).contains(own), "{}", stderr(&output));
}

#[test]
fn a_line_may_skip_a_whole_formula() {
    let (pack, answers) = answered("skips-all", &["fog/exp", "fog/linear"]);
    let saying = |declared: &str| {
        let hello = format!(
            "{{\"renderer\": \"r\", \"formulas\": [\"fog\"]{declared}}}\n{{\"id\": \"fog/exp\", \"skip\": \"no fog\"}}\n"
        );
        edit(&answers, |k, line| {
            let line = if line.contains("fog/linear") { line.to_owned() + "\n" } else { String::new() };
            if k == 0 { hello.clone() + &line } else { line }
        })
    };
    let (status, report) = judged(&pack, &saying(", \"skips\": [{\"id\": \"fog/exp\", \"reason\": \"r\"}]"), &[]);
    let groups = report["groups"].as_array().expect("an array");
    let group = groups.iter().find(|group| group["id"] == "fog/exp").expect("it was asked");
    assert_eq!(
        (status, &group["by_case"]["skipped"], &group["by_case"]["reason"]),
        (0, &group["by_case"]["asked"], &"no fog".into()),
        "{report}"
    );
    let (status, report) = judged(&pack, &saying(""), &[]);
    assert!(status == 1 && count(&report, "undeclared") == count(&report, "skipped"), "{report}");
}

#[test]
fn an_error_is_told_once_and_says_what_would_be_right() {
    let (pack, answers) = answered("told-once", &["fog/exp"]);
    let folder = pack.with_file_name("told-once-answers");
    std::fs::create_dir_all(folder.join("columns/fog/exp")).expect("a folder can be made");
    std::fs::write(folder.join("columns/fog/exp/f.npy"), "no array").expect("it can be written");
    std::fs::write(folder.join("answers.jsonl"), "").expect("it can be written");
    let nowhere = pack.with_file_name("nowhere.jsonl");
    let file = |name: &str, hello: &str| {
        let path = pack.with_file_name(name);
        std::fs::write(&path, hello.to_owned() + "\n").expect("it can be written");
        path
    };
    for (given, said) in [
        (file("glob.jsonl", r#"{"renderer": "r", "formulas": ["fog/["]}"#), "is not a glob"),
        (file("target.jsonl", r#"{"renderer": "r", "targets": ["rgb"]}"#), "no target `rgb`; expected rgba32float"),
        (
            file("number.jsonl", r#"{"renderer": 5}"#),
            "line 1: the renderer said a hello in which `renderer` is no string; expected such as",
        ),
        (
            file("skip.jsonl", r#"{"renderer": "r", "skips": [{"id": "fog"}]}"#),
            "missing field `reason`; expected such as",
        ),
        (folder, "`color.npy` is missing; expected f.npy, color.npy"),
        (nowhere, "expected a file of JSON lines, or a folder with answers.jsonl"),
    ] {
        let output = lightmeter(&["gate", text(&pack), text(&given)]);
        let told = stderr(&output);
        assert!(code(&output) == 2 && told.matches(said).count() == 1, "`{said}`: {told}");
    }
    for (args, said) in [
        (&["merge", text(&answers)][..], "it is no result; expected the JSON that `run`, `gate` or `sweep` writes"),
        (&["gate", text(&pack), text(&answers), "--expect", "/nowhere"], "/nowhere: it cannot be read: No such file"),
    ] {
        let output = lightmeter(args);
        assert!(code(&output) == 2 && stderr(&output).contains(said), "{}", stderr(&output));
    }
}
