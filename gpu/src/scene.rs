//! Frames drawn on a device: each draw by the shader that is composed from its effects.
//!
//! A draw's bindings, vertex inputs and varyings are those that its shader has, so what no effect calls for is neither
//! uploaded nor bound. Draws that differ in numbers alone share a pipeline.

mod geometry;
mod pipeline;
mod uniforms;

use crate::compose::{Composer, Intermediate, MOST_TOWARD, Recipe, ShaderForm, Technique, live};
use crate::depth_unit::DEPTH;
use crate::device::{Clock, ClockReading, Executor, Gpu, Pending, format};
use crate::error::GpuError;
use crate::shaders::Shaders;
use crate::work::{
    BindGroup, Binding, Bytes, ColorAttachment, Command, DepthAttachment, Handle, Read, RenderPass, Resources, Step,
    Submission, TextureResource,
};
use geometry::Geometry;
use lightmeter_scene::effects::{Called, Effect, Effects};
use lightmeter_scene::frame::{self, Draw, Frame, Place};
use lightmeter_scene::target::TargetFormat;
use pipeline::{Key, Pipelines, Program};
use std::rc::Rc;
use uniforms::{Packer, Resource, resource};
use wgpu_types::{Color, IndexFormat, LoadOp, Operations, StoreOp, TextureFormat, TextureUsages};

/// The shaders' file in messages: they are composed of several.
const FILE: &str = "scene.wgsl";

/// A frame on a device, ready to be drawn: pipelines, buffers and textures.
#[derive(Debug)]
pub struct SceneRenderer {
    executor: Executor,
    work: Submission,
}

/// What a draw is drawn by.
struct PreparedDraw {
    pipeline: Handle,
    program: Rc<Program>,
    resources: Vec<(u32, Resource)>,
    constant: Option<Color>,
}

impl SceneRenderer {
    /// Why a frame cannot be drawn on a device; `None` where it can.
    #[must_use]
    pub fn lacks(gpu: &Gpu, frame: &Frame) -> Option<&'static str> {
        let target = frame.target.format;
        let blends = frame.draws.iter().any(|draw| draw.blend.is_some());
        gpu.lacks_target(target).or_else(|| gpu.lacks_blending(target).filter(|_| blends))
    }

    /// Uploads the frame and compiles what draws it. `sets[i]` is what `frame.draws[i]` calls for. With a stage, the
    /// target is rgba32float and 0 where nothing is drawn, nothing is blended, and fragments give that intermediate result.
    ///
    /// # Errors
    /// [`GpuError::Unavailable`] where a shader is, in the arithmetic that is asked for, or the device lacks what that takes.
    /// Where the sets are not one a draw, the frame has no use for the technique, a blend state has no factor on the unit, a
    /// shader is invalid, or the device refuses a pipeline.
    ///
    /// # Panics
    /// Where a stage is asked of [`ShaderForm::Full`], or a draw names a mesh, a texture or a light that the frame lacks.
    pub fn new(gpu: &Gpu, shaders: &Shaders, frame: &Frame, sets: &[Called], recipe: Recipe) -> Result<Self, GpuError> {
        let (resources, work) = Self::describe(gpu, shaders, frame, sets, recipe)?;
        Self::of(gpu, &resources, work)
    }

    /// What [`SceneRenderer::new`] makes and submits, as data.
    ///
    /// # Errors
    /// As [`SceneRenderer::new`] has them, but for what the device refuses.
    ///
    /// # Panics
    /// As [`SceneRenderer::new`] does.
    pub fn describe(
        gpu: &Gpu,
        shaders: &Shaders,
        frame: &Frame,
        sets: &[Called],
        recipe: Recipe,
    ) -> Result<(Resources, Submission), GpuError> {
        if sets.len() != frame.draws.len() {
            return Err(GpuError::Sets { draws: frame.draws.len(), sets: sets.len() });
        }
        if let Some(reason) = recipe.rung.lacks(gpu) {
            return Err(GpuError::Unavailable { what: recipe.rung.name().into(), reason: reason.into() });
        }
        describe(shaders, frame, sets, recipe, gpu.is_gl)
    }

    /// Draws by a description.
    ///
    /// # Errors
    /// Where a shader is invalid, or the device refuses a resource.
    pub fn of(gpu: &Gpu, resources: &Resources, work: Submission) -> Result<Self, GpuError> {
        let mut executor = Executor::default();
        executor.make(gpu, resources, FILE)?;
        Ok(Self { executor, work })
    }

    /// Draws the frame and asks for its pixels.
    #[must_use]
    pub fn submit(&self, gpu: &Gpu) -> Pending {
        self.executor.submit(gpu, &self.work)
    }

    /// The pixels of a submission in the target's own bits, the top row first, rows without gaps.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub fn pixels(gpu: &Gpu, pending: Pending) -> Result<Vec<u8>, GpuError> {
        pending.map(gpu, |words| bytemuck::cast_slice(&words).to_vec())
    }

    /// How long it takes to draw the frame `repeats` times in one submission. A driver compiles at the first draw: draw once
    /// before.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub fn time(&self, gpu: &Gpu, clock: &Clock, repeats: u32) -> Result<ClockReading, GpuError> {
        self.executor.time(gpu, clock, &self.work, repeats)
    }
}

