//! `lightmeter schema`.

use super::{Status, emit};
use clap::{Args, ValueEnum};
use lightmeter::document::adapters::AdaptersDocument;
use lightmeter::document::bench::BenchDocument;
use lightmeter::document::bench::recommendation::Recommendation;
use lightmeter::document::effects::EffectsDocument;
use lightmeter::document::frame::FrameDocument;
use lightmeter::document::gate::GateReport;
use lightmeter::document::identify::IdentifyDocument;
use lightmeter::document::list::{CasesDocument, FormulasDocument};
use lightmeter::document::mistakes::MistakesDocument;
use lightmeter::document::pack::Manifest;
use lightmeter::document::run::Report;
use lightmeter::document::selftest::SelftestDocument;
use lightmeter::document::show::ShowDocument;
use lightmeter::document::special::SpecialReport;
use lightmeter::document::special::record::SpecialRecord;
use lightmeter::document::sweep::SweepDocument;
use lightmeter::document::sweep::presets::PresetsDocument;
use lightmeter::document::{Document as _, eval, protocol};
use lightmeter_scene::model::Scene;
use std::path::PathBuf;

/// Print the JSON Schema of a file that lightmeter reads or writes.
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
    /// The JSON of `run`
    Run,
    /// The JSON of `special`
    Special,
    /// The JSON of `gate`
    Gate,
    /// The manifest that `pack` writes
    Pack,
    /// A line that a renderer reads, of `gate --exec` or of a pack
    Protocol,
    /// The file of a scene, by which a renderer draws it
    Frame,
    /// The JSON of `sweep` and `merge`
    Sweep,
    /// The JSON of `bench`
    Bench,
    /// The JSON of `selftest`
    Selftest,
    /// The JSON of `list`
    Cases,
    /// The JSON of `list --formulas`
    Formulas,
    /// The JSON of `mistakes`
    Identify,
    Mistakes,
    /// The JSON of `show`
    Show,
    /// The JSON of `adapters`
    Adapters,
    /// The JSON of `effects`
    Effects,
    /// A line that `eval` reads or writes
    Eval,
    /// The JSON of `sweep` without a formula, the list of ready-made sweeps
    Presets,
    /// The JSON of `bench --recommend`
    Recommendation,
    /// A record that `special --record` writes
    SpecialRecord,
}

impl Schema {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let schema = match self.of {
            Of::Scene => schemars::schema_for!(Scene),
            Of::Run => Report::schema(),
            Of::Special => SpecialReport::schema(),
            Of::Gate => GateReport::schema(),
            Of::Pack => Manifest::schema(),
            Of::Protocol => protocol::schema(),
            Of::Frame => FrameDocument::schema(),
            Of::Sweep => SweepDocument::schema(),
            Of::Bench => BenchDocument::schema(),
            Of::Selftest => SelftestDocument::schema(),
            Of::Cases => CasesDocument::schema(),
            Of::Formulas => FormulasDocument::schema(),
            Of::Identify => IdentifyDocument::schema(),
            Of::Mistakes => MistakesDocument::schema(),
            Of::Show => ShowDocument::schema(),
            Of::Adapters => AdaptersDocument::schema(),
            Of::Effects => EffectsDocument::schema(),
            Of::Eval => eval::schema(),
            Of::Presets => PresetsDocument::schema(),
            Of::Recommendation => Recommendation::schema(),
            Of::SpecialRecord => SpecialRecord::schema(),
        };
        emit(&(serde_json::to_string_pretty(&schema)? + "\n"), self.out.as_deref())?;
        Ok(Status::Success)
    }
}
