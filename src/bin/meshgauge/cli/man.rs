//! `meshgauge man`

use std::io::{Write, stdout};

use clap::CommandFactory;
use clap_mangen::Man;

use super::Cli;
use crate::exit::{Status, Usage};

/// Print the manual page, of the program or of one of its commands: `meshgauge man | man -l -`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The command, such as `score`.
    command: Option<String>,
}

pub fn run(args: &Args) -> anyhow::Result<Status> {
    let mut program = Cli::command();
    // Gives the commands their full names.
    program.build();
    let page = match &args.command {
        None => program,
        Some(name) => match program.find_subcommand(name) {
            Some(command) => command.clone(),
            None => return Err(Usage(format!("no command is named \"{name}\"")).into()),
        },
    };
    let mut text = Vec::new();
    Man::new(page).render(&mut text)?;
    stdout().write_all(&text)?;
    Ok(Status::Fine)
}
