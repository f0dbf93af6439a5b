//! What a renderer declares: it is what is asked, and less of it than before is worse.

use super::process::{command_of, process};
use super::{answered, count, folder, judged, report, text};
use crate::{code, lightmeter, stderr, stdout};

const TWO: &str = "'formulas=fog/{exp,linear}'";

#[test]
fn a_gate_asks_what_the_renderer_declares_and_requires_what_is_asked_for_by_name() {
    for (filter, status, told) in [
        (&["{fog,color}/**"][..], 0, "the renderer declares 2 of 2"),
        (&["fog/*"], 0, "the renderer declares 2 of 14 formulas and scenes that the filter selects"),
        (&["fog/exp", "fog"], 0, "the renderer declares 2 of 14 "),
        (&["fog/exp"], 0, "0 fail"),
        // Two of three are named, and one of these is declared, which has less than half of their cases.
        (&["fog/exp", "fog/exp2-opengl", "fog/exp-radial"], 1, "less than the part of 0.5 that is required"),
        (
            &["fog/exp2-opengl/random/000001", "fog/exp/random/0000*"],
            0,
            "of 65 chosen cases 64 were judged and 1 excluded",
        ),
        (&["fog/exp2-opengl"], 3, "nothing was judged"),
    ] {
        let exec = command_of(TWO);
        let output = lightmeter(&[&["gate", "--exec", &exec, "--cases", "64"], filter].concat());
        let said = stdout(&output) + &stderr(&output);
        assert_eq!(code(&output), status, "{filter:?}: {said}");
        assert!(said.contains(told), "{filter:?}: {said}");
        // One line counts what is not declared; a reason stands there only for what the filter names.
        let is_named = filter.iter().any(|glob| glob.contains('2') || glob.contains("radial"));
        assert_eq!(said.contains("not among the formulas that it declares"), is_named, "{filter:?}: {said}");
    }
    let (status, found) = report(&process(&["fog/exp", "fog/exp-radial"], TWO, &["--require", "0.4"]));
    assert_eq!((status, count(&found, "failed")), (0, 0), "{}", found["totals"]);
}

#[test]
fn a_baseline_is_of_the_same_renderer_unless_one_is_compared_with_another() {
    let baseline = folder("across").join("baseline.json");
    let of = |renderer: &str, more: &[&str]| {
        let (pack, answers) = answered(&format!("across-{renderer}"), &["vector/reflect"]);
        let hello =
            format!("{{\"hello\":\"lightmeter.protocol/1\",\"renderer\":\"{renderer}\",\"formulas\":[\"**\"]}}\n");
        let lines = std::fs::read_to_string(&answers).expect("there are answers");
        std::fs::write(&answers, hello + &lines).expect("answers can be written");
        lightmeter(&[&["gate", text(&pack), text(&answers), "--baseline", text(&baseline)], more].concat())
    };
    let said = |output: &std::process::Output| stdout(output) + &stderr(output);
    let first = of("one", &["--update-baseline"]);
    assert!(code(&first) == 0 && said(&first).contains("is this result now"), "{}", said(&first));
    let bytes = std::fs::read(&baseline).expect("it is there");
    let again = of("one", &["--update-baseline"]);
    assert!(said(&again).contains("is this result already"), "{}", said(&again));
    assert!(std::fs::read(&baseline).expect("it is there") == bytes, "renewed, and not the same byte for byte");
    let other = of("two", &[]);
    assert_eq!(code(&other), 2, "{}", said(&other));
    assert!(said(&other).contains("is a result of one, and this is one of two"), "{}", said(&other));
    let across = of("two", &["--across"]);
    assert_eq!(code(&across), 0, "{}", said(&across));
    let alone = lightmeter(&["gate", "--exec", "true", "--across"]);
    assert!(code(&alone) == 2 && stderr(&alone).contains("--baseline"), "{}", stderr(&alone));
}

#[test]
#[ignore = "long: ./x campaign long"]
fn declaring_less_is_a_regression_and_declaring_more_is_none() {
    let (pack, answers) = answered("declared", &["attenuation/constant", "vector/reflect"]);
    let file = pack.with_file_name("baseline.json");
    let declares = |formulas: &str| {
        let hello = format!("{{\"hello\":\"lightmeter.protocol/1\",\"renderer\":\"r\",\"formulas\":[{formulas}]}}\n");
        let text_of = std::fs::read_to_string(&answers).expect("there are answers");
        let of = |line: &&str| formulas.split(',').any(|id| line.contains(&id.trim_matches('"').to_owned()));
        let lines: String = text_of.lines().filter(of).map(|line| line.to_owned() + "\n").collect();
        let path = answers.with_extension(format!("{}.jsonl", formulas.len()));
        std::fs::write(&path, hello + &lines).expect("answers can be written");
        path
    };
    let (both, one) = (declares("\"attenuation/constant\",\"vector/reflect\""), declares("\"vector/reflect\""));
    let (status, _) = judged(&pack, &one, &["--baseline", text(&file), "--update-baseline"]);
    assert_eq!(status, 0);
    let (status, found) = judged(&pack, &both, &["--baseline", text(&file), "--growth", "1"]);
    assert_eq!((status, found["regressions"].as_array().map(Vec::len)), (0, None), "{found}");
    let (status, _) = judged(&pack, &both, &["--baseline", text(&file), "--update-baseline"]);
    assert_eq!(status, 0);
    // The same cases by globs in another order, and by fewer globs.
    for filter in [&["vector/reflect", "attenuation/constant"][..], &["{attenuation/constant,vector/reflect}"]] {
        let name = format!("declared-{}", filter.len());
        let (other, _) = answered(&name, filter);
        let (status, found) = judged(&other, &one, &["--baseline", text(&file)]);
        assert!(status == 1 && found["regressions"].to_string().contains("declares less"), "{filter:?}: {found}");
    }
}
