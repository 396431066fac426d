//! The program: scores meshes on the command line, and as they land in a folder.

mod baseline;
mod cli;
mod config;
mod config_file;
mod daemon;
mod exit;
mod file_system;
mod folder;
mod identity;
mod logging;
mod measuring;
mod names;
mod nearest;
mod path_text;
mod progress;
mod publish;
mod quantity;
mod rules;
mod selection;
mod series;
mod state;
mod status;
mod suite;
mod summaries;

use std::process::ExitCode;

use clap::Parser;

use crate::exit::Status;

fn main() -> ExitCode {
    let cli = cli::Cli::parse();
    match cli::run(cli) {
        Ok(status) => status.into(),
        Err(failure) => {
            let status = Status::of_failure(&failure);
            if status != Status::Fine {
                eprintln!("meshgauge: {failure:#}");
            }
            status.into()
        }
    }
}
