//! `meshgauge baseline accept NAME`

use std::io::{Write, stdout};
use std::path::PathBuf;

use clap::Subcommand;

use super::{ConfigFile, history};
use crate::baseline::{Baselines, summary_at};
use crate::daemon::Places;
use crate::daemon::fields::printable;
use crate::exit::{Status, Usage};

/// Say what the daemon compares a part with.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// From now on compare with the mesh of this part that was scored last.
    Accept {
        /// The part: the mesh's path in the drop without extensions, or what baseline.pattern makes of it.
        #[arg(value_name = "NAME")]
        name: PathBuf,

        /// The state folder of the daemon [default: that of the configuration, else results/.meshgauge].
        #[arg(long, value_name = "DIR")]
        state: Option<PathBuf>,

        /// The results folder of the daemon [default: that of the configuration].
        #[arg(long, value_name = "DIR")]
        results: Option<PathBuf>,

        #[command(flatten)]
        config: ConfigFile,
    },
}

/// Does it. The daemon need not run, and need not be told.
pub fn run(args: &Args) -> anyhow::Result<Status> {
    let Action::Accept { name, state, results, config } = &args.action;
    let config = config.read()?;
    let mut watch = config.watch.clone();
    for (given, setting) in [(state, &mut watch.state), (results, &mut watch.results)] {
        if let Some(given) = given {
            setting.clone_from(given);
        }
    }
    let naming = config.baseline.naming()?;
    let places = Places::of(&watch);
    let database = history::open(&places.state)?;
    let Some(last) = database.last_summary(|mesh| naming.part(mesh) == *name)? else {
        return Err(Usage(format!("no mesh of a part named {} was scored", name.display())).into());
    };
    let summary = summary_at(&places.results.join(last))?;
    Baselines::of(&places.state).accept(name, &summary)?;
    let (part, path) = (name.display().to_string(), &summary.mesh.path);
    writeln!(stdout(), "{}", printable(&format!("{part}: compared with {path} from now on")))?;
    Ok(Status::Fine)
}
