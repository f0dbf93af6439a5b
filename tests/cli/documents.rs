//! What goes out as JSON is as its schema says, is read again by the types that wrote it, and written once more it is the same.

use super::{code, command, folder, lightmeter, stderr};
use lightmeter::document::Document;
use lightmeter::document::adapters::AdaptersDocument;
use lightmeter::document::bench::BenchDocument;
use lightmeter::document::bench::recommendation::Recommendation;
use lightmeter::document::effects::EffectsDocument;
use lightmeter::document::eval::{EvalAnswer, EvalRequest};
use lightmeter::document::frame::FrameDocument;
use lightmeter::document::list::{CasesDocument, Domain, FormulasDocument, ListedCases};
use lightmeter::document::pack::Manifest;
use lightmeter::document::protocol::ProtocolLine;
use lightmeter::document::report::{Examined, Report};
use lightmeter::document::selftest::SelftestDocument;
use lightmeter::document::show::{ShowDocument, ShownAnswer};
use lightmeter::document::special::SpecialReport;
use lightmeter::document::special::record::SpecialRecord;
use lightmeter::document::sweep::SweepDocument;
use lightmeter::document::sweep::presets::PresetsDocument;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What `lightmeter schema` prints and `docs/schemas/` has, but for the scene.
const NAMES: [&str; 19] = [
    "mistakes",
    "report",
    "special",
    "identify",
    "pack",
    "protocol",
    "frame",
    "sweep",
    "bench",
    "selftest",
    "cases",
    "formulas",
    "show",
    "adapters",
    "effects",
    "eval",
    "presets",
    "recommendation",
    "special-record",
];

/// Runs a command, reads its JSON by a type and writes it again.
fn read_and_written<T: Document>(args: &[&str]) -> (T, Value) {
    let output = lightmeter(&[args, &["--format", "json"]].concat());
    assert!(code(&output) <= 1, "{args:?}: {}", stderr(&output));
    again(&output.stdout)
}

/// Compares a document with its schema, reads it by a type and writes it again.
fn again<T: Document>(text: &[u8]) -> (T, Value) {
    let text = std::str::from_utf8(text).expect("it is UTF-8");
    let written: Value = serde_json::from_str(text).expect("it is JSON");
    assert_eq!(written["schema"], T::SCHEMA, "{}", T::WHAT);
    let schema = schema(T::SCHEMA);
    assert_eq!(departure(&schema, &schema, &written, ""), None);
    let read = T::read(text).unwrap_or_else(|error| panic!("{}: {error}", T::SCHEMA));
    assert_eq!(read.to_json().expect("it is written"), text);
    (read, written)
}

/// The schema of a name such as `lightmeter.report/2`, as the command prints it.
fn schema(name: &str) -> Value {
    let name =
        name.strip_prefix("lightmeter.").and_then(|name| name.rsplit_once('/')).expect("a name with a version").0;
    super::json(&["schema", name])
}

/// Where a value is not as a schema says, by the keywords that the schemas have; `root` is the whole schema.
fn departure(root: &Value, schema: &Value, value: &Value, place: &str) -> Option<String> {
    if let Some(target) = schema["$ref"].as_str() {
        let target = root.pointer(target.trim_start_matches('#')).expect("a reference has a target");
        return departure(root, target, value, place);
    }
    if let Some(any) = schema["anyOf"].as_array().or(schema["oneOf"].as_array()) {
        let fits = any.iter().any(|one| departure(root, one, value, place).is_none());
        return (!fits).then(|| format!("{place}: {value} fits none of {any:?}"));
    }
    let types = schema["type"].as_array().cloned().unwrap_or_else(|| vec![schema["type"].clone()]);
    let is_of = |name: &Value| match name.as_str() {
        None => true,
        Some("null") => value.is_null(),
        Some("boolean") => value.is_boolean(),
        Some("integer") => value.is_u64() || value.is_i64(),
        Some("number") => value.is_number(),
        Some("string") => value.is_string(),
        Some("array") => value.is_array(),
        Some("object") => value.is_object(),
        Some(other) => panic!("no type {other}"),
    };
    let is_listed = schema["enum"].as_array().is_none_or(|all| all.contains(value));
    let is_constant = schema.get("const").is_none_or(|constant| constant == value);
    if !(types.iter().any(is_of) && is_listed && is_constant) {
        return Some(format!("{place}: {value} is not as {schema} says"));
    }
    let within = |schema: &Value, value: &Value, name: &str| departure(root, schema, value, &format!("{place}/{name}"));
    if let Some(values) = value.as_array() {
        let of = |k: usize| schema["prefixItems"].get(k).unwrap_or(&schema["items"]);
        return values.iter().enumerate().find_map(|(k, value)| within(of(k), value, &k.to_string()));
    }
    let members = value.as_object()?;
    let missing = schema["required"].as_array().into_iter().flatten();
    if let Some(name) = missing.filter_map(Value::as_str).find(|name| !members.contains_key(*name)) {
        return Some(format!("{place}: no {name}"));
    }
    members.iter().find_map(|(name, value)| {
        let own = schema["properties"].get(name).unwrap_or(&schema["additionalProperties"]);
        if own == false { Some(format!("{place}: {name} is too much")) } else { within(own, value, name) }
    })
}

