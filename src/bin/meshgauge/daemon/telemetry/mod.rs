//! What the daemon tells of itself: a status file, metrics for Prometheus, and whether it is well.
//!
//! All of it is told from the daemon's loop, never from an idle timer, so that a loop that hangs shows: the status
//! grows old, and `/healthz` fails. None of it can stop the daemon: what cannot be written is left for the next time.

#[cfg(feature = "endpoint")]
mod endpoint;
mod heard;
mod heartbeat;
mod metrics;
mod report;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::Places;
use super::mount::Mount;
use super::tracking::Tracking;
use super::work::Work;
use crate::config::Config;
use crate::publish::{replace, sweep};
use crate::status::{self, Watched};

use heartbeat::Heartbeat;
use metrics::{Metrics, seconds_since_epoch};

pub use heard::Heard;

/// Everything that tells.
pub struct Telemetry {
    config: Config,
    places: Places,
    metrics: Metrics,
    heard: Arc<Heard>,
    heartbeat: Heartbeat,
    work: Work,
    process: status::Process,
    started: String,
    watched: Watched,
    /// What keeps the daemon from working as it should: words by reason.
    degraded: BTreeMap<&'static str, String>,
    ended: Option<String>,
    next: Instant,
}

impl Telemetry {
    /// Begins to tell, and to listen where that is wanted.
    pub fn start(config: &Config, places: &Places) -> anyhow::Result<Self> {
        let metrics = Metrics::new()?;
        let heartbeat = Heartbeat::new();
        listen(config, &metrics, &heartbeat)?;
        // Whoever reads the status may stand in another folder.
        let places = places.absolute()?;
        sweep(&places.state);
        Ok(Self {
            heard: Arc::new(Heard::new(metrics.clone())),
            metrics,
            heartbeat,
            work: Work::default(),
            process: status::Process::this(),
            started: report::timestamp(),
            watched: report::watched(&places.drop, &BTreeMap::new(), None),
            degraded: BTreeMap::new(),
            ended: None,
            next: Instant::now(),
            config: config.clone(),
            places,
        })
    }

    /// Counts the lines of the log.
    pub fn heard(&self) -> Arc<Heard> {
        Arc::clone(&self.heard)
    }

    /// Hears how far the workers are.
    pub fn work(&self) -> Work {
        self.work.clone()
    }

    /// The longest that the loop may wait.
    pub fn longest_round(&self) -> Duration {
        self.next.saturating_duration_since(Instant::now()).max(Duration::from_millis(10))
    }

    /// The configuration that is in force from now on.
    pub fn reconfigured(&mut self, config: &Config) {
        self.config = config.clone();
    }

    /// Something keeps the daemon from working as it should; `None` if it does no more.
    pub fn degraded(&mut self, reason: &'static str, words: Option<String>) {
        self.metrics.degraded.with_label_values(&[reason]).set(i64::from(words.is_some()));
        match words {
            Some(words) => drop(self.degraded.insert(reason, words)),
            None => drop(self.degraded.remove(reason)),
        }
    }

    /// A file system of the drop was read through.
    pub fn scanned(&mut self, mounts: &BTreeMap<PathBuf, Mount>, took: Duration) {
        self.metrics.drop_files.set(mounts.values().map(|mount| mount.files as i64).sum());
        self.metrics.drop_folders.set(mounts.values().map(|mount| mount.folders.len() as i64).sum());
        self.metrics.drop_problems.set(mounts.values().map(|mount| mount.problem_count as i64).sum());
        self.metrics.scans.inc();
        self.metrics.scan_seconds.set(took.as_secs_f64());
        self.metrics.scan_time.set(seconds_since_epoch());
        let root = mounts.get(Path::new("")).and_then(|mount| mount.root_problem.clone());
        self.degraded("drop", root.map(|problem| format!("the drop-folder cannot be read: {problem}")));
        let made = Some((took, self.metrics.scans.get()));
        self.watched = report::watched(&self.places.drop, mounts, made);
    }

