//! Shaders as somebody wrote them: bound by the names of their variables, judged as formulas, told apart by `identify`.

use super::gate::folder;
use super::{code, json, lightmeter, stderr, stdout};
use lightmeter::document::Document as _;
use lightmeter::document::identify::IdentifyDocument;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn shaders() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/shaders")
}

/// The example's file, its function, the formula, further options, and the mistakes that are named: none of one that is right.
type Example = (&'static str, &'static str, &'static str, &'static [&'static str], &'static [&'static str]);

const EXAMPLES: &[Example] = &[
    ("documents/slides-phong.frag", "", "lighting/phong", &["--bind", "Light.Ldir=direction"], &[]),
    ("documents/slides-fog.frag", "", "fog/linear", &[], &[]),
    ("documents/tutorial-gouraud.vert", "", "lighting/scalar-material", &[], &["shininess-floored"]),
    ("documents/tutorial-phong.frag", "", "lighting/scalar-material", &[], &[]),
    (
        "documents/course-two-lights.frag",
        "",
        "lighting/two-lights",
        &[
            "--bind",
            "light0dirn=direction",
            "--bind",
            "light0color=color0",
            "--bind",
            "light1posn=vec4f(position, 1.0)",
            "--bind",
            "light1color=color1",
            "--bind",
            "islight=1",
        ],
        &[],
    ),
    ("mistakes/half-vector-mean.frag", "", "lighting/blinn", &[], &["half-vector-as-mean"]),
    ("mistakes/normal-not-normalised.frag", "", "lighting/phong", &[], &["normal-not-normalised"]),
    ("mistakes/mirrored-the-wrong-way.wgsl", "", "lighting/phong", &[], &["view-reversed"]),
    ("mistakes/not-attenuated.frag", "", "lighting/point-blinn", &[], &["not-attenuated"]),
    ("mistakes/no-cutoff.frag", "", "lighting/spot", &[], &["no-cutoff"]),
    ("mistakes/both-sides-lit.wgsl", "diffuse", "lighting/diffuse-toward", &[], &["incidence-of-both-sides"]),
    ("mistakes/fog-factor-turned.frag", "", "fog/linear", &[], &["fog-mixed-the-wrong-way"]),
    ("mistakes/fog-squared-once.glsl", "applyFog", "fog/exp2-opengl", &[], &["fog-exp2-document"]),
    ("mistakes/gamma-applied.frag", "", "lighting/blinn", &[], &["gamma-encoded"]),
    ("mistakes/half-lambert.glsl", "halfLambert", "lighting/diffuse-toward", &[], &["half-lambert"]),
    ("right/blinn.frag", "", "lighting/blinn", &[], &[]),
    ("right/blinn.wgsl", "", "lighting/blinn", &[], &[]),
    ("right/textbook.glsl", "cone", "attenuation/spot-cutoff", &[], &[]),
    ("right/textbook.glsl", "coneWithPower", "attenuation/spot-exponent", &[], &[]),
    ("right/textbook.glsl", "diffuse", "lighting/diffuse-toward", &[], &[]),
    ("right/textbook.glsl", "diffuseSaturated", "lighting/diffuse-toward", &[], &[]),
    ("right/textbook.glsl", "highlight", "lighting/specular-phong", &[], &[]),
    ("right/textbook.glsl", "eyeNormal", "vector/normal-inverse-transpose", &[], &[]),
    ("right/textbook.glsl", "sun", "lighting/phong-unit-light", &[], &[]),
];

/// The words that judge a shader, or a function of it.
fn words(command: &str, formula: &str, file: &Path, function: &str) -> Vec<String> {
    let file = file.display().to_string();
    let shader = if function.is_empty() {
        ["--shader".to_owned(), file]
    } else {
        ["--function".to_owned(), format!("{function}@{file}")]
    };
    [command.to_owned(), formula.to_owned()].into_iter().chain(shader).collect()
}

#[test]
#[ignore = "long: ./x campaign long"]
fn each_example_is_judged_and_its_mistake_named() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for (file, function, formula, options, named) in EXAMPLES {
        let mut args = words("run", formula, &shaders().join(file), function);
        args.extend(options.iter().map(ToString::to_string));
        args.extend(["--cases", "512", "--format", "json"].map(str::to_owned));
        let output = lightmeter(&args.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(code(&output), i32::from(!named.is_empty()), "{file}: {}", stderr(&output));
        let report: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        let groups = report["groups"].as_array().expect("a list");
        assert_eq!(groups.len(), 2, "{file}: compute and fragment");
        for group in groups {
            let found: Vec<&str> = group["diagnosis"]["explanations"][0]["mistakes"]
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(Value::as_str)
                .collect();
            assert_eq!(found, *named, "{file}: {group}");
        }
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn the_line_in_which_a_mistake_is_made_is_told() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for (file, function, formula, line) in [
        ("mistakes/half-vector-mean.frag", "", "lighting/blinn", "half-vector-mean.frag:16: vec3 h = (l + v) * 0.5;"),
        ("mistakes/fog-squared-once.glsl", "applyFog", "fog/exp2-opengl", "fog-squared-once.glsl:3: float f = clamp("),
    ] {
        let args =
            [words("run", formula, &shaders().join(file), function), vec!["--cases".into(), "256".into()]].concat();
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let said = stdout(&lightmeter(&args));
        assert!(said.contains(line) && said.contains("\n  is the likely place of "), "{said}");
        let formula = &json(&[&args[..], &["--format", "json"]].concat())["shader"]["formulas"][0];
        let place = &formula["mistakes"][0];
        let (number, code) = (place["line"].to_string(), place["code"].as_str().unwrap_or_default());
        assert!(line.split_once(":").is_some_and(|(_, rest)| format!("{number}: {code}").starts_with(rest)), "{place}");
        assert!(formula["variables"].as_array().is_some_and(|variables| variables.len() > 3), "{formula}");
        let annotated = stdout(&lightmeter(&[&args[..], &["--format", "github"]].concat()));
        assert!(annotated.contains(&format!(",line={number},title={}", args[1])), "{annotated}");
        let junit = stdout(&lightmeter(&[&args[..], &["--format", "junit"]].concat()));
        assert!(junit.contains("\n  is the likely place of "), "{junit}");
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_baseline_knows_the_constants_it_was_made_with() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let file = shaders().join("right/blinn.frag").display().to_string();
    let baseline = folder("shader-constants").join("baseline.json").display().to_string();
    let run = ["run", "lighting/blinn", "--cases", "64", "--shader", &file, "--baseline", &baseline];
    let held = ["--constant", "shininess=32"];
    assert_eq!(code(&lightmeter(&[&run[..], &held, &["--update-baseline"]].concat())), 0);
    let (with, without) =
        (json(&[&run[..6], &held, &["--format", "json"]].concat()), json(&[&run[..6], &["--format", "json"]].concat()));
    // The worst case of a formula that passes is explained by the inputs that it was judged with.
    for report in [&with, &without] {
        assert_eq!(report["explained"][0]["id"], report["groups"][0]["worst"]);
    }
    let shininess = |report: &Value| report["explained"][0]["inputs"]["shininess"].clone();
    assert_eq!((shininess(&with), shininess(&without) == 32.0), (32.0.into(), false));
    assert_eq!(code(&lightmeter(&[&run[..], &held].concat())), 0);
    let output = lightmeter(&run);
    assert!(
        code(&output) == 2 && stderr(&output).contains("constants [\"shininess=32\"] there, [] here"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn the_stable_form_is_told_in_the_shaders_language() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let file = folder("shader-stable").join("own.glsl");
    let text = "float attenuation(float kc, float kl, float kq, float d) { return 1.0 / (kl * d + kq * d * d); }";
    std::fs::write(&file, text).expect("it can be written");
    for (file, function, formula, says) in [
        (file, "attenuation", "attenuation/polynomial", "float attenuation_polynomial_bounded("),
        (
            shaders().join("mistakes/gamma-applied.frag"),
            "",
            "lighting/blinn",
            "no stable form of lighting/blinn is known",
        ),
    ] {
        let args =
            [words("run", formula, &file, function), vec!["--cases".into(), "64".into(), "--suggest".into()]].concat();
        let output = lightmeter(&args.iter().map(String::as_str).collect::<Vec<_>>());
        assert!(code(&output) == 1 && stderr(&output).contains(says), "{}", stderr(&output));
    }
    let file = folder("shader-stable-itself").join("own.glsl");
    let text = "float opacity(float density, float distance) { return 1.0 - exp(-density * distance); }";
    std::fs::write(&file, text).expect("it can be written");
    let args = [words("run", "fog/opacity-expm1", &file, "opacity"), vec!["--suggest".into()]].concat();
    let output = lightmeter(&args.iter().map(String::as_str).collect::<Vec<_>>());
    let said = stderr(&output);
    assert!(
        said.contains("fog/opacity-expm1 is itself a stable form") && said.contains("float fog_opacity_expm1"),
        "{said}"
    );
    let output = lightmeter(&["run", "fog", "--suggest"]);
    assert!(code(&output) == 2 && stderr(&output).contains("no shader is given"), "{}", stderr(&output));
}

#[test]
fn no_example_is_left_out() {
    let mut there = BTreeSet::new();
    for kind in ["documents", "mistakes", "right"] {
        for entry in std::fs::read_dir(shaders().join(kind)).expect("the folder is there") {
            let name = entry.expect("it can be read").file_name();
            there.insert(format!("{kind}/{}", name.to_string_lossy()));
        }
    }
    assert_eq!(there, EXAMPLES.iter().map(|(file, ..)| (*file).to_owned()).collect());
}

#[test]
fn the_same_code_gives_the_same_in_each_language() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let module = naga::front::wgsl::parse_str(include_str!("../../conformance/examples/shaders/right/blinn.wgsl"));
    let module = module.expect("it is WGSL");
    let info = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::default());
    let info = { info }.validate(&module).expect("it is valid");
    let options =
        naga::back::spv::Options { flags: naga::back::spv::WriterFlags::DEBUG, ..naga::back::spv::Options::default() };
    let words: Vec<u32> = naga::back::spv::write_vec(&module, &info, &options, None).expect("it is written as SPIR-V");
    let spirv = folder("shader-spirv").join("blinn.spv");
    std::fs::write(&spirv, words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>())
        .expect("it can be written");
    let judged = |file: &Path, options: &[&str]| -> Vec<Value> {
        let file = file.display().to_string();
        let run = ["run", "lighting/blinn", "--shader", &file, "--cases", "512", "--format", "json"];
        let report = json(&[&run[..], options].concat());
        assert_eq!(report["totals"]["failed"], 0, "{file}");
        let groups = report["groups"].as_array().expect("a list").clone();
        groups
            .into_iter()
            .map(|group| serde_json::json!([group["verdicts"], group["error_ulp_max"], group["margin_max"]]))
            .collect()
    };
    let wgsl = judged(&shaders().join("right/blinn.wgsl"), &[]);
    assert_eq!(wgsl, judged(&shaders().join("right/blinn.frag"), &[]));
    // naga writes no names of inputs.
    assert_eq!(wgsl, judged(&spirv, &["--bind", "argument 0=p", "--bind", "argument 1=normal"]));
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_shader_is_told_which_formula_it_is() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let identified = |file: &str, function: &[&str]| {
        let file = shaders().join(file).display().to_string();
        let output = lightmeter(&[&["identify", &file, "--format", "json"], function].concat());
        (
            code(&output),
            IdentifyDocument::read(&stdout(&output)).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output))),
        )
    };
    let (status, found) = identified("right/blinn.frag", &[]);
    assert_eq!((status, found.is), (0, vec!["lighting/blinn".to_owned()]));
    let phong =
        found.candidates.iter().find(|candidate| candidate.formula == "lighting/phong").expect("it is bound to it");
    assert_eq!(phong.mistakes, ["blinn-for-phong"]);
    let (status, found) = identified("documents/slides-fog.frag", &[]);
    assert_eq!(status, 0);
    assert!(
        found.is.contains(&"fog/linear".to_owned()) && !found.is.contains(&"fog/linear-radial".to_owned()),
        "{:?}",
        found.is
    );
    // What can be of several families is put into several files, one of which requires another.
    let square = folder("shader-square").join("square.glsl");
    std::fs::write(&square, "float falloff(float d) { return 1.0 / (d * d); }").expect("it can be written");
    let (status, found) = identified(&square.display().to_string(), &["--function", "falloff"]);
    assert_eq!((status, found.is), (0, vec!["attenuation/square".to_owned()]));
    let (status, found) = identified("mistakes/half-lambert.glsl", &["--function", "halfLambert"]);
    assert_eq!((status, found.is.len()), (1, 0));
    assert_eq!(
        (found.candidates[0].formula.as_str(), found.candidates[0].mistakes.as_slice()),
        ("lighting/diffuse-toward", &["half-lambert".to_owned()][..])
    );
}

#[test]
fn a_shader_is_swept_measured_and_held_to_a_baseline() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let file = shaders().join("documents/slides-fog.frag").display().to_string();
    let sweep = [
        "sweep",
        "fog/linear",
        "--over",
        "p.z",
        "--from",
        "-9",
        "--to",
        "-8.9999",
        "--output",
        "color.r",
        "--format",
        "json",
    ];
    let report = json(&[&sweep[..], &["--shader", &file]].concat());
    assert_eq!(report["statistics"]["failed"], 0, "{report}");
    let baseline = folder("shader-baseline").join("baseline.json").display().to_string();
    for update in [&["--update-baseline"][..], &[]] {
        let run = ["run", "fog/linear", "--cases", "256", "--shader", &file, "--baseline", &baseline];
        let output = lightmeter(&[&run[..], update].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }
    // The suite's own code is another subject.
    let output = lightmeter(&["run", "fog/linear", "--cases", "256", "--baseline", &baseline]);
    let says = "a shader of your own there, the built-in shaders here";
    assert!(code(&output) == 2 && stderr(&output).contains(says), "{}", stderr(&output));
}

#[test]
fn a_report_says_how_each_variable_was_found_and_which_inputs_have_none() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let file = folder("shader-found").join("own.glsl");
    let text = "vec3 shade(vec3 normal, vec3 L, vec3 md) { return md * max(dot(normal, L), 0.0); }";
    std::fs::write(&file, text).expect("it can be written");
    let function = format!("shade@{}", file.display());
    let run = ["run", "lighting/diffuse-toward", "--cases", "64", "--function", &function, "--bind", "md=md"];
    let output = lightmeter(&[&run[..], &["--format", "json"]].concat());
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let judged = &report["shader"]["formulas"][0];
    let variables = judged["variables"].as_array().expect("a list");
    let found: Vec<&str> = variables.iter().filter_map(|one| one["found"].as_str()).collect();
    assert_eq!((found, &judged["unbound"]), (vec!["synonym", "synonym", "asked"], &serde_json::json!(["ld"])));
    let told = stdout(&lightmeter(&run));
    assert!(told.contains("nothing in it stands for ld of lighting/diffuse-toward"), "{told}");
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_bench_measures_a_shader_beside_the_suites_own() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let file = shaders().join("right/blinn.frag").display().to_string();
    let wrong = shaders().join("mistakes/half-vector-mean.frag").display().to_string();
    for (file, options, is_right) in
        [(&file, &[][..], true), (&file, &["--constant", "shininess=32"], true), (&wrong, &[], false)]
    {
        let bench = ["bench", "lighting/blinn", "--quick", "--shader", file, "--format", "json"];
        let report = json(&[&bench[..], options].concat());
        let rows = &report["adapters"][0]["groups"][0]["rows"];
        let row = |name: &str| rows.as_array().into_iter().flatten().find(|row| row["name"] == name).cloned();
        let name = std::path::Path::new(file).file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let (own, ours) = (row(name).expect("it is there"), row("f32").expect("it is there"));
        assert!(own["time"]["ns"].is_number() && ours["time"]["ns"].is_number(), "{own}");
        assert_eq!(own["disqualified"].is_null(), is_right, "{own}");
        assert!(ours["disqualified"].is_null(), "{ours}");
    }
}

/// What is given, and what is said.
type Bad = (Vec<String>, &'static str);

fn bad_files() -> Vec<Bad> {
    let folder = folder("shader-bad");
    let file = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).expect("it can be written");
        path.display().to_string()
    };
    let head = "in vec3 Normal; in vec3 p; out vec4 c;\n";
    let main = |body: &str| format!("{head}void main() {{\n  vec3 x = Normal;\n  {body}\n}}\n");
    vec![
        (vec!["--shader".into(), folder.join("none.frag").display().to_string()], "cannot read"),
        (vec!["--shader".into(), file("a.txt", "")], "its ending names no language"),
        (vec!["--shader".into(), file("a.hlsl", "")], "dxc -spirv"),
        (vec!["--shader".into(), file("syntax.frag", &main("c = vec4(1.0;"))], "syntax.frag:4"),
        (
            vec!["--shader".into(), file("include.frag", "// a\n#include \"x.glsl\"\n")],
            "include.frag:2: `#include \"x.glsl\"` is not followed",
        ),
        (vec!["--shader".into(), file("bad.wgsl", "fn a() -> f32 {\n    return b;\n}\n")], "bad.wgsl:2"),
        (vec!["--shader".into(), file("bad.spv", "no words")], "it is no SPIR-V"),
        (vec!["--shader".into(), file("nothing.frag", "void main() {}\n")], "the shader gives nothing"),
        (vec!["--shader".into(), file("empty.frag", "")], "it has no function at all"),
        (vec!["--shader".into(), file("silent.frag", &main(""))], "it never writes c"),
        (
            vec!["--shader".into(), file("turns.frag", &main("for (;;) { x += 1.0; } c = vec4(x, 1.0);"))],
            "turns.frag:4: a loop has no way out",
        ),
        (
            vec!["--shader".into(), file("version.frag", &format!("#version 999\n{}", main("c = vec4(x, 1.0);")))],
            "version.frag:1: `#version 999` is no version of GLSL",
        ),
        (
            vec![
                "--shader".into(),
                file("rays.frag", &format!("#extension GL_EXT_ray_tracing : require\n{}", main("c = vec4(x, 1.0);"))),
            ],
            "rays.frag:1: the extension GL_EXT_ray_tracing is required",
        ),
        (vec!["--shader".into(), file("slope.frag", &main("c = vec4(dFdx(Normal), 1.0);"))], "derivatives"),
        (
            vec![
                "--shader".into(),
                file("unknown.frag", &format!("uniform float wobble;\n{}", main("c = vec4(Normal * wobble, 1.0);"))),
            ],
            "wobble: f32",
        ),
        (
            vec![
                "--shader".into(),
                file("type.frag", &format!("uniform ivec3 shininess;\n{}", main("c = vec4(vec3(shininess), 1.0);"))),
            ],
            "shininess: vec3<i32>",
        ),
    ]
}

