//! A run held against an earlier one, against known failures, and against itself.

use super::{code, edited, folder, gate, json, lightmeter, stderr, stdout};
use serde_json::Value;
use std::path::PathBuf;

/// A file of this test's own.
fn file(name: &str) -> PathBuf {
    folder(name).join(name)
}

/// A run of a few cases.
fn run(filter: &[&str], more: &[&str]) -> (i32, String, String) {
    let output = lightmeter(&[&["run", "--cases", "200"], filter, more].concat());
    (code(&output), stdout(&output), stderr(&output))
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_run_is_no_worse_than_its_baseline_or_says_where() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let baseline = file("run-baseline.json");
    let path = baseline.to_str().expect("the path is UTF-8");
    let wrong = edited("run-baseline-wrong", "vector.wgsl", |text| text.replace("return i - 2.0", "return i - 2.0001"));
    let wrong = wrong.to_str().expect("the path is UTF-8");
    let filter = ["vector/reflect", "fog/linear", "blend/add/one"];
    let (status, _, said) = run(&filter, &["--baseline", path, "--update-baseline"]);
    assert!(status == 0 && said.contains("is this result now"), "{said}");
    // The same cases, a filter of them, and each shard.
    for (filter, more) in
        [(&filter[..], &[][..]), (&["fog/linear"], &[]), (&filter, &["--shard", "1/3"]), (&filter, &["--shard", "3/3"])]
    {
        let (status, said, _) = run(filter, &[&["--baseline", path], more].concat());
        assert_eq!(status, 0, "{more:?}: {said}");
    }
    let (status, said, _) = run(&filter, &["--baseline", path, "--shaders", wrong]);
    assert!(status == 1 && said.contains("are worse than in the baseline"), "{said}");
    assert!(said.contains("vector/reflect on lavapipe, compute:") && said.contains("newly failed: "), "{said}");
    assert!(!said.contains("fog/linear on lavapipe, compute:"), "{said}");
    let (status, _, said) = run(&filter, &["--baseline", path, "--seed", "2"]);
    assert!(status == 2 && said.contains("seed 1 there, 2 here"), "{said}");
    // What is wrong in the baseline and right now is no regression.
    let (status, ..) = run(&["vector/reflect"], &["--baseline", path, "--update-baseline", "--shaders", wrong]);
    assert_eq!(status, 1);
    assert_eq!(run(&["vector/reflect"], &["--baseline", path]).0, 0);
}

#[test]
fn one_adapter_is_compared_with_another_where_that_is_asked_for() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let baseline = file("run-across.json");
    let path = baseline.to_str().expect("the path is UTF-8");
    let filter = ["vector/reflect", "color/modulate"];
    assert_eq!(run(&filter, &["--adapter", "cpu", "--baseline", path, "--update-baseline"]).0, 0);
    let (status, _, said) = run(&filter, &["--adapter", "lavapipe", "--baseline", path]);
    assert!(status == 2 && said.contains("is a result of cpu, and this is one of lavapipe"), "{said}");
    // lavapipe has a fragment stage besides, and a part of the cases is compared with that part.
    for filter in [&filter[..], &filter[..1]] {
        let more = ["--adapter", "lavapipe", "--baseline", path, "--across", "--growth", "1000", "--format", "json"];
        let (status, said, told) = run(filter, &more);
        assert_eq!(status, 0, "{told}{said}");
        let report: Value = serde_json::from_str(&said).expect("JSON");
        let added: Vec<&str> =
            report["added"].as_array().expect("the other stage").iter().filter_map(Value::as_str).collect();
        assert!(added.len() == filter.len() && added.iter().all(|one| one.contains("fragment")), "{added:?}");
    }
}

