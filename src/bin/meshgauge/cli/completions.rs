//! `meshgauge completions SHELL`

use std::io::stdout;

use clap::CommandFactory;
use clap_complete::Shell;

use super::Cli;
use crate::exit::Status;

/// Print the completions of a shell: `meshgauge completions bash > ~/.local/share/bash-completion/completions/meshgauge`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The shell.
    shell: Shell,
}

pub fn run(args: &Args) -> anyhow::Result<Status> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "meshgauge", &mut text);
    std::io::Write::write_all(&mut stdout(), &text)?;
    Ok(Status::Fine)
}