fn bad_options(blinn: &str) -> Vec<Bad> {
    let blinn = blinn.to_owned();
    vec![
        (
            vec!["--shader".into(), blinn.clone(), "--bind".into(), "wobble=1.0".into()],
            "the shader has no `wobble` to bind",
        ),
        (
            vec!["--shader".into(), blinn.clone(), "--bind".into(), "shininess=shininess)*(2.0".into()],
            "expected WGSL of the type",
        ),
        (
            ["--constant", "shininess=1", "--constant", "shininess=2", "--shader", &blinn].map(String::from).to_vec(),
            "`--constant shininess` is given twice",
        ),
        (
            ["--constant", "la=ma", "--constant", "ma=la", "--shader", &blinn].map(String::from).to_vec(),
            "only one is said to be the other",
        ),
        (
            vec![
                "--shader".into(),
                blinn.clone(),
                "--bind".into(),
                "vNormal=la".into(),
                "--bind".into(),
                "vNormal=md".into(),
            ],
            "`vNormal` is bound twice",
        ),
        (vec!["--shader".into(), blinn.clone(), "--bind".into(), "vNormal=la.x".into()], "it has another type"),
        (vec!["--shader".into(), blinn.clone(), "--bind".into(), "vNormal=nothing".into()], "no definition in scope"),
        (vec!["--shader".into(), blinn.clone(), "--constant".into(), "wobble=1".into()], "has no input `wobble`"),
        (
            vec!["--shader".into(), blinn.clone(), "--constant".into(), "la=1".into()],
            "1 of 3 numbers of `la` in lighting/blinn",
        ),
        (vec!["--function".into(), "shade".into()], "names no file; expected NAME@FILE"),
        (vec!["--function".into(), format!("shade@{blinn}")], "it has no function `shade`"),
        (vec!["--bind".into(), "a=b".into()], "give the shader by"),
        (vec!["--shader".into(), blinn.clone(), "--adapter".into(), "cpu".into()], "has no shaders"),
    ]
}

