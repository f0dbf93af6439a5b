//! Why a renderer could not be asked.

use super::pack;
use lightmeter_catalogue::filter::FilterError;
use lightmeter_scene::target::TargetFormat;
use std::path::PathBuf;

/// Why a renderer could not be asked at all.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProcessError {
    /// The command cannot be started, or says nothing that can be read.
    #[error("`{command}` {message}")]
    Start {
        /// The command.
        command: String,
        /// What it does in the place of its hello.
        message: String,
    },
    /// What it declares cannot be read.
    #[error("the renderer's hello: {0}")]
    Hello(FilterError),
    /// It declares what there is not.
    #[error("the renderer's hello: `{glob}` matches no {what}{meant} `lightmeter list` lists them all")]
    Unmatched {
        /// The glob.
        glob: String,
        /// What it should match: `formula`, `scene`.
        what: &'static str,
        /// The names that are nearest to it, as the end of a sentence.
        meant: String,
    },
    /// It excludes by what there is not.
    #[error("the renderer's hello: `{entry}` of `excludes` names no {what}{known}")]
    Excludes {
        /// The entry.
        entry: String,
        /// What it should name: `shape`, `effect`.
        what: &'static str,
        /// What there is, as the end of a sentence.
        known: String,
    },
    /// It declares that it skips what must not be left out.
    #[error("the renderer's hello: skips `{id}`: it {why}")]
    Skip {
        /// The glob.
        id: String,
        /// Why that is refused.
        why: String,
    },
    /// It says of its code's place what cannot be.
    #[error("the renderer's hello: in `sources` of `{id}` {why}")]
    Source {
        /// The glob.
        id: String,
        /// What is wrong, and what would be right.
        why: &'static str,
    },
    /// It asks for accuracy rules that are unknown.
    #[error("the renderer's hello: no profile `{0}`; expected {profiles}", profiles = lightmeter_arithmetic::profile::PROFILES.map(|profile| profile.name).join(", "))]
    Profile(String),
    /// It declares a target that is unknown.
    #[error("the renderer's hello: no target `{0}`; expected {formats}", formats = TargetFormat::ALL.map(TargetFormat::name).join(", "))]
    Target(String),
    /// A scene is refused, which a test rules out.
    #[error(transparent)]
    Scene(#[from] lightmeter_catalogue::scene::SceneError),
    /// A pack's or a scene's file cannot be written.
    #[error(transparent)]
    Pack(#[from] pack::PackError),
    /// A folder for images cannot be made.
    #[error("cannot write {}: {message}", .path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why.
        message: String,
    },
}

// The message has the whole of it, so that it is no source besides, which would be told once more.
impl From<FilterError> for ProcessError {
    fn from(error: FilterError) -> Self {
        Self::Hello(error)
    }
}

/// Why a pack was not written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PackError {
    /// A file cannot be written.
    #[error("cannot write {}: {message}", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {message}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// It is no pack, or another's.
    #[error("{}: {message}", .path.display())]
    Manifest {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and what would be right.
        message: String,
    },
    /// A scene is refused, or a glob.
    #[error("{0}")]
    Plan(String),
}
