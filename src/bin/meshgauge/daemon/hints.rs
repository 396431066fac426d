//! Events of the kernel, as hints: they say that a look is due, and nothing else.
//!
//! Events are blind on network file systems, overflow, and get lost when folders come and go. What stands in the drop
//! is for the scan to say; without any hint it only says so later.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crossbeam_channel::{Receiver, Sender, bounded};
use notify::event::{AccessKind, AccessMode};
use notify::{Config, Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};

/// The folders that events are asked for.
pub struct Hints {
    watcher: Option<RecommendedWatcher>,
    watched: HashMap<PathBuf, (u64, u64)>,
    due: Receiver<()>,
    /// Keeps the channel open where there is no watcher.
    _sender: Sender<()>,
    complained: bool,
}

impl Hints {
    /// Asks for events if `wanted`, as far as the kernel gives any.
    pub fn new(wanted: bool) -> Self {
        // One place is enough: any number of events makes one look due.
        let (sender, due) = bounded(1);
        let _sender = sender.clone();
        let handler = move |event: notify::Result<Event>| {
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
        Self { watcher: watcher.flatten(), watched: HashMap::new(), due, _sender, complained: false }
    }

    /// Gets a message when a look is due.
    pub fn due(&self) -> &Receiver<()> {
        &self.due
    }

    /// Asks for events of exactly these folders below `root`, each with its device and inode.
    pub fn follow(&mut self, root: &Path, folders: &[(PathBuf, (u64, u64))]) {
        let Some(watcher) = &mut self.watcher else { return };
        let now: HashMap<_, _> = folders.iter().map(|(path, place)| (root.join(path), *place)).collect();
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
                }
                Err(error) if !self.complained => {
                    self.complained = true;
                    tracing::warn!("{}: no events, the scan finds its meshes: {error}", path.display());
                }
                Err(_) => {}
            }
        }
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