#[test]
fn what_is_wrong_with_a_shader_is_told_with_what_would_do() {
    let blinn = shaders().join("right/blinn.frag").display().to_string();
    for (given, says) in bad_files().into_iter().chain(bad_options(&blinn)) {
        let args = [&["run".to_owned(), "lighting/blinn".to_owned()][..], &given].concat();
        let output = lightmeter(&args.iter().map(String::as_str).collect::<Vec<_>>());
        let said = stderr(&output);
        assert!(code(&output) == 2 && said.contains(says), "{given:?}: {}: {said}", code(&output));
    }
    for command in ["sweep", "show"] {
        let output = lightmeter(&[command, "fog/exp/random/000001", "--shader", &blinn, "--constant", "density=1"]);
        assert_eq!(code(&output), 2, "{command}: {}", stderr(&output));
    }
    let fog = shaders().join("documents/slides-fog.frag").display().to_string();
    let output = lightmeter(&["sweep", "fog/linear", "--over", "p.z", "--output", "f", "--shader", &fog]);
    assert!(code(&output) == 2 && stderr(&output).contains("does not give f"), "{}", stderr(&output));
    let output = lightmeter(&["run", "--shader", &blinn]);
    assert!(code(&output) == 2 && stderr(&output).contains("lightmeter identify FILE"), "{}", stderr(&output));
}

