//! `meshgauge compare BASE NEW`

use std::collections::BTreeMap;
use std::io::{Write, stdout};
use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;
use meshgauge::Summary;
use meshgauge::compare::{Comparisons, Outcome, compare, compare_sets};
use meshgauge::report::COMPARISONS;

use super::ConfigFile;
use super::output;
use crate::config::Config;
use crate::exit::{Status, Usage};
use crate::summaries::{Named, Source};

/// Compare two meshes, or two folders of results: what got better, what got worse.
///
/// Exits with 1 where something got worse than the tolerances of the configuration allow.
#[derive(Debug, clap::Args)]
#[command(after_help = super::EXIT_STATUS)]
pub struct Args {
    /// What is compared with: a summary, a folder of results, or a mesh, which is scored first.
    #[arg(value_name = "BASE")]
    base: PathBuf,

    /// What is compared: the same. Meshes of two folders are paired by name; - reads summaries from standard input.
    #[arg(value_name = "NEW")]
    new: PathBuf,

    /// What is printed: table, json or markdown.
    #[arg(long, value_name = "FORMAT", value_parser = format_names())]
    format: Option<String>,

    /// Meshes that NEW lacks are no regression; so it is where NEW is one file.
    #[arg(long)]
    partial: bool,

    /// Print nothing, unless --format asks for it; the exit status tells.
    #[arg(short, long)]
    quiet: bool,

    #[command(flatten)]
    config: ConfigFile,
}

fn format_names() -> PossibleValuesParser {
    PossibleValuesParser::new(COMPARISONS.iter().map(|report| report.name))
}

impl Args {
    /// The configuration.
    pub fn config(&self) -> anyhow::Result<Config> {
        self.config.read()
    }
}

/// Compares what the command line names.
pub fn run(args: &Args, config: &Config) -> anyhow::Result<Status> {
    let source = Source { options: &config.options()?, rules: &config.watch };
    let base = source.read(&args.base)?;
    let new = source.read(&args.new)?;
    let tolerances = config.compare;
    let mut found = match (&base[..], &new[..]) {
        // Two files are compared whatever they are named.
        ([base], [new]) if !args.base.is_dir() && !args.new.is_dir() => {
            let pair = compare(&new.name, &base.summary, &new.summary, &tolerances);
            Comparisons::new(vec![pair], vec![], vec![])
        }
        _ => compare_sets(&by_name(base, &args.base)?, &by_name(new, &args.new)?, &tolerances),
    };
    if args.partial || args.base.is_dir() && !args.new.is_dir() {
        found = Comparisons::new(found.meshes, vec![], found.added);
    }
    if found.meshes.is_empty() && found.gone.is_empty() {
        let (base, new) = (args.base.display(), args.new.display());
        return Err(Usage(format!("no mesh of {new} has the name of one of {base}")).into());
    }
    if !args.quiet || args.format.is_some() {
        let report =
            args.format.as_deref().and_then(|name| COMPARISONS.iter().find(|report| report.name == name));
        let mut out = stdout().lock();
        (report.unwrap_or(&COMPARISONS[0]).render)(&found, &output::style(), &mut out)?;
        out.flush()?;
    }
    Ok(if found.outcome == Outcome::Worse { Status::Failed } else { Status::Fine })
}

fn by_name(found: Vec<Named>, path: &Path) -> Result<BTreeMap<String, Summary>, Usage> {
    let mut set = BTreeMap::new();
    for Named { name, summary } in found {
        if set.contains_key(&name) {
            return Err(Usage(format!("{}: two summaries are of a mesh named {name}", path.display())));
        }
        set.insert(name, summary);
    }
    Ok(set)
}
