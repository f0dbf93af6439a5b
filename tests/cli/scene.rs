//! Scenes on the command line: the schema, the effects, and what is refused.

use crate::{code, folder, json, lightmeter, stderr, stdout};
use lightmeter::scene::{library::SCENES, load};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace's root").to_owned()
}

/// A scene that is right, of which each row of bad input changes one thing.
fn base() -> Value {
    json!({
        "title": "t", "shows": "s",
        "camera": { "eye": [0, 0, 5], "projection": { "perspective": { "fov_y_deg": 45, "near": 1, "far": 10 } } },
        "lights": [
            { "kind": "directional", "toward": [0, 1, 0] },
            { "kind": "spot", "position": [0, 3, 0], "axis": [0, -1, 0], "cutoff_deg": 30, "falloff": [1, 0, 0] },
        ],
        "fog": { "color": [1, 1, 1], "factor": { "exp": { "density": 0.1 } } },
        "textures": { "dots": { "checker": { "size": [2, 2], "colors": [[1, 1, 1, 1], [0, 0, 0, 1]] } } },
        "materials": { "red": { "color": [1, 0, 0], "texture": { "image": "dots" } } },
        "meshes": {
            "ball": { "shape": { "sphere": {} } },
            "bare": { "shape": { "triangles": {
                "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]
            } } },
        },
        "objects": [
            { "name": "a", "mesh": "ball", "material": "red", "transform": [{ "scale": [1, 1, 1] }], "cutout": 0.5 },
            { "mesh": "bare", "shading": { "frequency": "unlit" }, "blend": { "color": "alpha" } },
        ],
    })
}

