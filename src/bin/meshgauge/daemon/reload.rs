//! What an operator asks of a running daemon: another configuration, another log file.

use std::sync::Arc;
use std::time::Instant;

use super::Places;
use super::log::Event;
use super::pool::shared_out;
use super::watching::{Watching, rules};

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
                // Log, results and state are held open.
                let moved = Places::of(&config.watch) != self.places;
                self.telemetry.reconfigured(&config);
                self.rules = Arc::new(rules(&config, &self.places));
                self.worker_config = Arc::new(shared_out(config.clone()));
                self.config = Arc::new(config);
                let now = Instant::now();
                self.scanners.each().for_each(|mount| mount.next_scan = now);
                if moved { event.with("needs_restart", "other folders or another log") } else { event }
            }
        };
        let told = self.record.event(event);
        self.bear(told)?;
        self.service.ready();
        self.tell();
        Ok(())
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
