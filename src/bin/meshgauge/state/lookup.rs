//! What was done about one version, for a reader beside the daemon.

use std::ffi::OsString;
use std::path::Path;

use anyhow::Context;
use rusqlite::{Connection, OpenFlags, OptionalExtension};

use super::path_value::Out;
use super::{FILE, Id, PATIENCE, Stage, State};

/// What was done about a version.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Known {
    /// How far it has come.
    pub stage: Stage,
    /// When its outcome was put down, RFC 3339.
    pub ended: Option<String>,
    /// Of a failure: the sort and the words.
    pub failure: Option<(String, String)>,
    /// Of a scored version: `pass`, `warn` or `fail`.
    pub verdict: Option<String>,
    /// File name of the published summary of its mesh.
    pub summary: Option<OsString>,
}

impl State {
    /// Opens the database in the folder to read, if there is one. Nothing is made or brought up to date.
    pub fn read(folder: &Path) -> anyhow::Result<Option<Self>> {
        let path = folder.join(FILE);
        if !path.exists() {
            return Ok(None);
        }
        let open = || {
            let connection = Connection::open_with_flags(&path, OpenFlags::SQLITE_OPEN_READ_ONLY)?;
            connection.busy_timeout(PATIENCE)?;
            Ok::<_, rusqlite::Error>(connection)
        };
        let connection = open().with_context(|| path.display().to_string())?;
        Ok(Some(Self { connection }))
    }

    /// What was done about the version.
    pub fn known(&self, id: Id) -> anyhow::Result<Option<Known>> {
        let query = "SELECT stage, ended, kind, reason, verdict, summary FROM version JOIN mesh USING (mesh)
                     WHERE id = ?1";
        let mut statement = self.connection.prepare_cached(query)?;
        let row = statement.query_row([id.to_string()], |row| {
            let (kind, reason): (Option<String>, Option<String>) = (row.get(2)?, row.get(3)?);
            let known = Known {
                stage: Stage::Claimed,
                ended: row.get(1)?,
                failure: kind.zip(reason),
                verdict: row.get(4)?,
                summary: row.get::<_, Option<Out>>(5)?.map(|name| name.0),
            };
            Ok((row.get::<_, String>(0)?, known))
        });
        let Some((name, known)) = row.optional()? else { return Ok(None) };
        let stage = Stage::of_name(&name).with_context(|| format!("no stage is called {name}"))?;
        Ok(Some(Known { stage, ..known }))
    }
}
