//! The `lightmeter` command.

#![warn(clippy::print_stderr)]

mod cli;

use clap::FromArgMatches as _;
use clap::error::{ContextKind, ContextValue};
use lightmeter::nearest::nearest;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::environment::complete();
    let status = command().unwrap_or_else(|error| {
        cli::say(&format!("error: {error:#}"));
        cli::Status::of(&error)
    });
    cli::end(status)
}

/// Reads the command line, with what the project's file says, and does as it asks.
fn command() -> anyhow::Result<cli::Status> {
    let mut told = cli::Cli::told();
    let words = cli::config::arguments(&told)?;
    let parsed = told.try_get_matches_from_mut(words).and_then(|matches| cli::Cli::from_arg_matches(&matches));
    match parsed {
        Ok(command) => command.run(),
        Err(error) if error.use_stderr() => {
            cli::say(error.render().to_string().trim_end());
            if let Some(ContextValue::String(typed)) = error.get(ContextKind::InvalidSubcommand)
                && let [nearest, ..] = nearest(typed, told.get_subcommands().map(clap::Command::get_name)).as_slice()
                && error.get(ContextKind::SuggestedSubcommand).is_none()
            {
                cli::say(&format!("\nDid you mean `lightmeter {nearest}`?"));
            }
            Ok(cli::Status::BadInput)
        }
        // What is asked for by --help and --version.
        Err(error) => error.exit(),
    }
}
