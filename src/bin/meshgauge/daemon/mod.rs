//! The daemon: each mesh that lands in the drop is scored once it stands still.
//!
//! One loop owns all state (`watching`): it has the drop looked at by threads (`scanners`), waits until files are whole
//! (`tracking`), hands them to workers (`pool`) and puts down what became of them (`record`). Events of the kernel only
//! make it look sooner.

mod degraded;
mod done;
pub mod fields;
mod finishing;
mod hints;
mod keeping;
mod log;
mod looking;
mod mount;
mod mounts;
mod owner;
mod pool;
mod process;
mod producer;
mod protocol;
mod record;
mod regression;
mod reload;
mod rotation;
mod scanners;
mod service;
mod settle;
mod signals;
mod telemetry;
mod tracking;
mod watching;
mod work;
mod worker;

use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Context;

use crate::config::{Config, Watch};
use crate::exit::{Status, Usage};
use crate::file_system;
use crate::state::State;

use log::{Event, Log};
use owner::Owner;
use record::Record;
use telemetry::Telemetry;
use watching::Watching;

pub use worker::serve;

/// Where the daemon reads and writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Places {
    /// Meshes are dropped here.
    pub drop: PathBuf,
    /// Summaries go here.
    pub results: PathBuf,
    /// The log.
    pub log: PathBuf,
    /// What must outlive the daemon.
    pub state: PathBuf,
}

/// Reads the configuration again.
pub type ReadConfig<'c> = &'c dyn Fn() -> anyhow::Result<Config>;

/// How the daemon runs.
#[derive(Debug, Clone, Copy)]
pub struct Mode {
    /// Score what is there and exit.
    pub once: bool,
    /// Print no line for each mesh.
    pub quiet: bool,
}

impl Places {
    /// The places that the configuration names or implies.
    pub fn of(watch: &Watch) -> Self {
        let or = |path: &Path, otherwise: PathBuf| {
            if path.as_os_str().is_empty() { otherwise } else { path.to_owned() }
        };
        // systemd separates several folders by colons; the first is ours.
        let given = std::env::var("STATE_DIRECTORY").ok().filter(|folders| !folders.is_empty());
        let given = given.and_then(|folders| folders.split(':').next().map(PathBuf::from));
        Self {
            drop: watch.drop.clone(),
            results: watch.results.clone(),
            log: or(&watch.log, watch.results.join("meshgauge.jsonl")),
            state: or(&watch.state, given.unwrap_or_else(|| watch.results.join(".meshgauge"))),
        }
    }
}

impl Places {
    /// The same from whatever folder they are seen.
    fn absolute(&self) -> std::io::Result<Self> {
        let absolute = std::path::absolute::<&Path>;
        Ok(Self {
            drop: absolute(&self.drop)?,
            results: absolute(&self.results)?,
            log: absolute(&self.log)?,
            state: absolute(&self.state)?,
        })
    }
}

/// How often a daemon that found no room to start tries again.
const BETWEEN_STARTS: Duration = Duration::from_secs(5);

/// Runs the daemon until it is stopped or, in `once` mode, until all is scored.
pub fn run(
    config: Config,
    places: Places,
    mode: Mode,
    read_config: ReadConfig<'_>,
) -> anyhow::Result<Status> {
    if !places.drop.is_dir() {
        let drop = places.drop.display();
        return Err(Usage(format!("{drop}: expected a folder that meshes are dropped into")).into());
    }
    let requests = signals::requests().context("signals")?;
    let mut telemetry = None;
    loop {
        match start(&config, &places, mode, &mut telemetry) {
            Ok((lock, record)) => {
                let telemetry = telemetry.context("telemetry starts before the rest")?;
                let watching = Watching::new(config, places, mode, record, telemetry, read_config);
                let status = watching.run(&requests)?;
                drop(lock);
                return Ok(status);
            }
            Err(error) if !mode.once && degraded::may_pass(&error) => {
                tracing::error!("the daemon starts when this has passed: {error:#}");
                if requests.stop.recv_timeout(BETWEEN_STARTS).is_ok() {
                    return Ok(Status::Fine);
                }
            }
            Err(error) => return Err(error),
        }
    }
}

/// Takes over from an earlier daemon.
fn start(
    config: &Config,
    places: &Places,
    mode: Mode,
    telemetry: &mut Option<Telemetry>,
) -> anyhow::Result<(File, Record)> {
    record::make_folders([&places.results, &places.state])?;
    let lock = lock(&places.state)?;
    let owner = file_system::network(&places.state).map(|_| Owner::take(&places.state)).transpose()?;
    // It listens: a start that is made again must not do that twice.
    let telemetry = match telemetry {
        Some(telemetry) => telemetry,
        None => telemetry.insert(Telemetry::start(config, places)?),
    };
    let (mut log, torn) = Log::open(&places.log).with_context(|| places.log.display().to_string())?;
    let state = State::open(&places.state)?;
    log.hear_with(telemetry.heard());
    let mut record = Record::new(log, state, places, mode.quiet)?;
    record.belongs_to(owner);
    record.configure(config)?;
    if torn > 0 {
        record.event(Event::warn("log.repaired").with("bytes", torn))?;
    }
    record.event(started(places, mode))?;
    Ok((lock, record))
}

/// Makes sure that no other daemon works with the same state; holds as long as the file is open.
fn lock(state: &Path) -> anyhow::Result<File> {
    let path = state.join("lock");
    let file = File::create(&path).with_context(|| path.display().to_string())?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(std::fs::TryLockError::WouldBlock) => {
            anyhow::bail!("{}: another meshgauge watch works with this state folder", state.display())
        }
        Err(std::fs::TryLockError::Error(error)) => Err(error).with_context(|| path.display().to_string()),
    }
}

fn started(places: &Places, mode: Mode) -> Event {
    Event::info("daemon.started")
        .with("version", env!("CARGO_PKG_VERSION"))
        .with("pid", std::process::id())
        .with("drop", places.drop.to_string_lossy())
        .with("results", places.results.to_string_lossy())
        .with("state", places.state.to_string_lossy())
        .with("once", mode.once)
}
