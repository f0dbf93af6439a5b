//! The independent set of bugs still fits the files that it edits.

use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn every_bug_is_an_edit_of_one_place() {
    let mut ids = BTreeSet::new();
    for (file, count) in [("bugs.toml", 150), ("second.toml", 50)] {
        edits_of_one_place(file, count, &mut ids);
    }
}

fn edits_of_one_place(file: &str, count: usize, ids: &mut BTreeSet<String>) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("bugs").join(file)).expect("the bugs can be read");
    let table: toml::Table = text.parse().expect("the bugs are TOML");
    let bugs = table["bug"].as_array().expect("an array of bugs");
    for bug in bugs {
        let field = |name: &str| bug[name].as_str().unwrap_or_else(|| panic!("{bug:?}: no {name}"));
        let folder = match field("side") {
            "wgsl" => "../gpu/src/shaders",
            "numpy" => "../conformance/renderers/numpy",
            side => panic!("{}: side {side}", field("id")),
        };
        let path = root.join(folder).join(field("file"));
        let edited = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert_eq!(edited.matches(field("find")).count(), 1, "{}", field("id"));
        assert!(field("find") != field("replace") && ids.insert(field("id").to_owned()), "{}", field("id"));
    }
    assert_eq!(bugs.len(), count, "{file}");
}
