//! Tests the drawing techniques that only `bench` uses. Each scene is changed so that the technique must give the same image as the plain
//! shader, so it can be judged by the f64 reference.

use crate::frames::frame;
use glam::{DVec3, Vec3};
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::image::expect::expect;
use lightmeter::image::file::StoredImage;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::select::builtin;
use lightmeter::subject::Subject;
use lightmeter::subject_gpu::gpu;
use lightmeter_gpu::compose::{Recipe, ShaderForm, Technique};
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_gpu::{Gpu, GpuError, Shaders};
use lightmeter_scene::effects::effects;
use lightmeter_scene::frame::{Cull, Draw, Fog, FogForm, Frame, Light, Material, Mesh, Place, Shading, Target};
use lightmeter_scene::raster::Provoking;
use lightmeter_scene::shading::{Distance, Frequency, Normals, Specular, SpecularGate, Viewer};
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
    if technique == Technique::UnitVectorsInterpolated {
        let frame = unequal_distances();
        finding.images += 1;
        finding.departure = first_departure(&image(gpu, shaders, &frame, technique)?, |pixel| {
            let color = lit_by_unit_vectors(&frame, pixel);
            (color, color)
        });
    }
    for (place, (name, _)) in SCENES.iter().enumerate() {
        let loaded = builtin(place, Some(SIZE)).unwrap_or_else(|error| panic!("{error}"));
        let Some(frame) = exact(technique, loaded.frame) else { continue };
        let image = match image(gpu, shaders, &frame, technique) {
            Err(GpuError::Technique { .. }) => continue,
            image => image?,
        };
        let legal = expect(&frame, None, None, &profile);
        finding.images += 1;
        let departure = first_departure(&image, |pixel| (legal[pixel].low, legal[pixel].high));
        finding.departure = finding.departure.or(departure.map(|what| format!("scene/{name}, {what}")));
    }
    finding.departure = finding.departure.map(|what| format!("{} of {what}", technique.name()));
    Ok(finding)
}

/// What a technique draws of a frame.
fn image(gpu: &Gpu, shaders: &Shaders, frame: &Frame, technique: Technique) -> Result<StoredImage, GpuError> {
    let recipe = Recipe { technique, ..Recipe::of(ShaderForm::Composed) };
    let renderer = SceneRenderer::new(gpu, shaders, frame, &effects(frame), recipe)?;
    let bytes = SceneRenderer::pixels(gpu, renderer.submit(gpu))?;
    Ok(StoredImage::read(frame.target.width as usize, frame.target.format, &bytes))
}

/// The first pixel that is farther from what is legal of it than is granted.
fn first_departure(image: &StoredImage, legal: impl Fn(usize) -> ([f64; 4], [f64; 4])) -> Option<String> {
    image.pixels.iter().enumerate().find_map(|(pixel, value)| {
        let (low, high) = legal(pixel);
        let is_legal = (0..4).all(|k| low[k] - SLACK <= value[k] && value[k] <= high[k] + SLACK);
        let place = [pixel % image.width, pixel / image.width];
        (!is_legal).then(|| format!("pixel {place:?}: {value:?} is not in {low:?} to {high:?}"))
    })
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

/// A triangle that covers the whole of an orthographic image, its vertices at very unequal distances from the eye and from a light at a point
/// and two spotlights that shine on all of it.
fn unequal_distances() -> Frame {
    let mut frame = frame(0);
    let place = |position| Place::Point { position, falloff: [1.0, 0.0, 0.0] };
    let spot =
        |position, axis| Place::Spot { position, falloff: [1.0, 0.0, 0.0], axis, cutoff_cosine: 0.0, exponent: 0.0 };
    let light =
        |diffuse: [f32; 3], place| Light { name: String::new(), ambient: [0.0; 3], diffuse, specular: [0.3; 3], place };
    frame.lights = vec![
        light([0.5, 0.0, 0.0], place([-1.0, 2.0, -0.5])),
        light([0.0, 0.5, 0.0], spot([2.0, 0.5, 1.0], [-1.0, 0.0, -3.0])),
        light([0.0, 0.0, 0.5], spot([0.0, -2.0, 0.0], [0.0, 1.0, -3.0])),
    ];
    frame.target.format = TargetFormat::Rgba32Float;
    frame.projection = [[0.5, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, -0.05, 0.0], [0.0, 0.0, 0.0, 1.0]];
    (frame.clear_depth, frame.ambient, frame.fog) = (1.0, [0.0; 3], None);
    frame.meshes = vec![Mesh {
        positions: vec![[-2.0, -2.0, -1.0], [6.0, -2.0, -2.0], [-2.0, 6.0, -9.0]],
        normals: vec![[0.0, 0.0, 1.0]; 3],
        uvs: vec![],
        lightmap_uvs: vec![],
        colors: vec![],
        triangles: vec![[0, 1, 2]],
    }];
    frame.draws = vec![Draw {
        name: String::new(),
        mesh: 0,
        modelview: std::array::from_fn(|k| std::array::from_fn(|j| if j == k { 1.0 } else { 0.0 })),
        material: Material {
            emissive: [0.0; 3],
            ambient: [0.0; 3],
            diffuse: [1.0; 3],
            specular: [1.0; 3],
            shininess: 4.0,
        },
        shading: Some(Shading {
            frequency: Frequency::Phong,
            provoking: Provoking::First,
            specular: Specular::Phong,
            gate: SpecularGate::Documents,
            viewer: Viewer::Local,
            normals: Normals::InverseTranspose,
        }),
        alpha: 1.0,
        vertex_colors: false,
        texture: None,
        lightmap: None,
        cutout: None,
        blend: None,
        depth: None,
        cull: Cull::None,
    }];
    frame
}

/// A pixel of [`unequal_distances`]: `Σ max(l·n, 0)·diffuse + max(r·v, 0)⁴·specular`, l and v the normalised sums of the vertices' unit vectors
/// by the pixel's weights, and r = 2(l·n)n − l.
fn lit_by_unit_vectors(frame: &Frame, pixel: usize) -> [f64; 4] {
    let corners = frame.meshes[0].positions.iter().map(|&p| Vec3::from(p).as_dvec3()).collect::<Vec<DVec3>>();
    let Target { width, height, .. } = frame.target;
    let place = u32::try_from(pixel).expect("a small image");
    let x = 4.0 * (f64::from(place % width) + 0.5) / f64::from(width) - 2.0;
    let y = 2.0 - 4.0 * (f64::from(place / width) + 0.5) / f64::from(height);
    let (second, third) = ((x + 2.0) / 8.0, (y + 2.0) / 8.0);
    let weights = [1.0 - second - third, second, third];
    let between = |unit: &dyn Fn(DVec3) -> DVec3| {
        weights.iter().zip(&corners).map(|(&weight, &p)| weight * unit(p)).sum::<DVec3>().normalize()
    };
    let (n, v) = (DVec3::Z, between(&|p| (-p).normalize()));
    let mut sum = DVec3::ZERO;
    for light in &frame.lights {
        let (Place::Point { position, .. } | Place::Spot { position, .. }) = light.place else { continue };
        let l = between(&|p| (Vec3::from(position).as_dvec3() - p).normalize());
        let highlight = (2.0 * l.dot(n) * n - l).dot(v).max(0.0).powi(4);
        sum += l.dot(n).max(0.0) * Vec3::from(light.diffuse).as_dvec3();
        sum += highlight * Vec3::from(light.specular).as_dvec3();
    }
    [sum.x, sum.y, sum.z, 1.0]
}
