//! wgpu's objects, made of descriptions.

use super::native::Native;
use crate::work::{
    BindGroup, Binding, Buffer, ComputePipeline, Contents, Handle, Pipeline, RenderPipeline, Resources, ShaderResource,
    TextureResource,
};

/// What was made of [`Resources`]: each object at the place of its description.
#[derive(Debug, Default)]
pub(super) struct Objects {
    shaders: Vec<wgpu::ShaderModule>,
    pipelines: Vec<PipelineObject>,
    buffers: Vec<wgpu::Buffer>,
    textures: Vec<TextureObject>,
    groups: Vec<wgpu::BindGroup>,
}

#[derive(Debug)]
enum PipelineObject {
    Compute(wgpu::ComputePipeline),
    Render(wgpu::RenderPipeline),
}

/// A texture and the view of all of it.
#[derive(Debug)]
pub(super) struct TextureObject {
    pub(super) texture: wgpu::Texture,
    pub(super) view: wgpu::TextureView,
}

/// The objects that handles name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scope<'a> {
    kept: &'a Objects,
    own: &'a Objects,
}

impl Objects {
    /// Makes the shaders and pipelines that are not made yet. `kept` are the objects that outlive these; none do where
    /// these are the ones.
    pub(super) fn compile(&mut self, native: &Native, resources: &Resources, kept: Option<&Self>) {
        let described = &resources.shaders[self.shaders.len()..];
        self.shaders.extend(described.iter().map(|described| shader(native, described)));
        let described = &resources.pipelines[self.pipelines.len()..];
        let made: Vec<_> = described.iter().map(|described| pipeline(native, self.scope(kept), described)).collect();
        self.pipelines.extend(made);
    }

    /// The same with buffers, textures and bind groups.
    pub(super) fn fill(&mut self, native: &Native, resources: &Resources, kept: Option<&Self>) {
        let described = &resources.buffers[self.buffers.len()..];
        self.buffers.extend(described.iter().map(|described| buffer(native, described)));
        let described = &resources.textures[self.textures.len()..];
        self.textures.extend(described.iter().map(|described| texture(native, described)));
        let described = &resources.groups[self.groups.len()..];
        let made: Vec<_> = described.iter().map(|described| group(native, self.scope(kept), described)).collect();
        self.groups.extend(made);
    }

    pub(super) fn forget_pipelines(&mut self) {
        self.pipelines.clear();
    }

    /// What handles name in a description of these objects.
    pub(super) fn scope<'a>(&'a self, kept: Option<&'a Self>) -> Scope<'a> {
        Scope { kept: kept.unwrap_or(self), own: self }
    }
}

impl<'a> Scope<'a> {
    fn shader(self, handle: Handle) -> &'a wgpu::ShaderModule {
        self.named(handle, |objects| &objects.shaders)
    }

    pub(super) fn compute_pipeline(self, handle: Handle) -> &'a wgpu::ComputePipeline {
        match self.named(handle, |objects| &objects.pipelines) {
            PipelineObject::Compute(pipeline) => pipeline,
            PipelineObject::Render(_) => panic!("{handle:?} is a render pipeline, and a compute pipeline is needed"),
        }
    }

    pub(super) fn render_pipeline(self, handle: Handle) -> &'a wgpu::RenderPipeline {
        match self.named(handle, |objects| &objects.pipelines) {
            PipelineObject::Render(pipeline) => pipeline,
            PipelineObject::Compute(_) => panic!("{handle:?} is a compute pipeline, and a render pipeline is needed"),
        }
    }

    pub(super) fn buffer(self, handle: Handle) -> &'a wgpu::Buffer {
        self.named(handle, |objects| &objects.buffers)
    }

    pub(super) fn texture(self, handle: Handle) -> &'a TextureObject {
        self.named(handle, |objects| &objects.textures)
    }

    pub(super) fn group(self, handle: Handle) -> &'a wgpu::BindGroup {
        self.named(handle, |objects| &objects.groups)
    }

    fn named<T>(self, handle: Handle, list: impl Fn(&'a Objects) -> &'a [T]) -> &'a T {
        let (objects, place) = match handle {
            Handle::Kept(place) => (self.kept, place),
            Handle::Own(place) => (self.own, place),
        };
        list(objects)
            .get(place as usize)
            .unwrap_or_else(|| panic!("no resource of its kind is described as {handle:?}"))
    }
}

fn shader(native: &Native, shader: &ShaderResource) -> wgpu::ShaderModule {
    native.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(&shader.label),
        source: wgpu::ShaderSource::Wgsl(shader.source.as_str().into()),
    })
}

fn pipeline(native: &Native, scope: Scope<'_>, pipeline: &Pipeline) -> PipelineObject {
    match pipeline {
        Pipeline::Compute(pipeline) => PipelineObject::Compute(compute_pipeline(native, scope, pipeline)),
        Pipeline::Render(pipeline) => PipelineObject::Render(render_pipeline(native, scope, pipeline)),
    }
}

