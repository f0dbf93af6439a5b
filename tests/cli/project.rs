//! What a project says in `lightmeter.toml`, and what shells and manuals are told.

use super::gate::folder;
use super::{code, command, stderr, stdout};
use serde_json::Value;
use std::path::Path;
use std::process::Output;

/// Runs in a folder below one that has a file of settings.
fn within(folder: &Path, config: &str, args: &[&str]) -> Output {
    let below = folder.join("below");
    std::fs::create_dir_all(&below).expect("a folder can be made");
    std::fs::write(folder.join("lightmeter.toml"), config).expect("it can be written");
    command(args).current_dir(&below).output().expect("the binary starts")
}

#[test]
fn a_project_s_settings_stand_for_options_that_are_not_given() {
    let folder = folder("config");
    let config = "adapter = [\"cpu\"]\nprofile = \"opengl\"\nrequire = 0.25\n";
    let run = ["run", "fog/exp", "--cases", "8"];
    let output = within(&folder, config, &run);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let told = "../lightmeter.toml: adapter cpu, profile opengl, require 0.25";
    assert_eq!(stdout(&output).lines().next(), Some(told));

    let json = |args: &[&str]| -> Value {
        let output = within(&folder, config, &[&run[..], args, &["--format", "json"]].concat());
        serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)))
    };
    let report = json(&[]);
    assert_eq!((&report["config"]["file"], &report["profile"]), (&"../lightmeter.toml".into(), &"opengl".into()));
    assert_eq!(report["config"]["settings"]["adapter"], "cpu");
    // What is given wins, and is no setting any more.
    let report = json(&["--profile", "vulkan"]);
    assert_eq!((&report["profile"], &report["config"]["settings"]["profile"]), (&"vulkan".into(), &Value::Null));
    let report = json(&["--no-config", "--adapter=cpu"]);
    assert_eq!((&report["profile"], &report["config"]), (&"wgsl".into(), &Value::Null));
    // A command that takes none of them is not told of any.
    let output = within(&folder, config, &["list", "fog/exp"]);
    assert_eq!(stdout(&output).lines().next(), Some("fog"));
}

#[test]
fn a_project_s_baseline_lies_beside_its_settings() {
    let folder = folder("config-baseline");
    let config = "adapter = [\"cpu\"]\nbaseline = \"kept.json\"\n";
    let run = ["run", "fog/exp", "--cases", "8"];
    let output = within(&folder, config, &[&run[..], &["--update-baseline"]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(folder.join("kept.json").exists());
    assert_eq!(code(&within(&folder, config, &run)), 0);
    let output = within(&folder, config, &["run", "fog/linear", "--cases", "8"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("kept.json is of other cases"), "{}", stderr(&output));
}

#[test]
fn settings_that_nothing_can_be_made_of_are_told() {
    let folder = folder("config-wrong");
    for (config, said) in [
        ("exec = \"rm -rf x\"", "a command to start is no setting"),
        ("adapter = 5", "expected a name such as \"lavapipe\", or a list of names"),
        ("require = 2.0", "`require` is 2; expected a fraction from 0 to 1"),
        ("profile = \"metal\"", "lightmeter.toml: profile is `metal`; expected one of"),
        ("adapter = [", "lightmeter.toml, line 1: "),
        ("expect = \"nowhere.toml\"", "lightmeter.toml: expect is `nowhere.toml`, and there is no such file"),
    ] {
        let output = within(&folder, config, &["run", "fog/exp", "--cases", "8"]);
        assert_eq!(code(&output), 2, "{config}: {}", stdout(&output));
        assert!(stderr(&output).contains(said), "{config}: {}", stderr(&output));
    }
}

#[test]
fn commands_that_take_no_setting_are_left_alone() {
    let folder = folder("config-alone");
    // Of two adapters, and of a file that nothing can be made of, whoever takes neither is not told.
    let image = folder.join("x.png").display().to_string();
    for config in ["adapter = [\"cpu\", \"all\"]", "nonsense = 1"] {
        for args in [&["list", "fog/exp"][..], &["help", "run"], &["render", "phong", "--size", "16", "--out", &image]]
        {
            let output = within(&folder, config, args);
            assert_eq!(code(&output), 0, "{config} {args:?}: {}", stderr(&output));
        }
    }
    let output = within(&folder, "adapter = [\"cpu\", \"all\"]", &["sweep", "fog/exp"]);
    assert_eq!(code(&output), 2);
    assert!(
        stderr(&output).contains("this command takes only one; choose one with `--adapter`"),
        "{}",
        stderr(&output)
    );
    // A folder of that name is no file without settings.
    std::fs::remove_file(folder.join("lightmeter.toml")).expect("it is there");
    std::fs::create_dir(folder.join("lightmeter.toml")).expect("a folder can be made");
    let output = command(&["run", "fog/exp"]).current_dir(&folder).output().expect("the binary starts");
    assert_eq!(code(&output), 2, "{}", stderr(&output));
    assert!(stderr(&output).contains("cannot read lightmeter.toml"), "{}", stderr(&output));
    std::fs::remove_dir(folder.join("lightmeter.toml")).expect("it is empty");
}

#[test]
fn a_gate_that_ends_with_the_first_failure_writes_no_baseline() {
    let (pack, answers) = super::gate::answered("fail-fast-gate", &["fog/exp", "vector/reflect"]);
    let spoil =
        |k: usize, line: &str| (if k == 3 { line.replace("\"value\":[", "\"value\":[7") } else { line.into() }) + "\n";
    let wrong = super::gate::edit(&answers, spoil).display().to_string();
    let (pack, baseline) = (pack.display().to_string(), folder("fail-fast-baseline").join("b.json"));
    let kept = baseline.display().to_string();
    let args = ["gate", &pack, &wrong, "--fail-fast", "--baseline", &kept, "--update-baseline"];
    let output = command(&args).output().expect("the binary starts");
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    assert!(stderr(&output).contains("the first failure ended the run, as --fail-fast asks"), "{}", stderr(&output));
    assert!(stderr(&output).contains("it was interrupted"), "{}", stderr(&output));
    assert!(!baseline.exists(), "half a result is no baseline");
    let output = command(&[&args[..4], &["--format", "json"]].concat()).output().expect("the binary starts");
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["interrupted"]["at_first_failure"], true, "{report}");
}

#[test]
fn shells_and_manuals_know_every_command() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let output = command(&["completions", shell]).output().expect("the binary starts");
        let text = stdout(&output);
        assert_eq!(code(&output), 0);
        assert!(text.contains("bench") && text.contains("fail-fast"), "{shell}");
        assert!(!text.contains("start-renderer"), "{shell} is told what is hidden");
    }
    let folder = folder("man");
    let output = command(&["man"]).arg(&folder).output().expect("the binary starts");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let page = std::fs::read_to_string(folder.join("lightmeter-run.1")).expect("there is a page");
    assert!(page.contains(".TH lightmeter-run") && page.contains("fail\\-fast"), "{page}");
    assert!(folder.join("lightmeter.1").exists() && !folder.join("lightmeter-start-renderer.1").exists());
}