/// What is put where in the base, as JSON; the field that is named; a part of what is said.
const REFUSED: &[(&str, &str, &str, &str)] = &[
    ("/lights/1/cutoff_deg", "91", "lights[1].cutoff_deg", "is 91; expected an angle above 0 and up to 90"),
    ("/lights/1/cutoff_deg", "0", "lights[1].cutoff_deg", "above 0"),
    ("/lights/1/cutoff_deg", "\"wide\"", "lights[1].cutoff_deg", "expected f64"),
    ("/lights/1/cutoff_deg", "1e39", "lights[1].cutoff_deg", "up to 90"),
    ("/lights/1/cutoff_deg", "null", "lights[1].cutoff_deg", "is missing"),
    ("/lights/1/axis", "[0, 0, 0]", "lights[1].axis", "not 0"),
    ("/lights/1/axis", "[0, 1e-60, 0]", "lights[1].axis", "not 0"),
    ("/lights/1/position", "[0, 1e39, 0]", "lights[1].position[1]", "range of f32"),
    ("/lights/1/position", "[0, 1]", "lights[1].position", "array"),
    ("/lights/1/falloff", "[0, 0, 0]", "lights[1].falloff", "not all 0"),
    ("/lights/1/falloff", "[1, -1, 0]", "lights[1].falloff[1]", "0 or above"),
    ("/lights/1/exponent", "-1", "lights[1].exponent", "0 or above"),
    ("/lights/1/attached", "\"moon\"", "lights[1].attached", "world, camera or the name of one object: a"),
    ("/lights/0/toward", "[0, 0, 0]", "lights[0].toward", "not 0"),
    ("/lights/0/toward", "null", "lights[0].toward", "is missing"),
    ("/lights/0/travel", "[0, 1, 0]", "lights[0].travel", "one of the two"),
    ("/lights/0/cutoff_deg", "30", "lights[0].cutoff_deg", "one of travel, toward, unit"),
    ("/lights/0/kind", "\"sun\"", "lights[0].kind", "unknown variant"),
    ("/lights/0/colour", "[1, 1, 1]", "lights[0].colour", "unknown field"),
    ("/target", r#"{ "width": 0 }"#, "target.width", "is 0; expected 1 to 8192"),
    ("/target", r#"{ "height": 8193 }"#, "target.height", "is 8193"),
    ("/target", r#"{ "format": "rgb565" }"#, "target.format", "unknown variant"),
    ("/background", "[0, 0, 0, 1e300]", "background[3]", "range of f32"),
    ("/camera/center", "[0, 0, 5]", "camera.center", "where the eye is"),
    ("/camera/up", "[0, 0, -2]", "camera.up", "parallel"),
    ("/camera/up", "[0, 0, 0]", "camera.up", "not 0"),
    ("/camera/eye", "[0, 0]", "camera.eye", "array"),
    ("/camera/projection/perspective/near", "0", "camera.projection.perspective.near", "above 0"),
    ("/camera/projection/perspective/near", "1e-60", "camera.projection.perspective.near", "above 0"),
    ("/camera/projection/perspective/far", "1", "camera.projection.perspective.far", "above `near`"),
    ("/camera/projection/perspective/fov_y_deg", "180", "camera.projection.perspective.fov_y_deg", "below 180"),
    (
        "/camera/projection",
        r#"{ "orthographic": { "height": -1, "near": 1, "far": 2 } }"#,
        "camera.projection.orthographic.height",
        "above 0",
    ),
    ("/fog/factor/exp/density", "-1", "fog.factor.exp.density", "0 or above"),
    ("/fog/factor", r#"{ "exp2": { "density": 1 } }"#, "fog.factor", "unknown variant"),
    ("/textures/dots/checker/size", "[2, 4096]", "textures.dots.checker.size", "1 to 2048"),
    ("/textures/dots", r#"{ "file": "missing.png" }"#, "textures.dots.file", "cannot be read"),
    ("/textures/dots", r#"{ "texels": [] }"#, "textures.dots.texels", "has 0 entries"),
    (
        "/textures/dots",
        r#"{ "texels": [[[0, 0, 0, 1], [0, 0, 0, 1]], [[0, 0, 0, 1]]] }"#,
        "textures.dots.texels[1]",
        "has 1 texels",
    ),
    ("/materials/red/shininess", "-1", "materials.red.shininess", "0 or above"),
    ("/materials/red/opacity", "1.5", "materials.red.opacity", "from 0 to 1"),
    ("/materials/red/texture/image", "\"dot\"", "materials.red.texture.image", "is `dot`; expected one of dots"),
    ("/materials/red", r#"{ "kd": 1, "diffuse": [1, 1, 1] }"#, "materials.red.diffuse", "one of the two"),
    (
        "/materials/red",
        r#"{ "specular": [1, 1, 1], "highlight": "metal" }"#,
        "materials.red.highlight",
        "one of the two",
    ),
    (
        "/materials/red",
        r#"{ "lightmap": { "image": "dots", "mode": "replace" } }"#,
        "materials.red.lightmap.mode",
        "modulate",
    ),
    ("/meshes/ball/shape/sphere", r#"{ "rings": 1 }"#, "meshes.ball.shape.sphere.rings", "2 to 1024"),
    ("/meshes/ball/shape/sphere", r#"{ "rings": 1024, "segments": 1024 }"#, "meshes.ball.shape.sphere", "1000000"),
    ("/meshes/ball/shape/sphere", r#"{ "radius": 0 }"#, "meshes.ball.shape.sphere.radius", "above 0"),
    ("/meshes/ball/shape", r#"{ "obj": "missing.obj" }"#, "meshes.ball.shape.obj", "cannot be read"),
    ("/meshes/bare/shape/triangles/triangles", "[[0, 1, 3]]", "meshes.bare.shape.triangles.triangles[0][2]", "is 3"),
    ("/meshes/bare/shape/triangles/triangles", "[[0, 1, -1]]", "meshes.bare.shape.triangles.triangles[0][2]", "u32"),
    ("/meshes/bare/shape/triangles/triangles", "[]", "meshes.bare.shape.triangles", "0 triangles"),
    ("/meshes/bare/shape/triangles/normals", "[[0, 0, 1]]", "meshes.bare.shape.triangles.normals", "1 entries"),
    (
        "/meshes/bare/shape/triangles/normals",
        "[[0, 0, 1], [0, 0, 0], [0, 0, 1]]",
        "meshes.bare.shape.triangles.normals[1]",
        "not 0",
    ),
    (
        "/meshes/bare",
        r#"{ "shape": { "triangles": { "positions": [[0, 0, 0]], "triangles": [[0, 0, 0]] } }, "normals": "face" }"#,
        "meshes.bare.normals",
        "no area",
    ),
    ("/objects/0/mesh", "\"bail\"", "objects[0].mesh", "is `bail`; expected one of ball, bare"),
    ("/objects/0/mesh", "\"bare\"", "objects[0].mesh", "no normals"),
    ("/objects/1/material", "\"red\"", "objects[1].mesh", "no texture coordinates"),
    ("/objects/1/vertex_colors", "true", "objects[1].mesh", "no colours"),
    ("/objects/0/material", "\"blue\"", "objects[0].material", "is `blue`; expected one of red"),
    ("/objects/0/name", "\"camera\"", "objects[0].name", "another name"),
    ("/objects/0/transform/0/scale", "[1, 0, 1]", "objects[0].transform", "flat"),
    (
        "/objects/0/transform/0",
        r#"{ "rotate": { "deg": 1, "axis": [0, 0, 0] } }"#,
        "objects[0].transform[0].rotate.axis",
        "not 0",
    ),
    ("/objects/0/transform/0", r#"{ "rotate": { "deg": 1 } }"#, "objects[0].transform[0].rotate", "axis"),
    (
        "/objects/0/transform/0",
        r#"{ "matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 2]] }"#,
        "objects[0].transform[0].matrix",
        "last row",
    ),
    ("/objects/0/transform/0/scale", "[1e30, 1e30, 1e39]", "objects[0].transform[0].scale[2]", "range of f32"),
    ("/objects/0/cutout", "2", "objects[0].cutout", "from 0 to 1"),
    ("/objects/1/blend/color", "\"screen\"", "objects[1].blend.color", "solid, alpha, mul, add"),
    ("/objects/1/blend/color", "\"add/one\"", "objects[1].blend.color", "equation/source/destination"),
    ("/objects/1/blend/color", "\"add/one/two\"", "objects[1].blend.color", "src-alpha-saturate"),
    ("/objects/1/blend/color", "\"min/one/zero\"", "objects[1].blend.color", "no factors"),
    ("/objects/1/blend/color", "\"add/constant-alpha/one\"", "objects[1].blend.color", "grey constant"),
    ("/objects/1/blend/alpha", "\"sum\"", "objects[1].blend.alpha", "is `sum`"),
    ("/objects/1/shading/alpha", "\"sum\"", "objects[1].shading.alpha", "unknown variant"),
    ("/objects/1/depth", r#"{ "test": { "compare": "less" } }"#, "objects[1].depth.test", "write"),
    ("/shadows", "true", "shadows", "unknown field"),
];

/// The base with one thing put in.
fn with(pointer: &str, value: &str) -> String {
    let mut scene = base();
    let (parent, field) = pointer.rsplit_once('/').expect("a pointer");
    let value: Value = serde_json::from_str(value).expect("a row's JSON");
    let parent = scene.pointer_mut(parent).unwrap_or_else(|| panic!("{pointer} is in the base"));
    match parent {
        Value::Array(list) => list[field.parse::<usize>().expect("a place")] = value,
        Value::Object(object) => _ = object.insert(field.to_owned(), value),
        _ => panic!("{pointer} is in a list or an object"),
    }
    scene.to_string()
}

fn refused(json: &str) -> String {
    let files = |name: &str| std::fs::read(Path::new("/nowhere").join(name));
    load::text("bad", json, &files).err().map_or_else(|| "accepted".into(), |error| error.to_string())
}

#[test]
fn the_base_of_bad_input_is_right() {
    assert_eq!(refused(&base().to_string()), "accepted");
}

#[test]
fn bad_input_is_refused_by_the_path_of_its_field() {
    for (pointer, value, path, says) in REFUSED {
        let message = refused(&with(pointer, value));
        assert!(message.starts_with(&format!("field `{path}`")), "{pointer} = {value}: {message}");
        assert!(message.contains(says), "{pointer} = {value}: {message}");
    }
}

#[test]
fn more_lights_than_a_frame_has_are_refused() {
    let lights = vec![base()["lights"][0].clone(); 65];
    let message = refused(&with("/lights", &Value::Array(lights).to_string()));
    assert!(message.starts_with("field `lights` is a list of 65; expected 64"), "{message}");
}

#[test]
fn what_is_not_a_scene_is_refused() {
    for (text, says) in [
        ("", "EOF"),
        ("[1]", "invalid"),
        ("{\"title\": \"t\"}", "missing field"),
        ("{\"title\": 1e999}", "title"),
        ("{\"title\": NaN}", "title"),
        (&format!("{} x", base()), "trailing"),
        (&base().to_string().replacen("\"ball\":", "\"bare\":", 1), "`bare` stands twice"),
        (&"[".repeat(100_000), "invalid"),
    ] {
        let message = refused(text);
        assert!(message.contains(says), "{text:.60}: {message}");
    }
}

/// Each may be drawn; together they would fill a machine's memory.
#[test]
fn too_much_in_all_is_refused() {
    let mut many = base();
    many["meshes"]["ball"] = json!({ "shape": { "sphere": { "rings": 600, "segments": 700 } } });
    let places: Vec<Value> = (0..40).map(|x| json!([{ "translate": [x, 0, 0] }])).collect();
    many["objects"][0]["instances"] = places.into();
    let said = refused(&many.to_string());
    assert!(said.contains("field `objects`") && said.contains("4000000 triangles at most"), "{said}");

    let mut large = base();
    for number in 0..9 {
        let colors = [[1, 1, 1, 1], [0, 0, 0, 1]];
        large["textures"][format!("large {number}")] = json!({ "checker": { "size": [2048, 2048], "colors": colors } });
    }
    let said = refused(&large.to_string());
    assert!(said.contains("field `textures`") && said.contains("16777216 at most"), "{said}");
}

#[cfg(unix)]
#[test]
fn what_never_ends_is_not_read() {
    let output = lightmeter(&["effects", "/dev/zero"]);
    assert_eq!(code(&output), 2, "{}", stderr(&output));
    assert!(stderr(&output).contains("it is a pipe or a device; expected a file"), "{}", stderr(&output));
}

#[test]
fn every_file_among_the_scenes_is_built_in_and_loads() {
    let folder = root().join("conformance/catalogue/scenes");
    let mut files: Vec<String> = std::fs::read_dir(folder)
        .expect("the folder of scenes")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "json"))
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    files.sort();
    assert_eq!(SCENES.map(|(name, _)| name).to_vec(), files);
    for name in files {
        let built_in = load::builtin(&name).unwrap_or_else(|error| panic!("{name}: {error}"));
        let file =
            load::file(&root().join(format!("conformance/catalogue/scenes/{name}.json"))).expect("the file loads");
        assert_eq!(built_in, file, "{name}");
        assert!(built_in.shows.ends_with('.') && built_in.shows.len() > 40, "{name}");
    }
}

#[test]
fn the_published_schema_is_current() {
    let output = lightmeter(&["schema", "scene"]);
    let published = std::fs::read_to_string(root().join("docs/scene.schema.json")).expect("the schema is published");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(
        stdout(&output) == published,
        "publish it again: cargo run -p lightmeter -- schema scene --out docs/scene.schema.json"
    );
}

#[test]
fn effects_are_told_light_by_light() {
    let text = stdout(&lightmeter(&["effects", "scene/teapot"]));
    for part in ["teapot: phong", "specular_blinn", "light `directional`", "not called for", "attenuation"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let file = root().join("conformance/catalogue/scenes/teapot.json");
    let told = json(&["effects", file.to_str().expect("UTF-8"), "--format", "json"]);
    assert_eq!((told["schema"].as_str(), told["scene"].as_str()), (Some("lightmeter.effects/1"), Some("teapot")));
    assert_eq!(told["draws"][1]["lights"], json!(["directional", "point"]));
    assert!(told["draws"][0]["reasons"][0]["why"].is_string());
}

#[test]
fn a_scene_that_is_refused_ends_with_2() {
    let folder = folder("scene");
    let file = folder.join("bad.json");
    std::fs::write(&file, with("/lights/1/cutoff_deg", "91")).expect("a scene can be written");
    for (scene, says) in [
        (file.to_str().expect("UTF-8"), "field `lights[1].cutoff_deg` is 91"),
        ("tea-pot", "no built-in scene `tea-pot`; did you mean `teapot`"),
        ("/nowhere/scene.json", "cannot read /nowhere/scene.json"),
        (folder.to_str().expect("UTF-8"), "cannot read"),
    ] {
        let output = lightmeter(&["effects", scene]);
        assert_eq!((code(&output), stdout(&output).as_str()), (2, ""), "{scene}");
        assert!(stderr(&output).contains(says), "{scene}: {}", stderr(&output));
    }
    let output = lightmeter(&["effects", "/nowhere/scene.json"]);
    assert_eq!(stderr(&output).matches("No such file").count(), 1, "{}", stderr(&output));
}
