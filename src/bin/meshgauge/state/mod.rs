//! What outlives the daemon: a SQLite database that people may query; `docs/STATE.md` describes its tables.
//!
//! The daemon is its only writer. On local disk it is kept with a write-ahead log, so that readers never hold the
//! daemon up; a crash of the process loses nothing, and what a crash of the machine may take from its end is told by
//! the log of results, which is on disk before (`recovery`). Network file systems do not carry the shared memory of a
//! write-ahead log: there it is kept with a rollback journal.

mod history;
mod id;
mod lookup;
mod meshes;
mod path_value;
mod recovery;
mod scores;
mod summaries;
mod versions;

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use anyhow::Context;
use rusqlite::{Connection, Transaction};

use crate::file_system;

pub use history::Entry;
pub use id::Id;
pub use lookup::Known;
pub use recovery::{LogMark, Logged};
pub use versions::{Failed, Stage, Tries};

/// The database's file name in the state folder.
pub const FILE: &str = "state.db";

/// The steps that lead to the present schema; `user_version` counts those that were made.
const MIGRATIONS: [&str; 3] =
    [include_str!("schema-1.sql"), include_str!("schema-2.sql"), include_str!("schema-3.sql")];

/// Another program that reads or edits may hold the database this long.
const PATIENCE: Duration = Duration::from_secs(10);

/// The database, open to write.
pub struct State {
    connection: Connection,
}

impl State {
    /// Opens the database in the folder, which is there; makes it or brings it up to date.
    pub fn open(folder: &Path) -> anyhow::Result<Self> {
        let path = folder.join(FILE);
        Self::prepare(&path, file_system::network(folder)).with_context(|| path.display().to_string())
    }

    fn prepare(path: &PathBuf, network: Option<&'static str>) -> anyhow::Result<Self> {
        let mut connection = Connection::open(path)?;
        connection.busy_timeout(PATIENCE)?;
        connection.set_prepared_statement_cache_capacity(64);
        connection.pragma_update(None, "foreign_keys", true)?;
        match network {
            None => {
                connection.pragma_update(None, "journal_mode", "WAL")?;
                connection.pragma_update(None, "synchronous", "NORMAL")?;
            }
            Some(name) => {
                tracing::warn!(
                    "{}: on {name}; a state folder on local disk is faster and safer",
                    path.display()
                );
                connection.pragma_update(None, "journal_mode", "TRUNCATE")?;
                connection.pragma_update(None, "synchronous", "FULL")?;
            }
        }
        migrate(&mut connection)?;
        Ok(Self { connection })
    }

    /// Begins what happens wholly or not at all; it ends with `commit`.
    pub fn begin(&self) -> anyhow::Result<Transaction<'_>> {
        Ok(self.connection.unchecked_transaction()?)
    }
}

/// Makes the steps that were not made yet.
fn migrate(connection: &mut Connection) -> anyhow::Result<()> {
    let made: usize = connection.pragma_query_value(None, "user_version", |row| row.get(0))?;
    anyhow::ensure!(
        made <= MIGRATIONS.len(),
        "written by a later version of meshgauge: expected schema {} or earlier, found {made}",
        MIGRATIONS.len()
    );
    for (step, sql) in MIGRATIONS.iter().enumerate().skip(made) {
        let transaction = connection.transaction()?;
        transaction.execute_batch(sql)?;
        transaction.pragma_update(None, "user_version", step + 1)?;
        transaction.commit()?;
    }
    Ok(())
}

/// The present time as it stands in the database: RFC 3339 in UTC, so that texts sort by time.
fn now() -> String {
    humantime::format_rfc3339_millis(SystemTime::now()).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A database in a folder that goes with it.
    pub fn open() -> (State, tempfile::TempDir) {
        let folder = tempfile::tempdir().expect("a folder");
        (State::open(folder.path()).expect("a database"), folder)
    }

    #[test]
    fn a_database_of_a_later_version_is_left_alone() {
        let (state, folder) = open();
        state.connection.pragma_update(None, "user_version", MIGRATIONS.len() + 1).expect("set");
        drop(state);
        let error = State::open(folder.path()).err().expect("it must not be opened");
        assert!(format!("{error:#}").contains("later version"), "{error:#}");
    }

    #[test]
    fn a_database_of_an_earlier_version_is_brought_up_to_date_with_what_it_holds() {
        let folder = tempfile::tempdir().expect("a folder");
        let old = Connection::open(folder.path().join(FILE)).expect("a database");
        old.execute_batch(MIGRATIONS[0]).expect("the first schema");
        old.execute_batch("INSERT INTO logged VALUES ('7', 'mesh.scored'); PRAGMA user_version = 1")
            .expect("filled");
        drop(old);
        let state = State::open(folder.path()).expect("it is brought up to date");
        for event in ["mesh.scored", "mesh.regressed"] {
            let logged = Logged { id: "7".into(), event: event.into() };
            state.note_logged(&logged).expect("the log tells two things of a version");
        }
        let count: u32 =
            state.connection.query_row("SELECT count(*) FROM logged", [], |row| row.get(0)).expect("a count");
        assert_eq!(count, 2);
    }

    #[test]
    fn a_database_that_is_up_to_date_is_opened_again() {
        let (state, folder) = open();
        drop(state);
        assert!(State::open(folder.path()).is_ok());
    }

    #[test]
    fn every_table_and_column_is_documented() {
        let text = include_str!("../../../../docs/STATE.md");
        let (state, _folder) = open();
        let query = "SELECT m.name, p.name FROM sqlite_master m, pragma_table_info(m.name) p
                     WHERE m.type IN ('table', 'view')";
        let mut statement = state.connection.prepare(query).expect("a query");
        let columns = statement.query_map([], |row| Ok((row.get(0)?, row.get(1)?))).expect("columns");
        for column in columns {
            let (table, column): (String, String) = column.expect("two names");
            let section = text.split("\n## ").find(|s| s.starts_with(&format!("`{table}`")));
            let section = section.unwrap_or_else(|| panic!("docs/STATE.md has no section `{table}`"));
            assert!(section.contains(&format!("`{column}`")), "`{table}` does not tell of `{column}`");
        }
    }
}
