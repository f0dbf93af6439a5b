//! `lightmeter bench`: what it measures, recommends and refuses.

use super::{code, edited, json, lightmeter, stderr, stdout};
use serde_json::Value;

/// A small bench.
const SMALL: &[&str] = &["bench", "fog/exp", "technique/power", "--quick", "--format", "json"];

fn small(more: &[&str]) -> Value {
    json(&[SMALL, more].concat())
}

fn rows<'a>(document: &'a Value, group: &str) -> &'a Vec<Value> {
    let groups = document["adapters"][0]["groups"].as_array().expect("groups");
    let group = groups.iter().find(|found| found["id"] == group).unwrap_or_else(|| panic!("no group {group}"));
    group["rows"].as_array().expect("rows")
}

#[test]
fn every_row_is_filled_or_says_why_not() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let document = small(&[]);
    assert_eq!(document["schema"], "lightmeter.bench/1");
    let measured = &document["adapters"][0];
    let rungs: Vec<&str> = measured["rungs"]
        .as_array()
        .expect("rungs")
        .iter()
        .map(|rung| rung["name"].as_str().expect("a name"))
        .collect();
    assert_eq!(
        rungs,
        ["f16", "f32-cheap", "f32", "f32-stable", "double-float", "f64", "cpu-f32", "cpu-f64", "cpu-accept"]
    );
    let names: Vec<&str> = rows(&document, "fog/exp").iter().map(|row| row["name"].as_str().expect("a name")).collect();
    assert_eq!(names, rungs);
    for row in ["fog/exp", "technique/power"].iter().flat_map(|group| rows(&document, group)) {
        if let Some(reason) = row["unavailable"].as_str() {
            assert!(!reason.is_empty() && row["time"].is_null(), "{row}");
            continue;
        }
        let time = &row["time"];
        assert!(time["ns"].as_f64().is_some_and(|ns| ns > 0.0), "{row}");
        let [low, ratio, high] =
            [&time["spread"][0], &time["ratio"], &time["spread"][1]].map(|x| x.as_f64().expect("a number"));
        assert!(low <= ratio && ratio <= high, "{row}");
        for inputs in ["random", "hard"] {
            for unit in ["ulp", "steps", "absolute"] {
                let spread = &row[inputs][unit];
                assert!(["max", "p99", "mean"].iter().all(|statistic| !spread[statistic].is_null()), "{row}");
            }
        }
        assert!(row["disqualified"].is_null(), "{row}");
    }
    let f32 = rows(&document, "fog/exp").iter().find(|row| row["name"] == "f32").expect("f32 is everywhere");
    assert_eq!((&f32["time"]["verdict"], &f32["time"]["ratio"]), (&"baseline".into(), &1.0.into()));
}

#[test]
#[ignore = "long: ./x campaign long"]
fn an_adapter_without_timestamps_is_timed_by_the_wall_and_says_so() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let document = small(&["--clock", "wall"]);
    let clock = &document["adapters"][0]["clock"];
    assert_eq!(clock["kind"], "wall");
    assert!(clock["note"].as_str().is_some_and(|note| !note.is_empty()), "{clock}");
    let text = stdout(&lightmeter(&["bench", "fog/exp", "--quick", "--clock", "wall"]));
    assert!(text.contains("wall"), "{text}");
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_wrong_value_disqualifies() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("bench_wrong", "fog.wgsl", |text| {
        text.replace("clamp(exp(-(density * distance)), 0.0, 1.0)", "clamp(0.9 * exp(-(density * distance)), 0.0, 1.0)")
    });
    let dir = dir.to_string_lossy();
    let document = json(&["bench", "fog/exp", "--quick", "--format", "json", "--shaders", &dir]);
    let row = rows(&document, "fog/exp").iter().find(|row| row["name"] == "f32").expect("f32 is everywhere");
    let reason = row["disqualified"].as_str().unwrap_or_else(|| panic!("{row}"));
    assert!(reason.contains("outside what fog/exp permits"), "{reason}");
    let front = &document["adapters"][0]["groups"][0]["front"];
    assert!(front.as_array().is_some_and(|front| !front.contains(&"f32".into())), "{front}");
    let advice = stdout(&lightmeter(&["bench", "fog/exp", "--quick", "--shaders", &dir, "--recommend", "1"]));
    assert!(!advice.contains(" f32 "), "{advice}");
}

#[test]
#[ignore = "long: ./x campaign long"]
fn the_cheapest_below_an_error_is_recommended() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let ask = |limit: &str| {
        let arguments = ["bench", "technique/power", "--quick", "--inputs", "random", "--recommend", limit];
        let output = lightmeter(&arguments);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stdout(&output)
    };
    // Which one is cheapest is the machine's to say; Schlick's approximation is off by a fifth of full scale.
    assert!(!ask("0.5").contains("none"));
    assert!(!ask("1e-3").contains("schlick"));
    assert!(ask("1e-300").contains("none"));
}

#[test]
fn bad_input_is_refused_with_what_would_be_right() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for (arguments, status, says) in [
        (&["bench", "nothing/there"][..], 2, "no group matches"),
        (&["bench", "fog/[", "--quick"], 2, "fog/["),
        (&["bench", "fog/exp", "--recommend", "small"], 2, "1e-4"),
        (&["bench", "fog/exp", "--recommend", "-1"], 2, "error"),
        (&["bench", "fog/exp", "--clock", "sun"], 2, "timestamps"),
        (&["bench", "no-such-scene.json"], 2, "no-such-scene.json"),
        (&["bench", "fog/exp", "--adapter", "nobody"], 2, "nobody"),
        (&["bench", "fog/exp", "--recommend", "1", "--format", "markdown"], 2, "text or json"),
        (&["bench", "scene/phong", "--adapter", "cpu"], 3, "no shaders"),
    ] {
        let output = lightmeter(arguments);
        assert_eq!(code(&output), status, "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{arguments:?}: {}", stderr(&output));
    }
}

#[test]
fn the_embedded_implementation_has_the_processors_rungs_alone() {
    let document = json(&["bench", "fog/exp", "--quick", "--adapter", "cpu", "--format", "json"]);
    for row in rows(&document, "fog/exp") {
        let is_of_processor = row["name"].as_str().is_some_and(|name| name.starts_with("cpu-"));
        assert_eq!(row["unavailable"].is_null(), is_of_processor, "{row}");
    }
}
