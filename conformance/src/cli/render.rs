//! `lightmeter render`: a scene's image, by the reference or by an adapter.

use super::Status;
use super::mistakes::of_scenes_by_name;
use super::options::Choice;
use super::shader::ShaderChoice;
use anyhow::bail;
use clap::{Args, ValueEnum};
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::device::Picture;
use lightmeter::faults::scene::{SceneFault, draw};
use lightmeter::filter::Filter;
use lightmeter::image::drawn::drawn;
use lightmeter::image::file::StoredImage;
use lightmeter::scene::load;
use lightmeter::scene::select::resize;
use lightmeter_reference::render::render;
use lightmeter_scene::effects::{effects, named};
use lightmeter_scene::frame::Frame;
use lightmeter_scene::stage::Intermediate;
use lightmeter_scene::target::TargetFormat;
use std::path::PathBuf;

/// Draw a scene, by the reference or by an adapter.
#[derive(Debug, Args)]
pub(crate) struct Render {
    /// A scene's file, or the name of one that is built in
    scene: PathBuf,
    /// Who draws it
    #[arg(long, value_enum, default_value_t = With::Reference)]
    with: With,
    /// Adapter to draw on, by its short name in `lightmeter adapters`; without it: lavapipe, or the first there is
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Draw by the shader that has all effects behind switches, rather than by those composed for each object
    #[arg(long)]
    full: bool,
    /// An intermediate result in place of the colour: position, depth, normal, diffuse, specular, surface or fog
    #[arg(long, value_name = "NAME", value_parser = stage)]
    stage: Option<Intermediate>,
    /// Draw by the WGSL in this folder in place of the built-in files of the same names
    #[arg(long, value_name = "DIR")]
    shaders: Option<PathBuf>,
    /// Pixels of the longer side; without it: the scene's own
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8192))]
    size: Option<u32>,
    /// Draw as a renderer with this mistake would, by the reference; `lightmeter mistakes` lists them
    #[arg(long, value_name = "NAME", value_parser = of_scenes_by_name)]
    mistake: Option<&'static SceneFault>,
    /// The image: .png of 8 bits, or .exr of binary32
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum With {
    /// The f64 reference
    Reference,
    /// An adapter
    Gpu,
}

fn stage(name: &str) -> Result<Intermediate, String> {
    let names: Vec<&str> = Intermediate::ALL.iter().map(|stage| stage.name()).collect();
    let found = Intermediate::ALL.into_iter().find(|stage| stage.name() == name);
    found.ok_or_else(|| format!("no such intermediate result; expected one of {}", names.join(", ")))
}

impl Render {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        // Not after minutes of work.
        StoredImage::check_name(&self.out)?;
        let of_adapters = self.adapter.is_some() || self.full || self.shaders.is_some();
        if self.with == With::Reference && of_adapters {
            bail!("`--adapter`, `--full` and `--shaders` only apply to drawing on an adapter; add `--with gpu`");
        }
        if self.full && self.stage.is_some() {
            bail!("intermediate results are drawn by composed shaders; leave out `--full` or `--stage`");
        }
        if self.mistake.is_some() && (self.with == With::Gpu || self.stage.is_some()) {
            bail!("a mistake is drawn by the reference, as a whole; leave out `--with gpu` and `--stage`");
        }
        let mut frame = load::scene(&self.scene)?.frame;
        if let Some(size) = self.size {
            resize(&mut frame, size);
        }
        let image = match self.with {
            With::Reference if let Some(mistake) = self.mistake => {
                let image = draw::<f64>(&frame, &[mistake]);
                if image.pixels == draw::<f64>(&frame, &[]).pixels {
                    bail!("`{}` changes nothing in this scene: {}", mistake.name, mistake.says);
                }
                image
            }
            With::Reference => {
                let format = self.stage.map_or(frame.target.format, |_| TargetFormat::Rgba32Float);
                StoredImage::of(&render::<f64>(&frame, None, self.stage), format)
            }
            With::Gpu => self.drawn(&frame)?,
        };
        image.write(&self.out)?;
        Ok(Status::Success)
    }

    fn drawn(&self, frame: &Frame) -> anyhow::Result<StoredImage> {
        let choice = Choice {
            adapter: self.adapter.iter().cloned().collect(),
            profile: &WGSL,
            target: vec![],
            size: None,
            seed: 1,
            shaders: ShaderChoice { shaders: self.shaders.clone(), ..ShaderChoice::default() },
        };
        let code = choice.code(&Filter::default(), true)?;
        let subjects = choice.subjects()?;
        let [subject] = subjects.as_slice() else { bail!("an image is drawn by one adapter") };
        let (sets, picture) = match self.stage {
            Some(stage) => (named(frame), Picture::Intermediate(stage)),
            None if self.full => (named(frame), Picture::Full),
            None => (effects(frame), Picture::Composed),
        };
        drawn(subject, &code, frame, &sets, picture)?.map_err(|reason| {
            anyhow::anyhow!(reason).context(format!("{} cannot draw this scene", subject.identity.name))
        })
    }
}