#[test]
fn what_is_no_result_of_a_run_is_no_baseline() {
    let baseline = file("run-no-baseline.json");
    let path = baseline.to_str().expect("the path is UTF-8");
    for (text, expected) in [
        ("", "cannot read"),
        ("{\"schema\": \"lightmeter.list/1\"}", "expected lightmeter.report/2"),
        ("{\"schema\": \"lightmeter.run/1\"}", "it is of an earlier version, `lightmeter.run/1`"),
        ("{\"schema\": \"lightmeter.report/3\"}", "it is of a later version, `lightmeter.report/3`"),
        ("{\"schema\": \"lightmeter.report/2\"}", "cannot read"),
    ] {
        std::fs::write(&baseline, text).expect("it can be written");
        let (status, _, said) = run(&["fog/linear"], &["--baseline", path]);
        assert!(status == 2 && said.contains(expected), "{text}: {said}");
    }
    // Whatever reads results says what a file of another version is.
    for (schema, expected) in [
        ("report/3", "of a later version"),
        ("run/1", "of an earlier version"),
        ("sweep/9", "of a later version"),
        ("bench/9", "of a later version"),
        ("selftest/9", "of a later version"),
    ] {
        std::fs::write(&baseline, format!("{{\"schema\": \"lightmeter.{schema}\"}}")).expect("it can be written");
        let is_of_shards = !(schema.starts_with("bench") || schema.starts_with("selftest"));
        let commands = [&["page", "report", path][..], &["merge", path, path]];
        for command in commands.into_iter().take(1 + usize::from(is_of_shards)) {
            let output = lightmeter(command);
            assert!(code(&output) == 2 && stderr(&output).contains(expected), "{command:?}: {}", stderr(&output));
        }
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_known_failure_is_expected_on_an_adapter_and_told_when_it_passes() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let expected = file("run-expected.toml");
    let path = expected.to_str().expect("the path is UTF-8");
    let wrong = edited("run-expected-wrong", "vector.wgsl", |text| text.replace("return i - 2.0", "return i + 2.0"));
    let wrong = wrong.to_str().expect("the path is UTF-8");
    let write = |id: &str| {
        let text = format!("[[expected]]\nid = \"{id}\"\nreason = \"a sign is lost\"\n");
        std::fs::write(&expected, text).expect("it can be written");
    };
    write("vector/reflect");
    let filter = ["vector/reflect", "fog/linear"];
    let (status, said, _) = run(&filter, &["--expect", path, "--shaders", wrong]);
    assert!(status == 0 && said.contains("fails as expected") && said.contains("a sign is lost"), "{said}");
    let report = json(
        &[&["run", "--cases", "200", "--format", "json"], &filter[..], &["--expect", path, "--shaders", wrong]]
            .concat(),
    );
    let of = |name: &str| report["totals"][name].as_u64();
    assert!(of("failed") == Some(0) && of("expected_failures") > Some(100), "{}", report["totals"]);
    let (status, said, _) = run(&filter, &["--expect", path]);
    assert!(status == 1 && said.contains("PASSES: take it out"), "{said}");
    write("vector/reflect/random/000003");
    let (status, said, _) = run(&filter, &["--expect", path, "--shaders", wrong]);
    assert!(status == 1 && said.contains("fails as expected"), "{said}");
    let on = |place: &str| {
        let text = format!("[[expected]]\nid = \"vector/reflect\"\nreason = \"a sign is lost\"\non = \"{place}\"\n");
        std::fs::write(&expected, text).expect("it can be written");
        run(&filter, &["--expect", path, "--shaders", wrong])
    };
    let (status, said, _) = on("compute");
    // The fragment stage fails as well, which nobody expects.
    assert!(status == 1 && said.contains("fails as expected") && said.contains("lavapipe, fragment"), "{said}");
    assert!(!said.contains("lavapipe, compute"), "{said}");
    let (status, _, said) = on("rgba9");
    assert!(status == 2 && said.contains("no stage and no target"), "{said}");
    write("vector/no-such");
    let (status, _, said) = run(&filter, &["--expect", path]);
    assert!(status == 2 && said.contains("matches no case"), "{said}");
}

#[test]
fn a_known_mistake_excuses_what_it_gives_and_no_other_mistake() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let attenuated = |text: &str| {
        let right = "return lighting_lit(light, material, at, highlight, lighting_attenuation(falloff, position, p));";
        let wrong = "let atten = lighting_attenuation(falloff, position, p);\n\
            let ambient = lighting_ambient(light.ambient, material.ambient);\n\
            let diffuse = light.diffuse * material.diffuse * lighting_incidence(at.l, at.n);\n\
            let specular = light.specular * material.specular * highlight;\n\
            return vec4f((ambient + diffuse + specular) * atten, 1.0);";
        let place = text.find("fn lighting_point_blinn(").expect("the function");
        text[..place].to_owned() + &text[place..].replacen(right, wrong, 1)
    };
    let one = edited("known-mistake", "lighting.wgsl", attenuated);
    let two = edited("known-mistake-and-another", "lighting.wgsl", |text| {
        let text = attenuated(text);
        let place = text.find("fn lighting_point_blinn(").expect("the function");
        let right = "lighting_highlight_blinn(at.n, at.l, at.v, material.shininess)";
        text[..place].to_owned()
            + &text[place..].replacen(right, "pow(max(dot(at.n, 0.5 * (at.l + at.v)), 0.0), material.shininess)", 1)
    });
    let expected = file("known-mistake.toml");
    let of = |shaders: &PathBuf, mistake: &str| {
        let entry =
            format!("[[expected]]\nid = \"lighting/point-blinn\"\nreason = \"as drawn\"\nmistake = {mistake}\n");
        let other = "[[expected]]\nid = \"fog\"\nreason = \"r\"\nrenderer = \"three.js\"\n";
        std::fs::write(&expected, entry + other).expect("it can be written");
        let [path, shaders] = [&expected, shaders].map(|path| path.to_str().expect("UTF-8"));
        run(&["lighting/point-blinn"], &["--adapter", "lavapipe", "--shaders", shaders, "--expect", path])
    };
    let known = "\"ambient-attenuated\"";
    let (status, said, _) = of(&one, known);
    assert!(status == 0 && said.contains("fails as expected"), "{said}");
    assert!(said.contains("1 expectation is of another renderer or version than this: `fog`"), "{said}");
    // Another mistake beside it fails, and both together are excused where both are known.
    let (status, said, _) = of(&two, known);
    assert!(status == 1 && said.contains("fails as expected") && said.contains("half-vector-as-mean"), "{said}");
    let (status, said, _) = of(&two, "[\"ambient-attenuated\", \"half-vector-as-mean\"]");
    assert!(status == 0, "{said}");
    let (status, said, _) = of(&one, "\"half-vector-as-mean\"");
    assert!(status == 1 && said.contains("IS MADE IN NO CASE"), "{said}");
    let (status, _, said) = of(&one, "\"ambient-atenuated\"");
    assert!(status == 2 && said.contains("did you mean `ambient-attenuated`"), "{said}");
}

