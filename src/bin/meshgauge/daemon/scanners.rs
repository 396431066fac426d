//! The threads that look at the drop: one for each file system that is mounted there, so that one that hangs holds up
//! nobody else.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use crossbeam_channel::{Receiver, Sender, bounded};

use super::mount::{Mount, Pulse};
use super::mounts::Mounted;
use super::producer::{Producer, Word};
use crate::file_system;
use crate::folder::{Found, Sight, Walk};

/// How much is told at a time.
const BATCH: usize = 1024;

/// What all the threads need to know.
#[derive(Debug, Clone)]
pub struct Rules {
    /// How the drop is read.
    pub walk: Walk,
    /// How producers give their word.
    pub producer: Producer,
}

/// What a thread is asked for.
pub(super) enum Ask {
    /// To read the file system through.
    Scan(Arc<Rules>, Walk),
    /// To look at these files.
    Look(Arc<Rules>, Vec<PathBuf>),
}

/// What a thread tells, bit by bit.
#[derive(Debug)]
pub struct Report {
    /// The mount.
    pub mount: u64,
    /// Files.
    pub seen: Vec<Seen>,
    /// Files that were asked for and are not there.
    pub gone: Vec<PathBuf>,
    /// Folders, with device and inode.
    pub folders: Vec<(PathBuf, (u64, u64))>,
    /// What could not be looked at.
    pub problems: Vec<(PathBuf, std::io::Error)>,
    /// Whether that was all, and of what.
    pub end: Option<End>,
}

/// What came to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The file system was read through.
    Scan,
    /// The files that were asked for were looked at.
    Look,
}

/// A file that was seen.
#[derive(Debug)]
pub struct Seen {
    /// Within the drop.
    pub path: PathBuf,
    /// What stands there.
    pub found: Found,
    /// What its producer says.
    pub word: Word,
}

/// All the threads.
pub struct Scanners {
    mounts: BTreeMap<PathBuf, Mount>,
    reports: Receiver<Report>,
    sender: Sender<Report>,
    next_id: u64,
}

impl Scanners {
    /// None yet.
    pub fn new() -> Self {
        let (sender, reports) = bounded(4);
        Self { mounts: BTreeMap::new(), reports, sender, next_id: 0 }
    }

    /// Gets what the threads tell.
    pub fn reports(&self) -> &Receiver<Report> {
        &self.reports
    }

    /// The mounts by where they stand.
    pub fn mounts(&self) -> &BTreeMap<PathBuf, Mount> {
        &self.mounts
    }

    /// The mount of this id, if it is still there.
    pub fn mount(&mut self, id: u64) -> Option<&mut Mount> {
        self.mounts.values_mut().find(|mount| mount.id == id)
    }

    /// Every mount.
    pub fn each(&mut self) -> impl Iterator<Item = &mut Mount> {
        self.mounts.values_mut()
    }

    /// Whether each was read through once.
    pub fn all_scanned(&self) -> bool {
        self.mounts.values().all(|mount| mount.scanned.is_some())
    }

    /// The mounts are these now; returns the ids of those that are no more.
    pub fn follow(&mut self, root: &Path, mounts: Vec<Mounted>) -> Vec<u64> {
        let mut gone = Vec::new();
        self.mounts.retain(|at, mount| {
            let stays = mounts.iter().any(|m| m.at == *at && m.number == mount.number);
            if !stays {
                gone.push(mount.id);
            }
            stays
        });
        let appeared: Vec<_> = mounts.into_iter().filter(|m| !self.mounts.contains_key(&m.at)).collect();
        for mounted in appeared {
            let is_root = mounted.at.as_os_str().is_empty();
            let mount = self.start(&root.join(&mounted.at), &mounted.kind, mounted.number, is_root);
            self.mounts.insert(mounted.at, mount);
        }
        if !gone.is_empty() {
            // What stood beneath a mount that is gone shows again.
            let now = Instant::now();
            self.mounts.values_mut().for_each(|mount| mount.next_scan = now);
        }
        gone
    }

