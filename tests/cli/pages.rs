//! Results as pages: one file of HTML from the documents of runs, the same as the command itself would have written.

use super::{code, folder, gate, json, lightmeter, stderr, stdout};
use lightmeter::cases::{Kind, Spec};
use lightmeter::faults::faults;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::load;
use lightmeter::select::catalogue;
use lightmeter::special::PROBES;
use lightmeter::sweep::PRESETS;
use lightmeter_scene::blend::{Equation, Factor};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// A file of these tests' own.
fn path(name: &str) -> String {
    static OWN: LazyLock<PathBuf> = LazyLock::new(|| folder("pages"));
    let path = OWN.join(name);
    path.to_str().expect("the path is UTF-8").to_owned()
}

/// The one file that a page is: with its policy, and without anything from elsewhere.
#[track_caller]
fn is_whole(page: &str) {
    assert!(page.starts_with("<!DOCTYPE html>"), "{page:.200}");
    assert!(page.contains("default-src 'none'"), "{page:.600}");
    for elsewhere in ["src=\"http", "href=\"http", "<link", "@import", "url("] {
        assert!(!page.contains(elsewhere), "{elsewhere}");
    }
}

#[test]
fn a_result_is_a_page_at_once_and_later() {
    let exec = gate::process::command_of("wrong-at=fog/exp/random/000017");
    let commands: [(&str, &[&str]); 5] = [
        ("run", &["run", "fog/exp", "--adapter", "cpu", "--cases", "32"]),
        ("gate", &["gate", "fog/exp", "--exec", &exec, "--cases", "32"]),
        ("sweep", &["sweep", "fog/exp", "--adapter", "cpu", "--from", "-8.01", "--to", "-8"]),
        ("bench", &["bench", "color/replace", "--quick", "--adapter", "cpu"]),
        ("selftest", &["selftest", "color/replace", "--only", "formulas"]),
    ];
    for (name, command) in commands {
        let [as_json, as_html, later] = ["json", "html", "later.html"].map(|end| path(&format!("page-{name}.{end}")));
        let failing = i32::from(name == "gate");
        let output = lightmeter(&[command, &["--format", "json", "--out", &as_json]].concat());
        assert_eq!(code(&output), failing, "{name}: {}", stderr(&output));
        let output = lightmeter(&[command, &["--format", "html", "--out", &as_html]].concat());
        assert_eq!(code(&output), failing, "{name}: {}", stderr(&output));
        let output = lightmeter(&["page", "report", &as_json, "--out", &later]);
        assert_eq!(code(&output), 0, "{name}: {}", stderr(&output));
        for page in [&as_html, &later] {
            let page = std::fs::read_to_string(page).expect("it was written");
            is_whole(&page);
            assert!(page.contains("<h1>"), "{name} has a verdict");
        }
    }
    let run = std::fs::read_to_string(path("page-run.later.html")).expect("it was written");
    for what in ["its worst case: <b>fog/exp/", "<figure class=\"plot\">", "lightmeter show fog/exp/"] {
        assert!(run.contains(what), "the card of what passes has {what}");
    }
    let sweep = std::fs::read_to_string(path("page-sweep.json")).expect("it was written");
    let sweep: serde_json::Value = serde_json::from_str(&sweep).expect("it is JSON");
    let along = sweep["statistics"]["along"].as_array().expect("errors along the input are told");
    let most = along.iter().filter_map(|part| part["error_max"].as_f64()).fold(0.0, f64::max);
    assert_eq!(Some(most), sweep["statistics"]["worst"]["error"].as_f64(), "the worst error is that of a part");
    let gate = std::fs::read_to_string(path("page-gate.later.html")).expect("it was written");
    for what in ["fails-fog-exp", "fog/exp/random/000017", "lightmeter gate fog/exp", "<figure class=\"plot\">"] {
        assert!(gate.contains(what), "the card of what fails has {what}");
    }
}

#[test]
fn the_page_of_a_sweep_has_the_command_that_made_it() {
    let asked = ["sweep", "fog/exp", "--adapter", "cpu", "--from", "-8.01", "--to", "-8", "--set", "density=0.0625"];
    let page = stdout(&lightmeter(&[&asked[..], &["--profile", "vulkan", "--format", "html"]].concat()));
    let command = "lightmeter sweep fog/exp --adapter cpu --from -8.01 --to -8 --set density=0.0625 --profile vulkan";
    assert!(page.contains(command), "{page}");
    // What the ready-made sweep shows is said of its own inputs alone.
    let preset = PRESETS.iter().find(|preset| preset.formula == "fog/exp").expect("there is one");
    assert!(!page.contains(preset.what), "{page}");
}