/// A pack, and answers to it of which some are wrong, some are skipped and one is not JSON.
fn packed() -> (PathBuf, PathBuf) {
    let folder = folder("documents-pack");
    let (pack, answers) = (folder.join("pack"), folder.join("answers.jsonl"));
    let dir = pack.to_str().expect("UTF-8");
    let output = lightmeter(&["pack", dir, "fog/exp", "vector/reflect", "scene/flat", "--cases", "16", "--size", "16"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let given = std::fs::File::open(pack.join("cases.jsonl")).expect("there are cases");
    let output = command(&["eval"]).stdin(given).output().expect("the binary starts");
    let mut written = "no answer\n".to_owned();
    for (place, line) in String::from_utf8(output.stdout).expect("UTF-8").lines().enumerate() {
        let mut answer: Value = serde_json::from_str(line).expect("it is JSON");
        match place % 5 {
            0 => answer["value"][0] = 0.123.into(),
            1 => answer = serde_json::json!({ "id": answer["id"], "skip": "it has none" }),
            _ => {}
        }
        written += &format!("{answer}\n");
    }
    std::fs::write(&answers, written).expect("answers can be written");
    (pack, answers)
}

#[test]
fn a_run_is_read_again() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let filters = ["fog/linear", "attenuation/*/hard", "blend/special", "blend/add/one", "special", "scene/flat"];
    let args = [&["run", "--adapter", "lavapipe", "--cases", "16", "--size", "16"], &filters[..]].concat();
    let (report, _) = read_and_written::<Report>(&args);
    assert!(!report.groups.is_empty() && !report.stability.is_empty() && !report.special.is_empty());
    assert!(!report.blend_states.is_empty() && !report.blend_promises.is_empty() && report.unstable_beyond.is_some());
    let claims = |row: &Examined| report.stable_forms.iter().any(|form| row.id.starts_with(&form.formula));
    assert!(report.stability.iter().all(claims), "each examined form says what it claims");
    assert!(report.groups.iter().any(|group| group.image.is_some()), "a scene is among them");
}

#[test]
fn failures_are_read_again() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let head = "fn fog_exp_factor(distance: f32, density: f32) -> f32 {";
    let wrong = |text: &str| text.replace(head, &format!("{head}\n    if density > 0.0 {{ return 0.5; }}"));
    let dir = super::edited("documents", "fog.wgsl", wrong);
    let dir = dir.to_str().expect("UTF-8");
    let (report, _) = read_and_written::<Report>(&["run", "fog/exp", "--cases", "16", "--shaders", dir]);
    assert!(!report.failures.is_empty(), "the shader is wrong");
}

#[test]
fn special_values_are_read_again() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let (report, written) = read_and_written::<SpecialReport>(&["special", "--adapter", "lavapipe"]);
    assert!(report.outcomes.len() > 100 && report.probes.len() > 100);
    assert!(report.probes.iter().all(|probe| report.classes.iter().any(|class| class.name == probe.class)));
    assert!(report.probes.iter().all(|probe| report.sources.iter().any(|source| source.section == probe.source)));
    assert!(
        report.deviations.iter().flat_map(|deviation| deviation.probes.iter()).all(|name| report.probe(name).is_some())
    );
    let bits = written["outcomes"][0]["bits"].as_str().expect("bits are written in hex");
    assert_eq!(bits, format!("0x{:08x}", report.outcomes[0].bits));
}

