//! NaN, infinity, subnormals and signed zero: the probes on real drivers, and runs that must not lose a NaN.

use super::{code, edited, folder, json, lightmeter, stderr, stdout};
use serde_json::Value;
use std::path::PathBuf;

fn outcomes<'a>(report: &'a Value, probe: &str) -> Vec<&'a Value> {
    let all = report["outcomes"].as_array().expect("outcomes");
    let found: Vec<&Value> = all.iter().filter(|outcome| outcome["probe"] == probe).collect();
    assert!(!found.is_empty(), "no outcome of {probe}");
    found
}

#[test]
fn drivers_keep_their_promises_and_are_as_on_record() {
    if crate::needs::lacks_recorded_lavapipe() {
        return;
    }
    // Software drivers alone: what a GPU does is on no record.
    let named = |name: &String| ["lavapipe", "llvmpipe-gl", "swiftshader"].contains(&name.as_str());
    let names: Vec<String> =
        lightmeter::adapters::names().expect("lavapipe is there").into_iter().filter(named).collect();
    let chosen: Vec<&str> = names.iter().flat_map(|name| ["--adapter", name.as_str()]).collect();
    let output = lightmeter(&[&["special"], &chosen[..]].concat());
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let text = stdout(&output);
    assert!(text.contains("nan-plus-one") && text.contains("0 promises broken"), "{text}");
}

#[test]
fn every_probe_has_a_result_in_both_stages() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let report = json(&["special", "--format", "json"]);
    assert_eq!(report["schema"], "lightmeter.special/1");
    for probe in report["probes"].as_array().expect("probes") {
        let name = probe["name"].as_str().expect("a name");
        let found = outcomes(&report, name);
        let stages: Vec<&str> = found.iter().filter_map(|outcome| outcome["stage"].as_str()).collect();
        let expected: &[&str] = if name.starts_with("varying") { &["raster"] } else { &["compute", "fragment"] };
        assert_eq!(stages, expected, "{name}");
        let definite = probe["definite"] == true;
        assert!(found.iter().all(|outcome| outcome["verdict"] == if definite { "kept" } else { "indeterminate" }));
    }
}

#[test]
fn a_nan_is_kept_bit_for_bit() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let report = json(&["special", "--format", "json"]);
    for (probe, bits) in [
        ("keep-nan", "0x7fc00000"),
        ("keep-negative-nan", "0xffc00000"),
        ("keep-signalling-nan", "0x7fa00001"),
        ("keep-nan-payload", "0x7fc12345"),
        ("varying-nan", "0x7fc12345"),
        ("varying-flat-signalling-nan", "0x7fa00001"),
    ] {
        for outcome in outcomes(&report, probe) {
            assert_eq!(outcome["bits"], bits, "{outcome}");
        }
    }
}

/// `special` by an edited copy of its shader: the exit code, and what is printed.
fn special_by(test: &str, right: &str, wrong: &str) -> (i32, String) {
    let dir = edited(test, "special.wgsl", |text| {
        assert!(text.contains(right), "`{right}` no longer stands in special.wgsl");
        text.replace(right, wrong)
    });
    let output = lightmeter(&["special", "--shaders", dir.to_str().expect("UTF-8")]);
    (code(&output), stdout(&output) + &stderr(&output))
}

#[test]
fn a_broken_promise_is_named() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let (code, text) = special_by("special-broken", "return step(edge, x);", "return 1.0 - step(edge, x);");
    assert_eq!(code, 1, "{text}");
    for stage in ["compute", "fragment"] {
        let line = format!("BROKEN step-minus-zero on lavapipe, {stage}: step(0, −0) is 0 (0x00000000), where");
        assert!(text.contains(&line), "{text}");
    }
}

#[test]
fn a_result_that_is_not_on_record_is_named() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let (code, text) = special_by("special-changed", "return saturate(x);", "return abs(saturate(x) - 0.25);");
    // Another version of the driver is not on record: what it gives is shown.
    let binds = json(&["special", "--format", "json"])["records"][0]["binds"] == true;
    assert_eq!(code, i32::from(binds), "{text}");
    let line =
        "CHANGED saturate-nan on lavapipe, compute: saturate(NaN) is 0.25 (0x3e800000), where llvmpipe, Mesa 22.3.6";
    assert!(!binds || text.contains(line) && text.contains("is on record with 0 (0x00000000)"), "{text}");
}

