//! What a file is read with.

use std::path::PathBuf;

/// What a file is read with.
#[derive(Clone, Debug, Default)]
pub struct ReadOptions {
    /// Folders of included files.
    pub include: Vec<PathBuf>,
    /// Macros, and what they stand for.
    pub defines: Vec<(String, String)>,
}
