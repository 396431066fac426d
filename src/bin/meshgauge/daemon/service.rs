//! What systemd wants to know. Without systemd none of this does anything.

use std::time::{Duration, Instant};

use sd_notify::NotifyState;

/// The service manager, as far as there is one.
pub struct Service {
    watchdog: Option<Duration>,
    fed: Instant,
}

impl Service {
    /// Finds out what the service manager wants.
    pub fn new() -> Self {
        Self { watchdog: sd_notify::watchdog_enabled(), fed: Instant::now() }
    }

    /// Meshes are scored from now on: the drop was read through once, or the configuration again.
    pub fn ready(&self) {
        tell(&[NotifyState::Ready]);
    }

    /// What the daemon is doing.
    pub fn status(&self, status: &str) {
        tell(&[NotifyState::Status(status)]);
    }

    /// The configuration is being read again; `ready` ends that.
    pub fn reloading(&self) {
        match NotifyState::monotonic_usec_now() {
            Ok(now) => tell(&[NotifyState::Reloading, now]),
            Err(error) => tracing::debug!("no monotonic clock: {error}"),
        }
    }

    /// No more meshes are claimed.
    pub fn stopping(&self) {
        tell(&[NotifyState::Stopping]);
    }

    /// Called in each round of the daemon's loop, never by an idle timer: a daemon that hangs must be found out.
    pub fn alive(&mut self) {
        if let Some(watchdog) = self.watchdog
            && self.fed.elapsed() >= watchdog / 4
        {
            self.fed = Instant::now();
            tell(&[NotifyState::Watchdog]);
        }
    }

    /// The longest that a round may take.
    pub fn longest_round(&self) -> Option<Duration> {
        self.watchdog.map(|watchdog| watchdog / 4)
    }
}

fn tell(state: &[NotifyState<'_>]) {
    if let Err(error) = sd_notify::notify(state) {
        tracing::debug!("the service manager did not hear: {error}");
    }
}
