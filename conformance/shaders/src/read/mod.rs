//! Reads shaders: GLSL of any version, WGSL, SPIR-V, HLSL.
//!
//! naga reads. GLSL is first brought into the one that naga knows (`glsl`). [`ShaderSource`] takes a file as it is, for a formula's
//! function; [`readings`] takes a file as people have it, where macros, included files and declarations may be elsewhere.

mod compiler;
mod complete;
mod error;
mod glsl;
mod hlsl;
mod hosts;
mod lines;
mod macros;
mod missing;
mod options;
mod source;
mod spirv;
mod wgsl;

pub use complete::{ShaderReading, readings};
pub use error::ShaderError;
pub use glsl::{Role, shown};
pub use options::ReadOptions;
pub use source::{Language, ShaderSource, is_shader};
