//! What can go wrong on the GPU's side.

use std::path::PathBuf;

/// An error of the GPU's side: of a shader, of an adapter, or of the device.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// A shader does not parse or does not validate.
    #[error("invalid shader {file}:\n{message}")]
    Shader {
        /// The file's name.
        file: String,
        /// naga's message, with the line.
        message: String,
    },
    /// A shader lacks a function that a formula is evaluated by.
    #[error("shader {file} has no function `{function}`, which the suite evaluates by that name")]
    MissingFunction {
        /// The file's name.
        file: String,
        /// The function's name.
        function: String,
    },
    /// A function's signature has a type that cannot be read from a row of numbers.
    #[error(
        "function `{function}` in {file} has a parameter or result of a type other than f32, u32, vectors, matrices and structs of them: {found}"
    )]
    Signature {
        /// The file's name.
        file: String,
        /// The function's name.
        function: String,
        /// The type.
        found: String,
    },
    /// A folder of shaders cannot be read.
    #[error("cannot read shaders from {}: {message}", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// The system's message, or what was expected.
        message: String,
    },
    /// An adapter gave no device.
    #[error("adapter {adapter} gave no device: {message}")]
    Open {
        /// The adapter's name.
        adapter: String,
        /// wgpu's message.
        message: String,
    },
    /// A draw of a frame cannot be drawn.
    #[error("draw `{draw}` cannot be drawn: {message}")]
    Draw {
        /// What the draw is called.
        draw: String,
        /// Why, and what would be right.
        message: String,
    },
    /// A frame has no use for a technique, or more than it can do.
    #[error("the technique {technique} cannot draw the frame: {reason}")]
    Technique {
        /// The technique's name.
        technique: &'static str,
        /// What the frame has or lacks.
        reason: String,
    },
    /// The effects given do not belong to the frame.
    #[error("a frame of {draws} draws needs the effects of each, and {sets} sets were given")]
    Sets {
        /// Draws of the frame.
        draws: usize,
        /// Sets that were given.
        sets: usize,
    },
    /// Something is unavailable in the arithmetic that was asked for.
    #[error("{what} is unavailable: {reason}")]
    Unavailable {
        /// What was asked for.
        what: String,
        /// Why it is not to be had.
        reason: String,
    },
    /// The device does not answer.
    #[error("the device failed: no answer within {0} s; does a shader loop?")]
    Timeout(u64),
    /// The device was lost or reported an error.
    #[error("the device failed: {0}")]
    Device(String),
}
