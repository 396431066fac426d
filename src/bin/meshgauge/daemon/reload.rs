//! What an operator asks of a running daemon: another configuration, another log file.

use std::sync::Arc;
use std::time::Instant;

use super::Places;
use super::hints::Hints;
use super::log::Event;
use super::pool::shared_out;
use super::watching::{Watching, rules};
use crate::config::Config;

impl Watching<'_> {
    /// Reads the configuration again. One that is not sound changes nothing; a sound one holds as a whole, for every
    /// mesh that is claimed from now on.
    pub(super) fn reload(&mut self) -> anyhow::Result<()> {
        self.service.reloading();
        let read = (self.read_config)();
        let event = match read.and_then(|config| self.record.configure(&config).map(|()| config)) {
            Err(error) => {
                tracing::error!("the configuration stays as it was: {error:#}");
                Event::error("config.refused").with("reason", format!("{error:#}"))
            }
            Ok(config) => {
                let event = Event::info("config.reloaded");
                let left = needs_restart(&self.started, &config, &self.places);
                self.hold(config);
                if left.is_empty() { event } else { event.with("needs_restart", left.join(", ")) }
            }
        };
        let told = self.record.event(event);
        self.bear(told)?;
        self.service.ready();
        self.tell();
        Ok(())
    }

    /// A sound configuration holds from now on.
    fn hold(&mut self, config: Config) {
        if config.watch.events != self.config.watch.events {
            // The next scan asks for events of each folder.
            self.hints = Hints::new(config.watch.events && !self.mode.once);
        }
        self.telemetry.reconfigured(&config);
        self.rules = Arc::new(rules(&config, &self.places));
        self.worker_config = Arc::new(shared_out(config.clone()));
        self.config = Arc::new(config);
        let now = Instant::now();
        self.scanners.each().for_each(|mount| mount.next_scan = now);
    }

    /// Somebody moved the log away.
    pub(super) fn reopen(&mut self) -> anyhow::Result<()> {
        let reopened = self.record.reopen_log();
        self.bear(reopened)?;
        Ok(())
    }

    /// Rotates the log when it is time, and begins another where somebody moved it away.
    pub(super) fn mind_log(&mut self) -> anyhow::Result<()> {
        if self.degraded.is_none() && self.pending.is_empty() {
            let minded = self.record.mind_log(&self.config.log);
            self.bear(minded)?;
        }
        Ok(())
    }
}

/// The settings that are other than at the start and hold only after a restart: folders and log are held open, the
/// endpoint listens, diagnostics are set up before the daemon is.
fn needs_restart(old: &Config, new: &Config, places: &Places) -> Vec<&'static str> {
    let there = Places::of(&new.watch);
    let rows = [
        ("watch.drop", there.drop != places.drop),
        ("watch.results", there.results != places.results),
        ("watch.log", there.log != places.log),
        ("watch.state", there.state != places.state),
        ("telemetry.listen", new.telemetry.listen != old.telemetry.listen),
        ("telemetry.stalled", new.telemetry.stalled != old.telemetry.stalled),
        ("diagnostics.level", new.diagnostics.level != old.diagnostics.level),
    ];
    rows.into_iter().filter(|(_, differs)| *differs).map(|(setting, _)| setting).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_held_open_needs_a_restart() {
        let old = Config::default();
        let places = Places::of(&old.watch);
        let left = |change: &dyn Fn(&mut Config)| {
            let mut new = old.clone();
            change(&mut new);
            needs_restart(&old, &new, &places)
        };
        assert_eq!(left(&|new| new.watch.events = false), [""; 0]);
        assert_eq!(left(&|new| new.compare.volume = 0.5), [""; 0]);
        assert_eq!(
            left(&|new| new.watch.results = "elsewhere".into()),
            ["watch.results", "watch.log", "watch.state"]
        );
        assert_eq!(left(&|new| new.telemetry.listen = "127.0.0.1:9817".into()), ["telemetry.listen"]);
        assert_eq!(left(&|new| new.diagnostics.level = "debug".into()), ["diagnostics.level"]);
    }
}
