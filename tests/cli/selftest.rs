//! `lightmeter selftest` on formulas, and its page.

use super::{code, folder, lightmeter, stderr, stdout};
use serde_json::Value;

#[test]
fn mistakes_in_formulas_are_caught_and_named() {
    let path = folder("selftest").join("selftest.json");
    let file = path.to_str().expect("a path of letters");
    let output = lightmeter(&["selftest", "fog", "attenuation", "lighting/phong", "--format", "json", "--out", file]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let run: Value = serde_json::from_str(&std::fs::read_to_string(&path).expect("the file")).expect("JSON");
    assert_eq!((&run["schema"], run["rows"].as_array().map(Vec::len)), (&"lightmeter.selftest/1".into(), Some(0)));
    let kills = run["kills"].as_array().expect("kills");
    let named = kills.iter().filter(|kill| kill["finding"] == "named").count();
    assert!(kills.len() > 300 && 100 * named >= 95 * kills.len(), "{named} of {}", kills.len());
    for kill in kills {
        assert!(kill["finding"] != "survived" && kill["smallest"].as_u64() >= Some(1), "{kill}");
    }
    for clean in run["clean"].as_array().expect("formulas") {
        assert!(clean["failed"] == 0 && clean["systematic"].is_null(), "{clean}");
    }
    let page = lightmeter(&["page", "selftest", file]);
    assert_eq!(code(&page), 0, "{}", stderr(&page));
    assert!(stdout(&page).contains("| fog-radial | fog uses radial distance |"), "{}", stdout(&page));
    let _ = std::fs::remove_file(path);
}

#[test]
fn the_resolution_is_told_by_parameter() {
    let output = lightmeter(&["selftest", "fog/exp", "--calibrate", "--draws", "0"]);
    let text = stdout(&output);
    assert_eq!(code(&output), 0, "{text}");
    let density =
        text.lines().find(|line| line.starts_with("fog/exp ") && line.contains("density") && line.contains("scale"));
    let errors: Vec<f64> = density.expect(&text).split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert!(errors.len() == 2 && errors.iter().all(|error| (1e-8..1e-4).contains(error)), "{errors:?}");
}

#[test]
fn bad_usage_is_said() {
    for (arguments, status, message) in [
        (&["selftest", "fog", "--only", "blend-unit"][..], 2, "a filter selects formulas"),
        (&["selftest", "frog"], 2, "no formula matches `frog`"),
        (&["selftest", "--formula-cases", "0"], 2, "0 is not in"),
    ] {
        let output = lightmeter(arguments);
        assert!(code(&output) == status && stderr(&output).contains(message), "{}", stderr(&output));
    }
}

/// Numbers that come of no mistake, in the place of lights whose sum some mistakes leave nearly open.
#[test]
fn noise_is_explained_by_nothing() {
    let file = folder("noise").join("noise.glsl");
    let functions = "vec4 constant(vec3 p) { return vec4(9.0, 8.0, 7.0, 1.0); }\n\
                     vec4 ofPosition(vec3 p) { return vec4(fract(sin(dot(p, vec3(12.9, 78.2, 37.7))) * vec3(43758.5, 1251.3, 917.1)), 1.0); }";
    std::fs::write(&file, functions).expect("it can be written");
    if !crate::needs::lacks_lavapipe() {
        for formula in ["lighting/spot", "lighting/point-blinn"] {
            for function in ["constant", "ofPosition"] {
                let function = format!("{function}@{}", file.display());
                let args = ["run", formula, "--cases", "512", "--function", &function, "--format", "json"];
                let output = lightmeter(&args);
                let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
                assert_eq!(code(&output), 1, "{}", stderr(&output));
                for group in report["groups"].as_array().expect("an array") {
                    assert!(group["failed"].as_u64() > Some(100), "{group}");
                    let explanations = &group["diagnosis"]["explanations"];
                    assert!(
                        explanations.as_array().is_none_or(Vec::is_empty),
                        "{function} as {formula}: {explanations}"
                    );
                }
            }
        }
    }
    let args = ["selftest", "--only", "noise", "fog/exp", "lighting/point-phong", "--formula-cases", "64"];
    let output = lightmeter(&args);
    let text = stdout(&output);
    assert_eq!(code(&output), 0, "{text}{}", stderr(&output));
    assert!(
        text.starts_with("noise in the place of formulas and scenes: ") && text.contains(" answers, 0 explained, and "),
        "{text}"
    );
    // What the mistaken formula gives itself is told, and is no failure.
    assert!(text.contains("fog/exp: always 0: "), "{text}");
}