    fn start(&mut self, root: &Path, kind: &str, number: u64, is_root: bool) -> Mount {
        let (asks, queue) = bounded::<Ask>(1);
        let (id, sender) = (self.next_id, self.sender.clone());
        self.next_id += 1;
        // To ask a mount that hangs what it is would hang.
        let network = file_system::is_network(kind) || (is_root && file_system::network(root).is_some());
        let pulse = Arc::new(Pulse::new());
        let beating = Arc::clone(&pulse);
        std::thread::spawn(move || {
            for ask in queue {
                if answer(id, ask, network, &sender, &beating).is_break() {
                    break;
                }
            }
        });
        tracing::info!(
            "{}: {kind}, {}",
            root.display(),
            if network { "scanned" } else { "events and scans" }
        );
        let now = Instant::now();
        Mount {
            id,
            kind: kind.to_owned(),
            network,
            busy: None,
            pulse,
            next_scan: now,
            next_look: now,
            scanned: None,
            files: 0,
            left_over: 0,
            hinted: false,
            folders: Vec::new(),
            reading: Vec::new(),
            problems: Vec::new(),
            problem_count: 0,
            root_problem: None,
            scan: 0,
            counted: 0,
            number,
            asks,
        }
    }

    /// Has the mount at `at` read through, unless its thread is at work.
    pub fn scan(&mut self, at: &Path, rules: &Arc<Rules>) {
        let below = self.mounts.keys().filter(|other| *other != at && other.starts_with(at));
        let walk = rules.walk.part(at.to_owned(), below.cloned().collect());
        let Some(mount) = self.mounts.get_mut(at) else { return };
        if mount.ask(Ask::Scan(Arc::clone(rules), walk)) {
            mount.scan += 1;
            (mount.counted, mount.left_over, mount.hinted) = (0, 0, false);
            mount.reading.clear();
            mount.problems.clear();
            (mount.problem_count, mount.root_problem) = (0, None);
        }
    }

    /// Has the files looked at, which are on the mount at `at`, unless its thread is at work.
    pub fn look(&mut self, at: &Path, rules: &Arc<Rules>, files: Vec<PathBuf>) {
        if let Some(mount) = self.mounts.get_mut(at) {
            mount.ask(Ask::Look(Arc::clone(rules), files));
        }
    }
}

impl Report {
    fn new(mount: u64) -> Self {
        Self {
            mount,
            seen: Vec::new(),
            gone: Vec::new(),
            folders: Vec::new(),
            problems: Vec::new(),
            end: None,
        }
    }

    fn is_full(&self) -> bool {
        self.seen.len() + self.gone.len() + self.folders.len() + self.problems.len() >= BATCH
    }
}

/// Does what is asked for; stops when nobody listens any more.
fn answer(mount: u64, ask: Ask, fresh: bool, sender: &Sender<Report>, pulse: &Pulse) -> ControlFlow<()> {
    let mut report = Report::new(mount);
    let pass_on = |report: &mut Report| {
        let full = std::mem::replace(report, Report::new(mount));
        match pulse.while_telling(|| sender.send(full)) {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        }
    };
    let end = match ask {
        Ask::Scan(rules, walk) => {
            walk.each(&mut |sight| {
                pulse.beat();
                match sight {
                    Sight::File(path, found) => report.seen.extend(rules.see(path, found)),
                    Sight::Folder(path, place) => report.folders.push((path, place)),
                    Sight::Problem(path, error) => report.problems.push((path, error)),
                }
                if report.is_full() { pass_on(&mut report) } else { ControlFlow::Continue(()) }
            })?;
            End::Scan
        }
        Ask::Look(rules, paths) => {
            rules.walk.look_at(paths, fresh, &mut |path, found| {
                pulse.beat();
                match found {
                    Some(found) => report.seen.extend(rules.see(path, found)),
                    None => report.gone.push(path),
                }
                if report.is_full() { pass_on(&mut report) } else { ControlFlow::Continue(()) }
            })?;
            End::Look
        }
    };
    report.end = Some(end);
    pass_on(&mut report)
}

impl Rules {
    /// A file with its producer's word, unless it is itself a word.
    fn see(&self, path: PathBuf, found: Found) -> Option<Seen> {
        if path.file_name().is_some_and(|name| self.producer.is_word(name)) {
            return None;
        }
        let word = match &found {
            Found::File(identity) => self.producer.word(&self.walk.root().join(&path), identity),
            Found::Other(_) => Word::None,
        };
        Some(Seen { path, found, word })
    }
}
