//! `lightmeter adapters`.

use super::options::Format;
use super::{Status, emit};
use anyhow::bail;
use clap::Args;
use lightmeter::blend_unit::model::BlendUnitModel;
use lightmeter::devices::known;
use std::fmt::Write as _;

/// List what can be run on.
#[derive(Debug, Args)]
pub(crate) struct Adapters {
    /// How the list is written
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

impl Adapters {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let found = lightmeter_gpu::adapters();
        let text = match self.format {
            Format::Junit => bail!("a list of adapters is written as text or json"),
            Format::Json => {
                let adapters: Vec<serde_json::Value> = found
                    .iter()
                    .map(|a| {
                        let known = known(&a.device, &a.driver);
                        serde_json::json!({
                            "name": a.name, "device": a.device, "backend": a.backend, "driver": a.driver,
                            "is_cpu": a.is_cpu, "subpixel_bits": known.subpixel_bits, "deviations": known.deviations,
                            "blend_model": known.blend_model.map(BlendUnitModel::name),
                            "blend_deviations": known.blend_deviations,
                        })
                    })
                    .collect();
                serde_json::to_string_pretty(&serde_json::json!({
                    "schema": "lightmeter.adapters/1", "adapters": adapters,
                }))? + "\n"
            }
            Format::Text => {
                let mut text = String::new();
                for a in &found {
                    writeln!(text, "{:<14} {:<7} {}  {}", a.name, a.backend, a.device, a.driver)?;
                    let known = known(&a.device, &a.driver);
                    let deviations = known.deviations.iter().map(|deviation| (deviation.name, deviation.reason));
                    let blending = known.blend_deviations.iter().map(|deviation| (deviation.name, deviation.reason));
                    for (name, reason) in deviations.chain(blending) {
                        writeln!(text, "  deviates: {name}: {reason}")?;
                    }
                    if let Some(model) = known.blend_model {
                        writeln!(text, "  blends on 8 linear bits as {} has it, bit for bit", model.name())?;
                    }
                }
                writeln!(text, "{:<14} {:<7} the reference's own formulas in f32: needs no driver", "cpu", "—")?;
                text
            }
        };
        emit(&text, None)?;
        Ok(Status::Success)
    }
}