#[test]
fn a_shader_that_discards_or_has_no_end_fails() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let folder = folder("shader-runs");
    let text = std::fs::read_to_string(shaders().join("right/blinn.frag")).expect("it is there");
    let with = |name: &str, statement: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text.replace("    vec3 l =", &format!("    {statement}\n    vec3 l =")))
            .expect("it can be written");
        path.display().to_string()
    };
    let discards = with("discards.frag", "if (n.z < 0.0) discard;");
    let report = json(&["run", "lighting/blinn", "--cases", "256", "--shader", &discards, "--format", "json"]);
    assert!(report["totals"]["failed"].as_u64().is_some_and(|failed| failed > 100), "{}", report["totals"]);
    let output = lightmeter(&["run", "lighting/blinn", "--cases", "16", "--shader", &discards]);
    assert!(stderr(&output).contains("It discards fragments"), "{}", stderr(&output));
    let endless = with("endless.frag", "while (n.x == n.x) { n.x += 1.0; }");
    // lavapipe ends a loop after 65,535 turns, so that there is a verdict; another driver's device is lost, or the watch ends it.
    let output = lightmeter(&["run", "lighting/blinn", "--cases", "64", "--shader", &endless]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
}

/// Shaders as people write them, each right: what they are given and give is declared in ways that naga does not read.
const DIALECTS: [(&str, &str); 8] = [
    (
        "old-mac.frag",
        "#version 330\rin vec3 p; // the place\runiform vec3 fog, shaded;\runiform float density;\rout vec4 o;\r\
         void main() {\r  o = vec4(mix(fog, shaded, exp(-density * abs(p.z))), 1.0);\r}\r",
    ),
    (
        "data.frag",
        "varying vec3 p;\nuniform vec3 fog, shaded;\nuniform float density;\n\
         void main() { gl_FragData[1] = vec4(p, 1.0); gl_FragData[0] = vec4(mix(fog, shaded, exp(-density * abs(p.z))), 1.0); }",
    ),
    (
        "names.frag",
        "varying vec3 p;\nuniform vec3 fog;\nuniform sampler2D sampler;\nuniform float density;\n\
         void main() {\n  vec4 sample = texture2D(sampler, vec2(0.5));\n  float patch = exp(-density * abs(p.z));\n  \
         gl_FragColor = vec4(mix(fog, sample.rgb, patch), 1.0);\n}",
    ),
    (
        "bright.frag",
        "#version 330\nlayout(location = 1) out vec4 bright;\nlayout(location = 0) out vec4 shown;\nin vec3 p;\n\
         uniform vec3 fog, shaded;\nuniform float density;\n\
         void main() { shown = vec4(mix(fog, shaded, exp(-density * abs(p.z))), 1.0); bright = max(shown - 1.0, 0.0); }",
    ),
    (
        "bright.wgsl",
        "struct Given { @location(1) bright: vec4f, @location(0) shown: vec4f }\n\
         struct Scene { fog: vec3f, shaded: vec3f, density: f32 }\n@group(0) @binding(0) var<uniform> scene: Scene;\n\
         @fragment fn main(@location(0) p: vec3f) -> Given {\n    let c = mix(scene.fog, scene.shaded, exp(-scene.density * abs(p.z)));\n    \
         return Given(vec4f(max(c - 1.0, vec3f()), 1.0), vec4f(c, 1.0));\n}",
    ),
    (
        "fixed-function.frag",
        "varying vec3 p;\nuniform vec3 shaded;\n\
         void main() { gl_FragColor = vec4(mix(gl_Fog.color.rgb, shaded, exp(-gl_Fog.density * abs(p.z))), 1.0); }",
    ),
    (
        "beside.frag",
        "#version 330\nout vec4 o;\nvec3 foggy(vec3 fog, vec3 shaded, float density, vec3 p) { return mix(fog, shaded, exp(-density * abs(p.z))); }\n\
         void main() { o = vec4(foggy(vec3(1.0), vec3(0.0), 1.0, vec3(0.0)), 1.0); }",
    ),
    (
        "constants.glsl",
        "const float ONE = 1.0;\nconst float UNUSED = 3.0;\n\
         vec3 foggy(vec3 fog, vec3 shaded, float density, vec3 p) { return mix(fog, shaded, exp(-ONE * density * abs(p.z))); }\n",
    ),
];