fn compute_pipeline(native: &Native, scope: Scope<'_>, pipeline: &ComputePipeline) -> wgpu::ComputePipeline {
    let constants: Vec<(&str, f64)> = pipeline.constants.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    native.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(&pipeline.label),
        layout: None,
        module: scope.shader(pipeline.shader),
        entry_point: Some(&pipeline.entry),
        compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
        cache: None,
    })
}

fn render_pipeline(native: &Native, scope: Scope<'_>, pipeline: &RenderPipeline) -> wgpu::RenderPipeline {
    let module = scope.shader(pipeline.shader);
    let layout = pipeline.layout.as_ref().map(|entries| {
        let group = native.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries });
        native.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(&group)],
            ..Default::default()
        })
    });
    let buffers: Vec<_> = pipeline
        .buffers
        .iter()
        .map(|buffer| {
            Some(wgpu::VertexBufferLayout {
                array_stride: buffer.stride,
                step_mode: buffer.step,
                attributes: &buffer.attributes,
            })
        })
        .collect();
    let targets: Vec<_> = pipeline.targets.iter().cloned().map(Some).collect();
    native.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(&pipeline.label),
        layout: layout.as_ref(),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(&pipeline.vertex),
            compilation_options: Default::default(),
            buffers: &buffers,
        },
        primitive: pipeline.primitive,
        depth_stencil: pipeline.depth.clone(),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(&pipeline.fragment),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn buffer(native: &Native, buffer: &Buffer) -> wgpu::Buffer {
    let create = |size: usize, usage: wgpu::BufferUsages| {
        let size = size as u64;
        native.device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    };
    let filled = |bytes: &[u8]| {
        let made = create(bytes.len().max(Buffer::BYTES_LEAST), buffer.usage | wgpu::BufferUsages::COPY_DST);
        native.queue.write_buffer(&made, 0, bytes);
        made
    };
    match &buffer.contents {
        Contents::Bytes(bytes) => filled(&bytes.0),
        Contents::Repeated { word, count } => filled(bytemuck::cast_slice(&vec![*word; *count])),
        Contents::Unwritten { bytes } => create(*bytes, buffer.usage),
    }
}

fn texture(native: &Native, described: &TextureResource) -> TextureObject {
    let texture = native.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: described.width, height: described.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: described.format,
        usage: described.usage,
        view_formats: &[],
    });
    upload(native, &texture, &described.contents.0);
    TextureObject { view: texture.create_view(&Default::default()), texture }
}

/// Fills a texture's first pixels, row after row.
fn upload(native: &Native, texture: &wgpu::Texture, bytes: &[u8]) {
    let pixel_bytes = pixel_bytes(texture);
    let (width, mut y) = (texture.width(), 0);
    let row_bytes = pixel_bytes * width as usize;
    let whole = bytes.len() / row_bytes * row_bytes;
    for part in [&bytes[..whole], &bytes[whole..]].into_iter().filter(|part| !part.is_empty()) {
        let rows = u32::try_from(part.len().div_ceil(row_bytes)).unwrap_or(u32::MAX);
        let columns = u32::try_from(part.len().min(row_bytes) / pixel_bytes).unwrap_or(u32::MAX);
        let mut place = texture.as_image_copy();
        place.origin.y = y;
        let bytes_per_row = u32::try_from(row_bytes).ok();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
        let size = wgpu::Extent3d { width: columns, height: rows, depth_or_array_layers: 1 };
        native.queue.write_texture(place, part, layout, size);
        y += rows;
    }
}

/// Bytes of a pixel of a texture of one aspect; 4 of another, which is not copied.
pub(super) fn pixel_bytes(texture: &wgpu::Texture) -> usize {
    bytes_of_pixel(texture.format())
}

/// Bytes of a pixel of a format of one aspect; 4 of another, which is not copied.
pub(super) fn bytes_of_pixel(format: wgpu::TextureFormat) -> usize {
    format.block_copy_size(None).map_or(4, |bytes| bytes as usize)
}

fn group(native: &Native, scope: Scope<'_>, group: &BindGroup) -> wgpu::BindGroup {
    let layout = match scope.named(group.pipeline, |objects| &objects.pipelines) {
        PipelineObject::Compute(pipeline) => pipeline.get_bind_group_layout(0),
        PipelineObject::Render(pipeline) => pipeline.get_bind_group_layout(0),
    };
    let resource = |binding: &Binding| match *binding {
        Binding::Buffer(buffer) => scope.buffer(buffer).as_entire_binding(),
        Binding::Part { buffer, offset, bytes } => wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: scope.buffer(buffer),
            offset,
            size: wgpu::BufferSize::new(bytes),
        }),
        Binding::Texture(texture) => wgpu::BindingResource::TextureView(&scope.texture(texture).view),
    };
    let entries: Vec<_> = group
        .bindings
        .iter()
        .map(|(number, binding)| wgpu::BindGroupEntry { binding: *number, resource: resource(binding) })
        .collect();
    native.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries })
}
