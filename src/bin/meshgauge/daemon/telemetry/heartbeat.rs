//! When the daemon's loop last turned, for whoever asks from another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Shared between the loop and those who watch it.
#[derive(Debug, Clone)]
pub struct Heartbeat(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    start: Instant,
    /// Milliseconds after `start`.
    last: AtomicU64,
    ready: AtomicBool,
}

impl Heartbeat {
    /// The loop turns now.
    pub fn new() -> Self {
        let (last, ready) = (AtomicU64::new(0), AtomicBool::new(false));
        Self(Arc::new(Inner { start: Instant::now(), last, ready }))
    }

    /// The loop turned.
    pub fn beat(&self) {
        let since = u64::try_from(self.0.start.elapsed().as_millis()).unwrap_or(u64::MAX);
        self.0.last.store(since, Ordering::Relaxed);
    }

    /// How long ago the loop last turned.
    pub fn age(&self) -> Duration {
        self.0.start.elapsed().saturating_sub(Duration::from_millis(self.0.last.load(Ordering::Relaxed)))
    }

    /// Says whether meshes that land now are scored: the drop was read through once, and nothing is in the way.
    pub fn set_ready(&self, ready: bool) {
        self.0.ready.store(ready, Ordering::Relaxed);
    }

    /// What `set_ready` said last.
    pub fn is_ready(&self) -> bool {
        self.0.ready.load(Ordering::Relaxed)
    }
}