#[test]
fn a_nan_in_the_place_of_a_number_breaks_the_promise() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let right = "return round(x);";
    let (code, text) = special_by("special-nan", right, "return bitcast<f32>(bitcast<u32>(x) | 0x7fc00000u);");
    assert_eq!(code, 1, "{text}");
    assert!(text.contains("BROKEN round-two-and-a-half on lavapipe, fragment") && text.contains("NaN 0x7f"), "{text}");
}

/// The tables are groups of a run, and count what the command of their own does.
#[test]
fn a_run_judges_the_tables() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let special = json(&["special", "--format", "json"]);
    let count = |verdict: &str| {
        special["outcomes"].as_array().expect("outcomes").iter().filter(|outcome| outcome["verdict"] == verdict).count()
    };
    let report = json(&["run", "special", "--format", "json"]);
    let totals = ["passed", "failed", "indeterminate"].map(|total| report["totals"][total].as_u64().expect("a count"));
    assert_eq!(totals, ["kept", "broken", "indeterminate"].map(|verdict| count(verdict) as u64));
    let groups: Vec<&str> =
        report["groups"].as_array().expect("groups").iter().filter_map(|g| g["id"].as_str()).collect();
    for table in ["special/nan", "special/infinity", "special/subnormal", "special/signed-zero", "special/rounding"] {
        assert!(groups.contains(&table), "{table} in {groups:?}");
    }
    let one = json(&["run", "special/signed-zero/step-minus-zero", "--format", "json"]);
    assert_eq!(one["totals"]["cases"], 2, "{}", one["totals"]);
    assert_eq!(code(&lightmeter(&["run", "special/signed-zero/no-such-probe"])), 2);
    // The embedded implementation has no shading language.
    let embedded = lightmeter(&["run", "special", "--adapter", "cpu"]);
    assert!(
        code(&embedded) == 3 && stdout(&embedded).contains("skipped 5 groups, from special/nan"),
        "{}",
        stdout(&embedded)
    );
}

#[test]
fn a_broken_promise_fails_a_run_with_its_operands() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("special-run", "special.wgsl", |text| {
        text.replace("return step(edge, x);", "return 1.0 - step(edge, x);")
    });
    let output = lightmeter(&["run", "special/signed-zero", "--shaders", dir.to_str().expect("UTF-8")]);
    let text = stdout(&output);
    assert_eq!(code(&output), 1, "{text}");
    for part in [
        "✗ special/signed-zero on lavapipe, compute: ",
        "FAIL special/signed-zero/step-minus-zero on lavapipe, compute: step(0, −0)",
        "0x80000000",
        "legal          1, by WGSL",
        "again          lightmeter run 'special/signed-zero/step-minus-zero' --adapter lavapipe",
    ] {
        assert!(text.contains(part), "no `{part}` in {text}");
    }
}

#[test]
fn probes_are_listed_and_shown_by_their_ids() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let list = stdout(&lightmeter(&["list", "special"]));
    assert!(list.contains("signed-zero") && list.contains("step-minus-zero"), "{list}");
    let list = json(&["list", "special/nan", "--format", "json"]);
    assert_eq!(list["cases"][0]["table"], "special/nan");
    let shown = stdout(&lightmeter(&["show", "special/signed-zero/step-minus-zero"]));
    for part in ["step(0, −0)", "promised  1", "compute", "kept", "WGSL"] {
        assert!(shown.contains(part), "no `{part}` in {shown}");
    }
    let shown = json(&["show", "special/nan/keep-nan", "--format", "json"]);
    assert_eq!(shown["answers"][0]["bits"], "0x7fc00000");
    let none = lightmeter(&["show", "special/nan/nothing"]);
    assert!(code(&none) == 2 && stderr(&none).contains("see `lightmeter list special`"), "{}", stderr(&none));
}

#[test]
fn bad_usage_of_special_is_told() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let rows: [(&[&str], i32, &str); 3] = [
        (&["special", "--adapter", "cpu"], 3, "nothing could be probed"),
        (&["special", "--format", "junit"], 2, "[possible values: text, json]"),
        (&["special", "--adapter", "vodoo"], 2, "no adapter `vodoo`"),
    ];
    for (args, expected, message) in rows {
        let output = lightmeter(args);
        assert!(code(&output) == expected && stderr(&output).contains(message), "{args:?}: {}", stderr(&output));
    }
}

