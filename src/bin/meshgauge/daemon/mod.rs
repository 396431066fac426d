//! The daemon: each mesh that lands in the drop is scored once it stands still.
//!
//! One loop owns all state: it looks (`folder`), waits until files stand still (`tracking`), hands them to workers
//! (`pool`) and puts down what became of them (`record`). Events of the kernel only make it look sooner.

mod done;
pub mod fields;
mod hints;
mod log;
mod pool;
mod process;
mod protocol;
mod record;
mod regression;
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

use anyhow::Context;

use crate::baseline::Baselines;
use crate::config::{Config, Watch};
use crate::exit::{Status, Usage};
use crate::file_system;
use crate::folder::Walk;
use crate::state::State;

use log::{Event, Log};
use record::Record;
use regression::Watchman;
use telemetry::Telemetry;
use watching::Watching;

pub use worker::serve;

/// Where the daemon reads and writes.
#[derive(Debug, Clone)]
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

/// Runs the daemon until it is stopped or, in `once` mode, until all is scored.
pub fn run(config: Config, places: Places, mode: Mode) -> anyhow::Result<Status> {
    if !places.drop.is_dir() {
        let drop = places.drop.display();
        return Err(Usage(format!("{drop}: expected a folder that meshes are dropped into")).into());
    }
    if let Some(advice) = file_system::advice(&places.drop, config.watch.settle.0) {
        tracing::warn!("{}: {advice}", places.drop.display());
    }
    let stop = signals::stop_requests().context("signals")?;
    record::make_folders([&places.results, &places.state])?;
    let lock = lock(&places.state)?;
    let (mut log, torn) = Log::open(&places.log).with_context(|| places.log.display().to_string())?;
    let telemetry = Telemetry::start(&config, &places)?;
    log.hear_with(telemetry.heard());
    let state = State::open(&places.state)?;
    let mut record = Record::new(log, state, &places.results, mode.quiet)?;
    if config.baseline.compare {
        record.watch_for_regressions(Watchman {
            baselines: Baselines::of(&places.state),
            naming: config.baseline.naming()?,
            tolerances: config.compare.tolerances(),
        });
    }
    if torn > 0 {
        record.event(Event::warn("log.repaired").with("bytes", torn))?;
    }
    record.event(started(&places, mode))?;
    let mut walk = Walk::new(&places.drop, &config.watch);
    for ours in
        [&places.results, &places.state, &places.log, &config.score.scratch, &config.telemetry.metrics_file]
    {
        walk.exclude(ours);
    }
    let status = Watching::new(config, walk, record, telemetry, mode).run(&stop)?;
    drop(lock);
    Ok(status)
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
