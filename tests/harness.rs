//! The conformance tests themselves: their names, their sum, what they print and how they end, whatever the environment.

#[path = "cli/shader_bugs.rs"]
mod shader_bugs;

use lightmeter::adapters;
use lightmeter::document::event::Silent;
use lightmeter::document::report::Totals;
use lightmeter::options::Options;
use lightmeter::run::{run, run_selection};
use lightmeter::select::catalogue;
use lightmeter::selection::Selection;
use lightmeter::special::Class;
use lightmeter::subject::Subject;
use lightmeter::subject_gpu::code_of;
use lightmeter::witness::NamedDeviation;
use lightmeter_gpu::FILES;
use lightmeter_tests::harness::{AdapterSuite, Variables};
use lightmeter_tests::place::folder;
use shader_bugs::SHADER_BUGS;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::process::{Command, Output};

/// The trials' names without any variable.
fn names() -> BTreeSet<String> {
    let suite = AdapterSuite::new(Variables::default().settings());
    let trials = suite.trials();
    let names: BTreeSet<String> = trials.iter().map(|trial| trial.name().to_owned()).collect();
    assert_eq!(names.len(), trials.len(), "a name stands twice");
    names
}

/// The program with some variables, and none of the caller's.
fn harness(variables: &[(&str, &str)], arguments: &[&str]) -> (i32, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_conformance-harness"));
    for (name, _) in std::env::vars_os().filter(|(name, _)| name.to_string_lossy().starts_with("LIGHTMETER_")) {
        command.env_remove(name);
    }
    let Output { status, stdout, stderr } =
        command.envs(variables.iter().copied()).args(arguments).output().expect("the program starts");
    let text = [stdout, stderr].map(|bytes| String::from_utf8(bytes).expect("output is UTF-8")).concat();
    assert!(!text.contains("panicked"), "{variables:?} {arguments:?}: {text}");
    (status.code().expect("the program ends by itself"), text)
}

/// The names of the trials that an output tells to have ended so.
fn ended<'a>(text: &'a str, how: &str) -> BTreeSet<&'a str> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("test ")?.split_once(" ... "));
    lines.filter(|(_, end)| end.starts_with(how)).map(|(name, _)| name.trim()).collect()
}

/// A folder with a copy of a shader, edited.
fn edited(test: &str, file: &str, right: &str, wrong: &str) -> PathBuf {
    let folder = folder(test);
    let (_, text) = FILES.into_iter().find(|(name, _)| *name == file).expect("the shader is built in");
    assert!(text.contains(right), "`{right}` no longer stands in {file}");
    std::fs::write(folder.join(file), text.replace(right, wrong)).expect("a shader can be written");
    folder
}

#[test]
fn every_formula_table_scene_and_deviation_has_its_trial() {
    let names = names();
    assert!(names.len() >= 200, "{}", names.len());
    let path = |id: &str| format!("conformance::{}", id.replace('/', "::"));
    for member in catalogue() {
        let id = path(&member.spec.id);
        let has_trial = names.iter().any(|name| {
            id.strip_prefix(name.as_str())
                .is_some_and(|rest| rest.is_empty() || rest.starts_with("::") || rest.starts_with('.'))
        });
        assert!(has_trial, "{} has no trial", member.spec.id);
    }
    let tables = Class::ALL.into_iter().map(|class| format!("special/{}", class.name()));
    let scenes = lightmeter::scene::library::SCENES.iter().map(|(name, _)| format!("scene/{name}"));
    let deviations = NamedDeviation::all().into_iter().map(|deviation| format!("deviation/{}", deviation.name()));
    for id in tables.chain(scenes).chain(deviations) {
        assert!(names.contains(&path(&id)), "{id} has no trial");
    }
}

/// The whole and the sum of its parts, by the embedded implementation and on devices.
#[test]
fn the_trials_judge_together_what_a_run_does() {
    if lightmeter_tests::needs::lacks_lavapipe() {
        return;
    }
    let code = code_of(None).expect("the built-in shaders are valid");
    let options = Options { cases: 16, ..Options::new(code) };
    let parts = Selection::of(&options).parts();
    let embedded = || vec![Subject::embedded()];
    let device = || adapters::open(&[]).unwrap_or_else(|error| panic!("{error}"));
    for open in [&embedded as &dyn Fn() -> Vec<Subject>, &device] {
        let whole = run(&mut open(), &options, &mut Silent).expect("the run ends").totals;
        let (mut subjects, mut sum) = (open(), Totals::default());
        for part in &parts {
            let judged = run_selection(&part.selection, &mut subjects, &options, &mut Silent);
            sum.add(&judged.expect("the part ends").totals);
        }
        assert_eq!(sum, whole, "{}", subjects[0].identity.name);
        assert!(whole.verdicts > 100_000 && whole.failed == 0, "{whole:?}");
    }
}

