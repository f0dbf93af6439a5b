//! The scenes that are built in: those of the documents, and the files that they name.

use std::io;

macro_rules! scenes {
    ($($name:literal)*) => {
        [$(($name, include_str!(concat!("../../scenes/", $name, ".json")))),*]
    };
}

const COUNT: usize = 34;

/// Each built-in scene's name and JSON.
pub const SCENES: [(&str, &str); COUNT] = scenes! {
    "attached-lights"
    "averaged-normals"
    "color-cube"
    "crossing"
    "depth-on-off"
    "eight-lights"
    "fixed-color"
    "flat"
    "fog-exp"
    "fog-exp2-document"
    "fog-exp2-opengl"
    "fog-linear"
    "fog-radial"
    "gouraud"
    "light-ambient"
    "light-ambient-opengl"
    "lightmap"
    "lights-together"
    "missed-highlight"
    "near-clip"
    "obj"
    "phong"
    "phong-blinn"
    "plastic-metal"
    "reversed-depth"
    "scaled-normals"
    "shininess"
    "sorted"
    "spotlight"
    "teapot"
    "texture-edges"
    "translucent-square"
    "unit-light"
    "viewer"
};

/// The files that they name.
const ASSETS: [(&str, &[u8]); 3] = [
    ("bricks.png", include_bytes!("../../scenes/bricks.png")),
    ("house.mtl", include_bytes!("../../scenes/house.mtl")),
    ("house.obj", include_bytes!("../../scenes/house.obj")),
];

/// The bytes of a file that a built-in scene names.
///
/// # Errors
///
/// Where there is none.
pub fn asset(name: &str) -> io::Result<Vec<u8>> {
    let found = ASSETS.iter().find(|(own, _)| *own == name);
    found.map(|(_, bytes)| bytes.to_vec()).ok_or_else(|| io::ErrorKind::NotFound.into())
}
