//! The real binary: what it prints, how it ends, and which mistakes in a shader it names.

#![expect(clippy::float_cmp, reason = "what must hold exactly is compared exactly")]

mod bench;
mod blend;
mod check;
mod compared;
mod documents;
mod gate;
mod hard;
mod held;
mod hostile;
mod images;
mod live;
mod mistakes;
#[path = "../src/needs.rs"]
#[expect(dead_code, unreachable_pub, reason = "the tests' library has it as well")]
mod needs;
mod pages;
#[path = "../src/place.rs"]
#[expect(unreachable_pub, reason = "the tests' library has it as well")]
mod place;
mod project;
mod quoted;
mod scene;
mod selftest;
mod shader;
mod shader_bugs;
mod signals;
#[path = "../src/skip.rs"]
#[expect(unreachable_pub, reason = "the tests' library has it as well")]
mod skip;
mod snapshots;
mod special;
mod sweep;

use place::folder;
use serde_json::Value;
use shader_bugs::SHADER_BUGS;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A command for which no time passes but what the renderer of a gate says: no limit expires by the machine's clock.
fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lightmeter"));
    command.args(args).env("LIGHTMETER_CLOCK", "renderer");
    command
}

fn lightmeter(args: &[&str]) -> Output {
    command(args).output().expect("the binary starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("the binary ends by itself")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("output is UTF-8")
}

fn stderr(output: &Output) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("messages are UTF-8");
    assert!(!text.contains("panicked"), "{text}");
    text
}

fn json(args: &[&str]) -> Value {
    let output = lightmeter(args);
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)))
}

/// A folder of this test's own, with a copy of one shader, edited.
fn edited(test: &str, file: &str, edit: impl Fn(&str) -> String) -> PathBuf {
    let dir = folder(&format!("edited-{test}"));
    let (_, text) = lightmeter_gpu::FILES
        .into_iter()
        .chain(lightmeter_gpu::SCENE_FILES)
        .chain(lightmeter_gpu::EFFECT_FILES)
        .find(|(name, _)| *name == file)
        .expect("the shader is built in");
    let path = dir.join(file);
    path.parent().map(std::fs::create_dir_all).transpose().expect("a folder for an effect can be made");
    std::fs::write(path, edit(text)).expect("a shader can be written");
    dir
}

#[test]
#[ignore = "long: ./x campaign long"]
fn each_mistake_in_a_shader_fails_by_family() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for (place, (mistake, file, right, wrong, filter)) in SHADER_BUGS.iter().enumerate() {
        let dir = edited(&format!("mistake-{place}"), file, |text| {
            assert!(text.contains(right), "{mistake}: `{right}` no longer stands in {file}");
            text.replace(right, wrong)
        });
        let dir = dir.to_str().expect("the folder's name is UTF-8");
        let family = filter.split('/').next().expect("a family");
        let args = ["run", filter, "--shaders", dir, "--cases", "256", "--groups"];
        let output = lightmeter(&args);
        let text = stdout(&output);
        assert_eq!(code(&output), 1, "{mistake}: {text}{}", stderr(&output));
        assert!(text.contains(&format!("✗ {family}/")), "{mistake}: {text}");
        assert!(text.contains(&format!("FAIL {family}/")) && text.contains("again"), "{mistake}: {text}");
    }
}

#[test]
fn unedited_copies_pass() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("unedited", "fog.wgsl", str::to_owned);
    let output = lightmeter(&["run", "fog", "--cases", "64", "--shaders", dir.to_str().expect("UTF-8")]);
    assert_eq!(code(&output), 0, "{}", stdout(&output));
}