/// What a frame needs on a device, and its drawing.
///
/// # Errors
/// As [`SceneRenderer::new`] has them, but for what the device refuses.
fn describe(
    shaders: &Shaders,
    frame: &Frame,
    sets: &[Called],
    recipe: Recipe,
    is_gl: bool,
) -> Result<(Resources, Submission), GpuError> {
    check_technique(frame, sets, recipe)?;
    let target = if recipe.stage.is_some() { TargetFormat::Rgba32Float } else { frame.target.format };
    let tests_depth = frame.draws.iter().any(|draw| draw.depth.is_some());
    let mut resources = Resources::default();
    let mut pipelines = Pipelines::new(Composer::new(shaders)?, recipe, format(target), tests_depth, is_gl);
    let mut packer = Packer::default();
    let prepared = frame
        .draws
        .iter()
        .zip(sets)
        .map(|(draw, called)| prepare(frame, draw, called, recipe, (&mut resources, &mut pipelines, &mut packer)))
        .collect::<Result<Vec<_>, GpuError>>()?;
    let uniforms = resources.buffer(packer.finish());
    let textures: Vec<Handle> = frame.textures.iter().map(|texture| resources.texture(texels(texture))).collect();
    let white = frame::Texture { width: 1, height: 1, texels: vec![[1.0; 4]] };
    let none = resources.texture(texels(&white));
    let mut geometry = Geometry::new(frame, is_gl);
    let mut commands = vec![];
    for (draw, prepared) in frame.draws.iter().zip(prepared) {
        let bindings = prepared.resources.iter().map(|(number, resource)| {
            let binding = match *resource {
                Resource::Uniform { offset, bytes } => Binding::Part { buffer: uniforms, offset, bytes },
                Resource::Texture(place) => Binding::Texture(place.map_or(none, |place| textures[place])),
            };
            (*number, binding)
        });
        let group = BindGroup { pipeline: prepared.pipeline, bindings: bindings.collect() };
        let group = resources.group(group);
        commands.extend(draw_commands(draw, &prepared, group, (&mut geometry, &mut resources)));
    }
    let work = drawing(frame, recipe.stage, format(target), commands, &mut resources);
    Ok((resources, work))
}

/// The pipeline of a draw, and what its bindings are given.
fn prepare(
    frame: &Frame,
    draw: &Draw,
    called: &Called,
    recipe: Recipe,
    (resources, pipelines, packer): (&mut Resources, &mut Pipelines, &mut Packer),
) -> Result<PreparedDraw, GpuError> {
    let stage = recipe.stage;
    let blended = draw.blend.filter(|_| stage.is_none());
    let blend = blended.map(|blend| pipeline::native(draw, blend)).transpose()?;
    let key = Key {
        effects: called.effects,
        blend: blend.map(|(state, _)| state),
        depth: draw.depth,
        cull: draw.cull,
        toward: toward(frame, called, recipe),
    };
    let (pipeline, program) = pipelines.get(resources, key)?;
    let told = uniforms::Told { frame, draw, called, effects: program.effects(called.effects), stage };
    let bound = program.bindings.iter().map(|(number, name)| Ok((*number, resource(&told, name, packer)?)));
    let resources = bound.collect::<Result<_, GpuError>>()?;
    Ok(PreparedDraw { pipeline, program, resources, constant: blend.map(|(_, constant)| constant) })
}