#[test]
fn records_and_the_page_are_made_from_a_run() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = folder("special-page");
    let path = |name: &str| dir.join(name).to_str().expect("UTF-8").to_owned();
    let (run, page) = (path("special.json"), path("special.md"));
    let made = lightmeter(&["special", "--format", "json", "--out", &run, "--record", &path("records")]);
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    let record = std::fs::read_to_string(dir.join("records/lavapipe.json")).expect("a record");
    assert!(record.contains("lightmeter.special-record/1") && record.contains("\"nan-plus-one\""), "{record}");
    assert_eq!(code(&lightmeter(&["page", "special", &run, "--out", &page])), 0);
    let text = std::fs::read_to_string(&page).expect("the page was written");
    assert!(text.contains("| nan-plus-one | NaN + 1 | nothing | NaN 0x"), "{text}");
    let other = lightmeter(&["page", "blend", &run]);
    assert!(code(&other) == 2 && stderr(&other).contains("schema is `lightmeter.special/1`"), "{}", stderr(&other));
}

/// The bits of the inputs of a case of fog/exp that tell it from every other.
fn marks(id: &str) -> [String; 2] {
    let shown = json(&["show", id, "--adapter", "cpu", "--format", "json"]);
    let bits = |name: &str| {
        let number = &shown["inputs"][name];
        let number = if number.is_array() { &number[0] } else { number };
        #[expect(clippy::cast_possible_truncation, reason = "inputs are floats, widened")]
        let x = number.as_f64().expect("a number") as f32;
        format!("0x{:08x}u", x.to_bits())
    };
    [bits("p"), bits("density")]
}

/// Fog whose function gives a NaN, which no compiler can fold, for one case alone.
fn fog_with_nan(test: &str, id: &str) -> PathBuf {
    let [p, density] = marks(id);
    edited(test, "fog.wgsl", |text| {
        let right = "return fog_mix(fog_exp_factor(fog_planar_distance(p), density), fog, shaded);";
        assert!(text.contains(right), "`{right}` no longer stands in fog.wgsl");
        let wrong = format!(
            "var fogged = fog_mix(fog_exp_factor(fog_planar_distance(p), density), fog, shaded);
    if bitcast<u32>(p.x) == {p} && bitcast<u32>(density) == {density} {{
        fogged.color.y = bitcast<f32>(bitcast<u32>(density) | 0x7fc00000u);
    }}
    return fogged;"
        );
        text.replace(right, &wrong)
    })
}

/// The first, a middle and the last case of a chunk of 65,536.
#[test]
#[ignore = "long: ./x campaign long"]
fn a_run_loses_no_nan() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for case in [0, 32_768, 65_535] {
        let id = format!("fog/exp/random/{case:06}");
        let dir = fog_with_nan(&format!("special-lost-{case}"), &id);
        let dir = dir.to_str().expect("UTF-8");
        let args = ["run", "fog/exp/random", "--cases", "65536", "--shaders", dir];
        let report = json(&[&args[..], &["--format", "json"]].concat());
        assert_eq!(report["totals"]["failed"], 2, "{id}: {}", report["totals"]);
        let failures = report["failures"].as_array().expect("failures");
        for stage in ["compute", "fragment"] {
            let failure = failures.iter().find(|failure| failure["stage"] == stage).expect(stage);
            assert_eq!(
                (&failure["id"], &failure["value"]),
                (&Value::from(id.as_str()), &Value::from("NaN")),
                "{stage}"
            );
            assert_eq!((&failure["output"], &failure["error_ulp"]), (&Value::from("color.g"), &Value::from("Inf")));
            let group = report["groups"].as_array().expect("groups").iter().find(|group| group["stage"] == stage);
            let group = group.expect(stage);
            assert_eq!((&group["worst"], &group["margin_max"]), (&Value::from(id.as_str()), &Value::from("Inf")));
        }
        let text = lightmeter(&args);
        assert_eq!(code(&text), 1, "{}", stdout(&text));
        let text = stdout(&text);
        assert!(
            text.contains(&format!("FAIL {id} on lavapipe, compute: color.g")) && text.contains("NaN  0x"),
            "{text}"
        );
        let junit = stdout(&lightmeter(&[&args[..], &["--format", "junit"]].concat()));
        for stage in ["compute", "fragment"] {
            assert!(junit.contains(&format!("FAIL {id} on lavapipe, {stage}: color.g")), "{junit}");
        }
    }
}
