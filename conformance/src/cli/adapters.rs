//! `lightmeter adapters`.

use super::Status;
use super::options::Format;
use super::terminal::level;
use clap::Args;
use lightmeter::adapters::{BROWSER, CHROMIUM, EMBEDDED};
use lightmeter::browser::chromium_program;
use lightmeter::devices::known;
use lightmeter::document::Document as _;
use lightmeter::document::adapters::{AdaptersDocument, ListedAdapter, SCHEMA};
use lightmeter::report::Level;
use lightmeter_gpu::Adapter;
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
            Format::Json => {
                let adapters = found.iter().map(listed).collect();
                AdaptersDocument { schema: SCHEMA.into(), adapters }.to_json()?
            }
            Format::Text => {
                let mut text = String::new();
                if level() == Level::Quiet {
                    let browser = chromium_program().map(|_| CHROMIUM);
                    let names = found.iter().map(|adapter| adapter.name.as_str()).chain([EMBEDDED]).chain(browser);
                    names.for_each(|name| text += &format!("{name}\n"));
                    return self.format.emit(&text, None).map(|()| Status::Success);
                }
                for a in &found {
                    writeln!(text, "{:<14} {:<7} {}  {}", a.name, a.backend, a.device, a.driver)?;
                    let known = known(&a.device, &a.driver);
                    let deviations = known.deviations.iter().map(|deviation| (&deviation.name, &deviation.reason));
                    let blending = known.blend_deviations.iter().map(|deviation| (&deviation.name, &deviation.reason));
                    for (name, reason) in deviations.chain(blending) {
                        writeln!(text, "  deviates: {name}: {reason}")?;
                    }
                    if let Some(model) = known.blend_model {
                        writeln!(text, "  blends on 8 linear bits as {} has it, bit for bit", model.name())?;
                    }
                }
                writeln!(text, "{:<14} {:<7} the reference's own formulas in f32: needs no driver", EMBEDDED, "—")?;
                if let Some(program) = chromium_program() {
                    let (name, program) = (CHROMIUM, program.display());
                    writeln!(text, "{name:<14} {:<7} the GPU of {program}, which is started for it", "webgpu")?;
                }
                writeln!(
                    text,
                    "{BROWSER:<14} {:<7} the GPU of whatever browser opens the page that is served for it",
                    "webgpu"
                )?;
                text
            }
        };
        self.format.emit(&text, None)?;
        Ok(Status::Success)
    }
}

fn listed(adapter: &Adapter) -> ListedAdapter {
    let known = known(&adapter.device, &adapter.driver);
    ListedAdapter {
        name: adapter.name.clone(),
        device: adapter.device.clone(),
        backend: adapter.backend.into(),
        driver: adapter.driver.clone(),
        is_cpu: adapter.is_cpu,
        subpixel_bits: known.subpixel_bits,
        deviations: known.deviations.into_iter().cloned().collect(),
        blend_model: known.blend_model.map(|model| model.name().into()),
        blend_deviations: known.blend_deviations.into_iter().cloned().collect(),
    }
}