#[test]
fn a_gate_that_judges_too_little_fails_in_its_page() {
    let exec = gate::process::command_of("formulas=fog/exp");
    let page = stdout(&lightmeter(&[
        "gate",
        "fog/exp",
        "fog/exp-radial",
        "--exec",
        &exec,
        "--cases",
        "16",
        "--require",
        "0.9",
        "--format",
        "html",
    ]));
    assert!(page.contains("✗ fails") && page.contains("part of 0.9"), "{page}");
}

/// Who, when, by what and how it ended stands at the top of each page.
#[test]
fn every_page_begins_with_the_same_head() {
    let run = path("head-run.json");
    let ran = lightmeter(&["run", "fog/exp", "--adapter", "cpu", "--cases", "16", "--format", "json", "--out", &run]);
    assert_eq!(code(&ran), 0);
    let html = path("head-matrix.html");
    assert_eq!(code(&lightmeter(&["page", "matrix", &run, "--out", &html])), 0);
    let sweep = ["sweep", "fog/exp", "--adapter", "cpu", "--from", "-8.01", "--to", "-8", "--format", "html"];
    let selftest = ["selftest", "color/replace", "--only", "formulas", "--format", "html"];
    for (name, page) in [
        ("run", stdout(&lightmeter(&["page", "report", &run]))),
        ("matrix", std::fs::read_to_string(html).expect("it was written")),
        ("sweep", stdout(&lightmeter(&sweep))),
        ("selftest", stdout(&lightmeter(&selftest))),
    ] {
        let head = page.split("<body>").nth(1).and_then(|body| body.split("</dl>").next()).expect("it has a head");
        for what in ["class=\"head good\"", "✓ passes", "lightmeter ", "0.1.0", "made at", " UTC", "seed"] {
            assert!(head.contains(what), "no {what} in the head of the page of a {name}: {head}");
        }
    }
}

/// The card of what passes shows what was answered to its worst case, as the card of what fails does.
#[test]
fn a_passing_card_has_inputs_and_the_answer() {
    let page = stdout(&lightmeter(&["run", "fog/exp", "--adapter", "cpu", "--cases", "16", "--format", "html"]));
    let card = page.split("class=\"card passing\"").nth(1).and_then(|rest| rest.split("</details>").next());
    let card = card.expect("it has a card");
    for what in
        ["on cpu, compute", "aria-label=\"inputs\"", "the reference is", "<b class=\"pass\">", "the answer", "r=\"4\""]
    {
        assert!(card.contains(what), "no {what} in {card}");
    }
}

#[test]
fn a_matrix_has_a_column_for_each_subject() {
    let [a, b] = ["a", "b"].map(|name| path(&format!("matrix-{name}.json")));
    let run = ["run", "fog/*", "--adapter", "cpu", "--cases", "16", "--format", "json", "--out"];
    assert_eq!(code(&lightmeter(&[&run[..], &[a.as_str()]].concat())), 0);
    let exec = gate::process::command_of("wrong-at=fog/exp/random/000003");
    let gate = ["gate", "fog/*", "--exec", &exec, "--cases", "16", "--format", "json", "--out"];
    assert_eq!(code(&lightmeter(&[&gate[..], &[b.as_str()]].concat())), 1);
    let table = stdout(&lightmeter(&["page", "matrix", &a, &b]));
    for what in ["matrix-a", "matrix-b", "| fog/exp |", "✗"] {
        assert!(table.contains(what), "no {what} in {table}");
    }
    let html = path("matrix.html");
    assert_eq!(code(&lightmeter(&["page", "matrix", &a, &b, "--out", &html])), 0);
    let page = std::fs::read_to_string(html).expect("it was written");
    is_whole(&page);
    assert!(page.contains("id=\"matrix\""));
}

#[test]
fn renderers_have_a_row_each() {
    let [right, wrong, text] = ["right.json", "wrong.json", "told.txt"].map(|name| path(&format!("renderers-{name}")));
    for (fault, status, file) in [("", 0, &right), ("wrong-at=fog/exp/random/000003", 1, &wrong)] {
        let exec = gate::process::command_of(fault);
        let gate = ["gate", "fog/*", "--exec", &exec, "--cases", "16", "--json", file, "--out", &text];
        assert_eq!(code(&lightmeter(&gate)), status);
    }
    for option in ["--out", "--baseline"] {
        let one_file =
            lightmeter(&["gate", "fog/*", "--cases", "16", "--exec", "true", "--json", &right, option, &right]);
        let told = stderr(&one_file);
        assert!(code(&one_file) == 2 && told.contains(&format!("`--json` and `{option}` both name")), "{told}");
    }
    // What is told is as it is without `--json`.
    assert!(std::fs::read_to_string(&text).expect("it was written").contains("cases pass, 1 fail"));
    let table = stdout(&lightmeter(&["page", "renderers", &right, &wrong]));
    let rows: Vec<Vec<&str>> = table
        .lines()
        .filter(|line| line.starts_with('|') && line.contains("example 1.0"))
        .map(|row| row.split('|').map(str::trim).collect())
        .collect();
    let [right, wrong] = rows.as_slice() else { panic!("{table}") };
    let (pass, other) = (9, 11);
    assert_eq!((right[1], wrong[1], right[other], wrong[other]), ("✓", "✗", "0", "1"), "{table}");
    let number = |cell: &str| cell.replace(',', "").parse::<u64>().expect("a number");
    assert_eq!(number(right[pass]), number(wrong[pass]) + 1, "{table}");
    assert!(right[6] != "0" && right[6] == wrong[6] && right[7] == "0", "{table}");
    let whys: Vec<&str> = table.lines().filter(|line| line.starts_with("* ✗ ")).collect();
    assert!(matches!(whys[..], [why] if why.starts_with("* ✗ example 1.0: ")), "{table}");
}

