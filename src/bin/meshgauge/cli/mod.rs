//! The command line: one file a subcommand.

mod baseline;
mod bench_generators;
mod compare;
mod completions;
mod config;
mod formats;
mod generate;
mod history;
mod man;
mod measures;
mod output;
mod report;
mod score;
mod status;
mod watch;
mod worker;

use std::path::PathBuf;

use clap::{Parser, Subcommand};

use crate::config::Config;
use crate::exit::Status;
use crate::logging;

/// Finite-element mesh quality: the twelve measures of the NPL report, for meshes of any size.
///
/// `score` measures meshes now; `watch` measures each mesh that lands in a folder.
#[derive(Debug, Parser)]
#[command(name = "meshgauge", version, max_term_width = 100, after_help = EXIT_STATUS)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,

    /// Say more about what is done, on stderr; twice says still more.
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    verbose: u8,
}

const EXIT_STATUS: &str = "\
Exit status:
  0  fine; a warning is fine
  1  scored, but a threshold or a comparison failed
  2  wrong usage or configuration
  3  a mesh could not be read
  4  out of a resource: disk, memory
With several meshes the others are still scored, and the highest status is returned.";

#[derive(Debug, Subcommand)]
enum Command {
    Score(Box<score::Args>),
    Watch(watch::Args),
    Status(status::Args),
    Compare(compare::Args),
    Report(report::Args),
    History(history::Args),
    Baseline(baseline::Args),
    Generate(generate::Args),
    BenchGenerators(bench_generators::Args),
    Formats(formats::Args),
    Measures(measures::Args),
    Config(config::Args),
    Completions(completions::Args),
    Man(man::Args),
    #[command(hide = true)]
    Worker(worker::Args),
}

/// Where the configuration comes from.
#[derive(Debug, clap::Args)]
struct ConfigFile {
    /// Configuration file; `meshgauge config` prints one with every setting and its default.
    #[arg(long, value_name = "FILE", env = "MESHGAUGE_CONFIG")]
    config: Option<PathBuf>,
}

impl ConfigFile {
    fn read(&self) -> anyhow::Result<Config> {
        Config::read(self.config.as_deref())
    }
}

/// Does what the command line asks for.
pub fn run(cli: Cli) -> anyhow::Result<Status> {
    let start = |config: &Config| logging::start(&config.diagnostics.level, cli.verbose);
    match cli.command {
        Command::Score(args) => {
            let config = args.config()?;
            start(&config);
            score::run(&args, &config)
        }
        Command::Watch(args) => {
            let config = args.config()?;
            start(&config);
            watch::run(&args, config)
        }
        Command::Status(args) => status::run(&args),
        Command::Compare(args) => {
            let config = args.config()?;
            start(&config);
            compare::run(&args, &config)
        }
        Command::Report(args) => {
            let config = args.config()?;
            start(&config);
            report::run(&args, &config)
        }
        Command::History(args) => history::run(&args),
        Command::Baseline(args) => baseline::run(&args),
        Command::Worker(args) => {
            start(&Config::default());
            worker::run(&args)
        }
        Command::Generate(args) => generate::run(&args),
        Command::BenchGenerators(args) => {
            let config = args.config()?;
            start(&config);
            bench_generators::run(&args, &config)
        }
        Command::Formats(args) => formats::run(&args),
        Command::Measures(args) => measures::run(&args),
        Command::Config(args) => config::run(&args),
        Command::Completions(args) => completions::run(&args),
        Command::Man(args) => man::run(&args),
    }
}
