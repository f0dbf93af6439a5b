//! What the sources say of who calls wgpu.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Only `device` and `adapters` name wgpu, so that all else describes its work, and nothing but the executor and the clock
/// makes objects, encodes commands or submits them.
#[test]
fn nothing_but_the_executor_calls_wgpu() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut sources = vec![];
    collect(&root, &mut sources);
    let naming = |needle: &str| -> BTreeSet<String> {
        let names = sources.iter().filter(|(_, text)| text.contains(needle)).map(|(path, _)| path.clone());
        names.collect()
    };
    // Needles are written in two parts, or this file would hold them as well.
    let namers = naming(concat!("wgpu", "::"));
    let outside: Vec<_> = namers
        .iter()
        .filter(|path| *path != "adapters.rs" && *path != "device.rs" && !path.starts_with("device/"))
        .collect();
    assert!(outside.is_empty(), "{outside:?} name wgpu");
    for (needle, callers) in [
        (
            concat!(".device", ".create_"),
            &["device/clock.rs", "device/executor.rs", "device/objects.rs", "device/readback.rs"][..],
        ),
        (concat!(".queue", "."), &["device/clock.rs", "device/executor.rs", "device/objects.rs"]),
        (concat!(".begin_", "compute_pass("), &["device/encode.rs"]),
        (concat!(".begin_", "render_pass("), &["device/encode.rs"]),
    ] {
        assert_eq!(naming(needle).iter().map(String::as_str).collect::<Vec<_>>(), callers, "{needle}");
    }
}

/// The sources of a folder and of those in it, by their paths from `src` on.
fn collect(folder: &Path, sources: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("the folder can be read").path();
        if path.is_dir() {
            collect(&path, sources);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
            let name = path.strip_prefix(&root).expect("it lies there").to_string_lossy().replace('\\', "/");
            sources.push((name, fs::read_to_string(&path).expect("a source is text")));
        }
    }
}