/// The functions of a shader file, each with its text.
fn functions(text: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    text.split("\nfn ").skip(1).map(|part| part.split_once('(').expect("a function has parameters"))
}

/// The shader functions in which a text of a file stands, and all that call them, themselves or by others.
fn concerned(file: &str, right: &str) -> BTreeSet<&'static str> {
    let of_file = FILES.into_iter().filter(|(name, _)| *name == file);
    let has_it = of_file.flat_map(|(_, text)| functions(text)).filter(|(_, body)| body.contains(right));
    let mut found: BTreeSet<&str> = has_it.map(|(name, _)| name).collect();
    assert!(!found.is_empty(), "`{right}` stands in no function of {file}");
    let all: BTreeMap<&str, &str> = FILES.into_iter().flat_map(|(_, text)| functions(text)).collect();
    loop {
        let calls = |body: &str| found.iter().any(|name| body.contains(&format!("{name}(")));
        let more: Vec<&str> = all.iter().filter(|(_, body)| calls(body)).map(|(name, _)| *name).collect();
        let before = found.len();
        found.extend(more);
        if found.len() == before {
            return found;
        }
    }
}

/// Ten of the mistakes that a run must find, in every file of formulas that has one.
#[test]
fn mistakes_fail_the_trials_of_the_formulas_that_they_concern() {
    if lightmeter_tests::needs::lacks_lavapipe() {
        return;
    }
    let functions: BTreeMap<String, Vec<String>> = {
        let selection = Selection::of(&Options::new(code_of(None).expect("the built-in shaders are valid")));
        let functions_of = |part: &Selection| {
            part.formulas.iter().map(|chosen| part.catalogue[chosen.member].spec.function.to_owned()).collect()
        };
        let name = |path: &str| format!("conformance::{}", path.replace('/', "::"));
        selection.parts().iter().map(|part| (name(&part.path), functions_of(&part.selection))).collect()
    };
    let of_formulas =
        |file: &str| file.strip_suffix(".wgsl").is_some_and(|family| lightmeter::cases::FAMILIES.contains(&family));
    let mut chosen: Vec<_> = SHADER_BUGS.iter().filter(|(_, file, ..)| of_formulas(file)).collect();
    // One of each file first.
    let mut seen = BTreeSet::new();
    chosen.sort_by_cached_key(|(_, file, ..)| !seen.insert(*file));
    assert!(chosen.len() >= 10, "{}", chosen.len());
    for (number, (mistake, file, right, wrong, filter)) in chosen.into_iter().take(10).enumerate() {
        let folder = edited(&format!("mistake-{number}"), file, right, wrong);
        let variables = [("LIGHTMETER_SHADERS", folder.to_str().expect("UTF-8")), ("LIGHTMETER_CASES", "256")];
        let (code, text) = harness(&variables, &["--skip", "conformance::scene"]);
        let failed = ended(&text, "FAILED");
        let family = format!("conformance::{}::", filter.split('/').next().expect("a family"));
        assert!(code == 101 && failed.iter().any(|name| name.starts_with(&family)), "{mistake}: {failed:?}\n{text}");
        let concerned = concerned(file, right);
        for name in failed {
            let functions = &functions[name];
            assert!(functions.iter().any(|function| concerned.contains(function.as_str())), "{mistake}: {name}");
        }
        // What run prints: counts, a case with its inputs, and the command that runs it alone.
        for part in [" failed", "FAIL ", "  reference ", "  legal ", "  again          lightmeter run '", "--shaders '"]
        {
            assert!(text.contains(part), "{mistake}: no `{part}` in {text}");
        }
    }
}

