//! `lightmeter check`: shaders step by step.

use super::{code, command, lightmeter, stderr, stdout};
use crate::place::folder;
use crate::skip::lacks;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

const RIGHT: &str = "varying vec3 n;\nuniform vec3 toLight;\nvoid main() {\n  gl_FragColor = vec4(max(dot(normalize(n), toLight), 0.0));\n}\n";

fn shader(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("the folder can be made");
    std::fs::write(&path, text).expect("the folder can be written to");
    path
}

fn check(given: &[&str]) -> (i32, String, String) {
    let output = lightmeter(&[&["check"], given].concat());
    (code(&output), stdout(&output), stderr(&output))
}

#[test]
fn steps_are_told_with_their_lines_and_the_exit_code_says_whether_one_is_wrong() {
    let own = folder("check-right");
    let right = shader(&own, "right.frag", RIGHT);
    let (code, said, _) = check(&[&right.display().to_string()]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("right.frag: GLSL, 1 step") && said.contains("4  lambert") && said.contains('✓'), "{said}");
    let wrong = shader(
        &own,
        "wrong.frag",
        &RIGHT.replace("max(dot(normalize(n), toLight), 0.0)", "abs(dot(normalize(n), toLight))"),
    );
    let (code, said, _) = check(&[&wrong.display().to_string(), &right.display().to_string()]);
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("✗ incidence-of-both-sides") && said.contains("2 files, 2 steps, 1 wrong"), "{said}");
    let none = shader(&own, "none.frag", "void main() {\n  gl_FragColor = vec4(1.0);\n}\n");
    let (code, said, _) = check(&[&none.display().to_string()]);
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("no step that is known"), "{said}");
}

#[test]
fn steps_are_judged_as_formulas_and_what_contradicts_the_review_is_open() {
    let own = folder("check-judged");
    // The logarithm of e has five digits, and a Lambert factor counts both sides.
    let text = RIGHT.replace("void main", "uniform vec3 k; varying vec3 p;\nvoid main").replace(
        "vec4(max(dot(normalize(n), toLight), 0.0))",
        "mix(vec4(k, 1.0), vec4(abs(dot(normalize(n), toLight))), exp2(-1.4427 * k.x * length(p)))",
    );
    let file = shader(&own, "digits.frag", &text).display().to_string();
    for adapter in [&[][..], &["--adapter", "lavapipe"]] {
        if !adapter.is_empty() && crate::needs::lacks_lavapipe() {
            continue;
        }
        let (code, said, told) = check(&[&[&*file, "--format", "json"], adapter].concat());
        assert_eq!(code, 1, "{said}{told}");
        let report: Value = serde_json::from_str(&said).expect("JSON");
        let steps = report["shaders"][0]["steps"].as_array().expect("steps");
        let of = |kind: &str| steps.iter().find(|step| step["kind"] == kind).expect("a step of the kind");
        let (lambert, fog) = (of("lambert"), of("fog"));
        assert_eq!(lambert["judged"]["formula"], "lighting/diffuse-toward");
        assert!(lambert["judged"]["random_wrong"].as_u64() > Some(100), "{lambert}");
        assert!(lambert["judged"]["explanation"].to_string().contains("incidence-of-both-sides"), "{lambert}");
        assert_eq!((&fog["verdict"], &fog["name"]), (&"perhaps".into(), &"contradicted".into()), "{fog}");
        assert!(fog["sentence"].to_string().contains("by fog/exp-radial, "), "{fog}");
        let by = if adapter.is_empty() { "f32" } else { "lavapipe" };
        assert!([lambert, fog].iter().all(|step| step["judged"]["by"] == by), "{said}");
    }
    let right = shader(&own, "right.frag", RIGHT).display().to_string();
    let (code, said, _) = check(&[&right]);
    assert!(code == 0 && said.contains("right.frag: GLSL, 1 step, 1 judged in f32"), "{said}");
    let (code, _, told) = check(&[&right, "--adapter", "nonsense"]);
    assert!(code == 2 && told.contains("nonsense"), "{code} {told}");
    for option in [["--cases", "0"], ["--profile", "nonsense"]] {
        let (code, _, told) = check(&[&[&*right], &option[..]].concat());
        assert!(code == 2 && told.contains(option[0]), "{code} {told}");
    }
}

