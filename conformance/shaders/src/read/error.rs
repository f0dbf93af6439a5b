//! Why a shader is not read.

use std::path::PathBuf;

/// Why a shader is not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShaderError {
    /// It cannot be read as a file.
    #[error("cannot read {}: {message}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// Its language is not one that is read.
    #[error("{}: {message}", .path.display())]
    Language {
        /// The file.
        path: PathBuf,
        /// What would do.
        message: String,
    },
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
}
