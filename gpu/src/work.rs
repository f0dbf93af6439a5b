//! Work for a device as plain data: what is made, what is computed or drawn, and what comes back.
//!
//! The types model the part of WebGPU that the suite uses; its states, formats and usages are those of `wgpu_types`.
//! Descriptions serialise, so whatever can do what WebGPU does can run them. They know nothing of formulas: shaders are
//! text, inputs and results are bytes.
//!
//! A description names a resource by its place in a list ([`Handle`]). [`Resources`] that outlive a submission are described
//! and made once; a [`Submission`] names them, and has resources of its own besides. JSON has no NaN and no infinity, so the
//! numbers of clear values, blend constants and pipeline constants must be finite, as WebGPU demands.

mod bytes;
mod pass;
mod resource;
#[cfg(test)]
pub(crate) mod tests;

pub use bytes::Bytes;
pub use pass::{ColorAttachment, Command, ComputePass, DepthAttachment, Read, RenderPass, Step, Write};
pub use resource::{
    BindGroup, Binding, Buffer, ComputePipeline, Contents, Pipeline, RenderPipeline, ShaderResource, TextureResource,
    VertexBuffer,
};

use serde::{Deserialize, Serialize};

/// The place of a resource among those of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Handle {
    /// Among the resources that outlive a submission.
    Kept(u32),
    /// Among the submission's own.
    Own(u32),
}

/// Resources, each kind in a list of its own. They may name each other, whatever their order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Resources {
    /// Shader modules.
    pub shaders: Vec<ShaderResource>,
    /// Compute and render pipelines.
    pub pipelines: Vec<Pipeline>,
    /// Buffers.
    pub buffers: Vec<Buffer>,
    /// Textures.
    pub textures: Vec<TextureResource>,
    /// Bind groups.
    pub groups: Vec<BindGroup>,
}

/// Work that is submitted at once.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Submission {
    /// Resources that end with the submission.
    pub own: Resources,
    /// New contents of buffers, before the first step.
    pub writes: Vec<Write>,
    /// Copies and passes, in order.
    pub steps: Vec<Step>,
    /// What comes back once the steps are done, one after the other.
    pub reads: Vec<Read>,
    /// The buffer through which it comes back, for MAP_READ and COPY_DST; one of the submission's own where none is named.
    pub through: Option<Handle>,
}

impl Resources {
    /// Adds a shader module that is kept.
    pub fn shader(&mut self, label: &str, source: String) -> Handle {
        Handle::Kept(add(&mut self.shaders, ShaderResource { label: label.into(), source }))
    }

    /// Adds a pipeline that is kept.
    pub fn pipeline(&mut self, pipeline: impl Into<Pipeline>) -> Handle {
        Handle::Kept(add(&mut self.pipelines, pipeline.into()))
    }

    /// Adds a buffer that is kept.
    pub fn buffer(&mut self, buffer: Buffer) -> Handle {
        Handle::Kept(add(&mut self.buffers, buffer))
    }

    /// Adds a texture that is kept.
    pub fn texture(&mut self, texture: TextureResource) -> Handle {
        Handle::Kept(add(&mut self.textures, texture))
    }

    /// Adds a bind group that is kept.
    pub fn group(&mut self, group: BindGroup) -> Handle {
        Handle::Kept(add(&mut self.groups, group))
    }
}

impl Submission {
    /// Adds a buffer that ends with the submission.
    pub fn buffer(&mut self, buffer: Buffer) -> Handle {
        Handle::Own(add(&mut self.own.buffers, buffer))
    }

    /// Adds a texture that ends with the submission.
    pub fn texture(&mut self, texture: TextureResource) -> Handle {
        Handle::Own(add(&mut self.own.textures, texture))
    }

    /// Adds a bind group that ends with the submission.
    pub fn group(&mut self, group: BindGroup) -> Handle {
        Handle::Own(add(&mut self.own.groups, group))
    }
}

/// Appends to a list and returns the place.
fn add<T>(list: &mut Vec<T>, item: T) -> u32 {
    list.push(item);
    u32::try_from(list.len() - 1).unwrap_or(u32::MAX)
}