/// The commands of a draw; none of one without triangles.
fn draw_commands(
    draw: &Draw,
    prepared: &PreparedDraw,
    group: Handle,
    (geometry, resources): (&mut Geometry<'_>, &mut Resources),
) -> Vec<Command> {
    let (buffer, count) = geometry.indices(resources, draw);
    if count == 0 {
        return vec![];
    }
    let mut commands = vec![Command::Pipeline(prepared.pipeline), Command::Group(group)];
    for (slot, input) in (0..).zip(&prepared.program.inputs) {
        commands.push(Command::Vertices { slot, buffer: geometry.vertices(resources, draw.mesh, *input) });
    }
    commands.push(Command::Indices { buffer, format: IndexFormat::Uint32 });
    commands.extend(prepared.constant.map(Command::BlendConstant));
    commands.push(Command::DrawIndexed { indices: 0..count });
    commands
}

/// The pass over the frame's target, whose pixels come back.
fn drawing(
    frame: &Frame,
    stage: Option<Intermediate>,
    format: TextureFormat,
    commands: Vec<Command>,
    resources: &mut Resources,
) -> Submission {
    let size = [frame.target.width, frame.target.height];
    let also = TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
    let target = resources.texture(TextureResource::target(size, format, also));
    let tests_depth = frame.draws.iter().any(|draw| draw.depth.is_some());
    let depth = tests_depth.then(|| DepthAttachment {
        texture: resources.texture(TextureResource::target(size, DEPTH, TextureUsages::TEXTURE_BINDING)),
        operations: Operations { load: LoadOp::Clear(frame.clear_depth), store: StoreOp::Discard },
    });
    let [r, g, b, a] = if stage.is_some() { [0.0; 4] } else { frame.background.map(f64::from) };
    let pass = RenderPass { colors: vec![ColorAttachment::cleared(target, Color { r, g, b, a })], depth, commands };
    Submission { steps: vec![Step::Render(pass)], reads: vec![Read::Texture(target)], ..Default::default() }
}

/// Lights of a draw that stand somewhere and whose vectors are interpolated.
fn toward(frame: &Frame, called: &Called, recipe: Recipe) -> usize {
    let effects = live(called.effects, recipe.stage);
    if !recipe.technique.has_vectors() || !recipe.technique.concerns(effects) {
        return 0;
    }
    let stands = |&&light: &&usize| match frame.lights[light].place {
        Place::Directional { .. } => false,
        Place::Point { .. } => effects.has(Effect::Point),
        Place::Spot { .. } => effects.has(Effect::Spot),
    };
    called.lights.iter().filter(stands).count()
}

/// Whether some draw has use for the technique, and none is more than it can do.
fn check_technique(frame: &Frame, sets: &[Called], recipe: Recipe) -> Result<(), GpuError> {
    let technique = recipe.technique;
    let refused = |reason: String| Err(GpuError::Technique { technique: technique.name(), reason });
    if technique == Technique::Plain {
        return Ok(());
    }
    if recipe.shader == ShaderForm::Full {
        return refused("the shader with all effects is drawn plainly alone".into());
    }
    if !sets.iter().any(|called| technique.concerns(live(called.effects, recipe.stage))) {
        return refused(match technique {
            Technique::FogAtVertex => "no draw of it is in fog".into(),
            _ => "no draw of it is lit at its fragments by a light that needs the normal".into(),
        });
    }
    for (draw, called) in frame.draws.iter().zip(sets) {
        let lights = toward(frame, called, recipe);
        if lights > MOST_TOWARD {
            let name = &draw.name;
            return refused(format!(
                "{lights} lights at a point or in a cone shine on `{name}`, and {MOST_TOWARD} are interpolated at most"
            ));
        }
    }
    Ok(())
}

/// A texture of binary32 texels.
fn texels(texture: &frame::Texture) -> TextureResource {
    let contents: &[u8] = bytemuck::cast_slice(&texture.texels);
    TextureResource {
        width: texture.width,
        height: texture.height,
        format: TextureFormat::Rgba32Float,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        contents: Bytes::from(contents),
    }
}

#[cfg(test)]
mod tests;
