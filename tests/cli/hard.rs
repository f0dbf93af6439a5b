//! Hard cases on the command line: run, listed, shown, and made a page.

use super::{code, edited, folder, json, lightmeter, stderr, stdout};

#[test]
fn hard_cases_are_judged_on_both_sides() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let report = json(&["run", "fog/*/hard", "--format", "json"]);
    let rows = report["stability"].as_array().expect("hard cases on both sides");
    assert!(rows.len() >= 20, "{} rows", rows.len());
    for row in rows {
        let id = row["id"].as_str().expect("an id");
        assert!(row["stable"].as_f64().expect("a number") <= row["bound"].as_f64().expect("a number"), "{row}");
        assert!(row["naive_formula"] != "" && row["fails"] != "" && row["condition"].is_number(), "{row}");
        assert!(row["stable_at"].as_str().is_some_and(|at| at.starts_with(id)), "{row}");
    }
    let text = stdout(&lightmeter(&["run", "fog/*/hard", "--verbose"]));
    let said = format!("the stable form keeps its bound at {} of {0}, the naive form fails at {0}", rows.len());
    assert!(text.contains(&said), "{text}");
}

#[test]
fn an_unstable_form_in_a_stable_ones_place_fails_its_group() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("unstable-fog", "fog.wgsl", |text| {
        text.replace("-elementary_exp_m1(-(density * distance))", "1.0 - exp(-(density * distance))")
    });
    let dir = dir.to_str().expect("UTF-8");
    let output = lightmeter(&["run", "fog/opacity-expm1/hard", "--shaders", dir]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let text = stdout(&output);
    assert!(text.contains("unstable at 4 hard cases: at fog/opacity-expm1/hard/"), "{text}");
    assert!(text.contains("where the form claims 72"), "{text}");
}

#[test]
fn a_case_near_a_hard_one_is_run_and_shown_alone() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let id = "fog/linear/hard/band-of-1-at-1e5/near/07";
    let output = lightmeter(&["run", id, "--format", "json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["groups"][0]["cases"], 1, "{report}");
    let text = stdout(&lightmeter(&["show", id]));
    assert!(text.contains("near: band-of-1-at-1e5"), "{text}");
    let beyond = lightmeter(&["show", "fog/linear/hard/band-of-1-at-1e5/near/32"]);
    assert_eq!(code(&beyond), 2);
    assert!(stderr(&beyond).contains("no case `fog/linear/hard/band-of-1-at-1e5/near/32`"));
}

#[test]
fn show_tells_ill_conditioned_from_unstable() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for (id, what) in [
        ("vector/interpolated-normal/hard/nearly-opposite", "ill-conditioned: with inputs that were rounded"),
        ("vector/normalize/hard/tiny", "anything is legal: the fault of the form"),
        ("lighting/cosine-power-by-chord/hard/half-1e6", ": stable\n"),
        ("interpolation/weights/hard/no-area", "there is no value here"),
    ] {
        let text = stdout(&lightmeter(&["show", id]));
        let at = text.find("\nconditioning\n").unwrap_or_else(|| panic!("{text}"));
        assert!(text[at..].lines().take(3).collect::<Vec<_>>().join("\n").contains(what.trim()), "{id}: {text}");
    }
    let shown = json(&["show", "fog/opacity-expm1/hard/one-in-1e7", "--format", "json"]);
    assert_eq!(shown["conditioning"]["standing"], "stable");
    assert_eq!(shown["forms"][0]["naive_formula"], "fog/opacity");
    let text = stdout(&lightmeter(&["show", "fog/opacity-expm1/hard/one-in-1e7"]));
    assert!(text.contains("forms on lavapipe, compute") && text.contains("naive   fog/opacity"), "{text}");
}

#[test]
fn the_list_says_which_form_fails_and_the_condition() {
    let listed = json(&["list", "fog/opacity-expm1/hard", "--format", "json"]);
    let hard = listed["cases"][0]["hard"].as_array().expect("hard cases");
    assert_eq!(hard.len(), 5);
    // The thickest fog of the series is hard for neither form.
    let hard: Vec<&serde_json::Value> =
        hard.iter().filter(|case| !case["id"].as_str().expect("an id").ends_with("/half")).collect();
    assert!(hard.iter().all(|case| case["naive"]["formula"] == "fog/opacity" && case["near"] == 32), "{listed}");
    assert!(hard.iter().all(|case| (case["condition"].as_f64().expect("a number") - 2.0).abs() < 0.01), "{listed}");
    let text = stdout(&lightmeter(&["list", "fog/opacity-expm1/hard"]));
    assert!(text.contains("fails: fog/opacity, 1 − 0.999 has lost 10 bits"), "{text}");
    let formulas = json(&["list", "fog/opacity-expm1", "--formulas", "--format", "json"]);
    assert_eq!(formulas["formulas"][0]["stable"]["bound"], 72.0, "{formulas}");
}

#[test]
fn a_page_has_every_case_with_both_errors_and_a_picture() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = folder("stability-page");
    let at = |name: &str| dir.join(name).to_str().expect("UTF-8").to_owned();
    let (run, page) = (at("hard.json"), at("stability.md"));
    assert_eq!(code(&lightmeter(&["run", "depth/*/hard", "--timing", "--format", "json", "--out", &run])), 0);
    let output = lightmeter(&["page", "stability", &run, "--out", &page]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let text = std::fs::read_to_string(&page).expect("a page");
    for case in ["at-900-of-1000", "near-1e-3-far-1e6", "a-room", "the-horizon"] {
        assert!(text.contains(&format!("| {case} | 1.0 |")), "{text}");
    }
    assert!(text.contains("| `depth/recovered-reversed` | 32 |") && text.contains("![Errors of naive"), "{text}");
    let picture = std::fs::read_to_string(at("stability.svg")).expect("a picture");
    // Two marks for each of the cases in the table, and two in the legend.
    let marks = picture.matches("<polygon").count();
    assert!(
        marks >= 2 * 4 + 2 && marks.is_multiple_of(2) && picture.contains("stable form, at its worst"),
        "{picture}"
    );

    let json = std::fs::read_to_string(&run).expect("the run was written");
    let mut older: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    older.as_object_mut().expect("an object").remove("stable_forms").expect("the run says what stable forms claim");
    std::fs::write(&run, older.to_string()).expect("a file");
    let refused = lightmeter(&["page", "stability", &run]);
    assert!(code(&refused) == 2 && stderr(&refused).contains("it does not say what stable forms claim"));

    std::fs::write(&run, stdout(&lightmeter(&["run", "fog/exp/random/000001", "--format", "json"]))).expect("a file");
    let refused = lightmeter(&["page", "stability", &run]);
    assert_eq!(code(&refused), 2);
    assert!(stderr(&refused).contains("examined no hard case; expected one of `lightmeter run '*/*/hard'`"));
}
