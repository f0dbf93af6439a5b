//! Frames drawn on a device: each draw by the shader that is composed from its effects.
//!
//! A draw's bindings, vertex inputs and varyings are those that its shader has, so what no effect calls for is neither
//! uploaded nor bound. Draws that differ in numbers alone share a pipeline.

mod geometry;
mod pipeline;
mod uniforms;

use crate::compose::{Composer, Intermediate, MOST_TOWARD, Recipe, ShaderForm, Technique, live};
use crate::depth_unit::DEPTH;
use crate::device::readback::{Pending, staging};
use crate::device::{Clock, ClockReading};
use crate::device::{Gpu, format};
use crate::error::GpuError;
use crate::shaders::Shaders;
use geometry::Geometry;
use lightmeter_scene::effects::{Called, Effect, Effects};
use lightmeter_scene::frame::{Frame, Place, Texture};
use lightmeter_scene::target::TargetFormat;
use pipeline::{Key, Pipelines};
use uniforms::{Packer, Resource, resource};

/// A frame on a device, ready to be drawn: pipelines, buffers and textures.
#[derive(Debug)]
pub struct SceneRenderer {
    draws: Vec<PreparedDraw>,
    target: wgpu::Texture,
    /// Where some draw has a depth test.
    depth: Option<wgpu::TextureView>,
    background: wgpu::Color,
    clear_depth: f32,
    pixel_bytes: u32,
}