#[test]
fn a_pack_and_a_gate_are_read_again() {
    let (pack, answers) = packed();
    let manifest = std::fs::read(pack.join("manifest.json")).expect("there is a manifest");
    let (manifest, _) = again::<Manifest>(&manifest);
    assert!(!manifest.formulas.is_empty() && !manifest.scenes.is_empty() && !manifest.files.is_empty());
    let args = ["gate", pack.to_str().expect("UTF-8"), answers.to_str().expect("UTF-8"), "--format", "json"];
    let (report, _) = again::<Report>(&lightmeter(&args).stdout);
    let renderer = report.renderer.as_ref().expect("who was asked");
    assert!(!report.failures.is_empty() && !renderer.problems.is_empty() && report.totals.skipped > 0);
    assert_eq!(report.compared_by.map(|by| by.choice), Some(manifest.choice));
}

#[test]
fn sweeps_are_read_again() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let range = ["--from", "1", "--to", "1.01", "--adapter"];
    for adapter in ["cpu", "lavapipe"] {
        let (document, _) =
            read_and_written::<SweepDocument>(&[&["sweep", "fog/exp"], &range[..], &[adapter]].concat());
        assert!(document.is_finished() && document.statistics.worst.is_some());
    }
    let checkpoint = folder("documents-sweep").join("blend.json");
    let place = checkpoint.to_str().expect("UTF-8");
    let args = ["sweep", "blend/mode-alpha", "--adapter", "lavapipe", "--checkpoint", place, "--blocks", "1"];
    let (document, _) = read_and_written::<SweepDocument>(&args);
    assert!(!document.is_finished() && document.statistics.stored.is_some());
}

#[test]
fn a_bench_is_read_again() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let args = ["bench", "fog/exp", "technique/power", "scaling/pixels", "--quick", "--adapter", "lavapipe"];
    let (document, _) = read_and_written::<BenchDocument>(&args);
    let measured = &document.adapters[0];
    assert!(!measured.groups.is_empty() && !measured.scalings.is_empty() && !measured.families.is_empty());
}

#[test]
fn a_self_test_is_read_again() {
    let (document, _) = read_and_written::<SelftestDocument>(&["selftest", "fog/exp", "--calibrate"]);
    assert!(document.kills.is_some_and(|kills| !kills.is_empty()) && document.calibration.is_some());
    let args = ["selftest", "--only", "blend-unit", "--target", "rgba8unorm", "--cases", "16"];
    let (document, _) = read_and_written::<SelftestDocument>(&args);
    assert!(!document.rows.is_empty() && document.kills.is_none());
}

#[test]
fn cases_and_formulas_are_read_again() {
    let filters =
        ["fog", "blend/special", "vector/reflect/random/000003", "special/nan", "scene/flat/0-0", "deviation"];
    let (document, _) = read_and_written::<CasesDocument>(&[&["list"], &filters[..]].concat());
    let (mut kinds, mut formulas) = ([0; 4], vec![]);
    for cases in document.cases {
        let kind = match cases {
            ListedCases::Formula(formula) => {
                formulas.push(formula);
                0
            }
            ListedCases::Table(_) => 1,
            ListedCases::Scene(_) => 2,
            ListedCases::Deviation(_) => 3,
        };
        kinds[kind] += 1;
    }
    assert!(kinds.iter().all(|&count| count > 0), "{kinds:?}");
    assert!(formulas.iter().any(|one| one.first.is_some()) && formulas.iter().any(|one| one.ids.is_some()));
    let hard = || formulas.iter().flat_map(|one| &one.hard);
    assert!(hard().any(|one| one.naive.is_some()) && hard().any(|one| one.condition.is_none()));

    let (document, _) = read_and_written::<FormulasDocument>(&["list", "--formulas"]);
    assert!(document.formulas.iter().any(|one| one.stable.is_some()));
    assert!(document.formulas.iter().any(|one| !one.aliases.is_empty()));
    let mut domains = document.formulas.iter().flat_map(|one| &one.inputs).map(|input| input.domain);
    assert!(domains.any(|domain| matches!(domain, Some(Domain::Transform(..)))), "all formulas are listed");
}

