//! The blend unit by the command line: all states, states separate for alpha, the page, the self-test.

use super::{code, eval, folder, json, lightmeter, stderr, stdout};
use serde_json::Value;

#[test]
#[ignore = "long: ./x campaign long"]
fn all_blend_states_are_judged_or_aliases() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let product = "blend/{add,subtract,reverse-subtract,min,max}";
    let report = json(&["run", product, "--cases", "16", "--target", "rgba8unorm", "--timing", "--format", "json"]);
    let unit = |id: &str| {
        let groups = report["groups"].as_array().expect("groups").iter();
        let mut of = groups.filter(|group| group["id"] == id && group["stage"] == "fixed-function");
        of.next().expect("the blend unit's group").clone()
    };
    let cases = |id: &str| unit(id)["cases"].as_u64().expect("a count");
    // Eight states in each equation are drawn by two routes, and the greater has two hard cases.
    assert_eq!((cases("blend/reverse-subtract"), cases("blend/max")), (233 * 16, 16 + 2));
    assert!(unit("blend/add")["seconds"].is_f64() && unit("blend/add")["seconds_warm"].is_f64());
    let routes = report["routes"].as_object().expect("routes");
    let judged = |route: &str| routes[route].as_u64().expect("a count");
    assert_eq!(judged("native") + judged("constant-replicated") + judged("folded-into-source"), 677);
    assert_eq!(report["aliases"].as_u64(), Some(448));
    let states = report["blend_states"].as_array().expect("states");
    assert_eq!(states.iter().filter(|state| state["route"] != "dual-source").count(), 677);
    for tier in ["exact", "nearest", "neighbour", "bound", "outside"] {
        assert!(states.iter().all(|state| state["tiers"][tier].is_u64()), "{tier}");
    }
    let embedded = json(&["run", "blend/min", "--adapter", "cpu", "--cases", "16", "--format", "json"]);
    assert!(embedded["routes"].as_object().is_none_or(serde_json::Map::is_empty), "no blend unit ran");
    let alias = json(&["run", "blend/min/src-alpha/zero", "--adapter", "cpu", "--format", "json"]);
    assert_eq!(alias["groups"][0]["id"], "blend/min");
}

#[test]
fn a_state_separate_for_alpha_is_run_by_its_name() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let id = "blend/separate/subtract.constant-color.constant-alpha/max/0003";
    for args in
        [&["run", id, "--target", "all", "--format", "json"][..], &["run", id, "--adapter", "cpu", "--format", "json"]]
    {
        let report = json(args);
        assert_eq!(report["totals"]["failed"], 0);
        let ids: Vec<&Value> =
            report["blend_states"].as_array().expect("states").iter().map(|state| &state["id"]).collect();
        assert!(
            !ids.is_empty() && ids.iter().all(|id| *id == "blend/separate/subtract.constant-color.constant-alpha/max")
        );
    }
    let line = r#"{"id":1,"formula":"blend/separate/subtract.constant-color.constant-alpha/max","inputs":{"src":[1,1,1,0.25],"dst":[0.5,0.5,0.5,0.75],"constant":[1,0.5,0.25,0.5]}}"#;
    let answer: Value = serde_json::from_str(&stdout(&eval(line))).expect("JSON");
    assert_eq!(answer["value"], serde_json::json!([0.75, 0.25, 0.0, 0.75]));
    let shown = stdout(&lightmeter(&["show", id, "--target", "rgba8unorm"]));
    assert!(shown.contains("folded-into-source") && shown.contains("steps from"), "{shown}");
}

#[test]
fn a_page_is_made_of_a_run() {
    let dir = folder("blend-page");
    let (run, page) = (dir.join("page.json"), dir.join("page.md"));
    let [run, page] = [&run, &page].map(|path| path.to_str().expect("UTF-8"));
    let args = ["blend/{add,special}", "--adapter", "cpu", "--target", "all", "--cases", "16", "--format", "json"];
    assert_eq!(code(&lightmeter(&[&["run"], &args[..], &["--out", run]].concat())), 0);
    assert_eq!(code(&lightmeter(&["page", "blend", run, "--out", page])), 0);
    let text = std::fs::read_to_string(page).expect("the page was written");
    // A row for each source factor in the matrix of the one equation that ran, and one for each case of NaN and infinity.
    let state = "| src-alpha-saturate | N ";
    assert!(text.contains(state) && text.contains("| min-of-nan-source |") && text.contains("(page.svg)"), "{text}");
    assert!(text.contains("FD "), "a mixed state has two routes: {text}");
    let picture = std::fs::read_to_string(dir.join("page.svg")).expect("the picture was written");
    // The background, a cell for each state, and the legend.
    assert_eq!(picture.matches("<rect").count(), 1 + 3 * 225 + 7);
    std::fs::write(run, "{\"schema\": \"lightmeter.list/1\"}").expect("a file can be written");
    for (file, message) in
        [(run, "schema is `lightmeter.list/1`; expected lightmeter.report/2"), ("/nowhere", "cannot read /nowhere")]
    {
        let output = lightmeter(&["page", "blend", file]);
        assert!(code(&output) == 2 && stderr(&output).contains(message), "{}", stderr(&output));
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn the_self_test_names_every_fault() {
    let output = lightmeter(&["selftest", "--only", "blend-unit", "--cases", "64"]);
    let text = stdout(&output);
    assert_eq!(code(&output), 0, "{text}");
    for fault in lightmeter::blend_unit::rules::FAULTS {
        let row = text.lines().find(|line| line.split_whitespace().next() == Some(fault.name)).expect(fault.name);
        assert!(row.contains("named"), "{row}");
    }
    assert!(text.lines().any(|line| line.starts_with("none") && line.matches("clean").count() == 5), "{text}");
}