#[test]
fn right_steps_with_constants_and_signs_are_right_by_their_formulas_wherever_they_are_computed() {
    let own = folder("check-constants");
    let text = "#version 330
in vec3 n; in vec3 p; uniform vec3 eye; uniform vec3 lamp; uniform vec3 axis; out vec4 color;
const vec3 toward = vec3(0.0, 0.6, 0.8);
void main() {
  vec3 N = normalize(n); vec3 V = normalize(eye - p); vec3 L = normalize(lamp - p);
  float d = length(lamp - p);
  float one = max(dot(N, toward), 0.0);
  float two = max(-dot(N, -L), 0.0);
  float three = pow(max(dot(reflect(-L, N), V), 0.0), 32.0);
  float four = pow(max(dot(N, normalize(V + toward)), 0.0), 64.0);
  float five = 1.0 / (1.0 + 0.09 * d + 0.032 * d * d);
  float six = dot(-L, axis) >= 0.9 ? 1.0 : 0.0;
  float seven = exp(-0.05 * length(p));
  color = vec4(mix(vec3(0.5), vec3((one + two + three + four) * five * six), seven), 1.0);
}
";
    let file = shader(&own, "constants.frag", text).display().to_string();
    for adapter in [&[][..], &["--adapter", "lavapipe"]] {
        if !adapter.is_empty() && crate::needs::lacks_lavapipe() {
            continue;
        }
        let (code, said, _) = check(&[&[&*file, "--format", "json"], adapter].concat());
        assert_eq!(code, 0, "{said}");
        let report: Value = serde_json::from_str(&said).expect("JSON");
        let steps = report["shaders"][0]["steps"].as_array().expect("steps");
        let judged: Vec<&Value> = steps.iter().filter(|step| step["judged"].is_object()).collect();
        let formulas: Vec<&str> = judged.iter().filter_map(|step| step["judged"]["formula"].as_str()).collect();
        let all = [
            "lighting/diffuse-toward",
            "lighting/diffuse-toward",
            "lighting/phong",
            "lighting/blinn",
            "attenuation/polynomial",
            "fog/exp-radial",
            "attenuation/spot-cutoff",
        ];
        assert_eq!(formulas, all, "{said}");
        for step in judged {
            assert!(step["judged"]["random_wrong"] == 0 && step["judged"]["random"].as_u64() >= Some(256), "{step}");
            assert!(step["judged"]["problem"].is_null() && step["verdict"] == "right", "{step}");
        }
    }
}

#[test]
fn code_scanning_and_people_are_shown_where_a_step_is_wrong() {
    let own = folder("check-shown");
    let text = RIGHT
        .replace("void main", "// <script>alert(1)</script>\nvoid main")
        .replace("max(dot(normalize(n), toLight), 0.0)", "abs(dot(normalize(n), toLight))");
    let wrong = shader(&own, "a b.frag", &text).display().to_string();
    let lost = own.join("lost.frag").display().to_string();
    let (code, said, _) = check(&[&wrong, &lost, "--format", "sarif"]);
    assert_eq!(code, 1, "{said}");
    let log: Value = serde_json::from_str(&said).expect("JSON");
    let run = &log["runs"][0];
    let result = &run["results"][0];
    assert_eq!(
        (&log["version"], &result["ruleId"], &result["level"]),
        (&"2.1.0".into(), &"incidence-of-both-sides".into(), &"error".into())
    );
    assert_eq!(run["tool"]["driver"]["rules"][0]["id"], "incidence-of-both-sides");
    let place = &result["locations"][0]["physicalLocation"];
    assert!(
        place["artifactLocation"]["uri"].to_string().contains("/a%20b.frag") && place["region"]["startLine"] == 5,
        "{place}"
    );
    assert_eq!(run["invocations"][0]["executionSuccessful"], false);
    assert!(run["invocations"][0]["toolExecutionNotifications"].to_string().contains("lost.frag"), "{said}");
    let accepted = ["--accept", "incidence-of-both-sides"];
    let (code, said, _) = check(&[&[&*wrong, "--format", "sarif"], &accepted[..]].concat());
    assert!(code == 0 && said.contains("\"suppressions\"") && said.contains("\"executionSuccessful\": true"), "{said}");
    let (code, page, _) = check(&[&wrong, &lost, "--format", "html"]);
    assert_eq!(code, 1);
    assert!(
        page.contains("2 shaders: 1 of 1 step wrong") && page.contains("<code>incidence-of-both-sides</code>"),
        "{page}"
    );
    assert!(page.contains("&lt;script&gt;alert(1)") && !page.contains("<script>alert(1)"), "{page}");
    assert!(page.contains("not read: ") && page.contains("by lighting/diffuse-toward, 135 of 256"), "{page}");
}

