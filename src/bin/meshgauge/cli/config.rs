//! `meshgauge config`

use std::io::{Write, stdout};

use super::ConfigFile;
use crate::config::Config;
use crate::config_file::DOCUMENTED;
use crate::exit::Status;

/// Print a configuration file with every setting and its default, or check one.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Check the configuration and print nothing if it is sound.
    #[arg(long)]
    check: bool,

    /// The file to check.
    #[arg(value_name = "FILE", requires = "check", conflicts_with = "config")]
    file: Option<std::path::PathBuf>,

    #[command(flatten)]
    config: ConfigFile,
}

pub fn run(args: &Args) -> anyhow::Result<Status> {
    if args.check {
        Config::read(args.file.as_deref().or(args.config.config.as_deref()))?;
    } else {
        stdout().write_all(DOCUMENTED.as_bytes())?;
    }
    Ok(Status::Fine)
}
