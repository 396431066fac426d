//! `meshgauge bench-generators SUITE`

use std::io::{Write, stdout};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};

use super::ConfigFile;
use crate::config::Config;
use crate::exit::Status;
use crate::suite::{self, Row, Suite};

/// Run mesh generators on model problems and score what they make.
///
/// Every mesh, its summary and a row with time, memory and version stand in the results folder, problem by problem.
/// What is known already is not run again while command, version and scripts are the same; an interrupted suite goes on
/// where it stopped. `meshgauge report` lays the results out as a page.
#[derive(Debug, clap::Args)]
#[command(after_help = super::EXIT_STATUS)]
pub struct Args {
    /// The file that names problems and generators, such as bench/generators/npl-2007.toml.
    suite: PathBuf,

    /// The folder for meshes, summaries and rows.
    #[arg(long, value_name = "DIR", default_value = "results/generators")]
    results: PathBuf,

    /// Only these generators or problems.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    only: Vec<String>,

    /// Set a variable of the suite's commands, as in python=/opt/venv/bin/python.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = variable)]
    variables: Vec<(String, String)>,

    /// What is printed.
    #[arg(long, value_name = "FORMAT", value_parser = ["table", "markdown", "csv", "json"], default_value = "table")]
    format: String,

    /// Run everything again.
    #[arg(long)]
    fresh: bool,

    /// Tell nothing on stderr while it runs.
    #[arg(short, long)]
    quiet: bool,

    #[command(flatten)]
    config: ConfigFile,
}

fn variable(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    Ok((name.to_owned(), value.to_owned()))
}

impl Args {
    /// The configuration.
    pub fn config(&self) -> anyhow::Result<Config> {
        self.config.read()
    }
}

/// Runs the suite.
pub fn run(args: &Args, config: &Config) -> anyhow::Result<Status> {
    let suite = Suite::read(&args.suite, &args.variables)?;
    let known = || {
        suite.problems.iter().map(|p| p.name.as_str()).chain(suite.generators.iter().map(|g| g.name.as_str()))
    };
    for name in &args.only {
        if !known().any(|known| known == name) {
            let hint = crate::nearest::nearest(name, known());
            let hint = hint.map(|near| format!("; did you mean {near}?")).unwrap_or_default();
            return Err(
                crate::exit::Usage(format!("no generator or problem is named \"{name}\"{hint}")).into()
            );
        }
    }
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(&stop))?;
    }
    let run = suite::Run {
        suite,
        results: args.results.clone(),
        only: args.only.clone(),
        fresh: args.fresh,
        options: config.options()?,
        stop,
    };
    let tell = |row: &Row| {
        let why = row.reason.as_ref().map(|why| format!(": {why}")).unwrap_or_default();
        if !args.quiet {
            eprintln!("{} {}: {}{why}", row.problem, row.generator, row.outcome);
        }
    };
    let scored = run.all(tell)?;
    let mut out = stdout().lock();
    suite::write(&run.suite, &scored, &args.format, &mut out)?;
    out.flush()?;
    Ok(Status::Fine)
}