#[test]
fn a_file_that_is_not_read_is_told_and_the_others_go_on() {
    let own = folder("check-unread");
    let right = shader(&own, "right.frag", RIGHT);
    let deep = shader(
        &own,
        "deep.frag",
        &format!("void main() {{\n  float x = {}1.0{};\n}}\n", "(".repeat(9999), ")".repeat(9999)),
    );
    let grows: String = (1..60).map(|k| format!("#define M{k} M{0} M{0} M{0} M{0}\n", k - 1)).collect();
    let grows = shader(&own, "grows.frag", &format!("#define M0 + 1.0\n{grows}void main() {{ float x = 0.0 M59; }}\n"));
    let files = [&right, &deep, &grows].map(|path| path.display().to_string());
    let given: Vec<&str> = files.iter().map(|path| &**path).chain(["/does/not/exist.frag"]).collect();
    let (code, said, _) = check(&given);
    assert_eq!(code, 2, "{said}");
    assert!(said.contains("deep.frag:2: it nests more than"), "{said}");
    assert!(said.contains("grows.frag: ") && said.contains("exist.frag: cannot read"), "{said}");
    assert!(said.contains("4  lambert") && said.contains("4 files, 1 step, 3 not read"), "{said}");
}

#[test]
fn the_json_is_a_report_with_shaders() {
    let own = folder("check-json");
    let right = shader(&own, "right.frag", RIGHT);
    let (code, said, _) = check(&[&right.display().to_string(), "--format", "json"]);
    assert_eq!(code, 0);
    let report: Value = serde_json::from_str(&said).expect("it is JSON");
    assert_eq!(report["schema"], "lightmeter.report/2");
    let step = &report["shaders"][0]["steps"][0];
    assert_eq!((&step["line"], &step["kind"], &step["verdict"]), (&4.into(), &"lambert".into(), &"right".into()));
}

#[test]
fn folders_and_globs_are_the_shaders_in_them() {
    let own = folder("check-folder");
    let first = shader(&own, "a.frag", RIGHT);
    shader(&own, "below/b.fs", RIGHT);
    shader(&own, "notes.txt", "no shader");
    assert_eq!(first.parent(), Some(&*own));
    let folder = own.display().to_string();
    let (code, said, _) = check(&[&folder]);
    assert!(code == 0 && said.contains("2 files, 2 steps"), "{said}");
    let (code, said, _) = check(&[&format!("{folder}/*.frag")]);
    assert!(code == 0 && said.contains("a.frag: GLSL, 1 step") && !said.contains("b.fs"), "{said}");
    let (code, _, said) = check(&[&format!("{folder}/*.wgsl")]);
    assert!(code == 2 && said.contains("no file is called so"), "{said}");
    let (code, _, said) = check(&[&folder, "-I", "/does/not/exist"]);
    assert!(code == 2 && said.contains("there is no such folder"), "{said}");
    let (code, _, said) = check(&[&folder, "-D", "3=4"]);
    assert!(code == 2 && said.contains("`3=4` is no macro"), "{said}");
}

const HLSL: &str = "float3 lightPosition;
float4 main(float3 normal : NORMAL, float3 position : TEXCOORD0) : SV_Target {
  float3 l = normalize(lightPosition - position);
  return saturate(dot(normalize(normal), l));
}
";