#[test]
fn what_makes_no_page_is_told() {
    let other = path("no-page.json");
    std::fs::write(&other, "{\"schema\": \"lightmeter.cases/1\"}").expect("it can be written");
    let broken = path("no-page.txt");
    std::fs::write(&broken, "not JSON").expect("it can be written");
    for (args, said) in [
        (&["page", "report", &other][..], "its schema is `lightmeter.cases/1`; expected the JSON of a run"),
        (&["page", "report", &broken], "it is not JSON"),
        (&["page", "report"], "exactly one run"),
        (&["page", "matrix"], "at least one run or gate"),
        (&["page", "matrix", &other], "no-page.json"),
        (&["page", "renderers"], "at least one gate"),
        (&["page", "renderers", &other], "no-page.json"),
        (&["book", "--docs", "/nowhere"], "a checkout of lightmeter"),
        (&["merge", "--format", "html", "/nowhere"], "/nowhere"),
    ] {
        let output = lightmeter(args);
        assert!(code(&output) == 2 && stderr(&output).contains(said), "{args:?}: {}", stderr(&output));
    }
}

#[test]
fn the_page_of_a_merge_is_that_of_the_whole() {
    let command = ["run", "fog", "--adapter", "cpu", "--cases", "16"];
    let parts = ["1/2", "2/2"].map(|shard| {
        let out = path(&format!("page-shard-{}.json", &shard[..1]));
        assert_eq!(
            code(&lightmeter(&[&command[..], &["--shard", shard, "--format", "json", "--out", &out]].concat())),
            0
        );
        out
    });
    let page = stdout(&lightmeter(&["merge", &parts[0], &parts[1], "--format", "html"]));
    is_whole(&page);
    let whole = json(&[&command[..], &["--format", "json"]].concat());
    let formulas = whole["groups"].as_array().expect("groups").iter().filter_map(|group| group["id"].as_str());
    for id in formulas {
        assert!(page.contains(id), "{id}");
    }
}

