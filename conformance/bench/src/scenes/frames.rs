//! What techniques and scalings draw.

use lightmeter_catalogue::scene::load;
use lightmeter_scene::frame::{Frame, Mesh};
use std::fmt::Write as _;

/// A frame of a scene written here.
fn frame(json: &str) -> Frame {
    let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    load::text("bench", json, &no_files)
        .unwrap_or_else(|error| panic!("a scene of the bench is refused: {error}"))
        .frame
}

/// A built-in scene's frame.
pub(super) fn builtin(name: &str) -> Frame {
    load::builtin(name).unwrap_or_else(|error| panic!("{error}")).frame
}

/// A ball of `rings` rings under a point light, shiny, lit at a frequency.
pub(super) fn ball(frequency: &str, rings: u32) -> Frame {
    let segments = rings * 3 / 2;
    frame(&format!(
        r#"{{
            "title": "", "shows": "", "target": {{ "format": "rgba32float" }},
            "camera": {{ "eye": [0, 0, 4], "projection": {{ "perspective": {{ "fov_y_deg": 31, "near": 1, "far": 10 }} }} }},
            "ambient": {{ "color": [0.1, 0.1, 0.1] }},
            "lights": [{{ "kind": "point", "color": [0.75, 0.75, 0.75], "position": [1.5, 2, 3] }}],
            "materials": {{ "white": {{ "ka": 0.1, "kd": 0.55, "ks": 0.6, "shininess": 32 }} }},
            "meshes": {{ "ball": {{ "shape": {{ "sphere": {{ "rings": {rings}, "segments": {segments} }} }} }} }},
            "shading": {{ "frequency": "{frequency}" }},
            "objects": [{{ "mesh": "ball", "material": "white", "transform": [{{ "rotate": {{ "deg": 20, "axis": [1, 0, 1] }} }}] }}]
        }}"#
    ))
}

/// A floor and a wall of two triangles each that recede into exponential fog.
pub(super) fn fog() -> Frame {
    frame(
        r#"{
            "title": "", "shows": "", "target": { "format": "rgba32float" },
            "background": [0.6, 0.65, 0.7, 1],
            "camera": { "eye": [0, 0, 0], "center": [0, 0, -1], "projection": { "perspective": { "fov_y_deg": 50, "near": 1, "far": 60 } } },
            "fog": { "color": [0.6, 0.65, 0.7], "factor": { "exp": { "density": 0.08 } } },
            "ambient": { "color": [0.3, 0.3, 0.3] },
            "lights": [{ "kind": "directional", "toward": [0.5, 0.8, 0.6] }],
            "materials": {
                "green": { "color": [0.2, 0.5, 0.2], "ka": 0.5, "kd": 0.7 },
                "red": { "color": [0.7, 0.15, 0.1], "ka": 0.5, "kd": 0.7 }
            },
            "meshes": {
                "floor": { "shape": { "plane": { "size": [40, 40] } } },
                "wall": { "shape": { "quad": { "size": [40, 6] } } }
            },
            "objects": [
                { "mesh": "floor", "material": "green", "transform": [{ "translate": [0, -1.5, -22.5] }] },
                { "mesh": "wall", "material": "red", "transform": [{ "rotate": { "deg": 90, "axis": [0, 1, 0] } }, { "translate": [-3, 1.5, -22.5] }] }
            ]
        }"#,
    )
}