#[test]
fn hlsl_is_read_by_glslang_with_the_lines_of_the_file() {
    let is_there = Command::new("glslangValidator").arg("--version").output().is_ok();
    if lacks(!is_there, ("glslang", "needs glslangValidator (Debian: apt-get install glslang-tools)")) {
        return;
    }
    let path = shader(&folder("check-hlsl"), "lit.hlsl", HLSL);
    let (code, said, _) = check(&[&path.display().to_string()]);
    assert!(code == 0 && said.contains("HLSL (read by glslangValidator, through SPIR-V), 1 step"), "{said}");
    assert!(said.contains("    4  lambert  return saturate("), "{said}");
}

/// What is asked of compilers that are seldom installed: stand-ins record it.
#[cfg(unix)]
#[test]
fn other_compilers_are_asked_for_the_entry_point_and_its_stage() {
    use std::os::unix::fs::PermissionsExt as _;
    let rows = [
        ("dxc", "-spirv -fspv-debug=line -T ps_6_0 -E main -Fo"),
        ("slangc", "-target spirv -g -stage fragment -entry main -o"),
    ];
    for (name, expected) in rows {
        let own = folder("check-compilers");
        let path = shader(&own, "lit.hlsl", HLSL);
        let (asked, programs) = (own.join("asked"), own.join("programs"));
        let program =
            shader(&programs, name, &format!("#!/bin/sh\necho \"$@\" >'{}'\necho 'ERROR: no'\n", asked.display()));
        std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).expect("it can be made a program");
        let mut asking = command(&["check", &path.display().to_string()]);
        let output = asking.env("PATH", &programs).output().expect("the binary starts");
        assert_eq!(code(&output), 2, "{}", stdout(&output));
        let asked = std::fs::read_to_string(&asked).expect("it was asked");
        assert!(asked.starts_with(expected), "{name}: {asked}");
    }
    let own = folder("check-no-compiler");
    let path = shader(&own, "lit.hlsl", HLSL);
    let mut asking = command(&["check", &path.display().to_string()]);
    let output = asking.env("PATH", &own).output().expect("the binary starts");
    let said = stdout(&output);
    assert!(
        code(&output) == 2 && said.contains("read by glslangValidator, dxc or slangc, and none is installed"),
        "{said}"
    );
}

const BOTH_SIDES: &str = "varying vec3 n;\nuniform vec3 toLight;\nvoid main() {\n  gl_FragColor = vec4(abs(dot(normalize(n), toLight)));\n}\n";

#[test]
fn what_is_meant_as_it_is_is_accepted_by_its_name_and_told() {
    let own = folder("check-accepted");
    let wrong = shader(&own, "wrong.frag", BOTH_SIDES).display().to_string();
    assert_eq!(check(&[&wrong]).0, 1);
    let (code, said, _) = check(&[&wrong, "--accept", "incidence-of-both-sides"]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("✗ incidence-of-both-sides (accepted)") && !said.contains("wrong\n"), "{said}");
    // Behind the step, above it, and on top of the file.
    let comment = "// lightmeter: accept incidence-of-both-sides: leaves are lit from both sides\n";
    let behind = BOTH_SIDES.replace(")));\n", &format!("))); {comment}"));
    let above = BOTH_SIDES.replace("  gl_", &format!("  {comment}  gl_"));
    let top = format!("#version 120\n{comment}{BOTH_SIDES}");
    for (name, text) in [("behind.frag", behind), ("above.frag", above), ("top.frag", top)] {
        let (code, said, _) = check(&[&shader(&own, name, &text).display().to_string()]);
        assert_eq!(code, 0, "{name}: {said}");
    }
    // A comment at another line accepts nothing, and a note says so.
    let elsewhere = BOTH_SIDES.replace("void main", &format!("{comment}void main"));
    let (code, said, _) = check(&[&shader(&own, "elsewhere.frag", &elsewhere).display().to_string()]);
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("line 3: this comment accepts `incidence-of-both-sides`, which is not found here"), "{said}");
    let right = shader(&own, "right.frag", RIGHT).display().to_string();
    let (code, said, _) = check(&[&right, "--accept", "incidence-of-both-sides"]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("note: `incidence-of-both-sides` is accepted, and no step has it"), "{said}");
    let (_, json, _) = check(&[&wrong, "--accept", "incidence-of-both-sides", "--format", "json"]);
    let json: Value = serde_json::from_str(&json).expect("JSON");
    let step = json["shaders"][0]["steps"].as_array().expect("steps").iter().find(|step| step["kind"] == "lambert");
    assert_eq!(step.expect("the step")["accepted"], true);
}