#[test]
fn a_run_in_json_has_what_others_build_upon() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let report = json(&["run", "fog/linear", "attenuation", "--cases", "100", "--format", "json"]);
    assert_eq!(report["schema"], "lightmeter.report/2");
    assert_eq!((report["seed"].as_u64(), report["profile"].as_str()), (Some(1), Some("wgsl")));
    assert!(report["seconds"].as_f64().is_some() && report["adapters"][0]["backend"].is_string());
    for total in
        ["cases", "verdicts", "passed", "failed", "expected_failures", "unexpected_passes", "skipped", "indeterminate"]
    {
        assert!(report["totals"][total].is_u64(), "{total}");
    }
    let groups = report["groups"].as_array().expect("groups");
    let linear =
        groups.iter().find(|group| group["id"] == "fog/linear" && group["stage"] == "fragment").expect("fog/linear");
    for field in [
        "adapter",
        "cases",
        "verdicts",
        "failed",
        "skipped",
        "indeterminate",
        "error_ulp_max",
        "margin_max",
        "seconds",
        "worst",
    ] {
        assert!(!linear[field].is_null(), "{field}");
    }
    let catalogue = lightmeter::select::catalogue();
    let member = catalogue.iter().find(|member| member.spec.id == "fog/linear").expect("a formula");
    let hard = member.spec.hard.len() as u64;
    assert_eq!(linear["cases"], 100 + hard * (1 + member.near()) + member.boundary());
    assert_eq!(report["failures"], Value::Array(vec![]));
}

#[test]
fn a_failure_in_json_tells_how_to_run_it_again() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("again", "fog.wgsl", |text| text.replace("dmax - distance", "dmax + distance"));
    let dir = dir.to_str().expect("UTF-8");
    let report = json(&["run", "fog/linear", "--cases", "64", "--format", "json", "--shaders", dir, "--seed", "5"]);
    let failure = &report["failures"][0];
    for field in ["id", "adapter", "inputs", "reference", "interval", "value", "error_ulp", "rerun"] {
        assert!(!failure[field].is_null(), "{field}");
    }
    let rerun = failure["rerun"].as_str().expect("a command");
    let id = failure["id"].as_str().expect("an id");
    assert!(rerun.contains(id) && rerun.contains("--seed 5") && rerun.contains("--shaders"), "{rerun}");
    let again = json(&["run", id, "--format", "json", "--shaders", dir, "--seed", "5"]);
    assert_eq!(again["failures"][0]["inputs"], failure["inputs"]);
}

#[test]
fn a_case_beyond_the_number_of_cases_is_run_by_its_name() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let report = json(&["run", "fog/linear/random/123456", "blend/max/zero/zero/0999", "--format", "json"]);
    assert_eq!(report["failures"], Value::Array(vec![]));
    let groups = report["groups"].as_array().expect("groups");
    for id in ["fog/linear", "blend/max"] {
        assert_eq!(groups.iter().find(|group| group["id"] == id).expect(id)["cases"], 1, "{id}");
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn every_profile_passes_on_a_right_driver() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for profile in ["wgsl", "vulkan"] {
        let output = lightmeter(&["run", "fog", "lighting", "--cases", "1000", "--profile", profile]);
        assert_eq!(code(&output), 0, "{profile}: {}", stdout(&output));
    }
}

