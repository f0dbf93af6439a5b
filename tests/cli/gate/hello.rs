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
    assert!(status == 4 && report["problems"]["counts"]["unknown"].as_u64() > Some(60), "{report}");
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
    let ids: Vec<_> = groups.iter().filter(|group| group["asked"].as_u64() > Some(0)).map(|one| &one["id"]).collect();
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
        let has_cases = |group: &&serde_json::Value| group["asked"].as_u64() > Some(0);
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