#[test]
fn a_name_that_there_is_not_is_refused_with_the_nearest_and_strict_counts_dialects() {
    let own = folder("check-names");
    let right = shader(&own, "right.frag", RIGHT).display().to_string();
    let (code, _, said) = check(&[&right, "--accept", "incidence-of-both-side"]);
    assert_eq!(code, 2);
    assert!(said.contains("did you mean `incidence-of-both-sides`?"), "{said}");
    let typed = shader(&own, "typed.frag", &format!("// lightmeter: accept incidence-of-both-side\n{RIGHT}"));
    let (code, said, _) = check(&[&typed.display().to_string()]);
    assert_eq!(code, 2, "{said}");
    assert!(said.contains("line 1: no dialect and no mistake is called `incidence-of-both-side`"), "{said}");
    let half = RIGHT.replace("max(dot(normalize(n), toLight), 0.0)", "dot(normalize(n), toLight) * 0.5 + 0.5");
    let half = shader(&own, "half.frag", &half).display().to_string();
    let (code, said, _) = check(&[&half]);
    assert!(code == 0 && said.contains('~'), "{code} {said}");
    let (code, said, _) = check(&[&half, "--strict"]);
    assert!(code == 1 && said.contains("in a dialect, which --strict counts"), "{code} {said}");
    let name = said.split_once("~ ").and_then(|(_, rest)| rest.split_whitespace().next()).expect("a name").to_owned();
    assert_eq!(check(&[&half, "--strict", "--accept", &name]).0, 0);
}

#[test]
fn a_project_says_its_shaders_and_what_they_are_read_with() {
    let own = folder("check-project");
    let lit = RIGHT.replace("max(dot(normalize(n), toLight), 0.0)", "LIT(dot(normalize(n), toLight))");
    shader(&own, "shaders/a/lit.frag", &format!("#include \"lit.h\"\n{lit}"));
    shader(&own, "include/lit.h", "#define LIT(x) WHICH(x)\n");
    shader(&own, "other.frag", RIGHT);
    let toml = |text: &str| std::fs::write(own.join("lightmeter.toml"), text).expect("the folder can be written to");
    let run = |given: &[&str]| {
        let output = command(&["check"]).args(given).current_dir(&own).output().expect("it runs");
        (code(&output), stdout(&output), stderr(&output))
    };
    let text = "[[shader]]\nfiles = [\"shaders/**/*.frag\"]\ninclude = [\"include\"]\ndefine = { WHICH = \"abs\" }\n";
    toml(text);
    let (code, said, _) = run(&[]);
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("✗ incidence-of-both-sides") && !said.contains("other.frag"), "{said}");
    // A file that is named is read with the same; an option wins.
    let (code, said, _) = run(&["shaders/a/lit.frag", "other.frag"]);
    assert!(code == 1 && said.contains("✗ incidence-of-both-sides"), "{code} {said}");
    let (code, said, _) = run(&["-D", "WHICH=normal_of"]);
    assert!(code != 1 && !said.contains("incidence-of-both-sides"), "{code} {said}");
    // A name that is accepted for all files is needed if one of them has it.
    let (code, said, _) = run(&["shaders/a/lit.frag", "other.frag", "--accept", "incidence-of-both-sides"]);
    assert!(code == 0 && !said.contains("take it out"), "{code} {said}");
    toml(&format!("{text}accept = [\"incidence-of-both-sides\"]\n"));
    assert_eq!(run(&[]).0, 0);
    for (wrong, told) in [
        (format!("{text}accept = [\"incidence-of-both-side\"]\n"), "did you mean `incidence-of-both-sides`?"),
        (text.replace("*.frag", "*.wgsl"), "no file is called so"),
        (text.replace("include =", "includes ="), "unknown field `includes`"),
        (text.replace("[\"include\"]", "[\"nowhere\"]"), "there is no such folder"),
        (text.replace("WHICH =", "\"W H\" ="), "is no macro"),
    ] {
        toml(&wrong);
        let (code, _, said) = run(&[]);
        assert_eq!(code, 2, "{said}");
        assert!(said.contains(told), "{said}");
    }
    let (code, _, said) = run(&["--no-config"]);
    assert_eq!(code, 2);
    assert!(said.contains("no file is named"), "{said}");
}