#[test]
fn a_bad_variable_fails_every_selected_trial_and_says_what_is_right() {
    if lightmeter_tests::needs::lacks_lavapipe() {
        return;
    }
    let rows = [
        ("LIGHTMETER_ADAPTER", "vodoo", "no adapter `vodoo`. There are"),
        ("LIGHTMETER_ADAPTER", ",", "no list of names, such as lavapipe,swiftshader"),
        ("LIGHTMETER_CASES", "many", "`many` is not a whole number from 1 to 1000000000000"),
        ("LIGHTMETER_CASES", "0", "`0` is not a whole number"),
        ("LIGHTMETER_SEED", "-1", "`-1` is not a whole number from 0"),
        ("LIGHTMETER_PROFILE", "exact", "no profile `exact`; expected one of wgsl, vulkan, opengl"),
        ("LIGHTMETER_SHADERS", "/nowhere", "cannot read shaders from /nowhere"),
        ("LIGHTMETER_ADAPTOR", "cpu", "is no variable of the conformance tests; there are LIGHTMETER_ADAPTER"),
    ];
    let fog = names().iter().filter(|name| name.contains("::fog::")).count();
    for (name, value, message) in rows {
        let line = format!("conformance: {name}={value}\n");
        for (arguments, trials) in [(&["::fog::"][..], fog), (&["--exact", "conformance::fog::linear"], 1)] {
            let (code, text) = harness(&[(name, value)], arguments);
            assert_eq!((code, ended(&text, "FAILED").len()), (101, trials), "{name}={value}: {text}");
            assert!(text.starts_with(&line) && text.contains(message), "{name}={value}: {text}");
        }
        // Names that these variables would have given may be filtered by, too.
        let (code, text) = harness(&[(name, value)], &["no-such-trial"]);
        // An unknown adapter has the same names as a known one.
        let is_known = value == "vodoo";
        assert!(is_known && code == 0 || code == 101 && text.contains(message), "{name}={value}: {text}");
    }
}

#[test]
fn without_a_driver_every_selected_trial_is_skipped_and_says_what_to_do() {
    const NONE: [(&str, &str); 4] = [
        ("VK_LOADER_DRIVERS_DISABLE", "*"),
        ("VK_DRIVER_FILES", ""),
        ("VK_ADD_DRIVER_FILES", ""),
        ("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere"),
    ];
    let arguments = ["::fog::linear"];
    for (ci, expected, how) in [("", 0, "ignored"), ("true", 101, "FAILED")] {
        let (code, text) = harness(&[&NONE[..], &[("CI", ci)]].concat(), &arguments);
        assert!(code == expected && ended(&text, how).len() >= 3 && ended(&text, "ok").is_empty(), "{text}");
        assert!(text.contains("apt-get install libvulkan1 mesa-vulkan-drivers"), "{text}");
    }
}

#[test]
fn where_the_named_driver_is_missing_every_selected_trial_fails_and_says_what_to_do() {
    const NOWHERE: [(&str, &str); 4] = [
        ("VK_DRIVER_FILES", "/nowhere"),
        ("VK_ADD_DRIVER_FILES", ""),
        ("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere"),
        ("LIBGL_DRIVERS_PATH", "/nowhere"),
    ];
    let all = names().len();
    for (arguments, trials) in
        [(&[][..], all), (&["::fog::linear"], 3), (&["--exact", "conformance::scene::teapot"], 1)]
    {
        let (code, text) = harness(&NOWHERE, arguments);
        assert_eq!(code, 101, "{text}");
        assert!(ended(&text, "ok").is_empty() && ended(&text, "FAILED").len() >= trials, "{text}");
        assert!(text.contains("`./x test` install lavapipe"), "{text}");
    }
    let every = [&NOWHERE[..], &[("LIGHTMETER_ADAPTER", "all")]].concat();
    for arguments in [&["lavapipe"][..], &["--exact", "conformance::fog::linear::lavapipe"], &["::fog::"]] {
        let (code, text) = harness(&every, arguments);
        assert!(code == 101 && text.contains("VK_DRIVER_FILES names no Vulkan driver"), "{arguments:?}: {text}");
    }
    // The embedded implementation needs none.
    let (code, text) = harness(&[&NOWHERE[..], &[("LIGHTMETER_ADAPTER", "cpu")]].concat(), &["::fog::linear"]);
    assert!(code == 0 && ended(&text, "FAILED").is_empty(), "{text}");
}

