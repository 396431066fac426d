//! What ties the database to the log of results.
//!
//! The log is on disk before the database is, so after a crash it may be ahead: by the outcome that was logged when the
//! daemon was killed, or by all of the last seconds where the machine lost its power. The mark says up to where the
//! log's outcomes are in the database; what stands behind it is remembered as logged, and is not logged again when its
//! mesh is scored once more.

use rusqlite::{OptionalExtension, params};

use super::{Id, State};

/// A place in the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LogMark {
    /// The log file's inode, which it keeps when it is rotated.
    pub inode: u64,
    /// Bytes from its start.
    pub offset: u64,
}

/// An outcome that the log tells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Logged {
    /// The version's id, as it stands in the log.
    pub id: String,
    /// The event's name.
    pub event: String,
}

impl State {
    /// Up to where the log's outcomes are in the database.
    pub fn log_mark(&self) -> anyhow::Result<Option<LogMark>> {
        let query = "SELECT inode, offset FROM log_mark";
        let mark = self.connection.prepare_cached(query)?.query_row([], |row| {
            let (inode, offset): (i64, i64) = (row.get(0)?, row.get(1)?);
            Ok(LogMark { inode: inode.cast_unsigned(), offset: offset.cast_unsigned() })
        });
        Ok(mark.optional()?)
    }

    /// Puts down that the log's outcomes up to `mark` are in the database.
    pub fn set_log_mark(&self, mark: LogMark) -> anyhow::Result<()> {
        let update = "INSERT OR REPLACE INTO log_mark VALUES (1, ?1, ?2)";
        let mut statement = self.connection.prepare_cached(update)?;
        statement.execute(params![mark.inode.cast_signed(), mark.offset.cast_signed()])?;
        Ok(())
    }

    /// Has all that was committed on disk: of what comes later the machine's power may take some.
    pub fn sync(&self) -> anyhow::Result<()> {
        Ok(self.connection.query_row("PRAGMA wal_checkpoint(PASSIVE)", [], |_| Ok(()))?)
    }

    /// Puts down that the log tells an outcome which the database may not hold.
    pub fn note_logged(&self, logged: &Logged) -> anyhow::Result<()> {
        let insert = "INSERT OR REPLACE INTO logged SELECT ?1, ?2 WHERE NOT EXISTS
                      (SELECT 1 FROM version WHERE id = ?1 AND stage NOT IN ('claimed', 'waiting', 'dropped'))";
        self.connection.prepare_cached(insert)?.execute([&logged.id, &logged.event])?;
        Ok(())
    }

    /// Whether the log tells that this became of the version.
    pub fn is_logged(&self, id: Id, event: &str) -> anyhow::Result<bool> {
        let query = "SELECT 1 FROM logged WHERE id = ?1 AND event = ?2";
        Ok(self.connection.prepare_cached(query)?.exists([id.to_string().as_str(), event])?)
    }

    /// The version's outcome is in the database now.
    pub fn forget_logged(&self, id: Id) -> anyhow::Result<()> {
        self.connection.prepare_cached("DELETE FROM logged WHERE id = ?1")?.execute([id.to_string()])?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::Stage;
    use super::super::tests::open;
    use super::*;
    use crate::identity::Identity;

    #[test]
    fn only_outcomes_that_the_database_lacks_are_remembered() {
        let (state, _folder) = open();
        let identity = Identity::default();
        let (a, b, c) = (Path::new("a"), Path::new("b"), Path::new("c"));
        for path in [a, b] {
            state.claim(path, &identity).expect("claimed");
        }
        state.end(Id::of(b, &identity), Stage::Scored, None).expect("ended");
        for path in [a, b, c] {
            let id = Id::of(path, &identity);
            state.note_logged(&Logged { id: id.to_string(), event: "mesh.scored".into() }).expect("noted");
        }
        let logged = |path| state.is_logged(Id::of(path, &identity), "mesh.scored").expect("read");
        assert_eq!([logged(a), logged(b), logged(c)], [true, false, true]);
        state.forget_logged(Id::of(a, &identity)).expect("forgotten");
        assert!(!logged(a));
    }

    #[test]
    fn the_mark_is_one() {
        let (state, _folder) = open();
        assert_eq!(state.log_mark().expect("read"), None);
        for offset in [7, u64::MAX] {
            let mark = LogMark { inode: 3, offset };
            state.set_log_mark(mark).expect("set");
            assert_eq!(state.log_mark().expect("read"), Some(mark));
        }
    }
}
