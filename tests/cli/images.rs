//! Images on the command line: scenes judged, shown and drawn, and what is refused.

use crate::{code, edited, folder, json, lightmeter, stderr, stdout};
use std::path::Path;

fn path(dir: &Path, name: &str) -> String {
    dir.join(name).to_str().expect("UTF-8").to_owned()
}

#[test]
fn a_scene_is_judged_by_both_kinds_of_shader() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let report = json(&["run", "scene/viewer", "--size", "64", "--format", "json"]);
    let groups = report["groups"].as_array().expect("there are groups");
    let stages: Vec<&str> = groups.iter().filter_map(|group| group["stage"].as_str()).collect();
    assert_eq!(stages, ["image", "image-full"]);
    for group in groups {
        assert_eq!((&group["cases"], &group["verdicts"], &group["failed"]), (&4096.into(), &16384.into(), &0.into()));
        assert_eq!((&group["image"]["width"], &group["image"]["height"]), (&64.into(), &64.into()));
        assert!(group["image"]["marked"].as_u64().is_some_and(|marked| marked < 100), "{group}");
    }
    assert!(groups[1]["image"]["differs_from_composed"].is_u64());
}

#[test]
fn shards_of_scenes_make_the_whole() {
    let ids = |shard: &str| -> Vec<String> {
        let listed = json(&["list", "scene/*", "--shard", shard, "--format", "json"]);
        let cases = listed["cases"].as_array().expect("there are cases");
        cases.iter().filter_map(|case| Some(case["scene"].as_str()?.to_owned())).collect()
    };
    let (whole, mut parts) = (ids("1/1"), [ids("1/3"), ids("2/3"), ids("3/3")].concat());
    parts.sort();
    assert_eq!(parts, whole);
    assert!(whole.len() > 20 && whole.contains(&"scene/teapot".to_owned()));
}

#[test]
fn one_pixel_is_judged_and_shown_by_its_name() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let report = json(&["run", "scene/teapot/24-30", "--size", "64", "--format", "json"]);
    assert_eq!((&report["totals"]["cases"], &report["totals"]["failed"]), (&2.into(), &0.into()));
    let shown = json(&["show", "scene/teapot/24-30", "--size", "64", "--format", "json"]);
    let stages = shown["stages"].as_array().expect("there are stages");
    let names: Vec<&str> = stages.iter().filter_map(|row| row["stage"].as_str()).collect();
    assert_eq!(names, ["position", "depth", "normal", "diffuse", "specular", "surface", "fog", "color"]);
    let color = &stages[7]["seen"][0];
    for k in 0..4 {
        let of = |what: &str| color[what][k].as_f64().expect("a number");
        assert!(of("low") <= of("value") && of("value") <= of("high"), "{color}");
    }
    let text = stdout(&lightmeter(&["show", "scene/teapot/24-30", "--size", "64"]));
    assert!(text.contains("✓ gives") && !text.contains('✗'), "{text}");
}

/// Truncation in place of `floor` shows at negative coordinates alone. Mesa's OpenGL cannot draw intermediate results of a wrong image, which
/// must not keep it from being told.
#[test]
#[ignore = "long: ./x campaign long"]
fn a_texture_that_is_truncated_fails_on_every_adapter() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("truncated", "texture.wgsl", |text| {
        let right = "vec2i(floor(uv * vec2f(textureDimensions(image))))";
        assert!(text.contains(right));
        text.replace(right, "vec2i(uv * vec2f(textureDimensions(image)))")
    });
    let (shaders, images) = (dir.to_str().expect("UTF-8"), path(&folder("truncated-images"), ""));
    let listed = json(&["adapters", "--format", "json"]);
    let adapters = listed["adapters"].as_array().expect("adapters").iter().filter(|one| one["backend"] != "embedded");
    let names: Vec<&str> = adapters.map(|one| one["name"].as_str().expect("a name")).collect();
    assert!(!names.is_empty(), "{listed}");
    for adapter in names {
        let args = ["run", "scene/texture-edges", "--size", "64", "--adapter", adapter];
        let right = lightmeter(&args);
        assert_eq!(code(&right), 0, "{adapter}: {}{}", stdout(&right), stderr(&right));
        let wrong = crate::command(&args)
            .args(["--shaders", shaders, "--images", &images])
            .output()
            .expect("the binary starts");
        assert_eq!(code(&wrong), 1, "{adapter}: {}{}", stdout(&wrong), stderr(&wrong));
        assert!(stdout(&wrong).contains("FAIL scene/texture-edges/"), "{adapter}: {}", stdout(&wrong));
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn all_pixels_together_tell_what_none_shows_alone() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let lit = "return sum.diffuse + sum.specular;";
    let images = path(&folder("bias-images"), "");
    let run = |name: &str, factor: f64, scene: &str| {
        let by = format!("return {factor:?} * (sum.diffuse + sum.specular);");
        let shaders = edited(name, "scene_lighting.wgsl", |text| text.replace(lit, &by));
        let shaders = shaders.to_str().expect("UTF-8").to_owned();
        let args = ["run", scene, "--size", "256", "--shaders", &shaders, "--images", &images, "--format", "json"];
        let report = json(&args);
        report["groups"][0].clone()
    };
    // Every pixel of an image of 8 bits is legal, and the image is not.
    let flat = run("bias-flat", 1.002, "scene/flat");
    let bias = &flat["image"]["bias"];
    assert_eq!((&flat["failed"], &flat["failed_groups"]), (&0.into(), &1.into()), "{flat}");
    assert!(flat["problems"][0]["says"].as_str().is_some_and(|said| said.contains("to one side")), "{flat}");
    assert!(bias["factor"].as_f64().is_some_and(|factor| (factor - 1.002).abs() < 0.0005), "{bias}");
    // What the accuracy rules leave to a highlight of a high power explains as much: it is told, and fails nothing.
    let legal = run("bias-legal", 1.003, "scene/missed-highlight");
    assert!(legal["image"]["bias"]["factor"].is_f64() && legal.get("problem").is_none(), "{legal}");
    // On floats the pixels themselves are wrong.
    let floats = run("bias-floats", 1.0005, "scene/combined-exp");
    assert!(floats["failed"].as_u64().is_some_and(|failed| failed > 1000), "{floats}");
    let right = run("bias-none", 1.0, "scene/flat");
    assert!(right["image"].get("bias").is_none() && right["failed_groups"] == 0, "{right}");
}