#[test]
fn filters_work_as_for_any_test_and_never_select_nothing_in_green() {
    const CPU: [(&str, &str); 2] = [("LIGHTMETER_ADAPTER", "cpu"), ("LIGHTMETER_CASES", "16")];
    let selected = |arguments: &[&str]| {
        let (code, text) = harness(&CPU, arguments);
        assert_eq!(code, 0, "{text}");
        ended(&text, "ok").into_iter().map(str::to_owned).collect::<Vec<String>>()
    };
    assert_eq!(selected(&["--exact", "conformance::fog::linear"]), ["conformance::fog::linear"]);
    let linear = selected(&["::fog::linear"]);
    assert!(linear.len() > 1 && linear.iter().all(|name| name.starts_with("conformance::fog::linear")), "{linear:?}");
    assert_eq!(selected(&["::fog::linear", "--skip", "linear-", "--test-threads", "2"]), ["conformance::fog::linear"]);
    let (code, text) = harness(&CPU, &["conformance::fgo"]);
    assert!(code == 101 && text.contains("no trial's name has `conformance::fgo` in it"), "{text}");
    // A test of another target.
    let (code, text) = harness(&CPU, &["the_gpu_agrees"]);
    assert!(code == 0 && text.contains("0 passed"), "{text}");
}

#[test]
fn the_list_needs_no_driver_and_is_what_nextest_reads() {
    let (code, text) = harness(&[("VK_DRIVER_FILES", "/nowhere")], &["--list", "--format", "terse"]);
    assert_eq!(code, 0);
    let listed: BTreeSet<&str> = text.lines().map(|line| line.strip_suffix(": test").expect(line)).collect();
    assert_eq!(listed, names().iter().map(String::as_str).collect());
    let (_, ignored) = harness(&[], &["--list", "--format", "terse", "--ignored"]);
    assert_eq!(ignored, "");
}

#[test]
fn several_adapters_are_parts_of_the_names() {
    if lightmeter_tests::needs::lacks_lavapipe() {
        return;
    }
    let variables = [("LIGHTMETER_ADAPTER", "cpu, lavapipe"), ("LIGHTMETER_CASES", "16")];
    let (code, text) = harness(&variables, &["::fog::linear::"]);
    let expected = ["conformance::fog::linear::cpu", "conformance::fog::linear::lavapipe"];
    assert_eq!((code, ended(&text, "ok")), (0, expected.into()), "{text}");
    assert!(text.contains("conformance: ✓ "), "{text}");
}

#[test]
fn an_invalid_shader_fails_every_selected_trial_with_its_line() {
    let folder = edited("invalid", "fog.wgsl", "return abs(p.z);", "return abs(p.z;");
    let variables = [("LIGHTMETER_SHADERS", folder.to_str().expect("UTF-8")), ("LIGHTMETER_CASES", "16")];
    let (code, text) = harness(&variables, &["conformance::interpolation"]);
    let failed = ended(&text, "FAILED");
    assert!(code == 101 && failed.contains("conformance::interpolation::line") && failed.len() > 20, "{text}");
    assert!(text.contains("fog.wgsl:"), "{text}");
}

#[test]
fn deviations_of_other_drivers_are_ignored_with_the_reason() {
    let (code, text) = harness(&[("LIGHTMETER_ADAPTER", "cpu")], &["conformance::deviation"]);
    assert_eq!((code, ended(&text, "ignored").len()), (0, NamedDeviation::all().len()), "{text}");
    assert!(text.contains("it does not concern this driver"), "{text}");
}

/// On every adapter there is, software OpenGL and SwiftShader among them where they are installed.
#[test]
fn witnesses_are_still_seen_on_every_adapter_that_they_concern() {
    if lightmeter_tests::needs::lacks_lavapipe() {
        return;
    }
    let options = Options::new(code_of(None).expect("the built-in shaders are valid"));
    let mut seen = BTreeSet::new();
    for mut subject in adapters::open(&[adapters::ALL.to_owned()]).unwrap_or_else(|error| panic!("{error}")) {
        for deviation in NamedDeviation::all() {
            let still = deviation.is_still_seen(&mut subject, &catalogue(), &options).expect("the witness is judged");
            assert_ne!(still, Some(false), "{} on {}", deviation.name(), subject.identity.name);
            seen.extend(still.map(|_| deviation.name()));
        }
    }
    assert!(seen.contains("llvmpipe-exp") || lightmeter_gpu::native_adapters()[0].name != "lavapipe", "{seen:?}");
}