#[test]
fn results_are_the_same_however_often_they_are_asked() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let report = json(&["run", "fog", "depth", "vector/halfway", "--cases", "100", "--runs", "3", "--format", "json"]);
    assert_eq!((report.get("unstable"), report["totals"]["failed"].as_u64()), (None, Some(0)), "{}", report["totals"]);
}

#[test]
fn failures_are_annotations_for_a_server() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let wrong = edited("run-github-wrong", "vector.wgsl", |text| text.replace("return i - 2.0", "return i + 2.0"));
    let wrong = wrong.to_str().expect("the path is UTF-8");
    let (status, said, _) = run(&["vector/reflect"], &["--shaders", wrong, "--format", "github"]);
    let lines: Vec<&str> = said.lines().collect();
    assert!(status == 1 && lines.len() >= 3, "{said}");
    assert!(
        lines.iter().all(|line| line.starts_with("::error title=") || line.starts_with("::notice title=")),
        "{said}"
    );
    assert!(lines[0].contains("vector/reflect") && lines[0].contains("lightmeter run"), "{said}");
}

#[test]
fn each_group_says_what_became_of_its_cases() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let report = json(&["run", "fog/linear", "blend/add/one/zero", "--cases", "100", "--format", "json"]);
    for group in report["groups"].as_array().expect("an array") {
        let counts = &group["by_case"];
        let count = |name: &str| counts[name].as_u64().unwrap_or_default();
        assert!(count("asked") >= 6 && count("asked") == count("passed"), "{group}");
        assert_eq!(counts["not_passed"], Value::Object(serde_json::Map::new()), "{group}");
    }
    assert_eq!(report["compared_by"]["choice"]["cases"], 100);
}

/// Two results, but for times, the command that made them, and what a sum over parts rounds in another way.
fn alike(mut a: Value, mut b: Value) -> (Value, Value) {
    for report in [&mut a, &mut b] {
        // Only `merge` warns that the shards may be of different builds.
        for name in ["seconds", "made_at", "timing", "command", "starts", "warnings"] {
            report.as_object_mut().expect("an object").remove(name);
            report["renderer"].as_object_mut().and_then(|renderer| renderer.remove(name));
        }
        for group in report["groups"].as_array_mut().expect("an array") {
            group.as_object_mut().expect("an object").remove("seconds");
            let counts = if group["by_case"].is_object() { &mut group["by_case"] } else { group };
            let mean = counts["error_mean"].as_f64().unwrap_or(f64::INFINITY);
            counts["error_mean"] = format!("{mean:.9e}").into();
        }
    }
    (a, b)
}

