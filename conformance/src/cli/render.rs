//! `lightmeter render`: a scene's image, by the reference or by a renderer.

use super::Status;
use clap::{Args, ValueEnum};
use lightmeter::image::file::Stored;
use lightmeter::scene::load;
use lightmeter_reference::render::render;
use std::path::PathBuf;

/// Draw a scene.
#[derive(Debug, Args)]
pub(crate) struct Render {
    /// A scene's file, or the name of one that is built in
    scene: String,
    /// Who draws it
    #[arg(long, value_enum, default_value_t = With::Reference)]
    with: With,
    /// The image: .png of 8 bits, or .exr of binary32
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum With {
    /// The f64 reference
    Reference,
}

impl Render {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        Stored::check_name(&self.out)?;
        let loaded = load::scene(&self.scene)?;
        let started = std::time::Instant::now();
        let drawn = render::<f64>(&loaded.frame, None, None);
        let image = Stored::of(&drawn, loaded.frame.target.format);
        eprintln!("{} fragments in {:.3} s", drawn.fragments, started.elapsed().as_secs_f64());
        let started = std::time::Instant::now();
        let profile = &lightmeter::arithmetic::profile::WGSL;
        let expected = lightmeter::image::expect(&loaded.frame, None, None, profile);
        let marked = expected.iter().filter(|e| e.is_marked).count();
        eprintln!("{marked} marked of {}, {:.3} s", expected.len(), started.elapsed().as_secs_f64());
        image.write(&self.out)?;
        Ok(Status::Success)
    }
}
