//! The `lightmeter` command.

#![warn(clippy::print_stderr)]

mod cli;

use clap::Parser as _;
use std::process::ExitCode;

fn main() -> ExitCode {
    match cli::Cli::parse().run() {
        Ok(status) => status.into(),
        Err(error) => {
            cli::say(&format!("error: {error:#}"));
            cli::Status::of(&error).into()
        }
    }
}
