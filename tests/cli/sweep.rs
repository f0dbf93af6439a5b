//! `lightmeter sweep` and `merge`: what they find, how they go on, and what they refuse.

use super::held::{Held, held};
use super::{code, command, edited, folder, json, lightmeter, stderr, stdout};
use serde_json::Value;

fn read(path: &str) -> Value {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A result without what a clock says and what follows from it.
fn but_for_times(mut result: Value) -> Value {
    let fields = result.as_object_mut().expect("a result is an object");
    fields.remove("seconds").expect("it says how long it took");
    fields.remove("made_at").expect("it says when it was made");
    fields.remove("checksum").expect("it has a checksum");
    fields.remove("command").expect("it has its command");
    result
}

/// A short sweep: 1,048,577 floats in 64 blocks and one more.
const SHORT: &[&str] = &["sweep", "fog/exp", "--from", "1", "--to", "1.125", "--format", "json"];

fn short<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [SHORT, more].concat()
}

#[test]
fn every_float_of_a_range_is_judged_and_counted() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let result = json(SHORT);
    let found = &result["statistics"];
    assert_eq!(result["schema"], "lightmeter.sweep/1");
    assert_eq!(
        (&found["inputs"], &found["passed"], &found["failed"]),
        (&1_048_577.into(), &1_048_577.into(), &0.into())
    );
    let counted: u64 =
        found["histogram"].as_object().expect("an object").values().map(|count| count.as_u64().unwrap_or(0)).sum();
    assert_eq!(counted, 1_048_577);
    let worst = &found["worst"];
    assert!(worst["error"].as_f64().is_some_and(|error| error > 0.5), "{worst}");
    // The worst input by itself gives the same verdict.
    let bits = worst["input"]["bits"].as_str().expect("bits");
    let alone = json(&["sweep", "fog/exp", "--from", bits, "--to", bits, "--format", "json"]);
    assert_eq!(alone["statistics"]["inputs"], 1);
    assert_eq!(&alone["statistics"]["worst"], worst);
}

#[test]
fn the_text_has_the_worst_input_the_histogram_and_a_command_for_one_input() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let output = lightmeter(&["sweep", "fog/exp2-opengl", "--from", "10", "--to", "11", "--set", "density=0.02"]);
    let text = stdout(&output);
    assert_eq!(code(&output), 0, "{text}");
    for part in
        ["fog/exp2-opengl: f = clamp", "density 0.02,", "every p.z from 10 to 11: 1,048,577 floats", "█", "✓ 0 of"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    let again = text.lines().find_map(|line| line.trim().strip_prefix("again      lightmeter ")).expect("a command");
    let alone = lightmeter(&again.split_whitespace().collect::<Vec<_>>());
    assert!(stdout(&alone).contains("1 inputs in") && code(&alone) == 0, "{again}: {}", stdout(&alone));
}

#[test]
#[ignore = "long: ./x campaign long"]
fn every_ready_made_sweep_runs_in_every_stage_it_has() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let listed = json(&["sweep", "--format", "json"]);
    let presets = listed["presets"].as_array().expect("an array");
    assert_eq!(presets.len(), 13);
    for preset in presets {
        let formula = preset["formula"].as_str().expect("an id");
        // A shard of one block, near the end of the range.
        let (stages, shard): (&[&str], &str) = if formula.starts_with("blend") {
            (&["fixed-function"], "64/64")
        } else {
            (&["compute", "fragment"], "250/250")
        };
        for adapter in ["lavapipe", "cpu"] {
            for stage in stages {
                let args = ["sweep", formula, "--adapter", adapter, "--stage", stage, "--format", "json"];
                let output = lightmeter(&[&args[..], &["--shard", shard]].concat());
                let result: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
                assert_eq!(code(&output), 0, "{formula} {adapter} {stage}: {}", stderr(&output));
                assert!(result["statistics"]["passed"].as_u64() > Some(1 << 17), "{formula} {adapter} {stage}");
            }
        }
    }
}

