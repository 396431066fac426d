//! `meshgauge worker`: scores what the daemon asks for; not for people.

use crate::daemon;
use crate::exit::Status;

/// Score meshes for a daemon: a request a line on standard input, an answer a line on standard output.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The daemon's process; the worker ends with it.
    #[arg(long, value_name = "PID")]
    parent: u32,
}

/// Serves until the daemon goes away.
pub fn run(args: &Args) -> anyhow::Result<Status> {
    daemon::serve(args.parent)?;
    Ok(Status::Fine)
}
