//! Wavefront OBJ without the feature `scenes`: no file is read.

use super::part::Part;
use crate::scene::field::{At, SceneError};
use crate::scene::files::Files;
use lightmeter_scene::frame::Texture;

/// Refuses the file.
pub(super) fn parts(
    at: &At<'_>,
    path: &str,
    _files: &Files<'_>,
    _textures: &mut Vec<Texture>,
) -> Result<Vec<Part>, SceneError> {
    let without = "no file, since the library was built without the feature `scenes`";
    Err(at.refuse(format_args!("is `{path}`"), without))
}