/// A page of the documentation.
fn docs(name: &str) -> String {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The page of rulings is made from no run.
#[test]
fn the_page_of_rulings_is_current() {
    let page = stdout(&lightmeter(&["page", "rulings"]));
    assert!(page == docs("rulings.md"), "docs/rulings.md is another: `lightmeter page rulings --out docs/rulings.md`");
}

/// The rows of a table of Markdown, each cell without its emphasis.
fn rows(text: &str) -> Vec<Vec<String>> {
    let cell = |cell: &str| cell.trim().trim_matches(['*', '`', '✗', ' ']).to_owned();
    let row = |line: &str| line.trim_matches('|').split('|').map(cell).collect();
    text.lines().filter(|line| line.starts_with('|')).map(row).collect()
}

/// The guide's table of costs is a part of the page of a bench, and the chapter on cost tells its extremes.
#[test]
fn figures_of_costs_are_those_of_the_page_of_the_bench() {
    let (bench, guide, chapter) = (docs("bench.md"), docs("guide.md"), docs("book/cost.md"));
    let (_, every) = bench.split_once("### Every formula").expect("the page has a section of every formula");
    let (_, scenes) = bench.split_once("### Scenes").expect("the page has a section of scenes");
    let (formulas, scenes) = (rows(every), rows(scenes.split("\n### ").next().unwrap_or_default()));
    let (_, told) = guide.split_once("| formula or scene | f16 |").expect("the guide has a table of costs");
    let told = rows(&format!("| formula or scene | f16 |{}", told.split("\n\n").next().unwrap_or_default()));
    for row in &told[2..] {
        let (id, time) = row[0].split_once("` (").expect("an id and a time");
        let of = if id.starts_with("scene/") { &scenes } else { &formulas };
        let known = of.iter().find(|known| known[0] == id.trim_start_matches("scene/")).expect("the page has it");
        assert_eq!(time, format!("{} in f32)", known[1]), "{id}");
        for (name, cell) in told[0].iter().zip(row).skip(1) {
            let column = of[0].iter().position(|head| head == name).expect("the page has the column");
            let known = known[column].split(" · ").take(2).collect::<Vec<_>>().join(" · ");
            assert_eq!(cell, known.trim_matches(['*', ' ']), "{name} of {id}");
        }
    }
    for (column, digits) in [("f32-cheap", [2, 1]), ("f32-stable", [2, 1])] {
        let column = formulas[0].iter().position(|head| head == column).expect("the page has the column");
        let ratio = |row: &Vec<String>| Some((row[column].split(" · ").next()?.parse::<f64>().ok()?, row[0].clone()));
        let ratios: Vec<(f64, String)> = formulas[2..].iter().filter_map(ratio).collect();
        let least = ratios.iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("there are some");
        let most = ratios.iter().max_by(|a, b| a.0.total_cmp(&b.0)).expect("there are some");
        for ((ratio, id), digits) in [least, most].into_iter().zip(digits) {
            let told = format!("{ratio:.digits$}");
            let line = chapter.lines().find(|line| line.contains(&format!("`{id}`"))).unwrap_or_default();
            assert!(line.contains(&format!(" {told} ")), "docs/book/cost.md does not have {told} of {id}");
        }
    }
}

/// Pages of measurements are made from runs of some time. Each formula, state and sweep that there is today has its place there.
#[test]
fn the_pages_of_measurements_have_all_that_is_measured() {
    let bench = docs("bench.md");
    let (_, every) = bench.split_once("### Every formula").expect("the page has a section of every formula");
    // All blend states share one function, which selectors tell what to compute. The page has it once, as `blend/state`.
    let is_measured = |spec: &Spec| matches!(spec.kind, Kind::Arithmetic) && spec.selectors.is_empty();
    for member in catalogue().iter().filter(|member| is_measured(&member.spec)) {
        let id = &member.spec.id;
        assert!(every.contains(&format!("\n| `{id}` |")), "docs/bench.md does not have {id}");
    }
    let blend = docs("blend.md");
    for equation in Equation::ALL {
        assert!(
            blend.contains(&format!("\n### {}\n", equation.name())),
            "docs/blend.md does not have {}",
            equation.name()
        );
    }
    for (_, table) in blend.split("\n### ").filter_map(|section| section.split_once("| src ↓ dst → |")) {
        let (head, rows) = table.split_once('\n').expect("a table has rows");
        for factor in Factor::ALL {
            let name = factor.name();
            assert!(head.contains(&format!(" {name} |")), "docs/blend.md has no column of {name}");
            assert!(rows.contains(&format!("\n| {name} |")), "docs/blend.md has no row of {name}");
        }
    }
    let sweep = docs("sweep.md");
    for preset in PRESETS {
        let headed = format!("\n## {} on lavapipe, ", preset.formula);
        let (_, section) = sweep.split_once(&headed).unwrap_or_else(|| panic!("no {headed:?} in docs/sweep.md"));
        let section = section.split("\n## ").next().unwrap_or_default();
        assert!(section.contains(preset.what), "docs/sweep.md does not say of {}: {}", preset.formula, preset.what);
    }
}

/// Pages of the documentation are made from runs of some time. What they say of the suite itself must be so today.
#[test]
fn the_pages_of_the_documentation_are_current() {
    let scenes = docs("scenes.md");
    for (name, _) in SCENES {
        let shows = load::builtin(name).expect("it is built in").shows;
        let plain: String = scenes.lines().find(|line| line.starts_with(&format!("| {name} |"))).expect(name).into();
        let words = shows.split("ruling").next().unwrap_or_default().trim_end_matches(['(', ' ']);
        assert!(plain.contains(words), "docs/scenes.md does not say what scene/{name} shows: {words}");
    }
    let stability = docs("stability.md");
    let claims = catalogue().into_iter().filter(|member| member.spec.stable.is_some());
    for member in claims {
        let id = &member.spec.id;
        assert!(stability.contains(&format!("### {id}")), "docs/stability.md has no section for {id}");
        for hard in member.spec.hard.iter().filter(|hard| hard.naive.is_some()) {
            assert!(stability.contains(hard.name), "docs/stability.md does not have {id}/hard/{}", hard.name);
        }
    }
    let selftest = docs("selftest.md");
    for fault in faults() {
        assert!(selftest.contains(fault.name), "docs/selftest.md does not have {}", fault.name);
    }
    let special = docs("special-values.md");
    for probe in PROBES {
        let what = probe.what.replace('|', "\\|");
        assert!(special.contains(&what), "docs/special-values.md does not have {} of {}", probe.what, probe.id());
    }
}
