//! The house's rules that can be checked: crates and files import each other one way, no two public types share a name, a formula
//! family has its four files, every shader function of the catalogue is there with the right signature, and no formula lacks hard data.
//! None of this needs a GPU.

mod bugs;
mod imports;
mod time;

use imports::{Imports, imports, public_types};
use lightmeter::cases::{FAMILIES, Kind};
use lightmeter::select::{CaseRef, catalogue};
use lightmeter_gpu::{FILES, Kernel, Shaders};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

#[test]
fn every_family_has_its_four_files() {
    for family in FAMILIES {
        for file in [
            format!("reference/src/{family}.rs"),
            format!("gpu/src/shaders/{family}.wgsl"),
            format!("conformance/catalogue/src/cases/{family}.rs"),
            format!("tests/properties/{family}.rs"),
        ] {
            assert!(root().join(&file).is_file(), "family `{family}` lacks {file}");
        }
    }
}

/// The packages of the workspace as cargo has them.
fn packages() -> Vec<Value> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version", "1", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo writes JSON");
    metadata["packages"].as_array().expect("packages").clone()
}

/// The crates and what each depends upon: of the workspace alone; with what its tests need, or without.
fn dependencies(with_tests: bool) -> BTreeMap<String, BTreeSet<String>> {
    let folder = |package: &Value| {
        let manifest = Path::new(package["manifest_path"].as_str().expect("a path"));
        let folder = manifest.parent().expect("a folder").strip_prefix(root()).expect("a folder of the workspace");
        folder.to_str().expect("UTF-8").to_owned()
    };
    let packages = packages();
    let of_name: BTreeMap<&str, String> =
        packages.iter().map(|package| (package["name"].as_str().expect("a name"), folder(package))).collect();
    let needs = |package: &Value| {
        let all = package["dependencies"].as_array().expect("dependencies").iter();
        let crates =
            all.filter(|one| with_tests || one["kind"] != "dev").filter_map(|one| of_name.get(one["name"].as_str()?));
        crates.cloned().collect()
    };
    packages.iter().map(|package| (folder(package), needs(package))).collect()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace's root")
}

/// A crate's name in the table of ARCHITECTURE.
fn short(package: &str) -> &str {
    package.strip_prefix("conformance/").or(package.strip_prefix("reference/")).unwrap_or(package)
}

/// Every crate that a path of dependencies leads to.
fn reached<'a>(crates: &'a BTreeMap<String, BTreeSet<String>>, from: &'a str) -> BTreeSet<&'a str> {
    let (mut found, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(package) = open.pop() {
        open.extend(crates[package].iter().map(String::as_str).filter(|next| found.insert(*next)));
    }
    found
}

#[test]
fn crates_depend_one_way_as_the_architecture_says() {
    let crates = dependencies(false);
    let text = std::fs::read_to_string(root().join("ARCHITECTURE.md")).expect("it is there");
    let (_, text) = text.split_once("## The crates").expect("the section is there");
    let (text, _) = text.split_once("\n## ").expect("another section follows");
    let mut told = BTreeMap::new();
    for line in text.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let needs = cells[2].split(", ").filter(|name| !name.is_empty());
        told.insert(cells[0].trim_matches('`').to_owned(), needs.map(str::to_owned).collect::<BTreeSet<String>>());
    }
    assert_eq!(told.keys().collect::<Vec<_>>(), crates.keys().collect::<Vec<_>>(), "ARCHITECTURE names every crate");
    for (package, needs) in &crates {
        let needs: BTreeSet<String> = needs.iter().map(|package| short(package).to_owned()).collect();
        if !told[package].contains("all of them") {
            assert_eq!(needs, told[package], "what {package} depends upon, and what ARCHITECTURE says");
        }
        assert!(!reached(&crates, package).contains(package.as_str()), "{package} depends upon itself");
    }
    let crates = dependencies(true);
    for package in ["engine", "faults", "gate", "harness", "report", "judge", "catalogue"] {
        let package = format!("conformance/{package}");
        assert!(!reached(&crates, &package).contains("gpu"), "{package} reaches the GPU");
    }
    assert!(!reached(&crates, "gpu").contains("reference") && !reached(&crates, "reference").contains("gpu"));
}

