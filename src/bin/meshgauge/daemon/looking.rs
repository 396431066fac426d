//! What is seen in the drop, and what follows from it.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::mounts::{self, Mounted};
use super::producer::Word;
use super::scanners::{End, Report, Seen};
use super::tracking::{Look, Place};
use super::watching::Watching;
use crate::config::Done;
use crate::exit::Status;
use crate::folder::Found;
use crate::identity::Identity;
use crate::names::has_mesh_extension;
use crate::state::Id;

/// Names of arrivals that were not come upon are kept up to this number.
const MOST_RENAMED: usize = 10_000;

/// What could not be looked at is remembered up to this number.
const MOST_PROBLEMS: usize = 10_000;

/// How often `--once` looks for files that it has waited for in vain: that goes over all of them.
const BETWEEN_STRAGGLERS: Duration = Duration::from_millis(500);

impl Watching<'_> {
    /// Asks the threads for what is due.
    pub(super) fn ask_scanners(&mut self) -> anyhow::Result<()> {
        if self.degraded.is_some() {
            return Ok(());
        }
        self.give_up();
        let now = Instant::now();
        if self.scanners.mounts().is_empty()
            || self.scanners.mounts().values().any(|m| m.busy.is_none() && now >= m.next_scan)
        {
            self.follow_mounts();
        }
        let places: Vec<PathBuf> = self.scanners.mounts().keys().cloned().collect();
        for at in places {
            let Some(mount) = self.scanners.mounts().get(&at) else { continue };
            if mount.busy.is_some() {
                continue;
            }
            let (id, again) = (mount.id, mount.left_over > 0 && self.tracking.has_room());
            let scan_due = if self.mode.once { mount.scanned.is_none() } else { now >= mount.next_scan };
            let look_due = now >= mount.next_look && self.tracking.settling() > 0;
            if scan_due || again {
                self.scanners.scan(&at, &self.rules);
            } else if look_due {
                let unsettled = self.tracking.unsettled(id);
                if unsettled.is_empty() {
                    self.put_off_looks(id);
                } else {
                    self.scanners.look(&at, &self.rules, unsettled);
                }
            }
        }
        Ok(())
    }

    fn put_off_looks(&mut self, mount: u64) {
        let config = &self.config.watch;
        if let Some(mount) = self.scanners.mount(mount) {
            mount.next_look = Instant::now() + mount.between_looks(config);
        }
    }

    /// Finds out what is mounted where.
    fn follow_mounts(&mut self) {
        if self.root.is_none() {
            self.root = std::fs::canonicalize(&self.places.drop).ok();
        }
        let alone = || vec![Mounted { at: PathBuf::new(), kind: "unknown".into(), number: 0 }];
        let mounts = match self.root.as_deref().map(mounts::below) {
            Some(Ok(mounts)) if mounts.iter().any(|mount| mount.at.as_os_str().is_empty()) => mounts,
            _ => alone(),
        };
        for id in self.scanners.follow(&self.places.drop, mounts) {
            self.tracking.unmounted(id);
        }
    }

    /// An event: the next scan comes sooner.
    pub(super) fn hurry(&mut self) {
        let arrived: Vec<PathBuf> = self.hints.renamed().collect();
        if self.config.watch.done == Done::Rename
            && let Ok(drop) = std::path::absolute(&self.places.drop)
        {
            let within = arrived.iter().filter_map(|path| path.strip_prefix(&drop).ok());
            let room = MOST_RENAMED.saturating_sub(self.renamed.len());
            self.renamed.extend(within.map(Path::to_owned).take(room));
        }
        self.hurry_scans();
    }

    fn hurry_scans(&mut self) {
        let config = &self.config.watch;
        self.scanners.each().filter(|mount| !mount.network).for_each(|mount| mount.hurry(config));
    }

    /// Takes in what a thread tells.
    pub(super) fn hear(&mut self, report: Report) -> anyhow::Result<()> {
        let Some(mount) = self.scanners.mount(report.mount) else { return Ok(()) };
        let place = Place { mount: mount.id, scan: mount.scan };
        let is_last = report.end.is_some();
        mount.reading.extend(report.folders);
        mount.counted += report.seen.len();
        for (path, error) in &report.problems {
            mount.complain(Path::new(""), path, error);
        }
        for (path, error) in &report.problems {
            self.complain(path, error);
        }
        for path in &report.gone {
            self.tracking.remove(path);
        }
        // Where there is no room, the next scan, when there is some again, comes upon the rest.
        let seen = self.see(place, report.seen);
        let left_over = self.bear(seen)?.unwrap_or(0);
        if let Some(mount) = self.scanners.mount(place.mount) {
            mount.left_over += left_over;
        }
        if is_last { self.end(place, report.end) } else { Ok(()) }
    }

    /// A thread has done what it was asked for.
    fn end(&mut self, place: Place, end: Option<End>) -> anyhow::Result<()> {
        let config = std::sync::Arc::clone(&self.config);
        let Some(mount) = self.scanners.mount(place.mount) else { return Ok(()) };
        let now = Instant::now();
        let began = mount.busy.take().unwrap_or(now);
        mount.next_look = now + mount.between_looks(&config.watch);
        if end != Some(End::Scan) {
            return Ok(());
        }
        mount.scanned = Some((now, now - began));
        mount.next_scan = now + mount.between_scans(&config.watch);
        mount.files = mount.counted;
        mount.folders = std::mem::take(&mut mount.reading);
        if mount.hinted {
            mount.hurry(&config.watch);
        }
        self.tracking.keep(place);
        let files = self.scanners.mounts().values().map(|mount| mount.files).sum();
        self.record.scanned(files);
        self.follow_folders();
        self.telemetry.scanned(self.scanners.mounts(), now - began);
        if !self.ready && self.scanners.all_scanned() {
            self.ready = true;
            self.service.ready();
        }
        self.tell();
        Ok(())
    }

    /// Asks for events of the folders that the scans came upon. Network file systems give none, and may hang.
    fn follow_folders(&mut self) {
        let local = self.scanners.mounts().values().filter(|mount| !mount.network);
        if self.hints.follow(&self.places.drop, local.flat_map(|mount| &mount.folders)) {
            // What came after the scan and before the kernel was asked for events made none.
            self.hurry_scans();
        }
    }

    /// Files were seen; says for how many of them there was no room.
    fn see(&mut self, place: Place, seen: Vec<Seen>) -> anyhow::Result<usize> {
        let mut unknown = Vec::new();
        for seen in seen {
            unknown.extend(self.recognize(place, seen)?);
        }
        let unknown = self.record.undone(unknown, |(path, look)| Id::of(path, &look.identity))?;
        let room = unknown.len().min(self.tracking.room());
        let (new, left_over) = unknown.split_at(room);
        let is_named = |path: &Path| has_mesh_extension(path.file_name().unwrap_or_default());
        let named = new.iter().filter(|(path, _)| is_named(path));
        self.record.detected(named.map(|(path, look)| (path.as_path(), &look.identity)))?;
        for (path, look) in new {
            self.tracking.add(path.clone(), place, *look, is_named(path));
        }
        Ok(left_over.len())
    }

    /// A file was seen that may be another one, or another version, than those that are known: then it is returned.
    fn recognize(&mut self, place: Place, seen: Seen) -> anyhow::Result<Option<(PathBuf, Look)>> {
        let Seen { path, found, word } = seen;
        let identity = match found {
            Found::File(identity) => identity,
            Found::Other(what) => {
                self.tracking.remove(&path);
                if !self.record.is_done(&path, &Identity::default())? {
                    self.record.ignored(&path, &Identity::default(), &format!("it is {what}"))?;
                }
                return Ok(None);
            }
        };
        let word = if self.renamed.remove(&path) { Word::Whole } else { word };
        let watch = &self.config.watch;
        let settle = self.scanners.mount(place.mount).map(|mount| mount.settle(watch));
        let look = Look { identity, word, now: Instant::now(), settle: settle.unwrap_or_default() };
        if self.tracking.contains(&path) {
            self.tracking.seen(&path, place);
            self.tracking.look(&path, look);
            return Ok(None);
        }
        Ok((!self.mode.once || word != Word::NotYet).then_some((path, look)))
    }

    /// Says what could not be looked at, once.
    fn complain(&mut self, path: &Path, error: &std::io::Error) {
        if self.problems.len() >= MOST_PROBLEMS {
            self.problems.clear();
        }
        if self.problems.insert(path.to_owned()) {
            tracing::warn!("{}: {error}", self.places.drop.join(path).display());
        }
        if self.mode.once {
            self.status = self.status.max(Status::Unreadable);
        }
    }

    /// With `--once` a file that is written for ever must not keep us for ever, nor may a mount that hangs.
    fn give_up(&mut self) {
        if !self.mode.once || self.looked_for_stragglers.elapsed() < BETWEEN_STRAGGLERS {
            return;
        }
        self.looked_for_stragglers = Instant::now();
        for path in self.tracking.give_up(Instant::now(), self.config.watch.patience.0) {
            let path = self.places.drop.join(path);
            eprintln!("meshgauge: {}: it is still being written; left for the next run", path.display());
            self.status = self.status.max(Status::Unreadable);
        }
        for (at, mount) in self.scanners.mounts() {
            if mount.hangs().is_some() && self.problems.insert(at.clone()) {
                let at = self.places.drop.join(at);
                eprintln!("meshgauge: {}: the file system does not answer", at.display());
                self.status = self.status.max(Status::Unreadable);
            }
        }
    }
}