/// A fragment that is left out has no position either: what is at fault is the cutout, or the alpha that it goes by.
#[test]
#[ignore = "long: ./x campaign long"]
fn what_a_cutout_leaves_out_is_no_wrong_position() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for (file, right, wrong, stage, mistake) in [
        ("effects/cutout.wgsl", "color.a < scene", "color.a <= scene", "cutout", "cutout-at-the-threshold"),
        ("texture.wgsl", "vec2i(floor(uv * ", "vec2i((uv * ", "surface", "texel-truncated"),
    ] {
        let shaders = edited(mistake, file, |text| {
            assert!(text.contains(right), "{file}");
            text.replace(right, wrong)
        });
        let report = json(&[
            "run",
            "scene/texture-edges",
            "--size",
            "256",
            "--shaders",
            shaders.to_str().expect("UTF-8"),
            "--format",
            "json",
        ]);
        let group = &report["groups"][0];
        assert_eq!(group["image"]["departs_in"]["stage"], stage, "{group}");
        assert!(group.to_string().contains(mistake), "{group}");
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_wrong_image_names_its_stage_and_leaves_pictures() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = edited("images", "vector.wgsl", |text| {
        let right = "return i - 2.0 * dot(i, n) * n;";
        assert!(text.contains(right));
        text.replace(right, "return i + 2.0 * dot(i, n) * n;")
    });
    let out = folder("images-of-failures");
    let (shaders, images) = (dir.to_str().expect("UTF-8"), out.to_str().expect("UTF-8"));
    let output = lightmeter(&["run", "scene/phong", "--size", "96", "--shaders", shaders, "--images", images]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let text = stdout(&output);
    assert!(text.contains("first departs in: specular"), "{text}");
    assert!(text.contains("  worst pixel\n    lightmeter show 'scene/phong/"), "{text}");
    for what in ["reference", "result", "error"] {
        let end = format!("-image-{what}.png");
        let files = std::fs::read_dir(&out).expect("the folder is there").flatten();
        let of_scene = files.filter(|file| file.file_name().to_string_lossy().ends_with(&end));
        let sizes: Vec<u64> = of_scene.map(|file| file.metadata().expect("it is there").len()).collect();
        assert!(matches!(sizes[..], [size] if size > 500), "{what}: {sizes:?}");
    }
    let junit = lightmeter(&[
        "run",
        "scene/phong",
        "--size",
        "32",
        "--shaders",
        shaders,
        "--images",
        images,
        "--format",
        "junit",
    ]);
    assert!(code(&junit) == 1 && stdout(&junit).contains("scene/phong"), "{}", stdout(&junit));
}

#[test]
fn images_are_drawn_to_png_and_exr() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = folder("render");
    for (name, start) in [("a.png", &b"\x89PNG"[..]), ("a.exr", b"\x76\x2f\x31\x01")] {
        for with in ["reference", "gpu"] {
            let file = path(&dir, &format!("{with}-{name}"));
            let output = lightmeter(&["render", "fixed-color", "--with", with, "--out", &file]);
            assert_eq!(code(&output), 0, "{}", stderr(&output));
            assert!(std::fs::read(&file).expect("it was written").starts_with(start), "{file}");
        }
    }
    let read = |with: &str| std::fs::read(path(&dir, &format!("{with}-a.exr"))).expect("it was written");
    assert_eq!(read("reference"), read("gpu"), "whole steps are stored exactly");
    let left = std::fs::read_dir(&dir).expect("the folder is there").count();
    assert_eq!(left, 4, "nothing else is left there");
}