    /// Looks which file systems answer.
    pub fn mounts(&mut self, mounts: &BTreeMap<PathBuf, Mount>) {
        let silent = mounts.iter().find_map(|(at, mount)| Some((at, mount.hangs()?)));
        let words = silent.map(|(at, silence)| {
            let at = self.places.drop.join(at);
            let seconds = silence.as_secs();
            format!("{}: the file system has not answered for {seconds} s", at.display())
        });
        if words.is_some() || self.degraded.contains_key("mount") {
            let made = (self.watched.scans > 0).then_some(self.watched.scans);
            let took = Duration::try_from_secs_f64(self.watched.scan_seconds).unwrap_or_default();
            let scanned = self.watched.scanned.clone();
            self.watched = report::watched(&self.places.drop, mounts, made.map(|scans| (took, scans)));
            self.watched.scanned = scanned;
        }
        self.degraded("mount", words);
    }

    /// The loop turned; tells what is to be told every few seconds.
    pub fn turned(&mut self, tracking: &Tracking) {
        self.heartbeat.beat();
        self.heartbeat
            .set_ready(self.metrics.scans.get() > 0 && self.degraded.is_empty() && self.ended.is_none());
        if Instant::now() >= self.next {
            self.tell(tracking);
        }
    }

    /// The daemon ends in good order.
    pub fn ended(&mut self, reason: &str, tracking: &Tracking) {
        self.ended = Some(reason.to_owned());
        self.heartbeat.set_ready(false);
        self.tell(tracking);
    }

    fn tell(&mut self, tracking: &Tracking) {
        let status = self.status(tracking);
        self.measure(&status);
        let path = self.places.state.join(status::FILE);
        let text = serde_json::to_string(&status).map_err(std::io::Error::other);
        self.note(text.and_then(|text| replace(&path, &text)), &path);
        let file = self.config.telemetry.metrics_file.clone();
        if !file.as_os_str().is_empty() {
            let text = self.metrics.text().map_err(std::io::Error::other);
            self.note(text.and_then(|text| replace(&file, &text)), &file);
        }
        self.next = Instant::now() + self.config.telemetry.interval.0;
    }

    fn note(&self, written: std::io::Result<()>, path: &Path) {
        if let Err(error) = written {
            tracing::debug!("{}: {error}", path.display());
        }
    }

    /// Brings what is measured and not counted up to date.
    fn measure(&self, status: &status::Status) {
        let queue = &status.queue;
        for (state, count) in [
            ("settling", queue.settling),
            ("queued", queue.queued),
            ("postponed", queue.postponed),
            ("awaiting", queue.awaiting),
            ("running", queue.running),
        ] {
            self.metrics.files.with_label_values(&[state]).set(count.cast_signed());
        }
        self.metrics.oldest.set(queue.oldest_seconds);
        let usage = report::usage();
        self.metrics.resident.set(usage.resident.cast_signed());
        self.metrics.open_files.set(usage.open_files.cast_signed());
        self.metrics.processor.inc_by((usage.processor - self.metrics.processor.get()).max(0.0));
    }
}

#[cfg(feature = "endpoint")]
fn listen(config: &Config, metrics: &Metrics, heartbeat: &Heartbeat) -> anyhow::Result<()> {
    let Some(address) = config.telemetry.address()? else { return Ok(()) };
    endpoint::start(address, config.telemetry.stalled.0, metrics.clone(), heartbeat.clone())
}

#[cfg(not(feature = "endpoint"))]
fn listen(config: &Config, _: &Metrics, _: &Heartbeat) -> anyhow::Result<()> {
    match config.telemetry.address()? {
        None => Ok(()),
        Some(_) => Err(crate::exit::Usage(
            "telemetry.listen needs a program that was built with the feature `endpoint`".into(),
        )
        .into()),
    }
}
