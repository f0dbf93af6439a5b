//! What a device makes: shader modules, pipelines, buffers, textures and bind groups.

use super::{Bytes, Handle};
use bytemuck::NoUninit;
use lightmeter_scene::target::SENTINEL;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use wgpu_types::{
    BindGroupLayoutEntry, BufferUsages, ColorTargetState, DepthStencilState, PrimitiveState, TextureFormat,
    TextureUsages, VertexAttribute, VertexStepMode,
};

/// A shader module.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShaderResource {
    /// The name in messages.
    pub label: String,
    /// The text in WGSL.
    pub source: String,
}

/// A pipeline.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pipeline {
    /// Of the compute stage.
    Compute(ComputePipeline),
    /// Of the vertex and fragment stages.
    Render(RenderPipeline),
}

/// A compute pipeline. Its bind group has the bindings that the shader reads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComputePipeline {
    /// The name in messages.
    pub label: String,
    /// The shader module.
    pub shader: Handle,
    /// The entry point.
    pub entry: String,
    /// Values of the module's `override` constants.
    pub constants: BTreeMap<String, f64>,
}

/// A render pipeline of one sample a pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RenderPipeline {
    /// The name in messages.
    pub label: String,
    /// The shader module of both entry points.
    pub shader: Handle,
    /// The bindings of its bind group; those that the shader reads where none are given.
    pub layout: Option<Vec<BindGroupLayoutEntry>>,
    /// The vertex entry point.
    pub vertex: String,
    /// The vertex buffers, by slot.
    pub buffers: Vec<VertexBuffer>,
    /// Topology and culling.
    pub primitive: PrimitiveState,
    /// The depth test.
    pub depth: Option<DepthStencilState>,
    /// The fragment entry point.
    pub fragment: String,
    /// Formats, blend states and write masks of the colour targets, by location.
    pub targets: Vec<ColorTargetState>,
}

/// How a vertex buffer is read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct VertexBuffer {
    /// Bytes from a vertex or an instance to the next.
    pub stride: u64,
    /// Whether it holds vertices or instances.
    pub step: VertexStepMode,
    /// What it holds.
    pub attributes: Vec<VertexAttribute>,
}

/// A buffer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Buffer {
    /// What it is for, besides being filled with its contents.
    pub usage: BufferUsages,
    /// What it holds at first.
    pub contents: Contents,
}

/// What a buffer holds at first.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Contents {
    /// These bytes. The buffer is as long, but has at least [`Buffer::BYTES_LEAST`] bytes.
    Bytes(Bytes),
    /// The same word over and over. The buffer is as long, but has at least [`Buffer::BYTES_LEAST`] bytes.
    Repeated {
        /// The word.
        word: u32,
        /// How many words.
        count: usize,
    },
    /// Nothing that is read.
    Unwritten {
        /// The buffer's length.
        bytes: usize,
    },
}

/// A texture of two dimensions with one level and one sample.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TextureResource {
    /// Pixels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The format.
    pub format: TextureFormat,
    /// What it is for.
    pub usage: TextureUsages,
    /// What the first pixels hold, row after row without gaps; the last row may end early. Empty of a texture that nothing
    /// is written to beforehand.
    pub contents: Bytes,
}

/// Bind group 0 of a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BindGroup {
    /// The pipeline whose bindings these are.
    pub pipeline: Handle,
    /// What is bound, by number.
    pub bindings: BTreeMap<u32, Binding>,
}

/// What is bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Binding {
    /// A whole buffer.
    Buffer(Handle),
    /// A part of a buffer.
    Part {
        /// The buffer.
        buffer: Handle,
        /// Where it begins; a multiple of 256 is legal everywhere.
        offset: u64,
        /// Its bytes.
        bytes: u64,
    },
    /// A texture.
    Texture(Handle),
}

impl From<ComputePipeline> for Pipeline {
    fn from(pipeline: ComputePipeline) -> Self {
        Self::Compute(pipeline)
    }
}

impl From<RenderPipeline> for Pipeline {
    fn from(pipeline: RenderPipeline) -> Self {
        Self::Render(pipeline)
    }
}

impl ComputePipeline {
    /// An entry point without constants.
    #[must_use]
    pub fn new(label: &str, shader: Handle, entry: &str) -> Self {
        Self { label: label.into(), shader, entry: entry.into(), constants: BTreeMap::new() }
    }
}

impl RenderPipeline {
    /// A vertex and a fragment entry point that draw triangles from no buffer, with no depth test.
    #[must_use]
    pub fn new(
        label: &str,
        shader: Handle,
        (vertex, fragment): (&str, &str),
        targets: impl IntoIterator<Item = ColorTargetState>,
    ) -> Self {
        Self {
            label: label.into(),
            shader,
            layout: None,
            vertex: vertex.into(),
            buffers: vec![],
            primitive: PrimitiveState::default(),
            depth: None,
            fragment: fragment.into(),
            targets: targets.into_iter().collect(),
        }
    }
}

impl RenderPipeline {
    /// The entry points that are written around a kernel: a triangle over all pixels.
    pub(crate) fn of_kernel(label: &str, shader: Handle, targets: impl IntoIterator<Item = ColorTargetState>) -> Self {
        Self::new(label, shader, ("lightmeter_vertex", "lightmeter_fragment"), targets)
    }
}

impl Buffer {
    /// The length of a buffer with fewer contents.
    pub const BYTES_LEAST: usize = 16;

    /// A buffer that holds these values.
    #[must_use]
    pub fn of<T: NoUninit>(values: &[T], usage: BufferUsages) -> Self {
        let bytes: &[u8] = bytemuck::cast_slice(values);
        Self { usage, contents: Contents::Bytes(bytes.into()) }
    }

    /// A buffer of sentinels, which results are written over.
    #[must_use]
    pub const fn sentinels(count: usize, usage: BufferUsages) -> Self {
        Self { usage, contents: Contents::Repeated { word: SENTINEL, count } }
    }

    /// A buffer that holds nothing yet.
    #[must_use]
    pub const fn unwritten(bytes: usize, usage: BufferUsages) -> Self {
        Self { usage, contents: Contents::Unwritten { bytes } }
    }
}

impl TextureResource {
    /// A texture that is drawn to, and for what else.
    #[must_use]
    pub fn target([width, height]: [u32; 2], format: TextureFormat, also: TextureUsages) -> Self {
        Self { width, height, format, usage: TextureUsages::RENDER_ATTACHMENT | also, contents: Bytes::default() }
    }
}

impl BindGroup {
    /// Buffers as bindings 0, 1, …
    #[must_use]
    pub fn of_buffers(pipeline: Handle, buffers: &[Handle]) -> Self {
        Self { pipeline, bindings: (0..).zip(buffers.iter().map(|buffer| Binding::Buffer(*buffer))).collect() }
    }

    /// Textures, by their numbers.
    #[must_use]
    pub fn of_textures(pipeline: Handle, textures: &[(u32, Handle)]) -> Self {
        let bindings = textures.iter().map(|(number, texture)| (*number, Binding::Texture(*texture)));
        Self { pipeline, bindings: bindings.collect() }
    }
}
