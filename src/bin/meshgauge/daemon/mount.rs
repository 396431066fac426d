//! A file system that is mounted in the drop: what is known of it, and what is due.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crossbeam_channel::Sender;

use super::scanners::Ask;
use crate::config::Watch;

/// How a thread shows that the file system answers it.
#[derive(Debug)]
pub(super) struct Pulse {
    start: Instant,
    /// Milliseconds from the start to the last answer.
    last: AtomicU64,
    /// Whether it waits for somebody to hear what it has to tell.
    telling: AtomicBool,
}

impl Pulse {
    /// It beats now.
    pub fn new() -> Self {
        Self { start: Instant::now(), last: AtomicU64::new(0), telling: AtomicBool::new(false) }
    }

    /// The file system answered.
    pub fn beat(&self) {
        self.last.store(self.start.elapsed().as_millis() as u64, Ordering::Relaxed);
    }

    /// Does something that may wait for whoever listens, which is not the file system's fault.
    pub fn while_telling<T>(&self, tell: impl FnOnce() -> T) -> T {
        self.telling.store(true, Ordering::Relaxed);
        let told = tell();
        self.beat();
        self.telling.store(false, Ordering::Relaxed);
        told
    }

    /// For how long the file system has not answered.
    fn silence(&self) -> Duration {
        if self.telling.load(Ordering::Relaxed) {
            return Duration::ZERO;
        }
        let last = Duration::from_millis(self.last.load(Ordering::Relaxed));
        self.start.elapsed().saturating_sub(last)
    }
}

/// So many problems of a scan are kept in words.
const PROBLEMS: usize = 20;

/// A mount that has not answered for so long hangs.
pub const HUNG: Duration = Duration::from_secs(10);

/// A file system, and the thread that looks at it.
#[derive(Debug)]
pub struct Mount {
    /// Unlike that of every other mount there is or was.
    pub id: u64,
    /// The kernel's name of its type.
    pub kind: String,
    /// Whether other machines may write to it.
    pub network: bool,
    /// Since when the thread has been at work.
    pub busy: Option<Instant>,
    /// How it shows that it gets on.
    pub(super) pulse: Arc<Pulse>,
    /// When it is to be read through next.
    pub next_scan: Instant,
    /// When what may still be changing is to be looked at next.
    pub next_look: Instant,
    /// When it was last read through, and how long that took.
    pub scanned: Option<(Instant, Duration)>,
    /// Number of files, when it was last read through.
    pub files: usize,
    /// Files that came up for which there was no room.
    pub left_over: usize,
    /// Whether something happened since the scan that is under way was begun.
    pub hinted: bool,
    /// The folders that the last scan came upon, with device and inode.
    pub folders: Vec<(PathBuf, (u64, u64))>,
    /// Those of the scan that is under way.
    pub reading: Vec<(PathBuf, (u64, u64))>,
    /// What could not be looked at by the last scan, in words; not all of it.
    pub problems: Vec<String>,
    /// Number of things that could not be looked at.
    pub problem_count: usize,
    /// Why the folder itself could not be read.
    pub root_problem: Option<String>,
    /// Number of scans that were begun.
    pub scan: u64,
    /// Files of the scan that is under way.
    pub counted: usize,
    /// The kernel's number of the mount.
    pub(super) number: u64,
    /// Gets what the thread is asked for.
    pub(super) asks: Sender<Ask>,
}

impl Mount {
    /// Asks the thread for something, unless it is at work; says whether it was asked.
    pub(super) fn ask(&mut self, ask: Ask) -> bool {
        let asked = self.busy.is_none() && self.asks.try_send(ask).is_ok();
        if asked {
            self.pulse.beat();
            self.busy = Some(Instant::now());
        }
        asked
    }

    /// Something could not be looked at.
    pub fn complain(&mut self, root: &Path, path: &Path, error: &std::io::Error) {
        self.problem_count += 1;
        if self.problems.len() < PROBLEMS {
            self.problems.push(format!("{}: {error}", path.display()));
        }
        if path == root {
            self.root_problem = Some(error.to_string());
        }
    }

    /// For how long it has not answered, if that is too long.
    pub fn hangs(&self) -> Option<Duration> {
        self.busy.map(|_| self.pulse.silence()).filter(|silence| *silence > HUNG)
    }

    /// Something happened: the next scan comes sooner. A scan that takes long is not made at every event.
    pub fn hurry(&mut self, watch: &Watch) {
        self.hinted = true;
        if let (None, Some((end, took))) = (self.busy, self.scanned) {
            self.next_scan = self.next_scan.min(end + self.between_looks(watch).max(took * 10));
        }
    }

    /// How long a file must stand still.
    pub fn settle(&self, watch: &Watch) -> Duration {
        if self.network { watch.settle_network.0 } else { watch.settle.0 }
    }

    /// How often it is read through.
    pub fn between_scans(&self, watch: &Watch) -> Duration {
        if self.network { watch.scan_network.0 } else { watch.scan.0 }
    }

    /// How long to wait between two looks at a file that may still be changing.
    pub fn between_looks(&self, watch: &Watch) -> Duration {
        (self.settle(watch) / 4).clamp(Duration::from_millis(20), Duration::from_secs(5))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A drop of 100 000 new files was said not to answer, because the loop took longer to hear of them than `HUNG`.
    #[test]
    fn a_thread_that_waits_for_the_loop_is_no_file_system_that_hangs() {
        let (pulse, wait) = (Pulse::new(), Duration::from_millis(50));
        std::thread::sleep(wait);
        assert!(pulse.silence() >= wait);
        pulse.while_telling(|| {
            std::thread::sleep(wait);
            assert_eq!(pulse.silence(), Duration::ZERO);
        });
        assert!(pulse.silence() < wait);
    }
}