#[test]
fn shaders_of_all_dialects_are_read() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let folder = folder("dialects");
    for (name, text) in DIALECTS {
        let path = folder.join(name);
        std::fs::write(&path, text).expect("it can be written");
        let file = path.display().to_string();
        let judged = if text.contains("foggy") {
            ["--function".to_owned(), format!("foggy@{file}")]
        } else {
            ["--shader".to_owned(), file]
        };
        let [option, value] = judged.each_ref().map(String::as_str);
        let output = lightmeter(&["run", "fog/exp", "--cases", "64", option, value]);
        assert_eq!(code(&output), 0, "{name}: {}{}", stdout(&output), stderr(&output));
        let wrong = std::fs::read_to_string(&path).expect("it is there").replace("abs(p.z)", "length(p)");
        std::fs::write(&path, wrong).expect("it can be written");
        let output = lightmeter(&["run", "fog/exp", "--cases", "64", option, value]);
        assert!(code(&output) == 1 && stdout(&output).contains("(fog-radial)"), "{name}: {}", stdout(&output));
    }
}

#[test]
fn the_page_has_all_names() {
    let page = include_str!("../../docs/shaders.md");
    let output = lightmeter(&["identify", "--names"]);
    assert!(page.contains(&stdout(&output)), "write the table again: lightmeter identify --names");
}

