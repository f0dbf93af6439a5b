//! The image and the camera's matrices.

use super::field::{At, SceneError};
use glam::{DMat4, DVec3, dcamera::rh};
use lightmeter_scene::frame::{Matrix, Target};
use lightmeter_scene::model::{self, Projection};

/// Pixels along each side of an image, at most.
const MOST_PIXELS: u32 = 8192;

/// The image.
pub(super) fn target(target: model::Target) -> Result<Target, SceneError> {
    let at = At::Scene.field("target");
    for (name, pixels) in [("width", target.width), ("height", target.height)] {
        at.field(name).require((1..=MOST_PIXELS).contains(&pixels), pixels, "1 to 8192 pixels")?;
    }
    Ok(Target { width: target.width, height: target.height, format: target.format })
}

/// World → eye.
pub(super) fn view(camera: &model::Camera) -> Result<DMat4, SceneError> {
    let at = At::Scene.field("camera");
    at.field("eye").numbers(camera.eye)?;
    at.field("center").numbers(camera.center)?;
    at.field("up").direction(camera.up)?;
    let (eye, center, up) = (DVec3::from(camera.eye), DVec3::from(camera.center), DVec3::from(camera.up));
    let Some(ahead) = (center - eye).try_normalize() else {
        return Err(at.field("center").refuse("is where the eye is", "another point"));
    };
    let Some(up) = up.try_normalize() else {
        return Err(at.field("up").refuse("is too short", "a vector that is not 0"));
    };
    // A thousandth of a degree apart.
    if ahead.cross(up).length() < 1.7e-5 {
        return Err(at.field("up").refuse("is parallel to the way from eye to center", "another direction"));
    }
    Ok(rh::view::look_at_mat4(eye, center, up))
}

/// Eye → clip, with WebGPU's depth from 0 to 1, or from 1 to 0.
pub(super) fn projection(camera: &model::Camera, target: Target) -> Result<Matrix, SceneError> {
    let at = At::Scene.field("camera");
    let at = at.field("projection");
    let aspect = f64::from(target.width) / f64::from(target.height);
    let planes = |at: &At<'_>, near: f64, far: f64| -> Result<(f64, f64), SceneError> {
        let rounded = at.field("near").positive(near)?;
        let beyond = at.field("far").number(far)? > rounded;
        at.field("far").require(beyond, far, &format!("a distance above `near`, which is {near}"))?;
        Ok(if camera.reversed_depth { (far, near) } else { (near, far) })
    };
    let matrix = match camera.projection {
        Projection::Perspective { fov_y_deg, near, far } => {
            let at = at.field("perspective");
            let is_angle = fov_y_deg > 0.0 && fov_y_deg < 180.0;
            at.field("fov_y_deg").require(is_angle, fov_y_deg, "an angle above 0 and below 180 degrees")?;
            let (near, far) = planes(&at, near, far)?;
            rh::proj::directx::perspective(fov_y_deg.to_radians(), aspect, near, far)
        }
        Projection::Orthographic { height, near, far } => {
            let at = at.field("orthographic");
            let half = f64::from(at.field("height").positive(height)?) / 2.0;
            let (near, far) = planes(&at, near, far)?;
            rh::proj::directx::orthographic(-half * aspect, half * aspect, -half, half, near, far)
        }
    };
    columns(&at, matrix)
}

/// The matrix in f32.
pub(super) fn columns(at: &At<'_>, matrix: DMat4) -> Result<Matrix, SceneError> {
    let mut columns = [[0.0; 4]; 4];
    for (column, of) in columns.iter_mut().zip(matrix.to_cols_array_2d()) {
        for (to, x) in column.iter_mut().zip(of) {
            *to = at.number(x).map_err(|_| at.refuse("makes a matrix beyond f32", "smaller numbers"))?;
        }
    }
    Ok(columns)
}
