//! `lightmeter schema`.

use super::{Status, emit};
use clap::{Args, ValueEnum};
use lightmeter::document::adapters::AdaptersDocument;
use lightmeter::document::bench::BenchDocument;
use lightmeter::document::bench::recommendation::Recommendation;
use lightmeter::document::effects::EffectsDocument;
use lightmeter::document::frame::FrameDocument;
use lightmeter::document::identify::IdentifyDocument;
use lightmeter::document::list::{CasesDocument, FormulasDocument};
use lightmeter::document::mistakes::MistakesDocument;
use lightmeter::document::pack::Manifest;
use lightmeter::document::report::Report;
use lightmeter::document::selftest::SelftestDocument;
use lightmeter::document::show::ShowDocument;
use lightmeter::document::special::SpecialReport;
use lightmeter::document::special::record::SpecialRecord;
use lightmeter::document::sweep::SweepDocument;
use lightmeter::document::sweep::presets::PresetsDocument;
use lightmeter::document::{Document as _, eval, protocol};
use lightmeter_scene::model::Scene;
use serde_json::Value;
use std::path::PathBuf;

/// Print the JSON Schema of a file that lightmeter reads or writes.
#[derive(Debug, Args)]
pub(crate) struct Schema {
    /// Of what
    #[arg(value_enum)]
    of: Of,
    /// Write the schema to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Of {
    /// A scene
    Scene,
    /// The JSON of `run`, `gate` and `merge`
    Report,
    /// What stands in the place of these says so.
    #[value(hide = true)]
    Run,
    /// The same.
    #[value(hide = true)]
    Gate,
    /// The JSON of `special`
    Special,
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
    /// The JSON of `identify`
    Identify,
    /// The JSON of `mistakes`
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
        if let Of::Run | Of::Gate = self.of {
            anyhow::bail!("`run`, `gate` and `merge` write one report: expected `lightmeter schema report`");
        }
        emit(&(serde_json::to_string_pretty(&self.of.schema())? + "\n"), self.out.as_deref())?;
        Ok(Status::Success)
    }
}

impl Of {
    fn schema(self) -> schemars::Schema {
        match self {
            Self::Scene => schemars::schema_for!(Scene),
            Self::Report | Self::Run | Self::Gate => Report::schema(),
            Self::Special => SpecialReport::schema(),
            Self::Pack => Manifest::schema(),
            Self::Protocol => protocol::schema(),
            Self::Frame => FrameDocument::schema(),
            Self::Sweep => SweepDocument::schema(),
            Self::Bench => BenchDocument::schema(),
            Self::Selftest => SelftestDocument::schema(),
            Self::Cases => CasesDocument::schema(),
            Self::Formulas => FormulasDocument::schema(),
            Self::Identify => IdentifyDocument::schema(),
            Self::Mistakes => MistakesDocument::schema(),
            Self::Show => ShowDocument::schema(),
            Self::Adapters => AdaptersDocument::schema(),
            Self::Effects => EffectsDocument::schema(),
            Self::Eval => eval::schema(),
            Self::Presets => PresetsDocument::schema(),
            Self::Recommendation => Recommendation::schema(),
            Self::SpecialRecord => SpecialRecord::schema(),
        }
    }
}

/// All schemas by their names.
pub(super) fn all() -> anyhow::Result<Vec<(String, Value)>> {
    let named = |of: &Of| {
        let name = of.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
        Ok((name, serde_json::to_value(of.schema())?))
    };
    Of::value_variants().iter().filter(|of| !matches!(of, Of::Run | Of::Gate)).map(named).collect()
}