#[test]
fn blend_states_are_read_as_people_write_them() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let output = lightmeter(&["show", "glBlendFunc(GL_SRC_ALPHA, GL_ONE)"]);
    let text = stdout(&output);
    assert!(
        text.starts_with("blend/add/src-alpha/one\n") && text.contains("commonly confused with blend/add/one/one"),
        "{text}"
    );
    let state =
        r#"{"color": {"srcFactor": "dst", "dstFactor": "zero"}, "alpha": {"srcFactor": "one", "dstFactor": "zero"}}"#;
    let report =
        json(&["run", "--blend", state, "--blend", "glDepthFunc(GL_LEQUAL)", "--cases", "64", "--format", "json"]);
    let ids: BTreeSet<&str> =
        report["groups"].as_array().expect("a list").iter().filter_map(|group| group["id"].as_str()).collect();
    assert!(ids.iter().any(|id| id.starts_with("blend/")) && ids.contains("depth/test"), "{ids:?}");
    let output = lightmeter(&["run", "--blend", "glBlendFunc(GL_SRC_ALPA, GL_ONE)"]);
    assert!(code(&output) == 2 && stderr(&output).contains("did you mean `src-alpha`"), "{}", stderr(&output));
}

#[test]
fn a_loop_whose_condition_never_ends_it_fails_and_one_that_ends_does_not() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let folder = folder("shader-turns");
    let judged = |name: &str, turns: &str| {
        let path = folder.join(name);
        let text = format!(
            "#version 330\nin vec3 n; uniform vec3 l; uniform vec3 ld; uniform vec3 md;\nout vec4 color;\n\
             void main() {{ float s = 0.0; int i = 0; {turns} color = vec4(ld * md * max(dot(n, l), 0.0) * s, 1.0); }}\n"
        );
        std::fs::write(&path, text).expect("it can be written");
        let file = path.display().to_string();
        let args = [
            "run",
            "lighting/diffuse-toward",
            "--cases",
            "256",
            "--shader",
            &file,
            "--bind",
            "n=n",
            "--format",
            "json",
        ];
        let output = lightmeter(&args);
        let report: serde_json::Value = serde_json::from_str(&stdout(&output)).expect("it is JSON");
        (stderr(&output), report["totals"]["failed"].clone(), report["totals"]["verdicts"].clone())
    };
    let (said, failed, verdicts) = judged("endless.frag", "while (i >= 0) { s += 1.0; if (s > 1e9) break; i = 1; }");
    assert!(said.contains("turn more than 16,384 times"), "{said}");
    assert_eq!(failed, verdicts);
    let (said, failed, _) = judged("ends.frag", "for (i = 0; i < 4000; ++i) { s += 0.00025; } s = 1.0;");
    assert!(said.contains("It has loops"), "{said}");
    assert_eq!(failed, 0, "{said}");
}

