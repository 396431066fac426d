//! What a daemon is doing, as it stands in a file that it replaces every few seconds: `STATE/status.json`.
//!
//! Whoever wants to know reads that file and `/proc`, and asks the daemon nothing, so it works when the daemon hangs or
//! is dead. Times that matter are seconds since the machine's start, which no setting of the clock changes.

mod explain;
mod live;
mod process;
mod text;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use anyhow::Context;
use serde::{Deserialize, Serialize};

use crate::config::Config;
use crate::path_text::PathText;

pub use explain::{Answer, Cause, explain};
pub use live::live;
pub use process::{Health, Process, health};
pub use text::text;

/// The file's name in the state folder.
pub const FILE: &str = "status.json";

/// The schema of what this version writes.
pub const SCHEMA: &str = "meshgauge.status/1";

/// What a daemon is doing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Status {
    /// `meshgauge.status/1`.
    pub schema: String,
    /// The program's version.
    pub meshgauge: String,
    /// Who wrote this, where.
    pub process: Process,
    /// When the daemon started, RFC 3339.
    pub started: String,
    /// When this was written, RFC 3339.
    pub written: String,
    /// The same by the clock of `Process::now`.
    pub written_at: f64,
    /// It is replaced this often, in seconds.
    pub interval_seconds: f64,
    /// Why the daemon ended, in good order.
    pub ended: Option<String>,
    /// What keeps it from working as it should, in words; empty is well.
    pub degraded: Vec<String>,
    /// The folders that it watches.
    pub watches: Vec<Watched>,
    /// Where its results go.
    pub places: Places,
    /// How many files wait for what.
    pub queue: Queue,
    /// The meshes that workers have, the one that has taken longest first.
    pub running: Vec<Running>,
    /// The files that wait: first those that are next, at most `MOST_WAITING`.
    pub waiting: Vec<Waiting>,
    /// Number of meshes by what became of them, since the start.
    pub outcomes: BTreeMap<String, u64>,
    /// Number of failures by kind, since the start.
    pub failures: BTreeMap<String, u64>,
    /// How fast it has been of late.
    pub rates: Rates,
    /// The last things that went wrong, the latest last.
    pub last_errors: Vec<LastError>,
    /// The configuration that is in force.
    pub config: Config,
}

/// Most files of `Status::waiting`.
pub const MOST_WAITING: usize = 1000;

/// A folder that is watched.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Watched {
    /// The folder.
    pub drop: PathText,
    /// The file systems below it: where each is mounted, and of what kind.
    pub mounts: Vec<Mount>,
    /// Files and sub-folders at the last scan.
    pub files: u64,
    /// Sub-folders at the last scan, the folder itself among them.
    pub folders: u64,
    /// What could not be looked at, at the last scan; a few of them in words.
    pub problems: Vec<String>,
    /// When it was last read through, RFC 3339.
    pub scanned: Option<String>,
    /// How long that took.
    pub scan_seconds: f64,
    /// Number of times it was read through since the start.
    pub scans: u64,
}

/// A file system.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mount {
    /// The first folder on it.
    pub path: PathText,
    /// The kernel's name of its type.
    pub kind: String,
    /// Whether it counts as a network file system, which is scanned and gives no events.
    #[serde(default)]
    pub network: bool,
    /// For how long it has not answered, where that is too long.
    #[serde(default)]
    pub hangs_seconds: Option<f64>,
}

/// Where results go.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Places {
    /// Summaries.
    pub results: PathText,
    /// The log.
    pub log: PathText,
}

/// How many files wait for what.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Queue {
    /// Those that must stand still for longer.
    pub settling: u64,
    /// Those that wait for a free worker.
    pub queued: u64,
    /// Those that wait for another try.
    pub postponed: u64,
    /// Those that wait for their producer's word.
    #[serde(default)]
    pub awaiting: u64,
    /// Those that a worker has.
    pub running: u64,
    /// How long the oldest of them has been known, in seconds.
    pub oldest_seconds: f64,
}

/// A mesh that a worker has.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Running {
    /// Its path within the drop.
    pub mesh: PathText,
    /// Its size.
    pub bytes: u64,
    /// How long the worker has had it.
    pub seconds: f64,
    /// `opening`, `reading nodes`, `measuring elements`.
    pub phase: String,
    /// Pieces (about 1 MiB each) that are done, and that are known.
    pub pieces: (u64, u64),
    /// Elements that are measured.
    pub elements: u64,
    /// How long since the worker was last heard of.
    pub silent_seconds: f64,
}

/// A file that waits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Waiting {
    /// Its path within the drop.
    pub mesh: PathText,
    /// Its size.
    pub bytes: u64,
    /// For what.
    pub waits: Waits,
    /// Since it was first seen.
    pub seconds: f64,
}

/// What a file waits for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Waits {
    /// To stand still for so many seconds more, unless it changes.
    Settling(f64),
    /// A free worker; it is the so-manieth in the queue, from 1.
    Queued(u64),
    /// Another try, in so many seconds.
    Postponed(f64),
    /// Its producer's word that it is whole.
    Word,
}

/// How fast it has been of late.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Rates {
    /// The time that the rates are over, up to 5 min.
    pub seconds: f64,
    /// Meshes that were done with, scored or not.
    pub meshes_per_second: f64,
    /// Bytes of meshes that were done with.
    pub bytes_per_second: f64,
}

/// Something that went wrong.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LastError {
    /// When, RFC 3339.
    pub timestamp: String,
    /// The mesh, if it is about one.
    pub mesh: Option<PathText>,
    /// What sort, as in the log.
    pub kind: String,
    /// In words.
    pub reason: String,
}

impl Status {
    /// Reads the file in the state folder.
    pub fn read(state: &Path) -> anyhow::Result<Self> {
        let path = state.join(FILE);
        let file = File::open(&path).with_context(|| format!("{}: no daemon wrote here", path.display()))?;
        let status: Self = serde_json::from_reader(BufReader::new(file))
            .with_context(|| format!("{}: no status that this version reads", path.display()))?;
        anyhow::ensure!(
            status.schema == SCHEMA,
            "{}: expected schema {SCHEMA}, found {}",
            path.display(),
            status.schema
        );
        Ok(status)
    }
}
