//! `lightmeter mistakes`, and what `--mistake` makes of `eval`, `show` and `render`.

use super::{LINE, code, eval_with, folder, lightmeter, stderr, stdout};
use lightmeter::document::Document as _;
use lightmeter::document::mistakes::{MistakeOf, MistakesDocument};
use lightmeter::faults::faults;
use serde_json::Value;

#[test]
#[ignore = "long: ./x campaign long"]
fn mistakes_are_listed_with_what_they_concern_and_how_they_look() {
    let output = lightmeter(&["mistakes", "--format", "json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let all = MistakesDocument::read(&stdout(&output)).expect("it is read again");
    let names: Vec<&str> = all.mistakes.iter().map(|mistake| mistake.name.as_ref()).collect();
    assert!(faults().iter().all(|fault| names.contains(&fault.name)), "none is left out");
    for mistake in all.mistakes.iter().filter(|mistake| mistake.of == MistakeOf::Formulas) {
        assert!(!mistake.formulas.is_empty(), "{} concerns something", mistake.name);
        assert!(mistake.looks.iter().all(|look| look.failing <= look.cases), "{}", mistake.name);
    }
    let radial = all.mistakes.iter().find(|mistake| &*mistake.name == "fog-radial").expect("it is known");
    let exp = radial.looks.iter().find(|look| look.formula == "fog/exp").expect("it concerns fog/exp");
    assert!(exp.failing > 100 && exp.too_small > 0, "{exp:?}");

    let output = lightmeter(&["mistakes", "fog-radial"]);
    let text = stdout(&output);
    assert!(text.starts_with("fog-radial\n  fog uses radial distance\n  seen in: OpenGL drivers"), "{text}");
    assert!(text.contains("cases fail, in f, color"), "{text}");
    let output = lightmeter(&["mistakes", "fog-smoothstep", "spot-axis-reversed"]);
    let text = stdout(&output);
    assert!(text.contains("\n  scene/fog-linear: ") && text.contains("\n  scene/spotlight: "), "{text}");
    assert!(text.contains(" of 1600 pixels fail, in red, green, blue; of the wrong numbers "), "{text}");
    let output = lightmeter(&["mistakes", "--formula", "scene/fog-*"]);
    let text = stdout(&output);
    assert!(text.contains("fog-black\n") && !text.contains("cutout-left-out"), "{text}");
    let output = lightmeter(&["mistakes", "--formula", "fog/exp"]);
    assert!(stdout(&output).contains("fog-radial") && !stdout(&output).contains("blinn-for-phong"));
}

#[test]
fn a_mistake_that_is_unknown_is_told_with_the_nearest() {
    for args in
        [&["mistakes", "fog-radail"][..], &["eval", "--mistake", "fog-radail"], &["mistakes", "--formula", "fgo"]]
    {
        let output = lightmeter(args);
        assert_eq!((code(&output), stdout(&output)), (2, String::new()), "{args:?}");
        assert!(
            stderr(&output).contains("fog-radial") || stderr(&output).contains("no formula"),
            "{}",
            stderr(&output)
        );
    }
    let output = lightmeter(&["render", "phong", "--mistake", "fog-base-two", "--out", "x.png"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("a mistake in formulas"), "{}", stderr(&output));
}

#[test]
fn a_formula_is_evaluated_as_whoever_makes_a_mistake_would() {
    let value = |args: &[&str]| -> Value {
        let output = eval_with(args, &LINE.replace("[0,0,-5]", "[3,0,-4]"));
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        serde_json::from_str(&stdout(&output)).expect("JSON")
    };
    let first = |answer: &Value, field: &str| answer[field][0].as_f64().expect("a number");
    let (right, wrong) = (value(&[]), value(&["--mistake", "fog-radial"]));
    assert!((first(&right, "value") - 0.6).abs() < 1e-6 && (first(&wrong, "value") - 0.5).abs() < 1e-6);
    assert!(first(&wrong, "low") <= 0.5 && first(&wrong, "high") >= 0.5 && first(&wrong, "high") < 0.55);
    let output = eval_with(&["--mistake", "blinn-for-phong"], LINE);
    assert_eq!(code(&output), 2);
    assert!(stdout(&output).contains("`blinn-for-phong` does not concern fog/linear"), "{}", stdout(&output));
}

#[test]
fn a_case_is_shown_with_a_mistake() {
    let case = "fog/linear-radial/hard/sideways";
    let output = lightmeter(&["show", case, "--mistake", "fog-planar", "--adapter", "cpu"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let text = stdout(&output);
    assert!(text.contains("\nas if fog uses planar distance\n  steps at which it shows  "), "{text}");
    assert!(text.contains("\n  distance  ") && text.contains("\n✗  f  "), "{text}");
    let output = lightmeter(&["show", case, "--mistake", "fog-planar", "--adapter", "cpu", "--format", "json"]);
    let shown: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert_eq!(
        (&shown["mistake"]["name"], &shown["mistake"]["outputs"][0]["value"]),
        (&"fog-planar".into(), &1.0.into())
    );
    assert_eq!(shown["mistake"]["steps"][0]["name"], "distance", "{shown}");
    let output = lightmeter(&["show", case, "--mistake", "fog-radial", "--adapter", "cpu"]);
    assert_eq!(code(&output), 2, "it has that by right");
}

#[test]
fn a_scene_is_drawn_with_a_mistake() {
    let folder = folder("mistaken-image");
    let draw = |name: &str, args: &[&str]| {
        let path = folder.join(name);
        let file = path.to_str().expect("UTF-8");
        let output = lightmeter(&[&["render", "phong", "--out", file], args].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        std::fs::read(path).expect("an image")
    };
    let (right, wrong) = (draw("right.png", &[]), draw("wrong.png", &["--mistake", "ambient-left-out"]));
    assert_ne!(right, wrong);
    let output = lightmeter(&["render", "phong", "--with", "gpu", "--mistake", "ambient-left-out", "--out", "x.png"]);
    assert_eq!(code(&output), 2, "the reference alone makes mistakes");
    let output = lightmeter(&["render", "phong", "--mistake", "fog-left-out", "--out", "x.png"]);
    let said = stderr(&output);
    assert!(code(&output) == 2 && said.contains("`fog-left-out` changes nothing in this scene"), "{said}");
    std::fs::remove_dir_all(folder).expect("it can be removed");
}

#[test]
fn a_group_of_blend_states_is_told_by_the_mistake_that_most_of_them_show() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let from = "case 6u: { return vec4f(src.a); }";
    let folder = super::edited("blend-group", "blend.wgsl", |text| text.replace(from, "case 6u: { return src; }"));
    let folder = folder.to_str().expect("UTF-8");
    let output = super::lightmeter(&["run", "blend/add", "--cases", "64", "--shaders", folder, "--format", "json"]);
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let groups = report["groups"].as_array().expect("groups");
    // The state that fails most often is one of few cases, which tell nothing by themselves.
    let group = groups.iter().find(|group| group["stage"] == "compute" && group["id"] == "blend/add").expect("one");
    let found = &group["diagnosis"];
    assert_eq!(found["explanations"][0]["mistakes"], serde_json::json!(["color-for-alpha"]), "{group}");
    assert!(found["others"]["explained"].as_u64() > Some(0), "{group}");
    assert!(found["formula"].as_str().is_some_and(|id| id.starts_with("blend/add/")), "{group}");
}