#[test]
fn the_witness_of_a_deviation_is_asked_by_its_name() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let list = stdout(&lightmeter(&["list", "deviation"]));
    assert!(list.starts_with("deviation\n  llvmpipe-exp ") && list.contains("exp is exp2(x"), "{list}");
    let listed = json(&["list", "deviation/llvmpipe-exp2", "--format", "json"]);
    assert_eq!(listed["cases"][0]["deviation"], "deviation/llvmpipe-exp2");
    let adapters = json(&["adapters", "--format", "json"]);
    let known = adapters["adapters"][0]["deviations"].as_array().expect("deviations");
    let concerns = known.iter().any(|deviation| deviation["name"] == "llvmpipe-exp");
    let output = lightmeter(&["run", "deviation/llvmpipe-exp"]);
    let text = stdout(&output);
    assert_eq!(code(&output), if concerns { 0 } else { 3 }, "{text}");
    assert_eq!(text.matches("seen again: llvmpipe-exp\n").count(), usize::from(concerns), "{text}");
    assert!(!text.contains("llvmpipe-exp2"), "{text}");
    // Rules that allow what the driver gives know of no deviation from them, and so none that is missing.
    let output = lightmeter(&["run", "fog/exp", "--cases", "8", "--profile", "opengl"]);
    assert_eq!(code(&output), 0, "{}", stdout(&output));
    // Results name it without the word before it, and so it can be asked for.
    assert!(stdout(&lightmeter(&["show", "llvmpipe-exp"])).contains("exp2(x · log2 e)"));
    let embedded = lightmeter(&["run", "deviation", "--adapter", "cpu"]);
    assert!(
        code(&embedded) == 3 && stderr(&embedded).contains("no deviation concerns the adapter"),
        "{}",
        stderr(&embedded)
    );
    let formulas = lightmeter(&["list", "special", "--formulas"]);
    assert!(code(&formulas) == 2 && stderr(&formulas).contains("no formula matches"), "{}", stderr(&formulas));
}

#[test]
fn nothing_judged_is_no_success() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let output = lightmeter(&["run", "vector/normalize/hard/tiny"]);
    assert_eq!(code(&output), 3, "{}", stdout(&output));
    assert!(stderr(&output).contains("nothing was judged"));
}