#[test]
fn a_mistake_in_a_shader_is_seen_with_its_first_inputs() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("sweep-mistake", "fog.wgsl", |text| {
        let wrong = text.replace("exp(-(density * distance))", "exp(-(density * distance) * 1.001)");
        assert_ne!(wrong, text);
        wrong
    });
    let dir = dir.to_string_lossy();
    let output = lightmeter(&short(&["--shaders", &dir]));
    let result: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(code(&output), 1);
    assert_eq!(result["statistics"]["failed"], 1_048_577);
    assert_eq!(result["statistics"]["failures"].as_array().map(Vec::len), Some(5));
    assert_eq!(result["statistics"]["failures"][0]["input"]["bits"], "0x3f800000");
    let text = stdout(&lightmeter(&["sweep", "fog/exp", "--from", "1", "--to", "1", "--shaders", &dir]));
    assert!(
        text.contains("FAIL") && text.contains(&format!("--shaders '{dir}'")) && text.contains("✗ 1 of 1"),
        "{text}"
    );
}

#[test]
fn one_wrong_float_among_a_million_is_found() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("sweep-one", "fog.wgsl", |text| {
        let right = "return clamp(exp(-(density * distance)), 0.0, 1.0);";
        let wrong = format!("if bitcast<u32>(distance) == 0x3f812345u {{ return 0.5; }}\n    {right}");
        assert!(text.contains(right));
        text.replace(right, &wrong)
    });
    for stage in ["compute", "fragment"] {
        let output = lightmeter(&short(&["--shaders", &dir.to_string_lossy(), "--stage", stage]));
        let result: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!((code(&output), &result["statistics"]["failed"]), (1, &1.into()), "{stage}");
        assert_eq!(result["statistics"]["worst"]["input"]["bits"], "0x3f812345", "{stage}");
        // What is beyond its limit is not called near to it.
        let file = dir.join(format!("beyond-{stage}.json")).to_string_lossy().into_owned();
        std::fs::write(&file, &output.stdout).expect("it can be written");
        let page = stdout(&lightmeter(&["page", "sweep", &file]));
        assert!(page.contains("Farthest beyond its limit: at") && !page.contains("Nearest to its limit"), "{page}");
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn nan_and_what_is_never_written_are_told() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let nan = edited("sweep-nan", "fog.wgsl", |text| {
        text.replace(
            "clamp(exp(-(density * distance)), 0.0, 1.0)",
            "bitcast<f32>(0x7fc00000u | bitcast<u32>(distance))",
        )
    });
    let result = json(&short(&["--shaders", &nan.to_string_lossy()]));
    assert_eq!(result["statistics"]["histogram"]["NaN"], 1_048_577, "{result}");
    let unwritten = edited("sweep-unwritten", "fog.wgsl", |text| {
        text.replace(
            "clamp(exp(-(density * distance)), 0.0, 1.0)",
            "bitcast<f32>(0x7fc5e171u | (bitcast<u32>(distance) & 0u))",
        )
    });
    let text = stdout(&lightmeter(&[
        "sweep",
        "fog/exp",
        "--from",
        "1",
        "--to",
        "2",
        "--shaders",
        &unwritten.to_string_lossy(),
    ]));
    assert!(text.contains("never written"), "{text}");
}

#[test]
fn both_zeros_and_both_signs_are_visited() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let result =
        json(&["sweep", "color/replace", "--over", "texel.r", "--from", "-1e-44", "--to", "1e-44", "--format", "json"]);
    // Seven subnormals of each sign, and both zeros.
    assert_eq!(result["statistics"]["inputs"], 16);
    assert_eq!(result["statistics"]["histogram"]["exact"], 16);
}

