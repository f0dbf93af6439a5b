//! One image of a frame as a subject draws it: its colours, or an intermediate result.

use crate::device::{Code, DeviceError, Picture};
use crate::subject::Subject;
use lightmeter_judge::image::file::StoredImage;
use lightmeter_reference::render::render;
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::stage::Intermediate;
use lightmeter_scene::target::TargetFormat;

/// The image in its target's units, or why the subject cannot draw it. An embedded subject has no shader with switches, and draws
/// what is asked of the other.
///
/// # Errors
/// Where a shader is invalid or the device fails.
pub fn drawn(
    subject: &Subject,
    code: &Code,
    frame: &Frame,
    sets: &[Called],
    picture: Picture,
) -> Result<Result<StoredImage, &'static str>, DeviceError> {
    let (stage, format) = match picture {
        Picture::Composed | Picture::Full => (None, frame.target.format),
        Picture::Intermediate(stage) => (Some(stage), TargetFormat::Rgba32Float),
    };
    let Some(device) = subject.device() else {
        let image = render::<f32>(frame, None, stage);
        return Ok(Ok(if stage.is_some() {
            StoredImage::unrounded(&image, format)
        } else {
            StoredImage::of(&image, format)
        }));
    };
    // An intermediate result is drawn on another format, and is not blended.
    let lacks = if stage.is_some() { device.lacks_target(format) } else { device.lacks_frame(frame) };
    if let Some(reason) = lacks {
        return Ok(Err(reason));
    }
    let bytes = device.pixels(device.draw(code, frame, sets, picture)?)?;
    Ok(Ok(StoredImage::read(frame.target.width as usize, format, &bytes)))
}

/// An intermediate result as a subject draws it, or why it cannot.
///
/// # Errors
/// Where a shader is invalid or the device fails.
pub fn intermediate(
    subject: &Subject,
    code: &Code,
    frame: &Frame,
    sets: &[Called],
    stage: Intermediate,
) -> Result<Result<StoredImage, &'static str>, DeviceError> {
    drawn(subject, code, frame, sets, Picture::Intermediate(stage))
}
