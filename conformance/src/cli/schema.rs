//! `lightmeter schema`.

use super::{Status, emit};
use clap::{Args, ValueEnum};
use lightmeter_scene::model::Scene;
use std::path::PathBuf;

/// Print the JSON Schema of a file that lightmeter reads.
#[derive(Debug, Args)]
pub(crate) struct Schema {
    /// Of what
    of: Of,
    /// Write the schema to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Of {
    /// A scene
    Scene,
}

impl Schema {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let schema = match self.of {
            Of::Scene => schemars::schema_for!(Scene),
        };
        emit(&(serde_json::to_string_pretty(&schema)? + "\n"), self.out.as_deref())?;
        Ok(Status::Success)
    }
}