#[test]
fn a_blend_mode_is_judged_over_every_byte_and_its_store_identified() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let result = json(&["sweep", "blend/mode-alpha", "--shard", "2/4", "--format", "json"]);
    let found = &result["statistics"];
    assert_eq!((&found["inputs"], &found["failed"]), (&(1 << 22).into(), &0.into()));
    let tiers = found["stored"]["tiers"].as_object().expect("tiers");
    assert_eq!(tiers.values().map(|count| count.as_u64().unwrap_or(0)).sum::<u64>(), 1 << 22);
    assert_eq!((&found["stored"]["predicted"], &found["stored"]["departing"]), (&(1 << 22).into(), &0.into()));
    let dir = edited("sweep-blend", "blend_unit.wgsl", |text| {
        let wrong = text.replace("return colored.color;", "return vec4f(colored.color.rgb, 0.9 * colored.color.a);");
        assert_ne!(wrong, text);
        wrong
    });
    let output = lightmeter(&["sweep", "blend/mode-alpha", "--shard", "64/64", "--shaders", &dir.to_string_lossy()]);
    let text = stdout(&output);
    assert!(code(&output) == 1 && text.contains("alpha 252/255") && text.contains("FAIL"), "{text}");
}

#[test]
fn the_arithmetic_of_a_blend_state_is_swept_too() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let args = ["sweep", "blend/add/src-alpha/one-minus-src-alpha", "--over", "src.a", "--from", "0.5", "--to", "1"];
    let result = json(&[&args[..], &["--format", "json"]].concat());
    assert_eq!((&result["statistics"]["inputs"], &result["statistics"]["failed"]), (&8_388_609.into(), &0.into()));
}

#[test]
fn what_is_done_in_parts_is_the_same_as_at_once() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = folder("sweep-parts");
    let checkpoint = dir.join("parts.json").to_string_lossy().into_owned();
    let once = json(SHORT);
    let parts = short(&["--checkpoint", &checkpoint, "--blocks", "30"]);
    let first = lightmeter(&parts);
    assert_eq!(code(&first), 1, "what is not finished is not green");
    assert!(stderr(&first).contains("not finished"), "{}", stderr(&first));
    assert_eq!(read(&checkpoint)["done"], 30);
    for (done, status) in [(60, 1), (65, 0)] {
        assert_eq!(code(&lightmeter(&parts)), status);
        assert_eq!(read(&checkpoint)["done"], done);
    }
    assert_eq!(but_for_times(read(&checkpoint)), but_for_times(once.clone()));
    // Nothing of a finished one is judged again.
    assert_eq!(but_for_times(json(&parts)), but_for_times(once));
    let (again, events) = Held::watch(&mut command(&parts)).ended();
    assert!(code(&again) == 0 && !events.contains(&"block".to_owned()), "{events:?} {}", stderr(&again));
}

#[test]
fn a_killed_sweep_goes_on_where_it_was() {
    let dir = folder("sweep-killed");
    let checkpoint = dir.join("killed.json").to_string_lossy().into_owned();
    // The checkpoint is written after the first block.
    let args = ["sweep", "color/srgb-encode", "--shard", "2/2", "--adapter", "cpu", "--format", "json"];
    let args = [&args[..], &["--checkpoint", &checkpoint]].concat();
    held(&args, "saved:1").kill();
    let before = read(&checkpoint)["done"].as_u64().expect("a count");
    let blocks = read(&checkpoint)["blocks"].as_u64().expect("a count");
    assert!(before > 0 && before < blocks, "{before} of {blocks}");
    // A few blocks further, and the same few blocks of a sweep that was never interrupted.
    let further = [&args[..], &["--blocks", "3"]].concat();
    assert_eq!(code(&lightmeter(&further)), 1);
    let resumed = read(&checkpoint);
    assert_eq!(resumed["done"].as_u64(), Some(before + 3));
    let whole = dir.join("whole.json").to_string_lossy().into_owned();
    let count = (before + 3).to_string();
    let args = [
        "sweep",
        "color/srgb-encode",
        "--shard",
        "2/2",
        "--adapter",
        "cpu",
        "--checkpoint",
        &whole,
        "--blocks",
        &count,
    ];
    assert_eq!(code(&lightmeter(&args)), 1);
    assert_eq!(but_for_times(resumed), but_for_times(read(&whole)));
}

