//! `meshgauge compare BASE NEW`, `meshgauge compare --since 7d`

use std::collections::BTreeMap;
use std::io::{Write, stdout};
use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;
use meshgauge::Summary;
use meshgauge::compare::{Comparisons, Outcome, compare, compare_sets};
use meshgauge::report::COMPARISONS;

use super::ConfigFile;
use super::{history, output};
use crate::config::Config;
use crate::daemon::Places;
use crate::exit::{Status, Usage};
use crate::quantity::Since;
use crate::summaries::{Named, Source};

/// Compare two meshes, two folders of results, or the daemon's scores of now and then: what got better, what got worse.
///
/// Exits with 1 where something got worse than the tolerances of the configuration allow.
#[derive(Debug, clap::Args)]
#[command(after_help = super::EXIT_STATUS)]
pub struct Args {
    /// What is compared with: a summary, a folder of results, or a mesh, which is scored first.
    #[arg(value_name = "BASE", required_unless_present = "since")]
    base: Option<PathBuf>,

    /// What is compared: the same. Meshes of two folders are paired by name; - reads summaries from standard input.
    #[arg(value_name = "NEW", required_unless_present = "since")]
    new: Option<PathBuf>,

    /// Compare the last score of each part with the one that stood then, from the daemon's history: 7d, 2026-11-15 or
    /// 2026-11-15T06:00:00Z (UTC).
    #[arg(long, value_name = "WHEN", conflicts_with_all = ["base", "new"])]
    since: Option<Since>,

    /// With --since: the state folder of the daemon [default: that of the configuration, else results/.meshgauge].
    #[arg(long, value_name = "DIR", requires = "since")]
    state: Option<PathBuf>,

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
    let mut found = match (&args.since, &args.base, &args.new) {
        (Some(since), ..) => since_then(*since, args.state.as_deref(), config)?,
        (None, Some(base), Some(new)) => base_and_new(base, new, config)?,
        _ => return Err(Usage("expected BASE and NEW, or --since".into()).into()),
    };
    if args.partial {
        found = Comparisons::new(found.meshes, vec![], found.added);
    }
    if found.meshes.is_empty() && found.gone.is_empty() {
        return Err(Usage(no_pair(args)).into());
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

/// Why there is nothing to compare.
fn no_pair(args: &Args) -> String {
    match (&args.since, &args.base, &args.new) {
        (None, Some(base), Some(new)) => {
            format!("no mesh of {} has the name of one of {}", new.display(), base.display())
        }
        (Some(since), ..) => format!("no mesh has a score of now and one of {since}"),
        _ => "there is nothing to compare".into(),
    }
}

/// What two paths hold.
fn base_and_new(base_path: &Path, new_path: &Path, config: &Config) -> anyhow::Result<Comparisons> {
    let source = Source { options: &config.options()?, rules: &config.watch };
    let base = source.read(base_path)?;
    let new = source.read(new_path)?;
    let tolerances = config.compare;
    let mut found = match (&base[..], &new[..]) {
        // Two files are compared whatever they are named.
        ([base], [new]) if !base_path.is_dir() && !new_path.is_dir() => {
            let pair = compare(&new.name, &base.summary, &new.summary, &tolerances);
            Comparisons::new(vec![pair], vec![], vec![])
        }
        _ => compare_sets(&by_name(base, base_path)?, &by_name(new, new_path)?, &tolerances),
    };
    if base_path.is_dir() && !new_path.is_dir() {
        found = Comparisons::new(found.meshes, vec![], found.added);
    }
    Ok(found)
}

/// The last score of each part beside the one that stood at a time. A part whose last mesh could not be scored is gone.
fn since_then(since: Since, state: Option<&Path>, config: &Config) -> anyhow::Result<Comparisons> {
    let mut watch = config.watch.clone();
    if let Some(state) = state {
        watch.state = state.to_owned();
    }
    let naming = config.baseline.naming()?;
    let keep = config.history.keep;
    if since.0.elapsed().is_ok_and(|distance| distance > keep.0) {
        let why = format!("summaries are kept for {keep} (history.keep): what stood at {since} is not known");
        return Err(Usage(why).into());
    }
    let parts = history::open(&Places::of(&watch).state)?
        .then_and_now(&since.to_string(), |mesh| naming.part(mesh))?;
    let (mut base, mut new) = (BTreeMap::new(), BTreeMap::new());
    for (part, found) in parts {
        let name = part.to_string_lossy();
        base.extend(found.then.map(|summary| (name.to_string(), summary)));
        new.extend(found.now.map(|summary| (name.to_string(), summary)));
    }
    Ok(compare_sets(&base, &new, &config.compare))
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