#[test]
fn a_run_ends_with_the_first_failure_where_that_is_asked() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let folder = super::edited("fail-fast", "fog.wgsl", |text| text.replace("length(p)", "abs(p.z)"));
    let folder = folder.to_str().expect("UTF-8");
    let count = |more: &[&str]| {
        let args = [&["run", "fog", "--cases", "256", "--format", "json", "--shaders", folder], more].concat();
        let output = command(&args).output().expect("the binary starts");
        assert_eq!(code(&output), 1, "{}", stderr(&output));
        let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        (report["totals"]["cases"].as_u64().expect("a count"), report["interrupted"]["message"].clone())
    };
    let (all, none) = count(&[]);
    let (some, why) = count(&["--fail-fast"]);
    assert!(some < all && none.is_null(), "{some} of {all}");
    assert_eq!(why, "the first failure ended the run");
}

#[test]
fn any_name_can_be_shown() {
    for (name, said) in [
        ("fog/exp", "mistakes that are known by name"),
        ("fog", "fog/linear-radial"),
        ("scene/phong", "effects that it calls for"),
        ("fog-base-two", "a power of 2"),
        ("ruling/4", "fog/exp2-document"),
        ("004", "lecture notes"),
        ("deviation/llvmpipe-exp", "exp2(x · log2 e)"),
        ("llvmpipe-exp", "exp2(x · log2 e)"),
        ("special/nan", "special values"),
        ("margin", "how much of its tolerance"),
        ("ruling 9", "by its name"),
        ("glossary", "how much of its tolerance"),
        ("blend/mode-alpha", "blend/mode-alpha"),
        ("spot-cutoff", "attenuation/spot-cutoff"),
        ("blinn", "lighting/blinn-stable"),
    ] {
        let output = command(&["show", name]).output().expect("the binary starts");
        assert_eq!(code(&output), 0, "{name}: {}", stderr(&output));
        assert!(stdout(&output).contains(said), "{name}: {}", stdout(&output));
    }
    let listed = command(&["list", "blinn"]).output().expect("the binary starts");
    assert!(code(&listed) == 0 && stdout(&listed).contains("point-blinn"), "{}", stderr(&listed));
    assert!(stderr(&listed).contains("no case matches `blinn`: these have it in their names"));
    for (name, said) in [("fog/exp", "fn fog_exp("), ("scene/phong", "fn scene_fragment(")] {
        let output = command(&["show", name, "--wgsl"]).output().expect("the binary starts");
        assert!(stdout(&output).contains(said), "{name}: {}", stdout(&output));
    }
    for (args, said) in [
        (&["show", "ruling/99"][..], "no ruling 99; there are 1 to 16"),
        (&["show", "scene/fong"], "no scene `fong`; did you mean"),
        (&["show", "fog/exp", "--format", "json"], "list --formulas --format json"),
        (&["show", "interpolation/raster-facing", "--wgsl"], "fixed hardware"),
    ] {
        let output = command(args).output().expect("the binary starts");
        assert_eq!(code(&output), 2, "{args:?}: {}", stdout(&output));
        assert!(stderr(&output).contains(said), "{args:?}: {}", stderr(&output));
    }
}