#[test]
fn shards_come_together_to_the_whole() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = folder("sweep-shards");
    let place = |name: &str| dir.join(name).to_string_lossy().into_owned();
    let paths: Vec<String> = (1..=3).map(|index| place(&format!("{index}.json"))).collect();
    for (index, path) in (1..).zip(&paths) {
        let shard = format!("{index}/3");
        assert_eq!(code(&lightmeter(&short(&["--shard", &shard, "--out", path]))), 0);
    }
    let [a, b, c] = [&paths[0], &paths[1], &paths[2]].map(String::as_str);
    let merged = json(&["merge", c, a, b, "--format", "json"]);
    assert_eq!(but_for_times(merged), but_for_times(json(SHORT)));

    let text = stdout(&lightmeter(&["merge", a, b, c]));
    let again = text.lines().find_map(|line| line.trim().strip_prefix("again      lightmeter ")).expect("a command");
    let alone = lightmeter(&again.split_whitespace().collect::<Vec<_>>());
    assert!(stdout(&alone).contains("1 inputs in") && code(&alone) == 0, "{again}: {}", stderr(&alone));

    let refused = |args: &[&str], says: &[&str]| {
        let output = lightmeter(&[&["merge"], args].concat());
        let message = stderr(&output);
        assert_eq!(code(&output), 2, "{args:?}: {message}");
        says.iter().for_each(|part| assert!(message.contains(part), "{part}: {message}"));
    };
    refused(&[a, c], &["no result of shard 2/3"]);
    refused(&[a, b, c, b], &["overlap", "both are shard 2/3"]);
    let halved = place("half.json");
    lightmeter(&short(&["--shard", "1/2", "--out", &halved]));
    refused(&[a, &halved], &["1/3", "1/2", "overlap"]);
    let other = place("other.json");
    lightmeter(&short(&["--shard", "2/3", "--set", "density=0.02", "--out", &other]));
    refused(&[a, &other], &["different sweeps", "density is 0.01", "0.02"]);
    let embedded = place("embedded.json");
    lightmeter(&short(&["--shard", "2/3", "--adapter", "cpu", "--out", &embedded]));
    refused(&[a, &embedded], &["adapter is lavapipe", "cpu"]);
    let dir = edited("sweep-merge", "fog.wgsl", |text| format!("{text}\n// changed\n"));
    let changed = place("changed.json");
    lightmeter(&short(&["--shard", "2/3", "--shaders", &dir.to_string_lossy(), "--out", &changed]));
    refused(&[a, &changed], &["the shader's text is"]);
    let part = place("part.json");
    lightmeter(&short(&["--shard", "2/3", "--checkpoint", &part, "--blocks", "2"]));
    refused(&[a, &part, c], &["part.json is not finished: 2 of 22 blocks"]);
    refused(&["no-such-file.json"], &["cannot read no-such-file.json"]);
}

