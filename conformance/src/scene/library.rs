//! The scenes that are built in: those of the documents, and the files that they name.

use std::io;

macro_rules! scenes {
    ($($name:literal)*) => {
        [$(($name, include_str!(concat!("../../scenes/", $name, ".json")))),*]
    };
}

const COUNT: usize = 2;

/// Each built-in scene's name and JSON.
pub const SCENES: [(&str, &str); COUNT] = scenes! {
    "teapot"
    "gouraud-phong"
};

/// The files that they name.
const ASSETS: [(&str, &[u8]); 0] = [];

/// The bytes of a file that a built-in scene names.
///
/// # Errors
///
/// Where there is none.
pub fn asset(name: &str) -> io::Result<Vec<u8>> {
    let found = ASSETS.iter().find(|(own, _)| *own == name);
    found.map(|(_, bytes)| bytes.to_vec()).ok_or_else(|| io::ErrorKind::NotFound.into())
}
