//! Shaders as people write them, and the steps that are found in each.

use lightmeter_document::report::{ShaderReview, StepVerdict};
use lightmeter_shaders::Reviewer;
use lightmeter_shaders::read::ReadOptions;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

static REVIEWER: LazyLock<Reviewer> = LazyLock::new(|| Reviewer::new().expect("the forms are read"));

static NAMES: LazyLock<Vec<String>> = LazyLock::new(lightmeter_shaders::accepted::names);

fn file(name: &str, text: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("steps-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    let path = folder.join(name);
    std::fs::write(&path, text).expect("the folder can be written to");
    path
}

fn review(name: &str, text: &str) -> ShaderReview {
    let path = file(name, text);
    REVIEWER.review(&path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// `line kind verdict name` of each step.
fn steps(name: &str, text: &str) -> Vec<String> {
    steps_of(&review(name, text))
}

fn steps_of(found: &ShaderReview) -> Vec<String> {
    // What has a name can be accepted by it.
    let named = found.steps.iter().filter(|step| step.verdict != StepVerdict::Right && !step.name.is_empty());
    for step in named {
        assert!(NAMES.contains(&step.name), "`{}` is not among the names", step.name);
    }
    let word = |verdict: StepVerdict| match verdict {
        StepVerdict::Right => "right",
        StepVerdict::Dialect => "dialect",
        StepVerdict::Mistake => "mistake",
        StepVerdict::Perhaps => "perhaps",
    };
    let told = |step: &lightmeter_document::report::ShaderStep| {
        format!("{} {} {} {}", step.line, step.kind, word(step.verdict), step.name).trim_end().to_owned()
    };
    found.steps.iter().map(told).collect()
}

const HEAD: &str = "#version 330 core
in vec3 normal; in vec3 position; out vec4 color;
uniform vec3 lightPosition, eyePosition, lightColor, material, ambient;
uniform float shininess, kc, kl, kq;
void main() {
vec3 n = normalize(normal); vec3 l = normalize(lightPosition - position); vec3 v = normalize(eyePosition - position);
";

/// The steps of a body that begins on line 7.
fn body(name: &str, text: &str) -> Vec<String> {
    steps(&format!("{name}.frag"), &format!("{HEAD}{text}\n}}\n"))
}

#[test]
fn what_is_right_is_right_however_it_is_written() {
    let rows: &[(&str, &str, &[&str])] = &[
        ("max", "color = vec4(material * lightColor * max(dot(n, l), 0.0), 1.0);", &["7 lambert right"]),
        ("clamp", "color = vec4(material * lightColor * clamp(dot(l, n), 0.0, 1.0), 1.0);", &["7 lambert right"]),
        (
            "branch",
            "float c = dot(n, l);\nif (c < 0.0) c = 0.0;\ncolor = vec4(material * lightColor * c, 1.0);",
            &["8 lambert right"],
        ),
        (
            "reflect by hand",
            "vec3 r = 2.0 * dot(n, l) * n - l;\ncolor = vec4(lightColor * pow(max(dot(r, v), 0.0), shininess), 1.0);",
            &["8 phong right"],
        ),
        (
            "half vector by length",
            "vec3 h = (l + v) / length(l + v);\ncolor = vec4(lightColor * pow(max(dot(n, h), 0.0), shininess), 1.0);",
            &["8 blinn right"],
        ),
        (
            "attenuation by Horner",
            "float d = distance(lightPosition, position);\ncolor = vec4(material * max(dot(n, l), 0.0) / (kc + d * (kl + d * kq)), 1.0);",
            &["8 lambert right", "8 attenuation right"],
        ),
    ];
    for (name, text, expected) in rows {
        assert_eq!(body(name, text), *expected, "{name}");
    }
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn each_mistake_is_called_by_its_name() {
    let rows: &[(&str, &str, &str)] = &[
        ("not clamped", "color = vec4(material * lightColor * dot(n, l), 1.0);", "7 lambert mistake not-clamped"),
        (
            "both sides",
            "color = vec4(material * lightColor * abs(dot(n, l)), 1.0);",
            "7 lambert mistake incidence-of-both-sides",
        ),
        (
            "light reversed",
            "vec3 w = normalize(position - lightPosition);\ncolor = vec4(material * lightColor * max(dot(n, w), 0.0), 1.0);",
            "8 lambert mistake light-reversed",
        ),
        (
            "not normalised",
            "color = vec4(material * lightColor * max(dot(normal, l), 0.0), 1.0);",
            "7 length mistake normal-not-normalised",
        ),
        (
            "mean",
            "color = vec4(lightColor * pow(max(dot(n, (l + v) * 0.5), 0.0), shininess), 1.0);",
            "7 blinn mistake half-vector-as-mean",
        ),
        (
            "unguarded",
            "color = vec4(lightColor * pow(dot(n, normalize(l + v)), shininess), 1.0);",
            "7 blinn mistake unguarded",
        ),
        (
            "eye reversed",
            "color = vec4(lightColor * max(dot(n, l), 0.0) + lightColor * pow(max(dot(reflect(-l, n), -v), 0.0), shininess), 1.0);",
            "7 phong mistake view-reversed",
        ),
        (
            "times lambert",
            "float c = max(dot(n, l), 0.0);\ncolor = vec4(lightColor * c * (material + pow(max(dot(n, normalize(l + v)), 0.0), shininess)), 1.0);",
            "8 terms mistake highlight-times-lambert",
        ),
        (
            "one attenuated",
            "float d = length(lightPosition - position); float a = 1.0 / (kc + kl * d + kq * d * d);\n\
             color = vec4(a * material * max(dot(n, l), 0.0) + lightColor * pow(max(dot(n, normalize(l + v)), 0.0), shininess), 1.0);",
            "8 terms mistake specular-not-attenuated",
        ),
        (
            "ambient as a factor",
            "color = vec4(ambient * material * lightColor * max(dot(n, l), 0.0), 1.0);",
            "7 terms mistake ambient-multiplies-diffuse",
        ),
        (
            "no value",
            "vec3 sum;\nsum += material * max(dot(n, l), 0.0);\ncolor = vec4(sum, 1.0);",
            "8 value mistake not-initialised",
        ),
        (
            "first term alone",
            "float d = length(lightPosition - position);\ncolor = vec4(material * max(dot(n, l), 0.0) * (1.0 / kc + kl * d + kq * d * d), 1.0);",
            "8 attenuation mistake reciprocal-of-the-first-term",
        ),
    ];
    for (name, text, expected) in rows {
        let found = body(name, text);
        assert!(found.iter().any(|own| own == expected), "{name}: {found:?}");
        let mistakes = found.iter().filter(|own| own.contains(" mistake ")).count();
        assert_eq!(mistakes, 1, "{name}: {found:?}");
    }
}

#[test]
fn what_looks_like_a_step_and_is_none_is_not_claimed() {
    let rows = [
        ("shadow bias", "float bias = max(0.05 * (1.0 - dot(n, l)), 0.005);\ncolor = vec4(material * bias, 1.0);"),
        ("unlit", "color = vec4(material * dot(material, vec3(0.2126, 0.7152, 0.0722)), 1.0);"),
        ("vignette", "color = vec4(material * clamp(1.0 - length(position.xy), 0.2, 1.0), 1.0);"),
        ("alpha alone", "color.rgb = material;"),
    ];
    for (name, text) in rows {
        let found = body(name, text);
        assert!(found.is_empty(), "{name}: {found:?}");
    }
}

#[test]
fn fog_is_told_by_its_form_and_how_it_is_mixed() {
    let head = "varying vec3 p; uniform vec3 fogColor, lit; uniform float fogStart, fogEnd, density;\nvoid main() { float d = length(p);\n";
    let rows: &[(&str, &str, &[&str])] = &[
        (
            "exp",
            "float f = exp(-density * d);\ngl_FragColor = vec4(mix(fogColor, lit, f), 1.0);",
            &["3 fog right exp", "4 fog-mix right"],
        ),
        (
            "turned",
            "float f = exp(-density * d);\ngl_FragColor = vec4(mix(lit, fogColor, f), 1.0);",
            &["3 fog right exp", "4 fog-mix mistake fog-mixed-the-wrong-way"],
        ),
        (
            "linear",
            "float f = clamp((fogEnd - d) / (fogEnd - fogStart), 0.0, 1.0);\ngl_FragColor = vec4(mix(fogColor, lit, f), 1.0);",
            &["3 fog right", "4 fog-mix right"],
        ),
        (
            "base two",
            "float f = exp2(-density * d);\ngl_FragColor = vec4(mix(fogColor, lit, f), 1.0);",
            &["3 fog mistake fog-base-two", "4 fog-mix right"],
        ),
        (
            "by log2(e)",
            "float f = exp2(-density * density * d * d * 1.442695);\ngl_FragColor = vec4(mix(fogColor, lit, f), 1.0);",
            &["3 fog right exp2-opengl", "4 fog-mix right"],
        ),
    ];
    for (name, text, expected) in rows {
        assert_eq!(steps(&format!("fog {name}.fs"), &format!("{head}{text}\n}}\n")), *expected, "{name}");
    }
}

#[test]
fn all_languages_give_the_same_steps() {
    let wgsl = "struct In { @location(0) normal: vec3f, @location(1) position: vec3f }
@group(0) @binding(0) var<uniform> lightPosition: vec3f;
@fragment fn main(i: In) -> @location(0) vec4f {
  let l = normalize(lightPosition - i.position);
  return vec4f(vec3f(max(dot(normalize(i.normal), l), 0.0)), 1.0);
}
";
    assert_eq!(steps("language.wgsl", wgsl), ["5 lambert right"]);
    let old = "varying vec3 normal, position;\nvoid main() {\n  vec3 l = normalize(gl_LightSource[0].position.xyz - position);\n  gl_FragColor = gl_FrontMaterial.diffuse * max(dot(normalize(normal), l), 0.0);\n}\n";
    assert_eq!(steps("language.fs", old), ["4 lambert right"]);
    assert_eq!(steps("carriage.fs", &old.replace('\n', "\r")), ["4 lambert right"]);
    let function = "float lit(vec3 normal, vec3 toLight) {\n  return max(dot(normal, toLight), 0.0);\n}\n";
    assert_eq!(steps("function.glsl", function), ["2 lambert right"]);
}

#[test]
fn what_is_not_there_is_stubbed_and_said() {
    let text = "#include \"missing.h\"\nvarying vec3 normal;\nuniform vec3 toLight;\nvoid main() {\n  gl_FragColor = vec4(albedo * max(dot(normalize(normal), toLight), 0.0), 1.0);\n}\n";
    let found = review("missing.fs", text);
    assert_eq!(found.steps[0].line, 5);
    assert!(found.notes.iter().any(|note| note.contains("missing.h") && note.contains("-I DIR")), "{:?}", found.notes);
    assert!(found.notes.iter().any(|note| note.contains("`albedo` is not declared")), "{:?}", found.notes);
}

#[test]
fn types_that_are_declared_nowhere_are_structures_of_what_is_asked_of_them() {
    let text = "vec3 lit(vec3 n, LightData light, float visibility) {\n  vec3 l = normalize(light.position.xyz - getPoint(n, 1.0).xyz);\n  return light.colors[0].rgb * scene.exposure * max(dot(normalize(n), l), 0.0);\n}\n";
    let found = review("type.glsl", text);
    let steps: Vec<(u32, &str)> = found.steps.iter().map(|step| (step.line, &*step.kind)).collect();
    assert_eq!(steps, [(3, "lambert")], "{found:?}");
    let notes = found.notes.join("; ");
    assert!(
        notes.contains("the type `LightData` is declared nowhere") && notes.contains("`position`, `colors`"),
        "{notes}"
    );
    assert!(notes.contains("`scene` is not declared: taken as a structure"), "{notes}");
    assert!(notes.contains("the function `getPoint` is not there: what it gives is taken as a vec3"), "{notes}");
    let wgsl = "#import host::types\n@fragment fn main(input: host::Input) -> @location(0) vec4f {\n  let l = normalize(light.position.xyz - input.world);\n  return vec4f(light.color.rgb * max(dot(normalize(input.normal), l), 0.0), 1.0);\n}\n";
    assert_eq!(steps_of(&review("type.wgsl", wgsl)), ["4 lambert right"]);
}

#[test]
fn what_nobody_reads_is_left_out_and_said_and_no_term_is_missed_then() {
    let text = "varying vec3 normal;\nuniform vec3 toLight;\nvoid odd() {\n  int a[3] = @;\n}\nvoid main() {\n  vec3 color = ### 1;\n  gl_FragColor = vec4(color * max(dot(normalize(normal), toLight), 0.0), 1.0);\n}\n";
    let found = review("odd.fs", text);
    assert_eq!(steps_of(&found), ["8 lambert right"]);
    assert!(found.notes.iter().any(|note| note.starts_with("line 7 is not read")), "{:?}", found.notes);
    // The statement that is left out might be what is missing.
    let unset = |odd: &str| {
        let text = format!(
            "varying vec3 normal;\nuniform vec3 toLight;\nvoid main() {{\n  vec3 sum;\n  {odd}\n  sum += vec3(max(dot(normalize(normal), toLight), 0.0));\n  gl_FragColor = vec4(sum, 1.0);\n}}\n"
        );
        steps_of(&review("unset.fs", &text)).join(", ")
    };
    assert!(unset("").contains("value mistake"), "{}", unset(""));
    assert!(unset("sum ??= 1;").contains("value perhaps"), "{}", unset("sum ??= 1;"));
}

#[test]
fn a_function_that_is_not_there_may_set_what_it_is_given() {
    let text = |call: &str| {
        format!(
            "varying vec3 normal;\nuniform vec3 toLight;\nvoid main() {{\n  vec3 t;\n  {call}\n  gl_FragColor = vec4(t * max(dot(normalize(normal), toLight), 0.0), 1.0);\n}}\n"
        )
    };
    let verdict = |call: &str| {
        steps("given.fs", &text(call)).into_iter().find(|step| step.contains("value")).expect("it is told")
    };
    assert!(verdict("basis(normal, t);").contains("perhaps"));
    assert!(verdict("").contains("mistake"));
}

#[test]
fn shaders_are_read_as_hosts_wrap_them() {
    let lit = "gl_FragColor = vec4(max(dot(normalize(normal), toLight), 0.0));";
    let head = "varying vec3 normal;\nuniform vec3 toLight;\n";
    let sections = format!(
        "#shader vertex\nattribute vec4 at;\nvoid main() {{ gl_Position = at; }}\n#shader fragment\n{head}void main() {{\n  {lit}\n}}\n"
    );
    assert_eq!(steps("sections.glsl", &sections), ["8 lambert right"]);
    let strings = format!(
        "const char* a = R\"(\nattribute vec4 at;\nvoid main() {{ gl_Position = at; }}\n)\";\nconst char* b = R\"x(\n{head}void main() {{\n  {lit}\n}}\n)x\";\n"
    );
    assert_eq!(steps("strings.glsl", &strings), ["9 lambert right"]);
    let switched = format!(
        "{head}#ifdef VERTEX_SHADER\nattribute vec4 at;\nvoid main() {{ gl_Position = at; }}\n#endif\n#ifdef FRAGMENT_SHADER\nvoid main() {{\n  {lit}\n}}\n#endif\n"
    );
    assert_eq!(steps("switched.glsl", &switched), ["9 lambert right"]);
    let godot = "shader_type spatial;\nuniform vec3 normal_of : hint_normal;\nuniform vec3 sun = vec3(0.0, 1.0, 0.0);\nvoid fragment() {\n  ALBEDO = vec3(max(dot(normalize(normal_of), normalize(sun)), 0.0));\n}\n";
    assert_eq!(steps("godot.glsl", godot), ["5 lambert right"]);
}

#[test]
fn what_is_not_used_is_told_so_and_what_ends_a_turn_is_read() {
    let text = "varying vec3 normal;\nuniform vec3 toLight;\nvoid main() {\n  float lit = max(dot(normalize(normal), toLight), 0.0);\n  gl_FragColor = vec4(1.0);\n}\n";
    let found = review("unused.fs", text);
    assert_eq!(steps_of(&found), ["4 lambert right"]);
    assert!(found.steps[0].sentence.ends_with("it does not enter an output's arithmetic"), "{found:?}");
    let turn = "@fragment fn main(@location(0) normal: vec3f, @location(1) toLight: vec3f) -> @location(0) vec4f {\n  var sum = 0.0;\n  var i = 0;\n  loop {\n    if (i >= 4) { break; }\n    continuing {\n      sum += max(dot(normalize(normal), normalize(toLight)), 0.0);\n      i++;\n    }\n  }\n  return vec4f(sum);\n}\n";
    assert_eq!(steps("turn.wgsl", turn), ["7 lambert right"]);
}

#[test]
fn what_is_right_elsewhere_is_no_mistake_where_it_stands_for_something_else() {
    // A shadow on a plane divides the same products; where a vertex comes to is not lit.
    let shadow = "attribute vec3 aPosition;\nuniform vec3 uPlaneNormal, uPlane, uLightLocation;\nvoid main() {\n  vec3 v = aPosition;\n  vec3 on = uLightLocation + (v - uLightLocation) * (dot(uPlaneNormal, uPlane - uLightLocation) / dot(uPlaneNormal, v - uLightLocation));\n  gl_Position = vec4(on, 1.0);\n}\n";
    assert_eq!(steps("shadow.vert", shadow), [""; 0]);
    // Which side a difference of two places points to, nobody knows.
    let moved = "attribute vec3 aPosition, aNormal;\nuniform mat4 uM;\nuniform vec3 uLightLocation;\nvarying float lit;\nvoid main() {\n  vec3 v = (uM * vec4(aPosition, 1.0)).xyz;\n  vec3 n = normalize((uM * vec4(aPosition + aNormal, 1.0)).xyz - v), l = normalize(uLightLocation - v);\n  lit = max(0.0, dot(n, l));\n  gl_Position = vec4(aPosition, 1.0);\n}\n";
    let found = steps("moved.vert", moved);
    assert!(found.iter().any(|step| step == "8 lambert right"), "{found:?}");
    assert!(found.iter().all(|step| !step.contains("mistake")), "{found:?}");
    // A square within another formula is none of the cosine's own.
    let smith = "float smith(vec3 normal, vec3 light, float a) {\n  float c = max(dot(normal, light), 0.0);\n  float square = c * c;\n  return 2.0 * c / (c + sqrt(a + (1.0 - a) * square));\n}\n";
    assert!(steps("smith.glsl", smith).iter().all(|step| !step.contains("mistake")));
    // Of an atmosphere, more of it below is no lost sign.
    let sky = "uniform float fDensity;\nvarying float fDepth;\nvoid main() {\n  gl_FragColor = vec4(exp(fDensity * fDepth));\n}\n";
    assert!(steps("sky.fs", sky).iter().all(|step| !step.contains("mistake")));
}

#[test]
fn a_steep_ramp_is_no_edge_and_terms_of_other_lights_are_no_measure() {
    let head = "varying vec3 normal, at;\nuniform vec3 lightPos, spotDirection, sunDirection, halfVector;\nuniform float isSun, kc, kl, kq;\n";
    let ramp = format!(
        "{head}void main() {{\n  vec3 l = normalize(lightPos - at);\n  float angle = dot(vec3(0.0, -1.0, 0.0), -l);\n  float inten = clamp((angle - 0.9) / (0.95 - 0.9), 0.0, 1.0);\n  gl_FragColor = vec4(inten * max(dot(normalize(normal), l), 0.0));\n}}\n"
    );
    let found = steps("steep.fs", &ramp);
    assert!(found.iter().any(|step| step == "7 spot dialect ramp") && found.len() == 2, "{found:?}");
    let edge = ramp.replace("clamp((angle - 0.9) / (0.95 - 0.9), 0.0, 1.0)", "(angle > 0.9 ? 1.0 : 0.0)");
    assert!(steps("edge.fs", &edge).iter().any(|step| step.contains("spot right")), "{:?}", steps("edge.fs", &edge));
    // The sun is not attenuated, and the lamp is: neither lacks anything.
    let lambert = |l: &str| format!("lightColor * max(dot(n, normalize({l})), 0.0)");
    let fading = "float d = length(lightPos - at); float fade = 1.0 / (kc + kl * d + kq * d * d);";
    let shine = "lightColor * pow(max(dot(n, normalize(halfVector)), 0.0), 8.0)";
    let text = |first: &str| {
        format!(
            "{head}uniform vec3 lightColor;\nvoid main() {{\n  vec3 n = normalize(normal), color = vec3(0.0);\n  {fading}\n  if (isSun == 1.0) {{ color += {first} + {shine}; }}\n  else {{ color += {} * fade; }}\n  gl_FragColor = vec4(color, 1.0);\n}}\n",
            lambert("lightPos - at")
        )
    };
    let found = steps("lights.fs", &text(&lambert("sunDirection")));
    assert!(found.iter().all(|step| !step.contains("mistake")), "{found:?}");
    let found = steps("shine.fs", &text("vec3(0.0)"));
    assert!(found.iter().all(|step| !step.contains("mistake")), "{found:?}");
    // Of one light it does.
    let found = steps("lacks.fs", &text(&(lambert("lightPos - at") + " * fade")));
    assert!(found.iter().any(|step| step.contains("terms mistake specular-not-attenuated")), "{found:?}");
}

#[test]
fn a_component_has_to_have_a_value_only_where_it_is_used() {
    let text = |set: &str, used: &str| {
        format!(
            "varying vec2 at;\nuniform vec4 tint;\nvoid main() {{\n  vec4 r;\n  {set}\n  vec4 s = r * tint;\n  gl_FragColor = vec4({used}, 0.0, 1.0);\n}}\n"
        )
    };
    assert_eq!(steps("unset.fs", &text("", "s.xy + s.zw")), ["6 value mistake not-initialised"]);
    assert_eq!(steps("in-part.fs", &text("r.xy = at;", "s.xy + s.zw")), ["6 value mistake not-initialised"]);
    assert_eq!(steps("set.fs", &text("r.xy = at;", "s.xy")), Vec::<String>::new());
    assert_eq!(steps("one.fs", &text("r.xy = at;", "at * s.x")), Vec::<String>::new());
    assert_eq!(steps("whole.fs", &text("r.xy = at;", "s.xy * length(s)")), ["6 value mistake not-initialised"]);
}

#[test]
fn a_cone_is_a_cone_and_a_half_vector_no_light() {
    let head = "varying vec3 normal, toLight, toEye;\nuniform vec3 spotDirection, lightDirection;\nuniform float inner, outer, spotExponent;\n";
    let text = |body: &str| {
        format!("{head}void main() {{\n  vec3 l = normalize(toLight), n = normalize(normal);\n  {body}\n}}\n")
    };
    let by_branches = "float c = dot(-l, normalize(spotDirection)), cone = 1.0;\n  if (c < outer) cone = 0.0;\n  else if (c < inner) cone = (c - outer) / (inner - outer);\n  gl_FragColor = vec4(cone * max(dot(n, l), 0.0));";
    let found = steps("cone-by-branches.fs", &text(by_branches));
    assert_eq!(found, ["8 spot right", "8 spot dialect ramp", "9 lambert right"]);
    let by_half = "float cone = pow(max(dot(normalize(spotDirection), normalize(l + normalize(toEye))), 0.0), spotExponent);\n  gl_FragColor = vec4(cone * max(dot(n, l), 0.0));";
    assert_eq!(steps("cone-by-half.fs", &text(by_half)), ["6 spot right", "7 lambert right"]);
    let toon = "float c = dot(normal, normalize(lightDirection + toEye));\n  gl_FragColor = vec4(c);";
    assert_eq!(steps("toon.fs", &text(toon)), Vec::<String>::new());
}

#[test]
fn a_place_is_no_normal_and_what_makes_a_form_good_is_part_of_it() {
    let moved = "attribute vec3 position, normal;\nuniform mat4 modelView, projection;\nvarying vec3 n, at;\nvoid main() {\n  n = mat3(modelView) * normal;\n  at = normalize((modelView * vec4(position + normal, 1.0)).xyz);\n  gl_Position = projection * vec4(at, 1.0);\n}\n";
    assert_eq!(steps("moved.vs", moved), ["5 normal-transform right"]);
    // k.y · d + k.z · d · d may be read as one coefficient of d: the squared term is not missing.
    let fade = "varying vec3 normal, at;\nuniform vec3 lightPos, k;\nvoid main() {\n  vec3 l = lightPos - at;\n  float d = length(l);\n  float fade = 1.0;\n  if (d != 0.0) {\n    fade = 1.0 / (k.x + (k.y * d) + (k.z * d * d));\n    fade = clamp(fade, 0.0, 1.0);\n  }\n  gl_FragColor = vec4(fade * max(dot(normalize(normal), normalize(l)), 0.0));\n}\n";
    assert_eq!(steps("fade.fs", fade), ["8 attenuation right", "11 lambert right"]);
    // naga's reader of GLSL takes one number for three.
    let parts = "varying vec3 normal, toLight;\nuniform vec4 q;\nstruct Data { vec3 world; } pos;\nvoid main() {\n  pos.world = q.x;\n  float shade = max(dot(normalize(normal), normalize(toLight)), 0.0);\n  gl_FragColor = vec4(length(pos.world.xyz) * shade);\n}\n";
    assert_eq!(steps("parts.fs", parts), ["6 lambert right"]);
}

#[test]
fn a_coefficient_is_not_made_of_the_distance_and_a_sign_may_be_a_constants() {
    let distance = "float d = length(lightPosition - position);\nfloat lit = max(dot(n, l), 0.0);\n";
    let of = |name: &str, factor: &str| {
        body(name, &format!("{distance}color = vec4(material * lightColor * lit * {factor}, 1.0);"))
            .into_iter()
            .filter(|step| step.contains("attenuation"))
            .collect::<Vec<_>>()
    };
    assert_eq!(of("squared", "(1.0 / (kc + kl * d + kq * d * d))"), ["9 attenuation right"]);
    assert_eq!(of("cubed", "(1.0 / (kc + kl * d + kq * d * d * d))"), [""; 0]);
    assert_eq!(of("root", "(1.0 / (kc + kl * sqrt(d) + kq * d * d))"), [""; 0]);
    // Floors are parts of the coefficients, and a small coefficient is one.
    let form = |name: &str, factor: &str| {
        let text = format!("{HEAD}{distance}color = vec4(material * lightColor * lit * {factor}, 1.0);\n}}\n");
        let found = review(name, &text);
        let function = found.steps.into_iter().find(|step| step.kind == "attenuation").and_then(|step| step.function);
        function.map(|own| (own.form, own.wgsl.contains("max("))).unwrap_or_default()
    };
    let floors = "(1.0 / (kc + max(kl, 0.03) * d + max(kq, 0.03) * d * d))";
    assert_eq!(form("floors.frag", floors), ("attenuation".into(), false));
    let small = "(1.0 / (1.0 + 0.00002 * d + 0.0003 * d * d))";
    assert_eq!(form("small.frag", small), ("attenuation_one".into(), false));
    let fog = |name: &str, factor: &str| {
        body(name, &format!("color = vec4(mix(ambient, material, {factor}), 1.0);"))
            .into_iter()
            .filter(|step| step.starts_with("7 fog ") || step.contains("mistake"))
            .collect::<Vec<_>>()
    };
    assert_eq!(fog("signed", "exp(-0.05 * length(position))"), ["7 fog right exp"]);
    assert_eq!(fog("unsigned", "exp(0.05 * length(position))"), ["7 fog mistake fog-exponent-positive"]);
    let formula = |text: &str| {
        let found = review("function.frag", &format!("{HEAD}{text}\n}}\n"));
        found.steps.into_iter().filter_map(|step| step.function.map(|own| own.wgsl)).collect::<Vec<_>>()
    };
    // A vector that the step normalises is a unit vector to it, and a constant is a part of it.
    let functions = formula("color = vec4(lightColor * pow(max(dot(reflect(-l, n), v), 0.0), 32.0), 1.0);");
    assert!(
        functions.len() == 1 && functions[0].contains("32.0f") && !functions[0].contains("normalize"),
        "{functions:?}"
    );
    // What is a claim only by its use is none by itself.
    assert_eq!(formula("color = vec4(material * lightColor * dot(n, l), 1.0);"), [""; 0]);
}

#[test]
fn what_has_no_value_is_not_guarded_by_a_limit() {
    let text = |power: &str| {
        format!(
            "varying vec3 normal, toLight, toEye;\nvoid main() {{\n  vec3 n = normalize(normal);\n  float lit = max(0.0, dot(n, normalize(toLight)));\n  vec3 h = normalize(normalize(toLight) + normalize(toEye));\n  gl_FragColor = vec4(lit, {power}, 0.0, 1.0);\n}}\n"
        )
    };
    let late = steps("late.fs", &text("max(0.0, pow(dot(n, h), 50.0))"));
    assert_eq!(late, ["4 lambert right", "6 blinn mistake unguarded"]);
    assert_eq!(steps("early.fs", &text("pow(max(dot(n, h), 0.0), 50.0)")), ["4 lambert right", "6 blinn right"]);
}

#[test]
fn included_files_are_read_below_the_folders_that_are_given_and_nowhere_else() {
    let include = file("factor.h", "float factor(vec3 n, vec3 l) { return max(dot(n, l), 0.0); }\n");
    let folder = include.parent().expect("a folder").to_owned();
    let text = "#include \"factor.h\"\nvarying vec3 normal;\nuniform vec3 toLight;\nvoid main() {\n  gl_FragColor = vec4(factor(normalize(normal), toLight));\n}\n";
    let path = file("includes.fs", text);
    let options = ReadOptions { include: vec![folder.clone()], defines: vec![] };
    let found = REVIEWER.review(&path, &options).expect("it is read");
    // What is included is of the directive's line.
    assert_eq!((found.steps[0].line, found.notes.len()), (1, 0), "{found:?}");
    // One that is there, above the folder.
    let inside = folder.join("inside");
    std::fs::create_dir_all(&inside).expect("a folder");
    let above = file("above.fs", &text.replace("factor.h", "../factor.h"));
    let options = ReadOptions { include: vec![inside], defines: vec![] };
    let found = REVIEWER.review(&above, &options).expect("it is read without");
    assert!(found.notes.iter().any(|note| note.contains("is not there")), "{:?}", found.notes);
}

#[test]
fn macros_of_the_host_choose_what_is_read() {
    let text = "varying vec3 normal;\nuniform vec3 toLight;\nvoid main() {\n#if LIGHTS == 2\n  gl_FragColor = vec4(abs(dot(normalize(normal), toLight)));\n#else\n  gl_FragColor = vec4(max(dot(normalize(normal), toLight), 0.0));\n#endif\n}\n";
    let path = file("macros.fs", text);
    let options = ReadOptions { include: vec![], defines: vec![("LIGHTS".into(), "2".into())] };
    let found = REVIEWER.review(&path, &options).expect("it is read");
    assert_eq!((found.steps.len(), found.steps[0].line), (1, 5), "{found:?}");
    // Without them each is tried that it compares with.
    let found = review("macros.fs", text);
    assert!(found.steps.iter().any(|step| step.line == 5), "{found:?}");
}

#[test]
fn a_loop_shows_its_first_turn_and_no_array_is_called_unset() {
    let text = "varying vec3 normal;\nuniform vec3 lights[4], colors[4];\nvoid main() {\n  vec3 sum = vec3(0.0); float c[4];\n  for (int i = 0; i < 4; i++) {\n    c[i] = max(dot(normalize(normal), lights[i]), 0.0);\n    sum += colors[i] * c[i];\n  }\n  gl_FragColor = vec4(sum * c[3], 1.0);\n}\n";
    let found = review("loop.fs", text);
    assert!(found.steps.iter().all(|step| step.kind == "lambert"), "{found:?}");
    assert!(found.notes.iter().any(|note| note.contains("first turn")), "{:?}", found.notes);
}

#[test]
fn what_is_no_shader_is_told_with_its_line() {
    let error = |name: &str, text: &str| {
        let path = file(name, text);
        REVIEWER.review(&path, &ReadOptions::default()).expect_err(name).to_string()
    };
    assert!(error("empty.frag", " \n").ends_with("it is empty"));
    assert!(error("binary.frag", "void\0").ends_with("it is no text"));
    assert!(error("words.frag", "\nhello world\n").contains("words.frag:2:"));
    assert!(
        error("deep.frag", &format!("void main() {{\n float x = {}1.0{};\n}}", "(".repeat(300), ")".repeat(300)))
            .contains("deep.frag:2: it nests")
    );
    assert!(error("what.xyz", "hello").contains("its ending names no language"));
    assert!(error("geometry.geom", "void main() {\n EmitVertex();\n vec3 x; return;\n}").contains(":2: `EmitVertex`"));
}
