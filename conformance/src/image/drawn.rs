//! One image of a frame as a subject draws it: its colours, or an intermediate result.

use super::file::Stored;
use crate::subject::Subject;
use lightmeter_gpu::compose::{Recipe, Shader};
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_gpu::{Error, Shaders};
use lightmeter_reference::render::render;
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::stage::Stage;
use lightmeter_scene::target::TargetFormat;

/// The image in its target's units, or why the subject cannot draw it.
///
/// # Errors
/// Where a shader is invalid or the device fails.
pub fn drawn(
    subject: &Subject,
    shaders: &Shaders,
    frame: &Frame,
    sets: &[Called],
    shader: Shader,
) -> Result<Result<Stored, &'static str>, Error> {
    let Some(gpu) = subject.gpu() else {
        return Ok(Ok(Stored::of(&render::<f32>(frame, None, None), frame.target.format)));
    };
    if let Some(reason) = SceneRenderer::lacks(gpu, frame) {
        return Ok(Err(reason));
    }
    let renderer = SceneRenderer::new(gpu, shaders, frame, sets, Recipe::of(shader))?;
    let bytes = SceneRenderer::pixels(gpu, renderer.submit(gpu))?;
    Ok(Ok(Stored::read(frame.target.width as usize, frame.target.format, &bytes)))
}

/// An intermediate result as a subject draws it.
///
/// # Errors
/// Where a shader is invalid or the device fails.
pub fn intermediate(
    subject: &Subject,
    shaders: &Shaders,
    frame: &Frame,
    sets: &[Called],
    stage: Stage,
) -> Result<Stored, Error> {
    let format = TargetFormat::Rgba32Float;
    let Some(gpu) = subject.gpu() else {
        return Ok(Stored::unrounded(&render::<f32>(frame, None, Some(stage)), format));
    };
    let renderer = SceneRenderer::new(gpu, shaders, frame, sets, Recipe::stage(stage))?;
    let bytes = SceneRenderer::pixels(gpu, renderer.submit(gpu))?;
    Ok(Stored::read(frame.target.width as usize, format, &bytes))
}
