//! A full disk is nobody's fault that a daemon could mend: it waits until there is room, and does then what it could
//! not do before.

use std::io;
use std::time::{Duration, Instant};

use rusqlite::ffi;

use super::log::Event;
use super::watching::Watching;

/// How often we look whether there is room again.
const BETWEEN_TRIES: Duration = Duration::from_secs(2);

/// What the daemon waits for.
#[derive(Debug)]
pub struct Degraded {
    /// In words.
    pub reason: String,
    /// Since when.
    pub since: Instant,
    /// When to try again.
    pub next_try: Instant,
}

impl Degraded {
    /// From now on.
    pub fn new(error: &anyhow::Error) -> Self {
        let now = Instant::now();
        Self { reason: format!("{error:#}"), since: now, next_try: now + BETWEEN_TRIES }
    }

    /// It is not over.
    pub fn again(&mut self, error: &anyhow::Error) {
        self.reason = format!("{error:#}");
        self.next_try = Instant::now() + BETWEEN_TRIES;
    }
}

impl Watching<'_> {
    /// Lets an error that may pass pass: the daemon goes on without claiming anything, until there is room again. A run
    /// that is to end cannot wait.
    pub(super) fn bear<T>(&mut self, result: anyhow::Result<T>) -> anyhow::Result<Option<T>> {
        let error = match result {
            Ok(value) => return Ok(Some(value)),
            Err(error) if self.mode.once || !may_pass(&error) => return Err(error),
            Err(error) => error,
        };
        match &mut self.degraded {
            Some(degraded) => degraded.again(&error),
            None => {
                tracing::error!("no mesh is claimed until this passes: {error:#}");
                self.degraded = Some(Degraded::new(&error));
                self.telemetry.degraded("storage", Some(format!("nothing is claimed: {error:#}")));
                self.tell();
            }
        }
        Ok(None)
    }

    /// Finds out whether there is room again, and does what could not be done.
    pub(super) fn recover(&mut self) -> anyhow::Result<()> {
        if self.degraded.as_ref().is_none_or(|degraded| Instant::now() < degraded.next_try) {
            return Ok(());
        }
        let room = self.record.find_room();
        if self.bear(room)?.is_none() {
            return Ok(());
        }
        let Some(degraded) = self.degraded.take() else { return Ok(()) };
        self.telemetry.degraded("storage", None);
        let resumed = Event::warn("daemon.resumed")
            .with("reason", degraded.reason.as_str())
            .with("seconds", degraded.since.elapsed().as_secs_f64());
        let told = self.record.event(resumed);
        self.bear(told)?;
        self.put_down()?;
        // What was come upon meanwhile was not put down.
        let now = Instant::now();
        self.scanners.each().for_each(|mount| mount.next_scan = now);
        self.tell();
        Ok(())
    }
}

/// Whether an error is about a place that is full, or read-only, or held by somebody: all that may pass. A failed fsync
/// is not among them: what it did not write may be lost whatever a second one says.
pub fn may_pass(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        let io = cause.downcast_ref::<io::Error>().is_some_and(|e| {
            use io::ErrorKind::{QuotaExceeded, ReadOnlyFilesystem, StorageFull};
            matches!(e.kind(), StorageFull | QuotaExceeded | ReadOnlyFilesystem)
        });
        let database = cause.downcast_ref::<rusqlite::Error>().and_then(rusqlite::Error::sqlite_error);
        io || database.is_some_and(|e| of_database(e.extended_code))
    })
}

fn of_database(code: i32) -> bool {
    const WRITES: [i32; 4] = [
        ffi::SQLITE_IOERR_WRITE,
        ffi::SQLITE_IOERR_TRUNCATE,
        ffi::SQLITE_IOERR_SHMSIZE,
        ffi::SQLITE_IOERR_SHMOPEN,
    ];
    WRITES.contains(&code)
        || matches!(
            code & 0xff,
            ffi::SQLITE_FULL | ffi::SQLITE_READONLY | ffi::SQLITE_BUSY | ffi::SQLITE_CANTOPEN
        )
}

#[cfg(test)]
mod tests {
    use anyhow::Context;

    use super::*;

    #[test]
    fn a_full_disk_passes_and_a_failed_fsync_does_not() {
        let error = |number| Err::<(), _>(io::Error::from_raw_os_error(number)).context("log").unwrap_err();
        // ENOSPC, EDQUOT, EROFS; EIO, ENOENT.
        assert!([28, 122, 30].into_iter().all(|number| may_pass(&error(number))));
        assert!(![5, 2].into_iter().any(|number| may_pass(&error(number))));
        assert!(of_database(ffi::SQLITE_FULL) && of_database(ffi::SQLITE_READONLY_DIRECTORY));
        assert!(!of_database(ffi::SQLITE_IOERR_FSYNC) && !of_database(ffi::SQLITE_CORRUPT));
    }
}