#[test]
fn ci_is_told_the_line_of_what_is_wrong() {
    let own = folder("check-ci");
    let wrong = shader(&own, "wrong.frag", BOTH_SIDES).display().to_string();
    let nowhere = own.join("nowhere.frag").display().to_string();
    let (code, said, _) = check(&[&wrong, &nowhere, "--format", "github"]);
    assert_eq!(code, 1, "{said}");
    assert!(
        said.contains(&format!("::error file={wrong},line=4,title=lambert%3A incidence-of-both-sides::")),
        "{said}"
    );
    assert!(said.contains(&format!("::error file={nowhere},title=not read::")), "{said}");
    let (_, said, _) = check(&[&wrong, "--format", "github", "--accept", "incidence-of-both-sides"]);
    assert!(said.contains("::notice file=") && said.contains("(accepted)") && !said.contains("::error"), "{said}");
    let typed =
        shader(&own, "typed.frag", &format!("\n// lightmeter: accept nothing-like-it\n{RIGHT}")).display().to_string();
    let (code, said, _) = check(&[&typed, "--format", "github", "--accept", "ramp"]);
    assert_eq!(code, 2, "{said}");
    assert!(said.contains(&format!("::error file={typed},line=2,title=accept::")), "{said}");
    assert!(said.contains("::warning title=note::`ramp` is accepted"), "{said}");
    let (_, said, _) = check(&[&typed, "--format", "junit", "--accept", "ramp"]);
    assert!(said.contains("errors=\"1\"") && said.contains("`ramp` is accepted"), "{said}");
    let (code, said, _) = check(&[&wrong, &nowhere, "--format", "junit"]);
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("tests=\"2\"") && said.contains("failures=\"1\"") && said.contains("errors=\"1\""), "{said}");
    assert!(said.contains("line=\"4\"") && said.contains("incidence-of-both-sides: "), "{said}");
}

#[test]
fn effects_of_hlsl_are_read_without_annotations_and_macros_that_are_elsewhere() {
    let is_there = Command::new("glslangValidator").arg("--version").output().is_ok();
    if lacks(!is_there, ("glslang", "needs glslangValidator (Debian: apt-get install glslang-tools)")) {
        return;
    }
    let text = "#include \"host.fxh\"\nuniform float Power <\n  ui_type = \"slider > a\"; ui_max = 8.0;\n> = 2.0;\nDECLARE_SHADOW(\"SpotLight\", Lamp)\nLOCAL_SAMPLER(map, 0);\nTexture2D<float4> Map : register(SLOT_MAP);\nSamplerState Linear : register(s0);\nfloat3 ToLight < string UIName = \"light\"; >;\nbool less(float a, float b) { return a < b; }\nfloat4 main(float3 n : NORMAL, float2 at : TEXCOORD0) : SV_Target {\n  float lit = max(dot(normalize(n), normalize(ToLight)), 0.0);\n  return Map.Sample(Linear, at) * lit * (less(lit, Power) ? 1.0 : 0.5);\n}\n";
    let path = shader(&folder("check-effect"), "annotated.hlsl", text).display().to_string();
    let (code, said, _) = check(&[&path]);
    assert!(code == 0 && said.contains("   12  lambert") && said.contains("1 step"), "{said}");
    assert!(said.contains("line 5: the macro `DECLARE_SHADOW` is not there"), "{said}");
}