#[test]
fn a_damaged_checkpoint_is_refused_with_its_path_and_what_to_do() {
    let dir = folder("sweep-damaged");
    let place = dir.join("damaged.json");
    let path = place.to_string_lossy().into_owned();
    let args = short(&["--adapter", "cpu", "--checkpoint", &path]);
    assert_eq!(code(&lightmeter(&[&args[..], &["--blocks", "2"]].concat())), 1);
    let good = std::fs::read_to_string(&place).expect("a checkpoint");
    let damages = [
        ("truncated", good[..good.len() / 2].to_owned(), "not JSON"),
        ("empty", String::new(), "not JSON"),
        (
            "another schema",
            good.replace("lightmeter.sweep/1", "lightmeter.sweep/9"),
            "it is of a later version, `lightmeter.sweep/9`",
        ),
        ("another count", good.replace("\"done\": 2", "\"done\": 3"), "its checksum does not hold"),
        ("a field gone", good.replace("\"seconds\"", "\"minutes\""), "minutes"),
    ];
    for (name, text, says) in damages {
        assert_ne!(text, good, "{name}");
        std::fs::write(&place, &text).expect("it can be damaged");
        let output = lightmeter(&args);
        let message = stderr(&output);
        assert_eq!(code(&output), 2, "{name}: {message}");
        for part in [says, "damaged.json is damaged", "delete it to start again"] {
            assert!(message.contains(part), "{name}: {part}: {message}");
        }
        assert_eq!(std::fs::read_to_string(&place).expect("it is there"), text, "{name}: it stays as it was");
    }
    std::fs::write(&place, &good).expect("it can be written");
    let output = lightmeter(&[&args[..], &["--set", "density=0.5"]].concat());
    let message = stderr(&output);
    assert_eq!(code(&output), 2, "{message}");
    for part in ["is of another sweep", "density is 0.01", "0.5", "delete it to start again"] {
        assert!(message.contains(part), "{part}: {message}");
    }
    let output = lightmeter(&[&args[..], &["--shard", "1/2"]].concat());
    assert!(code(&output) == 2 && stderr(&output).contains("shard is 1/1 there and 1/2 here"));
}

/// What is asked for, and what the message says.
const REFUSED: &[(&[&str], &str)] = &[
    (&["fog/exq"], "no formula `fog/exq`"),
    (&["vector/reflect"], "expected --over with one of i.x"),
    (&["fog/exp", "--over", "z"], "expected one of p.x p.y p.z density fog.r"),
    (&["fog/exp", "--from", "2", "--to", "1"], "the wrong way round; expected --from 1 --to 2"),
    (&["fog/exp", "--from", "NaN"], "expected a finite f32"),
    (&["fog/exp", "--to", "inf"], "expected a finite f32"),
    (&["fog/exp", "--to", "1e50"], "expected a finite f32"),
    (&["fog/exp", "--to", "far"], "not a number"),
    (&["fog/exp", "--set", "p.z=3"], "the sweep is over p.z"),
    (&["fog/exp", "--set", "density=thick"], "not a number"),
    (&["fog/exp", "--set", "density"], "expected NAME=VALUE"),
    (&["fog/exp", "--set", "haze=1"], "expected one of p.x"),
    (&["fog/exp", "--output", "g"], "expected one of f color.r"),
    (&["fog/exp", "--shard", "3/2"], "expected I/N with 1 ≤ I ≤ N"),
    (&["fog/exp", "--from", "1", "--to", "1", "--shard", "7/8"], "shard 7/8 has no inputs: the range has one block"),
    (&["fog/exp", "--stage", "raster"], "expected compute, fragment or fixed-function"),
    (&["fog/exp", "--stage", "fixed-function"], "expected --stage compute or fragment"),
    (&["fog/exp", "--blocks", "3"], "--checkpoint"),
    (&["fog/exp", "--adapter", "none"], "no adapter `none`"),
    (&["fog/exp", "--format", "junit"], "[possible values: text, json, html]"),
    (&["fog/exp", "--profile", "gl"], "expected one of wgsl"),
    (&["fog/exp", "--checkpoint", "/no/such/folder/a.json"], "cannot write /no/such/folder/a.json"),
    (&["fog/exp", "--out", "/no/such/folder/a.json"], "cannot write /no/such/folder/a.json"),
    (&["interpolation/raster-line", "--over", "x"], "fixed hardware"),
    (&["blend/mode-alpha", "--from", "0"], "which --from has no say in"),
];