#[test]
#[ignore = "long: ./x campaign long"]
fn the_formula_that_is_meant_is_the_nearest_one_and_not_one_that_mistakes_lead_to() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let told = |text: &str| {
        let file = folder.path().join("shader.frag");
        std::fs::write(&file, text).expect("it is written");
        lightmeter(&["identify", &file.to_string_lossy()])
    };
    // It normalises what is a unit vector already. Phong's without two of its terms is far away.
    let lambert = told(
        "uniform vec3 lightDir, lightColor, albedo; varying vec3 vNormal; void main() { gl_FragColor = \
         vec4(lightColor * albedo * max(dot(normalize(vNormal), normalize(lightDir)), 0.0), 1.0); }",
    );
    assert!(stdout(&lambert).contains("computes lighting/diffuse-toward."), "{}", stdout(&lambert));
    let white = told("void main() { gl_FragColor = vec4(1.0); }");
    assert!(code(&white) == 2 && stderr(&white).contains("its result is always the same"), "{}", stderr(&white));
    let fog = told(
        "uniform vec3 fogColor, mystery; uniform float fogDensity; varying float vFogDepth; void main() { gl_FragColor = vec4(mix(mystery, fogColor, 1.0 - exp(-fogDensity * vFogDepth)), 1.0); }",
    );
    assert!(stderr(&fog).contains("nothing of fog/exp is known to be meant by\n  mystery"), "{}", stderr(&fog));
}
