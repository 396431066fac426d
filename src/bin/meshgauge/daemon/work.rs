//! What the workers are at, as far as they said: for whoever asks what the daemon is doing.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use super::protocol::Progress;

/// The meshes that workers have. Clones share it.
#[derive(Debug, Clone, Default)]
pub struct Work(Arc<Mutex<HashMap<PathBuf, InWork>>>);

/// A mesh that a worker has.
#[derive(Debug, Clone, Copy)]
pub struct InWork {
    /// Its size.
    pub bytes: u64,
    /// When the worker got it.
    pub since: Instant,
    /// When the worker was last heard of.
    pub heard: Instant,
    /// What it said.
    pub progress: Progress,
}

impl Work {
    /// A worker gets the mesh.
    pub fn begin(&self, path: &Path, bytes: u64) {
        let now = Instant::now();
        let work = InWork { bytes, since: now, heard: now, progress: Progress::default() };
        self.all().insert(path.to_owned(), work);
    }

    /// The worker that has the mesh said how far it is.
    pub fn heard(&self, path: &Path, progress: Progress) {
        if let Some(work) = self.all().get_mut(path) {
            (work.heard, work.progress) = (Instant::now(), progress);
        }
    }

    /// The worker is done with the mesh.
    pub fn end(&self, path: &Path) {
        self.all().remove(path);
    }

    /// What is in work, that which has taken longest first.
    pub fn list(&self) -> Vec<(PathBuf, InWork)> {
        let mut list: Vec<_> = self.all().iter().map(|(path, work)| (path.clone(), *work)).collect();
        list.sort_by_key(|(_, work)| work.since);
        list
    }

    fn all(&self) -> MutexGuard<'_, HashMap<PathBuf, InWork>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