#[test]
fn shards_make_the_whole() {
    let cases = |shard: &str| {
        json(&["run", "fog", "--adapter", "cpu", "--cases", "100", "--shard", shard, "--format", "json"])["totals"]["cases"].as_u64().expect("a count")
    };
    assert_eq!(cases("1/3") + cases("2/3") + cases("3/3"), cases("1/1"));
    for (command, shard) in [("run", "4/3"), ("run", "-1/3"), ("gate", "-1/3"), ("sweep", "-1/3")] {
        let output = lightmeter(&[command, "fog/exp", "--shard", shard]);
        assert!(code(&output) == 2 && stderr(&output).contains("expected I/N with 1 ≤ I ≤ N"), "{}", stderr(&output));
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn the_embedded_implementation_passes_without_a_driver() {
    let output = command(&["run", "--adapter", "cpu", "--cases", "64"]).env("VK_DRIVER_FILES", "/nowhere").output();
    let output = output.expect("the binary starts");
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
}

#[test]
fn junit_is_written_to_a_file() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let file = folder("junit-of-a-run").join("junit.xml");
    let name = file.to_str().expect("UTF-8");
    let output =
        lightmeter(&["run", "vector/reflect", "--adapter", "cpu", "--cases", "8", "--format", "junit", "--out", name]);
    assert_eq!((code(&output), stdout(&output).as_str()), (0, ""));
    let text = std::fs::read_to_string(file).expect("the file was written");
    assert!(text.contains("<testsuite name=\"cpu\"") && text.contains("vector/reflect (compute)"), "{text}");
    // A blend unit has a test for each target, with its own failures.
    let dir =
        edited("junit", "blend_unit.wgsl", |text| text.replace("colored.color;", "vec4f(colored.color.rgb, 0.25);"));
    let args = ["run", "blend/max", "--target", "all", "--cases", "64", "--format", "junit", "--shaders"];
    let text = stdout(&lightmeter(&[&args[..], &[dir.to_str().expect("UTF-8")]].concat()));
    for target in ["rgba32float", "rgba8unorm-srgb", "bgra8unorm"] {
        let name = format!("name=\"blend/max (fixed-function on {target})\"");
        let test = text.split("<testcase").find(|test| test.contains(&name)).expect("a test for the target");
        assert!(test.contains("verdicts failed; ") && test.matches("FAIL ").count() == 5, "{test}");
        assert_eq!(test.matches(&format!("fixed-function on {target}: color")).count(), 5, "{test}");
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn cases_and_formulas_are_listed() {
    let tree = stdout(&lightmeter(&["list", "fog"]));
    assert!(tree.contains("hard/dmin-equals-dmax") && !tree.contains("lighting"), "{tree}");
    let hard = json(&["list", "*/*/hard", "--format", "json"]);
    assert!(hard["cases"].as_array().expect("cases").iter().all(|c| c["random"] == 0 && !c["hard"][0]["id"].is_null()));
    let formulas = json(&["list", "--formulas", "--format", "json"]);
    let linear = formulas["formulas"]
        .as_array()
        .expect("formulas")
        .iter()
        .find(|f| f["id"] == "fog/linear")
        .expect("fog/linear")
        .clone();
    assert_eq!(
        (linear["inputs"][1]["name"].as_str(), linear["inputs"][1]["unit"].as_str()),
        (Some("dmin"), Some("unit"))
    );
    assert!(!linear["inputs"][1]["domain"].is_null() && linear["outputs"][0]["name"] == "f");
    let step = |rule: &Value| rule.as_str().is_some_and(|rule| rule.starts_with("where dmin = dmax it is a step"));
    assert!(linear["rules"].as_array().expect("rules").iter().any(step), "{linear}");
    assert_eq!(linear["inputs"][4]["means"], "the surface's colour before fog");
    let text = stdout(&lightmeter(&["list", "--formulas", "lighting/two-lights"]));
    assert!(text.contains("towards light 0") && text.contains("  rule lights are not attenuated"), "{text}");
}

#[test]
fn a_case_is_shown_whole() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let text = stdout(&lightmeter(&["show", "fog/linear/hard/at-dmax", "--verbose"]));
    for part in
        ["f = clamp", "pins:", "0xc1200000", "steps", "distance", "reference", "compute", "fragment", "condition"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    for part in ["rule: where dmin = dmax it is a step", "the surface's colour before fog", "f: share of the surface's"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    let shown = json(&["show", "blend/min/src-alpha/one/0007", "--adapter", "cpu", "--format", "json"]);
    assert_eq!(shown["id"], "blend/min/one/one/0007");
    assert_eq!(shown["answers"][0]["values"][0]["outcome"], "pass");
}

#[test]
fn adapters_are_listed() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let adapters = json(&["adapters", "--format", "json"]);
    assert!(adapters["adapters"][0]["name"].is_string());
    assert!(stdout(&lightmeter(&["adapters"])).contains("cpu"));
}

fn eval(lines: &str) -> Output {
    eval_with(&[], lines)
}

fn eval_with(args: &[&str], lines: &str) -> Output {
    let mut child = command(&[&["eval"], args].concat())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    child.stdin.take().expect("a pipe").write_all(lines.as_bytes()).expect("lines can be written");
    child.wait_with_output().expect("the binary ends")
}

const LINE: &str =
    r#"{"id":"a","formula":"fog/linear","inputs":{"p":[0,0,-5],"dmin":0,"dmax":10,"fog":[0,0,0],"shaded":[1,1,1]}}"#;

#[test]
fn lines_are_evaluated() {
    let output =
        eval(&format!("{LINE}\n\n{}\n", LINE.replace("\"a\"", "2").replace("fog/linear", "fog/linear-radial")));
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let answers: Vec<Value> = stdout(&output).lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!((&answers[0]["id"], &answers[1]["id"]), (&Value::from("a"), &Value::from(2)));
    let first = |field: &str| answers[0][field][0].as_f64().expect("a number");
    assert!(
        first("value") == 0.5 && first("low") <= 0.5 && first("high") >= 0.5 && first("high") - first("low") < 1e-6
    );
    assert!(answers[0]["condition"].is_f64());
}

#[test]
fn nan_and_infinity_are_strings_both_ways() {
    for given in ["\"NaN\"", "\"Inf\""] {
        let output = eval(&LINE.replace("[0,0,-5]", &format!("[0,0,{given}]")));
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let answer: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        assert_eq!((answer["low"][0].as_str(), answer["high"][0].as_str()), (Some("-Inf"), Some("Inf")), "{answer}");
    }
}

#[test]
fn malformed_lines_are_named() {
    let rows = [
        ("nonsense", "line 2: not JSON"),
        ("[1]", "line 2: expected an object"),
        (r#"{"formula":"fog/linear","inputs":{}}"#, "field `id`"),
        (r#"{"id":1,"inputs":{}}"#, "field `formula`"),
        (r#"{"id":1,"formula":"fog/liner","inputs":{}}"#, "no formula `fog/liner`"),
        (r#"{"id":1,"formula":"fog/linear"}"#, "field `inputs`"),
        (r#"{"id":1,"formula":"fog/linear","inputs":{},"more":1}"#, "field `more`"),
        (&LINE.replace("\"dmin\":0,", ""), "field `inputs.dmin` is missing; expected a number"),
        (&LINE.replace("\"dmin\":0", "\"dmin\":\"zero\""), "field `inputs.dmin`"),
        (&LINE.replace("\"dmin\":0", "\"dmin\":1e39"), "field `inputs.dmin`"),
        (&LINE.replace("[0,0,-5]", "[0,0]"), "field `inputs.p`: 2 numbers; expected an array of 3 numbers"),
        (&LINE.replace("\"dmin\"", "\"near\""), "field `inputs.near`"),
    ];
    for (line, message) in rows {
        let output = eval(&format!("{LINE}\n{line}\n{LINE}\n"));
        assert_eq!(code(&output), 2, "{line}: {}", stderr(&output));
        let answers: Vec<Value> =
            stdout(&output).lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
        let text = answers[1]["error"].as_str().unwrap_or_default();
        assert!(text.contains("line 2") && text.contains(message), "{line}: {text}");
        assert!(answers[0]["value"].is_array() && answers[2] == answers[0], "what stands beside it is answered");
    }
}

#[test]
fn bad_usage_is_told_with_its_code() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let rows: &[(&[&str], i32, &str)] = &[
        (&["run", "--adapter", "vodoo"], 2, "no adapter `vodoo`. There are"),
        (&["run", "frog"], 2, "no case matches `frog`"),
        (&["run", "fog", "frog"], 2, "no case matches `frog`"),
        (&["run", "fog/[", "--adapter", "cpu"], 2, "is not a glob"),
        (&["run", "--profile", "exact"], 2, "no profile `exact`"),
        (&["run", "--shaders", "/nowhere"], 2, "cannot read shaders from /nowhere"),
        (&["run", "--cases", "0"], 2, "0 is not in"),
        (&["run", "--target", "rgba8"], 2, "no such format; expected one of rgba32float"),
        (&["run", "blend/separate/add.zero/min"], 2, "no case matches"),
        (&["run", "--separate", "many"], 2, "invalid value"),
        (&["selftest", "--format", "junit"], 2, "[possible values: text, json, html]"),
        (&["show", "fog/linear/hard/nothing"], 2, "no case `fog/linear/hard/nothing`; did you mean"),
        (&["show", "frog"], 2, "there is no `frog`"),
        (
            &["run", "fog", "--adapter", "cpu", "--cases", "8", "--out", "/nowhere/file"],
            2,
            "cannot write /nowhere/file",
        ),
        (&["swim"], 2, "unrecognized subcommand"),
    ];
    for (args, expected, message) in rows {
        let output = lightmeter(args);
        let text = stderr(&output);
        assert_eq!(code(&output), *expected, "{args:?}: {text}");
        assert!(text.contains(message), "{args:?}: {text}");
    }
}

#[test]
fn invalid_shaders_are_told_with_their_line() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let rows = [
        ("syntax", "fog.wgsl", "return abs(p.z);", "return abs(p.z;", "fog.wgsl:"),
        ("types", "fog.wgsl", "return abs(p.z);", "return abs(p);", "fog.wgsl:"),
        ("missing", "fog.wgsl", "fn fog_linear(", "fn fog_lineal(", "no function `fog_linear`"),
        ("entry", "raster.wgsl", "fn raster_facing(", "fn raster_farcing(", "no function `raster_facing`"),
        (
            "clash",
            "fog.wgsl",
            "struct Fogged {",
            "var<private> lightmeter_rows: f32;\nstruct Fogged {",
            "lightmeter_rows",
        ),
        ("discard", "fog.wgsl", "return abs(p.z);", "if p.z > 0.0 { discard; } return abs(p.z);", "fog.wgsl"),
        (
            "signature",
            "color.wgsl",
            "fn color_from_unorm8(byte: f32)",
            "fn color_from_unorm8(byte: f32, more: f32)",
            "color/from-unorm8 takes 1 to 1",
        ),
    ];
    for (test, file, right, wrong, message) in rows {
        let dir = edited(&format!("invalid-{test}"), file, |text| {
            assert!(text.contains(right), "{test}: `{right}` no longer stands in {file}");
            text.replace(right, wrong)
        });
        let output = lightmeter(&["run", "fog", "color", "--shaders", dir.to_str().expect("UTF-8")]);
        let text = stderr(&output);
        assert_eq!(code(&output), 2, "{test}: {text}");
        assert!(text.contains(message), "{test}: {text}");
    }
    let empty = folder("empty");
    let output = lightmeter(&["run", "--shaders", empty.to_str().expect("UTF-8")]);
    assert!(code(&output) == 2 && stderr(&output).contains("no .wgsl file there"));
    let stray = edited("stray", "fog.wgsl", str::to_owned);
    std::fs::rename(stray.join("fog.wgsl"), stray.join("frog.wgsl")).expect("a file can be renamed");
    let output = lightmeter(&["run", "--shaders", stray.to_str().expect("UTF-8")]);
    assert!(code(&output) == 2 && stderr(&output).contains("no such shader; expected one of"));
}

#[test]
fn without_a_browser_nothing_can_run() {
    let output = command(&["run", "fog/exp", "--adapter", "chromium"]).env("CHROMIUM", "/nowhere").output();
    let output = output.expect("the binary starts");
    let text = stderr(&output);
    assert_eq!(code(&output), 3, "{text}");
    assert!(text.contains("/nowhere does not start"), "{text}");
}

#[test]
fn what_serve_cannot_judge_is_refused_before_a_page_is_served() {
    for (arguments, says) in [
        (&["fog/exp", "--adapter", "lavapipe"][..], "use `run --adapter lavapipe`"),
        (&["fog/exq"], "did you mean `fog/exp`?"),
        (&["fog/exp", "--listen", "0.0.0.0:0"], "as 192.168.1.20:8443, or 127.0.0.1"),
        (&["fog/exp", "--listen", "nowhere"], "--listen"),
    ] {
        let output = command(&[&["serve"], arguments].concat()).output().expect("the binary starts");
        let text = stderr(&output);
        assert_eq!(code(&output), 2, "{arguments:?}: {text}");
        assert!(text.contains(says) && !text.contains("open this page"), "{arguments:?}: {text}");
    }
}

#[test]
fn without_a_driver_nothing_can_run() {
    let output = command(&["run", "fog"])
        .env("VK_DRIVER_FILES", "/nowhere")
        .env("VK_ADD_DRIVER_FILES", "")
        .env("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere")
        .env("LIBGL_DRIVERS_PATH", "/nowhere")
        .output()
        .expect("the binary starts");
    let text = stderr(&output);
    assert_eq!(code(&output), 3, "{text}");
    assert!(
        text.contains("VK_DRIVER_FILES names no Vulkan driver that is here") && text.contains("--adapter cpu"),
        "{text}"
    );
}