/// Where two results differ, by path.
fn differences(a: &Value, b: &Value, path: &str, out: &mut Vec<String>) {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            let names: std::collections::BTreeSet<&String> = a.keys().chain(b.keys()).collect();
            for name in names {
                let of = |object: &serde_json::Map<String, Value>| object.get(name).cloned().unwrap_or_default();
                differences(&of(a), &of(b), &format!("{path}/{name}"), out);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (k, (a, b)) in a.iter().zip(b).enumerate() {
                differences(a, b, &format!("{path}/{k}"), out);
            }
        }
        (a, b) if a != b => out.push(format!("{path}: {:.100} and {:.100}", a.to_string(), b.to_string())),
        _ => {}
    }
}

#[test]
fn shards_of_shaders_that_differ_in_their_text_alone_are_no_run() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let folder = file("merge-shaders");
    std::fs::create_dir_all(&folder).expect("the folder can be made");
    let shader = folder.join("fog.glsl");
    let judged = |text: &str, shard: &str| {
        let text = format!("float f(float density, float distance) {{ return {text}; }}");
        std::fs::write(&shader, text).expect("the file can be written");
        let out = folder.join(format!("{}.json", &shard[..1])).display().to_string();
        let function = format!("f@{}", shader.display());
        let command = ["run", "fog/exp", "--function", &function, "--cases", "64", "--format", "json"];
        lightmeter(&[&command[..], &["--shard", shard, "--out", &out]].concat());
        out
    };
    let first = judged("clamp(exp(-density * distance), 0.0, 1.0)", "1/2");
    let same = judged("clamp(exp(-density * distance), 0.0, 1.0)", "2/2");
    assert_eq!(code(&lightmeter(&["merge", &first, &same])), 0);
    let other = judged("clamp(exp2(-density * distance), 0.0, 1.0)", "2/2");
    let output = lightmeter(&["merge", &first, &other]);
    assert!(code(&output) == 2 && stderr(&output).contains("shaders_hash"), "{}", stderr(&output));
}

#[test]
#[ignore = "long: ./x campaign long"]
fn shards_of_a_run_and_of_a_gate_merge_into_the_whole() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let exec = gate::process::command_of("targets=all wrong-at=fog/exp/random/000017");
    let run =
        ["run", "fog", "blend/{min,max}/one", "depth", "special/nan", "vector/reflect", "scene/flat", "--size", "48"];
    let gate = ["gate", "fog", "blend/min/one/one", "vector/reflect", "scene/flat", "scene/phong", "--exec", &exec];
    for command in [&run[..], &gate[..]] {
        let command = [command, &["--cases", "90", "--format", "json"][..]].concat();
        let whole = json(&command);
        let parts = ["2/3", "1/3", "3/3"].map(|shard| {
            let path = file(&format!("merge-{}-{}.json", command[0], &shard[..1]));
            let out = path.to_str().expect("the path is UTF-8").to_owned();
            lightmeter(&[&command[..], &["--shard", shard, "--out", &out]].concat());
            out
        });
        let [a, b, c] = parts.each_ref().map(String::as_str);
        let merged = lightmeter(&["merge", a, b, c, "--format", "json"]);
        assert_eq!(code(&merged), i32::from(command[0] == "gate"), "{}", stderr(&merged));
        let (merged, whole) = alike(serde_json::from_slice(&merged.stdout).expect("it is JSON"), whole);
        let mut differing = vec![];
        differences(&merged, &whole, command[0], &mut differing);
        assert!(differing.is_empty(), "{:#?}", &differing[..differing.len().min(12)]);
        let told = lightmeter(&["merge", a, b, c, "--format", "github"]);
        assert_eq!(stdout(&told).starts_with("::error"), command[0] == "gate", "{}", stdout(&told));
        for (given, said) in [(&[a, b][..], "no result of shard 3/3"), (&[a, b, b], "overlap"), (&[], "required")] {
            let output = lightmeter(&[&["merge"], given].concat());
            assert!(code(&output) == 2 && stderr(&output).contains(said), "{}", stderr(&output));
        }
        let seed = file("merge-other-seed.json");
        let seed = seed.to_str().expect("the path is UTF-8");
        lightmeter(&[&command[..], &["--shard", "3/3", "--seed", "2", "--out", seed]].concat());
        let output = lightmeter(&["merge", a, b, seed]);
        assert!(code(&output) == 2 && stderr(&output).contains("different runs"), "{}", stderr(&output));
    }
}

