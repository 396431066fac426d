//! `meshgauge watch [DROP]`

use std::path::PathBuf;

use super::ConfigFile;
use crate::config::Config;
use crate::daemon::{self, Places};
use crate::exit::Status;
use crate::quantity::Span;

/// Score each mesh that lands in a folder, as it lands.
///
/// A file is scored when it stands still: size, times, inode and blocks unchanged for the settle time. Names that begin
/// with a dot or end like a file that is being written are passed over, so a producer that renames its finished file
/// into place is never read too early. Each mesh is scored in a process of its own, so a bad one fails alone. A mesh is
/// scored once; another version of it under the same name is scored again.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER)]
pub struct Args {
    /// The folder that meshes are dropped into; by default that of the configuration.
    drop: Option<PathBuf>,

    /// Score what the folder holds now, then exit.
    #[arg(long)]
    once: bool,

    /// Folder for NAME.summary.json; sub-folders of the drop are kept [default: results].
    ///
    /// Meshes of one folder that would share a NAME (pit.inp, pit.msh) keep their extensions: pit.inp.summary.json. If
    /// the second comes later, the summary of the first is renamed.
    #[arg(long, value_name = "DIR")]
    results: Option<PathBuf>,

    /// The log of results, JSON lines [default: RESULTS/meshgauge.jsonl].
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,

    /// Folder for the database of what was scored [default: $STATE_DIRECTORY, else RESULTS/.meshgauge].
    ///
    /// Remove it to have everything scored again.
    #[arg(long, value_name = "DIR")]
    state: Option<PathBuf>,

    /// How long a file must stand still before it is scored [default: 2s, on network file systems 90s].
    #[arg(long, value_name = "DURATION")]
    settle: Option<Span>,

    /// Print no line for each mesh.
    #[arg(short, long)]
    quiet: bool,

    #[command(flatten)]
    config: ConfigFile,
}

const AFTER: &str = "\
Signals: SIGTERM and SIGINT stop the daemon after the meshes in work (exit status 0); a second one stops it now.
SIGHUP reads the configuration again; one that is not sound changes nothing. SIGUSR1 begins a new log after somebody
moved the old one away.

Exit status with --once, the highest over the meshes of this run:
  0  all were scored; a warning is fine
  1  the verdict of a mesh is fail
  2  wrong usage or configuration
  3  a mesh could not be read, or did not settle in time
  4  out of a resource: disk, memory, or the state folder is in use by another daemon";

impl Args {
    /// The configuration, with what the command line says put over it.
    pub fn config(&self) -> anyhow::Result<Config> {
        let mut config = self.config.read()?;
        let watch = &mut config.watch;
        for (setting, given) in [
            (&mut watch.drop, &self.drop),
            (&mut watch.results, &self.results),
            (&mut watch.log, &self.log),
            (&mut watch.state, &self.state),
        ] {
            if let Some(path) = given {
                setting.clone_from(path);
            }
        }
        if let Some(settle) = self.settle {
            (watch.settle, watch.settle_network) = (settle, settle);
        }
        config.check()?;
        Ok(config)
    }
}

/// Runs the daemon.
pub fn run(args: &Args, config: Config) -> anyhow::Result<Status> {
    let places = Places::of(&config.watch);
    daemon::run(config, places, daemon::Mode { once: args.once, quiet: args.quiet }, &|| args.config())
}