/// The most crates from elsewhere that the library builds without its features.
const MOST_CRATES: usize = 62;

/// Who judges the answers of an engine of theirs needs neither a GPU nor a command line.
#[test]
fn the_library_without_features_is_light() {
    let tree = |features: &[&str]| -> BTreeSet<String> {
        let output = Command::new(env!("CARGO"))
            .args(["tree", "--offline", "--package", "lightmeter", "--edges", "normal", "--prefix", "none"])
            .args(features)
            .current_dir(root())
            .output()
            .expect("cargo starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8(output.stdout).expect("cargo writes UTF-8");
        let names = text.lines().filter_map(|line| line.split(' ').next());
        names.filter(|name| !name.starts_with("lightmeter")).map(str::to_owned).collect()
    };
    let light = tree(&["--no-default-features"]);
    for heavy in ["wgpu", "naga", "clap", "indicatif", "image", "maud", "plotters", "npyz"] {
        assert!(!light.contains(heavy), "the library without features builds {heavy}");
    }
    assert!(light.len() <= MOST_CRATES, "{} crates: {light:?}", light.len());
    let whole = tree(&[]);
    assert!(whole.contains("wgpu") && whole.contains("clap") && whole.len() > 2 * light.len());
}

/// Files, each with those that it imports from.
type FileGraph = BTreeMap<String, BTreeSet<String>>;

/// The largest sets of files of which each leads to every other.
fn strong_components(graph: &FileGraph) -> BTreeSet<BTreeSet<String>> {
    let reached: BTreeMap<&str, BTreeSet<&str>> = graph.keys().map(|file| (&file[..], reached(graph, file))).collect();
    let component = |file: &str| -> BTreeSet<String> {
        let mutual = reached[file].iter().filter(|other| reached[**other].contains(file));
        mutual.map(|other| (*other).to_owned()).collect()
    };
    graph.keys().map(|file| component(file)).filter(|component| !component.is_empty()).collect()
}

/// The part of a graph that lies between some of its files.
fn between(graph: &FileGraph, files: &BTreeSet<String>) -> FileGraph {
    let kept = graph.iter().filter(|(file, _)| files.contains(*file));
    kept.map(|(file, to)| (file.clone(), to & files)).collect()
}

/// The imports that make circles between files, a line each.
///
/// A circle is legal where one of its files is the module that all others descend from. So that module is taken out of its strong
/// component, and what remains is searched again: a circle that is left there runs without it. A component without such a module
/// contains an illegal circle.
fn circles(imports: &Imports) -> Vec<String> {
    let mut graph = FileGraph::new();
    for (from, to) in imports.keys() {
        graph.entry(to.clone()).or_default();
        graph.entry(from.clone()).or_default().insert(to.clone());
    }
    let (mut wrong, mut open) = (vec![], vec![graph]);
    while let Some(graph) = open.pop() {
        for mut component in strong_components(&graph) {
            let is_top = |top: &&String| {
                let descendants = format!("{top}::");
                component.iter().all(|file| file == *top || file.starts_with(&descendants))
            };
            if let Some(top) = component.iter().find(is_top).cloned() {
                component.remove(&top);
                open.push(between(&graph, &component));
                continue;
            }
            let inside = imports.iter().filter(|((from, to), _)| component.contains(from) && component.contains(to));
            wrong.extend(inside.map(|((from, to), names)| {
                let names = names.iter().map(String::as_str).collect::<Vec<_>>().join(", ");
                format!("{from} -> {to}: {names}")
            }));
        }
    }
    wrong
}

#[test]
fn circles_that_leave_a_family_of_modules_are_found() {
    // What the row pins, the imports, and the number of them that make a circle.
    type Edges<'a> = &'a [(&'a str, &'a str)];
    let rows: [(&str, Edges<'_>, usize); 9] = [
        ("imports one way", &[("crate::a", "crate::b"), ("crate::b", "crate::c"), ("crate::a", "crate::c")], 0),
        ("two files", &[("crate::a", "crate::b"), ("crate::b", "crate::a"), ("crate::b", "crate::c")], 2),
        ("a module and its child", &[("crate::a", "crate::a::b"), ("crate::a::b", "crate::a")], 0),
        (
            "a circle through a module and its child",
            &[("crate::a", "crate::a::b"), ("crate::a::b", "crate::c"), ("crate::c", "crate::a")],
            3,
        ),
        (
            "a circle of descendants that passes through their module",
            &[("crate::a", "crate::a::b"), ("crate::a::b", "crate::a::c"), ("crate::a::c", "crate::a")],
            0,
        ),
        (
            "a circle of children beside legal ones",
            &[
                ("crate::a", "crate::a::b"),
                ("crate::a::b", "crate::a"),
                ("crate::a::b", "crate::a::c"),
                ("crate::a::c", "crate::a::b"),
            ],
            2,
        ),
        (
            "the root is above all files, and hides no circle below it",
            &[
                ("crate", "crate::a"),
                ("crate::a", "crate::a::b"),
                ("crate::a::b", "crate::c"),
                ("crate::c", "crate::a"),
                ("crate::c", "crate"),
            ],
            3,
        ),
        ("a path that begins alike is no descendant", &[("crate::a", "crate::ab"), ("crate::ab", "crate::a")], 2),
        ("nothing", &[], 0),
    ];
    for (what, edges, count) in rows {
        let import =
            |(from, to): &(&str, &str)| (((*from).to_owned(), (*to).to_owned()), BTreeSet::from(["name".to_owned()]));
        let found = circles(&edges.iter().map(import).collect());
        assert_eq!(found.len(), count, "{what}: {found:?}");
    }
}

/// A file's path from the root of the workspace.
fn name_of(file: &Path) -> String {
    let file = file.canonicalize().expect("a source file");
    file.strip_prefix(root()).expect("a file of the workspace").to_str().expect("UTF-8").to_owned()
}

/// A module and its descendants may import each other; other files import one way.
#[test]
fn files_import_each_other_one_way() {
    let mut wrong = vec![];
    for package in packages() {
        let targets = package["targets"].as_array().expect("targets");
        for target in targets.iter().map(|target| Path::new(target["src_path"].as_str().expect("a path"))) {
            wrong.extend(circles(&imports(target)).iter().map(|line| format!("{}: {line}", name_of(target))));
        }
    }
    assert!(wrong.is_empty(), "files import each other in a circle:\n{}", wrong.join("\n"));
}

/// Names that public types share because they mean one thing in several representations, each in one of [`REPRESENTATIONS`].
const SHARED_NAMES: [&str; 8] = ["Blend", "DepthTest", "Fog", "Light", "Material", "Mesh", "Shading", "Target"];

/// A scene as it is written, a frame with everything resolved (a depth test also stands in rows of `depth`), and the operands of a
/// formula.
const REPRESENTATIONS: [&str; 4] = [
    "reference/scene/src/model/",
    "reference/scene/src/frame.rs",
    "reference/scene/src/depth.rs",
    "reference/src/lighting.rs",
];

/// The names that more than one public type bears, each with the places of its types.
fn shared_names(types: impl IntoIterator<Item = (String, PathBuf)>) -> BTreeMap<String, Vec<PathBuf>> {
    let mut places: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for (name, file) in types {
        places.entry(name).or_default().push(file);
    }
    places.retain(|_, files| files.len() > 1);
    places
}

/// The root files of the workspace's libraries.
fn libraries() -> Vec<PathBuf> {
    let mut roots = vec![];
    for package in packages() {
        let targets = package["targets"].as_array().expect("targets").iter();
        let libraries = targets.filter(|target| target["kind"][0] == "lib");
        roots.extend(libraries.map(|target| PathBuf::from(target["src_path"].as_str().expect("a path"))));
    }
    assert!(roots.len() > 10, "libraries of the workspace: {roots:?}");
    roots
}

/// Ways to go wrong are added: who matches on an error of the libraries must be ready for another one.
#[test]
fn errors_may_grow() {
    let is_enum = |text: &str, name: &str| text.contains(&format!("pub enum {name} {{"));
    let may_grow = |text: &str, name: &str| text.contains(&format!("#[non_exhaustive]\npub enum {name} {{"));
    let (mut enums, mut wrong) = (0, vec![]);
    for (name, file) in libraries().iter().flat_map(|root| public_types(root)) {
        let text = std::fs::read_to_string(&file).expect("a source file");
        if name.ends_with("Error") && is_enum(&text, &name) {
            enums += 1;
            if !may_grow(&text, &name) {
                wrong.push(format!("{name} in {}", name_of(&file)));
            }
        }
    }
    assert!(enums > 10, "{enums} errors");
    assert!(wrong.is_empty(), "these errors lack #[non_exhaustive] above `pub enum`:\n{}", wrong.join("\n"));
}

#[test]
fn no_two_public_types_have_one_name() {
    let roots = libraries();
    let mut wrong = vec![];
    let mut unused = BTreeSet::from(SHARED_NAMES);
    for (name, files) in shared_names(roots.iter().flat_map(|root| public_types(root))) {
        let files: Vec<String> = files.iter().map(|file| name_of(file)).collect();
        let is_representation = |file: &String| REPRESENTATIONS.iter().any(|place| file.starts_with(place));
        if !unused.remove(&name[..]) || !files.iter().all(is_representation) {
            wrong.push(format!("{name}: {}", files.join(", ")));
        }
    }
    assert!(wrong.is_empty(), "these names belong to more than one public type:\n{}", wrong.join("\n"));
    assert!(unused.is_empty(), "SHARED_NAMES lists {unused:?}, which no two public types share");
}

#[test]
fn a_name_that_two_types_bear_is_found() {
    let types = [("A", "a.rs"), ("B", "b.rs"), ("A", "c.rs")].map(|(name, file)| (name.to_owned(), file.into()));
    assert_eq!(shared_names(types), BTreeMap::from([("A".to_owned(), vec!["a.rs".into(), "c.rs".into()])]));
}

/// Every Rust file below a folder of the workspace, with its text.
fn sources(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() && !path.ends_with("target") {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.strip_prefix(root()).expect("of the workspace").to_str().expect("UTF-8").to_owned();
            found.push((name, std::fs::read_to_string(&path).expect("a source file")));
        }
    }
}

/// Lines outside of tests in which a text stands, by file.
fn files_with(text: &str) -> Vec<String> {
    let mut all = vec![];
    sources(&root().join("conformance"), &mut all);
    let has = |source: &str| source.split("#[cfg(test)]\nmod tests {").next().is_some_and(|code| code.contains(text));
    let is_test = |name: &str| name.contains("/src/tests/") || name.ends_with("/src/tests.rs");
    let is_meant = |(name, source): &(String, String)| name.contains("/src/") && !is_test(name) && has(source);
    let mut files: Vec<String> = all.into_iter().filter(is_meant).map(|(name, _)| name).collect();
    files.sort();
    files
}

/// The functions that take a profile and evaluate: nobody else enters its scope, so that it cannot be forgotten.
#[test]
fn a_profile_comes_into_force_where_formulas_are_evaluated_alone() {
    let files = [
        "conformance/catalogue/src/cases/formula.rs",
        "conformance/faults/src/factor.rs",
        "conformance/faults/src/selftest.rs",
        "conformance/faults/src/variation.rs",
        "conformance/judge/src/blend_unit/expect.rs",
        "conformance/judge/src/blend_unit/tally.rs",
        "conformance/judge/src/devices.rs",
        "conformance/judge/src/image/expect.rs",
        "conformance/judge/src/image/prepared.rs",
    ];
    assert_eq!(files_with(".scope("), files);
}

/// Formulas are instantiated in every arithmetic where they are evaluated by their type: in the catalogue alone.
#[test]
fn formulas_are_instantiated_in_one_room() {
    assert_eq!(files_with(".evaluate(&Reader::new("), ["conformance/catalogue/src/cases/formula.rs"]);
    // Besides, there is one of whose outputs some are free.
    let implemented = ["conformance/catalogue/src/cases/formula.rs", "conformance/catalogue/src/cases/partial.rs"];
    assert_eq!(files_with("AnyFormula for"), implemented);
}

#[test]
fn every_family_of_the_catalogue_is_listed_and_has_hard_cases() {
    let catalogue = catalogue();
    let families: BTreeSet<&str> = catalogue.iter().map(|member| member.spec.family()).collect();
    assert_eq!(families, FAMILIES.into_iter().collect());
    for family in FAMILIES {
        assert!(
            catalogue.iter().any(|m| m.spec.family() == family && !m.spec.hard.is_empty()),
            "{family} has no hard case"
        );
    }
}

#[test]
fn every_shader_is_valid_without_a_gpu() {
    let shaders = Shaders::built_in().expect("the built-in shaders are valid");
    for (file, _) in FILES {
        shaders.parse(file).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn every_formula_has_its_shader_function_with_its_signature() {
    let shaders = Shaders::built_in().expect("the built-in shaders are valid");
    for member in catalogue() {
        let spec = &member.spec;
        match spec.kind {
            Kind::Raster(raster) => {
                assert_eq!((raster.inputs(), raster.outputs()), (spec.input_len(), spec.output_len()), "{}", spec.id);
            }
            // The blend unit alone: no shader function.
            Kind::Blend(_) if spec.row_stages().is_empty() => assert_eq!(spec.function, "", "{}", spec.id),
            Kind::Arithmetic | Kind::Blend(_) | Kind::Depth(_) => {
                let kernel = Kernel::new(&shaders, &format!("{}.wgsl", spec.family()), spec.function);
                let kernel = kernel.unwrap_or_else(|error| panic!("{}: {error}", spec.id));
                assert_eq!(kernel.inputs, spec.selectors.len() + spec.input_len(), "{}", spec.id);
                assert_eq!(kernel.outputs, spec.output_len(), "{}", spec.id);
            }
        }
    }
}

#[test]
fn ids_are_unique_and_read_back() {
    let catalogue = catalogue();
    let mut seen = BTreeSet::new();
    for member in &catalogue {
        for case in [CaseRef::Random(0), CaseRef::Random(1_234_567)].into_iter().chain(member.fixed()) {
            let id = member.case_id(case);
            assert_eq!(member.case(&id), Some(case), "{id}");
            assert!(seen.insert(id.clone()), "{id} stands twice");
        }
    }
}

#[test]
fn hard_cases_name_inputs_of_their_formula() {
    for member in catalogue() {
        for hard in member.spec.hard {
            for (name, values) in hard.inputs {
                let place = member.spec.place(name);
                assert_eq!(
                    place.map(|place| place.len()),
                    Some(values.len()),
                    "{} {}: {name}",
                    member.spec.id,
                    hard.name
                );
            }
        }
    }
}

#[test]
fn what_a_formula_normalises_its_description_says() {
    for member in catalogue() {
        assert_eq!(member.spec.is_normalised, member.spec.text.contains('⟨'), "{}", member.spec.id);
    }
}

#[test]
fn inputs_follow_from_seed_id_and_number_alone() {
    for member in catalogue().iter().filter(|member| member.spec.family() != "blend") {
        let draw = |k, seed| {
            let mut row = vec![];
            member.inputs(CaseRef::Random(k), seed, &mut row);
            row.into_iter().map(f32::to_bits).collect::<Vec<_>>()
        };
        assert_eq!(draw(17, 1), draw(17, 1));
        assert_ne!((draw(17, 1), draw(18, 1)), (draw(17, 2), draw(18, 2)), "{}: the seed matters", member.spec.id);
        assert_ne!(draw(17, 1), draw(19, 1), "{}: the number matters", member.spec.id);
    }
}