/// A draw, ready.
#[derive(Debug)]
struct PreparedDraw {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    vertices: Vec<wgpu::Buffer>,
    indices: wgpu::Buffer,
    index_count: u32,
    constant: Option<wgpu::Color>,
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
        let stage = recipe.stage;
        if sets.len() != frame.draws.len() {
            return Err(GpuError::Sets { draws: frame.draws.len(), sets: sets.len() });
        }
        if let Some(reason) = recipe.rung.lacks(gpu) {
            return Err(GpuError::Unavailable { what: recipe.rung.name().into(), reason: reason.into() });
        }
        check_technique(frame, sets, recipe)?;
        let composer = Composer::new(shaders)?;
        let target = if stage.is_some() { TargetFormat::Rgba32Float } else { frame.target.format };
        let tests_depth = frame.draws.iter().any(|draw| draw.depth.is_some());
        let mut pipelines = Pipelines::new(gpu, composer, recipe, format(target), tests_depth);
        let mut packer = Packer::new(gpu);
        let mut prepared = vec![];
        for (draw, called) in frame.draws.iter().zip(sets) {
            let blended = draw.blend.filter(|_| stage.is_none());
            let blend = blended.map(|blend| pipeline::native(draw, blend)).transpose()?;
            let key = Key {
                effects: called.effects,
                blend: blend.map(|(state, _)| state),
                depth: draw.depth,
                cull: draw.cull,
                toward: toward(frame, called, recipe),
            };
            let (pipeline, program) = pipelines.get(key)?;
            let told = uniforms::Told { frame, draw, called, effects: program.effects(called.effects), stage };
            let resources: Vec<(u32, Resource)> = program
                .bindings
                .iter()
                .map(|(binding, name)| Ok((*binding, resource(&told, name, &mut packer)?)))
                .collect::<Result<_, GpuError>>()?;
            prepared.push((pipeline, program, resources, blend.map(|(_, constant)| constant)));
        }
        let uniforms = packer.finish(gpu);
        let textures: Vec<wgpu::TextureView> = frame.textures.iter().map(|texture| upload(gpu, texture)).collect();
        let none = upload(gpu, &Texture { width: 1, height: 1, texels: vec![[1.0; 4]] });
        let mut geometry = Geometry::new(gpu, frame);
        let mut draws = vec![];
        for (draw, (pipeline, program, resources, constant)) in frame.draws.iter().zip(prepared) {
            let group = bind(gpu, &pipeline, &resources, (&uniforms, &textures, &none));
            let (indices, index_count) = geometry.indices(draw);
            let vertices = program.inputs.iter().map(|input| geometry.vertices(draw.mesh, *input)).collect();
            draws.push(PreparedDraw { pipeline, group, vertices, indices, index_count, constant });
        }
        let (width, height) = (frame.target.width, frame.target.height);
        let depth = tests_depth.then(|| gpu.target(width, height, DEPTH).create_view(&Default::default()));
        let [r, g, b, a] = if stage.is_some() { [0.0; 4] } else { frame.background.map(f64::from) };
        let renderer = Self {
            draws,
            target: gpu.blend_target(width, height, format(target)),
            depth,
            background: wgpu::Color { r, g, b, a },
            clear_depth: frame.clear_depth,
            pixel_bytes: u32::try_from(4 * target.component_bytes()).unwrap_or(u32::MAX),
        };
        gpu.check_shader("scene.wgsl")?;
        Ok(renderer)
    }

    /// Draws the frame and asks for its pixels.
    #[must_use]
    pub fn submit(&self, gpu: &Gpu) -> Pending {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.encode(&mut encoder, None);
        let size = self.target.size();
        let row_bytes = self.pixel_bytes * size.width;
        let padded = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let staging = staging(gpu, padded as usize / 4 * size.height as usize);
        encoder.copy_texture_to_buffer(
            self.target.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &staging,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None },
            },
            size,
        );
        Pending::submit(gpu, encoder, staging, (padded as usize / 4, row_bytes as usize / 4))
    }

    /// The pixels of a submission in the target's own bits, the top row first, rows without gaps.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub fn pixels(gpu: &Gpu, pending: Pending) -> Result<Vec<u8>, GpuError> {
        Ok(bytemuck::cast_slice(&pending.wait(gpu)?).to_vec())
    }

    /// How long it takes to draw the frame so many times in one submission. A driver compiles at the first draw: draw once
    /// before.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    pub fn time(&self, gpu: &Gpu, clock: &Clock, repeats: u32) -> Result<ClockReading, GpuError> {
        clock.time(gpu, |encoder, span| {
            for k in 0..repeats {
                self.encode(encoder, span.part(k == 0, k + 1 == repeats).render());
            }
        })
    }

    fn encode(&self, encoder: &mut wgpu::CommandEncoder, timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>) {
        let view = self.target.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(self.background), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: self.depth.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(self.clear_depth),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: timestamps,
            ..Default::default()
        });
        for draw in self.draws.iter().filter(|draw| draw.index_count > 0) {
            pass.set_pipeline(&draw.pipeline);
            pass.set_bind_group(0, &draw.group, &[]);
            for (slot, buffer) in (0..).zip(&draw.vertices) {
                pass.set_vertex_buffer(slot, buffer.slice(..));
            }
            pass.set_index_buffer(draw.indices.slice(..), wgpu::IndexFormat::Uint32);
            if let Some(constant) = draw.constant {
                pass.set_blend_constant(constant);
            }
            pass.draw_indexed(0..draw.index_count, 0, 0..1);
        }
    }
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
fn upload(gpu: &Gpu, texture: &Texture) -> wgpu::TextureView {
    let made = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: texture.width, height: texture.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    gpu.upload(&made, bytemuck::cast_slice(&texture.texels), 16);
    made.create_view(&Default::default())
}

/// What a draw's shader has bindings for.
fn bind(
    gpu: &Gpu,
    pipeline: &wgpu::RenderPipeline,
    resources: &[(u32, Resource)],
    (uniforms, textures, none): (&wgpu::Buffer, &[wgpu::TextureView], &wgpu::TextureView),
) -> wgpu::BindGroup {
    let entries: Vec<wgpu::BindGroupEntry<'_>> = resources
        .iter()
        .map(|(binding, resource)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: match resource {
                Resource::Uniform { offset, size } => wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: uniforms,
                    offset: *offset,
                    size: wgpu::BufferSize::new(*size),
                }),
                Resource::Texture(place) => {
                    wgpu::BindingResource::TextureView(place.map_or(none, |place| &textures[place]))
                }
            },
        })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    })
}

#[cfg(test)]
mod tests;