#[test]
fn a_sweep_is_along_a_row_that_tells_something() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    // In the middle of all domains Blinn's highlight is 0, whatever the exponent.
    let doubled = edited("sweep-doubled", "lighting.wgsl", |text| {
        text.replace(
            "vector_cosine_power(n, vector_halfway(v, l), shininess)",
            "vector_cosine_power(n, vector_halfway(v, l), 2.0 * shininess)",
        )
    });
    let sweep = ["sweep", "lighting/blinn", "--over", "shininess", "--from", "20", "--to", "20.01"];
    let shaders = ["--shaders", doubled.to_str().expect("UTF-8")];
    assert_eq!(code(&lightmeter(&sweep)), 0);
    let output = lightmeter(&[&sweep[..], &shaders].concat());
    assert_eq!(code(&output), 1, "{}", stdout(&output));
    // The command for one input has the row, and says the same of it.
    let said = stdout(&output);
    let again = said.lines().find_map(|line| line.trim().strip_prefix("again")).expect("a command").trim().to_owned();
    let output = std::process::Command::new("sh")
        .args(["-c", &again.replacen("lightmeter", env!("CARGO_BIN_EXE_lightmeter"), 1)])
        .output()
        .expect("the shell starts");
    assert!(code(&output) == 1 && stdout(&output).contains("1 of 1 inputs outside"), "{again}: {}", stderr(&output));
}

#[test]
fn a_sweep_that_judges_nothing_is_no_success() {
    for (sweep, said) in [
        (&["fog/exp", "--over", "p.x"][..], "no output of fog/exp depends on p.x"),
        (
            &["fog/exp", "--over", "p.x", "--from", "1", "--to", "1.000001"],
            "no output of fog/exp depends on p.x from 1",
        ),
        (&["fog/exp", "--from", "1e-9", "--to", "1.0001e-9"], "twice the input would be legal too"),
        (&["fog/exp", "--set", "density=0"], "does not depend on p.z"),
        (
            &["fog/exp", "--output", "color.g", "--set", "fog=0.5", "--set", "shaded=0.5"],
            "color.g of fog/exp does not depend on p.z",
        ),
        (
            &["fog/linear", "--from", "1", "--to", "1.0001", "--set", "dmin=5", "--set", "dmax=5"],
            "does not depend on p.z",
        ),
        (
            &[
                "attenuation/polynomial",
                "--over",
                "d",
                "--from",
                "1",
                "--to",
                "1.001",
                "--set",
                "kc=0",
                "--set",
                "kl=0",
                "--set",
                "kq=0",
            ],
            "",
        ),
    ] {
        let output = lightmeter(&[&["sweep", "--adapter", "cpu"], sweep].concat());
        let told = stdout(&output) + &stderr(&output);
        assert!(code(&output) == 3 && told.contains(said), "{sweep:?}: {told}");
    }
}

#[test]
fn what_cannot_be_swept_is_refused_with_what_would_be_right() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for (args, says) in REFUSED {
        let output = lightmeter(&[&["sweep"], *args].concat());
        let message = stderr(&output);
        assert_eq!(code(&output), 2, "{args:?}: {message}");
        assert!(message.contains(says), "{args:?}: {message}");
    }
}

#[test]
fn a_page_of_results_has_each_with_its_worst_input_and_histogram() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = folder("sweep-page");
    let place = |name: &str| dir.join(name).to_string_lossy().into_owned();
    let (fog, blend, page) = (place("fog.json"), place("blend.json"), place("page.md"));
    lightmeter(&short(&["--out", &fog]));
    lightmeter(&[
        "sweep",
        "blend/mode-mul",
        "--shard",
        "1/64",
        "--adapter",
        "cpu",
        "--format",
        "json",
        "--out",
        &blend,
    ]);
    let output = lightmeter(&["page", "sweep", &fog, &blend, "--out", &page]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let text = std::fs::read_to_string(&page).expect("a page");
    for part in [
        "| fog/exp | p.z from 1 to 1.125 | lavapipe, compute | 1,048,577 | 0 |",
        "## blend/mode-mul on cpu",
        "█",
        "Greatest error: at",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let output = lightmeter(&["page", "sweep", &place("none.json")]);
    assert!(code(&output) == 2 && stderr(&output).contains("cannot read"));
}
