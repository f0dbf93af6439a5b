//! What a submission does: copies, passes and read-backs.

use super::{Bytes, Handle};
use lightmeter_scene::target::SENTINEL;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use wgpu_types::{Color, IndexFormat, LoadOp, Operations, StoreOp};

/// New contents of a buffer, from its start on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Write {
    /// The buffer, for COPY_DST.
    pub buffer: Handle,
    /// The contents.
    pub contents: Bytes,
}

/// A step of a submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// Copies the first bytes of a buffer into another.
    Copy {
        /// The buffer that is read.
        from: Handle,
        /// The buffer that is written.
        to: Handle,
        /// How many bytes.
        bytes: usize,
    },
    /// A compute pass.
    Compute(ComputePass),
    /// A render pass.
    Render(RenderPass),
}

/// A compute pass of one dispatch.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ComputePass {
    /// The compute pipeline.
    pub pipeline: Handle,
    /// Bind group 0.
    pub group: Handle,
    /// Workgroups in x, y and z.
    pub workgroups: [u32; 3],
}

/// A render pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RenderPass {
    /// What is drawn to, by location.
    pub colors: Vec<ColorAttachment>,
    /// The depth that is tested and written.
    pub depth: Option<DepthAttachment>,
    /// What is set and drawn, in order.
    pub commands: Vec<Command>,
}

/// A colour target of a pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ColorAttachment {
    /// The texture.
    pub texture: Handle,
    /// What becomes of it before and after the pass.
    pub operations: Operations<Color>,
}

/// The depth target of a pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DepthAttachment {
    /// The texture.
    pub texture: Handle,
    /// What becomes of it before and after the pass.
    pub operations: Operations<f32>,
}

/// A command of a render pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Command {
    /// The render pipeline of the following draws.
    Pipeline(Handle),
    /// Bind group 0 of the following draws.
    Group(Handle),
    /// A vertex buffer of the following draws.
    Vertices {
        /// Its place among the pipeline's vertex buffers.
        slot: u32,
        /// The buffer, for VERTEX.
        buffer: Handle,
    },
    /// The index buffer of the following draws.
    Indices {
        /// The buffer, for INDEX.
        buffer: Handle,
        /// What an index is.
        format: IndexFormat,
    },
    /// The blend constant of the following draws.
    BlendConstant(Color),
    /// The pixels that the following draws may touch: x, y, width and height.
    Scissor([u32; 4]),
    /// Draws vertices.
    Draw {
        /// The vertices.
        vertices: Range<u32>,
        /// The instances.
        instances: Range<u32>,
    },
    /// Draws vertices by their indices, once.
    DrawIndexed {
        /// The places in the index buffer.
        indices: Range<u32>,
    },
}

/// What comes back of a submission.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Read {
    /// The first bytes of a buffer, a multiple of 4.
    Buffer {
        /// The buffer, for COPY_SRC.
        buffer: Handle,
        /// How many bytes.
        bytes: usize,
    },
    /// All pixels of a texture for COPY_SRC, the top row first, rows without gaps.
    Texture(Handle),
}

impl RenderPass {
    /// A pass that draws a triangle over all pixels of targets of integers, which hold the sentinel before.
    #[must_use]
    pub fn screen(pipeline: Handle, group: Handle, targets: &[Handle]) -> Self {
        Self {
            colors: targets.iter().map(|target| ColorAttachment::sentinel(*target)).collect(),
            depth: None,
            commands: vec![
                Command::Pipeline(pipeline),
                Command::Group(group),
                Command::Draw { vertices: 0..3, instances: 0..1 },
            ],
        }
    }
}

impl ColorAttachment {
    /// A target that holds a colour before.
    #[must_use]
    pub const fn cleared(texture: Handle, color: Color) -> Self {
        Self { texture, operations: Operations { load: LoadOp::Clear(color), store: StoreOp::Store } }
    }

    /// A target of integers that holds the sentinel before.
    #[must_use]
    pub fn sentinel(texture: Handle) -> Self {
        let word = f64::from(SENTINEL);
        Self::cleared(texture, Color { r: word, g: word, b: word, a: word })
    }

    /// A target that is drawn over.
    #[must_use]
    pub const fn loaded(texture: Handle) -> Self {
        Self { texture, operations: Operations { load: LoadOp::Load, store: StoreOp::Store } }
    }
}

impl DepthAttachment {
    /// A depth that no case writes exactly: it tells an unwritten pixel.
    const UNWRITTEN: f32 = 0.314_159_3;

    /// A target that holds before what no case writes.
    #[must_use]
    pub const fn unwritten(texture: Handle) -> Self {
        Self { texture, operations: Operations { load: LoadOp::Clear(Self::UNWRITTEN), store: StoreOp::Store } }
    }
}