/// A square before which four translucent squares stand.
pub(super) fn layers() -> Frame {
    frame(
        r#"{
            "title": "", "shows": "", "target": { "format": "rgba32float" },
            "background": [0.1, 0.2, 0.3, 1],
            "camera": { "eye": [0, 0, 5], "projection": { "perspective": { "fov_y_deg": 45, "near": 1, "far": 10 } } },
            "ambient": { "color": [0.2, 0.2, 0.2] },
            "lights": [{ "kind": "point", "color": [0.75, 0.75, 0.75], "position": [0.5, 1, 3] }],
            "materials": {
                "back": { "color": [0.8, 0.7, 0.5], "ka": 0.2, "kd": 0.9 },
                "red": { "color": [0.9, 0.2, 0.1], "ka": 0.2, "kd": 0.9, "opacity": 0.37 },
                "blue": { "color": [0.1, 0.3, 0.9], "ka": 0.2, "kd": 0.9, "opacity": 0.61 }
            },
            "meshes": { "square": { "shape": { "quad": { "size": [3.4, 3.4] } } } },
            "shading": { "frequency": "phong" },
            "objects": [
                { "mesh": "square", "material": "back", "transform": [{ "translate": [0, 0, -0.5] }] },
                { "mesh": "square", "material": "red", "blend": { "color": "alpha" }, "transform": [{ "translate": [0.2, 0.1, 0] }] },
                { "mesh": "square", "material": "blue", "blend": { "color": "alpha" }, "transform": [{ "translate": [-0.3, 0.2, 0.2] }] },
                { "mesh": "square", "material": "red", "blend": { "color": "alpha" }, "transform": [{ "translate": [0.1, -0.3, 0.4] }] },
                { "mesh": "square", "material": "blue", "blend": { "color": "alpha" }, "transform": [{ "translate": [0.3, -0.1, 0.6] }] }
            ]
        }"#,
    )
}

/// A ball under `count` point lights, lit at its fragments.
pub(super) fn lights(count: u32) -> Frame {
    let mut lights = String::new();
    for k in 0..count {
        let (sin, cos) = (0.7 * f64::from(k)).sin_cos();
        let comma = if k == 0 { "" } else { ", " };
        let (x, y, bright) = (3.0 * cos, 3.0 * sin, 0.8 / f64::from(count));
        let _ = write!(
            lights,
            r#"{comma}{{ "kind": "point", "color": [{bright}, {bright}, {bright}], "position": [{x}, {y}, 3] }}"#
        );
    }
    frame(&format!(
        r#"{{
            "title": "", "shows": "", "target": {{ "format": "rgba8unorm" }},
            "camera": {{ "eye": [0, 0, 4], "projection": {{ "perspective": {{ "fov_y_deg": 31, "near": 1, "far": 10 }} }} }},
            "lights": [{lights}],
            "materials": {{ "white": {{ "kd": 0.55, "ks": 0.6, "shininess": 32 }} }},
            "meshes": {{ "ball": {{ "shape": {{ "sphere": {{ "rings": 16, "segments": 24 }} }} }} }},
            "shading": {{ "frequency": "phong" }},
            "objects": [{{ "mesh": "ball", "material": "white" }}]
        }}"#
    ))
}

/// A square of a grid that fills the view, under a point light: lit at the vertices or at the fragments.
pub(super) fn sheet(frequency: &str) -> Frame {
    frame(&format!(
        r#"{{
            "title": "", "shows": "", "target": {{ "format": "rgba8unorm" }},
            "camera": {{ "eye": [0, 0, 5], "projection": {{ "orthographic": {{ "height": 2, "near": 1, "far": 10 }} }} }},
            "ambient": {{ "color": [0.1, 0.1, 0.1] }},
            "lights": [{{ "kind": "point", "color": [0.75, 0.75, 0.75], "position": [0.5, 0.5, 1.5] }}],
            "materials": {{ "white": {{ "ka": 0.1, "kd": 0.55, "ks": 0.6, "shininess": 32 }} }},
            "meshes": {{ "sheet": {{ "shape": {{ "quad": {{ "size": [2, 2] }} }} }} }},
            "shading": {{ "frequency": "{frequency}" }},
            "objects": [{{ "mesh": "sheet", "material": "white", "depth": "none" }}]
        }}"#
    ))
}

/// The same square of `side`² vertices.
pub(super) fn grid(side: u32) -> Frame {
    let mut frame = sheet("gouraud");
    let mut mesh = Mesh::default();
    #[expect(clippy::cast_precision_loss, reason = "far below 2^24")]
    let place = |k: u32| 2.0 * k as f32 / (side - 1) as f32 - 1.0;
    for row in 0..side {
        for column in 0..side {
            mesh.positions.push([place(column), -place(row), 0.0]);
            mesh.normals.push([0.0, 0.0, 1.0]);
        }
    }
    for row in 0..side - 1 {
        for column in 0..side - 1 {
            let upper = row * side + column;
            let lower = upper + side;
            mesh.triangles.extend([[upper, lower, lower + 1], [upper, lower + 1, upper + 1]]);
        }
    }
    frame.meshes[0] = mesh;
    frame
}
