//! Events of the kernel, as hints: they say that a look is due, and nothing else.
//!
//! Events are blind on network file systems, overflow, and get lost when folders come and go. What stands in the drop
//! is for the scan to say; without any hint it only says so later. What arrived by rename is passed on by name, for
//! producers that are known to write under another name first.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crossbeam_channel::{Receiver, Sender, bounded};
use notify::event::{AccessKind, AccessMode, ModifyKind, RenameMode};
use notify::{Config, Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};

/// So many names of arrivals are kept until somebody asks.
const ARRIVALS: usize = 4096;

/// The folders that events are asked for.
pub struct Hints {
    watcher: Option<RecommendedWatcher>,
    watched: HashMap<PathBuf, (u64, u64)>,
    due: Receiver<()>,
    renamed: Receiver<PathBuf>,
    /// Keeps the channel open where there is no watcher.
    _sender: Sender<()>,
    complained: bool,
}

impl Hints {
    /// Asks for events if `wanted`, as far as the kernel gives any.
    pub fn new(wanted: bool) -> Self {
        // One place is enough: any number of events makes one look due.
        let (sender, due) = bounded(1);
        let (arrivals, renamed) = bounded(ARRIVALS);
        let _sender = sender.clone();
        let handler = move |event: notify::Result<Event>| {
            if let Ok(event) = &event
                && let EventKind::Modify(ModifyKind::Name(RenameMode::To)) = event.kind
            {
                // What finds no room must stand still instead.
                event.paths.iter().for_each(|path| drop(arrivals.try_send(path.clone())));
            }
            if event.as_ref().map_or(true, is_telling) {
                // Full means that a look is due already.
                let _ = sender.try_send(());
            }
        };
        let watcher = wanted.then(|| {
            RecommendedWatcher::new(handler, Config::default().with_follow_symlinks(false))
                .map_err(|e| tracing::warn!("no events from the kernel, the scan alone finds meshes: {e}"))
                .ok()
        });
        Self { watcher: watcher.flatten(), watched: HashMap::new(), due, renamed, _sender, complained: false }
    }

    /// Gets a message when a look is due.
    pub fn due(&self) -> &Receiver<()> {
        &self.due
    }

    /// Paths that arrived by rename since the last call.
    pub fn renamed(&self) -> impl Iterator<Item = PathBuf> {
        self.renamed.try_iter()
    }

    /// Asks for events of exactly these folders below `root`, each with its device and inode; says whether any is new.
    pub fn follow<'f>(
        &mut self,
        root: &Path,
        folders: impl Iterator<Item = &'f (PathBuf, (u64, u64))>,
    ) -> bool {
        let Some(watcher) = &mut self.watcher else { return false };
        let mut added = false;
        let now: HashMap<_, _> = folders.map(|(path, place)| (root.join(path), *place)).collect();
        self.watched.retain(|path, place| {
            let stays = now.get(path) == Some(place);
            if !stays {
                // A folder that is gone took its watch along.
                let _ = watcher.unwatch(path);
            }
            stays
        });
        for (path, place) in now {
            if self.watched.contains_key(&path) {
                continue;
            }
            match watcher.watch(&path, RecursiveMode::NonRecursive) {
                Ok(()) => {
                    self.watched.insert(path, place);
                    added = true;
                }
                Err(error) if !self.complained => {
                    self.complained = true;
                    tracing::warn!("{}: no events, the scan finds its meshes: {error}", path.display());
                }
                Err(_) => {}
            }
        }
        added
    }
}

/// Whether an event may stand for a change; our own reading makes events too.
fn is_telling(event: &Event) -> bool {
    match event.kind {
        EventKind::Access(AccessKind::Close(AccessMode::Write)) => true,
        EventKind::Access(_) => event.need_rescan(),
        _ => true,
    }
}