#[test]
fn what_is_shown_is_read_again() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let show = |id: &str, more: &[&str]| read_and_written::<ShowDocument>(&[&["show", id], more].concat()).0;
    let case = |id: &str, more: &[&str]| match show(id, more) {
        ShowDocument::Case(case) => case,
        other => panic!("{id} is {other:?}"),
    };
    let hard = case("fog/opacity-expm1/hard/one-in-1e7", &["--adapter", "lavapipe"]);
    assert!(!hard.answers.is_empty() && !hard.forms.is_empty() && !hard.outputs.is_empty());
    assert!(!case("fog/linear/hard/at-dmax", &["--adapter", "cpu"]).steps.is_empty());
    let targets = ["--target", "rgba8unorm", "--adapter"];
    let unit = |answer: &ShownAnswer| answer.target.is_some();
    let blended = |adapter: &str| case("blend/min/src-alpha/one/0007", &[&targets[..], &[adapter]].concat()).answers;
    assert!(blended("lavapipe").iter().any(|answer| unit(answer) && answer.values.is_some()));
    assert!(blended("cpu").iter().any(|answer| !unit(answer) && answer.values.is_some()));
    assert!(matches!(show("special/nan/keep-nan", &[]), ShowDocument::Probe(probe) if !probe.answers.is_empty()));
    let skipped = show("special/nan/keep-nan", &["--adapter", "cpu"]);
    assert!(matches!(skipped, ShowDocument::Probe(probe) if !probe.skipped.is_empty()));
    for adapter in [&["--adapter", "lavapipe"][..], &[]] {
        let pixel = show("scene/teapot/24-30", &[&["--size", "64"], adapter].concat());
        assert!(matches!(pixel, ShowDocument::Pixel(pixel) if pixel.stages.len() > 2));
    }
}

#[test]
fn what_can_be_asked_for_is_read_again() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let (adapters, _) = read_and_written::<AdaptersDocument>(&["adapters"]);
    assert!(!adapters.adapters.is_empty());
    let (effects, _) = read_and_written::<EffectsDocument>(&["effects", "scene/teapot"]);
    let mut reasons = effects.draws.iter().flat_map(|draw| &draw.reasons);
    assert!(reasons.all(|reason| reason.effect.is_some() != reason.light.is_some()));
    let (presets, _) = read_and_written::<PresetsDocument>(&["sweep"]);
    assert!(!presets.presets.is_empty());
}

/// Reads a line by a type, compares it with the schema of `eval`, and writes it again.
fn line_again<T: Serialize + DeserializeOwned>(line: &str) -> T {
    let schema = schema("lightmeter.eval/1");
    let value: Value = serde_json::from_str(line).expect("it is JSON");
    assert_eq!(departure(&schema, &schema, &value, ""), None);
    let read: T = serde_json::from_str(line).unwrap_or_else(|error| panic!("{line}: {error}"));
    assert_eq!(serde_json::to_string(&read).expect("it is written"), line);
    read
}

#[test]
fn lines_of_eval_are_read_again() {
    for line in [super::LINE, &super::LINE.replace("\"a\"", "7").replace("[0,0,-5]", "[0,0,\"NaN\"]")] {
        let request: EvalRequest = line_again(line);
        assert_eq!(EvalRequest::read(line).expect("it is a request"), request);
        let answer: EvalAnswer = line_again(super::stdout(&super::eval(line)).trim_end());
        assert_eq!(answer.id, request.id);
    }
}

#[test]
fn a_recommendation_is_read_again() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let args = ["bench", "technique/power", "--quick", "--inputs", "random", "--adapter", "lavapipe", "--recommend"];
    let found = |limit: &str| read_and_written::<Recommendation>(&[&args[..], &[limit]].concat()).0;
    assert!(found("1e-2").groups.iter().all(|group| group.chosen.is_some()));
    assert!(found("0").groups.iter().all(|group| group.reason.is_some()));
}

