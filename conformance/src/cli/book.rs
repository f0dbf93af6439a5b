//! `lightmeter book`.

use super::progress::Bar;
use super::{Cli, EXIT_CODES, Status, say, schema};
use anyhow::{Context as _, bail};
use clap::Args;
use lightmeter::book::{BookSources, CommandHelp, write};
use std::path::PathBuf;

/// Write the book: pages that explain, one for each formula, pictures, and all there is to look up
///
/// It is a folder of HTML that needs no server: open its `index.html`. Chapters and appendices are read from the documentation of a checkout, and
/// all else is made from what this binary judges.
#[derive(Debug, Args)]
pub(crate) struct Book {
    /// The folder to write it to; files of an earlier book in it are replaced
    #[arg(long, value_name = "DIR", default_value = "book")]
    out: PathBuf,
    /// The folder of the documentation, `docs` of a checkout
    #[arg(long, value_name = "DIR", default_value = "docs")]
    docs: PathBuf,
}

impl Book {
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        if !self.docs.join("book").is_dir() {
            bail!(
                "there are no chapters in {}; run this in a checkout of lightmeter, or name its folder `docs` by `--docs`",
                self.docs.join("book").display()
            );
        }
        std::fs::create_dir_all(&self.out).with_context(|| format!("cannot make the folder {}", self.out.display()))?;
        let sources = BookSources {
            docs: self.docs,
            commands: commands(),
            exit_codes: EXIT_CODES.iter().map(|(code, means)| ((*code).to_owned(), (*means).to_owned())).collect(),
            schemas: schema::all()?,
        };
        let bar = Bar::new(None, "pages").bar;
        let pages = write(&self.out, &sources, &|done, all| {
            bar.set_length(all as u64);
            bar.set_position(done as u64);
        })?;
        bar.finish_and_clear();
        say(&format!("{pages} pages; open {}", self.out.join("index.html").display()));
        Ok(Status::Success)
    }
}

/// What the command line says of its commands.
fn commands() -> Vec<CommandHelp> {
    let mut told = Cli::told();
    told.build();
    let visible = told.get_subcommands().filter(|one| !one.is_hide_set() && one.get_name() != "help");
    visible
        .map(|one| CommandHelp {
            name: one.get_name().to_owned(),
            about: one.get_about().map(ToString::to_string).unwrap_or_default(),
            help: one.clone().term_width(100).render_long_help().to_string(),
        })
        .collect()
}
