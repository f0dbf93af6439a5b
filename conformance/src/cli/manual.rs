//! `lightmeter completions` and `lightmeter man`: what shells and manuals know of the command line.

use super::{Cli, Status, emit};
use anyhow::Context as _;
use clap::Args;
use clap_complete::Shell;
use lightmeter::files::whole;
use std::path::{Path, PathBuf};

/// Print what completes this command's words in a shell.
///
/// For bash: `lightmeter completions bash > ~/.local/share/bash-completion/completions/lightmeter`.
#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

impl Completions {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        let mut text = vec![];
        let told = Cli::told();
        // What is hidden is for the command itself.
        let visible = told.get_subcommands().filter(|one| !one.is_hide_set()).cloned();
        let mut shown = clap::Command::new("lightmeter").args(told.get_arguments().cloned()).subcommands(visible);
        clap_complete::generate(self.shell, &mut shown, "lightmeter", &mut text);
        emit(&String::from_utf8(text)?, None)?;
        Ok(Status::Success)
    }
}

/// Write the manual as man pages, one a command: `man -l DIR/lightmeter-run.1` shows one.
#[derive(Debug, Args)]
pub(crate) struct Man {
    /// The folder to write them to
    dir: PathBuf,
}

impl Man {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        std::fs::create_dir_all(&self.dir).with_context(|| format!("cannot make {}", self.dir.display()))?;
        let mut command = Cli::told();
        command.build();
        page(&command, "lightmeter", &self.dir)?;
        for one in command.get_subcommands().filter(|one| !one.is_hide_set() && one.get_name() != "help") {
            page(one, &format!("lightmeter-{}", one.get_name()), &self.dir)?;
        }
        Ok(Status::Success)
    }
}

fn page(command: &clap::Command, name: &str, dir: &Path) -> anyhow::Result<()> {
    let mut text = vec![];
    clap_mangen::Man::new(command.clone().name(name.to_owned()).display_name(name.to_owned())).render(&mut text)?;
    let path = dir.join(format!("{name}.1"));
    whole(&path, &text).with_context(|| format!("cannot write {}", path.display()))
}
