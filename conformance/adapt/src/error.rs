//! What can be wrong with a shader, or with how it is bound.

use lightmeter_shaders::read::ShaderError;
use std::path::PathBuf;

/// Why a shader cannot be made a formula's function.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AdaptError {
    /// It is not read.
    #[error(transparent)]
    Read(#[from] ShaderError),
    /// It is not valid in its language, or uses what is not read.
    #[error("{}{}: {message}", .path.display(), .line.map(|line| format!(":{line}")).unwrap_or_default())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// The line, from 1, where it is known.
        line: Option<usize>,
        /// What is wrong, and what would be right.
        message: String,
    },
    /// Something has no binding, has two, or is bound to what does not fit.
    #[error("{0}")]
    Bind(String),
    /// Variables of it are nothing that the formula has.
    #[error("{message}")]
    Unknown {
        /// How many.
        variables: usize,
        /// Which, and what the formula has.
        message: String,
    },
    /// What a variable is said to mean is no expression over the formula's inputs.
    #[error("{0}")]
    Expression(String),
}