#[test]
fn a_record_of_special_values_is_read_again() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let folder = folder("documents-records");
    let output = lightmeter(&["special", "--adapter", "lavapipe", "--record", folder.to_str().expect("UTF-8")]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let written = std::fs::read(folder.join("lavapipe.json")).expect("there is a record");
    let (record, _) = again::<SpecialRecord>(&written);
    assert!(record.results.len() > 100);
    let published = Path::new(env!("CARGO_MANIFEST_DIR")).join("../conformance/judge/records/special");
    for entry in published.read_dir().expect("there are records") {
        again::<SpecialRecord>(&std::fs::read(entry.expect("an entry").path()).expect("it can be read"));
    }
}

#[test]
fn a_document_that_departs_from_its_schema_is_told() {
    type Change = (&'static str, fn(&mut Value));
    let (_, written) =
        read_and_written::<SweepDocument>(&["sweep", "fog/exp", "--adapter", "cpu", "--from", "1", "--to", "1.0001"]);
    let schema = schema("lightmeter.sweep/1");
    let changes: [Change; 5] = [
        ("no done", |document| drop(document.as_object_mut().and_then(|all| all.remove("done")))),
        (": more is too much", |document| document["more"] = 1.into()),
        ("/schema: ", |document| document["schema"] = "lightmeter.report/2".into()),
        ("/seconds: ", |document| document["seconds"] = "1 s".into()),
        ("/statistics/worst: ", |document| document["statistics"]["worst"]["error"] = "much".into()),
    ];
    for (said, change) in changes {
        let mut wrong = written.clone();
        change(&mut wrong);
        let departure = departure(&schema, &schema, &wrong, "").unwrap_or_default();
        assert!(departure.contains(said), "{said}: {departure}");
    }
}

#[test]
fn what_a_renderer_reads_is_read_again() {
    let folder = folder("documents-protocol");
    let dir = folder.to_str().expect("UTF-8");
    let scenes = ["scene/combined-exp", "scene/spotlight", "scene/sorted", "scene/fog-exp2-document"];
    let filter = ["fog/exp", "blend/add/src-alpha/one", "blend/layers", "special/nan"];
    let options = ["--cases", "8", "--size", "16", "--target", "rgba8unorm", "--special"];
    let output = lightmeter(&[&["pack", dir], &scenes[..], &filter, &options].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let schema = super::json(&["schema", "protocol"]);
    let lines = std::fs::read_to_string(folder.join("cases.jsonl")).expect("there are cases");
    let mut kinds = BTreeSet::new();
    for line in lines.lines() {
        let value: Value = serde_json::from_str(line).expect("it is JSON");
        assert_eq!(departure(&schema, &schema, &value, ""), None);
        let read: ProtocolLine = serde_json::from_value(value).expect("it is a line");
        let (kind, written) = match &read {
            ProtocolLine::Case(case) if case.target.is_some() => ("on a target", case.to_string()),
            ProtocolLine::Case(case) => ("case", case.to_string()),
            ProtocolLine::Probe(probe) => ("probe", probe.to_string()),
            _ => panic!("no line of a pack: {line}"),
        };
        kinds.insert(kind);
        assert_eq!(written, line);
    }
    assert_eq!(kinds, BTreeSet::from(["on a target", "case", "probe"]));
    for id in scenes {
        let file = folder.join("scenes").join(id.trim_start_matches("scene/")).join("scene.json");
        let text = std::fs::read(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let (read, _) = again::<FrameDocument>(&text);
        assert!(read.id == id && !read.frame.draws.is_empty(), "{id}");
    }
}

#[test]
fn the_published_schemas_are_current() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace's root");
    let schemas = std::fs::read_dir(root.join("docs/schemas")).expect("the schemas are published");
    let published = schemas.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
    assert_eq!(published.collect::<BTreeSet<_>>(), NAMES.iter().map(|name| format!("{name}.json")).collect());
    for name in NAMES {
        let path = format!("docs/schemas/{name}.json");
        let published = std::fs::read_to_string(root.join(&path)).expect("the schema is published");
        let current = super::stdout(&lightmeter(&["schema", name]));
        assert!(current == published, "publish it again: cargo run -p lightmeter -- schema {name} --out {path}");
    }
}