#[test]
fn how_values_are_stored_is_told_of_all_shards_together() {
    let exec = gate::process::command_of("targets=all blends-by=times-256");
    let shard = |shard: &str, more: &[&str]| {
        let path = file(&format!("stores-{}-{}.json", &shard[..1], more.len()));
        let out = path.to_str().expect("the path is UTF-8").to_owned();
        let command =
            ["gate", "blend/add/src-alpha", "--exec", &exec, "--cases", "64", "--format", "json", "--out", &out];
        lightmeter(&[&command[..], &["--shard", shard], more].concat());
        out
    };
    let parts: Vec<String> = (1..=6).map(|k| shard(&format!("{k}/6"), &["--target", "rgba8unorm"])).collect();
    let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    let merged = lightmeter(&[&["merge"], &parts[..]].concat());
    assert!(code(&merged) == 1 && stdout(&merged).contains("×256 for ×255"), "{}", stdout(&merged));
    // A shard that was asked on another target does not belong to the same run.
    let other = shard("6/6", &["--target", "rgba32float", "--seed", "1"]);
    let output = lightmeter(&[&["merge"], &parts[..5], &[&other]].concat());
    assert!(code(&output) == 2 && stderr(&output).contains("different runs"), "{}", stderr(&output));
}

#[test]
fn an_expected_failure_of_another_shard_is_no_unexpected_pass() {
    let expected = file("shard-expected.toml");
    let text = "[[expected]]\nid = \"fog/exp\"\nreason = \"known\"\n";
    std::fs::write(&expected, text).expect("it can be written");
    let exec = gate::process::command_of("wrong-at=fog/exp/random/000003");
    let expected = expected.to_str().expect("the path is UTF-8");
    let shard = |shard: &str, exec: &str| {
        let path = file(&format!("shard-expected-{}.json", &shard[..1]));
        let out = path.to_str().expect("the path is UTF-8").to_owned();
        let command = ["gate", "fog/exp", "--exec", exec, "--cases", "8", "--expect", expected, "--format", "json"];
        (code(&lightmeter(&[&command[..], &["--shard", shard, "--out", &out]].concat())), out)
    };
    let (parts, status): (Vec<String>, Vec<i32>) =
        ["1/2", "2/2"].into_iter().map(|k| shard(k, &exec)).map(|(status, out)| (out, status)).unzip();
    assert_eq!(status, [0, 0]);
    assert_eq!(code(&lightmeter(&["merge", &parts[0], &parts[1]])), 0);
    let right = gate::process::command_of("");
    let parts = ["1/2", "2/2"].map(|k| shard(k, &right).1);
    assert_eq!(code(&lightmeter(&["merge", &parts[0], &parts[1]])), 1, "none fails in any shard");
}

#[test]
fn damaged_shards_make_no_whole_and_no_panic() {
    let exec = gate::process::command_of("");
    let parts = ["1/2", "2/2"].map(|shard| {
        let path = file(&format!("damaged-{}.json", &shard[..1]));
        let out = path.to_str().expect("the path is UTF-8");
        lightmeter(&[
            "gate", "fog/exp", "--exec", &exec, "--cases", "8", "--format", "json", "--shard", shard, "--out", out,
        ]);
        path
    });
    let right = std::fs::read_to_string(&parts[1]).expect("it was written");
    for (from, to) in [
        ("\"failed\":0", "\"failed\":1000000"),
        ("\"asked\":", "\"asked\":1844674407370955161"),
        ("2/2", "5/2"),
        ("2/2", "2/99999999999"),
        ("2/2", "0/2"),
    ] {
        assert!(right.contains(from), "{from} stands nowhere");
        std::fs::write(&parts[1], right.replace(from, to)).expect("it can be written");
        let [a, b] = parts.each_ref().map(|path| path.to_str().expect("the path is UTF-8"));
        let output = lightmeter(&["merge", a, b]);
        assert!(stderr(&output).len() < 2000 && [1, 2].contains(&code(&output)), "{from} as {to}: {}", stderr(&output));
    }
}
