//! The daemon's state as the status file has it.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use super::Telemetry;
use super::metrics::Metrics;
use crate::daemon::mount::Mount as Scanned;
use crate::daemon::tracking::Tracking;
use crate::daemon::work::InWork;
use crate::status::{
    MOST_WAITING, Mount, Places, Process, Queue, Running, SCHEMA, Status, Waiting, Waits, Watched,
};

/// So many problems of a scan are told in words.
const PROBLEMS: usize = 20;

/// So many file systems are told of.
const MOUNTS: usize = 100;

impl Telemetry {
    /// What the daemon is doing now.
    pub(super) fn status(&self, tracking: &Tracking) -> Status {
        let now = Instant::now();
        let (queue, waiting) = waiting(tracking, now);
        Status {
            schema: SCHEMA.into(),
            meshgauge: env!("CARGO_PKG_VERSION").into(),
            process: self.process.clone(),
            started: self.started.clone(),
            written: timestamp(),
            written_at: Process::now(),
            interval_seconds: self.config.telemetry.interval.0.as_secs_f64(),
            ended: self.ended.clone(),
            degraded: self.degraded.values().cloned().collect(),
            watches: vec![self.watched.clone()],
            places: Places {
                results: self.places.results.as_path().into(),
                log: self.places.log.as_path().into(),
            },
            queue,
            running: self.work.list().into_iter().map(|(path, work)| running(&path, work, now)).collect(),
            waiting,
            outcomes: Metrics::counts(&self.metrics.meshes),
            failures: Metrics::counts(&self.metrics.failures),
            rates: self.heard.rates(now),
            last_errors: self.heard.errors(),
            config: self.config.clone(),
        }
    }
}

/// The present time, RFC 3339.
pub fn timestamp() -> String {
    humantime::format_rfc3339_millis(SystemTime::now()).to_string()
}

/// What is known of the drop from the scans of its file systems; how long the last took and the how-manieth it was,
/// unless none was made yet.
pub fn watched(drop: &Path, mounts: &BTreeMap<PathBuf, Scanned>, made: Option<(Duration, u64)>) -> Watched {
    let mount = |(at, mount): (&PathBuf, &Scanned)| Mount {
        path: drop.join(at).as_path().into(),
        kind: mount.kind.clone(),
        network: mount.network,
        hangs_seconds: mount.hangs().map(|silence| silence.as_secs_f64()),
    };
    Watched {
        drop: drop.into(),
        mounts: mounts.iter().take(MOUNTS).map(mount).collect(),
        files: mounts.values().map(|mount| mount.files as u64).sum(),
        folders: mounts.values().map(|mount| mount.folders.len() as u64).sum(),
        problems: mounts.values().flat_map(|mount| &mount.problems).take(PROBLEMS).cloned().collect(),
        scanned: made.map(|_| timestamp()),
        scan_seconds: made.map_or(0.0, |(took, _)| took.as_secs_f64()),
        scans: made.map_or(0, |(_, scans)| scans),
    }
}

fn waiting(tracking: &Tracking, now: Instant) -> (Queue, Vec<Waiting>) {
    let mut queue = Queue { running: tracking.running() as u64, ..Queue::default() };
    let mut listed = Vec::new();
    for (path, bytes, waits, first) in tracking.waiting(now) {
        match waits {
            Waits::Settling(_) => queue.settling += 1,
            Waits::Queued(_) => queue.queued += 1,
            Waits::Postponed(_) => queue.postponed += 1,
            Waits::Word => queue.awaiting += 1,
        }
        if listed.len() < MOST_WAITING {
            let seconds = now.duration_since(first).as_secs_f64();
            listed.push(Waiting { mesh: path.into(), bytes, waits, seconds });
        }
    }
    queue.oldest_seconds = tracking.oldest().map_or(0.0, |first| now.duration_since(first).as_secs_f64());
    (queue, listed)
}

fn running(path: &Path, work: InWork, now: Instant) -> Running {
    Running {
        mesh: path.into(),
        bytes: work.bytes,
        seconds: now.duration_since(work.since).as_secs_f64(),
        phase: work.progress.phase().into(),
        pieces: (work.progress.pieces_done, work.progress.pieces),
        elements: work.progress.elements,
        silent_seconds: now.duration_since(work.heard).as_secs_f64(),
    }
}

/// What this process takes of the machine.
pub struct Usage {
    /// Bytes of memory.
    pub resident: u64,
    /// Open file descriptors.
    pub open_files: u64,
    /// Seconds of processor time.
    pub processor: f64,
}

/// What this process takes of the machine, as far as `/proc` tells.
pub fn usage() -> Usage {
    let mut text = Vec::new();
    // Without /proc the numbers are zero.
    let _ = File::open("/proc/self/statm").and_then(|file| io::copy(&mut file.take(4096), &mut text));
    let pages = String::from_utf8_lossy(&text).split(' ').nth(1).and_then(|n| n.parse::<u64>().ok());
    let times = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Usage {
        resident: pages.unwrap_or(0) * rustix::param::page_size() as u64,
        open_files: fs::read_dir("/proc/self/fd").map_or(0, |entries| entries.count() as u64),
        processor: times.tv_sec as f64 + times.tv_nsec as f64 / 1e9,
    }
}
