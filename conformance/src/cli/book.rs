//! `lightmeter book`.

use super::progress::Bar;
use super::{Cli, EXIT_CODES, Status, say, schema};
use anyhow::{Context as _, bail};
use clap::Args;
use lightmeter::book::{BookSources, CommandHelp, write};
use std::path::{Path, PathBuf};

/// Write the book: pages that explain, one for each formula, pictures, and all there is to look up
///
/// It is a folder of HTML that needs no server: open its `index.html`. Chapters and appendices are read from the documentation of a checkout, and
/// all else is made from what this binary judges.
#[derive(Debug, Args)]
pub(crate) struct Book {
    /// The folder to write it to: a new or an empty one, or that of an earlier book, whose files are replaced
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
        own(&self.out)?;
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

/// Files that every book has, of any version.
const OF_A_BOOK: [&str; 3] = ["index.html", "search.html", "formula/index.html"];

/// Whether a book may be written to a folder: it is not there, has nothing in it, or is an earlier book.
fn own(folder: &Path) -> anyhow::Result<()> {
    let is_empty = std::fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none());
    if is_empty || !folder.exists() || OF_A_BOOK.iter().all(|file| folder.join(file).is_file()) {
        return Ok(());
    }
    bail!(
        "{} is not empty and no book: it lacks one of {}; give `--out` a folder that is new, empty or an earlier book",
        folder.display(),
        OF_A_BOOK.join(", ")
    );
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_book_is_written_to_a_new_folder_an_empty_one_or_a_book() {
        let folder = std::env::temp_dir().join(format!("lightmeter-book-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        own(&folder).expect("it is not there");
        std::fs::create_dir_all(folder.join("formula")).expect("a folder can be made");
        let refused = own(&folder).expect_err("it has a folder in it").to_string();
        assert!(refused.contains("is not empty and no book") && refused.contains("an earlier book"), "{refused}");
        for file in OF_A_BOOK {
            assert!(own(&folder).is_err(), "it has no {file}");
            std::fs::write(folder.join(file), "").expect("it can be written");
        }
        own(&folder).expect("it is a book");
        std::fs::remove_dir_all(&folder).expect("it is there");
        std::fs::create_dir(&folder).expect("a folder can be made");
        own(&folder).expect("it is empty");
        std::fs::remove_dir(&folder).expect("it is there");
    }
}