/// Arguments, and what standard error says.
const REFUSED: &[(&[&str], &str)] = &[
    (&["render", "teapot", "--out", "a.jpg"], "written as .png or .exr"),
    (&["render", "teapots", "--out", "a.png"], "teapot"),
    (&["render", "teapot", "--out", "no/such/folder/a.png"], "cannot write"),
    (&["render", "teapot", "--adapter", "lavapipe", "--out", "a.png"], "--with gpu"),
    (&["render", "teapot", "--with", "gpu", "--adapter", "none", "--out", "a.png"], "no adapter `none`"),
    (&["render", "teapot", "--with", "gpu", "--full", "--stage", "fog", "--out", "a.png"], "leave out"),
    (&["render", "teapot", "--stage", "colour", "--out", "a.png"], "expected one of position, depth"),
    (&["run", "scene/*", "--size", "0"], "0 is not in 1..=8192"),
    (&["show", "scene/teapot/512-0"], "512 × 512"),
    (&["show", "scene/teapot/1"], "scene/teapot/X-Y"),
    (&["page", "scenes", "Cargo.toml"], "makes no page"),
];

#[test]
fn what_cannot_be_drawn_is_refused() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for (args, says) in REFUSED {
        let output = lightmeter(args);
        assert_eq!(code(&output), 2, "{args:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{args:?}: {}", stderr(&output));
    }
    // A pixel that the size in force does not have is a filter that selects nothing.
    for args in [&["run", "scene/teapots"][..], &["run", "scene/viewer/3-3", "scene/teapot/300-300", "--size", "16"]] {
        let nothing = lightmeter(args);
        assert_eq!(code(&nothing), 2, "{args:?}: {}", stderr(&nothing));
        assert!(
            stderr(&nothing).contains("no case matches `scene/teapot")
                && stderr(&nothing).contains(", special, scene, deviation)")
        );
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn a_run_makes_the_page_and_its_contact_sheet() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let dir = folder("scenes-page");
    let (run, page) = (path(&dir, "run.json"), path(&dir, "scenes.md"));
    let output =
        lightmeter(&["run", "scene/fixed-color", "--size", "32", "--timing", "--format", "json", "--out", &run]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(code(&lightmeter(&["page", "scenes", &run, "--out", &page])), 0);
    let text = std::fs::read_to_string(&page).expect("the page was written");
    assert!(text.contains("(scenes.png)") && text.contains("| fixed-color | 0 failed, "), "{text}");
    assert!(text.contains("| teapot | skipped |") && text.contains(" ms: "), "{text}");
    let sheet = std::fs::metadata(dir.join("scenes.png")).expect("the sheet was written").len();
    assert!(sheet > 50_000, "{sheet} bytes");
}

#[test]
#[ignore = "long: ./x campaign long"]
fn edited_lines_that_no_picture_shows_are_told() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    let said = |name: &str, before: &str, after: &str| {
        let dir = edited(name, "scene.wgsl", |text| {
            assert!(text.contains(before), "{before}");
            text.replace(before, after)
        });
        let args = ["run", "scene/fog-exp", "--size", "16", "--shaders", dir.to_str().expect("UTF-8")];
        let output = lightmeter(&args);
        assert_eq!(code(&output), 0, "{name}");
        stderr(&output)
    };
    let factor = "out.fog_factor = scene_fog_factor";
    for (name, before, after, place) in [
        (
            "beside-changed",
            factor,
            "out.fog_factor = 0.5 * scene_fog_factor",
            "scene.wgsl:107 is edited and not judged",
        ),
        // What stands elsewhere in the file, too.
        ("beside-same", "out.viewer = vector_normalize(-eye.xyz);", "out.viewer = -eye.xyz;", "scene.wgsl:113 is"),
        ("beside-gone", "out.viewer = vector_normalize(-eye.xyz);\n", "", "scene.wgsl is edited and not judged"),
        ("beside-condition", "local_viewer & !unit_vectors", "local_viewer & unit_vectors", "is edited and not judged"),
    ] {
        let said = said(name, before, after);
        assert!(said.contains(place), "{name}: {said}");
    }
    let said = said("beside-nothing", "let eye = ", "let eye = 1.0 * ");
    assert!(!said.contains("not judged"), "{said}");
}

/// llvmpipe decides what is covered by moved vertices and interpolates among the given ones, so that these pixels have more or less alpha
/// than any vertex.
#[test]
fn attributes_may_lie_beyond_those_of_the_vertices() {
    if crate::needs::lacks_lavapipe() {
        return;
    }
    for (scene, size) in [("scene/combined-exp2-opengl", "128"), ("scene/combined-exp", "64")] {
        let output = lightmeter(&["run", scene, "--size", size]);
        assert_eq!(code(&output), 0, "{}", stdout(&output));
    }
}
