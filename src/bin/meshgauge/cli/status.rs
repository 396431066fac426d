//! `meshgauge status`

use std::io::{Write, stdout};
use std::path::PathBuf;

use serde_json::json;

use super::ConfigFile;
use crate::daemon::Places;
use crate::exit::{self, Usage};
use crate::status::{Answer, Cause, Health, Status, explain, health, live, text};

/// Tell what a daemon is doing, or why a file has not been scored yet.
///
/// It reads the file that the daemon replaces every few seconds, and asks the daemon nothing: it works when the daemon
/// hangs or is dead, and says so.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER)]
pub struct Args {
    /// Print JSON, for programs; docs/METRICS.md describes it.
    #[arg(long)]
    json: bool,

    /// Show it as a live screen, drawn anew every second; q ends it.
    #[arg(long, conflicts_with_all = ["json", "explain"])]
    watch: bool,

    /// Say what keeps this file from being scored.
    #[arg(long, value_name = "PATH")]
    explain: Option<PathBuf>,

    /// The state folder of the daemon [default: that of the configuration, else $STATE_DIRECTORY, else
    /// results/.meshgauge].
    #[arg(long, value_name = "DIR")]
    state: Option<PathBuf>,

    #[command(flatten)]
    config: ConfigFile,
}

const AFTER: &str = "\
Exit status:
  0  the daemon is well, or ended in good order; with --explain: the file is scored
  1  it is degraded, hangs, is stopped or is dead; with --explain: the file is not scored yet, or not meant to be
  2  wrong usage, or no daemon ever ran with this state folder
  3  with --explain: the file cannot be scored, or is not there";

/// Prints it.
pub fn run(args: &Args) -> anyhow::Result<exit::Status> {
    let mut watch = args.config.read()?.watch;
    if let Some(state) = &args.state {
        watch.state.clone_from(state);
    }
    let state = Places::of(&watch).state;
    if args.watch {
        return Ok(status_of_health(live(&state)?));
    }
    let status = Status::read(&state).map_err(|error| Usage(format!("{error:#}")))?;
    let (health, age) = health(&status);
    let mut out = stdout().lock();
    if let Some(path) = &args.explain {
        let answer = explain(&status, health, path, &state)?;
        if args.json {
            writeln!(out, "{}", serde_json::to_string(&answer)?)?;
        } else {
            writeln!(out, "{}: {}", path.display(), answer.words)?;
        }
        return Ok(status_of_answer(&answer));
    }
    if args.json {
        let whole = json!({ "health": health, "age_seconds": age, "status": status });
        writeln!(out, "{whole}")?;
    } else {
        write!(out, "{}", text(&status, health, age, None))?;
    }
    Ok(status_of_health(health))
}

fn status_of_health(health: Health) -> exit::Status {
    match health {
        Health::Well | Health::Ended | Health::Elsewhere => exit::Status::Fine,
        Health::Degraded | Health::Hung | Health::Stopped | Health::Dead => exit::Status::Failed,
    }
}

fn status_of_answer(answer: &Answer) -> exit::Status {
    match answer.state {
        Cause::Scored => exit::Status::Fine,
        Cause::Failed | Cause::Quarantined | Cause::Absent | Cause::Unreadable => exit::Status::Unreadable,
        _ => exit::Status::Failed,
    }
}
