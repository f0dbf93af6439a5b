//! Tests the drawing techniques that only `bench` uses. Each scene is changed so that the technique must give the same image as the plain
//! shader, so it can be judged by the f64 reference.

use lightmeter::arithmetic::profile::WGSL;
use lightmeter::image::expect::expect;
use lightmeter::image::file::StoredImage;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::select::builtin;
use lightmeter::subject::Subject;
use lightmeter::subject_gpu::gpu;
use lightmeter_gpu::compose::{Recipe, ShaderForm, Technique};
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_gpu::{GpuError, Shaders};
use lightmeter_scene::effects::effects;
use lightmeter_scene::frame::{Draw, Fog, FogForm, Frame, Place};
use lightmeter_scene::shading::{Distance, Viewer};
use lightmeter_scene::target::TargetFormat;

/// Pixels of the longer side.
const SIZE: u32 = 64;
/// How far interpolated vectors may take a component from what is legal: they are rounded at the vertices and once more on the way.
const SLACK: f64 = 1e-4;

/// What a technique draws of the built-in scenes.
#[derive(Clone, Debug, Default)]
pub struct TechniqueFinding {
    /// How many images each drew.
    pub images: u64,
    /// The first pixel that is not what it is to be.
    pub departure: Option<String>,
}

/// Draws every built-in scene by a technique, changed so that the technique gives what the plain shader gives.
///
/// # Errors
/// Where a shader is invalid or the device fails.
///
/// # Panics
/// Where the subject is no adapter, or a built-in scene is invalid.
pub fn drawn_by(technique: Technique, subject: &Subject, shaders: &Shaders) -> Result<TechniqueFinding, GpuError> {
    let gpu = gpu(subject).expect("the subject is an adapter");
    let profile = subject.known.profile(&WGSL);
    let mut finding = TechniqueFinding::default();
    for (place, (name, _)) in SCENES.iter().enumerate() {
        let loaded = builtin(place, Some(SIZE)).unwrap_or_else(|error| panic!("{error}"));
        let Some(frame) = exact(technique, loaded.frame) else { continue };
        let recipe = Recipe { technique, ..Recipe::of(ShaderForm::Composed) };
        let renderer = match SceneRenderer::new(gpu, shaders, &frame, &effects(&frame), recipe) {
            Err(GpuError::Technique { .. }) => continue,
            renderer => renderer?,
        };
        let bytes = SceneRenderer::pixels(gpu, renderer.submit(gpu))?;
        let image = StoredImage::read(frame.target.width as usize, frame.target.format, &bytes);
        let legal = expect(&frame, None, None, &profile);
        finding.images += 1;
        let mut pixels = image.pixels.iter().zip(&legal).enumerate();
        let is_outside = |value: &[f64; 4], low: &[f64; 4], high: &[f64; 4]| {
            (0..4).any(|k| !(low[k] - SLACK <= value[k] && value[k] <= high[k] + SLACK))
        };
        if let Some((pixel, (value, legal))) =
            pixels.find(|(_, (value, legal))| is_outside(value, &legal.low, &legal.high))
            && finding.departure.is_none()
        {
            let place = [pixel % image.width, pixel / image.width];
            finding.departure =
                Some(format!("{} of scene/{name}, pixel {place:?}: {value:?} is not in {legal:?}", technique.name()));
        }
    }
    Ok(finding)
}

/// A frame of which a technique gives what the plain shader gives; `None` where none can be made of it.
fn exact(technique: Technique, mut frame: Frame) -> Option<Frame> {
    frame.target.format = TargetFormat::Rgba32Float;
    frame.draws.iter_mut().for_each(|draw| (draw.blend, draw.cutout) = (None, None));
    match technique {
        // Vectors to a place are affine in the position.
        Technique::Plain | Technique::VectorsInterpolated => {}
        // Vectors that are everywhere the same.
        Technique::UnitVectorsInterpolated => {
            frame.lights.retain(|light| matches!(light.place, Place::Directional { .. }));
            frame
                .draws
                .iter_mut()
                .filter_map(|draw| draw.shading.as_mut())
                .for_each(|shading| shading.viewer = Viewer::NonLocal);
        }
        // Within its ramp linear fog is affine in the depth.
        Technique::FogAtVertex => {
            let depths = || frame.draws.iter().flat_map(|draw| depths(&frame, draw));
            let (nearest, farthest) = (depths().fold(f32::INFINITY, f32::min), depths().fold(0.0, f32::max));
            if nearest <= 0.0 {
                return None;
            }
            let color = frame.fog.as_ref().map_or([0.3, 0.5, 0.7], |fog| fog.color);
            let form = FogForm::Linear { dmin: 0.5 * nearest, dmax: 2.0 * farthest };
            frame.fog = Some(Fog { color, form, distance: Distance::Planar });
        }
    }
    Some(frame)
}

/// How far before the eye a draw's vertices are.
fn depths<'a>(frame: &'a Frame, draw: &'a Draw) -> impl Iterator<Item = f32> + 'a {
    let row = |k: usize| draw.modelview[k][2];
    frame.meshes[draw.mesh].positions.iter().map(move |p| -(row(0) * p[0] + row(1) * p[1] + row(2) * p[2] + row(3)))
}
